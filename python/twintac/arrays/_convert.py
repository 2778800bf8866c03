"""Conversion between libraries, precisions and devices."""

from typing import Any, TypeVar

import numpy as np

from ._namespace import Array, namespace, refuse

_Tree = TypeVar("_Tree")


def convert(tree: _Tree, like: Array) -> _Tree:
    """Converts a gel, shapes or friction to arrays of another library, precision and device.

    Args:
        tree: the gel, the shapes or the friction; masks stay masks.
        like: an array of the library, precision and device to convert to, such as
            `torch.zeros(1, device="cuda")`.

    Returns:
        The same data with the new arrays.

    Raises:
        Error: if `like` is no array of single or double precision.
    """
    xp = namespace("like", like)
    precision = str(like.dtype).rpartition(".")[2]
    if precision not in ("float32", "float64"):
        raise refuse("like", f"is an array of {precision}", "float32 or float64")
    device = getattr(like, "device", None)

    def one(value: Any) -> Any:
        if value is None:
            return None
        if isinstance(value, tuple):
            parts = [one(part) for part in value]
            return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
        array = np.asarray(value)
        kind = {"f": precision, "i": "int32"}.get(array.dtype.kind, array.dtype)
        return xp.asarray(np.array(array, kind), device=device)

    converted: _Tree = one(tree)
    return converted
