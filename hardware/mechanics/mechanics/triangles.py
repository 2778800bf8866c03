"""The surface of a solid as triangles without gaps.

Equal corners are merged, and triangles without area are left out.
"""

from __future__ import annotations

import struct

import numpy as np
import numpy.typing as npt
from build123d import Solid
from OCP.BRepMesh import BRepMesh_IncrementalMesh

from mechanics import fits

Corners = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]
# Corners nearer to each other than this are merged, mm: the faces of the CAD kernel agree at their
# edges to about 1e-7 mm.
SAME = 1e-4


def triangles(solid: Solid) -> tuple[Corners, Faces]:
    """Corners and triangles, within `STL_DEFLECTION` of the exact surface."""
    BRepMesh_IncrementalMesh(solid.wrapped, fits.STL_DEFLECTION, False, fits.STL_ANGLE, False)
    vertices, faces = solid.tessellate(fits.STL_DEFLECTION, fits.STL_ANGLE)
    points = np.array([[v.X, v.Y, v.Z] for v in vertices])
    places, numbers = np.unique(np.round(points / SAME).astype(np.int64), axis=0, return_inverse=True)
    indices = numbers.reshape(-1)[np.array(faces, dtype=np.int64)]
    a, b, c = indices.T
    kept = indices[(a != b) & (b != c) & (c != a)]
    return places.astype(np.float64) * SAME, np.asarray(kept, dtype=np.int64)


def stl_bytes(corners: Corners, faces: Faces) -> bytes:
    """A binary STL file."""
    points = corners.astype(np.float32)[faces]
    normals = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]).astype(np.float64)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    record = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("nothing", "<u2")])
    record["normal"], record["corners"] = unit, points
    return b"\0" * 80 + struct.pack("<I", len(faces)) + record.tobytes()
