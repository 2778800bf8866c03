"""Tests of the tasks as Gymnasium environments."""

import importlib.util
import subprocess
import sys
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import twintac
import twintac.gymnasium
from twintac.gymnasium.policies import random_policy, returns, scripted_policy

KINDS = ("ExploreShape", "HoldForce", "FollowEdge")


@pytest.mark.parametrize("kind", KINDS)
def test_gymnasium_finds_nothing_wrong(kind: str) -> None:
    check_env(gym.make(f"TwinTac/{kind}-v0", render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("kind", KINDS)
def test_one_of_many_is_as_alone(kind: str) -> None:
    many = gym.make_vec(f"TwinTac/{kind}-v0", num_envs=5)
    assert isinstance(many.unwrapped, twintac.gymnasium.TouchVectorEnv)
    alone = gym.make(f"TwinTac/{kind}-v0")
    many.action_space.seed(1)
    first, _ = many.reset(seed=7)
    again, _ = many.reset(seed=np.int64(7))  # type: ignore[arg-type]  # NumPy's integers are integers
    assert np.array_equal(first, again)
    observed, _ = alone.reset(seed=7 + 3)
    assert np.array_equal(first[3], observed)
    for _ in range(20):
        actions = many.action_space.sample()
        observations, rewards, terminated, truncated, infos = many.step(actions)
        observed, reward, is_over, is_late, info = alone.step(actions[3])
        assert np.array_equal(observations[3], observed)
        assert (rewards[3], terminated[3], truncated[3]) == (reward, is_over, is_late)
        assert all(infos[name][3] == value for name, value in info.items())
        if is_over or is_late:
            break


def test_the_next_episode_begins_in_the_next_step_or_the_same() -> None:
    next_step = gym.make_vec("TwinTac/ExploreShape-v0", num_envs=2)
    same_step = gym.make_vec("TwinTac/ExploreShape-v0", num_envs=2, autoreset_mode=AutoresetMode.SAME_STEP)
    assert next_step.metadata["autoreset_mode"] == AutoresetMode.NEXT_STEP
    assert same_step.metadata["autoreset_mode"] == AutoresetMode.SAME_STEP
    actions = np.zeros((2, 8), np.float32)
    last: Any = None
    for env in (next_step, same_step):
        env.reset(seed=1)
        for _ in range(5):
            last = env.step(actions)
        assert last[2].all()
        if env is next_step:
            ends, begins = last[0], env.step(actions)[0]
    assert np.array_equal(last[0], begins)
    assert np.array_equal(np.stack(last[4]["final_obs"]), ends)
    assert last[4]["_final_obs"].all() and "is_right" in last[4]["final_info"]


def test_environments_without_autoreset_are_reset_by_a_mask() -> None:
    env = gym.make_vec("TwinTac/HoldForce-v0", num_envs=3, autoreset_mode="Disabled")
    env.reset(seed=1)
    before = env.step(np.ones((3, 1), np.float32))[0]
    after, infos = env.reset(options={"reset_mask": np.array([False, True, False])})
    assert np.array_equal(before[[0, 2]], after[[0, 2]]) and not np.array_equal(before[1], after[1])
    assert infos["_wanted_n"].tolist() == [False, True, False]


def test_wrong_input_is_an_error() -> None:
    with pytest.raises(twintac.Error, match="there is no task `Juggle`"):
        twintac.Tasks("Juggle", 1)
    tasks = twintac.Tasks("HoldForce", 2)
    with pytest.raises(twintac.Error, match=r"`actions` has the shape \[2, 3\], expected \[2, 1\]"):
        tasks.step(np.zeros((2, 3)))
    with pytest.raises(twintac.Error, match="not finite"):
        tasks.step(np.array([[0.0], [np.nan]]))
    with pytest.raises(twintac.Error, match="`autoreset` is `Later`"):
        twintac.Tasks("HoldForce", 2, autoreset="Later")  # type: ignore[arg-type]


def test_what_is_missing_is_said() -> None:
    script = """
import sys
sys.modules["gymnasium"] = None
import importlib.util
importlib.util.find_spec = lambda name, package=None: None
import twintac.gymnasium
"""
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, encoding="utf-8", check=False)
    assert ran.returncode == 1
    assert "twintac.gymnasium needs the package gymnasium: pip install gymnasium" in ran.stderr


@pytest.mark.parametrize("kind", KINDS)
def test_a_script_is_better_than_chance(kind: str) -> None:
    def mean(policy: Any) -> float:
        tasks = twintac.Tasks(kind, 32, autoreset="Disabled")
        tasks.seed(list(range(100, 132)))
        return float(returns(policy, tasks).mean())

    assert mean(scripted_policy(kind)) > mean(random_policy(kind)) + 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_a_picture_shows_the_contact(kind: str) -> None:
    env = gym.make(f"TwinTac/{kind}-v0", render_mode="rgb_array")
    env.reset(seed=1)
    before: Any = env.render()
    for _ in range(3):
        env.step(np.full(env.action_space.shape or (), 0.5, np.float32))
    after: Any = env.render()
    assert before.shape == (240, 600, 3) and before.dtype == np.uint8
    assert not np.array_equal(before, after)


@pytest.mark.skipif(importlib.util.find_spec("stable_baselines3") is None, reason="stable-baselines3 is not installed")
def test_stable_baselines_finds_nothing_wrong_and_learns() -> None:
    from stable_baselines3 import PPO  # type: ignore[import-not-found, unused-ignore]
    from stable_baselines3.common import env_checker  # type: ignore[import-not-found, unused-ignore]

    from twintac.gymnasium.sb3 import TouchVecEnv

    for kind in KINDS:
        env_checker.check_env(gym.make(f"TwinTac/{kind}-v0").unwrapped)
    env = TouchVecEnv("ExploreShape", 4, seed=1)
    model = PPO("MlpPolicy", env, n_steps=10, batch_size=20, n_epochs=1, device="cpu", seed=1)
    model.learn(80)
    assert model.num_timesteps >= 80


def test_the_usual_variation_is_that_of_the_tasks() -> None:
    def first(variation: twintac.SensorVariation | None) -> Any:
        tasks = twintac.Tasks("ExploreShape", 20, variation=variation)
        tasks.reset()
        return tasks.step(np.zeros((20, 8), np.float32))[0]

    assert np.array_equal(first(twintac.SensorVariation.usual()), first(None))
    assert not np.array_equal(first(twintac.SensorVariation()), first(None))
