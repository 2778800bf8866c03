#!/usr/bin/env python3
"""Writes the licences of all code of others that a program of this repository contains.

    python3 .github/licences.py --out LICENCES-THIRD-PARTY.txt [--manifest-path Cargo.toml]

The code is that of the normal and build dependencies in Cargo's lock file, for all platforms; the
texts are those in the packages. `Cargo.toml` of the repository is that of the program and of the
Python package, `web/engine/Cargo.toml` that of the page and of the npm package. Needs Python 3.11 or
later and Cargo.
Exit code 2 if a licence is none of those that are accepted (`ACCEPTED`): then somebody must decide.
"""

import argparse
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
# Licences that demand no more of a program than their text beside it. MPL-2.0 also demands that the
# source of its files can be had: it can, from crates.io, unchanged.
ACCEPTED = {
    "0BSD", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "BSL-1.0", "CC0-1.0", "ISC",
    "MIT", "MIT-0", "MPL-2.0", "OFL-1.1", "Ubuntu-font-1.0", "Unicode-3.0", "Unlicense", "Zlib",
}
LICENCE_FILE = re.compile(r"(licen[cs]es?|copying|notices?|ufl|ofl)([-_. ].*)?(?<!\.rs)", re.IGNORECASE)


def packages(manifest: Path) -> list[dict[str, Any]]:
    """The packages of others that a program or library of a workspace contains."""
    command = ["cargo", "metadata", "--locked", "--format-version", "1", "--manifest-path", str(manifest)]
    metadata = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    edges = {
        node["id"]: [dep["pkg"] for dep in node["deps"] if any(kind["kind"] != "dev" for kind in dep["dep_kinds"])]
        for node in metadata["resolve"]["nodes"]
    }
    reached, left = set(), list(metadata["workspace_members"])
    while left:
        package = left.pop()
        if package not in reached:
            reached.add(package)
            left += edges[package]
    others = [package for package in metadata["packages"] if package["id"] in reached and package["source"]]
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def is_accepted(expression: str) -> bool:
    """Whether one may choose accepted licences from an SPDX expression."""
    tokens = re.findall(r"\(|\)|[^\s()/]+|/", expression.replace(" WITH ", "_WITH_"))
    words = {"AND": "and", "OR": "or", "/": "or", "(": "(", ")": ")"}
    terms = [words.get(token) or str(token.replace("_WITH_", " WITH ") in ACCEPTED) for token in tokens]
    return bool(terms) and bool(eval(" ".join(terms)))  # these words and nothing else


def document(all_packages: list[dict[str, Any]]) -> str:
    """All packages with their licences, and each text once."""
    listed, by_text = [], dict[str, list[str]]()
    for package in all_packages:
        name = f"{package['name']} {package['version']}"
        where = package["repository"] or f"https://crates.io/crates/{package['name']}"
        authors = f", by {', '.join(package['authors'])}" if package["authors"] else ""
        listed.append(f"{name} ({package['license']}){authors}, {where}")
        for text in texts(package):
            by_text.setdefault(text, []).append(name)
    parts = ["This program contains code of others:", "\n".join(listed), "The licence texts in these packages:"]
    parts += [f"{'=' * 80}\n{', '.join(names)}\n\n{text}" for text, names in by_text.items()]
    return "\n\n".join(parts) + "\n"


def texts(package: dict[str, Any]) -> list[str]:
    """The licence texts in a package, each once."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(file for file in folder.rglob("*") if LICENCE_FILE.fullmatch(file.name) and file.is_file())
    read = [file.read_text(encoding="utf-8", errors="replace") for file in files]
    return list(dict.fromkeys("\n".join(line.rstrip() for line in text.strip().splitlines()) for text in read))


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--out", type=Path, help="the file that is written; without it, licences are only checked")
    parser.add_argument("--manifest-path", type=Path, default=ROOT / "Cargo.toml")
    given = parser.parse_args()
    all_packages = packages(given.manifest_path)
    wrong = [package for package in all_packages if not is_accepted(package["license"] or "")]
    for package in wrong:
        print(f"error: {package['name']} {package['version']}: {package['license']} is not an accepted licence", file=sys.stderr)
    if wrong:
        return 2
    if given.out:
        given.out.write_text(document(all_packages), encoding="utf-8")
    print(f"{len(all_packages)} packages of others, with accepted licences")
    return 0


if __name__ == "__main__":
    sys.exit(main())
