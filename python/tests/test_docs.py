"""Tests that run every block of code in the book and in the READMEs, or check it with the program
that would run it.

The text after the three backquotes of a block defines what is done:

- `sh`: run in bash. `python`: run. Both in the order of the page, in a folder of the page's own
  that has the content of a checkout; Python's names are kept from block to block.
- Any language with `title="NAME.SUFFIX"`: a file of that name, which a later block of the page has
  to name.
- `text`: the expected output of the block before; `...` stands for any text. With a title: a
  drawing, which has no command.
- `toml` with a title that is not the name of a file: settings of a run, which are read.
- `sh` or `python` with any other title, which gives a reason: not run. Programs check the options
  of their commands, mypy checks snippets.
- `rust`: a test of the crate `twintac`, whose documentation includes the page.

Any other block fails. Commands that other tests run are only checked here: `pip install`, with
which `python/check.sh` begins, and `cargo` in README.md, which `cargo xtask readme` runs.
"""

import contextlib
import doctest
import importlib.util
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib.metadata import metadata
from itertools import dropwhile
from pathlib import Path
from typing import Any

import pytest
from conftest import DATA, ROOT, run_command

import twintac

PAGES = [ROOT / "README.md", ROOT / "python/README.md", *sorted(ROOT.joinpath("docs").rglob("*.md"))]
BESIDE = ("crates", "docs", "variations", "imports", "materials", "protocols", "python", "emulators", "rigs", "sensors")
BIN = Path(sys.executable).parent
FILE_NAME = re.compile(r"[\w/-]+\.\w+")


@dataclass
class Block:
    """A fenced block."""

    line: int
    language: str
    title: str
    code: str

    @property
    def is_file(self) -> bool:
        return FILE_NAME.fullmatch(self.title) is not None

    @property
    def is_run(self) -> bool:
        return self.language in ("sh", "python") and not self.title


def blocks(page: str) -> list[Block]:
    """The fenced blocks of a page."""
    found: list[Block] = []
    inside: Block | None = None
    for number, line in enumerate(page.splitlines(), 1):
        if line.lstrip().startswith("```"):
            if inside:
                found.append(inside)
                inside = None
            else:
                head = re.fullmatch(r'```(\w+)(?: title="([^"]+)")?', line)
                assert head, f"line {number}: a block begins with ```LANGUAGE or ```LANGUAGE title=\"...\", unindented"
                inside = Block(number, head[1], head[2] or "", "")
        elif inside:
            inside.code += line + "\n"
    assert not inside, "the last block has no end"
    return found


WITH_BLOCKS = {str(path.relative_to(ROOT)): found for path in PAGES if (found := blocks(path.read_text(encoding="utf-8")))}


def commands(code: str) -> list[list[str]]:
    """The words of each command of a shell block."""
    found: list[list[str]] = []
    for line in code.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
        lexer.whitespace_split = True
        command: list[str] = []
        ends = False
        for word in lexer:
            if word in ("&&", ";", "|"):
                found.append(command)
                command, ends = [], False
            elif word.startswith(">"):
                ends = True
            elif not ends:
                command.append(word)
        found.append(command)
    is_before = re.compile(r"time|[A-Z]+=.*")  # the program comes next
    return [list(dropwhile(is_before.fullmatch, command)) for command in found if command]


def read_command(command: list[str]) -> None:
    """Checks the options of a command with its program."""
    program, *words = command
    said = " ".join(command)
    if program == "twintac":
        ran = run_command(*words, "--help")
        assert ran.returncode == 0, f"`{said}`: {ran.stderr}"
    elif program.endswith("pip"):
        known = set(metadata("twintac").get_all("Provides-Extra") or [])
        for word in words:
            if extras := re.fullmatch(r"(?:\./python|twintac)\[(.+)\]", word):
                assert set(extras[1].split(",")) <= known, said
    elif program in ("python", "python3") and words[0] == "-m":
        assert importlib.util.find_spec(words[1]), said
    elif program in ("python", "python3"):
        script = (ROOT / words[0]).read_text(encoding="utf-8")
        for word in words[1:]:
            assert not word.startswith("--") or f'"{word}"' in script, f"`{said}`: there is no {word}"
    elif program == "cargo":
        assert words[0] in ("doc", "run", "test", "xtask"), said
        if words[0] == "xtask":
            assert all(f'"{word}"' in (ROOT / "xtask/src/main.rs").read_text(encoding="utf-8") for word in words[1:2]), said
    elif program in ("cd", "hq", "sbatch") or program.startswith("python/"):
        files = [word for word in command if word.startswith("python/")]
        assert all((ROOT / file).exists() for file in files), said
    else:
        pytest.fail(f"`{said}`: nothing reads `{program}`")


def read_settings(block: Block, folder: Path) -> None:
    """Checks settings of a run with the program."""
    file = folder / f"settings-{block.line}.toml"
    file.write_text(block.code, encoding="utf-8")
    given = ["--sensor", ROOT / "sensors/phystac.toml", "--import", DATA / "import.toml", "--recordings", DATA / "presses.csv"]
    ran = run_command("import", *given, "--settings", file, "--out", folder / f"settings-{block.line}")
    assert ran.returncode == 0, ran.stderr


class Session:
    """The folder of a page, and its Python names."""

    def __init__(self, page: str) -> None:
        self.page = page
        self.names: dict[str, Any] = {"__name__": "__main__"}

    def run(self, block: Block) -> str:
        """Runs a block. Returns its output."""
        place = f"{self.page}:{block.line}"
        if block.language == "python":
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile("\n" * block.line + block.code, ROOT / self.page, "exec"), self.names)
            return printed.getvalue()
        environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}", "MPLBACKEND": "Agg"}
        command = ["bash", "-euo", "pipefail", "-c", block.code]
        ran = subprocess.run(command, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, encoding="utf-8", check=False)
        assert ran.returncode == 0, f"{place}: {ran.stderr}"
        return ran.stdout


@pytest.fixture(scope="session")
def demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The result of `twintac demo`, which pages use."""
    folder = tmp_path_factory.mktemp("demo")
    ran = subprocess.run([BIN / "twintac", "demo"], cwd=folder, capture_output=True, text=True, encoding="utf-8", check=False)
    assert ran.returncode == 0, ran.stderr
    return folder / "runs/demo"


@pytest.mark.parametrize("page", WITH_BLOCKS)
def test_page(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> None:
    found = WITH_BLOCKS[page]
    if any("import mujoco" in block.code for block in found):
        pytest.importorskip("mujoco", reason="MuJoCo 4 needs Python 3.11 or later")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    for name in BESIDE:
        Path(name).symlink_to(ROOT / name)
    if any("runs/demo" in block.code or "twintac demo" in block.code for block in found):
        shutil.copytree(request.getfixturevalue("demo"), "runs/demo")
    session = Session(page)
    printed: str | None = None
    for index, block in enumerate(found):
        place = f"{page}:{block.line}"
        if block.is_file:
            assert any(block.title in later.code for later in found[index + 1 :]), f"{place}: nothing uses {block.title}"
            Path(block.title).parent.mkdir(parents=True, exist_ok=True)
            Path(block.title).write_text(block.code, encoding="utf-8")
        elif block.language == "rust":
            assert f"/{page}" in (ROOT / "crates/app/twintac/src/lib.rs").read_text(encoding="utf-8"), f"{place}: no crate's documentation includes the page"
        elif block.language == "text" and block.title:
            assert not re.search(r"^\s*(twintac|python3?|pip|cargo) ", block.code, re.MULTILINE), f"{place}: has a command"
        elif block.language == "text":
            assert printed is not None, f"{place}: the block before it prints nothing, or is not run"
            assert doctest.OutputChecker().check_output(block.code, printed, doctest.ELLIPSIS), f"{place}: printed is\n{printed}"
        elif block.language == "toml":
            read_settings(block, tmp_path)
        elif block.language == "sh":
            words = commands(block.code)
            read = [command for command in words if block.title or command[:2] == ["pip", "install"] or (page == "README.md" and command[0] == "cargo")]
            assert block.title or not read or read == words, f"{place}: what is run here and what is only read are blocks of their own"
            for command in read:
                read_command(command)
            printed = None if read else session.run(block)
        else:
            assert block.language == "python", f"{place}: nothing runs `{block.language}`"
            printed = session.run(block) if block.is_run else None  # mypy checks the others


def test_snippets_that_are_not_run_have_no_wrong_names_and_types(tmp_path: Path) -> None:
    for page, found in WITH_BLOCKS.items():
        snippets = [block.code for block in found if block.language == "python"]
        if not all(block.is_run for block in found if block.language == "python"):
            (tmp_path / f"{re.sub(r'[^a-z]', '_', page.lower())}.py").write_text("\n".join(snippets), encoding="utf-8")
    mypy = [sys.executable, "-m", "mypy", "--ignore-missing-imports", "--allow-redefinition", "--cache-dir", str(tmp_path / "cache"), str(tmp_path)]
    ran = subprocess.run(mypy, cwd=tmp_path, capture_output=True, text=True, encoding="utf-8", check=False)
    assert ran.returncode == 0, ran.stdout


def test_every_name_is_in_the_reference() -> None:
    page = (ROOT / "docs/reference/python.md").read_text(encoding="utf-8")
    assert "`twintac.__version__`" in page
    assert [name for name in twintac.__all__ if name != "__version__" and f"::: twintac.{name}\n" not in page] == []


@pytest.mark.parametrize("command", ["twintac demo --no-such-option", "twintac bake", "python python/examples/rl/train.py --no-such-option 1", "pip install ./python[none]", "rm x"])
def test_a_command_that_no_program_has_is_found(command: str) -> None:
    with pytest.raises((AssertionError, pytest.fail.Exception)):
        read_command(shlex.split(command))


@pytest.mark.parametrize("page", ["```\nx\n```\n", "  ```sh\nx\n  ```\n", "```sh\nx\n", "```sh reason\nx\n```\n"])
def test_a_block_that_says_not_what_it_is_fails(page: str) -> None:
    with pytest.raises(AssertionError):
        blocks(page)
