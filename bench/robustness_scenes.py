"""The scenes of bench/robustness.py: ten families of patterns, each over printed thickness, pre-stretch and mesh size.

A scene is a name and the text of a scene file; drawings and curves stand beside it as files. Sizes are chosen so that
a scene has about 1,000 to 5,000 triangles, thin plastic (which needs small elements) included. Everything comes from
fixed seeds: the same scenes every time and everywhere.
"""

import itertools
import math
import random

THICKNESSES = (0.2, 0.4, 0.6, 0.9, 1.2)  # mm
PRESTRETCHES = (1.2, 1.45, 1.7)
MESH_SIZES = (1.0, 1.3, 1.7)  # mm, each with every thickness and every pre-stretch
# Drawings of random strips that are drawn anew for every thickness and pre-stretch.
RANDOM_FAMILIES = {"random-sparse": 5, "random-dense": 12}  # strips


def strip(thickness, **_):
    # Narrow and in fabric where it is thick, wide and without fabric where it is thin: both may roll in two ways.
    if thickness < 0.5:
        return 'generator = "strip"\noptions = { length_mm = 30, width_mm = 3 }', "margin_mm = 0"
    return 'generator = "strip"\noptions = { length_mm = 80, width_mm = 2 }', "margin_mm = 5"


def staggered(thickness, **_):
    rows, length = (4, 8) if thickness < 0.3 else (7, 12)
    return (
        f'generator = "staggered"\noptions = {{ rows = {rows}, length_mm = {length}, strips_per_row = 2 }}',
        "margin_mm = 1",
    )


def torus(thickness, **_):
    if thickness < 0.3:
        rings = 'inner_mm = 6, outer_mm = 13, rings = "6:10, 8.5:10"'
    else:
        rings = 'inner_mm = 9, outer_mm = 22, rings = "9:14, 12:14, 16:28"'
    return f'generator = "radial"\noptions = {{ {rings} }}', 'outline = "fabric"'


def bell(thickness, **_):
    size = "inner_mm = 6, outer_mm = 14" if thickness < 0.3 else "inner_mm = 8, outer_mm = 22"
    return f'generator = "radial"\noptions = {{ {size}, rings = "8:14" }}', 'outline = "fabric"'


def stars(thickness, **_):
    radius = 12 if thickness < 0.3 else 15
    return f'generator = "stars"\noptions = {{ radius_mm = {radius} }}', 'outline = "fabric"'


def hexagons_outlined(thickness, **_):
    radius = 10 if thickness < 0.3 else 18
    return f'generator = "hexagons"\noptions = {{ radius_mm = {radius} }}', 'outline = "fabric"'


def hexagons_filled(thickness, **_):
    radius = 10 if thickness < 0.3 else 18
    return (
        f'generator = "hexagons"\noptions = {{ style = "filled", radius_mm = {radius} }}',
        'outline = "fabric"',
    )


def curve_network(folder, name, thickness, **_):
    """Two families of waves that cross, with wide openings between them."""
    half = 9.0 if thickness < 0.3 else 15.0
    curves = []
    for place in (-0.6, 0.0, 0.6):
        steps = [half * (i / 20 - 1) for i in range(41)]
        wave = [(t, half * place + 0.08 * half * math.sin(4 * t / half + 3 * place)) for t in steps]
        curves += [wave, [(y, x) for x, y in wave]]
    text = "\n\n".join("\n".join(f"{x:.6f}, {y:.6f}" for x, y in curve) for curve in curves)
    (folder / f"{name}.csv").write_text(text + "\n")
    return f'generator = "curves"\noptions = {{ file = "{name}.csv" }}', "margin_mm = 2"


def random_strips(folder, name, thickness, count, **_):
    """Straight strips of random place, direction, length and width on a rectangle of fabric."""
    draw = random.Random(name)
    width, height = (18.0, 14.0) if thickness < 0.3 else (36.0, 28.0)
    lines = []
    for i in range(count):
        x, y = draw.uniform(2, width - 2), draw.uniform(2, height - 2)
        angle, half = draw.uniform(0, math.pi), draw.uniform(0.12, 0.3) * width
        dx, dy = half * math.cos(angle), half * math.sin(angle)
        ends = [
            min(max(c, 1.2), size - 1.2)
            for c, size in ((x - dx, width), (y - dy, height), (x + dx, width), (y + dy, height))
        ]
        lines.append(
            '<path id="s{}" stroke-width="{:.2f}" d="M {:.4f} {:.4f} L {:.4f} {:.4f}"/>'.format(
                i, draw.uniform(0.8, 2.0), *ends
            )
        )
    (folder / f"{name}.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">'
        f'<g id="fabric" fill="none" stroke="grey"><path d="M 0 0 H {width} V {height} H 0 Z"/></g>'
        f'<g fill="none" stroke="black">{"".join(lines)}</g></svg>\n'
    )
    return f'svg = "{name}.svg"', 'outline = "fabric"'


FAMILIES = {
    "strip": strip,
    "staggered": staggered,
    "torus": torus,
    "bell": bell,
    "stars": stars,
    "hexagons-outlined": hexagons_outlined,
    "hexagons-filled": hexagons_filled,
    "curves": curve_network,
    **{family: random_strips for family in RANDOM_FAMILIES},
}


def write_scenes(folder):
    """Writes all scene files into a folder; yields (family, name, path)."""
    for f, (family, draw) in enumerate(FAMILIES.items()):
        for (i, thickness), (k, prestretch) in itertools.product(enumerate(THICKNESSES), enumerate(PRESTRETCHES)):
            size = MESH_SIZES[(f + i + k) % len(MESH_SIZES)]
            name = f"{family}-h{thickness}-s{prestretch}-m{size}"
            pattern, fabric = draw(
                folder=folder, name=name, thickness=thickness, count=RANDOM_FAMILIES.get(family)
            )
            path = folder / f"{name}.toml"
            path.write_text(
                f"[pattern]\n{pattern}\n[fabric]\nprestretch = {prestretch}\n{fabric}\n"
                f"[plastic]\nthickness_mm = {thickness}\n"
                f"[mesh]\nsize_mm = {size}\nfabric_size_mm = {2 * size}\n"
            )
            yield family, name, path
