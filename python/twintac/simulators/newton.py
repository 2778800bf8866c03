"""Touch in Newton, on the device of its state. It needs `newton` and `torch`.

    sensors = Sensors(model, ["*touch"], shapes=["*block"])  # sites and shapes, by their labels
    state.clear_forces()
    touch = sensors.push(state, dt)                          # adds to state.body_f
    solver.step(state, state_after, control, contacts, dt)

Each site (`builder.add_site`) is the frame of a gel, with z out of the board. The sensors launch
kernels of Warp alone, so that `push` and the solver's step can be captured in a graph.
"""

import os
from fnmatch import fnmatchcase

import newton
import numpy as np
import numpy.typing as npt
import torch
import warp as wp

from .. import FastGel, Shape, arrays
from ..arrays._shapes import from_samples
from ._moment import Poses, Touch
from ._scene import Places, scene
from ._shapes import primitive
from ._warp import WarpGels

__all__ = ["Sensors", "Touch"]

_Ints = npt.NDArray[np.intp]


class Sensors:
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
        self.scene = scene(
            places, felt, gel, friction, retardation_s, None, follows_thin=True
        )
        # For each world, the indices of the corresponding bodies.
        in_worlds = np.full((len(chosen), len(own)), -1)
        for place, number in enumerate(local):
            in_worlds[:, number] = body[chosen[:, place]]
        device = model.body_q.device
        transforms = model.shape_transform.numpy()[chosen]
        self._local = wp.array(transforms, dtype=wp.transform, device=device)
        self._body_of = wp.array(body[chosen], dtype=int, device=device)
        self._body = wp.array(in_worlds, dtype=int, device=device)
        self._pushed = wp.array(in_worlds[:, self.scene.body], dtype=int, device=device)
        self._middle_m = model.body_com
        n_worlds, n_places = chosen.shape
        self._position_m = wp.zeros((n_worlds, n_places), dtype=wp.vec3, device=device)
        self._rotation = wp.zeros((n_worlds, n_places), dtype=wp.mat33, device=device)
        self._middle_in_world_m = wp.zeros((n_worlds, len(own)), dtype=wp.vec3, device=device)
        # The sites come first, then the shapes.
        self._poses = Poses(
            self._position_m[:, :n_sites],
            self._rotation[:, :n_sites],
            self._position_m[:, n_sites:],
            self._rotation[:, n_sites:],
            self._middle_in_world_m,
        )
        self._gels = WarpGels(self.scene, gel, n_worlds, device)
        self.touch: Touch = self._gels.touch()
        """The last output of the sensors: tensors that each push changes."""

    def push(self, state: newton.State, dt: float) -> Touch:
        """Reads the sensors, and adds the forces of the gels on bodies to `state.body_f`. Call
        `state.clear_forces()` before, and make the solver's step afterwards.

        Args:
            state: the state with the poses.
            dt: time since the last call, s; 0 replaces the last time step. A captured call keeps
                the time that it was captured with.

        Returns:
            The output of the sensors, which is `touch`: tensors that each push changes.
        """
        device = self._position_m.device
        wp.launch(
            _place,
            self._position_m.shape,
            [state.body_q, self._body_of, self._local],
            [self._position_m, self._rotation],
            device=device,
        )
        wp.launch(
            _place_middles,
            self._body.shape,
            [state.body_q, self._body, self._middle_m],
            [self._middle_in_world_m],
            device=device,
        )
        self._gels.pass_time(dt)
        self._gels.launch(self._poses)
        push = self._gels.push
        wp.launch(_apply, push.shape, [self._pushed, push], [state.body_f], device=device)
        return self.touch

    def forget(self, worlds: torch.Tensor | slice | None = None) -> None:
        """Resets the gels.

        Args:
            worlds: indices of the worlds, or a mask; all worlds unless given.
        """
        self._gels.forget(worlds)


@wp.kernel
def _place(
    body_q: wp.array[wp.transform],
    body: wp.array2d[int],
    local: wp.array2d[wp.transform],
    position_m: wp.array2d[wp.vec3],
    rotation: wp.array2d[wp.mat33],
) -> None:
    """Poses in the world of what has a pose in the frame of a body; -1 is the world."""
    w, place = wp.tid()
    pose = local[w, place]
    if body[w, place] >= 0:
        pose = body_q[body[w, place]] * pose
    position_m[w, place] = wp.transform_get_translation(pose)
    rotation[w, place] = wp.quat_to_matrix(wp.transform_get_rotation(pose))


@wp.kernel
def _place_middles(
    body_q: wp.array[wp.transform],
    body: wp.array2d[int],
    middle_m: wp.array[wp.vec3],
    position_m: wp.array2d[wp.vec3],
) -> None:
    """Centres of mass of bodies in the world."""
    w, b = wp.tid()
    if body[w, b] >= 0:
        position_m[w, b] = wp.transform_point(body_q[body[w, b]], middle_m[body[w, b]])


@wp.kernel
def _apply(
    body: wp.array2d[int],
    push: wp.array2d[wp.spatial_vector],
    body_f: wp.array[wp.spatial_vector],
) -> None:
    w, b = wp.tid()
    if body[w, b] >= 0:
        wp.atomic_add(body_f, body[w, b], push[w, b])


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
        return from_samples(Shape.surface(corners_mm, np.asarray(mesh.indices).reshape(-1, 3)))
    shape = primitive(kind.name, half_m)
    if shape is None:
        raise ValueError(f"shape `{label}` is a {kind.name}, which sensors do not feel")
    return shape
