"""Geoms of a model as rigid shapes: the true shapes, not the convex hulls that MuJoCo collides."""

from typing import Any, NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from .. import Body, Error, Pose, Shape

_Array = npt.NDArray[np.float64]
_Type = mujoco.mjtGeom

PLANE, MESH, HFIELD = int(_Type.mjGEOM_PLANE), int(_Type.mjGEOM_MESH), int(_Type.mjGEOM_HFIELD)
# A plane is a slab. Its frame moves along the plane in strides, mm, so that sensors are near the
# middle of the slab.
_SLAB_MM = (20000.0, 20000.0, 40.0)
PLANE_STRIDE_MM = 5000.0
_LONGITUDES, _LATITUDES = 48, 24


class Felt(NamedTuple):
    """The shape of a geom, for sensors."""

    body: Body
    origin_mm: float
    """Height of the shape's origin in the geom's frame, mm."""
    radius_mm: float
    """Radius of the ball about the geom's origin that holds the geom, mm; without meaning for a
    plane.
    """


def key_of(model: mujoco.MjModel, kind: int, asset: int, half_m: _Array) -> tuple[object, ...]:
    """A key that is equal for geoms of equal shape."""
    if kind in (MESH, HFIELD):
        return kind, *(part.tobytes() for part in contents(model, kind, asset))
    return kind, half_m.tobytes()


def contents(model: mujoco.MjModel, kind: int, asset: int) -> list[npt.NDArray[Any]]:
    """The data of a mesh or height field, as views; empty for other geoms."""
    if kind == MESH:
        first, n_corners = int(model.mesh_vertadr[asset]), int(model.mesh_vertnum[asset])
        first_triangle, n_triangles = int(model.mesh_faceadr[asset]), int(model.mesh_facenum[asset])
        return [model.mesh_vert[first : first + n_corners], model.mesh_face[first_triangle : first_triangle + n_triangles]]
    if kind == HFIELD:
        first, n_x, n_y = int(model.hfield_adr[asset]), int(model.hfield_ncol[asset]), int(model.hfield_nrow[asset])
        return [model.hfield_size[asset], model.hfield_data[first : first + n_x * n_y].reshape(n_y, n_x)]
    return []


def felt(model: mujoco.MjModel, geom: int, kind: int, asset: int, half_m: _Array) -> Felt:
    """The shape of a geom of this kind, asset and size.

    Raises `ValueError`, which names the geom, for a geom that has no supported shape.
    """
    if kind in (PLANE, MESH, HFIELD):
        size_mm = np.zeros(3)
    else:
        size_mm = 1e3 * half_m
        if not np.isfinite(size_mm).all():
            raise ValueError(f"{_called(model, geom)} has the size {half_m}, which is not finite")
    try:
        shape, origin_mm, radius_mm = _shape(model, geom, kind, asset, size_mm)
        return Felt(Body(shape), origin_mm, radius_mm)
    except Error as error:
        problem = f"{_called(model, geom)} is a {_Type(kind).name} that sensors do not feel: {error}"
        raise ValueError(f"{problem}; mend it, or leave it out of `geoms`") from error


def _shape(model: mujoco.MjModel, geom: int, kind: int, asset: int, size_mm: _Array) -> tuple[Shape, float, float]:
    a_mm, b_mm, c_mm = (float(length_mm) for length_mm in size_mm)
    if kind == PLANE:
        return Shape.box(_SLAB_MM, 0.0), -_SLAB_MM[2], 0.0
    if kind == _Type.mjGEOM_SPHERE:
        return Shape.sphere(a_mm), -a_mm, a_mm
    if kind == _Type.mjGEOM_BOX:
        return Shape.box((2.0 * a_mm, 2.0 * b_mm, 2.0 * c_mm), 0.0), -c_mm, float(np.linalg.norm(size_mm))
    if kind == _Type.mjGEOM_CYLINDER:
        return Shape.cylinder(a_mm, 2.0 * b_mm, 0.0), -b_mm, float(np.hypot(a_mm, b_mm))
    if kind == _Type.mjGEOM_CAPSULE:
        return _capsule(a_mm, b_mm), 0.0, a_mm + b_mm
    if kind == _Type.mjGEOM_ELLIPSOID:
        corners, triangles = _unit_ball()
        return Shape.surface(corners * size_mm, triangles), 0.0, float(size_mm.max())
    if kind in (MESH, HFIELD):
        corners_mm, triangles = surface_of(kind, contents(model, kind, asset))
        return Shape.surface(corners_mm, triangles), 0.0, _reach(corners_mm)
    raise ValueError(f"{_called(model, geom)} is a {_Type(kind).name}, which sensors do not feel")


def surface_of(kind: int, parts: list[npt.NDArray[Any]]) -> tuple[_Array, npt.NDArray[np.int64]]:
    """Vertices, mm, and triangles of a mesh or height field, from the result of `contents`."""
    if kind == HFIELD:
        return _height_field(*parts)
    corners_m, triangles = parts
    return 1e3 * corners_m.astype(float), triangles.astype(np.int64)


def _reach(corners_mm: _Array) -> float:
    return float(np.linalg.norm(corners_mm, axis=1).max())


def _capsule(radius_mm: float, half_mm: float) -> Shape:
    def at(z_mm: float) -> Pose:
        return Pose((0.0, 0.0, z_mm))

    ball = Shape.sphere(radius_mm)
    ends = [(ball, at(half_mm - radius_mm)), (ball, at(-half_mm - radius_mm))]
    return Shape.union([(Shape.cylinder(radius_mm, 2.0 * half_mm, 0.0), at(-half_mm)), *ends])


def _height_field(size_m: npt.NDArray[Any], part: npt.NDArray[Any]) -> tuple[_Array, npt.NDArray[np.int64]]:
    """A height field as a closed surface: the grid on top, the base below."""
    n_y, n_x = part.shape
    half_x_mm, half_y_mm, top_mm, base_mm = 1e3 * size_m.astype(float)
    heights = part.astype(float).ravel()
    x_mm, y_mm = np.meshgrid(np.linspace(-half_x_mm, half_x_mm, n_x), np.linspace(-half_y_mm, half_y_mm, n_y))
    plan_mm = np.column_stack([x_mm.ravel(), y_mm.ravel()])
    above = np.column_stack([plan_mm, top_mm * heights])
    below = np.column_stack([plan_mm, np.full(n_x * n_y, -base_mm)])
    number = np.arange(n_x * n_y).reshape(n_y, n_x)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    top = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    around = np.concatenate([number[0, :], number[1:, -1], number[-1, -2::-1], number[-2:0:-1, 0]])
    after, down = np.roll(around, -1), n_x * n_y
    sides = [np.column_stack([around, around + down, after + down]), np.column_stack([around, after + down, after])]
    triangles = np.concatenate([top, top[:, ::-1] + down, *sides])
    return np.concatenate([above, below]), triangles


def _unit_ball() -> tuple[_Array, npt.NDArray[np.int64]]:
    """A ball of radius 1 as triangles."""
    polar = np.linspace(0.0, np.pi, _LATITUDES + 1)[1:-1]
    turn = np.linspace(0.0, 2.0 * np.pi, _LONGITUDES, endpoint=False)
    polar, turn = (part.ravel() for part in np.meshgrid(polar, turn, indexing="ij"))
    rings = np.column_stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)])
    corners = np.concatenate([rings, [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    number = np.arange(len(rings)).reshape(_LATITUDES - 1, _LONGITUDES)
    beside = np.roll(number, -1, axis=1)
    a, b, c, d = (part.ravel() for part in (number[:-1], number[1:], beside[1:], beside[:-1]))
    north, south = np.full(_LONGITUDES, len(rings)), np.full(_LONGITUDES, len(rings) + 1)
    caps = [np.column_stack([north, number[0], beside[0]]), np.column_stack([south, beside[-1], number[-1]])]
    return corners, np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d]), *caps])


def _called(model: mujoco.MjModel, geom: int) -> str:
    name = model.geom(geom).name
    return f"geom `{name}`" if name else f"geom {geom} (without a name)"
