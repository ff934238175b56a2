"""Runs the Python peers on the points that `cobra-train` was measured on, and compares."""

import argparse
import json
import os
import platform
import statistics
import subprocess
from importlib.metadata import version
from pathlib import Path

import authors
import paper
import points

PACKAGES = ["gpytorch", "linear_operator", "numpy", "scikit-learn", "scipy", "torch"]

RECIPE = ["components", "overlap", "metric", "iterations", "repetitions", "seed"]


def main():
    """Measures, writes the JSON document, prints the tables."""
    arguments = parse()
    load = os.getloadavg()[0]
    folder = arguments.folder
    before = run(arguments.program, arguments.mesh, folder)
    training, test = points.read(folder / "training.csv"), points.read(folder / "test.csv")
    queries = test[: before["queries"]]

    def clustered(overlap):
        return points.cluster(training, arguments.components, overlap, arguments.seed)

    scoring = authors.measure(clustered(overlap=-1), queries, arguments.repetitions)
    learned = paper.measure(
        clustered(arguments.overlap), test, arguments.metric, arguments.iterations, arguments.seed
    )
    after = run(arguments.program, arguments.mesh, folder)
    ours = between(before, after)
    document = {
        "mesh": arguments.mesh.name,
        "recipe": {name: getattr(arguments, name) for name in RECIPE},
        "cores": os.cpu_count(),
        "load": load,
        "versions": {
            "python": platform.python_version(),
            **{name: version(name) for name in PACKAGES},
        },
        "cobra": ours,
        "cobra_before_and_after": [before, after],
        "authors_pipeline": scoring,
        "gpytorch": learned,
        "ratios": ratios(ours, scoring, learned),
    }
    (folder / "peers.json").write_text(json.dumps(document, indent=2) + "\n")
    print(tables(document))


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path, help="`same-points`, built")
    parser.add_argument("mesh", type=Path)
    parser.add_argument("folder", type=Path, help="of the points and of peers.json")
    parser.add_argument("--components", type=int, default=16, help="k-means components")
    parser.add_argument(
        "--overlap",
        type=float,
        default=0.05,
        help="GPyTorch's components reach farther by this share; none overlap if negative",
    )
    parser.add_argument("--metric", choices=paper.COORDINATES, default="angles")
    parser.add_argument("--iterations", type=int, default=250, help="of Adam")
    parser.add_argument("--repetitions", type=int, default=20, help="of scoring")
    parser.add_argument("--seed", type=int, default=0)
    return parser.parse_args()


def run(program, mesh, folder):
    """What the example measures, and the points that it writes."""
    done = subprocess.run([program, mesh, folder], check=True, stdout=subprocess.PIPE)
    return json.loads(done.stdout)


def between(before, after):
    """The mean of each time: what else the machine does may change while the peers run."""
    return {
        name: statistics.mean([value, after[name]]) if name.endswith("_seconds") else value
        for name, value in before.items()
    }


def ratios(ours, scoring, learned):
    """How often the time of one goes into that of another."""
    score = ours["scoring_seconds"]
    return {
        "training: GPyTorch / cobra": learned["training_seconds"] / ours["training_seconds"],
        "scoring: authors' pipeline with deviation / cobra": scoring["with_deviation_seconds"]
        / score,
        "scoring: authors' pipeline, mean alone / cobra": scoring["mean_alone_seconds"] / score,
        "scoring: distance to the mesh / cobra": ours["mesh_distance_seconds"] / score,
        "scoring: cobra / nearest of the training points": score / ours["nearest_point_seconds"],
        "scoring: cobra's map / nearest of the training points": ours["map_scoring_seconds"]
        / ours["nearest_point_seconds"],
    }


def tables(document):
    """Ratios and quality as Markdown."""
    lines = ["| time | ratio |", "|---|--:|"]
    lines += [f"| {name} | {ratio:.3g} |" for name, ratio in document["ratios"].items()]
    lines += ["", "| quality on the test points | F | Chamfer × 10³ | rms |", "|---|--:|--:|--:|"]
    for name in ("cobra", "gpytorch"):
        of = document[name]
        lines.append(f"| {name} | {of['f_score']:.2f} | {of['chamfer']:.4f} | {of['rms']:.4f} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
