"""Sensors that feel what touches their bodies, and push back."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import mujoco
import mujoco.batch
import numpy as np
import numpy.typing as npt

from .. import Body, Coupling, FastGel, Imperfection, Sensor, SensorBatch, Twin
from ._poses import cross, multiply, rotate, turned_back
from ._shapes import body_of, key_of

_Array = npt.NDArray[np.float64]
_Data: TypeAlias = mujoco.MjData | mujoco.batch.Batch
_PLANE = int(mujoco.mjtGeom.mjGEOM_PLANE)
# Bodies push when they are this close, mm.
_REACH_MM = 2.0


@dataclass(frozen=True)
class _Geom:
    number: int
    body: int
    shape: int
    origin_mm: float
    radius_mm: float
    is_plane: bool


class TouchSensors:
    """Touch sensors in one or many worlds of one model.

    - `sites`: names of the sites that are the frames of their gels, z out of the board: `add_sensor` makes them.
    - `sensor`, `gel`: of all of them; PhysTac and its fast gel unless given.
    - `twin`: its barometers read, with gains and memory; pressures at the ports unless given.
    - `imperfection`: makes each sensor imperfect in its own way; perfect ones unless given.
    - `friction`: Coulomb's coefficient of every body on every gel.
    - `retardation_s`: the loss of the gel, s, see `twintac.Coupling`.
    - `geoms`: names of the geoms that can touch; all that collide unless given. Those of the sensor's own body never do.
    - `n_worlds`: worlds of the model, as those of a `mujoco.batch.Batch`.
    - `n_threads`: as many as there are cores unless given; results do not depend on it.
    - `seed`: of the imperfections.

    Call `update` when poses are known and forces are not:

        mujoco.mj_step1(model, data)
        touch.update(data)
        mujoco.mj_step2(model, data)

    or, for a persistent `mujoco.batch.Batch` of `n_worlds` simulations, after `batch.step(stage=mujoco.mjtStage.mjSTAGE_VEL)`.
    Steps of 2 ms or less keep bodies of 20 g and more at rest on the gel.

    Raises `ValueError` for a site or geom that the model does not have, and if no geom can touch.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        sites: Sequence[str],
        *,
        sensor: Sensor | None = None,
        gel: FastGel | None = None,
        twin: Twin | None = None,
        imperfection: Imperfection | None = None,
        friction: float = 0.8,
        retardation_s: float = 0.005,
        geoms: Sequence[str] | None = None,
        n_worlds: int = 1,
        n_threads: int | None = None,
        seed: int = 0,
    ) -> None:
        sensor = Sensor.phystac() if sensor is None else sensor
        gel = FastGel.phystac() if gel is None else gel
        self._site = np.array([_number(model, "site", name) for name in sites], int)
        self._body = model.site_bodyid[self._site].astype(int)
        self._n_worlds, self._timestep_s = n_worlds, float(model.opt.timestep)
        low_mm, high_mm = sensor.bounds_mm
        self._middle_mm = 0.5 * (low_mm + high_mm)
        self._radius_mm = 0.5 * float(np.linalg.norm(high_mm - low_mm))
        # About which the wrench counts.
        self._center_mm = np.array([*self._middle_mm[:2], high_mm[2]])
        self._geoms, bodies = _touchable(model, geoms)
        self._geom = np.array([geom.number for geom in self._geoms], int)
        self._geom_body = np.array([geom.body for geom in self._geoms], int)
        self._shape = np.array([geom.shape for geom in self._geoms], int)
        self._origin_mm = np.array([[0.0, 0.0, geom.origin_mm] for geom in self._geoms])
        self._near_mm = np.array([geom.radius_mm for geom in self._geoms]) + self._radius_mm + _REACH_MM
        self._is_plane = np.array([geom.is_plane for geom in self._geoms], bool)
        # The parts of a body do not feel each other.
        weld = model.body_weldid
        self._can_touch = weld[self._body][:, None] != weld[self._geom_body][None, :]
        self._batch = SensorBatch(
            gel,
            bodies,
            n_worlds * len(self._site),
            imperfection=imperfection,
            twin=twin,
            coupling=Coupling(sensor, friction=friction, retardation_s=retardation_s),
            seed=seed,
            n_threads=n_threads,
        )
        n_taxels = len(sensor.taxels)
        self._readings_kpa = np.zeros((n_worlds, len(self._site), n_taxels), np.float32)
        self._wrench = np.zeros((n_worlds, len(self._site), 6), np.float32)
        self._applied = np.zeros((n_worlds, model.nbody, 6))

    @property
    def provenance(self) -> str:
        """What every reading is: simulated."""
        return self._batch.provenance

    @property
    def readings_kpa(self) -> npt.NDArray[np.float32]:
        """What the sensors read last, kPa, `[n_worlds, n_sensors, n_taxels]`."""
        return self._readings_kpa

    @property
    def wrench(self) -> npt.NDArray[np.float32]:
        """Force on each gel, N, and torque about the top of its middle, N mm, in the frame of the gel, `[n_worlds, n_sensors, 6]`."""
        return self._wrench

    def update(self, data: _Data) -> npt.NDArray[np.float32]:
        """One more time step: reads where geoms are, and applies to bodies what the gels do to them (`xfrc_applied`). Returns `readings_kpa`.

        Raises `ValueError` for data of another number of worlds.
        """
        at = [_rows(data, name, self._n_worlds) for name in ("site_xpos", "site_xquat", "geom_xpos", "geom_xquat")]
        site_mm, site_quat = 1e3 * at[0][:, self._site], at[1][:, self._site]
        geom_mm, geom_quat = 1e3 * at[2][:, self._geom], at[3][:, self._geom]
        middle_mm = site_mm + rotate(site_quat, self._middle_mm)
        to_geom_mm = geom_mm[:, None] - middle_mm[:, :, None]
        normal = rotate(geom_quat, np.array([0.0, 0.0, 1.0]))[:, None]
        above_mm = -(to_geom_mm * normal).sum(-1)
        distance_mm = np.where(self._is_plane, above_mm, np.linalg.norm(to_geom_mm, axis=-1))
        world, sensor, geom = np.nonzero(self._can_touch & (distance_mm < self._near_mm))
        # A plane is the same wherever its frame is moved along it.
        along_mm = to_geom_mm[world, sensor, geom] + above_mm[world, sensor, geom, None] * normal[world, 0, geom]
        place_mm = geom_mm[world, geom] - np.where(self._is_plane[geom, None], along_mm, 0.0)
        place_mm = place_mm + rotate(geom_quat[world, geom], self._origin_mm[geom])
        back = turned_back(site_quat[world, sensor])
        poses = np.empty((len(world), 7))
        poses[:, :3] = rotate(back, place_mm - site_mm[world, sensor])
        turn = multiply(back, geom_quat[world, geom])
        poses[:, 3:] = turn[:, [1, 2, 3, 0]]
        number = world * len(self._site) + sensor
        ends = np.searchsorted(number, np.arange(self._n_worlds * len(self._site)), side="right")
        readings_kpa, wrench = self._batch.step(self._timestep_s, poses, self._shape[geom], ends)
        self._readings_kpa = readings_kpa.reshape(self._readings_kpa.shape)
        self._wrench = wrench.reshape(self._wrench.shape)
        self._push(data, world, sensor, geom, site_mm, site_quat)
        return self._readings_kpa

    def reset(self, world: int | None = None) -> None:
        """Lets the gels of a world, counted from 0, rest, or of all: to be called when its data are reset."""
        worlds = range(self._n_worlds) if world is None else [world]
        for world in worlds:
            self._applied[world] = 0.0
            for sensor in range(len(self._site)):
                self._batch.rest(world * len(self._site) + sensor)

    def _push(
        self,
        data: _Data,
        world: npt.NDArray[np.intp],
        sensor: npt.NDArray[np.intp],
        geom: npt.NDArray[np.intp],
        site_mm: _Array,
        site_quat: _Array,
    ) -> None:
        """Applies what gels and bodies do to each other."""
        on_gel = self._batch.wrench_of_touches().astype(float)
        quat = site_quat[world, sensor]
        force_n, torque_n_m = rotate(quat, on_gel[:, :3]), 1e-3 * rotate(quat, on_gel[:, 3:])
        at_m = 1e-3 * (site_mm[world, sensor] + rotate(quat, self._center_mm))
        middle_m = _rows(data, "xipos", self._n_worlds)
        new = np.zeros_like(self._applied)
        for body, sign in ((self._body[sensor], 1.0), (self._geom_body[geom], -1.0)):
            lever_m = at_m - middle_m[world, body]
            torque = torque_n_m + cross(lever_m, force_n)
            np.add.at(new, (world, body), sign * np.concatenate([force_n, torque], axis=1))
        applied = _rows(data, "xfrc_applied", self._n_worlds)
        applied += new - self._applied
        self._applied = new


def _rows(data: _Data, name: str, n_worlds: int) -> _Array:
    """A field of one world or many, `[n_worlds, n, …]`."""
    if isinstance(data, mujoco.MjData):
        if n_worlds != 1:
            raise ValueError(f"`data` is of one world, the sensors are of {n_worlds}: hand in the batch")
        rows: _Array = getattr(data, name)[None]
        return rows
    if data.nsim != n_worlds:
        raise ValueError(f"`data` has {data.nsim} worlds, the sensors are of {n_worlds}")
    rows = data.bind(name)
    return rows


def _touchable(model: mujoco.MjModel, names: Sequence[str] | None) -> tuple[list[_Geom], list[Body]]:
    if names is None:
        collides = (model.geom_contype | model.geom_conaffinity) != 0
        numbers = [int(number) for number in np.nonzero(collides)[0]]
    else:
        numbers = [_number(model, "geom", name) for name in names]
    shapes: dict[tuple[int, int, bytes], int] = {}
    bodies: list[Body] = []
    origins_mm: list[float] = []
    geoms = []
    for number in numbers:
        key = key_of(model, number)
        if key not in shapes:
            body, origin_mm = body_of(model, number)
            shapes[key] = len(bodies)
            bodies.append(body)
            origins_mm.append(origin_mm)
        shape = shapes[key]
        geoms.append(
            _Geom(
                number=number,
                body=int(model.geom_bodyid[number]),
                shape=shape,
                origin_mm=origins_mm[shape],
                radius_mm=1e3 * float(model.geom_rbound[number]),
                is_plane=int(model.geom_type[number]) == _PLANE,
            )
        )
    if not geoms:
        raise ValueError("the model has no geom that could touch: all have `contype` and `conaffinity` 0; name some in `geoms`")
    return geoms, bodies


def _number(model: mujoco.MjModel, kind: str, name: str) -> int:
    objects = {"site": mujoco.mjtObj.mjOBJ_SITE, "geom": mujoco.mjtObj.mjOBJ_GEOM}
    number: int = mujoco.mj_name2id(model, objects[kind], name)
    if number < 0:
        count = {"site": model.nsite, "geom": model.ngeom}[kind]
        names = (mujoco.mj_id2name(model, objects[kind], other) for other in range(count))
        known = ", ".join(other for other in names if other) or "none"
        raise ValueError(f"the model has no {kind} `{name}`; it has {known}")
    return number
