"""Tests that the surrogate of the gel as arrays agrees with Rust in every library, and that its
gradients agree with differences.
"""

import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from contacts import CUBE, CUBES, Contacts, compiled, contacts, meshes, simple

from twintac import Body, Coupling, Error, FastGel, Pose, Sensor, SensorBatch, Shape, arrays

LIBRARIES = ("numpy", "torch", "jax")
SENSORS = ("phystac", "phystac_tip")
# Relative to the largest reading.
TOLERANCE = 1e-4


class Library(NamedTuple):
    """A library and an array of it in single precision."""

    name: str
    xp: Any
    like: Any

    def array(self, values: Any) -> Any:
        """The values as an array of the library, in single precision."""
        return self.xp.asarray(np.asarray(values, np.float32))


def library(name: str) -> Library:
    if name == "numpy":
        return Library(name, np, np.zeros(1, np.float32))
    if name == "torch":
        torch = pytest.importorskip("torch", reason="PyTorch is not installed")
        xp = pytest.importorskip("array_api_compat.torch", reason="array-api-compat is not installed")
        return Library(name, xp, torch.zeros(1))
    jnp = pytest.importorskip("jax.numpy", reason="JAX is not installed")
    return Library(name, jnp, jnp.zeros(1, jnp.float32))


@pytest.fixture(scope="module", params=LIBRARIES)
def lib(request: pytest.FixtureRequest) -> Library:
    return library(request.param)


@pytest.fixture(scope="module")
def gel() -> arrays.Gel:
    return arrays.load(FastGel.phystac())


def agrees(found: arrays.Reading, expected: tuple[Any, Any]) -> None:
    for own, rusts in zip((found.pressure_kpa, found.wrench), expected):
        own = np.asarray(own)
        assert own.dtype == np.float32 and own.shape == rusts.shape
        assert np.abs(own - rusts).max() < TOLERANCE * np.abs(rusts).max()


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("n_bodies", [1, 2, 3])
def test_it_reads_what_rust_reads(sensor: str, n_bodies: int, lib: Library) -> None:
    fast = getattr(FastGel, sensor)()
    own, rusts = zip(*simple())
    drawn = contacts(arrays.load(fast), 200, n_bodies, len(own), seed=n_bodies)
    found = drawn.by_arrays(arrays.load(fast, like=lib.like), arrays.stack(own), lib.xp)
    agrees(found, drawn.by_rust(fast, list(rusts)))


@pytest.mark.parametrize("sensor", SENSORS)
def test_surfaces_of_triangles_are_sampled_as_rust_samples_them(sensor: str, lib: Library) -> None:
    fast = getattr(FastGel, sensor)()
    own, rusts = zip(*meshes(), simple()[0])
    # Nearly upright shapes are thicker than they are deep.
    drawn = contacts(arrays.load(fast), 150, 2, len(own), depth_mm=2.0)
    leans = np.abs(drawn.quaternion[..., :2]).max(axis=-1, keepdims=True)
    drawn = drawn._replace(quaternion=np.where(leans < 0.1, drawn.quaternion, [0.0, 0.0, 0.0, 1.0]))
    found = drawn.by_arrays(arrays.load(fast, like=lib.like), arrays.stack(own), lib.xp)
    agrees(found, drawn.by_rust(fast, list(rusts)))


@pytest.mark.parametrize("sensor", SENSORS)
def test_ports_may_lie_between_points_of_all_grids(sensor: str) -> None:
    fast = getattr(FastGel, sensor)()
    low_mm, high_mm = fast.ports_mm.min(axis=0), fast.ports_mm.max(axis=0)
    places_mm = np.concatenate([np.random.default_rng(1).uniform(low_mm, high_mm, (20, 2)), fast.ports_mm, [[5.0, 5.0]]])
    moved = fast.with_ports(places_mm)
    own, rusts = zip(*simple())
    drawn = contacts(arrays.load(fast), 100, 2, len(own))
    agrees(drawn.by_arrays(arrays.load(moved), arrays.stack(own)), drawn.by_rust(moved, list(rusts)))


def test_a_plane_is_a_box_without_end(gel: arrays.Gel) -> None:
    # Its z axis points against that of the gel.
    down, depth_mm = np.array([1.0, 0.0, 0.0, 0.0], np.float32), np.linspace(-1.0, 3.0, 9)
    place_mm = np.stack([0.0 * depth_mm, 0.0 * depth_mm, 8.5 - depth_mm], axis=-1).astype(np.float32)
    planes = arrays.stack([arrays.plane()])
    found = arrays.read(gel, planes, place_mm[:, None], arrays.rotation_of(down)[None])
    box = Body(Shape.box((400.0, 400.0, 40.0), 0.0))
    agrees(found, FastGel.phystac().batch([box], 1).read(place_mm))
    assert found.gap_mm[:, 0] == pytest.approx(-depth_mm, abs=1e-5)


def test_an_ellipsoid_is_as_far_away_as_its_nearest_point() -> None:
    axes_mm = np.array([6.0, 4.0, 2.5])
    polar, turn = np.meshgrid(np.linspace(0.0, np.pi, 700), np.linspace(0.0, 2.0 * np.pi, 1400))
    surface_mm = axes_mm * np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], -1)
    point_mm = np.random.default_rng(1).uniform(-7.0, 7.0, (60, 3))
    point_mm[:3] = np.diag([1.0, 2.0, 1.0])  # on its axes
    nearest_mm = [np.sqrt(((surface_mm - point) ** 2).sum(-1).min()) for point in point_mm]
    signed_mm = np.where(((point_mm / axes_mm) ** 2).sum(-1) < 1.0, -1.0, 1.0) * nearest_mm
    # The gap to a gel of a single point is the distance of that point.
    gel = arrays.load(FastGel.phystac(), like=np.zeros(1))
    alone = gel._replace(points_mm=gel.points_mm[:, :1], levels_mm=gel.levels_mm[:1], deepest_mm=gel.deepest_mm[:1], highest_mm=gel.highest_mm - 100.0)
    shapes = arrays.centered(arrays.stack([arrays.ellipsoid(axes_mm.tolist())]))
    near = arrays._contact.near(np, alone, shapes, (alone.points_mm[:, 0] - point_mm)[:, None], np.eye(3)[None])
    assert near.gap_mm[:, 0] == pytest.approx(signed_mm, abs=2e-3)


def test_a_round_ellipsoid_is_a_ball(gel: arrays.Gel) -> None:
    balls = arrays.stack([arrays.ball(3.0), arrays.ball(6.0)])
    same = arrays.stack([arrays.ellipsoid((3.0, 3.0, 3.0)), arrays.ellipsoid((6.0, 6.0, 6.0))])
    drawn = contacts(gel, 100, 2, 2)
    expected = drawn.by_arrays(gel, balls)
    agrees(drawn.by_arrays(gel, same), (expected.pressure_kpa, expected.wrench))


def every_shape() -> arrays.Shapes:
    others = [arrays.ellipsoid((5.0, 4.0, 3.0)), arrays.ellipsoid((2.0, 2.0, 2.0)), arrays.plane()]
    return arrays.stack([own for own, _ in simple()] + others + [meshes()[0][0]])


def gradient(lib: Library, function: Callable[..., Any], *given: Any) -> list[Any]:
    """Gradients of a sum with respect to the arguments, in single precision."""
    if lib.name == "jax":
        jax = pytest.importorskip("jax")
        every = tuple(range(len(given)))
        found = jax.jit(jax.grad(function, argnums=every))(*(lib.array(value) for value in given))
        return [np.asarray(value) for value in found]
    own = [lib.array(value).requires_grad_() for value in given]
    function(*own).backward()
    return [value.grad.numpy() for value in own]


@pytest.mark.parametrize("name", LIBRARIES[1:])
@pytest.mark.parametrize("sensor", SENSORS)
def test_gradients_are_those_of_differences(name: str, sensor: str) -> None:
    lib, fast = library(name), getattr(FastGel, sensor)()
    gel, exact = arrays.load(fast, like=lib.like), arrays.load(fast, like=np.zeros(1))
    shapes = every_shape()
    drawn = contacts(exact, 200, 2, len(shapes.grown_mm) - 1, depth_mm=3.0)
    weight = np.random.default_rng(2).normal(size=8)

    def felt(gel: arrays.Gel, xp: Any, position_mm: Any, quaternion: Any) -> Any:
        chosen = arrays.choose(arrays.convert(shapes, gel.points_mm), xp.asarray(drawn.number))
        weights = xp.asarray(weight.astype(np.dtype(str(gel.points_mm.dtype).rpartition(".")[2])))
        reading = arrays.read(gel, chosen, position_mm, arrays.rotation_of(quaternion))
        return (reading.pressure_kpa * weights).sum(-1) + reading.wrench[..., 2] + reading.wrench[..., 4]

    # Along random directions, one for each contact, in which it moves or rotates.
    given, random, off = (drawn.position_mm, drawn.quaternion), np.random.default_rng(3), []
    slopes = gradient(lib, lambda *own: felt(gel, lib.xp, *own).sum(), *given)
    for argument, slope in enumerate(slopes):
        way = random.normal(size=slope.shape)
        above, below = (
            felt(exact, np, *(value + step * way if value is given[argument] else value for value in given)) for step in (1e-5, -1e-5)
        )
        difference, found = (above - below) / 2e-5, (slope * way).sum(axis=(-2, -1))
        off.append(np.abs(found - difference) / np.maximum(np.abs(difference), 1e-3 * np.abs(difference).max()))
    assert (np.concatenate(off) < 0.02).mean() > 0.95


@pytest.mark.parametrize("name", LIBRARIES[1:])
def test_gradients_are_numbers_everywhere(name: str) -> None:
    lib = library(name)
    gel, shapes = arrays.load(FastGel.phystac(), like=lib.like), every_shape()
    n = len(shapes.grown_mm)
    # Upright above points and ports, with surfaces, edges and middles exactly at points, far away,
    # and at zero distance.
    heights_mm = [8.5, 8.0, 7.0, 6.0, 5.5, 4.5, 3.5, 2.5, 0.0, 9.0, 10.5, 11.0, 1e3, 1e6]
    places_mm = [(0.0, 0.0), (-4.0, 4.0), (1.0, 0.0), (1.0, 1.0), (17.0, 9.0), (-1e6, 0.0)]
    grid = np.array([[[x, y, z]] for x, y in places_mm for z in heights_mm])
    position_mm = np.tile(grid, (n, 1, 1, 1)).reshape(-1, 1, 3)
    number = np.repeat(np.arange(n, dtype=np.int32), len(grid))[:, None]
    chosen = arrays.choose(arrays.convert(shapes, lib.like), lib.xp.asarray(number))
    for quaternion in ([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 1.0]):

        def felt(position_mm: Any, quaternion: Any) -> Any:
            reading = arrays.read(gel, chosen, position_mm, arrays.rotation_of(quaternion))
            return reading.pressure_kpa.sum() + reading.wrench.sum() + reading.gap_mm.sum()

        for slope in gradient(lib, felt, position_mm, np.tile(quaternion, (len(number), 1, 1))):
            assert np.isfinite(slope).all()


@pytest.mark.parametrize("name", LIBRARIES[1:])
def test_the_gap_pulls_where_nothing_touches(name: str) -> None:
    lib = library(name)
    gel = arrays.load(FastGel.phystac(), like=lib.like)
    balls = arrays.convert(arrays.stack([arrays.ball(5.0)]), lib.like)
    above = [[[0.0, 0.0, 12.0]]]
    [none] = gradient(lib, lambda at: arrays.read(gel, balls, at).pressure_kpa.sum(), above)
    [down] = gradient(lib, lambda at: arrays.read(gel, balls, at).gap_mm.sum(), above)
    assert (none == 0.0).all() and down.ravel() == pytest.approx([0.0, 0.0, 1.0], abs=1e-6)
    assert np.asarray(arrays.read(gel, balls, lib.array(above)).gap_mm) == pytest.approx(3.5, abs=1e-5)


def test_leading_dimensions_do_not_matter(lib: Library) -> None:
    gel, shapes = arrays.load(FastGel.phystac(), like=lib.like), arrays.stack([own for own, _ in simple()])
    drawn = contacts(arrays.load(FastGel.phystac()), 24, 2, len(shapes.grown_mm))
    rows = drawn.by_arrays(gel, shapes, lib.xp)
    shaped = Contacts._make(value.reshape(2, 3, 4, *value.shape[1:]) for value in drawn)
    for own, flat in zip(shaped.by_arrays(gel, shapes, lib.xp), rows):
        assert tuple(own.shape[:3]) == (2, 3, 4)
        assert np.allclose(np.asarray(own).reshape(flat.shape), np.asarray(flat), atol=1e-4)
    one = Contacts._make(value[5] for value in drawn).by_arrays(gel, shapes, lib.xp)
    assert np.allclose(np.asarray(one.pressure_kpa), np.asarray(rows.pressure_kpa)[5], atol=1e-4)
    swapped = Contacts._make(value[:, ::-1].copy() for value in drawn).by_arrays(gel, shapes, lib.xp)
    assert np.allclose(np.asarray(swapped.wrench), np.asarray(rows.wrench), atol=1e-4)
    none = Contacts._make(value[:0] for value in drawn).by_arrays(gel, shapes, lib.xp)
    assert tuple(none.pressure_kpa.shape) == (0, 8) and tuple(none.wrench.shape) == (0, 6)


def test_shapes_stretch_over_worlds(gel: arrays.Gel) -> None:
    shapes = arrays.stack([arrays.ball(5.0), arrays.box((8.0, 8.0, 8.0))])
    places_mm = np.array([[[-8.0, 0.0, z_mm], [8.0, 0.0, z_mm]] for z_mm in (7.0, 7.5, 8.0)])
    found = arrays.read(gel, shapes, places_mm)
    each = arrays.stack([shapes] * 3)
    assert np.array_equal(found.wrench, arrays.read(gel, each, places_mm).wrench)
    assert found.pressure_kpa.shape == (3, 8) and found.gap_mm.shape == (3, 2)


def test_jax_compiles_once_for_all_shapes() -> None:
    jax, lib = pytest.importorskip("jax"), library("jax")
    gel, shapes = arrays.load(FastGel.phystac(), like=lib.like), arrays.convert(every_shape(), lib.like)
    traced = []

    @jax.jit  # type: ignore[untyped-decorator]
    def felt(gel: arrays.Gel, shapes: arrays.Shapes, number: Any, position_mm: Any) -> Any:
        traced.append(1)
        return arrays.read(gel, arrays.choose(shapes, number), position_mm).wrench

    above = lib.array(np.tile([[0.0, 0.0, 7.5]], (4, 1, 1)))
    found = [np.asarray(felt(gel, shapes, lib.xp.full((4, 1), number), above)) for number in (0, 3, 5)]
    assert len(traced) == 1 and np.abs(found[0] - found[1]).max() > 0.1
    alone = jax.vmap(lambda own: felt(gel, shapes, lib.xp.zeros(1, int), own))(above)
    assert np.allclose(np.asarray(alone), found[0], atol=1e-4)


def test_torch_maps_over_worlds() -> None:
    lib = library("torch")
    torch = pytest.importorskip("torch")
    gel = arrays.load(FastGel.phystac(), like=lib.like)
    shapes = arrays.convert(arrays.stack([arrays.box((8.0, 8.0, 8.0), 0.5)]), lib.like)
    above = lib.array([[[float(x_mm), 0.0, 7.5]] for x_mm in range(4)])
    mapped = torch.func.vmap(lambda own: arrays.read(gel, shapes, own).pressure_kpa)(above)
    assert np.allclose(mapped.numpy(), arrays.read(gel, shapes, above).pressure_kpa.numpy(), atol=1e-4)


def test_what_is_no_number_reads_none(lib: Library) -> None:
    gel, shapes = arrays.load(FastGel.phystac(), like=lib.like), every_shape()
    n = len(shapes.grown_mm)
    place_mm = np.tile([0.0, 0.0, 7.5], (n, 2, 1, 1))
    place_mm[:, 0, 0, 2] = np.nan
    number = np.repeat(np.arange(n, dtype=np.int32), 2).reshape(n, 2, 1)
    chosen = arrays.choose(arrays.convert(shapes, lib.like), lib.xp.asarray(number))
    found = compiled(lib.xp, arrays.read)(gel, chosen, lib.array(place_mm))
    for own in found:
        assert np.isnan(np.asarray(own)[:, 0]).all() and np.isfinite(np.asarray(own)[:, 1]).all()


def test_poses_in_the_world_are_brought_into_the_gels_frame(lib: Library) -> None:
    random = np.random.default_rng(1)
    turns = random.normal(size=(5, 4))
    matrices = np.asarray(arrays.rotation_of(turns))
    assert np.allclose(matrices @ matrices.swapaxes(-1, -2), np.eye(3)) and np.allclose(np.linalg.det(matrices), 1.0)
    scalar_first = arrays.rotation_of(np.roll(turns, 1, axis=-1), is_scalar_first=True)
    assert np.allclose(scalar_first, matrices)
    gel_m, bodies_m = random.normal(size=(5, 3)), random.normal(size=(5, 2, 3))
    bodies = np.asarray(arrays.rotation_of(random.normal(size=(5, 2, 4))))
    given = (lib.array(value) for value in (gel_m, matrices, bodies_m, bodies))
    place_mm, rotation = (np.asarray(part) for part in arrays.gel_from_body(*given))
    assert np.allclose(np.einsum("wij,wbj->wbi", matrices, place_mm), 1e3 * (bodies_m - gel_m[:, None]), atol=1e-2)
    assert np.allclose(np.einsum("wij,wbjk->wbik", matrices, rotation), bodies, atol=1e-5)


@pytest.mark.parametrize("sensor", SENSORS)
@pytest.mark.parametrize("n_bodies", [1, 2])
def test_friction_and_loss_are_those_of_rust(sensor: str, n_bodies: int, lib: Library) -> None:
    fast, described, n = getattr(FastGel, sensor)(), getattr(Sensor, sensor)(), 40
    gel, own, rusts = arrays.load(fast, like=lib.like), *zip(*simple()[:6])
    drawn = contacts(arrays.load(fast), n, n_bodies, len(own), depth_mm=2.0)
    coupling = Coupling(described, friction=0.6, retardation_s=0.01)
    batch = SensorBatch(fast, [Body(shape) for shape in rusts], n, coupling=coupling, n_threads=1)
    same = np.tile(np.arange(n_bodies), n)
    shapes = arrays.choose(arrays.convert(arrays.stack(own), lib.like), lib.xp.asarray(drawn.number))
    held = arrays.held(gel, lib.array(drawn.position_mm))
    friction = arrays.friction(fast, 0.6, retardation_s=0.01, like=lib.like)
    way_mm = np.random.default_rng(5).normal(0.0, [0.15, 0.15, 0.05], drawn.position_mm.shape)
    step = compiled(lib.xp, arrays.step)
    for moment in range(5):
        position_mm, half = drawn.position_mm + moment * way_mm, 0.025 * moment
        x, y, z, w = np.moveaxis(drawn.quaternion, -1, 0)
        s, c = np.sin(half), np.cos(half)
        quaternion = np.stack([c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z], axis=-1)
        poses = np.concatenate([position_mm, quaternion], axis=-1).reshape(-1, 7)
        expected = batch.step(0.02, poses, drawn.number.ravel(), n_bodies * np.arange(1, n + 1), touch_id=same)
        rotation = arrays.rotation_of(lib.array(quaternion))
        held, found = step(gel, friction, held, 0.02, shapes, lib.array(position_mm), rotation)
        for ours, theirs in zip((found.pressure_kpa, found.wrench, found.wrench_of_bodies), (*expected, batch.wrench_of_touches())):
            ours = np.asarray(ours).reshape(theirs.shape)
            assert np.abs(ours - theirs).max() < TOLERANCE * np.abs(theirs).max()
        slips = batch.slip_of_touches()
        ours = np.asarray(found.slip_mm_per_s).reshape(slips.shape)
        assert np.abs(ours - slips).max() < 1e-3 * max(1.0, np.abs(slips).max())
    assert np.abs(np.asarray(held.force_n)).max() > 0.1 and np.abs(slips).max() > 1.0


@pytest.mark.parametrize("name", LIBRARIES[1:])
def test_gradients_go_through_friction(name: str) -> None:
    lib = library(name)
    gel, friction = arrays.load(FastGel.phystac(), like=lib.like), arrays.friction(FastGel.phystac(), 0.6, retardation_s=0.01, like=lib.like)
    balls = arrays.convert(arrays.stack([arrays.ball(5.0), arrays.ball(5.0)]), lib.like)
    start = lib.array([[-6.0, 0.0, 7.5], [6.0, 0.0, 20.0]])

    def felt(along_mm: Any) -> Any:
        held, _ = arrays.step(gel, friction, arrays.held(gel, start), 0.02, balls, start)
        moved = start + along_mm * lib.array([1.0, 0.0, 0.0])
        return arrays.step(gel, friction, held, 0.02, balls, moved)[1].wrench[..., 0].sum()

    [slope] = gradient(lib, felt, 0.1)
    difference = (float(felt(lib.array(0.11))) - float(felt(lib.array(0.09)))) / 0.02
    assert np.isfinite(slope) and float(slope) == pytest.approx(difference, rel=0.02)


def refusal(call: Callable[[], Any]) -> Error:
    with pytest.raises(Error) as caught:
        call()
    return caught.value


BALL = arrays.stack([arrays.ball(5.0)])
HERE = np.zeros((4, 1, 3), np.float32)
UPRIGHT = np.tile(np.eye(3, dtype=np.float32), (4, 1, 1, 1))


@pytest.mark.parametrize(
    ("field", "says", "call"),
    [
        ("position_mm", "[4, 1, 2], expected [..., n_bodies, 3]", lambda gel: arrays.read(gel, BALL, HERE[..., :2])),
        ("position_mm", "[3], expected [..., n_bodies, 3]", lambda gel: arrays.read(gel, BALL, HERE[0, 0])),
        ("rotation", "[4, 1, 3], expected [..., n_bodies, 3, 3]", lambda gel: arrays.read(gel, BALL, HERE, HERE)),
        ("rotation", "[3, 1]", lambda gel: arrays.read(gel, BALL, HERE, UPRIGHT[:3])),
        ("position_mm", "[4, 3], expected such as fit [2]", lambda gel: arrays.read(gel, arrays.stack([arrays.ball(5.0)] * 2), np.zeros((4, 3, 3), np.float32))),
        ("shapes", "one shape, expected", lambda gel: arrays.read(gel, arrays.ball(5.0), HERE)),
        ("position_mm", "is a list, expected an array", lambda gel: arrays.read(gel, BALL, [[0.0, 0.0, 7.0]])),
        ("shapes", "is empty", lambda _: arrays.stack([])),
        ("shapes", "[[], [1]]", lambda _: arrays.stack([arrays.ball(5.0), BALL])),
        ("shapes", "[1, 1]", lambda _: arrays.choose(arrays.stack([BALL]), np.zeros(3, int))),
        ("radius_mm", "is -1.0, expected a length", lambda _: arrays.ball(-1.0)),
        ("radius_mm", "is nan", lambda _: arrays.cylinder(float("nan"), 5.0)),
        ("size_mm", "has 2 lengths, expected 3", lambda _: arrays.box((1.0, 2.0))),
        ("edge_radius_mm", "is 3.0, expected 0 to 2.0 mm", lambda _: arrays.box((4.0, 8.0, 8.0), 3.0)),
        ("height_mm", "is 4.0, expected 6.0 or more", lambda _: arrays.capsule(3.0, 4.0)),
        ("quaternion", "[4, 3]", lambda _: arrays.rotation_of(np.zeros((4, 3)))),
        ("coefficient", "is -1.0, expected 0 or more", lambda _: arrays.friction(FastGel.phystac(), -1.0)),
        ("like", "is a float", lambda gel: arrays.convert(gel, 1.0)),
        ("like", "int64, expected float32", lambda gel: arrays.convert(gel, np.zeros(1, np.int64))),
    ],
)
def test_what_cannot_be_is_refused_by_name(field: str, says: str, call: Callable[[arrays.Gel], Any], gel: arrays.Gel) -> None:
    error = refusal(lambda: call(gel))
    assert error.field == field and f"`{field}`" in str(error) and says in str(error)


def test_shapes_of_another_precision_are_refused(gel: arrays.Gel) -> None:
    jax_or_torch = [name for name in ("jax", "torch") if _is_installed(name)]
    for name in jax_or_torch:
        other = library(name)
        error = refusal(lambda: arrays.read(gel, arrays.convert(BALL, other.like), HERE))
        assert error.field == "shapes" and "one of numpy" in str(error)


def _is_installed(name: str) -> bool:
    try:
        library(name)
    except pytest.skip.Exception:
        return False
    return True


def test_a_gel_is_read_from_itself_its_file_and_its_bytes(tmp_path: Path, gel: arrays.Gel) -> None:
    data = FastGel.phystac().to_bytes()
    (tmp_path / "gel.safetensors").write_bytes(data)
    for source in (data, tmp_path / "gel.safetensors", str(tmp_path / "gel.safetensors")):
        assert np.array_equal(arrays.load(source).pressure.rows, gel.pressure.rows)
    same = FastGel.load(tmp_path / "gel.safetensors").reader().read([(Body(Shape.sphere(5.0)), Pose((0.0, 0.0, 7.5)))])
    assert same[1][2] < 0.0
    start = 8 + int.from_bytes(data[:8], "little")
    entries = json.loads(data[8:start])
    entries["__metadata__"]["twintac-fast"] = json.dumps({**json.loads(entries["__metadata__"]["twintac-fast"]), "version": 5})
    header = json.dumps(entries).encode()
    older = len(header).to_bytes(8, "little") + header + data[start:]
    for name, wrong in (("none", b"none"), ("half", data[: len(data) // 2]), ("empty", b""), ("older", older)):
        (tmp_path / name).write_bytes(wrong)
        error = refusal(lambda: arrays.load(tmp_path / name))
        assert error.file == str(tmp_path / name) and str(tmp_path / name) in str(error)
    assert "5 where 6 is expected" in str(refusal(lambda: arrays.load(older)))
    assert "no-such-file" in str(refusal(lambda: arrays.load("no-such-file")))


def test_distances_of_shapes_are_exact() -> None:
    ball = Shape.sphere(5.0)
    assert ball.bounds_mm.tolist() == [[-5.0, -5.0, 0.0], [5.0, 5.0, 10.0]]
    assert ball.signed_distance_mm([[0.0, 0.0, 5.0], [0.0, 0.0, -1.0]]) == pytest.approx([-5.0, 1.0])
    for wrong in (np.zeros((2, 2)), np.zeros(3), np.full((1, 3), np.nan)):
        assert refusal(lambda: ball.signed_distance_mm(wrong)).field == "points_mm"


def test_proximity_is_that_of_rust(gel: arrays.Gel) -> None:
    random = np.random.default_rng(5)
    poses = np.zeros((200, 7))
    poses[:, :3] = random.uniform([-14.0, -7.0, 7.0], [14.0, 7.0, 12.0], (200, 3))
    poses[:, 6] = 1.0
    sensors = SensorBatch(FastGel.phystac(), [Body(Shape.sphere(5.0))], 200)
    sensors.step(0.01, poses)
    expected = sensors.proximity()
    reading = arrays.read(gel, arrays.stack([arrays.ball(5.0)]), poses[:, None, :3].astype(np.float32))
    assert arrays.proximity(reading.gap_mm) == pytest.approx(expected, abs=1e-5)
    assert (expected == 0.0).any() and (expected == 1.0).any() and ((expected > 0.1) & (expected < 0.9)).any()


def test_what_is_behind_the_sensor_does_not_press_it(gel: arrays.Gel) -> None:
    kinds = [
        (arrays.ball(5.0), Shape.sphere(5.0), 10.0),
        (arrays.box((60.0, 60.0, 60.0)), Shape.box((60.0, 60.0, 60.0), 0.0), 60.0),
        (arrays.box((1000.0, 1000.0, 40.0)), Shape.box((1000.0, 1000.0, 40.0), 0.0), 40.0),
        (arrays.cylinder(10.0, 30.0, 0.5), Shape.cylinder(10.0, 30.0, 0.5), 30.0),
        (arrays.ellipsoid((8.0, 6.0, 5.0)), None, 10.0),
        (arrays.plane(), None, 0.0),
    ]
    reader = FastGel.phystac().reader()
    for own, shape, height_mm in kinds:
        for tilt in (0.0, 0.1, 0.26):
            quaternion = np.array([0.0, np.sin(0.5 * tilt), 0.0, np.cos(0.5 * tilt)])
            rotation = np.asarray(arrays.rotation_of(quaternion))
            for behind_mm in (1.0, 5.0, 20.0, 1000.0):
                place_mm = np.array([0.0, 0.0, -behind_mm]) - rotation @ np.array([0.0, 0.0, height_mm])
                poses = place_mm[None].astype(np.float32), rotation[None].astype(np.float32)
                reading = arrays.read(gel, arrays.stack([own]), *poses)
                assert not reading.pressure_kpa.any() and not reading.wrench.any(), (height_mm, tilt, behind_mm)
                assert arrays.proximity(reading.gap_mm) == 0.0
                if shape is not None:
                    touching = [(Body(shape), Pose(tuple(place_mm), tuple(quaternion)))]
                    assert not reader.read(touching)[0].any()


def test_thin_shapes_that_are_sampled_are_named() -> None:
    with pytest.warns(UserWarning, match=r"the shape is 1(\.\d)? mm thick .* deeper than 0\.\d+ mm, readings are too low"):
        arrays.mesh(Shape.surface(CUBE * [1.0, 1.0, 1.2 / 9.0], CUBES))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        arrays.mesh(Shape.surface(CUBE, CUBES))
