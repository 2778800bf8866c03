"""Display of the progress of long calls."""

import sys
from collections.abc import Callable
from importlib import import_module
from typing import Any, Literal, TypeAlias

Progress: TypeAlias = Callable[[str, int, int, str], object] | Literal[False] | None
"""`None` shows a line on a terminal and in notebooks, `False` shows nothing. A function is called
at each step with the name of the work, the number of finished steps, the total number of steps as
far as it is known (0 if it is not), and a text about the current state. At the end of each work
both numbers are equal.
"""


def listener(progress: Progress) -> Callable[[str, int, int, str], object] | None:
    """The function to call at each step, or `None` if nothing shall be shown."""
    if progress is not None:
        return progress or None
    is_watched = sys.stderr.isatty() or "ipykernel" in sys.modules
    return (_bar() or _Line()) if is_watched else None


class _Line:
    """A line on standard error that is overwritten at each step."""

    def __call__(self, work: str, done: int, total: int, state: str) -> None:
        end = "\n" if done == total > 0 else ""
        print(f"\r\x1b[K{work:>12} {done}/{total or '?'} {state}", end=end, file=sys.stderr, flush=True)


def _bar() -> "_Bar | None":
    try:
        return _Bar(import_module("tqdm.auto").tqdm)
    except ImportError:
        return None


class _Bar:
    """A progress bar of tqdm for each work."""

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
