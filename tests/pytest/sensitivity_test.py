"""`ruche sensitivity` as a user runs it."""

import json
import math
import os
import subprocess

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path id="strip" d="M 4 5 H 16" stroke="black" stroke-width="1" fill="none"/></svg>"""
COARSE = ["--set", "fabric.margin_mm=1", "--set", "mesh.size_mm=1"]


def sensitivity(*arguments, cwd):
    return subprocess.run(
        [PROGRAM, "sensitivity", *arguments], cwd=cwd, capture_output=True, text=True, timeout=600
    )


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "d.svg").write_text(DRAWING)
    return tmp_path


def slopes_printed(text):
    """Parameter -> slope of the lines of a table."""
    rows = (line.split() for line in text.splitlines() if line.startswith("  ") and "%" in line)
    return {row[0]: next(float(w) for w in row[1:] if w[0] in "+-") for row in rows if "." in row[0]}


def test_the_table_is_sorted_and_agrees_with_the_file(folder):
    run = sensitivity("d.svg", *COARSE, "-o", "s.json", cwd=folder)
    assert run.returncode == 0, run.stderr
    found = json.loads((folder / "s.json").read_text())
    measure = found["measures"]["mean_curvature"]
    assert f"mean_curvature = {measure['value']:.6g} 1/mm" in run.stdout
    printed = slopes_printed(run.stdout)
    assert list(printed) == sorted(printed, key=lambda name: -abs(printed[name]))
    for name, slope in printed.items():
        assert math.isclose(slope, measure["d_ln_by_d_ln"][name], abs_tol=6e-4)
    assert measure["d_ln_by_d_ln"]["plastic.thickness_mm"] < -1  # thicker plastic curls less
    assert printed["fabric.prestretch"] > 1
    together = measure["d_ln_by_d_ln"]["fabric.prestretch.1"] + measure["d_ln_by_d_ln"]["fabric.prestretch.2"]
    assert math.isclose(together, measure["d_ln_by_d_ln"]["fabric.prestretch"], rel_tol=1e-6)
    assert found["parameters"]["plastic.thickness_mm"]["value"] == pytest.approx(0.6)
    assert "curvature.strip" in found["measures"]


def test_a_card_with_intervals_says_how_sure_the_shape_is(folder):
    card = subprocess.run([PROGRAM, "cards", "spandex-tpu95a"], capture_output=True, text=True).stdout
    lines = []
    for line in card.splitlines():
        if line.startswith("fabric_thickness_mm"):
            line = line.replace("value = 0.46,", "value = 0.46, interval = [0.437, 0.483],")
            assert "interval" in line
        lines.append(line)
    (folder / "card.toml").write_text("\n".join(lines) + "\n")
    run = sensitivity("d.svg", *COARSE, "--set", "fabric.card=card.toml", "-o", "s.json", cwd=folder)
    assert run.returncode == 0, run.stderr
    found = json.loads((folder / "s.json").read_text())
    assert found["parameters"]["material.fabric_thickness_mm"]["relative_uncertainty"] == pytest.approx(0.05)
    measure = found["measures"]["mean_curvature"]
    slope = measure["d_ln_by_d_ln"]["material.fabric_thickness_mm"]
    assert measure["relative_uncertainty"] == pytest.approx(0.05 * abs(slope))
    row = next(line for line in run.stdout.splitlines() if "material.fabric_thickness_mm" in line)
    assert f"+-{100 * 0.05 * abs(slope):.2g} %" in row
    # Another value than the card's is not what the interval is about.
    run = sensitivity("d.svg", *COARSE, "--set", "fabric.card=card.toml", "--set", "material.fabric_thickness_mm=0.5",
                      "-o", "s.json", cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "relative_uncertainty" not in (folder / "s.json").read_text()


def test_wrong_measures_are_refused_before_anything_is_released(folder):
    run = sensitivity("d.svg", "--metric", "mean_curvatur", cwd=folder)
    assert run.returncode == 2
    assert "did you mean mean_curvature?" in run.stderr and "length" in run.stderr
    assert "iteration" not in run.stderr


def test_several_measures_and_the_start_from_a_result(folder):
    first = subprocess.run([PROGRAM, "simulate", "d.svg", *COARSE, "-o", "out", "--set", "output.picture=false", "--set",
                            "output.page=false"], cwd=folder, capture_output=True, text=True, timeout=600)
    assert first.returncode == 0, first.stderr
    run = sensitivity("d.svg", *COARSE, "--metric", "height", "--metric", "curvature.strip", "--start", "out", cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "height = " in run.stdout and "curvature.strip = " in run.stdout and "area = " not in run.stdout
    every = sensitivity("d.svg", *COARSE, "--metric", "all", cwd=folder)
    assert "area = " in every.stdout


def test_a_shape_that_is_not_at_rest_has_none(folder):
    run = sensitivity("d.svg", *COARSE, "--set", "solver.max_iterations=1", "-o", "s.json", cwd=folder)
    assert run.returncode == 3
    assert "no sensitivities" in run.stderr
    assert not (folder / "s.json").exists()
