"""Tests of the example that estimates the force on a sensor with dead taxels."""

import importlib
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="PyTorch is not installed")

FOLDER = Path(__file__).parents[1] / "examples/rl"


@pytest.fixture
def example(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The example, with few episodes and fits."""
    monkeypatch.setattr(sys, "path", [str(FOLDER), *sys.path])
    module = importlib.import_module("estimate_force")
    for name, few in {"N_ENVS": 3, "N_ROUNDS": 2, "N_FITS": 2, "N_LAST_FITS": 2, "N_TOGETHER": 2}.items():
        monkeypatch.setattr(module, name, few)
    return module


def test_the_same_seed_trains_the_same_network(example: ModuleType, tmp_path: Path) -> None:
    for folder in ("one", "other"):
        example.train("varied", 3, tmp_path / folder)
    one, other = (example.trained(tmp_path / folder / "varied-3.pt").state_dict() for folder in ("one", "other"))
    assert all(torch.equal(one[name], other[name]) for name in one)
    assert [path.name for path in (tmp_path / "one").iterdir()] == ["varied-3.pt"]


def test_a_dead_taxel_is_known_and_its_readings_are_not(example: ModuleType) -> None:
    observed = np.random.default_rng(1).uniform(0.1, 1.0, (2, 19)).astype(np.float32)
    is_dead = np.zeros((2, 8), np.float32)
    is_dead[1, 3] = 1.0
    known = example.knowing(observed, is_dead)
    assert np.array_equal(known[0], np.concatenate([observed[0], np.zeros(8)]))
    assert np.flatnonzero(known[1, :19] != observed[1]).tolist() == [3, 11]
    assert known[1, [3, 11]].tolist() == [0.0, 0.0] and known[1, 19:].tolist() == is_dead[1].tolist()


def test_true_values_hold_the_force(example: ModuleType, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the true force and its growth, only the time that the robot needs is lost."""
    monkeypatch.setattr(example, "N_ENVS", 64)
    monkeypatch.setattr(example, "DISTURBANCE", 0.0)
    error_n = example.play(None, "perfect", 5, np.random.default_rng(1))["error"].numpy()
    assert error_n.shape == (64, 220)
    after_a_change = (np.arange(220) % 55) < 40
    assert error_n[:, ~after_a_change].mean() < 0.01 < 0.1 < error_n[:, after_a_change].mean()
