"""The fabric's law (docs/theory.md, section 3) in a uniaxial tension test, in numpy and on its own: what `ruche` computes is
not used, so that one can be held against the other.

A material point is pulled at an angle to the first axis; its transverse and shear strain are free (S_tt = S_dt = 0).
Stresses in MPa. `Law` is a dict with the keys of a material card.
"""

import numpy as np

PARAMETERS = (
    "alpha_1_mpa",
    "alpha_2_mpa",
    "alpha_3_mpa",
    "beta_1_mpa",
    "beta_2_mpa",
    "gamma_1",
    "gamma_2",
    "fabric_poissons_ratio",
)


def strains_to_fabric_axes(angle_deg):
    """(E_dd, E_tt, 2 E_dt) along and across the pull to (E_11, E_22, 2 E_12)."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.array([[c * c, s * s, -c * s], [s * s, c * c, c * s], [2 * c * s, -2 * c * s, c * c - s * s]])


def stress(law, strain):
    """Second Piola-Kirchhoff stress (n, 3) at strains (n, 3), both in fabric axes; complex numbers pass through."""
    a1, a2, a3, b1, b2, g1, g2, nu = (law[key] for key in PARAMETERS)
    e1, e2, shear = strain[:, 0], strain[:, 1], strain[:, 2]
    c12 = nu * np.sqrt(a1 * a2)
    own = np.stack(
        [
            (a1 * e1 + c12 * e2) / (1 - nu * nu) - b1 * np.log(1 - e1 / g1),
            (c12 * e1 + a2 * e2) / (1 - nu * nu) - b2 * np.log(1 - e2 / g2),
            a3 * shear,
        ],
        axis=1,
    )
    modulus, share = law["fabric_youngs_modulus_mpa"], law["neo_hookean_share"]
    lam, mu = modulus * nu / (1 - nu * nu), modulus / (2 * (1 + nu))
    d11, d22, d12 = 1 + 2 * e1, 1 + 2 * e2, shear  # C = 2 E + I
    det = d11 * d22 - d12 * d12
    factor = (0.5 * lam * np.log(det) - mu) / det  # S_NH = mu I + (lambda ln J - mu) C^-1
    neo = np.stack([mu + factor * d22, mu + factor * d11, -factor * d12], axis=1)
    return (1 - share) * own + share * neo


def admissible(law, strain):
    inside = (strain[:, 0] < law["gamma_1"]) & (strain[:, 1] < law["gamma_2"])
    return inside & ((1 + 2 * strain[:, 0]) * (1 + 2 * strain[:, 1]) > strain[:, 2] ** 2)


def tangent(law, strain):
    """dS/dE (n, 3, 3) in fabric axes, by complex steps: exact to rounding."""
    step = 1e-30
    columns = []
    for k in range(3):
        moved = strain.astype(complex)
        moved[:, k] += 1j * step
        columns.append(stress(law, moved).imag / step)
    return np.stack(columns, axis=2)


def pull(law, angle_deg, stretches):
    """Strains (n, 3) in fabric axes at which nothing holds the width and the shear."""
    turn = strains_to_fabric_axes(angle_deg)
    along = 0.5 * (np.asarray(stretches, dtype=float) ** 2 - 1)
    local = np.stack([along, -0.3 * along / (1 + along), np.zeros_like(along)], axis=1)
    for _ in range(200):
        strain = local @ turn.T
        force = stress(law, strain) @ turn
        stiffness = turn.T @ tangent(law, strain) @ turn
        step = -np.linalg.solve(stiffness[:, 1:, 1:], force[:, 1:, None])[:, :, 0]
        length = np.ones(len(along))
        for _ in range(60):
            trial = local.copy()
            trial[:, 1:] += length[:, None] * step
            outside = ~admissible(law, trial @ turn.T)
            if not outside.any():
                break
            length[outside] *= 0.5
        local = trial
        if np.abs(step).max() < 1e-14:
            break
    else:
        raise ValueError(f"no equilibrium at {angle_deg} degrees")
    return local @ turn.T


def nominal_stress(law, angle_deg, stretches):
    turn = strains_to_fabric_axes(angle_deg)
    return np.asarray(stretches) * (stress(law, pull(law, angle_deg, stretches)) @ turn)[:, 0]


def derivatives(law, angle_deg, stretches):
    """Nominal stress and transverse Green strain along a pull, and both by PARAMETERS (n, 8)."""
    turn = strains_to_fabric_axes(angle_deg)
    stretches = np.asarray(stretches, dtype=float)
    strain = pull(law, angle_deg, stretches)
    local_stress = stress(law, strain) @ turn
    transverse = np.linalg.solve(turn, strain.T).T[:, 1]
    stiffness = turn.T @ tangent(law, strain) @ turn
    step = 1e-30
    by_parameter = np.stack(
        [stress({**law, key: law[key] + 1j * step}, strain.astype(complex)).imag @ turn / step for key in PARAMETERS], axis=2
    )
    # What is free follows: dE_f/dp = -T_ff^-1 dS_f/dp, dS_d/dp = dS_d/dp + T_df dE_f/dp.
    free = -np.linalg.solve(stiffness[:, 1:, 1:], by_parameter[:, 1:, :])
    along = by_parameter[:, 0, :] + np.einsum("nf,nfp->np", stiffness[:, 0, 1:], free)
    return stretches * local_stress[:, 0], transverse, stretches[:, None] * along, free[:, 0, :]
