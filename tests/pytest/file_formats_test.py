"""docs/file-formats.md: its examples run, and its tables name what is really there."""

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
PAGE = (Path(os.environ["RUCHE_SOURCE"]) / "docs/file-formats.md").read_text()
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="10mm" viewBox="0 0 20 10">
<path id="strip" d="M 4 5 H 16" stroke="black" stroke-width="1" fill="none"/></svg>"""
SMALL = ["--set", "output.picture=false", "--quiet"]


def ruche(*arguments, cwd, code=0):
    run = subprocess.run([PROGRAM, *arguments], cwd=cwd, capture_output=True, text=True, timeout=600)
    assert run.returncode == code, run.stderr
    return run.stdout


def example(language, containing=""):
    """The only code block in a language that contains a text."""
    blocks = [block for block in re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) if containing in block]
    assert len(blocks) == 1
    return blocks[0]


def section(title):
    return re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE).group(1)


def first_column(text):
    """The names in backticks in the first cells of a section's tables."""
    cells = re.findall(r"^\|([^|]*)\|", text, re.MULTILINE)
    return {name for cell in cells for name in re.findall(r"`([^`]+)`", cell)}


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    place = tmp_path_factory.mktemp("result")
    (place / "d.svg").write_text(DRAWING)
    (place / "k.toml").write_text('[pattern]\nsvg = "d.svg"\n[fabric]\nmargin_mm = 1\n[[plastic.rule]]\nmatch = "black"\n'
                                  "youngs_modulus_mpa = 30\n")
    ruche("simulate", "k.toml", *SMALL, cwd=place)
    return place / "k.out"


def test_every_code_block_is_tried():
    languages = re.findall(r"^```(\w+)$", PAGE, re.MULTILINE)
    assert sorted(languages) == ["csv", "obj", "ply", "toml", "toml"]


def test_the_smallest_scene(tmp_path):
    ruche("pattern", "radial", "-o", "torus.svg", cwd=tmp_path)
    (tmp_path / "k.toml").write_text(example("toml", "torus.svg"))
    out = ruche("check", "k.toml", "--set", "fabric.prestretch=1.6", cwd=tmp_path)
    assert re.search(r"^strips +80$", out, re.MULTILINE)
    # The drawing has a layer "fabric", as the page says of outlines.
    assert 'fabric.outline = the drawing\'s layer "fabric"' in out


def test_rules_by_nested_groups_and_their_overrides(tmp_path):
    (tmp_path / "d.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="0 0 60 60"><g id="outer"><g id="inner">'
        '<path id="a" d="M 10 20 H 50" stroke="red" stroke-width="1"/></g>'
        '<path id="b" d="M 10 40 H 50" stroke="red" stroke-width="1"/></g></svg>')
    (tmp_path / "k.toml").write_text('[pattern]\nsvg = "d.svg"\n[[plastic.rule]]\nmatch = "outer"\nthickness_mm = 0.5\n'
                                     '[[plastic.rule]]\nmatch = "inner"\nthickness_mm = 0.9\n')
    ruche("simulate", "k.toml", "--set", "plastic.rule.1.side=back", "--set", "solver.max_iterations=1", *SMALL, cwd=tmp_path,
          code=3)
    prints = {}
    for line in (tmp_path / "k.out/layout.obj").read_text().splitlines():
        if line.startswith("g "):
            prints[line[2:]] = 0
    assert {"a", "b"} <= set(prints)
    header, body = (tmp_path / "k.out/layout.ply").read_text().split("end_header\n")
    names = re.findall(r"^property (?:list \w+ )?\w+ (\w+)$", header[header.index("element face"):], re.MULTILINE)
    rows = [line.split()[3:] for line in body.splitlines() if line.startswith("3 ")]
    faces = [dict(zip(names, row)) for row in rows if len(row) == len(names)]
    found = {(face["strip"], face["front_mm"], face["back_mm"]) for face in faces}
    assert found == {("-1", "0", "0"), ("0", "0.9", "0"), ("1", "0", "0.5")}


def test_the_material_card(tmp_path):
    (tmp_path / "d.svg").write_text(DRAWING)
    card = example("toml", "my-knit")
    built_in = ruche("cards", "spandex-tpu95a", cwd=tmp_path)
    fields = dict(re.findall(r"^(\w+) += (\{.*\})$", built_in, re.MULTILINE))
    missing = [f"{key} = {value}\n" for key, value in fields.items() if key not in card]
    assert len(missing) == len(fields) - 2
    (tmp_path / "my.toml").write_text(card.replace("[common]\n", "[common]\n" + "".join(missing)))
    out = ruche("check", "d.svg", "--stretch", "1.45", "--set", "fabric.card=my.toml", cwd=tmp_path)
    assert re.search(r"^material\.alpha_1_mpa +0\.031 MPa +measured 2026-03-02", out, re.MULTILINE)
    assert re.search(r"^material\.plastic_density_kg_per_m3 +1210 kg/m\^3 +data sheet", out, re.MULTILINE)


def test_the_layout_as_ply(tmp_path):
    (tmp_path / "m.ply").write_text(example("ply"))
    assert re.search(r"^layout +20 x 6 mm, 120 mm\^2, of which 20 mm\^2 printed$", ruche("check", "m.ply", cwd=tmp_path),
                     re.MULTILINE)
    ruche("simulate", "m.ply", "--set", "solver.max_iterations=1", *SMALL, cwd=tmp_path, code=3)
    assert [strip["id"] for strip in json.loads((tmp_path / "m.out/report.json").read_text())["strips"]] == ["left arm"]
    for properties, values, printed in (("property double thickness_mm", "-0.6", 20),
                                        ("property double back_mm\nproperty float back_modulus_mpa", "0.6 30", 20)):
        text = example("ply").replace("property double front_mm", properties).replace(" 0.6 ", f" {values} ")
        text = text.replace(" 0 -1\n", " " + " ".join(["0"] * len(values.split())) + " -1\n")
        (tmp_path / "m.ply").write_text(text)
        assert f"of which {printed} mm^2 printed" in ruche("check", "m.ply", cwd=tmp_path)


def test_the_layout_as_obj_with_a_table(tmp_path):
    (tmp_path / "m.obj").write_text(example("obj"))
    (tmp_path / "k.toml").write_text('[pattern]\nmesh = "m.obj"\nthickness_table = "t.csv"\n')
    table = example("csv")
    for variant in (table, table.replace(",", ";"), table.replace(",", "\t"), "# by hand\n0 0.6\n1 0.6 # both\n"):
        (tmp_path / "t.csv").write_text(variant)
        assert "20 mm^2, of which 20 mm^2 printed" in ruche("check", "k.toml", cwd=tmp_path)


def test_the_table_of_the_report_has_its_keys(result):
    report = json.loads((result / "report.json").read_text())
    text = section("report.json")
    assert first_column(text) - {"alternatives"} == set(report)  # that only with --alternatives
    named = set(re.findall(r"`([^`]+)`", text))
    for key in ("energy_mJ", "mesh", "solver", "health", "shape"):
        assert set(report[key]) <= named, key
    assert set(report["strips"][0]) <= named


def test_the_table_of_fields_has_those_of_the_files(result):
    table = first_column(section("Shape and layout")) - {".obj", ".mtl", ".ply", ".vtu", ".glb", "shape.stl"}
    header = (result / "shape.ply").read_text().split("end_header")[0]
    fields = set(re.findall(r"^property \w+ (\w+)$", header, re.MULTILINE)) - {"x", "y", "z"}
    assert table == fields
    read = first_column(section("Layout mesh"))
    assert {"front_mm", "back_mm", "front_modulus_mpa", "back_modulus_mpa", "strip"} <= read & table


def test_the_table_of_the_benchmark_has_its_keys(tmp_path):
    found = json.loads(ruche("bench", "--triangles", "3000", "--json", cwd=tmp_path))
    assert first_column(section("Benchmark")) == set(found)
    pieces = {"value_s", "gradient_s", "hessian_s", "factorization_s", "solve_s"}
    assert set(found["with_all_threads"]) == pieces <= set(found)
