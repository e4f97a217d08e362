"""The locale of a program that uses the module does not matter: the command line never sets one, others may."""

import subprocess
import sys

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="20.5mm" height="10.5mm" viewBox="0 0 20.5 10.5">
<path id="strip" d="M 4.5 5.25 H 16.5" stroke="black" stroke-width="1.5" fill="none"/></svg>"""


def test_a_program_that_has_set_a_german_locale_gets_the_same_numbers(german, tmp_path):
    (tmp_path / "d.svg").write_text(DRAWING)
    (tmp_path / "k.toml").write_text('[pattern]\nsvg = "d.svg"\n[fabric]\nmargin_mm = 1.5\n')
    code = """if True:
        import json, locale, ruche, sys
        if sys.argv[1:]: locale.setlocale(locale.LC_ALL, "de_DE.UTF-8")
        result = ruche.simulate("k.toml", set=["fabric.prestretch=1.65", "mesh.size_mm=1.25"])
        report = result.report
        print(json.dumps([result.positions.tolist(), report["energy_mJ"], report["strips"], report["parameters"]]))"""
    outputs = [subprocess.check_output([sys.executable, "-c", code, *argument], cwd=tmp_path, env=german)
               for argument in ([], ["german"])]
    assert len(outputs[0]) > 1000
    assert outputs[0] == outputs[1]
