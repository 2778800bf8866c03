"""Touch in MuJoCo Warp, with PyTorch on the device of its data: needs `mujoco-warp` and `torch`.

    sensors = Sensors(model, data, ["palm"])  # of a mujoco.MjModel, and data of MuJoCo Warp
    warp_model.callback.control = sensors
    mujoco_warp.step(warp_model, data)
    sensors.touch.pressure_kpa                # [n_worlds, n_sensors, n_taxels], a tensor

MuJoCo Warp calls it in each step, when poses are known and forces are not. Inside of a captured
CUDA graph it has not been tried.
"""

import os
from collections.abc import Sequence
from typing import Any

import mujoco
import torch
import warp as wp

from .. import FastGel
from ._moment import Memory, Poses, Touch, begin, forget, moment
from ._mujoco import scene_of

__all__ = ["Memory", "Sensors", "Touch"]


class Sensors:
    """Sensors at sites of a model, which `twintac.mujoco.add_sensor` makes, in all worlds of `data`.

    - `gel`: what `arrays.load` takes; PhysTac's unless given.
    - `friction`: Coulomb's coefficient of every body on every gel.
    - `retardation_s`: the loss of the gel, s, see `twintac.Coupling`.
    - `geoms`: names of the geoms that can touch; all that collide unless given. Those of the
      sensor's own body never do. A geom that can touch needs no collisions in MuJoCo.

    `xfrc_applied` of the bodies that gels push is theirs: forces of your own on them stand in
    `applied`. A second look at the same time changes nothing, and in a world whose time has gone
    back, gels have forgotten everything. Steps of 2 ms or less keep bodies of 20 g and more at rest
    on a gel.

    Raises `ValueError` for a site or geom that the model does not have, and if no geom can touch;
    `Error` for a geom that sensors do not feel.
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
        time_s = wp.to_torch(data.time)
        kept: dict[str, Any] = {"friction": friction, "retardation_s": retardation_s}
        self.scene = scene_of(model, sites, gel=gel, geoms=geoms, like=time_s, **kept)
        self.memory: Memory = begin(self.scene, _poses(data), time_s)
        """What gels remember; it may be set to what it was."""
        self.applied = torch.zeros_like(wp.to_torch(data.xfrc_applied))
        """Forces of your own on the bodies that gels push, as `xfrc_applied` has them: force, N,
        and torque, N m, `[n_worlds, n_bodies, 6]`."""
        _, self.touch = moment(self.scene, self.memory, _poses(data), time_s)
        """What sensors felt last."""

    def __call__(self, model: Any, data: Any) -> None:
        """Looks at the poses of `data`, and writes what gels do to bodies into `xfrc_applied`."""
        with torch.no_grad():
            time_s = wp.to_torch(data.time)
            self.memory, self.touch = moment(self.scene, self.memory, _poses(data), time_s)
            body = self.scene.body
            wp.to_torch(data.xfrc_applied)[:, body] = self.applied[:, body] + self.touch.push

    def forget(self, worlds: torch.Tensor | slice | None = None) -> None:
        """Gels of these worlds, numbers or a mask, or of all, remember nothing."""
        chosen = torch.zeros_like(self.memory.time_s, dtype=torch.bool)
        chosen[slice(None) if worlds is None else worlds] = True
        self.memory = forget(self.memory, chosen)


def _poses(data: Any) -> Poses:
    return Poses(
        *(
            wp.to_torch(rows)
            for rows in (
                data.site_xpos,
                data.site_xmat,
                data.geom_xpos,
                data.geom_xmat,
                data.xipos,
            )
        )
    )
