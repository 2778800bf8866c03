"""Tests of InHandTurn: a hand that turns an object by touch."""

import importlib.util
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
from twintac import Error, FastGel, Imperfection
from twintac.gymnasium._hand import Thing, draw_thing, hand
from twintac.gymnasium._in_hand import N_STEPS, InHandTurn
from twintac.gymnasium.policies import random_policy, scripted_policy

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


@pytest.mark.parametrize("touch", ["taxels", "forces", "none"])
def test_gymnasium_finds_nothing_wrong(touch: str) -> None:
    env = gym.make("TwinTac/InHandTurn-v0", touch=touch)
    n_measured = {"taxels": 32, "forces": 4, "none": 0}[touch]
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
    figures, dropped = played(InHandTurn(48, imperfection=Imperfection(), autoreset="Disabled"), FIRST_SEED)
    error_deg, is_box = np.degrees(figures[:, 0]), figures[:, 4] > 0
    assert not dropped.any()
    assert 12 < is_box.sum() < 36
    assert np.mean(error_deg[~is_box] < 5.0) > 0.8
    assert np.mean(error_deg[is_box] < 5.0) < 0.5


def test_an_open_hand_measures_nothing_and_a_closed_one_its_grip() -> None:
    tasks = InHandTurn(2, imperfection=Imperfection(), autoreset="Disabled")
    tasks.seed([1, 2])
    tasks.reset()
    open_hand = np.tile([0.0, -1.0], 4)
    for _ in range(8):
        observed, *_ = tasks.step(np.stack([open_hand, np.tile([0.0, 1.0], 4)]))
    newest = observed[:, :32]
    assert np.all(newest[0] == 0.0)
    # Each fingertip presses, and its taxels measure some kPa.
    assert np.all(newest[1].reshape(4, 8).max(axis=1) > 0.2)


def test_a_step_moves_a_target_by_less_than_half_of_its_range() -> None:
    tasks = InHandTurn(1, autoreset="Disabled")
    tasks.reset()
    observed, *_ = tasks.step(np.ones((1, 8)))
    targets = observed[0, 32 + 8 : 32 + 16]
    middle_rad = 0.125  # of `close`, which begins at 0
    assert np.allclose(targets[0::2], 0.8) and np.allclose(targets[1::2], -middle_rad / 0.225 + 0.8, atol=1e-6)


def test_an_object_that_falls_ends_the_episode() -> None:
    tasks = InHandTurn(4, autoreset="Disabled")
    tasks.reset()
    act = random_policy("InHandTurn")
    ended = np.zeros(4, np.bool_)
    for _ in range(N_STEPS):
        observed, rewards, terminated, truncated, figures, _ = tasks.step(act(np.zeros((4, tasks.n_observed), np.float32)))
        assert np.all(rewards[terminated] == -2.0) and np.all(figures[terminated, 3] == 1.0)
        assert np.all(rewards[ended] == 0.0)
        ended |= terminated
    assert ended.any() and not np.any(truncated & ended)


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
    with pytest.raises(Error, match="`touch` is `smell`, expected one of taxels, forces, none"):
        gym.make("TwinTac/InHandTurn-v0", touch="smell")
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
    assert env.reset().shape == (3, 82)
    observed, rewards, ended, infos = env.step(np.zeros((3, 8), np.float32))
    assert observed.shape == (3, 82) and rewards.shape == ended.shape == (3,) and len(infos) == 3


def test_without_mujoco_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "twintac.gymnasium._in_hand")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(ImportError, match="InHandTurn needs MuJoCo 4 or later"):
        gym.make("TwinTac/InHandTurn-v0")
