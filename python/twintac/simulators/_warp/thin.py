"""Bodies that are known by samples, and how thin they are under their faces."""

from typing import Any

import numpy as np
import warp as wp

from ... import arrays
from ...arrays._samples import thin_faces

wp.set_module_options({"enable_backward": False})

# Smallest upward component of the normal of a top.
_LEAST_TOP = 0.25


@wp.struct
class Faces:
    """The faces under which bodies are thin."""

    thin: wp.array[int]
    """Indices of the bodies that have such faces."""
    first: wp.array[int]
    """Index of the first face of each body, and their number, `[n_geoms + 1]`."""
    normal: wp.array[wp.vec3]
    half_mm: wp.array[float]
    """Half of the thickness under each face."""


def faces(shapes: arrays.Shapes, device: Any) -> Faces:
    """The faces of shapes of NumPy, `[n_geoms]`, on a device."""
    n_geoms = len(shapes.grown_mm)
    normals, halves_mm, counts = [np.zeros((0, 3))], [np.zeros(0)], np.zeros(n_geoms, int)
    if shapes.samples is not None and shapes.is_sampled is not None:
        known: dict[int, Any] = {}  # equal shapes share their samples
        for geom in np.flatnonzero(shapes.is_sampled):
            samples = shapes.samples.of(int(geom))
            if int(samples.first) not in known:
                known[int(samples.first)] = thin_faces(samples)
            normal, half_mm = known[int(samples.first)]
            normals.append(normal)
            halves_mm.append(half_mm)
            counts[geom] = len(half_mm)
    found = Faces()
    found.thin = wp.array(np.flatnonzero(counts), dtype=int, device=device)
    found.first = wp.array(np.append(0, counts.cumsum()), dtype=int, device=device)
    found.normal = wp.array(np.concatenate(normals), dtype=wp.vec3, device=device)
    found.half_mm = wp.array(np.concatenate(halves_mm), dtype=float, device=device)
    return found


@wp.func
def is_thin(faces: Faces, geom: int, depth_mm: float, up: wp.vec3) -> bool:
    """Whether a point at this depth inside of a body may be nearer to a top than to the lower
    side.
    """
    for face in range(faces.first[geom], faces.first[geom + 1]):
        if depth_mm > faces.half_mm[face] and wp.dot(faces.normal[face], up) > _LEAST_TOP:
            return True
    return False
