"""Tests that values pass from process to process, that forked processes work, and that threads
share objects.
"""

import copy
import os
import pickle
import re
import shutil
import signal
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DATA

import twintac
from twintac import (
    Body,
    Coupling,
    Dataset,
    Error,
    FastGel,
    Friction,
    Gel,
    SensorVariation,
    Inverse,
    Pose,
    Press,
    PressPath,
    PressureMap,
    Reader,
    ReadingTable,
    Recording,
    Run,
    Sensor,
    SensorBatch,
    Shape,
    Tasks,
    Twin,
)

COARSE = {"edges_per_height": 2.0, "max_nodes": 1500, "max_path_nodes": 1500}
PLACES = np.tile([0.0, 0.0, 7.5], (64, 1))


def in_fork(work: Callable[[], object], timeout_s: float = 60.0) -> None:
    """Calls a function in a forked process, which has to succeed in time."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            work()
            code = 0
        finally:
            os._exit(code)
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            assert os.waitstatus_to_exitcode(status) == 0
            return
        time.sleep(0.01)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    pytest.fail("the forked process hangs")


@pytest.fixture(scope="module")
def gel() -> Gel:
    return Gel(Sensor.phystac(), COARSE)


@pytest.fixture(scope="module")
def followed(gel: Gel) -> twintac.Followed:
    return gel.follow(PressPath("sphere-25", [0.0, 1.0], [[0.0, 0.0, 0.0], [0.0, 0.0, -0.3]], zero="touch"))


@pytest.fixture(scope="module")
def reading() -> twintac.Reading:
    with Reader.emulated(Sensor.phystac()) as reader:
        return reader.read()


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_works_after_calls_before_it(gel: Gel, tmp_path: Path) -> None:
    fast, ball = FastGel.phystac(), Body(Shape.sphere(5.0))
    sensors, batch = SensorBatch(fast, [ball], 64, n_threads=2), fast.batch([ball], 2)
    tasks = Tasks("HoldForce", 64, n_threads=2)
    tasks.reset()
    deep = Pose((0.0, 0.0, gel.touch("sphere-25", Pose((0.0, 0.0, 0.0))).position_mm[2] - 0.2))
    state = gel.state("sphere-25", [deep])
    dataset = Dataset(fast=True, n_presses=4)
    works: dict[str, Callable[[], Any]] = {
        "SensorBatch": lambda: sensors.step(0.01, PLACES),
        "FastBatch": lambda: batch.read(PLACES),
        "Tasks": lambda: tasks.step(np.zeros((64, 1))),
        "GelState": lambda: state.step(0.01, deep),
        "Gel": lambda: gel.press(Press("sphere-25", depth_mm=0.2)),
        "Dataset": lambda: dataset.make(tmp_path / str(os.getpid()), progress=False),
        "Inverse": lambda: Inverse(fast, {"ball": Shape.sphere(5.0)}),
    }
    for work in works.values():
        work()
    for work in works.values():
        in_fork(work)
    in_fork(lambda: in_fork(works["SensorBatch"]))
    expected = batch.read(PLACES)[0]
    in_fork(lambda: np.testing.assert_array_equal(batch.read(PLACES)[0], expected))


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_what_was_at_work_when_a_process_was_forked_says_so() -> None:
    batch = FastGel.phystac().batch([Body(Shape.sphere(6.0))], n_threads=1)
    many = np.tile([0.0, 0.0, 7.5], (60_000, 1))
    worker = threading.Thread(target=lambda: batch.read(many))
    worker.start()
    time.sleep(0.2)

    def work() -> None:
        with pytest.raises(Error, match="when this process was forked"):
            batch.read(PLACES)

    in_fork(work)
    worker.join()
    assert batch.read(PLACES)[0].shape == (64, 8)


@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_reader_is_read_by_the_process_that_opened_it() -> None:
    with Reader.emulated(Sensor.phystac()) as reader:
        reader.read()

        def work() -> None:
            with pytest.raises(Error, match="in this process"):
                reader.read()
            reader.close()

        in_fork(work)
        assert reader.read().sequence > 0


def figures(value: object) -> object:
    """All numbers of an object, as texts with every bit."""
    if isinstance(value, Sensor | Shape | Body | SensorVariation | Gel | FastGel | Run | Coupling):
        return repr(value)
    names = [name for name in dir(value) if not name.startswith("_")]
    members = {name: getattr(value, name) for name in names}
    return {name: member.tolist() if isinstance(member, np.ndarray) else repr(member) for name, member in members.items() if not callable(member)}


def again(value: Any) -> list[Any]:
    protocols = [pickle.loads(pickle.dumps(value, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    return [*protocols, copy.copy(value), copy.deepcopy(value)]


def test_values_are_the_same_after_a_pickle(gel: Gel, followed: twintac.Followed, reading: twintac.Reading, tmp_path: Path) -> None:
    sensor, fast = Sensor.phystac(), FastGel.phystac()
    tetrahedron = Shape.surface([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    union = Shape.union([(Shape.sphere(3.0), Pose((0.1, 0.0, 0.0))), (tetrahedron, Pose((0.0, 0.0, 1.0)))])
    table = ReadingTable([0.0, 0.1, 0.2], [0.0], [0.3, 0.9], np.linspace(0.0, 1.0, 48).reshape(2, 1, 3, 8))
    inverse = Inverse(fast, {"ball": Shape.sphere(5.0)})
    felt_kpa = fast.reader().read([(Body(Shape.sphere(5.0)), Pose((1.0, 0.0, 7.0)))])[0]
    contact = inverse.start("simulated").update(0.1, felt_kpa)
    recording = Recording.import_csv(DATA / "import.toml", DATA / "presses.csv")
    values: list[Any] = [
        Pose((1 / 3, 2.0, 3.0), (0.0, 0.0, 0.6, 0.8)),
        Press("sphere-25", at_mm=(1 / 3, 2.0), depth_mm=0.7, hold_s=0.1),
        sensor,
        union,
        Body(union),
        SensorVariation(gain_deviation=1 / 3),
        Coupling(sensor, friction=0.5, retardation_s=0.01),
        PressPath("sphere-25", [0.0, 1.0], [[0.0, 0.0, 8.0], [0.0, 0.0, 7.9]], force_n=[np.nan, 1.0]),
        table,
        PressureMap(sensor, [1.0, np.nan, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], "real"),
        fast,
        fast.with_ports([[1.0, 2.0], [0.1, 0.2]]),
        gel,
        gel.press(Press("sphere-25", depth_mm=0.2)),
        followed,
        contact,
        recording,
        reading,
        Run.start(tmp_path / "run", sensor, "nowhere"),
    ]
    for value in values:
        for same in again(value):
            assert type(same) is type(value)
            assert repr(same) == repr(value) and figures(same) == figures(value)
    assert contact is not None
    floor = inverse.floor_map(2.0)
    assert np.array_equal(floor.read(pickle.loads(pickle.dumps(contact))), floor.read(contact))
    pressed, same = (own.press(Press("sphere-25", depth_mm=0.3)) for own in (gel, copy.deepcopy(gel)))
    assert np.array_equal(pressed.readings_kpa, same.readings_kpa)
    moved = fast.with_ports([[1.0, 2.0]])
    for own in (fast, moved):
        place = [(Body(union), Pose((0.0, 0.0, 7.0)))]
        assert np.array_equal(own.reader().read(place)[0], pickle.loads(pickle.dumps(own)).reader().read(place)[0])
    for name, column in recording.columns().items():
        assert np.array_equal(column, copy.copy(recording).columns()[name], equal_nan=column.dtype.kind == "f")


def test_a_sensor_with_a_surface_needs_no_file_after_a_pickle(tmp_path: Path) -> None:
    corners = np.array([[x, y, z] for x in (-5.0, 5.0) for y in (-4.0, 4.0) for z in (0.0, 8.0)]) + 1 / 3
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [(a, *pair) for a, b, c, d in faces for pair in ((b, c), (c, d))]
    vertices = ["".join(f"vertex {x} {y} {z}\n" for x, y, z in corners[list(triangle)]) for triangle in triangles]
    facets = "".join(f"facet normal 0 0 0\nouter loop\n{three}endloop\nendfacet\n" for three in vertices)
    (tmp_path / "own.stl").write_text(f"solid own\n{facets}endsolid own\n", encoding="utf-8")
    text = Path(DATA.parents[4], "sensors/phystac.toml").read_text(encoding="utf-8")
    text = re.sub(r'material = "\.\./', f'material = "{DATA.parents[4]}/', text)
    text += '\n[[indenters]]\nname = "own"\nshape = { kind = "stl", path = "own.stl" }\n'
    (tmp_path / "own.toml").write_text(text, encoding="utf-8")
    sensor = Sensor.load(tmp_path / "own.toml")
    kept = pickle.dumps(sensor)
    (tmp_path / "own.stl").unlink()
    same = pickle.loads(kept)
    assert same.describe() == sensor.describe() and same.indenters == sensor.indenters
    above = Pose((0.0, 0.0, 0.0))
    assert Gel(same, COARSE).touch("own", above) == Gel(sensor, COARSE).touch("own", above)


def test_a_twin_is_found_where_it_lies_or_said_to_be_another(trained: Path, tmp_path: Path) -> None:
    shutil.copytree(trained / "model", tmp_path / "model")
    twin = Twin.load(tmp_path / "model")
    prediction = twin.predict(Press("sphere-25", depth_mm=0.5))
    for same in again(twin):
        assert repr(same) == repr(twin)
    for same in again(prediction):
        assert figures(same) == figures(prediction)
    kept = pickle.dumps(twin)
    sums = tmp_path / "model/checksums.json"
    sums.write_text(sums.read_text(encoding="utf-8") + "\n", encoding="utf-8")
    with pytest.raises(Error, match="another one"):
        pickle.loads(kept)


def test_what_is_no_value_says_what_to_pickle_instead(gel: Gel) -> None:
    fast, sensor, ball = FastGel.phystac(), Sensor.phystac(), Body(Shape.sphere(5.0))
    inverse = Inverse(fast, {"ball": Shape.sphere(5.0)})
    reader = Reader.emulated(sensor)
    reader.close()
    stateful: list[object] = [
        fast.reader(),
        fast.batch([ball]),
        SensorBatch(fast, [ball], 1),
        Tasks("HoldForce", 1),
        Friction(sensor, 0.5),
        inverse,
        inverse.start("real"),
        inverse.floor_map(2.0),
        gel.state("sphere-25", [Pose((0.0, 0.0, 8.0))]),
        Dataset(fast=True, n_presses=1),
        reader,
    ]
    for value in stateful:
        name = type(value).__name__
        for keep in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(TypeError, match=rf"a twintac\.{name} can't be pickled or copied: \w+"):
                keep(value)


def test_a_pickle_of_another_version_is_refused_by_name() -> None:
    kept: Any = Pose((0.0, 0.0, 0.0)).__reduce__()
    restored, (name, state) = kept
    with pytest.raises(Error, match="Spoon"):
        restored("Spoon", state)
    with pytest.raises(Error, match=name):
        restored(name, b"\x00")


def test_every_class_tells_what_it_is() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+.*", twintac.__version__)
    for name in twintac.__all__:
        owner = getattr(twintac, name)
        if isinstance(owner, type) and name != "Error":
            assert "__repr__" in vars(owner), name
    sensor = Sensor.phystac()
    fast, ball = FastGel.phystac(), Body(Shape.sphere(5.0))
    assert repr(fast) == "<FastGel of \"phystac\" with 8 ports>"
    assert repr(SensorBatch(fast, [ball], 3)).startswith("<SensorBatch of 3 sensors of 8 taxels, 1 bodies")
    assert repr(Tasks("HoldForce", 2)) == "<Tasks: 2 environments of HoldForce, simulated>"
    assert repr(PressureMap(sensor, [np.nan, *range(7)], "real")) == "<PressureMap of \"phystac\" without t0, real>"


@pytest.mark.parametrize("kind", ["reader", "batch", "sensors", "tasks", "tracker", "friction", "floor", "twin states", "twin at a place"])
def test_threads_take_turns(kind: str, trained: Path) -> None:
    fast, ball = FastGel.phystac(), Body(Shape.sphere(5.0))
    reader, batch = fast.reader(), fast.batch([ball], 2)
    sensors, tasks = SensorBatch(fast, [ball], 64, n_threads=2), Tasks("HoldForce", 64, n_threads=2)
    inverse = Inverse(fast, {"ball": Shape.sphere(5.0)})
    tracker, friction, floor = inverse.start("simulated"), Friction(Sensor.phystac(), 0.5), inverse.floor_map(1.0)
    twin = Twin.load(trained / "model")
    states, pressed = twin.states(4), twin.at(Press("cylinder", at_mm=(0.0, 0.0), depth_mm=1.0))
    pose = Pose((1.0, 0.0, 7.0))
    felt_kpa = reader.read([(ball, pose)])[0]
    contact = inverse.start("simulated").update(0.1, felt_kpa)
    assert contact is not None
    works: dict[str, Callable[[], object]] = {
        "reader": lambda: reader.read([(ball, pose)]),
        "batch": lambda: batch.read(PLACES),
        "sensors": lambda: sensors.step(0.01, PLACES),
        "tasks": lambda: tasks.step(np.zeros((64, 1))),
        "tracker": lambda: tracker.update(0.01, felt_kpa),
        "friction": lambda: friction.read(reader, ball, pose),
        "floor": lambda: floor.read(contact),
        "twin states": lambda: states.step(0.01, np.zeros((4, 8))),
        "twin at a place": lambda: pressed.step(0.01, 0.5),
    }
    wrong: list[BaseException] = []

    def work() -> None:
        try:
            for _ in range(50):
                works[kind]()
                repr(works[kind])
        except BaseException as error:
            wrong.append(error)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert wrong == []


def test_a_state_is_stepped_by_several_threads(gel: Gel) -> None:
    top_mm = gel.touch("sphere-25", Pose((0.0, 0.0, 0.0))).position_mm[2]
    poses = [Pose((0.0, 0.0, top_mm - depth_mm)) for depth_mm in (0.1, 0.2)]
    state = gel.state("sphere-25", poses)
    threads = [threading.Thread(target=lambda pose=pose: [state.step(0.01, pose) for _ in range(5)]) for pose in poses]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        assert state.depth_mm is None or state.depth_mm < 0.3
    assert state.gel_from_indenter in poses
