"""`ruche compare`: a result against scans of itself, as another program writes them."""

import json
import os
import subprocess

import numpy as np
import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
# Three strips of different lengths: no motion takes the piece to itself.
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm" viewBox="0 0 40 30"
stroke="black" stroke-width="1" fill="none"><path d="M 6 6 H 34"/><path d="M 6 12 H 20"/><path d="M 8 12 V 25"/></svg>"""


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    place = tmp_path_factory.mktemp("compare")
    (place / "d.svg").write_text(DRAWING)
    subprocess.run([PROGRAM, "simulate", "d.svg", "--quiet", "--set", "output.picture=false", "--set", "output.stl=true"],
                   cwd=place, check=True)
    return place / "d.out"


def compare(result, scan, *options):
    run = subprocess.run([PROGRAM, "compare", result, scan, *options], capture_output=True, text=True, timeout=600)
    report = result / "compare.json"
    return run, json.loads(report.read_text()) if run.returncode == 0 else None


def test_its_own_surface_in_inches_turned_and_shifted_is_found(result, tmp_path):
    points = np.array([line.split()[1:4] for line in (result / "shape.obj").read_text().splitlines() if line.startswith("v ")], float)
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    placed = (points @ turn.T + [200, -40, 90]) / 25.4
    scan = tmp_path / "scan.ply"
    scan.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(placed)}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                    + "\n".join(" ".join(f"{x:.7f}" for x in p) for p in placed) + "\n")
    run, report = compare(result, scan)
    assert run.returncode == 0, run.stderr
    assert report["unit"] == "inch" and report["unit_guessed"] and "guessed" in run.stdout
    # The reference surface is the fabric's front here: on the skin where nothing is printed, below it where there is.
    assert report["rms_mm"] < 0.46
    placing = report["placing"]
    back = np.array(placing["rotation"]).reshape(3, 3) @ (25.4 * placed).T
    assert placing["scale"] == 1
    # Within a layer's thickness: the scan settles somewhere between the two skins.
    assert np.linalg.norm(back.T + placing["translation_mm"] - points, axis=1).max() < 1.2
    page = (result / "compare.html").read_text()
    assert "scan_distance_mm" in page and '"comparison"' in page


def test_a_scan_in_the_wrong_format_or_unit_is_refused(result, tmp_path):
    (tmp_path / "a.stl").write_text("nothing")
    run, _ = compare(result, tmp_path / "a.stl")
    assert run.returncode == 2 and "a.stl" in run.stderr
    run, _ = compare(result, result / "shape.stl", "--unit", "yard")
    assert run.returncode == 2 and "yard" in run.stderr
    run, _ = compare(result, result / "scene.toml")
    assert run.returncode == 2 and "neither OBJ, PLY nor STL" in run.stderr
