"""Touch in Newton, with PyTorch on the device of its state. It needs `newton` and `torch`.

    sensors = Sensors(model, ["*touch"], shapes=["*block"])  # sites and shapes, by their labels
    state.clear_forces()
    touch = sensors.push(state, dt)                          # adds to state.body_f
    solver.step(state, state_after, control, contacts, dt)

Each site (`builder.add_site`) is the frame of a gel, with z out of the board. The sensors have not
been tried inside of a captured CUDA graph.
"""

import os
from fnmatch import fnmatchcase
from typing import Any

import newton
import numpy as np
import numpy.typing as npt
import torch
import warp as wp

from .. import FastGel, Shape, arrays
from ._gels import Gels, placed
from ._moment import Memory, Poses, Touch
from ._scene import Places, scene
from ._shapes import primitive

__all__ = ["Memory", "Sensors", "Touch"]

_Ints = npt.NDArray[np.intp]


class Sensors(Gels):
    """Sensors in all worlds of a model. The worlds must be alike.

    Shapes that touch gels should not collide with the sensor's body: the body would carry them
    instead of the gel. With steps of 2 ms or less, bodies of 20 g and more stay at rest on a gel.

    Args:
        model: the model.
        sites: labels of the sites, or patterns of labels with `*`; the same number in each world.
        shapes: labels of the shapes that can touch, or patterns; the same number in each world.
            Shapes outside of all worlds can touch in each world. Shapes of the sensor's own rigid
            part never touch it.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.

    Raises:
        ValueError: for labels that nothing has, worlds that differ, and shapes of unsupported
            types.
    """

    def __init__(
        self,
        model: newton.Model,
        sites: list[str],
        *,
        shapes: list[str],
        gel: FastGel | str | os.PathLike[str] | bytes | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
    ) -> None:
        site, shape = _in_worlds(model, "sites", sites), _in_worlds(model, "shapes", shapes)
        body = model.shape_body.numpy()
        # The bodies of the first world stand for those of all worlds; bodies outside of all worlds
        # are among them.
        own = np.unique(np.concatenate([[-1], body[site[0]], body[shape[0]]]))
        chosen = np.concatenate([site, shape], axis=1)
        local = np.searchsorted(own, body[chosen[0]])
        # The world is the last one.
        part_of = np.append(_parts(model), -1)[own]
        n_sites = site.shape[1]
        places = Places(
            site=np.arange(n_sites),
            geom=np.arange(shape.shape[1]),
            body_of_sensor=local[:n_sites],
            body_of_geom=local[n_sites:],
            moves=part_of >= 0,
            part_of=part_of,
        )
        felt = [_shape(model, shape[:, place]) for place in range(shape.shape[1])]
        like = wp.to_torch(model.body_q)
        found = scene(places, felt, gel, friction, retardation_s, like)
        # For each world, the indices of the corresponding bodies.
        in_worlds = np.full((len(chosen), len(own)), -1)
        for place, number in enumerate(local):
            in_worlds[:, number] = body[chosen[:, place]]
        self._local = wp.to_torch(model.shape_transform)[torch.tensor(chosen, device=like.device)]
        self._body_of = torch.tensor(body[chosen], device=like.device)
        self._body = torch.tensor(in_worlds, device=like.device)
        self._middle = wp.to_torch(model.body_com)
        self._n_sites = n_sites
        self._begin(found, self._poses(model.body_q))

    def push(self, state: newton.State, dt: float) -> Touch:
        """Reads the sensors, and adds the forces of the gels on bodies to `state.body_f`. Call
        `state.clear_forces()` before, and make the solver's step afterwards.

        Args:
            state: the state with the poses.
            dt: time since the last call, s.

        Returns:
            The output of the sensors.
        """
        with torch.no_grad():
            touch = self._step(self._poses(state.body_q), dt)
            pushed = self._body[:, self.scene.body].flatten()
            wp.to_torch(state.body_f).index_add_(0, pushed, touch.push.flatten(0, 1))
        return touch

    def _poses(self, body_q: Any) -> Poses:
        """Poses of sites, shapes and bodies, from those of bodies: position, m, and quaternion, w
        last.
        """
        of_body = wp.to_torch(body_q)
        still = torch.tensor([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], device=of_body.device)

        def rows_of(body: torch.Tensor) -> torch.Tensor:
            return torch.where((body >= 0)[..., None], of_body[body], still)

        rows, middle = rows_of(self._body_of), rows_of(self._body)
        turn = arrays.rotation_of(rows[..., 3:])
        own_turn = arrays.rotation_of(self._local[..., 3:])
        place_m, turn = placed(rows[..., :3], turn, self._local[..., :3], own_turn)
        lever_m = (arrays.rotation_of(middle[..., 3:]) * self._middle[self._body][..., None, :]).sum(-1)
        n = self._n_sites
        return Poses(
            place_m[:, :n], turn[:, :n], place_m[:, n:], turn[:, n:], middle[..., :3] + lever_m
        )


def _in_worlds(model: newton.Model, field: str, labels: list[str]) -> _Ints:
    """Indices of the shapes with these labels, `[n_worlds, n]`."""
    has_one = (any(fnmatchcase(own, label) for label in labels) for own in model.shape_label)
    found = np.flatnonzero(np.fromiter(has_one, bool))
    if not len(found):
        raise ValueError(f"`{field}` is {labels}, which no shape of the model is labelled")
    world = model.shape_world.numpy()[found]
    n_worlds = max(1, model.world_count)
    in_all = found[world < 0] if model.world_count else found
    rows = [found[world == number] for number in range(model.world_count)] or [found[:0]]
    if len({len(row) for row in rows}) > 1:
        counts = [len(row) for row in rows]
        raise ValueError(f"`{field}` is {labels}, of which worlds have {counts}: they have to be alike")
    return np.array([np.concatenate([row, in_all]) for row in rows]).reshape(n_worlds, -1)


def _parts(model: newton.Model) -> _Ints:
    """For each body, the first body of the rigid part that fixed joints make of bodies; -1 for what
    is fixed to the world.
    """
    part_of = np.arange(model.body_count)
    fixed = model.joint_type.numpy() == int(newton.JointType.FIXED)
    ends = zip(model.joint_parent.numpy()[fixed], model.joint_child.numpy()[fixed])
    for parent, child in ends:
        first = part_of[parent] if parent >= 0 else -1
        part_of[part_of == part_of[child]] = first
    return part_of


def _shape(model: newton.Model, numbers: _Ints) -> arrays.Shapes:
    """The shape, which is the same in all worlds, with Newton's origin."""
    first, label = int(numbers[0]), model.shape_label[int(numbers[0])]
    scales, kinds = model.shape_scale.numpy()[numbers], model.shape_type.numpy()[numbers]
    sources = {id(model.shape_source[int(number)]) for number in numbers}
    if (scales != scales[0]).any() or (kinds != kinds[0]).any() or len(sources) > 1:
        raise ValueError(f"shape `{label}` differs from world to world: they have to be alike")
    kind, half_m = newton.GeoType(int(kinds[0])), scales[0].astype(float)
    if kind in (newton.GeoType.MESH, newton.GeoType.CONVEX_MESH):
        mesh = model.shape_source[first]
        corners_mm = np.asarray(mesh.vertices, float) * 1e3 * half_m
        return arrays.mesh(Shape.surface(corners_mm, np.asarray(mesh.indices).reshape(-1, 3)))
    shape = primitive(kind.name, half_m)
    if shape is None:
        raise ValueError(f"shape `{label}` is a {kind.name}, which sensors do not feel")
    return shape
