"""Data terms against noises: the error of restored images, and whether the matching term wins.

Run ``python benchmarks/field_noise.py``; some minutes. Every image is read with one kind of noise
at one level and restored with each data term; all are told the scale of the noise. There are two
kinds of images (``noise_scenes.py``):

- ``drawn``: from the prior of the model itself, by its Gibbs sampler with no data. The model is
  then true, but for the data term where that does not match: nothing is tuned, and by theory no
  estimate beats the matching term's posterior mean in RMSE on average;
- ``flat``: a disc and a rectangle on a floor. No prior of the model draws such images: step and
  edge are tuned for each term under each noise by one and the same search on other images.

The estimate is the posterior mean (``--by map``: the labelling of least energy). Its error is the
root mean square over the image (RMSE, in 1/200 of the range) and the share of edges wrong; terms
are compared image by image, so that what is hard about an image hurts all alike.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from noise_scenes import LEVELS, SIZE, SMOOTH, TERMS, Array, Prior, drawn, flat, pinned, read
from numpy.typing import NDArray

from tactile_graph.compiled import warm_up
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.samplers.posterior import posterior

UNIT = 200.0 / LEVELS
SCALES = (10.0, 20.0, 40.0)
STEPS, EDGES = (0.5, 1.0, 2.0, 4.0), (1.5, 2.0, 2.5, 3.0, 4.0, 6.0)
"""What the search tries, see `Prior`."""
FIRST = Prior(step=1.0, edge=2.5, spread=LEVELS / 3)
"""What it starts from."""
EDGE = {"drawn": SMOOTH.height, "flat": LEVELS / 10}
"""Levels from which on a step is an edge; those of flat scenes are a quarter of the range."""
TRAIN_SEEDS = 10_000


def by_minimum(values: Array, model: Model, seed: int) -> Array:
    """Return the labelling of least energy (MAP)."""
    del seed
    image, region, expected = pinned(values)
    return restore(image, region, expected, model=model).image.values[:SIZE]


def by_mean(values: Array, model: Model, seed: int) -> Array:
    """Return the posterior mean, which no other estimate beats in RMSE if the model is true."""
    image, region, expected = pinned(values)
    rng = np.random.default_rng([seed, 1])
    n = 60 if seed >= TRAIN_SEEDS else 150
    found = posterior(image, region, expected, model=model, rng=rng, n_burn=30, n_samples=n)
    return found.mean.values[:SIZE]


Estimate = Callable[[Array, Model, int], Array]
ESTIMATES: dict[str, Estimate] = {"map": by_minimum, "mean": by_mean}


@cache
def image_of(scenes: str, seed: int) -> Array:
    rng = np.random.default_rng([seed, 0])
    return drawn(rng) if scenes == "drawn" else flat(rng)


@dataclass(frozen=True)
class Case:
    """One kind of images with one noise, and the estimate.

    Parameters
    ----------
    scenes : str
        ``drawn`` or ``flat``.
    kind : str
        Of noise.
    scale : float
        Of the noise, in 1/200 of the range.
    way : callable
    """

    scenes: str
    kind: str
    scale: float
    way: Estimate

    def errors(self, term: str, prior: Prior, seeds: range) -> tuple[Array, Array]:
        """Return RMSE and share of edges wrong (%) of each image."""
        model, edge = prior.model(term, self.scale / UNIT), EDGE[self.scenes]
        found = []
        for seed in seeds:
            truth = image_of(self.scenes, seed)
            rng = np.random.default_rng([seed, 2])
            seen = read(self.kind, truth, self.scale / UNIT, rng)
            restored = self.way(seen, model, seed)
            wanted = edges(truth, edge)
            wrong = np.count_nonzero(edges(restored, edge) != wanted) / np.count_nonzero(wanted)
            found.append((UNIT * np.sqrt(np.mean((restored - truth) ** 2)), 100.0 * wrong))
        rmse, wrongs = np.array(found).T
        return rmse, wrongs

    def tuned(self, term: str, seeds: range) -> tuple[Prior, float]:
        """Return the prior of least mean RMSE, and that: the true one, or what a search finds."""
        known: dict[Prior, float] = {}

        def cost(prior: Prior) -> float:
            if prior not in known:
                known[prior] = float(self.errors(term, prior, seeds)[0].mean())
            return known[prior]

        if self.scenes == "drawn":
            return SMOOTH, cost(SMOOTH)
        best = FIRST
        best = min((replace(best, edge=edge) for edge in EDGES), key=cost)
        best = min((replace(best, step=step) for step in STEPS), key=cost)
        at = EDGES.index(best.edge)
        near = EDGES[max(at - 1, 0) : at + 2]
        best = min((replace(best, edge=edge) for edge in near), key=cost)
        return best, cost(best)


def edges(values: Array, height: float) -> NDArray[np.bool_]:
    steps = [np.abs(np.diff(values, axis=axis)).ravel() for axis in (0, 1)]
    return np.concatenate(steps) > height


@dataclass(frozen=True)
class Trial:
    """One term under one noise: its prior, its mean RMSE where tuned, its errors elsewhere."""

    prior: Prior
    tuned_rmse: float
    rmse: Array
    wrong: Array


Found = dict[tuple[str, float], dict[str, Trial]]


def compared(case: Case, n_train: int, n_test: int) -> dict[str, Trial]:
    """Return each term's trial."""
    found = {}
    for term in TERMS:
        prior, rmse = case.tuned(term, range(TRAIN_SEEDS, TRAIN_SEEDS + n_train))
        found[term] = Trial(prior, rmse, *case.errors(term, prior, range(n_test)))
    return found


def verdict(trials: dict[str, Trial], kind: str) -> tuple[str, str, float, float]:
    """Return won, tied or lost, the rival, by how much its RMSE is higher, half its 95 % interval.

    The rival is the best other term on the images tuned on: picked on the images compared, the
    luckiest of four would be taken.
    """
    rival = min((t for t in TERMS if t != kind), key=lambda t: trials[t].tuned_rmse)
    gains = trials[rival].rmse - trials[kind].rmse
    gain, half = float(gains.mean()), float(1.96 * gains.std(ddof=1) / np.sqrt(len(gains)))
    return "won" if gain > half else "lost" if gain < -half else "tied", rival, gain, half


def show(scenes: str, found: Found, n_test: int) -> None:
    """Print errors, and how the matching term does against the best other."""
    for scale in sorted({s for _, s in found}):
        print(f"\n{scenes} scenes, noise of scale {scale:g}, {n_test} images: "
              f"RMSE (edges wrong, %)")  # fmt: skip
        print(f"  {'noise':11}" + "".join(f"{term:>17}" for term in TERMS) + "   matching one")
        for kind in TERMS:
            trials = found[kind, scale]
            cells = [f"{t.rmse.mean():8.2f} ({t.wrong.mean():5.1f})" for t in trials.values()]
            word, rival, gain, half = verdict(trials, kind)
            share = 100.0 * gain / trials[kind].rmse.mean()
            print(f"  {kind:11}" + "".join(f"{cell:>17}" for cell in cells)
                  + f"   {word}: {rival} {gain:+.2f} +- {half:.2f} ({share:+.1f} %)")  # fmt: skip
    words = [verdict(trials, kind)[0] for (kind, _), trials in found.items()]
    print(f"\n{scenes} scenes, matching term against the best of the others: "
          f"{', '.join(f'{words.count(w)} {w}' for w in ('won', 'tied', 'lost'))}")  # fmt: skip
    gains = [
        100.0 * (trials["gaussian"].rmse.mean() / trials[kind].rmse.mean() - 1.0)
        for (kind, _), trials in found.items() if kind != "gaussian"
    ]  # fmt: skip
    print(f"the Gaussian term's RMSE under other noises: {min(gains):+.0f} to {max(gains):+.0f} % "
          f"of the matching one's, median {np.median(gains):+.0f} %")  # fmt: skip


def draw(all_found: dict[str, Found], file: str) -> None:
    """Plot RMSE against the scale of the noise, a row for each kind of scenes, bars of 95 %."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(len(all_found), 5, figsize=(15, 3.2 * len(all_found)),
                                   sharex=True, squeeze=False, layout="constrained")  # fmt: skip
    for row, (scenes, found) in zip(axes, all_found.items(), strict=True):
        scales = sorted({s for _, s in found})
        for axis, kind in zip(row, TERMS, strict=True):
            for k, term in enumerate(TERMS):
                each = [found[kind, s][term].rmse for s in scales]
                half = [1.96 * e.std(ddof=1) / np.sqrt(len(e)) for e in each]
                own = term == kind
                axis.errorbar(np.array(scales) * 1.03 ** (k - 2), [e.mean() for e in each], half,
                              color=f"C{k}", label=term, lw=2.5 if own else 1.0, capsize=2,
                              marker="o" if own else ".", zorder=3 if own else 2)  # fmt: skip
            axis.set(title=f"{kind} noise, {scenes} scenes", xscale="log", ylim=0)
            axis.set_xticks(scales, [f"{s:g}" for s in scales])
            axis.minorticks_off()
            axis.grid(alpha=0.3)
        row[0].set(ylabel="RMSE, 1/200 of the range")
    for axis in axes[-1]:
        axis.set(xlabel="scale of the noise, 1/200 of the range")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), title="data term",
                  loc="outside right upper")  # fmt: skip
    figure.savefig(file, dpi=110)
    print(f"plot: {file}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--images", type=int, default=40, help="images tested on, of each noise")
    parser.add_argument("--train", type=int, default=16, help="images tuned on")
    parser.add_argument("--by", choices=[*ESTIMATES], default="mean")
    parser.add_argument("--scales", type=float, nargs="+", default=list(SCALES))
    parser.add_argument("--scenes", nargs="+", choices=[*EDGE], default=[*EDGE])
    parser.add_argument("--plot", default="field_noise.png")
    chosen = parser.parse_args()
    warm_up()
    all_found: dict[str, Found] = {}
    for scenes in chosen.scenes:
        found = all_found[scenes] = {}
        for scale in chosen.scales:
            for kind in TERMS:
                case = Case(scenes, kind, scale, ESTIMATES[chosen.by])
                found[kind, scale] = compared(case, chosen.train, chosen.images)
                print(f"{scenes} {kind} {scale:g}: {verdict(found[kind, scale], kind)} "
                      f"{[(t.prior.step, t.prior.edge) for t in found[kind, scale].values()]}",
                      file=sys.stderr)  # fmt: skip
        show(scenes, found, chosen.images)
    draw(all_found, chosen.plot)


if __name__ == "__main__":
    main()
