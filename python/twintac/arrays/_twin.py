"""A trained twin as arrays: from port pressures to what the barometers read, with the relaxation of
the gel as a state.

A barometer reads `r + Σ c q`: `r` is the static nonlinearity of the port on gain × port pressure,
and the overstresses `q` follow each change of `r` and fade (a generalized Maxwell solid, Simo and
Hughes, Computational Inelasticity, section 10.3). This is what Rust's `TwinState` computes.
"""

import json
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import Error
from ._convert import convert
from ._file import read_tensors
from ._gel import Layer
from ._namespace import Array, for_rows, namespace, refuse

# Added to the sum of squares of a sensor's readings, in units of the largest reading.
_ROUNDING = 1e-8
# Most steps of time have exponents beyond these.
_SHORTEST = 1e-4


class Twin(NamedTuple):
    """A trained twin, as arrays: what `twin` returns."""

    gain: Array
    """Reading over port pressure for small pressures, `[n_taxels]`."""
    growth_per_kpa: Array
    """Relative growth of a reading with its size, 1/kPa, `[n_taxels]`."""
    share: Array
    """Share of each overstress in the reading, `[n_time_constants, n_taxels]`."""
    time_constant_s: Array
    """`[n_time_constants, 1]`"""
    unit_kpa: Array
    """Port pressures that are inputs of 1 to the perceptron, kPa, `[n_taxels]`."""
    reading_kpa: Array
    """The largest reading, kPa, `[]`."""
    correction_limit: Array
    """Largest correction as a fraction of the size of all readings of a sensor, `[]`."""
    layers: tuple[Layer, ...]
    """The perceptron; empty in variants without one."""


class Relaxed(NamedTuple):
    """The state of viscoelastic relaxation of the gels: the result of `rested` and `read_twin`."""

    is_rested: Array
    """Whether the gel has rested, so that the next frame ignores the time before it, `[...]`."""
    relaxed_kpa: Array
    """Readings without overstress at the last moment, kPa, `[..., n_taxels]`."""
    overstress_kpa: Array
    """`[..., n_time_constants, n_taxels]`"""


def twin(folder: str | os.PathLike[str], *, like: Array | None = None) -> Twin:
    """A twin from the folder of its model, such as `runs/demo/model`. Arrays are of NumPy in single
    precision, or of the library, the precision and the device of the array `like`.

    Raises `Error` with the file if it cannot be read, and for a twin of the variant `paper`, which
    reads stress, not pressures.
    """
    record_file = Path(folder) / "twin.json"
    try:
        record = json.loads(record_file.read_text(encoding="utf-8"))
        variant = str(record["variant"])
        if variant == "paper":
            raise refuse("folder", "has a twin of the variant paper", "one that reads pressures")
        gains, start = record["gains"], record["start"]
        n_taxels = len(gains["gain"])
        share = np.array(gains["memory"], np.float64).reshape(n_taxels, -1).T
        found = Twin(
            gain=np.array(gains["gain"], np.float64),
            growth_per_kpa=np.array(gains["stiffening_per_kpa"], np.float64),
            share=share,
            time_constant_s=np.array(gains["time_constants_s"], np.float64).reshape(-1, 1),
            unit_kpa=np.array(start["normalization"]["pressure_rms_kpa"], np.float64),
            reading_kpa=np.array(float(start["normalization"]["reading_kpa"])),
            correction_limit=np.array(float(start["correction_limit"])),
            layers=_layers(Path(folder) / "weights.safetensors"),
        )
    except (OSError, ValueError, KeyError, TypeError) as error:
        if isinstance(error, Error):
            raise
        file = os.fspath(record_file)
        raise Error(f"reading {file}: {error!r}", file=file) from error
    return convert(found, np.zeros(0, np.float32) if like is None else like)


def rested(twin: Twin, pressure_kpa: Array) -> Relaxed:
    """Gels that have rested, of as many sensors as there are pressures `[..., n_taxels]`."""
    xp = namespace("twin", twin.gain)
    zero = xp.astype(0.0 * pressure_kpa, twin.gain.dtype)
    overstress = zero[..., None, :] + xp.zeros_like(twin.time_constant_s)
    return Relaxed(zero[..., 0] == 0.0, zero, overstress)


def read_twin(
    twin: Twin, before: Relaxed, since_previous_s: Array | float, pressure_kpa: Array
) -> tuple[Relaxed, Array]:
    """One more moment: from port pressures to the readings of the barometers, kPa.

    - `before`: the state after the previous frame; at first the result of `rested`.
    - `since_previous_s`: time since the previous frame, s, one for all or `[...]`. Gels that have
      rested ignore it.
    - `pressure_kpa`: what `read` or `step` returns, kPa, `[..., n_taxels]`.

    Returns the new state, and readings above those of an untouched sensor, kPa, `[..., n_taxels]`.
    """
    xp = namespace("twin", twin.gain)
    if tuple(pressure_kpa.shape)[-1:] != tuple(twin.gain.shape):
        expected = f"[..., {twin.gain.shape[0]}], the taxels of the twin"
        raise refuse("pressure_kpa", f"has the shape {list(pressure_kpa.shape)}", expected)
    now_kpa = _static(xp, twin, xp.astype(pressure_kpa, twin.gain.dtype, copy=False))
    changed_kpa = xp.where(before.is_rested[..., None], 0.0, now_kpa - before.relaxed_kpa)
    since_s = for_rows(since_previous_s)
    kept, arrived = _faded(xp, since_s / twin.time_constant_s)
    overstress_kpa = kept * before.overstress_kpa + arrived * changed_kpa[..., None, :]
    readings_kpa = now_kpa + xp.sum(twin.share * overstress_kpa, axis=-2)
    return Relaxed(before.is_rested & False, now_kpa, overstress_kpa), readings_kpa


def _static(xp: Any, twin: Twin, pressure_kpa: Array) -> Array:
    """Readings of a gel without relaxation, above those of an untouched sensor, kPa."""
    untouched = xp.zeros_like(twin.gain)
    zero_kpa = _elastic(xp, twin, untouched) if twin.layers else untouched
    return _port(xp, twin, _elastic(xp, twin, pressure_kpa)) - _port(xp, twin, zero_kpa)


def _elastic(xp: Any, twin: Twin, pressure_kpa: Array) -> Array:
    """Gain × pressure, and the perceptron's correction of it."""
    elastic_kpa = twin.gain * pressure_kpa
    if not twin.layers:
        return elastic_kpa
    size = xp.sum((elastic_kpa / twin.reading_kpa) ** 2, axis=-1)
    hidden = pressure_kpa / twin.unit_kpa
    for number, (weight, bias) in enumerate(twin.layers):
        hidden = xp.matmul(hidden, weight) + bias
        if number + 1 < len(twin.layers):
            hidden = 0.5 * hidden * (1.0 + _erf(xp, hidden * 2.0**-0.5))
    limit_kpa = twin.correction_limit * twin.reading_kpa * xp.sqrt(size + _ROUNDING)
    return elastic_kpa + limit_kpa[..., None] * xp.tanh(hidden)


def _port(xp: Any, twin: Twin, elastic_kpa: Array) -> Array:
    """The static nonlinearity of each port; tension is read in proportion."""
    pushes = xp.where(elastic_kpa > 0.0, elastic_kpa, 0.0)
    grown = twin.growth_per_kpa * pushes
    steeper = pushes * (1.0 + grown)
    flatter = pushes / (1.0 - xp.where(grown < 0.0, grown, 0.0))
    pushed = xp.where(twin.growth_per_kpa >= 0.0, steeper, flatter)
    return xp.where(elastic_kpa > 0.0, pushed, elastic_kpa)


def _faded(xp: Any, ratio: Array) -> tuple[Array, Array]:
    """What is left of an overstress after a time, over its time constant, and what of a linear
    change becomes one: exact."""
    kept = xp.exp(-ratio)
    is_long = ratio > _SHORTEST
    arrived = -xp.expm1(-ratio) / xp.where(is_long, ratio, 1.0)
    return kept, xp.where(is_long, arrived, 1.0 - 0.5 * ratio)


def _erf(xp: Any, value: Array) -> Array:
    """The error function within 1.5e-7 (Abramowitz and Stegun, 1964, formula 7.1.26): the array API
    has none."""
    size = xp.abs(value)
    t = 1.0 / (1.0 + 0.3275911 * size)
    powers = 0.254829592 + t * (
        -0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))
    )
    return xp.sign(value) * (1.0 - t * powers * xp.exp(-size * size))


def _layers(file: Path) -> tuple[Layer, ...]:
    tensors = read_tensors(file.read_bytes())
    found: list[Layer] = []
    while (key := f"layer{len(found)}") + ".weight" in tensors:
        found.append(Layer(tensors[f"{key}.weight"], tensors[f"{key}.bias"]))
    return tuple(found)
