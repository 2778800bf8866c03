"""The surrogate of the gel as a pure function of arrays of NumPy, PyTorch or JAX: for thousands of
sensors at once, on the device of the arrays, and with gradients.

`load` turns a `FastGel` into arrays; `ball`, `box` and other functions make shapes, and `stack`
combines them. `read` computes pressures, force and gap from poses. With `friction`, `step` goes
from one time step to the next; it takes the state of the gels and returns the new one. `read_twin`
adds a trained twin (`twin`), and `deliver` the sensor variation (`spread`, `draw`, `connected`).

All data are tuples of arrays, and no function keeps a state, so that `jit`, `vmap` and `grad` work.
No array is copied to the host. PyTorch and NumPy 1 need the package array-api-compat. On CPUs
alone, `FastBatch` is several times faster.
"""

from ._channels import contact, history, proximity, push
from ._convert import convert
from ._friction import Friction, Held, HeldReading, friction, held, step
from ._gel import Gel, Layer, Network, load
from ._pose import gel_from_body, rotation_of
from ._random import keys
from ._read import Reading, read
from ._samples import Samples
from ._select import select
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
from ._twin import Relaxed, Twin, read_twin, rested, twin
from ._variation import (
    Bus,
    Drawn,
    Spread,
    as_described,
    connected,
    deliver,
    draw,
    installed,
    spread,
    stiffened,
)

__all__ = [
    "Bus",
    "Drawn",
    "Friction",
    "Gel",
    "Held",
    "HeldReading",
    "Layer",
    "Network",
    "Reading",
    "Relaxed",
    "Samples",
    "Shapes",
    "Spread",
    "Twin",
    "as_described",
    "ball",
    "box",
    "capsule",
    "centered",
    "choose",
    "connected",
    "contact",
    "convert",
    "cylinder",
    "deliver",
    "draw",
    "ellipsoid",
    "friction",
    "gel_from_body",
    "held",
    "history",
    "installed",
    "keys",
    "load",
    "mesh",
    "plane",
    "proximity",
    "push",
    "read",
    "read_twin",
    "rested",
    "rotation_of",
    "select",
    "spread",
    "stack",
    "step",
    "stiffened",
    "twin",
]
