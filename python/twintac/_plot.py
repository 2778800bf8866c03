"""Plots of results with Matplotlib. The functions return the axes, so that callers can restyle
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from operator import index
from typing import TYPE_CHECKING, Any, SupportsIndex

import numpy as np
import numpy.typing as npt

from twintac._error import Error

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from twintac import Followed, Prediction, Pressed, PressureMap, Recording

READINGS = "above zero, kPa"


def pressed(result: Pressed, axes: Sequence[Axes] | None) -> list[Axes]:
    """Plots readings and force over depth."""
    readings, force = panels(axes, 2)
    lines(readings, result.depth_mm, result.readings_kpa, numbered(result.readings_kpa))
    readings.set(title=result.provenance, ylabel="pressure at ports, kPa")
    force.plot(result.depth_mm, result.force_n, color="black")
    force.set(xlabel="depth below first touch, mm", ylabel="force, N")
    return [readings, force]


def followed(result: Followed, axes: Sequence[Axes] | None) -> list[Axes]:
    """Plots readings, force and the indenter's position over time."""
    readings, force, place = panels(axes, 3)
    lines(readings, result.time_s, result.readings_kpa, numbered(result.readings_kpa))
    readings.set(title=titled(result.provenance, result.failure), ylabel="pressure at ports, kPa")
    lines(force, result.time_s, result.force_n, ["x", "y", "z"])
    force.set_ylabel("force on the gel, N")
    lines(place, result.time_s, result.position_mm, ["x", "y", "z"])
    place.set(xlabel="time, s", ylabel="indenter, mm")
    return [readings, force, place]


def prediction(result: Prediction, axes: Sequence[Axes] | None) -> list[Axes]:
    """Plots readings with their intervals, force and depth over time; times at which the prediction
    is not reliable have a grey background.
    """
    readings, force, depth = panels(axes, 3)
    drawn = lines(readings, result.time_s, result.readings_kpa, numbered(result.readings_kpa))
    half_width_kpa = result.half_width_kpa
    if half_width_kpa is not None:
        for line, centre, half in zip(drawn, result.readings_kpa.T, half_width_kpa.T, strict=True):
            readings.fill_between(result.time_s, centre - half, centre + half, alpha=0.2, color=line.get_color(), linewidth=0)
    doubtful = ~result.simulated
    if result.is_out_of_distribution is not None:
        doubtful = doubtful | result.is_out_of_distribution
    if doubtful.any():
        low, high = readings.get_ylim()
        readings.fill_between(result.time_s, low, high, where=doubtful, color="0.9", zorder=0, label="not to be trusted")
        readings.set_ylim(low, high)
        readings.legend(ncols=2, fontsize="small")
    readings.set(title=titled(result.provenance, result.failure), ylabel=f"reading {READINGS}")
    force.plot(result.time_s, result.force_n, color="black")
    force.set_ylabel("force, N")
    depth.plot(result.time_s, result.depth_mm, color="black")
    depth.set(xlabel="time, s", ylabel="depth, mm")
    return [readings, force, depth]


def recording(result: Recording, press: SupportsIndex | None, axes: Sequence[Axes] | None) -> list[Axes]:
    """Plots readings, force and height of one press over time."""
    try:
        number = 0 if press is None else index(press)
    except TypeError:
        raise Error(f"`press` is {press!r}, expected the number of a press, from 0", field="press") from None
    if not 0 <= number < len(result):
        raise Error(f"`press` is {number}: there are {len(result)} presses, counted from 0", field="press")
    columns = result.columns()
    rows = columns["press_index"] == number
    time_s = columns["time_s"][rows]
    taxels = result.taxels
    kpa = np.stack([np.where(columns[f"{name}_valid"], columns[f"{name}_kpa"], np.nan)[rows] for name in taxels], axis=1)
    readings, force, height = panels(axes, 3)
    lines(readings, time_s, kpa, taxels)
    indenter = columns["indenter"][rows][0] if rows.any() else ""
    readings.set(title=f"{result.presses[number]}, {indenter}, {result.provenance}", ylabel=f"reading {READINGS}")
    force.plot(time_s, columns["force_n"][rows], color="black")
    force.set_ylabel("force, N")
    height.plot(time_s, columns["z_mm"][rows], color="black")
    height.set(xlabel="time, s", ylabel="indenter's z, mm")
    return [readings, force, height]


def pressure_map(result: PressureMap, bounds_mm: Sequence[Sequence[float]], axes: Axes | None) -> Axes:
    """Plots the map in the plane of the gel."""
    axes = axes if axes is not None else subplots(1)[0]
    (left, bottom, _), (right, top, _) = bounds_mm
    image = axes.imshow(result.pressure_kpa, origin="lower", extent=(left, right, bottom, top), aspect="equal")
    axes.set(title=result.provenance, xlabel="x, mm", ylabel="y, mm")
    axes.figure.colorbar(image, ax=axes, label="pressure above baseline, kPa")
    return axes


def titled(provenance: str, failure: str | None) -> str:
    """The provenance of numbers, and the reason if they end early."""
    return provenance if failure is None else f"{provenance}, ends early: {failure}"


def numbered(readings: npt.NDArray[np.float64]) -> list[str]:
    """Names of taxels: their indices in a row of readings."""
    return [f"taxel {taxel}" for taxel in range(readings.shape[1])]


def lines(axes: Axes, along: npt.NDArray[np.float64], values: npt.NDArray[np.float64], labels: Sequence[str]) -> list[Any]:
    """Plots a line for each column of `values`."""
    drawn = [axes.plot(along, column, label=label)[0] for column, label in zip(values.T, labels, strict=True)]
    axes.legend(ncols=2 if len(labels) > 4 else 1, fontsize="small")
    return drawn


def panels(axes: Sequence[Axes] | None, n: int) -> Sequence[Axes]:
    """The given axes, or new ones above each other with a common abscissa. Raises `Error` for
    another number of axes.
    """
    if axes is None:
        return subplots(n)
    if not hasattr(axes, "__len__") or len(axes) != n:
        raise Error(f"`axes` has to be {n} axes, such as `matplotlib.pyplot.subplots({n})[1]`", field="axes")
    return axes


def subplots(n: int) -> list[Axes]:
    """New axes above each other with a common abscissa. Raises `ModuleNotFoundError` without
    Matplotlib.
    """
    try:
        pyplot = import_module("matplotlib.pyplot")
    except ModuleNotFoundError as absent:
        raise ModuleNotFoundError("plots need Matplotlib: pip install matplotlib", name=absent.name) from absent
    heights = [2.0, *[1.0] * (n - 1)]
    _, axes = pyplot.subplots(
        n, sharex=True, squeeze=False, layout="constrained", figsize=(7, 2.6 + 1.4 * n), height_ratios=heights
    )
    return list(axes[:, 0])
