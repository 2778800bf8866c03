"""Tests that the notebook widget presses the gel according to its sliders."""

import sys

import pytest

pytest.importorskip("ipywidgets")

from twintac import Error, Gel, Pose, Press, Sensor  # noqa: E402
from twintac.widget import GelWidget  # noqa: E402


def test_sliders_press_the_gel() -> None:
    widget = GelWidget(Sensor.phystac(), "sphere-25", max_nodes=600)
    assert widget.readings_kpa.max() == 0.0
    assert "<svg" in widget.shown.value and "simulated" in widget.shown.value
    widget.depth_mm.value = 1.0
    force_n = -widget.state.force_n[2]
    assert 0.2 < force_n < 1.0
    assert f"{force_n:.3f} N down" in widget.shown.value
    widget.x_mm.value = -12.0
    widget.y_mm.value = -4.0
    assert widget.readings_kpa.argmax() == Sensor.phystac().taxels.index("t0")
    assert widget.state.gel_from_indenter is not None
    assert widget.state.gel_from_indenter.position_mm[:2] == pytest.approx((-12.0, -4.0))
    widget.depth_mm.value = -0.5
    assert abs(widget.state.force_n[2]) < 1e-6


def test_another_indenter_presses_where_the_first_was() -> None:
    widget = GelWidget(Sensor.phystac(), max_nodes=600)
    widget.depth_mm.value = 0.8
    first = widget.state.force_n[2]
    widget.indenter.value = "cube"
    assert widget.state.force_n[2] < 1.2 * first  # a cube touches with a larger area than a ball
    state = widget.state
    assert state.gel_from_indenter == Pose(state.gel_from_indenter.position_mm) if state.gel_from_indenter else False


def test_an_indenter_that_cannot_press_shows_no_numbers() -> None:
    widget = GelWidget(Sensor.phystac(), "sphere-25", max_nodes=600)
    widget.depth_mm.value = 0.8
    widget.indenter.options = [*widget.indenter.options, "nosuch"]
    widget.indenter.value = "nosuch"
    for depth_mm in (0.5, 1.0):
        widget.depth_mm.value = depth_mm
        assert "nosuch" in widget.shown.value and " N " not in widget.shown.value
    widget.indenter.value = "sphere-25"
    assert "simulated" in widget.shown.value and widget.state.force_n[2] < -0.2


def test_what_cannot_be_is_said() -> None:
    with pytest.raises(Error, match="nosuch"):
        GelWidget(Sensor.phystac(), "nosuch")
    for depth_mm in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(Error, match="deepest_mm"):
            GelWidget(Sensor.phystac(), deepest_mm=depth_mm)


def test_a_gel_shows_itself_in_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    display = pytest.importorskip("IPython.display")
    shown: list[object] = []
    monkeypatch.setattr(display, "display", shown.append)
    sensor = Sensor.phystac()
    Gel(sensor)._ipython_display_()
    assert isinstance(shown[0], GelWidget)
    monkeypatch.setitem(sys.modules, "twintac.widget", None)
    Gel(sensor)._ipython_display_()
    assert isinstance(shown[1], Sensor)
    assert "<svg" in sensor._repr_svg_() and "34" in sensor._repr_svg_()


def test_a_press_shows_itself_in_a_notebook() -> None:
    pressed = Gel(Sensor.phystac(), {"max_nodes": 800}).press(Press("sphere-25", depth_mm=0.5))
    picture = pressed._repr_svg_()
    for part in ("<svg", "simulated", "taxel 7", "depth below first touch, mm", "force, N"):
        assert part in picture, part
