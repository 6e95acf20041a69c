"""Figures 4.30 to 4.36: turning and rounding, and a rectangle on its way through rectangle-2."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tactile_graph import Mask, Points
from tactile_graph_thesis.drawing.elements import elements_figure
from tactile_graph_thesis.drawing.panels import draw_mask, draw_points, finish, panels
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.items.rectangle_stages import ONE, rectangle_frame
from tactile_graph_thesis.measure.stages import setting
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from tactile_graph_thesis.measure.rectangle_stages import Stage


def _figures(work: Work) -> dict[str, tuple[Stage, ...]]:
    from tactile_graph_thesis.measure.rectangle_stages import rectangle_stages

    return work.once("rectangle stages", lambda: rectangle_stages(rectangle_frame(work)))


def _drawn(shown: tuple[Stage, ...], columns: int) -> Any:
    """Return a figure of images side by side, masks with their areas."""
    size = 4.2 if columns == 1 else 3.4
    rows = len(shown) // columns
    figure, axes = panels(columns, rows, size, shared=rows == 1)
    if rows > 1:
        figure.set_size_inches(7.4, 5.4)
    titles = []
    for one, stage in zip(axes, shown, strict=True):
        if isinstance(stage.shown, Mask):
            draw_mask(one, stage.shown)
            titles.append(f"{stage.title}, {stage.shown.area_cm2:.1f} cm²")
        elif isinstance(stage.shown, Points):
            draw_points(one, stage.shown)
            titles.append(stage.title)
    return finish(figure, axes, titles, columns)


def _lost_share(shown: tuple[Stage, ...]) -> float:
    """Return the share of the cells that come to lie on others when turned and rounded."""
    first, last = shown[0].shown, shown[-1].shown
    assert isinstance(first, Mask)
    assert isinstance(last, Mask)
    return 1.0 - last.count / first.count


def _figure_4_30(work: Work) -> Made:
    shown = _figures(work)["4.30"]
    lost = _lost_share(shown)
    return Made(
        findings=(
            Finding(
                "turning and rounding whole elements leaves many voids",
                f"{100 * lost:.0f} % of the cells come to lie on others",
                lost > 0.05,
            ),
        ),
        figure=_drawn(shown, 2),
    )


def _figure_4_31(work: Work) -> Made:
    shown, coarse = _figures(work)["4.31"], _figures(work)["4.30"]
    share, size = _lost_share(shown), [s[0].shown.pitch_cm[0] for s in (shown, coarse)]  # type: ignore[union-attr]
    return Made(
        findings=(
            Finding(
                "voids remain on cells of a tenth, but are not as drastic",
                f"{100 * share:.0f} % of the cells come to lie on others, "
                f"{100 * _lost_share(coarse):.0f} % of whole elements; but each void is "
                f"{10 * size[0]:.1f} mm wide, not {10 * size[1]:.0f} mm",
                share > 0.0 and size[0] < size[1],
            ),
        ),
        figure=_drawn(shown, 2),
    )


def _figure_4_33(work: Work) -> Made:
    rotated, filled = _figures(work)["4.32"][0].shown, _figures(work)["4.33"][-1].shown
    assert isinstance(rotated, Mask)
    assert isinstance(filled, Mask)
    before, after = rotated.area_cm2, filled.area_cm2
    return Made(
        findings=(
            Finding(
                "the pre-filter fills the voids that rounding leaves",
                f"{before:.1f} cm² before, {after:.1f} cm² after",
                after > before,
            ),
        ),
        figure=_drawn(_figures(work)["4.33"], 2),
    )


def _simple(figure: str) -> Any:
    """Return a function that draws the images of a figure."""
    return lambda work: Made(figure=_drawn(_figures(work)[figure], len(_figures(work)[figure])))


def _figure_4_34(_: Work) -> Made:
    element = setting("rectangle-2", "opened", "element")
    return Made(figure=elements_figure({"of rectangle-2": element}))


def _figure_4_36(work: Work) -> Made:
    opened, points = _figures(work)["4.35"][-1].shown, _figures(work)["4.36"][0].shown
    assert isinstance(opened, Mask)
    assert isinstance(points, Points)
    figure, axes = panels(1, panel_in=4.2)
    draw_mask(axes[0], opened)
    draw_points(axes[0], points, "boundary")
    return Made(figure=finish(figure, axes, [f"{points.count} boundary points"]))


_OFTEN = " How often the pre-filter is applied is not given; here it makes eight passes."
ITEMS = (
    Item(
        "figure-4.30",
        "Rounding noise",
        "A footprint centred, turned, and rounded to elements.",
        _figure_4_30,
        ONE,
    ),
    Item(
        "figure-4.31",
        "Rounding noise on finer cells",
        "The same on elements cut in a hundred.",
        _figure_4_31,
        ONE + " The share of voids is a matter of the angle, not of the size of the cells: what "
        "finer cells change is how wide each void is.",
    ),
    Item(
        "figure-4.32",
        "After turning and rounding",
        "The image that morphology starts from.",
        _simple("4.32"),
        ONE,
    ),
    Item(
        "figure-4.33",
        "The pre-filter",
        "Dilated eight times, then eroded as often: voids are filled.",
        _figure_4_33,
        ONE + " The order of the two is not given; the other one would erase the "
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
        _simple("4.35"),
        ONE + _OFTEN,
    ),
    Item(
        "figure-4.36",
        "Boundary of the filtered rectangle",
        "The boundary of figure 4.35.",
        _figure_4_36,
        ONE,
    ),
)
