"""Sums of readings are in the unit of the image they are of, which need not be the frame's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

import pytest

from helpers_graphs import registry
from tactile_graph import Degenerate, Frame, Image, load, loads
from tactile_graph.engine.tables import image_quantities
from tactile_graph.engine.tables.table import make_table, units_of, without_one_unit
from tactile_graph.steps.rules import Quantity


class Part(NamedTuple):
    """A record that is measured on an image, and seen as it."""

    total: float
    image: Image


Part.image_unit = ("total",)  # type: ignore[attr-defined]
Part.provides = {Image: "image"}  # type: ignore[attr-defined]


class Both(NamedTuple):
    volts: Image
    grams: Image


class Weighed(NamedTuple):
    total: float


Weighed.image_unit = ("total",)  # type: ignore[attr-defined]


def grams(image: Image) -> Annotated[Image, Quantity("gram")]:
    return image.with_values(2.0 * image.values, quantity="gram")


def same(image: Image) -> Annotated[Image, Quantity.like("image")]:
    return image.with_values(image.values + 1.0)


def unsaid(image: Image) -> Image:
    return image.with_values(image.values + 1.0, quantity="gram")


def parts(image: Image) -> list[Part]:
    return [Part(float(image.total), image)]


def weighed(image: Image) -> Weighed:
    if image.total < 0.0:
        raise Degenerate("less than nothing")
    return Weighed(float(image.total))


def both(image: Image) -> Both:
    return Both(image, grams(image))


def apart(one: Image, other: Image) -> Weighed:
    return weighed(one)


def part(image: Image) -> Part:
    return Part(float(image.total), image)


def mixed(one: Part, other: Part) -> Part:
    return one


STEPS: dict[str, Callable[..., Any]] = {
    f.__name__: f for f in (grams, same, unsaid, parts, weighed, both, apart)
}
NODES = """
pipeline: p
nodes:
  same: {step: same, in: frame}
  grams: {step: grams, in: same}
  unsaid: {step: unsaid, in: frame}
  weighed: {step: weighed, in: grams}
  of_unsaid: {step: weighed, in: unsaid}
  parts: {step: parts, in: grams}
  of_parts: {step: weighed, in: parts, each: true}
  both: {step: both, in: frame}
  of_field: {step: weighed, in: both.grams}
  apart: {step: apart, in: {one: same, other: grams}}
  chosen: {first_of: [grams, same]}
  either: {first_of: [grams, weighed]}
outputs: [frame.image, same, grams, unsaid, weighed, of_unsaid, parts, of_parts, both, of_field,
          apart, chosen, either]
"""


def units(*names: str, long: bool = False, of: str = "volt") -> dict[str, str]:
    pipeline = loads(NODES, "p.yaml", registry(STEPS))
    return units_of(make_table(pipeline, names, long), [of])


@pytest.mark.parametrize(
    ("name", "column", "expected"),
    [
        ("same", "same.total", "V"),
        ("grams", "grams.total", "g"),
        ("unsaid", "unsaid.total", ""),
        ("weighed", "weighed.total", "g"),
        ("of_unsaid", "of_unsaid.total", ""),
        ("both", "both.grams.total", ""),
        ("of_field", "of_field.total", ""),
        ("apart", "apart.total", ""),
        ("chosen", "chosen.total", ""),
        ("either", "either.total", "g"),
    ],
)
def test_a_sum_is_in_the_unit_that_was_promised_of_its_image(
    name: str, column: str, expected: str
) -> None:
    assert units(name)[column] == expected


def test_each_node_is_followed_once_where_wires_meet_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Read twice by each after it, a node would be asked for a thousand times after ten."""
    asked, follow = [], image_quantities._told_of

    def noted(graph: Any, ref: Any, known: Any) -> Any:
        asked.append(ref)
        return follow(graph, ref, known)

    monkeypatch.setattr(image_quantities, "_told_of", noted)
    lines = [f"n{i}: {{step: mixed, in: {{one: n{i - 1}, other: n{i - 1}}}}}" for i in range(1, 11)]
    nodes = "\n  ".join(["n0: {step: part, in: frame}", *lines])
    text = f"pipeline: p\nnodes:\n  {nodes}\noutputs: [n10]\n"
    pipeline = loads(text, "p.yaml", registry({"part": part, "mixed": mixed}))
    assert units_of(make_table(pipeline, ["n10"], False), ["volt"])["n10.total"] == "V"
    assert len(asked) < 40


def test_items_of_a_list_are_in_the_unit_of_the_image_they_are_parts_of() -> None:
    assert units("parts", long=True)["total"] == "g"
    assert units("of_parts", long=True)["total"] == "g"


def test_a_column_of_several_outputs_has_a_unit_where_they_agree_in_it() -> None:
    assert units("grams", "weighed", long=True)["total"] == "g"
    assert units("grams", "same", long=True)["total"] == ""
    assert units("grams", "same", long=True, of="gram")["total"] == "g"


def test_what_runs_for_each_item_within_is_in_its_unit(tmp_path: Any) -> None:
    inner = tmp_path / "inner.yaml"
    inner.write_text("""
pipeline: inner
nodes:
  weighed: {step: weighed, in: frame}
outputs: [weighed]
""")
    outer = NODES.replace("outputs:", "  within: {use: inner, each: true, in: parts}\noutputs:")
    pipeline = loads(outer, "p.yaml", registry(STEPS, {"inner": inner}))
    table = make_table(pipeline, ["within"], long=True)
    assert units_of(table, ["volt"])["total"] == "g"


def test_a_shipped_pipeline_names_grams_grams() -> None:
    pipeline = load("features")
    table = make_table(pipeline, ["load"], long=False)
    assert units_of(table, ["volt"])["load.total"] == "g"
    assert units_of(table, ["counts"])["load.total"] == "counts"


def test_frames_of_several_quantities_leave_a_column_without_a_unit_and_say_so() -> None:
    pipeline = loads(NODES, "p.yaml", registry(STEPS))
    table = make_table(pipeline, ["same", "grams"], long=False)
    found = units_of(table, ["volt", "gram"])
    assert (found["same.total"], found["grams.total"]) == ("", "g")
    said = "frames are in gram and volt: same.total, same.peak have no one unit"
    assert without_one_unit(table, ["volt", "gram"]) == said
    assert without_one_unit(table, ["volt"]) == ""


def test_a_pandas_table_has_the_units_of_all_its_frames() -> None:
    pytest.importorskip("pandas")
    pipeline = loads(NODES, "p.yaml", registry(STEPS))
    frames = [Frame.of([[1.0, 2.0]], quantity=q) for q in ("volt", "gram")]
    told = pipeline.stream(frames, only=["same", "grams"]).to_pandas().attrs["units"]
    assert (told["same.total"], told["grams.total"]) == ("", "g")
