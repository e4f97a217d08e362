"""Strips as elastic rods, from Python: energies against formulas in NumPy."""

import numpy as np
import pytest

import ruche


def three_rows(edges):
    """Squares of 1 mm in two rows; the vertices of the middle row."""
    points = np.array([(i, j - 1) for j in range(3) for i in range(edges + 1)], dtype=float)
    row = edges + 1
    triangles = []
    for a in (j * row + i for j in range(2) for i in range(edges)):
        triangles += [(a, a + 1, a + row + 1), (a + row + 1, a + row, a)]
    return points, np.array(triangles), list(range(row, 2 * row))


def rod_alone(edges, thickness, **options):
    points, triangles, middle = three_rows(edges)
    material = ruche.Material.preset("spandex-tpu95a")
    for name in ("alpha_1", "alpha_2", "alpha_3", "beta_1", "beta_2", "neo_hookean_share", "fabric_bending_stiffness"):
        setattr(material, name, 0.0)
    rods = [(middle, 1.2, thickness)]
    return ruche.Model(ruche.Mesh(points, triangles), np.zeros(len(triangles)), material, rods=rods, **options), points


@pytest.mark.parametrize("thickness", [0.6, -0.6])
def test_a_rod_on_a_circle_has_its_bending_energy(thickness):
    model, points = rod_alone(8, thickness)
    assert model.size == 3 * len(points) + 8
    natural = np.copysign(0.152362385, thickness)  # bimetal of Table 1, s = 1.7
    for turn in (-0.2, 0.0, 0.1):
        radius = np.inf if turn == 0.0 else 0.5 / np.sin(0.5 * turn)
        x = model.initial()
        if turn != 0.0:
            # A turn downwards, away from the front.
            x[: 3 * len(points)] = np.stack(
                [radius * np.sin(turn * points[:, 0]), points[:, 1], radius * (np.cos(turn * points[:, 0]) - 1)], axis=1
            ).ravel()
        strain = 2 * np.tan(0.5 * turn) - 2 * np.tan(0.5 * natural)
        expected = 7 * 0.5 * 72.3 * 1.2 * 0.6**3 / 12 * strain**2
        assert model.energy(x) == pytest.approx(expected, rel=1e-7)


def test_gradient_belongs_to_the_energy():
    model, points = rod_alone(4, 0.5, prestretch=(1.6, 1.4), fabric_axis_deg=20.0)
    random = np.random.default_rng(2)
    x = model.initial() + 0.05 * random.standard_normal(model.size)
    v = random.standard_normal(model.size)

    def slope(h):
        return (model.energy(x + h * v) - model.energy(x - h * v)) / (2 * h)

    assert (4 * slope(5e-4) - slope(1e-3)) / 3 == pytest.approx(model.gradient(x) @ v, rel=1e-8)


def test_rods_and_print_exclude_each_other():
    points, triangles, middle = three_rows(3)
    material = ruche.Material()
    with pytest.raises(ruche.InputError, match="strips"):
        ruche.Model(ruche.Mesh(points, triangles), np.full(12, 0.5), material, rods=[(middle, 1.0, 0.5)])
    with pytest.raises(ruche.InputError, match="edge"):
        ruche.Model(ruche.Mesh(points, triangles), np.zeros(12), material, rods=[([4, 6], 1.0, 0.5)])
