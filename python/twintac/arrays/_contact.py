"""The input of the surrogate: for each point of the gel's surface, its distance to the bodies."""

from typing import Any, NamedTuple

from ._distance import distance_mm, is_behind
from ._gel import Gel
from ._namespace import Array
from ._shapes import Shapes

REACH_MM = 2.0
"""Bodies farther away from a point than this do not count there, mm."""


# The distance of a body that is behind the sensor, mm.
FAR_MM = 1000.0


class Near(NamedTuple):
    """The proximity of bodies to the gel."""

    share: Array
    """The proximity: 0 at the distance `REACH_MM` and beyond, 1 at the surface of a body, more
    inside. For the nearest body `[..., n_points, n_levels]`, for each body
    `[..., n_bodies, n_points, n_levels]`.
    """
    gap_mm: Array
    """Distance of each body from the nearest point of the gel, mm, negative inside the gel,
    `[..., n_bodies]`.
    """


def near(xp: Any, gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array) -> Near:
    """The proximity of the nearest body, for each point and level."""
    share, gap_mm = share_of_bodies(xp, gel, shapes, position_mm, rotation)
    return Near(xp.max(share, axis=-3), gap_mm)


def share_of_bodies(
    xp: Any, gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array
) -> Near:
    """The proximity of each body to the gel.

    All products are written by components: some devices round the factors of matrix products to ten
    bits. This is acceptable for networks, but not for positions.
    """
    of_gel = [[rotation[..., row, column, None, None] for row in range(3)] for column in range(3)]
    up = [axis[2] for axis in of_gel]
    away_mm = [
        gel.points_mm[axis, :, None] - position_mm[..., axis, None, None] for axis in range(3)
    ]
    height_mm = away_mm[2] + gel.levels_mm
    point_mm = [
        (axis[0] * away_mm[0] + axis[1] * away_mm[1]) + axis[2] * height_mm for axis in of_gel
    ]
    middle_mm, half_mm = _box_in_gel(xp, shapes, of_gel)
    # A body that is less deep than half of its smallest thickness keeps its own top.
    lowest_mm = position_mm[..., 2, None, None] + middle_mm[2] - half_mm[2]
    size_mm = shapes.half_mm + shapes.grown_mm[..., None]
    thin_mm = xp.min(size_mm, axis=-1)[..., None, None]
    is_open = xp.astype(gel.highest_mm[:, None] - lowest_mm > thin_mm, lowest_mm.dtype)
    found_mm = distance_mm(xp, shapes, point_mm, up, is_open)
    base_mm = [
        (axis[0] * away_mm[0] + axis[1] * away_mm[1]) - axis[2] * position_mm[..., 2, None, None]
        for axis in of_gel
    ]
    behind = is_behind(xp, shapes, base_mm, up, is_open)
    if shapes.is_plane is None:
        behind = behind & (lowest_mm < 0.0)
    else:
        behind = behind & (shapes.is_plane[..., None, None] | (lowest_mm < 0.0))
    found_mm = xp.where(behind, FAR_MM, found_mm)
    deepest_mm = xp.maximum(found_mm, -gel.deepest_mm)
    share = xp.clip((REACH_MM - deepest_mm) * (1.0 / REACH_MM), 0.0, None)
    # A body is extended only above its own bounding box. A point whose surface level is not near a
    # body counts as far from it on all levels.
    is_above = share[..., :1] > 0.0
    for axis in (0, 1):
        is_beside = xp.abs(away_mm[axis] - middle_mm[axis]) > half_mm[axis] + REACH_MM
        if shapes.is_plane is not None:
            is_beside = is_beside & ~shapes.is_plane[..., None, None]
        is_above = is_above & ~is_beside
    share = share * xp.astype(is_above, share.dtype)
    return Near(share, xp.min(found_mm[..., 0], axis=-1))


def _box_in_gel(
    xp: Any, shapes: Shapes, of_gel: list[list[Array]]
) -> tuple[list[Array], list[Array]]:
    """Middle and half size, along the gel's axes, of the box that holds a body; the middle is
    relative to the body's origin.
    """
    own_mm = [shapes.middle_mm[..., axis, None, None] for axis in range(3)]
    size_mm = shapes.half_mm + shapes.grown_mm[..., None]
    half_mm = [size_mm[..., axis, None, None] for axis in range(3)]
    middle, half = [], []
    for row in range(3):
        middle.append(sum(own_mm[column] * of_gel[column][row] for column in range(3)))
        half.append(sum(half_mm[column] * xp.abs(of_gel[column][row]) for column in range(3)))
    return middle, half
