"""Touch sensors on any body of a MuJoCo model.

The gel of a sensor is not a colliding geom. The surrogate of the gel computes the forces from the
depth of other bodies' geoms in the gel, and these forces are applied to both bodies. So the gel
carries the load, instead of MuJoCo's contacts.
"""

from ._attach import add_sensor
from ._touch import TouchSensors, TouchState

__all__ = ["TouchSensors", "TouchState", "add_sensor"]
