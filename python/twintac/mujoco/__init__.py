"""Touch sensors on any body of a MuJoCo model.

The gel of a sensor is no geom that collides: the fast gel reads how far the geoms of other bodies
reach into it, and what it pushes them with is
applied to both bodies. So the gel carries the load, not MuJoCo's contact.
"""

from ._attach import add_sensor
from ._touch import TouchSensors, TouchState

__all__ = ["TouchSensors", "TouchState", "add_sensor"]
