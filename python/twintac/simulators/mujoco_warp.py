"""Touch in MuJoCo Warp, on the device of its data. It needs `mujoco-warp` and `torch`.

    sensors = Sensors(model, data, ["palm"])  # of a mujoco.MjModel, and data of MuJoCo Warp
    warp_model.callback.control = sensors
    mujoco_warp.step(warp_model, data)
    sensors.touch.pressure_kpa                # [n_worlds, n_sensors, n_taxels], a tensor

MuJoCo Warp calls the sensors in each step, when poses are known and forces are not. The sensors
launch kernels of Warp alone, so that steps can be captured in a graph.
"""

import os
from collections.abc import Sequence
from typing import Any

import mujoco
import torch
import warp as wp

from .. import FastGel
from ._moment import Poses, Touch
from ._mujoco import scene_of
from ._warp import WarpGels

__all__ = ["Sensors", "Touch"]


class Sensors:
    """Sensors at sites of a model, in all worlds of `data`. `twintac.mujoco.add_sensor` makes such
    sites.

    The sensors overwrite `xfrc_applied` of the bodies that the gels push. Write your own forces on
    these bodies into `applied`. A repeated call at the same time changes nothing. In a world whose
    time has gone back, the gels start anew. With steps of 2 ms or less, bodies of 20 g and more
    stay at rest on a gel.

    Args:
        model: the model.
        data: the data of MuJoCo Warp.
        sites: names of the sites.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.
        geoms: names of the geoms that can touch; all that collide unless given. Geoms of the
            sensor's own body never touch it. A geom that can touch needs no collisions in MuJoCo.

    Raises:
        ValueError: for a site or geom that the model does not have, and if no geom can touch.
        Error: for a geom of an unsupported shape.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: Any,
        sites: Sequence[str],
        *,
        gel: FastGel | str | os.PathLike[str] | bytes | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
        geoms: Sequence[str] | None = None,
    ) -> None:
        kept: dict[str, Any] = {"friction": friction, "retardation_s": retardation_s}
        self.scene = scene_of(model, sites, gel=gel, geoms=geoms, follows_thin=True, **kept)
        self._gels = WarpGels(self.scene, gel, data.nworld, data.time.device)
        self._body = wp.array(self.scene.body, dtype=int, device=data.time.device)
        self._applied = wp.zeros_like(data.xfrc_applied)
        self.applied: torch.Tensor = wp.to_torch(self._applied)
        """Your own forces on the bodies that the gels push, as in `xfrc_applied`: force, N, and
        torque, N m, `[n_worlds, n_bodies, 6]`.
        """
        self.touch: Touch = self._gels.touch()
        """The last output of the sensors: tensors that each step changes."""
        self.time_s: torch.Tensor = wp.to_torch(self._gels.time_s)
        """The simulator's time of the last output, s, `[n_worlds]`."""
        self._gels.begin(data.time)
        self._gels.tell_time(data.time)
        self._gels.launch(_poses(data))

    def __call__(self, model: Any, data: Any) -> None:
        """Reads the poses of `data`, and writes the forces of the gels on bodies into
        `xfrc_applied`.

        Args:
            model: the model of MuJoCo Warp, which is not used.
            data: the data of MuJoCo Warp.
        """
        self._gels.tell_time(data.time)
        self._gels.launch(_poses(data))
        push = self._gels.push
        wp.launch(
            _apply,
            push.shape,
            inputs=[self._body, self._applied, push],
            outputs=[data.xfrc_applied],
            device=push.device,
        )

    def forget(self, worlds: torch.Tensor | slice | None = None) -> None:
        """Resets the gels.

        Args:
            worlds: indices of the worlds, or a mask; all worlds unless given.
        """
        self._gels.forget(worlds)


@wp.kernel
def _apply(
    body: wp.array[int],
    applied: wp.array2d[wp.spatial_vector],
    push: wp.array2d[wp.spatial_vector],
    xfrc_applied: wp.array2d[wp.spatial_vector],
) -> None:
    w, b = wp.tid()
    xfrc_applied[w, body[b]] = applied[w, body[b]] + push[w, b]


def _poses(data: Any) -> Poses:
    return Poses(data.site_xpos, data.site_xmat, data.geom_xpos, data.geom_xmat, data.xipos)
