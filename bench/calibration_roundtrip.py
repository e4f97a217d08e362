#!/usr/bin/python3
"""Does `ruche calibrate` find the card that `ruche virtual-test` tested?

usage: bench/calibration_roundtrip.py FOLDER [--seeds 100] [--mode joint|paper] [--cycles 6] [--format plain|weights]
           [--jobs 1] [--curves 20] [--card CARD]

The tests of the card are simulated once (FOLDER/curves.json). For each seed they are recorded with noise (1 % of full
scale) and hysteresis, by a machine or by hand with hung masses (`--format weights`), calibrated, and the fitted values and
their 95 % intervals are kept in FOLDER/RUN/seed-N.json (RUN: "joint-3-cycles", "joint-weights"), so that a run that was
stopped goes on where it was. For the first `--curves` seeds the fitted card is simulated too, and its tension curves are
compared with the true ones; bench/calibration_limit.py says what they can be compared with. At the end it prints a table
and writes FOLDER/RUN/summary.json; it ends with 1 when an interval holds the truth in less than 90 % of the seeds.
"""

import argparse
import concurrent.futures
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

import uniaxial_law

PROGRAM = os.environ.get("RUCHE_PROGRAM", str(Path(__file__).parents[1] / "build/release/ruche"))
PARAMETERS = (*uniaxial_law.PARAMETERS, "fabric_bending_stiffness_n_mm")
WANTED_COVERAGE = 0.9
CURVE_ERRORS = ("largest_relative_error", "largest_error_over_full_scale")


def run(*command):
    done = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return done.stdout


def values_of(card_text, prestretch):
    """Values and intervals of a card's set, with what holds at every pre-stretch."""
    card = tomllib.loads(card_text)
    chosen = min(card["set"], key=lambda s: abs(s["prestretch"] - prestretch))
    entries = {**card.get("common", {}), **chosen}
    result = {}
    for name in PARAMETERS:
        entry = entries[name]
        entry = entry if isinstance(entry, dict) else {"value": entry}
        result[name] = {"value": entry["value"], "interval": entry.get("interval"), "source": entry.get("source", "")}
    return result


def tension_curves(path):
    data = json.loads(Path(path).read_text())
    return {c["angle_deg"]: c for c in data["curves"] if c["test"] == "tension"}


def curve_errors(true_file, fitted_file):
    """Largest errors of the fitted tension curves: over the force, from a tenth of the strain on, and where; over full scale."""
    relative = over_scale = 0.0
    place = {}
    fitted = tension_curves(fitted_file)
    for angle, true in tension_curves(true_file).items():
        scale, end = true["force_N"][-1], true["displacement_mm"][-1]
        for d, wanted, found in zip(true["displacement_mm"], true["force_N"], fitted[angle]["force_N"]):
            over_scale = max(over_scale, abs(found - wanted) / scale)
            if d >= 0.1 * end and abs(found / wanted - 1.0) > relative:
                relative = abs(found / wanted - 1.0)
                place = {"angle_deg": angle, "share_of_strain": d / end, "share_of_force": wanted / scale}
    return {"largest_relative_error": relative, "largest_error_over_full_scale": over_scale, "place": place}


def run_folder(arguments):
    kind = "weights" if arguments.format == "weights" else f"{arguments.cycles}-cycles"
    return arguments.folder / f"{arguments.mode}-{kind}"


def one_seed(seed, arguments):
    kept = run_folder(arguments) / f"seed-{seed}.json"
    if kept.exists():
        return json.loads(kept.read_text())
    curves = arguments.folder / "curves.json"
    with tempfile.TemporaryDirectory() as place:
        lab, card = Path(place) / "lab", Path(place) / "card.toml"
        machine = (f"--seed={seed}", f"--cycles={arguments.cycles}", f"--format={arguments.format}")
        run("virtual-test", arguments.card, "-o", lab, "--curves", curves, f"--prestretch={arguments.prestretch}", *machine)
        campaign = lab / "campaign.toml"
        campaign.write_text(campaign.read_text().replace('mode = "joint"', f'mode = "{arguments.mode}"'))
        begin = time.monotonic()
        run("calibrate", campaign, "-o", card)
        result = {"seed": seed, "seconds": time.monotonic() - begin}
        result["values"] = values_of(card.read_text(), arguments.prestretch)
        if seed <= arguments.curves:
            tests = ("--tests=tension", f"--prestretch={arguments.prestretch}")
            run("virtual-test", card, "-o", lab, *tests, "--curves", lab / "fitted.json")
            result["curves"] = curve_errors(curves, lab / "fitted.json")
    partial = kept.with_suffix(".part")
    partial.write_text(json.dumps(result, indent=1))
    partial.rename(kept)
    return result


def summarise(results, truth):
    rows = {}
    for name in PARAMETERS:
        true = truth[name]["value"]
        found = [r["values"][name]["value"] for r in results]
        intervals = [r["values"][name]["interval"] for r in results]
        given = [i for i in intervals if i]
        rows[name] = {
            "truth": true,
            "mean": statistics.fmean(found),
            "bias": statistics.fmean(found) / true - 1.0,
            "spread": statistics.pstdev(found) / true,
            "half_width": statistics.fmean([0.5 * (hi - lo) for lo, hi in given]) / true if given else None,
            "with_interval": len(given),
            "coverage": sum(lo <= true <= hi for lo, hi in given) / len(results),
        }
    return rows


def percent(value):
    return "-" if value is None else f"{100.0 * value:.2f} %"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--mode", choices=("joint", "paper"), default="joint")
    parser.add_argument("--cycles", type=int, default=6)
    parser.add_argument("--format", choices=("plain", "weights"), default="plain")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--curves", type=int, default=20)
    parser.add_argument("--card", default="spandex-tpu95a")
    parser.add_argument("--prestretch", type=float, default=1.7)
    arguments = parser.parse_args()
    run_folder(arguments).mkdir(parents=True, exist_ok=True)

    curves = arguments.folder / "curves.json"
    with tempfile.TemporaryDirectory() as place:  # simulates, unless the curves are there
        run("virtual-test", arguments.card, "-o", place, "--curves", curves, f"--prestretch={arguments.prestretch}")
    truth_text = run("cards", arguments.card) if not arguments.card.endswith(".toml") else Path(arguments.card).read_text()
    truth = values_of(truth_text, arguments.prestretch)

    results, failures = [], []
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        tasks = {pool.submit(one_seed, seed, arguments): seed for seed in range(1, arguments.seeds + 1)}
        for task in concurrent.futures.as_completed(tasks):
            try:
                results.append(task.result())
            except RuntimeError as failed:
                failures.append({"seed": tasks[task], "error": str(failed)})
                print(failed, file=sys.stderr)
            print(f"\r{len(results)} of {arguments.seeds}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    if not results:
        sys.exit("no seed was calibrated")

    rows = summarise(results, truth)
    curves_checked = [r["curves"] for r in results if "curves" in r]
    summary = {
        "card": arguments.card,
        "mode": arguments.mode,
        "seeds": len(results),
        "failures": failures,
        "parameters": rows,
        "curves": {key: max((c[key] for c in curves_checked), default=None) for key in CURVE_ERRORS},
        "curves_median": {key: statistics.median(c[key] for c in curves_checked) if curves_checked else None for key in CURVE_ERRORS},
        "curves_within_1_percent": sum(c["largest_relative_error"] <= 0.01 for c in curves_checked),
        "seconds_per_calibration": statistics.median(r["seconds"] for r in results),
    }
    (run_folder(arguments) / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    print(f"{len(results)} seeds, {run_folder(arguments).name}; {len(failures)} failed")
    print("| parameter | truth | bias | spread | half interval | truth in interval |")
    print("|---|---|---|---|---|---|")
    for name, row in rows.items():
        print(
            f"| {name} | {row['truth']:g} | {percent(row['bias'])} | {percent(row['spread'])} "
            f"| {percent(row['half_width'])} | {percent(row['coverage'])} |"
        )
    if curves_checked:
        for key, value in summary["curves"].items():
            print(f"{key.replace('_', ' ')}: median {percent(summary['curves_median'][key])}, largest {percent(value)}")
        print(f"all seven curves within 1 %: {summary['curves_within_1_percent']} of {len(curves_checked)} cards")
    enough = all(row["coverage"] >= WANTED_COVERAGE for row in rows.values())
    sys.exit(0 if enough and not failures else 1)


if __name__ == "__main__":
    main()
