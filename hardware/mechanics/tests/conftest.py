"""Fixtures that all tests use: the import path of the modules, and the mechanics of two variants,
made once.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
MECHANICS = HERE.parent
sys.path.insert(0, str(MECHANICS))

from checks import files  # noqa: E402


def run(program: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Runs one of the programs."""
    command = [sys.executable, MECHANICS / program, *arguments]
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)


def _made(variant: str, folder: Path) -> Path:
    ran = run("make.py", HERE / f"{variant}.geometry.json", "--out", folder)
    assert ran.returncode == 0, ran.stderr
    return folder


@pytest.fixture(scope="session")
def block_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that make.py makes for a block of gel."""
    return _made("phystac-ms5837", tmp_path_factory.mktemp("block"))


@pytest.fixture(scope="session")
def block(block_folder: Path) -> files.Made:
    """The same folder, read."""
    return files.read(block_folder)


@pytest.fixture(scope="session")
def dome(tmp_path_factory: pytest.TempPathFactory) -> files.Made:
    """The folder that make.py makes for a dome of gel, read."""
    return files.read(_made("fingertip", tmp_path_factory.mktemp("dome")))
