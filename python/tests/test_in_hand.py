"""Tests of InHandTurn: a hand that turns an object by touch."""

import importlib.util
import re
import sys
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt
import pytest
from gymnasium.utils.env_checker import check_env

pytest.importorskip("mujoco.batch", reason="MuJoCo 4 or later is not installed")

import mujoco

import twintac.gymnasium  # registers the tasks
from twintac import Error, FastGel, SensorVariation
from twintac.gymnasium._hand import PALM_RADIUS_M, Thing, draw_thing, hand
from twintac.gymnasium._in_hand import N_STEPS, InHandTurn
from twintac.gymnasium.policies import scripted_policy, seeing_policy

FIRST_SEED = 10**9


def played(tasks: InHandTurn, seed: int, n_steps: int = N_STEPS) -> tuple[npt.NDArray[Any], npt.NDArray[np.bool_]]:
    """The figures at the end under the scripted baseline, and which objects were dropped."""
    tasks.seed([seed + number for number in range(len(tasks))])
    act = scripted_policy("InHandTurn")
    observed, figures = tasks.reset()
    dropped = np.zeros(len(tasks), np.bool_)
    for _ in range(n_steps):
        observed, _, terminated, _, figures, _ = tasks.step(act(observed))
        dropped |= terminated
    return figures, dropped


@pytest.mark.parametrize("touch", ["taxels", "forces", "none", "truth", "truth+forces"])
def test_gymnasium_finds_nothing_wrong(touch: str) -> None:
    env = gym.make("TwinTac/InHandTurn-v0", touch=touch)
    n_measured = {"taxels": 32, "forces": 4, "none": 0, "truth": 5, "truth+forces": 9}[touch]
    assert env.observation_space.shape == (4 * (n_measured + 16) + 2,) and env.action_space.shape == (8,)
    check_env(env.unwrapped, skip_render_check=True)


def test_one_of_many_is_as_alone_also_in_later_episodes() -> None:
    many = gym.make_vec("TwinTac/InHandTurn-v0", num_envs=5, autoreset_mode="SameStep", n_threads=2)
    alone = gym.make("TwinTac/InHandTurn-v0")
    many.action_space.seed(1)
    observations, _ = many.reset(seed=7)
    observed, _ = alone.reset(seed=7 + 3)
    assert np.array_equal(observations[3], observed)
    n_episodes = 0
    for _ in range(2 * N_STEPS):
        actions = many.action_space.sample()
        observations, rewards, terminated, truncated, infos = many.step(actions)
        observed, reward, is_over, is_late, info = alone.step(actions[3])
        assert (rewards[3], terminated[3], truncated[3]) == (reward, is_over, is_late)
        if is_over or is_late:
            assert np.array_equal(infos["final_obs"][3], observed)
            observed, _ = alone.reset()
            n_episodes += 1
        else:
            assert all(infos[name][3] == value for name, value in info.items())
        assert np.array_equal(observations[3], observed)
    assert n_episodes >= 2


def test_the_script_turns_cylinders_and_knows_nothing_of_boxes() -> None:
    figures, dropped = played(InHandTurn(48, variation=SensorVariation(), autoreset="Disabled"), FIRST_SEED)
    error_deg, is_box = np.degrees(figures[:, 0]), figures[:, 4] > 0
    assert not dropped.any()
    assert 12 < is_box.sum() < 36
    assert np.mean(error_deg[~is_box] < 5.0) > 0.8
    assert np.mean(error_deg[is_box] < 5.0) < 0.5


def test_an_open_hand_measures_nothing_and_a_closed_one_its_grip() -> None:
    tasks = InHandTurn(2, variation=SensorVariation(), autoreset="Disabled")
    tasks.seed([1, 2])
    tasks.reset()
    open_hand = np.tile([0.0, -1.0], 4)
    for _ in range(8):
        observed, *_ = tasks.step(np.stack([open_hand, np.tile([0.0, 1.0], 4)]))
    newest = observed[:, :32]
    assert np.all(newest[0] == 0.0)
    # Each fingertip presses, and its taxels measure some kPa.
    assert np.all(newest[1].reshape(4, 8).max(axis=1) > 0.2)


def test_an_action_of_one_moves_a_target_by_a_tenth_of_its_range() -> None:
    tasks = InHandTurn(1, autoreset="Disabled")
    tasks.reset()
    for step in range(1, 12):
        observed, *_ = tasks.step(np.ones((1, 8)))
        targets = observed[0, 32 + 8 : 32 + 16]
        middle_rad = 0.125  # of `close`, which begins at 0
        assert np.allclose(targets[0::2], min(0.2 * step, 1.0), atol=1e-6)
        assert np.allclose(targets[1::2], min(-middle_rad / 0.225 + 0.2 * step, 1.0), atol=1e-6)


def test_the_truth_is_the_angle_that_is_left_and_how_the_object_lies() -> None:
    tasks = InHandTurn(16, touch="truth+forces", autoreset="Disabled")
    tasks.seed(range(16))
    _, begun = tasks.reset()
    observed, _, _, _, figures, _ = tasks.step(np.zeros((16, 8)))
    truth = observed[:, :5]
    assert np.allclose(truth[:, 0] * np.pi / 2.0, figures[:, 2] - figures[:, 1], atol=1e-5)
    is_box = figures[:, 4] > 0
    assert np.allclose(np.hypot(truth[:, 1], truth[:, 2]), is_box, atol=1e-5)
    assert np.all(truth[:, 3:] > 12.0 / 26.0 - 1e-6) and np.all(truth[:, 3:] < 19.0 / 26.0 + 1e-6)
    assert np.all(truth[~is_box, 3] == truth[~is_box, 4]) and np.array_equal(begun[:, 2], figures[:, 2])


def test_who_sees_the_object_turns_most_of_them() -> None:
    tasks = InHandTurn(32, touch="truth", autoreset="Disabled")
    tasks.seed([FIRST_SEED + number for number in range(32)])
    act = seeing_policy()
    observed, _ = tasks.reset()
    for _ in range(N_STEPS):
        observed, _, _, _, figures, _ = tasks.step(act(observed))
    assert np.mean((np.degrees(figures[:, 0]) < 5.0) & (figures[:, 3] == 0.0)) > 0.85


def test_an_object_that_falls_ends_the_episode() -> None:
    tasks = InHandTurn(3, autoreset="Disabled")
    tasks.reset()
    still = np.zeros((3, 8))
    tasks.step(still)
    position_m, quaternion = tasks._batch.bind("qpos")[:, -7:-4], tasks._batch.bind("qpos")[:, -4:]
    position_m[0, 0] = PALM_RADIUS_M + 0.002
    quaternion[1] = np.cos(np.radians(22.5)), np.sin(np.radians(22.5)), 0.0, 0.0  # tilted by 45 degrees
    _, rewards, terminated, truncated, figures, _ = tasks.step(still)
    assert terminated.tolist() == [True, True, False] and not truncated.any()
    assert rewards[:2].tolist() == [-2.0, -2.0] and figures[:, 3].tolist() == [1.0, 1.0, 0.0]
    _, rewards, terminated, truncated, _, _ = tasks.step(still)
    assert rewards[:2].tolist() == [0.0, 0.0] and not terminated.any()


@pytest.mark.parametrize("is_box", [True, False])
def test_an_object_is_as_mujoco_would_compile_it(is_box: bool) -> None:
    random = np.random.default_rng(5)
    thing = next(thing for thing in iter(lambda: draw_thing(random), None) if thing.is_box == is_box)
    kind, size = ("box", thing.half_m) if is_box else ("cylinder", thing.half_m[:2])
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><worldbody><body><freejoint/><geom type="{kind}" size="{" ".join(map(str, size))}" mass="{thing.mass_kg}"/></body></worldbody></mujoco>'
    )
    assert np.allclose(model.body_inertia[1], thing.inertia_kg_m2, rtol=1e-6)
    assert np.allclose(model.geom_aabb[0, 3:], thing.around_m)
    assert model.geom_rbound[0] == pytest.approx(float(np.linalg.norm(thing.half_m)))
    assert isinstance(thing, Thing) and hand().nu == 8


def test_wrong_input_is_an_error() -> None:
    for touch in ("smell", "", "taxels+none", "taxels+taxels", "taxels, forces"):
        with pytest.raises(Error, match=f"`touch` is `{re.escape(touch)}`, expected none, or some of truth, taxels, forces with \\+ between"):
            gym.make("TwinTac/InHandTurn-v0", touch=touch)
    with pytest.raises(Error, match="`touch` is for InHandTurn, not for HoldForce"):
        gym.make("TwinTac/HoldForce-v0", touch="none")
    with pytest.raises(Error, match="`gel` is of `phystac`, the fingertips need one of `phystac-tip`"):
        InHandTurn(1, gel=FastGel.phystac())
    with pytest.raises(Error, match="`n_environments` is 0, expected 1 to"):
        InHandTurn(0)
    tasks = InHandTurn(2)
    with pytest.raises(Error, match=r"`actions` has the shape \[1, 8\], expected \[2, 8\]"):
        tasks.step(np.zeros((1, 8)))
    with pytest.raises(Error, match="not finite"):
        tasks.step(np.full((2, 8), np.nan))
    with pytest.raises(Error, match="`seeds` has 1 seeds, expected one for each of 2"):
        tasks.seed([1])
    with pytest.raises(Error, match="`seeds` has -1, expected 0 to"):
        tasks.seed([1, -1])


@pytest.mark.skipif(importlib.util.find_spec("stable_baselines3") is None, reason="Stable-Baselines3 is not installed")
def test_stable_baselines_gets_the_same_environments() -> None:
    from twintac.gymnasium.sb3 import TouchVecEnv

    env = TouchVecEnv("InHandTurn", 3, touch="forces", seed=4)
    assert np.asarray(env.reset()).shape == (3, 82)
    observed, rewards, ended, infos = env.step(np.zeros((3, 8), np.float32))
    assert np.asarray(observed).shape == (3, 82) and rewards.shape == ended.shape == (3,) and len(infos) == 3


def test_without_mujoco_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "twintac.gymnasium._in_hand")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ImportError, match="InHandTurn needs MuJoCo 4 or later"):
        gym.make("TwinTac/InHandTurn-v0")
