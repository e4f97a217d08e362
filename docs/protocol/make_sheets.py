#!/usr/bin/python3
"""Draws the sheets of the measuring protocol: A4, to be printed at 100 %.

usage: docs/protocol/make_sheets.py [FOLDER]        default: the folder of this script

A test compares the sheets in the repository with what this script draws.
"""

import math
import sys
from pathlib import Path

PAGE = (210, 297)
ANGLES = (0, 15, 30, 45, 60, 75, 90)

STYLE = """
    .cut { fill: none; stroke: #000; stroke-width: 0.3 }
    .clamp { fill: #e4e4e4; stroke: none }
    .mark { fill: none; stroke: #000; stroke-width: 0.2 }
    .fine { fill: none; stroke: #9a9a9a; stroke-width: 0.1 }
    .axis { fill: none; stroke: #c02020; stroke-width: 0.5 }
    .head { fill: #c02020; stroke: none }
    text { font-family: "DejaVu Sans", Arial, sans-serif; font-size: 3.2px; fill: #000 }
    .title { font-size: 6px; font-weight: bold }
    .small { font-size: 2.6px }
    .red { fill: #c02020 }
"""


def number(value):
    """Short, and the same on every machine."""
    return f"{value:.3f}".rstrip("0").rstrip(".") if value else "0"


class Sheet:
    def __init__(self, title, lines):
        self.parts = []
        self.text(12, 17, title, "title")
        for i, line in enumerate(lines):
            self.text(12, 24 + 4.6 * i, line)
        self.check_ruler()

    def add(self, element):
        self.parts.append("  " + element)

    def text(self, x, y, content, css=None, anchor="start", turn=0):
        content = content.replace("&", "&amp;").replace("<", "&lt;")
        css = f' class="{css}"' if css else ""
        turn = f' transform="rotate({number(turn)} {number(x)} {number(y)})"' if turn else ""
        self.add(f'<text x="{number(x)}" y="{number(y)}" text-anchor="{anchor}"{css}{turn}>{content}</text>')

    def box(self, x, y, width, height, css):
        self.add(
            f'<rect class="{css}" x="{number(x)}" y="{number(y)}" width="{number(width)}" height="{number(height)}"/>'
        )

    def line(self, x1, y1, x2, y2, css="mark"):
        self.add(f'<path class="{css}" d="M{number(x1)} {number(y1)}L{number(x2)} {number(y2)}"/>')

    def axis_arrow(self, x, y, angle_deg, length):
        """The fabric's first axis: an arrow from (x, y), `angle_deg` anticlockwise from "up"."""
        turn = math.radians(angle_deg)
        dx, dy = -math.sin(turn), -math.cos(turn)
        tip = (x + length * dx, y + length * dy)
        self.line(x, y, tip[0] - 2 * dx, tip[1] - 2 * dy, "axis")
        corners = [tip, (tip[0] - 3 * dx - 1.1 * dy, tip[1] - 3 * dy + 1.1 * dx)]
        corners.append((tip[0] - 3 * dx + 1.1 * dy, tip[1] - 3 * dy - 1.1 * dx))
        self.add('<path class="head" d="M' + "L".join(f"{number(px)} {number(py)}" for px, py in corners) + 'Z"/>')

    def check_ruler(self):
        x, y = 12, 286
        self.line(x, y, x + 100, y)
        for i in range(0, 101, 10):
            self.line(x + i, y, x + i, y - (3 if i % 50 == 0 else 1.5))
        self.text(x + 103, y + 1, "Exactly 100 mm on paper? If not, print at 100 %.", "small")

    def svg(self):
        width, height = PAGE
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm"'
            f' viewBox="0 0 {width} {height}">\n  <style>{STYLE}  </style>\n'
            f'  <rect width="{width}" height="{height}" fill="#fff"/>\n' + "\n".join(self.parts) + "\n</svg>\n"
        )


def clamped_piece(sheet, x, y, width, free, tab):
    """A piece with tabs for the clamps above and below its free length."""
    sheet.box(x, y, width, tab, "clamp")
    sheet.box(x, y + tab + free, width, tab, "clamp")
    sheet.box(x, y, width, free + 2 * tab, "cut")
    sheet.line(x, y + tab, x + width, y + tab)
    sheet.line(x, y + tab + free, x + width, y + tab + free)


def tension_strips():
    sheet = Sheet(
        "Tension: strips of 20 x 110 mm",
        [
            "Cut the paper strips out, lay each on the relaxed fabric so that its red arrow points along the fabric's first",
            "axis, draw around it, cut. Clamps hold the grey tabs, edges on the lines: 110 mm of fabric stay free.",
            "Mark the middle line on the fabric with a soft pen: the width is measured there.",
        ],
    )
    width, free, tab, top = 20, 110, 20, 50
    for i, angle in enumerate(ANGLES):
        x = 14 + 26.5 * i
        clamped_piece(sheet, x, top, width, free, tab)
        middle = top + tab + 0.5 * free
        sheet.line(x, middle, x + width, middle)
        sheet.text(x + 0.5 * width, top - 2, f"{angle}°", anchor="middle")
        sheet.text(x + 0.5 * width, top + 11, f"clamp {angle}°", "small", "middle")
        sheet.text(x + 0.5 * width, top + tab + free + 11, "clamp", "small", "middle")
        sheet.text(x + 0.5 * width, middle - 1.2, "width here", "small", "middle")
        # The pull is upwards; the first axis lies `angle` clockwise of it, so that the pull is at +angle from it.
        start = x + 0.5 * width - 8 * math.sin(math.radians(angle))
        sheet.axis_arrow(start, top + tab + 30 + 8 * math.cos(math.radians(angle)), -angle, 16)
        sheet.text(x + 0.5 * width, top + tab + 44, "first axis", "small red", "middle")
    sheet.text(12, 212, "0° is a strip along the first axis, 90° one along the second. All seven make a full test; 0°, 45° and 90° are the least.")
    sheet.text(12, 217, "The first axis is yours to choose, and to keep: along the wales (the visible ribs) of a knit, if you can see them.")
    sheet.text(12, 222, "The pull is at the given angle from the arrow, anticlockwise, with the side you print on facing you.")
    sheet.text(12, 235, "Notes, per strip: relaxed length and width as cut, to 0.5 mm")
    for i, angle in enumerate(ANGLES):
        y = 243 + 5.4 * i
        sheet.text(14, y, f"{angle}°")
        sheet.line(26, y + 0.8, 76, y + 0.8, "fine")
        sheet.text(78, y, "mm long", "small")
        sheet.line(96, y + 0.8, 146, y + 0.8, "fine")
        sheet.text(148, y, "mm wide", "small")
    return sheet.svg()


def shear_squares():
    sheet = Sheet(
        "Shear: squares of 60 x 60 mm",
        [
            "One square with the first axis from clamp to clamp (0°), one with it along the clamps (90°). Clamps hold the grey tabs.",
            "The clamps stay parallel, 60 mm apart; one moves sideways, up to 18 mm. Write down the force for each millimetre,",
            "on the way out and on the way back, three times. The sides between the clamps stay free.",
        ],
    )
    side, tab, top = 60, 20, 48
    for i, angle in enumerate((0, 90)):
        x = 25 + 85 * i
        clamped_piece(sheet, x, top, side, side, tab)
        sheet.text(x + side / 2, top - 2, f"{angle}°", anchor="middle")
        sheet.text(x + side / 2, top + 11, "clamp (moves sideways)", "small", "middle")
        sheet.text(x + side / 2, top + tab + side + 11, "clamp (stays)", "small", "middle")
        length = 24
        start = (x + side / 2, top + tab + 42) if angle == 0 else (x + side / 2 - length / 2, top + tab + 30)
        sheet.axis_arrow(*start, -angle, length)
        sheet.text(x + side / 2, top + tab + 50, "first axis", "small red", "middle")
    y = 172
    sheet.text(12, y, "Scale for the moving clamp: glue it to the fixed base, read at the clamp's edge")
    left = 85
    for mm in range(-20, 21):
        height = 7 if mm % 10 == 0 else 5 if mm % 5 == 0 else 3
        sheet.line(left + 20 + mm, y + 8, left + 20 + mm, y + 8 + height)
        if mm % 10 == 0:
            sheet.text(left + 20 + mm, y + 19, str(mm), "small", "middle")
    sheet.line(left, y + 8, left + 40, y + 8)
    for i, line in enumerate(
        [
            "Without a machine: screw the lower clamp (two slats) to a board. Let the upper clamp slide along a straight edge that",
            "keeps it 60 mm away (a drawer runner, two rulers as rails), pull it by a thread over the board's rounded edge with",
            "weights, and read the scale. Friction of the rail is measured with the same weights and no fabric, and subtracted.",
            "If that cannot be built: leave the shear test out. Strips at 30°, 45° and 60° shear as well, and the joint fit takes",
            "the shear stiffness from them, with a wider interval.",
        ]
    ):
        sheet.text(12, 204 + 4.8 * i, line)
    return sheet.svg()


def cantilever():
    sheet = Sheet(
        "Bending: strips of 20 mm that hang over an edge",
        [
            "Cut one strip along each axis. Push it over the table's edge under a ruler until its free length is at a line, wait 30 s,",
            "and read on the scale, which stands upright behind the strip with its corner at the edge of the table, how far the tip",
            "reaches (x) and how far it hangs (y). Each length: front side up, then back side up.",
        ],
    )
    for i, angle in enumerate((0, 90)):
        x, top = 14 + 27 * i, 50
        sheet.box(x, top, 20, 30, "clamp")
        sheet.box(x, top, 20, 130, "cut")
        sheet.text(x + 10, top - 2, f"{angle}°", anchor="middle")
        sheet.text(x + 10, top + 8, "on the table,", "small", "middle")
        sheet.text(x + 10, top + 12, "below a ruler", "small", "middle")
        for mm in range(30, 101, 10):
            sheet.line(x, top + 130 - mm, x + 20, top + 130 - mm)
            sheet.text(x + 19, top + 130 - mm - 1, f"{mm} mm", "small", "end")
        if angle == 0:
            sheet.axis_arrow(x + 4, top + 125, 0, 20)
        else:
            sheet.axis_arrow(x + 2, top + 118, -90, 16)
        sheet.text(x + 10, top + 128, "first axis", "small red", "middle")
    left, top, size = 82, 56, 110
    sheet.text(left, top - 6, "table's edge here; x: reach, mm", "small")
    for mm in range(0, size + 1, 2):
        css = "mark" if mm % 10 == 0 else "fine"
        sheet.line(left + mm, top, left + mm, top + size, css)
        sheet.line(left, top + mm, left + size, top + mm, css)
        if mm % 10 == 0:
            sheet.text(left + mm, top - 1.5, str(mm), "small", "middle")
            if mm:
                sheet.text(left - 1.5, top + mm + 1, str(mm), "small", "end")
    sheet.text(left - 8, top + 55, "y: drop, mm", "small", "middle", -90)
    sheet.text(12, 196, "Readings, mm: the first strip that hangs by about a third of its length is long enough; the longest may hang steeply.")
    columns = ["length", "0° front x", "y", "0° back x", "y", "90° front x", "y", "90° back x", "y"]
    for j, name in enumerate(columns):
        sheet.text(14 + 20.5 * j, 204, name, "small")
    for i, length in enumerate((30, 40, 50, 60, 70, 80, 90, 100)):
        y = 212 + 7 * i
        sheet.text(14, y, str(length))
        for j in range(1, 9):
            sheet.line(14 + 20.5 * j, y + 0.8, 14 + 20.5 * j + 16, y + 0.8, "fine")
    return sheet.svg()


def printed_strips():
    """A drawing for `ruche simulate` and the printer: layer "fabric", and one layer per thickness."""
    rows = [("h06", "0.6", "#1f77b4"), ("h08", "0.8", "#2ca02c"), ("h10", "1.0", "#d62728")]
    parts = []
    for r, (layer, thickness, colour) in enumerate(rows):
        strips = []
        for k in range(3):
            x, y = 15 + 50 * k, 20 + 24 * r
            strips.append(
                f'    <path id="strip-{thickness}-{k + 1}" fill="none" stroke="{colour}" stroke-width="3"'
                f' stroke-linecap="butt" d="M{x} {y}H{x + 40}"/>'
            )
        body = "\n".join(strips)
        parts.append(f'  <g id="{layer}" inkscape:groupmode="layer" inkscape:label="{layer}">\n{body}\n  </g>')
    layers = "\n".join(parts)
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
        ' width="170mm" height="88mm" viewBox="0 0 170 88">\n'
        '  <g id="fabric" inkscape:groupmode="layer" inkscape:label="fabric">\n'
        '    <rect id="outline" x="5" y="8" width="160" height="72" fill="none" stroke="#888" stroke-width="0.2"/>\n'
        "  </g>\n" + layers + "\n</svg>\n"
    )


SHEETS = {
    "tension-strips.svg": tension_strips,
    "shear-squares.svg": shear_squares,
    "cantilever.svg": cantilever,
    "printed-strips.svg": printed_strips,
}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for name, draw in SHEETS.items():
        (folder / name).write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    main()
