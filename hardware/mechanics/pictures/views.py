"""The pictures of the guide, by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from checks.files import Made
from pictures.bodies import Body, board, cut, moved, part, potting, screws, show
from pictures.scene import Label, Scene

View = Callable[[Made, Path], None]
FROM_ABOVE = (0.7, -1.4, 1.3)
# Distance by which the mould is moved apart in the picture of demoulding, mm.
APART = 16.0


def exploded(made: Made, path: Path) -> None:
    """All parts of the sensor above each other."""
    scene = Scene((1.0, -1.7, 0.75))
    height = made.geometry.gel.size[2]
    places = [("lid", -34.0), ("board", -14.0), ("port-plate", 2.0), ("gel", 12.0), ("shell", 32.0 + height)]
    texts = {
        "lid": "lid, with nuts",
        "board": "board, chips up",
        "port-plate": "port plate",
        "gel": "gel (cast in place)",
        "shell": "shell",
    }
    edge = made.figures["outer_mm"][2]
    for name, up in places:
        bodies = board(made) if name == "board" else part(made, name)
        show(scene, moved(bodies, (0.0, 0.0, up)))
        reach = {
            "gel": made.geometry.gel.high[0],
            "board": made.geometry.board.high[0],
            "port-plate": made.geometry.board.high[0],
        }.get(name, edge)
        z = {"gel": height / 2, "shell": 0.0, "lid": made.figures["levels_mm"]["lid_bottom"] + 1.5}.get(
            name, made.geometry.board.top_z
        )
        scene.labels.append(Label(texts[name], (reach - 1.0, 0.0, z + up)))
    show(scene, moved(screws(made, "sensor"), (0.0, 0.0, 50.0 + height)))
    first = made.figures["screws"]["sensor"][-1]
    scene.labels.append(
        Label(f"{len(made.geometry.board.holes)} screws M2 x {first['length_mm']:g}", (*first["at_mm"], 48.0 + height))
    )
    scene.draw(path)


def _sensor(made: Made) -> list[Body]:
    names = ("gel", "port-plate", "shell", "lid")
    return [
        *board(made),
        *potting(made),
        *screws(made, "sensor"),
        *(body for name in names for body in part(made, name)),
    ]


def section(made: Made, path: Path) -> None:
    """The assembled sensor, cut along the first row of taxels."""
    y = made.geometry.taxels[0].at[1]
    scene = Scene((0.25, -1.0, 0.42))
    show(scene, cut(_sensor(made), (0.0, 1.0, 0.0), y))
    board_of, levels = made.geometry.board, made.figures["levels_mm"]
    x0, _, x1, _ = made.figures["outer_mm"]
    row = sorted(taxel.at[0] for taxel in made.geometry.taxels if taxel.at[1] == y)
    scene.labels += [
        Label("gel", (made.geometry.gel.high[0] - 3.0, y, made.geometry.gel.size[2] / 2)),
        Label("shell", (x1 - 1.0, y, 0.5)),
        Label("barometer", (row[-1], y, board_of.top_z / 2)),
        Label("board", (board_of.low[0] + 9.0, y, board_of.top_z - board_of.thickness / 2), "left"),
        Label("port plate", (made.geometry.gel.low[0] + 1.2, y, board_of.top_z / 2), "left"),
        Label("lid", (x1 - 4.0, y, (levels["lid_bottom"] + levels["lid_inside"]) / 2)),
        Label("potting", (row[0] - made.geometry.chip.body[0] / 2 - 0.15, y, board_of.top_z / 2), "left"),
    ]
    scene.draw(path)


def assembled(made: Made, path: Path) -> None:
    """The assembled sensor."""
    scene = Scene(FROM_ABOVE)
    show(scene, _sensor(made))
    scene.draw(path)


def bare_board(made: Made, path: Path) -> None:
    """Step 1: the soldered board."""
    scene = Scene(FROM_ABOVE)
    show(scene, board(made))
    top, chip = made.geometry.board.top_z, made.geometry.taxels[-1]
    scene.labels += [
        Label("port of a barometer", (*chip.at, 0.0)),
        Label("M2 hole", (*made.geometry.board.holes[-1], top)),
    ]
    scene.draw(path)


def plate_on(made: Made, path: Path) -> None:
    """Step 2: the port plate on the board."""
    scene = Scene(FROM_ABOVE)
    show(scene, board(made))
    show(scene, part(made, "port-plate"))
    scene.labels += [
        Label("hole around a chip", (*made.geometry.taxels[-1].at, 0.0)),
        Label("anchor hole", (*made.figures["anchors_at_mm"][1], 0.0)),
    ]
    scene.draw(path)


def mould_on(made: Made, path: Path) -> None:
    """Step 3: jig, board, port plate and the mould's halves."""
    scene = Scene(FROM_ABOVE)
    show(scene, board(made))
    for name in ("port-plate", "casting-jig", "mould-half-a", "mould-half-b"):
        show(scene, part(made, name))
    show(scene, screws(made, "casting")[: len(made.geometry.board.holes)])
    parting = made.figures["levels_mm"]["parting"]
    gel = made.geometry.gel
    scene.labels += [
        Label("half B", (gel.high[0] + 4.0, 9.0, parting)),
        Label("half A", (gel.low[0] - 4.0, -9.0, parting), "left"),
        Label("groove for a cable tie", (made.figures["outer_mm"][2] + 1.0, -8.0, parting / 2)),
        Label("jig", (gel.high[0] - 2.0, gel.low[1] - 11.0, -6.0)),
    ]
    scene.draw(path)


def filled(made: Made, path: Path) -> None:
    """Step 4: the closed mould, cut through its fill hole."""
    scene = Scene((0.3, -1.0, 0.5))
    bodies = [*board(made), *potting(made), *screws(made, "casting")]
    for name in ("port-plate", "casting-jig", "mould-half-a", "mould-half-b", "mould-cover", "gel"):
        bodies += part(made, name)
    fill, *vents = made.figures["channels"]
    y = fill["at_mm"][1]
    show(scene, cut(bodies, (0.0, 1.0, 0.0), y))
    cover = made.figures["levels_mm"]["cover"]
    scene.labels += [
        Label("fill hole: syringe", (fill["at_mm"][0], y, cover), "left" if fill["at_mm"][0] < 0 else "right"),
        Label("cover", (made.geometry.gel.high[0] + 5.0, y, cover - 2.0)),
        Label("vent", (*max((v["at_mm"] for v in vents), key=lambda at: at[0] + at[1]), cover)),
        Label("silicone", (made.geometry.gel.high[0] - 5.0, y, made.geometry.gel.size[2] / 3)),
        Label("jig", (made.geometry.gel.high[0] + 4.0, y, -8.0)),
    ]
    scene.draw(path)


def demoulded(made: Made, path: Path) -> None:
    """Step 5: the cover lifted, the halves moved apart along the diagonal."""
    scene = Scene((0.9, -1.5, 1.0))
    show(scene, board(made))
    for name in ("port-plate", "casting-jig", "gel"):
        show(scene, part(made, name))
    step = APART
    show(scene, moved(part(made, "mould-half-a"), (-step, -step, 0.0)))
    show(scene, moved(part(made, "mould-half-b"), (step, step, 0.0)))
    show(scene, moved(part(made, "mould-cover"), (0.0, 0.0, 24.0)))
    cover, parting = made.figures["levels_mm"]["cover"], made.figures["levels_mm"]["parting"]
    gel = made.geometry.gel
    scene.labels += [
        Label("1. cover up", (gel.high[0], gel.low[1] - 6.0, cover + 24.0)),
        Label("2. halves apart", (gel.low[0] - step, gel.low[1] - 4.0 - step, parting), "left"),
        Label("gel", (gel.high[0], gel.low[1], gel.size[2] / 3)),
    ]
    scene.draw(path)


def shell_on(made: Made, path: Path) -> None:
    """Step 6: the shell from above, the lid from below."""
    scene = Scene((1.0, -1.6, 0.7))
    show(scene, board(made))
    for name, up in (("port-plate", 0.0), ("gel", 0.0), ("shell", made.geometry.gel.size[2] + 8.0), ("lid", -14.0)):
        show(scene, moved(part(made, name), (0.0, 0.0, up)))
    show(scene, moved(screws(made, "sensor"), (0.0, 0.0, made.geometry.gel.size[2] + 26.0)))
    scene.draw(path)


def on_flange(made: Made, path: Path) -> None:
    """Step 7: the sensor on a robot's flange."""
    scene = Scene((1.0, -1.5, 1.1))
    show(scene, [*_sensor(made), *part(made, "flange-plate"), *screws(made, "flange")])
    scene.draw(path)


def on_jaw(made: Made, path: Path) -> None:
    """Step 7, alternative: the sensor on the mount for a gripper's jaw."""
    scene = Scene((1.0, -1.5, 0.6))
    show(scene, [*_sensor(made), *part(made, "jaw-mount"), *screws(made, "jaw")])
    scene.draw(path)


def indenters(made: Made, path: Path) -> None:
    """All indenters in a row, tips up."""
    scene = Scene((0.6, -1.6, 0.9))
    along = 0.0
    for each in made.geometry.indenters:
        body = part(made, f"indenter-{each.name}")[0]
        width = made.meshes[f"indenter-{each.name}"].extents[0]
        along += width / 2 + 4.0
        turned = Body(body.shape.rotate((180.0, 0.0, 0.0)), body.kind)
        show(scene, [turned.moved((along, 0.0, 0.0))])
        along += width / 2 + 4.0
    scene.draw(path)


def prints(made: Made, path: Path) -> None:
    """All printed parts side by side, as they lie on the bed."""
    scene = Scene((0.35, -1.2, 1.5))
    x = y = deepest = 0.0
    for number, name in enumerate(PRINTS):
        mesh = made.meshes[name]
        body = part(made, name)[0]
        if name in FACE_DOWN:
            body = Body(body.shape.rotate((180.0, 0.0, 0.0)), body.kind)
        low_x, low_y, low_z = body.shape.bounding_box()[:3]
        if number % 3 == 0:
            x, y, deepest = 0.0, y - deepest - 34.0, 0.0
        width, depth = mesh.extents[:2]
        show(scene, [body.moved((x - low_x, y - depth - low_y, -low_z))])
        scene.labels.append(Label(name, (x + width / 2, y - depth, 0.0), "below"))
        x, deepest = x + 72.0, max(deepest, depth)
    scene.draw(path)


def single(name: str) -> View:
    """A function that draws one print in its mounted orientation."""

    def draw(made: Made, path: Path) -> None:
        is_under = name in ("lid", "mould-cover", "flange-plate", "jaw-mount")
        scene = Scene((0.8, -1.4, -0.9) if is_under else FROM_ABOVE)
        show(scene, part(made, name))
        scene.draw(path)

    return draw


VIEWS: dict[str, View] = {
    "exploded": exploded,
    "section": section,
    "assembled": assembled,
    "step-1-board": bare_board,
    "step-2-port-plate": plate_on,
    "step-3-mould": mould_on,
    "step-4-fill": filled,
    "step-5-demould": demoulded,
    "step-6-shell": shell_on,
    "step-7-flange": on_flange,
    "step-7-jaw": on_jaw,
    "indenters": indenters,
}
PRINTS: tuple[str, ...] = (
    "port-plate",
    "shell",
    "lid",
    "mould-half-a",
    "mould-half-b",
    "mould-cover",
    "casting-jig",
    "flange-plate",
    "jaw-mount",
)
FACE_DOWN = ("port-plate", "shell", "flange-plate", "jaw-mount")
VIEWS["prints"] = prints
VIEWS |= {f"part-{name}": single(name) for name in PRINTS}
