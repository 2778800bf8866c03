"""The input of the surrogate: for each point of the gel's surface, its distance to the bodies, as
`arrays._contact` describes it.
"""

from typing import Any

import numpy as np
import warp as wp

from ... import arrays
from ...arrays._contact import FAR_MM, REACH_MM
from .._moment import AWAY_MM
from .distance import Bodies, distance_mm, is_behind, is_plane
from .thin import Faces, is_thin

wp.set_module_options({"enable_backward": False})


@wp.struct
class Points:
    """The points of the surface at which distances are evaluated, `[n_points]`."""

    at_mm: wp.array[wp.vec3]
    levels_mm: wp.array[wp.vec3]
    deepest_mm: wp.array[float]
    highest_mm: wp.array[float]


def points(gel: arrays.Gel, device: Any) -> Points:
    """The points of a gel of NumPy, on a device."""
    n_points = gel.points_mm.shape[1]
    found = Points()
    found.at_mm = wp.array(np.ascontiguousarray(gel.points_mm.T), dtype=wp.vec3, device=device)
    found.levels_mm = wp.array(gel.levels_mm, dtype=wp.vec3, device=device)
    found.deepest_mm = wp.array(gel.deepest_mm[:, 0], dtype=float, device=device)
    highest_mm = np.broadcast_to(gel.highest_mm, (n_points,))
    found.highest_mm = wp.array(np.ascontiguousarray(highest_mm), dtype=float, device=device)
    return found


@wp.struct
class Box:
    """The box, along the gel's axes, that holds a body."""

    middle_mm: wp.vec3
    """Its middle, relative to the body's origin."""
    half_mm: wp.vec3
    thin_mm: float
    """Half of the smallest size of the body's own box."""


@wp.func
def box_of(bodies: Bodies, body: int, rotation: wp.mat33) -> Box:
    """The box of a body that is turned by this rotation."""
    grown_mm = bodies.grown_mm[body]
    size_mm = bodies.half_mm[body] + wp.vec3(grown_mm, grown_mm, grown_mm)
    half_mm = wp.vec3(0.0, 0.0, 0.0)
    for row in range(3):
        for column in range(3):
            half_mm[row] += wp.abs(rotation[row, column]) * size_mm[column]
    found = Box()
    found.middle_mm = rotation * bodies.middle_mm[body]
    found.half_mm = half_mm
    found.thin_mm = wp.min(size_mm)
    return found


@wp.func
def lowest_of(bodies: Bodies, body: int, position_mm: wp.vec3, rotation: wp.mat33) -> float:
    """Height of the lowest point of a body's box."""
    box = box_of(bodies, body, rotation)
    return position_mm[2] + box.middle_mm[2] - box.half_mm[2]


@wp.func
def share_of(distance_mm: wp.vec3, most_mm: float) -> wp.vec3:
    """The proximity at the distances of three levels: 0 at the reach and beyond, 1 at the surface."""
    share = wp.vec3(0.0, 0.0, 0.0)
    for level in range(3):
        share[level] = wp.max((REACH_MM - wp.max(distance_mm[level], -most_mm)) / REACH_MM, 0.0)
    return share


@wp.kernel
def place(
    site: wp.array[int],
    geom: wp.array[int],
    site_m: wp.array2d[wp.vec3],
    site_rotation: wp.array2d[wp.mat33],
    geom_m: wp.array2d[wp.vec3],
    geom_rotation: wp.array2d[wp.mat33],
    can_touch: wp.array2d[bool],
    position_mm: wp.array3d[wp.vec3],
    rotation: wp.array3d[wp.mat33],
    gap_mm: wp.array3d[float],
    broken: wp.array3d[float],
) -> None:
    """Poses of the geoms in the frames of the gels, and NaN instead of 0 where a pose is not finite:
    minima and maxima forget it. `[n_worlds, n_sensors, n_geoms]`.
    """
    w, s, g = wp.tid()
    turn = wp.transpose(site_rotation[w, site[s]])
    position_mm[w, s, g] = turn * (1000.0 * (geom_m[w, geom[g]] - site_m[w, site[s]]))
    rotation[w, s, g] = turn * geom_rotation[w, geom[g]]
    gap_mm[w, s, g] = AWAY_MM
    broken[w, s, g] = 0.0
    if can_touch[s, g]:
        gap_mm[w, s, g] = float(wp.inf)
        total = position_mm[w, s, g] + rotation[w, s, g] * wp.vec3(1.0, 1.0, 1.0)
        broken[w, s, g] = 0.0 * (total[0] + total[1] + total[2])


@wp.kernel
def approach(
    points: Points,
    faces: Faces,
    bodies: Bodies,
    can_touch: wp.array2d[bool],
    position_mm: wp.array3d[wp.vec3],
    rotation: wp.array3d[wp.mat33],
    share: wp.array4d[wp.vec3],
    gap_mm: wp.array3d[float],
) -> None:
    """The proximity of each body to each point, for the three levels,
    `[n_worlds, n_sensors, n_geoms, n_points]`; and the gap of each body. The
    proximity of thin bodies that are followed upward (`columns`) is left out.
    """
    w, s, g, p = wp.tid()
    share[w, s, g, p] = wp.vec3(0.0, 0.0, 0.0)
    if not can_touch[s, g]:
        return
    own = rotation[w, s, g]
    turn, origin_mm = wp.transpose(own), position_mm[w, s, g]
    up = wp.vec3(own[2, 0], own[2, 1], own[2, 2])
    box, away_mm = box_of(bodies, g, own), points.at_mm[p] - origin_mm
    lowest_mm = lowest_of(bodies, g, origin_mm, own)
    depth_mm = points.highest_mm[p] - lowest_mm
    if is_thin(faces, g, depth_mm, up):
        wp.atomic_min(gap_mm, w, s, g, distance_mm(bodies, g, turn * away_mm, up, 0.0))
        return
    is_open = wp.where(depth_mm > box.thin_mm, 1.0, 0.0)
    is_flat = is_plane(bodies, g)
    found_mm = wp.vec3(FAR_MM, FAR_MM, FAR_MM)
    base_mm = turn * wp.vec3(away_mm[0], away_mm[1], -origin_mm[2])
    if not ((is_flat or lowest_mm < 0.0) and is_behind(bodies, g, base_mm, up, is_open)):
        for level in range(3):
            height_mm = away_mm[2] + points.levels_mm[p][level]
            point_mm = turn * wp.vec3(away_mm[0], away_mm[1], height_mm)
            found_mm[level] = distance_mm(bodies, g, point_mm, up, is_open)
    wp.atomic_min(gap_mm, w, s, g, found_mm[0])
    is_above = is_flat or (
        wp.abs(away_mm[0] - box.middle_mm[0]) <= box.half_mm[0] + REACH_MM
        and wp.abs(away_mm[1] - box.middle_mm[1]) <= box.half_mm[1] + REACH_MM
    )
    if is_above and found_mm[0] < REACH_MM:
        share[w, s, g, p] = share_of(found_mm, points.deepest_mm[p])


@wp.kernel
def join(share: wp.array4d[wp.vec3], together: wp.array4d[wp.vec3]) -> None:
    """The proximity of the nearest body, `[n_worlds, n_sensors, 1, n_points]`."""
    w, s, p = wp.tid()
    nearest = wp.vec3(0.0, 0.0, 0.0)
    for g in range(share.shape[2]):
        nearest = wp.max(nearest, share[w, s, g, p])
    together[w, s, 0, p] = nearest


@wp.kernel
def touch(
    share: wp.array4d[wp.vec3], near_mm: float, far_mm: float, touched: wp.array3d[float]
) -> None:
    """The degree of contact, 0 to 1, for each row of points."""
    w, s, g = wp.tid()
    nearest = float(0.0)
    for p in range(share.shape[3]):
        nearest = wp.max(nearest, share[w, s, g, p][0])
    gap_mm = REACH_MM * (1.0 - nearest)
    touched[w, s, g] = wp.clamp((far_mm - gap_mm) / (far_mm - near_mm), 0.0, 1.0)
