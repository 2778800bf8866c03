"""Checks that no two bodies of an assembly share volume. They may touch."""

from __future__ import annotations

from itertools import combinations

import manifold3d

from checks.files import Made
from checks.finding import Row
from checks.solids import board_bodies, screw_body, solid

# Shared volume, mm³, below which two bodies only touch.
TOUCH = 1e-3
# Gel and cover touch in a curved face, of which each has its own triangles: they may differ by the
# STL's tolerance.
CURVED_CONTACT = ("gel", "mould-cover")
CURVED_DEFLECTION = 0.02


def bodies(made: Made, assembly: str) -> dict[str, manifold3d.Manifold]:
    """All bodies of an assembly: prints, gel, board with its parts, screws with their nuts."""
    found = {name: solid(made.meshes[name]) for name in made.used_in(assembly)}
    found |= board_bodies(made)
    screws = list(made.figures["screws"][assembly])
    if assembly in ("flange", "jaw"):
        screws += made.figures["screws"]["sensor"]
    for index, screw in enumerate(screws):
        found[f"screw {screw['thread']} {index}"] = screw_body(screw)
    return found


def shared_volume(a: manifold3d.Manifold, b: manifold3d.Manifold) -> float:
    """Volume that two bodies share, mm³."""
    low_a, high_a = a.bounding_box()[:3], a.bounding_box()[3:]
    low_b, high_b = b.bounding_box()[:3], b.bounding_box()[3:]
    if any(high_a[i] <= low_b[i] or high_b[i] <= low_a[i] for i in range(3)):
        return 0.0
    return float((a ^ b).volume())


def check(made: Made) -> list[Row]:
    """A row for each assembly, and one for each pair of bodies that shares volume."""
    rows = []
    for assembly in ("sensor", "casting", "flange", "jaw"):
        pairs = list(combinations(sorted(bodies(made, assembly).items()), 2))
        worst, found = 0.0, []
        for (name_a, a), (name_b, b) in pairs:
            if "mould-cover" in (name_a, name_b) and "gel" in (name_a, name_b):
                allowed = TOUCH + CURVED_DEFLECTION * _curved_area(made)
            else:
                allowed = TOUCH
            volume = shared_volume(a, b)
            worst = max(worst, volume if allowed == TOUCH else 0.0)
            if volume > allowed:
                found.append(
                    Row(
                        "interference",
                        f"{assembly}: {name_a}, {name_b}",
                        f"{volume:.4f} mm3",
                        f"<= {allowed:.4g} mm3",
                        False,
                    )
                )
        rows.append(
            Row(
                "interference",
                f"{assembly}: {len(pairs)} pairs",
                f"most {worst:.2g} mm3",
                f"<= {TOUCH:g} mm3",
                not found,
            )
        )
        rows += found
    return rows


def _curved_area(made: Made) -> float:
    """Area of the gel's top, seen from above, if the top is curved, mm²; else 0."""
    gel = made.geometry.gel
    is_flat = gel.solid["kind"] == "block" and not gel.solid.get("edge_radius_mm")
    return 0.0 if is_flat else gel.size[0] * gel.size[1]
