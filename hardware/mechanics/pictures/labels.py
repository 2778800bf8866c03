"""Labels beside a picture, each with a line to its object."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PIL import Image, ImageDraw, ImageFont

if TYPE_CHECKING:
    from pictures.scene import Label

MARGIN = 250
TEXT_SIZE, LINE_HEIGHT = 24, 40
INK, LINE = (28, 36, 48), (110, 118, 130)


def draw_labels(picture: Image.Image, labels: list[Label], points: list[tuple[float, float]]) -> Image.Image:
    """The picture with a margin on each side that has labels. Labels at the sides have the order of
    the heights of their points.
    """
    left = MARGIN if any(label.side == "left" for label in labels) else 0
    right = MARGIN if any(label.side == "right" for label in labels) else 0
    below = 2 * LINE_HEIGHT if any(label.side == "below" for label in labels) else 0
    wide = Image.new("RGB", (picture.width + left + right, picture.height + below), "white")
    wide.paste(picture, (left, 0))
    drawing = ImageDraw.Draw(wide)
    font = ImageFont.load_default(TEXT_SIZE)
    for label, (u, v) in zip(labels, points, strict=True):
        if label.side == "below":
            drawing.text(
                (left + u * picture.width, v * picture.height + 24), label.text, fill=INK, font=font, anchor="mt"
            )
    for side in ("left", "right"):
        mine = [
            (label, (left + u * picture.width, v * picture.height))
            for label, (u, v) in zip(labels, points, strict=True)
            if label.side == side
        ]
        mine.sort(key=lambda pair: pair[1][1])
        heights = _spread([at[1] for _, at in mine], wide.height)
        for (label, at), y in zip(mine, heights, strict=True):
            width = drawing.textlength(label.text, font=font)
            x = left - 20 - width if side == "left" else wide.width - right + 20
            end = left - 12 if side == "left" else x - 8
            drawing.line([(end, y), at], fill=LINE, width=2)
            drawing.ellipse([at[0] - 4, at[1] - 4, at[0] + 4, at[1] + 4], fill=INK)
            drawing.text((x, y), label.text, fill=INK, font=font, anchor="lm")
    return wide


def _spread(heights: list[float], height: int) -> list[float]:
    """Heights in the same order, moved apart so that the lines of text do not overlap."""
    spread: list[float] = []
    for at in heights:
        spread.append(max(at, spread[-1] + LINE_HEIGHT if spread else LINE_HEIGHT / 2))
    over = spread[-1] - (height - LINE_HEIGHT / 2) if spread else 0.0
    return [at - max(over, 0.0) for at in spread]
