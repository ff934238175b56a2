"""Scoring as the authors' code does: scikit-learn's posterior, a call for each component."""

import statistics
import time

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RationalQuadratic

from points import Mixture, angles_and_distances

NOISE_VARIANCE = 1e-6
"""What scikit-learn calls alpha."""


def measure(mixture: Mixture, queries, repetitions: int) -> dict:
    """Seconds to score ``queries``, the median of ``repetitions``.

    The hyperparameters are constants of the order that is learned: what a prediction costs does
    not depend on them.
    """
    processes = []
    for component in mixture.components:
        inputs, distances = angles_and_distances(component.points, component.centre)
        process = GaussianProcessRegressor(
            RationalQuadratic(alpha=1, length_scale=0.1), optimizer=None, alpha=NOISE_VARIANCE
        )
        processes.append(process.fit(inputs, distances))
    with_deviation = [timed(score, mixture, processes, queries) for _ in range(repetitions)]
    mean_alone = [timed(residuals, mixture, processes, queries) for _ in range(repetitions)]
    return {
        "terms": sum(len(component.points) for component in mixture.components),
        "with_deviation_seconds": statistics.median(with_deviation),
        "mean_alone_seconds": statistics.median(mean_alone),
    }


def score(mixture, processes, queries):
    """The likelihood of each point under the component it belongs to (Eqs. 4, 5 and 9)."""
    owners = mixture.owners(queries)
    likelihoods = np.empty(len(queries))
    for index, process in enumerate(processes):
        own = owners == index
        if own.any():
            centre = mixture.components[index].centre
            inputs, distances = angles_and_distances(queries[own], centre)
            mean, deviation = process.predict(inputs, return_std=True)
            likelihoods[own] = np.exp(-0.5 * ((distances - mean) / deviation) ** 2)
    return likelihoods


def residuals(mixture, processes, queries):
    """How far each point lies from the component it belongs to, along its direction."""
    owners = mixture.owners(queries)
    found = np.empty(len(queries))
    for index, process in enumerate(processes):
        own = owners == index
        if own.any():
            centre = mixture.components[index].centre
            inputs, distances = angles_and_distances(queries[own], centre)
            found[own] = distances - process.predict(inputs)
    return found


def timed(function, *arguments):
    """Seconds that a call takes."""
    start = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - start
