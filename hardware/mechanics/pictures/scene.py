"""A scene of solids that is drawn to a PNG file, with light, colours, edges, and labels with leader
lines.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pyvista as pv
import trimesh
from PIL import Image

from mechanics.export import write_whole

# Colours of the bodies.
COLORS = {
    "board": "#1f6f4a",
    "chip": "#b9bec6",
    "part": "#2f3136",
    "port-plate": "#e9e4d8",
    "shell": "#4a6fa5",
    "lid": "#34507a",
    "gel": "#f2b8a0",
    "silicone": "#f2b8a0",
    "mould-half-a": "#d9a441",
    "mould-half-b": "#c98a2b",
    "mould-cover": "#e3bd6f",
    "casting-jig": "#7a8a99",
    "flange-plate": "#8d99a6",
    "jaw-mount": "#8d99a6",
    "indenter": "#6a7f94",
    "screw": "#9aa0a8",
}
SIZE = (1200, 900)
# Largest size of PNG files of the guide, bytes.
LARGEST = 150_000


@dataclass(frozen=True)
class Label:
    """A label at the left or right of a picture with a line to a point, or a label directly below
    the point.
    """

    text: str
    at: tuple[float, float, float]
    side: str = "right"


@dataclass
class Scene:
    """Solids to draw."""

    direction: tuple[float, float, float] = (1.0, -1.5, 0.9)
    labels: list[Label] = field(default_factory=list)
    _solids: list[tuple[trimesh.Trimesh, str, float]] = field(default_factory=list)

    def add(self, mesh: trimesh.Trimesh, kind: str, opacity: float = 1.0) -> None:
        """Adds a solid with the colour of its kind."""
        self._solids.append((mesh, COLORS[kind], opacity))

    def draw(self, path: Path) -> None:
        """Writes the picture."""
        plotter = pv.Plotter(off_screen=True, window_size=[2 * side for side in SIZE], lighting="none")
        plotter.set_background("white")
        for light in _lights(np.array(self.direction)):
            plotter.add_light(light)
        for mesh, color, opacity in self._solids:
            surface = pv.wrap(mesh)
            plotter.add_mesh(
                surface, color=color, opacity=opacity, smooth_shading=True, split_sharp_edges=True,
                feature_angle=25, ambient=0.25, diffuse=0.75, specular=0.15, specular_power=20,
            )  # fmt: skip
            edges = surface.extract_feature_edges(
                feature_angle=25, boundary_edges=False, manifold_edges=False, non_manifold_edges=False
            )
            if edges.n_points:
                plotter.add_mesh(edges, color="#1c2430", line_width=2.0, opacity=min(1.0, opacity + 0.2))
        self._aim(plotter)
        image = plotter.screenshot(return_img=True)
        points = [_on_screen(plotter, label.at) for label in self.labels]
        plotter.close()
        picture = Image.fromarray(np.asarray(image)[..., :3]).resize(SIZE, Image.Resampling.LANCZOS)
        if self.labels:
            from pictures.labels import draw_labels

            picture = draw_labels(picture, self.labels, points)
        write_png(_cropped(picture), path)

    def _aim(self, plotter: pv.Plotter) -> None:
        """Sets a parallel view in which the solids fill the picture."""
        toward, side, up = _axes(np.array(self.direction))
        points = np.concatenate([mesh.vertices for mesh, _, _ in self._solids])
        across, upward = points @ side, points @ up
        middle = (across.min() + across.max()) / 2 * side + (upward.min() + upward.max()) / 2 * up
        camera = plotter.camera
        camera.parallel_projection = True
        camera.focal_point, camera.position, camera.up = tuple(middle), tuple(middle + 1000.0 * toward), tuple(up)
        camera.parallel_scale = 1.03 * max(np.ptp(upward) / 2, np.ptp(across) / 2 * SIZE[1] / SIZE[0])
        plotter.renderer.ResetCameraClippingRange()


def _axes(direction: npt.NDArray[np.float64]) -> tuple[npt.NDArray[np.float64], ...]:
    """Unit vectors towards the viewer, to the right in the picture, and up in the picture."""
    toward = direction / np.linalg.norm(direction)
    side = np.cross([0.0, 0.0, 1.0], toward)
    side = side / np.linalg.norm(side)
    return toward, side, np.cross(toward, side)


def _lights(direction: npt.NDArray[np.float64]) -> list[pv.Light]:
    """A main light over the left shoulder of the viewer, a weak one from the right, and one from
    above in the picture.
    """
    toward, side, up = _axes(direction)
    if direction[2] < 0.0:  # view from below: lights the faces that are directed downward
        up = -up
    places = ((toward - 0.7 * side + 0.6 * up, 0.75), (toward + 1.2 * side, 0.3), (0.3 * toward + up, 0.25))
    return [
        pv.Light(position=tuple(1000.0 * place), focal_point=(0, 0, 0), intensity=power, positional=False)
        for place, power in places
    ]


def _on_screen(plotter: pv.Plotter, at: tuple[float, float, float]) -> tuple[float, float]:
    """The position of a point in the picture: fractions of width and height from the upper left."""
    renderer = plotter.renderer
    renderer.SetWorldPoint(*at, 1.0)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    return x / (2 * SIZE[0]), 1.0 - y / (2 * SIZE[1])


def _cropped(picture: Image.Image) -> Image.Image:
    """The picture without its white margins, except for a narrow one."""
    dark = np.asarray(picture.convert("L")) < 252
    rows, columns = np.flatnonzero(dark.any(axis=1)), np.flatnonzero(dark.any(axis=0))
    margin = 12
    box = (columns[0] - margin, rows[0] - margin, columns[-1] + margin, rows[-1] + margin)
    return picture.crop((max(box[0], 0), max(box[1], 0), min(box[2], picture.width), min(box[3], picture.height)))


def write_png(picture: Image.Image, path: Path) -> None:
    """Writes a PNG file of at most `LARGEST` bytes, with fewer colours if necessary."""
    for colors in (256, 128, 64, 32):
        reduced = picture.quantize(colors, dither=Image.Dither.NONE)
        data = io.BytesIO()
        reduced.save(data, format="PNG", optimize=True)
        if data.tell() <= LARGEST:
            break
    write_whole(path, lambda partial: partial.write_bytes(data.getvalue()))
