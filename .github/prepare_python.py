#!/usr/bin/env python3
"""Prepares the folder `python` of a checkout for a release, before maturin packs it.

    python3 .github/prepare_python.py REPOSITORY-URL TAG

Copies the licences beside pyproject.toml, from where maturin takes them, with those of the code of
others (`licences.py`), and makes the relative links of README.md absolute, because index pages show
it without the repository.
"""

import re
import shutil
import subprocess
import sys
from pathlib import Path
from posixpath import normpath

ROOT = Path(__file__).resolve().parents[1]


def absolute(readme: str, repository: str, tag: str) -> str:
    """The text of python/README.md with absolute links."""

    def link(found: "re.Match[str]") -> str:
        path, anchor = found[1], found[2] or ""
        target = normpath(f"python/{path}")
        if not (ROOT / target).exists():
            sys.exit(f"error: python/README.md: {path} does not exist")
        kind = "tree" if (ROOT / target).is_dir() else "blob"
        return f"]({repository}/{kind}/{tag}/{target}{anchor})"

    return re.sub(r"\]\((?![a-z]+:)([^)#\s]+)(#[^)\s]*)?\)", link, readme)


def main(repository: str, tag: str) -> None:
    for licence in ROOT.glob("LICENSE-*"):
        shutil.copy(licence, ROOT / "python")
    others = ROOT / "python/LICENCES-THIRD-PARTY.txt"
    subprocess.run([sys.executable, ROOT / ".github/licences.py", "--out", others], check=True)
    readme = ROOT / "python/README.md"
    readme.write_text(absolute(readme.read_text(encoding="utf-8"), repository.rstrip("/"), tag), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit((__doc__ or "").strip())
    main(*sys.argv[1:])
