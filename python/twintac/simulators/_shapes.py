"""Shapes of simulators, with their origins in their middles."""

import numpy as np
import numpy.typing as npt

from .. import arrays


def primitive(kind: str, half_m: npt.ArrayLike) -> arrays.Shapes | None:
    """A shape by the name that simulators share, or `None` for another kind.

    Args:
        kind: `sphere`, `box`, `cylinder`, `capsule`, `ellipsoid` or `plane`, in any case.
        half_m: half sizes, m: the radius of a sphere; half of a box along each axis; radius and half
            height of a cylinder, and of a capsule without its ends; half axes of an ellipsoid.
    """
    a_mm, b_mm, c_mm = [*(1e3 * np.asarray(half_m, float).reshape(-1)).tolist(), 0.0, 0.0, 0.0][:3]
    match kind.lower():
        case "plane":
            return arrays.plane()
        case "sphere":
            return arrays.centered(arrays.ball(a_mm))
        case "box":
            return arrays.centered(arrays.box((2.0 * a_mm, 2.0 * b_mm, 2.0 * c_mm)))
        case "cylinder":
            return arrays.centered(arrays.cylinder(a_mm, 2.0 * b_mm))
        case "capsule":
            return arrays.centered(arrays.capsule(a_mm, 2.0 * (a_mm + b_mm)))
        case "ellipsoid":
            return arrays.centered(arrays.ellipsoid((a_mm, b_mm, c_mm)))
    return None
