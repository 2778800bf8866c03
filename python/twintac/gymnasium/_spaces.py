"""Code that the environments share."""

from __future__ import annotations

import importlib.util
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import gymnasium as gym

    from twintac import FastGel, SensorVariation, Tasks
    from twintac.gymnasium._in_hand import InHandTurn

KINDS = ("ExploreShape", "HoldForce", "FollowEdge", "InHandTurn")
"""Names of the tasks."""

FRAMES_PER_S = {"ExploreShape": 2, "HoldForce": 55, "FollowEdge": 55, "InHandTurn": 12.5}
"""Steps of each task in a second."""

Single: TypeAlias = npt.NDArray[np.float32]
"""Arrays of single precision."""


def require_gymnasium() -> None:
    """Raises `ImportError`, which says how to install Gymnasium, if it is missing."""
    if importlib.util.find_spec("gymnasium") is None:
        raise ImportError("twintac.gymnasium needs the package gymnasium: pip install gymnasium")


def make_tasks(
    kind: str,
    n_environments: int,
    *,
    gel: FastGel | None = None,
    variation: SensorVariation | None = None,
    touch: str | None = None,
    autoreset: Literal["NextStep", "SameStep", "Disabled"] = "NextStep",
    n_threads: int | None = None,
) -> Tasks | InHandTurn:
    """The environments of a task. `touch` is for InHandTurn only."""
    from twintac import Error, Tasks

    if kind == "InHandTurn":
        from twintac.gymnasium._in_hand import InHandTurn

        return InHandTurn(
            n_environments, gel=gel, variation=variation, touch="taxels" if touch is None else touch, autoreset=autoreset, n_threads=n_threads
        )
    if touch is not None:
        raise Error(f"`touch` is for InHandTurn, not for {kind}")
    return Tasks(kind, n_environments, gel=gel, variation=variation, autoreset=autoreset, n_threads=n_threads)


def spaces(tasks: Tasks | InHandTurn) -> tuple[gym.Space[Single], gym.Space[Single]]:
    """The spaces of observations and actions of one environment."""
    from gymnasium.spaces import Box

    observation: gym.Space[Any] = Box(-10.0, 10.0, (tasks.n_observed,), np.float32)
    action: gym.Space[Any] = Box(-1.0, 1.0, (tasks.n_actions,), np.float32)
    return observation, action
