"""The graph as SVG: whole, well-formed, and fit to stand in any page."""

from __future__ import annotations

import re
from xml.etree import ElementTree as ET

import pytest

from helpers_draw import CIRCLE, branched, circle_demo, registry
from tactile_graph import Image, Mask, loads
from tactile_graph.draw.graph_drawing import description
from tactile_graph.draw.svg import graph_svg
from tactile_graph.draw.svg_text import text_width

SVG = "{http://www.w3.org/2000/svg}"


def texts(svg: str) -> list[str]:
    return [t.text or "" for t in ET.fromstring(svg).iter(f"{SVG}text")]


@pytest.mark.parametrize("make", [circle_demo, branched])
def test_is_well_formed_and_shows_every_node(make) -> None:
    pipeline = make()
    shown = texts(graph_svg(pipeline))
    for name, node in pipeline.nodes.items():
        assert name in shown
        if node.signature is not None and not node.each:
            assert node.signature.name in shown
    assert "frame" in shown


def test_source_settings_conditions_and_outputs_are_named() -> None:
    shown = texts(graph_svg(circle_demo()))
    assert {"source", "made", "n = 3", "level_v = 0.01"} <= set(shown)
    assert "when footprint.count > 4" in shown
    assert shown.count("output") == 1


def test_settings_left_at_their_default_are_left_to_the_tooltip() -> None:
    svg = graph_svg(circle_demo())
    assert not any("most_turns" in t for t in texts(svg))
    titles = [t.text or "" for t in ET.fromstring(svg).iter(f"{SVG}title")]
    assert any("most_turns = 50" in t for t in titles)


def test_a_setting_spelled_out_is_shown_even_at_its_default() -> None:
    text = CIRCLE.replace("{step: subdivide, in: fo", "{step: subdivide, with: {factor: 2}, in: fo")
    assert "factor = 2" in texts(graph_svg(loads(text, "x.yaml", registry())))
    assert "factor = 2" not in texts(graph_svg(circle_demo()))
    overridden = circle_demo().with_settings({"fine.factor": 2})
    assert "factor = 2" in texts(graph_svg(overridden))


def test_ports_fields_and_ranks_stand_on_the_wires() -> None:
    shown = texts(graph_svg(branched()))
    assert {"mask", "image", "items", "1", "2"} <= set(shown)


def test_each_kind_of_wire_has_its_own_stroke_and_a_word_in_the_legend() -> None:
    svg = graph_svg(branched())
    dashes = [p.get("stroke-dasharray") for p in ET.fromstring(svg).iter(f"{SVG}path")]
    # One of each kind is the legend's own.
    assert dashes.count("7 4") == 4 + 1, "conditions are dashed"
    assert dashes.count("1.5 4") == 2 + 1, "choices are dotted"
    assert {"data", "condition", "choice, in order"} <= set(texts(svg))


def test_a_graph_of_data_alone_needs_no_legend() -> None:
    text = CIRCLE.replace(", when: footprint.count > 4", "")
    assert "condition" not in texts(graph_svg(loads(text, "x.yaml", registry())))


def strokes(svg: str) -> dict[str, str]:
    found = {}
    for group in ET.fromstring(svg).iter(f"{SVG}g"):
        rect, text = group.find(f"{SVG}rect"), group.find(f"{SVG}text")
        if group.find(f"{SVG}title") is not None and rect is not None and text is not None:
            found[text.text or ""] = rect.get("stroke-width", "")
    return found


def test_new_nodes_have_a_thicker_border() -> None:
    widths = strokes(graph_svg(circle_demo(), {"hull"}))
    assert float(widths["hull"]) >= 3 * float(widths["edge"])
    assert len({w for name, w in widths.items() if name != "hull"}) == 1
    assert len(set(strokes(graph_svg(circle_demo())).values())) == 1


def test_a_node_that_no_output_needs_says_so() -> None:
    assert texts(graph_svg(branched())).count("only when asked for") == 1
    assert "only when asked for" not in texts(graph_svg(circle_demo()))


def test_has_a_title_and_a_description_for_those_who_cannot_see_it() -> None:
    root = ET.fromstring(graph_svg(circle_demo()))
    assert root.get("role") == "img"
    assert root.findtext(f"{SVG}title") == "pipeline circle-demo"
    told = root.findtext(f"{SVG}desc") or ""
    assert told == description(circle_demo())
    assert "fine (subdivide) reads footprint" in told
    assert "circle (fit_circle) reads hull, footprint when footprint.count > 4" in told
    assert told.endswith("and is an output.")


def test_nothing_in_it_can_leak_into_the_page_around_it() -> None:
    svg = graph_svg(branched())
    assert "<style" not in svg
    assert " id=" not in svg


def odd_image(image: Image, *, text: str = "", other: str = "") -> Mask:
    """Return <nothing> & "more"."""
    return image.mask(image.values > 0)


def test_odd_names_and_texts_are_escaped() -> None:
    text = """
pipeline: 'a <b> & "c"'
about: 'x < y & "z" ]]> <script>'
nodes:
  n: {step: 'st<e>p&', in: frame, with: {text: '<&">', other: "tab\\tand \\u0007 bell"}}
outputs: [n]
"""
    pipeline = loads(text, "odd.yaml", registry(**{"st<e>p&": odd_image}))
    svg = graph_svg(pipeline)
    root = ET.fromstring(svg)
    shown = texts(svg)
    assert 'a <b> & "c"' in shown
    assert "st<e>p&" in shown
    assert 'text = <&">' in shown
    assert root.get("aria-label") == 'pipeline a <b> & "c"'
    assert "\x07" not in svg
    assert "<script>" not in svg


def test_every_line_fits_into_its_box() -> None:
    long = "a_node_with_a_name_that_nobody_should_ever_give_to_a_node"
    text = CIRCLE.replace("hull:", f"{long}:").replace("in: hull", f"in: {long}")
    for group in ET.fromstring(graph_svg(loads(text, "x.yaml", registry()))).iter(f"{SVG}g"):
        rect = group.find(f"{SVG}rect")
        if group.find(f"{SVG}title") is None or rect is None:
            continue
        left, width = float(rect.get("x", "0")), float(rect.get("width", "0"))
        top, height = float(rect.get("y", "0")), float(rect.get("height", "0"))
        for line in group.iter(f"{SVG}text"):
            half = text_width(line.text or "", float(line.get("font-size", "0"))) / 2
            middle = float(line.get("x", "0"))
            assert left <= middle - half
            assert middle + half <= left + width
            assert top < float(line.get("y", "0")) < top + height


def test_a_step_with_many_settings_shows_some_and_counts_the_rest() -> None:
    def many(image: Image, *, a: int = 0, b: int = 0, c: int = 0, d: int = 0) -> Mask:
        """Return a mask."""
        return image.mask(image.values > 0)

    text = """
pipeline: m
nodes:
  n: {step: many, in: frame, with: {a: 1, b: 2, c: 3, d: 4}}
outputs: [n]
"""
    shown = texts(graph_svg(loads(text, "m.yaml", registry(many=many))))
    assert [t for t in shown if "=" in t or "more" in t] == [
        "a = 1",
        "b = 2",
        "and 2 more settings",
    ]


def test_an_embedded_pipelines_nodes_are_drawn_with_their_own_settings(tmp_path) -> None:
    (tmp_path / "inner.yaml").write_text(
        "pipeline: inner\nnodes:\n  touched: {step: threshold, in: frame, with: {level_v: 0.2}}\n"
        "  fine: {step: subdivide, in: touched}\noutputs: [fine]\n"
    )
    text = "pipeline: outer\nnodes:\n  part: {use: ./inner.yaml, in: frame}\noutputs: [part]\n"
    file = tmp_path / "outer.yaml"
    file.write_text(text)
    shown = texts(graph_svg(loads(text, str(file), registry())))
    assert {"part", "part/touched", "part/fine", "level_v = 0.2", "hands on"} <= set(shown)


def test_width_grows_with_the_graph_and_letters_keep_their_size() -> None:
    small = loads(
        "pipeline: s\nnodes: {m: {step: threshold, in: frame}}\noutputs: [m]\n",
        "s.yaml",
        registry(),
    )
    a, b = ET.fromstring(graph_svg(small)), ET.fromstring(graph_svg(circle_demo()))
    assert float(a.get("width", "0")) < float(b.get("width", "0"))
    assert {t.get("font-size") for t in a.iter(f"{SVG}text")} <= {"13", "11", "10"}
    assert {t.get("font-size") for t in b.iter(f"{SVG}text")} <= {"13", "11", "10"}


def test_a_notebook_shows_the_pipeline_by_its_graph() -> None:
    pipeline = circle_demo()
    assert pipeline._repr_svg_() == graph_svg(pipeline) == pipeline.svg()


def luminance(colour: str) -> float:
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: str, b: str) -> float:
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


def test_lines_and_words_stand_out_on_white_and_on_dark_pages() -> None:
    svg = graph_svg(branched())
    bare = set(re.findall(r'<path[^>]* stroke="(#\w{6})"', svg))
    head = ET.fromstring(svg).find(f"{SVG}text")
    assert head is not None
    for colour in (*bare, head.get("fill", "")):
        assert contrast(colour, "#ffffff") > 3.5
        assert contrast(colour, "#111111") > 3.5
    for group in ET.fromstring(svg).iter(f"{SVG}g"):
        rect = group.find(f"{SVG}rect")
        if group.find(f"{SVG}title") is not None and rect is not None:
            for line in group.iter(f"{SVG}text"):
                assert contrast(rect.get("fill", ""), line.get("fill", "")) > 3.4


def test_the_sources_settings_are_those_spelled_out() -> None:
    text = CIRCLE.replace("n: 3", "n: 2")  # the default
    pipeline = loads(text, "x.yaml", registry())
    assert "n = 2" in texts(graph_svg(pipeline))
    assert "n = 2" not in texts(graph_svg(pipeline.with_source("made")))
    assert "n = 5" in texts(graph_svg(pipeline.with_source("made", n=5)))
