"""The picture strip: a row a frame, a column a node, and in each cell what a person looks for."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from helpers_draw import (
    CIRCLE,
    Circle,
    Frame,
    branched,
    broken,
    circle_demo,
    disc_frame,
    discs,
    empty_frame,
    registry,
)
from tactile_graph import Ellipse, Image, Points, Polygon, Rectangle, loads
from tactile_graph.api.result import Result
from tactile_graph.draw.colours import FAILED
from tactile_graph.draw.display import Note, cell_edges
from tactile_graph.draw.paint_strip import told_once
from tactile_graph.draw.strip import (
    figure_bytes,
    figure_png,
    picture_format,
    save_strip,
    strip_figure,
)
from tactile_graph.errors import PluginError, UsageError
from tactile_graph.plugins.registry import installed_and
from tactile_graph.wires import Mask, TrueObject


class Centre(NamedTuple):
    total: float
    x_cm: float | None
    y_cm: float | None


def cells(figure: Figure) -> list[Axes]:
    return [a for a in figure.axes if not a.get_label().startswith("scale")]


def scales(figure: Figure) -> list[Axes]:
    return [a for a in figure.axes if a.get_label().startswith("scale")]


def titles(figure: Figure) -> list[str]:
    return [a.get_title() for a in cells(figure) if a.get_title()]


def cell(figure: Figure, row: int, column: int) -> Axes:
    return cells(figure)[row * len(titles(figure)) + column]


def words(axes: Axes) -> str:
    return " ".join(" ".join(t.get_text().split()) for t in axes.texts)


def legend(figure: Figure) -> list[str]:
    return [t.get_text() for x in figure.legends for t in x.get_texts()]


@pytest.fixture(scope="module")
def results() -> list[Result]:
    return list(circle_demo().stream([*discs(2), empty_frame(7)]))


@pytest.fixture(scope="module")
def strip(results) -> Figure:
    return strip_figure(results)


@pytest.mark.slow
def test_one_row_a_frame_and_one_column_a_node(strip) -> None:
    assert titles(strip) == [
        "frame", "footprint\n(threshold)", "fine\n(subdivide)", "eroded\n(erode)",
        "dilated\n(dilate)", "edge\n(boundary)", "hull", "circle\n(fit_circle)",
    ]  # fmt: skip
    assert len(cells(strip)) == 3 * 8
    rows = [words(cell(strip, r, 0)) for r in range(3)]
    assert rows == ["frame 0 0 s", "frame 1 0.04 s", "frame 7"]


@pytest.mark.slow
def test_rows_and_columns_stand_in_a_grid(strip) -> None:
    boxes = np.array([a.get_position().bounds for a in cells(strip)]).reshape(3, 8, 4)
    assert np.allclose(boxes[:, :, 0], boxes[:1, :, 0])
    assert np.allclose(boxes[:, :, 1], boxes[:, :1, 1])
    assert np.all(np.diff(boxes[0, :, 0]) > boxes[0, 0, 2]), "columns do not overlap"
    assert np.all(-np.diff(boxes[:, 0, 1]) > boxes[0, 0, 3]), "rows do not overlap"
    assert boxes[..., 0].min() > 0
    assert (boxes[..., 0] + boxes[..., 2]).max() < 1


def test_axes_are_in_cm_y_down_and_the_same_everywhere(strip) -> None:
    for axes in cells(strip):
        assert axes.get_xlim() == pytest.approx((0.0, 20.8))
        assert axes.get_ylim() == pytest.approx((20.8, 0.0))
    assert [cell(strip, r, 0).get_ylabel() for r in range(3)] == ["y in cm"] * 3
    assert [cell(strip, 2, c).get_xlabel() for c in range(8)] == ["x in cm"] * 8


def test_a_cell_keeps_the_shape_of_the_pad() -> None:
    frame = Frame.of(np.ones((4, 8)), (1.0, 0.5), quantity="volt")
    figure = strip_figure([circle_demo().run(frame)], ["frame", "footprint"])
    box, (width, height) = cells(figure)[0].get_position(), figure.get_size_inches()
    assert box.width * width / (box.height * height) == pytest.approx(8.0 / 2.0)


@pytest.mark.slow
def test_the_legend_tells_found_from_true(strip) -> None:
    assert legend(strip) == ["found", "true"]
    unknown = circle_demo().run(next(discs(1, truth=False)))
    assert legend(strip_figure([unknown])) == ["found"]
    assert legend(strip_figure([unknown], ["frame", "footprint"])) == []


def test_the_circle_is_drawn_where_it_was_found_and_the_truth_dashed_where_it_lies(
    strip, results
) -> None:
    dashed = [x for x in cell(strip, 0, 7).lines if x.is_dashed()]
    assert len(dashed) == 1
    true = results[0].frame.truth[0].shape
    xy = dashed[0].get_xydata()
    assert np.hypot(xy[:, 0] - true.x_cm, xy[:, 1] - true.y_cm) == pytest.approx(true.radius_cm)
    found = results[0]["circle"]
    outline = next(x for x in cell(strip, 0, 7).lines if len(x.get_xydata()) > 80
                   and not x.is_dashed()).get_xydata()  # fmt: skip
    assert np.hypot(outline[:, 0] - found.x_cm, outline[:, 1] - found.y_cm) == pytest.approx(
        found.radius_cm
    )
    assert outline[0] == pytest.approx(outline[-1]), "the outline closes"


def test_the_truth_is_drawn_over_every_picture_of_its_frame(strip) -> None:
    for column in range(8):
        assert sum(x.is_dashed() for x in cell(strip, 1, column).lines) == 1
        assert not cell(strip, 2, column).lines, "nothing lay on the empty pad"


def test_a_colour_bar_names_the_quantity_and_its_range_holds_for_all_frames() -> None:
    frames = [Frame.of(np.eye(16) * peak, 1.3, quantity="volt") for peak in (1.0, 3.0)]
    figure = strip_figure(list(circle_demo().stream(frames)), ["frame"])
    (bar,) = scales(figure)
    assert bar.get_xlabel() == "V"
    assert bar.get_xlim() == (0.0, 3.0)
    assert [a.images[0].get_clim() for a in cells(figure)] == [(0.0, 3.0)] * 2


def test_invalid_cells_are_left_blank() -> None:
    values = np.ones((16, 16))
    values[3, 4] = np.nan
    values[5, 5] = 2.0
    figure = strip_figure([circle_demo().run(Frame.of(values, 1.3, quantity="volt"))], ["frame"])
    shown = np.ma.asarray(cells(figure)[0].images[0].get_array())
    assert np.argwhere(np.ma.getmaskarray(shown)).tolist() == [[3, 4]]


def test_a_skipped_cell_carries_its_reason(strip) -> None:
    said = words(cell(strip, 2, 7))
    assert said == "skipped when footprint.count > 4 is false (footprint.count = 0)"
    assert words(cell(strip, 2, 2)) == "skipped nothing asked for it"


def test_a_failed_cell_carries_what_went_wrong_and_where() -> None:
    text = CIRCLE.replace("step: fit_circle", "step: broken_fit").replace("in: hull", "in: dilated")
    text = text.replace(
        "outputs: [circle]", "  last: {step: circle_again, in: circle}\noutputs: [last]"
    )

    def circle_again(circle: Circle) -> Circle:
        """Return the circle."""
        return circle

    made = registry(broken_fit=broken, circle_again=circle_again)
    result = loads(text, "x.yaml", made).run(next(discs(1)))
    figure = strip_figure([result], ["circle", "last"])
    own, dependant = cells(figure)
    assert "failed ZeroDivisionError: no cell is left to divide by" in words(own)
    assert "failed at circle ZeroDivisionError" in words(dependant)
    assert all("\n" in t.get_text() for t in dependant.texts), "long reasons are wrapped"
    assert to_hex(own.get_facecolor()) == FAILED


def two_discs() -> Frame:
    a, b = disc_frame(Circle(4, 10, 2.6), 7), disc_frame(Circle(15, 8, 3.1), 8)
    return Frame.of(
        a.image.values + b.image.values, 1.3, quantity="volt", index=11, label="left foot",
        truth=(*(a.truth or ()), *(b.truth or ())),
    )  # fmt: skip


def test_a_list_is_drawn_item_by_item_with_numbers() -> None:
    result = branched().run(two_discs())
    (axes,) = cells(strip_figure([result], ["parts"]))
    assert sum(isinstance(c, LineCollection) for c in axes.collections) == 2
    said = [t.get_text() for t in axes.texts]
    assert {"1", "2", "count 2"} <= set(said)
    assert sum(x.is_dashed() for x in axes.lines) == 2, "two true outlines"
    assert "frame 11 left foot" in words(axes)


def test_a_plugins_own_type_is_drawn_by_its_outline() -> None:
    figure = strip_figure([branched().run(two_discs(), only=["cross"])], ["cross"])
    (axes,) = cells(figure)
    outline = max((x.get_xydata() for x in axes.lines if not x.is_dashed()), key=len)
    assert outline.tolist() == [[10.4, 9.4], [11.4, 10.4], [10.4, 11.4], [9.4, 10.4], [10.4, 9.4]]


class Lettered:
    def outline_cm(self) -> str:
        return "xx"


def lettered(image: Image) -> Lettered:
    return Lettered()


def test_an_outline_that_is_none_is_told_with_its_node() -> None:
    text = "{pipeline: p, nodes: {n: {step: lettered, in: frame}}, outputs: [n]}"
    result = loads(text, registry=installed_and({"lettered": lettered})).run(np.ones((2, 2)))
    told = r"node 'n': Lettered\.outline_cm\(\) must give corners"
    with pytest.raises(PluginError, match=told):
        strip_figure([result], ["n"])


@pytest.mark.slow
def test_numbers_are_printed_as_text() -> None:
    result = branched().run(two_discs(), only=["areas", "circle.radius_cm"])
    figure = strip_figure([result], ["areas", "circle.radius_cm"])
    areas, radius = cells(figure)
    assert all(f"{a:.4g}" in words(areas) for a in result["areas"])
    assert f"{result['circle.radius_cm']:.4g}" in words(radius)
    assert legend(figure) == [], "a number is no outline, and over nothing no truth is drawn"


def test_a_field_of_a_node_can_be_asked_for_by_name() -> None:
    figure = strip_figure([circle_demo().run(next(discs(1)))], ["hull.area_cm2", "frame.image"])
    assert len(cells(figure)) == 2
    assert len(scales(figure)) == 1


def test_what_was_found_off_the_pad_is_said_to_be_there() -> None:
    def away(points: Points) -> Circle:
        """Return a circle far away."""
        return Circle(900.0, 900.0, 2.0)

    text = CIRCLE.replace("step: fit_circle", "step: away")
    result = loads(text, "x.yaml", registry(away=away)).run(next(discs(1)))
    figure = strip_figure([result], ["circle"])
    assert "outside the picture" in words(cells(figure)[0])
    assert cells(figure)[0].get_xlim() == pytest.approx((0.0, 20.8))


@pytest.mark.slow
def test_a_place_is_marked_and_its_numbers_are_printed() -> None:
    def centre(image: Image) -> Centre:
        """Return the middle."""
        return Centre(image.total, 3.0, 4.0) if image.total else Centre(0.0, None, None)

    text = "pipeline: c\nnodes: {c: {step: centre, in: frame}}\noutputs: [c]\n"
    pipeline = loads(text, "c.yaml", registry(centre=centre))
    frames = [disc_frame(Circle(9, 9, 3), truth=False), empty_frame()]
    figure = strip_figure(list(pipeline.stream(frames)))
    marks = [x.get_xydata().tolist() for x in cell(figure, 0, 1).lines]
    assert marks == [[[3.0, 4.0]]]
    assert words(cell(figure, 0, 1)).startswith("total ")
    assert not cell(figure, 1, 1).lines
    assert words(cell(figure, 1, 1)) == "total 0"


class Many(NamedTuple):
    loaded: bool
    total: float
    force_n: float
    contact_area_cm2: float
    peak: float
    n_left_out: int
    x_cm: float
    y_cm: float


@pytest.mark.slow
def test_the_numbers_of_a_low_wide_pad_stay_in_its_picture() -> None:
    def many(image: Image) -> Many:
        """Return much."""
        return Many(True, image.total, 12.5, 32.25, image.peak, 0, 8.0, 1.0)

    text = "pipeline: m\nnodes: {m: {step: many, in: frame}}\noutputs: [m]\n"
    pipeline = loads(text, "m.yaml", registry(many=many))
    frame = Frame.of(np.eye(4, 32), 0.5, quantity="volt")
    figure = strip_figure(list(pipeline.stream([frame])), ["frame", "m"])
    axes = cell(figure, 0, 1)
    (note,) = axes.texts
    assert "contact_area_cm2 32.25" in note.get_text()
    assert note.get_text().endswith("n_left_out 0")
    box, within = note.get_window_extent(), axes.get_window_extent()
    assert within.y0 <= box.y0 < box.y1 <= within.y1
    assert within.x0 <= box.x0 < box.x1 <= within.x1


def test_what_each_of_many_objects_says_of_itself_does_not_cover_them() -> None:
    its, count = [Note("kind", "disc"), Note("confidence", 0.6)], Note("count", 3)
    assert told_once([count, *its * 2]) == [count, *its * 2]
    assert told_once([count, *its * 3]) == [count]


def test_of_many_frames_some_are_shown_spread_evenly_and_the_strip_says_so() -> None:
    results = list(circle_demo().stream(discs(9)))
    figure = strip_figure(results, ["footprint"], most_rows=3)
    assert [" ".join(words(a).split()[:2]) for a in cells(figure)] == [
        "frame 0",
        "frame 4",
        "frame 8",
    ]
    assert figure.texts[0].get_text() == "circle-demo  (3 of 9 frames)"
    assert len(cells(strip_figure(results, ["footprint"], most_rows=1))) == 1


def test_of_many_nodes_those_near_the_output_are_shown() -> None:
    chain = "".join(f"  d{i}: {{step: dilate, in: {'base' if i == 0 else f'd{i - 1}'}}}\n"
                    for i in range(14))  # fmt: skip
    first = "pipeline: long\nnodes:\n  base: {step: threshold, in: frame}\n"
    text = f"{first}{chain}outputs: [base, d13]\n"
    figure = strip_figure([loads(text, "l.yaml", registry()).run(next(discs(1)))])
    shown = [t.split("\n")[0] for t in titles(figure)]
    assert shown == ["frame", "base", *(f"d{i}" for i in range(6, 14))]


def test_a_node_nobody_asked_for_has_no_column() -> None:
    figure = strip_figure([circle_demo().run(next(discs(1)), only=["fine"])])
    assert [t.split("\n")[0] for t in titles(figure)] == ["frame", "footprint", "fine"]


def test_an_unknown_node_is_refused(results) -> None:
    with pytest.raises(UsageError, match=r"circel.*did you mean 'circle'"):
        strip_figure(results, ["circel"])


def test_no_frame_gives_no_picture() -> None:
    with pytest.raises(UsageError, match="no picture can be drawn: there is no frame"):
        strip_figure([])


@pytest.mark.parametrize(
    ("suffix", "head"),
    [
        (".png", b"\x89PNG"),
        (".svg", b"<?xml"),
        pytest.param(".PDF", b"%PDF", marks=pytest.mark.slow),
    ],
)
def test_is_written_in_the_format_of_its_suffix(tmp_path: Path, results, suffix, head) -> None:
    path = tmp_path / f"strip{suffix}"
    path.write_text("old")
    save_strip(results[:1], path, ["circle"])
    assert path.read_bytes().startswith(head)
    assert [p.name for p in tmp_path.iterdir()] == [path.name], "nothing is left beside it"
    first = path.read_bytes()
    save_strip(results[:1], path, ["circle"])
    assert path.read_bytes() == first, "the same results give the same bytes"


def test_an_unknown_suffix_is_refused_before_anything_is_drawn(tmp_path: Path) -> None:
    message = r"strip\.pgn: a picture's suffix must be one of \.pdf, \.png, \.svg; got '\.pgn'; did"
    with pytest.raises(UsageError, match=message):
        save_strip([], tmp_path / "strip.pgn")
    with pytest.raises(UsageError, match=r"strip: a picture's suffix must be one of .*; got none"):
        picture_format("strip")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_a_plain_error(tmp_path: Path, results) -> None:
    path = tmp_path / "no" / "strip.png"
    with pytest.raises(UsageError, match=r"strip\.png: cannot be written: No such file"):
        save_strip(results[:1], path, ["circle"])


def test_a_write_that_fails_leaves_the_old_file_alone(
    tmp_path: Path, results, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "strip.png"
    path.write_text("old")

    def full(part: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(UsageError, match="cannot be written: No space left on device"):
        save_strip(results[:1], path, ["circle"])
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["strip.png"]


@pytest.mark.slow
def test_odd_names_are_drawn_as_they_are_and_warn_of_nothing() -> None:
    frame = Frame.of(np.eye(16), 1.3, quantity="volt", label="$x^{ 手 \\frac 🤚")
    text = CIRCLE.replace("circle-demo", "'$a_{ 手'")
    figure = strip_figure([loads(text, "x.yaml", registry()).run(frame)], ["circle", "frame"])
    assert figure_png(figure).startswith(b"\x89PNG")


def n_figures() -> int:
    """Count by type: asking an object for its class wakes proxies of what is gone."""
    return sum(issubclass(type(o), Figure) for o in gc.get_objects())


@pytest.mark.slow
def test_what_has_no_glyph_is_spelled_out() -> None:
    figure = Figure()
    text = figure.text(0.5, 0.5, "a\udc80\u202eb\nc")
    assert figure_bytes(figure, "png").startswith(b"\x89PNG")
    assert text.get_text() == "a\\udc80\\u202eb\nc"


def test_knows_no_window_and_leaves_no_figure_behind(results) -> None:
    data = figure_png(strip_figure(results[:1], ["circle"]))
    assert data.startswith(b"\x89PNG")
    pyplot = sys.modules.get("matplotlib.pyplot")
    assert pyplot is None or not pyplot.get_fignums()
    gc.collect()
    before = n_figures()
    for _ in range(3):
        figure_png(strip_figure(results[:1], ["circle"]))
    gc.collect()
    assert n_figures() <= before


@pytest.mark.slow
def test_a_notebook_shows_a_result_by_its_picture(results) -> None:
    figure = results[0].picture("circle", "hull")
    assert titles(figure) == ["circle\n(fit_circle)", "hull"]
    assert results[0]._repr_png_().startswith(b"\x89PNG")


def test_the_rim_of_a_mask_follows_its_cells() -> None:
    values = np.zeros((3, 3), bool)
    values[1, 1] = values[1, 2] = True
    found = cell_edges(Mask(values, (2.0, 1.0), (10.0, 5.0)))
    edges = [tuple(map(tuple, e)) for e in found.tolist()]
    assert len(edges) == 6
    assert {(12.0, 6.0), (16.0, 6.0), (16.0, 7.0), (12.0, 7.0)} <= {p for e in edges for p in e}
    assert ((14.0, 6.0), (14.0, 7.0)) not in edges, "no line between two cells that are on"


def test_truth_of_any_shape_is_drawn() -> None:
    shapes = (
        Ellipse(5, 5, 3, 2, 0.3),
        Rectangle(14, 5, 4, 2, 0.4),
        Polygon(np.array([[4.0, 12.0], [8.0, 12.0], [6.0, 16.0]])),
    )
    frame = Frame.of(np.eye(16), 1.3, quantity="volt", truth=tuple(TrueObject(s) for s in shapes))
    (axes,) = cells(strip_figure([circle_demo().run(frame)], ["frame"]))
    drawn = [x.get_xydata() for x in axes.lines if x.is_dashed()]
    for shape, xy in zip(shapes, drawn, strict=True):
        assert xy[:-1] == pytest.approx(shape.outline_cm())
