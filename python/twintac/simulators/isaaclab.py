"""Touch in Isaac Lab, with PyTorch on the device of its simulation. It was written against the
interface of Isaac Lab 2.3, and has not been run with Isaac Sim.

    from twintac.arrays import box, centered
    from twintac.simulators.isaaclab import Sensors

    class Palm(DirectRLEnv):
        def _setup_scene(self):
            ...
            self.touch = None

        def _apply_action(self):  # before each step of the simulation
            self.touch = self.touch or Sensors(
                [(self.hand, "palm")], touching=[(self.block, "Block", centered(box((12, 12, 20))))]
            )
            self.touch.push(self.physics_dt)  # adds the forces of the gels to the step

        def _get_observations(self):
            return {"policy": self.touch.output.pressure_kpa.flatten(1)}
"""

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
import torch

from .. import FastGel, arrays
from ._gels import Gels, local_pose, placed, rotation_of
from ._moment import Memory, Poses, Touch
from ._scene import Places
from ._scene import scene as scene_of

__all__ = ["Memory", "Sensors", "Touch"]


class Sensors(Gels):
    """Sensors on bodies of articulations and rigid objects, in all environments. Make them when the
    simulation has started.

    Bodies that touch gels should not collide with the sensor's body: it would carry them instead of
    the gel. With steps of 2 ms or less, bodies of 20 g and more stay at rest on a gel. Poses are in
    the world and in single precision: at 100 m from the world's origin they are known to 8 µm.

    Args:
        bodies: the bodies that carry the sensors: each an asset, `Articulation` or `RigidObject`,
            and the name of a body of it.
        touching: the bodies that can touch them: each an asset, the name of a body, and the shape in
            the body's frame, as `twintac.arrays` makes it. The sensor's own body never touches it.
        position_mm: position of the gel's frame in the frame of each body, mm.
        quaternion: orientation of the gel's frame, z out of the board, in the frame of each body,
            `(x, y, z, w)`.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.

    Raises:
        ValueError: if there is no body or nothing that can touch, and for names of other than one
            body.
    """

    output: Touch
    """The output of the last `push`, `[n_envs, ...]`."""

    def __init__(
        self,
        bodies: Sequence[tuple[Any, str]],
        *,
        touching: Sequence[tuple[Any, str, arrays.Shapes]],
        position_mm: tuple[float, float, float] = (0.0, 0.0, 0.0),
        quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
        gel: FastGel | str | os.PathLike[str] | bytes | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
    ) -> None:
        named = [*bodies, *((asset, name) for asset, name, _ in touching)]
        found = [(asset, _body_of(asset, name)) for asset, name in named]
        self._bodies = list({(id(asset), body): (asset, body) for asset, body in found}.values())
        number = {(id(asset), body): place for place, (asset, body) in enumerate(self._bodies)}
        self._of = [number[id(asset), body] for asset, body in found]
        places = Places(
            site=np.arange(len(bodies)),
            geom=np.arange(len(touching)),
            body_of_sensor=np.array(self._of[: len(bodies)], int),
            body_of_geom=np.array(self._of[len(bodies) :], int),
            moves=np.ones(len(self._bodies), bool),
            part_of=np.arange(len(self._bodies)),
        )
        like = torch.zeros(0, device=self._bodies[0][0].device if self._bodies else None)
        shapes = [shape for _, _, shape in touching]
        self._n_sensors = len(bodies)
        self._local = local_pose(position_mm, quaternion, like)
        self._begin(scene_of(places, shapes, gel, friction, retardation_s, like), self._poses())

    def push(self, dt: float) -> Touch:
        """Reads the sensors, and adds the forces of the gels on bodies to the next step. Call it
        once before each step of the simulation, and before `scene.write_data_to_sim`: in a
        `DirectRLEnv` from `_apply_action`, else from an action term.

        Args:
            dt: time since the last call, s, which is the time step of the simulation.

        Returns:
            The output of the sensors.
        """
        with torch.no_grad():
            self.output = self._step(self._poses(), dt)
            for place, number in enumerate(self.scene.body.tolist()):
                asset, body = self._bodies[number]
                push = self.output.push[:, place : place + 1]
                asset.instantaneous_wrench_composer.add_forces_and_torques(
                    forces=push[..., :3].contiguous(),
                    torques=push[..., 3:].contiguous(),
                    body_ids=[body],
                    is_global=True,
                )
        return self.output

    def _poses(self) -> Poses:
        def rows(field: str) -> torch.Tensor:
            return torch.stack([getattr(asset.data, field)[:, body] for asset, body in self._bodies], dim=1)

        pose = rows("body_link_pose_w")[:, self._of]
        n = self._n_sensors
        body_m, turn = pose[..., :3], rotation_of(pose[..., 3:])
        return Poses(
            *placed(body_m[:, :n], turn[:, :n], *self._local),
            body_m[:, n:],
            turn[:, n:],
            rows("body_com_pos_w"),
        )


def _body_of(asset: Any, name: str) -> int:
    """The index of the body of an asset with this name, or that matches this expression."""
    numbers, names = asset.find_bodies(name)
    if len(numbers) != 1:
        raise ValueError(f"`{name}` are the bodies {names}, expected one")
    return int(numbers[0])
