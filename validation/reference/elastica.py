"""Planar elastica under end loads and under their own weight: what a thin strip does that does not stretch.

    elastica.py                   writes the curves of validation/end-loaded-strip, pushed-strip and heavy-strip

Lengths over the strip's, loads over bending stiffness (docs/theory.md, section 5.8). The scenes: a strip of 100 x 10 mm
behind a clamp of 5 mm, two plies of 0.6 mm with E = 72.3 MPa and no Poisson's ratio.
"""

from functools import partial
from pathlib import Path

import numpy as np
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

LENGTH, WIDTH, CLAMP = 100.0, 10.0, 5.0  # mm
STIFFNESS = 72.3 * 1.2**3 / 12  # N mm, per width
FORCES = (0.01, 0.02, 0.04, 0.07, 0.1)  # N, across
PUSHES = (0.028, 0.032, 0.04, 0.06, 0.1)  # N, along; Euler's load is 0.0257 N
WEIGHT = 17686e-12 * 0.6  # t/mm^2
GRAVITY = (981.0, 2943.0, 9810.0, 29430.0, 98100.0, 294300.0)  # mm/s^2


def end_loaded(load):
    """Reach and drop of the tip under a dead force across, load = F L^2/B (Bisshopp and Drucker 1945)."""

    def from_tip(angle):
        m = (1 + np.sin(angle)) / 2
        start = np.arcsin(1 / np.sqrt(2 * m))
        return m, start, ellipk(m) - ellipkinc(start, m)

    tip = brentq(lambda angle: from_tip(angle)[2] - np.sqrt(load), 1e-9, np.pi / 2 - 1e-9, xtol=1e-15)
    m, start, root = from_tip(tip)
    return np.sqrt(2 * np.sin(tip)) / root, 1 - 2 * (ellipe(m) - ellipeinc(start, m)) / root


def pushed(load):
    """Reach and height of the tip under a dead force along, load = P L^2/B > pi^2/4 (Euler 1744; Love 1927, 262)."""
    m = brentq(lambda m: ellipk(m) - np.sqrt(load), 1e-12, 1 - 1e-12, xtol=1e-16)
    return 2 * ellipe(m) / ellipk(m) - 1, 2 * np.sqrt(m / ellipk(m) ** 2)


def heavy(load, tip_level):
    """Reach and drop of the end s = 1 of theta'' = -load (1 - s) cos theta, theta(0) = 0, where the end is free
    (theta' = 0), or level (theta = 0: the middle of a strip twice as long between two clamps, one of which slides)."""

    def slope(s, y, share):
        return np.array([y[1], -share * (1 - s) * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])])

    def ends(a, b):
        return np.array([a[0], b[0] if tip_level else b[1], a[2], a[3]])

    grid, guess = np.linspace(0, 1, 201), np.zeros((4, 201))
    for share in load * np.geomspace(1e-3, 1, 12):  # from the straight strip on
        solution = solve_bvp(partial(slope, share=share), ends, grid, guess, tol=1e-10, max_nodes=100000)
        assert solution.success, solution.message
        grid, guess = solution.x, solution.y
    return guess[2, -1], guess[3, -1]


def write(path, header, rows):
    path.write_text(header + "\n" + "".join(f"{x:g},{y:.6f}\n" for x, y in rows))


def main():
    folder = Path(__file__).resolve().parents[1]
    stiff = WIDTH * STIFFNESS / LENGTH**2  # N: F over load
    for name, forces, solve, sign in (("end-loaded-strip", FORCES, end_loaded, 1), ("pushed-strip", PUSHES, pushed, -1)):
        ends = [(sign * force, *solve(force / stiff)) for force in forces]
        write(folder / name / "reach.csv", "force_n,tip_x_mm", [(f, CLAMP + LENGTH * reach) for f, reach, _ in ends])
        write(folder / name / "height.csv", "force_n,tip_z_mm", [(f, LENGTH * height) for f, _, height in ends])
    for name, level in (("cantilever", False), ("between-clamps", True)):
        ends = [(-g, *heavy(WEIGHT * g * LENGTH**3 / STIFFNESS, level)) for g in GRAVITY]
        folder_of = folder / "heavy-strip"
        write(folder_of / f"{name}-reach.csv", "g_mm_per_s2,x_mm", [(g, CLAMP + LENGTH * reach) for g, reach, _ in ends])
        write(folder_of / f"{name}-height.csv", "g_mm_per_s2,z_mm", [(g, -LENGTH * drop) for g, _, drop in ends])


if __name__ == "__main__":
    main()
