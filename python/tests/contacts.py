"""Random contacts, for the surrogate of the gel in Rust and as arrays, for tests and benchmarks."""

import importlib
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from twintac import Body, FastGel, Shape, arrays
from twintac.arrays._shapes import from_samples

_Float = npt.NDArray[np.float64]

CUBE = np.array([[x, y, z] for x in (-3.0, 3.0) for y in (-4.0, 4.0) for z in (0.0, 9.0)])
CUBES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
)


def simple() -> list[tuple[arrays.Shapes, Shape]]:
    """Shapes for which Rust and arrays have the same formulas."""
    return [
        (arrays.ball(2.5), Shape.sphere(2.5)),
        (arrays.ball(6.0), Shape.sphere(6.0)),
        (arrays.ball(12.5), Shape.sphere(12.5)),
        (arrays.box((8.0, 6.0, 10.0), 0.8), Shape.box((8.0, 6.0, 10.0), 0.8)),
        (arrays.box((10.0, 12.0, 2.0)), Shape.box((10.0, 12.0, 2.0), 0.0)),
        (arrays.cylinder(4.0, 10.0, 0.5), Shape.cylinder(4.0, 10.0, 0.5)),
        (arrays.cylinder(6.0, 1.5, 0.2), Shape.cylinder(6.0, 1.5, 0.2)),
        (arrays.capsule(3.0, 14.0), Shape.cylinder(3.0, 14.0, 2.99999)),
    ]


def meshes() -> list[tuple[arrays.Shapes, Shape]]:
    """Shapes that Rust and arrays sample."""
    shapes = [Shape.surface(CUBE, CUBES), Shape.triangle(12.0, 10.0, 0.5), Shape.wedge(1.2, 14.0, 12.0, 0.5)]
    return [(from_samples(shape), shape) for shape in shapes]


class Contacts(NamedTuple):
    """Bodies on as many sensors as there are rows."""

    number: npt.NDArray[np.int32]
    """Index of the shape of each body, `[n, n_bodies]`."""
    position_mm: _Float
    """Positions of the bodies, `[n, n_bodies, 3]`."""
    quaternion: _Float
    """Orientations, `(x, y, z, w)`, `[n, n_bodies, 4]`."""

    def by_rust(self, gel: FastGel, shapes: list[Shape], n_threads: int = 1) -> tuple[Any, Any]:
        """Pressures and wrenches of `FastBatch`."""
        n, n_bodies = self.number.shape
        poses = np.concatenate([self.position_mm, self.quaternion], axis=-1).reshape(-1, 7)
        batch = gel.batch([Body(shape) for shape in shapes], n_threads)
        return batch.read(poses, self.number.ravel(), n_bodies * np.arange(1, n + 1))

    def by_arrays(self, gel: arrays.Gel, shapes: arrays.Shapes, xp: Any = np) -> arrays.Reading:
        """The output with the arrays of a library."""
        precision = np.dtype(str(gel.points_mm.dtype).rpartition(".")[2])
        pose = (xp.asarray(values.astype(precision)) for values in (self.position_mm, self.quaternion))
        work = compiled(xp, _read)
        found: arrays.Reading = work(gel, arrays.convert(shapes, gel.points_mm), xp.asarray(self.number), *pose)
        return found


def compiled(xp: Any, function: Any) -> Any:
    """The function, compiled if it is of JAX, which otherwise compiles each operation by itself."""
    return importlib.import_module("jax").jit(function) if xp.__name__ == "jax.numpy" else function


def _read(gel: arrays.Gel, shapes: arrays.Shapes, number: Any, position_mm: Any, quaternion: Any) -> arrays.Reading:
    return arrays.read(gel, arrays.choose(shapes, number), position_mm, arrays.rotation_of(quaternion))


def contacts(
    gel: arrays.Gel, n: int, n_bodies: int, n_shapes: int, seed: int = 1, *, tilted: float = 0.2, depth_mm: float = 4.0
) -> Contacts:
    """Bodies of random shapes at random positions over a gel of NumPy, from 1 mm above it to
    `depth_mm` deep. A fifth has random orientations, the others lean by about `tilted` radians.
    """
    random = np.random.default_rng(seed)
    low_mm, high_mm = gel.points_mm[:2].min(axis=1), gel.points_mm[:2].max(axis=1)
    place_mm = random.uniform(low_mm, high_mm, (n, n_bodies, 2))
    nearest = ((gel.points_mm[:2].T - place_mm[..., None, :]) ** 2).sum(axis=-1).argmin(axis=-1)
    height_mm = gel.points_mm[2][nearest] - random.uniform(-1.0, depth_mm, (n, n_bodies))
    quaternion = np.concatenate(
        [random.normal(0.0, 0.5 * tilted, (n, n_bodies, 2)), random.normal(0.0, 1.0, (n, n_bodies, 1)), np.ones((n, n_bodies, 1))], axis=-1
    )
    is_free = random.random((n, n_bodies, 1)) < 0.2
    quaternion = np.where(is_free, random.normal(0.0, 1.0, quaternion.shape), quaternion)
    quaternion /= np.linalg.norm(quaternion, axis=-1, keepdims=True)
    number = random.integers(0, n_shapes, (n, n_bodies)).astype(np.int32)
    return Contacts(number, np.concatenate([place_mm, height_mm[..., None]], axis=-1), quaternion)
