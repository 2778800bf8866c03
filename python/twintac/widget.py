"""A notebook widget: sliders move an indenter over and into a gel, and the readings of the taxels
are drawn.

It needs ipywidgets: `pip install './python[notebook]'` in a checkout.

    from twintac import Sensor
    from twintac.widget import GelWidget

    GelWidget(Sensor.phystac())
"""

from __future__ import annotations

from collections.abc import Iterator
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from twintac import Error, Gel, GelState, Pose, PressureMap, Sensor

try:
    from ipywidgets import HTML, Dropdown, FloatSlider, HBox, VBox
except ModuleNotFoundError as _absent:
    raise ModuleNotFoundError("the widget needs ipywidgets: pip install ipywidgets", name=_absent.name) from _absent

_Point = npt.NDArray[np.float64]

TRAVEL_MM = 0.5
"""Longest motion of the indenter in one step of the solver, mm."""
STEP_S = 0.02
"""Time of one step of the solver, s."""
CLEAR_MM = 0.5
"""Clearance of the indenter above the gel at the start, mm."""


class GelWidget(VBox):  # type: ignore[misc]
    """A sensor's gel, pressed with sliders. All numbers are simulated.

    Args:
        sensor: the sensor.
        indenter: the first indenter, one of `Sensor.indenters`; the first of them unless given.
        deepest_mm: lowest position of the depth slider below first touch in the middle of the gel,
            mm, above 0.
        max_nodes: largest number of nodes of the mesh: with more nodes an answer takes longer and
            has a smaller error. A mesh that is refined at an indenter's rim has up to two thirds
            more.

    Raises:
        Error: for an indenter that the sensor does not have, for a `deepest_mm` out of range, and
            if the gel cannot be meshed.
    """

    def __init__(self, sensor: Sensor, indenter: str | None = None, *, deepest_mm: float = 2.0, max_nodes: int = 1500) -> None:
        if not 0.0 < deepest_mm < float("inf"):
            raise Error(f"`deepest_mm` is {deepest_mm}, expected a finite number above 0", field="deepest_mm")
        self.sensor = sensor
        self.deepest_mm = deepest_mm
        self._gel = Gel(sensor, {"max_path_nodes": max_nodes})
        low, high = sensor.bounds_mm
        middle = 0.5 * (low + high)

        def slider(name: str, least: float, value: float, most: float) -> Any:
            return FloatSlider(value, min=least, max=most, step=0.05, description=name, readout_format=".2f")

        names = sensor.indenters
        chosen = names[0] if indenter is None and names else indenter
        self._take_up(chosen if chosen is not None else "")
        self.indenter = Dropdown(options=names, value=chosen, description="indenter")
        self.x_mm = slider("x, mm", low[0], middle[0], high[0])
        self.y_mm = slider("y, mm", low[1], middle[1], high[1])
        self.depth_mm = slider("depth, mm", -CLEAR_MM, -CLEAR_MM, deepest_mm)
        self.shown = HTML()
        super().__init__([HBox([VBox([self.indenter, self.x_mm, self.y_mm, self.depth_mm]), self.shown])])
        self.indenter.observe(self._indenter_changed, "value")
        for one in (self.x_mm, self.y_mm, self.depth_mm):
            one.observe(self._moved, "value")
        self._moved(None)

    @property
    def state(self) -> GelState:
        """The current state of the gel."""
        return self._state

    @property
    def readings_kpa(self) -> npt.NDArray[np.float64]:
        """Pressure in the gel over each taxel's port, kPa; `[n_taxels]`."""
        return self._readings_kpa

    def _take_up(self, indenter: str) -> None:
        """Meshes the gel for an indenter that may press anywhere."""
        low, high = self.sensor.bounds_mm
        middle = Pose((0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), high[2]))
        touch_mm = self._gel.touch(indenter, middle).position_mm[2]
        places = [middle.position_mm[:2], *((x, y) for x in np.linspace(low[0], high[0], 5)[1:-1] for y in np.linspace(low[1], high[1], 4)[1:-1])]
        self._state = self._gel.state(indenter, [Pose((x, y, touch_mm - self.deepest_mm)) for x, y in places])
        self._touch_mm = touch_mm
        self._missing = ""
        self._at: _Point | None = None
        self._readings_kpa = np.zeros(len(self.sensor.taxels))

    def _indenter_changed(self, change: Any) -> None:
        try:
            self._take_up(change["new"])
        except Error as error:
            # The mesh is still that of the previous indenter, which is no longer shown.
            self._missing = str(error)
        self._moved(None)

    def _moved(self, _: Any) -> None:
        """Moves the indenter to the position of the sliders."""
        if self._missing:
            self.shown.value = f"<p><b>{escape(self._missing)}</b></p>"
            return
        fault = ""
        to = np.array([self.x_mm.value, self.y_mm.value, self._touch_mm - self.depth_mm.value])
        try:
            for place in self._way(to):
                self._readings_kpa = self._state.step(STEP_S, Pose(place))
                self._at = place
        except Error as error:
            fault = str(error)
        self._show(fault)

    def _way(self, to: _Point) -> Iterator[_Point]:
        """Positions on the straight line to `to`. The first approach comes from above."""
        start = np.array([to[0], to[1], self._touch_mm + CLEAR_MM]) if self._at is None else self._at
        steps = max(1, int(np.ceil(np.linalg.norm(to - start) / TRAVEL_MM)))
        if self._at is None:
            yield start
        for step in range(1, steps + 1):
            yield start + (to - start) * (step / steps)

    def _show(self, fault: str) -> None:
        force_n = self._state.force_n
        rows = "".join(f"<tr><td>{escape(name)}</td><td>{kpa:.2f} kPa</td></tr>" for name, kpa in zip(self.sensor.taxels, self._readings_kpa, strict=True))
        picture = PressureMap(self.sensor, self._readings_kpa, "simulated")._repr_svg_()
        told = f"<p><b>{escape(fault)}</b></p>" if fault else ""
        self.shown.value = (
            f"{told}<p><b>simulated</b>: {-force_n[2]:.3f} N down, {float(np.hypot(force_n[0], force_n[1])):.3f} N aside</p>"
            f'<div style="display: flex; gap: 1em">{picture}<table>{rows}</table></div>'
        )
