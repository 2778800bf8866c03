"""Intersections of rays with triangles, and distances from a surface."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import trimesh
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

Array = npt.NDArray[np.float64]


class Surface:
    """A mesh for ray intersections and distances."""

    def __init__(self, mesh: trimesh.Trimesh) -> None:
        self.mesh = mesh
        points = vtk.vtkPoints()
        points.SetData(numpy_to_vtk(np.ascontiguousarray(mesh.vertices, dtype=np.float64), deep=True))
        faces = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces]).astype(np.int64).ravel()
        cells = vtk.vtkCellArray()
        cells.ImportLegacyFormat(numpy_to_vtkIdTypeArray(faces, deep=True))
        self._data = vtk.vtkPolyData()
        self._data.SetPoints(points)
        self._data.SetPolys(cells)
        self._locator = vtk.vtkStaticCellLocator()
        self._locator.SetDataSet(self._data)
        self._locator.BuildLocator()

    def first_hit(self, start: Array, direction: Array, reach: float) -> tuple[float, int] | None:
        """Distance to the first triangle along a ray, mm, and the triangle's index; `None` without
        a hit.
        """
        t, cell, sub = vtk.reference(0.0), vtk.reference(0), vtk.reference(0)
        at, parametric = [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        end = start + reach * direction
        if not self._locator.IntersectWithLine(start, end, 1e-9, t, at, parametric, sub, cell):
            return None
        return float(t) * reach, int(cell)

    def distance(self, point: Array) -> float:
        """Distance to the nearest point of the surface, mm."""
        nearest, squared = [0.0, 0.0, 0.0], vtk.reference(0.0)
        cell, sub = vtk.reference(0), vtk.reference(0)
        self._locator.FindClosestPoint(point, nearest, cell, sub, squared)
        return math.sqrt(float(squared))
