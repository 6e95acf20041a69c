"""A file marks settings free, with the values they may take; what they cannot take is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import pytest
from annotated_types import Ge

from helpers_graphs import STEPS, registry
from tactile_graph import Image, Mask, loads
from tactile_graph.errors import PipelineError


def pressed(image: Image, *, above: Annotated[float, Ge(0)] = 0.0, kind: str = "") -> Mask:
    return image.mask(image.values > above)


@pytest.fixture
def reg(tmp_path: Path) -> Any:
    inner = tmp_path / "inner.yaml"
    inner.write_text("{pipeline: inner, nodes: {m: {step: pressed, in: frame}}, outputs: [m]}")
    return registry({**STEPS, "pressed": pressed}, {"inner": inner})


def text(node: str) -> str:
    return f"pipeline: p\nnodes:\n  m: {{{node}}}\noutputs: [m]\n"


def test_values_of_steps_and_of_embedded_pipelines_are_known_by_their_setting(reg: Any) -> None:
    own = loads(text("step: pressed, in: frame, free: {above: [0.1, 0.2], kind: [a]}"), "p", reg)
    assert own.free == {"m.above": (0.1, 0.2), "m.kind": ("a",)}
    used = loads(text("use: inner, in: frame, free: {m.above: [1, 2]}"), "p.yaml", reg)
    assert used.free == {"m/m.above": (1, 2)}


def test_what_is_free_changes_nothing_that_is_computed(reg: Any) -> None:
    free = loads(text("step: pressed, in: frame, free: {above: [0.1]}"), "p", reg)
    bound = loads(text("step: pressed, in: frame"), "p", reg)
    assert free.key == bound.key
    assert free.resolved() == bound.resolved()


@pytest.mark.parametrize(
    ("node", "told"),
    [
        ("step: pressed, in: frame, free: {above: [0.1, -1]}", "3:53 node 'm', above: must be >="),
        ("step: pressed, in: frame, free: {abov: [1]}", "3:40 node 'm': unknown setting 'abov'; "
         "did you mean 'above'?"),
        ("step: pressed, in: frame, free: {above: 0.1:0.2}", "'above' needs a list of the values "
         "it may take, got a text: '0.1:0.2'"),
        ("step: pressed, in: frame, free: {above: []}", "got an empty list"),
        ("step: pressed, in: frame, free: [above]", "'free' must be a mapping of settings to "
         "lists of the values they may take, got a list: ['above']"),
        ("use: inner, in: frame, free: {m.above: [1, -2]}", "3:50 node 'm', m.above: must be >="),
        ("use: inner, in: frame, free: {above: [1]}", "are named node.setting"),
        ("use: inner, in: frame, free: {n.above: [1]}", "no node named 'n'"),
        ("first_of: [frame], free: {above: [1]}", "'free' makes no sense beside 'first_of'"),
    ],
)  # fmt: skip
def test_what_cannot_be_chosen_is_told_at_its_place(reg: Any, node: str, told: str) -> None:
    with pytest.raises(PipelineError) as caught:
        loads(text(node), "p.yaml", reg)
    (problem,) = caught.value.problems
    assert problem.mark is not None
    assert told in f"{problem.mark.line}:{problem.mark.column} {problem.message}"
