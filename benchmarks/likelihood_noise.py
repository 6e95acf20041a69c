"""A pad's unevenness from recordings of discs whose places nobody knows.

Run with ``python benchmarks/likelihood_noise.py`` (half a minute); ``--recordings N`` takes other
than 10 of each pad, of 24 images. Mean and standard deviation of what `learned_noise` makes of one
image, of six, and of all, beside what the pad was made with.
"""

from __future__ import annotations

import argparse

import numpy as np
from learned_noise import learned_noise

from tactile_graph import Image, load
from tactile_graph.compiled import warm_up
from tactile_graph_likelihood.settings import FootprintSettings
from tactile_graph_likelihood.single.footprint_of import FootprintDisc

IMAGES, GROUPS = 24, (1, 6, 24)
PADS = ((0.25, 0.05), (0.483, 0.164), (0.75, 0.3), (1.0, 0.1))


def recorded(sigma: float, voids: float, seed: int) -> list[Image]:
    source = load("circle-likelihood").with_source(
        "simulate", scene="discs", frames=IMAGES, sigma=sigma, voids=voids
    )
    run = source.runner(only=["grams"])
    return [run(frame)["grams"] for frame in source.frames(seed)]


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--recordings", type=int, default=10)
    parser.add_argument("--seed", type=int, default=200)
    chosen = parser.parse_args()
    warm_up()
    model = FootprintDisc(FootprintSettings(on_pad="whole")).model
    print(f"{'true':>13}", *(f"{f'{n} image' + 's' * (n > 1):>30}" for n in GROUPS))
    for sigma, voids in PADS:
        found: dict[int, list[tuple[float, float]]] = {n: [] for n in GROUPS}
        for k in range(chosen.recordings):
            images = recorded(sigma, voids, chosen.seed + k)
            for n, its in found.items():
                for first in range(0, IMAGES, max(n, 3)):  # of single images every third
                    noise = learned_noise(model, images[first : first + n])
                    its.append((noise.sigma, noise.voids))
        print(f"{sigma:7g} {voids:5g}", end="")
        for its in found.values():
            mean, off = np.mean(its, axis=0), np.std(its, axis=0)
            print(f"  {mean[0]:.3f} +- {off[0]:.3f} {mean[1]:.3f} +- {off[1]:.3f}", end="")
        print()


if __name__ == "__main__":
    main()
