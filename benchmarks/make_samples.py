"""Make the recordings that come with the ``sample`` source: run it to write them again.

    python benchmarks/make_samples.py [--seed 4] [--to FOLDER]

``discs``: the three discs of thesis table 4.2, each at two random places, on the thesis' pad as
``simulate`` models it, with lognormal unevenness 0.5 and one element in ten without contact.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from tactile_graph.steps import Report
from tactile_graph_sources.sample import FOLDER
from tactile_graph_sources.simulate import simulate
from tactile_graph_sources.writers.write_npz import write_npz


def make_discs(path: Path, seed: int) -> int:
    frames = simulate(
        scene="discs",
        pad="thesis",
        frames=6,
        sigma=0.5,
        voids=0.1,
        rng=np.random.default_rng(seed),
        report=Report(),
    )
    return write_npz(path, frames)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=4)
    parser.add_argument("--to", type=Path, default=FOLDER)
    chosen = parser.parse_args()
    path = chosen.to / "discs.npz"
    n = make_discs(path, chosen.seed)
    print(f"{path}: {n} frames, {path.stat().st_size} bytes, seed {chosen.seed}")


if __name__ == "__main__":
    main()
