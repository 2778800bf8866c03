"""Tests of the example that trains a hand to turn objects."""

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is not installed")
pytest.importorskip("mujoco.batch", reason="MuJoCo 4 or later is not installed")

EXAMPLE = Path(__file__).parents[1] / "examples/rl/in_hand.py"


def loaded() -> ModuleType:
    spec = importlib.util.spec_from_file_location("in_hand", EXAMPLE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def in_hand(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The example, with few episodes and fits."""
    module = loaded()
    for name, few in {"N_ENVS": 2, "N_FITS": 2, "N_LAST_FITS": 2, "N_TOGETHER": 2}.items():
        monkeypatch.setattr(module, name, few)
    return module


def test_a_training_that_was_stopped_continues_to_the_same_policy(in_hand: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    in_hand.train("forces", 3, 2, tmp_path / "whole")
    kept, n_kept = in_hand.kept, 0

    def stops_in_the_second_round(path: Path, write: object) -> None:
        nonlocal n_kept
        n_kept += 1
        if n_kept == 3:
            raise KeyboardInterrupt
        kept(path, write)

    with monkeypatch.context() as stopped, pytest.raises(KeyboardInterrupt):
        stopped.setattr(in_hand, "kept", stops_in_the_second_round)
        in_hand.train("forces", 3, 2, tmp_path / "stopped")
    in_hand.train("forces", 3, 2, tmp_path / "stopped")
    policies = [in_hand.trained(tmp_path / name / "forces-3") for name in ("whole", "stopped")]
    observed = np.random.default_rng(1).uniform(-1.0, 1.0, (5, 4 * (4 + 16) + 2)).astype(np.float32)
    observed[:, -1] = 1.0
    actions = [policy(observed) for policy, _ in policies]
    assert actions[0].shape == (5, 8) and np.array_equal(*actions)
    curves = [[row["near"] for row in rows] for _, rows in policies]
    assert curves[0] == curves[1] and [row["actor"] for row in policies[0][1]] == ["teacher", "student"]


def test_no_training_has_an_episode_of_the_test() -> None:
    example = loaded()
    assert example.first_seed(example.MOST_SEED + 1, 0) <= min(example.TEST_SEEDS)
    assert example.first_seed(3, example.MOST_ROUNDS) <= example.first_seed(4, 0)
    assert example.first_seed(3, 4) + example.N_ENVS <= example.first_seed(3, 5)


def test_what_is_felt_has_no_truth(in_hand: ModuleType) -> None:
    # Four frames of truth (5), force (4) and joints (16), the wanted angle, and what is left.
    frames = np.arange(4 * 25, dtype=np.float32)
    observed = np.concatenate([frames, [0.3, 0.9]]).astype(np.float32)[None]
    assert in_hand.newest(observed, in_hand.N_TRUTH)[0].tolist() == [*frames[5:25], *observed[0, -2:]]


def test_steps_after_a_fall_do_not_count(in_hand: ModuleType) -> None:
    episodes = in_hand.Episodes(None, seed=1)
    for step in range(in_hand.N_STEPS):
        observed = np.zeros((2, 4 * 21 + 2), np.float32)
        # The second object falls in the step with the number 9.
        observed[:, -1] = 1.0 - np.array([step, min(step, 10)]) / in_hand.N_STEPS
        episodes.act(observed)
    weight = episodes.tensors()["weight"]
    assert weight[0].tolist() == [1.0] * 60 and weight[1].tolist() == [1.0] * 11 + [0.0] * 49
