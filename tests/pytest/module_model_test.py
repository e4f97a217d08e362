"""The Python module as a researcher uses it: NumPy in, NumPy and SciPy out."""

import copy

import numpy as np
import pytest
import scipy.sparse

import ruche


def rectangle(length, width, nx, ny):
    """Right triangles on a grid, diagonals alternating."""
    points = [(length * i / nx, width * j / ny) for j in range(ny + 1) for i in range(nx + 1)]
    triangles = []
    for j in range(ny):
        for i in range(nx):
            a = j * (nx + 1) + i
            b, c, d = a + 1, a + nx + 1, a + nx + 2
            triangles += [(a, b, d), (a, d, c)] if (i + j) % 2 == 0 else [(a, b, c), (b, d, c)]
    return np.array(points), np.array(triangles)


def strip(thickness, **options):
    points, triangles = rectangle(30.0, 1.0, 30, 1)
    material = ruche.Material.preset("spandex-tpu95a")
    return ruche.Model(ruche.Mesh(points, triangles), np.full(len(triangles), thickness), material, **options)


def test_preset_is_table_1_and_fields_are_checked():
    material = ruche.Material.preset("spandex-tpu95a")
    assert material.plastic_youngs_modulus == 72.3
    assert material.alpha_1 == 0.024161
    material.fabric_thickness = 0.5
    assert material.fabric_thickness == 0.5
    with pytest.raises(ruche.InputError, match="fabric_thickness"):
        material.fabric_thickness = -1.0
    other = copy.copy(material)
    other.beta_1 = 0.0
    assert material.beta_1 == 0.029676


def test_gradient_and_hessian_belong_to_the_energy():
    points, triangles = rectangle(6.0, 4.0, 6, 4)
    plastic = np.where(points[triangles].mean(axis=1)[:, 1] < 2.0, 0.4, 0.0)
    material = ruche.Material.preset("spandex-tpu95a")
    model = ruche.Model(ruche.Mesh(points, triangles), plastic, material, prestretch=(1.6, 1.4), fabric_axis_deg=20.0)
    random = np.random.default_rng(1)
    x = model.initial() + 0.05 * random.standard_normal(model.size)
    v = random.standard_normal(model.size)

    def slope(f, h):
        return (f(x + h * v) - f(x - h * v)) / (2 * h)

    def richardson(f, h=1e-4):
        return (4 * slope(f, h / 2) - slope(f, h)) / 3

    assert richardson(model.energy) == pytest.approx(model.gradient(x) @ v, rel=1e-8)
    hessian = model.hessian(x)
    assert scipy.sparse.isspmatrix_csc(hessian)
    product = hessian @ v
    assert np.abs(richardson(model.gradient) - product).max() < 1e-8 * np.abs(product).max()
    assert sum(model.energy_terms(x).values()) == pytest.approx(model.energy(x), rel=1e-14)
    assert set(model.energy_terms(x)) == {"fabric_membrane", "fabric_bending", "plastic", "gravity"}


def test_solve_bends_the_strip_like_a_bimetal():
    result = ruche.solve(strip(0.6))
    assert result.converged and result.stable
    assert result.residual <= 1e-9
    assert result.positions.shape == (62, 3)
    middle = 0.5 * (result.positions[:31] + result.positions[31:])
    a, b, c = middle[10], middle[15], middle[20]
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a))
    curvature = 4 * area / (np.linalg.norm(b - a) * np.linalg.norm(c - b) * np.linalg.norm(c - a))
    assert curvature == pytest.approx(0.152362385, rel=1e-4)


def test_back_print_and_two_columns_mean_the_same():
    negative = strip(-0.6)
    points, triangles = rectangle(30.0, 1.0, 30, 1)
    columns = np.tile([0.0, 0.6], (len(triangles), 1))
    both = ruche.Model(ruche.Mesh(points, triangles), columns, ruche.Material.preset("spandex-tpu95a"))
    x = negative.initial() + 0.01 * np.sin(np.arange(negative.size))
    assert both.energy(x) == negative.energy(x)
    assert both.energy(x) != strip(0.6).energy(x)


def test_pins_hold():
    points, triangles = rectangle(10.0, 4.0, 10, 4)
    left = np.flatnonzero(points[:, 0] == 0.0)
    pins = {int(v): (0.0, float(points[v, 1]), 0.0) for v in left}
    pins |= {int(v): (12.0, None, 0.0) for v in np.flatnonzero(points[:, 0] == 10.0)}
    material = ruche.Material.preset("spandex-tpu95a")
    model = ruche.Model(ruche.Mesh(points, triangles), np.zeros(len(triangles)), material, prestretch=1.3, pins=pins)
    result = ruche.solve(model)
    assert result.converged and result.stable
    assert result.positions[left, 0] == pytest.approx(0.0, abs=1e-12)
    assert result.positions[points[:, 0] == 10.0, 0] == pytest.approx(12.0, abs=1e-12)


def test_laminate_density_of_one_ply_is_its_plate_energy():
    nu, modulus, t, k = 0.4, 72.3, 0.6, 0.01
    plies = [(-t / 2, t / 2, modulus, np.eye(2))]
    density = ruche.laminate_energy_density(np.eye(2), np.diag([k, 0.0]), plies, nu)
    assert density == pytest.approx(0.5 * modulus * t**3 / (12 * (1 - nu**2)) * k**2, rel=1e-12)


@pytest.mark.parametrize(
    "broken, message",
    [
        ({"plastic_mm": np.zeros(3)}, "plastic_mm"),
        ({"plastic_mm": np.full(60, np.nan)}, "triangle 0"),
        ({"prestretch": -1.0}, "prestretch"),
        ({"edge_normals": "free-ish"}, "edge_normals"),
        ({"no_such_switch": 1}, "no_such_switch"),
        ({"pins": [99]}, "99"),
    ],
)
def test_mistakes_are_named(broken, message):
    points, triangles = rectangle(30.0, 1.0, 30, 1)
    arguments = {"plastic_mm": np.zeros(len(triangles)), "material": ruche.Material()} | broken
    with pytest.raises(ruche.InputError, match=message):
        ruche.Model(ruche.Mesh(points, triangles), **arguments)


def test_wrong_length_of_x_is_refused():
    with pytest.raises(ruche.InputError, match="unknowns"):
        strip(0.6).energy(np.zeros(5))


def test_simulate_runs_a_scene(tmp_path):
    scene = tmp_path / "strip.toml"
    scene.write_text('[pattern]\ngenerator = "strip"\n[plastic]\nthickness_mm = 1.0\n')
    result = ruche.simulate(str(scene), set=["fabric.margin_mm=0"])
    assert result.converged and result.stable
    assert result.positions.shape == (len(result.layout), 3)
    assert result.report["status"] == "converged"
    assert result.report["energy_mJ"]["total"] == pytest.approx(result.energy)
