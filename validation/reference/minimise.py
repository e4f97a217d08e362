"""Newton's method for the references' smooth energies of a few dozen unknowns."""

import numpy as np


def symmetric_derivative(gradient, x, step=1e-5):
    """The Hessian from central differences of an exact gradient."""
    rows = [(gradient(x + step * unit) - gradient(x - step * unit)) / (2 * step) for unit in np.eye(len(x))]
    return (np.array(rows) + np.array(rows).T) / 2


def minimise(energy, gradient_and_hessian, x, still, longest=np.inf):
    """From x downhill with halved steps until a step is shorter than `still`; `longest` is the longest one that is
    tried. A positive definite Hessian at the end certifies a strict minimum among the states that x describes."""
    for _ in range(300):
        gradient, hessian = gradient_and_hessian(x)
        values, vectors = np.linalg.eigh(hessian)
        step = -vectors @ ((vectors.T @ gradient) / np.maximum(np.abs(values), 1e-9))
        if np.max(np.abs(step)) < still:
            assert values[0] > 0, values[0]
            return x
        step *= min(1.0, longest / np.max(np.abs(step)))
        share = 1.0
        while energy(x + share * step) > energy(x) + 1e-14 * abs(energy(x)) and share > 1e-6:
            share /= 2
        x = x + share * step
    raise RuntimeError("Newton's method did not converge")
