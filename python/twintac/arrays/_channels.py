"""Signals that controllers and policies use beside pressures: whether there is contact, how near
bodies are, and the readings of the frames before.
"""

from ._contact import REACH_MM
from ._namespace import Array, namespace, refuse


def contact(before: Array, value: Array, *, on: float, off: float) -> Array:
    """Whether sensors are in contact, with hysteresis: a contact begins where a value exceeds `on`,
    and lasts until it falls below `off`.

    Args:
        before: the contact at the time step before, a mask `[...]`; at first none.
        value: the quantity from which contact is detected, `[...]`: the normal force, N, or the
            largest reading, kPa.
        on, off: the two thresholds; `off` is not larger than `on`.

    Returns:
        A mask, `[...]`.

    Raises:
        Error: if `off` is larger than `on`.
    """
    if not off <= on:
        raise refuse("off", f"is {off}", f"{on} at most, the threshold `on`")
    xp = namespace("value", value)
    return xp.where(before, value >= off, value > on)


def proximity(gap_mm: Array) -> Array:
    """How near the nearest body is to each sensor: 1 where it touches, falling linearly to 0 where it
    is 2 mm away or farther, as `SensorBatch.proximity`.

    Args:
        gap_mm: distances of the bodies, mm, `[..., n_bodies]`: `gap_mm` of a reading.

    Returns:
        `[...]`.
    """
    xp = namespace("gap_mm", gap_mm)
    return xp.clip(1.0 - xp.min(gap_mm, axis=-1) * (1.0 / REACH_MM), 0.0, 1.0)


def history(readings_kpa: Array, n_frames: int) -> Array:
    """A buffer of the last readings, `[..., n_frames, n_taxels]`, which begins with `n_frames` times
    the readings `[..., n_taxels]`.

    Raises:
        Error: for fewer frames than 1.
    """
    if n_frames < 1:
        raise refuse("n_frames", f"is {n_frames}", "1 or more")
    xp = namespace("readings_kpa", readings_kpa)
    *leading, n_taxels = readings_kpa.shape
    return xp.broadcast_to(readings_kpa[..., None, :], (*leading, n_frames, n_taxels))


def push(history: Array, readings_kpa: Array, is_new: Array | None = None) -> Array:
    """The buffer after one more frame: the oldest one is dropped, and the newest is the last.

    Args:
        history: the buffer, `[..., n_frames, n_taxels]`.
        readings_kpa: the frame, `[..., n_taxels]`.
        is_new: a mask `[...]` of the sensors that have delivered a frame, where buses are slower
            than time steps; all unless given.
    """
    xp = namespace("history", history)
    pushed = xp.concat([history[..., 1:, :], readings_kpa[..., None, :]], axis=-2)
    return pushed if is_new is None else xp.where(is_new[..., None, None], pushed, history)
