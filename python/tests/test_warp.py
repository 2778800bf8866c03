"""Tests of the kernels of Warp beside the formulas of `twintac.arrays`, and inside captured steps."""

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

wp = pytest.importorskip("warp", reason="needs `pip install warp-lang torch`")
torch = pytest.importorskip("torch", reason="needs `pip install warp-lang torch`")

from contacts import CUBE, CUBES, Contacts  # noqa: E402

from twintac import FastGel, Shape, arrays  # noqa: E402
from twintac.arrays._shapes import from_samples  # noqa: E402
from twintac.simulators._moment import Memory, Poses, Touch, begin, forget, moment  # noqa: E402
from twintac.simulators._scene import Places, Scene, scene  # noqa: E402
from twintac.simulators._warp import WarpGels  # noqa: E402

Array = npt.NDArray[np.float32]
N_WORLDS, N_SENSORS = 48, 2
STEP_S = 0.001
SHAPES = [
    *(arrays.centered(shape) for shape in (arrays.ball(4.0), arrays.box((6.0, 8.0, 5.0), 0.3), arrays.box((9.0, 9.0, 1.0), 0.1))),
    *(arrays.centered(shape) for shape in (arrays.cylinder(4.0, 6.0, 0.2), arrays.cylinder(5.0, 1.2, 0.1), arrays.capsule(2.0, 9.0))),
    arrays.centered(arrays.ellipsoid((3.0, 4.0, 5.0))),
    arrays.plane(),
    arrays.mesh(Shape.surface(2.0 * CUBE, CUBES)),
]
PLANE = 7


def scene_of(gel: FastGel, shapes: list[arrays.Shapes]) -> Scene:
    """Sensors on bodies of their own, and shapes on bodies of their own; the last shape is on the
    first sensor's body, which it does not touch.
    """
    n = len(shapes)
    body_of_geom = N_SENSORS + np.arange(n)
    body_of_geom[-1] = 0 if n > 1 else body_of_geom[-1]
    places = Places(
        site=np.arange(N_SENSORS),
        geom=np.arange(n),
        body_of_sensor=np.arange(N_SENSORS),
        body_of_geom=body_of_geom,
        moves=np.ones(N_SENSORS + n, bool),
        part_of=np.arange(N_SENSORS + n),
    )
    return scene(places, shapes, gel, 0.8, 0.005, None)


def turns(rng: np.random.Generator, n: int, spread: float) -> Any:
    return arrays.rotation_of(np.concatenate([spread * rng.normal(size=(n, 3)), np.ones((n, 1))], axis=-1))


class Motion:
    """Sensors anywhere in the world, and bodies that slide over them, several at a time."""

    def __init__(self, found: Scene, shapes: list[int], seed: int) -> None:
        rng, n = np.random.default_rng(seed), len(shapes)
        self.site_m = rng.normal(size=(N_WORLDS, N_SENSORS, 3))
        self.site_turn = turns(rng, N_WORLDS * N_SENSORS, 1.0).reshape(N_WORLDS, N_SENSORS, 3, 3)
        self.middle_m = rng.normal(size=(N_WORLDS, N_SENSORS + n, 3))
        # A body is on one of the sensors, or far from all of them.
        self.sensor = rng.integers(N_SENSORS, size=(N_WORLDS, n))
        is_near = rng.random((N_WORLDS, n)) < max(0.35, 1.0 / n)
        height_mm = found.gel.center_mm[2] + rng.uniform(-1.5, 5.0, (N_WORLDS, n))
        level_mm = found.gel.center_mm[2] + rng.uniform(-1.5, 0.5, (N_WORLDS, n))
        height_mm = np.where(np.array(shapes) == PLANE, level_mm, height_mm)
        aside_mm = rng.uniform(-8.0, 8.0, (N_WORLDS, n, 2))
        self.at_mm = np.concatenate([aside_mm, np.where(is_near, height_mm, 400.0)[..., None]], axis=-1)
        self.turn = turns(rng, N_WORLDS * n, 0.2).reshape(N_WORLDS, n, 3, 3)
        down = np.diag([1.0, -1.0, -1.0])
        self.turn = np.where(np.array(shapes)[:, None, None] == PLANE, self.turn @ down, self.turn)
        self.speed_mm = rng.normal(size=self.at_mm.shape) * [0.3, 0.3, 0.05]

    def poses(self, step: int) -> Poses:
        """Poses after a number of steps."""
        at_mm = self.at_mm + step * self.speed_mm
        rows = np.arange(N_WORLDS)[:, None], self.sensor
        origin_m, turn = self.site_m[rows], self.site_turn[rows]
        geom_m = origin_m + 1e-3 * (turn @ at_mm[..., None])[..., 0]
        of_geom = turn @ turns(np.random.default_rng(step), 1, 0.02)[0] @ self.turn
        all = (self.site_m, self.site_turn, geom_m, of_geom, self.middle_m)
        return Poses(*(values.astype(np.float32) for values in all))


def on_device(poses: Poses) -> Poses:
    return Poses(*(wp.array(rows, dtype=wp.mat33 if rows.ndim == 4 else wp.vec3, device="cpu") for rows in poses))


def differ(found: Scene, kernels: Touch, expected: Touch) -> dict[str, float]:
    """Largest differences, as fractions of the largest absolute values, or of 1."""
    parts = {}
    for name, own, right in zip(Touch._fields, kernels, expected):
        own, right = np.asarray(own), np.asarray(right)
        assert own.shape == right.shape, name
        assert np.isfinite(own).all(), name
        if name == "gap_mm":  # of bodies that cannot touch it only says that they are far away
            assert (own[:, ~found.can_touch] > 300.0).all()
            own, right = own[:, found.can_touch], right[:, found.can_touch]
        parts[name] = float(np.abs(own - right).max() / max(np.abs(right).max(), 1.0))
    return parts


@pytest.mark.parametrize("which", range(-1, len(SHAPES)))
@pytest.mark.parametrize("gel", [FastGel.phystac(), FastGel.phystac_tip()], ids=["phystac", "tip"])
def test_kernels_compute_what_arrays_compute(gel: FastGel, which: int) -> None:
    """Each shape alone (one body a sensor), and all of them together (-1)."""
    chosen = list(range(len(SHAPES))) if which < 0 else [which]
    found = scene_of(gel, [SHAPES[number] for number in chosen])
    motion = Motion(found, chosen, seed=1 + which)
    gels = WarpGels(found, gel, N_WORLDS, "cpu")
    touch = gels.touch()
    time_s = np.zeros(N_WORLDS, np.float32)
    memory: Memory = begin(found, motion.poses(0), time_s)
    gels.begin(wp.array(time_s, dtype=float, device="cpu"))
    is_reset = np.arange(N_WORLDS) % 3 == 0
    slips = touches = 0.0
    # Some times come twice; once the time of some worlds goes back, and once some are released.
    for step, moment_number in enumerate((0, 1, 2, 2, 3, 4, 4, 5, 6, 7)):
        time_s = np.full(N_WORLDS, STEP_S * moment_number, np.float32)
        if step == 5:
            time_s[is_reset] = 0.5 * STEP_S
        if step == 8:
            memory = forget(memory, ~is_reset)
            gels.forget(torch.tensor(~is_reset))
        poses = motion.poses(step)
        memory, expected = moment(found, memory, poses, time_s)
        gels.tell_time(wp.array(time_s, dtype=float, device="cpu"))
        gels.launch(on_device(poses))
        # Positions in the world are known to 0.1 µm.
        limits = {"pressure_kpa": 2e-5, "wrench": 3e-5, "gap_mm": 2e-5, "slip_mm_per_s": 3e-4, "push": 1e-4}
        for name, part in differ(found, touch, expected).items():
            assert part < limits[name], (step, name, part)
        slips = max(slips, float(np.abs(expected.slip_mm_per_s).max()))
        touches = max(touches, float(np.abs(expected.pressure_kpa).max()))
    assert touches > 3.0 and slips > 10.0


@pytest.mark.parametrize("n_bodies", [1, 2])
@pytest.mark.parametrize("gel", [FastGel.phystac(), FastGel.phystac_tip()], ids=["phystac", "tip"])
def test_thin_meshes_at_all_depths_read_what_rust_reads(gel: FastGel, n_bodies: int) -> None:
    plate, needle = CUBE * [1.3, 1.0, 0.1], CUBE * [0.3, 0.25, 1.0]
    shapes = [Shape.surface(plate, CUBES), Shape.surface(needle, CUBES), Shape.ring(5.0, 4.3, 4.0, 0.2), Shape.wedge(1.2, 14.0, 12.0, 0.5), Shape.triangle(12.0, 2.0, 0.2)]
    rng = np.random.default_rng(n_bodies)
    n = 400
    top_mm = arrays.load(gel).center_mm[2]
    lowest_mm = top_mm - rng.uniform(-0.2, 4.5, (n, n_bodies))
    position_mm = np.concatenate([rng.uniform(-7.0, 7.0, (n, n_bodies, 2)), lowest_mm[..., None]], axis=-1)
    quaternion = np.concatenate([0.1 * rng.normal(size=(n, n_bodies, 2)), rng.normal(size=(n, n_bodies, 1)), np.ones((n, n_bodies, 1))], axis=-1)
    quaternion /= np.linalg.norm(quaternion, axis=-1, keepdims=True)
    number = rng.integers(len(shapes), size=(n, n_bodies)).astype(np.int32)
    expected = Contacts(number, position_mm, quaternion).by_rust(gel, shapes)
    # Each world has all shapes, and those that are not in this contact are far away.
    geom_m = np.full((n, len(shapes) * n_bodies, 3), 1.0)
    geom_turn = np.tile(np.eye(3), (n, len(shapes) * n_bodies, 1, 1))
    rows, bodies = np.arange(n)[:, None], np.arange(n_bodies)
    geom_m[rows, number * n_bodies + bodies] = 1e-3 * position_mm
    geom_turn[rows, number * n_bodies + bodies] = arrays.rotation_of(quaternion)
    own = [from_samples(shape) for shape in shapes for _ in range(n_bodies)]
    n_geoms = len(own)
    places = Places(np.array([0]), np.arange(n_geoms), np.array([0]), 1 + np.arange(n_geoms), np.ones(1 + n_geoms, bool), np.arange(1 + n_geoms))
    gels = WarpGels(scene(places, own, gel, 0.0, 0.0, None, follows_thin=True), gel, n, "cpu")
    touch = gels.touch()
    gels.pass_time(STEP_S)
    still = np.zeros((n, 1, 3)), np.tile(np.eye(3), (n, 1, 1, 1))
    gels.launch(on_device(Poses(*(values.astype(np.float32) for values in (*still, geom_m, geom_turn, np.zeros((n, 1 + n_geoms, 3)))))))
    error_kpa = np.abs(np.asarray(touch.pressure_kpa)[:, 0] - expected[0]).max(axis=-1)
    # Where readings jump, rounding decides on which side of the jump a contact is.
    assert (error_kpa > 1e-4 * np.abs(expected[0]).max()).mean() < 0.005


def test_a_time_step_that_is_given_passes_as_one_that_is_told() -> None:
    chosen = [1, 0]
    found = scene_of(FastGel.phystac(), [SHAPES[number] for number in chosen])
    motion = Motion(found, chosen, seed=7)
    told, given = (WarpGels(found, None, N_WORLDS, "cpu") for _ in range(2))
    told.begin(wp.zeros(N_WORLDS, dtype=float, device="cpu"))
    of_told, of_given = told.touch(), given.touch()
    for step in range(1, 5):
        # Times that single precision knows exactly.
        told.tell_time(wp.full(N_WORLDS, step * 2.0**-10, dtype=float, device="cpu"))
        given.pass_time(2.0**-10)
        for gels in (told, given):
            gels.launch(on_device(motion.poses(step)))
    for own, other in zip(of_told, of_given):
        assert torch.equal(own, other)


def still(found: Scene, position_mm: Any) -> Poses:
    """Bodies, upright, at positions in the frame of a sensor at the origin, `[n_worlds, n_geoms, 3]`."""
    geom_m = 1e-3 * np.asarray(position_mm, np.float32)
    n_worlds, n_geoms, _ = geom_m.shape
    turn = np.eye(3, dtype=np.float32)
    rows = np.zeros((n_worlds, 1, 3), np.float32), np.tile(turn, (n_worlds, 1, 1, 1)), geom_m, np.tile(turn, (n_worlds, n_geoms, 1, 1))
    return Poses(*rows, np.zeros((n_worlds, 1 + n_geoms, 3), np.float32))


def one_sensor(shapes: list[arrays.Shapes]) -> Scene:
    n = len(shapes)
    places = Places(np.array([0]), np.arange(n), np.array([0]), 1 + np.arange(n), np.ones(1 + n, bool), np.arange(1 + n))
    return scene(places, shapes, None, 0.8, 0.005, None, follows_thin=True)


def test_the_gap_of_a_thin_mesh_is_its_distance_also_beside_the_gel() -> None:
    found = one_sensor([from_samples(Shape.surface(CUBE * [1.0, 1.0, 0.12], CUBES))])
    beside_mm = [[[x_mm, 0.0, 6.0]] for x_mm in (2000.0, 100.0, 25.0)]
    gels = WarpGels(found, None, 3, "cpu")
    touch = gels.touch()
    gels.pass_time(STEP_S)
    gels.launch(on_device(still(found, beside_mm)))
    expected = arrays.read(found.gel, found.shapes, np.array(beside_mm))
    assert touch.gap_mm[:, 0].numpy() == pytest.approx(expected.gap_mm, rel=1e-4)
    gels.launch(on_device(still(found, [[[0.0, 0.0, 6.0]]] * 3)))
    assert touch.gap_mm.numpy() == pytest.approx(6.0 - found.gel.center_mm[2], abs=0.1)


def test_a_pose_that_is_no_number_gives_no_numbers_in_its_world_alone() -> None:
    for place in range(3):
        found = one_sensor([SHAPES[1], SHAPES[0]])
        position_mm = np.tile([[0.0, 0.0, 9.0], [3.0, 2.0, 10.0]], (3, 1, 1))
        position_mm[1, 1, place] = np.nan
        gels = WarpGels(found, None, 3, "cpu")
        touch = gels.touch()
        gels.pass_time(STEP_S)
        gels.launch(on_device(still(found, position_mm)))
        assert all(torch.isnan(values).all() for values in (touch.pressure_kpa[1], touch.wrench[1], touch.gap_mm[1, :, 1]))
        for values in touch:
            assert torch.isfinite(values[[0, 2]]).all()


def test_no_time_replaces_the_last_step_and_time_that_goes_back_forgets() -> None:
    found = one_sensor([SHAPES[1]])
    used, fresh = (WarpGels(found, None, 1, "cpu") for _ in range(2))

    def at(gels: WarpGels, x_mm: float, step_s: float) -> Any:
        gels.pass_time(step_s)
        gels.launch(on_device(still(found, [[[x_mm, 0.0, 9.5]]])))
        return gels.touch().wrench[0, 0].clone()

    assert torch.isfinite(at(used, 0.0, 0.0)).all()
    at(used, 0.0, STEP_S)
    slid = at(used, 0.05, STEP_S)
    assert torch.equal(at(used, 0.05, 0.0), slid)
    forgotten = at(used, 0.05, -STEP_S)
    assert torch.equal(forgotten, at(fresh, 0.05, STEP_S)) and (slid - forgotten)[0].abs() > 0.01


def test_a_captured_step_of_mujoco_warp_is_the_step() -> None:
    mujoco = pytest.importorskip("mujoco", reason="MuJoCo 4 needs Python 3.11 or later")
    mujoco_warp = pytest.importorskip("mujoco_warp", reason="needs `pip install mujoco-warp`; its kernels take a minute to compile")
    from test_simulators import N_STEPS, WEIGHT_N, palm

    from twintac.simulators.mujoco_warp import Sensors

    model = palm()
    host = mujoco.MjData(model)
    mujoco.mj_forward(model, host)

    def start() -> tuple[Any, Any, Any]:
        on, data = mujoco_warp.put_model(model), mujoco_warp.put_data(model, host, nworld=2)
        sensors = Sensors(model, data, ["touch"], geoms=["block"])
        on.callback.control = sensors
        mujoco_warp.step(on, data)
        return on, data, sensors

    on, data, captured = start()
    with wp.ScopedCapture(device="cpu") as capture:
        mujoco_warp.step(on, data)
    for _ in range(N_STEPS - 1):
        wp.capture_launch(capture.graph)
    on, other, direct = start()
    for _ in range(N_STEPS - 1):
        mujoco_warp.step(on, other)
    assert data.time.numpy() == pytest.approx(other.time.numpy())
    assert torch.equal(captured.touch.pressure_kpa, direct.touch.pressure_kpa)
    assert np.asarray(-captured.touch.wrench[:, 0, 2]) == pytest.approx([WEIGHT_N] * 2, rel=0.01)
