"""Touch in MuJoCo XLA (MJX), with JAX: needs `mujoco-mjx`.

    sensors = mjx_touch.put(model, ["palm"])
    memory = sensors.begin(mx, data)
    data, memory, touch = sensors.step(mx, data, memory)

All are pure functions of one world; worlds are many by `jax.vmap`, and it may be compiled and
differentiated as MJX itself.
"""

import os
from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import mujoco
from mujoco import mjx

from .. import FastGel
from ._moment import Memory, Poses, Touch, begin, moment
from ._mujoco import scene_of
from ._scene import Scene

__all__ = ["Memory", "Scene", "Sensors", "Touch", "put"]


class Sensors(NamedTuple):
    """Sensors on bodies of a model: what `put` returns. It is a tuple of arrays, so that it may be
    an argument of compiled functions."""

    scene: Scene

    def begin(self, model: mjx.Model, data: mjx.Data) -> Memory:
        """Gels that remember nothing, at the time of `data`: at first, and after a reset."""
        return begin(self.scene, _poses(mjx.kinematics(model, data)), data.time)

    def look(self, model: mjx.Model, data: mjx.Data, memory: Memory) -> tuple[Memory, Touch]:
        """What sensors feel at the pose of `data`, and what gels then remember. A second look at
        the same time changes nothing; where time has gone back, gels have forgotten everything."""
        return moment(self.scene, memory, _poses(mjx.kinematics(model, data)), data.time)

    def step(
        self, model: mjx.Model, data: mjx.Data, memory: Memory
    ) -> tuple[mjx.Data, Memory, Touch]:
        """One time step in which gels push: the data after it, what gels remember, and what sensors
        felt at its beginning. `xfrc_applied` stays yours: what gels do is added for this step
        alone. Steps of 2 ms or less keep bodies of 20 g and more at rest on a gel."""
        memory, touch = self.look(model, data, memory)
        applied = data.xfrc_applied
        pushed = data.replace(xfrc_applied=applied.at[self.scene.body].add(touch.push))
        return mjx.step(model, pushed).replace(xfrc_applied=applied), memory, touch


def put(
    model: mujoco.MjModel,
    sites: Sequence[str],
    *,
    gel: FastGel | str | os.PathLike[str] | bytes | None = None,
    friction: float = 0.8,
    retardation_s: float = 0.005,
    geoms: Sequence[str] | None = None,
) -> Sensors:
    """Sensors at sites of a model, which `twintac.mujoco.add_sensor` makes, on JAX's device.

    - `gel`: what `arrays.load` takes; PhysTac's unless given.
    - `friction`: Coulomb's coefficient of every body on every gel.
    - `retardation_s`: the loss of the gel, s, see `twintac.Coupling`.
    - `geoms`: names of the geoms that can touch; all that collide unless given. Those of the
      sensor's own body never do. A geom that can touch needs no collisions in MuJoCo.

    Raises `ValueError` for a site or geom that the model does not have, and if no geom can touch;
    `Error` for a geom that sensors do not feel.
    """
    kept = {"friction": friction, "retardation_s": retardation_s, "geoms": geoms}
    return Sensors(scene_of(model, sites, gel=gel, like=jnp.zeros(0, jnp.float32), **kept))  # type: ignore[arg-type]


def _poses(data: mjx.Data) -> Poses:
    def turns(rows: jax.Array) -> jax.Array:
        return rows.reshape(*rows.shape[:1], 3, 3)

    return Poses(
        data.site_xpos, turns(data.site_xmat), data.geom_xpos, turns(data.geom_xmat), data.xipos
    )
