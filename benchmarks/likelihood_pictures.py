"""The figures of docs/likelihood.md and its evidence, drawn from runs made here.

    python benchmarks/likelihood_pictures.py [-o docs/pictures] [--scenes 100]

Writes likelihood-forward.png, -posterior.png, -pressure.png, -bound.png and -calibration.png; about
two minutes.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from bayes_bound import SIGMA, VOIDS, bound, errors, reader
from likelihood_robustness import KINDS, frames
from matplotlib import pyplot as plt
from numpy.typing import NDArray
from scipy.special import fdtr

from tactile_graph import Circle, Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph_likelihood.settings import FootprintSettings
from tactile_graph_likelihood.single.footprint_of import FootprintDisc
from tactile_graph_likelihood.single.likely import LikelyCircle
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import load_pad

Values = NDArray[np.float64]
TRUTH, FOUND, OLD, LEAST = "black", "tab:red", "tab:blue", "tab:green"
LEVELS = (0.15, 0.3, SIGMA, 0.65, 0.85)
PAD = load_pad("thesis").geometry


def example(seed: int) -> tuple[Frame, Values, LikelyCircle, Circle]:
    """Return one frame of DISC II, its grams, the likelihood's disc and circle-3's."""
    frame = list(frames(*KINDS["as designed"], 2, seed))[1]
    result = load("circle-likelihood").runner(only=["grams", "circle"])(frame)
    old = load("circle-3").runner()(frame).get("circle")
    assert isinstance(old, Circle)
    return frame, result["grams"].values, result["circle"], old


def outline(axes: Any, shape: Circle, colour: str, style: str, label: str) -> None:
    xy = shape.outline_cm()
    axes.plot(*np.vstack([xy, xy[:1]]).T, style, color=colour, lw=1.4, label=label)


def forward(folder: Path, seed: int) -> None:
    frame, grams, found, old = example(seed)
    assert frame.truth is not None
    true = frame.truth[0].shape
    share = coverage_cm2(Circle(found.x_cm, found.y_cm, found.radius_cm), PAD) / PAD.element_cm**2
    s = float(np.exp(found.posterior.mean[3]))
    u = np.log(np.where(grams > 0.0, grams, 1.0) / np.where(share > 0.0, s * share, 1.0)) / SIGMA
    shown = (
        ("coverage c", share, {"cmap": "Greys", "vmin": 0, "vmax": 1}, "of an element"),
        ("expected load s c", s * share, {"cmap": "viridis", "vmin": 0, "vmax": grams.max()}, "g"),
        ("load read l", grams, {"cmap": "viridis", "vmin": 0, "vmax": grams.max()}, "g"),
        (
            "u = ln(l / s c) / σ",
            np.ma.masked_where((grams <= 0.0) | (share <= 0.0), u),
            {"cmap": "RdBu_r", "vmin": -3, "vmax": 3},
            "grey: nothing read, or bare",
        ),
    )
    figure, many = plt.subplots(1, 4, figsize=(13, 3.9), layout="constrained")
    width, height = PAD.size_cm
    half = 0.5 * PAD.gap_cm
    for axes, (title, values, how, unit) in zip(many, shown, strict=True):
        axes.set_facecolor("0.85")
        box = (-half, width + half, height + half, -half)
        picture = axes.imshow(values, extent=box, **how)
        figure.colorbar(picture, ax=axes, shrink=0.8, location="bottom", label=unit, pad=0.02)
        outline(axes, true, TRUTH, "--", "true outline")
        outline(axes, found, FOUND, "-", "likelihood")
        outline(axes, old, OLD, ":", "circle-3")
        axes.set(title=title, xlabel="x, cm")
    around(many, true)
    many[0].set_ylabel("y, cm")
    figure.legend(
        *many[0].get_legend_handles_labels(), ncols=3, fontsize=9, loc="outside upper center"
    )
    save(figure, folder / "likelihood-forward.png")


def around(many: Any, true: Any) -> None:
    """Cut all axes down to the object and two elements around it."""
    reach = true.radius_cm + 2.6
    for axes in many:
        axes.set(
            xlim=(true.x_cm - reach, true.x_cm + reach), ylim=(true.y_cm + reach, true.y_cm - reach)
        )


def region(axes: Any, posterior: Posterior, i: int, j: int) -> None:
    """Draw the shadow of the 90 % region on two of its numbers."""
    covariance = posterior.covariance[np.ix_([i, j], [i, j])]
    turn = np.linspace(0.0, 2.0 * np.pi, 200)
    ring = np.linalg.cholesky(covariance) @ np.array([np.cos(turn), np.sin(turn)])
    ring *= np.sqrt(posterior.reach)
    axes.plot(
        posterior.mean[i] + ring[0], posterior.mean[j] + ring[1], color=FOUND, label="90 % region"
    )


def cloud(folder: Path, seed: int) -> None:
    frame, grams, found, old = example(seed)
    del grams
    assert frame.truth is not None
    true = frame.truth[0].shape
    settings = FootprintSettings(on_pad="whole", precision=0.05, most_points=4096)
    posterior = FootprintDisc(settings).model.posterior(
        load("circle-likelihood").runner(only=["grams"])(frame)["grams"]
    )
    figure, many = plt.subplots(1, 2, figsize=(10, 4.4), layout="constrained")
    names = ("x, cm", "y, cm", "radius, cm")
    truth, its = posterior.numbers(true), posterior.numbers(old)
    for axes, (i, j) in zip(many, ((0, 1), (0, 2)), strict=True):
        size = 2500.0 * posterior.weights
        axes.scatter(*posterior.points[:, [i, j]].T, s=size, color="0.4", alpha=0.4, lw=0)
        region(axes, posterior, i, j)
        axes.plot(truth[i], truth[j], "+", ms=14, mew=2, color=TRUTH, ls="", label="truth")
        axes.plot(posterior.mean[i], posterior.mean[j], "o", color=FOUND, label="posterior mean")
        axes.plot(its[i], its[j], "s", color=OLD, label="circle-3")
        axes.set(xlabel=names[i], ylabel=names[j])
        axes.set_aspect("equal", adjustable="datalim")
        axes.grid(alpha=0.3)
    many[0].invert_yaxis()
    many[0].legend(fontsize=8)
    figure.suptitle("weighted points of the posterior of one frame (DISC II)", fontsize=10)
    save(figure, folder / "likelihood-posterior.png")
    del found


def against_bound(folder: Path, scenes: int, steps: int) -> None:
    rows: dict[str, list[Values]] = {"Bayes bound": [], "circle-likelihood": [], "circle-3": []}
    for sigma in LEVELS:
        voids = VOIDS * sigma / SIGMA
        source = load("circle-likelihood").with_source(
            "simulate", scene="discs", frames=scenes, sigma=sigma, voids=voids
        )
        step = FootprintDisc(FootprintSettings(on_pad="whole", sigma=sigma, voids=voids))
        grams = source.runner(only=["grams"])
        told = reader(
            "circle-likelihood", "circle", **{"circle.sigma": sigma, "circle.voids": voids}
        )
        old = reader("circle-3", "circle")
        found: dict[str, list[tuple[float, ...]]] = {name: [] for name in rows}
        for frame in source.frames(7):
            assert frame.truth is not None
            true = frame.truth[0].shape
            answers = (bound(step.model, grams, frame, steps), told(frame), old(frame))
            for name, answer in zip(rows, answers, strict=True):
                if answer is not None:
                    found[name].append(errors(answer, true))
        for name in rows:
            rows[name].append(np.mean(found[name], axis=0))
            print(f"sigma {sigma:.3f} {name:20s} {rows[name][-1].round(4)} {len(found[name])}")
    figure, many = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained", sharey=True)
    styles = {"Bayes bound": (LEAST, "-"), "circle-likelihood": (FOUND, "o--")}
    for axes, k, what in zip(many, (0, 1), ("centre", "radius"), strict=True):
        for name, values in rows.items():
            colour, style = styles.get(name, (OLD, "s:"))
            axes.semilogy(LEVELS, [v[k] for v in values], style, color=colour, label=name)
        axes.axvline(SIGMA, color="0.8", zorder=0)
        axes.text(SIGMA, 1.4, " calibrated pad", fontsize=8, color="0.4", va="top")
        axes.set(xlabel="unevenness σ (voids in proportion)", title=f"mean error of the {what}")
        axes.grid(alpha=0.3, which="both")
        axes.set_ylim(0.008, 1.5)
    many[0].set_ylabel("cm")
    many[0].legend(fontsize=8, loc="lower right")
    save(figure, folder / "likelihood-bound.png")


def level_of(posterior: Posterior, true: Any) -> float:
    """Return the least probability at which the region holds the truth, 90 % being one of them.

    As `Posterior.reach` has it: the points' own quantile, or Hotelling's, whichever is larger.
    """
    numbers = posterior.numbers(true)
    n, points = len(numbers), max(posterior.equal_points, len(numbers) + 2.0)
    off = np.vstack([numbers, posterior.points[:, :n]]) - posterior.mean[:n]
    squared = (off * np.linalg.solve(posterior.covariance[:n, :n], off.T).T).sum(axis=1)
    rank = float(posterior.weights[squared[1:] < squared[0]].sum())
    scale = n * (points - 1.0) * (points + 1.0) / (points * (points - n))
    return min(rank, float(fdtr(n, points - n, squared[0] / scale)))


def calibration(folder: Path, scenes: int) -> None:
    levels: dict[str, list[float]] = {}
    for name, kind, output in (
        ("circle-likelihood", "discs", "circle"),
        ("rectangle-likelihood", "rectangles", "rectangle"),
    ):
        pipeline = load(name).with_source("simulate", scene=kind, frames=scenes)
        run = pipeline.runner()
        found = [(run(f).get(output), f.truth) for f in pipeline.frames(11)]
        label = f"{kind}, as designed"
        levels[label] = [level_of(a.posterior, t[0].shape) for a, t in found if a and t]
    run = load("circle-likelihood").runner()
    for name in ("30 % voids", "exponent 1, not 1.46", "bumps 2 cells wide", "weight off centre"):
        seen = list(frames(*KINDS[name], scenes, 23))
        answers = [(run(f).get("circle"), f.truth) for f in seen]
        levels[f"discs, {name}"] = [
            level_of(a.posterior, t[0].shape) for a, t in answers if a and t
        ]
    figure, axes = plt.subplots(figsize=(6, 4.6), layout="constrained")
    axes.plot([0, 1], [0, 1], color="0.6", lw=1)
    for k, (name, values) in enumerate(levels.items()):
        grid = np.linspace(0.0, 1.0, 201)
        held = (np.array(values)[:, None] <= grid).mean(axis=0)
        axes.plot(grid, held, lw=2 if k < 2 else 1, ls="-" if k < 2 else "--", label=name)
        print(f"{name:32s} 50 %: {held[100]:.1%}, 90 %: {held[180]:.1%}")
    axes.set(xlim=(0, 1), ylim=(0, 1), xlabel="stated probability of the region")
    axes.set_ylabel("share of scenes whose truth it holds")
    axes.legend(fontsize=8)
    axes.grid(alpha=0.3)
    save(figure, folder / "likelihood-calibration.png")


def pressures(folder: Path, scenes: int) -> None:
    """Draw pressures, what an even face leaves over under a ball, and errors with and without."""
    figure, (first, second, third) = plt.subplots(
        1, 3, figsize=(13, 3.9), layout="constrained", width_ratios=(1, 0.9, 1.7)
    )
    r = np.linspace(-1.0, 1.0, 401)[1:-1]
    for fall, label in ((0.0, "even"), (0.5, "fall ½: ball, elastic pad"), (1.0, "fall 1: soft")):
        first.plot(r, (1.0 + fall) * (1.0 - r * r) ** fall, label=label)
    first.plot(r, np.exp(0.8 * r), "--", label="lean 0.8")
    first.set(xlabel="distance from the middle over the radius", ylim=(0.0, 2.9))
    first.set_ylabel("pressure over its mean")
    first.legend(fontsize=8, loc="upper left")
    first.grid(alpha=0.3)
    left_over(second)
    kinds = ("as designed", "weight off centre", "ball on an elastic pad", "ball on a soft layer")
    kinds = (*kinds, "foam, half a cell")
    ways = {
        "circle-3": (load("circle-3"), OLD),
        "an even face": (load("circle-likelihood").with_settings({"circle.pressure": "even"}), ""),
        "any pressure": (load("circle-likelihood"), FOUND),
    }
    at = np.arange(len(kinds))
    for k, (name, (pipeline, colour)) in enumerate(ways.items()):
        run, off = pipeline.runner(), []
        for kind in kinds:
            seen = [(run(f).get("circle"), f.truth) for f in frames(*KINDS[kind], scenes, 29)]
            off.append(np.mean([errors(a, t[0].shape) for a, t in seen if a and t], axis=0))
        for j, shade in enumerate((1.0, 0.45)):
            place = at + 0.28 * (k - 1) + 0.06 - 0.12 * (1 - j)
            label = f"{name}: {('centre', 'radius')[j]}"
            third.bar(place, np.array(off)[:, j], 0.12, color=colour or "0.4", alpha=shade,
                      label=label)  # fmt: skip
        print(f"{name:14s}", np.round(off, 3).tolist())
    third.set_xticks(
        at, [k.replace(", ", ",\n").replace(" on ", "\non ") for k in kinds], fontsize=8
    )
    third.set_ylabel("mean error, cm")
    third.grid(alpha=0.3, axis="y")
    third.set_ylim(0.0, 1.3 * third.get_ylim()[1])
    third.legend(fontsize=8, ncols=3, loc="upper left")
    save(figure, folder / "likelihood-pressure.png")


def left_over(axes: Any) -> None:
    """Draw the residuals that an even face leaves over under a ball."""
    frame = list(frames(*KINDS["ball on an elastic pad"], 2, 8))[1]
    assert frame.truth is not None
    run = load("circle-likelihood").with_settings({"circle.pressure": "even"})
    result = run.runner(only=["grams", "circle"])(frame)
    found, grams, true = result["circle"], result["grams"].values, frame.truth[0].shape
    share = coverage_cm2(Circle(found.x_cm, found.y_cm, found.radius_cm), PAD) / PAD.element_cm**2
    s = float(np.exp(found.posterior.mean[3]))
    seen = (grams > 0.0) & (share > 0.05)
    u = np.log(np.where(seen, grams, 1.0) / np.where(seen, s * share, 1.0)) / SIGMA
    width, height = PAD.size_cm
    half = 0.5 * PAD.gap_cm
    axes.set_facecolor("0.85")
    picture = axes.imshow(
        np.ma.masked_where(~seen, u), extent=(-half, width + half, height + half, -half),
        cmap="RdBu_r", vmin=-3, vmax=3,
    )  # fmt: skip
    axes.figure.colorbar(picture, ax=axes, shrink=0.8, label="u, standard deviations")
    outline(axes, true, TRUTH, "--", "true outline")
    outline(axes, found, "0.4", "-", "an even face")
    full = load("circle-likelihood").runner()(frame)["circle"]
    outline(axes, full, FOUND, "-", "any pressure")
    around([axes], true)
    axes.set(title="one ball: what an even face leaves over", xlabel="x, cm", ylabel="y, cm")
    axes.title.set_fontsize(9)
    axes.legend(fontsize=8, loc="lower right")


def save(figure: Any, path: Path) -> None:
    figure.savefig(path, dpi=90)
    plt.close(figure)
    print(f"{path}: {path.stat().st_size / 1024:.0f} kB")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    here = Path(__file__).parents[1] / "docs/pictures"
    parser.add_argument("-o", "--output", type=Path, default=here)
    parser.add_argument("--scenes", type=int, default=100, help="of a level, and half of a curve")
    parser.add_argument("--steps", type=int, default=5000, help="of each Markov chain")
    parser.add_argument("--seed", type=int, default=1, help="of the frame that is shown")
    chosen = parser.parse_args()
    warm_up()
    plt.switch_backend("Agg")
    forward(chosen.output, chosen.seed)
    cloud(chosen.output, chosen.seed)
    pressures(chosen.output, chosen.scenes)
    calibration(chosen.output, 2 * chosen.scenes)
    against_bound(chosen.output, chosen.scenes, chosen.steps)


if __name__ == "__main__":
    main()
