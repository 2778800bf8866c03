"""Tests that the package's command is the program."""

from pathlib import Path

from conftest import run_command

import twintac


def test_help_and_version_are_told_on_standard_output() -> None:
    for option, word in (("--help", "reproduce"), ("--version", "twintac 0.")):
        ran = run_command(option)
        assert (ran.returncode, ran.stderr) == (0, "")
        assert word in ran.stdout


def test_what_is_wrong_is_told_on_standard_error(tmp_path: Path) -> None:
    for arguments, word in ((["bake"], "bake"), (["report", "--run", tmp_path / "none"], "is not a run")):
        ran = run_command(*arguments)
        assert (ran.returncode, ran.stdout) == (2, "")
        assert word in ran.stderr


def test_runs_know_the_package_as_their_program(trained: Path) -> None:
    """The command keeps the stages of a run that Python has made, because both are one build."""
    twintac.Run.open(trained).finish(progress=False)
    before = {path: path.stat().st_mtime_ns for path in trained.rglob("stage.json")}
    assert run_command("train", "--run", trained).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in trained.rglob("stage.json")} == before


def test_every_name_is_there_with_its_docs() -> None:
    for name in set(twintac.__all__) - {"Progress"}:
        assert getattr(twintac, name).__doc__, name
