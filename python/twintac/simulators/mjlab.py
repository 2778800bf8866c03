"""Touch as a sensor of mjlab: needs `mjlab`.

    palm = TouchSensorCfg("touch", bodies=("hand/palm",), geoms=("block/block",))
    scene = Scene(SceneCfg(entities={...}, sensors=(palm,)), device)
    ...
    scene["touch"].data.pressure_kpa  # [n_envs, n_sensors, n_taxels], a tensor

An observation is a function of the environment, which mjlab delays and keeps a history of as its
configuration says: `lambda env: env.scene["touch"].data.pressure_kpa.flatten(1)`.
"""

from dataclasses import dataclass
from typing import Any

import mujoco
import torch
from mjlab.sensor import Sensor as MjlabSensor
from mjlab.sensor import SensorCfg

from .. import FastGel, Sensor
from ..mujoco import add_sensor
from ._moment import Touch
from .mujoco_warp import Sensors

__all__ = ["Touch", "TouchSensor", "TouchSensorCfg"]


@dataclass
class TouchSensorCfg(SensorCfg):  # type: ignore[misc, unused-ignore]
    """Sensors of one kind in a scene, to stand in `SceneCfg.sensors`. On a GPU, where mjlab captures
    steps, they have not been tried.
    """

    bodies: tuple[str, ...] = ()
    """Names of the bodies that they stand on, as the scene has them: `entity/body`."""
    geoms: tuple[str, ...] | None = None
    """Names of the geoms that can touch, `entity/geom`; all that collide unless given. They need no
    collisions in MuJoCo."""
    position_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Where the gel's frame is in that of each body, mm."""
    quaternion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    """How it is turned there, `(x, y, z, w)`."""
    sensor: Sensor | None = None
    """PhysTac unless given."""
    gel: FastGel | None = None
    """Its fast gel; PhysTac's unless given."""
    friction: float = 0.8
    """Coulomb's coefficient of every body on every gel."""
    retardation_s: float = 0.005
    """The loss of the gel, s, see `twintac.Coupling`."""

    def build(self) -> "TouchSensor":
        """The sensors, as mjlab makes them."""
        return TouchSensor(self)


class TouchSensor(MjlabSensor[Touch]):  # type: ignore[misc, unused-ignore]
    """What `TouchSensorCfg` makes. Its `data` are what was felt in the last substep or `forward`. In
    environments that are reset, gels forget everything.

    `xfrc_applied` of the bodies that gels push is theirs: forces of your own on them, such as
    `Entity.write_external_wrench_to_sim` would write, stand in `sensors.applied`.
    """

    def __init__(self, cfg: TouchSensorCfg) -> None:
        super().__init__()
        self.cfg = cfg
        self.sensors: Sensors

    def edit_spec(self, scene_spec: mujoco.MjSpec, entities: dict[str, Any]) -> None:
        """Puts the sensors onto their bodies."""
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
        """Lets MuJoCo Warp call the sensors in each step, after what it calls already."""
        cfg = self.cfg
        # Those of MuJoCo Warp, which mjlab wraps.
        model, data = (getattr(own, "struct", own) for own in (model, data))
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
        """Gels of these environments, or of all, forget everything."""
        super().reset(env_ids)
        self.sensors.forget(env_ids)

    def _compute_data(self) -> Touch:
        return self.sensors.touch

    def _sites(self) -> list[str]:
        return [f"{self.cfg.name}/{number}" for number in range(len(self.cfg.bodies))]
