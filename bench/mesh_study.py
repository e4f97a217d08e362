#!/usr/bin/python3
"""How far is the curvature of a strip on the default mesh from that of a converged one?

usage: bench/mesh_study.py [FILE.json] [--thicknesses 0.6,1.0] [--widths 1,2,3,5,8,10] [--margins 0,5]

Each strip is released on the default mesh and on meshes with a half and a quarter of all its element sizes (plastic
and fabric). The table shows the curvature of the centre line and its distance from the one on the finest mesh. Needs
the Python module: PYTHONPATH=build/release/python.

A wide thin strip may also roll across its width, another stable shape with an almost straight centre line. Like is
compared with like: a row whose shapes differ by more than 2 % in energy is marked and not counted. The program ends
with 1 when a default mesh is off by more than 1 %.
"""

import argparse
import json
import sys
import tempfile
from pathlib import Path

import ruche

SCENE = """
[pattern]
generator = "strip"
[pattern.options]
length_mm = {length}
width_mm = {width}
[fabric]
prestretch = 1.7
margin_mm = {margin}
[plastic]
thickness_mm = {thickness}
[mesh]
size_mm = {size}
elements_across = {across}
fabric_size_mm = {fabric_size}
"""
REFINEMENTS = (1, 2, 4)
ALLOWED = 0.01
SAME_SHAPE = 0.02


def release(folder, strip, refinement):
    scene = Path(folder) / "strip.toml"
    scene.write_text(
        SCENE.format(**strip, size=1.0 / refinement, across=1.0 * refinement, fabric_size=2.0 / refinement)
    )
    report = ruche.simulate(str(scene)).report
    measured = report["strips"][0]
    return {
        "refinement": refinement,
        "triangles": report["mesh"]["triangles"],
        "curvature_per_mm": measured["curvature_per_mm"],
        "fit_rms_mm": measured["fit_rms_mm"],
        "energy_mJ": report["energy_mJ"]["total"],
        "certain": report["status"] == "converged" and report["stable"],
    }


def study(strip):
    with tempfile.TemporaryDirectory() as folder:
        runs = [release(folder, strip, refinement) for refinement in REFINEMENTS]
    finest = runs[-1]
    for run in runs:
        run["error"] = run["curvature_per_mm"] / finest["curvature_per_mm"] - 1
    same = all(abs(run["energy_mJ"] / finest["energy_mJ"] - 1) < SAME_SHAPE for run in runs)
    return {**strip, "runs": runs, "comparable": same and all(run["certain"] for run in runs)}


def numbers(text):
    return [float(number) for number in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default="build/mesh_study.json")
    parser.add_argument("--thicknesses", type=numbers, default=[0.6, 1.0])
    parser.add_argument("--widths", type=numbers, default=[1, 2, 3, 5, 8, 10])
    parser.add_argument("--margins", type=numbers, default=[0, 5])
    arguments = parser.parse_args()

    print("margin  h_p  width  triangles: default, half, quarter    curvature /mm     default    half")
    strips = []
    for margin in arguments.margins:
        for thickness in arguments.thicknesses:
            for width in arguments.widths:
                length = max(30.0, 6.0 * width)
                strip = study({"length": length, "width": width, "margin": margin, "thickness": thickness})
                strips.append(strip)
                runs = strip["runs"]
                print(
                    f"{margin:6g} {thickness:4g} {width:6g}  "
                    + "".join(f"{run['triangles']:8d}" for run in runs)
                    + f"  {runs[-1]['curvature_per_mm']:22.5f}  {runs[0]['error']:+10.2%} {runs[1]['error']:+7.2%}"
                    + ("" if strip["comparable"] else "  not comparable"),
                    flush=True,
                )
    Path(arguments.file).write_text(json.dumps({"strips": strips}, indent=1) + "\n")
    compared = [strip for strip in strips if strip["comparable"]]
    worst = max(abs(strip["runs"][0]["error"]) for strip in compared)
    print(f"{len(compared)} of {len(strips)} strips compared; the default is off by at most {worst:.2%}")
    print(f"written: {arguments.file}")
    return 0 if len(compared) == len(strips) and worst <= ALLOWED else 1


if __name__ == "__main__":
    sys.exit(main())
