"""Rigid shapes as arrays of numbers."""

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import Shape
from ._namespace import Array, check_same_library, namespace, refuse
from ._samples import Samples, sampled, thinnest_mm

_Floats = npt.NDArray[np.float64]


class Shapes(NamedTuple):
    """Shapes of bodies, `[..., n_bodies]`: the result of `ball`, `box` and the others, and of
    `stack`. A ball is a point that is grown by its radius; masks mark the other kinds of shapes. A
    mask is `None` if no shape is of its kind, and then costs nothing.

    It is a tuple of arrays: shapes may differ from world to world and from call to call without a
    new compilation, as long as the kinds are the same.
    """

    half_mm: Array
    """Half of the size along each axis, without the growth, mm, `[..., n_bodies, 3]`."""
    grown_mm: Array
    """Growth in all directions, which is the radius of the edges, mm, `[..., n_bodies]`."""
    middle_mm: Array
    """The middle of the shape in its own frame, mm, `[..., n_bodies, 3]`."""
    is_box: Array | None = None
    is_cylinder: Array | None = None
    """True for cylinders and capsules."""
    is_ellipsoid: Array | None = None
    is_plane: Array | None = None
    is_sampled: Array | None = None
    samples: Samples | None = None
    """The samples of the shapes that are sampled."""

    def as_precise(self, xp: Any, precision: Any) -> "Shapes":
        """The same lengths in another precision."""
        return self._replace(
            half_mm=xp.astype(self.half_mm, precision, copy=False),
            grown_mm=xp.astype(self.grown_mm, precision, copy=False),
            middle_mm=xp.astype(self.middle_mm, precision, copy=False),
            samples=None if self.samples is None else self.samples.as_precise(xp, precision),
        )


# Presses are seldom deeper than half of this thickness.
_THIN_MM = 4.0
_MASKS = ("is_box", "is_cylinder", "is_ellipsoid", "is_plane", "is_sampled")


def ball(radius_mm: float) -> Shapes:
    """A ball that stands on its origin, as `Shape.sphere` does.

    Args:
        radius_mm: radius, mm, above 0.

    Returns:
        The shape.

    Raises:
        Error: for a length that is out of range, as all functions that make shapes do.
    """
    _check(radius_mm=radius_mm)
    return _shape((0.0, 0.0, 0.0), radius_mm, radius_mm)


def box(size_mm: Sequence[float], edge_radius_mm: float = 0.0) -> Shapes:
    """A box that stands on its origin, as `Shape.box` does.

    Args:
        size_mm: full size along x, y and z, mm.
        edge_radius_mm: radius of the edges, mm, at most half of the smallest size.

    Returns:
        The shape.

    Raises:
        Error: for a length that is out of range.
    """
    if len(size_mm) != 3:
        raise refuse("size_mm", f"has {len(size_mm)} lengths", "3")
    _check(size_mm=min(size_mm))
    _check_edge(edge_radius_mm, 0.5 * min(size_mm))
    half_mm = [0.5 * length_mm - edge_radius_mm for length_mm in size_mm]
    return _shape(half_mm, edge_radius_mm, 0.5 * size_mm[2], is_box=True)


def cylinder(radius_mm: float, height_mm: float, edge_radius_mm: float = 0.0) -> Shapes:
    """An upright cylinder that stands on its origin, as `Shape.cylinder` does.

    Args:
        radius_mm: radius, mm.
        height_mm: height, mm.
        edge_radius_mm: radius of the edges, mm, at most the radius and half of the height.

    Returns:
        The shape.

    Raises:
        Error: for a length that is out of range.
    """
    _check(radius_mm=radius_mm, height_mm=height_mm)
    _check_edge(edge_radius_mm, min(radius_mm, 0.5 * height_mm))
    core_mm = radius_mm - edge_radius_mm
    half_mm = (core_mm, core_mm, 0.5 * height_mm - edge_radius_mm)
    return _shape(half_mm, edge_radius_mm, 0.5 * height_mm, is_cylinder=True)


def capsule(radius_mm: float, height_mm: float) -> Shapes:
    """An upright cylinder with hemispherical ends that stands on its origin.

    Args:
        radius_mm: radius, mm.
        height_mm: height over both ends, mm, at least twice the radius.

    Returns:
        The shape.

    Raises:
        Error: for a length that is out of range.
    """
    _check(radius_mm=radius_mm)
    if not height_mm >= 2.0 * radius_mm:
        raise refuse("height_mm", f"is {height_mm}", f"{2.0 * radius_mm} or more")
    half_mm = (0.0, 0.0, 0.5 * height_mm - radius_mm)
    return _shape(half_mm, radius_mm, 0.5 * height_mm, is_cylinder=True)


def ellipsoid(half_mm: Sequence[float]) -> Shapes:
    """An ellipsoid that stands on its origin.

    Args:
        half_mm: half axes along x, y and z, mm.

    Returns:
        The shape.

    Raises:
        Error: for a length that is out of range.
    """
    if len(half_mm) != 3:
        raise refuse("half_mm", f"has {len(half_mm)} lengths", "3")
    _check(half_mm=min(half_mm))
    return _shape(half_mm, 0.0, half_mm[2], is_ellipsoid=True)


def plane() -> Shapes:
    """A half-space: it fills everything below z = 0 of its frame. It presses a gel if its z axis
    points against that of the gel.
    """
    return _shape((1.0, 1.0, 1.0), 0.0, 0.0, is_plane=True)


def mesh(shape: Shape) -> Shapes:
    """Any `Shape` by samples of its distance, in its own frame: triangle meshes (`Shape.surface`,
    `Shape.stl`), unions, rings. Sampling takes from a millisecond to several seconds, for shapes of
    many triangles and for large ones. Where a body is pressed deeper than half of its thickness,
    readings are too low, down to zero, because sampled shapes are not extended upward, as other
    shapes are. Bodies that are thinner than 4 mm give a warning.
    """
    found = from_samples(shape)
    if (least_mm := thinnest(found)) is not None:
        warnings.warn(f"the shape is {too_thin(least_mm)}", stacklevel=2)
    return found


def from_samples(shape: Shape) -> Shapes:
    """As `mesh`, without a warning."""
    samples, bounds_mm = sampled(shape)
    middle_mm, half_mm = bounds_mm.mean(axis=0), 0.5 * (bounds_mm[1] - bounds_mm[0])
    found = _shape(half_mm, 0.0, 0.0, is_sampled=True)
    return found._replace(middle_mm=middle_mm, samples=samples)


def thinnest(shape: Shapes) -> float | None:
    """The smallest thickness of one shape that is sampled, mm, if it matters: `None` if no press is
    likely to be deeper than half of it.
    """
    least_mm = np.inf if shape.samples is None else thinnest_mm(shape.samples)
    return least_mm if least_mm < _THIN_MM else None


def too_thin(thickness_mm: float) -> str:
    """What happens to a shape that is so thin, for a warning."""
    return (
        f"{thickness_mm:.2g} mm thick at its thinnest, and is known by samples: where this part is "
        f"pressed deeper than {0.5 * thickness_mm:.2g} mm, readings are too low, down to zero"
    )


def centered(shapes: Shapes) -> Shapes:
    """The same shapes with their origins in their middles, as in simulators. Shapes that are
    sampled keep their origins.
    """
    moved_mm = np.zeros_like(shapes.middle_mm)
    if shapes.is_sampled is not None:
        moved_mm = np.where(shapes.is_sampled[..., None], shapes.middle_mm, moved_mm)
    return shapes._replace(middle_mm=moved_mm)


def stack(shapes: Sequence[Shapes]) -> Shapes:
    """Combines shapes along a new first dimension: the shapes of the bodies of one sensor, or those
    of the sensors of several worlds, of which each has the same number. The arrays are of NumPy;
    use `convert` afterwards.

    Args:
        shapes: at least one; all have the same leading dimensions.

    Returns:
        The shapes, with one more dimension.

    Raises:
        Error: if there is no shape, and for shapes of different leading dimensions.
    """
    if not shapes:
        raise refuse("shapes", "is empty", "a shape or more")
    leading = {tuple(own.grown_mm.shape) for own in shapes}
    if len(leading) > 1:
        problem = f"have the leading dimensions {sorted(map(list, leading))}"
        raise refuse("shapes", problem, "the same of all")
    masks: dict[str, Any] = {}
    for name in _MASKS:
        own_masks = [getattr(own, name) for own in shapes]
        if any(mask is not None for mask in own_masks):
            nothing = np.zeros(leading.copy().pop(), bool)
            masks[name] = np.stack([nothing if mask is None else mask for mask in own_masks])
    return Shapes(
        half_mm=np.stack([own.half_mm for own in shapes]),
        grown_mm=np.stack([own.grown_mm for own in shapes]),
        middle_mm=np.stack([own.middle_mm for own in shapes]),
        samples=Samples.stack([own.samples for own in shapes], leading.pop()),
        **masks,
    )


def choose(shapes: Shapes, number: Array) -> Shapes:
    """Chooses a shape for each body. It works on the device, and in compiled functions.

    Args:
        shapes: shapes `[n_shapes]`, as `stack` makes them.
        number: index of the shape of each body, from 0, `[..., n_bodies]`.

    Returns:
        The shapes of the bodies, `[..., n_bodies]`.

    Raises:
        Error: for shapes of other dimensions, and for indices of another library.
    """
    xp = namespace("shapes", shapes.grown_mm)
    check_same_library(xp, number=number)
    if len(shapes.grown_mm.shape) != 1:
        problem = f"have the leading dimensions {list(shapes.grown_mm.shape)}"
        raise refuse("shapes", problem, "one, [n_shapes]")

    def of_number(value: Array | None) -> Array | None:
        if value is None:
            return None
        taken = xp.take(value, xp.reshape(number, (-1,)), axis=0)
        return xp.reshape(taken, (*number.shape, *value.shape[1:]))

    samples = shapes.samples
    if samples is not None:
        samples = Samples(samples.distance_mm, *(of_number(part) for part in samples[1:]))
    own = {name: of_number(getattr(shapes, name)) for name in Shapes._fields if name != "samples"}
    return Shapes(**own, samples=samples)


def _shape(
    half_mm: Sequence[float] | _Floats, grown_mm: float, middle_mm: float, **masks: bool
) -> Shapes:
    own: dict[str, Any] = {name: np.array(mask) for name, mask in masks.items()}
    return Shapes(
        half_mm=np.array(half_mm, np.float64),
        grown_mm=np.array(grown_mm, np.float64),
        middle_mm=np.array([0.0, 0.0, middle_mm]),
        **own,
    )


def _check(**lengths_mm: float) -> None:
    for field, length_mm in lengths_mm.items():
        if not 0.0 < length_mm < np.inf:
            raise refuse(field, f"is {length_mm}", "a length above 0 mm")


def _check_edge(edge_radius_mm: float, most_mm: float) -> None:
    if not 0.0 <= edge_radius_mm <= most_mm:
        raise refuse("edge_radius_mm", f"is {edge_radius_mm}", f"0 to {most_mm} mm")
