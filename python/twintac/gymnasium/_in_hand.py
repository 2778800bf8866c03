"""The task InHandTurn, in many worlds of MuJoCo. It has the interface of `twintac.Tasks`."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from operator import index
from typing import Any, SupportsIndex, TypeAlias

import numpy as np
import numpy.typing as npt

if importlib.util.find_spec("mujoco") is None or importlib.util.find_spec("mujoco.batch") is None:
    raise ImportError("InHandTurn needs MuJoCo 4 or later, with Python 3.11 or later: pip install 'mujoco>=4'")

import mujoco
import mujoco.batch

from twintac import Error, FastGel, Sensor, SensorVariation
from twintac.gymnasium._hand import CLOSE_RAD, N_FINGERS, PALM_RADIUS_M, SWING_RAD, TIMESTEP_S, TIPS, Thing, draw_thing, hand
from twintac.mujoco import TouchSensors

MEASURED = ("truth", "taxels", "forces")
"""What can be measured besides the joints: what only the simulation knows (the angle that is left,
how the object lies, its size), the reading of each taxel, one normal force for each fingertip.
"""

_Array: TypeAlias = npt.NDArray[np.float64]
_Bool: TypeAlias = npt.NDArray[np.bool_]
_Ints: TypeAlias = npt.NDArray[np.intp]
_Single: TypeAlias = npt.NDArray[np.float32]

N_STEPS, STEP_S = 60, 0.08
N_HISTORY = 4  # frames in an observation
_SUBSTEPS = round(STEP_S / TIMESTEP_S)
_MOST = 10_000  # environments
_FRICTION = 0.8
FASTEST = 0.1
"""The fraction of a servo's range by which its target moves in a step at an action of 1."""
WANTED_RAD = np.radians((15.0, 90.0))
_NEAR_RAD = np.radians(5.0)
_OFF_M, _TILT_COS = PALM_RADIUS_M, np.cos(np.radians(40.0))
_DROPPED, _NEAR_REWARD = -2.0, 0.05
# The encoders of cheap servos: zeros that are off, and steps.
_ENCODER_DEVIATION_RAD, _ENCODER_STEP_RAD = np.radians((0.5, 0.3))
_READING_KPA, _FORCE_N = 10.0, 3.0  # units of observations
_LOW, _HIGH = (np.array(ends) for ends in zip(*[SWING_RAD, CLOSE_RAD] * N_FINGERS))
_MIDDLE_RAD, _HALF_RAD = 0.5 * (_LOW + _HIGH), 0.5 * (_HIGH - _LOW)
N_JOINTS = 2 * N_FINGERS
_VELOCITIES = mujoco.mjtStage.mjSTAGE_VEL


class InHandTurn:
    """Many hands that turn an unknown object on their palm, each with its own sensors."""

    figures = ["error_rad", "turned_rad", "wanted_rad", "is_dropped", "is_box"]
    provenance = "simulated"
    n_actions = N_JOINTS

    def __init__(
        self,
        n_environments: int,
        *,
        gel: FastGel | None = None,
        variation: SensorVariation | None = None,
        touch: str = "taxels",
        autoreset: str = "NextStep",
        n_threads: int | None = None,
    ) -> None:
        self._measured = [] if touch == "none" else touch.split("+")
        if len(set(self._measured) & set(MEASURED)) < len(self._measured):
            raise Error(f"`touch` is `{touch}`, expected none, or some of {', '.join(MEASURED)} with + between")
        if gel is not None and gel.sensor != Sensor.phystac_tip().name:
            raise Error(f"`gel` is of `{gel.sensor}`, the fingertips need one of `{Sensor.phystac_tip().name}`")
        if not 1 <= n_environments <= _MOST:
            raise Error(f"`n_environments` is {n_environments}, expected 1 to {_MOST}")
        self._n, self._autoreset = n_environments, autoreset
        self._model = hand()
        self._batch = mujoco.batch.Batch(self._model, self._n, nthread=n_threads or 0, persistent=True)
        self._batch.forward(stage=_VELOCITIES)
        self._touch = TouchSensors(
            self._model,
            TIPS,
            sensor=Sensor.phystac_tip(),
            gel=gel,
            geoms=["object"],
            n_worlds=self._n,
            n_threads=n_threads,
            friction=_FRICTION,
            variation=SensorVariation.usual() if variation is None else variation,
        )
        self._object = int(self._model.geom("object").id), int(self._model.body("object").id)
        self._random = [np.random.default_rng(number) for number in range(self._n)]
        self._things: list[Thing | None] = [None] * self._n
        self._wanted_rad, self._turned_rad, self._yaw_rad = np.zeros((3, self._n))
        self._steps = np.zeros(self._n, np.int64)
        self._has_ended = np.ones(self._n, np.bool_)
        self._target_rad = np.zeros((self._n, N_JOINTS))
        self._encoder_zero_rad = np.zeros((self._n, N_JOINTS))
        # What the last steps measured, and the joints then, the newest first.
        self._history = np.zeros((self._n, N_HISTORY, self._frame().shape[1]))

    def __len__(self) -> int:
        return self._n

    @property
    def n_observed(self) -> int:
        return int(self._history[0].size) + 2

    def seed(self, seeds: Sequence[SupportsIndex | None] | npt.NDArray[np.integer[Any]]) -> None:
        """Sets the seeds of the environments, as `Tasks.seed`."""
        if len(seeds) != self._n:
            raise Error(f"`seeds` has {len(seeds)} seeds, expected one for each of {self._n} environments")
        whole = [None if seed is None else index(seed) for seed in seeds]
        wrong = [seed for seed in whole if seed is not None and not 0 <= seed < 2**64]
        if wrong:
            raise Error(f"`seeds` has {wrong[0]}, expected 0 to 2⁶⁴ - 1")
        for number, seed in enumerate(whole):
            if seed is not None:
                self._random[number] = np.random.default_rng(seed)

    def reset(self, which: npt.ArrayLike | None = None) -> tuple[_Single, _Single]:
        """Begins the next episode of environments, as `Tasks.reset`."""
        chosen = np.ones(self._n, np.bool_) if which is None else np.asarray(which, np.bool_)
        if chosen.shape != (self._n,):
            raise Error(f"`which` has the shape {list(chosen.shape)}, expected [{self._n}]")
        self._begin(np.flatnonzero(chosen))
        return np.where(chosen[:, None], self._observe(), 0.0).astype(np.float32), np.where(chosen[:, None], self._figures(), 0.0).astype(np.float32)

    def step(self, actions: npt.ArrayLike) -> tuple[_Single, _Array, _Bool, _Bool, _Single, tuple[_Single, _Single] | None]:
        """Computes one step of every environment, as `Tasks.step`."""
        actions = np.asarray(actions, float)
        if actions.shape != (self._n, N_JOINTS):
            raise Error(f"`actions` has the shape {list(actions.shape)}, expected [{self._n}, {N_JOINTS}]")
        if not np.isfinite(actions).all():
            raise Error("`actions` has a number that is not finite")
        waits = self._has_ended
        before_rad = self._error_rad()
        self._move(np.clip(actions, -1.0, 1.0), ~waits)
        after_rad = self._error_rad()
        is_dropped = self._is_dropped() & ~waits
        self._steps += ~waits
        rewards = before_rad - after_rad + _NEAR_REWARD * (after_rad < _NEAR_RAD)
        rewards = np.where(is_dropped, _DROPPED, rewards) * ~waits
        truncated = (self._steps >= N_STEPS) & ~is_dropped & ~waits
        ended = is_dropped | truncated
        last = None
        if self._autoreset == "SameStep" and ended.any():
            last = self._observe(), self._figures()
            self._begin(np.flatnonzero(ended))
        else:
            self._has_ended = ended if self._autoreset == "NextStep" else ended | waits
            if self._autoreset == "NextStep" and waits.any():
                self._begin(np.flatnonzero(waits))
        return self._observe(), rewards, is_dropped, truncated, self._figures(), last

    def picture(self, environment: int) -> npt.NDArray[np.uint8]:
        """A picture of one environment, `[240, 320, 3]`, 0 to 255. MuJoCo draws it, with OpenGL as the
        environment variable `MUJOCO_GL` names it.
        """
        camera = mujoco.MjvCamera()
        camera.lookat[:], camera.distance, camera.azimuth, camera.elevation = (0.0, 0.0, -0.015), 0.22, 60.0, -50.0
        with mujoco.Renderer(self._batch.get_model(environment), 240, 320) as renderer:
            renderer.update_scene(self._batch.get_data(environment), camera)
            return np.asarray(renderer.render())

    def _begin(self, numbers: _Ints) -> None:
        """Begins the next episode of some environments."""
        if not len(numbers):
            return
        batch, qpos = self._batch, self._batch.bind("qpos")
        batch.reset(numbers, stage=mujoco.mjtStage.mjSTAGE_NONE)
        for number in numbers:
            random = self._random[number]
            thing = draw_thing(random)
            yaw_rad = random.uniform(-np.pi, np.pi)
            wanted_rad = random.uniform(*WANTED_RAD) * random.choice([-1.0, 1.0])
            self._put(number, thing, yaw_rad + wanted_rad)
            aside_m = random.uniform(-0.002, 0.002, 2)
            qpos[number, -7:] = [*aside_m, thing.half_height_m, *_about_z(yaw_rad)]
            self._wanted_rad[number], self._turned_rad[number], self._yaw_rad[number] = wanted_rad, 0.0, yaw_rad
            self._encoder_zero_rad[number] = random.normal(0.0, _ENCODER_DEVIATION_RAD, N_JOINTS)
            self._touch.replace(int(number), int(random.integers(2**40)))
        batch.bind("ctrl")[numbers] = 0.0
        self._target_rad[numbers], self._steps[numbers], self._has_ended[numbers] = 0.0, 0, False
        batch.set_const(numbers)
        batch.forward(numbers, stage=_VELOCITIES)
        self._history[numbers] = self._frame()[numbers, None]

    def _put(self, number: int, thing: Thing, wanted_rad: float) -> None:
        """Replaces the object of a world, and moves the mark of the wanted angle."""
        geom, body = self._object
        kind = mujoco.mjtGeom.mjGEOM_BOX if thing.is_box else mujoco.mjtGeom.mjGEOM_CYLINDER
        values: dict[str, tuple[int, Any]] = {
            "geom_type": (geom, int(kind)),
            "geom_size": (geom, thing.half_m),
            "geom_rbound": (geom, np.linalg.norm(thing.half_m)),
            "geom_aabb": (geom, np.concatenate([np.zeros(3), thing.around_m])),
            "body_mass": (body, thing.mass_kg),
            "body_inertia": (body, thing.inertia_kg_m2),
            "geom_pos": (self._model.geom("pointer").id, [0.006, 0.0, thing.half_height_m]),
            "body_quat": (self._model.body("wanted").id, _about_z(wanted_rad)),
        }
        for name, (place, value) in values.items():
            self._batch.expand(name)[number, place] = value
        self._things[number] = thing

    def _move(self, actions: _Array, is_going: _Bool) -> None:
        """Moves the targets of the servos evenly, as the actions say, in a step of the task."""
        batch, ctrl = self._batch, self._batch.bind("ctrl")
        aim_rad = np.clip(self._target_rad + 2.0 * FASTEST * _HALF_RAD * actions, _LOW, _HIGH)
        way_rad = (aim_rad - self._target_rad) * is_going[:, None]
        for substep in range(1, _SUBSTEPS + 1):
            ctrl[:] = self._target_rad + substep / _SUBSTEPS * way_rad
            self._touch.update(batch)
            batch.step(stage=_VELOCITIES)
        self._target_rad += way_rad
        self._history = np.concatenate([self._frame()[:, None], self._history[:, :-1]], axis=1)
        w, _, _, z = self._batch.bind("qpos")[:, -4:].T
        yaw_rad = 2.0 * np.arctan2(z, w)
        self._turned_rad += (yaw_rad - self._yaw_rad + np.pi) % (2.0 * np.pi) - np.pi
        self._yaw_rad = yaw_rad

    def _error_rad(self) -> _Array:
        return np.asarray(np.abs(self._wanted_rad - self._turned_rad))

    def _is_dropped(self) -> _Bool:
        qpos = self._batch.bind("qpos")
        _, x, y, _ = qpos[:, -4:].T
        up = 1.0 - 2.0 * (x**2 + y**2)
        return np.asarray(~((np.linalg.norm(qpos[:, -7:-5], axis=1) < _OFF_M) & (up > _TILT_COS)))

    def _frame(self) -> _Array:
        """What the fingertips and the encoders measure now, and the targets of the servos."""
        measured = {
            "truth": self._truth,
            "taxels": lambda: self._touch.readings_kpa.reshape(self._n, -1) / _READING_KPA,
            "forces": lambda: -self._touch.wrench[:, :, 2] / _FORCE_N,
        }
        joints_rad = self._batch.bind("qpos")[:, :N_JOINTS] + self._encoder_zero_rad
        joints_rad = np.round(joints_rad / _ENCODER_STEP_RAD) * _ENCODER_STEP_RAD
        angles = [(rad - _MIDDLE_RAD) / _HALF_RAD for rad in (joints_rad, self._target_rad)]
        return np.concatenate([*(measured[name]() for name in self._measured), *angles], axis=1)

    def _truth(self) -> _Array:
        """The angle that is left; how a box lies, the same after a quarter of a turn; and the size."""
        left = (self._wanted_rad - self._turned_rad) / WANTED_RAD[1]
        lies = np.zeros((self._n, 2))
        half_m = np.zeros((self._n, 2))
        for number, thing in enumerate(self._things):
            if thing is not None:
                half_m[number] = thing.around_m[:2]
                if thing.is_box:
                    lies[number] = np.cos(4.0 * self._yaw_rad[number]), np.sin(4.0 * self._yaw_rad[number])
        return np.concatenate([left[:, None], lies, half_m / PALM_RADIUS_M], axis=1)

    def _observe(self) -> _Single:
        wanted, left = self._wanted_rad / WANTED_RAD[1], 1.0 - self._steps / N_STEPS
        observed = np.concatenate([self._history.reshape(self._n, -1), wanted[:, None], left[:, None]], axis=1)
        # An unstable world has numbers that are not finite; its episode ends.
        return np.nan_to_num(np.clip(observed, -10.0, 10.0)).astype(np.float32)

    def _figures(self) -> _Single:
        is_box = [thing is not None and thing.is_box for thing in self._things]
        return np.stack([self._error_rad(), self._turned_rad, self._wanted_rad, self._is_dropped(), np.array(is_box)], axis=1).astype(np.float32)


def _about_z(yaw_rad: float) -> list[float]:
    """The quaternion (w, x, y, z) of a rotation about the vertical axis."""
    return [float(np.cos(0.5 * yaw_rad)), 0.0, 0.0, float(np.sin(0.5 * yaw_rad))]
