"""Touch in ManiSkill, with PyTorch on the device of its scene. It needs `mani_skill`.

    class Palm(BaseEnv):
        def _after_reconfigure(self, options):
            self.touch = Sensors([self.palm], touching=[self.block])

        def _before_simulation_step(self):
            self.touch.push()  # adds the forces of the gels to the step

        def _get_obs_extra(self, info):
            return {"pressure_kpa": self.touch.output.pressure_kpa}
"""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from mani_skill.utils.structs import Actor, Link
from sapien import Pose, physx

from .. import FastGel, Shape, arrays
from ..arrays._shapes import from_samples
from ._gels import Gels, local_pose, placed, rotation_of
from ._moment import Memory, Poses, Touch
from ._scene import Places
from ._scene import scene as scene_of
from ._shapes import primitive

__all__ = ["Memory", "Sensors", "Touch"]

# PhysX has the axis of cylinders and capsules, and the normal of planes, along x: this rotation
# turns z to x.
_Z_TO_X = Pose(q=(0.5**0.5, 0.0, 0.5**0.5, 0.0))


class Sensors(Gels):
    """Sensors on bodies, in all sub-scenes of a scene.

    Bodies that touch gels should not collide with the sensor's body: it would carry them instead of
    the gel. With steps of 2 ms or less, bodies of 20 g and more stay at rest on a gel, so set
    `SimConfig(sim_freq=500)` or more.

    On the CPU the gels push actors and links. On a GPU they push only dynamic actors: SAPIEN has no
    forces on links there, so the robot does not feel what its gels carry. This module has not been
    run on a GPU.

    Args:
        bodies: the actors or links that carry the sensors.
        touching: the actors or links that can touch them, with their collision shapes. The sensor's
            own body never touches it.
        position_mm: position of the gel's frame in the frame of each body, mm.
        quaternion: orientation of the gel's frame, z out of the board, in the frame of each body,
            `(x, y, z, w)`.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.

    Raises:
        ValueError: if there is no body or nothing that can touch, if nothing moves, for bodies that
            are not in each sub-scene, shapes that differ between sub-scenes, and unsupported
            shapes.
    """

    output: Touch
    """The output of the last `push`, `[n_envs, ...]`."""

    def __init__(
        self,
        bodies: Sequence[Actor | Link],
        *,
        touching: Sequence[Actor | Link],
        position_mm: tuple[float, float, float] = (0.0, 0.0, 0.0),
        quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
        gel: FastGel | str | os.PathLike[str] | bytes | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
    ) -> None:
        self._bodies = list({id(body): body for body in [*bodies, *touching]}.values())
        number = {id(body): place for place, body in enumerate(self._bodies)}
        shapes = [(body, shape) for body in touching for shape in _shapes(body)]
        places = Places(
            site=np.arange(len(bodies)),
            geom=np.arange(len(shapes)),
            body_of_sensor=np.array([number[id(body)] for body in bodies], int),
            body_of_geom=np.array([number[id(body)] for body, _ in shapes], int),
            moves=np.array([_moves(body) for body in self._bodies], bool),
            part_of=np.arange(len(self._bodies)),
        )
        like = torch.zeros(0, device=self._bodies[0].device if self._bodies else None)
        felt = [shape for _, (shape, *_) in shapes]
        found = scene_of(places, felt, gel, friction, retardation_s, like)
        self._sub_scenes = self._bodies[0].scene
        for body in self._bodies:
            if len(body._objs) != self._sub_scenes.num_envs:
                problem = f"is in {len(body._objs)} of {self._sub_scenes.num_envs} sub-scenes"
                raise ValueError(f"`{body.name}` {problem}, expected all")
        at = [local_pose(position_mm, quaternion, like)] * len(bodies)
        at += [local_pose(place_mm, turn, like) for _, (_, place_mm, turn) in shapes]
        self._local_m, self._local_turn = (torch.stack(own) for own in zip(*at))
        self._of = torch.tensor(np.concatenate([places.body_of_sensor, places.body_of_geom]), device=like.device)
        middles_m = [_middle_m(body) for body in self._bodies]
        self._middle_m = torch.stack(middles_m, dim=1)
        self._n_sensors = len(bodies)
        self._begin(found, self._poses())

    def push(self) -> Touch:
        """Reads the sensors, and adds the forces of the gels on bodies to the next step. Call it
        once before each step of the simulation.

        Returns:
            The output of the sensors.
        """
        with torch.no_grad():
            self.output = self._step(self._poses(), self._sub_scenes.timestep)
        for place, number in enumerate(self.scene.body.tolist()):
            _apply(self._bodies[number], self.output.push[:, place])
        if self._sub_scenes.gpu_sim_enabled:
            self._sub_scenes.px.gpu_apply_rigid_dynamic_force()
            self._sub_scenes.px.gpu_apply_rigid_dynamic_torque()
        return self.output

    def _poses(self) -> Poses:
        if self._sub_scenes.gpu_sim_enabled:
            self._sub_scenes.px.gpu_fetch_rigid_dynamic_data()
            self._sub_scenes.px.gpu_fetch_articulation_link_pose()
        pose = torch.stack([body.pose.raw_pose for body in self._bodies], dim=1)
        body_m, turn = pose[..., :3], rotation_of(pose[..., 3:])
        place_m, place_turn = placed(
            body_m[:, self._of], turn[:, self._of], self._local_m, self._local_turn
        )
        middle_m = body_m + (turn * self._middle_m[..., None, :]).sum(-1)
        n = self._n_sensors
        return Poses(
            place_m[:, :n], place_turn[:, :n], place_m[:, n:], place_turn[:, n:], middle_m
        )


def _middle_m(body: Actor | Link) -> torch.Tensor:
    """The centre of mass in the frame of the body, m, `[n_envs, 3]`."""
    if _moves(body):
        middle_m: torch.Tensor = body.cmass_local_pose.p
        return middle_m
    return torch.zeros(len(body._objs), 3, device=body.device)


def _moves(body: Actor | Link) -> bool:
    """Whether forces can be put on a body."""
    if isinstance(body, Link):
        return not body.scene.gpu_sim_enabled
    return bool(body.px_body_type == "dynamic")


def _apply(body: Actor | Link, push: torch.Tensor) -> None:
    """Puts a force, N, and a torque about the centre of mass, N m, on a body, `[n_envs, 6]`."""
    if body.scene.gpu_sim_enabled:
        index = body._body_data_index
        body.px.cuda_rigid_body_force.torch()[index, :3] = push[:, :3]
        body.px.cuda_rigid_body_torque.torch()[index, :3] = push[:, 3:]
        return
    for own, wrench in zip(body._bodies, push.numpy()):
        own.add_force_torque(wrench[:3], wrench[3:])


_Placed = tuple[arrays.Shapes, Any, Any]


def _shapes(body: Actor | Link) -> list[_Placed]:
    """The collision shapes of a body, the same in all sub-scenes: each with its position, mm, and
    its orientation, `(x, y, z, w)`, in the frame of the body.
    """
    of_scenes = [[_numbers(shape) for shape in own.collision_shapes] for own in body._bodies]
    if any(of_scene != of_scenes[0] for of_scene in of_scenes):
        raise ValueError(f"`{body.name}` has other shapes in other sub-scenes: they have to be alike")
    if not of_scenes[0]:
        raise ValueError(f"`{body.name}` has no collision shape, expected at least one")
    return [_placed(body, shape) for shape in body._bodies[0].collision_shapes]


def _numbers(shape: Any) -> list[Any]:
    """The kind, pose and sizes of a shape."""
    names = ("half_size", "radius", "half_length", "scale", "vertices")
    values = [shape.local_pose.p, shape.local_pose.q, *(getattr(shape, name, 0.0) for name in names)]
    return [type(shape).__name__, *(np.asarray(value).tolist() for value in values)]


def _placed(body: Actor | Link, shape: Any) -> _Placed:
    kind = type(shape).__name__.removeprefix("PhysxCollisionShape")
    pose = shape.local_pose * _Z_TO_X if kind in ("Cylinder", "Capsule", "Plane") else shape.local_pose
    position_mm, quaternion = 1e3 * pose.p, pose.q[[1, 2, 3, 0]]
    if isinstance(shape, physx.PhysxCollisionShapeConvexMesh | physx.PhysxCollisionShapeTriangleMesh):
        corners_mm = 1e3 * shape.vertices * shape.scale
        triangles = np.asarray(shape.triangles, np.int64).reshape(-1, 3)
        return from_samples(Shape.surface(corners_mm.astype(float), triangles)), position_mm, quaternion
    half_m = [getattr(shape, name) for name in ("radius", "half_length") if hasattr(shape, name)]
    found = primitive(kind, getattr(shape, "half_size", half_m))
    if found is None:
        raise ValueError(f"a shape of `{body.name}` is a {kind}, which sensors do not feel")
    return found, position_mm, quaternion
