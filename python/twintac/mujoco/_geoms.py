"""The geoms that can touch sensors, and their shapes in each world."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
import numpy.typing as npt

from ._shapes import PLANE, Felt, contents, felt, key_of
from ._worlds import Data, Worlds

_Ints = npt.NDArray[np.intp]
_Fields = list[npt.NDArray[Any]]
# The fields that define a geom's shape, besides those of meshes and height fields.
_FIELDS = ("geom_type", "geom_dataid", "geom_size")
_COLLIDES = ("geom_contype", "geom_conaffinity")


class Geoms:
    """The geoms that can touch: those with the given names, or all that collide. Their shapes are
    read again when models have changed.
    """

    def __init__(self, model: mujoco.MjModel, worlds: Worlds, names: Sequence[str] | None) -> None:
        self._worlds = worlds
        self._by_name = names is not None
        if names is None:
            self.number = colliding(model)
        else:
            self.number = np.array([number_of(model, "geom", name) for name in names], int)
        if not len(self.number):
            raise ValueError("the model has no geom that could touch: all have `contype` and `conaffinity` 0; name some in `geoms`")
        self.body: _Ints = model.geom_bodyid[self.number].astype(int)
        self._models: list[mujoco.MjModel] = []
        self._fields: _Fields = []
        self._assets: _Fields = []
        self._felt: dict[tuple[object, ...], Felt] = {}
        self._expected = np.zeros(model.ngeom, bool)
        self._expected[self.number] = True
        self._read([model], [np.asarray(getattr(model, name))[None][:, self.number] for name in _FIELDS])

    def read(self, data: Data) -> bool:
        """Reads the geoms of all worlds, if they have changed; returns whether any has.

        Raises `ValueError` if other geoms collide than at first, and for geoms of unsupported
        types.
        """
        models = self._worlds.models
        fields: _Fields = [self._worlds.field(data, name)[:, self.number] for name in _FIELDS]
        self._check_colliding(data)
        is_same = len(models) == len(self._models) and all(one is other for one, other in zip(models, self._models))
        is_same = is_same and _equal(fields, self._fields)
        # The models of single worlds are replaced when they change.
        if is_same and (len(models) > 1 or _equal(self._contents(models[0], fields), self._assets)):
            return False
        self._read(models, fields)
        return True

    def _read(self, models: list[mujoco.MjModel], fields: _Fields) -> None:
        kind, asset, size = fields
        n_read = max(len(models), *(len(field) for field in fields))
        number: dict[tuple[object, ...], int] = {}
        found: dict[tuple[object, ...], Felt] = {}
        shape = np.zeros((n_read, len(self.number)), int)
        for world in range(n_read):
            model = models[min(world, len(models) - 1)]
            for place, geom in enumerate(self.number):
                kind_here, asset_here = (int(field[min(world, len(field) - 1), place]) for field in (kind, asset))
                half_m = np.array(size[min(world, len(size) - 1), place], float)
                key = key_of(model, kind_here, asset_here, half_m)
                if key not in number:
                    number[key] = len(number)
                    found[key] = self._felt[key] if key in self._felt else felt(model, int(geom), kind_here, asset_here, half_m)
                shape[world, place] = number[key]
        self._felt, self._models = found, models
        self._fields = [np.array(field) for field in fields]
        self._assets = [np.array(part) for part in self._contents(models[0], fields)]
        self.bodies = [one.body for one in found.values()]
        n_all = (self._worlds.n_worlds, len(self.number))
        self.shape: _Ints = np.broadcast_to(shape, n_all)
        self.origin_mm = np.broadcast_to(np.array([one.origin_mm for one in found.values()])[shape], n_all)
        self.radius_mm = np.broadcast_to(np.array([one.radius_mm for one in found.values()])[shape], n_all)
        self.is_plane = np.broadcast_to(kind == PLANE, n_all)

    def _contents(self, model: mujoco.MjModel, fields: _Fields) -> _Fields:
        """The data of meshes and height fields."""
        kinds = {(int(kind), int(asset)) for kind, asset in zip(fields[0].ravel(), fields[1].ravel())}
        return [part for kind in sorted(kinds) for part in contents(model, *kind)]

    def _check_colliding(self, data: Data) -> None:
        if self._by_name:
            return
        contype, conaffinity = (self._worlds.field(data, name) != 0 for name in _COLLIDES)
        if ((contype | conaffinity) != self._expected).any():
            raise ValueError("other geoms collide than when the sensors were made: name those that can touch in `geoms`, or make `TouchSensors` anew")


def _equal(some: _Fields, others: _Fields) -> bool:
    return len(some) == len(others) and all(np.array_equal(one, other) for one, other in zip(some, others))


def colliding(model: mujoco.MjModel) -> _Ints:
    """The indices of the geoms that collide with others."""
    return np.nonzero((model.geom_contype | model.geom_conaffinity) != 0)[0]


def filtered(model: mujoco.MjModel, with_gel: _Ints, others: _Ints, by_family: bool) -> npt.NDArray[np.bool_]:
    """Which pairs of bodies MuJoCo lets pass through each other, `[n_with_gel, n_others]`: bodies of
    one rigid part, those that the model excludes, and with `by_family` a body and its parent, unless
    the model disables that filter.
    """
    weld: _Ints = np.asarray(model.body_weldid, int)
    parent: _Ints = weld[model.body_parentid[weld]]
    a, b = weld[with_gel][:, None], weld[others][None, :]
    apart = a == b
    if by_family and not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_FILTERPARENT):
        apart = apart | ((a > 0) & (b > 0) & ((parent[a] == b) | (parent[b] == a)))
    signature = np.asarray(model.exclude_signature, np.int64)
    pairs = (with_gel[:, None].astype(np.int64) << 16) + others[None, :], (others[None, :].astype(np.int64) << 16) + with_gel[:, None]
    return np.asarray(apart | np.isin(pairs[0], signature) | np.isin(pairs[1], signature))


def number_of(model: mujoco.MjModel, kind: str, name: str) -> int:
    """The index of a site or geom.

    Raises `ValueError` for one that the model does not have.
    """
    objects = {"site": mujoco.mjtObj.mjOBJ_SITE, "geom": mujoco.mjtObj.mjOBJ_GEOM}
    number: int = mujoco.mj_name2id(model, objects[kind], name)
    if number < 0:
        count = {"site": model.nsite, "geom": model.ngeom}[kind]
        names = (mujoco.mj_id2name(model, objects[kind], other) for other in range(count))
        known = ", ".join(other for other in names if other) or "none"
        raise ValueError(f"the model has no {kind} `{name}`; it has {known}")
    return number
