"""Sensors at the sites of a MuJoCo model."""

import os
from collections.abc import Sequence

import mujoco
import numpy as np

from .. import FastGel, Shape, arrays
from ..arrays._namespace import Array
from ..arrays._shapes import from_samples
from ..mujoco._geoms import colliding, filtered, number_of
from ..mujoco._shapes import HFIELD, MESH, contents, surface_of
from ._scene import Places, Scene, scene
from ._shapes import primitive


def scene_of(
    model: mujoco.MjModel,
    sites: Sequence[str],
    *,
    gel: FastGel | str | os.PathLike[str] | bytes | None = None,
    friction: float = 0.8,
    retardation_s: float = 0.005,
    geoms: Sequence[str] | None = None,
    like: Array | None = None,
    follows_thin: bool = False,
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
    of_sensor, of_geom = model.site_bodyid[site].astype(int), model.geom_bodyid[geom].astype(int)
    places = Places(
        site=site,
        geom=geom,
        body_of_sensor=of_sensor,
        body_of_geom=of_geom,
        moves=part_of > 0,
        part_of=part_of,
        apart=filtered(model, of_sensor, of_geom, by_family=geoms is None),
    )
    shapes = [_shape(model, int(number)) for number in geom]
    return scene(places, shapes, gel, friction, retardation_s, like, follows_thin=follows_thin)


def _shape(model: mujoco.MjModel, geom: int) -> arrays.Shapes:
    """The shape of a geom, with the geom's origin."""
    kind, asset = int(model.geom_type[geom]), int(model.geom_dataid[geom])
    if kind in (MESH, HFIELD):
        corners_mm, triangles = surface_of(kind, contents(model, kind, asset))
        return from_samples(Shape.surface(corners_mm, triangles))
    of_kind = mujoco.mjtGeom(kind).name
    shape = primitive(of_kind.removeprefix("mjGEOM_"), model.geom_size[geom])
    if shape is None:
        name = model.geom(geom).name or str(geom)
        raise ValueError(f"geom `{name}` is a {of_kind}, which sensors do not feel")
    return shape
