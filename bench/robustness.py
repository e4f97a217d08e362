#!/usr/bin/python3
"""Does every scene end in a certified minimum, and do other seeds find the same one?

usage: bench/robustness.py [FILE.json] [--only TEXT] [--jobs 2] [--seeds 1,2,3] [--fresh]

Releases the 150 scenes of robustness_scenes.py from three seeds each and writes what came of them to FILE
(build/robustness.json). The file is written after each scene; scenes that are in it already are not run again, so the
suite can be stopped and go on later; --fresh begins anew. Needs the Python module:
PYTHONPATH=build/release/python.

A line per scene: triangles; for each seed c (converged), s (certified stable) or what it is instead; iterations and
factorisations on the finest mesh (all seeds); energies; which seeds end in the same state. Two states are the same when
their shapes agree to 1e-3 mm (rms) after a rigid motion, never because their energies do; but then their energies must
agree to 1e-8. Several different states of a scene are no failure: crumpling patterns have many minima.

The program ends with 1 when fewer than 97 % of the runs are converged and stable, when one is tangled, or when equal
shapes have different energies.
"""

import argparse
import json
import math
import multiprocessing
import os
import sys
import tempfile
from pathlib import Path

import numpy

import ruche
from robustness_scenes import write_scenes

ENOUGH = 0.97
SAME_SHAPE = 1e-3  # mm
SAME_ENERGY = 1e-8


def distance(shape, other):
    """Root mean square distance between two shapes after the best rigid motion (Kabsch), mm."""
    a, b = shape - shape.mean(axis=0), other - other.mean(axis=0)
    u, _, v = numpy.linalg.svd(a.T @ b)
    u[:, 2] *= math.copysign(1.0, numpy.linalg.det(u @ v))
    return float(numpy.sqrt(((a @ (u @ v) - b) ** 2).sum(axis=1).mean()))


def release(path, seed):
    try:
        result = ruche.simulate(str(path), [f"solver.seed={seed}", "solver.threads=1"])
    except (ValueError, RuntimeError) as error:
        return {"seed": seed, "status": "refused", "stable": False, "message": str(error)}, None
    report = result.report
    run = {
        "seed": seed,
        "status": report["status"],
        "stable": report["stable"],
        "message": report["message"],
        "triangles": report["mesh"]["triangles"],
        "energy_mJ": report["energy_mJ"]["total"],
        "residual_N": report["residual_N"],
        "seconds": report["solver"]["seconds"],
        "levels": report["solver"]["levels"],
        "health": {k: v for k, v in report["health"].items() if k != "self_intersection_places"},
        "warnings": report["warnings"],
    }
    return run, result.positions


def states_of(runs, shapes):
    """Numbers the distinct states; and the largest relative difference in energy between equal shapes."""
    firsts, spread = [], 0.0
    for run, shape in zip(runs, shapes):
        if not certain(run):
            continue
        for first in firsts:
            if distance(shapes[first], shape) < SAME_SHAPE:
                run["state"] = firsts.index(first)
                spread = max(spread, abs(run["energy_mJ"] / runs[first]["energy_mJ"] - 1))
                break
        else:
            run["state"] = len(firsts)
            firsts.append(runs.index(run))
    return len(firsts), spread


def certain(run):
    return run["status"] == "converged" and run["stable"]


def tangled(run):
    return bool(run.get("health", {}).get("tangled"))


def study(task):
    name, path, seeds = task
    runs, shapes = zip(*(release(path, seed) for seed in seeds))
    states, spread = states_of(runs, shapes)
    return name, {"runs": runs, "states": states, "energy_spread": spread}


def line_of(name, scene):
    runs = scene["runs"]

    def verdict(run):
        return "cs" if certain(run) else {"converged": "c-", "not_converged": "--"}.get(run["status"], run["status"])

    def finest(key):
        return "/".join(str(run["levels"][-1][key]) if run.get("levels") else "-" for run in runs)

    return (
        f"{name:38} {runs[0].get('triangles', 0):6d} {' '.join(verdict(run) for run in runs)}"
        f"  it {finest('iterations'):12} fact {finest('factorizations'):12} levels {len(runs[0].get('levels', []))}"
        f"  {sum(run.get('seconds', 0) for run in runs):6.1f} s  states {scene['states']}  "
        + " ".join(f"{run.get('energy_mJ', math.nan):.9g}" for run in runs)
        + "".join(f"\n    seed {run['seed']}: {run['message']}" for run in runs if not certain(run) or tangled(run))
        + (f"\n    equal shapes differ in energy by {scene['energy_spread']:.1e}" if unequal(scene) else "")
    )


def unequal(scene):
    return scene["energy_spread"] > SAME_ENERGY


def write(path, scenes):
    pending = path.with_suffix(".part")
    pending.write_text(json.dumps({"scenes": scenes}, indent=1) + "\n")
    os.replace(pending, path)


def summary(scenes):
    runs = [run for scene in scenes.values() for run in scene["runs"]]
    good = sum(certain(run) and not tangled(run) for run in runs)
    knots = sum(tangled(run) for run in runs)
    split = sum(unequal(scene) for scene in scenes.values())
    several = sum(scene["states"] > 1 for scene in scenes.values())
    print(
        f"{len(scenes)} scenes, {len(runs)} runs: {good} ({good / max(1, len(runs)):.2%}) converged and certified stable, "
        f"{knots} tangled; {several} scenes with more than one state; {split} with equal shapes of different energy"
    )
    return bool(runs) and good >= ENOUGH * len(runs) and knots == 0 and split == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default="build/robustness.json", type=Path)
    parser.add_argument("--only", default="", help="scenes whose name contains this")
    parser.add_argument("--jobs", type=int, default=2, help="scenes at a time, one thread each")
    parser.add_argument("--seeds", type=lambda text: [int(seed) for seed in text.split(",")], default=[1, 2, 3])
    parser.add_argument("--fresh", action="store_true", help="run again what the file holds")
    arguments = parser.parse_args()

    known = {}
    if arguments.file.exists() and not arguments.fresh:
        known = json.loads(arguments.file.read_text())["scenes"]
    with tempfile.TemporaryDirectory() as folder, multiprocessing.Pool(arguments.jobs) as pool:
        wanted = {name: path for _, name, path in write_scenes(Path(folder)) if arguments.only in name}
        tasks = [(name, path, arguments.seeds) for name, path in wanted.items() if name not in known]
        for name, scene in pool.imap(study, tasks):
            known[name] = scene
            write(arguments.file, known)
            print(line_of(name, scene), flush=True)
    good = summary({name: scene for name, scene in known.items() if name in wanted})
    print(f"written: {arguments.file}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
