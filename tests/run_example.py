"""Runs one example through the built program and checks what a reader of its README relies on.

usage: run_example.py PROGRAM SCENE OUTPUT_FOLDER
"""

import json
import shutil
import struct
import subprocess
import sys
from pathlib import Path


def png_size(path):
    """Width and height as the PNG's header states them."""
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n", f"{path} is not a PNG file"
    return struct.unpack(">II", head[16:24])


def main():
    program, scene, out = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    shutil.rmtree(out, ignore_errors=True)
    out.parent.mkdir(parents=True, exist_ok=True)
    run = subprocess.run([program, "simulate", str(scene), "-o", str(out)], stdin=subprocess.DEVNULL)
    assert run.returncode == 0, f"exit code {run.returncode}, expected 0: converged and stable"

    report = json.loads((out / "report.json").read_text())
    assert report["status"] == "converged", report["status"]
    assert report["stable"] is True
    assert 0 <= report["residual_N"] < 1e-6, report["residual_N"]
    assert report["energy_mJ"]["total"] > 0
    assert report["strips"], "no strip is reported"
    assert report["assumptions"], "the assumed fabric thickness and density must be named"
    assert png_size(out / "picture.png") == (1600, 1200)


if __name__ == "__main__":
    main()
