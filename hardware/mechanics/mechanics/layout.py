"""The positions of all parts.

Levels, outlines and screws of a variant are computed from its geometry alone. Every part is drawn
in its mounted position.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from mechanics import fits
from mechanics.gel import edge_height
from mechanics.geometry import Geometry, GeometryError, Point
from mechanics.screws import M2, M3, M3_SUNK_RADIUS, Screw

# Length by which a screw's end exceeds its nut.
BEYOND_NUT = 0.3
# Distance between the two screws that hold the lid on a mount.
MOUNT_PITCH = 16.0
# Distance from the clamping screws' axes to the mould's outer face: hole, groove for a cable tie,
# and a wall between them.
CLAMP_EDGE = 5.0


@dataclass(frozen=True)
class Rectangle:
    """A rectangle parallel to the axes, mm."""

    x0: float
    y0: float
    x1: float
    y1: float

    def grown(self, by: float) -> Rectangle:
        """The rectangle with all sides moved outward by a distance."""
        return Rectangle(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)

    def around(self, other: Rectangle) -> Rectangle:
        """The smallest rectangle that holds both."""
        return Rectangle(min(self.x0, other.x0), min(self.y0, other.y0), max(self.x1, other.x1), max(self.y1, other.y1))

    @property
    def center(self) -> Point:
        """The centre."""
        return ((self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2)

    def distance(self, point: Point) -> float:
        """Distance of a point from the rectangle, mm; 0 inside."""
        return math.hypot(
            max(self.x0 - point[0], 0.0, point[0] - self.x1), max(self.y0 - point[1], 0.0, point[1] - self.y1)
        )


@dataclass(frozen=True)
class Fastener:
    """An upright screw with its nut: location, height of its seat, length, height of the nut's
    upper face, mm.
    """

    screw: Screw
    at: Point
    seat_z: float
    length: float
    nut_top_z: float
    is_sunk: bool = False

    @property
    def end_z(self) -> float:
        """Height of the screw's end, mm."""
        return self.seat_z - self.length


class Layout:
    """Levels (`_z`), outlines and screws, mm. Raises `GeometryError` for a geometry that cannot be
    built.
    """

    def __init__(self, geometry: Geometry) -> None:
        self.geometry = geometry
        self.board = geometry.board
        self.gel = Rectangle(*geometry.gel.low[:2], *geometry.gel.high[:2])
        self.gel_top_z = geometry.gel.high[2]
        self.chip_holes = tuple(self._chip_hole(taxel.at) for taxel in geometry.taxels)
        # Chips may be nearer to the board's edge than the thickness of a wall: the port plate is
        # wider than the board there.
        self.plate_patches = tuple(hole.grown(fits.MIN_WALL) for hole in self.chip_holes)
        self.board_box = Rectangle(*self.board.low, *self.board.high)
        for patch in self.plate_patches:
            self.board_box = self.board_box.around(patch)
        shell = geometry.shell
        self.gap = shell.gap if shell else fits.FREE_GAP
        self.rim_z = shell.height if shell else fits.FREE_HEIGHT
        self.wall = max(shell.wall if shell else fits.FREE_WALL, fits.MIN_WALL)
        self.opening = self.gel.grown(self.gap)
        self.pocket = self.board_box.grown(fits.FIT)
        self.outer = self.opening.around(self.pocket).grown(self.wall)
        self.parts_z = self.board.bottom_z - self.board.tallest - fits.PARTS_GAP
        self._check()

    def _chip_hole(self, at: Point) -> Rectangle:
        half_x, half_y = (side / 2 + fits.CHIP_GAP for side in self.geometry.chip.body)
        return Rectangle(at[0] - half_x, at[1] - half_y, at[0] + half_x, at[1] + half_y)

    @cached_property
    def corner(self) -> float:
        """Radius of the outer corners: as large as the board's corners allow, at least the wall."""
        needed = fits.FIT + self.wall
        corners = [
            *self.board.outline,
            *((x, y) for patch in self.plate_patches for x in (patch.x0, patch.x1) for y in (patch.y0, patch.y1)),
        ]
        for radius in (8.0, 6.0, 4.0):
            core = self.outer.grown(-radius)
            if all(core.distance(corner) <= radius - needed + 1e-9 for corner in corners):
                return radius
        return self.wall

    def _check(self) -> None:
        sink = M2.head_radius + fits.HOLE_FIT
        if self.rim_z < 2 * fits.MIN_WALL:
            raise GeometryError(
                f"shell.height_mm: {self.rim_z:g} mm is too thin for screw heads: at least {2 * fits.MIN_WALL:g} mm"
            )
        for hole in self.board.holes:
            room = self.opening.distance(hole) - sink
            if room < fits.MIN_WALL - 1e-9:
                raise GeometryError(
                    f"board.holes at {hole}: {room:.2f} mm are left between the screw's head and the shell's opening,"
                    f" {fits.MIN_WALL} mm are needed:"
                    f" move the hole to at least {sink + fits.MIN_WALL:.2f} mm from the opening"
                )
        for taxel in self.geometry.taxels:
            if Rectangle(*self.board.low, *self.board.high).distance(taxel.at) > 0.0:
                raise GeometryError(f"taxels `{taxel.name}` at {taxel.at} is not on the board")

    @cached_property
    def sensor_screws(self) -> tuple[Fastener, ...]:
        """The screws of shell, port plate, board and lid: inserted from above, with nuts in the
        lid.
        """
        seat = self.rim_z - min(M2.head_height, self.rim_z - fits.MIN_WALL)
        # The nut is completely inside the lid, at most half a millimetre below the lid's upper
        # face.
        length = M2.length(seat - self.parts_z + M2.nut_height + BEYOND_NUT + 0.5, 25)
        nut = seat - length + BEYOND_NUT + M2.nut_height
        return tuple(Fastener(M2, hole, seat, length, nut) for hole in self.board.holes)

    @cached_property
    def lid_z(self) -> float:
        """Height of the lid's lower face: the lid has the usual thickness, or reaches to the ends
        of the screws.
        """
        return min(self.parts_z - fits.PLATE, self.sensor_screws[0].end_z)

    @cached_property
    def mount_points(self) -> tuple[Point, Point]:
        """Locations of the two countersunk M3 screws that go from the inside of the lid into a
        mount.
        """
        x, y = self.outer.center
        points = ((x - MOUNT_PITCH / 2, y), (x + MOUNT_PITCH / 2, y))
        for point in points:
            if any(math.dist(point, hole) < M3_SUNK_RADIUS + M2.nut_flats for hole in self.board.holes):
                raise GeometryError(
                    f"board.holes: one is above the mount's screw at {point}: move it further from the gel's middle"
                )
        return points

    def mount_screws(self, thickness: float, floor: float) -> tuple[Fastener, ...]:
        """The screws of the lid and a mount of a given thickness; at least `floor` of the mount's
        thickness holds the nut.
        """
        length = M3.length(fits.PLATE + floor + M3.nut_height, fits.PLATE + thickness)
        nut = min(self.sunk_z - length + M3.nut_height, self.lid_z - floor)
        return tuple(Fastener(M3, at, self.sunk_z, length, nut, True) for at in self.mount_points)

    @cached_property
    def sunk_z(self) -> float:
        """Height of the upper face of the mount's countersunk heads.

        Its distance from the lid's lower face does not depend on the lid's thickness.
        """
        return self.lid_z + fits.PLATE

    # The mould and its jig.

    @cached_property
    def parting_z(self) -> float:
        """Height up to which the gel's sides are upright: the halves of the mould are below, the
        cover above.
        """
        return edge_height(self.geometry.gel)

    @cached_property
    def clamp_y(self) -> tuple[float, float]:
        """Lines of the clamping screws: far enough outward that the traps of their nuts are beside
        the board's bed.
        """
        trap = (M3.nut_flats + fits.FIT) / math.sqrt(3.0)
        beside = self.gel.grown(fits.MOULD_WALL).around(self.pocket.grown(fits.MIN_WALL)).grown(trap)
        return (beside.y0, beside.y1)

    @cached_property
    def mould_box(self) -> Rectangle:
        """Outline of mould and jig."""
        low, high = self.clamp_y
        ends = self.pocket.around(self.gel.grown(fits.MOULD_WALL)).grown(2.0)
        return Rectangle(ends.x0, low - CLAMP_EDGE, ends.x1, high + CLAMP_EDGE)

    @cached_property
    def cover_z(self) -> float:
        """Height of the cover's upper face."""
        return self.gel_top_z + 4.0

    @cached_property
    def jig_z(self) -> float:
        """Height of the jig's lower face."""
        return self.parts_z - fits.PLATE

    @cached_property
    def clamp_screws(self) -> tuple[Fastener, ...]:
        """The screws of cover, halves and jig."""
        x0, x1 = self.gel.x0 + 6.0, self.gel.x1 - 6.0
        length = max(length for length in M3.lengths if length <= self.cover_z - self.jig_z)
        nut = self.cover_z - length + BEYOND_NUT + M3.nut_height
        return tuple(Fastener(M3, (x, y), self.cover_z, length, nut) for y in self.clamp_y for x in (x0, x1))

    @cached_property
    def casting_screws(self) -> tuple[Fastener, ...]:
        """The screws of the mould's halves, port plate, board and jig: in the holes that later hold
        the shell.
        """
        seat = min(fits.PLATE, self.parting_z)
        length = max(length for length in M2.lengths if length <= seat - self.jig_z)
        nut = seat - length + BEYOND_NUT + M2.nut_height
        if nut > self.board.bottom_z - fits.MIN_WALL:
            raise GeometryError("board: no M2 screw on sale ends within the jig: change the board's thickness")
        return tuple(Fastener(M2, hole, seat, length, nut) for hole in self.board.holes)

    @cached_property
    def fill_at(self) -> Point:
        """Location of the fill hole: on the gel's middle line, near the end that is farther from
        any taxel.
        """
        y = self.gel.center[1]
        ends = [(self.gel.x0 + fits.FILL_INSET, y), (self.gel.x1 - fits.FILL_INSET, y)]
        return max(ends, key=lambda end: min(math.dist(end, taxel.at) for taxel in self.geometry.taxels))

    @cached_property
    def vents_at(self) -> tuple[Point, ...]:
        """Locations of the vents: at the corners, and at the highest point of a dome."""
        corners = self.gel.grown(-fits.VENT_INSET)
        vents = [(x, y) for y in (corners.y0, corners.y1) for x in (corners.x0, corners.x1)]
        solid = self.geometry.gel.solid
        if solid["kind"] == "dome":
            crown = (float(solid["crown_at_mm"][0]), float(solid["crown_at_mm"][1]))
            if math.dist(crown, self.fill_at) > fits.FILL_CONE_RADIUS + 2 * fits.VENT_RADIUS:
                vents.append(crown)
        return tuple(vents)
