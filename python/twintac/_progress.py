"""How far long work is."""

import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any, Literal, TypeAlias

Progress: TypeAlias = Callable[[str, int, int, str], object] | Literal[False] | None
"""`None` shows a line on a terminal and in notebooks, `False` nothing. A function hears of each step: the work, steps that are done, all
steps as far as they are known, and how things stand. At the end of each work both numbers are the same."""


def listener(progress: Progress) -> Callable[[str, int, int, str], object] | None:
    """What hears of each step, if anybody does."""
    if progress is not None:
        return progress or None
    is_watched = sys.stderr.isatty() or "ipykernel" in sys.modules
    return (_bar() or _Line()) if is_watched else None


class _Line:
    """A line that is written again and again."""

    def __call__(self, work: str, done: int, total: int, state: str) -> None:
        end = "\n" if done == total > 0 else ""
        print(f"\r\x1b[K{work:>12} {done}/{total or '?'} {state}", end=end, file=sys.stderr, flush=True)


def _bar() -> "_Bar | None":
    try:
        return _Bar(import_module("tqdm.auto").tqdm)
    except ImportError:
        return None


class _Bar:
    """A bar of tqdm for each work."""

    def __init__(self, tqdm: Any) -> None:
        self._tqdm = tqdm
        self._bar: Any = None

    def __call__(self, work: str, done: int, total: int, state: str) -> None:
        if self._bar is None or self._bar.desc != work:
            self._bar = self._tqdm(desc=work)
        self._bar.total = total or None
        self._bar.set_postfix_str(state, refresh=False)
        self._bar.update(done - self._bar.n)
        if done == total > 0:
            self._bar.close()
