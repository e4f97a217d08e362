"""Writes the raw files of this example: synthetic tests of the fabric and plastic of the paper's Table 1.

The fabric is the homogeneous law (docs/theory.md, section 3), pulled with its width and shear free; unloading follows the
law, loading is stiffer, noise is 0.5 % of the largest force. A machine's three ways to write a table are all there.

usage: /usr/bin/python3 make_data.py
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root

OUT = Path(__file__).parent / "raw"
ALPHA, BETA, GAMMA = (0.024161, 0.090890, 0.063419), (0.029676, 0.020512), (0.9626, 0.9637)
NU, E_F, SHARE, H_F, DENSITY, K_B, E_P = 0.3, 1.05, 0.01, 0.46, 0.20, 9.57e-3, 72.3
LENGTH, WIDTH = 110.0, 20.0
random = np.random.default_rng(20260302)


def stress(e):
    """Second Piola-Kirchhoff stress, MPa, of Green strain (E11, E22, 2 E12) in fabric axes."""
    plane = 1 / (1 - NU**2)
    cross = NU * np.sqrt(ALPHA[0] * ALPHA[1]) * plane
    own = np.array([
        ALPHA[0] * plane * e[0] + cross * e[1] - BETA[0] * np.log1p(-e[0] / GAMMA[0]),
        ALPHA[1] * plane * e[1] + cross * e[0] - BETA[1] * np.log1p(-e[1] / GAMMA[1]),
        ALPHA[2] * e[2],
    ])
    c11, c22, c12 = 1 + 2 * e[0], 1 + 2 * e[1], e[2]
    j2 = c11 * c22 - c12**2
    mu, lam = E_F / (2 * (1 + NU)), E_F * NU * plane
    neo_hookean = mu * np.array([1, 1, 0]) + (lam * 0.5 * np.log(j2) - mu) / j2 * np.array([c22, c11, -c12])
    return (1 - SHARE) * own + SHARE * neo_hookean


def pull(angle_deg, stretches):
    """Force in N and width in mm of a sample at an angle to the first axis."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    turn = np.array([[c * c, s * s, -c * s], [s * s, c * c, c * s], [2 * c * s, -2 * c * s, c * c - s * s]])
    free = np.zeros(2)
    force, width = [], []
    for stretch in stretches:
        axial = 0.5 * (stretch**2 - 1)
        free = root(lambda f: (turn.T @ stress(turn @ np.array([axial, *f])))[1:], free, tol=1e-13).x
        second = (turn.T @ stress(turn @ np.array([axial, *free])))[0]
        force.append(stretch * second * WIDTH * H_F)
        width.append(WIDTH * np.sqrt(1 + 2 * free[0]))
    return np.array(force), np.array(width)


def write_tension(angle, style):
    """Two cycles at 1 mm/s, 1.25 readings a second, up to 77 mm."""
    up = np.linspace(0, 77, 62)
    force, width = pull(angle, 1 + up / LENGTH)
    rows = []
    for cycle in range(2):
        stiffer = 1.25 if cycle == 0 else 1.12
        rows += list(zip(up, stiffer * force, width)) + list(zip(up[::-1], force[::-1], width[::-1]))[1:]
    rows = np.array(rows)
    rows[:, 1] += 0.005 * force.max() * random.standard_normal(len(rows))
    rows[:, 2] += 0.05 * random.standard_normal(len(rows))
    time = 0.8 * np.arange(len(rows))
    comma = lambda x, digits: f"{x:.{digits}f}".replace(".", ",")
    if style == "bluehill":
        lines = ['"Raw Data"', '"Operator","student"', "", '"Time","Extension","Load","Width"', '"(s)","(mm)","(N)","(mm)"']
        lines += [f'"{t:.2f}","{d:.4f}","{f:.5f}","{w:.3f}"' for t, (d, f, w) in zip(time, rows)]
        text = "\r\n".join(lines).encode()
    elif style == "zwick":
        lines = ['"Prüfzeit";"Standardweg";"Standardkraft";"Probenbreite"', '"s";"mm";"N";"mm"']
        lines += [f"{comma(t, 2)};{comma(d, 4)};{comma(f, 5)};{comma(w, 3)}" for t, (d, f, w) in zip(time, rows)]
        text = "\r\n".join(lines).encode("latin-1")
    else:
        lines = ["time_s,displacement_mm,force_N,width_mm"]
        lines += [f"{t:.2f},{d:.4f},{f:.5f},{w:.3f}" for t, (d, f, w) in zip(time, rows)]
        text = "\n".join(lines).encode()
    (OUT / f"tension-{angle:02d}.csv").write_bytes(text + b"\n")


def cantilever(load):
    """(x, y) over L of a heavy strip, from its tip: theta'' = -u cos theta up to where it is horizontal."""

    def strip(tip_angle):
        horizontal = lambda u, z: z[0]
        horizontal.terminal = True
        end = solve_ivp(lambda u, z: [z[1], -u * np.cos(z[0]), np.cos(z[0]), np.sin(z[0])], (0, 50),
                        [tip_angle, 0, 0, 0], rtol=1e-10, atol=1e-12, events=horizontal)
        return end.t[-1], end.y[2:, -1]

    tip_angle = brentq(lambda a: strip(a)[0] ** 3 - load, 1e-3, np.pi / 2 - 1e-9)
    length, ends = strip(tip_angle)
    return ends / length


def main():
    OUT.mkdir(exist_ok=True)
    for angle, style in zip(range(0, 91, 15), ["bluehill", "plain", "zwick", "bluehill", "zwick", "plain", "bluehill"]):
        write_tension(angle, style)
    strain = np.linspace(0, 0.03, 61)
    plastic = 10 * 1.0 * E_P * (strain - 3 * strain**2) + 0.03 * random.standard_normal(61)
    lines = ["Extension (mm),Load (N)"] + [f"{150 * e:.4f},{f:.4f}" for e, f in zip(strain, plastic)]
    (OUT / "plastic.csv").write_text("\n".join(lines) + "\n")
    print("cantilevers for campaign.toml:")
    for length in (20, 30, 40, 50):
        x, y = length * cantilever(DENSITY * 9.80665e-6 * length**3 / K_B) + 0.2 * random.standard_normal(2)
        print(f"L = {length}: x = {x:.1f}, y = {y:.1f}")


if __name__ == "__main__":
    main()
