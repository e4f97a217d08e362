"""`ruche calibrate` as a person meets it: the example campaign, exit codes, what is written and what is not."""

import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

RUCHE = os.environ["RUCHE_PROGRAM"]
EXAMPLE = Path(os.environ["RUCHE_SOURCE"]) / "examples/calibration"
TRUTH = {
    "alpha_1_mpa": 0.024161, "alpha_2_mpa": 0.090890, "alpha_3_mpa": 0.063419, "beta_1_mpa": 0.029676,
    "beta_2_mpa": 0.020512, "gamma_1": 0.9626, "gamma_2": 0.9637, "fabric_poissons_ratio": 0.3,
    "fabric_bending_stiffness_n_mm": 9.57e-3, "plastic_youngs_modulus_mpa": 72.3,
}  # fmt: skip


SVG = '<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M 1 1 H 8"/></svg>\n'
PDF = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n1 0 obj <</Type /Catalog>> endobj\nxref\n" + b"".join(
    b"%010d 00000 n\n" % (17 * i) for i in range(40)
)
# What people take for the readings, or for the campaign: text, bytes or what makes them, and what is said in either place.
OTHER_FILES = {
    "a drawing": (SVG, "is an XML or SVG file, expected a table as text", "campaign.toml:1: not valid TOML"),
    "a page": ("<!DOCTYPE html>\n<html><body>1,2</body></html>\n", "is an HTML or XML file", "campaign.toml:1: not valid TOML"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(range(256)), "is a picture (PNG)", "is not UTF-8 text"),
    "a photograph": (b"\xff\xd8\xff\xe0\0\x10JFIF" + bytes(range(256)), "is a picture (JPEG)", "is not UTF-8 text"),
    "a report": (PDF, "is a PDF, expected a table as text", "campaign.toml:2: byte 0xE2 is not UTF-8 text"),
    "a spreadsheet": (b"PK\x03\x04\x14\0\6\0" + bytes(99), "is a spreadsheet (xlsx, ods)", "campaign.toml"),
    "an old spreadsheet": (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(99), "is an old spreadsheet", "is not UTF-8 text"),
    "bytes": (bytes(range(256)) * 40, "is a binary file", "campaign.toml"),
    "nothing": ("", "raw.csv: is empty", "has neither [[tension]] nor [[printed]]"),
    "a letter": ("Dear Sir,\nthe knit was soft.\n", "has no table of numbers", "campaign.toml:1: not valid TOML"),
    "200 MB of readings": (lambda: b"time_s,displacement_mm,force_N\n" + b"0.1,1.5,2.5\n" * (200 * 2**20 // 12),
                           "5 to 50 readings a second are plenty", "is longer than 4 MB"),
}  # fmt: skip


def campaign_of(name, place):
    """A campaign of one test, with one of OTHER_FILES in place of the test's file or of the campaign itself."""
    content = OTHER_FILES[name][0]
    content = content() if callable(content) else content
    if place == "campaign.toml":
        return {place: content}
    test = '[[tension]]\nfile = "raw.csv"\nangle_deg = 0\nlength_mm = 110\nwidth_mm = 20\n'
    return {"campaign.toml": test, place: content}


def ruche(*arguments, cwd, **more):
    return subprocess.run([RUCHE, *arguments], cwd=cwd, capture_output=True, text=True, timeout=600, **more)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    place = tmp_path_factory.mktemp("calibrated")
    run = ruche("calibrate", EXAMPLE / "campaign.toml", "-o", "card.toml", cwd=place)
    assert run.returncode == 0, run.stderr
    return place, run


def test_the_example_gives_the_truth_back_within_its_intervals(finished):
    place, _ = finished
    values = tomllib.loads((place / "card.toml").read_text())["set"][0]
    inside = [name for name, truth in TRUTH.items() if values[name]["interval"][0] <= truth <= values[name]["interval"][1]]
    assert len(inside) >= len(TRUTH) - 1, {name: values[name] for name in TRUTH if name not in inside}
    assert values["alpha_1_mpa"]["value"] == pytest.approx(TRUTH["alpha_1_mpa"], rel=0.1)


def test_the_committed_card_of_the_example_is_the_one_that_comes_out(finished):
    place, _ = finished
    new = tomllib.loads((place / "card.toml").read_text())["set"][0]
    old = tomllib.loads((EXAMPLE / "card.toml").read_text())["set"][0]
    for name in TRUTH:
        assert new[name]["value"] == pytest.approx(old[name]["value"], rel=1e-5), name
        assert new[name].get("files") == old[name].get("files"), name


def test_files_are_named_with_the_hashes_that_sha256sum_gives(finished):
    place, _ = finished
    files = tomllib.loads((place / "card.toml").read_text())["set"][0]["alpha_1_mpa"]["files"]
    assert len(files) == 7
    for entry in files:
        name, digest = re.fullmatch(r"(\S+) sha256:([0-9a-f]{64})", entry).groups()
        told = subprocess.check_output(["sha256sum", EXAMPLE / "raw" / name], text=True)
        assert told.split()[0] == digest


def test_the_page_stands_alone(finished):
    place, _ = finished
    page = (place / "card.html").read_text()
    assert page.count("<svg") == page.count("</svg>") >= 10
    assert "http" not in page and "<script" not in page
    assert "NaN" not in page and "nan" not in re.sub(r"<[^>]*>", "", page)


def test_a_simulation_with_the_card_repeats_what_was_doubtful(finished):
    place, _ = finished
    (place / "strip.toml").write_text('[pattern]\ngenerator = "strip"\n[fabric]\ncard = "card.toml"\nprestretch = 1.6\n')
    run = ruche("check", "strip.toml", cwd=place)
    assert run.returncode == 0, run.stderr
    assert "working modulus" in run.stdout
    assert "plastic_density = 1210 kg/m^3 (assumed" in run.stdout


def test_a_mistake_ends_with_exit_code_2_and_writes_nothing(tmp_path):
    shutil.copytree(EXAMPLE, tmp_path / "c")
    broken = tmp_path / "c/raw/tension-30.csv"
    broken.write_bytes(b"\r\n".join(broken.read_bytes().split(b"\r\n")[:40]))
    run = ruche("calibrate", "c/campaign.toml", "-o", "card.toml", cwd=tmp_path)
    assert run.returncode == 2
    assert "c/raw/tension-30.csv:40: there is no unloading" in run.stderr
    assert not (tmp_path / "card.toml").exists() and not (tmp_path / "card.html").exists()


def test_decimal_commas_of_the_locale_change_nothing(finished, german, tmp_path):
    place, _ = finished
    run = ruche("calibrate", EXAMPLE / "campaign.toml", "-o", "card.toml", "--mode", "paper", cwd=tmp_path, env=german)
    assert run.returncode == 0, run.stderr
    plain = ruche("calibrate", EXAMPLE / "campaign.toml", "-o", "plain.toml", "--mode", "paper", cwd=tmp_path)
    assert plain.returncode == 0
    assert (tmp_path / "card.toml").read_text() == (tmp_path / "plain.toml").read_text()


@pytest.mark.parametrize("place", ["raw.csv", "campaign.toml"])
@pytest.mark.parametrize("name", OTHER_FILES)
def test_a_file_of_another_kind_is_refused_by_what_it_is(name, place, tmp_path):
    _, as_test, as_campaign = OTHER_FILES[name]
    files = campaign_of(name, place)
    for path, bytes_or_text in files.items():
        (tmp_path / path).write_bytes(bytes_or_text if isinstance(bytes_or_text, bytes) else bytes_or_text.encode())
    run = ruche("calibrate", "campaign.toml", "-o", "card.toml", "--quiet", cwd=tmp_path)
    assert run.returncode == 2, run.stderr
    assert run.stderr.startswith("error: ") and run.stderr.count("error: ") == 1
    assert place in run.stderr and (as_test if place == "raw.csv" else as_campaign) in run.stderr, run.stderr
    assert len(run.stderr.splitlines()) <= 4 and len(run.stderr) < 600
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(files)
    (tmp_path / place).unlink()  # it may be large, and pytest keeps the folder
