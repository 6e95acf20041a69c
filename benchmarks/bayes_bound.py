"""The least error possible on the calibrated pad, and how near each localiser comes to it.

Run with ``python benchmarks/bayes_bound.py`` (about four minutes); ``--scenes N`` takes N scenes
a level. Discs of table 4.2 and rectangles of table 4.6 lie on the pad ``thesis`` at three levels
of unevenness, the calibrated one in the middle. The bound is the posterior mean under the pad's
own unevenness by long Markov chains (Metropolis, steps of four lengths; one chain from the truth
and one from the answer): no estimate errs less in the mean square. Its prior is the placement's
own, any place and angle at which the outline lies on the pad, and log-uniform sizes, 0.5 to 15 cm.

The likelihood pipelines are run twice: told the level, and left at the pad's own unevenness.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Frame, Rectangle, load
from tactile_graph.compiled import compiled_as_is, warm_up
from tactile_graph_likelihood.geometry.outlines import unpacked
from tactile_graph_likelihood.single.density.log_posterior import log_likelihood, log_rest
from tactile_graph_likelihood.single.density.problem import problem_of
from tactile_graph_likelihood.single.footprint_of import (
    Footprint,
    FootprintDisc,
    FootprintRectangle,
)
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.readings import readings_of

Values = NDArray[np.float64]
SIGMA, VOIDS = 0.483, 0.164
LEVELS = (0.25, SIGMA, 0.75)


@compiled_as_is
def chain(
    kind: int, start: Values, grid: Values, logs: Values, states: NDArray[np.uint8],
    noise: Values, prior: Values, root: Values, steps: int, seed: int,
) -> Values:  # fmt: skip
    """Return the mean of a Metropolis chain after its first fifth."""
    np.random.seed(seed)  # noqa: NPY002
    n = start.shape[0]
    problem = problem_of(kind, 0, grid, logs, states, noise, prior)
    p, mean, kept = start.copy(), np.zeros(n), 0
    now = log_rest(problem, p)
    if now > -math.inf:
        now += log_likelihood(problem, p)
    for t in range(steps):
        length = 2.0 / math.sqrt(n) * (0.3, 1.0, 1.0, 3.0)[np.random.randint(4)]  # noqa: NPY002
        trial = p.copy()
        for k in range(n):
            z = length * np.random.standard_normal()  # noqa: NPY002
            for m in range(k, n):
                trial[m] += root[m, k] * z
        new = log_rest(problem, trial)
        if new > -math.inf:
            new += log_likelihood(problem, trial)
        if math.log(np.random.random()) < new - now:  # noqa: NPY002
            p, now = trial, new
        if 5 * t >= steps:
            mean += p
            kept += 1
    return mean / kept


def bound(model: Model, run: Callable[[Frame], object], frame: Frame, steps: int) -> object:
    """The shape of the long-run posterior mean."""
    image = run(frame)["grams"]  # type: ignore[index]
    readings = readings_of(image, model.gap_cm, model.noise.least)
    found = model.posterior_of(readings)
    width, height = readings.size_cm
    prior = np.array([*readings.grid[:2], width, height, 0.5, 15.0, 1.0, 0.0, 0.0])
    assert frame.truth is not None
    truth = found.mean.copy()
    truth[:-1] = found.numbers(frame.truth[0].shape)
    prior[7] = found.mean[4] if len(truth) > 4 else 0.0
    root = np.linalg.cholesky(found.covariance + 1e-9 * np.eye(len(truth)))
    noise = model.noise.vector(1.3)
    means = [
        chain.call(
            model.kind, start, readings.grid, readings.logs, readings.states, noise, prior, root,
            steps, seed,
        )
        for seed, start in enumerate((truth, found.most_likely))
    ]  # fmt: skip
    return unpacked(model.kind, 0, np.mean(means, axis=0))


def errors(found: object, true: object) -> tuple[float, ...]:
    """Distance of the centres and the absolute errors of what else a shape has, in cm and deg."""
    centre = math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm)  # type: ignore[attr-defined]
    if isinstance(true, Circle):
        assert isinstance(found, Circle)
        return centre, abs(found.radius_cm - true.radius_cm)
    assert isinstance(found, Rectangle)
    assert isinstance(true, Rectangle)
    turn = math.degrees(abs(math.remainder(found.angle_rad - true.angle_rad, math.pi)))
    sides = abs(found.length_cm - true.length_cm), abs(found.breadth_cm - true.breadth_cm)
    return centre, *sides, turn


def rectangle_2() -> Callable[[Frame], object]:
    """rectangle-2 as its table reports it: the angle of its axis."""
    from dataclasses import replace

    run = load("rectangle-2").runner()

    def read(frame: Frame) -> object:
        result = run(frame)
        found = result.get("rectangle")
        return None if found is None else replace(found, angle_rad=result["axis"].angle_rad)

    return read


def reader(name: str, output: str, **settings: object) -> Callable[[Frame], object]:
    run = load(name).with_settings(settings).runner()
    return lambda frame: run(frame).get(output)


def contestants(kind: str, sigma: float, voids: float) -> dict[str, Callable[[Frame], object]]:
    shape, first = ("circle", "circle-3") if kind == "discs" else ("rectangle", "rectangle-3")
    told = {f"{shape}.sigma": sigma, f"{shape}.voids": voids}
    guessed = {f"{shape}.estimate": ["sigma", "voids"]}
    found = {
        f"{shape}-likelihood, told": reader(f"{shape}-likelihood", shape, **told),
        f"{shape}-likelihood": reader(f"{shape}-likelihood", shape),
        f"{shape}-likelihood, estimating": reader(f"{shape}-likelihood", shape, **guessed),
        first: reader(first, shape),
    }
    if kind != "discs":
        found["rectangle-2"] = rectangle_2()
    return found


def level(kind: str, sigma: float, scenes: int, steps: int, seed: int) -> None:
    voids = VOIDS * sigma / SIGMA
    source = load("circle-likelihood").with_source(
        "simulate", scene=kind, frames=scenes, sigma=sigma, voids=voids
    )
    settings: dict[str, object] = {"on_pad": "whole", "sigma": sigma, "voids": voids}
    step: Footprint = (FootprintDisc if kind == "discs" else FootprintRectangle)(**settings)  # type: ignore[arg-type]
    grams = source.runner(only=["grams"])
    runs = {"Bayes bound": lambda f: bound(step.model, grams, f, steps)}
    runs.update(contestants(kind, sigma, voids))
    rows: dict[str, list[tuple[float, ...]]] = {name: [] for name in runs}
    lost = dict.fromkeys(runs, 0)
    for frame in source.frames(seed):
        assert frame.truth is not None
        for name, run in runs.items():
            found = run(frame)
            if found is None:
                lost[name] += 1
            else:
                rows[name].append(errors(found, frame.truth[0].shape))
    names = ("centre", "radius") if kind == "discs" else ("centre", "length", "breadth", "angle")
    print(
        f"\n{kind}, sigma {sigma:g}, voids {voids:.3f}: mean error, and over the bound's; cm, deg"
    )
    print(f"{'':34}" + "".join(f"{n:>17}" for n in names) + "   no answer")
    least = np.mean(rows["Bayes bound"], axis=0)
    for name, found in rows.items():
        mean = np.mean(found, axis=0)
        cells = "".join(f"{m:9.4f} {m / b:7.2f}" for m, b in zip(mean, least, strict=True))
        print(f"{name:34}{cells}   {lost[name]} of {scenes}")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=300, help="a level")
    parser.add_argument("--steps", type=int, default=10_000, help="of each Markov chain")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--levels", type=float, nargs="*", default=LEVELS)
    parser.add_argument(
        "--kinds",
        nargs="*",
        default=("discs", "rectangles"),
        help="scenes; also rectangle-1 and rectangle-2, one rectangle of table 4.6 each",
    )
    chosen = parser.parse_args()
    warm_up()
    for kind in chosen.kinds:
        for sigma in chosen.levels:
            level(kind, sigma, chosen.scenes, chosen.steps, chosen.seed)


if __name__ == "__main__":
    main()
