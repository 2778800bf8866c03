"""Code that the environments share."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import gymnasium as gym

    from twintac import Tasks

KINDS = ("ExploreShape", "HoldForce", "FollowEdge")
"""Names of the tasks."""

FRAMES_PER_S = {"ExploreShape": 2, "HoldForce": 55, "FollowEdge": 55}
"""Steps of each task in a second."""

Single: TypeAlias = npt.NDArray[np.float32]
"""Arrays of single precision."""


def require_gymnasium() -> None:
    """Raises `ImportError`, which says how to install Gymnasium, if it is missing."""
    if importlib.util.find_spec("gymnasium") is None:
        raise ImportError("twintac.gymnasium needs the package gymnasium: pip install gymnasium")


def spaces(tasks: Tasks) -> tuple[gym.Space[Single], gym.Space[Single]]:
    """The spaces of observations and actions of one environment."""
    from gymnasium.spaces import Box

    observation: gym.Space[Any] = Box(-10.0, 10.0, (tasks.n_observed,), np.float32)
    action: gym.Space[Any] = Box(-1.0, 1.0, (tasks.n_actions,), np.float32)
    return observation, action
