"""Tests that plots show the numbers of the results, and that wrong arguments raise errors."""

import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from conftest import DATA
from matplotlib.axes import Axes

matplotlib.use("agg")

from matplotlib import pyplot  # noqa: E402

from twintac import Error, Gel, Press, PressPath, PressureMap, Recording, Run, Sensor, Twin  # noqa: E402

COARSE = {"edges_per_height": 4.0, "edges_per_contact_radius": 4.0}


def check(axes: "list[Axes]", along: "np.ndarray[tuple[int, ...], np.dtype[np.float64]]") -> None:
    """Checks that all axes have the same abscissa, and units in their labels."""
    for one in axes:
        assert one.get_ylabel().endswith((" mm", " N", " kPa"))
        for line in one.get_lines():
            np.testing.assert_array_equal(line.get_xdata(), along)
    assert axes[-1].get_xlabel().endswith((" s", " mm"))
    pyplot.close("all")


def test_a_press() -> None:
    pressed = Gel(Sensor.phystac(), COARSE).press(Press("sphere-25", depth_mm=1.0))
    axes = pressed.plot()
    assert axes[0].get_title() == "simulated"
    for line, reading in zip(axes[0].get_lines(), pressed.readings_kpa.T, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), reading)
    np.testing.assert_array_equal(axes[1].get_lines()[0].get_ydata(), pressed.force_n)
    check(axes, pressed.depth_mm)
    given = pyplot.subplots(2)[1]
    assert pressed.plot(given)[1] is given[1]
    with pytest.raises(Error, match="has to be 2 axes") as wrong:
        pressed.plot(list(pyplot.subplots(3)[1]))
    assert wrong.value.field == "axes"
    with pytest.raises(Error, match="has to be 2 axes"):
        pressed.plot(given[0])
    pyplot.close("all")


def test_a_path() -> None:
    path = PressPath("sphere-25", [0, 1], [[0.0, 0.0, 0.0], [1.0, 0.0, -0.5]], zero="touch", rate_hz=10)
    followed = Gel(Sensor.phystac(), COARSE).follow(path)
    axes = followed.plot()
    np.testing.assert_array_equal(axes[1].get_lines()[2].get_ydata(), followed.force_n[:, 2])
    check(axes, followed.time_s)


def test_a_prediction(trained: Path) -> None:
    run = Run.open(trained)
    prediction = Twin.load(run.model_folder).predict(Press("sphere-25", depth_mm=1.0))
    axes = prediction.plot()
    assert len(axes[0].collections) >= prediction.readings_kpa.shape[1], "an interval for each taxel"
    check(axes, prediction.time_s)


def test_a_recording() -> None:
    recording = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")
    for press in (0, np.int64(1)):
        axes = recording.plot(press)
        columns = recording.columns()
        rows = columns["press_index"] == press
        np.testing.assert_array_equal(axes[1].get_lines()[0].get_ydata(), columns["force_n"][rows])
        assert [line.get_label() for line in axes[0].get_lines()] == recording.taxels
        assert recording.presses[int(press)] in axes[0].get_title()
        check(axes, columns["time_s"][rows])
    for wrong in (-1, len(recording), 2**70, 0.5, "first"):
        with pytest.raises(Error, match="press") as refused:
            recording.plot(wrong)  # type: ignore[arg-type]
        assert refused.value.field == "press"


def test_a_map() -> None:
    sensor = Sensor.phystac()
    map_ = PressureMap(sensor, [0, 0, 5, np.nan, 0, 0, 0, 0], "simulated")
    axes = map_.plot()
    image = axes.get_images()[0]
    np.testing.assert_array_equal(image.get_array(), map_.pressure_kpa)
    low, high = sensor.bounds_mm
    assert axes.get_xlim() == (low[0], high[0]) and axes.get_ylim() == (low[1], high[1])
    given = pyplot.subplots()[1]
    assert map_.plot(given) is given
    pyplot.close("all")


def test_without_matplotlib(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.startswith("matplotlib")]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(ModuleNotFoundError, match="pip install matplotlib"):
        PressureMap(Sensor.phystac(), np.zeros(8), "simulated").plot()
