"""Pictures of what was learned about a pad; each a figure with axes, units and legend."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.calibration.plot import new_figure
from tactile_graph_pads.learned import STATES
from tactile_graph_pads.learning.learn import LearnedPad
from tactile_graph_pads.learning.place_fit import HeldOut
from tactile_graph_pads.learning.summary import UNITS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
MARKS = {"dead": ("x", "#d62728"), "stuck": ("s", "#ff7f0e"), "noisy": ("^", "#9467bd"),
         "missing": ("o", "#7f7f7f")}  # fmt: skip
BEFORE, AFTER, UNLIKE = "#8a8f98", "#0b5cad", "#d1681e"
WIDTH_IN = 9.0


class Picture(NamedTuple):
    """A figure with its title and what it shows in words."""

    title: str
    caption: str
    figure: Figure


def pictures(found: LearnedPad) -> Iterator[Picture]:
    """Yield the pictures of whatever was learned."""
    yield _empty_pad(found)
    if found.gains is not None and found.gains.stand_out:
        yield _gains(found)
    if found.under is not None and len(found.under):
        yield _under_objects(found)
    if found.curve is not None:
        yield _law(found)
    if found.place is not None:
        yield _places(found)


def _empty_pad(found: LearnedPad) -> Picture:
    elements, unit = found.elements, UNITS[found.learned.reading]
    figure, (left, right) = _pair(_map_height(found))
    _map(left, elements.noise, f"noise / {unit} (one standard deviation)", "viridis",
         _middle(elements.noise[elements.good]))  # fmt: skip
    _map(right, elements.offset, f"offset / {unit}", "cividis",
         _middle(elements.offset[elements.good]))  # fmt: skip
    for axes in (left, right):
        _mark(axes, elements.state)
    handles, labels = left.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside lower center", ncols=4)
    rest = found.resting
    where = "of the empty pad" if rest.from_empty else "in all; each element where untouched"
    caption = (
        f"From {rest.frames} frames {where}. Colours span 1 to 99 % of the good elements; marked "
        "are those that are no good."
    )
    return Picture("The empty pad", caption, figure)


def _gains(found: LearnedPad) -> Picture:
    assert found.gains is not None
    figure, (left, right) = _pair(_map_height(found))
    good = found.elements.good
    span = max(float(np.quantile(np.abs(np.log(found.elements.gain[good])), 0.98)), 0.02)
    limits = (float(np.exp(-span)), float(np.exp(span)))
    _map(left, found.elements.gain, "gain, relative to the median", "RdBu_r", limits, True)
    _mark(left, found.elements.state)
    first, second = (half.ravel() for half in found.gains.halves)
    right.plot(np.exp(first), np.exp(second), ".", color=AFTER, ms=4, label="element")
    ends = np.nanmin([first, second]), np.nanmax([first, second])
    right.plot(np.exp(ends), np.exp(ends), color=BEFORE, lw=1, label="both alike")
    right.set(xscale="log", yscale="log", xlabel="gain from one half of the frames",
              ylabel="gain from the other half")  # fmt: skip
    for axis in (right.xaxis, right.yaxis):
        _plain_ticks(axis)
    right.legend()
    caption = (
        f"How strongly elements answer, in {UNITS[found.loads]}, compared with their neighbours "
        f"under the same objects. Two halves of the frames agree by {found.gains.alike:.2f} "
        "(correlation of the logarithms)."
    )
    return Picture("Gains", caption, figure)


def _under_objects(found: LearnedPad) -> Picture:
    assert found.under is not None
    figure = new_figure(WIDTH_IN, 3.4)
    axes = figure.subplots()
    under = found.under[found.under > 0.0]
    edges = np.geomspace(0.99 * under.min(), 1.01 * under.max(), 80)  # all may read the same
    axes.hist(under, edges.tolist(), color=AFTER, alpha=0.75, label="readings under objects")
    if found.loads == found.learned.reading:
        axes.axvline(found.learned.touched_from, color=BEFORE, ls="--", label="touched from")
    turn_on = found.learned.turn_on
    if turn_on is not None:
        axes.axvline(turn_on.reading, color=UNLIKE, label=f"turn-on: {turn_on.reading:.3g}")
    axes.set(xscale="log", xlabel=f"reading above the offset / {UNITS[found.loads]}",
             ylabel="elements and frames")  # fmt: skip
    axes.legend()
    caption = "All readings of good elements that are more than noise."
    if turn_on is None:
        caption += " They begin in the noise, or slowly: no turn-on is told."
    return Picture("Readings under objects", caption, figure)


def _law(found: LearnedPad) -> Picture:
    assert found.curve is not None
    figure, (left, right) = _pair(3.8)
    reading, grams = np.array([(0.0, 0.0), *found.curve.points]).T
    left.plot(reading, grams, "o-", color=AFTER, ms=4, label="rising lines")
    left.set(xlabel=f"reading above the offset / {UNITS[found.learned.reading]}",
             ylabel="load on the element / g")  # fmt: skip
    left.legend()
    true, told = found.curve.true_g, found.curve.found_g
    right.plot(true, told, ".", color=AFTER, label="held-out frame")
    ends = np.array([true.min(), true.max()])
    right.plot(ends, ends, color=BEFORE, lw=1, label="exact")
    right.set(xlabel="true weight / g", ylabel="weight by the law / g")
    right.legend()
    caption = (
        f"The law from {len(true)} known weights. On the right each frame is weighed by a law "
        f"learned without it and a fifth of the others: median error "
        f"{found.curve.off_percent:.0f} %."
    )
    return Picture("Law", caption, figure)


def _places(found: LearnedPad) -> Picture:
    assert found.place is not None
    figure, (left, right) = _pair(4.2)
    blocks, halves = found.place.blocks, found.place.halves
    _cumulative(left, blocks.off_before, BEFORE, "before")
    _cumulative(left, blocks.off, AFTER, "after, recordings held out")
    _cumulative(left, halves.off, UNLIKE, "after, from an unlike half")
    left.set(xlabel="error of the place / cells", ylabel="share of contacts / %", ylim=(0, 100))
    left.set_xlim(0.0, 1.05 * float(np.quantile(blocks.off_before, 0.99)))
    left.legend(loc="lower right")
    right.plot(*blocks.before.T, ".", color=BEFORE, ms=4, label="before")
    right.plot(*blocks.after.T, ".", color=AFTER, ms=4, label="after, recordings held out")
    right.axhline(0.0, color="0.8", lw=0.8, zorder=0)
    right.axvline(0.0, color="0.8", lw=0.8, zorder=0)
    right.set(xlabel="error in x / cells", ylabel="error in y / cells (down)", aspect="equal")
    right.invert_yaxis()
    right.legend()
    verdict = "" if found.place.helps else " It would not help, and is left out of the pad file."
    return Picture(
        "Places before and after the correction", _place_caption(found) + verdict, figure
    )


def _place_caption(found: LearnedPad) -> str:
    assert found.place is not None

    def told(held: HeldOut) -> str:
        return (
            f"median {np.median(held.off):.3f}, 95 % within {np.quantile(held.off, 0.95):.2f} "
            f"cells, error over stated deviation {held.over_stated:.2f}"
        )

    blocks = found.place.blocks
    return (
        f"{len(blocks.off)} contacts at known places in {found.place.n_groups} recordings or "
        "stretches of one, cross-validated by recording: every place is told by a correction "
        "learned without its recording and those next to it. "
        f"Before: median {np.median(blocks.off_before):.3f} cells, 95 % within "
        f"{np.quantile(blocks.off_before, 0.95):.2f}. After: {told(blocks)}. "
        "Told by one half of the recordings, the other half being as unlike as can be "
        f"(people, objects or postures never seen): {told(found.place.halves)}; the deviation is "
        "made true there."
    )


def _cumulative(axes: Axes, off: Array, colour: str, name: str) -> None:
    axes.plot(np.sort(off), 100.0 * (np.arange(len(off)) + 0.5) / len(off), color=colour,
              label=f"{name}: median {np.median(off):.2f}")  # fmt: skip
    axes.grid(alpha=0.3)


def _pair(height_in: float) -> tuple[Figure, Any]:
    figure = new_figure(WIDTH_IN, height_in)
    return figure, figure.subplots(1, 2)


def _map_height(found: LearnedPad) -> float:
    rows, columns = found.elements.offset.shape
    return float(np.clip(0.5 * WIDTH_IN * rows / columns, 2.2, 6.0)) + 0.6


def _map(
    axes: Axes, values: Array, label: str, colours: str, limits: tuple[float, float],
    logarithmic: bool = False,
) -> None:  # fmt: skip
    from matplotlib.colors import LogNorm, Normalize

    scale = LogNorm(*limits) if logarithmic else Normalize(*limits)
    shown = axes.imshow(values, cmap=colours, interpolation="nearest", aspect="equal", norm=scale)
    axes.set(xlabel="column", ylabel="row")
    bar = axes.figure.colorbar(shown, ax=axes, shrink=0.9, extend="both")
    bar.set_label(label)
    if logarithmic:
        _plain_ticks(bar.ax.yaxis)


def _middle(values: Array) -> tuple[float, float]:
    """Return what 1 and 99 % of values lie below."""
    low, high = np.quantile(values, [0.01, 0.99]) if values.size else (0.0, 1.0)
    return float(low), float(high)


def _plain_ticks(axis: Any) -> None:
    """Write 0.7 and 1.5 on a logarithmic axis of less than a decade, not powers of ten."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1.0, 1.5, 2.0, 3.0, 5.0, 7.0)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _mark(axes: Axes, state: NDArray[np.str_]) -> None:
    for name in STATES[1:]:
        row, column = np.nonzero(state == name)
        if len(row):
            mark, colour = MARKS[name]
            axes.plot(column, row, mark, color=colour, ms=5, mew=1.5, mfc="none",
                      label=f"{name} ({len(row)})")  # fmt: skip
