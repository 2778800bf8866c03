"""Tests that the Python code of README.md runs as it stands."""

import re
from pathlib import Path

import pytest

README = Path(__file__).parents[1] / "README.md"


def test_the_snippet_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    snippets = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    assert len(snippets) == 1
    exec(compile(snippets[0], README, "exec"), {"__name__": "__main__"})
    assert re.fullmatch(r"\(30, 8\) kPa, emulated; off by at most 0\.0\d+ kPa\n", capsys.readouterr().out)
