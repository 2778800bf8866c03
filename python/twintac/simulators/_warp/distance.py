"""Signed distances to bodies, as `arrays._distance` and `arrays._samples` describe them."""

from typing import Any

import numpy as np
import warp as wp

from ...arrays import _distance, _samples
from ...arrays._contact import REACH_MM
from ...arrays._shapes import Shapes

wp.set_module_options({"enable_backward": False})

_BALL, _BOX, _CYLINDER, _ELLIPSOID, _PLANE, _SAMPLED = range(6)
_SIDE, _TOP = _distance.LOOKS_UP
_MORE, _THIN_MM, _THICK_MM = _distance.MORE, _distance.THIN_MM, _distance.THICK_MM
_TINY, _N_STEPS = _distance.TINY, _distance.N_STEPS


@wp.struct
class Bodies:
    """The shapes of bodies, `[n_bodies]`."""

    kind: wp.array[int]
    half_mm: wp.array[wp.vec3]
    grown_mm: wp.array[float]
    middle_mm: wp.array[wp.vec3]
    samples_mm: wp.array[float]
    first: wp.array[int]
    n_cells: wp.array[wp.vec3i]
    low_mm: wp.array[wp.vec3]
    cells_per_mm: wp.array[wp.vec3]


def bodies(shapes: Shapes, device: Any) -> Bodies:
    """Shapes of NumPy, `[n_bodies]`, on a device."""
    kind = np.full(shapes.grown_mm.shape, _BALL, np.int32)
    masks = (shapes.is_box, shapes.is_cylinder, shapes.is_ellipsoid, shapes.is_plane, shapes.is_sampled)
    for number, mask in enumerate(masks, _BOX):
        if mask is not None:
            kind[mask] = number
    samples = _samples.one_cell(kind.shape) if shapes.samples is None else shapes.samples
    found = Bodies()
    found.kind = wp.array(kind, dtype=int, device=device)
    found.half_mm = wp.array(shapes.half_mm, dtype=wp.vec3, device=device)
    found.grown_mm = wp.array(shapes.grown_mm, dtype=float, device=device)
    found.middle_mm = wp.array(shapes.middle_mm, dtype=wp.vec3, device=device)
    found.samples_mm = wp.array(samples.distance_mm, dtype=float, device=device)
    found.first = wp.array(samples.first, dtype=int, device=device)
    found.n_cells = wp.array(samples.n_cells, dtype=wp.vec3i, device=device)
    found.low_mm = wp.array(samples.low_mm, dtype=wp.vec3, device=device)
    found.cells_per_mm = wp.array(samples.cells_per_mm, dtype=wp.vec3, device=device)
    return found


@wp.func
def distance_mm(
    bodies: Bodies, body: int, point_mm: wp.vec3, up: wp.vec3, is_open: float
) -> float:
    """The distance of a point, in the body's frame, to the body; `up` is the gel's z axis there, and
    `is_open` is 1 where the body is extended above its top, else 0.
    """
    kind = bodies.kind[body]
    half_mm, grown_mm = bodies.half_mm[body], bodies.grown_mm[body]
    own_mm = point_mm - bodies.middle_mm[body]
    if kind == _BOX:
        return _box_mm(half_mm, grown_mm, own_mm, up, is_open)
    if kind == _CYLINDER:
        return _cylinder_mm(half_mm, grown_mm, own_mm, up, is_open)
    if kind == _ELLIPSOID:
        return _ellipsoid_mm(half_mm, own_mm, up, is_open)
    if kind == _PLANE:
        return own_mm[2]
    if kind == _SAMPLED:
        return _sampled_mm(bodies, body, point_mm)
    above_mm = is_open * wp.max(wp.dot(own_mm, up), 0.0)
    return wp.length(own_mm - above_mm * up) - grown_mm


@wp.func
def is_behind(
    bodies: Bodies, body: int, base_mm: wp.vec3, up: wp.vec3, is_open: float
) -> bool:
    """Whether a body that reaches below the base of the gel is below this point of the base."""
    kind = bodies.kind[body]
    if kind == _PLANE:
        return up[2] >= 0.0
    if kind == _SAMPLED or is_open == 0.0:
        return False
    half_mm, grown_mm = bodies.half_mm[body], bodies.grown_mm[body]
    own_mm = base_mm - bodies.middle_mm[body]
    if kind == _BOX:
        tops = _tops(half_mm, grown_mm, up)
        return wp.dot(wp.cw_mul(_lowest(half_mm, tops), own_mm), _signs(up)) > 0.0
    if kind == _CYLINDER:
        if _top(wp.abs(up[2]), 2.0 * (half_mm[2] + grown_mm)) > 0.0:
            return own_mm[2] * _sign(up[2]) > 0.0
        side = _top(wp.length(wp.vec2(up[0], up[1])), 2.0 * (half_mm[0] + grown_mm))
        return side > 0.0 and own_mm[0] * up[0] + own_mm[1] * up[1] > 0.0
    return wp.dot(own_mm, up) > 0.0


@wp.func
def is_plane(bodies: Bodies, body: int) -> bool:
    """Whether a body is a half-space, which is nowhere thin and ends nowhere."""
    return bodies.kind[body] == _PLANE


@wp.func
def _box_mm(
    half_mm: wp.vec3, grown_mm: float, own_mm: wp.vec3, up: wp.vec3, is_open: float
) -> float:
    height, sign = wp.abs(up), _signs(up)
    tops = is_open * _tops(half_mm, grown_mm, up)
    main = _lowest(half_mm, tops)
    upright = wp.dot(height, main)
    slope = wp.dot(tops, main) / wp.where(upright > 0.0, upright, 1.0)
    over_mm = wp.dot(main, wp.cw_mul(own_mm, sign) - half_mm)
    beyond_mm = wp.vec3(0.0, 0.0, 0.0)
    for i in range(3):
        above_mm = wp.max(2.0 * tops[i] * sign[i] * own_mm[i], 0.0)
        lean = (1.0 - main[i]) * height[i] * slope
        beside_mm = (lean * over_mm - own_mm[i] * sign[i] - half_mm[i]) / wp.sqrt(lean * lean + 1.0)
        beyond_mm[i] = wp.max(wp.abs(own_mm[i]) - half_mm[i] - above_mm, beside_mm)
    return _over_sides_mm(beyond_mm) - grown_mm


@wp.func
def _cylinder_mm(
    half_mm: wp.vec3, grown_mm: float, own_mm: wp.vec3, up: wp.vec3, is_open: float
) -> float:
    height, sign = wp.abs(up[2]), _sign(up[2])
    flat, level = wp.vec2(own_mm[0], own_mm[1]), wp.vec2(up[0], up[1])
    aside = wp.length(level)
    way = level / wp.where(aside > 0.0, aside, 1.0)
    end = is_open * _top(height, 2.0 * (half_mm[2] + grown_mm))
    side = is_open * _top(aside, 2.0 * (half_mm[0] + grown_mm))
    flat = flat - side * wp.max(wp.dot(flat, way), 0.0) * way
    above_mm = wp.abs(own_mm[2]) - half_mm[2] - wp.max(2.0 * end * sign * own_mm[2], 0.0)
    slope = end / wp.where(height > 0.0, height, 1.0)
    leaning = flat - slope * wp.max(sign * own_mm[2] - half_mm[2], 0.0) * level
    beside_mm = wp.max(wp.length(flat), wp.length(leaning)) - half_mm[0]
    inside_mm = wp.min(wp.min(beside_mm, above_mm), 0.0)  # there are two kinds of sides, not three
    return _over_sides_mm(wp.vec3(beside_mm, above_mm, inside_mm)) - grown_mm


@wp.func
def _ellipsoid_mm(half_mm: wp.vec3, own_mm: wp.vec3, up: wp.vec3, is_open: float) -> float:
    bent = wp.cw_div(up, wp.cw_mul(half_mm, half_mm))
    above_mm = is_open * wp.max(wp.dot(own_mm, bent) / wp.dot(up, bent), 0.0)
    away_mm = wp.abs(own_mm - above_mm * up)
    least_mm = wp.min(half_mm)
    reach_mm2, over_mm2 = wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0)
    for i in range(3):
        reach_mm2[i] = half_mm[i] * (away_mm[i] + _TINY * least_mm)
        over_mm2[i] = half_mm[i] * half_mm[i] - least_mm * least_mm
    shift = wp.max(reach_mm2 - over_mm2)
    for _ in range(_N_STEPS):
        length2, slope = float(0.0), float(0.0)
        for i in range(3):
            part = reach_mm2[i] / (shift + over_mm2[i])
            length2 += part * part
            slope += part * part / (shift + over_mm2[i])
        shift += (wp.sqrt(length2) - 1.0) * length2 / slope
    normal2 = float(0.0)
    for i in range(3):
        part = reach_mm2[i] / (half_mm[i] * (shift + over_mm2[i]))
        normal2 += part * part
    return (shift - least_mm * least_mm) * wp.sqrt(normal2)


@wp.func
def sampled_mm(bodies: Bodies, body: int, point_mm: wp.vec3) -> float:
    """The distance by the samples alone: the reach where there are none."""
    for i in range(3):
        cells = (point_mm[i] - bodies.low_mm[body][i]) * bodies.cells_per_mm[body][i]
        if cells < 0.0 or cells >= float(bodies.n_cells[body][i]):
            return REACH_MM
    return _sampled_mm(bodies, body, point_mm)


@wp.func
def _sampled_mm(bodies: Bodies, body: int, point_mm: wp.vec3) -> float:
    n_cells, per_mm = bodies.n_cells[body], bodies.cells_per_mm[body]
    corner = wp.vec3i(0, 0, 0)
    part, beyond_mm = wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0)
    for i in range(3):
        cells = (point_mm[i] - bodies.low_mm[body][i]) * per_mm[i]
        inside = wp.clamp(cells, 0.0, float(n_cells[i]))
        whole = wp.min(wp.floor(inside), float(n_cells[i]) - 1.0)
        corner[i] = int(whole)
        part[i] = inside - whole
        beyond_mm[i] = (cells - inside) / per_mm[i]
    along_y = n_cells[2] + 1
    along_x = along_y * (n_cells[1] + 1)
    at = bodies.first[body] + corner[0] * along_x + corner[1] * along_y + corner[2]
    low = wp.lerp(
        _between(bodies.samples_mm, at, part[2]),
        _between(bodies.samples_mm, at + along_y, part[2]),
        part[1],
    )
    high = wp.lerp(
        _between(bodies.samples_mm, at + along_x, part[2]),
        _between(bodies.samples_mm, at + along_x + along_y, part[2]),
        part[1],
    )
    return wp.lerp(low, high, part[0]) + wp.length(beyond_mm)


@wp.func
def _between(values: wp.array[float], at: int, part: float) -> float:
    return wp.lerp(values[at], values[at + 1], part)


@wp.func
def _over_sides_mm(beyond_mm: wp.vec3) -> float:
    outside_mm = wp.length(wp.max(beyond_mm, wp.vec3(0.0, 0.0, 0.0)))
    return outside_mm + wp.min(wp.max(beyond_mm), 0.0)


@wp.func
def _tops(half_mm: wp.vec3, grown_mm: float, up: wp.vec3) -> wp.vec3:
    tops = wp.vec3(0.0, 0.0, 0.0)
    for i in range(3):
        tops[i] = _top(wp.abs(up[i]), 2.0 * (half_mm[i] + grown_mm))
    return tops


@wp.func
def _top(height: float, thick_mm: float) -> float:
    thick = wp.clamp((thick_mm - _THIN_MM) / (_THICK_MM - _THIN_MM), 0.0, 1.0)
    part = wp.clamp((height - _SIDE - _MORE * thick) / (_TOP - _SIDE), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)


@wp.func
def _lowest(half_mm: wp.vec3, tops: wp.vec3) -> wp.vec3:
    least_mm, axis = float(wp.inf), int(-1)
    for i in range(3):
        if tops[i] > 0.0 and half_mm[i] < least_mm:
            least_mm = half_mm[i]
            axis = i
    found = wp.vec3(0.0, 0.0, 0.0)
    if axis >= 0:
        found[axis] = 1.0
    return found


@wp.func
def _signs(way: wp.vec3) -> wp.vec3:
    return wp.vec3(_sign(way[0]), _sign(way[1]), _sign(way[2]))


@wp.func
def _sign(value: float) -> float:
    return wp.where(value < 0.0, -1.0, 1.0)
