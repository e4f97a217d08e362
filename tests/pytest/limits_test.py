"""Runs that may not take as much memory or time as they would like: they stop before, with the shape so far."""

import json
import os
import resource
import subprocess
from pathlib import Path

import pytest

RUCHE = os.environ["RUCHE_PROGRAM"]
MEGABYTE = 1 << 20
SCENE = """
[pattern]
generator = "staggered"
[fabric]
margin_mm = 2
[mesh]
size_mm = 0.5
fabric_size_mm = 1.0
[output]
picture = false
"""


def simulate(folder, *options, address_space=None):
    scene = Path(folder) / "sheet.toml"
    scene.write_text(SCENE)

    def limit():
        if address_space:
            resource.setrlimit(resource.RLIMIT_AS, (address_space, address_space))

    return subprocess.run(
        [RUCHE, "simulate", scene, "-o", Path(folder) / "out", "--quiet", *options],
        preexec_fn=limit, capture_output=True, text=True, timeout=600,
    )  # fmt: skip


def report_of(folder):
    return json.loads((Path(folder) / "out/report.json").read_text())


def test_memory_limit_of_the_scene_stops_before_the_fine_mesh_and_keeps_the_coarse_shape(tmp_path):
    run = simulate(tmp_path, "--set", "solver.memory_limit_mb=1")
    assert run.returncode == 3, run.stderr
    report = report_of(tmp_path)
    assert report["status"] == "not_converged" and not report["stable"]
    assert "not enough memory" in report["message"]
    whole = simulate(tmp_path, "--resume")
    assert whole.returncode == 0, whole.stderr
    assert report_of(tmp_path)["status"] == "converged"


@pytest.mark.skipif("RUCHE_SANITIZED" in os.environ, reason="sanitizers reserve address space without end")
def test_address_space_limit_ends_with_a_result_or_a_message_never_with_a_crash_or_a_hang(tmp_path):
    seen = set()
    for megabytes in (200, 400, 520, 600, 700, 800, 1000, 2000):
        folder = tmp_path / str(megabytes)
        folder.mkdir()
        run = simulate(folder, address_space=megabytes * MEGABYTE)
        seen.add(run.returncode)
        if run.returncode == 1:
            assert run.stderr.startswith("error: ")
            assert not (folder / "out/report.json").exists()
        else:
            report = report_of(folder)
            assert (report["status"] == "converged") == (run.returncode == 0)
            if run.returncode == 3:
                assert "memory" in report["message"]
    assert 0 in seen and 1 in seen and seen <= {0, 1, 3}


def test_time_limit_keeps_the_shape_so_far_and_the_run_goes_on_from_it(tmp_path):
    run = simulate(tmp_path, "--set", "solver.time_limit_s=0.05")
    assert run.returncode == 3, run.stderr
    report = report_of(tmp_path)
    assert report["status"] == "not_converged" and "time limit" in report["message"]
    assert simulate(tmp_path, "--resume").returncode == 0
    assert report_of(tmp_path)["status"] == "converged"
