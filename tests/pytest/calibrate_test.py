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
