"""The gel as a solid: the cavity of its mould, and the gel in pictures. It is not printed."""

from __future__ import annotations

from build123d import Axis, Face, Part, Pos, Solid, fillet

from mechanics.gel import edge_radius, ends, fall_curvature, kind
from mechanics.geometry import Gel
from mechanics.layout import Rectangle
from mechanics.sketch import box


def gel(of: Gel) -> Part:
    """The exact undeformed gel, without facets."""
    return _block(of) if kind(of) == "block" else _dome(of)


def _block(of: Gel) -> Part:
    """The intersection of an arch along x and one along y: two rounded edges meet in a mitre."""
    block = box(Rectangle(*of.low[:2], *of.high[:2]), of.low[2], of.high[2])
    radius = edge_radius(of)
    if radius == 0.0:
        return block
    top = block.edges().group_by(Axis.Z)[-1]
    along_x = fillet(top.filter_by(Axis.Y), radius)
    return along_x & fillet(top.filter_by(Axis.X), radius)


def _dome(of: Gel) -> Part:
    """The solid below the patches of the top: between crown and edges, the top is one quadratic
    patch in each quarter.
    """
    solid = of.solid
    crown = ends(solid, "crown_at_mm")
    quarters = [
        _below_patch(of, (x0, x1), (y0, y1), crown)
        for x0, x1 in ((of.low[0], crown[0]), (crown[0], of.high[0]))
        for y0, y1 in ((of.low[1], crown[1]), (crown[1], of.high[1]))
        if x1 - x0 > 1e-9 and y1 - y0 > 1e-9
    ]
    whole = quarters[0]
    for quarter in quarters[1:]:
        whole = whole + quarter
    return whole


def _below_patch(of: Gel, x: tuple[float, float], y: tuple[float, float], crown: tuple[float, float]) -> Part:
    """The solid below a quarter of the top, down to z = 0.

    A quadratic descent is exactly a Bézier patch of degree two.
    """
    curvature = []
    for axis, stands_at, quarter in (("x", crown[0], x), ("y", crown[1], y)):
        towards = fall_curvature(ends(of.solid, f"{axis}_mm"), stands_at, ends(of.solid, f"drop_{axis}_mm"))
        curvature.append(towards[0] if quarter[1] <= stands_at else towards[1])
    poles = []
    for px in range(3):
        row = []
        for py in range(3):
            at = (x[0] + (x[1] - x[0]) * px / 2, y[0] + (y[1] - y[0]) * py / 2)
            # The poles of a² along [a0, a1] are a0², a0 a1, a1² (its polar form).
            fall = curvature[0] * _polar(x[0] - crown[0], x[1] - crown[0], px)
            fall += curvature[1] * _polar(y[0] - crown[1], y[1] - crown[1], py)
            row.append((at[0], at[1], float(of.solid["crown_mm"]) - fall))
        poles.append(row)
    deep = 2.0 * of.high[2]
    under = Solid.extrude(Pos(0.0, 0.0, -deep) * Face.make_bezier_surface(poles), (0.0, 0.0, deep))
    return box(Rectangle(x[0], y[0], x[1], y[1]), 0.0, of.high[2] + 1.0) & under


def _polar(a0: float, a1: float, index: int) -> float:
    return (a0 * a0, a0 * a1, a1 * a1)[index]
