"""The forces between gels and bodies, in MuJoCo's form."""

import mujoco
import numpy as np
import numpy.typing as npt

from ._poses import cross
from ._worlds import Data, Worlds

_Array = npt.NDArray[np.float64]
_FEELING = (int(mujoco.mjtSensor.mjSENS_FORCE), int(mujoco.mjtSensor.mjSENS_TORQUE))


class Push:
    """Wrenches on bodies along world axes, `[n_worlds, n_bodies, 6]`: force, N, and torque, N m,
    about the reference point that MuJoCo uses for each.
    """

    def __init__(self, model: mujoco.MjModel, worlds: Worlds, bodies: npt.NDArray[np.intp]) -> None:
        self._model, self._worlds, self.bodies = model, worlds, np.unique(bodies[bodies > 0])
        self._row = np.full(model.nbody, -1)
        self._row[self.bodies] = np.arange(len(self.bodies))
        # Which degrees of freedom move which body.
        self._moves = np.zeros((model.nv, len(self.bodies)))
        for row, body in enumerate(self.bodies):
            for other in _up(model, int(body)):
                first = int(model.body_dofadr[other])
                self._moves[first : first + int(model.body_dofnum[other]), row] = 1.0
        self.owned = self._moves.any(axis=1)
        self._written = np.zeros((worlds.n_worlds, int(self.owned.sum())))
        # The values that a restored state had written are allowed there, too.
        self._restored = self._written.copy()

    def on_bodies(self, about: _Array, touching: tuple[_Array, _Array, _Array], who: tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], npt.NDArray[np.intp]]) -> _Array:
        """The wrench on each body, `[n_worlds, n_bodies, 6]`, from wrenches on gels.

        - `about`: the reference point of each body's torque, m, `[n_worlds, n_bodies, 3]`.
        - `touching`: force on the gel, N, torque, N m, and the point of application, m,
          `[n_touches, 3]` each.
        - `who`: indices of the world, of the body with the gel and of the touching body,
          `[n_touches]` each.
        """
        (force_n, torque_n_m, at_m), (world, with_gel, other) = touching, who
        total = np.zeros((self._worlds.n_worlds, len(self.bodies), 6))
        for body, sign in ((with_gel, 1.0), (other, -1.0)):
            row = self._row[body]
            moved = row >= 0
            lever_m = at_m[moved] - about[world[moved], row[moved]]
            torque = torque_n_m[moved] + cross(lever_m, force_n[moved])
            np.add.at(total, (world[moved], row[moved]), sign * np.concatenate([force_n[moved], torque], axis=1))
        return total

    def middles_m(self, data: Data) -> _Array:
        """The reference points of the bodies' wrenches in `xfrc_applied`, m."""
        return self._worlds.rows(data, "xipos")[:, self.bodies]

    def roots_m(self, data: Data) -> _Array:
        """The reference points of the motions of degrees of freedom, m."""
        return self._worlds.rows(data, "subtree_com")[:, self._model.body_rootid[self.bodies]]

    def generalized(self, data: Data, about_roots: _Array) -> _Array:
        """Wrenches about the roots, converted to forces of the degrees of freedom,
        `[n_worlds, n_owned]`.
        """
        wrench = self._moves[self.owned] @ about_roots
        motion = self._worlds.rows(data, "cdof")[:, self.owned]
        with np.errstate(invalid="ignore"):
            forces = (motion[..., :3] * wrench[..., 3:]).sum(-1) + (motion[..., 3:] * wrench[..., :3]).sum(-1)
        # Forces are not finite if a body of the kinematic tree has no finite pose; they become 0.
        return np.where(np.isfinite(forces), forces, 0.0)

    def check(self, data: Data, goes_on: npt.NDArray[np.bool_]) -> None:
        """Raises `ValueError` if others have changed the values in `qfrc_applied` that are written
        here; `goes_on`: the worlds in which a step was made with these values.
        """
        found = self._worlds.rows(data, "qfrc_applied")[:, self.owned]
        foreign = (found != 0.0) & (found != self._written) & (found != self._restored)
        cleared = goes_on[:, None] & (found == 0.0) & (self._written != 0.0)
        if not (foreign | cleared).any():
            return
        world, dof = (int(part[0]) for part in np.nonzero(foreign | cleared))
        joint = int(self._model.dof_jntid[np.nonzero(self.owned)[0][dof]])
        joint_name = self._model.joint(joint).name or str(joint)
        problem = f"`qfrc_applied` of joint `{joint_name}` in world {world} is {found[world, dof]:g}, `update` wrote {self._written[world, dof]:g}"
        raise ValueError(f"{problem}: what gels do stands there; give forces of yours in `xfrc_applied`, set `qfrc_applied` to 0 after another state was loaded, or step within `with touch.pushing(data):`, which leaves it to you")

    def write(self, data: Data, forces: _Array) -> None:
        """Writes the forces of the degrees of freedom into `qfrc_applied`."""
        self._worlds.rows(data, "qfrc_applied")[:, self.owned] = forces
        self._written = forces
        self._restored = np.zeros_like(forces)

    @property
    def written(self) -> _Array:
        """The values that were written last, `[n_worlds, n_owned]`."""
        return self._written

    def restore(self, world: int, written: _Array) -> None:
        """Stores the values that a restored state had written."""
        self._restored[world] = written

    def unfelt_by(self) -> str | None:
        """The first of MuJoCo's own force or torque sensors that would not measure forces in
        `qfrc_applied`, by name or number; `None` if there is none.
        """
        model = self._model
        above = {other for body in self.bodies for other in _up(model, int(body))}
        for sensor in range(model.nsensor):
            if int(model.sensor_type[sensor]) in _FEELING and int(model.site_bodyid[model.sensor_objid[sensor]]) in above:
                return str(model.sensor(sensor).name or sensor)
        return None


def _up(model: mujoco.MjModel, body: int) -> list[int]:
    """A body and all its ancestors, without the world."""
    chain = []
    while body > 0:
        chain.append(body)
        body = int(model.body_parentid[body])
    return chain
