"""`ruche virtual-test` as a user runs it, and the sheets of the measuring protocol."""

import os
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
SOURCE = Path(os.environ["RUCHE_SOURCE"])
FEW = ("--angles-deg=0", "--elements-across=3", "--cantilever-lengths-mm=40", "--shear-side-mm=30")


def run(*arguments, status=0):
    done = subprocess.run([PROGRAM, "virtual-test", *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    return done


def contents(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def rows(path, encoding="utf-8"):
    return [line.split(",") for line in path.read_text(encoding=encoding).splitlines()]


def test_a_folder_has_a_record_for_each_sample_and_a_campaign_that_names_them(tmp_path):
    run("spandex-tpu95a", "-o", tmp_path / "lab", *FEW)
    campaign = tomllib.loads((tmp_path / "lab/campaign.toml").read_text())
    assert campaign["prestretch"] == 1.7
    for test, count in (("tension", 1), ("shear", 2), ("plastic_tension", 1)):
        assert len(campaign[test]) == count
        for sample in campaign[test]:
            table = rows(tmp_path / "lab" / sample["file"])
            assert table[0][:3] == ["time_s", "displacement_mm", "force_N"]
            assert len(table) > 100
    assert [(c["angle_deg"], c["side"]) for c in campaign["cantilever"]] == [
        (0, "front"),
        (0, "back"),
        (90, "front"),
        (90, "back"),
    ]
    tension = rows(tmp_path / "lab" / campaign["tension"][0]["file"])[1:]
    assert max(float(row[1]) for row in tension) == pytest.approx(77.0, abs=0.4)
    # Full scale of the paper's fabric at 70 %, 20 mm wide: 2.25 N by the homogeneous law.
    assert max(float(row[2]) for row in tension) == pytest.approx(2.25, rel=0.06)


def test_the_same_seed_gives_the_same_files_and_simulated_curves_are_kept(tmp_path):
    first = run("spandex-tpu95a", "-o", tmp_path / "lab", *FEW)
    assert "stand in" in first.stdout
    before = contents(tmp_path / "lab")
    again = run("spandex-tpu95a", "-o", tmp_path / "lab", *FEW)
    assert "are those of" in again.stdout
    assert contents(tmp_path / "lab") == before
    curves = tmp_path / "lab/curves.json"
    other = run("spandex-tpu95a", "-o", tmp_path / "other", "--curves", curves, "--seed=2", *FEW)
    assert "are those of" in other.stdout
    after = contents(tmp_path / "other")
    assert "curves.json" not in after
    assert after["tension-1.csv"] != before["tension-1.csv"]
    assert len(after["tension-1.csv"].splitlines()) == len(before["tension-1.csv"].splitlines())


def test_without_noise_the_way_back_is_the_curve_whatever_the_hysteresis(tmp_path):
    common = (*FEW, "--tests=tension", "--noise=0", "--cycles=1", "--curves", tmp_path / "curves.json")
    run("spandex-tpu95a", "-o", tmp_path / "a", "--hysteresis=0", *common)
    run("spandex-tpu95a", "-o", tmp_path / "b", "--hysteresis=0.2", *common)
    clean, loop = rows(tmp_path / "a/tension-1.csv")[1:], rows(tmp_path / "b/tension-1.csv")[1:]
    top = max(range(len(clean)), key=lambda i: float(clean[i][1]))
    assert clean[top + 1 :] == loop[top + 1 :]
    half = top // 2
    assert float(loop[half][2]) > float(clean[half][2]) + 0.3


def test_machines_write_in_their_own_ways(tmp_path):
    common = (*FEW, "--tests=tension", "--curves", tmp_path / "curves.json")
    run("spandex-tpu95a", "-o", tmp_path / "b", "--format=bluehill", *common)
    run("spandex-tpu95a", "-o", tmp_path / "z", "--format=zwick", *common)
    bluehill = (tmp_path / "b/tension-1.csv").read_bytes()
    zwick = (tmp_path / "z/tension-1.csv").read_bytes()
    assert b'"(s)","(mm)","(N)","(mm)"\r\n' in bluehill
    assert "Prüfzeit".encode("latin-1") in zwick
    last = zwick.decode("latin-1").splitlines()[-1]
    assert re.fullmatch(r"\d+,\d+;-?\d+,\d+;-?\d+,\d+;\d+,\d+", last)


@pytest.mark.parametrize(
    "arguments, complaint",
    [
        (("no-such-card",), "no-such-card"),
        (("spandex-tpu95a", "--tests=tensoin"), "did you mean tension"),
        (("spandex-tpu95a", "--angles-deg=0;90"), "0;90"),
        (("spandex-tpu95a", "--length-mm=-3"), "outside"),
        (("spandex-tpu95a", "--prestretch=1.8"), "1.8"),
        (("spandex-tpu95a", "--format=excel"), "excel"),
        (("spandex-tpu95a", "--grip-width-mm=10"), "dogbone"),
    ],
)
def test_mistakes_are_refused_and_nothing_is_written(tmp_path, arguments, complaint):
    done = run(*arguments, "-o", tmp_path / "lab", status=2)
    assert complaint in done.stderr
    assert not (tmp_path / "lab").exists()


def test_the_sheets_are_those_that_the_script_draws(tmp_path):
    script = SOURCE / "docs/protocol/make_sheets.py"
    subprocess.run([sys.executable, script, tmp_path], check=True)
    drawn = sorted(tmp_path.iterdir())
    assert len(drawn) == 4
    for path in drawn:
        assert path.read_text() == (SOURCE / "docs/protocol" / path.name).read_text(), path.name
        ElementTree.parse(path)


def check(scene):
    done = subprocess.run([PROGRAM, "check", str(scene)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_printed_sheet_is_a_drawing_of_nine_strips():
    text = check(SOURCE / "docs/protocol/printed-strips.svg")
    assert re.search(r"strips +9\n", text)
    assert "160 x 72 mm" in text
    assert "1080 mm^2 printed" in text


def test_the_protocols_scene_is_one_and_its_campaign_is_toml(tmp_path):
    protocol = (SOURCE / "docs/measuring-protocol.md").read_text()
    scene, campaign = re.findall(r"```toml\n(.*?)```", protocol, re.DOTALL)
    (tmp_path / "strip.toml").write_text(scene.replace("my-card.toml", "spandex-tpu95a"))
    assert "120 mm^2 printed" in check(tmp_path / "strip.toml")
    assert tomllib.loads(campaign)["tension"][0]["file"] == "strip-00.csv"
