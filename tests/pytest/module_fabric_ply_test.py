"""The fabric under plastic with the law of bare fabric, against a quadrature of the theory page's formulas in NumPy."""

import numpy as np
import pytest

import ruche

NU_LAMINATE, H_FABRIC, H_PLASTIC = 0.4, 0.46, 0.6
S = np.array([1.7, 1.6])


def law(strain, m):
    """Psi~ (MPa) of (E11, E22, 2 E12): theory page, (1) to (5), inside the law."""
    alpha, beta, gamma = (np.array([m[f"{k}_1"], m[f"{k}_2"]]) for k in ("alpha", "beta", "gamma"))
    nu, modulus = m["fabric_poissons_ratio"], m["fabric_youngs_modulus"]
    e = strain[:2]
    assert np.all(e < gamma - 1e-3)
    own = 0.5 * (alpha * e**2).sum() + nu * np.sqrt(alpha.prod()) * e.prod()
    own = own / (1 - nu**2) + 0.5 * m["alpha_3"] * strain[2] ** 2
    own += (beta * ((gamma - e) * np.log((gamma - e) / gamma) + e)).sum()
    log_j = 0.5 * np.log((2 * e[0] + 1) * (2 * e[1] + 1) - strain[2] ** 2)
    mu, bulk = modulus / (2 * (1 + nu)), modulus * nu / (1 - nu**2)
    neo_hookean = 0.5 * mu * (2 * e.sum() - 2 * log_j) + 0.5 * bulk * log_j**2
    return (1 - m["neo_hookean_share"]) * own + m["neo_hookean_share"] * neo_hookean


def expected_energy(layout, shape, c, material, side):
    """Energy of one printed triangle whose edges i have c_i, mJ; both plies by 16 Gauss points."""
    edges = np.array([layout[1] - layout[0], layout[2] - layout[0]]).T
    now = np.array([shape[1] - shape[0], shape[2] - shape[0]]).T
    a = now.T @ now
    b = 2 * np.array([[c[0] + c[1], c[0]], [c[0], c[0] + c[2]]])
    area = 0.5 * np.linalg.det(edges)
    to_layout = np.linalg.inv(edges)
    to_relaxed = np.linalg.inv(np.diag(1 / S) @ edges)
    x, w = np.polynomial.legendre.leggauss(16)
    energy = 0.0
    for xq, wq in zip(0.5 * (x + 1), 0.5 * w):
        metric = a - 2 * (side * H_PLASTIC * xq) * b
        strain = to_layout.T @ metric @ to_layout - np.eye(2)
        density = NU_LAMINATE / (1 - NU_LAMINATE**2) * np.trace(strain) ** 2
        density += np.trace(strain @ strain) / (1 + NU_LAMINATE)
        energy += wq * H_PLASTIC * area * material.plastic_youngs_modulus / 8 * density
        metric = a - 2 * (-side * H_FABRIC * xq) * b
        green = 0.5 * (to_relaxed.T @ metric @ to_relaxed - np.eye(2))
        values = {key: getattr(material, key) for key in dir(material) if not key.startswith("_")}
        voigt = np.array([green[0, 0], green[1, 1], 2 * green[0, 1]])
        energy += wq * H_FABRIC * area / S.prod() * law(voigt, values)
    return energy


@pytest.mark.parametrize("side", [1, -1])
def test_energy_of_a_printed_triangle_is_a_numpy_quadrature(side):
    layout = np.array([[0.0, 0.0], [1.1, 0.1], [0.3, 0.9]])
    material = ruche.Material.preset("spandex-tpu95a")
    model = ruche.Model(ruche.Mesh(layout, np.array([[0, 1, 2]])), np.array([side * H_PLASTIC]), material,
                        prestretch=tuple(S), fabric_ply="same_law")
    # Three rims: their c_i are the edge unknowns, edge i opposite vertex i.
    assert model.size == 9 + 3
    random = np.random.default_rng(4)
    for _ in range(5):
        x = model.initial()
        x[:9] += 0.01 * random.standard_normal(9)
        x[:9] *= 0.95
        x[9:] = 0.02 * random.standard_normal(3)
        expected = expected_energy(layout, x[:9].reshape(3, 3), x[9:], material, side)
        # Three points instead of 16 through a ply whose curvature stays below 0.2 /mm: a few 1e-6 at most.
        assert model.energy_terms(x)["plastic"] == pytest.approx(expected, rel=1e-5)
        assert model.energy(x) == pytest.approx(expected, rel=1e-5)


def test_consistent_modulus_makes_both_plies_pull_alike():
    material = ruche.Material.preset("spandex-tpu95a")
    modulus = ruche.consistent_fabric_modulus(material, 1.7)
    assert 0.10 < modulus < 0.12
    material.fabric_youngs_modulus = modulus
    assert ruche.consistent_fabric_modulus(material, 1.7) == pytest.approx(modulus, rel=1e-12)

    layout = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    mesh = ruche.Mesh(layout, np.array([[0, 1, 2], [0, 2, 3]]))

    def tension(fabric_ply):
        """Mean tension over both axes of the flat state on the frame; the plastic pulls at nothing there."""
        model = ruche.Model(mesh, np.full(2, 0.5), material, prestretch=1.7, fabric_ply=fabric_ply,
                            edge_normals="averaged")
        x = model.initial()
        return 0.5 * model.gradient(x) @ x

    assert tension("linear") == pytest.approx(tension("same_law"), rel=1e-9)
