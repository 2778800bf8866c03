"""Distances to thin bodies that are known by samples. A gel is never above a body, so everything
above such a body counts as inside it: the body is followed upward in columns, as Rust's surrogate
follows it. A body that is pressed less deep than half of its thickness needs no columns.
"""

from typing import Any

import numpy as np
import warp as wp

from ...arrays._contact import REACH_MM
from ...arrays._gel import LEVELS_MM, SPACING_MM, Grid
from .distance import Bodies, sampled_mm
from .near import Points, box_of, lowest_of, share_of
from .thin import Faces, is_thin

wp.set_module_options({"enable_backward": False})

# Columns on each side of those within the body's box: the lateral extent of a body follows from its
# neighbouring columns, up to `_FARTHEST` spacings away.
_AROUND, _FARTHEST = 2, 3
# Largest step upward, mm, and step as a fraction of the distance to the nearest face: below a body,
# and in it or above it; the smallest step.
_LARGEST_MM, _LARGEST_INSIDE_MM = 0.5, 0.2
_OF_DISTANCE, _OF_DISTANCE_INSIDE = 0.9, 0.25
_SMALLEST_MM = 0.03
# Rate at which the distance grows upward from a face that is a side, and from one that is a top.
_SIDE_RISES, _TOP_RISES = 0.35, 0.5
# Rate at which the distance grows upward from the base of the gel, from which a body is below it.
_LEAVES = 0.1


@wp.struct
class Columns:
    """The columns of all grids, each with some columns around it, `[n_columns]`."""

    at_mm: wp.array[wp.vec2]
    levels_mm: wp.array[wp.vec3]
    place: wp.array[wp.vec2i]
    """Column and row in the grid."""
    point: wp.array[int]
    """The point of the surface in the column; -1 around the grid."""
    grid: wp.array[int]
    first_mm: wp.array[wp.vec2]
    spacing_mm: wp.array[float]
    n: wp.array[wp.vec2i]
    highest_mm: wp.array[float]
    start: wp.array[int]
    """Index of the first column of each grid, `[n_grids]`, as the four before."""


@wp.struct
class Levels:
    """What the way up finds at the three levels of each column,
    `[n_worlds, n_sensors, n_thin, n_columns]`.
    """

    plain_mm: wp.array4d[wp.vec3]
    """Distance to the nearest face."""
    least_mm: wp.array4d[wp.vec3]
    """The smallest of these distances, here and below."""
    open_mm: wp.array4d[wp.vec3]
    """Distance to the body continued upward above its tops, without regard to its lateral extent."""
    top: wp.array4d[wp.vec3]
    """Degree to which there is a top here or below, from 0 to 1."""
    is_inside: wp.array4d[wp.vec3]
    """1 in the body and above it, else 0."""


class ThinBodies:
    """The proximity of thin bodies that are known by samples.

    Args:
        faces: the faces under which the bodies are thin.
        grids: the grids of the gel's points.
        shape: the shape of the proximities, `[n_worlds, n_sensors, n_geoms, n_points]`.
        device: the device.
    """

    def __init__(self, faces: Any, grids: list[Grid], shape: tuple[int, ...], device: Any) -> None:
        self._faces, self._columns, self._device = faces, _columns(grids, device), device
        n_thin, n_columns = faces.thin.shape[0], self._columns.at_mm.shape[0]
        self._shape = (*shape[:2], n_thin, n_columns)
        self._levels = Levels()
        for name in ("plain_mm", "least_mm", "open_mm", "top", "is_inside"):
            setattr(self._levels, name, wp.zeros(self._shape, dtype=wp.vec3, device=device))

    def launch(self, points: Any, placed: list[Any], share: Any, gap_mm: Any) -> None:
        """Adds the proximity of thin bodies that are pressed deeper than half of their thickness;
        `placed` are bodies, which of them can touch, positions and rotations.
        """
        if self._shape[2] == 0:
            return
        inputs = [self._columns, self._faces, *placed]
        wp.launch(_climb, self._shape, inputs, [self._levels], device=self._device)
        inputs = [points, *inputs, self._levels]
        wp.launch(_spread, self._shape, inputs, [share, gap_mm], device=self._device)


def _columns(grids: list[Grid], device: Any) -> Columns:
    at_mm, levels_mm, place, point, number, start = [], [], [], [], [], [0]
    of_grid: list[Any] = []
    for grid in grids:
        scale = max(grid.spacing_mm / SPACING_MM, 1.0)
        for j in range(-_AROUND, grid.n[1] + _AROUND):
            for i in range(-_AROUND, grid.n[0] + _AROUND):
                inside = grid.point(i, j)
                nearest = grid.point(min(max(i, 0), grid.n[0] - 1), min(max(j, 0), grid.n[1] - 1))
                assert nearest is not None
                height_mm = grid.height_mm[nearest - grid.first_point]
                at_mm.append(grid.first_mm + grid.spacing_mm * np.array([i, j]))
                levels_mm.append(height_mm + scale * np.array(LEVELS_MM))
                place.append([i, j])
                point.append(-1 if inside is None else inside)
                number.append(len(of_grid))
        start.append(len(point))
        of_grid.append((grid.first_mm, grid.spacing_mm, grid.n, grid.height_mm.max()))
    found = Columns()
    kinds = {
        "at_mm": (at_mm, wp.vec2),
        "levels_mm": (levels_mm, wp.vec3),
        "place": (place, wp.vec2i),
        "point": (point, int),
        "grid": (number, int),
        "first_mm": ([grid[0] for grid in of_grid], wp.vec2),
        "spacing_mm": ([grid[1] for grid in of_grid], float),
        "n": ([grid[2] for grid in of_grid], wp.vec2i),
        "highest_mm": ([grid[3] for grid in of_grid], float),
        "start": (start[:-1], int),
    }
    for name, (values, kind) in kinds.items():
        setattr(found, name, wp.array(np.array(values), dtype=kind, device=device))
    return found


@wp.struct
class _Climb:
    """State of the way up a column."""

    height_mm: float
    plain_mm: float
    least_mm: float
    open_mm: float
    steepest: float
    """The largest rate at which the distance grew on the way."""
    is_inside: bool
    slope: float
    """Rate at which the distance fell where the body began."""


@wp.kernel
def _climb(
    columns: Columns,
    faces: Faces,
    bodies: Bodies,
    can_touch: wp.array2d[bool],
    position_mm: wp.array3d[wp.vec3],
    rotation: wp.array3d[wp.mat33],
    levels: Levels,
) -> None:
    """Follows a body upward in each column within its box, and around it."""
    w, s, t, c = wp.tid()
    g = faces.thin[t]
    origin_mm, own = position_mm[w, s, g], rotation[w, s, g]
    if not (can_touch[s, g] and _is_followed(columns, faces, bodies, c, g, origin_mm, own)):
        return
    lowest_mm = lowest_of(bodies, g, origin_mm, own)
    start_mm = wp.max(lowest_mm, 0.0)
    turn, at_mm = wp.transpose(own), columns.at_mm[c]
    plain_mm = _field_mm(bodies, g, turn, origin_mm, at_mm, start_mm)
    # What is below the base has not come through the gel: it is behind the sensor.
    if lowest_mm < 0.0 and plain_mm >= 0.0:
        above_mm = _field_mm(bodies, g, turn, origin_mm, at_mm, start_mm + _SMALLEST_MM)
        if above_mm - plain_mm > _LEAVES * _SMALLEST_MM:
            levels.plain_mm[w, s, t, c] = wp.vec3(REACH_MM, REACH_MM, REACH_MM)
            levels.least_mm[w, s, t, c] = wp.vec3(REACH_MM, REACH_MM, REACH_MM)
            levels.open_mm[w, s, t, c] = wp.vec3(REACH_MM, REACH_MM, REACH_MM)
            levels.top[w, s, t, c] = wp.vec3(0.0, 0.0, 0.0)
            levels.is_inside[w, s, t, c] = wp.vec3(0.0, 0.0, 0.0)
            return
    climb = _Climb()
    climb.height_mm = start_mm
    climb.plain_mm = plain_mm
    climb.least_mm = plain_mm
    climb.open_mm = plain_mm
    plain, least = wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0)
    opened, top, inside = wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0), wp.vec3(0.0, 0.0, 0.0)
    for number in range(3):
        level = 2 - number  # from below
        level_mm = columns.levels_mm[c][level]
        while climb.height_mm + _step_mm(climb) <= level_mm:
            next_mm = climb.height_mm + _step_mm(climb)
            climb = _up_to(climb, next_mm, _field_mm(bodies, g, turn, origin_mm, at_mm, next_mm))
        there = climb
        plain[level] = _field_mm(bodies, g, turn, origin_mm, at_mm, level_mm)
        if level_mm > climb.height_mm:
            there = _up_to(climb, level_mm, plain[level])
        least[level] = there.least_mm
        opened[level] = there.open_mm
        rises = (there.steepest - _SIDE_RISES) / (_TOP_RISES - _SIDE_RISES)
        top[level] = wp.clamp(rises, 0.0, 1.0)
        inside[level] = wp.where(there.is_inside, 1.0, 0.0)
    levels.plain_mm[w, s, t, c] = plain
    levels.least_mm[w, s, t, c] = least
    levels.open_mm[w, s, t, c] = opened
    levels.top[w, s, t, c] = top
    levels.is_inside[w, s, t, c] = inside


@wp.kernel
def _spread(
    points: Points,
    columns: Columns,
    faces: Faces,
    bodies: Bodies,
    can_touch: wp.array2d[bool],
    position_mm: wp.array3d[wp.vec3],
    rotation: wp.array3d[wp.mat33],
    levels: Levels,
    share: wp.array4d[wp.vec3],
    gap_mm: wp.array3d[float],
) -> None:
    """The proximity at the points, with regard to the lateral extent of the body."""
    w, s, t, c = wp.tid()
    g, p = faces.thin[t], columns.point[c]
    origin_mm, own = position_mm[w, s, g], rotation[w, s, g]
    if p < 0 or not can_touch[s, g]:
        return
    if not _is_followed(columns, faces, bodies, c, g, origin_mm, own):
        return
    found_mm = wp.vec3(0.0, 0.0, 0.0)
    for level in range(3):
        plain_mm = levels.plain_mm[w, s, t, c][level]
        top = levels.top[w, s, t, c][level]
        open_mm = levels.open_mm[w, s, t, c][level]
        if levels.is_inside[w, s, t, c][level] > 0.0 and top > 0.0:
            aside_mm = float(wp.inf)
            for row in range(-_FARTHEST, _FARTHEST + 1):
                for column in range(-_FARTHEST, _FARTHEST + 1):
                    other = _beside(columns, c, column, row)
                    if other >= 0 and _is_in_box(columns, bodies, other, g, origin_mm, own):
                        if levels.is_inside[w, s, t, other][level] == 0.0:
                            away_mm = wp.length(columns.at_mm[other] - columns.at_mm[c])
                            beside_mm = away_mm - levels.open_mm[w, s, t, other][level]
                            aside_mm = wp.min(aside_mm, beside_mm)
            least_mm = levels.least_mm[w, s, t, c][level]
            open_mm = wp.max(open_mm, -wp.max(aside_mm, -least_mm))
        found_mm[level] = plain_mm + top * wp.min(open_mm - plain_mm, 0.0)
    if found_mm[0] < REACH_MM:  # else the body may be anywhere beyond
        wp.atomic_min(gap_mm, w, s, g, found_mm[0])
    share[w, s, g, p] = share_of(found_mm, points.deepest_mm[p])


@wp.func
def _field_mm(
    bodies: Bodies, g: int, turn: wp.mat33, origin_mm: wp.vec3, at_mm: wp.vec2, height_mm: float
) -> float:
    return sampled_mm(bodies, g, turn * (wp.vec3(at_mm[0], at_mm[1], height_mm) - origin_mm))


@wp.func
def _step_mm(climb: _Climb) -> float:
    """Distance to the height at which the distance is evaluated next."""
    away_mm = wp.abs(climb.plain_mm)
    if climb.is_inside:
        return wp.clamp(_OF_DISTANCE_INSIDE * away_mm, _SMALLEST_MM, _LARGEST_INSIDE_MM)
    return wp.clamp(_OF_DISTANCE * away_mm, _SMALLEST_MM, _LARGEST_MM)


@wp.func
def _up_to(climb: _Climb, height_mm: float, plain_mm: float) -> _Climb:
    """Continues to a height that is no farther than the next step."""
    way_mm, more_mm = height_mm - climb.height_mm, plain_mm - climb.plain_mm
    found = _Climb()
    found.height_mm = height_mm
    found.plain_mm = plain_mm
    found.least_mm = wp.min(plain_mm, climb.least_mm)
    found.open_mm = wp.min(plain_mm, climb.open_mm - climb.slope * way_mm)
    found.steepest = climb.steepest
    # Distances beyond the reach are only known to be beyond it. An incomplete step counts as a
    # fraction of a step.
    if climb.plain_mm < REACH_MM:
        found.steepest = wp.max(climb.steepest, more_mm / _step_mm(climb))
    found.is_inside = climb.is_inside
    found.slope = climb.slope
    if not climb.is_inside and plain_mm < 0.0:
        found.is_inside = True
        found.slope = wp.clamp(-more_mm / wp.max(way_mm, 1.0e-30), 0.0, 1.0)
    return found


@wp.func
def _is_followed(
    columns: Columns, faces: Faces, bodies: Bodies, c: int, g: int, origin_mm: wp.vec3, own: wp.mat33
) -> bool:
    """Whether a body is so deep that it is followed upward, in a column within its box or around
    it.
    """
    depth_mm = columns.highest_mm[columns.grid[c]] - lowest_of(bodies, g, origin_mm, own)
    up = wp.vec3(own[2, 0], own[2, 1], own[2, 2])
    return is_thin(faces, g, depth_mm, up) and _is_in_box(columns, bodies, c, g, origin_mm, own)


@wp.func
def _is_in_box(
    columns: Columns, bodies: Bodies, c: int, g: int, origin_mm: wp.vec3, own: wp.mat33
) -> bool:
    grid, box = columns.grid[c], box_of(bodies, g, own)
    for axis in range(2):
        middle_mm = origin_mm[axis] + box.middle_mm[axis] - columns.first_mm[grid][axis]
        reach_mm = box.half_mm[axis] + REACH_MM
        n = columns.n[grid][axis]
        low = int(wp.ceil((middle_mm - reach_mm) / columns.spacing_mm[grid]))
        high = int(wp.floor((middle_mm + reach_mm) / columns.spacing_mm[grid])) + 1
        last = wp.clamp(high, 0, n)
        first = wp.min(wp.max(low, 0), last)
        place = columns.place[c][axis]
        if place < first - _AROUND or place >= last + _AROUND:
            return False
    return True


@wp.func
def _beside(columns: Columns, c: int, column: int, row: int) -> int:
    """Index of a column beside this one in the same grid; -1 where there is none."""
    grid = columns.grid[c]
    n_x, n_y = columns.n[grid][0], columns.n[grid][1]
    i, j = columns.place[c][0] + column, columns.place[c][1] + row
    if i < -_AROUND or i >= n_x + _AROUND or j < -_AROUND or j >= n_y + _AROUND:
        return -1
    return columns.start[grid] + (j + _AROUND) * (n_x + 2 * _AROUND) + i + _AROUND
