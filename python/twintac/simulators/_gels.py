"""Gels in simulators that have no time of their own, or poses of bodies alone, with PyTorch."""

from typing import Any

import torch

from .. import arrays
from ._moment import Memory, Poses, Touch, begin, forget, moment
from ._scene import Scene


class Gels:
    """The gels of all worlds, from one time step to the next."""

    scene: Scene
    memory: Memory
    """The state of the gels; it may be set to an earlier state."""

    def forget(self, worlds: torch.Tensor | slice | None = None) -> None:
        """Resets the gels.

        Args:
            worlds: indices of the worlds, or a mask; all worlds unless given.
        """
        chosen = torch.zeros_like(self.memory.time_s, dtype=torch.bool)
        chosen[slice(None) if worlds is None else worlds] = True
        self.memory = forget(self.memory, chosen)

    def _begin(self, scene: Scene, poses: Poses) -> None:
        """Starts with gels that nothing has touched."""
        self.scene = scene
        n_worlds, device = poses.site_m.shape[0], poses.site_m.device
        self.memory = begin(scene, poses, torch.zeros(n_worlds, device=device))

    def _step(self, poses: Poses, dt: float) -> Touch:
        """The output at poses, `dt` seconds after the last call."""
        # Each call begins at time 0, so that times are not rounded.
        start_s = torch.zeros_like(self.memory.time_s)
        memory = self.memory._replace(time_s=start_s)
        self.memory, touch = moment(self.scene, memory, poses, start_s + dt)
        return touch


def rotation_of(quaternion: torch.Tensor) -> torch.Tensor:
    """Rotation matrices of quaternions with w first, `[..., 4]`."""
    rotation: torch.Tensor = arrays.rotation_of(quaternion[..., [1, 2, 3, 0]])
    return rotation


def placed(
    body_m: torch.Tensor,
    body_rotation: torch.Tensor,
    local_m: torch.Tensor,
    local_rotation: torch.Tensor,
) -> tuple[torch.Tensor, torch.Tensor]:
    """Positions, m, and rotations in the world of what has a pose in the frame of a body. Products
    are summed without a matrix product, which some devices round.
    """
    position_m = body_m + (body_rotation * local_m[..., None, :]).sum(-1)
    rotation = (body_rotation[..., :, :, None] * local_rotation[..., None, :, :]).sum(-2)
    return position_m, rotation


def local_pose(
    position_mm: Any, quaternion: Any, like: torch.Tensor
) -> tuple[torch.Tensor, torch.Tensor]:
    """A pose in the frame of a body, mm and `(x, y, z, w)`, as a position, m, and a rotation."""
    position_m = 1e-3 * torch.as_tensor(position_mm, dtype=like.dtype, device=like.device)
    turn = torch.as_tensor(quaternion, dtype=like.dtype, device=like.device)
    return position_m, arrays.rotation_of(turn / turn.norm())
