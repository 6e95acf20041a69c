"""Figures 4.4 and 4.5: how many readings are enough."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.threshold_errors import ThresholdErrors, threshold_errors
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
LONGEST_GROUP = 30
"""Figure 4.4 is drawn to this N."""
FLAT = 0.25
"""Change from which a variance is not settled: that of one from 30 readings has this deviation."""


def running_variances(error_cm: Array, largest: int) -> Array:
    """Return the variance of the first 2, 3, … readings of every group, shape (..., groups, N-1).

    Parameters
    ----------
    error_cm : ndarray, shape (..., readings)
    largest : int
        N: the readings are cut into groups of so many, what is left over is left out.
    """
    n_groups = error_cm.shape[-1] // largest
    groups = error_cm[..., : n_groups * largest].reshape(*error_cm.shape[:-1], n_groups, largest)
    n = np.arange(1, largest + 1)
    sums, squares = groups.cumsum(axis=-1), (groups**2).cumsum(axis=-1)
    variances = (squares - sums**2 / n)[..., 1:] / (n[1:] - 1)
    return np.asarray(np.maximum(variances, 0.0))


class SampleVariances(NamedTuple):
    """Variances of the first N readings of many samples, at one threshold.

    Parameters
    ----------
    readings : ndarray, shape (N - 1,)
        2 to N.
    runs : ndarray, shape (discs, samples, N - 1)
    mean, low, high : ndarray, shape (N - 1,)
        Over all samples; nine in ten lie between low and high.
    """

    readings: NDArray[np.intp]
    runs: Array
    mean: Array
    low: Array
    high: Array


def _at_the_chosen_threshold(found: ThresholdErrors) -> SampleVariances:
    at = found.at(numbers("threshold")["chosen_v"])
    largest = min(LONGEST_GROUP, found.error_cm.shape[2])
    runs = running_variances(found.error_cm[at], largest)
    low, high = np.quantile(runs.reshape(-1, largest - 1), [0.05, 0.95], axis=0)
    return SampleVariances(np.arange(2, largest + 1), runs, runs.mean(axis=(0, 1)), low, high)


def _figure_4_4(work: Work) -> Made:
    found = threshold_errors(work)
    samples = _at_the_chosen_threshold(found)
    end = min(work.group, int(samples.readings[-1]))
    mean, low, high = (float(v[end - 2]) for v in (samples.mean, samples.low, samples.high))
    unsure = float(samples.runs[..., end - 2].std(axis=1).mean() / mean)
    what = f"variance of the radius error, N = {end}"
    said = numbers("variance")["variance_cm2"]
    columns = (samples.readings, samples.mean, samples.low, samples.high)
    return Made(
        compared=(Compared(what, "cm²", mean, said, low, high),),
        findings=(hardly_changes(samples.runs, _ends(samples.runs, work)),),
        table=Table(
            ("readings", "mean_cm2", "low_cm2", "high_cm2"),
            [tuple(map(float, row)) for row in zip(*columns, strict=True)],
        ),
        figure=_variance_figure(found, samples),
        notes=(
            f"A variance taken from {end} readings is uncertain by {100 * unsure:.0f} % "
            "(standard deviation over samples).",
        ),
    )


def _variance_figure(found: ThresholdErrors, samples: SampleVariances) -> Figure:
    figure = new_figure(8.0, 6.2)
    axes = figure.subplots()
    n, said = samples.readings, numbers("variance")["variance_cm2"]
    axes.fill_between(
        n, samples.low, samples.high, color="0.88", label="nine in ten samples of any disc"
    )
    for k in range(len(found.names)):
        label = f"{found.label(k)}: first readings"
        axes.plot(n, samples.runs[k, 0], lw=1.0, color=f"C{k}", label=label)
    axes.plot(n, samples.mean, "k-", lw=2.0, label="mean of all samples")
    axes.axhline(said, color="0.4", ls=":", label="the thesis', after N = 14")
    axes.set(
        xlabel="readings N",
        ylabel="variance of the radius error / cm²",
        title="Variance against the number of readings, threshold 0.01 V",
    )
    axes.grid(alpha=0.3)
    figure.legend(loc="outside lower center", ncols=2, fontsize="small")
    return figure


def _ends(runs: Array, work: Work) -> tuple[int, int]:
    """Return the N from which the thesis finds the variance flat, and the N it chooses."""
    last = min(work.group, runs.shape[-1] + 1)
    return min(int(numbers("variance")["flat_from"]), last), last


def _change(runs: Array, ends: tuple[int, int]) -> Array:
    start, last = ends
    return np.abs(runs[..., last - 2] / runs[..., start - 2] - 1.0)


def hardly_changes(runs: Array, ends: tuple[int, int]) -> Finding:
    """Return whether a variance is settled between the N of the flat part and the chosen N.

    Parameters
    ----------
    runs : ndarray, shape (..., N - 1)
        Running variances.
    ends : (int, int)
        The two N.
    """
    (start, last), change = ends, _change(runs, ends)
    return Finding(
        f"from N = {start} on the variance hardly changes, so {last} readings are enough",
        f"from {start} to {last} readings it changes by {100 * np.median(change):.0f} % in half "
        f"of all series, by more than {100 * np.quantile(change, 0.95):.0f} % in one of twenty",
        f"a change of {100 * FLAT:.0f} % or more in half of all series",
        bool(np.median(change) < FLAT),
    )


def hardly_changes_anywhere(runs: Array, level_v: Array, ends: tuple[int, int]) -> Finding:
    """Return whether the same holds at each threshold.

    Parameters
    ----------
    runs : ndarray, shape (levels, ..., N - 1)
    level_v : ndarray, shape (levels,)
    ends : (int, int)
        The two N.
    """
    change = np.median(_change(runs, ends).reshape(len(level_v), -1), axis=1)
    worst = int(change.argmax())
    return Finding(
        f"the whole range of thresholds strengthens that {ends[1]} readings are enough",
        f"the variance changes most at {level_v[worst]:g} V, by {100 * change[worst]:.0f} % in "
        f"half of all series from {ends[0]} to {ends[1]} readings",
        f"a threshold at which it changes by {100 * FLAT:.0f} % or more in half of all series",
        bool(change[worst] < FLAT),
    )


def _figure_4_5(work: Work) -> Made:
    found = threshold_errors(work)
    largest = min(LONGEST_GROUP, found.error_cm.shape[2])
    runs = running_variances(found.error_cm, largest)
    first, mean = runs[:, :, 0].mean(axis=1), runs.mean(axis=(1, 2))
    n = np.arange(2, largest + 1)
    figure = new_figure(11.0, 4.6)
    parts = figure.subplots(1, 2, sharey=True)
    top = float(max(first.max(), mean.max()))
    for axes, values, title in (
        (parts[0], first, "the first readings of each disc"),
        (parts[1], mean, "mean over all samples"),
    ):
        shown = axes.pcolormesh(n, 1e3 * found.level_v, values, vmin=0.0, vmax=top)
        axes.set(title=title, xlabel="readings N")
    parts[0].set_ylabel("threshold / mV")
    figure.colorbar(shown, ax=parts, label="variance of the radius error / cm²")
    at_group = mean[:, min(work.group, largest) - 2]
    return Made(
        findings=(hardly_changes_anywhere(runs, found.level_v, _ends(runs, work)),),
        table=Table(
            ("threshold_v", "readings", "variance_cm2"),
            [
                (float(v), int(k), float(mean[i, j]))
                for i, v in enumerate(found.level_v)
                for j, k in enumerate(n)
            ],
        ),
        figure=figure,
        notes=(
            f"At N = {min(work.group, largest)} the variance, mean over discs, goes from "
            f"{at_group.min():.3f} to {at_group.max():.3f} cm² with the threshold.",
        ),
    )


ITEMS = (
    Item(
        "figure-4.4",
        "Variance against the number of readings",
        "The variance of the first N errors, for rising N, at the chosen threshold.",
        _figure_4_4,
        "A variance estimated from few readings scatters around one value; it falls or rises with "
        "N only by chance. What N buys is certainty. The thesis does not say which disc or error "
        "its curve is of.",
    ),
    Item(
        "figure-4.5",
        "Variance, readings and threshold",
        "The same for every threshold: what a first series of readings shows, and the mean over "
        "many.",
        _figure_4_5,
        "The thesis' plot is lost; it was one surface.",
    ),
)
