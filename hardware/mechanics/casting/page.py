"""The casting sheet as a PDF page. The same input gives the same bytes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from reportlab.lib import colors
from reportlab.lib.pagesizes import A4
from reportlab.lib.units import mm
from reportlab.lib.utils import ImageReader
from reportlab.pdfgen.canvas import Canvas
from reportlab.platypus import Table, TableStyle

from casting.recipe import TEST_POUR_G, Recipe
from checks.files import Made

# Times for Ecoflex 00-30 and 00-31: stirring and curing as in the paper; pot life and density as
# quotations of the maker give them, not verified.
STEPS = (
    ("0:00", "Weigh A, then B into the same cup. Stir for 3 min; scrape walls and bottom."),
    ("0:04", "Degas until the foam has fallen: about -90 kPa, let air in twice, 5 to 10 min."),
    ("0:14", "Pour into the open mould until the port plate is covered by about 2 mm."),
    ("0:16", "Degas mould and rest of the cup: air leaves the chips' holes. No bubbles for 1 min: let air in slowly."),
    ("0:24", "Fill up to just below the rim. Put the cover on, four M3 screws finger-tight."),
    ("0:28", "Syringe in the fill hole: press until silicone without bubbles stands in every vent."),
    ("0:35", "Level, let stand. Pot life ends at about 0:45. Write down time and temperature."),
    (
        "4:30",
        "A thumb leaves no mark on the rest in the cup: demould. Cover up, cable tie off, halves apart diagonally.",
    ),
    ("24 h", "First calibration. Earlier, stiffness still changes."),
)


def _lines(recipe: Recipe) -> list[list[str]]:
    return [
        ["gel", f"{recipe.gel_mm3 / 1000:.2f} mL", f"{recipe.gel_g:.1f} g"],
        ["around chips and in anchors", f"{recipe.potting_mm3 / 1000:.2f} mL", f"{recipe.potting_g:.1f} g"],
        ["mix, with a reserve", f"{recipe.mixed_g / recipe.density_g_per_cm3:.1f} mL", f"{recipe.mixed_g:.0f} g"],
        ["part A", "", f"{recipe.each_g:.0f} g"],
        ["part B", "", f"{recipe.each_g:.0f} g"],
        ["test pour the day before", "", f"{TEST_POUR_G:.0f} g"],
    ]


def _screws(made: Made) -> str:
    counts: dict[str, int] = {}
    for screw in made.figures["screws"]["casting"]:
        name = f"{screw['thread']} x {screw['length_mm']:g}"
        counts[name] = counts.get(name, 0) + 1
    return ", ".join(f"{count} {name}" for name, count in counts.items())


def write_page(made: Made, recipe: Recipe, picture: Path, path: Path) -> None:
    """Writes the casting sheet as a PDF file."""
    canvas = Canvas(str(path), pagesize=A4, invariant=1)
    canvas.setTitle(f"Casting sheet, {made.geometry.variant}")
    width, height = A4
    left, y = 18 * mm, height - 20 * mm
    canvas.setFont("Helvetica-Bold", 17)
    canvas.drawString(left, y, f"Casting sheet: {made.geometry.variant}")
    canvas.setFont("Helvetica", 9)
    density = f"density {recipe.density_g_per_cm3:.2f} g/cm3 (read your product's sheet)."
    density = f"Ecoflex 00-31 or 00-30, A:B 1:1 by weight, {density}"
    canvas.drawString(left, y - 6 * mm, density)
    canvas.drawString(
        left,
        y - 10.5 * mm,
        "Nobody has cast this sensor yet. Nitrile or vinyl gloves, no latex. Glasses. No flame near release spray.",
    )
    y -= 16 * mm
    y = _table(canvas, _lines(recipe), (62 * mm, 26 * mm, 22 * mm), left, y, [(-2, 3), (-2, 4)])
    canvas.setFont("Helvetica", 9)
    canvas.drawString(
        left, y - 6 * mm, f"Screws of the mould: {_screws(made)}, each with a nut. One cable tie, at most 3.6 mm wide."
    )
    y -= 10 * mm
    rows = [[time, text, "[   ]"] for time, text in STEPS]
    y = _table(canvas, rows, (14 * mm, 148 * mm, 12 * mm), left, y, [])
    image = ImageReader(str(picture))
    pixels_x, pixels_y = image.getSize()
    drawn = min(width - 2 * left, (y - 40 * mm) * pixels_x / pixels_y)
    canvas.drawImage(image, left, y - 6 * mm - drawn * pixels_y / pixels_x, drawn, drawn * pixels_y / pixels_x)
    canvas.setFont("Helvetica", 9)
    for line, text in enumerate(
        (
            "Date, room temperature, batch of A and B:",
            "Weighed A, B:",
            "What was seen (bubbles, leaks, places that stay sticky):",
        )
    ):
        canvas.drawString(left, 28 * mm - line * 6 * mm, text)
        start = left + canvas.stringWidth(text, "Helvetica", 9) + 2 * mm
        canvas.line(start, 27.5 * mm - line * 6 * mm, width - left, 27.5 * mm - line * 6 * mm)
    canvas.showPage()
    canvas.save()


def _table(
    canvas: Canvas, rows: list[list[str]], widths: tuple[float, ...], left: float, y: float, bold: list[tuple[int, int]]
) -> float:
    """Draws a table below a height. Returns the height of its lower end."""
    made = Table(rows, colWidths=widths)
    style: list[tuple[Any, ...]] = [
        ("FONTSIZE", (0, 0), (-1, -1), 9),
        ("LINEBELOW", (0, 0), (-1, -1), 0.3, colors.grey),
        ("VALIGN", (0, 0), (-1, -1), "MIDDLE"),
    ]
    style += [("TOPPADDING", (0, 0), (-1, -1), 2.5), ("BOTTOMPADDING", (0, 0), (-1, -1), 2.5)]
    style += [("FONTNAME", (0, row), (-1, row), "Helvetica-Bold") for _, row in bold]
    made.setStyle(TableStyle(style))
    _, used = made.wrapOn(canvas, 500, 500)
    made.drawOn(canvas, left, y - used)
    return float(y - used)
