"""Turns: quaternions as MuJoCo has them, `(w, x, y, z)`, in arrays of any shape `[…, 4]`, and
matrices.
"""

import numpy as np
import numpy.typing as npt

_Array = npt.NDArray[np.float64]
# Axes, each one further and two further.
_NEXT, _LAST = [1, 2, 0], [2, 0, 1]


def multiply(a: _Array, b: _Array) -> _Array:
    """The turn `b`, then the turn `a`."""
    vector = a[..., :1] * b[..., 1:] + b[..., :1] * a[..., 1:] + cross(a[..., 1:], b[..., 1:])
    scalar = a[..., :1] * b[..., :1] - (a[..., 1:] * b[..., 1:]).sum(-1, keepdims=True)
    return np.concatenate([scalar, vector], axis=-1)


def turned_back(a: _Array) -> _Array:
    """The turn the other way."""
    back: _Array = a * np.array([1.0, -1.0, -1.0, -1.0])
    return back


def turned(turn: _Array, vector: _Array) -> _Array:
    """Vectors, `[n, 3]`, turned by matrices, `[n, 3, 3]`."""
    vectors: _Array = (turn @ vector[:, :, None])[:, :, 0]
    return vectors


def cross(a: _Array, b: _Array) -> _Array:
    """The cross product; for a few vectors three times as fast as NumPy's."""
    product: _Array = a[..., _NEXT] * b[..., _LAST] - a[..., _LAST] * b[..., _NEXT]
    return product
