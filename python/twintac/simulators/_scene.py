"""Sensors on the bodies of a MuJoCo model, as arrays."""

import os
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from .. import FastGel, Shape, arrays
from ..arrays._namespace import Array
from ..mujoco._geoms import colliding, number_of
from ..mujoco._shapes import HFIELD, MESH, PLANE, contents, surface_of


class Scene(NamedTuple):
    """Sensors at sites of a model, and the geoms that can touch them: what `scene` returns."""

    gel: arrays.Gel
    friction: arrays.Friction
    shapes: arrays.Shapes
    """Of the geoms that can touch, `[n_geoms]`."""
    site: Array
    """Numbers of the sites, `[n_sensors]`."""
    geom: Array
    """Numbers of the geoms that can touch, `[n_geoms]`."""
    can_touch: Array
    """Which geom can touch which sensor, `[n_sensors, n_geoms]`."""
    body: Array
    """Numbers of the bodies that are pushed, `[n_bodies]`."""
    body_of_geom: Array
    """Number of the body of each geom that can touch, `[n_geoms]`."""
    body_of_sensor: Array
    """Number of the body of each sensor, `[n_sensors]`."""
    geom_is_of: Array
    """1 where a geom is of a pushed body, `[n_geoms, n_bodies]`."""
    sensor_is_of: Array
    """1 where a sensor is of a pushed body, `[n_sensors, n_bodies]`."""


def scene(
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
    them.

    - `gel`: what `arrays.load` takes; PhysTac's unless given.
    - `friction`: Coulomb's coefficient of every body on every gel.
    - `retardation_s`: the loss of the gel, s, see `twintac.Coupling`.
    - `geoms`: names of the geoms that can touch; all that collide unless given. Those of the
      sensor's own body never do. Each is looked at from each sensor in each world.
    - `like`: an array of the library, the precision and the device of the result.

    Raises `ValueError` for a site or geom that the model does not have, and if no geom can touch;
    `Error` for a geom that sensors do not feel.
    """
    source = FastGel.phystac() if gel is None else gel
    site = np.array([number_of(model, "site", name) for name in sites], int)
    if geoms is None:
        geom = colliding(model)
    else:
        geom = np.array([number_of(model, "geom", name) for name in geoms], int)
    if not len(site) or not len(geom):
        missing = "`sites` has none" if not len(site) else "the model has no geom that could touch"
        raise ValueError(f"{missing}, expected at least one")
    body_of_sensor = model.site_bodyid[site].astype(int)
    body_of_geom = model.geom_bodyid[geom].astype(int)
    weld = model.body_weldid
    body = np.unique(np.concatenate([body_of_sensor, body_of_geom]))
    body = body[weld[body] > 0]
    if not len(body):
        raise ValueError("neither sensors nor geoms that can touch are on a body that moves")
    found = Scene(
        gel=arrays.load(source),
        friction=arrays.friction(source, friction, retardation_s=retardation_s),
        shapes=arrays.stack([_shape(model, int(number)) for number in geom]),
        site=site,
        geom=geom,
        can_touch=weld[body_of_sensor][:, None] != weld[body_of_geom][None, :],
        body=body,
        body_of_geom=body_of_geom,
        body_of_sensor=body_of_sensor,
        geom_is_of=(body_of_geom[:, None] == body).astype(float),
        sensor_is_of=(body_of_sensor[:, None] == body).astype(float),
    )
    return arrays.convert(found, np.zeros(0, np.float32) if like is None else like)


def _shape(model: mujoco.MjModel, geom: int) -> arrays.Shapes:
    """A geom as a shape with its origin where the geom's is."""
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
