"""The surrogate of the gel as arrays: the points where it evaluates distances, and its networks."""

import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import Error, FastGel
from ._convert import convert
from ._file import File, read_file
from ._namespace import Array

_Floats = npt.NDArray[np.float64]

N_LEVELS = 3
# Heights of the levels at which distances are evaluated, and the largest depth that counts, mm, for
# points 2 mm apart; in proportion for points that are farther apart.
LEVELS_MM = (0.0, -1.5, -3.0)
_DEEPEST_MM = 4.0
SPACING_MM = 2.0
# Gap up to which a contact counts wholly, and gap from which nothing touches, in spacings of
# points: a body may touch between points.
_TOUCHED = (0.05, 0.25)
# Pressure, kPa, and wrench, N and N mm, that an output of 1 of the networks stands for.
_PRESSURE_KPA = 50.0
_WRENCH = (1.0, 1.0, 10.0, 30.0, 30.0, 10.0)
# The influence of the gel's edges decays by a factor of e over this fraction of the gel's height.
_EDGE_DECAY = 0.5
# Fractions of a spacing below this count as 0.
_ROUNDING = 1e-6
# Largest number of weights of all ports together: they take 0.5 GB in single precision.
_MOST_WEIGHTS = 2**27


class Layer(NamedTuple):
    """A linear layer of a network."""

    weight: Array
    """The weights, `[n_inputs, n_outputs]`."""
    bias: Array
    """The biases, `[n_outputs]`."""


class Network(NamedTuple):
    """A network that processes each point alone, then, for each row, all points near the row."""

    point: Layer
    """The layer from the levels of a point to its features."""
    rows: Array
    """The weights from the features of all points to the first hidden units of each row,
    `[n_points * n_features, n_rows * n_hidden]`.
    """
    bias: Array
    """The biases of the first hidden units, `[n_rows, n_hidden]`."""
    layers: tuple[Layer, ...]
    """The following layers, shared by all rows; the last one has `n_outputs`."""
    near: Array
    """1 where a row sees a point, else 0, `[n_points, n_rows]`."""
    unit: Array
    """The value that an output of 1 stands for, `[n_rows * n_outputs]`."""


class Gel(NamedTuple):
    """A surrogate of the gel as arrays, all of one library: the result of `load`. It is a tuple, so
    that it may be an argument of compiled functions, and gradients may be taken with respect to it.
    """

    points_mm: Array
    """The points of the surface at which distances are evaluated, in the gel's frame,
    `[3, n_points]`; the points of the first grid come first.
    """
    levels_mm: Array
    """Heights of the levels relative to the points, `[n_points, 3]`."""
    deepest_mm: Array
    """The largest depth that counts at each point, `[n_points, 1]`."""
    highest_mm: Array
    """Height of the highest point of each point's grid, `[n_points]`, or `[1]` for all."""
    touched_mm: Array
    """Gap up to which a contact counts wholly, and gap from which nothing touches, `[2]`."""
    pressure: Network
    """The network of the pressures at the ports."""
    wrench: Network
    """The network of force and torque, from the points of the first grid."""
    ports_mm: Array
    """Positions of the ports in the plane of the gel, `[n_taxels, 2]`."""
    center_mm: Array
    """The centre of the top of the gel's bounding box, the reference point of torques, `[3]`."""


def load(source: FastGel | str | os.PathLike[str] | bytes, *, like: Array | None = None) -> Gel:
    """Loads a surrogate of the gel as arrays.

    Args:
        source: a `FastGel`, a file that `twintac fast train` has made, or the bytes of such a file.
        like: an array of the library, precision and device of the result; NumPy in single precision
            unless given.

    Returns:
        The surrogate, for `read` and `step`.

    Raises:
        Error: with the file if it is not a surrogate of the gel, and for more ports than fit into
            one matrix (about 2,000 on PhysTac's gel).
    """
    file = read_file(source)
    try:
        gel = _gel(file)
    except (KeyError, IndexError, TypeError, ValueError) as error:
        if isinstance(error, Error):
            raise
        raise Error(f"this surrogate of the gel cannot be read: {error!r}") from error
    return convert(gel, np.zeros(0, np.float32) if like is None else like)


class Grid(NamedTuple):
    first_mm: _Floats
    spacing_mm: float
    n: tuple[int, int]
    height_mm: _Floats
    first_point: int

    def point(self, i: int, j: int) -> int | None:
        """Index of a point among the points of all grids; `None` outside the grid."""
        is_there = 0 <= i < self.n[0] and 0 <= j < self.n[1]
        return self.first_point + j * self.n[0] + i if is_there else None

    def cell(self, at_mm: _Floats) -> tuple[int, int, _Floats]:
        """Column and row of the cell that contains a location, and the offset of the location in
        the cell, as fractions of the spacing.
        """
        cells = (at_mm - self.first_mm) / self.spacing_mm + 1e-9
        corner = np.floor(cells)
        return int(corner[0]), int(corner[1]), cells - corner

    def has(self, at_mm: _Floats) -> bool:
        """Whether a point of the grid, or of its continuation beyond the border, is above a
        location.
        """
        return bool(np.hypot(*self.cell(at_mm)[2]) < _ROUNDING)

    def height_mm_at(self, at_mm: _Floats) -> float:
        """Height of the gel at a location, mm, linear between points; outside the grid the height
        at its border.
        """
        i, j, part = self.cell(at_mm)
        i0, i1 = (min(max(i + step, 0), self.n[0] - 1) for step in (0, 1))
        j0, j1 = (min(max(j + step, 0), self.n[1] - 1) for step in (0, 1))
        z = self.height_mm.reshape(self.n[1], self.n[0])
        rows = [z[k, i0] + part[0] * (z[k, i1] - z[k, i0]) for k in (j0, j1)]
        return float(rows[0] + part[1] * (rows[1] - rows[0]))


def grids_of(header: dict[str, Any]) -> list[Grid]:
    found: list[Grid] = []
    first_point = 0
    for grid in header["layout"]["grids"]:
        height_mm = np.array(grid["height_mm"], np.float64)
        n = (int(grid["n"][0]), int(grid["n"][1]))
        first_mm = np.array(grid["first_mm"], np.float64)
        found.append(Grid(first_mm, float(grid["spacing_mm"]), n, height_mm, first_point))
        first_point += len(height_mm)
    return found


def _gel(file: File) -> Gel:
    header, grids = file.header, grids_of(file.header)
    points, levels, deepest, highest = [], [], [], []
    for grid in grids:
        row, column = np.divmod(np.arange(len(grid.height_mm)), grid.n[0])
        x_mm, y_mm = (
            grid.first_mm[axis] + grid.spacing_mm * part for axis, part in enumerate((column, row))
        )
        points.append(np.stack([x_mm, y_mm, grid.height_mm]))
        scale = max(grid.spacing_mm / SPACING_MM, 1.0)
        levels.append(np.tile(np.multiply(LEVELS_MM, scale), (len(row), 1)))
        deepest.append(np.full((len(row), 1), scale * _DEEPEST_MM))
        highest.append(np.full(len(row), grid.height_mm.max()))
    highest_mm = np.concatenate(highest)
    return Gel(
        points_mm=np.concatenate(points, axis=1),
        levels_mm=np.concatenate(levels),
        deepest_mm=np.concatenate(deepest),
        highest_mm=highest_mm[:1] if (highest_mm == highest_mm[0]).all() else highest_mm,
        touched_mm=np.multiply(_TOUCHED, grids[0].spacing_mm),
        pressure=_pressure(file, grids),
        wrench=_of_all_points(file, "wrench", grids[0], np.array(_WRENCH)),
        ports_mm=np.array(header["ports_mm"], np.float64).reshape(-1, 2),
        center_mm=np.array(header["center_mm"], np.float64),
    )


def _pressure(file: File, grids: list[Grid]) -> Network:
    """The network of the pressures: of all taxels together if there is one, else of patches."""
    n_ports = len(file.header["ports_mm"])
    if file.layers("taxels"):
        return _of_all_points(file, "taxels", grids[0], np.full(n_ports, _PRESSURE_KPA))
    return _of_patches(file, grids)


def _of_all_points(file: File, name: str, grid: Grid, unit: _Floats) -> Network:
    """A network of one row that sees all points of a grid."""
    point, first, *rest = (Layer(*layer) for layer in file.layers(name))
    n_inputs = len(grid.height_mm) * len(point.bias)
    return Network(
        point=point,
        rows=first.weight[:n_inputs],
        bias=first.bias[None],
        layers=tuple(rest),
        near=np.ones((len(grid.height_mm), 1)),
        unit=unit,
    )


def _of_patches(file: File, grids: list[Grid]) -> Network:
    """A network with a row for each port; the row sees the points of the port's patch."""
    point, first, *rest = (Layer(*layer) for layer in file.layers("pressure"))
    offsets = [(int(i), int(j)) for i, j in file.header["layout"]["patch"]["offsets"]]
    ports_mm = np.array(file.header["ports_mm"], np.float64).reshape(-1, 2)
    n_features, n_hidden, n_ports = len(point.bias), len(first.bias), len(ports_mm)
    n_points = sum(len(grid.height_mm) for grid in grids)
    if n_points * n_features * n_ports * n_hidden > _MOST_WEIGHTS:
        most = _MOST_WEIGHTS // (n_points * n_features * n_hidden)
        raise Error(f"the gel has {n_ports} ports, expected at most {most}", field="source")
    n_own = len(offsets) * n_features
    own = first.weight[:n_own].astype(np.float64).reshape(len(offsets), n_features, n_hidden)
    rows = np.zeros((n_points, n_features, n_ports, n_hidden), np.float32)
    near = np.zeros((n_points, n_ports))
    for port, at_mm in enumerate(ports_mm):
        grid = next((grid for grid in grids if grid.has(at_mm)), grids[0])
        i, j, _ = grid.cell(at_mm)
        for offset, weights in _patch(grid.cell(at_mm)[2], offsets, own).items():
            if (number := grid.point(i + offset[0], j + offset[1])) is not None:
                rows[number, :, port] = weights
                near[number, port] = 1.0
    # The features of a port are constant, so they go into the bias. The feature of the mesh's
    # coarseness is 0.
    about = np.stack([_describe(file.header, grids[0], at_mm) for at_mm in ports_mm])
    return Network(
        point=point,
        rows=rows.reshape(n_points * n_features, n_ports * n_hidden),
        bias=first.bias + about @ first.weight[n_own : n_own + about.shape[1]],
        layers=tuple(rest),
        near=near,
        unit=np.full(n_ports, _PRESSURE_KPA),
    )


def _patch(
    part: _Floats, offsets: list[tuple[int, int]], own: _Floats
) -> dict[tuple[int, int], _Floats]:
    """The weights of a port, by the offsets of points from the port's cell: those of the patch if
    the port is at a point, else interpolated linearly between the patches at the cell's four
    corners. `part` is the offset of the port in its cell, as fractions of the spacing.
    """
    if np.hypot(*part) < _ROUNDING:
        return dict(zip(offsets, own))
    found: dict[tuple[int, int], _Floats] = {}
    for corner in ((0, 0), (1, 0), (0, 1), (1, 1)):
        share = np.prod([part[axis] if corner[axis] else 1.0 - part[axis] for axis in (0, 1)])
        if share >= _ROUNDING:
            for (i, j), weights in zip(offsets, own):
                key = (i + corner[0], j + corner[1])
                found[key] = found.get(key, 0.0) + share * weights
    return found


def _describe(header: dict[str, Any], grid: Grid, at_mm: _Floats) -> _Floats:
    """Features of a location at the base of the gel, `[13]`: the proximity of each edge and its
    square, and how much lower the gel is than at its highest point, above the location and on each
    side.
    """
    around = header["layout"]["surroundings"]
    decay_mm = _EDGE_DECAY * around["height_mm"]
    near, sides = [], []
    for axis in (0, 1):
        for edge_mm, way in ((around["low_mm"][axis], -1.0), (around["high_mm"][axis], 1.0)):
            near.append(np.exp(-max(way * (edge_mm - at_mm[axis]), 0.0) / decay_mm))
            side_mm = at_mm.copy()
            side_mm[axis] += way * decay_mm
            sides.append(1.0 - grid.height_mm_at(side_mm) / around["height_mm"])
    above = 1.0 - grid.height_mm_at(at_mm) / around["height_mm"]
    return np.array([*near, *np.square(near), above, *sides])
