"""Sensors at the sites of a MuJoCo model."""

import os
from collections.abc import Sequence

import mujoco
import numpy as np

from .. import FastGel, Shape, arrays
from ..arrays._namespace import Array
from ..mujoco._geoms import colliding, number_of
from ..mujoco._shapes import HFIELD, MESH, PLANE, contents, surface_of
from ._scene import Places, Scene, scene


def scene_of(
    model: mujoco.MjModel,
    sites: Sequence[str],
    *,
    gel: FastGel | str | os.PathLike[str] | bytes | None = None,
    friction: float = 0.8,
    retardation_s: float = 0.005,
    geoms: Sequence[str] | None = None,
    like: Array | None = None,
) -> Scene:
    """Sensors at sites that are the frames of their gels, as `twintac.mujoco.add_sensor` makes
    them, and the geoms with the given names, or all that collide.

    Raises `ValueError` for a site or geom that the model does not have, and if no geom can touch;
    `Error` for a geom of an unsupported shape.
    """
    site = np.array([number_of(model, "site", name) for name in sites], int)
    if geoms is None:
        geom = colliding(model)
    else:
        geom = np.array([number_of(model, "geom", name) for name in geoms], int)
    part_of = np.asarray(model.body_weldid, int)
    places = Places(
        site=site,
        geom=geom,
        body_of_sensor=model.site_bodyid[site].astype(int),
        body_of_geom=model.geom_bodyid[geom].astype(int),
        moves=part_of > 0,
        part_of=part_of,
    )
    shapes = [_shape(model, int(number)) for number in geom]
    return scene(places, shapes, gel, friction, retardation_s, like)


def _shape(model: mujoco.MjModel, geom: int) -> arrays.Shapes:
    """The shape of a geom, with the geom's origin."""
    kind, asset = int(model.geom_type[geom]), int(model.geom_dataid[geom])
    a_mm, b_mm, c_mm = (1e3 * float(length_m) for length_m in model.geom_size[geom])
    kinds = mujoco.mjtGeom
    if kind == PLANE:
        return arrays.plane()
    if kind in (MESH, HFIELD):
        corners_mm, triangles = surface_of(kind, contents(model, kind, asset))
        return arrays.mesh(Shape.surface(corners_mm, triangles))
    if kind == kinds.mjGEOM_SPHERE:
        return arrays.centered(arrays.ball(a_mm))
    if kind == kinds.mjGEOM_BOX:
        return arrays.centered(arrays.box((2.0 * a_mm, 2.0 * b_mm, 2.0 * c_mm)))
    if kind == kinds.mjGEOM_CYLINDER:
        return arrays.centered(arrays.cylinder(a_mm, 2.0 * b_mm))
    if kind == kinds.mjGEOM_CAPSULE:
        return arrays.centered(arrays.capsule(a_mm, 2.0 * (a_mm + b_mm)))
    if kind == kinds.mjGEOM_ELLIPSOID:
        return arrays.centered(arrays.ellipsoid((a_mm, b_mm, c_mm)))
    name = model.geom(geom).name or str(geom)
    raise ValueError(f"geom `{name}` is a {kinds(kind).name}, which sensors do not feel")
