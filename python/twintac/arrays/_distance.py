"""Signed distances to bodies.

A body that is deeper than it is thick is extended upward above its top. Points of the undeformed
gel above the top would otherwise count as outside the body, although a gel is never above a body.
"""

from typing import Any

from ._namespace import Array, root
from ._samples import sampled_mm
from ._shapes import Shapes

# A face counts as a top according to the height of its upward normal: not at all at the first
# value, wholly at the second. `MORE` is added to both for thick bodies. Below `THIN_MM` a body is
# thin, above `THICK_MM` thick, mm.
LOOKS_UP = (0.1, 0.3)
MORE = 0.4
THIN_MM, THICK_MM = 2.5, 3.5
# Newton steps to the nearest point of an ellipsoid. Four steps find it to a thousandth of the size.
N_STEPS = 6
TINY = 1e-6


def distance_mm(
    xp: Any, shapes: Shapes, point_mm: list[Array], up: list[Array], is_open: Array
) -> Array:
    """The distances of points to bodies, mm, negative inside:
    `[..., n_bodies, n_points, n_levels]`.

    - `point_mm`: three coordinates in each body's frame, each of that shape.
    - `up`: the gel's z axis in each body's frame, three coordinates `[..., n_bodies, 1, 1]`.
    - `is_open`: 1 where a body is extended above its top, else 0;
      `[..., n_bodies, n_points or 1, 1]`.
    """
    half_mm = [shapes.half_mm[..., axis, None, None] for axis in range(3)]
    grown_mm = shapes.grown_mm[..., None, None]
    own_mm = [point_mm[axis] - shapes.middle_mm[..., axis, None, None] for axis in range(3)]
    found_mm = _ball_mm(xp, own_mm, up, is_open) - grown_mm

    def put(mask: Array, other_mm: Array) -> Array:
        return xp.where(mask[..., None, None], other_mm, found_mm)

    if shapes.is_box is not None:
        found_mm = put(shapes.is_box, _box_mm(xp, half_mm, grown_mm, own_mm, up, is_open))
    if shapes.is_cylinder is not None:
        found_mm = put(shapes.is_cylinder, _cylinder_mm(xp, half_mm, grown_mm, own_mm, up, is_open))
    if shapes.is_ellipsoid is not None:
        mask = shapes.is_ellipsoid[..., None, None]
        # prevents a division by zero for other shapes
        axes_mm = [xp.where(mask, half, 1.0) for half in half_mm]
        found_mm = put(shapes.is_ellipsoid, _ellipsoid_mm(xp, axes_mm, own_mm, up, is_open))
    if shapes.is_plane is not None:
        found_mm = put(shapes.is_plane, own_mm[2])
    if shapes.is_sampled is not None and shapes.samples is not None:
        found_mm = put(shapes.is_sampled, sampled_mm(xp, shapes.samples, point_mm))
    return found_mm


def is_behind(
    xp: Any, shapes: Shapes, base_mm: list[Array], up: list[Array], is_open: Array
) -> Array:
    """Whether bodies are below points of the base of the gel: what is below the base has not come
    through the gel, it is behind the sensor. `base_mm`, `up` and `is_open` as for `distance_mm`, for
    bodies that reach below the base.
    """
    half_mm = [shapes.half_mm[..., axis, None, None] for axis in range(3)]
    grown_mm = shapes.grown_mm[..., None, None]
    own_mm = [base_mm[axis] - shapes.middle_mm[..., axis, None, None] for axis in range(3)]
    found = sum(map(_product, own_mm, up)) > 0.0

    def put(mask: Array, other: Array) -> Array:
        return xp.where(mask[..., None, None], other, found)

    sign = [_sign(xp, way) for way in up]
    if shapes.is_box is not None:
        height = [xp.abs(way) for way in up]
        tops = [_top(xp, height[i], 2.0 * (half_mm[i] + grown_mm)) for i in range(3)]
        main = _lowest(xp, half_mm, tops)
        over_mm = sum(main[i] * own_mm[i] * sign[i] for i in range(3))
        found = put(shapes.is_box, over_mm > 0.0)
    if shapes.is_cylinder is not None:
        end = _top(xp, xp.abs(up[2]), 2.0 * (half_mm[2] + grown_mm))
        aside = root(xp, up[0] ** 2 + up[1] ** 2)
        side = _top(xp, aside, 2.0 * (half_mm[0] + grown_mm))
        beside = (side > 0.0) & (own_mm[0] * up[0] + own_mm[1] * up[1] > 0.0)
        found = put(shapes.is_cylinder, xp.where(end > 0.0, own_mm[2] * sign[2] > 0.0, beside))
    found = found & (is_open > 0.0)
    if shapes.is_plane is not None:
        found = put(shapes.is_plane, up[2] + 0.0 * own_mm[2] >= 0.0)
    if shapes.is_sampled is not None:
        found = found & ~shapes.is_sampled[..., None, None]
    return found


def _ball_mm(xp: Any, own_mm: list[Array], up: list[Array], is_open: Array) -> Array:
    """The distance to the centre of a ball; for an extended ball, to the vertical axis above its
    centre.
    """
    above_mm = is_open * xp.clip(sum(map(_product, own_mm, up)), 0.0, None)
    return root(xp, sum((own - above_mm * way) ** 2 for own, way in zip(own_mm, up)))


def _box_mm(
    xp: Any,
    half_mm: list[Array],
    grown_mm: Array,
    own_mm: list[Array],
    up: list[Array],
    is_open: Array,
) -> Array:
    height = [xp.abs(way) for way in up]
    tops = [is_open * _top(xp, height[i], 2.0 * (half_mm[i] + grown_mm)) for i in range(3)]
    main = _lowest(xp, half_mm, tops)
    # A side that leans out over the gel ends at the top. The extension above it has upright sides.
    upright = sum(map(_product, height, main))
    slope = sum(map(_product, tops, main)) / xp.where(upright > 0.0, upright, 1.0)
    sign = [_sign(xp, way) for way in up]
    over_mm = sum(main[i] * (own_mm[i] * sign[i] - half_mm[i]) for i in range(3))
    beyond_mm = []
    for i in range(3):
        above_mm = xp.clip(2.0 * tops[i] * sign[i] * own_mm[i], 0.0, None)
        lean = (1.0 - main[i]) * height[i] * slope
        cosine = 1.0 / xp.sqrt(lean * lean + 1.0)
        beside_mm = cosine * (lean * over_mm - own_mm[i] * sign[i] - half_mm[i])
        beyond_mm.append(xp.maximum(xp.abs(own_mm[i]) - half_mm[i] - above_mm, beside_mm))
    return _over_sides_mm(xp, beyond_mm) - grown_mm


def _cylinder_mm(
    xp: Any,
    half_mm: list[Array],
    grown_mm: Array,
    own_mm: list[Array],
    up: list[Array],
    is_open: Array,
) -> Array:
    x_mm, y_mm, z_mm = own_mm
    height, sign = xp.abs(up[2]), _sign(xp, up[2])
    aside = root(xp, up[0] ** 2 + up[1] ** 2)
    way = [part / xp.where(aside > 0.0, aside, 1.0) for part in up[:2]]
    end = is_open * _top(xp, height, 2.0 * (half_mm[2] + grown_mm))
    side = is_open * _top(xp, aside, 2.0 * (half_mm[0] + grown_mm))
    out_mm = side * xp.clip(x_mm * way[0] + y_mm * way[1], 0.0, None)
    x_mm, y_mm = x_mm - out_mm * way[0], y_mm - out_mm * way[1]
    above_mm = xp.abs(z_mm) - half_mm[2] - xp.clip(2.0 * end * sign * z_mm, 0.0, None)
    # Above a tilted top, the side of the extension is upright.
    slope = end / xp.where(height > 0.0, height, 1.0)
    over_mm = slope * xp.clip(sign * z_mm - half_mm[2], 0.0, None)
    leaning_mm2 = (x_mm - up[0] * over_mm) ** 2 + (y_mm - up[1] * over_mm) ** 2
    beside_mm = root(xp, xp.maximum(x_mm**2 + y_mm**2, leaning_mm2)) - half_mm[0]
    return _over_sides_mm(xp, [beside_mm, above_mm]) - grown_mm


def _ellipsoid_mm(
    xp: Any, half_mm: list[Array], own_mm: list[Array], up: list[Array], is_open: Array
) -> Array:
    """The exact distance: to the point of the surface whose normal passes through the given point.
    An extended ellipsoid has upright sides above its widest cross-section.
    """
    bent = [way / half**2 for way, half in zip(up, half_mm)]
    above = sum(map(_product, own_mm, bent)) / sum(map(_product, up, bent))
    above_mm = is_open * xp.clip(above, 0.0, None)
    away_mm = [xp.abs(own - above_mm * way) for own, way in zip(own_mm, up)]
    least_mm = xp.minimum(xp.minimum(half_mm[0], half_mm[1]), half_mm[2])
    over_mm2 = [half**2 - least_mm**2 for half in half_mm]
    # The nearest point is `half² away / (shift + half² - least²)`, with one shift for all axes.
    reach_mm2 = [half * (away + TINY * least_mm) for half, away in zip(half_mm, away_mm)]
    shift = _largest(xp, [reach - over for reach, over in zip(reach_mm2, over_mm2)])
    for _ in range(N_STEPS):
        parts = [(reach / (shift + over)) ** 2 for reach, over in zip(reach_mm2, over_mm2)]
        length2 = parts[0] + parts[1] + parts[2]
        slope = sum(part / (shift + over) for part, over in zip(parts, over_mm2))
        # Newton's step for 1 - 1 / length, which is nearly linear.
        shift = shift + (xp.sqrt(length2) - 1.0) * length2 / slope
    normal2 = sum(
        (reach / (half * (shift + over))) ** 2
        for reach, half, over in zip(reach_mm2, half_mm, over_mm2)
    )
    return (shift - least_mm**2) * xp.sqrt(normal2)


def _over_sides_mm(xp: Any, beyond_mm: list[Array]) -> Array:
    """The distance, from the distances of a point beyond the faces of each axis."""
    outside_mm = root(xp, sum(xp.clip(beyond, 0.0, None) ** 2 for beyond in beyond_mm))
    return outside_mm + xp.clip(_largest(xp, beyond_mm), None, 0.0)


def _top(xp: Any, height: Array, thick_mm: Array) -> Array:
    """The degree to which a face counts as a top, 0 to 1."""
    thick = xp.clip((thick_mm - THIN_MM) / (THICK_MM - THIN_MM), 0.0, 1.0)
    side, top = LOOKS_UP
    part = xp.clip((height - side - MORE * thick) / (top - side), 0.0, 1.0)
    return part * part * (3.0 - 2.0 * part)


def _lowest(xp: Any, half_mm: list[Array], tops: list[Array]) -> list[Array]:
    """1 for the axis along which a box is thinnest, among the axes with a top; 0 for the other
    axes.
    """
    far = [xp.where(top > 0.0, half, xp.inf) for half, top in zip(half_mm, tops)]
    least = xp.minimum(xp.minimum(far[0], far[1]), far[2])
    found, left = [], xp.ones_like(least)
    for own in far:
        is_it = xp.where((own <= least) & (own < xp.inf), left, 0.0)
        found.append(is_it)
        left = left - is_it
    return found


def _largest(xp: Any, values: list[Array]) -> Array:
    found = values[0]
    for value in values[1:]:
        found = xp.maximum(found, value)
    return found


def _sign(xp: Any, value: Array) -> Array:
    one = xp.ones_like(value)
    return xp.where(value < 0.0, -one, one)


def _product(a: Array, b: Array) -> Array:
    return a * b
