"""Tests that each check finds its defect.

Files are damaged on purpose. The check has to report the damage, and nothing before the damage.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import trimesh

from checks import cavity, indenters, interference, meshes, walls
from checks.files import Made
from checks.finding import Row, table

Check = Callable[[Made], list[Row]]


def broken(made: Made, name: str, mesh: trimesh.Trimesh) -> Made:
    """The same files, with another mesh for a part."""
    return replace(made, meshes={**made.meshes, name: mesh})


def moved(made: Made, name: str, by: tuple[float, float, float]) -> Made:
    """The same files, with a part shifted."""
    mesh = made.meshes[name].copy()
    mesh.apply_translation(by)
    return broken(made, name, mesh)


def scaled(made: Made, name: str, by: tuple[float, float, float]) -> Made:
    """The same files, with a part scaled."""
    mesh = made.meshes[name].copy()
    mesh.apply_scale(by)
    return broken(made, name, mesh)


def findings(check: Check, made: Made) -> list[str]:
    """The checks that fail, with their objects."""
    return [f"{row.check}: {row.of}" for row in check(made) if not row.holds]


@pytest.mark.parametrize("check", [meshes.check, cavity.check, interference.check, walls.check, indenters.check])
def test_nothing_is_found_in_what_was_made(check: Check, block: Made, dome: Made) -> None:
    assert findings(check, block) == []
    assert findings(check, dome) == []


def test_a_missing_triangle_is_found(block: Made) -> None:
    mesh = block.meshes["shell"]
    open_mesh = trimesh.Trimesh(mesh.vertices, mesh.faces[:-1], process=False)
    assert findings(meshes.check, broken(block, "shell", open_mesh)) == ["closed, two triangles at each edge: shell"]


def test_a_triangle_that_branches_off_is_found(block: Made) -> None:
    mesh = block.meshes["shell"]
    faces = np.vstack([mesh.faces, mesh.faces[:1]])
    assert "closed, two triangles at each edge: shell" in findings(
        meshes.check, broken(block, "shell", trimesh.Trimesh(mesh.vertices, faces, process=False))
    )


def test_one_triangle_turned_inward_is_found(block: Made) -> None:
    mesh = block.meshes["lid"]
    faces = mesh.faces.copy()
    faces[0] = faces[0][::-1]
    turned = trimesh.Trimesh(mesh.vertices, faces, process=False)
    assert findings(meshes.check, broken(block, "lid", turned)) == ["closed, two triangles at each edge: lid"]


def test_a_surface_turned_inward_is_found(block: Made) -> None:
    mesh = block.meshes["lid"]
    turned = trimesh.Trimesh(mesh.vertices, mesh.faces[:, ::-1], process=False)
    assert findings(meshes.check, broken(block, "lid", turned)) == ["turned outward: lid"]


def test_a_loose_piece_is_found(block: Made) -> None:
    crumb = trimesh.creation.box([1.0, 1.0, 1.0])
    crumb.apply_translation([0.0, 0.0, -5.0])
    both = trimesh.util.concatenate([block.meshes["lid"], crumb])
    assert findings(meshes.check, broken(block, "lid", both)) == ["one body: lid"]


def test_a_part_that_is_too_large_is_found(block: Made) -> None:
    assert findings(meshes.check, scaled(block, "jaw-mount", (4.0, 1.0, 1.0))) == ["size: jaw-mount"]


def test_a_part_at_another_height_is_found(block: Made) -> None:
    assert findings(meshes.check, moved(block, "shell", (0.0, 0.0, 0.1))) == ["levels: shell"]


def test_a_mould_that_holds_more_is_found(block: Made, dome: Made) -> None:
    for made in (block, dome):
        assert findings(cavity.check, moved(made, "mould-cover", (0.0, 0.0, 0.15))) == ["volume as the gel's: mould"]
        assert findings(cavity.check, moved(made, "mould-half-b", (0.3, 0.0, 0.0))) == ["volume as the gel's: mould"]


def test_a_gel_of_another_form_is_found(dome: Made) -> None:
    # Rotation about z keeps the volume: only the form differs.
    mesh = dome.meshes["gel"].copy()
    mesh.apply_translation([-5.1, 0.0, 0.0])
    mesh.apply_transform(trimesh.transformations.rotation_matrix(np.pi, [0, 0, 1]))
    mesh.apply_translation([5.1, 0.0, 0.0])
    assert findings(cavity.check, broken(dome, "gel", mesh)) == ["form of the top: gel"]


def test_parts_in_each_other_are_found(block: Made) -> None:
    found = findings(interference.check, moved(block, "lid", (0.0, 0.0, 0.05)))
    assert "interference: sensor: lid, shell" in found
    assert "interference: sensor: board, lid" in found


def test_a_hole_that_no_screw_passes_is_found(block: Made) -> None:
    found = findings(interference.check, moved(block, "port-plate", (0.15, 0.0, 0.0)))
    assert "interference: sensor: port-plate, screw M2 0" in found


def test_a_chip_that_meets_the_plate_is_found(block: Made) -> None:
    found = findings(interference.check, moved(block, "port-plate", (0.0, 0.35, 0.0)))
    assert "interference: sensor: chip t0, port-plate" in found


@pytest.mark.parametrize("wall", [0.6, 1.0, 1.5])
def test_walls_are_measured(wall: float) -> None:
    tube = trimesh.creation.annulus(5.0 - wall, 5.0, 10.0, sections=128)
    assert walls.thickness(tube)[0] == pytest.approx(wall, abs=0.01)


def test_corners_are_no_walls() -> None:
    wedge = trimesh.creation.cylinder(10.0, 8.0, sections=3)
    assert walls.thickness(wedge)[0] == pytest.approx(8.0, abs=1e-3)


def test_a_thin_wall_is_found(block: Made) -> None:
    thin = trimesh.creation.box([20.0, 20.0, 1.0])
    assert findings(walls.check, broken(block, "lid", thin)) == ["thinnest wall: lid"]


@pytest.mark.parametrize("name", ["sphere-25", "cube", "x", "ring", "triangle", "wedge", "cylinder"])
def test_an_indenter_of_another_form_is_found(name: str, block: Made) -> None:
    wider = scaled(block, f"indenter-{name}", (1.03, 1.03, 1.0))
    assert findings(indenters.check, wider) == [f"described form: indenter-{name}"]


def test_an_indenter_with_a_bump_missing_is_found(block: Made) -> None:
    """Where the file has less than the description, the points of the file show no difference, but
    the points of the description do.
    """
    whole = block.meshes["indenter-ring"]
    disc = trimesh.creation.cylinder(2.0, 30.0)
    disc.apply_translation([0.0, 0.0, 15.0])
    shape = {"kind": "ring", "outer_radius_mm": 7.0, "inner_radius_mm": 4.0, "height_mm": 10.0, "edge_radius_mm": 0.8}
    assert indenters.form_error(whole, shape, 9.15) < 0.05
    assert indenters.form_error(disc, shape, 9.15) > 1.0


def test_findings_stand_out_in_the_table() -> None:
    rows = [Row("a", "b", "c", "d", True), Row("e", "f", "g", "h", False)]
    assert [line[0] for line in table(rows).splitlines()] == [" ", " ", "!"]
