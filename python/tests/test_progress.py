"""Tests of the display of progress."""

import sys

import pytest

from twintac import _progress


def test_nobody_follows_where_nobody_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _progress.listener(None) is None  # standard error is captured
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    assert _progress.listener(None) is not None
    assert _progress.listener(False) is None
    assert _progress.listener(print) is print


@pytest.mark.parametrize("has_tqdm", [True, False])
def test_a_person_sees_how_far_each_work_is(
    has_tqdm: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if not has_tqdm:
        monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    listener = _progress.listener(None)
    assert listener is not None
    for work in ("simulating", "training"):
        for done in range(4):
            listener(work, done, 3, "loss 2 %")
    seen = capsys.readouterr().err
    for word in ("simulating", "training", "3/3", "loss 2 %"):
        assert word in seen
