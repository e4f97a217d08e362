#!/usr/bin/python3
"""How well tension tests can determine the fabric's law at all: the Cramér-Rao bound, whatever the fit.

usage: bench/calibration_limit.py [--cycles 1 2 3 4 6] [--noise 0.01] [--sampling 5] [--widths 1]
           [--runs FOLDER/RUN ... [--run-cycles 3]]

The information of all readings of the unloading branches (force and width with independent normal errors, as `ruche
virtual-test` records them) bounds the covariance of any unbiased estimate of the eight parameters from below. Parameters
are drawn with that covariance, and the seven curves of each draw are compared with the true ones: the largest error over
all of them is what an efficient fit cannot do better than. With --runs, folders of bench/calibration_roundtrip.py: what
fits really did, curves by the closed law for all seeds, and by the simulator where it simulated them.

The law is that of a material point (bench/uniaxial_law.py), whose derivatives are those of the clamped sample within some
per cent.
"""

import argparse
import json
from pathlib import Path

import numpy as np

from uniaxial_law import PARAMETERS, derivatives, nominal_stress

TRUTH = {
    "alpha_1_mpa": 0.024161,
    "alpha_2_mpa": 0.090890,
    "alpha_3_mpa": 0.063419,
    "beta_1_mpa": 0.029676,
    "beta_2_mpa": 0.020512,
    "gamma_1": 0.9626,
    "gamma_2": 0.9637,
    "fabric_poissons_ratio": 0.3,
    "fabric_youngs_modulus_mpa": 1.05,
    "neo_hookean_share": 0.01,
}
ANGLES = (0, 15, 30, 45, 60, 75, 90)
LENGTH_MM, SPEED_MM_PER_S, LARGEST = 110.0, 100.0 / 60.0, 1.7
DRAWS = 4000


def unloading_stretches(sampling):
    seconds = LENGTH_MM * (LARGEST - 1) / SPEED_MM_PER_S
    return LARGEST - np.arange(1, int(seconds * sampling) + 1) / sampling * SPEED_MM_PER_S / LENGTH_MM


def information(arguments):
    """Fisher information (8, 8) of one unloading of each orientation."""
    total = np.zeros((len(PARAMETERS), len(PARAMETERS)))
    stretches = unloading_stretches(arguments.sampling)
    for angle in ANGLES:
        _, transverse, by_force, by_width = derivatives(TRUTH, angle, stretches)
        full = nominal_stress(TRUTH, angle, [LARGEST])[0]
        rows = by_force / (arguments.noise * full)
        total += rows.T @ rows
        if arguments.widths:
            # A width w (over the relaxed one) with the error e is a Green strain with the error w e.
            rows = by_width / (arguments.noise * np.sqrt(1 + 2 * transverse))[:, None]
            total += rows.T @ rows
    return total


def compared_stretches():
    """Those of the simulated curves, closer together towards the end, from a tenth of the strain on."""
    left = 1 - np.arange(48) / 47
    strains = (LARGEST - 1) * (1 - left**1.5)
    return 1 + strains[strains >= 0.1 * (LARGEST - 1)]


class Comparison:
    """Errors of a law's seven curves against the true ones."""

    def __init__(self):
        self.stretches = compared_stretches()
        self.true = [nominal_stress(TRUTH, angle, self.stretches) for angle in ANGLES]

    def relative(self, law):
        found = [nominal_stress(law, angle, self.stretches) for angle in ANGLES]
        return np.concatenate([f / t - 1 for f, t in zip(found, self.true)])

    def over_scale(self, relative):
        scales = np.concatenate([t / t.max() for t in self.true])
        return relative * scales

    def place(self, index):
        angle, point = divmod(index, len(self.stretches))
        return ANGLES[angle], self.stretches[point] - 1


def draws_of(covariance, comparison, generator):
    """Relative errors (draws, points) of curves whose parameters scatter with the covariance, to first order."""
    by_parameter = np.concatenate(
        [derivatives(TRUTH, angle, comparison.stretches)[2] / t[:, None] for angle, t in zip(ANGLES, comparison.true)]
    )
    scatter = generator.multivariate_normal(np.zeros(len(PARAMETERS)), covariance, DRAWS, method="cholesky")
    return scatter @ by_parameter.T


def describe(errors, comparison):
    worst = np.abs(errors).max(axis=1)
    scaled = np.abs(comparison.over_scale(errors)).max(axis=1)
    steep = np.mean([comparison.place(i)[1] > 0.6 * (LARGEST - 1) for i in np.abs(errors).argmax(axis=1)])
    return (
        f"{100 * np.median(worst):.2f} % | {100 * np.quantile(worst, 0.9):.2f} % | {100 * np.mean(worst <= 0.01):.0f} % | "
        f"{100 * steep:.0f} % | {100 * np.median(scaled):.2f} % | {100 * np.quantile(scaled, 0.99):.2f} %"
    )


HEAD = (
    "largest error over seven curves: median | 90 % below | within 1 % | of these beyond 42 % strain | "
    "over full scale: median | 99 % below"
)


def report_run(folder, bound, comparison):
    seeds = [json.loads(path.read_text()) for path in sorted(folder.glob("seed-*.json"))]
    if not seeds:
        raise SystemExit(f"{folder}: no seed-N.json")
    laws = [{**TRUTH, **{key: seed["values"][key]["value"] for key in PARAMETERS}} for seed in seeds]
    print(f"\n{folder}: {len(seeds)} fitted cards")
    print("| parameter | spread | Cramér-Rao | ratio |\n|---|---|---|---|")
    for key, least in zip(PARAMETERS, np.sqrt(np.diag(bound))):
        spread = np.std([law[key] for law in laws], ddof=1)
        print(f"| {key} | {100 * spread / TRUTH[key]:.2f} % | {100 * least / TRUTH[key]:.2f} % | {spread / least:.2f} |")
    errors = np.array([comparison.relative(law) for law in laws])
    print(f"| curves by the closed law | {HEAD} |\n|---|---|---|---|---|---|---|\n| {len(laws)} cards | {describe(errors, comparison)} |")
    simulated = [(seed, error) for seed, error in zip(seeds, errors) if "curves" in seed]
    if not simulated:
        return
    by_simulator = np.array([seed["curves"]["largest_relative_error"] for seed, _ in simulated])
    by_law = np.array([np.abs(error).max() for _, error in simulated])
    print(
        f"{len(simulated)} of them simulated: {np.sum(by_simulator <= 0.01)} within 1 %, median {100 * np.median(by_simulator):.2f} %, "
        f"largest {100 * by_simulator.max():.2f} %; the closed law says the same within "
        f"{100 * np.abs(by_simulator - by_law).max():.2f} % of force"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cycles", type=int, nargs="+", default=[1, 2, 3, 4, 6])
    parser.add_argument("--noise", type=float, default=0.01)
    parser.add_argument("--sampling", type=float, default=5.0)
    parser.add_argument("--widths", type=int, choices=(0, 1), default=1)
    parser.add_argument("--runs", type=Path, nargs="*", default=[])
    parser.add_argument("--run-cycles", type=int, default=3, help="unloading branches per orientation in the runs")
    arguments = parser.parse_args()
    bound = np.linalg.inv(information(arguments))
    comparison = Comparison()
    generator = np.random.default_rng(1)
    print(f"| cycles | {HEAD} |\n|---|---|---|---|---|---|---|")
    for cycles in arguments.cycles:
        errors = draws_of(bound / cycles, comparison, generator)
        print(f"| {cycles} | {describe(errors, comparison)} |")
    for folder in arguments.runs:
        report_run(folder, bound / arguments.run_cycles, comparison)


if __name__ == "__main__":
    main()
