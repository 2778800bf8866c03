"""A single environment."""

from __future__ import annotations

from operator import index
from typing import Any, ClassVar, SupportsIndex

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from twintac import FastGel, SensorVariation
from twintac.gymnasium._spaces import FRAMES_PER_S, Single, make_tasks, spaces


class TouchEnv(gym.Env[Single, Single]):
    """One environment of a task. With the same seed, it equals an environment of a vector
    environment.

    Args:
        kind: `"ExploreShape"`, `"HoldForce"`, `"FollowEdge"` or `"InHandTurn"`. `twintac.gymnasium`
            describes their observations, actions and rewards.
        variation: the sensor variation from which the sensor of each episode is drawn; that of a
            working sensor unless given.
        gel: the surrogate of the gel; that of the task's sensor unless given.
        touch: for InHandTurn: what is measured besides the joints, `"taxels"`, the reading of each
            taxel, `"forces"`, one normal force for each fingertip, `"truth"`, what only the
            simulation knows, several of these with `+` between them, or `"none"`.
        render_mode: `"rgb_array"`, or none.

    Raises:
        twintac.Error: for an unknown task, and for actions of another shape or that are not finite.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 55}
    """Gymnasium's data about the environment; `render_fps` is the number of steps in a second."""
    provenance: ClassVar[str] = "simulated"
    """Provenance of all numbers."""

    def __init__(
        self,
        kind: str,
        *,
        variation: SensorVariation | None = None,
        gel: FastGel | None = None,
        touch: str | None = None,
        render_mode: str | None = None,
    ) -> None:
        self._tasks = make_tasks(kind, 1, gel=gel, variation=variation, touch=touch, autoreset="Disabled", n_threads=1)
        self._figures = self._tasks.figures
        self.observation_space, self.action_space = spaces(self._tasks)
        self.metadata = {**self.metadata, "render_fps": FRAMES_PER_S[kind]}
        self.render_mode = render_mode
        self._is_seeded = False

    def reset(self, *, seed: SupportsIndex | None = None, options: dict[str, Any] | None = None) -> tuple[Single, dict[str, Any]]:
        """Begins the next episode, or the first one of a seed.

        Args:
            seed: seed of the environment; the sequence of episodes continues unless given.
            options: without effect.

        Returns:
            The observation, `[n_observed]`, and the info.
        """
        seed = None if seed is None else index(seed)  # Gymnasium does not accept integers of NumPy
        super().reset(seed=seed)
        if seed is None and not self._is_seeded:
            seed = int(self.np_random.integers(2**63))
        if seed is not None:
            self._tasks.seed([seed])
            self._is_seeded = True
        observed, figures = self._tasks.reset()
        return observed[0], self._info(figures[0])

    def step(self, action: Single) -> tuple[Single, float, bool, bool, dict[str, Any]]:
        """Makes one step.

        Args:
            action: the action, `[n_actions]`.

        Returns:
            The observation, the reward, whether the task is over, whether time is over, and the
                info.
        """
        actions = np.asarray(action, np.float32).reshape(1, -1)
        observed, rewards, terminated, truncated, figures, _ = self._tasks.step(actions)
        return observed[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), self._info(figures[0])

    def render(self) -> npt.NDArray[np.uint8] | None:  # type: ignore[override]
        """A picture of the object from above and of the readings, 0 to 255, `[240, 600, 3]`, for
        InHandTurn of the hand, `[240, 320, 3]`; `None` unless `render_mode` is `"rgb_array"`.
        """
        return self._tasks.picture(0) if self.render_mode == "rgb_array" else None

    def _info(self, figures: Single) -> dict[str, Any]:
        return dict(zip(self._figures, map(float, figures)))
