"""The hand of InHandTurn: four fingers around a palm, and an object on it, as a MuJoCo model.

For pictures there is a pointer on the object, and a green mark at the base where it should point.

The fingers stand around the palm, a quarter of a turn apart, with a phystac-tip each that faces the
middle. A finger has two hinges at its base: `swing`, sideways, and `close`, towards the middle.
Both are moved by position servos.
"""

from __future__ import annotations

from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from twintac import Sensor
from twintac.mujoco import add_sensor

N_FINGERS = 4
TIPS = [f"tip-{finger}" for finger in range(N_FINGERS)]
"""Names of the sensors' sites."""
TIMESTEP_S = 0.002
PALM_RADIUS_M = 0.026
SWING_RAD, CLOSE_RAD = (-0.4, 0.4), (-0.1, 0.35)
"""Ranges of the servos. At 0 a finger is upright; `close` is positive towards the middle."""

_BASE_RADIUS_M, _BASE_HEIGHT_M, _TIP_HEIGHT_M = 0.052, -0.055, 0.07
_SENSOR_HEIGHT_M, _SENSOR_INWARD_M = 0.065, 0.006  # of the gel's frame in a finger
# Rotation of the gel's frame in a finger, (x, y, z, w): x up along the finger, z to the middle.
_GEL_IN_FINGER = (0.0, -np.sqrt(0.5), 0.0, np.sqrt(0.5))
_SERVO = 'kp="20" forcerange="-0.3 0.3"'  # N m/rad, and N m: 4.5 N at the tip
_HINGE = 'type="hinge" damping="0.1" armature="0.001" frictionloss="0.02"'

_Array = npt.NDArray[np.float64]


class Thing(NamedTuple):
    """An object: a geom of MuJoCo of uniform density."""

    is_box: bool
    half_m: _Array
    """Half of the edges of a box; radius, half of the height, and 0 for a cylinder."""
    mass_kg: float

    @property
    def half_height_m(self) -> float:
        return float(self.half_m[2 if self.is_box else 1])

    @property
    def around_m(self) -> _Array:
        """Half of the edges of the box around it."""
        radius_m, half_height_m = self.half_m[:2]
        return self.half_m if self.is_box else np.array([radius_m, radius_m, half_height_m])

    @property
    def inertia_kg_m2(self) -> _Array:
        """The principal moments of inertia about its middle."""
        if self.is_box:
            square_m2 = self.half_m**2
            return np.asarray(self.mass_kg / 3.0 * (square_m2.sum() - square_m2))
        radius_m, half_height_m = self.half_m[:2]
        across = radius_m**2 / 4.0 + half_height_m**2 / 3.0
        return self.mass_kg * np.array([across, across, radius_m**2 / 2.0])


def draw_thing(random: np.random.Generator) -> Thing:
    """A box or a cylinder of random size and mass."""
    mass_kg = float(np.exp(random.uniform(np.log(0.03), np.log(0.12))))
    half_height_m = random.uniform(0.017, 0.022)
    if random.random() < 0.5:
        return Thing(True, np.array([*random.uniform(0.012, 0.016, 2), half_height_m]), mass_kg)
    return Thing(False, np.array([random.uniform(0.013, 0.019), half_height_m, 0.0]), mass_kg)


def hand() -> mujoco.MjModel:
    """The model, with one object for all worlds."""
    fingers, servos = "", ""
    for finger in range(N_FINGERS):
        angle_rad = 2.0 * np.pi * finger / N_FINGERS
        at_m = _BASE_RADIUS_M * np.cos(angle_rad), _BASE_RADIUS_M * np.sin(angle_rad), _BASE_HEIGHT_M
        fingers += f"""
          <body name="finger-{finger}" pos="{at_m[0]:.6f} {at_m[1]:.6f} {at_m[2]:.6f}" euler="0 0 {angle_rad:.9f}">
            <joint name="swing-{finger}" axis="1 0 0" {_HINGE}/>
            <joint name="close-{finger}" axis="0 -1 0" {_HINGE}/>
            <geom type="capsule" fromto="0 0 0 0 0 {_TIP_HEIGHT_M + 0.005}" size="0.006" mass="0.04" contype="0" conaffinity="0" rgba="0.3 0.3 0.35 1"/>
            <geom type="box" pos="-0.004 0 {_TIP_HEIGHT_M}" size="0.002 0.011 0.017" mass="0.01" contype="2" conaffinity="1" rgba="0.15 0.3 0.2 1"/>
          </body>"""
        for name, (low_rad, high_rad) in (("swing", SWING_RAD), ("close", CLOSE_RAD)):
            servos += f'<position joint="{name}-{finger}" ctrlrange="{low_rad} {high_rad}" {_SERVO}/>'
    spec = mujoco.MjSpec.from_string(f"""
      <mujoco>
        <compiler angle="radian"/>
        <option timestep="{TIMESTEP_S}" integrator="implicitfast"/>
        <visual><headlight ambient="0.45 0.45 0.45"/></visual>
        <asset><texture type="skybox" builtin="flat" rgb1="1 1 1" rgb2="1 1 1" width="32" height="192"/></asset>
        <worldbody>
          <light pos="-0.1 -0.3 0.5" dir="0.2 0.6 -1" diffuse="0.6 0.6 0.6"/>
          <geom type="cylinder" pos="0 0 -0.062" size="0.068 0.004" contype="0" conaffinity="0" rgba="0.3 0.3 0.35 1"/>
          <geom type="cylinder" pos="0 0 -0.034" size="0.01 0.026" contype="0" conaffinity="0" rgba="0.3 0.3 0.35 1"/>
          <body name="wanted" pos="0 0 -0.0575"><geom type="box" pos="0.044 0 0" size="0.022 0.002 0.0005" contype="0" conaffinity="0" rgba="0.3 0.8 0.4 1"/></body>
          <geom type="cylinder" pos="0 0 -0.005" size="{PALM_RADIUS_M} 0.005" contype="1" conaffinity="1" friction="0.3 0.001 0.0001" rgba="0.45 0.45 0.5 1"/>
          {fingers}
          <body name="object" pos="0 0 0.02"><freejoint name="object"/>
            <geom name="object" type="cylinder" size="0.016 0.02" mass="0.06" contype="1" conaffinity="3" friction="0.3 0.001 0.0001" rgba="0.9 0.6 0.3 1"/>
            <geom name="pointer" type="box" pos="0.006 0 0.02" size="0.006 0.0012 0.0008" mass="0" contype="0" conaffinity="0" rgba="0.1 0.5 0.2 1"/>
          </body>
        </worldbody>
        <actuator>{servos}</actuator>
      </mujoco>""")
    for finger, tip in enumerate(TIPS):
        position_mm = (-1e3 * _SENSOR_INWARD_M, 0.0, 1e3 * _SENSOR_HEIGHT_M)
        add_sensor(spec, Sensor.phystac_tip(), body=f"finger-{finger}", name=tip, position_mm=position_mm, quaternion=_GEL_IN_FINGER)
    return spec.compile()
