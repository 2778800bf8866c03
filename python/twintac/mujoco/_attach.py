"""Sensors on bodies of a model."""

from collections.abc import Sequence

import mujoco
import numpy as np

from .. import Sensor

_GEL_RGBA = (0.35, 0.65, 0.85, 0.6)


def add_sensor(
    spec: mujoco.MjSpec,
    sensor: Sensor,
    *,
    body: str,
    name: str,
    position_mm: Sequence[float] = (0.0, 0.0, 0.0),
    quaternion: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
) -> None:
    """Adds a sensor to a body: a site `name`, which is the frame of the gel, with z out of the
    board, and a box `name`, which shows the gel and collides with nothing.

    Args:
        spec: the model's specification, which is changed.
        sensor: the sensor.
        body: name of the body.
        name: name of the site and of the box.
        position_mm: position of the gel's frame in the body's frame, mm.
        quaternion: orientation of the gel's frame in the body's frame, `(x, y, z, w)`.

    Raises:
        ValueError: for a body that the model does not have, a position that is not finite, and a
            quaternion of another length than 1.
    """
    length = float(np.linalg.norm(quaternion))
    if np.shape(position_mm) != (3,) or not np.isfinite(position_mm).all():
        raise ValueError(f"`position_mm` is {position_mm}, expected three finite lengths in mm")
    if np.shape(quaternion) != (4,) or not abs(length - 1.0) < 1e-3:
        raise ValueError(f"`quaternion` is {quaternion}, of length {length:.3f}, expected (x, y, z, w) of length 1")
    parent = spec.body(body)
    if parent is None:
        known = ", ".join(other.name for other in spec.bodies)
        raise ValueError(f"`body` is `{body}`, which the model does not have; it has {known}")
    x, y, z, w = quaternion
    low_mm, high_mm = sensor.bounds_mm
    middle_mm = 0.5 * (low_mm + high_mm)
    place = [1e-3 * length_mm for length_mm in position_mm]
    parent.add_site(name=name, pos=place, quat=[w, x, y, z], size=[1e-3] * 3, group=3)
    to_middle_mm = np.zeros(3)
    mujoco.mju_rotVecQuat(to_middle_mm, middle_mm, np.array([w, x, y, z]))
    parent.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[0.5e-3 * length_mm for length_mm in high_mm - low_mm],
        pos=[start + 1e-3 * aside_mm for start, aside_mm in zip(place, to_middle_mm)],
        quat=[w, x, y, z],
        contype=0,
        conaffinity=0,
        mass=0.0,
        rgba=_GEL_RGBA,
    )

