"""What checks find."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """One thing that was checked: where, what, what was found, what is allowed, and whether that holds."""

    check: str
    of: str
    found: str
    allowed: str
    holds: bool

    def as_json(self) -> dict[str, Any]:
        """The row as a JSON object."""
        return asdict(self)


def table(rows: list[Row]) -> str:
    """Rows as text in columns; those that do not hold begin with `!`."""
    cells = [("", "check", "of", "found", "allowed")]
    cells += [("" if row.holds else "!", row.check, row.of, row.found, row.allowed) for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(5)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in cells
    )
