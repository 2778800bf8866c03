"""Touch as a sensor of mjlab. It needs `mjlab`.

    palm = TouchSensorCfg("touch", bodies=("hand/palm",), geoms=("block/block",))
    scene = Scene(SceneCfg(entities={...}, sensors=(palm,)), device)
    ...
    scene["touch"].data.pressure_kpa  # [n_envs, n_sensors, n_taxels], a tensor

An observation is a function of the environment. Its delay and its history are set in mjlab's
configuration:

    lambda env: env.scene["touch"].data.pressure_kpa.flatten(1)
"""

from dataclasses import dataclass
from typing import Any

import mujoco
import torch
import warp as wp
from mjlab.sensor import Sensor as MjlabSensor
from mjlab.sensor import SensorCfg

from .. import FastGel, Sensor
from ..mujoco import add_sensor
from ._moment import Touch
from .mujoco_warp import Sensors

__all__ = ["Touch", "TouchSensor", "TouchSensorCfg"]


@dataclass
class TouchSensorCfg(SensorCfg):  # type: ignore[misc, unused-ignore]
    """Sensors of one kind in a scene, for `SceneCfg.sensors`. On a GPU, mjlab captures its steps
    before it initializes sensors: call `env.sim.create_graph()` when the environment is made.
    """

    bodies: tuple[str, ...] = ()
    """Names of the bodies that carry the sensors, as in the scene: `entity/body`."""
    geoms: tuple[str, ...] | None = None
    """Names of the geoms that can touch, `entity/geom`; all that collide unless given. They need no
    collisions in MuJoCo.
    """
    position_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Position of the gel's frame in the frame of each body, mm."""
    quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    """Orientation of the gel's frame in the frame of each body, `(x, y, z, w)`."""
    sensor: Sensor | None = None
    """The description of the sensors; PhysTac unless given."""
    gel: FastGel | None = None
    """The surrogate of the gel; PhysTac's unless given."""
    friction: float = 0.8
    """Coulomb's coefficient of every body on every gel."""
    retardation_s: float = 0.005
    """Time constant of the gel's damping, s, see `twintac.Coupling`."""

    def build(self) -> "TouchSensor":
        """Makes the sensors; mjlab calls it."""
        return TouchSensor(self)


class TouchSensor(MjlabSensor[Touch]):  # type: ignore[misc, unused-ignore]
    """The sensors that `TouchSensorCfg` makes. `data` has the output of the last substep or
    `forward`: tensors that each substep changes. The gels of environments that are reset start anew.

    The sensors overwrite `xfrc_applied` of the bodies that the gels push. Write your own forces on
    these bodies into `sensors.applied`, instead of with `Entity.write_external_wrench_to_sim`.
    """

    def __init__(self, cfg: TouchSensorCfg) -> None:
        super().__init__()
        self.cfg = cfg
        self.sensors: Sensors
        self._data: Any
        self._step_s: float
        self._start_s: tuple[torch.Tensor, torch.Tensor] | None = None
        self._is_called = False

    def edit_spec(self, scene_spec: mujoco.MjSpec, entities: dict[str, Any]) -> None:
        """Adds the sensors to their bodies."""
        sensor = self.cfg.sensor or Sensor.phystac()
        for body, site in zip(self.cfg.bodies, self._sites()):
            add_sensor(
                scene_spec,
                sensor,
                body=body,
                name=site,
                position_mm=self.cfg.position_mm,
                quaternion=self.cfg.quaternion,
            )

    def initialize(self, mj_model: mujoco.MjModel, model: Any, data: Any, device: str) -> None:
        """Registers the sensors with MuJoCo Warp, which calls them in each step, after the callback
        that was registered before.
        """
        cfg = self.cfg
        # The objects of MuJoCo Warp, which mjlab wraps.
        model, data = (getattr(own, "struct", own) for own in (model, data))
        self._data, self._step_s = data, float(mj_model.opt.timestep)
        self.sensors = Sensors(
            mj_model,
            data,
            self._sites(),
            gel=cfg.gel,
            friction=cfg.friction,
            retardation_s=cfg.retardation_s,
            geoms=cfg.geoms,
        )
        before = model.callback.control

        def control(model: Any, data: Any) -> None:
            if before is not None:
                before(model, data)
            self.sensors(model, data)

        model.callback.control = control

    def reset(self, env_ids: torch.Tensor | slice | None = None) -> None:
        """Resets the gels of these environments, or of all."""
        super().reset(env_ids)
        self.sensors.forget(env_ids)

    def _compute_data(self) -> Touch:
        if not self._is_called:
            self._check_calls()
        return self.sensors.touch

    def _check_calls(self) -> None:
        """Checks, until the first steps have been made, that MuJoCo Warp calls the sensors in each
        of them: a captured step calls only what was there when it was captured.
        """
        now_s = wp.to_torch(self._data.time), self.sensors.time_s
        if self._start_s is None:
            self._start_s = now_s[0].clone(), now_s[1].clone()
        passed_s, followed_s = (now - start for now, start in zip(now_s, self._start_s))
        self._is_called = bool((followed_s > 0.0).any())
        if not self._is_called and bool((passed_s > 1.5 * self._step_s).any()):
            raise RuntimeError(
                "the simulation makes steps without the touch sensors: if it captured them before "
                "the sensors were there, call `env.sim.create_graph()` once when the environment "
                "is made; actuation must not be disabled"
            )

    def _sites(self) -> list[str]:
        return [f"{self.cfg.name}/{number}" for number in range(len(self.cfg.bodies))]
