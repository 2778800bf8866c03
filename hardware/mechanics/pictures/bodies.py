"""The bodies in pictures: prints, the board with its parts, screws; with cuts on request."""

from __future__ import annotations

from dataclasses import dataclass

import manifold3d
import numpy as np
import trimesh

from checks.files import Made
from checks.solids import board_bodies, rod, screw_body, solid
from pictures.scene import Scene

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Body:
    """A solid with the name of its colour."""

    shape: manifold3d.Manifold
    kind: str

    def moved(self, by: Vector) -> Body:
        """The body, shifted."""
        return Body(self.shape.translate(by), self.kind)

    def cut(self, normal: Vector, offset: float) -> Body:
        """The half on the side to which the normal points."""
        return Body(self.shape.trim_by_plane(normal, offset), self.kind)


def mesh_of(shape: manifold3d.Manifold) -> trimesh.Trimesh:
    """The triangles of a solid."""
    made = shape.to_mesh()
    return trimesh.Trimesh(np.asarray(made.vert_properties)[:, :3], np.asarray(made.tri_verts), process=False)


def part(made: Made, name: str) -> list[Body]:
    """A print, or the gel."""
    kind = "indenter" if name.startswith("indenter-") else name
    return [Body(solid(made.meshes[name]), kind)]


def board(made: Made) -> list[Body]:
    """The board with chips, their ports, and the parts below."""
    kinds = {"board": "board", "chip": "chip", "part": "part"}
    bodies = [Body(shape, kinds[name.split()[0]]) for name, shape in board_bodies(made).items()]
    for taxel in made.geometry.taxels:
        bodies.append(Body(rod(list(taxel.at), taxel.port_radius, -0.05, 0.02), "part"))
    return bodies


def potting(made: Made) -> list[Body]:
    """The silicone below the plane of the ports, in the space that the port plate leaves between
    board and gel.
    """
    chip_holes, anchors = made.meshes["port-plate"], made.figures["anchors_at_mm"]
    low = made.geometry.board.top_z
    x, y = (side / 2 + 0.3 for side in made.geometry.chip.body)
    plate = solid(chip_holes) + manifold3d.Manifold.compose(
        [shape for name, shape in board_bodies(made).items() if name.startswith("chip")]
    )
    bodies = []
    for taxel in made.geometry.taxels:
        hole = manifold3d.Manifold.cube((2 * x, 2 * y, -low)).translate((taxel.at[0] - x, taxel.at[1] - y, low))
        bodies.append(Body(hole - plate, "silicone"))
    for at in anchors:
        bodies.append(Body(rod(at, 1.0, low, 0.0) - plate, "silicone"))
    return bodies


def screws(made: Made, assembly: str) -> list[Body]:
    """The screws of an assembly, with nuts."""
    return [Body(screw_body(screw), "screw") for screw in made.figures["screws"][assembly]]


def moved(bodies: list[Body], by: Vector) -> list[Body]:
    """Shifted bodies."""
    return [body.moved(by) for body in bodies]


def cut(bodies: list[Body], normal: Vector, offset: float) -> list[Body]:
    """The parts of bodies on one side of a plane."""
    halves = [body.cut(normal, offset) for body in bodies]
    return [body for body in halves if body.shape.volume() > 1e-9]


def show(scene: Scene, bodies: list[Body], opacity: float = 1.0) -> None:
    """Adds bodies to a scene."""
    for body in bodies:
        scene.add(mesh_of(body.shape), body.kind, opacity)
