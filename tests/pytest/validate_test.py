"""`ruche validate`: the quick subset of the paper's experiments, and how the command behaves."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
SOURCE = Path(os.environ["RUCHE_SOURCE"])
SANITIZED = "RUCHE_SANITIZED" in os.environ

sys.path.insert(0, str(SOURCE / "validation/reference"))

SCENE = """
[pattern]
generator = "strip"
[pattern.options]
length_mm = 8
[fabric]
margin_mm = 0
"""

EXPERIMENT = """
title = "Two thicknesses"
scene = "scene.toml"
meshes = [1, 0.5]
[sweep]
key = "plastic.thickness_mm"
label = "thickness (mm)"
values = [0.8, 1.0]
[[metric]]
name = "curvature"
of = "strip_curvature"
label = "curvature (1/mm)"
[[metric]]
name = "bimetal"
of = "bimetal_curvature"
[[picture]]
variant = "as the scene"
title = "<strip>"
at = 0.8
[[check]]
says = "It falls"
kind = "{kind}"
metric = "curvature"
[[check]]
says = "It is the bimetal's"
kind = "within"
metric = "curvature"
reference = "bimetal"
relative = 0.003
"""


def run(*arguments, status=0):
    done = subprocess.run([PROGRAM, "validate", *map(str, arguments)], cwd=SOURCE, capture_output=True, text=True)
    assert done.returncode == status, done.stdout + done.stderr
    return done


@pytest.fixture
def experiments(tmp_path):
    def make(name="two", kind="falls"):
        folder = tmp_path / "experiments" / name
        folder.mkdir(parents=True)
        (folder / "scene.toml").write_text(SCENE)
        (folder / "experiment.toml").write_text(EXPERIMENT.format(kind=kind))
        return folder.parent

    return make


@pytest.mark.skipif(SANITIZED, reason="whole releases")
def test_the_quick_subset_holds(tmp_path):
    run("--quick", "-o", tmp_path / "out")
    result = json.loads((tmp_path / "out/validation.json").read_text())
    assert result["failed_checks"] == 0
    assert len(result["experiments"]) >= 3
    assert result["unresolved_checks"] == 0
    assert all(run["certain"] for e in result["experiments"] for run in e["runs"])


@pytest.mark.skipif(SANITIZED, reason="whole releases")
def test_known_solutions_of_shells_hold_in_their_quick_subset(tmp_path):
    run("--quick", "--set-of", "shell", "-o", tmp_path / "out")
    result = json.loads((tmp_path / "out/validation.json").read_text())
    assert result["failed_checks"] == 0
    assert {e["name"] for e in result["experiments"]} >= {"end-loaded-strip", "heavy-strip", "bilayer-disc"}


def test_every_experiment_can_be_read_and_its_scenes_too():
    names = [path.parent.name for path in (SOURCE / "validation").glob("*/experiment.toml")]
    assert len(names) >= 8
    for name in names:
        for scene in (SOURCE / "validation" / name).glob("scene*.toml"):
            subprocess.run([PROGRAM, "check", scene], check=True, capture_output=True)


def test_a_page_and_json_are_written_and_runs_are_not_computed_twice(tmp_path, experiments):
    folder, out = experiments(), tmp_path / "out"
    done = run("two", "--experiments", folder, "-o", out, "--jobs", 2)
    assert "holds         It falls" in done.stdout
    page = (out / "report.html").read_text()
    assert "<svg" in page and "data:image/png;base64," in page
    assert "&lt;strip&gt;" in page and "<strip>" not in page
    result = json.loads((out / "validation.json").read_text())
    experiment = result["experiments"][0]
    assert len(experiment["runs"]) == 4
    kept = {path.name: path.stat().st_mtime_ns for path in (out / "runs").iterdir()}
    assert len(kept) == 5

    run("two", "--experiments", folder, "-o", out)
    assert {path.name: path.stat().st_mtime_ns for path in (out / "runs").iterdir()} == kept
    assert json.loads((out / "validation.json").read_text())["experiments"][0]["series"] == experiment["series"]


def test_a_run_s_command_gives_the_same_curvature(tmp_path, experiments):
    out = tmp_path / "out"
    run("two", "--experiments", experiments(), "-o", out)
    last = json.loads((out / "validation.json").read_text())["experiments"][0]["runs"][-1]
    command = last["command"].replace("ruche simulate", f"{PROGRAM} simulate", 1)
    subprocess.run(f"{command} -o {tmp_path}/again --quiet", shell=True, check=True, cwd=SOURCE)
    report = json.loads((tmp_path / "again/report.json").read_text())
    assert report["strips"][0]["curvature_per_mm"] == pytest.approx(last["values"]["curvature"], rel=1e-9)


def test_a_check_that_fails_has_an_exit_code_of_its_own(tmp_path, experiments):
    done = run("two", "--experiments", experiments(kind="rises"), "-o", tmp_path / "out", status=3)
    assert "DOES NOT HOLD It falls" in done.stdout
    assert json.loads((tmp_path / "out/validation.json").read_text())["failed_checks"] == 1


def test_a_name_that_is_none_is_refused(tmp_path, experiments):
    done = run("towo", "--experiments", experiments(), "-o", tmp_path / "out", status=2)
    assert "did you mean two" in done.stderr and "\n" in done.stderr
    done = run("--experiments", tmp_path / "nowhere", "-o", tmp_path / "out", status=2)
    assert "holds no experiments" in done.stderr
    assert not (tmp_path / "out").exists()


def test_ctrl_c_keeps_what_is_done(tmp_path, experiments):
    folder, out = experiments(), tmp_path / "out"
    text = (folder / "two/experiment.toml").read_text()
    many = ", ".join(f"{0.8 + 0.001 * k:.3f}" for k in range(400))
    (folder / "two/experiment.toml").write_text(text.replace("values = [0.8, 1.0]", f"values = [{many}]"))
    process = subprocess.Popen([PROGRAM, "validate", "two", "--experiments", folder, "-o", out], stdout=subprocess.PIPE)
    deadline = time.monotonic() + 60
    while not list(out.glob("runs/*.json")) and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    assert process.wait(600) == 130
    assert list(out.glob("runs/*.json"))
    assert not (out / "validation.json").exists()


def test_the_infinite_strip_has_the_values_that_are_kept_and_the_bimetal_s_when_narrow():
    import infinite_strip

    kept = (SOURCE / "validation/infinite-strip/infinite-strip.csv").read_text().splitlines()
    for line in (kept[1], kept[4]):
        width, curvature = map(float, line.split(","))
        assert infinite_strip.curvature(width) == pytest.approx(curvature, abs=1e-9)
    bimetal, stretch = infinite_strip.Laminate().bimetal()
    assert bimetal == pytest.approx(0.152362385, abs=5e-10)
    assert stretch == pytest.approx(0.94958916, abs=5e-9)
    # The strip leaves the bimetal with the fourth power of its width.
    assert infinite_strip.curvature(0.1) == pytest.approx(bimetal, rel=1e-7)


def test_the_oblique_strip_has_the_values_that_are_kept_and_no_torsion_without_obliqueness():
    import helical_strip
    import infinite_strip

    kept = {
        name: dict(tuple(map(float, line.split(","))) for line in path.read_text().splitlines()[1:])
        for name in ("curvature", "torsion")
        for path in [SOURCE / f"validation/oblique-strip/{name}.csv"]
    }
    curvature, torsion = helical_strip.helix(helical_strip.ObliqueLaminate(axis_deg=30.0), terms=10)
    assert curvature == pytest.approx(kept["curvature"][30.0], abs=2e-9)
    assert torsion == pytest.approx(kept["torsion"][30.0], abs=2e-9)
    assert abs(torsion) > 1e-3
    # The other side of the axis is the mirror image, and even pre-stretch the surface of revolution.
    mirrored = helical_strip.helix(helical_strip.ObliqueLaminate(axis_deg=-30.0), terms=8)
    assert mirrored == pytest.approx((curvature, -torsion), abs=1e-7)
    even = helical_strip.ObliqueLaminate(second_prestretch=1.7, axis_deg=30.0)
    curvature, torsion = helical_strip.helix(even, width=3.0, terms=10)
    assert curvature == pytest.approx(infinite_strip.curvature(3.0, terms=12), abs=1e-8)
    assert abs(torsion) < 1e-9


def test_elastica_have_the_values_that_are_kept_and_those_of_linear_beams():
    import elastica

    for name, solve, stiffness in (
        ("end-loaded-strip", elastica.end_loaded, 1),
        ("pushed-strip", elastica.pushed, -1),
    ):
        rows = (SOURCE / f"validation/{name}/height.csv").read_text().splitlines()[1:]
        for row in rows:
            force, height = map(float, row.split(","))
            load = stiffness * force * elastica.LENGTH**2 / (elastica.WIDTH * elastica.STIFFNESS)
            assert elastica.LENGTH * solve(load)[1] == pytest.approx(height, abs=2e-6)
    assert elastica.end_loaded(1e-3)[1] == pytest.approx(1e-3 / 3, rel=1e-5)
    assert elastica.heavy(1e-3, False)[1] == pytest.approx(1e-3 / 8, rel=1e-5)
    assert elastica.heavy(1e-3, True)[1] == pytest.approx(1e-3 / 24, rel=1e-5)
    table = (SOURCE / "tests/data/reference/cantilever_master_curve.csv").read_text().splitlines()[1:]
    for line in table[::5]:
        gamma, x, y = map(float, line.split(",")[:3])
        if 0.1 <= gamma <= 500:
            assert elastica.heavy(gamma, False) == pytest.approx((x, y), abs=2e-8)


def test_a_small_disc_is_the_narrow_strip_s_cap_and_a_wide_one_the_closed_form_s_cylinder():
    import bilayer_disc

    laminate = bilayer_disc.Laminate(prestretch=1.7)
    assert bilayer_disc.cylinder(laminate) == pytest.approx(0.220942 / 2 / 0.152362385, rel=3e-6)
    assert bilayer_disc.cylinder(bilayer_disc.Laminate(prestretch=1.0001)) == pytest.approx(0.7, rel=1e-4)
    kept = (SOURCE / "validation/bilayer-disc/cap.csv").read_text().splitlines()[1:]
    values = bilayer_disc.caps(12)
    assert [float(line.split(",")[1]) for line in kept] == pytest.approx(values, abs=1e-7)
    assert all(later < earlier < 1 for earlier, later in zip(values, values[1:]))
    # Where the disc leaves the cap, by uniform curvature: h = 0.6 mm of plastic, the fabric hardly counts.
    limit = bilayer_disc.bifurcation(bilayer_disc.Laminate(prestretch=1.05))
    assert limit == pytest.approx(8 * 0.61 / 20**2 / 1.4**1.5, rel=0.1)
