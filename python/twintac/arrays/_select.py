"""A choice between two states, sensor by sensor."""

from typing import Any, TypeVar

from ._namespace import Array, namespace

_State = TypeVar("_State")


def select(chosen: Array, this: _State, other: _State) -> _State:
    """Chooses, for each sensor, one of two states of the same type, such as `Held`, `Relaxed`,
    `Drawn` or `Bus`: `this` where the mask `chosen`, `[...]`, is true, else `other`. It resets
    chosen sensors or worlds on their device.
    """
    xp = namespace("chosen", chosen)

    def one(a: Any, b: Any) -> Any:
        if isinstance(a, tuple):
            parts = [one(*pair) for pair in zip(a, b, strict=True)]
            return type(a)(*parts) if hasattr(a, "_fields") else tuple(parts)
        wide = xp.reshape(chosen, (*chosen.shape, *(1 for _ in range(a.ndim - chosen.ndim))))
        return xp.where(wide, a, b)

    selected: _State = one(this, other)
    return selected
