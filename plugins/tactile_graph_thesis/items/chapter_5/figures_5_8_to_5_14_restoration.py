"""Figures 5.8 to 5.14: Bayesian restoration with and without lines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from tactile_graph_thesis.drawing.line_fields import (
    draw_5_8,
    draw_5_10_to_5_13,
    draw_5_13,
    draw_5_14,
)
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.restorations import (
    Hulls,
    Restoration,
    Way,
    figures_5_10_to_5_13,
    hulls,
)
from tactile_graph_thesis.measure.simulated_rectangle import TITLES, cells_amiss, figure_5_8
from tactile_graph_thesis.work import Work

BIG = 0.1
"""Share of an image's peak above which a cell counts for the object's size."""
LITTLE = 0.02
"""Share of the peak by which an image may move (rms) that is not changed much."""
SIMILAR = 0.1
"""Share by which the areas of hulls may differ that are very similar."""
READINGS, QUICK_READINGS = 25, 8
"""Of each disc, for figure 5.14."""


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


# -- the simulated rectangle -----------------------------------------------------------------


def _simulated(work: Work) -> list[Restoration]:
    """Return the restorations by each way, the thesis' first."""
    return work.once("figure 5.8", lambda: [figure_5_8(work.seed, way) for way in TITLES])


def _figure_5_8(work: Work) -> Made:
    made = _simulated(work)
    return Made(findings=(looks_like_the_original(made[0]),), figure=draw_5_8(*made))


def looks_like_the_original(made: Restoration) -> Finding:
    """Return whether lines keep what is smoothed away without them.

    Parameters
    ----------
    made : Restoration
    """
    assert made.truth is not None
    true = made.truth.values
    corrupted, smooth, lined = (
        _rms(image.values - true) for image in (made.observed, made.smooth, made.lined)
    )
    return Finding(
        "with lines the restored image looks much like the original, without them it is "
        "smoothed throughout",
        f"levels off the original (rms): corrupted {corrupted:.1f}, without lines {smooth:.1f}, "
        f"with lines {lined:.1f}",
        "lines that take away less than a fifth of the error with noise, or of that without lines",
        lined < 0.8 * min(smooth, corrupted),
    )


def _figure_5_9(work: Work) -> Made:
    made = _simulated(work)
    amiss = {one.restorer: cells_amiss(one) for one in made}
    return Made(findings=(matches_the_rectangle(amiss),), figure=draw_5_8(*made))


def matches_the_rectangle(amiss: dict[str, int]) -> Finding:
    """Return whether lines show the rectangle's dimensions, by the cells amiss of each way.

    Parameters
    ----------
    amiss : dict
        By the name of the way, the thesis' first.
    """
    words = ", ".join(f"{n} by {name}" for name, n in amiss.items())
    return Finding(
        "the lines match the rectangle's dimensions exactly",
        f"cells that what the lines enclose has too many or lacks: {words}",
        "a single one by the first, which is the thesis' schedule",
        next(iter(amiss.values())) == 0,
    )


# -- readings of the pad ---------------------------------------------------------------------


def _restored(work: Work, way: Way) -> tuple[Restoration, ...]:
    def made() -> tuple[Restoration, ...]:
        return figures_5_10_to_5_13(work.seed, work.pad_name, way)

    return work.once(("figures 5.10 to 5.13", way), made)


def _figure_of(index: int) -> Callable[[Work], Made]:
    """Return a function that draws one object's restorations."""

    def make(work: Work) -> Made:
        made, ours = (_restored(work, way)[index] for way in ("thesis", "bayes"))
        return Made(
            findings=(seems_bigger(made), not_changed_much(made)),
            figure=draw_5_10_to_5_13([made, ours]),
        )

    return make


def seems_bigger(made: Restoration) -> Finding:
    """Return whether the object seems bigger without lines.

    Parameters
    ----------
    made : Restoration
    """
    level = BIG * made.observed.peak
    read, smooth = (int((im.values > level).sum()) for im in (made.observed, made.smooth))
    return Finding(
        "without lines the object seems bigger, and the image is smooth",
        f"{smooth} cells above {100 * BIG:.0f} % of the peak against {read} as read",
        "less than a tenth more cells",
        smooth > 1.1 * read,
    )


def not_changed_much(made: Restoration) -> Finding:
    """Return whether the image is hardly another with lines.

    Parameters
    ----------
    made : Restoration
    """
    read = made.observed.values
    smooth, lined = (
        _rms(im.values - read) / made.observed.peak for im in (made.smooth, made.lined)
    )
    return Finding(
        "with lines the image is not changed much",
        f"it moves by {100 * lined:.1f} % of the peak (rms), without lines by {100 * smooth:.0f} %",
        f"a move of {100 * LITTLE:.0f} % of the peak",
        lined < LITTLE,
    )


def _figure_5_13(work: Work) -> Made:
    return Made(figure=draw_5_13(_restored(work, "thesis"), _restored(work, "bayes")))


def _figure_5_14(work: Work) -> Made:
    n = QUICK_READINGS if work.quick else READINGS
    made = hulls(work.seed, n, work.pad_name)
    rows = [
        (h.name, *(getattr(h, w).area_cm2 for w in ("every_line", "enclosed", "logarithmic")),
         h.heuristic.area_cm2)
        for h in made
    ]  # fmt: skip
    columns = ("object", "every line_cm2", "enclosed_cm2", "logarithmic_cm2", "circle-3_cm2")
    first = [
        next(h for h in made if h.name == name) for name in dict.fromkeys(h.name for h in made)
    ]
    return Made(
        findings=(very_similar(made, "enclosed"),),
        table=Table(columns, rows),
        figure=draw_5_14(first),
        notes=(
            f"Areas over circle-3's, medians of {len(made)} readings: hull of every line "
            f"{area_ratio(made, 'every_line'):.2f}, of what lines enclose "
            f"{area_ratio(made, 'enclosed'):.2f}, the same on a logarithmic scale "
            f"{area_ratio(made, 'logarithmic'):.2f}.",
        ),
    )


def area_ratio(made: list[Hulls], which: str) -> float:
    """Return the median area of one kind of hull over circle-3's.

    Parameters
    ----------
    made : list of Hulls
    which : "every_line", "enclosed" or "logarithmic"
    """
    return float(np.median([getattr(h, which).area_cm2 / h.heuristic.area_cm2 for h in made]))


def very_similar(made: list[Hulls], which: str) -> Finding:
    """Return whether one kind of hull is much like circle-3's.

    Parameters
    ----------
    made : list of Hulls
    which : "every_line", "enclosed" or "logarithmic"
    """
    ratio = area_ratio(made, which)
    return Finding(
        "the hulls by both ways are very similar",
        f"the hull of what lines enclose has {ratio:.2f} times the area of circle-3's, in the "
        f"median of {len(made)} readings",
        f"a median {100 * SIMILAR:.0f} % off",
        bool(1.0 - SIMILAR < ratio < 1.0 / (1.0 - SIMILAR)),
    )


_SAMPLED = (
    "The thesis gives neither its image nor its noise in numbers; ours are of our choice. Its line "
    "potentials are partly lost, and so is the unit of its energy: in squared levels its start "
    "temperature freezes most lines where they start, in thousands of these it anneals."
)
_READ = (
    "A simulated reading of the same object, by thesis-smooth and thesis-lines; below it on a "
    "logarithmic scale, by bayes-smooth and bayes-lines. The thesis set its two parameters anew "
    "for each object and does not give them: ours are the same for all, such that lines are free "
    "at its start temperature."
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
        "The line field of figure 5.8 in the last column.",
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
        "The sampler leaves lines astray far from the object, which the hull of every line goes "
        "around; the hull compared is that of what lines enclose.",
    ),
)
