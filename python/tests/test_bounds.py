"""Tests that every count has a bound and every error names its argument: values out of range are
refused before memory is allocated.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from twintac import (
    Body,
    Dataset,
    Error,
    FastGel,
    Gel,
    Inverse,
    Pose,
    Press,
    PressPath,
    PressureMap,
    Reader,
    ReadingTable,
    Run,
    Sensor,
    SensorBatch,
    Shape,
    Tasks,
)

HUGE = (10**13, 2**40, 2**63, 2**64, 10**40, -1)


@pytest.fixture(scope="module")
def gel() -> FastGel:
    return FastGel.phystac()


@pytest.fixture(scope="module")
def ball() -> Body:
    return Body(Shape.sphere(5.0))


def refusal(wrong: Callable[[], object]) -> Error:
    with pytest.raises(Error) as caught:
        wrong()
    return caught.value


@pytest.mark.parametrize("number", [*HUGE, 0, True, 1.0, "1", np.float64(1.0), [1, 2]])
def test_a_count_that_cannot_be_is_refused_by_name(number: Any, gel: FastGel, ball: Body) -> None:
    sphere = {"ball": Shape.sphere(5.0)}
    for field, wrong in [
        ("n_sensors", lambda: SensorBatch(gel, [ball], number)),
        ("n_threads", lambda: SensorBatch(gel, [ball], 1, n_threads=number)),
        ("n_threads", lambda: gel.batch([ball], number)),
        ("n_environments", lambda: Tasks("HoldForce", number)),
        ("n_threads", lambda: Tasks("HoldForce", 1, n_threads=number)),
        ("n_presses", lambda: Dataset(fast=True, n_presses=number)),
        ("counts_per_pa", lambda: Reader.open("/dev/no-such-bus", Sensor.phystac(), counts_per_pa=number)),
    ]:
        error = refusal(wrong)
        assert error.field == field
        assert f"`{field}` is {str(number)[:5]}" in str(error).replace("'", "").replace("np.float64(", "")
        assert "expected an integer from 1 to" in str(error)
    if not isinstance(number, str | list | bool | float):
        for field in ("n_starts", "n_steps"):
            error = refusal(lambda: Inverse(gel, sphere, **{field: number}))
            assert error.field == field


def test_a_gel_of_many_ports_takes_fewer_sensors(gel: FastGel, ball: Body) -> None:
    many = gel.with_ports(np.zeros((100_000, 2)))
    assert "expected an integer from 1 to 100" in str(refusal(lambda: SensorBatch(many, [ball], 101)))
    assert "at most 2500" in str(refusal(lambda: many.batch([ball]).read(np.tile([0.0, 0.0, 50.0], (2501, 1)))))
    floor = gel.with_ports(np.zeros((1_000_000, 2)))
    assert "presses of 1000000 readings" in str(refusal(lambda: Inverse(floor, {"ball": Shape.sphere(5.0)})))


@pytest.mark.parametrize("seed", [-1, 2**64, 1.5, "1", None])
def test_a_seed_that_cannot_be_is_refused_by_name(seed: Any, gel: FastGel, ball: Body) -> None:
    tasks = Tasks("HoldForce", 2, n_threads=1)
    if seed is not None:
        assert refusal(lambda: SensorBatch(gel, [ball], 1, seed=seed)).field == "seed"
        assert refusal(lambda: tasks.seed([0, seed])).field == "seeds"
    assert refusal(lambda: tasks.seed(seed)).field == "seeds"


def test_integers_of_numpy_are_integers(gel: FastGel, ball: Body) -> None:
    places = np.zeros((2, 3)) + [0.0, 0.0, 7.5]
    own = SensorBatch(gel, [ball], np.int64(2), seed=np.uint32(3), n_threads=np.int8(1)).step(0.1, places)
    same = SensorBatch(gel, [ball], 2, seed=3, n_threads=1).step(0.1, places)
    assert np.array_equal(own[0], same[0])
    tasks = Tasks("HoldForce", np.int16(2), n_threads=np.uint8(1))
    tasks.seed(np.array([1, 2]))
    tasks.seed([np.int64(1), None])
    assert tasks.reset([True, False])[0].shape == (2, tasks.n_observed)


def test_sensors_that_are_not_there_are_refused_by_name(gel: FastGel, ball: Body) -> None:
    sensors, tasks = SensorBatch(gel, [ball], 2), Tasks("HoldForce", 2, n_threads=1)
    for number in (2, -1, 2**63, 2**70):
        assert refusal(lambda: sensors.rest(number)).field == "sensor"
        assert refusal(lambda: sensors.replace(number, 0)).field == "sensor"
        assert refusal(lambda: tasks.picture(number)).field == "environment"
    assert refusal(lambda: sensors.replace(0, -1)).field == "number"


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        ("position_mm", lambda: Pose([[0.0, 0.0, 0.0]])),
        ("position_mm", lambda: Pose("abc")),
        ("position_mm", lambda: Pose([0.0, 0.0, 1j])),
        ("position_mm", lambda: Pose([0.0, [1.0], 0.0])),  # type: ignore[arg-type]
        ("position_mm", lambda: Pose(object())),  # type: ignore[arg-type]
        ("position_mm", lambda: Pose(np.array(["1", "2", "3"]))),
        ("size_mm", lambda: Shape.box(3.0, 0.1)),
        ("vertices_mm", lambda: Shape.surface([0.0, 1.0], [[0, 1, 2]])),
        ("triangles", lambda: Shape.surface(np.eye(3), [[0.0, 1.5, 2.0]])),
        ("time_s", lambda: PressPath("sphere-25", [[0.0]], [[0.0, 0.0, 0.0]])),
        ("gel_from_indenter", lambda: PressPath("sphere-25", [0.0], [0.0, 0.0, 0.0])),
        ("rate_hz", lambda: PressPath("sphere-25", [0.0, 1e300], np.zeros((2, 3)), rate_hz=1.0)),
        ("readings_kpa", lambda: PressureMap(Sensor.phystac(), np.zeros((8, 1)), "real")),
        ("readings_kpa", lambda: PressureMap(Sensor.phystac(), [np.inf] * 8, "real")),
        ("readings_kpa", lambda: ReadingTable([0.0], [0.0], [1.0], np.zeros((1, 1, 8)))),
        ("x_mm", lambda: ReadingTable([0.0, 1e9], [0.0], [1.0], np.zeros((1, 1, 2, 8)))),
        ("depth_mm", lambda: Press("sphere-25", depth_mm=1e300)),
        ("speed_mm_per_s", lambda: Press("sphere-25", speed_mm_per_s=1e-300)),
        ("hold_s", lambda: Press("sphere-25", hold_s=1e9)),
        ("at_mm", lambda: Press("sphere-25", at_mm=(0.0, 1e9))),
        ("places_mm", lambda: FastGel.phystac().with_ports([[np.nan, 0.0]])),
        ("places_mm", lambda: FastGel.phystac().with_ports([[0.0, 100.0]])),
        ("places_mm", lambda: FastGel.phystac().with_ports(np.zeros((0, 2)))),
        ("places_mm", lambda: FastGel.phystac().with_ports([0.0, 0.0])),
        ("deepest_mm", lambda: Inverse(FastGel.phystac(), {"ball": Shape.sphere(5.0)}, deepest_mm=1000.0)),
        ("seed", lambda: Run.demo("never-made", seed=-1)),
    ],
)
def test_what_came_is_said_by_name(field: str, wrong: Callable[[], object]) -> None:
    error = refusal(wrong)
    assert error.field == field
    assert f"`{field}`" in str(error)


def test_shapes_of_arrays_say_what_came_and_what_was_expected(gel: FastGel, ball: Body) -> None:
    error = str(refusal(lambda: gel.batch([ball]).read([0.0, 0.0, 7.5])))
    assert error == "`gel_from_body` has the shape [3], expected [n, 7], place in mm and quaternion (x, y, z, w), or [n, 3], the place alone"
    assert "has the shape [2, 2], expected [2]" in str(refusal(lambda: Tasks("HoldForce", 2).reset(np.ones((2, 2), bool))))
    assert "expected integers [n_touches]" in str(refusal(lambda: gel.batch([ball]).read([[0.0, 0.0, 7.5]], body=[[0]])))


def test_settings_that_never_end_are_refused() -> None:
    within: dict[str, Any] = {}
    within["solver"] = within
    assert "in each other" in str(refusal(lambda: Gel(Sensor.phystac(), within)))
    assert refusal(lambda: Gel(Sensor.phystac(), {"max_nodes": 2**63})).field == "max_nodes"
    assert "key 1" in str(refusal(lambda: Gel(Sensor.phystac(), {1: 2.0})))  # type: ignore[dict-item]


def test_a_time_that_cannot_be_is_refused(gel: FastGel, ball: Body) -> None:
    sensors = SensorBatch(gel, [ball], 1)
    for seconds in (-1.0, np.nan, np.inf, 1e300):
        assert refusal(lambda: sensors.step(seconds, [[0.0, 0.0, 7.5]])).field == "since_previous_s"


def test_readings_beyond_all_barometers_are_refused_and_change_nothing(gel: FastGel, ball: Body) -> None:
    inverse = Inverse(gel, {"ball": Shape.sphere(5.0)})
    tracker, other = inverse.start("simulated"), inverse.start("simulated")
    readings_kpa = gel.reader().read([(ball, Pose((1.0, 0.0, 7.0)))])[0]
    for wrong in (1e39, np.inf, np.nan):
        assert refusal(lambda: tracker.update(0.01, [wrong] * 8)).field == "readings_kpa[0]"
    found, expected = tracker.update(0.01, readings_kpa), other.update(0.01, readings_kpa)
    assert found is not None and expected is not None and found.place_mm == expected.place_mm
