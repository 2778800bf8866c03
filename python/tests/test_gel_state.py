"""Tests of gels that are pressed frame by frame, along paths, and by twins."""

import json
import time
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest
from conftest import ROOT, run_command

from twintac import Error, Gel, GelState, Pose, Press, PressPath, Sensor, Twin

COARSE = {"edges_per_height": 4.0, "edges_per_contact_radius": 4.0, "max_path_nodes": 1500}

PATH = """
summary = "Down, aside, and up"
indenter = "sphere-25"
zero = "touch"
rate_hz = 5.0
poses = [
  { time_s = 0.0, position_mm = [-1.0, 0.0, 0.5] },
  { time_s = 1.0, position_mm = [-1.0, 0.0, -0.8] },
  { time_s = 2.0, position_mm = [1.0, 0.0, -0.8], turn_rad = [0.0, 0.1, 0.0] },
]
points = [{ name = "middle", position_mm = [0.0, 0.0, 2.0], radius_mm = 1.0 }]
"""


@pytest.fixture(scope="module")
def gel() -> Gel:
    return Gel(Sensor.phystac(), COARSE)


@pytest.fixture(scope="module")
def touch(gel: Gel) -> Pose:
    return gel.touch("sphere-25", Pose((-1.0, 0.0, 0.0)))


def moved(touch: Pose, x_mm: float, depth_mm: float) -> Pose:
    x, y, z = touch.position_mm
    return Pose((x + x_mm, y, z - depth_mm))


def pressed(gel: Gel, touch: Pose) -> GelState:
    return gel.state("sphere-25", [moved(touch, 0.0, 1.0), moved(touch, 2.0, 1.0)])


def test_a_ball_touches_where_its_lowest_point_meets_the_top(touch: Pose) -> None:
    assert touch.position_mm == pytest.approx((-1.0, 0.0, 8.5), abs=1e-6)


def test_a_force_that_the_sensor_does_not_stand_is_refused_at_once(gel: Gel, touch: Pose) -> None:
    state = pressed(gel, touch)
    started = time.monotonic()
    with pytest.raises(Error, match="1000 N, the sensor withstands 212 N") as caught:
        state.step(0.1, moved(touch, 0.0, 0.0), force_n=1000.0)
    assert caught.value.field == "force_n"
    poses = [[*moved(touch, 0.0, depth_mm).position_mm] for depth_mm in (-0.1, 0.1)]
    with pytest.raises(Error, match="withstands 212 N"):
        gel.follow(PressPath("sphere-25", [0.0, 1.0], poses, force_n=[np.nan, 1000.0]), progress=False)
    assert time.monotonic() - started < 2.0
    state.step(0.1, moved(touch, 0.0, 0.1), force_n=1.0)
    assert state.force_n[2] == pytest.approx(-1.0, rel=0.01)


def test_a_gel_pushes_back_where_it_is_pressed(gel: Gel, touch: Pose) -> None:
    state = pressed(gel, touch)
    assert state.gel_from_indenter is None and state.depth_mm is None
    assert state.force_n.tolist() == [0.0, 0.0, 0.0]
    assert state.step(0.1, moved(touch, 0.0, -0.5)) == pytest.approx(np.zeros(8), abs=1e-6)
    for depth_mm in (0.3, 0.6, 0.9):
        before_n = state.force_n[2]
        readings_kpa = state.step(0.1, moved(touch, 0.0, depth_mm))
        assert state.force_n[2] < before_n and readings_kpa.max() > 0.0
    assert readings_kpa.shape == (8,) and state.depth_mm == pytest.approx(0.9)
    assert abs(state.force_n[0]) < 0.05 * -state.force_n[2]
    assert state.provenance == "simulated"
    x_mm = Sensor.phystac().taxel_positions_mm[:, 0]
    slid_kpa = state.step(0.1, moved(touch, 2.0, 0.9))
    assert slid_kpa @ x_mm / slid_kpa.sum() > readings_kpa @ x_mm / readings_kpa.sum() + 1.0
    assert state.gel_from_indenter == moved(touch, 2.0, 0.9)


def test_friction_resists_what_slides(touch: Pose) -> None:
    state = pressed(Gel(Sensor.phystac(), {**COARSE, "solver": {"friction": 0.5}}), touch)
    state.step(0.1, moved(touch, 0.0, 0.9))
    state.step(0.1, moved(touch, 2.0, 0.9))
    force_n, torque_n_mm = state.force_n, state.torque_n_mm
    assert 0.2 < force_n[0] / -force_n[2] < 0.55  # Coulomb's limit
    # The force acts where the ball touches, at its origin: the lever arm is far smaller than the
    # radius.
    assert torque_n_mm.shape == (3,) and np.linalg.norm(torque_n_mm) < 3.0 * np.linalg.norm(force_n)


def test_a_gel_that_rested_answers_as_at_first(gel: Gel, touch: Pose) -> None:
    state = pressed(gel, touch)
    first = state.step(0.1, moved(touch, 0.0, 0.8))
    state.step(0.1, moved(touch, 2.0, 1.0))
    state.rest()
    assert state.gel_from_indenter is None
    assert np.array_equal(state.step(0.1, moved(touch, 0.0, 0.8)), first)


def test_a_force_is_met(gel: Gel, touch: Pose) -> None:
    state = pressed(gel, touch)
    state.step(0.1, moved(touch, 0.0, 0.5), force_n=2.0)
    assert -state.force_n[2] == pytest.approx(2.0, rel=0.02)
    assert state.depth_mm is not None and state.depth_mm > 0.0


def test_a_press_that_cannot_be_leaves_the_gel_as_it_was(gel: Gel, touch: Pose) -> None:
    state = pressed(gel, touch)
    state.step(0.1, moved(touch, 0.0, 0.5))
    before = (state.gel_from_indenter, state.force_n.tolist())
    with pytest.raises(Error, match="mm deep"):
        state.step(0.1, moved(touch, 0.0, 9.0))
    assert (state.gel_from_indenter, state.force_n.tolist()) == before
    for wrong in ({"since_previous_s": -1.0}, {"since_previous_s": 0.1, "force_n": 0.0}):
        with pytest.raises(Error) as caught:
            state.step(gel_from_indenter=touch, **wrong)
        assert caught.value.field in wrong
    with pytest.raises(Error, match="there is no indenter `spoon`"):
        gel.state("spoon", [touch])
    with pytest.raises(Error, match="does not touch the gel"):
        gel.touch("sphere-25", Pose((100.0, 0.0, 0.0)))
    with pytest.raises(Error, match="at least one"):
        gel.state("sphere-25", [])


def test_a_path_is_that_of_the_command(gel: Gel, tmp_path: Path) -> None:
    (tmp_path / "path.toml").write_text(PATH, encoding="utf-8")
    settings = "\n".join(["[simulate]", *(f"{name} = {value}" for name, value in COARSE.items())])
    (tmp_path / "settings.toml").write_text(settings, encoding="utf-8")
    files = ["--path", tmp_path / "path.toml", "--settings", tmp_path / "settings.toml"]
    said = run_command("simulate", "--sensor", ROOT / "sensors/phystac.toml", *files, "--json")
    assert said.returncode == 0, said.stderr
    frames = json.loads(said.stdout)["frames"]
    followed = gel.follow(PressPath.load(tmp_path / "path.toml"))
    assert followed.failure is None and len(followed) == len(frames) == 11
    assert followed.time_s.tolist() == [frame["time_s"] for frame in frames]
    assert followed.depth_mm.tolist() == [frame["depth_mm"] for frame in frames]
    assert followed.position_mm.tolist() == [frame["position_mm"] for frame in frames]
    assert followed.force_n.tolist() == [frame["force_n"] for frame in frames]
    assert followed.torque_n_mm.tolist() == [frame["torque_n_mm"] for frame in frames]
    taxels = [f"t{number}" for number in range(8)]
    assert followed.readings_kpa.tolist() == [[frame["pressure_kpa"][name] for name in taxels] for frame in frames]
    assert followed.points_kpa.keys() == {"middle"}
    assert followed.points_kpa["middle"].tolist() == [frame["pressure_kpa"]["middle"] for frame in frames]
    assert followed.provenance == "simulated"


def path(**changed: object) -> PressPath:
    poses: npt.ArrayLike = [[-1.0, 0.0, 0.5], [-1.0, 0.0, -0.8]]
    arguments = {"indenter": "sphere-25", "time_s": [0.0, 1.0], "gel_from_indenter": poses, "zero": "touch"}
    return PressPath(**{**arguments, **changed})  # type: ignore[arg-type]


def test_a_path_of_arrays_is_that_of_a_file(gel: Gel, tmp_path: Path) -> None:
    turned = [-0.0, float(np.sin(0.05)), 0.0, float(np.cos(0.05))]
    upright = [0.0, 0.0, 0.0, 1.0]
    poses = [[-1.0, 0.0, 0.5, *upright], [-1.0, 0.0, -0.8, *upright], [1.0, 0.0, -0.8, *turned]]
    own = path(time_s=[0.0, 1.0, 2.0], gel_from_indenter=poses, rate_hz=5.0)
    (tmp_path / "path.toml").write_text(PATH, encoding="utf-8")
    of_file = PressPath.load(tmp_path / "path.toml")
    assert own.time_s.tolist() == of_file.time_s.tolist() and own.indenter == "sphere-25"
    followed, expected = gel.follow(own), gel.follow(of_file)
    assert followed.readings_kpa == pytest.approx(expected.readings_kpa, abs=1e-9)


def test_a_path_asks_for_forces(gel: Gel) -> None:
    followed = gel.follow(path(force_n=[np.nan, 1.5]))
    assert -followed.force_n[-1, 2] == pytest.approx(1.5, rel=0.02)


def test_a_path_that_ends_early_says_why(gel: Gel) -> None:
    followed = gel.follow(path(gel_from_indenter=[[-1.0, 0.0, 0.5], [-1.0, 0.0, -9.0]]))
    assert len(followed) == 1 and followed.failure is not None and "at 1 s" in followed.failure


@pytest.mark.parametrize(
    ("field", "wrong"),
    [
        ("poses[1].time_s", {"time_s": [0.0, 0.0]}),
        ("poses[1]", {"time_s": [0.0, float("nan")]}),
        ("time_s", {"time_s": [0.0]}),
        ("gel_from_indenter", {"gel_from_indenter": np.zeros((2, 4))}),
        ("poses", {"gel_from_indenter": np.zeros((0, 3)), "time_s": []}),
        ("zero", {"zero": "sea"}),
        ("rate_hz", {"rate_hz": 0.0}),
        ("rate_hz", {"rate_hz": float("nan")}),
        ("poses[1].force_n", {"force_n": [1.0, -1.0]}),
        ("force_n", {"force_n": [1.0]}),
    ],
)
def test_a_wrong_path_is_named(field: str, wrong: dict[str, object]) -> None:
    with pytest.raises(Error) as caught:
        path(**wrong)
    assert caught.value.field == field


def test_a_wrong_file_of_a_path_has_its_line(tmp_path: Path) -> None:
    (tmp_path / "path.toml").write_text(PATH.replace("rate_hz = 5.0", "rate_hz = -5.0"), encoding="utf-8")
    with pytest.raises(Error) as caught:
        PressPath.load(tmp_path / "path.toml")
    assert (caught.value.line, caught.value.field) == (5, "rate_hz")


def test_a_twin_along_a_path_reads_as_the_command_says(trained: Path, tmp_path: Path) -> None:
    (tmp_path / "path.toml").write_text(PATH, encoding="utf-8")
    said = run_command("predict", "--model", trained / "model", "--path", tmp_path / "path.toml", "--json")
    expected = json.loads(said.stdout)["presses"][0]
    steps: list[tuple[str, int, int, str]] = []
    twin = Twin.load(trained / "model")
    along = PressPath.load(tmp_path / "path.toml")
    predicted = twin.predict_along(along, progress=lambda *step: steps.append(step))
    for name in ("time_s", "place_mm", "depth_mm", "force_n", "readings_kpa"):
        assert getattr(predicted, name).tolist() == expected[name], name
    assert predicted.failure is None and predicted.provenance == "simulated"
    assert steps[-1][:3] == ("simulating", 11, 11)
    assert twin.predict(Press("sphere-25", depth_mm=0.5)).failure is None


def test_a_frame_with_a_deadline_says_whether_it_has_settled(gel: Gel) -> None:
    touch = gel.touch("sphere-25", Pose((-4.0, 4.0, 0.0)))
    poses = [moved(touch, 0.0, 1.0), moved(touch, 2.0, 1.0)]
    state = gel.state("sphere-25", poses, deadline_ms=60_000)
    assert state.converged is None and state.residual is None and state.behind_mm is None
    waited = gel.state("sphere-25", poses)
    assert np.array_equal(state.step(0.02, poses[0]), waited.step(0.02, poses[0]))
    assert state.converged is True and state.behind_mm == 0.0
    assert state.residual is not None and 0.0 <= state.residual < 1e-3
    hurried = gel.state("sphere-25", poses, deadline_ms=1)
    hurried.step(0.02, poses[0])
    hurried.step(0.02, poses[1])
    assert hurried.converged is False
    for wrong in (0.0, -1.0, float("nan"), 1e9):
        with pytest.raises(Error, match="deadline_ms"):
            gel.state("sphere-25", poses, deadline_ms=wrong)
