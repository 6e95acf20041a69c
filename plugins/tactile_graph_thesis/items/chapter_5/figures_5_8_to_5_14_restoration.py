"""Figures 5.8 to 5.14: Bayesian restoration with and without lines."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tactile_graph_thesis.drawing.line_fields import draw_5_8, draw_5_10_to_5_13, draw_5_14
from tactile_graph_thesis.drawing.panels import FOUND, draw_image, draw_true, finish, panels
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.measure.restorations import (
    Restoration,
    figure_5_8,
    figure_5_14,
    figures_5_10_to_5_13,
)
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BIG = 0.1
"""Share of an image's peak above which a cell counts for the object's size."""


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


# -- the simulated rectangle -----------------------------------------------------------------


def _simulated(work: Work) -> Restoration:
    return work.once("figure 5.8", lambda: figure_5_8(work.seed))


def _figure_5_8(work: Work) -> Made:
    made = _simulated(work)
    assert made.truth is not None
    true = made.truth.values
    off = {
        name: _rms(image.values - true)
        for name, image in (
            ("corrupted", made.observed),
            ("without lines", made.smooth),
            ("with lines", made.lined),
        )
    }
    words = ", ".join(f"{name} {value:.1f}" for name, value in off.items())
    return Made(
        findings=(
            Finding(
                "with lines the restored image looks much like the original, without them it is "
                "smoothed throughout",
                f"levels off the original (rms): {words}",
                off["with lines"] < min(off["without lines"], off["corrupted"]),
            ),
        ),
        figure=draw_5_8(made),
    )


def _figure_5_9(work: Work) -> Made:
    made = _simulated(work)
    assert made.truth is not None
    true = np.diff(made.truth.values, axis=0) != 0.0, np.diff(made.truth.values, axis=1) != 0.0
    found = made.lines.horizontal, made.lines.vertical
    missing = sum(int((t & ~f).sum()) for t, f in zip(true, found, strict=True))
    extra = sum(int((f & ~t).sum()) for t, f in zip(true, found, strict=True))
    figure, axes = panels(1, panel_in=4.2)
    draw_image(axes[0], made.truth, 2.0 * made.truth.peak)
    _draw_lines(axes[0], made)
    return Made(
        findings=(
            Finding(
                "the lines match the rectangle's dimensions exactly",
                f"{missing} of the {sum(int(t.sum()) for t in true)} lines of its outline are "
                f"missing, {extra} are elsewhere",
                missing == 0,
            ),
        ),
        figure=finish(figure, axes, ["lines over the original"]),
    )


def _draw_lines(axes: Axes, made: Restoration) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(
        LineCollection(
            list(made.lines.segments_cm), colors=FOUND, linewidths=1.8, label="line that is on"
        )
    )


# -- readings of the pad ---------------------------------------------------------------------


def _restored(work: Work) -> tuple[Restoration, ...]:
    return work.once("figures 5.10 to 5.13", lambda: figures_5_10_to_5_13(work.seed, work.pad_name))


def _figure_of(index: int) -> Callable[[Work], Made]:
    """Return a function that draws one object's restorations."""

    def make(work: Work) -> Made:
        made = _restored(work)[index]
        read, smooth, lined = (im.values for im in (made.observed, made.smooth, made.lined))
        size = [int((im > BIG * read.max()).sum()) for im in (read, smooth)]
        moved = [_rms(im - read) / float(read.max()) for im in (smooth, lined)]
        return Made(
            findings=(
                Finding(
                    "without lines the object seems bigger, and the image is smooth",
                    f"{size[1]} cells above {100 * BIG:.0f} % of the peak against {size[0]} as "
                    "read",
                    size[1] > size[0],
                ),
                Finding(
                    "with lines the image is not changed much",
                    f"it moves by {100 * moved[1]:.0f} % of the peak (rms), without lines by "
                    f"{100 * moved[0]:.0f} %",
                    moved[1] < moved[0],
                ),
            ),
            figure=draw_5_10_to_5_13([made]),
        )

    return make


def _figure_5_13(work: Work) -> Made:
    figure, axes = panels(3)
    for one, made in zip(axes, _restored(work), strict=True):
        draw_image(one, made.observed, 3.0 * made.observed.peak)
        _draw_lines(one, made)
        draw_true(one, made.shape)
    return Made(figure=finish(figure, axes, [m.name for m in _restored(work)]))


def _figure_5_14(work: Work) -> Made:
    hulls = figure_5_14(work.seed, work.pad_name)
    ratios = [h.bayesian.area_cm2 / h.heuristic.area_cm2 for h in hulls]
    words = ", ".join(
        f"{h.name} {h.bayesian.area_cm2:.0f} and {h.heuristic.area_cm2:.0f} cm²" for h in hulls
    )
    return Made(
        findings=(
            Finding(
                "the hulls by both ways are very similar",
                f"areas by lines and by circle-3: {words}",
                all(0.9 < r < 1.0 / 0.9 for r in ratios),
            ),
        ),
        figure=draw_5_14(hulls),
    )


_SAMPLED = (
    "The thesis gives neither its image nor its noise in numbers; ours are of our choice. Its line "
    "potentials are partly lost."
)
_READ = (
    "A simulated reading of the same object. The images are on a logarithmic scale, since "
    "single elements read many times as much as their neighbours; the thesis set its two "
    "parameters anew for each object and does not give them."
)
ITEMS = (
    Item(
        "figure-5.8",
        "Restoring a simulated image",
        "A rectangle on an even floor: original, corrupted, restored without and with lines.",
        _figure_5_8,
        _SAMPLED,
    ),
    Item(
        "figure-5.9",
        "Lines of the simulated image",
        "The line field of figure 5.8.",
        _figure_5_9,
        _SAMPLED,
    ),
    *(
        Item(
            f"figure-5.{10 + k}",
            f"Restoring {name}",
            f"{name} of table 5.1 as read, restored without and with lines, and its lines.",
            _figure_of(k),
            _READ,
        )
        for k, name in enumerate(("Disc I", "Disc II", "RECTANGLE II"))
    ),
    Item(
        "figure-5.13",
        "Lines of three objects",
        "The line fields of figures 5.10 to 5.12.",
        _figure_5_13,
        _READ,
    ),
    Item(
        "figure-5.14",
        "Hulls by both ways",
        "The convex hull of the line field and of circle-3's boundary, for both discs.",
        _figure_5_14,
        _READ,
    ),
)
