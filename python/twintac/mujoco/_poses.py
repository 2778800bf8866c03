"""Quaternions as MuJoCo has them, `(w, x, y, z)`, in arrays of any shape `[…, 4]`."""

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]


def multiply(a: _Array, b: _Array) -> _Array:
    """The turn `b`, then the turn `a`."""
    vector = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + np.cross(a[..., 1:], b[..., 1:])
    scalar = a[..., :1] * b[..., :1] - (a[..., 1:] * b[..., 1:]).sum(-1, keepdims=True)
    return np.concatenate([scalar, vector], axis=-1)


def turned_back(a: _Array) -> _Array:
    """The turn the other way."""
    back: _Array = a * np.array([1.0, -1.0, -1.0, -1.0])
    return back


def rotate(a: _Array, vector: _Array) -> _Array:
    """Vectors, turned."""
    across = 2.0 * np.cross(a[..., 1:], vector)
    turned: _Array = vector + a[..., :1] * across + np.cross(a[..., 1:], across)
    return turned
