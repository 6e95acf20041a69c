"""A guard that always holds changes nothing of what else is computed."""

from __future__ import annotations

import re
from typing import Any

import pytest

from helpers_blocks import assert_blocks_are_frames, told
from helpers_graphs import STEPS, frame, registry
from tactile_graph import loads

NUMBERS = [1, 3, 2, 4, 6, 5, 3, 7, 8, 9, 2]
"""Of these `shy` says nothing of 3, 6 and 9."""
NODES = """\
pipeline: p
nodes:
  v: {{step: read, in: frame}}
  a: {{step: shy, in: v}}
  b: {{step: add1, in: a}}
  odd: {{step: add1, in: v, when: v % 2 > 0}}
  items: {{step: many, in: v}}
  n: {{step: count, in: v}}
  g: {wires}
outputs: [g]
"""


def outcomes(text: str) -> list[Any]:
    pipeline = loads(text, "p.yaml", registry(STEPS))
    results = assert_blocks_are_frames(pipeline, [frame(n, i) for i, n in enumerate(NUMBERS)])
    return [told(result.outcome("g")) for result in results]


@pytest.mark.parametrize(
    "wires",
    [
        "{step: add2, in: [a, n]}",
        "{step: add2, in: [b, n]}",
        "{step: add3, in: [a, odd, n]}",
        "{step: add3, in: [odd, a, n]}",
        "{step: total_of, in: {a: a, items: [b, n]}}",
        "{step: add2, in: [c, n]}\n  c: {first_of: [odd, b]}",
        "{step: add2, in: [c, n]}\n  c: {first_of: [b, odd]}",
        "{step: add2, in: [c, n]}\n  c: {step: total, in: {items: [a, b]}}",
        "{step: add2, in: [c, n]}\n  c: {step: total, in: e}\n"
        "  e: {step: shy, in: items, each: true}",
    ],
)
def test_a_guard_that_always_holds_changes_no_answer(wires: str) -> None:
    text = NODES.format(wires=wires)
    plain = outcomes(text)
    assert {type(outcome) for outcome in plain} == {int, tuple}
    for name in ("a", "b", "g", "c"):
        guarded = re.sub(rf"( {name}: {{.*)}}\n", r"\1, when: frame.index >= 0}\n", text)
        assert outcomes(guarded) == plain


def test_the_state_beside_a_step_that_skipped_itself_goes_on() -> None:
    guarded = "{step: add2, in: [a, n], when: v > 0}"
    text = NODES.format(wires=guarded).replace("count, in: v}", "count, in: one}")
    one = "  one: {step: constant, with: {value: 1}}\noutputs"
    values = outcomes(text.replace("outputs", one))
    assert [v for v in values if isinstance(v, int)] == [
        n + 2 * k for k, n in enumerate(NUMBERS, 1) if n % 3
    ]
