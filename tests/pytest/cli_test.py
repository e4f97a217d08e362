"""The program as a person meets it: verbs, exit codes, files, interruptions, full disks."""

import json
import os
import re
import resource
import signal
import subprocess
import time

import pytest

from metis_watch import wait_until_metis_orders

PROGRAM = os.environ["RUCHE_PROGRAM"]
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path id="strip" d="M 4 5 H 16" stroke="black" stroke-width="1" fill="none"/></svg>"""
COARSE = ["--set", "fabric.margin_mm=1", "--set", "mesh.size_mm=1", "--set", "output.picture=false",
          "--set", "output.page=false"]


def ruche(*arguments, cwd, **more):
    return subprocess.run([PROGRAM, *arguments], cwd=cwd, capture_output=True, text=True, timeout=600, **more)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "d.svg").write_text(DRAWING)
    return tmp_path


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A small drawing, simulated once."""
    place = tmp_path_factory.mktemp("finished")
    (place / "d.svg").write_text(DRAWING)
    run = ruche("simulate", "d.svg", *COARSE, cwd=place)
    assert run.returncode == 0, run.stderr
    return place, run


def report(place):
    return json.loads((place / "report.json").read_text())


def test_version_and_help(tmp_path):
    assert re.fullmatch(r"ruche \d+\.\d+\.\d+\n", ruche("--version", cwd=tmp_path).stdout)
    verbs = [], ["simulate"], ["check"], ["render"], ["pattern"], ["pattern", "radial"], ["cards"], ["template"], ["bench"]
    for verb in *verbs, ["virtual-test"]:
        run = ruche(*verb, "--help", cwd=tmp_path)
        assert run.returncode == 0 and run.stderr == ""
        assert len(run.stdout) > 100
    assert "ruche simulate my.svg" in ruche("--help", cwd=tmp_path).stdout
    assert "--inner-mm" in ruche("pattern", "radial", "--help", cwd=tmp_path).stdout


def test_cards_are_listed_and_a_printed_card_can_be_used(folder):
    assert "spandex-tpu95a" in ruche("cards", cwd=folder).stdout
    (folder / "my card.toml").write_text(ruche("cards", "spandex-tpu95a", cwd=folder).stdout)
    run = ruche("check", "d.svg", "--set", "fabric.card=my card.toml", cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "my card.toml" in run.stdout


def test_template_is_a_scene(folder):
    (folder / "k.toml").write_text(ruche("template", cwd=folder).stdout.replace("drawing.svg", "d.svg"))
    run = ruche("check", "k.toml", cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "| key | default |" in ruche("template", "--manual", cwd=folder).stdout


def test_bare_fabric_shrinks_and_fabric_may_be_cut_along_the_print(folder):
    (folder / "bare.toml").write_text('plastic = "none"\n[pattern]\nsvg = "d.svg"\n[fabric]\nmargin_mm = 4\n'
                                      "[output]\npicture = false\n")
    assert ruche("simulate", "bare.toml", "--set", "fabric.prestretch=1.6", cwd=folder).returncode == 0
    shape = report(folder / "bare.out")["shape"]
    assert shape["printed_area_mm2"] == 0
    assert abs(shape["area_mm2"] / shape["layout_area_mm2"] * 1.6**2 - 1) < 1e-6
    run = ruche("simulate", "d.svg", "--set", "fabric.margin_mm=0", "--set", "output.picture=false", cwd=folder)
    assert run.returncode == 0, run.stderr
    shape = report(folder / "d.out")["shape"]
    assert abs(shape["printed_area_mm2"] - 12) < 1e-6 and shape["layout_area_mm2"] == shape["printed_area_mm2"]


def test_check_prints_every_value_with_unit_and_source_and_writes_nothing(folder):
    (folder / "k.toml").write_text('[pattern]\nsvg = "d.svg"\n[material]\nplastic_density_kg_per_m3 = 1200\n')
    before = sorted(folder.iterdir())
    run = ruche("check", "k.toml", "--stretch", "1.65", "--set", "mesh.size_mm=0.8", cwd=folder)
    assert run.returncode == 0, run.stderr
    for line in [
        r"fabric\.prestretch +\[1\.65, 1\.65\] +--stretch 1\.65",
        r"mesh\.size_mm +0\.8 mm +--set mesh\.size_mm=0\.8",
        r"material\.alpha_1_mpa +0\.024161 MPa +paper Table 1",
        r"material\.fabric_thickness_mm +0\.46 mm +assumed: .*",
        r"material\.plastic_density_kg_per_m3 +1200 kg/m\^3 +k\.toml:4",
        r"solver\.seed +1 +default",
        r"strips +1",
        r"mesh +\d+ triangles, \d+ vertices",
        r"  plastic\.thickness = 0\.6 mm \(not given\)",
    ]:
        assert re.search("^" + line + "$", run.stdout, re.MULTILINE), line + "\n" + run.stdout
    assert sorted(folder.iterdir()) == before


@pytest.mark.parametrize("name", ["strip", "staggered", "radial", "stars", "hexagons"])
def test_generated_drawings_can_be_simulated(name, tmp_path):
    run = ruche("pattern", name, "-o", "x y.svg", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert ruche("check", "x y.svg", cwd=tmp_path).returncode == 0
    assert ruche("pattern", name, cwd=tmp_path).stdout == (tmp_path / "x y.svg").read_text()


def test_a_field_from_a_file_is_drawn_and_stands_beside_its_scene(tmp_path):
    place = tmp_path / "scenes"
    place.mkdir()
    nodes = [f"{x},{y},{15 * y},{3 + 0.1 * x}" for x in (-8, 0, 8) for y in (-8, 0, 8)]
    (place / "field.csv").write_text("\n".join(["x_mm,y_mm,angle_deg,spacing_mm", *nodes]))
    options = ["--field", "file", "--file", "scenes/field.csv", "--inner-mm", "0", "--outer-mm", "8"]
    run = ruche("pattern", "traced", *options, "-o", "x.svg", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert " strips, " in run.stdout
    (place / "k.toml").write_text('[pattern]\ngenerator = "traced"\n[pattern.options]\nfield = "file"\n'
                                  'file = "field.csv"\ninner_mm = 0\nouter_mm = 8\n')
    count = run.stdout.split(": ")[1].split(" strips")[0]
    checked = ruche("check", "scenes/k.toml", cwd=tmp_path)
    assert f"strips     {count}\n" in checked.stdout
    (place / "field.csv").write_text("\n".join(nodes[:-1]))
    for broken in (ruche("check", "scenes/k.toml", cwd=tmp_path), ruche("pattern", "traced", *options, cwd=tmp_path)):
        assert broken.returncode == 2
        assert "scenes/field.csv: there is no node at x = 8, y = 8 mm" in broken.stderr


def test_a_drawing_alone_is_simulated_and_says_what_it_assumed(finished):
    place, run = finished
    assert "assumed:\n  fabric.card = spandex-tpu95a (not given)\n  fabric.prestretch = [1.7, 1.7] (not given)" in run.stdout
    assert "fabric_thickness = 0.46 mm (assumed" in run.stdout
    for line in ["converged, stable", "energy ", "residual ", "curvature ", "time ", "d.out/report.json", "d.out/shape.obj"]:
        assert line in run.stdout
    out = place / "d.out"
    assert report(out)["status"] == "converged" and report(out)["stable"] is True
    names = {"shape.obj", "shape.mtl", "shape.ply", "shape.vtu", "shape.glb", "layout.obj", "layout.ply", "layout.vtu",
             "scene.toml", "state.ruche", "report.json"}
    assert {path.name for path in out.iterdir()} == names


def test_the_result_can_be_run_again_from_its_own_scene(finished, tmp_path):
    place, _ = finished
    run = ruche("simulate", str(place / "d.out/scene.toml"), "-o", "again", "--quiet", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert run.stdout == "" and run.stderr == ""
    first, again = report(place / "d.out"), report(tmp_path / "again")
    assert abs(again["energy_mJ"]["total"] / first["energy_mJ"]["total"] - 1) < 1e-10


def test_the_layout_of_a_result_can_be_simulated_as_a_mesh(finished, tmp_path):
    place, _ = finished
    run = ruche("simulate", str(place / "d.out/layout.ply"), "-o", "again", *COARSE, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    first, again = report(place / "d.out"), report(tmp_path / "again")
    assert abs(again["energy_mJ"]["total"] / first["energy_mJ"]["total"] - 1) < 1e-9


def test_resume_and_start_go_on_from_the_state(finished, tmp_path):
    place, _ = finished
    resumed = ruche("simulate", "d.svg", *COARSE, "--resume", cwd=place)
    assert resumed.returncode == 0, resumed.stderr
    assert report(place / "d.out")["solver"]["iterations"] <= 2
    other = ruche("simulate", "d.svg", *COARSE, "--resume", "--stretch", "1.6", cwd=place)
    assert other.returncode == 2
    assert "fabric.prestretch was [1.7, 1.7], now [1.6, 1.6]" in other.stderr
    started = ruche("simulate", "d.svg", *COARSE, "--start", "d.out", "--stretch", "1.6", "-o", "e", cwd=place)
    assert started.returncode == 0, started.stderr
    fresh = ruche("simulate", "d.svg", *COARSE, "--stretch", "1.6", "-o", "f", cwd=place)
    assert fresh.returncode == 0
    a, b = report(place / "e"), report(place / "f")
    assert abs(a["energy_mJ"]["total"] / b["energy_mJ"]["total"] - 1) < 1e-9


def test_a_result_that_does_not_converge_is_written_and_marked(folder):
    run = ruche("simulate", "d.svg", *COARSE, "--set", "solver.max_iterations=1", cwd=folder)
    assert run.returncode == 3, run.stderr
    assert "NOT CONVERGED" in run.stdout
    assert report(folder / "d.out")["status"] == "not_converged"


def big_run(folder):
    """A run that takes long enough to be interrupted."""
    (folder / "k.toml").write_text('[pattern]\ngenerator = "radial"\n[mesh]\nsize_mm = 0.4\nfabric_size_mm = 0.5\n'
                                   "[output]\npicture = false\n")
    return subprocess.Popen([PROGRAM, "simulate", "k.toml"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True)


def wait_for(process, text):
    seen = ""
    while text not in seen:
        line = process.stderr.readline()
        assert line, "the program ended early: " + seen
        seen += line


def grid_of_a_wide_strip(path):
    """30 x 5 mm on squares of 1 mm cut by alternating diagonals, 0.3 mm of plastic: rolls along or across."""
    long, wide = 30, 5
    points = [f"{i} {j}" for j in range(wide + 1) for i in range(long + 1)]
    faces = []
    for j in range(wide):
        for i in range(long):
            a, b, c, d = (j * (long + 1) + i + k for k in (0, 1, long + 1, long + 2))
            cut = [(a, b, d), (a, d, c)] if (i + j) % 2 == 0 else [(a, b, c), (b, d, c)]
            faces += ["3 {} {} {} 0.3".format(*face) for face in cut]
    header = ["ply", "format ascii 1.0", f"element vertex {len(points)}", "property double x", "property double y",
              f"element face {len(faces)}", "property list uchar int vertex_indices", "property double front_mm",
              "end_header"]
    path.write_text("\n".join(header + points + faces) + "\n")


def test_alternatives_are_listed_and_each_has_a_folder(tmp_path):
    grid_of_a_wide_strip(tmp_path / "strip.ply")
    nothing_else = ["--set", "output.picture=false", "--set", "output.glb=false", "-o", "out"]
    run = ruche("simulate", "strip.ply", "--alternatives", "2", *nothing_else, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    assert re.search(r"^shapes     2 from \d+ further starts$", run.stdout, re.MULTILINE), run.stdout
    out = tmp_path / "out"
    shapes = report(out)["alternatives"]["shapes"]
    assert [shape["folder"] for shape in shapes] == ["alternatives/1", "alternatives/2"]
    assert [shape["ordinary"] for shape in shapes].count(True) == 1
    assert 0.02 < shapes[1]["above_lowest"] < 0.06
    assert shapes[1]["energy_mJ"] == pytest.approx(shapes[0]["energy_mJ"] * (1 + shapes[1]["above_lowest"]))
    assert len(report(out)["alternatives"]["symmetries"]) == 3
    for shape in shapes:
        assert shape["found_from"]
        alone = report(out / shape["folder"])
        assert alone["status"] == "converged" and alone["stable"] is True
        assert alone["energy_mJ"]["total"] == shape["energy_mJ"]
        assert (out / shape["folder"] / "shape.ply").is_file()
    # The lower and the higher one stay apart when a run begins from either.
    again = ruche("simulate", "strip.ply", "--start", "out/alternatives/2", *nothing_else[:-1], "again", cwd=tmp_path)
    assert again.returncode == 0
    assert report(tmp_path / "again")["energy_mJ"]["total"] == pytest.approx(shapes[1]["energy_mJ"], rel=1e-9)
    # A later result without alternatives leaves none behind.
    assert ruche("simulate", "strip.ply", *nothing_else, cwd=tmp_path).returncode == 0
    assert "alternatives" not in report(out) and not (out / "alternatives").exists()


def test_an_interrupted_run_leaves_its_state_and_goes_on(folder):
    process = big_run(folder)
    wait_for(process, "release")
    process.send_signal(signal.SIGINT)
    out, error = process.communicate(timeout=600)
    assert process.returncode == 130, error
    assert "interrupted" in out
    assert report(folder / "k.out")["status"] == "interrupted"
    assert (folder / "k.out/state.ruche").stat().st_size > 1000


def test_an_interrupted_run_does_not_replace_a_finished_result(folder):
    (folder / "k.out").mkdir()
    (folder / "k.out/report.json").write_text('{"status": "converged"}')
    process = big_run(folder)
    wait_for(process, "release")
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=600)
    assert process.returncode == 130
    assert (folder / "k.out/report.json").read_text() == '{"status": "converged"}'
    assert {path.name for path in (folder / "k.out").iterdir()} == {"report.json", "state.ruche"}


def test_an_interrupt_while_metis_orders_is_one_like_any_other(folder):
    process = big_run(folder)
    wait_until_metis_orders(process.pid)
    process.send_signal(signal.SIGTERM)
    out, error = process.communicate(timeout=600)
    assert process.returncode == 130, error
    assert "interrupted" in out
    assert report(folder / "k.out")["status"] == "interrupted"


def test_a_second_interrupt_ends_the_program_at_once(folder):
    process = big_run(folder)
    wait_for(process, "release")
    process.send_signal(signal.SIGINT)
    time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=600)
    assert process.returncode in (-signal.SIGINT, 130)


def earlier_result(folder):
    (folder / "out").mkdir()
    (folder / "out/report.json").write_text('{"status": "converged", "earlier": true}')
    (folder / "out/shape.obj").write_text("# earlier\n")
    return {path: path.read_text() for path in (folder / "out").iterdir()}


def test_a_full_disk_leaves_the_earlier_result_as_it_was(folder, finished):
    before = earlier_result(folder)
    # A byte too little for each of the files in turn.
    sizes = sorted({path.stat().st_size - 1 for path in (finished[0] / "d.out").iterdir()})
    assert len(sizes) > 8
    for size in [0, 1000, *sizes[::2], sizes[-1]]:
        run = ruche("simulate", "d.svg", *COARSE, "-o", "out", cwd=folder,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
        assert run.returncode == 1, run.stderr
        assert run.stderr.splitlines()[-1].startswith("error: cannot write out/")
        assert {path: path.read_text() for path in (folder / "out").iterdir()} == before
    # With room for all of them it would have been replaced.
    size = sizes[-1] + 100000
    run = ruche("simulate", "d.svg", *COARSE, "-o", "out", cwd=folder,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))
    assert run.returncode == 0, run.stderr
    assert "earlier" not in report(folder / "out")


def test_a_file_in_place_of_the_folder_is_an_error_before_any_work(folder):
    (folder / "out").write_text("mine")
    for output in "out", "out/deeper":
        run = ruche("simulate", "d.svg", *COARSE, "-o", output, cwd=folder)
        assert run.returncode == 1
        assert "cannot write" in run.stderr and "release" not in run.stderr
        assert (folder / "out").read_text() == "mine"
    run = ruche("pattern", "strip", "-o", "out/x.svg", cwd=folder)
    assert run.returncode == 1 and "cannot write" in run.stderr


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_an_error(folder):
    (folder / "out").mkdir(mode=0o500)
    run = ruche("simulate", "d.svg", *COARSE, "-o", "out", cwd=folder)
    assert run.returncode == 1 and "cannot write" in run.stderr


def numbers(result):
    """What a report says of the shape."""
    values = report(result)
    return {key: values[key] for key in ("status", "stable", "energy_mJ", "residual_N", "mesh", "health", "shape", "strips")}


def test_umlauts_spaces_and_a_german_locale_change_nothing(finished, german, tmp_path):
    place = tmp_path / "Gewölbe für Öl"
    place.mkdir()
    (place / "Zeichnung ü 1.svg").write_text(DRAWING)
    (place / "Szene ß.toml").write_text('[pattern]\nsvg = "Zeichnung ü 1.svg"\n[fabric]\nmargin_mm = 1.0\n'
                                        "[output]\npicture = false\n")
    run = ruche("simulate", "Gewölbe für Öl/Szene ß.toml", "--set", "mesh.size_mm=1.0", "-o", "Gewölbe für Öl/Lösung 1",
                cwd=tmp_path, env=german)
    assert run.returncode == 0, run.stderr
    assert "," not in re.search(r"energy +(\S+)", run.stdout).group(1)
    plain, other = finished[0] / "d.out", place / "Lösung 1"
    assert numbers(other) == numbers(plain)
    # Neither names nor times stand in these: the same to the last byte.
    for name in "shape.ply", "layout.ply", "shape.vtu":
        assert (other / name).read_bytes() == (plain / name).read_bytes(), name
    again = ruche("simulate", str(other / "scene.toml"), "-o", "Lösung 2", cwd=tmp_path, env=german)
    assert again.returncode == 0, again.stderr
    assert numbers(tmp_path / "Lösung 2")["energy_mJ"] == numbers(plain)["energy_mJ"]


def test_bench_measures_a_release_without_any_file(tmp_path):
    run = ruche("bench", "--scene", "svg", "--triangles", "6000", "--threads", "1", "--json", cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["scene"] == "svg" and found["threads"] == 1
    assert abs(found["triangles"] / 6000 - 1) < 0.1
    assert found["unknowns"] > found["triangles"] * 1.5
    times = [found[key] for key in ("value_s", "gradient_s", "hessian_s", "factorization_s", "solve_s")]
    assert all(time > 0 for time in times)
    assert found["converged"] and found["stable"]
    assert found["levels"][-1]["factorizations"] == found["factorizations"] > 0
    # Parts of a release are not longer than the whole, and that is not mostly something else.
    assert 1 < found["equivalent_factorizations"] < 500
    assert abs(found["equivalent_factorizations"] * found["factorization_s"] / found["release_cpu_s"] - 1) < 1e-9
    assert found["peak_mb"] > found["factor_mb"] > 1
    assert list(tmp_path.iterdir()) == []


def test_bench_says_what_cannot_be_measured(tmp_path):
    wrong = ruche("bench", "--scene", "tours", cwd=tmp_path)
    assert wrong.returncode == 2 and "did you mean torus" in wrong.stderr
    small = ruche("bench", "--scene", "torus", "--triangles", "100", cwd=tmp_path)
    assert small.returncode == 2 and re.search(r"--triangles: .* 100 triangles\n  The nearest mesh has \d+", small.stderr)
    assert ruche("bench", "--triangles", "-5", cwd=tmp_path).returncode == 2
