"""The points that everybody works on, and how what is learned of them is judged."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree
from sklearn.cluster import KMeans

TAU = 0.01
"""A point is reproduced when the other set has a point nearer than this (unit sphere)."""


@dataclass
class Component:
    """A reference point, and the training points around it."""

    centre: np.ndarray
    points: np.ndarray


@dataclass
class Mixture:
    """Components, and the clustering that says which of them a point belongs to."""

    clusters: KMeans
    components: list[Component]

    def owners(self, points):
        """The index of the component whose reference point is nearest to each point."""
        return self.clusters.predict(points)


def read(path: Path) -> np.ndarray:
    """Points of a file with ``x,y,z`` a line."""
    return np.loadtxt(path, delimiter=",")


def cluster(points, count: int, overlap: float, seed: int) -> Mixture:
    """k-means components of ``points``.

    A component has the points that are nearest to its reference point and, where ``overlap`` is
    not negative, all others within (1 + overlap) times the distance of the farthest of these.
    """
    clusters = KMeans(count, random_state=seed, n_init=1).fit(points)
    components = []
    for index, centre in enumerate(clusters.cluster_centers_):
        own = clusters.labels_ == index
        if overlap >= 0:
            distances = np.linalg.norm(points - centre, axis=1)
            own |= distances <= (1 + overlap) * distances[own].max()
        components.append(Component(centre, points[own]))
    return Mixture(clusters, components)


def angles_and_distances(points, centre):
    """(φ, θ) and the distance of each point from ``centre`` (Eq. 1)."""
    directions, distances = directions_and_distances(points, centre)
    azimuth = np.arctan2(directions[:, 1], directions[:, 0])
    return np.column_stack([azimuth, np.arccos(directions[:, 2])]), distances


def directions_and_distances(points, centre):
    """Unit vector and distance of each point from ``centre`` (Eq. 1)."""
    offsets = points - centre
    distances = np.linalg.norm(offsets, axis=1)
    return offsets / distances[:, None], distances


def quality(points, predicted_distances, centres):
    """The paper's metrics of predictions in the directions of ``points`` from ``centres``."""
    directions, distances = directions_and_distances(points, centres)
    predicted = centres + directions * predicted_distances[:, None]
    to_surface = cKDTree(points).query(predicted)[0]
    to_prediction = cKDTree(predicted).query(points)[0]
    precision = 100 * np.mean(to_surface < TAU)
    recall = 100 * np.mean(to_prediction < TAU)
    return {
        "f_score": 2 * precision * recall / (precision + recall),
        "chamfer": 1e3 * (np.mean(to_surface**2) + np.mean(to_prediction**2)),
        "rms": float(np.sqrt(np.mean((distances - predicted_distances) ** 2))),
    }
