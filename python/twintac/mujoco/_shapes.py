"""Geoms of a model as rigid shapes: the true ones, not the convex hulls with which MuJoCo collides."""

import mujoco
import numpy as np
import numpy.typing as npt

from .. import Body, Error, Pose, Shape

_Array = npt.NDArray[np.float64]
_Type = mujoco.mjtGeom

# A plane is a slab that is moved along with the sensor, mm.
_SLAB_MM = (400.0, 400.0, 40.0)
_LONGITUDES, _LATITUDES = 48, 24


def body_of(model: mujoco.MjModel, geom: int) -> tuple[Body, float]:
    """A geom's shape, in mm, and the height of the shape's origin in the geom's frame, mm."""
    shape, origin_mm = _shape(model, geom)
    return Body(shape), origin_mm


def key_of(model: mujoco.MjModel, geom: int) -> tuple[int, int, bytes]:
    """What geoms of equal shape have in common."""
    return int(model.geom_type[geom]), int(model.geom_dataid[geom]), model.geom_size[geom].tobytes()


def _shape(model: mujoco.MjModel, geom: int) -> tuple[Shape, float]:
    a_mm, b_mm, c_mm = (float(size_mm) for size_mm in 1e3 * model.geom_size[geom])
    kind = _Type(model.geom_type[geom])
    if kind == _Type.mjGEOM_PLANE:
        return Shape.box(_SLAB_MM, 0.0), -_SLAB_MM[2]
    if kind == _Type.mjGEOM_SPHERE:
        return Shape.sphere(a_mm), -a_mm
    if kind == _Type.mjGEOM_BOX:
        return Shape.box((2.0 * a_mm, 2.0 * b_mm, 2.0 * c_mm), 0.0), -c_mm
    if kind == _Type.mjGEOM_CYLINDER:
        return Shape.cylinder(a_mm, 2.0 * b_mm, 0.0), -b_mm
    if kind == _Type.mjGEOM_CAPSULE:
        return _capsule(a_mm, b_mm), 0.0
    if kind == _Type.mjGEOM_ELLIPSOID:
        corners, triangles = _unit_ball()
        return Shape.surface(corners * (a_mm, b_mm, c_mm), triangles), 0.0
    if kind == _Type.mjGEOM_MESH:
        return _mesh(model, geom), 0.0
    if kind == _Type.mjGEOM_HFIELD:
        return _height_field(model, int(model.geom_dataid[geom])), 0.0
    raise ValueError(f"{_called(model, geom)} is a {kind.name}, which sensors do not feel")


def _capsule(radius_mm: float, half_mm: float) -> Shape:
    def at(z_mm: float) -> Pose:
        return Pose((0.0, 0.0, z_mm))

    ball = Shape.sphere(radius_mm)
    ends = [(ball, at(half_mm - radius_mm)), (ball, at(-half_mm - radius_mm))]
    return Shape.union([(Shape.cylinder(radius_mm, 2.0 * half_mm, 0.0), at(-half_mm)), *ends])


def _mesh(model: mujoco.MjModel, geom: int) -> Shape:
    mesh = int(model.geom_dataid[geom])
    first, n_corners = int(model.mesh_vertadr[mesh]), int(model.mesh_vertnum[mesh])
    corners = model.mesh_vert[first : first + n_corners].astype(float)
    first, n_triangles = int(model.mesh_faceadr[mesh]), int(model.mesh_facenum[mesh])
    triangles = model.mesh_face[first : first + n_triangles].astype(np.int64)
    try:
        return Shape.surface(1e3 * corners, triangles)
    except Error as error:
        problem = f"{_called(model, geom)} has a mesh whose inside is not known: {error}"
        raise ValueError(f"{problem}; close the mesh, or leave this geom out of `geoms`") from error


def _height_field(model: mujoco.MjModel, field: int) -> Shape:
    """A height field as a closed block: its grid on top, its base below."""
    n_y, n_x = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    half_x_mm, half_y_mm, top_mm, base_mm = 1e3 * model.hfield_size[field]
    first = int(model.hfield_adr[field])
    heights = model.hfield_data[first : first + n_x * n_y].astype(float)
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
    return Shape.surface(np.concatenate([above, below]), triangles)


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
