"""Training with the paper's recipe: GPyTorch, on the processor."""

import time

import gpytorch
import numpy as np
import torch

from points import Mixture, angles_and_distances, directions_and_distances, quality

COORDINATES = {"angles": angles_and_distances, "chord": directions_and_distances}

LEARNING_RATE = 0.1
PATIENCE = 10
DECAY = 0.1
JITTER = 1e-4


class Process(gpytorch.models.ExactGP):
    """A zero mean and a scaled rational quadratic."""

    def __init__(self, inputs, targets, likelihood):
        super().__init__(inputs, targets, likelihood)
        self.mean_module = gpytorch.means.ZeroMean()
        self.covar_module = gpytorch.kernels.ScaleKernel(gpytorch.kernels.RQKernel())

    def forward(self, inputs):
        """The prior over ``inputs``."""
        mean, covariance = self.mean_module(inputs), self.covar_module(inputs)
        return gpytorch.distributions.MultivariateNormal(mean, covariance)


def measure(mixture: Mixture, test, metric: str, iterations: int, seed: int) -> dict:
    """Seconds to learn all components, one after the other, and how good they are on ``test``.

    The time has neither the clustering in it nor the predictions.
    """
    torch.manual_seed(seed)
    coordinates = COORDINATES[metric]
    owners = mixture.owners(test)
    predicted = np.empty(len(test))
    seconds = 0.0
    exact = gpytorch.settings.fast_computations(False, False, False)
    with exact, gpytorch.settings.cholesky_jitter(JITTER):
        for index, component in enumerate(mixture.components):
            start = time.perf_counter()
            process = learn(*tensors(coordinates, component.points, component.centre), iterations)
            seconds += time.perf_counter() - start
            own = owners == index
            with torch.no_grad():
                inputs, _ = tensors(coordinates, test[own], component.centre)
                predicted[own] = process(inputs).mean.numpy()
            print(f"component {index}: {seconds:.1f} s so far", flush=True)
    centres = mixture.clusters.cluster_centers_[owners]
    return {
        "terms": sum(len(component.points) for component in mixture.components),
        "threads": torch.get_num_threads(),
        "training_seconds": seconds,
        **quality(test, predicted, centres),
    }


def learn(inputs, targets, iterations: int) -> Process:
    """A process with hyperparameters learned by Adam, ready to predict."""
    likelihood = gpytorch.likelihoods.GaussianLikelihood()
    process = Process(inputs, targets, likelihood).train()
    likelihood.train()
    optimiser = torch.optim.Adam(process.parameters(), lr=LEARNING_RATE)
    scheduler = torch.optim.lr_scheduler.ReduceLROnPlateau(
        optimiser, patience=PATIENCE, factor=DECAY
    )
    marginal = gpytorch.mlls.ExactMarginalLogLikelihood(likelihood, process)
    for _ in range(iterations):
        optimiser.zero_grad()
        loss = -marginal(process(inputs), targets)
        loss.backward()
        optimiser.step()
        scheduler.step(loss.detach())
    likelihood.eval()
    return process.eval()


def tensors(coordinates, points, centre):
    """What a process sees of ``points``."""
    inputs, distances = coordinates(points, centre)
    return (
        torch.tensor(inputs, dtype=torch.float32),
        torch.tensor(distances, dtype=torch.float32),
    )
