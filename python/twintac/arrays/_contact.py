"""What the gel is touched by: for each point of its surface, how far inside a body it lies, or how
close to one."""

from typing import Any, NamedTuple

from ._distance import distance_mm
from ._gel import Gel
from ._namespace import Array
from ._shapes import Shapes

REACH_MM = 2.0
"""What is farther away from a point does not press there."""


class Near(NamedTuple):
    """What is near the gel."""

    share: Array
    """How much of the reach around a body is left: 0 far away, 1 at its surface, more inside. Of the
    nearest body `[..., n_points, n_levels]`, of each `[..., n_bodies, n_points, n_levels]`."""
    gap_mm: Array
    """How far each body is from the nearest point, less than 0 in the gel, `[..., n_bodies]`."""


def near(xp: Any, gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array) -> Near:
    """What is near the gel: the nearest body of each point and level."""
    share, gap_mm = share_of_bodies(xp, gel, shapes, position_mm, rotation)
    return Near(xp.max(share, axis=-3), gap_mm)


def share_of_bodies(
    xp: Any, gel: Gel, shapes: Shapes, position_mm: Array, rotation: Array
) -> Near:
    """How near each body is to the gel.

    Everything is written by components: products of matrices are rounded to ten bits on some
    devices, which may be done to networks, and not to places.
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
    # What is less deep than half of its thickness has its top nowhere near a point.
    lowest_mm = position_mm[..., 2, None, None] + middle_mm[2] - half_mm[2]
    size_mm = shapes.half_mm + shapes.grown_mm[..., None]
    thin_mm = xp.min(size_mm, axis=-1)[..., None, None]
    is_open = xp.astype(gel.highest_mm[:, None] - lowest_mm > thin_mm, lowest_mm.dtype)
    found_mm = distance_mm(xp, shapes, point_mm, up, is_open)
    deepest_mm = xp.maximum(found_mm, -gel.deepest_mm)
    share = xp.clip((REACH_MM - deepest_mm) * (1.0 / REACH_MM), 0.0, None)
    # What goes on above its top does so above itself alone; and what is not near the surface is not
    # near anything below it.
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
    """Middle and half of the box along the gel's axes that holds a body, from its origin."""
    own_mm = [shapes.middle_mm[..., axis, None, None] for axis in range(3)]
    size_mm = shapes.half_mm + shapes.grown_mm[..., None]
    half_mm = [size_mm[..., axis, None, None] for axis in range(3)]
    middle, half = [], []
    for row in range(3):
        middle.append(sum(own_mm[column] * of_gel[column][row] for column in range(3)))
        half.append(sum(half_mm[column] * xp.abs(of_gel[column][row]) for column in range(3)))
    return middle, half
