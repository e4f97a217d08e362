#!/usr/bin/python3
"""What a release costs: scenes x sizes x threads, how it grows, and the laminate element against the tests' oracle.

usage: bench/release_study.py [FILE.json] [--scenes strips,torus] [--sizes 5000,20000,80000,200000] [--threads 1,2]
                              [--repeats 3] [--build build/release] [--again]

Runs `ruche bench` three times for each row, keeps the run with the median of equivalent factorisations, and writes
FILE.json (default build/release_study.json) and the same as Markdown tables beside it, after every row: when it is
stopped, the next start goes on where it was; --again begins anew. Let nothing else run meanwhile. Needs a release build
with benchmarks (tools/bench makes one).

Growth is the exponent p of processor time ~ triangles^p from the mesh nearest to 20,000 triangles to the largest one.
The program ends with 1 when a release did not end converged and stable, or the element is less than 40 times as fast
as the oracle.
"""

import argparse
import json
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["strips", "staggered", "torus", "stars", "svg", "fivestrips-without-log-terms"]
WANTED_TIMES_FASTER = 40
GROWTH_FROM = 20000
COLUMNS = (  # title, how to write it
    ("scene", lambda r: r["scene"]),
    ("triangles", lambda r: f"{r['triangles']}"),
    ("unknowns", lambda r: f"{r['unknowns']}"),
    ("threads", lambda r: f"{r['threads']}"),
    ("energy s", lambda r: f"{r['value_s']:.3g}"),
    ("gradient s", lambda r: f"{r['gradient_s']:.3g}"),
    ("Hessian s", lambda r: f"{r['hessian_s']:.3g}"),
    ("factorisation s", lambda r: f"{r['factorization_s']:.3g}"),
    ("by clock", lambda r: f"{r['with_all_threads']['factorization_s']:.3g}"),
    ("solve s", lambda r: f"{r['solve_s']:.3g}"),
    ("release CPU s", lambda r: f"{r['release_cpu_s']:.3g}"),
    ("by clock", lambda r: f"{r['release_wall_s']:.3g}"),
    ("iterations", lambda r: f"{r['iterations']}"),
    ("factorisations", lambda r: f"{r['factorizations']}"),
    ("equivalent factorisations", lambda r: f"{r['equivalent_factorizations']:.1f}"),
    ("least to most", lambda r: "{:.1f} to {:.1f}".format(*r.get("equivalent_factorizations_spread", [math.nan] * 2))),
    ("peak MB", lambda r: f"{r['peak_mb']:.0f}"),
    ("of the factor", lambda r: f"{r['peak_over_factor']:.2f}"),
    ("certain", lambda r: "yes" if certain(r) else "NO"),
)


def certain(row):
    return row["converged"] and row["stable"]


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|---" * len(titles) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def growth(rows):
    """Exponent of processor time over triangles for each scene and number of threads that has two sizes."""
    found = []
    for scene, threads in sorted({(row["scene"], row["threads"]) for row in rows}):
        own = [row for row in rows if (row["scene"], row["threads"]) == (scene, threads)]
        first = min(own, key=lambda row: abs(math.log(row["triangles"] / GROWTH_FROM)))
        last = max(own, key=lambda row: row["triangles"])
        if last["triangles"] < 2 * first["triangles"]:
            continue
        ratio = math.log(last["triangles"] / first["triangles"])
        found.append({
            "scene": scene,
            "threads": threads,
            "from": first["triangles"],
            "to": last["triangles"],
            "release": math.log(last["release_cpu_s"] / first["release_cpu_s"]) / ratio,
            "factorization": math.log(last["factorization_s"] / first["factorization_s"]) / ratio,
        })
    return found


def markdown(study):
    rows = [result for result in study["runs"].values() if "triangles" in result]
    parts = [table([title for title, _ in COLUMNS], [[write(row) for _, write in COLUMNS] for row in rows])]
    parts.append("Processor time ~ triangles^p:\n")
    parts.append(table(
        ["scene", "threads", "triangles", "p of the release", "p of one factorisation"],
        [[g["scene"], str(g["threads"]), f"{g['from']} to {g['to']}", f"{g['release']:.2f}", f"{g['factorization']:.2f}"]
         for g in growth(rows)]))
    if element := study.get("element"):
        parts.append(
            f"Laminate element, value to Hessian, one thread: {element['element_ns']:.0f} ns; the oracle "
            f"{element['oracle_ns']:.0f} ns, {element['times_faster']:.0f} times as long.\n")
    for key, result in study["runs"].items():
        if "error" in result:
            parts.append(f"{key}: {result['error']}\n")
    return "\n".join(parts)


def measure(build, scene, size, threads):
    run = subprocess.run(
        [build / "ruche", "bench", "--json", "--scene", scene, "--triangles", str(size),
         "--threads", str(threads)],
        capture_output=True, text=True)
    if run.returncode not in (0, 3):
        return {"error": f"exit code {run.returncode}: {run.stderr.strip()}"}
    return json.loads(run.stdout)


def median(results):
    """The run with the median of equivalent factorisations, and the least and the most of all runs."""
    failed = [result for result in results if "error" in result or not certain(result)]
    if failed:
        return failed[0]
    ranked = sorted(results, key=lambda result: result["equivalent_factorizations"])
    spread = [ranked[0]["equivalent_factorizations"], ranked[-1]["equivalent_factorizations"]]
    return ranked[len(ranked) // 2] | {"equivalent_factorizations_spread": spread}


def measure_element(build):
    out = subprocess.check_output(
        [build / "bench/ruche_bench", "--benchmark_filter=^laminate_element", "--benchmark_format=json"],
        text=True, stderr=subprocess.DEVNULL)
    entry = json.loads(out)["benchmarks"][0]
    if entry.get("error_occurred"):
        sys.exit(f"laminate_element: {entry['error_message']}")
    return {key: entry[key] for key in ("element_ns", "oracle_ns", "times_faster")}


def numbers(text):
    return [int(number) for number in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", default=ROOT / "build/release_study.json", type=Path)
    parser.add_argument("--scenes", type=lambda text: text.split(","), default=SCENES)
    parser.add_argument("--sizes", type=numbers, default=[5000, 20000, 80000, 200000])
    parser.add_argument("--threads", type=numbers, default=[1, 2])
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--build", type=Path, default=ROOT / "build/release")
    parser.add_argument("--again", action="store_true", help="forget the rows that the file has")
    arguments = parser.parse_args()

    study = {"runs": {}}
    if arguments.file.exists() and not arguments.again:
        study = json.loads(arguments.file.read_text())

    def save():
        arguments.file.write_text(json.dumps(study, indent=1) + "\n")
        arguments.file.with_suffix(".md").write_text(markdown(study))

    study["element"] = measure_element(arguments.build)
    save()
    print(f"laminate element: {study['element']['times_faster']:.0f} times as fast as the oracle", flush=True)
    for size in arguments.sizes:  # small ones first: they tell soonest whether something is wrong
        for scene in arguments.scenes:
            for threads in arguments.threads:
                key = f"{scene} {size} {threads}"
                if key in study["runs"]:
                    continue
                result = study["runs"][key] = median(
                    [measure(arguments.build, scene, size, threads) for _ in range(arguments.repeats)])
                save()
                took = result.get("error") or f"{result['release_cpu_s']:.3g} s, certain: {certain(result)}"
                print(f"{key}: {took}", flush=True)
    print(f"written: {arguments.file}, {arguments.file.with_suffix('.md').name}")
    good = all("error" not in result and certain(result) for result in study["runs"].values())
    return 0 if good and study["element"]["times_faster"] >= WANTED_TIMES_FASTER else 1


if __name__ == "__main__":
    sys.exit(main())
