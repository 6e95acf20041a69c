"""Figures 5.8 to 5.14 and table 5.2: Bayesian restoration with and without lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph_thesis.drawing.beside import beside_figure
from tactile_graph_thesis.drawing.panels import FOUND, draw_image, draw_true, finish, panels
from tactile_graph_thesis.item import Compared, Finding, Item, Made, Table
from tactile_graph_thesis.numbers import error_table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from tactile_graph_thesis.measure.fields import RadiusRow, Restoration

READINGS, QUICK_READINGS = 100, 15
"""Of each disc for table 5.2."""
BIG = 0.1
"""Share of an image's peak above which a cell counts for the object's size."""


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.mean(values**2)))


# -- the simulated rectangle -----------------------------------------------------------------


def _simulated(work: Work) -> Restoration:
    from tactile_graph_thesis.measure.fields import figure_5_8

    return work.once("figure 5.8", lambda: figure_5_8(work.seed))


def _figure_5_8(work: Work) -> Made:
    from tactile_graph_thesis.drawing.fields import draw_5_8

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


def _draw_lines(axes: Any, made: Restoration) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(
        LineCollection(
            list(made.lines.segments_cm), colors=FOUND, linewidths=1.8, label="line that is on"
        )
    )


# -- readings of the pad ---------------------------------------------------------------------


def _restored(work: Work) -> tuple[Restoration, ...]:
    from tactile_graph_thesis.measure.fields import figures_5_10_to_5_13

    return work.once("figures 5.10 to 5.13", lambda: figures_5_10_to_5_13(work.seed))


def _figure_of(index: int) -> Any:
    """Return a function that draws one object's restorations."""

    def make(work: Work) -> Made:
        from tactile_graph_thesis.drawing.fields import draw_5_10_to_5_13

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
    from tactile_graph_thesis.drawing.fields import draw_5_14
    from tactile_graph_thesis.measure.fields import figure_5_14

    hulls = figure_5_14(work.seed)
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


def _table_5_2(work: Work) -> Made:
    from tactile_graph_thesis.measure.fields import table_5_2

    thesis = error_table("table-5.2")
    n = min(QUICK_READINGS if work.quick else READINGS, work.readings)
    rows = table_5_2(work.seed, n)
    compared = []
    for row in rows:
        known = thesis.values[thesis.objects.index(row.name)]
        for way, ours, theirs in (
            ("the line field's hull", row.line_hull_cm, float(known[1])),
            ("the line field's hull, moved in", row.bayesian_cm, None),
            ("circle-3", row.heuristic_cm, float(known[2])),
        ):
            compared.append(Compared(f"{row.name}, radius by {way}", "cm", ours[0], theirs))
    columns = (
        "object",
        "true_cm",
        "lines_cm",
        "lines_sd_cm",
        "lines moved in_cm",
        "lines moved in_sd_cm",
        "circle-3_cm",
        "circle-3_sd_cm",
    )
    data = [(r.name, r.actual_cm, *r.line_hull_cm, *r.bayesian_cm, *r.heuristic_cm) for r in rows]
    return Made(
        tuple(compared),
        (_as_good(rows),),
        Table(columns, data),
        beside_figure(compared, "Radii by lines and by circle-3", "radius"),
        notes=(f"Means over {n} readings of each disc.",),
    )


def _as_good(rows: tuple[RadiusRow, ...]) -> Finding:
    off = {
        way: float(np.mean([abs(getattr(r, way)[0] - r.actual_cm) for r in rows]))
        for way in ("line_hull_cm", "bayesian_cm", "heuristic_cm")
    }
    return Finding(
        "with a convex hull the Bayesian way does as well as the heuristic one",
        f"the mean radius is off by {off['line_hull_cm']:.2f} cm by lines, by "
        f"{off['heuristic_cm']:.2f} cm by circle-3; by lines moved in by what border cells leave "
        f"uncovered {off['bayesian_cm']:.2f} cm",
        off["line_hull_cm"] <= 1.5 * off["heuristic_cm"],
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
    Item(
        "table-5.2",
        "Radii by both ways",
        "Radius of both discs by the hull of the line field and by circle-3.",
        _table_5_2,
        "The thesis gives one number for each, from one reading as it seems; ours are means. "
        "Lines run between cells, so a hull of lines encloses what border cells leave uncovered, "
        "where the points that circle-3 fits are centres of cells.",
    ),
)
