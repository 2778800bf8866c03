"""What is wrong is an exception that says what, where, and what to do."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import DATA, ROOT, run_command

from twintac import (
    Body,
    Error,
    FastGel,
    Gel,
    Imperfection,
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
    text = (ROOT / "sensors/phystac.toml").read_text()
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text.replace("port_radius_mm", "port_radius", 1))
    with pytest.raises(Error) as caught:
        Sensor.load(wrong)
    error = caught.value
    assert error.file == str(wrong)
    assert error.line is not None and "port_radius" in wrong.read_text().splitlines()[error.line - 1]
    assert error.field is not None and "taxels" in error.field
    assert run_command("sensor", "show", wrong).stderr == f"error: {error}\n"
    assert isinstance(error, ValueError)


def test_a_wrong_cell_has_its_column(tmp_path: Path) -> None:
    lines = (DATA / "presses.csv").read_text().splitlines()
    cells = lines[3].split(",")
    lines[3] = ",".join(["x", *cells[1:]])
    (tmp_path / "presses.csv").write_text("\n".join(lines))
    with pytest.raises(Error) as caught:
        Recording.import_csv(DATA / "import.toml", tmp_path / "presses.csv")
    assert caught.value.file == str(tmp_path / "presses.csv")
    assert caught.value.line == 4
    assert caught.value.field == lines[0].split(",")[0]


MISSING = "no/such/file"


@pytest.mark.parametrize(
    "load",
    [
        lambda: Sensor.load(MISSING),
        lambda: Recording.load(MISSING),
        lambda: Recording.import_csv(MISSING),
        lambda: FastGel.load(MISSING),
        lambda: Imperfection.load(MISSING),
        lambda: Shape.stl(MISSING),
        lambda: Run.open(MISSING),
    ],
)
def test_a_missing_file_is_named(load: Callable[[], object]) -> None:
    with pytest.raises(Error, match="No such file") as caught:
        load()
    assert caught.value.file is not None and caught.value.file.startswith(MISSING)


def test_a_folder_without_a_twin_says_so() -> None:
    with pytest.raises(Error, match=MISSING):
        Twin.load(MISSING)


@pytest.fixture(scope="module")
def ball() -> Body:
    return Body(Shape.sphere(5.0))


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
        ("imperfection.hysteresis", lambda: Imperfection(hysteresis=2.0)),
        ("imperfection.gain", lambda: Imperfection(gain=2.0)),
        ("simulate.edges_per_height", lambda: Gel(Sensor.phystac(), {"edges_per_height": -1.0})),
        ("simulate.edges", lambda: Gel(Sensor.phystac(), {"edges": 1.0})),
        ("noise_kpa", lambda: Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}, noise_kpa=-1.0)),
        ("settings", lambda: Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}, nose_kpa=1.0)),
        ("provenance", lambda: PressureMap(Sensor.phystac(), np.zeros(8), "unreal")),  # type: ignore[arg-type]
        ("bodies", lambda: FastGel.phystac().batch([])),
    ],
)
def test_a_wrong_argument_is_named(field: str, wrong: Callable[[], object]) -> None:
    with pytest.raises(Error) as caught:
        wrong()
    assert caught.value.field == field
    assert field.split(".")[-1] in str(caught.value)


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("gel_from_body", {"gel_from_body": np.zeros((2, 4))}),
        ("position_mm", {"gel_from_body": np.full((1, 3), np.nan)}),
        ("quaternion", {"gel_from_body": np.zeros((1, 7))}),
        ("body", {"gel_from_body": np.zeros((2, 3)), "body": [0]}),
        ("body", {"gel_from_body": np.zeros((1, 3)), "body": [1]}),
        ("body", {"gel_from_body": np.zeros((1, 3)), "body": [-1]}),
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
    with pytest.raises(Error, match="there are 2"):
        sensors.rest(2)


def test_an_indenter_that_the_sensor_does_not_have_is_named() -> None:
    with pytest.raises(Error, match="there is no indenter `spoon`; the sensor has"):
        Gel(Sensor.phystac()).press(Press("spoon"))


def test_readings_of_another_sensor_are_refused() -> None:
    with pytest.raises(Error, match="8 taxels"):
        PressureMap(Sensor.phystac(), [1.0, 2.0], "real")
    tracker = Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}).start("real")
    with pytest.raises(Error, match="readings_kpa"):
        tracker.update(0.01, [1.0])
