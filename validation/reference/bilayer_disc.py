"""A disc of plastic all over stretched fabric, as a shell of revolution: the cap that a small disc becomes.

    bilayer_disc.py               writes the curves of validation/bilayer-disc

The axisymmetric branch goes on beyond the point where the disc leaves it for a cylinder (docs/theory.md, section 5.8).
The laminate's energy is minimised with polynomials along the meridian, with nothing of the program in it.
"""

from pathlib import Path

import numpy as np
from infinite_strip import Laminate
from minimise import minimise, symmetric_derivative
from numpy.polynomial import legendre

RADIUS, MIDDLE = 20.0, 10.0  # mm, of the disc and of the part that is measured
CAPS = (1.005, 1.01, 1.02, 1.03, 1.04, 1.05, 1.07, 1.1, 1.15, 1.2)
CYLINDERS = (1.03, 1.05, 1.07, 1.1, 1.2, 1.4, 1.7)


class Cap:
    """The meridian over r in [0, R]: its angle is odd in r, its stretch even."""

    def __init__(self, laminate, terms=16):
        self.laminate, self.terms = laminate, terms
        nodes, weights = legendre.leggauss(3 * terms + 8)
        self.t, self.weights = (nodes + 1) / 2, weights / 2
        unit = np.eye(2 * terms)
        self.angle = np.array([legendre.legval(self.t, unit[2 * k + 1]) for k in range(terms)]).T
        self.slope = np.array([legendre.legval(self.t, legendre.legder(unit[2 * k + 1])) for k in range(terms)]).T / RADIUS
        self.stretch = np.array([legendre.legval(self.t, unit[2 * k]) for k in range(terms)]).T
        self.to_legendre = np.linalg.inv(legendre.legvander(nodes, len(nodes) - 1))
        antiderivatives = np.array([legendre.legval(nodes, legendre.legint(e, lbnd=-1)) / 2 for e in np.eye(len(nodes))]).T
        self.integral = antiderivatives @ self.to_legendre  # from 0 to each node

    def shape(self, x):
        """Stretch along the meridian, stretch around, and both curvatures (positive where the back is concave)."""
        angle, slope = self.angle @ x[: self.terms], self.slope @ x[: self.terms]
        stretch = self.stretch @ x[self.terms :]
        t = self.t if x.ndim == 1 else self.t[:, None]
        around = (self.integral @ (stretch * np.cos(angle))) / t
        return stretch, around, slope / stretch, np.sin(angle) / (around * t * RADIUS)

    def energy(self, x):
        """Over 2 pi R^2; for each column of x where it has several."""
        stretch, around, along, across = self.shape(x)
        a = stretch**2, around**2
        return (self.weights * self.t) @ self.laminate.density(*a, -along * a[0], -across * a[1])

    def gradient(self, x):
        """By complex steps: exact to rounding."""
        step = 1e-30
        return self.energy(x[:, None] + 1j * step * np.eye(len(x))).imag / step

    def solve(self, x):
        """Stable among shapes of revolution."""
        return minimise(self.energy, lambda x: (self.gradient(x), symmetric_derivative(self.gradient, x)), x, still=1e-11)

    def mean_curvature(self, x):
        """Mean over the layout's area of r < MIDDLE."""
        _, _, along, across = self.shape(x)
        whole = legendre.legint(self.to_legendre @ ((along + across) / 2 * self.t), lbnd=-1) / 2
        share = MIDDLE / RADIUS
        return legendre.legval(2 * share - 1, whole) / (share**2 / 2)


def caps(terms=16):
    """Mean curvature of the middle over that of a narrow strip, for each pre-stretch: the small disc's is 1."""
    x, result = None, []
    for prestretch in CAPS:
        laminate = Laminate(prestretch=prestretch)
        cap = Cap(laminate, terms)
        if x is None:
            curvature, stretch = laminate.bimetal()
            x = np.zeros(2 * terms)
            x[0], x[terms] = curvature * stretch * RADIUS, stretch
        x = cap.solve(x)
        result.append(cap.mean_curvature(x) / laminate.bimetal()[0])
    return result


def cylinder(laminate):
    """Mean curvature of the wide sheet that rolls up (b2 = 0, both stretches free) over that of a narrow strip."""
    x = np.array([1.0, 1.0, 0.0])  # a1, a2, b1

    def gradient(x):
        step = 1e-30
        return np.array([laminate.density(*(x + 1j * step * u), 0.0).imag / step for u in np.eye(3)])

    # The energy is quadratic in them.
    hessian = np.array([gradient(x + u) - gradient(x) for u in np.eye(3)])
    a1, _, b1 = x - np.linalg.solve(hessian, gradient(x))
    return -b1 / a1 / 2 / laminate.bimetal()[0]


def bifurcation(laminate):
    """The curvature (1/mm) of a free small disc at which one of this radius leaves the cap, for uniform curvature."""
    plies = [(z0, z1, modulus / rest) for z0, z1, modulus, rest in laminate.plies()]  # per layout
    stretching = sum(m * (z1 - z0) for z0, z1, m in plies)
    neutral = sum(m * (z1**2 - z0**2) / 2 for z0, z1, m in plies) / stretching
    bending = sum(m * ((z1 - neutral) ** 3 - (z0 - neutral) ** 3) / 3 for z0, z1, m in plies) / (1 - laminate.poisson**2)
    membrane = stretching * RADIUS**4 / 192
    return 2 / (1 + laminate.poisson) * np.sqrt(bending * (1 - laminate.poisson) / membrane)


def main():
    folder = Path(__file__).resolve().parents[1] / "bilayer-disc"
    coarse, fine = caps(12), caps(16)
    assert np.max(np.abs(np.subtract(coarse, fine))) < 1e-7, (coarse, fine)
    wide = [cylinder(Laminate(prestretch=s)) for s in CYLINDERS]
    for name, prestretches, values in (("cap", CAPS, fine), ("cylinder", CYLINDERS, wide)):
        rows = "".join(f"{s:g},{v:.8f}\n" for s, v in zip(prestretches, values))
        (folder / f"{name}.csv").write_text("prestretch,mean_curvature_over_narrow_strip\n" + rows)


if __name__ == "__main__":
    main()
