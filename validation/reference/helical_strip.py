"""The infinitely long printed strip on fabric with oblique axes: a helix, by three functions across its width.

    helical_strip.py              writes the curves of validation/oblique-strip

A strip that is the same at every cross-section is moved along itself by a screw motion (docs/theory.md, section 5.7):

    r(X, Y) = turn by omega X about the axis of p(Y), then advance by c X along the axis

Nothing is assumed about twist and shear: omega, c and the curve p(Y) in space are found together. The laminate's energy
is minimised with polynomials across the width; nothing of the program's meshes, elements or solver is in it.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from infinite_strip import Laminate
from minimise import minimise
from numpy.polynomial import legendre

ANGLES = (0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0)  # degrees
WIDTH = 2.0  # mm


@dataclass
class ObliqueLaminate(Laminate):
    """Print on the front of fabric that is stretched by two factors along axes at an angle to the strip."""

    second_prestretch: float = 1.3
    axis_deg: float = 30.0

    def rest_metrics(self):
        """(z0, z1, Young's modulus, rest metric in the layout's axes) of each ply."""
        c, s = np.cos(np.radians(self.axis_deg)), np.sin(np.radians(self.axis_deg))
        axes = np.array([[c, -s], [s, c]])
        fabric = axes @ np.diag([1 / self.prestretch**2, 1 / self.second_prestretch**2]) @ axes.T
        return (
            (0.0, self.plastic_thickness, self.plastic_modulus, np.eye(2)),
            (-self.fabric_thickness, 0.0, self.fabric_modulus, fabric),
        )

    def full_density(self, a, b):
        """Energy per layout area for fundamental forms given as (11, 12, 22), arrays, mJ/mm^2."""
        nu = self.poisson

        def matrix(form):
            return np.array([[form[0], form[1]], [form[1], form[2]]])

        def trace(p, q):
            return np.einsum("ij...,ji...->...", p, q)

        def product(p, q):
            return nu / (1 - nu**2) * (p[0, 0] + p[1, 1]) * (q[0, 0] + q[1, 1]) + trace(p, q) / (1 + nu)

        total = 0.0
        for z0, z1, modulus, rest in self.rest_metrics():
            inverse = np.linalg.inv(rest)
            strain = np.einsum("ij,jk...->ik...", inverse, matrix(a))
            strain[0, 0] -= 1
            strain[1, 1] -= 1
            bend = np.einsum("ij,jk...->ik...", inverse, matrix(b))
            moments = ((z1 - z0) / 4, -(z1**2 - z0**2) / 2, (z1**3 - z0**3) / 3)
            total = total + 0.5 * modulus * np.sqrt(np.linalg.det(rest)) * (
                moments[0] * product(strain, strain) + moments[1] * product(strain, bend) + moments[2] * product(bend, bend)
            )
        return total


class HelicalStrip:
    """Unknowns: omega, c, and the coefficients of p(Y): the distance from the axis, and what is across and along it
    beyond the middle of the strip, which lies at angle and height 0."""

    def __init__(self, laminate, width, terms):
        self.laminate, self.half, self.terms = laminate, width / 2, terms
        nodes, weights = legendre.leggauss(2 * terms + 8)
        self.weights = weights / 2
        unit = np.eye(terms + 1)
        values, slopes, bends = (
            np.array([legendre.legval(nodes, legendre.legder(e, k)) for e in unit]).T / self.half**k for k in range(3)
        )
        self.at_middle = np.array([legendre.legval(0.0, e) for e in unit])
        self.bases = {0: values, 1: slopes, 2: bends}
        self.shifted = {0: (values - self.at_middle)[:, 1:], 1: slopes[:, 1:], 2: bends[:, 1:]}

    def curve(self, x, k):
        """The k-th derivative of p by Y at the nodes."""
        n = self.terms
        out, across, along = x[2 : 3 + n], x[3 + n : 3 + 2 * n], x[3 + 2 * n :]
        return np.array([self.bases[k] @ out, self.shifted[k] @ across, self.shifted[k] @ along])

    def energy(self, x):
        """Per layout area, for each column of x."""
        omega, advance = x[0], x[1]
        p, p1, p2 = (self.curve(x, k) for k in range(3))
        zero = 0 * p[0]
        r_x = np.array([-omega * p[1], omega * p[0], advance + zero])  # first index: the component in space
        r_xx = np.array([-(omega**2) * p[0], -(omega**2) * p[1], zero])
        r_xy = np.array([-omega * p1[1], omega * p1[0], zero])

        def dot(u, v):
            return np.sum(u * v, axis=0)

        a = dot(r_x, r_x), dot(r_x, p1), dot(p1, p1)
        normal = np.cross(r_x, p1, axis=0) / np.sqrt(a[0] * a[2] - a[1] ** 2)
        b = dot(normal, r_xx), dot(normal, r_xy), dot(normal, p2)
        return self.weights @ self.laminate.full_density(a, b)

    def gradients(self, x):
        """The gradient for each column of x, by complex steps: exact to rounding."""
        step, (n, m) = 1e-30, x.shape
        moved = x[:, :, None] + 1j * step * np.eye(n)[:, None, :]
        return (self.energy(moved.reshape(n, m * n)).imag / step).reshape(m, n).T

    def gradient_and_hessian(self, x):
        step, n = 1e-5, len(x)
        columns = self.gradients(x[:, None] + step * np.hstack([np.zeros((n, 1)), np.eye(n), -np.eye(n)]))
        hessian = (columns[:, 1 : 1 + n] - columns[:, 1 + n :]) / (2 * step)
        return columns[:, 0], (hessian + hessian.T) / 2

    def solve(self, x):
        """Stable among all states of this kind: twisted ones too."""
        return minimise(lambda x: self.energy(x[:, None])[0], self.gradient_and_hessian, x, still=1e-10, longest=0.5)


def helix(laminate, width=WIDTH, terms=8):
    """Curvature (positive where the back is concave) and torsion (positive: right-handed) of the centre line, 1/mm."""
    strip = HelicalStrip(laminate, width, terms)
    curvature, stretch = laminate.bimetal()
    x = np.zeros(3 + 3 * terms)
    x[0], x[2], x[3 + 2 * terms] = curvature * stretch, 1 / curvature, stretch * width / 2
    x = strip.solve(x)
    radius = strip.at_middle @ x[2 : 3 + terms]
    around, advance = x[0] * radius, x[1]
    squared = around**2 + advance**2
    return around * x[0] / squared, x[0] * advance / squared


def main():
    folder = Path(__file__).resolve().parents[1] / "oblique-strip"
    rows = []
    for angle in ANGLES:
        laminate = ObliqueLaminate(axis_deg=angle)
        coarse, fine = (np.array(helix(laminate, terms=n)) for n in (7, 10))
        assert np.max(np.abs(coarse - fine)) < 2e-9, (angle, coarse, fine)
        rows.append((angle, *fine))
    for k, name in ((1, "curvature"), (2, "torsion")):
        lines = "".join(f"{row[0]:g},{row[k]:.10f}\n" for row in rows)
        (folder / f"{name}.csv").write_text(f"axis_deg,{name}_per_mm\n" + lines)


if __name__ == "__main__":
    main()
