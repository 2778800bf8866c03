"""Functions and fixtures that several tests use."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DATA = ROOT / "crates/app/twintac/examples/data"


def run_example(name: str, folder: Path, *arguments: str) -> str:
    """Runs an example in a folder. Returns its standard output."""
    example = ROOT / "python/examples" / name
    ran = subprocess.run([sys.executable, example, *arguments], cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    assert ran.returncode == 0, ran.stderr
    return ran.stdout


def run_command(*arguments: object) -> "subprocess.CompletedProcess[str]":
    """Runs the command that the package installs."""
    command = Path(sysconfig.get_path("scripts")) / ("twintac.exe" if os.name == "nt" else "twintac")
    words = [str(command), *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, encoding="utf-8", check=False)


@pytest.fixture(scope="session")
def trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished run: that of the example that trains a twin."""
    folder = tmp_path_factory.mktemp("trained")
    run_example("train_from_csv.py", folder)
    return folder / "runs/from-csv"
