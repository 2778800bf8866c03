"""Tests of exceptions: they say what is wrong, where, and what to do."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA, ROOT, run_command

from twintac import (
    Body,
    Coupling,
    Error,
    FastGel,
    Friction,
    Gel,
    SensorVariation,
    Inverse,
    Pose,
    Press,
    PressureMap,
    Recording,
    Run,
    Sensor,
    SensorBatch,
    Shape,
    Twin,
)


def test_a_wrong_field_has_its_file_and_line_and_the_text_of_the_command(tmp_path: Path) -> None:
    text = (ROOT / "sensors/phystac.toml").read_text(encoding="utf-8")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text.replace("port_radius_mm", "port_radius", 1), encoding="utf-8")
    with pytest.raises(Error) as caught:
        Sensor.load(wrong)
    error = caught.value
    assert error.file == str(wrong)
    assert error.line is not None and "port_radius" in wrong.read_text(encoding="utf-8").splitlines()[error.line - 1]
    assert error.field is not None and "taxels" in error.field
    assert run_command("sensor", "show", wrong).stderr == f"error: {error}\n"
    assert isinstance(error, ValueError)


def test_a_wrong_cell_has_its_column(tmp_path: Path) -> None:
    lines = (DATA / "presses.csv").read_text(encoding="utf-8").splitlines()
    cells = lines[3].split(",")
    lines[3] = ",".join([cells[0], "x", *cells[2:]])
    (tmp_path / "presses.csv").write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(Error) as caught:
        Recording.import_csv(DATA / "import.toml", tmp_path / "presses.csv")
    assert caught.value.file == str(tmp_path / "presses.csv")
    assert caught.value.line == 4
    assert caught.value.field == lines[0].split(",")[1]


MISSING = "no/such/file"


@pytest.mark.parametrize(
    "load",
    [
        lambda: Sensor.load(MISSING),
        lambda: Recording.load(MISSING),
        lambda: Recording.import_csv(MISSING),
        lambda: FastGel.load(MISSING),
        lambda: SensorVariation.load(MISSING),
        lambda: Shape.stl(MISSING),
        lambda: Run.open(MISSING),
    ],
)
def test_a_missing_file_is_named(load: Callable[[], object]) -> None:
    with pytest.raises(Error, match="No such file") as caught:
        load()
    assert caught.value.file is not None and caught.value.file.startswith(MISSING)


def test_a_folder_without_a_twin_says_so() -> None:
    with pytest.raises(Error, match=MISSING) as caught:
        Twin.load(MISSING)
    assert caught.value.file is not None and caught.value.file.startswith(MISSING)


@pytest.mark.parametrize("path", [f"{MISSING}.svg", "map.pdf"])
def test_a_picture_that_cannot_be_written_is_named_once(path: str) -> None:
    with pytest.raises(Error) as caught:
        PressureMap(Sensor.phystac(), np.zeros(8), "simulated").save(path)
    assert caught.value.file == path
    assert str(caught.value).count(path) == 1 and str(caught.value).count("No such file") <= 1


@pytest.fixture(scope="module")
def ball() -> Body:
    return Body(Shape.sphere(5.0))


def inverse(**settings: Any) -> Inverse:
    return Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}, **settings)


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        ("depth_mm", lambda: Press("sphere-25", depth_mm=-1.0)),
        ("speed_mm_per_s", lambda: Press("sphere-25", speed_mm_per_s=0.0)),
        ("hold_s", lambda: Press("sphere-25", hold_s=float("nan"))),
        ("radius_mm", lambda: Shape.sphere(0.0)),
        ("edge_radius_mm", lambda: Shape.box([1.0, 1.0, 1.0], 0.5)),
        ("quaternion", lambda: Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 2.0))),
        ("position_mm", lambda: Pose((0.0, 0.0, float("inf")))),
        ("position_mm", lambda: Pose([0.0, 0.0])),
        ("quaternion", lambda: Pose(np.zeros(3), np.zeros(3))),
        ("at_mm", lambda: Press("sphere-25", at_mm=(0.0, 0.0, 0.0))),
        ("size_mm", lambda: Shape.box([1.0, 1.0], 0.1)),
        ("hysteresis", lambda: SensorVariation(hysteresis=2.0)),
        ("gain_deviation", lambda: SensorVariation(gain_deviation=float("nan"))),
        ("gain", lambda: SensorVariation(gain=2.0)),
        ("friction", lambda: Coupling(Sensor.phystac(), friction=-1.0)),
        ("coefficient", lambda: Friction(Sensor.phystac(), -1.0)),
        ("edges_per_height", lambda: Gel(Sensor.phystac(), {"edges_per_height": -1.0})),
        ("edges_per_height", lambda: Gel(Sensor.phystac(), {"edges_per_height": float("nan")})),
        ("edges", lambda: Gel(Sensor.phystac(), {"edges": 1.0})),
        ("noise_kpa", lambda: inverse(noise_kpa=-1.0)),
        ("noise_kpa", lambda: inverse(noise_kpa=np.float32("nan"))),
        ("model_part", lambda: inverse(model_part=-0.1)),
        ("place_walk_mm", lambda: inverse(place_walk_mm=float("inf"))),
        ("n_starts", lambda: inverse(n_starts=-1)),
        ("nose_kpa", lambda: inverse(nose_kpa=1.0)),
        ("spacing_mm", lambda: inverse().floor_map(1e-4)),
        ("provenance", lambda: PressureMap(Sensor.phystac(), np.zeros(8), "unreal")),  # type: ignore[arg-type]
        ("bodies", lambda: FastGel.phystac().batch([])),
    ],
)
def test_a_wrong_argument_is_named(field: str, wrong: Callable[[], object]) -> None:
    with pytest.raises(Error) as caught:
        wrong()
    assert caught.value.field == field
    assert caught.value.file is None and caught.value.line is None
    assert field in str(caught.value) and " line " not in str(caught.value)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("gel_from_body", {"gel_from_body": np.zeros((2, 4))}),
        ("position_mm", {"gel_from_body": np.full((1, 3), np.nan)}),
        ("quaternion", {"gel_from_body": np.zeros((1, 7))}),
        ("body", {"gel_from_body": np.zeros((2, 3)), "body": [0]}),
        ("body", {"gel_from_body": np.zeros((1, 3)), "body": [1]}),
        ("body", {"gel_from_body": np.zeros((1, 3)), "body": [-1]}),
        ("body", {"gel_from_body": np.zeros((1, 3)), "body": [0.7]}),
        ("ends", {"gel_from_body": np.zeros((1, 3)), "ends": np.array([1.0])}),
        ("ends", {"gel_from_body": np.zeros((2, 3)), "ends": [2, 1]}),
        ("ends", {"gel_from_body": np.zeros((2, 3)), "ends": [1]}),
    ],
)
def test_wrong_touches_are_named(field: str, arguments: dict[str, object], ball: Body) -> None:
    batch = FastGel.phystac().batch([ball])
    with pytest.raises(Error) as caught:
        batch.read(**arguments)  # type: ignore[arg-type]
    assert caught.value.field == field


def test_sensors_refuse_what_cannot_be(ball: Body) -> None:
    sensors = SensorBatch(FastGel.phystac(), [ball], 2)
    with pytest.raises(Error, match="2 sensors"):
        sensors.step(0.01, np.zeros((3, 3)))
    with pytest.raises(Error, match="since_previous_s"):
        sensors.step(-0.01, np.zeros((2, 3)))
    for on_a_sensor in (sensors.rest, sensors.state):
        with pytest.raises(Error, match="`sensor` is 2, expected an integer from 0 to 1"):
            on_a_sensor(2)
    with pytest.raises(Error, match="at least one"):
        sensors.set_bodies([])


def test_things_that_a_gel_holds_are_told_apart(ball: Body) -> None:
    gel, coupling = FastGel.phystac(), Coupling(Sensor.phystac(), friction=0.8)
    sensors, places = SensorBatch(gel, [ball], 1, coupling=coupling), np.array([[-8.0, 0.0, 8.0], [8.0, 0.0, 8.0]])
    for touch_id, match in ((None, "`touch_id` is missing"), ([1, 1], "touched twice by the body 1"), ([1], "has 1 numbers"), ([0.5, 1.0], "integers")):
        with pytest.raises(Error, match=match) as caught:
            sensors.step(0.01, places, [0, 0], [2], touch_id=touch_id)
        assert caught.value.field == "touch_id"
    with pytest.raises(Error, match="phystac-tip"):
        SensorBatch(gel, [ball], 1, coupling=Coupling(Sensor.phystac_tip(), friction=0.8))
    with pytest.raises(Error, match="gel_from_body|position_mm"):
        sensors.step(0.01, places * np.nan, [0, 0], [2], touch_id=[1, 2])
    with pytest.raises(Error, match="8 taxels without a twin, expected `phystac`, 1 taxels"):
        SensorBatch(gel.with_ports([[0.0, 0.0]]), [ball], 1).set_state(0, sensors.state(0))
    of_tip = SensorBatch(FastGel.phystac_tip(), [ball], 1).state(0)
    with pytest.raises(Error, match="is of `phystac-tip`, 8 taxels without a twin, expected `phystac`"):
        SensorBatch(gel, [ball], 1).set_state(0, of_tip)


def test_an_indenter_that_the_sensor_does_not_have_is_named() -> None:
    with pytest.raises(Error, match="there is no indenter `spoon`; the sensor has"):
        Gel(Sensor.phystac()).press(Press("spoon"))
    with pytest.raises(Error) as caught:
        Gel(Sensor.phystac()).touch("spoon", Pose((0.0, 0.0, 0.0)))
    assert caught.value.field == "indenter"


def test_readings_of_another_sensor_are_refused() -> None:
    with pytest.raises(Error, match="8 taxels"):
        PressureMap(Sensor.phystac(), [1.0, 2.0], "real")
    tracker = Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}).start("real")
    with pytest.raises(Error, match="readings_kpa"):
        tracker.update(0.01, [1.0])
