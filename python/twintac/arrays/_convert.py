"""From one library, precision and device to another."""

from typing import Any, TypeVar

import numpy as np

from ._namespace import Array, namespace, refuse

_Tree = TypeVar("_Tree")


def convert(tree: _Tree, like: Array) -> _Tree:
    """The same gel, shapes or friction with arrays of the library, the precision and the device of
    the array `like`, such as `convert(gel, torch.zeros(1, device="cuda"))`. Masks stay masks.

    Raises `Error` where `like` is no array of single or double precision.
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
