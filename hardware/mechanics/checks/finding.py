"""Results of checks."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Row:
    """The result of one check: the check, the checked object, the found value, the allowed values,
    and whether the check holds.
    """

    check: str
    of: str
    found: str
    allowed: str
    holds: bool

    def as_json(self) -> dict[str, Any]:
        """The row as a JSON object."""
        return asdict(self)


def table(rows: list[Row]) -> str:
    """Rows as text in columns; rows that do not hold begin with `!`."""
    cells = [("", "check", "of", "found", "allowed")]
    cells += [("" if row.holds else "!", row.check, row.of, row.found, row.allowed) for row in rows]
    widths = [max(len(line[i]) for line in cells) for i in range(5)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in cells
    )
