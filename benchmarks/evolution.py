"""Every algorithm from circle-1 to ``locate`` and from thesis-smooth to ``restore``, step by step.

    python benchmarks/evolution.py --frames 60 --tables docs/evolution.md \
        --plot docs/pictures/evolution.png

Each chain follows the pipelines' own ``evolves:``. All run on the same frames: discs on the pad of
the thesis, and on three kinds of pads of `second_simulator`, which none of them is told. The kinds
were chosen before anything was run on them, and the seed is none that a setting was tuned with.

The error of a circle is the mean of the distance of its centre and of what its radius is off, each
with a bootstrap interval of 95 % over frames; a frame without an answer errs by the radius of its
disc in both. The first two steps of the second chain give an image alone: theirs is the root mean
square difference from what an even pad without noise reads, in percent of that image's peak. Times
are medians of the ratio to circle-3's time for the same frame in the same run, intervals likewise.

``--tables`` replaces what follows the line ``## Measured`` of a page.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from second_simulator import BASE, KINDS, Bench

from tactile_graph import Circle, Frame, Pipeline, load
from tactile_graph.compiled import warm_up
from tactile_graph_compare.variants.lineage import nodes_between
from tactile_graph_pads.calibration.plot import new_figure

Array = NDArray[np.float64]
LOCALISERS = ("circle-1", "locate")
RESTORERS = ("thesis-smooth", "bayes-circle")
"""First and last of each chain; the last one's way back by ``evolves`` must lead to the first."""
THESIS_PAD = "the thesis' pad"
OTHERS = ("law 1/F", "12 dead elements", "foam 0.6 cells")
REFERENCE = "circle-3"
IMAGES = ("thesis-smooth", "thesis-lines")
"""Steps that give an image and no circle."""
SHAPES = ("object-likelihood", "locate")
"""Steps that find out which shape it is, and call it an object."""
SEED = 8
BENCH_FRAMES = 12
DRAWS = 2000
HEADING = "## Measured"


class Between(NamedTuple):
    """A number with its interval."""

    value: float
    low: float
    high: float

    def __format__(self, spec: str) -> str:
        return f"{self.value:{spec}} ({self.low:{spec}} to {self.high:{spec}})"


class Measured(NamedTuple):
    """What one pipeline came to on one pad, frame by frame.

    Attributes
    ----------
    centre_cm, radius_cm : ndarray, shape (frames,)
        Errors; NaN of a step that gives an image alone.
    image_percent : ndarray, shape (frames,)
        Error of the image; NaN of a step that gives a circle.
    seconds : ndarray, shape (frames,)
    unanswered : int
    """

    centre_cm: Array
    radius_cm: Array
    image_percent: Array
    seconds: Array
    unanswered: int


# -- the chains ------------------------------------------------------------------------------


def chain(first: str, last: str) -> list[Pipeline]:
    """Return the pipelines from the first to the last, by what each evolved from.

    Parameters
    ----------
    first, last : str

    Raises
    ------
    ValueError
        If the way back from the last does not lead to the first.
    """
    found = [load(last)]
    while found[-1].name != first:
        parent = found[-1].evolves
        if not parent:
            raise ValueError(f"{last} does not evolve from {first}")
        found.append(load(parent))
    return found[::-1]


def change(parent: Pipeline, child: Pipeline) -> tuple[int, str]:
    """Return how many nodes a step touches, and which, as ``compare --lineage`` tells them.

    Parameters
    ----------
    parent, child : Pipeline
    """
    added, removed, changed, _ = nodes_between(parent, child)
    words = [f"adds {', '.join(added)}"] if added else []
    words += [f"drops {', '.join(removed)}"] if removed else []
    words += [f"changes {one.node} ({', '.join(c.what for c in one.changes)})" for one in changed]
    return len(added) + len(removed) + len(changed), "; ".join(words) or "nothing"


# -- frames ----------------------------------------------------------------------------------


def thesis_frames(n: int, seed: int) -> list[tuple[Frame, Array]]:
    """Return frames of the thesis' pad, with what an even one without noise reads.

    Parameters
    ----------
    n, seed : int
    """
    found = load(REFERENCE).with_source("simulate", scene="discs", frames=n).frames(seed)
    return [(frame, _even(frame)) for frame in found]


def other_frames(kind: str, n: int, seed: int) -> list[tuple[Frame, Array]]:
    """Return frames of one of the second simulator's pads, a new one every twelve frames.

    Parameters
    ----------
    kind : str
    n, seed : int
    """
    frames: list[Frame] = []
    for k in range(-(-n // BENCH_FRAMES)):
        rng = np.random.default_rng([seed, list(KINDS).index(kind), k])
        frames += Bench(KINDS[kind], rng).frames(min(BENCH_FRAMES, n - len(frames)))
    return [(frame, _even(frame)) for frame in frames]


def _even(frame: Frame) -> Array:
    """Return what a pad without unevenness, faults and noise reads of the same object."""
    even = replace(BASE, sigma=0.0, voids=0.0, noise_v=0.0)
    image = Bench(even, np.random.default_rng(0)).frame(list(frame.truth or ())).image
    return np.asarray(image.values, np.float64)


# -- measuring -------------------------------------------------------------------------------


def measured(
    pipelines: Sequence[Pipeline], frames: Sequence[tuple[Frame, Array]], seed: int
) -> dict[str, Measured]:
    """Return what every pipeline comes to, all of them frame by frame in turn.

    Parameters
    ----------
    pipelines : sequence of Pipeline
    frames : sequence of (Frame, ndarray)
    seed : int
    """
    runners = {p.name: p.runner(seed=seed) for p in pipelines}
    for runner in runners.values():
        runner(frames[0][0])  # what is made once is no frame's time
    rows: dict[str, list[tuple[float, ...]]] = {name: [] for name in runners}
    order = np.random.default_rng(seed)
    for frame, even in frames:
        for name in order.permutation(list(runners)):
            start = time.process_time()
            result = runners[name](frame)
            seconds = time.process_time() - start
            rows[name].append((*_errors(name, result, frame, even), seconds))
    return {name: _gathered(np.array(told)) for name, told in rows.items()}


def _gathered(rows: Array) -> Measured:
    missing = np.isnan(rows[:, 3])
    return Measured(rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 4], int(missing.sum()))


def _errors(name: str, result: Any, frame: Frame, even: Array) -> tuple[float, float, float, float]:
    """Return errors of centre, radius and image, and NaN in the last place without an answer."""
    assert frame.truth is not None
    true = frame.truth[0].shape
    assert isinstance(true, Circle)
    if name in IMAGES:
        restored = result.get("restored")
        off = np.sqrt(((restored.image.values - even) ** 2).mean()) / even.max()
        return np.nan, np.nan, 100.0 * float(off), 0.0
    found = result["object"].shape if name in SHAPES else result.get("circle")
    if found is None:
        return true.radius_cm, true.radius_cm, np.nan, np.nan
    centre = float(np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
    return centre, abs(_radius(found) - true.radius_cm), np.nan, 0.0


def _radius(found: Any) -> float:
    """Return a disc's radius; of another shape that of a disc of the same area."""
    radius = getattr(found, "radius_cm", None)
    return float(np.sqrt(found.area_cm2 / np.pi) if radius is None else radius)


def bootstrap(values: Array, of: Callable[..., Any] = np.mean) -> Between:
    """Return a statistic with its 95 % interval over resampled frames.

    Parameters
    ----------
    values : ndarray, shape (frames,)
    of : callable
        ``np.mean`` or ``np.median``, with an axis.
    """
    rng = np.random.default_rng(0)
    drawn = of(rng.choice(values, (DRAWS, len(values))), axis=1)
    return Between(float(of(values)), *map(float, np.quantile(drawn, [0.025, 0.975])))


# -- telling ---------------------------------------------------------------------------------


def steps_table(pipelines: Sequence[Pipeline]) -> str:
    """Return what every step of a chain changes.

    Parameters
    ----------
    pipelines : sequence of Pipeline
    """
    rows = [[f"`{pipelines[0].name}`", "–", pipelines[0].about]]
    for parent, child in pairwise(pipelines):
        n, words = change(parent, child)
        rows.append([f"`{child.name}`", str(n), words])
    return table(("step", "nodes touched", "what it does to the one before"), rows)


def errors_table(
    pipelines: Sequence[Pipeline], found: dict[str, Measured], reference: Measured
) -> str:
    """Return errors and times of a chain on one pad.

    Parameters
    ----------
    pipelines : sequence of Pipeline
    found : dict
        Pipeline -> what it came to.
    reference : Measured
        That of circle-3.
    """
    rows = []
    for name in (p.name for p in pipelines):
        its = found[name]
        ratio = bootstrap(its.seconds / reference.seconds, np.median)
        if name in IMAGES:
            errors = [f"image {bootstrap(its.image_percent):.1f} %", "–"]
        else:
            errors = [f"{bootstrap(its.centre_cm):.2f}", f"{bootstrap(its.radius_cm):.2f}"]
        rows.append([f"`{name}`", *errors, f"{ratio:.2g}", str(its.unanswered or "–")])
    heads = ("step", "centre, cm", "radius, cm", f"time / {REFERENCE}'s", "unanswered")
    return table(heads, rows)


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table.

    Parameters
    ----------
    head : sequence of str
    rows : sequence of sequence of str
    """
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def figure(chains: dict[str, list[Pipeline]], found: dict[str, dict[str, Measured]]) -> Any:
    """Return error against time, a panel for each pad, with the intervals of both.

    Parameters
    ----------
    chains : dict
    found : dict
        Pad -> pipeline -> what it came to.
    """
    drawn = new_figure(9.5, 8.0)
    axes = drawn.subplots(2, 2, sharex=True, sharey=True)
    for one, (pad, its) in zip(axes.flat, found.items(), strict=True):
        for k, pipelines in enumerate(chains.values()):
            _draw(one, [p.name for p in pipelines if p.name not in IMAGES], its, f"C{k}")
        one.set(title=pad, xscale="log", yscale="log")
        one.grid(alpha=0.3, which="both")
    for one in axes[-1]:
        one.set_xlabel(f"time of a frame over {REFERENCE}'s, median")
    for one in axes[:, 0]:
        one.set_ylabel("mean error of the radius / cm")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    drawn.legend(handles, labels, loc="outside lower center", fontsize=8)
    return drawn


def _draw(axes: Any, names: Sequence[str], its: dict[str, Measured], color: str) -> None:
    reference = its[REFERENCE].seconds
    x = [bootstrap(its[name].seconds / reference, np.median) for name in names]
    y = [bootstrap(its[name].radius_cm) for name in names]
    axes.errorbar(
        [v.value for v in x],
        [v.value for v in y],
        yerr=_bars(y),
        xerr=_bars(x),
        fmt="o-",
        ms=4,
        lw=0.8,
        capsize=2,
        color=color,
        label=", ".join(f"{k} {name}" for k, name in enumerate(names, 1)),
    )
    for k, (a, b) in enumerate(zip(x, y, strict=True), 1):
        axes.annotate(
            str(k), (a.value, b.value), (5, 4), textcoords="offset points", fontsize=8, color=color
        )


def _bars(values: Sequence[Between]) -> Array:
    return np.array([[v.value - v.low for v in values], [v.high - v.value for v in values]])


# -- the run ---------------------------------------------------------------------------------


def main() -> None:
    """Measure all, print the tables, and write what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=60, help="of each pad")
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--tables", type=Path, help=f"page whose part {HEADING!r} is replaced")
    parser.add_argument("--plot", type=Path)
    asked = parser.parse_args()
    warm_up()
    chains = {f"{first} to {last}": chain(first, last) for first, last in (LOCALISERS, RESTORERS)}
    pipelines = list({p.name: p for some in chains.values() for p in some}.values())
    found = {}
    for pad in (THESIS_PAD, *OTHERS):
        own = pad == THESIS_PAD
        frames = (
            thesis_frames(asked.frames, asked.seed)
            if own
            else other_frames(pad, asked.frames, asked.seed)
        )
        found[pad] = measured(pipelines, frames, asked.seed)
        print(f"{pad}: done", flush=True)
    parts = [HEADING, f"{asked.frames} discs a pad, seed {asked.seed}."]
    for name, some in chains.items():
        parts += [f"### From {name}", steps_table(some)]
        for pad, its in found.items():
            parts += [f"#### {pad[0].upper()}{pad[1:]}", errors_table(some, its, its[REFERENCE])]
    text = "\n\n".join(parts) + "\n"
    print(text)
    if asked.tables:
        page = asked.tables.read_text(encoding="utf-8")
        asked.tables.write_text(page.partition(HEADING)[0] + text, encoding="utf-8")
    if asked.plot:
        figure(chains, found).savefig(asked.plot, dpi=110)


if __name__ == "__main__":
    main()
