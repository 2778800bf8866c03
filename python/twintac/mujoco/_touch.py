"""Sensors that measure contact with the geoms of other bodies, and push these bodies."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
import numpy.typing as npt

from .. import Coupling, FastGel, Sensor, SensorBatch, SensorState, SensorVariation, Twin
from ._clock import Clock
from ._declared import declared
from ._geoms import Geoms, filtered, number_of
from ._poses import multiply, turned, turned_back
from ._push import Push
from ._shapes import PLANE_STRIDE_MM
from ._worlds import Data, Worlds

_Array = npt.NDArray[np.float64]
_Ints = npt.NDArray[np.intp]
# Bodies closer to a sensor than this are evaluated, mm.
_REACH_MM = 2.0
# The built-in sensors, with their surrogates, by name.
_BUILT_IN = {"phystac": (Sensor.phystac, FastGel.phystac), "phystac-tip": (Sensor.phystac_tip, FastGel.phystac_tip)}


class _Shown(NamedTuple):
    """What the sensors show since the last update, `[n_worlds, n_sensors, …]`."""

    readings_kpa: npt.NDArray[np.float32]
    ground_truth_kpa: npt.NDArray[np.float32]
    wrench: npt.NDArray[np.float32]
    slip_mm_per_s: npt.NDArray[np.float32]
    proximity: npt.NDArray[np.float32]

    def copy(self) -> "_Shown":
        return _Shown(*(own.copy() for own in self))


@dataclass(frozen=True)
class TouchState:
    """The state of `TouchSensors` at a time: the result of `TouchSensors.state`."""

    _sensors: tuple[SensorState, ...]
    _shown: _Shown
    _time_s: _Array
    _written: _Array


class _Touches(NamedTuple):
    """The contacts in all worlds: indices of world, sensor and geom, `[n_touches]`."""

    world: _Ints
    sensor: _Ints
    geom: _Ints


class TouchSensors:
    """Touch sensors in one or many worlds of one model.

    Call `update` once in each time step, when poses are known and forces are not:

        mujoco.mj_step1(model, data)
        touch.update(data)
        mujoco.mj_step2(model, data)

    With a persistent `mujoco.batch.Batch` of `n_worlds` simulations, call
    `batch.forward(stage=mujoco.mjtStage.mjSTAGE_VEL)` once, and `update` before each
    `batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)`. With steps of 2 ms or less, bodies of 20 g and
    more stay at rest on the gel.

    `update` writes the forces of the gels into `qfrc_applied` in each step. It changes no other
    field but the `sensordata` of declared sensors, so `xfrc_applied` is free for you, a viewer or a
    reset. With `pushing`, `qfrc_applied` is free as well, and MuJoCo's own force sensors measure
    the gels.

    A gel keeps the state of friction and damping for each pair of geom and sensor in each world. If
    a geom has a new size, mesh or height field, the next update reads its shape again.

    Args:
        model: the model.
        sites: names of the sites that are the frames of the gels, with z out of the board;
            `add_sensor` makes such sites. Without it, the sensors are those that the MJCF declares
            as user sensors at sites, with the name of the sensor's description before a slash, such
            as `phystac/palm`; `update` then also writes the readings of one world to `sensordata`.
        sensor: the description of all sensors; that of `gel` if that is built in, and PhysTac if
            neither is given.
        gel: the surrogate of the gel of all sensors; that of `sensor` if that is built in.
        twin: with a twin, readings are those of its barometers, with gains and viscoelastic
            relaxation; without, readings are the pressures at the ports.
        variation: the sensor variation, from which each sensor is drawn; perfect sensors unless
            given.
        friction: Coulomb's coefficient of every body on every gel.
        retardation_s: time constant of the gel's damping, s, see `twintac.Coupling`.
        geoms: names of the geoms that can touch; all colliding geoms unless given, but those of the
            parent and the children of the sensor's body, which MuJoCo does not collide either.
            Geoms of the sensor's own body, and of bodies that `<exclude>` names with it, never
            touch it.
        n_worlds: number of worlds of the model, such as those of a `mujoco.batch.Batch`.
        n_threads: number of threads; as many as there are cores unless given. Results do not depend
            on it.
        seed: seed of the sensor variation.

    Raises:
        ValueError: for a site or geom that the model does not have, if no geom can touch, for a
            sensor, gel and twin that do not belong together, and for a model that declares no
            sensor, or one of another dimension.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        sites: Sequence[str] | None = None,
        *,
        sensor: Sensor | None = None,
        gel: FastGel | None = None,
        twin: Twin | None = None,
        variation: SensorVariation | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
        geoms: Sequence[str] | None = None,
        n_worlds: int = 1,
        n_threads: int | None = None,
        seed: int = 0,
    ) -> None:
        sensor, gel = _belonging(sensor, gel)
        if n_worlds < 1:
            raise ValueError(f"`n_worlds` is {n_worlds}, expected 1 or more")
        n_taxels = len(gel.ports_mm)
        self._address: _Ints | None = None
        if sites is None:
            self._site, self._names, self._address = declared(model, sensor.name, n_taxels)
        else:
            self._site = np.array([number_of(model, "site", name) for name in sites], int)
            self._names = list(sites)
        if not len(self._site):
            raise ValueError("`sites` has none, expected at least one")
        twice = [name for place, name in enumerate(self._names) if self._site[place] in self._site[:place]]
        if twice:
            raise ValueError(f"the site of `{twice[0]}` is named twice, expected once")
        self._body: _Ints = model.site_bodyid[self._site].astype(int)
        self._worlds = Worlds(model, n_worlds)
        self._geoms = Geoms(model, self._worlds, geoms)
        self._batch = SensorBatch(
            gel,
            self._geoms.bodies,
            n_worlds * len(self._site),
            variation=variation,
            twin=twin,
            coupling=Coupling(sensor, friction=friction, retardation_s=retardation_s),
            seed=seed,
            n_threads=n_threads,
        )
        self._clock = Clock(n_worlds)
        self._push = Push(model, self._worlds, np.concatenate([self._body, self._geoms.body]))
        self._unfelt_by = self._push.unfelt_by()
        low_mm, high_mm = sensor.bounds_mm
        self._middle_mm = 0.5 * (low_mm + high_mm)
        self._radius_mm = 0.5 * float(np.linalg.norm(high_mm - low_mm))
        # The reference point of the wrench.
        self._center_mm = np.array([*self._middle_mm[:2], high_mm[2]])
        self._can_touch = ~filtered(model, self._body, self._geoms.body, by_family=geoms is None)
        self._shown = _Shown(*(np.zeros((n_worlds, len(self._site), n), np.float32) for n in (n_taxels, n_taxels, 6, 2, 1)))

    def __repr__(self) -> str:
        worlds = "one world" if self._worlds.n_worlds == 1 else f"{self._worlds.n_worlds} worlds"
        return f"<TouchSensors at {', '.join(self._names)} in {worlds}, {len(self._geoms.number)} geoms can touch, simulated>"

    @property
    def provenance(self) -> str:
        """Provenance of every reading: `"simulated"`."""
        return self._batch.provenance

    @property
    def readings_kpa(self) -> npt.NDArray[np.float32]:
        """The last readings, kPa, `[n_worlds, n_sensors, n_taxels]`; 0 after a reset. A sensor has
        NaN if its pose, or that of a geom that can touch it, is not finite.
        """
        return self._shown.readings_kpa

    @property
    def wrench(self) -> npt.NDArray[np.float32]:
        """Force on each gel, N, and torque about the centre of the top of its bounding box, N mm,
        in the frame of the sensor as it is installed: that of the site, moved by what `variation`
        has drawn; `[n_worlds, n_sensors, 6]`, NaN where the readings are NaN.
        """
        return self._shown.wrench

    def read_ground_truth(self) -> npt.NDArray[np.float32]:
        """The last readings without sensor variation, kPa, `[n_worlds, n_sensors, n_taxels]`: those
        of a perfect sensor, beside the imperfect ones. They are 0 and NaN where `readings_kpa` are
        after a reset or for poses that are not finite.
        """
        return self._shown.ground_truth_kpa

    @property
    def slip_mm_per_s(self) -> npt.NDArray[np.float32]:
        """The slip velocity of what touches each sensor, mm/s, along x and y of the gel, `[n_worlds,
        n_sensors, 2]`: of several geoms the fastest one, and 0 if all stick.
        """
        return self._shown.slip_mm_per_s

    @property
    def proximity(self) -> npt.NDArray[np.float32]:
        """How near the geoms were to each sensor at the last update, `[n_worlds, n_sensors]`: 1 where
        one touches, falling linearly to 0 where the nearest is 2 mm away or farther
        (`SensorBatch.proximity`).
        """
        return self._shown.proximity[..., 0]

    def update(self, data: Data) -> npt.NDArray[np.float32]:
        """Makes one time step: reads the poses of the geoms, and writes the forces of the gels on
        bodies into `qfrc_applied`, in place of those of the last update.

        A world whose time has gone back starts anew, as after `reset`. A second call at the same
        time replaces the forces, and adds nothing.

        Args:
            data: the data of the world, or the batch of the worlds.

        Returns:
            `readings_kpa`.

        Raises:
            ValueError: for data of another model or number of worlds; if more or less than one time
                step has passed; if others have written to the part of `qfrc_applied` that the gels use;
                and for a model with force or torque sensors of MuJoCo that would have to measure
                the gels, which they do within `pushing` only. Nothing is changed then.
        """
        if self._unfelt_by is not None:
            raise ValueError(f"MuJoCo's force sensor `{self._unfelt_by}` does not feel what gels push with `update`: step within `with touch.pushing(data):`")
        touches = self._sense(data, is_updated=True)
        self._push.write(data, self._push.generalized(data, self._wrenches(data, touches, self._push.roots_m(data))))
        self._tell(data)
        return self._shown.readings_kpa

    @contextmanager
    def pushing(self, data: Data) -> Iterator[npt.NDArray[np.float32]]:
        """Does the same as `update`, for a step that is made inside of the `with` block:

            mujoco.mj_step1(model, data)
            with touch.pushing(data) as readings_kpa:
                mujoco.mj_step2(model, data)

        With a batch, call `batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)` inside of the block. The
        forces of the gels are added to `xfrc_applied`, and subtracted at the end of the block. So
        MuJoCo's own force sensors measure them, and `qfrc_applied` is free for your use. Sensors of
        several kinds push together: `with palm.pushing(data), tips.pushing(data):`.

        Args:
            data: the data of the world, or the batch of the worlds.

        Yields:
            `readings_kpa`.

        Raises:
            ValueError: as `update` does, and if `xfrc_applied` of pushed bodies is written inside
                of the block; write it before the block.
        """
        touches = self._sense(data, is_updated=bool(self._push.written.any()))
        if self._push.written.any():
            self._push.write(data, np.zeros_like(self._push.written))
        before_s, applied = self._worlds.times_s(data), self._worlds.rows(data, "xfrc_applied")
        others = applied.copy()
        applied[:, self._push.bodies] += self._wrenches(data, touches, self._push.middles_m(data))
        written = applied.copy()
        self._tell(data)
        stays = np.zeros(applied.shape, bool)
        try:
            yield self._shown.readings_kpa
        finally:
            applied = self._worlds.rows(data, "xfrc_applied")
            stays = applied == written
            applied[stays] = others[stays]
        # MuJoCo clears the field when it resets an unstable world.
        changed = ~stays.all((1, 2)) & (self._worlds.times_s(data) > before_s)
        if changed.any():
            world = int(np.nonzero(changed)[0][0])
            raise ValueError(f"`xfrc_applied` of world {world} was written inside of `pushing`, where what gels push stands in it: write it before")

    def reset(self, world: int | None = None) -> None:
        """Resets the gels, readings and wrenches to zero. Call it when the data are set to another
        state.

        Args:
            world: index of the world, from 0; all worlds unless given.
        """
        for number in self._numbers(world):
            self._rest(number)
            self._clock.last_s[number] = np.nan

    def replace(self, world: int, number: int) -> None:
        """Replaces the sensors of one world by others at rest, whose deviations are drawn anew from
        the sensor variation, as for a new episode.

        Args:
            world: index of the world, from 0.
            number: identifies the new sensors. Those of `n_worlds` worlds that were just made have
                the numbers 0 to `n_worlds - 1`.

        Raises:
            ValueError: for a world that does not exist.
        """
        self.reset(world)
        for place, sensor in enumerate(self._sensors_of(self._numbers(world)[0])):
            self._batch.replace(sensor, number * len(self._site) + place)

    def state(self, world: int | None = None) -> TouchState:
        """The current state of the sensors, to be stored with the state of the data. If both are
        restored, the same steps give the same bits.

        Args:
            world: index of the world, from 0; all worlds unless given.

        Returns:
            The state, for `set_state`.
        """
        numbers = self._numbers(world)
        return TouchState(
            _sensors=tuple(self._batch.state(sensor) for number in numbers for sensor in self._sensors_of(number)),
            _shown=_Shown(*(own[numbers] for own in self._shown)),
            _time_s=self._clock.last_s[numbers].copy(),
            _written=self._push.written[numbers].copy(),
        )

    def set_state(self, state: TouchState, world: int | None = None) -> None:
        """Restores a state. The state of one world may be set in another world.

        Args:
            state: the result of `state`.
            world: index of the world, from 0; all worlds unless given.

        Raises:
            ValueError: for the state of another number of worlds, or of other sensors.
        """
        numbers = self._numbers(world)
        given, own = state._shown.readings_kpa.shape, self._shown.readings_kpa[numbers].shape
        if given != own or state._written.shape != self._push.written[numbers].shape:
            raise ValueError(f"`state` is of {given} readings (worlds, sensors, taxels), expected {own}, of the same model")
        sensors = iter(state._sensors)
        self._shown = self._shown.copy()
        for place, number in enumerate(numbers):
            for sensor in self._sensors_of(number):
                self._batch.set_state(sensor, next(sensors))
            for shown, kept in zip(self._shown, state._shown, strict=True):
                shown[number] = kept[place]
            self._clock.last_s[number] = state._time_s[place]
            self._push.restore(number, state._written[place])

    def _sense(self, data: Data, is_updated: bool) -> _Touches:
        """Reads all sensors; `is_updated` says whether the data hold the forces of the last update.
        If it raises, nothing has changed.
        """
        worlds = self._worlds
        worlds.look(data)
        timestep_s = np.broadcast_to(worlds.field(data, "opt.timestep").reshape(-1), worlds.n_worlds)
        now_s = worlds.times_s(data)
        since_s, begun, goes_on = self._clock.passed(now_s, timestep_s)
        if is_updated:
            self._push.check(data, goes_on)
        if self._geoms.read(data):
            self._batch.set_bodies(self._geoms.bodies)
        touches, poses, touch_id, unknown = self._near(data)
        for world in np.nonzero(begun)[0]:
            self._rest(int(world))
        number = touches.world * len(self._site) + touches.sensor
        ends = np.searchsorted(number, np.arange(worlds.n_worlds * len(self._site)), side="right")
        body = self._geoms.shape[touches.world, touches.geom]
        readings_kpa, wrench = self._batch.step(since_s, poses, body, ends, touch_id=touch_id)
        slip_mm_per_s = np.zeros_like(self._shown.slip_mm_per_s)
        slips = self._batch.slip_of_touches()
        # Of several that are assigned to one sensor, the last one stays: the fastest.
        order = np.argsort(np.linalg.norm(slips, axis=-1), kind="stable")
        slip_mm_per_s[touches.world[order], touches.sensor[order]] = slips[order]
        found = (readings_kpa, self._batch.read_ground_truth(), wrench, slip_mm_per_s, self._batch.proximity())
        self._shown = _Shown(*(new.reshape(old.shape) for new, old in zip(found, self._shown, strict=True)))
        for world, sensor in zip(*np.nonzero(unknown)):
            self._batch.rest(int(world) * len(self._site) + int(sensor))
            for shown in self._shown:
                shown[world, sensor] = np.nan
        self._clock.last_s = now_s
        return touches

    def _near(self, data: Data) -> tuple[_Touches, _Array, npt.NDArray[np.int64], npt.NDArray[np.bool_]]:
        """The contacts that are near enough to be evaluated; their poses, as `gel_from_body`; the
        identities of the touches; and the sensors with unknown readings, `[n_worlds, n_sensors]`.
        """
        site_mm, site_turn, site_quat, site_is_there = self._places(data, "site", self._site)
        geom_mm, geom_turn, geom_quat, geom_is_there = self._places(data, "geom", self._geoms.number)
        unknown = ~site_is_there | (self._can_touch & ~geom_is_there[:, None]).any(-1)
        with np.errstate(invalid="ignore", over="ignore"):
            to_geom_mm = geom_mm[:, None] - (site_mm + site_turn @ self._middle_mm)[:, :, None]
            above_mm = -(to_geom_mm * geom_turn[:, None, :, :, 2]).sum(-1)
            distance_mm = np.where(self._geoms.is_plane[:, None], above_mm, np.linalg.norm(to_geom_mm, axis=-1))
            near_mm = (self._geoms.radius_mm + self._radius_mm + _REACH_MM)[:, None]
        world, sensor, geom = np.nonzero(self._can_touch & (distance_mm < near_mm) & ~unknown[:, :, None])
        # A plane may be shifted along itself, so its slab follows the sensor, in strides.
        strides, planes = np.zeros((len(world), 2)), self._geoms.is_plane[world, geom]
        if planes.any():
            along_mm = turned(geom_turn[world, geom].swapaxes(1, 2), -to_geom_mm[world, sensor, geom])
            strides[planes] = np.round(along_mm[planes, :2] / PLANE_STRIDE_MM)
        origin_mm = np.concatenate([strides * PLANE_STRIDE_MM, self._geoms.origin_mm[world, geom, None]], axis=1)
        place_mm = geom_mm[world, geom] + turned(geom_turn[world, geom], origin_mm)
        poses = np.empty((len(world), 7))
        poses[:, :3] = turned(site_turn[world, sensor].swapaxes(1, 2), place_mm - site_mm[world, sensor])
        poses[:, 3:] = multiply(turned_back(site_quat[world, sensor]), geom_quat[world, geom])[:, [1, 2, 3, 0]]
        # A touch is identified by the geom and, for a plane, by the stride.
        along = (strides.astype(np.int64) & 0xFFFFF) @ np.array([1 << 20, 1])
        touch_id = along * self._can_touch.shape[1] + geom
        return _Touches(world, sensor, geom), poses, touch_id, unknown

    def _places(self, data: Data, kind: str, numbers: _Ints) -> tuple[_Array, _Array, _Array, npt.NDArray[np.bool_]]:
        """Positions, mm, rotations as matrices and as quaternions, of sites or geoms in all worlds,
        and which of them are finite.
        """
        place_m, turn = (self._worlds.rows(data, f"{kind}_{name}")[:, numbers] for name in ("xpos", "xmat"))
        quat = self._worlds.quaternions(data, kind)[:, numbers]
        if not quat.any(-1).all():
            raise ValueError("`data` has no poses yet: call `mujoco.mj_step1` or `mujoco.mj_forward` before, or `batch.forward(stage=mujoco.mjtStage.mjSTAGE_VEL)`")
        is_there = np.asarray(np.isfinite(place_m).all(-1) & np.isfinite(quat).all(-1))
        return 1e3 * place_m, turn.reshape(*turn.shape[:2], 3, 3), quat, is_there

    def _wrenches(self, data: Data, touches: _Touches, about_m: _Array) -> _Array:
        """The forces between gels and bodies, as wrenches on bodies about the points `about_m`."""
        world, sensor, geom = touches
        site_mm, site_turn, _, _ = self._places(data, "site", self._site)
        on_gel, turn = self._batch.wrench_of_touches().astype(float), site_turn[world, sensor]
        force_n, torque_n_m = turned(turn, on_gel[:, :3]), 1e-3 * turned(turn, on_gel[:, 3:])
        at_m = 1e-3 * (site_mm[world, sensor] + turn @ self._center_mm)
        return self._push.on_bodies(about_m, (force_n, torque_n_m, at_m), (world, self._body[sensor], self._geoms.body[geom]))

    def _tell(self, data: Data) -> None:
        """Writes the readings to `sensordata`, for sensors that the model declares. Those of a batch
        cannot be written.
        """
        if self._address is not None and isinstance(data, mujoco.MjData):
            data.sensordata[self._address] = self._shown.readings_kpa[0]

    def _rest(self, world: int) -> None:
        for sensor in self._sensors_of(world):
            self._batch.rest(sensor)
        self._shown = self._shown.copy()
        for shown in self._shown:
            shown[world] = 0.0

    def _sensors_of(self, world: int) -> range:
        return range(world * len(self._site), (world + 1) * len(self._site))

    def _numbers(self, world: int | None) -> list[int]:
        if world is None:
            return list(range(self._worlds.n_worlds))
        if not 0 <= world < self._worlds.n_worlds:
            raise ValueError(f"`world` is {world}, there are {self._worlds.n_worlds}")
        return [int(world)]


def _belonging(sensor: Sensor | None, gel: FastGel | None) -> tuple[Sensor, FastGel]:
    """Sensor and gel. For a built-in sensor, one of them determines the other."""
    name = "phystac" if sensor is None and gel is None else sensor.name if sensor is not None else gel.sensor if gel is not None else ""
    if (sensor is None or gel is None) and name not in _BUILT_IN:
        known, missing = ("sensor", "gel") if gel is None else ("gel", "sensor")
        raise ValueError(f"`{known}` is of `{name}`, which is not built in: give its `{missing}` too")
    return _BUILT_IN[name][0]() if sensor is None else sensor, _BUILT_IN[name][1]() if gel is None else gel
