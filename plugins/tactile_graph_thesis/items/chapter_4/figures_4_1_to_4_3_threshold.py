"""Figures 4.1 to 4.3: the threshold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Mask, load
from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_thesis.drawing.panels import draw_mask, draw_true, finish, panels
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.measure.shown_reading import TRIED, true_shape
from tactile_graph_thesis.measure.threshold_errors import (
    SCENE,
    ThresholdErrors,
    threshold_errors,
)
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]


# -- figure 4.1 ------------------------------------------------------------------------------


def _figure_4_1(work: Work) -> Made:
    frame = work.frames(SCENE, 6 * work.readings)[0]
    levels = numbers("threshold")["footprints_v"]
    base = load("circle-3")
    runners = [base.with_settings({"footprint.level_v": v}).runner(["footprint"]) for v in levels]
    masks = [run(frame)["footprint"] for run in runners]
    true = true_shape(frame)
    figure, axes = panels(2)
    for one, mask in zip(axes, masks, strict=True):
        draw_mask(one, mask)
        draw_true(one, true)
    finish(
        figure,
        axes,
        [f"threshold {v:g} V, {m.count} cells" for v, m in zip(levels, masks, strict=True)],
    )
    of_disc = work.frames(SCENE, 6 * work.readings)[::6]
    counts = np.array(
        [
            [(m.count, voids(m, true_shape(f))) for m in (run(f)["footprint"] for run in runners)]
            for f in of_disc[:TRIED]
        ],
        np.float64,
    )
    return Made(findings=by_threshold(counts, levels), figure=figure)


def by_threshold(counts: Array, levels: list[float]) -> tuple[Finding, ...]:
    """Return whether the lower of two thresholds gives a larger footprint with fewer voids.

    Parameters
    ----------
    counts : ndarray, shape (readings, 2, 2)
        At the lower and the higher one, cells that are on, and cells void under the object.
    levels : list of float
    """
    cells, void = (counts[..., k].mean(axis=0) for k in (0, 1))
    return (
        Finding(
            "a very low threshold gives a very big footprint, a higher one a smaller",
            f"{cells[0]:.1f} cells at {levels[0]:g} V, {cells[1]:.1f} at {levels[1]:g} V, means "
            f"of {len(counts)} readings",
            "less than a tenth more cells; that there are no fewer goes without saying",
            bool(cells[0] >= 1.1 * cells[1]),
        ),
        Finding(
            "the higher threshold leaves a lot of voids under the object, and some are there "
            "at the lower one too",
            f"{void[1]:.1f} cells void at {levels[1]:g} V, {void[0]:.1f} at {levels[0]:g} V",
            "less than half a cell void at either, or less than half a cell more at the higher",
            bool(void[1] > void[0] + 0.5 and void[0] > 0.5),
        ),
    )


def voids(mask: Mask, disc: Circle) -> int:
    """Return how many cells with their centre in the disc are off."""
    off = np.hypot(mask.x_cm[None, :] - disc.x_cm, mask.y_cm[:, None] - disc.y_cm)
    return int(((off < disc.radius_cm - 0.5) & ~mask.values).sum())


# -- figures 4.2 and 4.3 ---------------------------------------------------------------------


def _curves(axes: Axes, found: ThresholdErrors, discs: list[int], group: int) -> None:
    n = found.error_cm.shape[2] // group
    for k in discs:
        size = np.abs(found.error_cm[:, k])
        means = size[:, : n * group].reshape(len(size), n, group).mean(axis=2)
        low, high = np.quantile(means, [0.05, 0.95], axis=1)
        axes.fill_between(1e3 * found.level_v, low, high, color=f"C{k}", alpha=0.15, lw=0)
        axes.plot(
            1e3 * found.level_v, found.mean_cm[:, k], ".-", color=f"C{k}", label=found.label(k)
        )
    axes.set(xlabel="threshold / mV", ylabel="mean error of the radius / cm")
    axes.grid(alpha=0.3)


def _of_radius(found: ThresholdErrors) -> list[list[int]]:
    """Return the discs of each radius, lightest first."""
    radii = dict.fromkeys(found.radius_cm.tolist())
    return [[int(k) for k in np.flatnonzero(found.radius_cm == r)] for r in radii]


def _threshold_table(found: ThresholdErrors) -> Table:
    columns = ("threshold_v", *(f"{found.label(k)}: error_cm" for k in range(len(found.names))))
    rows = [
        (float(v), *map(float, row)) for v, row in zip(found.level_v, found.mean_cm, strict=True)
    ]
    return Table(columns, rows)


def _figure_4_2(work: Work) -> Made:
    found = threshold_errors(work)
    figure = new_figure(11.0, 4.6)
    parts = figure.subplots(1, 2, sharey=True)
    for axes, discs in zip(parts, _of_radius(found), strict=True):
        _curves(axes, found, discs, work.group)
        axes.set_title(f"discs of {found.radius_cm[discs[0]]:g} cm")
        axes.legend(fontsize="small")
    return Made(
        findings=_light_and_heavy(found),
        table=_threshold_table(found),
        figure=figure,
        notes=_notes(work, found),
    )


def _light_and_heavy(found: ThresholdErrors) -> tuple[Finding, ...]:
    said = numbers("threshold")
    above = found.level_v > said["best_v"][1] + 1e-9
    light, heavy = ([group[end] for group in _of_radius(found)] for end in (0, -1))
    lightest, heaviest = (found.mean_cm[above][:, some] for some in (light, heavy))
    lightest_below = found.mean_cm[~above][:, light]
    small = float((found.mean_cm[:, heavy] < said["error_below_cm"]).mean())
    return (
        Finding(
            "above 0.015 V heavier discs of the same radius err less",
            f"mean error there {lightest.mean():.2f} cm for the lightest, "
            f"{heaviest.mean():.2f} cm for the heaviest discs",
            "a level above 0.015 V at which one of the heaviest errs as much as the lightest",
            bool((heaviest < lightest).all()),
        ),
        Finding(
            "heavier discs err by less than 1 cm for most thresholds",
            f"the heaviest do at {100 * small:.0f} % of the levels",
            "1 cm or more at half of the levels",
            small > 0.5,
        ),
        Finding(
            "the lightest discs err more above 0.015 V than below",
            f"{lightest.mean():.2f} cm above, {lightest_below.mean():.2f} cm up to it",
            "no larger mean error above",
            bool(lightest.mean() > lightest_below.mean()),
        ),
    )


def _notes(work: Work, found: ThresholdErrors) -> tuple[str, ...]:
    return (
        f"Lines are means over {found.error_cm.shape[2]} readings of each disc; nine in ten means "
        f"of {work.group} readings, the thesis' own number, lie in the bands.",
    )


def _figure_4_3(work: Work) -> Made:
    found, said = threshold_errors(work), numbers("threshold")
    figure = new_figure(8.0, 6.0)
    axes = figure.subplots()
    low, high = said["best_v"]
    axes.axvspan(1e3 * low, 1e3 * high, color="0.9", zorder=0, label="the thesis' best range")
    _curves(axes, found, list(range(len(found.names))), work.group)
    axes.set_title("All discs of table 4.1")
    figure.legend(loc="outside lower center", ncols=3, fontsize="small")
    best = (found.level_v >= low - 1e-9) & (found.level_v <= high + 1e-9)
    what, limit = "largest mean error between 0.01 and 0.015 V", said["error_below_cm"]
    worst = float(found.mean_cm[best].max())
    return Made(
        compared=(Compared(what, "cm", worst, limit, limit=True),),
        findings=_one_threshold(found),
        table=_threshold_table(found),
        figure=figure,
        notes=_notes(work, found),
    )


def _one_threshold(found: ThresholdErrors) -> tuple[Finding, ...]:
    said, over_all = numbers("threshold"), found.mean_cm.mean(axis=1)
    low, high = said["best_v"]
    least_v, at = float(found.level_v[over_all.argmin()]), found.at(said["chosen_v"])
    more = over_all[at] / over_all.min()
    return (
        Finding(
            "errors are lowest between 0.01 and 0.015 V",
            f"the mean over all discs is least at {least_v:g} V, {over_all.min():.3f} cm",
            "a least error elsewhere",
            low - 1e-9 <= least_v <= high + 1e-9,
        ),
        Finding(
            "one threshold, 0.01 V, serves all discs",
            f"the mean error over all discs there is {over_all[at]:.3f} cm, "
            f"{100 * (more - 1):.0f} % above the least of any level; "
            f"the worst disc's {found.mean_cm[at].max():.2f} cm",
            "an error there a quarter above the least of any level",
            bool(over_all[at] < 1.25 * over_all.min()),
        ),
    )


_PAD = (
    "The simulated pad was fitted to the tables of discs, not to this study. "
    "Cardboard under the objects and a converter step far below the threshold leave little for a "
    "low threshold to pick up; the thesis' pad had residual voltages the model lacks."
)
ITEMS = (
    Item(
        "figure-4.1",
        "Footprints at two thresholds",
        "The lightest large disc at a low and at a high threshold.",
        _figure_4_1,
        _PAD,
    ),
    Item(
        "figure-4.2",
        "Error against threshold, by radius",
        "Mean error of circle-3's radius over the thesis' range of thresholds, for light and "
        "heavy discs of two radii.",
        _figure_4_2,
        _PAD,
    ),
    Item(
        "figure-4.3",
        "Error against threshold, all discs",
        "The same curves together: whether one threshold is enough.",
        _figure_4_3,
        _PAD,
    ),
)
