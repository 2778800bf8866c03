"""The vector environments for Stable-Baselines3: `TouchVecEnv("HoldForce", 256)` is a `VecEnv`."""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from typing import Any

if importlib.util.find_spec("stable_baselines3") is None:
    raise ImportError("twintac.gymnasium.sb3 needs the package stable-baselines3: pip install stable-baselines3")

import numpy as np
import numpy.typing as npt
from stable_baselines3.common.vec_env import VecEnv  # type: ignore[import-not-found, unused-ignore]

from twintac import FastGel, SensorVariation
from twintac.gymnasium._spaces import Single, make_tasks, spaces


class TouchVecEnv(VecEnv):  # type: ignore[misc, unused-ignore]
    """Many environments of a task. An episode that ends is followed by a new one in the same step,
    as Stable-Baselines3 expects.

    Args:
        kind: as in `twintac.gymnasium.TouchVectorEnv`.
        num_envs: number of environments.
        variation: as in `TouchVectorEnv`.
        gel: as in `TouchVectorEnv`.
        touch: as in `TouchVectorEnv`.
        n_threads: as in `TouchVectorEnv`.
        seed: environment `i` has the seed `seed + i`.
    """

    def __init__(
        self,
        kind: str,
        num_envs: int,
        *,
        variation: SensorVariation | None = None,
        gel: FastGel | None = None,
        touch: str | None = None,
        n_threads: int | None = None,
        seed: int = 0,
    ) -> None:
        self.tasks = make_tasks(
            kind, num_envs, gel=gel, variation=variation, touch=touch, autoreset="SameStep", n_threads=n_threads
        )
        self.tasks.seed([seed + number for number in range(num_envs)])
        self.render_mode = None
        super().__init__(num_envs, *spaces(self.tasks))
        self._figures = self.tasks.figures
        self._returns = np.zeros(num_envs)
        self._lengths = np.zeros(num_envs, np.int64)

    def reset(self) -> Single:  # type: ignore[override, unused-ignore]
        """Begins the next episode of every environment.

        Returns:
            Observations, `[num_envs, n_observed]`.
        """
        self.tasks.seed(self._seeds)
        self._reset_seeds()
        self._reset_options()
        self._returns[:] = 0.0
        self._lengths[:] = 0
        return self.tasks.reset()[0]

    def step_async(self, actions: npt.NDArray[Any]) -> None:
        """Stores the actions of the next step, `[num_envs, n_actions]`."""
        self._actions = actions

    def step_wait(self) -> tuple[Single, npt.NDArray[np.float64], npt.NDArray[np.bool_], list[dict[str, Any]]]:  # type: ignore[override, unused-ignore]
        """Makes the step.

        Returns:
            Observations, `[num_envs, n_observed]`; rewards, and whether episodes ended, each
                `[num_envs]`; and infos. Only the infos of episodes that ended have content: the
                figures of the task, `terminal_observation`, `TimeLimit.truncated` and `episode`.
        """
        observed, rewards, terminated, truncated, _, last = self.tasks.step(self._actions)
        self._returns += rewards
        self._lengths += 1
        ended = terminated | truncated
        infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        if last is not None:
            for number in np.flatnonzero(ended):
                info: dict[str, Any] = dict(zip(self._figures, map(float, last[1][number])))
                info["terminal_observation"] = last[0][number]
                info["TimeLimit.truncated"] = bool(truncated[number])
                info["episode"] = {"r": float(self._returns[number]), "l": int(self._lengths[number]), "t": 0.0}
                infos[number] = info
            self._returns[ended] = 0.0
            self._lengths[ended] = 0
        return observed, rewards, ended, infos

    def close(self) -> None:
        """Does nothing: the environments hold no resources."""

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of this object, once for each environment."""
        return [getattr(self, attr_name)] * len(self._numbers(indices))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Raises `AttributeError`: environments have no attributes of their own."""
        raise AttributeError(f"environments of {type(self).__name__} have no attribute of their own to set: {attr_name}")

    def env_method(self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any) -> list[Any]:
        """Raises `AttributeError`: environments have no methods of their own."""
        raise AttributeError(f"environments of {type(self).__name__} have no method of their own: {method_name}")

    def env_is_wrapped(self, wrapper_class: type[Any], indices: Any = None) -> list[bool]:
        """`False` for each environment: there are no wrappers."""
        return [False] * len(self._numbers(indices))

    def get_images(self) -> Sequence[npt.NDArray[np.uint8]]:
        """A picture of each environment, 0 to 255, `[240, 600, 3]`, for InHandTurn `[240, 320, 3]`."""
        return [self.tasks.picture(number) for number in range(self.num_envs)]

    def _numbers(self, indices: Any) -> list[int]:
        return list(self._get_indices(indices))
