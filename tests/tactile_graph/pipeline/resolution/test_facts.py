"""What quantity comes to a step is followed from the frame on, for each that frames may be in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pytest

from helpers_graphs import registry
from tactile_graph import Frame, Image, Pipeline, loads
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph.errors import PipelineError, RuleError
from tactile_graph.pipeline.conditions.conditions import compile_condition
from tactile_graph.pipeline.graph import FrameRule
from tactile_graph.pipeline.resolution.facts import quantity_trouble
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps import Quantity


def weigh(
    image: Annotated[Image, Quantity("volt", "siemens")],
) -> Annotated[Image, Quantity("gram")]:
    return image.with_values(image.values, quantity="gram")


class Known:
    """A step that says only when it is made what it takes."""

    stateless = True

    def __init__(self, *, learned_in: str = "gram") -> None:
        self.takes = {"image": (learned_in,)}
        self.takes_by, self.takes_hint = "learned_in", "learn it anew"

    def __call__(self, image: Image) -> float:
        return float(image.values.sum())


def told(
    *, quantity: Literal["volt", "counts", "raw"] | None = None
) -> Iterator[Annotated[Frame, Quantity("volt", "counts", "raw", of="quantity")]]:
    yield frame(quantity or "counts")


STEPS = {"weigh": weigh, "known": Known, "told": told}
NODES = """
  volts: {first_of: [frame.image], when: volt}
  grams: {step: weigh, in: volts}
  others: {first_of: [frame.image], when: big and not volt}
  load: {first_of: [others, grams]}
"""


def frame(quantity: str) -> Frame:
    return Frame.of(np.ones((3, 3)), quantity=quantity)


def pipeline(node: str, nodes: str = NODES, **pipelines: Path) -> Pipeline:
    text = (
        "pipeline: p\n"
        'conditions: {volt: frame.image.quantity == "volt", big: frame.image.rows > 2}\n'
        f"nodes:{nodes}  x: {node}\noutputs: [x]\n"
    )
    return loads(text, "p.yaml", registry(steps=STEPS, pipelines=pipelines))


def test_it_is_followed_through_conditions_and_choices() -> None:
    p = pipeline("{step: known, in: load}")
    assert p.run(frame("volt"))["x"] == 9.0
    assert p.run(frame("gram"))["x"] == 9.0
    words = "setting 'learned_in' of step 'known' takes gram at port 'image', got a frame of raw; l"
    with pytest.raises(RuleError, match=words):
        p.run(frame("raw"))


def test_what_another_step_makes_of_the_frame_is_told_with_it() -> None:
    p = pipeline("{step: known, in: load, with: {learned_in: raw}}")
    assert p.run(frame("raw"))["x"] == 9.0
    with pytest.raises(RuleError, match="takes raw at port 'image', got gram of a volt frame"):
        p.run(frame("volt"))


def test_a_source_that_says_its_quantity_settles_it_at_load() -> None:
    p = pipeline("{step: known, in: load}")
    with pytest.raises(PipelineError, match=r"p.yaml:\d+.* takes gram .*, got raw; learn it anew"):
        p.with_source("told", quantity="raw")
    assert p.with_source("told", quantity="volt").run(frame("volt"))["x"] == 9.0
    p.with_source("told")


def test_a_step_behind_a_condition_makes_no_demand_on_frames_that_it_keeps_away() -> None:
    p = pipeline("{first_of: [load]}")
    assert p.run(frame("raw"))["x"].quantity == "raw"  # 'weigh' takes none of these
    guarded = pipeline("{step: weigh, in: frame, when: volt}", "\n")
    assert isinstance(guarded.run(frame("raw")).outcome("x"), Skipped)
    bare = pipeline("{step: weigh, in: frame, when: big}", "\n")
    with pytest.raises(RuleError, match="takes volt or siemens"):
        bare.run(frame("raw"))


def test_a_condition_on_what_a_step_gives_is_settled_too() -> None:
    nodes = NODES + '  w: {step: weigh, in: frame, when: load.quantity != "raw"}\n'
    p = pipeline("{first_of: [w, load]}", nodes)
    assert p.run(frame("raw"))["x"].quantity == "raw"
    words = r"takes volt or siemens .* got a frame of kilopascal; tactile-graph inspect names the p"
    with pytest.raises(RuleError, match=words):
        p.run(frame("kilopascal"))


def test_it_is_followed_into_and_out_of_a_used_pipeline(tmp_path: Path) -> None:
    inner = tmp_path / "inner.yaml"
    inner.write_text(
        "pipeline: inner\nnodes:\n  g: {step: weigh, in: frame}\noutputs: [g]\n", encoding="utf-8"
    )
    p = pipeline("{step: known, in: u}", "\n  u: {use: inner, when: volt}\n", inner=inner)
    assert p.run(frame("volt"))["x"] == 9.0
    assert isinstance(p.run(frame("raw")).outcome("x"), Skipped)
    p = pipeline("{step: known, in: u}", "\n  u: {use: inner}\n", inner=inner)
    with pytest.raises(RuleError, match="node 'u/g': step 'weigh' takes volt or siemens"):
        p.run(frame("raw"))


def test_what_no_frame_can_mend_is_an_error_of_the_file(tmp_path: Path) -> None:
    with pytest.raises(PipelineError, match="takes raw at port 'image', got gram"):
        pipeline("{step: known, in: grams, with: {learned_in: raw}}")


def test_all_that_a_frame_breaks_is_told_at_once() -> None:
    nodes = "\n  g: {step: weigh, in: frame}\n  k: {step: known, in: frame}\n"
    with pytest.raises(RuleError) as caught:
        pipeline("{first_of: [g, k]}", nodes).run(frame("raw"))
    first, second = str(caught.value).splitlines()
    assert first.startswith("pipeline 'p', node 'g': step 'weigh' takes volt or siemens")
    assert second.startswith("  node 'k': setting 'learned_in' of step 'known' takes gram")


QUANTITY = Ref("frame", ("image", "quantity"))
SETTLED = [
    ('frame.image.quantity == "volt"', True),
    ('frame.image.quantity != "volt"', False),
    ('frame.image.quantity in ("gram", "raw")', False),
    ('not frame.image.quantity == "volt" and frame.image.rows > 2', False),
    ('frame.image.quantity == "volt" and frame.image.rows > 2', None),
    ('frame.image.quantity == "volt" or frame.image.rows > 2', True),
    ('frame.image.quantity == "raw" or frame.image.rows > 2', None),
    ("len(frame.image.quantity) > 3", True),
    ("frame.image.rows > 2", None),
]


@pytest.mark.parametrize(("text", "comes_out"), SETTLED)
def test_a_condition_is_settled_as_far_as_the_quantity_decides(text: str, comes_out: Any) -> None:
    guard = compile_condition(text, {"frame": Frame})
    known = {ref: "volt" for ref in guard.refs if ref == QUANTITY}
    assert guard.settled(known) is comes_out


def test_where_nobody_said_what_values_mean_the_error_says_how_to() -> None:
    rule = FrameRule("x", "image", "decouple", {}, Quantity("volt"))
    told = quantity_trouble(rule, "raw", "raw")
    assert told.endswith("got a frame of raw; if its values are volt, say so: --with quantity=volt")
    assert "--with" not in quantity_trouble(rule, "kilopascal", "kilopascal")
