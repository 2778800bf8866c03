"""The content of geometry.json. z is up; z = 0 is the plane of the ports, which is the gel's flat
bottom.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

Solid = Mapping[str, Any]
Point = tuple[float, float]


class GeometryError(ValueError):
    """Something in geometry.json cannot be built; the message says what, where, and what to do."""


@dataclass(frozen=True)
class Gel:
    """The gel: its solid as in the description, its volume, mm³, and its bounding box, mm."""

    solid: Solid
    volume_mm3: float
    low: tuple[float, float, float]
    high: tuple[float, float, float]

    @property
    def size(self) -> tuple[float, float, float]:
        """Sizes along x, y and z, mm."""
        return (self.high[0] - self.low[0], self.high[1] - self.low[1], self.high[2] - self.low[2])


@dataclass(frozen=True)
class Shell:
    """The rigid wall around the gel, mm: gap to the gel's side, height above z = 0, thickness."""

    gap: float
    height: float
    wall: float


@dataclass(frozen=True)
class Taxel:
    """A taxel: the location of its port, and the port's radius, mm."""

    name: str
    at: Point
    port_radius: float


@dataclass(frozen=True)
class Chip:
    """The barometer's body, mm."""

    name: str
    body: Point
    height: float
    is_confirmed: bool


@dataclass(frozen=True)
class Part:
    """A part on the board's bottom face: centre and full size, mm; the last number of the size is
    the height.
    """

    reference: str
    center: Point
    size: tuple[float, float, float]


@dataclass(frozen=True)
class Board:
    """The circuit board, mm."""

    outline: tuple[Point, ...]
    thickness: float
    top_z: float
    holes: tuple[Point, ...]
    drill: float
    parts: tuple[Part, ...]
    connector: Part
    opens_toward: Point

    @property
    def bottom_z(self) -> float:
        """Height of the board's bottom face, mm."""
        return self.top_z - self.thickness

    @property
    def low(self) -> Point:
        """Smallest x and y of the outline, mm."""
        return (min(p[0] for p in self.outline), min(p[1] for p in self.outline))

    @property
    def high(self) -> Point:
        """Largest x and y of the outline, mm."""
        return (max(p[0] for p in self.outline), max(p[1] for p in self.outline))

    @property
    def tallest(self) -> float:
        """Height of the tallest part on the bottom face, mm."""
        return max(part.size[2] for part in (*self.parts, self.connector))


@dataclass(frozen=True)
class Indenter:
    """A rigid shape that presses the gel; its origin is its point of first touch."""

    name: str
    shape: Solid


@dataclass(frozen=True)
class Geometry:
    """A variant of the sensor."""

    variant: str
    summary: str
    gel: Gel
    shell: Shell | None
    taxels: tuple[Taxel, ...]
    chip: Chip
    board: Board
    indenters: tuple[Indenter, ...]


class _Reader:
    """Reads fields of a JSON object; errors name the field."""

    def __init__(self, value: Any, place: str) -> None:
        if not isinstance(value, Mapping):
            raise GeometryError(f"{place}: expected an object, found {value!r}")
        self.value: Mapping[str, Any] = value
        self.place = place

    def any(self, name: str) -> Any:
        if name not in self.value:
            raise GeometryError(f"{self.place}.{name} is missing")
        return self.value[name]

    def text(self, name: str) -> str:
        found = self.any(name)
        if not isinstance(found, str) or not found:
            raise GeometryError(f"{self.place}.{name}: expected a text, found {found!r}")
        return found

    def number(self, name: str, least: float = -1e4) -> float:
        return _number(self.any(name), f"{self.place}.{name}", least)

    def numbers(self, name: str, count: int, least: float = -1e4) -> tuple[float, ...]:
        return _numbers(self.any(name), f"{self.place}.{name}", count, least)

    def point(self, name: str) -> Point:
        x, y = self.numbers(name, 2)
        return (x, y)

    def triple(self, name: str, least: float = -1e4) -> tuple[float, float, float]:
        x, y, z = self.numbers(name, 3, least)
        return (x, y, z)

    def child(self, name: str) -> _Reader:
        return _Reader(self.any(name), f"{self.place}.{name}")

    def children(self, name: str) -> list[_Reader]:
        found = self.any(name)
        if not isinstance(found, Sequence) or isinstance(found, str):
            raise GeometryError(f"{self.place}.{name}: expected a list, found {found!r}")
        return [_Reader(item, f"{self.place}.{name}[{index}]") for index, item in enumerate(found)]


def _number(value: Any, place: str, least: float) -> float:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if not is_number or not math.isfinite(value) or not least <= value <= 1e7:
        raise GeometryError(f"{place}: expected a number of at least {least:g}, found {value!r}")
    return float(value)


def _numbers(value: Any, place: str, count: int, least: float) -> tuple[float, ...]:
    if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != count:
        raise GeometryError(f"{place}: expected {count} numbers, found {value!r}")
    return tuple(_number(item, f"{place}[{index}]", least) for index, item in enumerate(value))


def load(path: Path) -> Geometry:
    """Reads a geometry.json. Raises `GeometryError`, which names the file and the field."""
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise GeometryError(f"{path}: can't be read: {error.strerror}") from error
    except ValueError as error:
        raise GeometryError(f"{path}: not JSON: {error}") from error
    try:
        return _geometry(_Reader(value, "geometry"))
    except GeometryError as error:
        raise GeometryError(f"{path}: {error}") from error


def _geometry(read: _Reader) -> Geometry:
    gel = read.child("gel")
    bounds = gel.any("bounds_mm")
    if not isinstance(bounds, Sequence) or len(bounds) != 2:
        raise GeometryError(f"{gel.place}.bounds_mm: expected two corners, found {bounds!r}")
    low, high = (_numbers(corner, f"{gel.place}.bounds_mm[{i}]", 3, -1e4) for i, corner in enumerate(bounds))
    if not all(a < b for a, b in zip(low, high, strict=True)) or low[2] != 0.0:
        raise GeometryError(f"{gel.place}.bounds_mm: the first corner must be below the second, at z = 0")
    shell = None if read.any("shell") is None else read.child("shell")
    geometry = Geometry(
        variant=read.text("variant"),
        summary=read.text("summary"),
        gel=Gel(
            gel.child("solid").value,
            gel.number("volume_mm3", 1.0),
            (low[0], low[1], low[2]),
            (high[0], high[1], high[2]),
        ),
        shell=None
        if shell is None
        else Shell(*(shell.number(name, 0.0) for name in ("gap_mm", "height_mm", "wall_mm"))),
        taxels=tuple(
            Taxel(t.text("name"), t.triple("position_mm")[:2], t.number("port_radius_mm", 0.01))
            for t in read.children("taxels")
        ),
        chip=_chip(read.child("chip")),
        board=_board(read.child("board")),
        indenters=tuple(Indenter(i.text("name"), i.child("shape").value) for i in read.children("indenters")),
    )
    for list_name, found in (("taxels", geometry.taxels), ("indenters", geometry.indenters)):
        if not found:
            raise GeometryError(f"geometry.{list_name} is empty")
    if abs(geometry.board.top_z + geometry.chip.height) > 1e-6:
        raise GeometryError("geometry.board.top_z_mm: the chips must reach from the board up to z = 0")
    return geometry


def _chip(read: _Reader) -> Chip:
    body = read.numbers("body_mm", 2, 0.1)
    confirmed = read.any("footprint_confirmed")
    if not isinstance(confirmed, bool):
        raise GeometryError(f"{read.place}.footprint_confirmed: expected true or false, found {confirmed!r}")
    return Chip(read.text("name"), (body[0], body[1]), read.number("height_mm", 0.1), confirmed)


def _board(read: _Reader) -> Board:
    outline = read.any("outline_mm")
    if not isinstance(outline, Sequence) or len(outline) < 3:
        raise GeometryError(f"{read.place}.outline_mm: expected three corners or more, found {outline!r}")
    corners = [_numbers(corner, f"{read.place}.outline_mm[{index}]", 2, -1e4) for index, corner in enumerate(outline)]
    holes = read.children("holes")
    if len(holes) < 2:
        raise GeometryError(f"{read.place}.holes: two M2 holes or more hold the board, found {len(holes)}")
    for hole in holes:
        if hole.text("screw") != "M2":
            raise GeometryError(f"{hole.place}.screw: only M2 is built, found {hole.text('screw')!r}")
    connector = read.child("connector")
    toward = connector.point("opens_toward")
    if sorted(abs(t) for t in toward) != [0.0, 1.0]:
        raise GeometryError(f"{connector.place}.opens_toward: expected a direction along x or y, found {toward!r}")
    return Board(
        outline=tuple((c[0], c[1]) for c in corners),
        thickness=read.number("thickness_mm", 0.2),
        top_z=read.number("top_z_mm"),
        holes=tuple(hole.point("position_mm") for hole in holes),
        drill=max(hole.number("drill_mm", 2.0) for hole in holes),
        parts=tuple(_part(part) for part in read.children("bottom_parts")),
        connector=_part(connector),
        opens_toward=toward,
    )


def _part(read: _Reader) -> Part:
    return Part(read.text("reference"), read.point("center_mm"), read.triple("size_mm", 0.01))
