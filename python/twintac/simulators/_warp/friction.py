"""Friction and damping of bodies on gels, as `arrays._friction` describes them."""

from typing import Any

import numpy as np
import warp as wp

from ... import arrays
from ...arrays import _friction
from ...arrays._contact import REACH_MM

wp.set_module_options({"enable_backward": False})

_CARRYING, _CHANGE = _friction.CARRYING, _friction.CHANGE
_THINNEST, _LEAST_RADIUS_MM = _friction.THINNEST, _friction.LEAST_RADIUS_MM
_ARM_OF_RADIUS, _STEP = _friction.ARM_OF_RADIUS, _friction.STEP
_PI = float(np.pi)

# What a time does to the state of a world: time has gone on, is the same, or has gone back.
_GOES_ON, _STAYS, _GOES_BACK = range(3)


@wp.struct
class Layer:
    """The gel as an elastic layer, with the points of its first grid."""

    coefficient: float
    retardation_s: float
    shear_modulus_n_per_mm2: float
    poissons_ratio: float
    height_mm: float
    area_mm2: float
    center_mm: wp.vec3
    point_height_mm: wp.array[float]
    way: wp.array2d[wp.vec2]
    away_mm: wp.array2d[float]
    kernel: wp.array[float]


@wp.struct
class Held:
    """The state of friction and damping, `[n_worlds, n_sensors, n_geoms]`."""

    is_held: wp.array3d[bool]
    position_mm: wp.array3d[wp.vec3]
    rotation: wp.array3d[wp.mat33]
    force_n: wp.array3d[wp.vec2]
    torque_n_mm: wp.array3d[float]
    is_known: wp.array3d[bool]
    elastic: wp.array3d[wp.spatial_vector]


@wp.struct
class Foot:
    """The area in which the gel carries each body, `[n_worlds, n_sensors, n_geoms]`."""

    deepest: wp.array3d[float]
    n_points: wp.array3d[float]
    thickness_mm: wp.array3d[float]


def layer(gel: arrays.Gel, friction: arrays.Friction, device: Any) -> Layer:
    """A gel and its friction of NumPy, on a device."""
    found = Layer()
    for name in ("coefficient", "retardation_s", "shear_modulus_n_per_mm2", "poissons_ratio"):
        setattr(found, name, float(getattr(friction, name)))
    found.height_mm, found.area_mm2 = float(friction.height_mm), float(friction.area_mm2)
    found.center_mm = wp.vec3(*gel.center_mm.tolist())
    n_points = friction.away_mm.shape[1]
    heights_mm = np.ascontiguousarray(gel.points_mm[2, :n_points])
    found.point_height_mm = wp.array(heights_mm, dtype=float, device=device)
    way = np.ascontiguousarray(np.moveaxis(friction.way, 0, -1))
    found.way = wp.array(way, dtype=wp.vec2, device=device)
    found.away_mm = wp.array(friction.away_mm, dtype=float, device=device)
    found.kernel = wp.array(friction.kernel, dtype=float, device=device)
    return found


def held(shape: tuple[int, int, int], device: Any) -> Held:
    """Gels that hold nothing."""
    found = Held()
    kinds = {
        "is_held": bool,
        "position_mm": wp.vec3,
        "rotation": wp.mat33,
        "force_n": wp.vec2,
        "torque_n_mm": float,
        "is_known": bool,
        "elastic": wp.spatial_vector,
    }
    for name, kind in kinds.items():
        setattr(found, name, wp.zeros(shape, dtype=kind, device=device))
    return found


def foot(shape: tuple[int, int, int], device: Any) -> Foot:
    """No contact yet."""
    found = Foot()
    for name in ("deepest", "n_points", "thickness_mm"):
        setattr(found, name, wp.zeros(shape, dtype=float, device=device))
    return found


@wp.kernel
def tell_time(
    now_s: wp.array[float],
    time_s: wp.array[float],
    passed_s: wp.array[float],
    turn: wp.array[int],
) -> None:
    """Compares the simulator's time, `[n_worlds]`, with that of the last call."""
    w = wp.tid()
    _pass(now_s[w] - time_s[w], w, passed_s, turn)
    time_s[w] = now_s[w]


@wp.kernel
def pass_time(step_s: float, passed_s: wp.array[float], turn: wp.array[int]) -> None:
    """Lets a time step pass in all worlds."""
    w = wp.tid()
    _pass(step_s, w, passed_s, turn)


@wp.func
def _pass(step_s: float, w: int, passed_s: wp.array[float], turn: wp.array[int]) -> None:
    turn[w] = _STAYS
    if step_s > 0.0:
        turn[w] = _GOES_ON
        passed_s[w] = step_s
    if step_s < 0.0:
        turn[w] = _GOES_BACK


@wp.kernel
def forget(chosen: wp.array[bool], before: Held, now: Held) -> None:
    """Releases all bodies in the chosen worlds."""
    w, s, g = wp.tid()
    if chosen[w]:
        _release(before, w, s, g)
        _release(now, w, s, g)


@wp.func
def _release(held: Held, w: int, s: int, g: int) -> None:
    held.is_held[w, s, g] = False
    held.is_known[w, s, g] = False
    held.force_n[w, s, g] = wp.vec2(0.0, 0.0)
    held.torque_n_mm[w, s, g] = 0.0


@wp.kernel
def step_on(layer: Layer, share: wp.array4d[wp.vec3], foot: Foot) -> None:
    """Finds the area in which the gel carries each body."""
    w, s, g = wp.tid()
    deepest, height_mm = float(-1.0), float(0.0)
    for p in range(layer.point_height_mm.shape[0]):
        depth = share[w, s, g, p][0] - 1.0
        # Of points that are equally deep, the last one counts.
        if depth >= deepest:
            deepest = depth
            height_mm = layer.point_height_mm[p]
    n_points = float(0.0)
    if deepest > 0.0:
        for p in range(layer.point_height_mm.shape[0]):
            n_points += _part(share[w, s, g, p][0], deepest)
    foot.deepest[w, s, g] = deepest
    foot.n_points[w, s, g] = n_points
    left_mm = height_mm - deepest * REACH_MM
    foot.thickness_mm[w, s, g] = wp.max(left_mm, _THINNEST * height_mm)


@wp.func
def _part(share: float, deepest: float) -> float:
    """Fraction of its area with which a point carries a body."""
    return wp.clamp(((share - 1.0) / deepest - _CARRYING) / _CHANGE + 0.5, 0.0, 1.0)


@wp.kernel
def hold(
    layer: Layer,
    foot: Foot,
    turn: wp.array[int],
    passed_s: wp.array[float],
    position_mm: wp.array3d[wp.vec3],
    rotation: wp.array3d[wp.mat33],
    together: wp.array4d[float],
    apart: wp.array4d[float],
    broken: wp.array3d[float],
    before: Held,
    now: Held,
    wrench: wp.array3d[wp.spatial_vector],
    slip_mm_per_s: wp.array3d[wp.vec2],
    gap_mm: wp.array3d[float],
) -> None:
    """Friction and damping of each body: the new state, the wrench with both, and the slip."""
    w, s, g = wp.tid()
    if turn[w] == _GOES_ON:
        before.is_held[w, s, g] = now.is_held[w, s, g]
        before.position_mm[w, s, g] = now.position_mm[w, s, g]
        before.rotation[w, s, g] = now.rotation[w, s, g]
        before.force_n[w, s, g] = now.force_n[w, s, g]
        before.torque_n_mm[w, s, g] = now.torque_n_mm[w, s, g]
        before.is_known[w, s, g] = now.is_known[w, s, g]
        before.elastic[w, s, g] = now.elastic[w, s, g]
    if turn[w] == _GOES_BACK:
        _release(before, w, s, g)
    elastic = _share_of_body(together, apart, w, s, g)
    touches = foot.deepest[w, s, g] > 0.0
    holds = touches and elastic[2] < 0.0
    force_n, torque_n_mm, slip_mm = wp.vec2(0.0, 0.0), float(0.0), wp.vec2(0.0, 0.0)
    if not touches:
        elastic = wp.spatial_vector()
    if holds:
        x_mm, y_mm = -elastic[4] / elastic[2], elastic[3] / elastic[2]
        radius_mm = wp.sqrt(layer.area_mm2 * foot.n_points[w, s, g] / _PI)
        radius_mm = wp.max(radius_mm, _LEAST_RADIUS_MM)
        along = 8.0 * layer.shear_modulus_n_per_mm2 * radius_mm / (2.0 - layer.poissons_ratio)
        along = along * (1.0 + 0.5 * radius_mm / layer.height_mm)
        if before.is_held[w, s, g]:
            about = 16.0 / 3.0 * layer.shear_modulus_n_per_mm2 * radius_mm * radius_mm * radius_mm
            origin_mm, own = position_mm[w, s, g], rotation[w, s, g]
            origin_before_mm, own_before = before.position_mm[w, s, g], before.rotation[w, s, g]
            place_mm = layer.center_mm + wp.vec3(x_mm, y_mm, 0.0)
            turned = own * wp.transpose(own_before)
            moved_mm = turned * (place_mm - origin_before_mm) + origin_mm - place_mm
            force_n = before.force_n[w, s, g] + along * wp.vec2(moved_mm[0], moved_mm[1])
            torque_n_mm = before.torque_n_mm[w, s, g] + about * _turned_rad(turned)
        limit_n = layer.coefficient * wp.length(wp.vec3(elastic[0], elastic[1], elastic[2]))
        arm_n = torque_n_mm / (_ARM_OF_RADIUS * radius_mm)
        needed_n = wp.length(wp.vec3(force_n[0], force_n[1], arm_n))
        kept = float(1.0)
        if needed_n > limit_n:
            kept = limit_n / needed_n
        slip_mm = (1.0 - kept) / along * force_n
        force_n, torque_n_mm = kept * force_n, kept * torque_n_mm
        elastic[0] += force_n[0]
        elastic[1] += force_n[1]
        elastic[5] += x_mm * force_n[1] - y_mm * force_n[0] + torque_n_mm
    lossy = elastic
    if before.is_known[w, s, g]:
        rate = (elastic - before.elastic[w, s, g]) / passed_s[w]
        lossy = elastic + layer.retardation_s * rate
    if lossy[2] > 0.0:  # a gel does not adhere
        lossy = wp.spatial_vector()
    no = broken[w, s, g]
    wrench[w, s, g] = lossy + wp.spatial_vector(no, no, no, no, no, no)
    slip_mm_per_s[w, s, g] = slip_mm / passed_s[w] + wp.vec2(no, no)
    gap_mm[w, s, g] += no
    now.is_held[w, s, g] = holds
    now.position_mm[w, s, g] = position_mm[w, s, g]
    now.rotation[w, s, g] = rotation[w, s, g]
    now.force_n[w, s, g] = force_n
    now.torque_n_mm[w, s, g] = torque_n_mm
    now.is_known[w, s, g] = True
    now.elastic[w, s, g] = elastic


@wp.func
def _share_of_body(
    together: wp.array4d[float], apart: wp.array4d[float], w: int, s: int, g: int
) -> wp.spatial_vector:
    """The wrench of all bodies, divided among them in proportion to their wrenches when each presses
    alone.
    """
    part = float(1.0)
    n_bodies = apart.shape[2]
    if n_bodies > 1:
        sum_n = float(0.0)
        for body in range(n_bodies):
            sum_n += apart[w, s, body, 2]
        if sum_n < 0.0:
            part = together[w, s, 0, 2] / sum_n
    found = wp.spatial_vector()
    for axis in range(6):
        found[axis] = part * apart[w, s, g, axis]
    return found


@wp.func
def _turned_rad(turned: wp.mat33) -> float:
    """Rotation about the vertical."""
    # The axis of the rotation, multiplied by twice the sine of the angle, and twice the cosine.
    sines = wp.vec3(
        turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]
    )
    sine = wp.length(sines)
    if sine <= 1e-6:
        return 0.5 * sines[2]
    return sines[2] * wp.atan2(sine, wp.trace(turned) - 1.0) / sine


@wp.kernel
def pull(
    layer: Layer,
    foot: Foot,
    share: wp.array4d[wp.vec3],
    now: Held,
    pressed_kpa: wp.array4d[float],
    broken: wp.array3d[float],
    pressure_kpa: wp.array3d[float],
) -> None:
    """Adds the pressures at the ports due to friction along the surface to those of the presses."""
    w, s, t = wp.tid()
    pressure = pressed_kpa[w, s, 0, t]
    n_entries = layer.kernel.shape[0]
    for g in range(share.shape[2]):
        pressure += broken[w, s, g]
        deepest, force_n = foot.deepest[w, s, g], now.force_n[w, s, g]
        if deepest > 0.0 and wp.length_sq(force_n) > 0.0:
            height_mm = foot.thickness_mm[w, s, g]
            felt = float(0.0)
            for p in range(layer.point_height_mm.shape[0]):
                part = _part(share[w, s, g, p][0], deepest)
                entry = layer.away_mm[t, p] / (_STEP * height_mm)
                if part > 0.0 and entry < float(n_entries) - 1.0:
                    low = wp.min(int(entry), n_entries - 2)
                    value = wp.lerp(layer.kernel[low], layer.kernel[low + 1], entry - float(low))
                    felt += part * wp.dot(layer.way[t, p], force_n) * value
            # N/mm² = 1000 kPa
            pressure += 1000.0 * felt / (foot.n_points[w, s, g] * height_mm * height_mm)
    pressure_kpa[w, s, t] = pressure
