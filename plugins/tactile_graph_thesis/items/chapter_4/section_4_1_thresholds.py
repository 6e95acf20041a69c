"""Section 4.1: a threshold that varies with the load, and why our errors are least at less."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline, load
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.altered import altered
from tactile_graph_thesis.measure.circles import circle_errors
from tactile_graph_thesis.measure.threshold_errors import SCENE
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
FRACTIONS = (0.02, 0.05, 0.1, 0.2)
"""Of the mean reading, from which one is chosen."""
READINGS = 60
"""Of each disc, at most: half to choose the fraction on, half to report."""
COMPELLING = 0.75
"""Share of the error left from which a variable threshold would be compelling."""
RESIDUALS_V = (0.0, 0.005, 0.0125, 0.02)
"""Largest voltages that unloaded elements read; each element's lies evenly between 0 and it."""
LEVELS_V = (0.005, 0.0075, 0.01, 0.0125, 0.015, 0.02, 0.025, 0.03)


def _frames(work: Work) -> list[Frame]:
    return work.frames(SCENE, 6 * work.readings)[: 6 * min(READINGS, work.readings)]


def _radius_cm(frames: list[Frame], pipeline: Pipeline, seed: int) -> Array:
    """Return the mean error of the radius of each disc, shape (discs,)."""
    names = tuple(dict.fromkeys(f.truth[0].name for f in frames if f.truth))
    runner = pipeline.runner(seed=seed)
    return np.asarray(circle_errors(frames, [runner], names)[0, ..., 2].mean(axis=1))


# -- a variable threshold --------------------------------------------------------------------


def variable(fraction: float) -> Pipeline:
    """Return circle-3 with a level that rises with the mean reading of the footprint.

    Parameters
    ----------
    fraction : float
        Of that mean.
    """
    floor = float(numbers("threshold")["low_v"])
    settings = {"fraction": fraction, "floor": floor}
    return altered(
        "circle-3",
        {
            "found": {"step": "threshold_variable", "in": "frame", "with": settings},
            "footprint": {"first_of": ["found.mask"]},
        },
    )


def _variable(work: Work) -> Made:
    frames = _frames(work)
    half = 6 * (len(frames) // 12)
    tried = {f: _radius_cm(frames[:half], variable(f), work.seed).mean() for f in FRACTIONS}
    chosen = min(tried, key=lambda f: float(tried[f]))
    names = tuple(dict.fromkeys(f.truth[0].name for f in frames if f.truth))
    rest = frames[half:]
    one = _radius_cm(rest, load("circle-3"), work.seed)
    other = _radius_cm(rest, variable(chosen), work.seed)
    ways = ("0.01 V for all", f"{chosen:g} of the mean reading")
    groups = {
        name: dict(zip(ways, map(float, pair), strict=True))
        for name, *pair in zip(names, one, other, strict=True)
    }
    return Made(
        findings=(no_compelling_need(one, other),),
        table=Table(
            ("disc", *(f"{w}: error_cm" for w in ways)),
            [(n, *g.values()) for n, g in groups.items()],
        ),
        figure=bars(groups, "mean error of the radius / cm", "One threshold, or one for each"),
        notes=(
            f"The fraction is the best of {', '.join(f'{f:g}' for f in FRACTIONS)} on other "
            f"readings; at least {numbers('threshold')['low_v']:g} V.",
        ),
    )


def no_compelling_need(one_cm: Array, variable_cm: Array) -> Finding:
    """Return whether a universal threshold does about as well.

    Parameters
    ----------
    one_cm, variable_cm : ndarray, shape (discs,)
        Mean errors of the radius.
    """
    return Finding(
        "there is no compelling need for a variable threshold",
        f"mean error over the discs {one_cm.mean():.2f} cm with one for all, "
        f"{variable_cm.mean():.2f} cm with one that varies",
        f"{100 * COMPELLING:.0f} % of the error or less left by the latter",
        bool(variable_cm.mean() > COMPELLING * one_cm.mean()),
    )


# -- residual voltages -----------------------------------------------------------------------


def with_residuals(frames: list[Frame], most_v: float, seed: int) -> list[Frame]:
    """Return the readings on a pad whose elements read something without a load.

    Parameters
    ----------
    frames : list of Frame
    most_v : float
        Of each element it is drawn once, evenly from 0 to this.
    seed : int
    """
    own = most_v * np.random.default_rng(seed).random(frames[0].image.shape)
    return [replace(f, image=f.image.with_values(f.image.values + own)) for f in frames]


def _residuals(work: Work) -> Made:
    frames = _frames(work)
    pipelines = [load("circle-3").with_settings({"footprint.level_v": v}) for v in LEVELS_V]
    errors = {}
    for most in RESIDUALS_V:
        some = with_residuals(frames, most, work.seed)
        errors[most] = np.array([_radius_cm(some, p, work.seed).mean() for p in pipelines])
    best = {most: LEVELS_V[int(e.argmin())] for most, e in errors.items()}
    rows = [(v, *(float(e[k]) for e in errors.values())) for k, v in enumerate(LEVELS_V)]
    columns = ("threshold_v", *(f"to {1e3 * most:g} mV: error_cm" for most in RESIDUALS_V))
    return Made(
        findings=(moves_the_best(best),), table=Table(columns, rows), figure=_curves(errors)
    )


def moves_the_best(best_v: dict[float, float]) -> Finding:
    """Return whether residual voltages bring the best threshold into the thesis' range.

    Parameters
    ----------
    best_v : dict
        Largest residual voltage -> the threshold of least error.
    """
    low, high = numbers("threshold")["best_v"]
    words = ", ".join(f"{1e3 * m:g} mV: {1e3 * v:g} mV" for m, v in best_v.items())
    return Finding(
        "(not in the thesis) residual voltages up to 12.5 mV bring the best threshold from below "
        "into the thesis' range of 0.01 to 0.015 V",
        f"largest residual voltage, and the threshold of least error: {words}",
        "a best threshold in the range without them, or outside it with 12.5 mV",
        best_v[0.0] < low and low <= best_v[0.0125] <= high,
    )


def _curves(errors: dict[float, Array]) -> Figure:
    from tactile_graph_pads.calibration.plot import new_figure

    figure = new_figure(7.5, 4.6)
    axes = figure.subplots()
    for most, e in errors.items():
        axes.plot(1e3 * np.array(LEVELS_V), e, "o-", ms=4, label=f"residuals to {1e3 * most:g} mV")
    axes.set(
        xlabel="threshold / mV",
        ylabel="mean error of the radius / cm",
        title="What unloaded elements read, and the best threshold",
    )
    axes.set_ylim(bottom=0.0, top=2.0)
    axes.grid(alpha=0.3)
    axes.legend()
    return figure


ITEMS = (
    Item(
        "variable-threshold",
        "One threshold or one for each",
        "Error of circle-3's radius with the thesis' threshold and with one that rises with the "
        "load of each cell, on the discs of table 4.1.",
        _variable,
        "The thesis names no law for its variable threshold; ours takes a share of the mean "
        "reading of the footprint.",
        after="4.1",
    ),
    Item(
        "residual-voltages",
        "Residual voltages and the best threshold",
        "Error of circle-3's radius against the threshold on pads whose unloaded elements read "
        "something, as section 4.1 tells.",
        _residuals,
        "The thesis does not say how large its residual voltages are.",
        after="4.1",
    ),
)
