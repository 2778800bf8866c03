"""Fixtures that several tests use."""

import importlib.util
from collections.abc import Iterator
from pathlib import Path

import pytest
from board import Board

if importlib.util.find_spec("lerobot") is None:
    pytest.skip("the package lerobot is not installed", allow_module_level=True)


@pytest.fixture
def board(tmp_path: Path) -> Iterator[Board]:
    """An emulated microcontroller that sends frames."""
    with Board(tmp_path) as board:
        yield board
