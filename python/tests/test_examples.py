"""Tests that run every example."""

import json
from pathlib import Path

import pytest
from conftest import ROOT, run_example

EXAMPLES = sorted(path.name for path in (ROOT / "python/examples").glob("*.py"))


@pytest.mark.parametrize("name", [name for name in EXAMPLES if name not in ("gallery.py", "grasp_by_touch.py", "press_a_ball.py", "train_from_csv.py")])
def test_example_prints(name: str, tmp_path: Path) -> None:
    if "mjx" in name:
        pytest.importorskip("mujoco.mjx", reason="needs `pip install mujoco-mjx`")
    last = run_example(name, tmp_path).splitlines()[-1]
    assert "emulated" in last or "simulated" in last


def test_a_ball_is_read_and_drawn(tmp_path: Path) -> None:
    lines = run_example("press_a_ball.py", tmp_path).splitlines()
    assert len(lines) == 8 and all(line.endswith("kPa, simulated") for line in lines)
    assert (tmp_path / "ball.png").read_bytes().startswith(b"\x89PNG")


def test_the_gallery_is_drawn_from_the_examples(tmp_path: Path) -> None:
    run_example("gallery.py", tmp_path, "pictures", "find_a_contact", "imperfect_sensors")
    pictures = sorted((tmp_path / "pictures").iterdir())
    assert [picture.stem for picture in pictures] == ["find_a_contact", "imperfect_sensors"]
    assert all(picture.read_bytes().startswith(b"\x89PNG") for picture in pictures)


def test_training_makes_a_model_and_a_report(trained: Path) -> None:
    assert (trained / "report.html").is_file()
    assert (trained / "model").is_dir()


def test_objects_are_lifted_by_touch(tmp_path: Path) -> None:
    pytest.importorskip("mujoco", reason="MuJoCo 4 needs Python 3.11 or later")
    printed = run_example("grasp_by_touch.py", tmp_path, "--objects", "2", "--seed", "3", "--json")
    grasps = json.loads(printed)["grasps"]
    assert [grasp["kind"] for grasp in grasps] == ["box", "ball"]
    for grasp in grasps:
        assert grasp["lifted"] and grasp["needed_n"] < grasp["held_n"] < 2.0 * grasp["needed_n"]
