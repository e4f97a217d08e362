#!/usr/bin/python3
"""Fig. 7 of the paper: what clamped samples at seven angles pull with, as the simulator has it.

usage: bench/figure7.py FOLDER [--card CARD] [--prestretch S]

Runs `ruche virtual-test` (build/release/ruche, or RUCHE_PROGRAM) into FOLDER, prints a table of forces and draws
FOLDER/figure7.svg. The measured points of the paper's figure stand only in its picture, so they are not here.
"""

import argparse
import json
import os
import subprocess
from pathlib import Path

PROGRAM = os.environ.get("RUCHE_PROGRAM", Path(__file__).parents[1] / "build/release/ruche")
WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 620, 420, 60, 20, 90, 50
COLOURS = ("#1b3a6b", "#1f77b4", "#17a2b8", "#2ca02c", "#bcaa22", "#ff7f0e", "#d62728")


def at(curve, strain, length):
    """Force at a strain, along the straight line between two simulated points."""
    displacement = strain * length
    points = list(zip(curve["displacement_mm"], curve["force_N"]))
    for (d0, f0), (d1, f1) in zip(points, points[1:]):
        if d0 <= displacement <= d1 + 1e-9:
            return f0 + (f1 - f0) * (displacement - d0) / (d1 - d0)
    raise ValueError(f"no point at strain {strain}")


def print_table(curves, samples):
    length, largest = samples["length_mm"], samples["prestretch"] - 1.0
    strains = [round(largest * i / 7, 4) for i in range(1, 8)]
    print("| angle | " + " | ".join(f"{100 * strain:g} %" for strain in strains) + " | width at the end, mm |")
    print("|---" * (len(strains) + 2) + "|")
    for curve in curves:
        forces = " | ".join(f"{at(curve, strain, length):.4f}" for strain in strains)
        print(f"| {curve['angle_deg']:g}° | {forces} | {curve['width_mm'][-1]:.2f} |")


def tick_step(largest):
    return next(step for step in (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100) if largest / step <= 7)


def plot(curves, samples):
    length = samples["length_mm"]
    most_strain = samples["prestretch"] - 1.0
    most_force = max(curve["force_N"][-1] for curve in curves)

    def place(strain, force):
        x = LEFT + strain / most_strain * (WIDTH - LEFT - RIGHT)
        y = HEIGHT - BOTTOM - force / most_force * (HEIGHT - TOP - BOTTOM)
        return f"{x:.2f} {y:.2f}"

    parts = []

    def grid(step, largest, line, label, unit_factor):
        for i in range(int(largest / step + 1e-9) + 1):
            parts.append(f'<path class="grid" d="{line(i * step)}"/>')
            parts.append(label(i * step, f"{unit_factor * i * step:g}"))

    def label_x(value, text):
        x, y = place(value, 0).split()
        return f'<text x="{x}" y="{float(y) + 18}" text-anchor="middle">{text}</text>'

    def label_y(value, text):
        x, y = place(0, value).split()
        return f'<text x="{float(x) - 8}" y="{float(y) + 4}" text-anchor="end">{text}</text>'

    grid(tick_step(most_strain), most_strain, lambda s: f"M{place(s, 0)}L{place(s, most_force)}", label_x, 100)
    grid(tick_step(most_force), most_force, lambda f: f"M{place(0, f)}L{place(most_strain, f)}", label_y, 1)
    labels = []
    for curve, colour in zip(curves, COLOURS):
        line = "L".join(place(d / length, f) for d, f in zip(curve["displacement_mm"], curve["force_N"]))
        parts.append(f'<path class="curve" stroke="{colour}" d="M{line}"/>')
        x, y = place(curve["displacement_mm"][-1] / length, curve["force_N"][-1]).split()
        labels.append([float(y) + 4, f"{curve['angle_deg']:g}°", colour])
    labels.sort()
    for before, label in zip(labels, labels[1:]):
        label[0] = max(label[0], before[0] + 14)  # not on top of each other
    for y, text, colour in labels:
        parts.append(f'<text x="{WIDTH - RIGHT + 8}" y="{y:.2f}" fill="{colour}">{text}</text>')
    size = f"{length:g} x {samples['width_mm']:g} mm"
    parts.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" text-anchor="middle">strain, %  (clamped sample of {size})</text>')
    parts.append(f'<text transform="translate(18 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">force, N</text>')
    style = (
        "text { font-family: 'DejaVu Sans', Arial, sans-serif; font-size: 12px }"
        " .grid { stroke: #ddd; fill: none } .curve { fill: none; stroke-width: 2 }"
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}">\n'
        f'<style>{style}</style>\n<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--card", default="spandex-tpu95a")
    parser.add_argument("--prestretch", default="1.7")
    arguments = parser.parse_args()
    subprocess.run(
        [PROGRAM, "virtual-test", arguments.card, "-o", arguments.folder, "--tests=tension"]
        + [f"--prestretch={arguments.prestretch}"],
        check=True,
    )
    data = json.loads((arguments.folder / "curves.json").read_text())
    print_table(data["curves"], data["samples"])
    (arguments.folder / "figure7.svg").write_text(plot(data["curves"], data["samples"]), encoding="utf-8")


if __name__ == "__main__":
    main()
