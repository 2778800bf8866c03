"""Tests of contact estimation, by tables and twins, and of the pressure at the base of the gel."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from twintac import Body, Contact, Error, FastGel, Inverse, Pose, Press, ReadingTable, Shape, Twin

X_MM, Y_MM, DEPTH_MM = np.linspace(-6.0, 6.0, 13), np.linspace(-3.0, 3.0, 7), np.linspace(0.2, 1.6, 8)
BALL = Shape.sphere(5.0)


def read(x_mm: float, y_mm: float, depth_mm: float) -> tuple[npt.NDArray[np.float32], float]:
    readings_kpa, wrench = FastGel.phystac().reader().read([(Body(BALL), Pose((x_mm, y_mm, 8.5 - depth_mm)))])
    return readings_kpa, -float(wrench[2])


@pytest.fixture(scope="module")
def table() -> ReadingTable:
    depth_mm, y_mm, x_mm = (axis.ravel() for axis in np.meshgrid(DEPTH_MM, Y_MM, X_MM, indexing="ij"))
    readings_kpa, wrench = FastGel.phystac().batch([Body(BALL)]).read(np.stack([x_mm, y_mm, 8.5 - depth_mm], axis=1))
    shape = (len(DEPTH_MM), len(Y_MM), len(X_MM))
    return ReadingTable(X_MM, Y_MM, DEPTH_MM, readings_kpa.reshape(*shape, 8), -wrench[:, 2].reshape(shape))


def found(inverse: Inverse, readings_kpa: npt.ArrayLike) -> Contact:
    tracker = inverse.start("simulated")
    for _ in range(10):
        contact = tracker.update(0.01, readings_kpa)
    assert contact is not None
    return contact


def test_a_table_finds_what_it_was_made_of(table: ReadingTable) -> None:
    readings_kpa, force_n = read(-2.3, 1.4, 0.9)
    inverse = Inverse.of_tables({"ball": table}, noise_kpa=0.02)
    contact = found(inverse, readings_kpa)
    assert inverse.shapes == ["ball"] and contact.shape == "ball"
    assert contact.place_mm == pytest.approx((-2.3, 1.4), abs=0.2)
    assert contact.depth_mm == pytest.approx(0.9, abs=0.1)
    assert contact.force_n == pytest.approx(force_n, rel=0.1)
    assert contact.provenance == "simulated"


def test_measured_places_are_enough(table: ReadingTable) -> None:
    places = ReadingTable(X_MM, Y_MM, [1.0], readings(1.0))
    contact = found(Inverse.of_tables({"weight": places}, noise_kpa=0.02, n_steps=8), read(1.2, -0.7, 1.0)[0])
    assert contact.place_mm == pytest.approx((1.2, -0.7), abs=0.2)
    assert contact.depth_mm == 1.0 and contact.force_n == 0.0


def readings(depth_mm: float) -> npt.NDArray[np.float32]:
    """Readings at all locations, `[1, n_y, n_x, 8]`."""
    y_mm, x_mm = (axis.ravel() for axis in np.meshgrid(Y_MM, X_MM, indexing="ij"))
    places = np.stack([x_mm, y_mm, np.full(x_mm.shape, 8.5 - depth_mm)], axis=1)
    return FastGel.phystac().batch([Body(BALL)]).read(places)[0].reshape(1, len(Y_MM), len(X_MM), 8)


def test_a_wrong_table_is_named() -> None:
    good = readings(1.0)
    nan = np.full(good.shape, np.nan)
    for field, arguments in (
        ("x_mm", ([0.0, 1.0, 3.0], Y_MM, [1.0], good)),
        ("y_mm", (X_MM, Y_MM[::-1], [1.0], good)),
        ("depth_mm", (X_MM, Y_MM, [], good)),
        ("readings_kpa", (X_MM, Y_MM, [1.0], good[:, 1:])),
        ("readings_kpa", (X_MM, Y_MM, [1.0], nan)),
        ("force_n", (X_MM, Y_MM, [1.0], good, np.zeros((1, 2, 3)))),
    ):
        with pytest.raises(Error) as caught:
            ReadingTable(*arguments)
        assert caught.value.field == field
    tables = {"eight": ReadingTable(X_MM, Y_MM, [1.0], good), "four": ReadingTable(X_MM, Y_MM, [1.0], good[..., :4])}
    with pytest.raises(Error, match="4 taxels"):
        Inverse.of_tables(tables)
    with pytest.raises(Error, match="shape"):
        Inverse.of_tables({})
    with pytest.raises(Error, match="is no setting; there are ") as caught:
        Inverse.of_tables({"eight": tables["eight"]}, nois_kpa=1.0)
    assert caught.value.field == "nois_kpa"


def test_the_floor_is_seen_finer_than_the_taxels(table: ReadingTable) -> None:
    gel = FastGel.phystac()
    inverse = Inverse(gel, {"ball": BALL}, noise_kpa=0.02)
    contact = found(inverse, read(-3.0, 2.0, 1.0)[0])
    floor = inverse.floor_map(0.5)
    pressure_kpa = floor.read(contact)
    assert pressure_kpa.shape == (len(floor.y_mm), len(floor.x_mm))
    assert np.diff(floor.x_mm) == pytest.approx(0.5) and np.diff(floor.y_mm) == pytest.approx(0.5)
    assert len(floor.x_mm) * len(floor.y_mm) > 2000
    row, column = np.unravel_index(pressure_kpa.argmax(), pressure_kpa.shape)
    assert (floor.x_mm[column], floor.y_mm[row]) == pytest.approx((-3.0, 2.0), abs=1.0)
    places_mm = np.array([[floor.x_mm[column], floor.y_mm[row]]])
    pose = Pose((*contact.place_mm, 8.5 - contact.depth_mm))
    there_kpa = gel.with_ports(places_mm).reader().read([(Body(BALL), pose)])[0]
    assert pressure_kpa[row, column] == pytest.approx(there_kpa[0], rel=0.02)
    assert floor.provenance == "simulated"
    with pytest.raises(Error, match="spacing_mm"):
        inverse.floor_map(0.0)
    with pytest.raises(Error, match="FastGel"):
        Inverse.of_tables({"ball": table}).floor_map()
    with pytest.raises(Error, match="another inverse") as caught:
        Inverse(gel, {"ball": Shape.sphere(4.0)}).floor_map().read(contact)
    assert caught.value.field == "contact"


def test_a_twin_finds_where_it_is_pressed(trained: Path) -> None:
    twin = Twin.load(trained / "model")
    predicted = twin.predict(Press("sphere-25", at_mm=(-3.0, 1.0), depth_mm=0.9, hold_s=0.2))
    steps: list[str] = []
    inverse = Inverse.of_twin(
        trained / "model", ["sphere-25"], progress=lambda work, *_: steps.append(work), deepest_mm=1.5
    )
    assert inverse.shapes == ["sphere-25"] and "simulating" in steps
    tracker, contacts, before_s = inverse.start("simulated"), [], 0.0
    for frame, time_s in enumerate(predicted.time_s):
        # Now and then one taxel is lost; its last reading is used.
        is_lost = np.arange(8) == frame % 16
        readings_kpa = np.where(is_lost, np.nan, predicted.readings_kpa[frame])
        contacts.append(tracker.update(time_s - before_s, readings_kpa))
        before_s = time_s
    assert contacts[0] is None
    deepest = contacts[int(predicted.depth_mm.argmax())]
    assert deepest is not None and deepest.shape == "sphere-25"
    assert deepest.place_mm == pytest.approx((-3.0, 1.0), abs=0.5)
    with pytest.raises(Error, match="spoon"):
        Inverse.of_twin(trained / "model", ["spoon"])
