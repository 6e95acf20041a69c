"""Settings that are free, and what is wrong with how they were named."""

from __future__ import annotations

import re

import pytest

from helpers_tune import LADDER
from tactile_graph import loads
from tactile_graph.errors import UsageError
from tactile_graph_tune.request import Free, Request, parse_free


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=0.01:0.04:3", (0.01, 0.02, 0.04)),
        ("a.b=-1:1:3", (-1.0, 0.0, 1.0)),
        ("a.b=cross3, disc5", ("cross3", "disc5")),
    ],
)
def test_values_are_a_range_or_a_list(text, values):
    assert parse_free(text) == Free("a.b", values)


@pytest.mark.parametrize("text", ["a.b", "ab=1:2", "a.b=", "a.b=2:1", "a.b=1:2:1", "a.b=x:2"])
def test_what_is_neither_is_refused(text):
    with pytest.raises(UsageError, match=re.escape(f"--free {text}: must be")):
        parse_free(text)


@pytest.mark.parametrize("text", ["a.b=0.005,0.005", "a.b=auto,1,auto"])
def test_a_value_that_stands_there_twice_is_refused(text):
    with pytest.raises(UsageError, match=f"--free {text}: a value stands there twice"):
        parse_free(text)


def test_too_many_values_are_refused_before_they_are_made():
    with pytest.raises(UsageError, match="1000000000000 combinations of values, at most 32"):
        parse_free("a.b=0:1:1000000000000")


def test_combinations_come_behind_what_the_file_has(hand_made):
    free = (Free("footprint.level_v", (0.3, 0.6)), Free("first.fail_at_x", (-1.0,)))
    found = Request(loads(LADDER), free=free).variants()
    assert found == [{}, {"footprint.level_v": 0.3, "first.fail_at_x": -1.0},
                     {"footprint.level_v": 0.6, "first.fail_at_x": -1.0}]  # fmt: skip


@pytest.mark.parametrize(
    ("free", "message"),
    [
        (Free("footprint.level", (1,)), "no such setting; did you mean 'footprint.level_v'"),
        (Free("footprint.level_v", tuple(range(40))), "40 combinations of values, at most 32"),
    ],
)
def test_settings_that_are_not_there_and_too_many_values_are_refused(hand_made, free, message):
    with pytest.raises(UsageError, match=message):
        Request(loads(LADDER), free=(free,)).variants()


def test_a_setting_of_what_no_output_needs_is_refused(hand_made):
    more = "nodes:\n  other: {step: pressed, in: frame}\n"
    pipeline = loads(LADDER.replace("nodes:\n", more, 1))
    with pytest.raises(UsageError, match=r"--free other.level_v: changes nothing, no output needs"):
        Request(pipeline, free=(Free("other.level_v", (0.3, 0.6)),)).variants()


def test_what_the_file_marks_is_free_and_the_command_line_comes_before_it(hand_made):
    marked = "with: {level_v: 0.5}, free: {level_v: [0.3, 0.4]}"
    pipeline = loads(LADDER.replace("with: {level_v: 0.5}", marked))
    name = "footprint.level_v"
    assert Request(pipeline).variants() == [{}, {name: 0.3}, {name: 0.4}]
    assert Request(pipeline, free=(Free(name, (0.6,)),)).variants() == [{}, {name: 0.6}]
