"""Sensors on bodies, and the geoms that can touch them, as arrays."""

import os
import warnings
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .. import FastGel, arrays
from ..arrays._namespace import Array
from ..arrays._shapes import thinnest, too_thin

_Ints = npt.NDArray[np.intp]


class Scene(NamedTuple):
    """Sensors at sites of a model, and the geoms that can touch them: the result of `scene`."""

    gel: arrays.Gel
    friction: arrays.Friction
    shapes: arrays.Shapes
    """Shapes of the geoms that can touch, `[n_geoms]`."""
    site: Array
    """Indices of the sites, `[n_sensors]`."""
    geom: Array
    """Indices of the geoms that can touch, `[n_geoms]`."""
    can_touch: Array
    """Which geom can touch which sensor, `[n_sensors, n_geoms]`."""
    body: Array
    """Indices of the bodies that are pushed, `[n_bodies]`."""
    body_of_geom: Array
    """Index of the body of each geom that can touch, `[n_geoms]`."""
    body_of_sensor: Array
    """Index of the body of each sensor, `[n_sensors]`."""
    geom_is_of: Array
    """1 where a geom belongs to a pushed body, `[n_geoms, n_bodies]`."""
    sensor_is_of: Array
    """1 where a sensor belongs to a pushed body, `[n_sensors, n_bodies]`."""


class Places(NamedTuple):
    """The sensors of a model and the geoms that can touch them, by indices."""

    site: _Ints
    geom: _Ints
    body_of_sensor: _Ints
    body_of_geom: _Ints
    moves: npt.NDArray[np.bool_]
    """For each body, whether it can move."""
    part_of: _Ints
    """For each body, the rigid part to which it belongs: a part does not touch itself."""
    apart: npt.NDArray[np.bool_] | None = None
    """Which geoms do not touch which sensors besides, `[n_sensors, n_geoms]`."""


def scene(
    places: Places,
    shapes: Sequence[arrays.Shapes],
    gel: FastGel | str | os.PathLike[str] | bytes | None,
    friction: float,
    retardation_s: float,
    like: Array | None,
    *,
    follows_thin: bool = False,
) -> Scene:
    """The scene as arrays of the library, precision and device of `like`; the adapters describe the
    arguments. Unless what evaluates the scene follows thin bodies upward (`follows_thin`), a warning
    says which shapes are thin and known by samples.

    Raises `ValueError` if there is nothing to touch, or nothing that moves.
    """
    if not len(places.site) or not len(places.geom):
        has_none = "`sites` has none" if not len(places.site) else "there is no shape that can touch"
        raise ValueError(f"{has_none}, expected at least one")
    for number, shape in enumerate(shapes):
        if not follows_thin and (least_mm := thinnest(shape)) is not None:
            warnings.warn(f"shape {number} of those that can touch is {too_thin(least_mm)}", stacklevel=3)
    source = FastGel.phystac() if gel is None else gel
    of_sensor, of_geom = places.body_of_sensor, places.body_of_geom
    body = np.unique(np.concatenate([of_sensor, of_geom]))
    body = body[places.moves[body]]
    if not len(body):
        raise ValueError("neither sensors nor shapes that can touch are on a body that moves")
    can_touch = places.part_of[of_sensor][:, None] != places.part_of[of_geom][None, :]
    if places.apart is not None:
        can_touch = can_touch & ~places.apart
    found = Scene(
        gel=arrays.load(source),
        friction=arrays.friction(source, friction, retardation_s=retardation_s),
        shapes=arrays.stack(shapes),
        site=places.site,
        geom=places.geom,
        can_touch=can_touch,
        body=body,
        body_of_geom=of_geom,
        body_of_sensor=of_sensor,
        geom_is_of=(of_geom[:, None] == body).astype(float),
        sensor_is_of=(of_sensor[:, None] == body).astype(float),
    )
    return arrays.convert(found, np.zeros(0, np.float32) if like is None else like)
