"""Touch in MuJoCo XLA (MJX), with JAX. It needs `mujoco-mjx`.

    from twintac.simulators.mjx import put

    sensors = put(model, ["palm"])    # model: a mujoco.MjModel
    memory = sensors.begin(mx, data)  # mx = mjx.put_model(model), data = mjx.make_data(mx)
    data, memory, touch = sensors.step(mx, data, memory)

All functions are pure functions of one world. `jax.vmap` makes them functions of many worlds. They
can be compiled and differentiated as MJX itself.
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
    """Sensors on bodies of a model: the result of `put`. It is a tuple of arrays, so that it may be
    an argument of compiled functions.
    """

    scene: Scene

    def begin(self, model: mjx.Model, data: mjx.Data) -> Memory:
        """The initial state of the gels, at the time of `data`: at first, and after a reset.

        Args:
            model: the model on the device.
            data: the data of the world.

        Returns:
            The state, for `look` and `step`.
        """
        return begin(self.scene, _poses(mjx.kinematics(model, data)), data.time)

    def look(self, model: mjx.Model, data: mjx.Data, memory: Memory) -> tuple[Memory, Touch]:
        """The output of the sensors at the pose of `data`. A repeated call at the same time changes
        nothing. If time has gone back, the gels start anew.

        Args:
            model: the model on the device.
            data: the data of the world.
            memory: the state of the gels.

        Returns:
            The new state, and the output.
        """
        return moment(self.scene, memory, _poses(mjx.kinematics(model, data)), data.time)

    def step(
        self, model: mjx.Model, data: mjx.Data, memory: Memory
    ) -> tuple[mjx.Data, Memory, Touch]:
        """Makes one time step in which gels push. `xfrc_applied` keeps your values: the forces of
        the gels are added for this step alone. With steps of 2 ms or less, bodies of 20 g and more
        stay at rest on a gel.

        Args:
            model: the model on the device.
            data: the data of the world.
            memory: the state of the gels.

        Returns:
            The data after the step, the new state of the gels, and the output of the sensors at the
                beginning of the step.
        """
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
    """Puts sensors at sites of a model onto JAX's device. `twintac.mujoco.add_sensor` makes such
    sites.

    Args:
        model: the model.
        sites: names of the sites.
        gel: the surrogate of the gel, as `arrays.load` takes it; PhysTac's unless given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.
        geoms: names of the geoms that can touch; all that collide unless given. Geoms of the
            sensor's own body never touch it. A geom that can touch needs no collisions in MuJoCo.

    Returns:
        The sensors.

    Raises:
        ValueError: for a site or geom that the model does not have, and if no geom can touch.
        Error: for a geom of an unsupported shape.
    """
    kept = {"friction": friction, "retardation_s": retardation_s, "geoms": geoms}
    return Sensors(scene_of(model, sites, gel=gel, like=jnp.zeros(0, jnp.float32), **kept))  # type: ignore[arg-type]


def _poses(data: mjx.Data) -> Poses:
    def turns(rows: jax.Array) -> jax.Array:
        return rows.reshape(*rows.shape[:1], 3, 3)

    return Poses(
        data.site_xpos, turns(data.site_xmat), data.geom_xpos, turns(data.geom_xmat), data.xipos
    )
