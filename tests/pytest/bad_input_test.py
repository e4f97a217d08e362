"""What is wrong in the input ends in one clear message, exit code 2 and nothing written."""

import os
import subprocess

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
MM = 'width="60mm" height="60mm" viewBox="0 0 60 60"'


def svg(content, head=MM):
    return f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {head}>{content}</svg>'


def strip(path="M 10 30 H 50", style='stroke="black" stroke-width="1" fill="none"'):
    return svg(f'<path id="s" d="{path}" {style}/>')


PLY = """ply
format ascii 1.0
element vertex 3
property double x
property double y
property double z
element face 1
property list uchar int vertex_indices
property double front_mm
property double back_mm
end_header
0 0 0
{x} 0 0
0 10 0
3 {corners} {front} 0
"""
GOOD_PLY = PLY.format(x=10, corners="0 1 2", front=0.5)
GOOD = strip()
SCENE = '[pattern]\nsvg = "d.svg"\n'
STATE = b"ruche state 1\n" + bytes(200)
ENTITIES = "<!DOCTYPE svg [" + '<!ENTITY a0 "ha">' + "".join(
    f'<!ENTITY a{i} "' + f"&a{i - 1};" * 10 + '">' for i in range(1, 12)) + "]>"


def scene(text, **files):
    """A scene beside a good drawing, and the part of the message that matters."""
    return {"k.toml": SCENE + text, "d.svg": GOOD, **files}


# name: (files, arguments after `simulate`, what the message says)
CASES = {
    # the command line
    "no such scene": ({}, ["k.toml"], "k.toml: there is no such file"),
    "no such drawing": ({}, ["d.svg"], "d.svg: there is no such file"),
    "no such drawing in a scene": ({"k.toml": SCENE}, ["k.toml"], "d.svg: there is no such file"),
    "no argument": ({}, [], "scene"),
    "unknown option": (scene(""), ["k.toml", "--strech", "1.5"], "--strech"),
    "unknown kind of file": ({"k.txt": "a"}, ["k.txt"], "neither a scene (.toml)"),
    "dxf": ({"k.dxf": "0\nSECTION\n"}, ["k.dxf"], "DXF cannot be read yet"),
    "folder as scene": ({"k.toml/x": "a"}, ["k.toml"], "is a folder"),
    "set without value": (scene(""), ["k.toml", "--set", "fabric.prestretch"], "expected path=value"),
    "set of an unknown key": (scene(""), ["k.toml", "--set", "fabric.prestrech=1.5"], "did you mean prestretch?"),
    "set out of range": (scene(""), ["k.toml", "--set", "mesh.size_mm=-1"], "--set mesh.size_mm=-1: mesh.size_mm: -1"),
    "set through a value": (scene(""), ["k.toml", "--set", "pattern.svg.x=1"], "cannot be set inside"),
    "stretch is no number": ({"d.svg": GOOD}, ["d.svg", "--stretch", "much"], "--stretch much: fabric.prestretch: expected"),
    "stretch below 1": ({"d.svg": GOOD}, ["d.svg", "--stretch", "0.8"], "0.8 is outside [1, 3]"),
    "stretch beyond the law": ({"d.svg": GOOD}, ["d.svg", "--stretch", "1.75"], "beyond the fabric's law, which ends at 1.7103"),
    "side": ({"d.svg": GOOD}, ["d.svg", "--side", "top"], '"top" is none of front, back'),
    "width nan": ({"d.svg": GOOD}, ["d.svg", "--width-mm", "nan"], "not a finite number"),
    "resume nothing": (scene(""), ["k.toml", "--resume"], "state.ruche: there is no such file"),
    "start from a folder without a result": (scene("", **{"e/x": ""}), ["k.toml", "--start", "e"], "there is no such file"),
    "start from something else": (scene(""), ["k.toml", "--start", "d.svg"], "is not a state file"),
    "start from a damaged state": (scene("", s=STATE), ["k.toml", "--start", "s"], "damaged state file"),
    # the scene's text
    "empty scene": ({"k.toml": ""}, ["k.toml"], "k.toml: is empty"),
    "comment only": ({"k.toml": "# nothing\n"}, ["k.toml"], "is empty"),
    "binary scene": ({"k.toml": b"\x7fELF\x02\x01\x01" + bytes(100)}, ["k.toml"], "k.toml:1: is a binary file"),
    "png as scene": ({"k.toml": b"\x89PNG\r\n\x1a\n" + bytes(100)}, ["k.toml"], "is not UTF-8"),
    "utf-16 scene": ({"k.toml": SCENE.encode("utf-16")}, ["k.toml"], "UTF-16"),
    "latin-1 scene": ({"k.toml": (SCENE + "# M\xfcnchen").encode("latin-1")}, ["k.toml"], "k.toml:3: byte 0xFC is not UTF-8"),
    "truncated scene": ({"k.toml": '[pattern]\nsvg = "d.s'}, ["k.toml"], "k.toml:2: not valid TOML"),
    "duplicate key": (scene('svg = "e.svg"\n'), ["k.toml"], "k.toml:3: not valid TOML"),
    "huge scene": ({"k.toml": "#" + "x" * 5_000_000}, ["k.toml"], "longer than 4 MB"),
    "arrays 100,000 deep": ({"k.toml": "a = " + "[" * 100_000}, ["k.toml"], "k.toml:1: not valid TOML"),
    "tables 100,000 deep": ({"k.toml": "a = " + "{a=" * 100_000}, ["k.toml"], "k.toml:1: not valid TOML"),
    "keys 100,000 deep": ({"k.toml": "a" + ".a" * 100_000 + " = 1"}, ["k.toml"], "a key of more than 100 parts"),
    "scene in another encoding": ({"k.toml": '[pattern]\nsvg = "Zeichnung \N{EURO SIGN}.svg"'.encode("cp1252")}, ["k.toml"],
                                  "k.toml:2: byte 0x80 is not UTF-8"),
    "table headers 100,000 deep": ({"k.toml": "[a" + ".a" * 100_000 + "]"}, ["k.toml"], "a key of more than 100 parts"),
    # the scene's values
    "unknown key": (scene("[material]\nfabric_thicknes_mm = 1"), ["k.toml"],
                    "k.toml:4: material.fabric_thicknes_mm: unknown key; did you mean fabric_thickness_mm?"),
    "unknown table": (scene("[platic]\n"), ["k.toml"], "did you mean plastic?"),
    "text for a number": (scene('[mesh]\nsize_mm = "1"'), ["k.toml"], 'expected a number, found the text "1"'),
    "number for a text": ({"k.toml": "[pattern]\nsvg = 3"}, ["k.toml"], "expected a text in quotes, found the integer 3"),
    "number for a table": (scene("", **{"k.toml": "mesh = 1\n" + SCENE}), ["k.toml"], "expected a table, [mesh]"),
    "nan": (scene("[mesh]\nsize_mm = nan"), ["k.toml"], "nan is not a finite number"),
    "infinity": (scene("[plastic]\nthickness_mm = inf"), ["k.toml"], "inf is not a finite number"),
    "nan by --set": (scene(""), ["k.toml", "--set", "plastic.thickness_mm=nan"], "nan is not a finite number"),
    "1e9 mm thick": (scene("[plastic]\nthickness_mm = 1e9"), ["k.toml"], "k.toml:4: plastic.thickness_mm: 1000000000 is outside"),
    "1e9 mm wide by option": ({"d.svg": GOOD}, ["d.svg", "--width-mm", "1e9"], "--width-mm 1e9: pattern.width_mm: 1000000000 is outside"),
    "moved by 1e9 mm": (scene("[[support]]\npoint_mm = [1, 1]\nmove_mm = [0, 0, 1e9]"), ["k.toml"],
                        "k.toml:5: support.1.move_mm: 1000000000 is outside"),
    "negative density": (scene("[material]\nplastic_density_kg_per_m3 = -1"), ["k.toml"], "-1 is outside [0, 30000]"),
    "no stiffness": (scene("[material]\n" + "".join(f"{key}_mpa = 0\n" for key in (
        "alpha_1", "alpha_2", "beta_1", "beta_2", "fabric_youngs_modulus"))), ["k.toml"], "the fabric has no stiffness at all"),
    "1e9 mm": (scene("[fabric]\nmargin_mm = 1e9"), ["k.toml"], "1000000000 is outside"),
    "thickness 0": (scene("[plastic]\nthickness_mm = 0"), ["k.toml"], "0 is outside [0.001, 50]"),
    "three pre-stretches": (scene("[fabric]\nprestretch = [1.5, 1.5, 1.5]"), ["k.toml"], "an array of 3"),
    "stretch beyond the law along one axis": (scene("[fabric]\nprestretch = [1.5, 1.8]"), ["k.toml"],
                                              "k.toml:4: fabric.prestretch: 1.8 is beyond the fabric's law"),
    "no pattern": ({"k.toml": "[fabric]\nprestretch = 1.5"}, ["k.toml"], "there is nothing to simulate"),
    "drawing and mesh": (scene('mesh = "m.ply"'), ["k.toml"], "k.toml:3: pattern.mesh: contradicts pattern.svg"),
    "drawing and generator": (scene('generator = "strip"'), ["k.toml"], "contradicts pattern.svg"),
    "gravity without support": (scene("[gravity]\nacceleration_mm_per_s2 = [0, 0, -9810]"), ["k.toml"],
                                "gravity without a support or a table"),
    "table without gravity": (scene("[gravity]\ntable = true"), ["k.toml"], "holds nothing without gravity"),
    "force without support": (scene("[[force]]\npoint_mm = [10, 30]\nforce_n = [0, 0, 1]"), ["k.toml"],
                              "a force without a support"),
    "weightless on a table": (scene("[gravity]\nacceleration_mm_per_s2 = [0, 0, -9810]\ntable = true\n[material]\n"
                                    "plastic_density_kg_per_m3 = 0\nfabric_areal_density_kg_per_m2 = 0"), ["k.toml"],
                              "k.toml:5: gravity.table: piece 1 of 1 of the sheet has no weight"),
    "support that holds nothing": (scene("[[support]]\nmin_mm = [900, 0]\nmax_mm = [901, 1]"), ["k.toml"],
                                   "k.toml:3: support.1: there is no vertex"),
    "support inside out": (scene("[[support]]\nmin_mm = [9, 0]\nmax_mm = [1, 1]"), ["k.toml"], "inside out"),
    "too many triangles": (scene("[mesh]\nsize_mm = 0.01\nfabric_size_mm = 0.01"), ["k.toml"], "triangles, at most"),
    "unknown card": (scene('[fabric]\ncard = "spandex-tpu95"'), ["k.toml"], "did you mean spandex-tpu95a?"),
    "no such card file": (scene('[fabric]\ncard = "c.toml"'), ["k.toml"], "c.toml"),
    "truncated card": (scene('[fabric]\ncard = "c.toml"', **{"c.toml": 'name = "x'}), ["k.toml"], "c.toml:1: not valid TOML"),
    "incomplete card": (scene('[fabric]\ncard = "c.toml"', **{"c.toml": 'name = "x"\n[[set]]\nprestretch = 1.5\n'}), ["k.toml"],
                        "c.toml"),
    "card without sets": (scene('[fabric]\ncard = "c.toml"', **{"c.toml": 'name = "x"\n'}), ["k.toml"], "has no [[set]]"),
    "unknown generator": ({"k.toml": 'pattern.generator = "radail"'}, ["k.toml"], "did you mean radial?"),
    "unknown option of a generator": ({"k.toml": 'pattern.generator = "strip"\npattern.options.lenght_mm = 9'},
                                      ["k.toml"], "k.toml:2: pattern.options.lenght_mm"),
    "generator option out of range": ({"k.toml": 'pattern.generator = "strip"\npattern.options.width_mm = -1'},
                                      ["k.toml"], "k.toml:2: pattern.options.width_mm"),
    "generator contradicts itself": (
        {"k.toml": '[pattern]\ngenerator = "radial"\n[pattern.options]\ninner_mm = 30\nouter_mm = 20'}, ["k.toml"], "30 is not smaller than outer_mm = 20"),
    # the drawing
    "empty drawing": ({"d.svg": ""}, ["d.svg"], "d.svg: is empty"),
    "binary drawing": ({"d.svg": bytes(range(256)) * 4}, ["d.svg"], "d.svg: is not text"),
    "text as drawing": ({"d.svg": "hello"}, ["d.svg"], "d.svg:1: is not well-formed XML"),
    "truncated drawing": ({"d.svg": GOOD[:-20]}, ["d.svg"], "seems to be cut off"),
    "html as drawing": ({"d.svg": "<html><body/></html>"}, ["d.svg"], "<html>, not <svg>"),
    "drawing without shapes": ({"d.svg": svg("")}, ["d.svg"], "nothing is printed: the drawing has no visible lines"),
    "only text is drawn": ({"d.svg": svg('<text x="3" y="9">print me</text>')}, ["d.svg"], "d.svg:1: text: text is not printed"),
    "everything is hidden": ({"d.svg": strip(style='stroke="black" stroke-width="1" display="none"')}, ["d.svg"], "path 's': is hidden"),
    "everything is ignored": (scene('[[plastic.rule]]\nmatch = "black"\nrole = "ignore"'), ["k.toml"], "the rules leave no shape as a strip"),
    "strip of width 0": ({"d.svg": strip(style='stroke="black" stroke-width="0" fill="none"')}, ["d.svg"], "has neither fill nor stroke"),
    "strip of 0.01 mm": ({"d.svg": strip(style='stroke="black" stroke-width="0.01" fill="none"')}, ["d.svg"], "element 's': is 0.01 mm wide"),
    "strip of length 0": ({"d.svg": strip("M 10 10 h 0")}, ["d.svg"], "covers nothing"),
    "nan in a path": ({"d.svg": strip("M nan 10 H 50")}, ["d.svg"], "a number expected at 'nan 10"),
    "nan as page width": ({"d.svg": svg('<path d="M 1 1 H 9" stroke="black"/>', 'width="nan" height="9mm" viewBox="0 0 9 9"')},
                          ["d.svg"], "d.svg:1: svg: width: 'nan' is not a length"),
    "1e9 mm wide strip": ({"d.svg": strip(style='stroke="black" stroke-width="1e9" fill="none"')}, ["d.svg"],
                          "d.svg:1: path 's': reaches to"),
    "1e400 in a path": ({"d.svg": strip("M 1e400 10 H 50")}, ["d.svg"], "a number expected at '1e400 10"),
    "1e9 mm in a path": ({"d.svg": strip("M 0 10 H 1e9")}, ["d.svg"], "d.svg:1: path 's': reaches to (1e+09, 50) mm"),
    "unknown path command": ({"d.svg": strip("M 10 10 K 50")}, ["d.svg"], "expected at 'K 50'"),
    "transform to nothing": ({"d.svg": svg('<g transform="scale(0)"><path d="M 1 1 H 9" stroke="black"/></g>')},
                             ["d.svg"], "covers nothing"),
    "page of 0 mm": ({"d.svg": svg('<path d="M 1 1 H 9" stroke="black"/>',
                                   'width="0mm" height="0mm" viewBox="0 0 60 60"')}, ["d.svg"], "'0mm' is not positive"),
    "page of 1e9 mm": ({"d.svg": svg('<path d="M 1 1 H 9" stroke="black"/>',
                                     'width="1e9mm" height="1e9mm" viewBox="0 0 60 60"')}, ["d.svg"], "the page is 1e+09 x 1e+09 mm"),
    "self-crossing outline": (
        {"d.svg": svg('<path id="o" d="M 0 0 L 50 50 L 50 0 L 0 50 Z" stroke="blue" fill="none"/>'
                      '<path d="M 10 30 H 40" stroke="black" stroke-width="1"/>'),
         "k.toml": SCENE + '[fabric]\noutline = "blue"'}, ["k.toml"], "crosses or touches itself near x = 25, y = 35 mm"),
    "open outline": (
        {"d.svg": svg('<path id="o" d="M 0 0 L 50 0 L 50 50" stroke="blue" fill="none"/>'
                      '<path d="M 10 30 H 40" stroke="black" stroke-width="1"/>'),
         "k.toml": SCENE + '[fabric]\noutline = "blue"'}, ["k.toml"], "is not closed: it ends near x = 50, y = 10 mm"),
    "no outline of that name": (scene('[fabric]\noutline = "bleu"'), ["k.toml"], "no shape matches the fabric outline 'bleu'"),
    "everything beyond the fabric": (
        {"d.svg": svg('<path id="o" d="M 0 0 H 9 V 9 Z" stroke="blue" fill="none"/>'
                      '<path d="M 20 30 H 40" stroke="black" stroke-width="1"/>'),
         "k.toml": SCENE + '[fabric]\noutline = "blue"'}, ["k.toml"], "all strips lie outside the fabric"),
    "plastic none and nothing to bound the fabric": (
        {"d.svg": svg(""), "k.toml": 'plastic = "none"\n' + SCENE}, ["k.toml"], "d.svg"),
    "everything is in the layer of the fabric": (
        {"d.svg": svg('<g id="Fabric"><path d="M 0 0 H 9 V 9 Z" stroke="blue" fill="none"/></g>')}, ["d.svg"],
        "Layer 'Fabric' is taken as the fabric's outline for its name"),
    "open outline in the layer of the fabric": (
        {"d.svg": svg('<g id="fabric"><path id="o" d="M 0 0 H 50 V 50" stroke="blue" fill="none"/></g>'
                      '<path d="M 10 30 H 40" stroke="black" stroke-width="1"/>')}, ["d.svg"],
        "Layer 'fabric' is taken as the fabric's outline for its name"),
    "drawing in an unknown encoding": (
        {"d.svg": b'<?xml version="1.0" encoding="Shift_JIS"?>' + strip("M 10 30 H 50").replace('"s"', '"\u7d19"').encode("shift-jis")},
        ["d.svg"], "d.svg:1: the encoding 'shift_jis' is not supported"),
    "drawing that is not in the encoding it says": (
        {"d.svg": b'<?xml version="1.0" encoding="UTF-8"?>' + svg('<path id="\xfcber" d="M 1 1"/>').encode("latin-1")},
        ["d.svg"], "d.svg:1: the text is not UTF-8"),
    "entity bomb in a style": (
        {"d.svg": ENTITIES + strip(style='style="&a11;"')}, ["d.svg"], "covers nothing"),
    "entity bomb in a path": ({"d.svg": ENTITIES + strip("M &a11; 10 H 50")}, ["d.svg"], "a number expected at '&a11;"),
    "entity from a file": (
        {"d.svg": '<!DOCTYPE svg [<!ENTITY x SYSTEM "secret.txt">]>' + strip("&x;"), "secret.txt": "M 10 30 H 50"}, ["d.svg"],
        "nothing is printed"),
    "entity bomb": ({"d.svg": ENTITIES + svg("<text>&a11;</text>")}, ["d.svg"], "nothing is printed: the drawing has no visible lines"),
    "elements 100,000 deep": ({"d.svg": svg("<g>" * 100_000 + "</g>" * 100_000)}, ["d.svg"], "nested more than 200 deep"),
    "use of itself": ({"d.svg": svg('<g id="a"><use xlink:href="#a"/></g>')}, ["d.svg"], "refers to itself"),
    "use bomb": ({"d.svg": svg('<path id="u0" d="M 1 1 H 9" stroke="black"/>' + "".join(
        f'<g id="u{i}">' + f'<use href="#u{i - 1}"/>' * 10 + "</g>" for i in range(1, 12)))}, ["d.svg"], "repeat more than 100000 elements"),
    "dashes of 0.05 mm": ({"d.svg": strip(style='stroke="black" stroke-width="1" stroke-dasharray="0.05"')},
                          ["d.svg"], "is 0.05 mm wide"),
    # the layout mesh
    "empty mesh": ({"m.ply": ""}, ["m.ply"], "is not a PLY file"),
    "binary mesh": ({"m.ply": b"ply\nformat binary_little_endian 1.0\n" + bytes(99)}, ["m.ply"], "???\" in the header\n  A PLY for a layout has"),
    "truncated mesh": ({"m.ply": GOOD_PLY[:-8]}, ["m.ply"], "m.ply:15: face 0: the line ends too early"),
    "mesh with a corner too many": ({"m.ply": PLY.format(x=10, corners="0 1 3", front=0.5)}, ["m.ply"], "a corner is vertex 3"),
    "mesh with nan": ({"m.ply": PLY.format(x="nan", corners="0 1 2", front=0.5)}, ["m.ply"], "vertex 1: (nan, 0, 0) is not finite"),
    "mesh with a thickness of nan": ({"m.ply": PLY.format(x=10, corners="0 1 2", front="nan")}, ["m.ply"],
                                     "a printed thickness of nan mm"),
    "mesh of 1e9 mm": ({"m.ply": PLY.format(x=1e9, corners="0 1 2", front=0.5)}, ["m.ply"], "is more than 100 m away"),
    "mesh 1e9 mm thick": ({"m.ply": PLY.format(x=10, corners="0 1 2", front=1e9)}, ["m.ply"], "a printed thickness of 1000000000 mm"),
    "mesh with commas for points": ({"m.ply": PLY.format(x="10,5", corners="0 1 2", front=0.5)}, ["m.ply"],
                                    '"10,5" is not a number'),
    "mesh without thickness": ({"m.ply": GOOD_PLY.replace("front_mm", "f").replace("back_mm", "b")}, ["m.ply"],
                               "neither front_mm, back_mm nor thickness_mm"),
    "mesh with thickness in two ways": ({"m.ply": GOOD_PLY.replace("back_mm", "thickness_mm")}, ["m.ply"],
                                        "both thickness_mm and front_mm"),
    "mesh in utf-16": ({"m.ply": GOOD_PLY.encode("utf-16")}, ["m.ply"], "is not a PLY file"),
    "mesh that is not flat": ({"m.ply": GOOD_PLY.replace("0 10 0\n", "0 10 3\n")}, ["m.ply"], "the layout is not flat"),
    "mesh with negative thickness": ({"m.ply": PLY.format(x=10, corners="0 1 2", front=-0.5)}, ["m.ply"], "a printed thickness of -0.5 mm"),
    "mesh that is folded over": (
        {"m.ply": PLY.format(x=10, corners="0 1 2", front=0.5).replace("face 1", "face 2") + "3 0 2 1 0 0\n"},
        ["m.ply"], "1 of 2 triangles are clockwise"),
    "mesh without area": ({"m.ply": PLY.format(x=0, corners="0 1 2", front=0.5)}, ["m.ply"], "it lies on vertex 0"),
    "mesh with a billion vertices": ({"m.ply": GOOD_PLY.replace("vertex 3", "vertex 1000000000")}, ["m.ply"], "is not a number of vertex elements"),
    "obj that is none": ({"m.obj": "hello\n"}, ["m.obj"], "an OBJ says nothing about what is printed"),
    **{name: ({"k.toml": '[pattern]\nmesh = "m.obj"\nthickness_table = "t.csv"', "t.csv": table,
               "m.obj": "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"}, ["k.toml"], message) for name, table, message in (
        ("table with nan", "triangle,front_mm\n0,nan\n", "a printed thickness of nan mm"),
        ("table with a word", "triangle,front_mm\n0,thick\n", 't.csv:2: "thick" is not a thickness'),
        ("table with decimal commas", "0;0,5;0\n", "t.csv:1: 4 columns, expected 2 or 3"),
        ("table beyond the mesh", "1,0.5\n", "t.csv:1: there is no triangle 1"),
        ("table that says it twice", "0,0.5\n0,0.6\n", "t.csv:2: triangle 0 is listed twice"),
        ("binary table", bytes(range(256)), "t.csv:1"))},
    "no such thickness table": (
        {"k.toml": '[pattern]\nmesh = "m.obj"\nthickness_table = "t.csv"',
         "m.obj": "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"}, ["k.toml"], "t.csv: there is no such file"),
}


def snapshot(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_there_are_enough_cases():
    assert len(CASES) >= 60


@pytest.mark.parametrize("name", CASES)
def test_bad_input_ends_in_one_clear_message(name, tmp_path):
    files, arguments, message = CASES[name]
    for path, content in {**files, "out/report.json": '{"status": "converged"}'}.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_bytes(content if isinstance(content, bytes) else content.encode("utf-8"))
    before = snapshot(tmp_path)
    run = subprocess.run([PROGRAM, "simulate", *arguments, "-o", "out"], cwd=tmp_path, capture_output=True, timeout=600)
    error = run.stderr.decode("utf-8", errors="strict")
    assert run.returncode == 2, error[-2000:]
    assert run.stdout == b""
    assert all(c == "\n" or ord(c) >= 32 for c in error), repr(error)
    assert error.startswith("error: ") and error.count("error: ") == 1, error
    assert message in error, error
    assert len(error.splitlines()) <= 5 and len(error) < 1500, error
    assert snapshot(tmp_path) == before


@pytest.mark.parametrize("name", ["unknown key", "no such drawing", "support that holds nothing", "strip of 0.01 mm"])
def test_check_finds_the_same_mistakes(name, tmp_path):
    files, arguments, message = CASES[name]
    for path, content in files.items():
        (tmp_path / path).write_text(content)
    run = subprocess.run([PROGRAM, "check", *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert run.returncode == 2
    assert message in run.stderr
    assert run.stdout == ""


@pytest.mark.parametrize(
    "arguments, message",
    [
        ([], "subcommand"),
        (["simulat", "k.toml"], "did you mean simulate?"),
        (["pattern"], "subcommand"),
        (["pattern", "stripp", "-o", "t.svg"], "did you mean strip?"),
        (["pattern", "strip", "--width-mm", "-1", "-o", "t.svg"], "width_mm"),
        (["pattern", "strip", "--width-mm", "wide", "-o", "t.svg"], "width_mm"),
        (["cards", "spandex"], "there is no material card"),
        (["check"], "scene"),
    ],
)
def test_a_wrong_command_line_is_explained(arguments, message, tmp_path):
    run = subprocess.run([PROGRAM, *arguments], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert run.returncode == 2
    assert run.stderr.startswith("error: ") and message in run.stderr, run.stderr
    assert list(tmp_path.iterdir()) == []
