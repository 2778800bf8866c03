#!/usr/bin/env python3
"""Checks that all packages of the repository have one version, licences, and links to one repository.

    python3 .github/check_versions.py                        before a commit
    python3 .github/check_versions.py --tag v0.1.0           before a release: also the tag
    python3 .github/check_versions.py --notes notes.md       writes CHANGELOG.md's newest part

The version and the repository are those of `[workspace.package]` in Cargo.toml; every other file is
compared with it. With `--tag`, the changelog must have a date instead of "unreleased", and the
repository must not be the placeholder. Needs Python 3.11 or later and nothing else.
Exit code 2 if anything differs, with a line for each difference.
"""

import argparse
import json
import re
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
PLACEHOLDER = "example.org"
LICENCES = ("LICENSE-APACHE", "LICENSE-MIT")
LOCK_FILES = ("Cargo.lock", "firmware/Cargo.lock", "fuzz/Cargo.lock", "web/engine/Cargo.lock")
LINKING_FILES = (
    "CITATION.cff",
    "mkdocs.yml",
    "python/pyproject.toml",
    ".github/ISSUE_TEMPLATE/config.yml",
    ".github/ISSUE_TEMPLATE/sensor-or-chip.yml",
    "web/package/package.json",
    "SECURITY.md",
)
# What must not stand in a file when a release is made, and what must.
UNRELEASED = ("is released yet", "There is none yet", "is not published yet")
UNRELEASED_FILES = ("CHANGELOG.md", "VERSIONING.md", "SECURITY.md", "crates/app/twintac/README.md", "crates/app/twintac/src/lib.rs")
INSTALLS = {
    "python/README.md": "pip install twintac",
    "docs/index.md": "pip install twintac",
    "crates/app/twintac/README.md": "twintac = \"",
}


def text(file: str) -> str:
    return (ROOT / file).read_text(encoding="utf-8")


def toml(file: str) -> dict[str, Any]:
    return tomllib.loads(text(file))


def ours(package: dict[str, Any]) -> bool:
    """Whether an entry of a lock file is a package of this repository."""
    return "source" not in package and re.match("twintac|digitac$|phystac$", package["name"]) is not None


def versions() -> Iterator[tuple[str, str]]:
    """Where a version is stated, and the version."""
    for name, wanted in toml("Cargo.toml")["workspace"]["dependencies"].items():
        if isinstance(wanted, dict) and "path" in wanted:
            yield f"Cargo.toml, dependency {name}", wanted.get("version", "none").removeprefix("=")
    yield "firmware/Cargo.toml", toml("firmware/Cargo.toml")["workspace"]["package"]["version"]
    for file in ("fuzz/Cargo.toml", "web/engine/Cargo.toml"):
        yield file, toml(file)["package"]["version"]
    for file in LOCK_FILES:
        for package in toml(file)["package"]:
            if ours(package):
                yield f"{file}, package {package['name']}", package["version"]
    for file in ("web/package.json", "web/package/package.json", "web/package-lock.json"):
        yield file, json.loads(text(file))["version"]
    yield "web/package-lock.json, first package", json.loads(text("web/package-lock.json"))["packages"][""]["version"]
    yield "web/tests/package.test.mjs, archive", found(r"\btwintac-(\d[^\"]*)\.tgz", text("web/tests/package.test.mjs"))
    yield "python/lerobot/pyproject.toml", toml("python/lerobot/pyproject.toml")["project"]["version"]
    yield "CITATION.cff", found(r"^version: *['\"]?([^'\"\s]+)", text("CITATION.cff"))
    yield "CHANGELOG.md, first heading of a version", changelog()[0]


def published_crates() -> Iterator[str]:
    """The folders of the crates that are published."""
    for manifest in sorted(ROOT.glob("crates/*/*/Cargo.toml")):
        folder = str(manifest.parent.relative_to(ROOT))
        if toml(f"{folder}/Cargo.toml")["package"].get("publish") is not False:
            yield folder


def found(pattern: str, where: str) -> str:
    match = re.search(pattern, where, re.MULTILINE)
    return match[1] if match else "none"


def changelog() -> tuple[str, str, str]:
    """The newest version in the changelog, the note in brackets behind it, and what changed."""
    match = re.search(r"^## (\S+) *(?:\(([^)\n]*)\))?\n(.*?)(?=^## |\Z)", text("CHANGELOG.md"), re.MULTILINE | re.DOTALL)
    return (match[1], match[2] or "", match[3].strip()) if match else ("none", "", "")


def differences(tag: str | None) -> Iterator[str]:
    """What does not fit, one line each."""
    package = toml("Cargo.toml")["workspace"]["package"]
    version, repository = package["version"], package["repository"]
    for place, stated in versions():
        if stated != version:
            yield f"{place}: the version is {stated}, in Cargo.toml it is {version}"

    for name, wanted in toml("Cargo.toml")["workspace"]["dependencies"].items():
        if isinstance(wanted, dict) and "path" in wanted and not wanted.get("version", "").startswith("="):
            yield f"Cargo.toml, dependency {name}: write `=` before the version, because internal crates may change in a patch"
    for folder in published_crates():
        for licence in LICENCES:
            if not (ROOT / folder / licence).is_file():
                yield f"{folder}: has no {licence}; make a symbolic link to that of the repository"

    project = toml("python/pyproject.toml")["project"]
    crate = toml("python/Cargo.toml")
    if "version" not in project.get("dynamic", []) or crate["package"]["version"] != {"workspace": True}:
        yield "python: the version is not that of the workspace (`dynamic` in pyproject.toml, `version.workspace` in Cargo.toml)"
    abi = next(feature for feature in crate["dependencies"]["pyo3"]["features"] if feature.startswith("abi3-py"))
    if abi != "abi3-py" + oldest_python().replace(".", ""):
        yield f"python/Cargo.toml: {abi} is not the oldest Python of pyproject.toml, {oldest_python()}"

    for file in LINKING_FILES:
        links = re.findall(r"https://[^\s\"'<>)]+", text(file))
        links = [link for link in links if "twintac" in link or PLACEHOLDER in link]
        wrong = [link for link in links if link.removesuffix(".git") != repository and not link.startswith(repository + "/")]
        yield from (f"{file}: {link} is not below {repository}, the repository of Cargo.toml" for link in wrong)

    if tag is not None:
        if tag != f"v{version}":
            yield f"the tag is {tag}, the version of Cargo.toml is {version}: the tag must be v{version}"
        date, cited = changelog()[1], found(r"^date-released: *['\"]?([\d-]+)", text("CITATION.cff"))
        if not re.fullmatch(r"\d{4}-\d\d-\d\d", date):
            yield f"CHANGELOG.md: the heading of {changelog()[0]} has no date; write `## {version} (YYYY-MM-DD)`"
        elif cited != date:
            yield f"CITATION.cff: `date-released` is {cited}, the date in CHANGELOG.md is {date}"
        if PLACEHOLDER in repository:
            yield f"Cargo.toml: the repository is still the placeholder {repository}"
        for file in UNRELEASED_FILES:
            if any(words in text(file) for words in UNRELEASED):
                yield f"{file}: says that nothing is released yet"
        for file, words in INSTALLS.items():
            if words not in text(file):
                yield f"{file}: does not say how to install the released package: `{words}`"


def oldest_python() -> str:
    return found(r">=\s*(\d+\.\d+)", toml("python/pyproject.toml")["project"]["requires-python"])


def outputs() -> dict[str, str]:
    """What the release workflow needs to know."""
    return {
        "version": toml("Cargo.toml")["workspace"]["package"]["version"],
        "pythons": json.dumps([oldest_python(), "3.x"]),  # 3.x: the newest one
        "maturin": next(tool for tool in toml("python/pyproject.toml")["build-system"]["requires"] if tool.startswith("maturin")),
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--tag", help="the tag of the release, such as v0.1.0")
    parser.add_argument("--notes", type=Path, help="write the newest part of CHANGELOG.md to this file")
    parser.add_argument("--outputs", type=Path, help="append version, pythons and maturin to this file, as NAME=VALUE")
    given = parser.parse_args()
    wrong = list(differences(given.tag))
    if wrong:
        print("\n".join(f"error: {line}" for line in wrong), file=sys.stderr)
        return 2
    if given.notes:
        given.notes.write_text(changelog()[2] + "\n", encoding="utf-8")
    if given.outputs:
        with given.outputs.open("a", encoding="utf-8") as file:
            file.writelines(f"{name}={value}\n" for name, value in outputs().items())
    print(f"{outputs()['version']}: all {len(list(versions()))} places agree")
    return 0


if __name__ == "__main__":
    sys.exit(main())
