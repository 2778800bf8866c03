"""One world (`MjData`) or many (a persistent `Batch`), and the models of these worlds."""

import weakref
from typing import TypeAlias

import mujoco
import numpy as np
import numpy.typing as npt

from ._poses import quaternion_of

try:
    from mujoco.batch import Batch
except ModuleNotFoundError:  # before MuJoCo 4
    Batch = mujoco.MjData

_Array = npt.NDArray[np.float64]
Data: TypeAlias = mujoco.MjData | Batch
# Models must agree in these fields, so that indices of bodies, geoms and sites have the same
# meaning.
_SIZES = ("nbody", "nv", "ngeom", "nsite")
_LAYOUT = ("body_parentid", "body_dofadr", "geom_bodyid", "site_bodyid")


class Worlds:
    """The worlds of data; they have one model, or models with the same layout."""

    def __init__(self, model: mujoco.MjModel, n_worlds: int) -> None:
        self._model, self.n_worlds = model, n_worlds
        self._known: list[mujoco.MjModel] = [model]
        self._copies: weakref.WeakKeyDictionary[Batch, mujoco.MjModel] = weakref.WeakKeyDictionary()

    def rows(self, data: Data, name: str) -> _Array:
        """A field of every world, `[n_worlds, …]`; it is writable for one world, and for the state
        of a batch.
        """
        rows: _Array = np.asarray(getattr(data, name))[None] if isinstance(data, mujoco.MjData) else data.bind(name)
        return rows

    def quaternions(self, data: Data, kind: str) -> _Array:
        """Rotations of sites or geoms as quaternions; MuJoCo has them since version 4."""
        if hasattr(mujoco.MjData, f"{kind}_xquat"):
            return self.rows(data, f"{kind}_xquat")
        turn = self.rows(data, f"{kind}_xmat")
        return quaternion_of(turn.reshape(*turn.shape[:2], 3, 3))

    def times_s(self, data: Data) -> _Array:
        """A copy of the time of every world, s, `[n_worlds]`."""
        return np.array([data.time]) if isinstance(data, mujoco.MjData) else np.array(data.bind("time"), float)

    def look(self, data: Data) -> None:
        """Updates `models`: one for all worlds, or one for each.

        Raises `ValueError` for data of another number of worlds or of another model, and for a
        batch that is not persistent.
        """
        if isinstance(data, mujoco.MjData):
            if self.n_worlds != 1:
                raise ValueError(f"`data` is of one world, the sensors are of {self.n_worlds}: hand in the batch")
            found = [data.model]
        else:
            found = self._of_batch(data)
        if len(found) != len(self._known) or any(one is not other for one, other in zip(found, self._known)):
            for model in found:
                self._check(model)
            self._known = found

    @property
    def models(self) -> list[mujoco.MjModel]:
        """The models that were found last: one for all worlds, or one for each."""
        return self._known

    def field(self, data: Data, name: str) -> _Array:
        """A field of the models, `[1, …]` if it is the same in all worlds, else `[n_worlds, …]`."""
        if not isinstance(data, mujoco.MjData) and data.models is None:
            expanded = data.expanded(name)
            if expanded is not None:
                return np.asarray(expanded)
        if len(self._known) == 1:
            return np.asarray(_of(self._known[0], name))[None]
        return np.stack([np.asarray(_of(model, name)) for model in self._known])

    def _of_batch(self, batch: Batch) -> list[mujoco.MjModel]:
        if batch.nsim != self.n_worlds:
            raise ValueError(f"`data` has {batch.nsim} worlds, the sensors are of {self.n_worlds}")
        if not batch.persistent:
            raise ValueError("the batch is not persistent, so that a step does not go on from the poses that sensors read: make it with `persistent=True`")
        models = batch.models
        if models is not None:
            return [models] if isinstance(models, mujoco.MjModel) else list(models)
        # A batch steps a copy of the model that it was made of.
        if batch not in self._copies:
            self._copies[batch] = batch.get_model(0)
        return [self._copies[batch]]

    def _check(self, model: mujoco.MjModel) -> None:
        own = self._model
        same = all(getattr(model, name) == getattr(own, name) for name in _SIZES)
        if not (same and all(np.array_equal(getattr(model, name), getattr(own, name)) for name in _LAYOUT)):
            raise ValueError("`data` is of another model than the sensors: its bodies, geoms or sites are others; make `TouchSensors` of its model")


def _of(model: mujoco.MjModel, name: str) -> npt.ArrayLike:
    owner = model.opt if name.startswith("opt.") else model
    field: npt.ArrayLike = getattr(owner, name.removeprefix("opt."))
    return field
