"""The fast gel as a pure function of arrays: of NumPy, PyTorch or JAX, of thousands of sensors at
once, on their device, and with gradients.

`load` makes arrays of a fast gel, `ball`, `box` and others shapes, `stack` puts them together, and
`read` goes from poses to pressures, force and gap. With `friction`, `step` goes from moment to
moment, with what gels remember in and out. All of it is tuples and functions without memory of
their own: `jit`, `vmap` and `grad` work on them. Whatever the library is, it needs no copy to the
host. On processors alone, `FastBatch` is several times faster.
"""

from ._convert import convert
from ._friction import Friction, Held, HeldReading, friction, held, step
from ._gel import Gel, Layer, Network, load
from ._pose import gel_from_body, rotation_of
from ._read import Reading, read
from ._samples import Samples
from ._shapes import (
    Shapes,
    ball,
    box,
    capsule,
    centered,
    choose,
    cylinder,
    ellipsoid,
    mesh,
    plane,
    stack,
)

__all__ = [
    "Friction",
    "Gel",
    "Held",
    "HeldReading",
    "Layer",
    "Network",
    "Reading",
    "Samples",
    "Shapes",
    "ball",
    "box",
    "capsule",
    "centered",
    "choose",
    "convert",
    "cylinder",
    "ellipsoid",
    "friction",
    "gel_from_body",
    "held",
    "load",
    "mesh",
    "plane",
    "read",
    "rotation_of",
    "stack",
    "step",
]
