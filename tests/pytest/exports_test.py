"""Other programs read what Ruche writes: meshio and assimp are the judges."""

import os
import re
import subprocess
from pathlib import Path

import meshio
import numpy as np
import pytest

BUILD = Path(os.environ["RUCHE_BUILD"])
RADIUS = 12.0  # of the rolled sample sheet, mm; 30 x 20 mm, printed on the front (convex) side
WIDTH = 20.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """All formats of the sample, in a folder with a space and an umlaut in its name."""
    path = tmp_path_factory.mktemp("exports of ü")
    subprocess.run(
        [BUILD / "tests" / "ruche_tests", "-tc=exporters: every format of a rolled sheet*"],
        env=os.environ | {"RUCHE_EXPORT_FOLDER": str(path)},
        check=True,
        capture_output=True,
    )
    return path


def triangles(mesh):
    return np.vstack([block.data for block in mesh.cells if block.type == "triangle"])


def test_meshio_reads_the_same_shape_from_every_format(folder):
    reference = meshio.read(folder / "shape.vtu")
    assert reference.points.shape == (31 * 21, 3)
    assert np.allclose(np.hypot(reference.points[:, 0], reference.points[:, 2]), RADIUS)
    for name in ("shape.ply", "shape.obj"):
        mesh = meshio.read(folder / name)
        assert np.array_equal(mesh.points, reference.points), name
        assert len(triangles(mesh)) == 2 * 30 * 20
    assert np.array_equal(triangles(meshio.read(folder / "shape.ply")), triangles(reference))


def test_layout_is_flat_and_has_the_connectivity_of_the_shape(folder):
    for ending in ("vtu", "ply", "obj"):
        layout = meshio.read(folder / f"layout.{ending}")
        shape = meshio.read(folder / f"shape.{ending}")
        assert np.all(layout.points[:, 2] == 0)
        assert np.array_equal(triangles(layout), triangles(shape))
        assert np.allclose(RADIUS * np.sin(layout.points[:, 0] / RADIUS), shape.points[:, 0])


def test_vtu_fields_are_the_closed_form_of_a_roll(folder):
    mesh = meshio.read(folder / "shape.vtu")
    cells = {name: blocks[0] for name, blocks in mesh.cell_data.items()}
    assert sorted(set(cells["front_mm"])) == [0, 0.4, 0.6]
    assert sorted(set(cells["back_mm"])) == [0, 0.5, 0.8]
    assert np.array_equal(cells["side"], (cells["front_mm"] > 0) + 2 * (cells["back_mm"] > 0))
    assert np.array_equal(cells["strip"] >= 0, cells["side"] > 0)
    assert np.allclose(cells["curvature_max_per_mm"], 1 / RADIUS, rtol=0.01)
    assert np.allclose(cells["mean_curvature_per_mm"], 0.5 / RADIUS, rtol=0.01)
    assert np.allclose(cells["gauss_curvature_per_mm2"], 0, atol=1e-4)
    assert np.allclose(cells["stretch_max"], 1, atol=1e-6)
    assert np.allclose(cells["stretch_min"], 1, atol=0.001)  # chords are shorter than arcs
    assert np.all(cells["energy_density_mJ_per_mm2"] == 0.25)
    normal = np.column_stack([mesh.points[:, 0], np.zeros(len(mesh.points)), mesh.points[:, 2]]) / RADIUS
    assert np.allclose(mesh.point_data["normal"], normal, atol=0.05)
    assert np.array_equal(mesh.point_data["layout_mm"][:, :2], meshio.read(folder / "layout.vtu").points[:, :2])


def test_ply_carries_the_same_fields_as_vtu(folder):
    vtu = meshio.read(folder / "shape.vtu")
    ply = meshio.read(folder / "shape.ply")
    for name in ("curvature_max_per_mm", "gauss_curvature_per_mm2"):
        assert np.array_equal(ply.point_data[name], vtu.point_data[name])
    for name in ("front_mm", "back_mm", "side", "strip", "stretch_max", "mean_curvature_per_mm"):
        assert np.array_equal(ply.cell_data[name][0], vtu.cell_data[name][0])


def assimp_info(path):
    report = subprocess.run(["assimp", "info", path], check=True, capture_output=True, text=True).stdout
    values = {}
    for line in report.splitlines():
        if match := re.match(r"([A-Z][a-z]+(?: point)?):? +(.+)", line):
            values.setdefault(*match.groups())
    return report, values


@pytest.mark.parametrize("name", ["shape.obj", "shape.ply", "shape.stl", "layout.obj", "layout.ply", "layout.stl"])
def test_assimp_reads_every_triangle(folder, name):
    _, values = assimp_info(folder / name)
    assert int(values["Faces"]) == 2 * 30 * 20


def test_assimp_sees_the_strips_of_the_obj_and_their_materials(folder):
    report, values = assimp_info(folder / "shape.obj")
    assert int(values["Meshes"]) == 4
    for name in ("front_strip", "back_strip", "both", "plastic_front", "plastic_back", "fabric"):
        assert name in report


def point(text):
    return np.array([float(x) for x in text.strip("()").split()])


def test_assimp_reads_the_glb_in_metres_with_three_materials(folder):
    report, values = assimp_info(folder / "shape.glb")
    assert int(values["Meshes"]) == 3
    for name in ("fabric", "plastic_front", "plastic_back"):
        assert name in report
    low, high = point(values["Minimum point"]), point(values["Maximum point"])
    # The front strip is 0.6 mm thick where the roll is widest; y is up: our y (the roll's axis) goes to -z.
    assert high[0] == pytest.approx((RADIUS + 0.6) * 1e-3, abs=2e-5)
    assert [low[2], high[2]] == pytest.approx([-WIDTH * 1e-3, 0], abs=1e-6)


def test_assimp_converts_the_glb_to_another_format(folder, tmp_path):
    target = tmp_path / "again.stl"
    subprocess.run(["assimp", "export", folder / "shape.glb", target], check=True, capture_output=True)
    assert target.read_text().count("facet normal") > 2 * 30 * 20
