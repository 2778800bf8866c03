"""Sensor variation as arrays: sensors that differ from a perfect one, each in its own way, and what
they deliver. This is what Rust's `SensorBatch` does with a `SensorVariation`; the random numbers are
others, drawn from keys (`keys`).
"""

from typing import Any, NamedTuple

import numpy as np

from .. import SensorVariation
from ._convert import convert
from ._namespace import Array, namespace, refuse, root
from ._random import normal, uniform

# Shortest time between two frames, as a fraction of the usual one.
_SHORTEST_FRAME = 0.1
# Rounding of times costs no frame, s.
_TIME_S = 1e-6
# Which random numbers are drawn for what: a normal number takes two. Those of taxels are further
# apart than any sensor has taxels, those of pairs beyond them.
_MOUNT, _TEMPERATURE, _JITTER, _MODULUS, _FATE, _GAIN, _OFFSET, _DRIFT, _GROWTH, _NOISE, _COUPLING = (
    0, 16, 32, 48, 1 << 12, 2 << 12, 3 << 12, 4 << 12, 5 << 12, 6 << 12, 7 << 12,
)  # fmt: skip
_MOST_TAXELS = 1 << 11
# When a sensor is drawn; moments count from 0.
_AT_BIRTH = -1


class Spread(NamedTuple):
    """The distributions that sensors are drawn from, as arrays: the fields of `SensorVariation`, `[]`."""

    gain_deviation: Array
    growth_deviation_per_kpa: Array
    offset_deviation_kpa: Array
    drift_kpa_per_k: Array
    drift_deviation_kpa_per_k: Array
    temperature_deviation_k: Array
    temperature_time_s: Array
    cross_talk: Array
    cross_talk_deviation: Array
    noise_deviation_kpa: Array
    quantum_kpa: Array
    hysteresis: Array
    dead_chance: Array
    stuck_chance: Array
    late_chance: Array
    rate_hz: Array
    jitter: Array
    modulus_deviation: Array
    height_deviation_mm: Array
    place_deviation_mm: Array
    turn_deviation_rad: Array
    tilt_deviation_rad: Array


class Drawn(NamedTuple):
    """Sensors as they were drawn: what does not change until they are drawn anew."""

    key: Array
    """`[...]`"""
    gain: Array
    """`[..., n_taxels]`, as all of taxels."""
    growth_per_kpa: Array
    offset_kpa: Array
    drift_kpa_per_k: Array
    is_dead: Array
    is_stuck: Array
    is_late: Array
    coupling: Array
    """Fraction of taxel j's pressure that taxel i reads in addition (cross-talk), `[..., i, j]`."""
    modulus: Array
    """The modulus of the gel over that of the surrogate's gel, `[...]`."""
    offset_mm: Array
    """Origin of the frame of the sensor as described, in the frame as installed, mm, `[..., 3]`."""
    rotation: Array
    """Rotation from the frame of the sensor as described to that as installed, `[..., 3, 3]`."""


class Bus(NamedTuple):
    """What the sensors keep from frame to frame: the result of `connected` and `deliver`."""

    moment: Array
    """Number of frames before, `[...]`."""
    temperature_k: Array
    """Of each sensor, above that of its tare."""
    until_frame_s: Array
    """Time until the bus delivers the next frame."""
    since_frame_s: Array
    behind_kpa: Array
    """What hysteresis lets through, kPa, `[..., n_taxels]`."""
    before_kpa: Array
    """What should have been read at the last frame."""
    delivered_kpa: Array
    """What the bus delivered last."""
    has_delivered: Array
    """`[..., n_taxels]`: a stuck taxel keeps its first reading for good."""


def spread(variation: SensorVariation, *, like: Array | None = None) -> Spread:
    """The sensor variation as arrays: of NumPy, or as the array `like`."""
    fields = {name: np.array(value) for name, value in variation.fields().items()}
    return convert(Spread(**fields), np.zeros(0, np.float32) if like is None else like)


def draw(spread: Spread, key: Array, n_taxels: int) -> Drawn:
    """Draws a sensor for each key `[...]`: the same key, the same sensor.

    Raises `Error` for numbers of taxels that are not from 1 to 2,048.
    """
    xp = namespace("spread", spread.gain_deviation)
    if not 1 <= n_taxels <= _MOST_TAXELS:
        raise refuse("n_taxels", f"is {n_taxels}", f"1 to {_MOST_TAXELS}")
    like = spread.gain_deviation

    def alone(number: int) -> Array:
        return _alone(xp, like, key, number, _AT_BIRTH)

    def of_taxels(first: int, n: int = n_taxels) -> Array:
        return normal(xp, key[..., None], _numbers(xp, first, n, like), _AT_BIRTH, like)

    chance = uniform(xp, key[..., None], _numbers(xp, _FATE, n_taxels, like), _AT_BIRTH, like)
    dead, stuck, late = spread.dead_chance, spread.stuck_chance, spread.late_chance
    part = spread.cross_talk + spread.cross_talk_deviation * of_taxels(_COUPLING, n_taxels**2)
    coupling = xp.reshape(part, (*part.shape[:-1], n_taxels, n_taxels))
    row = xp.arange(n_taxels, device=getattr(like, "device", None))
    offset_mm = [
        spread.place_deviation_mm * alone(_MOUNT),
        spread.place_deviation_mm * alone(_MOUNT + 2),
        spread.height_deviation_mm * alone(_MOUNT + 4),
    ]
    axis_rad = [
        spread.tilt_deviation_rad * alone(_MOUNT + 6),
        spread.tilt_deviation_rad * alone(_MOUNT + 8),
        spread.turn_deviation_rad * alone(_MOUNT + 10),
    ]
    return Drawn(
        key=key,
        gain=1.0 + spread.gain_deviation * of_taxels(_GAIN),
        growth_per_kpa=spread.growth_deviation_per_kpa * of_taxels(_GROWTH),
        offset_kpa=spread.offset_deviation_kpa * of_taxels(_OFFSET),
        drift_kpa_per_k=spread.drift_kpa_per_k
        + spread.drift_deviation_kpa_per_k * of_taxels(_DRIFT),
        is_dead=chance < dead,
        is_stuck=(chance >= dead) & (chance < dead + stuck),
        is_late=(chance >= dead + stuck) & (chance < dead + stuck + late),
        coupling=xp.where(row[:, None] == row[None, :], 0.0, coupling),
        modulus=xp.exp(spread.modulus_deviation * alone(_MODULUS)),
        offset_mm=xp.stack(offset_mm, axis=-1),
        rotation=_rotation(xp, axis_rad),
    )


def installed(drawn: Drawn, position_mm: Array, rotation: Array) -> tuple[Array, Array]:
    """Poses of bodies in the frames of the sensors as installed, from poses in the frames as
    described: arguments of `read` and `step`.

    - `position_mm`: `[..., n_bodies, 3]`, mm.
    - `rotation`: `[..., n_bodies, 3, 3]`.
    """
    turn = drawn.rotation[..., None, :, :]
    position_mm = drawn.offset_mm[..., None, :] + _turned(turn, position_mm)
    columns = [_turned(turn, rotation[..., :, axis]) for axis in range(3)]
    return position_mm, namespace("drawn", drawn.gain).stack(columns, axis=-1)


def stiffened(drawn: Drawn, values: Array) -> Array:
    """Pressures or wrenches of the gels as they are, from those that `read` and `step` return: at
    given poses, both are proportional to the modulus. `values` has the dimensions of the sensors
    first, `[..., n_taxels]` or `[..., n_bodies, 6]`."""
    xp = namespace("drawn", drawn.gain)
    more = (1,) * (values.ndim - drawn.modulus.ndim)
    return values * xp.reshape(drawn.modulus, (*drawn.modulus.shape, *more))


def as_described(drawn: Drawn, wrench: Array) -> Array:
    """Wrenches `[..., n_bodies, 6]` along the axes of the sensors as described, from those along
    the axes as installed, which `step` returns for `installed` poses."""
    xp = namespace("drawn", drawn.gain)
    back = xp.matrix_transpose(drawn.rotation)[..., None, :, :]
    return xp.concat([_turned(back, wrench[..., :3]), _turned(back, wrench[..., 3:])], axis=-1)


def connected(spread: Spread, drawn: Drawn) -> Bus:
    """Sensors that have just been switched on, and read nothing yet."""
    xp = namespace("drawn", drawn.gain)
    zeros = xp.zeros_like(drawn.gain)
    alone = zeros[..., 0]
    like = spread.gain_deviation
    warm_k = spread.temperature_deviation_k * _alone(xp, like, drawn.key, _TEMPERATURE, _AT_BIRTH)
    moment = xp.zeros_like(drawn.key)
    return Bus(moment, alone + warm_k, alone, alone, zeros, zeros, zeros, zeros > 1.0)


def deliver(
    spread: Spread, drawn: Drawn, before: Bus, since_previous_s: Array | float, true_kpa: Array
) -> tuple[Bus, Array]:
    """One more moment: from what taxels should read to what the bus delivers.

    - `before`: the state after the previous frame; at first the result of `connected`.
    - `since_previous_s`: time since the previous frame, s, one for all or `[...]`.
    - `true_kpa`: what perfect sensors read, kPa, `[..., n_taxels]`: the pressures of `read` and
      `step`, or the readings of `read_twin`.

    Returns the new state, and the delivered readings, kPa, `[..., n_taxels]`. Between two frames of
    the bus, readings stay the same.
    """
    xp = namespace("drawn", drawn.gain)
    is_first = ~before.has_delivered[..., 0]
    until_s = xp.where(is_first, 0.0, before.until_frame_s - since_previous_s)
    since_s = xp.where(is_first, 0.0, before.since_frame_s + since_previous_s)
    is_frame = (spread.rate_hz == 0.0) | (until_s <= _TIME_S)
    temperature_k = _warmed(xp, spread, drawn, before, since_s)
    wait_s = _wait_s(xp, spread, drawn, before, until_s)
    half_kpa = spread.hysteresis * xp.abs(true_kpa)
    behind_kpa = xp.maximum(before.behind_kpa, true_kpa - half_kpa)
    behind_kpa = xp.minimum(behind_kpa, true_kpa + half_kpa)
    through_kpa = behind_kpa + xp.sum(drawn.coupling * behind_kpa[..., None, :], axis=-1)
    reading_kpa = _reading(xp, spread, drawn, before, temperature_k, through_kpa)
    delivered_kpa = xp.where(drawn.is_late, before.before_kpa, reading_kpa)
    is_kept = drawn.is_stuck & before.has_delivered
    delivered_kpa = xp.where(is_kept, before.delivered_kpa, delivered_kpa)
    delivered_kpa = xp.where(drawn.is_dead, 0.0, delivered_kpa)
    taxel_frame = is_frame[..., None]
    now = Bus(
        moment=before.moment + 1,
        temperature_k=xp.where(is_frame, temperature_k, before.temperature_k),
        until_frame_s=xp.where(is_frame, wait_s, until_s),
        since_frame_s=xp.where(is_frame, 0.0, since_s),
        behind_kpa=behind_kpa,
        before_kpa=xp.where(taxel_frame, reading_kpa, before.before_kpa),
        delivered_kpa=xp.where(taxel_frame, delivered_kpa, before.delivered_kpa),
        has_delivered=before.has_delivered | taxel_frame,
    )
    return now, now.delivered_kpa


def _warmed(xp: Any, spread: Spread, drawn: Drawn, before: Bus, since_s: Array) -> Array:
    """The temperature, an Ornstein-Uhlenbeck process, exact for any time."""
    time_s = xp.where(spread.temperature_time_s > 0.0, spread.temperature_time_s, 1.0)
    kept = xp.exp(-since_s / time_s)
    new_k = spread.temperature_deviation_k * root(xp, 1.0 - kept * kept)
    warmer_k = _alone(xp, spread.gain_deviation, drawn.key, _TEMPERATURE, before.moment)
    return kept * before.temperature_k + new_k * warmer_k


def _wait_s(xp: Any, spread: Spread, drawn: Drawn, before: Bus, until_s: Array) -> Array:
    """Time until the frame after this one. A late frame does not make the next one late; frames
    that were missed are gone."""
    rate_hz = xp.where(spread.rate_hz > 0.0, spread.rate_hz, 1.0)
    late = _alone(xp, spread.gain_deviation, drawn.key, _JITTER, before.moment)
    late_s = xp.maximum(until_s, -1.0 / rate_hz)
    return late_s + xp.clip(1.0 + spread.jitter * late, _SHORTEST_FRAME, None) / rate_hz


def _reading(
    xp: Any, spread: Spread, drawn: Drawn, before: Bus, temperature_k: Array, through_kpa: Array
) -> Array:
    growth = xp.clip(1.0 + drawn.growth_per_kpa * xp.abs(through_kpa), 0.0, None)
    like = spread.gain_deviation
    numbers = _numbers(xp, _NOISE, through_kpa.shape[-1], like)
    noise = normal(xp, drawn.key[..., None], numbers, before.moment[..., None], like)
    reading_kpa = (
        drawn.gain * growth * through_kpa
        + drawn.offset_kpa
        + drawn.drift_kpa_per_k * temperature_k[..., None]
        + spread.noise_deviation_kpa * noise
    )
    is_stepped = spread.quantum_kpa > 0.0
    step_kpa = xp.where(is_stepped, spread.quantum_kpa, 1.0)
    return xp.where(is_stepped, step_kpa * xp.round(reading_kpa / step_kpa), reading_kpa)


def _alone(xp: Any, like: Array, key: Array, number: int, moment: Array | int) -> Array:
    """A normal number for each sensor, `[...]`."""
    moment = moment if isinstance(moment, int) else moment[..., None]
    return normal(xp, key[..., None], number, moment, like)[..., 0]


def _numbers(xp: Any, first: int, n: int, like: Array) -> Array:
    """Of so many normal numbers, `[n]`."""
    device = getattr(like, "device", None)
    return first + 2 * xp.arange(n, dtype=xp.int32, device=device)


def _turned(turn: Array, vector: Array) -> Array:
    """Vectors `[..., 3]` by matrices `[..., 3, 3]`, without a matrix product, which devices round."""
    turned: Array = sum(turn[..., :, axis] * vector[..., axis, None] for axis in range(3))
    return turned


def _rotation(xp: Any, axis_rad: list[Array]) -> Array:
    """The matrix of a rotation vector (Rodrigues), `[..., 3, 3]`."""
    x, y, z = axis_rad
    square = x * x + y * y + z * z
    angle = root(xp, square)
    is_turned = square > 1e-12
    sine = xp.where(is_turned, xp.sin(angle) / xp.where(is_turned, angle, 1.0), 1.0)
    versine = xp.where(is_turned, (1.0 - xp.cos(angle)) / xp.where(is_turned, square, 1.0), 0.5)
    zero = xp.zeros_like(x)
    across = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    axis = [x, y, z]
    rows = []
    for i in range(3):
        for j in range(3):
            twice = axis[i] * axis[j] - (square if i == j else zero)
            rows.append((1.0 if i == j else 0.0) + sine * across[i][j] + versine * twice)
    return xp.reshape(xp.stack(rows, axis=-1), (*x.shape, 3, 3))
