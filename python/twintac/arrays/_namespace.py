"""The library of an array, and functions that the other files use with all libraries."""

import importlib
import math
from typing import Any

from .. import Error

Array = Any
"""An array of NumPy, PyTorch, JAX or any other library of the array API standard."""


def refuse(field: str, problem: str, expected: str) -> Error:
    """The error for an argument that cannot be used."""
    return Error(f"`{field}` {problem}, expected {expected}", field=field)


def namespace(field: str, array: Array) -> Any:
    """The functions of the library of an array.

    Raises `Error` if the argument is no array, and if `array-api-compat` is needed and missing.
    """
    if hasattr(array, "__array_namespace__"):
        return array.__array_namespace__()
    library = type(array).__module__.partition(".")[0]
    if library not in ("numpy", "torch"):
        raise refuse(field, f"is a {type(array).__name__}", "an array of NumPy, PyTorch or JAX")
    try:
        return importlib.import_module(f"array_api_compat.{library}")
    except ImportError as error:
        problem = f"is an array of {library}, which needs array-api-compat"
        raise refuse(field, problem, "that `pip install array-api-compat` was done") from error


def check_same_library(expected: Any, **arrays: Array) -> None:
    """Raises `Error` for an array of another library than the expected one."""
    for field, array in arrays.items():
        if array is not None and (found := namespace(field, array)) is not expected:
            problem = f"is an array of {_name(found)}"
            raise refuse(field, problem, f"one of {_name(expected)}, as the gel is: see `convert`")


def check_shape(field: str, array: Array, *last: int) -> None:
    """Raises `Error` unless the array has a dimension for bodies, followed by exactly these
    dimensions.
    """
    shape = tuple(array.shape)
    if len(shape) < len(last) + 1 or shape[len(shape) - len(last) :] != last:
        wanted = ", ".join(str(length) for length in last)
        raise refuse(field, f"has the shape {list(shape)}", f"[..., n_bodies, {wanted}]")


def broadcast(**shapes: tuple[int, ...]) -> tuple[int, ...]:
    """The common shape to which all of these shapes broadcast.

    Raises `Error`, which names the first shape that does not fit the shapes before it.
    """
    found: tuple[int, ...] = ()
    for field, shape in shapes.items():
        n = max(len(found), len(shape))
        pairs = list(zip((1,) * (n - len(found)) + found, (1,) * (n - len(shape)) + shape))
        if any(a != b and 1 not in (a, b) for a, b in pairs):
            problem = f"has the leading dimensions {list(shape)}"
            raise refuse(field, problem, f"such as fit {list(found)}")
        found = tuple(b if a == 1 else a for a, b in pairs)
    return found


def root(xp: Any, square: Array) -> Array:
    """The square root; its derivative at 0 is 0 instead of infinite."""
    is_zero = square <= 0.0  # NaN stays NaN
    return xp.where(is_zero, 0.0, xp.sqrt(xp.where(is_zero, 1.0, square)))


def times(xp: Any, rows: Array, matrix: Array) -> Array:
    """Rows `[..., n]` multiplied by a matrix `[n, m]`, as one matrix product: `[..., m]`."""
    leading, n = tuple(rows.shape[:-1]), rows.shape[-1]
    product = xp.matmul(xp.reshape(rows, (math.prod(leading), n)), matrix)
    return xp.reshape(product, (*leading, matrix.shape[-1]))


def for_rows(since_s: Array | float) -> Array | float:
    """Times of sensors, `[...]`, or one for all, for arrays `[..., n, m]` of sensors."""
    if isinstance(since_s, float) or not len(getattr(since_s, "shape", ())):
        return since_s
    return since_s[..., None, None]


def _name(xp: Any) -> str:
    name: str = xp.__name__
    return name.removeprefix("array_api_compat.").removesuffix(".numpy")
