"""`ruche compare`: a result against scans of itself and photos, as another program writes them."""

import json
import os
import struct
import subprocess
import zlib

import numpy as np
import pytest

PROGRAM = os.environ["RUCHE_PROGRAM"]
# Three strips of different lengths: no motion takes the piece to itself.
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="30mm" viewBox="0 0 40 30"
stroke="black" stroke-width="1" fill="none"><path d="M 6 6 H 34"/><path d="M 6 12 H 20"/><path d="M 8 12 V 25"/></svg>"""


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    place = tmp_path_factory.mktemp("compare")
    (place / "d.svg").write_text(DRAWING)
    subprocess.run([PROGRAM, "simulate", "d.svg", "--quiet", "--set", "output.picture=false", "--set", "output.stl=true"],
                   cwd=place, check=True)
    return place / "d.out"


def compare(result, scan, *options):
    run = subprocess.run([PROGRAM, "compare", result, scan, *options], capture_output=True, text=True, timeout=600)
    report = result / "compare.json"
    return run, json.loads(report.read_text()) if run.returncode == 0 else None


def test_its_own_surface_in_inches_turned_and_shifted_is_found(result, tmp_path):
    points = np.array([line.split()[1:4] for line in (result / "shape.obj").read_text().splitlines() if line.startswith("v ")], float)
    turn, _ = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    placed = (points @ turn.T + [200, -40, 90]) / 25.4
    scan = tmp_path / "scan.ply"
    scan.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(placed)}\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
                    + "\n".join(" ".join(f"{x:.7f}" for x in p) for p in placed) + "\n")
    run, report = compare(result, scan)
    assert run.returncode == 0, run.stderr
    assert report["unit"] == "inch" and report["unit_guessed"] and "guessed" in run.stdout
    # The reference surface is the fabric's front here: on the skin where nothing is printed, below it where there is.
    assert report["rms_mm"] < 0.46
    placing = report["placing"]
    back = np.array(placing["rotation"]).reshape(3, 3) @ (25.4 * placed).T
    assert placing["scale"] == 1
    # Within a layer's thickness: the scan settles somewhere between the two skins.
    assert np.linalg.norm(back.T + placing["translation_mm"] - points, axis=1).max() < 1.2
    page = (result / "compare.html").read_text()
    assert "scan_distance_mm" in page and '"comparison"' in page


def test_a_scan_in_the_wrong_format_or_unit_is_refused(result, tmp_path):
    (tmp_path / "a.stl").write_text("nothing")
    run, _ = compare(result, tmp_path / "a.stl")
    assert run.returncode == 2 and "a.stl" in run.stderr
    run, _ = compare(result, result / "shape.stl", "--unit", "yard")
    assert run.returncode == 2 and "yard" in run.stderr
    run, _ = compare(result, result / "scene.toml")
    assert run.returncode == 2 and "neither OBJ, PLY nor STL" in run.stderr


def png(width, height, shade):
    """A grey picture as a PNG file; shade(x, y) gives 0 to 255."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    y, x = np.mgrid[0:height, 0:width]
    rows = np.pad(np.clip(shade(x, y), 0, 255).astype(np.uint8), ((0, 0), (1, 0)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


def test_a_silhouette_photo_gives_a_circle_in_mm(result, tmp_path):
    photo = tmp_path / "roll.png"
    # Edges as wide as a pixel: a disc of 150 pixels, 20 pixels per mm.
    photo.write_bytes(png(640, 480, lambda x, y: 230 - 180 * np.clip(150 - np.hypot(x - 320, y - 240) + 0.5, 0, 1)))
    run, report = compare(result, photo, "--known-length-mm", "30", "--known-length-at", "20,10,620,10")
    assert run.returncode == 0, run.stderr
    assert report["mm_per_px"] == pytest.approx(0.05)
    assert report["curvature_per_mm"] == pytest.approx(1 / 7.5, rel=1e-3)
    errors = report["relative_errors"]
    assert errors["scale"] == pytest.approx(2**0.5 / 600)  # a pixel at either end of 600
    assert 0 < errors["edge"] < 0.5 / 150  # somewhere in an edge that is as wide as a pixel
    assert errors["fit"] < 1e-3
    assert report["uncertainty_per_mm"] == pytest.approx(report["curvature_per_mm"] * np.linalg.norm(list(errors.values())))
    assert report["result_curvature_per_mm"] > report["result_outline_curvature_per_mm"] > 0
    assert f"{report['curvature_per_mm']:.5f} +-" in run.stdout and "silhouette.png" in run.stdout
    assert (result / "silhouette.png").read_bytes().startswith(b"\x89PNG")


def test_a_photo_without_scale_or_with_a_scans_options_is_refused(result, tmp_path):
    photo = tmp_path / "roll.png"
    photo.write_bytes(png(64, 48, lambda x, y: 200 + 0 * x))
    scale = "--known-length-mm", "30", "--known-length-at", "2,1,62,1"
    for options, said in [((), "--known-length-mm: is missing"), (scale + ("--unit", "cm"), "--unit: is for scans"), (scale, "stands out")]:
        run, _ = compare(result, photo, *options)
        assert run.returncode == 2 and said in run.stderr, run.stderr
    run, _ = compare(result, result / "shape.stl", *scale)
    assert run.returncode == 2 and "--known-length-mm: is for photos" in run.stderr
