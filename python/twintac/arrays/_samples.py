"""Arbitrary shapes, by samples of their signed distance on a grid."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import Shape
from ._namespace import Array, root

_Floats = npt.NDArray[np.float64]

# The samples are those of Rust: their spacing, the cells across the thinnest body, the largest
# number of samples.
_SPACING_MM = 0.5
_CELLS_OF_THICKNESS = 6.0
_MOST_SAMPLES = 4e6
_REACH_MM = 2.0

# A body counts as infinitely thick above this thickness, mm; step into a body, mm; components of
# normals are rounded to multiples of one over `_NORMALS`; a face is across a body from another one if
# the cosine of the angle between their outward normals is below `_ACROSS`.
_THICKEST_MM, _STEP_MM, _NORMALS, _ACROSS = 12.0, 0.25, 4.0, -0.7


class Samples(NamedTuple):
    """Distances of shapes at the corners of the cells of grids. One array holds the samples of all
    shapes one after the other; each body uses a part of it.
    """

    distance_mm: Array
    """The distances, mm, along z first, then y, `[n_samples]`."""
    first: Array
    """Index of the first sample of each body, `[..., n_bodies]`."""
    n_cells: Array
    """Numbers of cells along each axis, integers, `[..., n_bodies, 3]`."""
    low_mm: Array
    """The first corner in the shape's frame, mm, `[..., n_bodies, 3]`."""
    cells_per_mm: Array
    """Cells per mm along each axis, `[..., n_bodies, 3]`."""

    def as_precise(self, xp: Any, precision: Any) -> "Samples":
        """The same lengths in another precision."""
        return self._replace(
            distance_mm=xp.astype(self.distance_mm, precision, copy=False),
            low_mm=xp.astype(self.low_mm, precision, copy=False),
            cells_per_mm=xp.astype(self.cells_per_mm, precision, copy=False),
        )

    def of(self, body: int) -> "Samples":
        """The samples of one of the bodies `[n_bodies]`."""
        return Samples(self.distance_mm, *(part[body] for part in self[1:]))

    @staticmethod
    def stack(all: "Sequence[Samples | None]", leading: tuple[int, ...]) -> "Samples | None":
        """The samples of several shapes along a new first dimension. A shape without samples gets
        one cell, which nothing reads. Equal samples are stored once.
        """
        if not any(own is not None for own in all):
            return None
        known: dict[bytes, int] = {}
        values: list[Any] = []
        parts: list[Samples] = []
        n_samples = 0
        for own in (one_cell(leading) if own is None else own for own in all):
            key = own.distance_mm.tobytes()
            if key not in known:
                known[key] = n_samples
                values.append(own.distance_mm)
                n_samples += own.distance_mm.size
            parts.append(own._replace(first=own.first + np.int32(known[key])))
        columns = [np.stack(column) for column in list(zip(*parts))[1:]]
        return Samples(np.concatenate(values), *columns)


def one_cell(leading: tuple[int, ...]) -> Samples:
    """Samples of one cell, for shapes without samples: nothing reads them."""
    return Samples(
        distance_mm=np.full(8, _REACH_MM, np.float32),
        first=np.zeros(leading, np.int32),
        n_cells=np.ones((*leading, 3), np.int32),
        low_mm=np.zeros((*leading, 3)),
        cells_per_mm=np.ones((*leading, 3)),
    )


def sampled(shape: Shape) -> tuple[Samples, _Floats]:
    """Samples of a shape, and the corners of its bounding box, mm, `[2, 3]`."""
    low_mm, high_mm = bounds_mm = shape.bounds_mm
    volume_mm3 = np.prod(high_mm - low_mm + 2.0 * _REACH_MM)
    even_mm = np.full(3, max(np.cbrt(volume_mm3 / _MOST_SAMPLES), _SPACING_MM))
    finer_mm = np.minimum(even_mm, (high_mm - low_mm) / _CELLS_OF_THICKNESS)
    is_many = volume_mm3 / np.prod(finer_mm) > _MOST_SAMPLES
    spacing_mm = even_mm if is_many else finer_mm
    first_mm, last_mm = low_mm - _REACH_MM - spacing_mm, high_mm + _REACH_MM + spacing_mm
    n_cells = np.ceil((last_mm - first_mm) / spacing_mm).astype(np.int32)
    axes = [first_mm[axis] + spacing_mm[axis] * np.arange(n_cells[axis] + 1) for axis in range(3)]
    corners_mm = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    samples = Samples(
        distance_mm=shape.signed_distance_mm(corners_mm).astype(np.float32),
        first=np.array(0, np.int32),
        n_cells=n_cells,
        low_mm=first_mm,
        cells_per_mm=1.0 / spacing_mm,
    )
    return samples, bounds_mm


def thin_faces(samples: Samples) -> tuple[_Floats, _Floats]:
    """Faces of a sampled shape under which it is thin: outward normals, `[n, 3]`, and half of the
    smallest thickness under such faces, mm, `[n]`. `samples` are those of one shape.
    """

    def at_mm(points_mm: _Floats) -> _Floats:
        axes = [points_mm[:, axis, None] for axis in range(3)]
        found: _Floats = sampled_mm(np, samples, axes)[:, 0]
        return found

    def outwards(points_mm: _Floats) -> tuple[_Floats, _Floats]:
        """Outward normals, and where there are any."""
        steps = _STEP_MM * np.eye(3)
        slope = [at_mm(points_mm + step) - at_mm(points_mm - step) for step in steps]
        length = np.linalg.norm(slope, axis=0)
        return np.stack(slope, axis=-1) / np.where(length > 0.0, length, 1.0)[:, None], length > 0.0

    step_mm = 1.0 / samples.cells_per_mm
    n = samples.n_cells + 1
    own_mm = samples.distance_mm[int(samples.first) :][: int(np.prod(n))].reshape(n)
    is_near = np.abs(own_mm) < 0.5 * step_mm.max()
    point_mm = samples.low_mm + step_mm * np.argwhere(is_near)
    normal, has_way = outwards(point_mm)
    point_mm, normal = point_mm[has_way], normal[has_way]
    surface_mm = point_mm - at_mm(point_mm)[:, None] * normal
    half_mm = np.full(len(normal), np.inf)
    is_inside = np.full(len(normal), True)
    for number in range(1, int(_THICKEST_MM / _STEP_MM)):
        left = np.flatnonzero(is_inside)
        end_mm = surface_mm[left] - _STEP_MM * number * normal[left]
        is_out = at_mm(end_mm) > 0.0
        out, end_mm = left[is_out], end_mm[is_out]
        is_inside[out] = False
        is_across = (outwards(end_mm)[0] * normal[out]).sum(axis=-1) <= _ACROSS
        half_mm[out[is_across]] = 0.5 * _STEP_MM * (number - 1)
    is_thin = np.isfinite(half_mm)
    keys, which = np.unique(np.rint(_NORMALS * normal[is_thin]), axis=0, return_inverse=True)
    least_mm = np.full(len(keys), np.inf)
    np.minimum.at(least_mm, which.reshape(-1), half_mm[is_thin])
    has_way = np.linalg.norm(keys, axis=-1) > 0.0
    return keys[has_way] / np.linalg.norm(keys[has_way], axis=-1, keepdims=True), least_mm[has_way]


def thinnest_mm(samples: Samples) -> float:
    """The smallest thickness of one shape, mm; infinite for a thick one."""
    return 2.0 * float(min(thin_faces(samples)[1], default=np.inf))


def sampled_mm(xp: Any, samples: Samples, point_mm: list[Array]) -> Array:
    """The distances of points, three coordinates of `[..., n_bodies, n_points, n_levels]` each,
    linear between samples. Outside the grid it is the distance at the nearest point of the grid,
    plus the distance to that point.
    """
    whole, parts, beyond_mm2 = [], [], 0.0
    for axis in range(3):
        n_cells = samples.n_cells[..., axis, None, None]
        per_mm = samples.cells_per_mm[..., axis, None, None]
        cells = (point_mm[axis] - samples.low_mm[..., axis, None, None]) * per_mm
        n = xp.astype(n_cells, cells.dtype)
        inside = xp.minimum(xp.maximum(cells, xp.zeros_like(cells)), n)
        corner = xp.minimum(xp.floor(inside), n - 1.0)
        corner = xp.where(corner == corner, corner, 0.0)  # NaN is at no location
        whole.append(xp.astype(corner, n_cells.dtype))
        parts.append(inside - corner)
        beyond_mm2 = beyond_mm2 + ((cells - inside) / per_mm) ** 2
    along_y = samples.n_cells[..., 2, None, None] + 1
    along_x = along_y * (samples.n_cells[..., 1, None, None] + 1)
    corner = samples.first[..., None, None] + whole[0] * along_x + whole[1] * along_y + whole[2]

    def at(index: Array) -> Array:
        values = xp.take(samples.distance_mm, xp.reshape(index, (-1,)), axis=0)
        return xp.reshape(values, tuple(index.shape))

    def between(low: Array, high: Array, axis: int) -> Array:
        return low + (high - low) * parts[axis]

    edges = [corner, corner + along_y, corner + along_x, corner + along_x + along_y]
    along_z = [between(at(edge), at(edge + 1), 2) for edge in edges]
    sides = [between(along_z[0], along_z[1], 1), between(along_z[2], along_z[3], 1)]
    return between(sides[0], sides[1], 0) + root(xp, beyond_mm2)
