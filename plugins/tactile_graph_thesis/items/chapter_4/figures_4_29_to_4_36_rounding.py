"""Figures 4.29 to 4.36: turning and rounding, and a rectangle on its way through rectangle-2."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tactile_graph import Mask, Points, load
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_fitters.orientation.rotate_points import rotate_points
from tactile_graph_thesis.drawing.elements import elements_figure
from tactile_graph_thesis.drawing.panels import draw_mask, draw_points, finish, panels
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.items.block_diagram import block_diagram
from tactile_graph_thesis.measure.shown_reading import (
    ONE_RECTANGLE,
    RECTANGLES,
    readings_of,
    setting,
    stages,
    typical_rectangle,
)
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactile_graph import Frame

PIPELINE = "rectangle-2"


def _nodes(work: Work) -> Any:
    """Return every node of rectangle-2 for the reading that is shown."""
    frame = typical_rectangle(work)
    return work.once(("nodes", PIPELINE), lambda: stages(PIPELINE, frame, work.seed))


# -- turning and rounding --------------------------------------------------------------------


class Rounding(NamedTuple):
    """A footprint centred, turned and rounded to cells; all in cm about its centre but the first.

    Parameters
    ----------
    original : Mask
        Where it lies on the pad.
    centred, turned : Points
        Centres of the cells that are on.
    rounded : Mask
    """

    original: Mask
    centred: Points
    turned: Points
    rounded: Mask

    @property
    def lost_share(self) -> float:
        """Share of the cells that come to lie on others."""
        return 1.0 - self.rounded.count / self.original.count

    @property
    def sides_moved_cm(self) -> float:
        """How far rounding moves the deviations along x and y that length and breadth show in."""
        rows, columns = np.nonzero(self.rounded.values)
        cells = np.column_stack([self.rounded.x_cm[columns], self.rounded.y_cm[rows]])
        spans = [np.sqrt(12.0) * xy.std(axis=0) for xy in (cells, self.turned.xy_cm)]
        return float(np.abs(spans[0] - spans[1]).mean())


def rounding(mask: Mask, axis: Any, rounded: Mask) -> Rounding:
    """Return what happens to a mask on its way to the turned and rounded one.

    Parameters
    ----------
    mask : Mask
    axis : Axis
        It is turned about the axis' centre until that lies along x.
    rounded : Mask
        What `rotate_mask` makes of both.
    """
    rows, columns = np.nonzero(mask.values)
    cells = Points(np.column_stack([mask.x_cm[columns], mask.y_cm[rows]]))
    x, y = axis.x_cm, axis.y_cm
    origin = (rounded.origin_cm[0] - x, rounded.origin_cm[1] - y)
    return Rounding(
        mask,
        Points(cells.xy_cm - (x, y)),
        Points(rotate_points(cells, axis).xy_cm - (x, y)),
        Mask(rounded.values, rounded.pitch_cm, origin),
    )


def whole_and_fine(frame: Frame, seed: int = 0) -> tuple[Rounding, Rounding]:
    """Return what turning and rounding does to whole elements, and to rectangle-2's fine cells.

    Parameters
    ----------
    frame : Frame
    seed : int
    """
    fine = stages(PIPELINE, frame, seed)
    whole = load(PIPELINE).with_settings({"fine.factor": 1}).run(frame, ["rotated"], seed=seed)
    return (
        rounding(fine["footprint"], fine["axis"], whole["rotated"]),
        rounding(fine["fine"], fine["axis"], fine["rotated"]),
    )


def _roundings(work: Work) -> tuple[Rounding, Rounding]:
    frame = typical_rectangle(work)
    return work.once("roundings", lambda: whole_and_fine(frame, work.seed))


def _rounding_figure(found: Rounding) -> Figure:
    figure, axes = panels(2, 2, 3.4, shared=False)
    figure.set_size_inches(7.4, 5.4)
    draw_mask(axes[0], found.original)
    draw_points(axes[1], found.centred)
    draw_points(axes[2], found.turned)
    draw_mask(axes[3], found.rounded)
    titles = [
        _with_area("original", found.original),
        "less the mean",
        "turned",
        _with_area("turned and rounded", found.rounded),
    ]
    return finish(figure, axes, titles, 2)


def _with_area(title: str, mask: Mask) -> str:
    return f"{title}, {mask.area_cm2:.1f} cm²"


def _figure_4_30(work: Work) -> Made:
    found = [whole for whole, _ in _all_roundings(work)]
    return Made(findings=(leaves_voids(found),), figure=_rounding_figure(_roundings(work)[0]))


def _all_roundings(work: Work) -> list[tuple[Rounding, Rounding]]:
    """Return those of many readings of the rectangle, which lies at another angle in each."""

    def made() -> list[tuple[Rounding, Rounding]]:
        frames = readings_of(work, "rectangles", RECTANGLES[1])
        return [whole_and_fine(frame, work.seed) for frame in frames]

    return work.once("all roundings", made)


def leaves_voids(found: Sequence[Rounding]) -> Finding:
    """Return whether turning and rounding lays many cells on others.

    Parameters
    ----------
    found : sequence of Rounding
        Of whole elements, at different angles.
    """
    lost = 100.0 * np.array([one.lost_share for one in found])
    return Finding(
        "turning and rounding whole elements leaves many voids",
        f"{lost.mean():.0f} % of the cells come to lie on others, mean of {len(lost)} readings; "
        f"{lost.max():.0f} % at most",
        "less than one cell in twenty on average",
        bool(lost.mean() >= 5.0),
    )


def _figure_4_31(work: Work) -> Made:
    whole, fine = zip(*_all_roundings(work), strict=True)
    return Made(
        findings=(not_as_drastic(whole, fine),), figure=_rounding_figure(_roundings(work)[1])
    )


def not_as_drastic(whole: Sequence[Rounding], fine: Sequence[Rounding]) -> Finding:
    """Return whether fine cells lose some too, but move the footprint's sides much less.

    Parameters
    ----------
    whole, fine : sequence of Rounding
        Of the same readings.
    """
    lost = 100.0 * float(np.mean([one.lost_share for one in fine]))
    moved, moved_whole = (float(np.mean([one.sides_moved_cm for one in r])) for r in (fine, whole))
    return Finding(
        "voids remain on cells of a tenth, but are not as drastic",
        f"{lost:.0f} % of the cells come to lie on others; turning and rounding moves length and "
        f"breadth of the footprint by {10 * moved:.1f} mm on average, by {10 * moved_whole:.1f} mm "
        "on whole elements",
        "not one cell lost, or sides moved by half as much as on whole elements",
        lost > 0.0 and moved < 0.5 * moved_whole,
    )


# -- the filters -----------------------------------------------------------------------------


def dilated_first(rotated: Mask) -> Mask:
    """Return the image between the pre-filter's dilations and its erosions, grown by their reach.

    Parameters
    ----------
    rotated : Mask
    """
    element, times = (setting(PIPELINE, "filled", name) for name in ("element", "times"))
    (x, y), (px, py) = rotated.origin_cm, rotated.pitch_cm
    out = Mask(np.pad(rotated.values, times), (px, py), (x - times * px, y - times * py))
    dilate = Dilate(element=element)
    for _ in range(times):
        out = dilate(out)
    return out


def _masks_figure(**masks: Mask) -> Figure:
    """Return a figure of masks side by side, each with its name and area."""
    figure, axes = panels(len(masks), 1, 4.2 if len(masks) == 1 else 3.4)
    for one, mask in zip(axes, masks.values(), strict=True):
        draw_mask(one, mask)
    titles = [_with_area(name.replace("_", " "), mask) for name, mask in masks.items()]
    return finish(figure, axes, titles)


def _figure_4_32(work: Work) -> Made:
    return Made(figure=_masks_figure(turned_and_rounded=_nodes(work)["rotated"]))


def _figure_4_33(work: Work) -> Made:
    rotated, filled = (_nodes(work)[name] for name in ("rotated", "filled"))
    figure = _masks_figure(dilated=dilated_first(rotated), then_eroded=filled)
    return Made(findings=(fills_voids(rotated, filled),), figure=figure)


def fills_voids(rotated: Mask, filled: Mask) -> Finding:
    """Return whether lone voids inside are gone: cells that are off between cells that are on.

    Parameters
    ----------
    rotated, filled : Mask
    """
    before, after = (lone_voids(mask) for mask in (rotated, filled))
    return Finding(
        "the pre-filter fills all the void points",
        f"{before} cells off between four that are on before, {after} after",
        "one in a hundred left, or none there before",
        before > 0 and after < 0.01 * before,
    )


def lone_voids(mask: Mask) -> int:
    """Return how many cells are off whose four neighbours are on.

    Parameters
    ----------
    mask : Mask
    """
    on = np.pad(mask.values, 1)
    around = on[:-2, 1:-1] & on[2:, 1:-1] & on[1:-1, :-2] & on[1:-1, 2:]
    return int((around & ~mask.values).sum())


def _figure_4_34(_: Work) -> Made:
    return Made(figure=elements_figure({f"of {PIPELINE}": setting(PIPELINE, "opened", "element")}))


def _figure_4_35(work: Work) -> Made:
    filled, opened = (_nodes(work)[name] for name in ("filled", "opened"))
    eroded = Erode(element=setting(PIPELINE, "opened", "element"))(filled)
    return Made(figure=_masks_figure(eroded=eroded, then_dilated=opened))


def _figure_4_36(work: Work) -> Made:
    opened, points = (_nodes(work)[name] for name in ("opened", "boundary"))
    figure, axes = panels(1, panel_in=4.2)
    draw_mask(axes[0], opened)
    draw_points(axes[0], points, "boundary")
    return Made(figure=finish(figure, axes, [f"{points.count} boundary points"]))


_OFTEN = " How often the pre-filter is applied is not given; here it makes eight passes."
ITEMS = (
    block_diagram("4.29", "rectangle-2", "Blocks of the second rectangular localisation"),
    Item(
        "figure-4.30",
        "Rounding noise",
        "A footprint centred, turned, and rounded to elements.",
        _figure_4_30,
        ONE_RECTANGLE,
    ),
    Item(
        "figure-4.31",
        "Rounding noise on finer cells",
        "The same on elements cut in a hundred.",
        _figure_4_31,
        ONE_RECTANGLE
        + " The share of voids is a matter of the angle, not of the size of the cells: what "
        "finer cells change is how wide each void is.",
    ),
    Item(
        "figure-4.32",
        "After turning and rounding",
        "The image that morphology starts from.",
        _figure_4_32,
        ONE_RECTANGLE,
    ),
    Item(
        "figure-4.33",
        "The pre-filter",
        "Dilated eight times, then eroded as often: voids are filled.",
        _figure_4_33,
        ONE_RECTANGLE + " The order of the two is not given; the other one would erase the "
        "image, as the thesis itself says." + _OFTEN,
    ),
    Item(
        "figure-4.34",
        "Structuring element of the rectangles",
        "The square of the filter.",
        _figure_4_34,
    ),
    Item(
        "figure-4.35",
        "The filter",
        "Eroded, then dilated by the square.",
        _figure_4_35,
        ONE_RECTANGLE + _OFTEN,
    ),
    Item(
        "figure-4.36",
        "Boundary of the filtered rectangle",
        "The boundary of figure 4.35.",
        _figure_4_36,
        ONE_RECTANGLE,
    ),
)
