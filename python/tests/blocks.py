"""A block on a palm in MuJoCo, for tests."""

from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from twintac import Sensor
from twintac.mujoco import TouchSensors, add_sensor

BLOCK = '<body name="thing" pos="0.001 0 0.019"><freejoint name="free"/><geom name="thing" type="box" size="0.006 0.006 0.01" mass="0.1"/></body>'
LEGS = """<body name="thing" pos="0 0 0.0136"><freejoint name="free"/>
    <geom name="left" type="box" size="0.004 0.004 0.005" pos="-0.008 0 0" mass="0.03"/>
    <geom name="right" type="box" size="0.004 0.004 0.005" pos="0.008 0 0" mass="0.03"/></body>"""


def palm(things: str = BLOCK, option: str = "", rest: str = "", palm_holds: str = "", sensor: Sensor | None = None) -> mujoco.MjModel:
    """A model with a palm at the origin and things above it."""
    spec = mujoco.MjSpec.from_string(f'<mujoco><option timestep="0.001">{option}</option><worldbody><body name="palm">{palm_holds}</body>{things}</worldbody>{rest}</mujoco>')
    add_sensor(spec, Sensor.phystac() if sensor is None else sensor, body="palm", name="touch")
    return spec.compile()


class Scene:
    """A model in motion, with its sensors."""

    def __init__(self, model: mujoco.MjModel, **arguments: Any) -> None:
        self.model, self.data = model, mujoco.MjData(model)
        self.touch = TouchSensors(model, ["touch"], **arguments)

    def step(self, n_steps: int = 1, pushing: bool = False) -> npt.NDArray[np.float64]:
        """Makes steps. Returns `qpos` after each step."""
        way = []
        for _ in range(n_steps):
            mujoco.mj_step1(self.model, self.data)
            if pushing:
                with self.touch.pushing(self.data):
                    mujoco.mj_step2(self.model, self.data)
            else:
                self.touch.update(self.data)
                mujoco.mj_step2(self.model, self.data)
            way.append(self.data.qpos.copy())
        return np.array(way)

    @property
    def height_mm(self) -> float:
        return 1e3 * float(self.data.body("thing").xpos[2])

    @property
    def force_n(self) -> float:
        return float(self.touch.wrench[0, 0, 2])
