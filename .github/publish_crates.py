#!/usr/bin/env python3
"""Publishes the crates of this workspace on crates.io, in the order of their dependencies.

    python3 .github/publish_crates.py --list           the crates, and which are already published
    python3 .github/publish_crates.py                  publishes the rest
    python3 .github/publish_crates.py --minutes 15     the same, and does not begin again after this time

`cargo publish --workspace` knows the order, but it stops at crates.io's limits (status 429: today
30 versions at once and one more a minute, for crates that are new five at once and one more in ten
minutes), and it refuses to begin if a crate is already published. This script leaves out what is
published, and waits and begins again at a limit. If it is stopped, run it again.

The credentials are Cargo's: `cargo login`, or CARGO_REGISTRY_TOKEN. It compiles nothing, as it runs
Cargo with `--no-verify`: run `cargo publish --workspace --dry-run` first, which compiles each
crate as it will be published. Needs Python 3.10 or later and Cargo 1.90 or later.
Exit code 0 if all are published, 1 if Cargo failed, 3 if `--minutes` ended it: then run it again.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
WAIT_S = 60
AT_A_LIMIT = ("429", "Too Many Requests")


def crates() -> dict[str, str]:
    """The version of each crate that may be published."""
    command = ["cargo", "metadata", "--no-deps", "--format-version", "1"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    packages = [package for package in metadata["packages"] if package["publish"] != []]
    return {package["name"]: package["version"] for package in packages}


def is_published(name: str, version: str) -> bool:
    """Whether crates.io has this version of a crate."""
    with tempfile.TemporaryDirectory() as elsewhere:  # where `cargo info` finds no workspace
        command = ["cargo", "info", "--registry", "crates-io", f"{name}@{version}"]
        ran = subprocess.run(command, cwd=elsewhere, capture_output=True, text=True)
    if ran.returncode != 0 and "could not find" not in ran.stderr:
        sys.exit(f"error: `{' '.join(command)}` failed\n{ran.stderr}")
    return ran.returncode == 0


def publish(published: list[str]) -> tuple[int, str]:
    """Publishes all crates but these. Cargo's exit code, and what it said."""
    command = ["cargo", "publish", "--workspace", "--locked", "--no-verify"]
    for name in published:
        command += ["--exclude", name]
    said = ""
    with subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True) as cargo:
        for line in cargo.stderr or ():
            print(line, end="", file=sys.stderr, flush=True)
            said += line
    return cargo.returncode, said


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    parser.add_argument("--list", action="store_true", help="publish nothing")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="do not begin again after this time")
    given = parser.parse_args()
    end = time.monotonic() + 60 * given.minutes
    left = crates()
    published: list[str] = []
    while True:
        for name, version in list(left.items()):
            if is_published(name, version):
                published.append(name)
                del left[name]
        print(f"published: {len(published)}, left: {' '.join(left) or 'none'}", flush=True)
        if given.list or not left:
            return 0
        code, said = publish(published)
        if code == 0:
            return 0
        if not any(word in said for word in AT_A_LIMIT):
            return 1
        if time.monotonic() + WAIT_S > end:
            return 3
        print(f"the limit of crates.io is reached: again in {WAIT_S} s", flush=True)
        time.sleep(WAIT_S)


if __name__ == "__main__":
    sys.exit(main())
