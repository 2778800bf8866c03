"""One time step of all sensors of all worlds: from poses to readings and forces on bodies, as a
pure function of arrays.
"""

from typing import Any, NamedTuple

from .. import arrays
from ..arrays._namespace import Array, namespace
from ._scene import Scene

# Where a body that cannot touch is put, along each axis, mm.
AWAY_MM = 1000.0


class Poses(NamedTuple):
    """Poses of sites, geoms and bodies in the world, m, with any leading dimensions."""

    site_m: Array
    """Positions of the sites, `[..., n_sites, 3]`."""
    site_rotation: Array
    """Rotation matrices of the sites, `[..., n_sites, 3, 3]`."""
    geom_m: Array
    """Positions of the geoms, `[..., n_geoms, 3]`."""
    geom_rotation: Array
    """Rotation matrices of the geoms, `[..., n_geoms, 3, 3]`."""
    middle_m: Array
    """Centres of mass of the bodies, reference points of torques, `[..., n_bodies, 3]`."""


class Memory(NamedTuple):
    """The state of friction and damping of the gels of all worlds: the result of `begin` and
    `moment`.
    """

    time_s: Array
    """The simulator's time of `now`, s, `[...]`."""
    passed_s: Array
    """Time from `before` to `now`, s, `[...]`."""
    before: arrays.Held
    """The state of the gels one time step before `now`."""
    now: arrays.Held
    """The state of the gels at `time_s`."""


class Touch(NamedTuple):
    """The output of the sensors of all worlds at a time. All numbers are `simulated`."""

    pressure_kpa: Array
    """Pressure at each port, kPa, `[..., n_sensors, n_taxels]`."""
    wrench: Array
    """Force on each gel, N, and torque about the centre of the top of the gel's bounding box, N mm,
    in the gel's frame, `[..., n_sensors, 6]`.
    """
    gap_mm: Array
    """Distance of each geom from each gel, mm, negative inside the gel,
    `[..., n_sensors, n_geoms]`.
    """
    slip_mm_per_s: Array
    """How fast each geom slips over each gel, mm/s, along x and y of the gel, `[..., n_sensors,
    n_geoms, 2]`."""
    push: Array
    """Force, N, and torque about the centre of mass, N m, on each body of `Scene.body`, along the
    axes of the world, `[..., n_bodies, 6]`.
    """


def begin(scene: Scene, poses: Poses, time_s: Array) -> Memory:
    """The initial state of the gels, in as many worlds as there are poses."""
    xp = namespace("gel", scene.gel.points_mm)
    position_mm, _ = _relative(xp, scene, poses)
    nothing = arrays.held(scene.gel, position_mm)
    time_s = xp.astype(time_s, nothing.force_n.dtype) + 0.0 * nothing.torque_n_mm[..., 0, 0]
    # No time has passed yet, so the first time step follows an empty state.
    return Memory(time_s - 1.0, xp.ones_like(time_s), nothing, nothing)


def moment(scene: Scene, memory: Memory, poses: Poses, time_s: Array) -> tuple[Memory, Touch]:
    """The new state and the output of the gels at poses. A call with the time of the previous call
    replaces that time step, with the new poses: a repeated call with the same poses changes
    nothing. Where time has gone back, the gels start anew.
    """
    xp = namespace("gel", scene.gel.points_mm)
    position_mm, rotation = _relative(xp, scene, poses)
    time_s = xp.astype(time_s, memory.time_s.dtype) + 0.0 * memory.time_s
    goes_on, goes_back = time_s > memory.time_s, time_s < memory.time_s
    nothing = arrays.held(scene.gel, position_mm)
    before = arrays.select(
        goes_back, nothing, arrays.select(goes_on, memory.now, memory.before)
    )
    passed_s = xp.where(goes_on, time_s - memory.time_s, memory.passed_s)
    now, reading = arrays.step(
        scene.gel, scene.friction, before, passed_s[..., None], scene.shapes, position_mm, rotation
    )
    touch = Touch(
        reading.pressure_kpa,
        reading.wrench,
        reading.gap_mm,
        reading.slip_mm_per_s,
        _push(xp, scene, poses, reading.wrench_of_bodies),
    )
    return Memory(time_s, passed_s, before, now), touch


def forget(memory: Memory, chosen: Array) -> Memory:
    """The same state, with the gels of the chosen worlds (a mask, `[...]`) reset."""
    xp = namespace("chosen", chosen)
    before, now = (
        arrays.select(chosen, arrays.Held(*(xp.zeros_like(part) for part in own)), own)
        for own in (memory.before, memory.now)
    )
    return memory._replace(before=before, now=now)


def _relative(xp: Any, scene: Scene, poses: Poses) -> tuple[Array, Array]:
    """Poses of the geoms in the frames of the gels: positions, mm, `[..., n_sensors, n_geoms, 3]`,
    and rotation matrices.
    """
    position_mm, rotation = arrays.gel_from_body(
        xp.take(poses.site_m, scene.site, axis=-2),
        xp.take(poses.site_rotation, scene.site, axis=-3),
        xp.take(poses.geom_m, scene.geom, axis=-2)[..., None, :, :],
        xp.take(poses.geom_rotation, scene.geom, axis=-3)[..., None, :, :, :],
    )
    return xp.where(scene.can_touch[..., None], position_mm, AWAY_MM), rotation


def _push(xp: Any, scene: Scene, poses: Poses, wrench: Array) -> Array:
    """The wrenches on bodies, from the wrench of each geom on each gel,
    `[..., n_sensors, n_geoms, 6]`.
    """
    wrench = xp.where(scene.can_touch[..., None], wrench, 0.0)
    turn = xp.take(poses.site_rotation, scene.site, axis=-3)
    force_n = _turned(turn, wrench[..., :3])
    torque_n_m = 1e-3 * _turned(turn, wrench[..., 3:])
    origin_m = xp.take(poses.site_m, scene.site, axis=-2)
    top_m = origin_m + 1e-3 * _turned(turn, scene.gel.center_mm[None, None, :])[..., 0, :]
    of_geom = xp.take(poses.middle_m, scene.body_of_geom, axis=-2)
    of_sensor = xp.take(poses.middle_m, scene.body_of_sensor, axis=-2)
    lever_m = top_m[..., :, None, :] - of_geom[..., None, :, :]
    on_geom = xp.concat([force_n, torque_n_m + _cross(xp, lever_m, force_n)], axis=-1)
    on_geom = -xp.sum(on_geom, axis=-3)
    force_n, torque_n_m = xp.sum(force_n, axis=-2), xp.sum(torque_n_m, axis=-2)
    torque_n_m = torque_n_m + _cross(xp, top_m - of_sensor, force_n)
    on_sensor = xp.concat([force_n, torque_n_m], axis=-1)
    return _summed(xp, on_geom, scene.geom_is_of) + _summed(xp, on_sensor, scene.sensor_is_of)


def _turned(turn: Array, vector: Array) -> Array:
    """Vectors `[..., n_sensors, n, 3]`, rotated by matrices `[..., n_sensors, 3, 3]`, without a
    matrix product, which some devices round.
    """
    columns = [turn[..., :, axis][..., None, :] * vector[..., axis, None] for axis in range(3)]
    turned: Array = columns[0] + columns[1] + columns[2]
    return turned


def _cross(xp: Any, a: Array, b: Array) -> Array:
    after = [(1, 2), (2, 0), (0, 1)]
    parts = [a[..., i] * b[..., j] - a[..., j] * b[..., i] for i, j in after]
    return xp.stack(parts, axis=-1)


def _summed(xp: Any, wrench: Array, is_of: Array) -> Array:
    """Sums `[..., n_bodies, 6]` of `[..., n, 6]`."""
    return xp.sum(wrench[..., :, None, :] * is_of[..., None], axis=-3)
