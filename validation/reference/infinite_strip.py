"""The infinitely long printed strip of finite width: curvature of its centre line, by one function across its width.

A strip that is the same at every cross-section, and its own mirror image along and across, is a surface of revolution
(docs/theory.md, section 5.6). What is left of the laminate's energy is minimised here with functions across the width
that are polynomials: spectral accuracy, with nothing of the program's meshes, elements or solver in it.

    infinite_strip.py > infinite-strip.csv        curvature over width, h_p = 0.6 mm, Table 1, s = 1.7
"""

import sys
from dataclasses import dataclass

import numpy as np
from minimise import minimise, symmetric_derivative

WIDTHS = (1.0, 2.0, 3.0, 5.0, 8.0)


@dataclass
class Laminate:
    """Print on the front: z = 0 is the interface. MPa, mm; the paper's Table 1, and the thickness it implies."""

    plastic_thickness: float = 0.6
    fabric_thickness: float = 0.46
    prestretch: float = 1.7
    plastic_modulus: float = 72.3
    fabric_modulus: float = 1.05
    poisson: float = 0.4

    def plies(self):
        """(z0, z1, Young's modulus, rest metric / layout metric) of each ply."""
        return (
            (0.0, self.plastic_thickness, self.plastic_modulus, 1.0),
            (-self.fabric_thickness, 0.0, self.fabric_modulus, 1.0 / self.prestretch**2),
        )

    def density(self, a1, a2, b1, b2):
        """Energy per layout area for diagonal fundamental forms, mJ/mm^2."""

        def product(p, q):
            nu = self.poisson
            return nu / (1 - nu**2) * (p[0] + p[1]) * (q[0] + q[1]) + (p[0] * q[0] + p[1] * q[1]) / (1 + nu)

        total = 0.0
        for z0, z1, modulus, rest in self.plies():
            a = (a1 / rest - 1, a2 / rest - 1)
            b = (b1 / rest, b2 / rest)
            moments = ((z1 - z0) / 4, -(z1**2 - z0**2) / 2, (z1**3 - z0**3) / 3)
            total = total + 0.5 * modulus * rest * (
                moments[0] * product(a, a) + moments[1] * product(a, b) + moments[2] * product(b, b)
            )
        return total

    def bimetal(self):
        """Curvature and stretch of a narrow strip: Timoshenko 1925, as in docs/theory.md, section 5.2."""
        p, q = self.plastic_modulus, self.fabric_modulus * self.prestretch**2
        tp, tf, rest = self.plastic_thickness, self.fabric_thickness, 1 / self.prestretch**2
        matrix = [
            [(p * tp + q * tf) / 2, (-p * tp**2 + q * tf**2) / 2],
            [(-p * tp**2 + q * tf**2) / 2, 2 / 3 * (p * tp**3 + q * tf**3)],
        ]
        a, b = np.linalg.solve(matrix, [(p * tp + q * tf * rest) / 2, (-p * tp**2 + q * tf**2 * rest) / 2])
        return -b / a, np.sqrt(a)


class Strip:
    """Half of the cross-section, y in [0, w/2]: the angle of the meridian is odd in y, the stretch across even."""

    def __init__(self, laminate, width, terms):
        self.laminate, self.half, self.terms = laminate, width / 2, terms
        nodes, weights = np.polynomial.legendre.leggauss(3 * terms + 8)
        self.t, self.weights = (nodes + 1) / 2, weights / 2  # on [0, 1]
        legendre = np.polynomial.legendre.legval
        unit = np.eye(2 * terms)
        odd = [legendre(self.t, unit[2 * k + 1]) for k in range(terms)]
        derivative = np.polynomial.legendre.legder
        slope = [legendre(self.t, derivative(unit[2 * k + 1])) / self.half for k in range(terms)]
        even = [legendre(self.t, unit[2 * k]) for k in range(terms)]
        self.angle, self.angle_slope, self.across = (np.array(m).T for m in (odd, slope, even))
        # Integral from 0 to each node: that of the polynomial through the values at all nodes.
        powers = np.polynomial.legendre.legvander(2 * self.t - 1, len(self.t) - 1)
        integrals = np.array(
            [
                legendre(2 * self.t - 1, np.polynomial.legendre.legint(np.eye(len(self.t))[k], lbnd=-1)) / 2
                for k in range(len(self.t))
            ]
        ).T
        self.integral = integrals @ np.linalg.inv(powers)

    def energy(self, x):
        """Of half the section per layout length. x: turn per layout length, stretch of the centre line, then coefficients."""
        turn, centre = x[0], x[1]
        angle, slope = self.angle @ x[2 : 2 + self.terms], self.angle_slope @ x[2 : 2 + self.terms]
        across = self.across @ x[2 + self.terms :]
        along = centre - turn * self.half * (self.integral @ (across * np.sin(angle)))
        density = self.laminate.density(along**2, across**2, -turn * along * np.cos(angle), -across * slope)
        return self.half * np.sum(self.weights * density)

    def gradient(self, x):
        """By complex steps: exact to rounding."""
        step = 1e-30
        return np.array([self.energy(x + 1j * step * unit).imag / step for unit in np.eye(len(x))])

    def solve(self, x):
        return minimise(self.energy, lambda x: (self.gradient(x), symmetric_derivative(self.gradient, x)), x, still=1e-12)


def curvature(width, laminate=None, terms=8):
    """Curvature of the centre line, 1/mm; positive where the back is concave."""
    laminate = laminate or Laminate()
    strip = Strip(laminate, width, terms)
    kappa, stretch = laminate.bimetal()
    x = np.zeros(2 + 2 * terms)
    x[0], x[1], x[2 + terms] = kappa * stretch, stretch, stretch
    x = strip.solve(x)
    return x[0] / x[1]


def main():
    sys.stdout.write("width_mm,curvature_per_mm\n")
    for width in WIDTHS:
        coarse, fine = curvature(width, terms=12), curvature(width, terms=18)
        assert abs(coarse - fine) < 1e-9, (width, coarse, fine)
        sys.stdout.write(f"{width:g},{fine:.10f}\n")


if __name__ == "__main__":
    main()
