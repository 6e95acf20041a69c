"""The graph as a picture: what its SVG shows, painted by matplotlib."""

from __future__ import annotations

import io
from xml.etree import ElementTree as ET

import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.patches import FancyBboxPatch, PathPatch

from helpers_draw import branched, circle_demo
from tactile_graph.draw.graph_drawing import graph_drawing
from tactile_graph.draw.paint_graph import MOST_PX, graph_figure, graph_picture
from tactile_graph.draw.svg import graph_svg

SVG = "{http://www.w3.org/2000/svg}"


def texts(figure: Figure) -> list[str]:
    return [t.get_text() for t in figure.axes[0].texts]


@pytest.mark.parametrize("make", [circle_demo, branched])
def test_shows_the_words_boxes_and_lines_of_the_svg(make) -> None:
    figure, svg = graph_figure(make()), ET.fromstring(graph_svg(make()))
    assert sorted(texts(figure)) == sorted(t.text or "" for t in svg.iter(f"{SVG}text"))
    patches = figure.axes[0].patches
    rects = list(svg.iter(f"{SVG}rect"))
    lines = [p for p in svg.iter(f"{SVG}path") if p.get("fill") == "none"]
    assert sum(isinstance(p, FancyBboxPatch) for p in patches) == len(rects)
    assert sum(isinstance(p, PathPatch) for p in patches) == len(lines)


@pytest.mark.slow
def test_every_line_of_text_lies_within_its_box_in_matplotlibs_own_font() -> None:
    figure = graph_figure(branched())
    axes = figure.axes[0]
    boxes = [p.get_window_extent() for p in axes.patches if isinstance(p, FancyBboxPatch)]
    drawing = graph_drawing(branched())
    outside = {w.line.text for w in (*drawing.head, *drawing.legend) if hasattr(w, "line")}
    for text in axes.texts:
        if text.get_text() in outside:
            continue
        words = text.get_window_extent()
        assert any(
            b.x0 <= words.x0 and words.x1 <= b.x1 and b.y0 - 2 <= words.y0 and words.y1 <= b.y1 + 2
            for b in boxes
        ), text.get_text()


@pytest.mark.slow
def test_is_two_pixels_for_one_and_the_same_bytes_each_time() -> None:
    drawing = graph_drawing(circle_demo())
    png = graph_picture(circle_demo(), "png")
    rows, columns, _ = imread(io.BytesIO(png), format="png").shape
    assert columns == pytest.approx(2 * drawing.width, abs=2)
    assert rows == pytest.approx(2 * drawing.height, abs=2)
    assert png == graph_picture(circle_demo(), "png")
    assert graph_picture(circle_demo(), "pdf") == graph_picture(circle_demo(), "pdf")


def test_a_graph_too_wide_for_a_picture_file_is_drawn_coarser(monkeypatch) -> None:
    monkeypatch.setattr("tactile_graph.draw.paint_graph.MOST_PX", 400)
    png = graph_picture(circle_demo(), "png")
    rows, columns, _ = imread(io.BytesIO(png), format="png").shape
    assert rows < columns
    assert columns == pytest.approx(400, abs=2)
    assert MOST_PX < 65_536, "what matplotlib can paint"
