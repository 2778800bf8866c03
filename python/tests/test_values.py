"""Tests that numbers agree with those of the command line, that shapes are as documented, and that
the same call gives the same bits.
"""

import copy
import json
from pathlib import Path

import numpy as np
import numpy.typing as npt
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

COARSE = {"edges_per_height": 4.0, "edges_per_contact_radius": 4.0}

PROTOCOL = """
summary = "One press"
indenters = ["sphere-25"]
places = { kind = "grid", x_mm = [1.0, 1.0], y_mm = [2.0, 2.0], count = [1, 1] }
depth_mm = [0.8, 0.8]
speed_mm_per_s = [2.0, 2.0]
hold_s = [0.5, 0.5]
clearance_mm = 0.0
"""


def test_a_sensor_is_that_of_its_file() -> None:
    sensor = Sensor.load(ROOT / "sensors/phystac.toml")
    assert sensor.describe() == run_command("sensor", "show", ROOT / "sensors/phystac.toml").stdout
    assert sensor.taxels == Sensor.phystac().taxels == [f"t{number}" for number in range(8)]
    assert sensor.taxel_positions_mm.shape == (8, 3)
    assert "sphere-25" in sensor.indenters


def test_a_press_has_a_row_for_each_frame_and_repeats_to_the_last_bit() -> None:
    gel = Gel(Sensor.phystac(), COARSE)
    pressed, again = (gel.press(Press("sphere-25", depth_mm=0.8)) for _ in range(2))
    n_frames = len(pressed.depth_mm)
    assert pressed.readings_kpa.shape == (n_frames, 8)
    assert pressed.force_n.shape == (n_frames,)
    assert pressed.depth_mm[0] == 0.0 and pressed.depth_mm[-1] == 0.8
    assert np.all(np.diff(pressed.force_n) > 0.0)
    assert np.array_equal(pressed.readings_kpa, again.readings_kpa)
    assert pressed.provenance == "simulated"


def test_friction_holds_up_to_coulombs_limit() -> None:
    sensor, reader = Sensor.phystac(), FastGel.phystac().reader()
    ball, friction = Body(Shape.sphere(radius_mm=12.5)), Friction(Sensor.phystac(), 0.5)
    readings_kpa = felt_kpa = wrench = held = np.zeros(0, np.float32)
    pose = Pose((0.0, 0.0, 7.5))
    for x_mm in np.linspace(0.0, 2.0, 21):
        pose = Pose((x_mm, 0.0, 7.5))
        readings_kpa, wrench = reader.read([(ball, pose)])
        felt_kpa, held = friction.read(reader, ball, pose)
    assert held[0] - wrench[0] == pytest.approx(0.5 * np.linalg.norm(wrench[:3]), rel=1e-3)
    ahead = readings_kpa.argmax()
    assert felt_kpa[ahead] > readings_kpa[ahead]
    friction.release()
    assert np.array_equal(friction.read(reader, ball, pose)[1], wrench)
    with pytest.raises(Error, match="coefficient"):
        Friction(sensor, -0.1)


def test_a_press_is_that_of_the_command(tmp_path: Path) -> None:
    (tmp_path / "protocol.toml").write_text(PROTOCOL, encoding="utf-8")
    settings = [f"{name} = {value}" for name, value in COARSE.items()]
    (tmp_path / "settings.toml").write_text("\n".join(["[simulate]", *settings]), encoding="utf-8")
    files = ["--protocol", tmp_path / "protocol.toml", "--settings", tmp_path / "settings.toml"]
    sensor = ROOT / "sensors/phystac.toml"
    assert run_command("simulate", "--sensor", sensor, *files, "--out", tmp_path / "out").returncode == 0
    (table,) = (tmp_path / "out").glob("*.json")
    frames = json.loads(table.read_text(encoding="utf-8"))["table"]["frames"]
    pressed = Gel(Sensor.load(sensor), COARSE).press(Press("sphere-25", at_mm=(1.0, 2.0), depth_mm=0.8))
    assert pressed.depth_mm.tolist() == [frame["depth_mm"] for frame in frames]
    assert pressed.force_n.tolist() == [frame["force_n"] for frame in frames]
    assert pressed.readings_kpa.tolist() == [frame["port_pressure_kpa"] for frame in frames]


def test_a_map_goes_through_its_readings() -> None:
    sensor = Sensor.phystac()
    readings_kpa = [0.0, 2.0, 7.5, 1.0, 0.0, 1.5, 6.0, 0.8]
    pressure_map = PressureMap(sensor, readings_kpa, "real")
    pressure_kpa = pressure_map.pressure_kpa
    assert pressure_kpa.shape == (64, 96)
    assert pressure_map.provenance == "real"
    x_mm, y_mm = sensor.taxel_positions_mm[2, :2]
    column, row = int((x_mm + 17.0) / 34.0 * 96), int((y_mm + 9.0) / 18.0 * 64)
    assert pressure_kpa[row, column] == pytest.approx(7.5, abs=0.3)


def test_a_recording_is_its_parquet_file(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    recording = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")
    recording.save(tmp_path / "presses.parquet")
    frames = recording.to_pandas()
    pandas.testing.assert_frame_equal(frames, pandas.read_parquet(tmp_path / "presses.parquet"), check_dtype=False)
    assert recording.to_polars().shape == frames.shape
    assert Recording.load(tmp_path / "presses.parquet").columns().keys() == recording.columns().keys()
    assert recording.provenance == "emulated"
    assert len(recording) == len(recording.presses) == frames["press"].nunique()


def test_an_import_says_what_it_left_out_and_guesses_a_description(tmp_path: Path) -> None:
    lines = (DATA / "presses.csv").read_text(encoding="utf-8").splitlines()
    cells = lines[100].split(",")
    taxel = lines[0].split(",").index("t4_kpa")
    cells[taxel] = "NaN"
    lines[100] = ",".join(cells)
    (tmp_path / "presses.csv").write_text("\n".join(lines), encoding="utf-8")
    recording = Recording.import_csv(DATA / "import.toml", tmp_path / "presses.csv")
    (file,) = recording.imported
    assert (file["file"], file["presses"], file["missing_readings"]) == ("presses.csv", len(recording), 1)
    columns = recording.columns()
    assert np.isnan(columns["t4_kpa"]).sum() == np.isnan(columns["t4_raw"]).sum() == 1
    assert (~columns["t4_valid"]).sum() == 1
    recording.save(tmp_path / "presses.parquet")
    assert Recording.load(tmp_path / "presses.parquet").imported == []
    guessed = Recording.guess_import(DATA / "presses.csv")
    (tmp_path / "guessed.toml").write_text(guessed, encoding="utf-8")
    assert len(Recording.import_csv(tmp_path / "guessed.toml", DATA / "presses.csv")) == len(recording)
    with pytest.raises(Error, match="no rows of numbers"):
        Recording.guess_import(DATA / "import.toml")


def test_characterization_is_that_of_the_command(trained: Path, tmp_path: Path) -> None:
    recording = Run.open(trained).recording()
    found = recording.characterize(Sensor.phystac(), tmp_path)
    presses = trained / "recordings/presses.parquet"
    said = run_command(
        "characterize", "--sensor", trained / "sensor.toml", "--recordings", presses, "--json"
    )
    assert found == json.loads(said.stdout)
    assert (tmp_path / "report.html").is_file()


def test_metrics_are_those_of_the_file_and_of_the_command(trained: Path) -> None:
    metrics = Run.open(trained).finish(progress=False)
    assert metrics == json.loads((trained / "metrics.json").read_text(encoding="utf-8"))
    assert metrics == json.loads(run_command("evaluate", "--run", trained, "--json").stdout)
    assert metrics["provenance"] == "emulated"


def test_a_prediction_is_that_of_the_command(trained: Path, tmp_path: Path) -> None:
    (tmp_path / "protocol.toml").write_text(PROTOCOL, encoding="utf-8")
    said = run_command("predict", "--model", trained / "model", "--protocol", tmp_path / "protocol.toml", "--json")
    expected = json.loads(said.stdout)["presses"][0]
    twin = Twin.load(trained / "model")
    predicted = twin.predict(Press("sphere-25", at_mm=(1.0, 2.0), depth_mm=0.8, hold_s=0.5))
    for name in ("time_s", "depth_mm", "force_n", "readings_kpa", "simulated"):
        assert getattr(predicted, name).tolist() == expected[name], name
    certainty = expected["certainty"]
    assert certainty is not None and predicted.half_width_kpa is not None
    assert predicted.half_width_kpa.tolist() == certainty["half_width_kpa"]
    assert predicted.readings_kpa.shape == (len(predicted), 8)
    assert (predicted.provenance, twin.trained_on) == ("simulated", "emulated")


def test_a_twin_at_a_place_steps_as_its_prediction_says(trained: Path) -> None:
    twin = Twin.load(trained / "model")
    press = Press("sphere-25", depth_mm=0.8)
    predicted, at = twin.predict(press), twin.at(press)
    assert at.step(0.0, -1.0) == pytest.approx(np.zeros(8), abs=1e-9)
    assert at.force_n == 0.0
    at.rest()
    contact_offset_mm = predicted.depth_mm.max() - press.depth_mm
    before_s = 0.0
    for frame, time_s in enumerate(predicted.time_s):
        readings_kpa = at.step(time_s - before_s, predicted.depth_mm[frame] - contact_offset_mm)
        assert readings_kpa == pytest.approx(predicted.readings_kpa[frame], abs=1e-6)
        assert at.force_n == pytest.approx(predicted.force_n[frame], abs=1e-6)
        before_s = time_s
    assert predicted.readings_kpa.max() > 1.0


def test_twins_that_are_stepped_together_are_those_alone(trained: Path) -> None:
    twin = Twin.load(trained / "model")
    pressure_kpa = np.random.default_rng(1).uniform(0.0, 10.0, (5, 8))
    together = twin.states(5).step(0.01, pressure_kpa)
    alone = np.concatenate([twin.states().step(0.01, row[None]) for row in pressure_kpa])
    assert np.array_equal(together, alone)


def test_a_batch_reads_as_a_reader_does() -> None:
    gel = FastGel.phystac()
    bodies = [Body(Shape.sphere(5.0)), Body(Shape.box([8.0, 8.0, 8.0], 0.5))]
    half = float(np.sqrt(0.5))
    poses = [Pose((-4.0, 2.0, 7.5)), Pose((3.0, 0.0, 7.0), (0.0, 0.0, half, half)), Pose((8.0, 3.0, 7.8))]
    rows = np.array([[*pose.position_mm, *pose.quaternion] for pose in poses])
    pressure_kpa, wrench = gel.batch(bodies, n_threads=2).read(rows, body=[0, 1, 0], ends=[1, 1, 3])
    touching: list[list[tuple[Body, Pose]]] = [
        [(bodies[0], poses[0])],
        [],
        [(bodies[1], poses[1]), (bodies[0], poses[2])],
    ]
    reader = gel.reader()
    for sensor, own in enumerate(touching):
        expected_kpa, expected = reader.read(own)
        assert np.array_equal(pressure_kpa[sensor], expected_kpa)
        assert np.array_equal(wrench[sensor], expected)
    assert pressure_kpa.dtype == wrench.dtype == np.float32
    assert wrench[1, 2] == 0.0 and wrench[0, 2] < 0.0


def test_poses_and_places_are_any_few_numbers() -> None:
    pose = Pose((1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0))
    assert pose == Pose([1, 2, 3], [0, 0, 1, 0]) == Pose(np.array([1.0, 2.0, 3.0]), np.array([0.0, 0.0, 1.0, 0.0], np.float32))
    assert Pose(np.zeros(3)).quaternion == (0.0, 0.0, 0.0, 1.0)
    assert Press("sphere-25", at_mm=np.array([1.0, -2.0])) == Press("sphere-25", at_mm=[1, -2]) == Press("sphere-25", at_mm=(1.0, -2.0))


def test_settings_may_be_of_numpy() -> None:
    assert SensorVariation(gain_deviation=np.float32(0.25)) == SensorVariation(gain_deviation=0.25)
    gel, shapes = FastGel.phystac(), {"ball": Shape.sphere(5.0)}
    readings_kpa = gel.reader().read([(Body(shapes["ball"]), Pose((1.0, 0.0, 6.5)))])[0]
    own = Inverse(gel, shapes, noise_kpa=np.float32(0.25), n_steps=np.int64(2)).start("simulated").update(0.1, readings_kpa)
    same = Inverse(gel, shapes, noise_kpa=0.25, n_steps=2).start("simulated").update(0.1, readings_kpa)
    assert own is not None and same is not None
    assert np.array_equal(own.covariance, same.covariance) and own.place_mm == same.place_mm


def test_what_is_pressed_tells_how_deep() -> None:
    gel = Gel(Sensor.phystac(), {"edges_per_height": np.float64(2.0), "max_path_nodes": np.int64(1500)})
    touch = gel.touch("sphere-25", Pose((0.0, 0.0, 0.0)))
    x_mm, y_mm, z_mm = touch.position_mm
    deep = Pose((x_mm, y_mm, z_mm - 0.5), touch.quaternion)
    state = gel.state("sphere-25", [deep])
    assert repr(state) == "<GelState untouched, simulated>"
    state.step(0.1, deep)
    assert repr(state) == "<GelState pressed 0.50 mm deep, simulated>"


def test_arrays_of_another_type_or_layout_read_the_same() -> None:
    batch = FastGel.phystac().batch([Body(Shape.sphere(5.0))])
    places = np.array([[-4.0, 2.0, 7.5], [4.0, 2.0, 7.5]])
    expected = batch.read(places)[0]
    for same in (np.asfortranarray(places), places.astype(np.float32), places.tolist()):
        assert np.array_equal(batch.read(same)[0], expected)


def test_sensors_are_imperfect_by_their_seed_alone() -> None:
    gel, ball = FastGel.phystac(), Body(Shape.sphere(6.0))
    places = np.tile([0.0, 0.0, 7.5], (6, 1))

    def readings_kpa(seed: int, n_threads: int, **fields: float) -> npt.NDArray[np.float32]:
        variation = SensorVariation(**fields)
        batch = SensorBatch(gel, [ball], 6, variation=variation, seed=seed, n_threads=n_threads)
        return [batch.step(0.01, places)[0] for _ in range(3)][-1]

    own = readings_kpa(1, 1, gain_deviation=0.1, noise_deviation_kpa=0.1)
    assert np.array_equal(own, readings_kpa(1, 3, gain_deviation=0.1, noise_deviation_kpa=0.1))
    assert not np.array_equal(own, readings_kpa(2, 1, gain_deviation=0.1, noise_deviation_kpa=0.1))
    perfect = readings_kpa(1, 1)
    assert np.array_equal(perfect, gel.batch([ball]).read(places)[0])
    assert np.ptp(own[:, 0]) > np.ptp(perfect[:, 0]) == 0.0


def test_one_body_twice_is_two_things() -> None:
    box = Body(Shape.box((8.0, 8.0, 10.0), 0.0))
    sensors = SensorBatch(FastGel.phystac(), [box], 1, coupling=Coupling(Sensor.phystac(), friction=0.8, retardation_s=0.005))
    places = np.array([[-8.0, 0.0, 8.4], [8.0, 0.0, 8.4]])
    expected = FastGel.phystac().batch([box]).read(places, [0, 0], [2])[1]
    for order in ([0, 1], [1, 0], [0, 1]):
        wrench = sensors.step(0.01, places[order], [0, 0], [2], touch_id=order)[1]
        assert wrench[0, :3] == pytest.approx(expected[0, :3], abs=5e-3) and wrench[0, 2] < -0.05
        left, right = sensors.wrench_of_touches()[order]
        assert left[2] == pytest.approx(right[2], abs=5e-3) and left[0] == pytest.approx(-right[0], abs=5e-3)


def test_a_sensor_goes_on_from_its_state() -> None:
    noisy, ball = SensorVariation(noise_deviation_kpa=0.1, hysteresis=0.1), Body(Shape.sphere(6.0))
    sensors = SensorBatch(FastGel.phystac(), [ball], 2, variation=noisy, coupling=Coupling(Sensor.phystac(), friction=0.8, retardation_s=0.005))

    def steps() -> npt.NDArray[np.float32]:
        return np.array([sensors.step(0.01, np.tile([0.1 * n, 0.0, 7.5], (2, 1)), touch_id=[4, 4])[0] for n in range(5)])

    steps()
    state = sensors.state(0)
    first = steps()
    assert not np.array_equal(steps()[:, 0], first[:, 0])
    for sensor in (0, 1):
        sensors.set_state(sensor, copy.deepcopy(state))
    again = steps()
    assert np.array_equal(again[:, 0], first[:, 0]) and np.array_equal(again[:, 1], first[:, 0])
    assert repr(state) == "<SensorState of 8 taxels, simulated>"


def test_a_contact_is_found_where_it_is() -> None:
    gel, shape = FastGel.phystac(), Shape.sphere(5.0)
    reader, ball = gel.reader(), Body(shape)
    tracker = Inverse(gel, {"ball": shape}, noise_kpa=0.02).start("simulated")
    assert tracker.update(0.01, np.zeros(8)) is None
    pressure_kpa, wrench = reader.read([(ball, Pose((-3.0, 2.0, 7.3)))])
    for _ in range(10):
        contact = tracker.update(0.01, pressure_kpa)
    assert contact is not None
    assert contact.place_mm == pytest.approx((-3.0, 2.0), abs=0.2)
    assert contact.depth_mm == pytest.approx(1.2, abs=0.1)
    assert contact.force_n == pytest.approx(-wrench[2], rel=0.1)
    assert contact.shape == "ball" and contact.shape_probabilities == {"ball": 1.0}
    assert contact.covariance.shape == (4, 4)
    assert contact.provenance == tracker.provenance == "simulated"


def test_a_surface_presses_as_the_box_that_it_is(tmp_path: Path) -> None:
    corners = np.array([[x, y, z] for x in (-4.0, 4.0) for y in (-4.0, 4.0) for z in (0.0, 8.0)])
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    lines = ["solid box"]
    for a, b, c, d in faces:
        for triangle in ((a, b, c), (a, c, d)):
            vertices = "".join(f"vertex {x} {y} {z}\n" for x, y, z in corners[list(triangle)])
            lines.append(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet")
    (tmp_path / "box.stl").write_text("\n".join([*lines, "endsolid box"]), encoding="utf-8")
    surface, box = Shape.stl(tmp_path / "box.stl"), Shape.box([8.0, 8.0, 8.0], 0.0)
    whole = Shape.union([(surface, Pose((0.0, 0.0, 0.0)))])
    tenth = Shape.stl(tmp_path / "box.stl", scale=0.1)
    with pytest.raises(Error, match="0.008 × 0.008 × 0.008 mm large.*`unit = \"m\"`"):
        Shape.stl(tmp_path / "box.stl", scale=1e-3)
    with pytest.raises(Error, match="8000 × 8000 × 8000 mm large"):
        Shape.stl(tmp_path / "box.stl", unit="m")
    with pytest.raises(Error, match="`unit` is `feet`, expected one of mm, cm, m, inch"):
        Shape.stl(tmp_path / "box.stl", unit="feet")
    with pytest.raises(Error, match="one of the two"):
        Shape.stl(tmp_path / "box.stl", unit="m", scale=2.0)
    reader, pose = FastGel.phystac().reader(), Pose((0.0, 0.0, 7.5))
    expected_kpa = reader.read([(Body(box), pose)])[0]
    small_kpa = reader.read([(Body(Shape.box([0.8, 0.8, 0.8], 0.0)), pose)])[0]
    assert reader.read([(Body(tenth), pose)])[0] == pytest.approx(small_kpa, abs=0.05)
    for shape in (surface, whole):
        assert reader.read([(Body(shape), pose)])[0] == pytest.approx(expected_kpa, abs=0.05)


def test_a_taxel_without_a_reading_is_left_out_of_the_map() -> None:
    sensor, readings = Sensor.phystac(), [5.0] * 8
    whole = PressureMap(sensor, readings, "real")
    readings[2] = float("nan")
    without = PressureMap(sensor, readings, "real")
    masked = PressureMap(sensor, np.ma.masked_array([5.0] * 8, mask=[taxel == 2 for taxel in range(8)]), "real")
    x_mm, y_mm, _ = sensor.taxel_positions_mm[2]
    (low_x, low_y, _), (high_x, high_y, _) = sensor.bounds_mm
    row, column = int((y_mm - low_y) / (high_y - low_y) * 64), int((x_mm - low_x) / (high_x - low_x) * 96)
    assert without.missing == ["t2"] and whole.missing == []
    assert np.array_equal(without.pressure_kpa, masked.pressure_kpa)
    assert without.pressure_kpa[row, column] == pytest.approx(5.0, rel=0.5)
    assert np.isnan(PressureMap(sensor, [np.nan] * 8, "real").pressure_kpa).all()
    assert "without t2" in without._repr_svg_() and "without" not in whole._repr_svg_()
