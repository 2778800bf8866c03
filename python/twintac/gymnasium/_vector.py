"""Many environments, stepped in one call."""

from __future__ import annotations

from collections.abc import Sequence
from operator import index
from typing import Any, ClassVar, SupportsIndex

import gymnasium as gym
import numpy as np
import numpy.typing as npt
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space

from twintac import FastGel, SensorVariation
from twintac.gymnasium._spaces import FRAMES_PER_S, Single, make_tasks, spaces

_Bool = npt.NDArray[np.bool_]


class TouchVectorEnv(gym.vector.VectorEnv[Single, Single, npt.NDArray[Any]]):
    """Many environments of a task, stepped in one call. With a seed, environment `i` equals a
    single environment with the seed `seed + i`; it does not depend on the other environments.

    Args:
        kind: `"ExploreShape"`, `"HoldForce"`, `"FollowEdge"` or `"InHandTurn"`. `twintac.gymnasium`
            describes their observations, actions and rewards.
        num_envs: number of environments.
        variation: the sensor variation from which the sensor of each episode is drawn; that of a
            working sensor unless given.
        gel: the surrogate of the gel; that of the task's sensor unless given.
        touch: for InHandTurn: what is measured besides the joints, `"taxels"`, the reading of each
            taxel, `"forces"`, one normal force for each fingertip, `"truth"`, what only the
            simulation knows, several of these with `+` between them, or `"none"`.
        autoreset_mode: when an environment whose episode is over begins the next one: in the next
            step, in the same step, or when `reset` is called.
        n_threads: number of threads; as many as there are cores unless given. Results do not depend
            on it.
        render_mode: `"rgb_array"`, or none.

    Raises:
        twintac.Error: for an unknown task, and for actions of another shape or that are not finite.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"],
        "render_fps": 55,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }
    """Gymnasium's data about the environments; `render_fps` is the number of steps in a second."""
    provenance: ClassVar[str] = "simulated"
    """Provenance of all numbers."""

    def __init__(
        self,
        kind: str,
        num_envs: int = 1,
        *,
        variation: SensorVariation | None = None,
        gel: FastGel | None = None,
        touch: str | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        n_threads: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        mode = AutoresetMode(autoreset_mode)
        self._tasks = make_tasks(
            kind,
            num_envs,
            gel=gel,
            variation=variation,
            touch=touch,
            autoreset=mode.value,
            n_threads=n_threads,
        )
        self._figures = self._tasks.figures
        num_envs = self.num_envs = len(self._tasks)
        self.single_observation_space, self.single_action_space = spaces(self._tasks)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.metadata = {**self.metadata, "autoreset_mode": mode, "render_fps": FRAMES_PER_S[kind]}
        self.render_mode = render_mode
        self._is_seeded = False
        self._observed: Single = np.zeros(self.observation_space.shape or (), np.float32)

    def reset(
        self, *, seed: SupportsIndex | Sequence[SupportsIndex | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Single, dict[str, Any]]:
        """Begins the next episode of each environment, or of chosen ones.

        Args:
            seed: environment `i` gets the seed `seed + i`, or the one of a list.
            options: `options["reset_mask"]`, `[num_envs]`, is true for the environments to reset;
                all unless given.

        Returns:
            Observations, `[num_envs, n_observed]`, and infos.
        """
        if seed is None and not self._is_seeded:
            seed = int(self.np_random.integers(2**62))
        if seed is not None:
            if isinstance(seed, Sequence | np.ndarray):
                self._tasks.seed(seed)
            else:
                self._tasks.seed([index(seed) + number for number in range(self.num_envs)])
            self._is_seeded = True
        mask = (options or {}).get("reset_mask")
        which: _Bool | None = None if mask is None else np.asarray(mask)
        observed, figures = self._tasks.reset(which)
        if which is not None:
            observed = np.where(which[:, None], observed, self._observed)
        self._observed = observed
        return observed, self._infos(figures, np.ones(self.num_envs, np.bool_) if which is None else which)

    def step(self, actions: Single) -> tuple[Single, npt.NDArray[np.float64], _Bool, _Bool, dict[str, Any]]:
        """Makes one step of every environment.

        Args:
            actions: the actions, `[num_envs, n_actions]`.

        Returns:
            Observations, `[num_envs, n_observed]`; rewards, whether the task is over, and whether
                time is over, each `[num_envs]`; and infos. With the mode `"SameStep"` the infos
                have `final_obs` and `final_info` of the episodes that ended.
        """
        observed, rewards, terminated, truncated, figures, last = self._tasks.step(actions)
        self._observed = observed
        infos = self._infos(figures, np.ones(self.num_envs, np.bool_))
        if last is not None:
            self._tell_ends(infos, terminated | truncated, *last)
        return observed, rewards, terminated, truncated, infos

    def render(self) -> tuple[npt.NDArray[np.uint8], ...] | None:  # type: ignore[override]
        """A picture of each environment, 0 to 255, `[240, 600, 3]`, for InHandTurn `[240, 320, 3]`;
        `None` unless `render_mode` is `"rgb_array"`.
        """
        if self.render_mode != "rgb_array":
            return None
        return tuple(self._tasks.picture(number) for number in range(self.num_envs))

    def _infos(self, figures: Single, which: _Bool) -> dict[str, Any]:
        infos: dict[str, Any] = {}
        for name, values in zip(self._figures, figures.T):
            infos[name] = values
            infos[f"_{name}"] = which
        return infos

    def _tell_ends(self, infos: dict[str, Any], ended: _Bool, observed: Single, figures: Single) -> None:
        """Adds the last observation of the episodes that ended in this step to the infos, in the
        form of Gymnasium's own vector environments.
        """
        last = np.full(self.num_envs, None, dtype=object)
        for number in np.flatnonzero(ended):
            last[number] = observed[number]
        infos["final_obs"], infos["_final_obs"] = last, ended
        infos["final_info"], infos["_final_info"] = self._infos(figures, ended), ended
