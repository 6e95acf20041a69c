"""Settings stand in the YAML afterwards, in their place, however the file is spelled."""

from __future__ import annotations

import math
import re

import pytest
import yaml

import tactile_graph as tg
from helpers_live import FLOW
from tactile_graph.errors import UsageError
from tactile_graph.pipeline.document import on_one_line
from tactile_graph_live.server import yaml_settings
from tactile_graph_live.server.yaml_settings import text_with

BLOCK = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  smooth:
    # why it is smoothed
    step: low_pass
    in: frame
  footprint:
    step: threshold
    in: smooth
    with:
      level_v: 0.01   # volts
  boundary: {step: boundary_scan, in: footprint}
outputs: [boundary]
"""


def lines_that_differ(a: str, b: str) -> list[str]:
    return [line for line in b.splitlines() if line not in a.splitlines()]


@pytest.mark.parametrize("text", [FLOW, BLOCK])
def test_a_setting_that_is_there_is_changed_in_its_place(text: str) -> None:
    changed = text_with(text, {"footprint": {"level_v": 0.02}})
    (line,) = lines_that_differ(text, changed)
    assert "level_v: 0.02" in line
    assert changed.replace("0.02", "0.01") == text


@pytest.mark.parametrize("text", [FLOW, BLOCK])
def test_a_setting_that_is_not_there_is_added_and_comments_stay(text: str) -> None:
    node = tg.loads(text).nodes["smooth"]
    assert node.signature is not None
    name = node.signature.settings[0].name
    value = node.settings[name]
    changed = text_with(text, {"smooth": {name: value}})
    assert f"with: {{{name}: {on_one_line(value)}}}" in changed
    assert "# why it is smoothed" in changed or "# as it comes" in changed
    assert tg.loads(changed).key == tg.loads(text).key


def test_a_second_setting_is_added_to_those_that_are_there() -> None:
    node = "  a: {step: simulate_me, with: {x: 1}}\n"
    text = f"pipeline: p\nnodes:\n{node}"
    assert "with: {x: 1, y: [2, 3]}" in text_with(text, {"a": {"y": [2, 3]}})
    block = "pipeline: p\nnodes:\n  a:\n    step: s\n    with:\n      x: 1\n"
    assert "      x: 1\n      y: word\n" in text_with(block, {"a": {"y": "word"}})


def test_values_are_spelled_so_that_yaml_reads_them_back() -> None:
    for value in (0.5, 1e-7, True, None, "yes", "a: b", [1, 2], {"a": 1}, "µ", "1"):
        assert yaml.safe_load(on_one_line(value)) == value
        assert "\n" not in on_one_line(value)


HEAD = "pipeline: p\nsource: {step: sample, with: {name: discs}}\noutputs: [a, b]\nnodes:\n"
PLAIN = "  a: {step: low_pass, in: frame, with: {size: 5}}\n"
IN_LINES = "  b:\n    step: low_pass\n    in: frame\n"
SPELLINGS = {
    "alias of the settings": (
        "  a: {step: low_pass, in: frame, with: &w {size: 5}}  # wide\n"
        "  b: {step: low_pass, in: frame, with: *w}  # as wide\n",
        "  a: {step: low_pass, in: frame, with: &w {size: 5}}  # wide\n"
        "  b: {step: low_pass, in: frame, with: {size: 7}}  # as wide\n",
    ),
    "alias of the value": (
        "  a: {step: low_pass, in: frame, with: {size: &l 5}}\n"
        "  b: {step: low_pass, in: frame, with: {size: *l}}\n",
        "  a: {step: low_pass, in: frame, with: {size: &l 5}}\n"
        "  b: {step: low_pass, in: frame, with: {size: 7}}\n",
    ),
    "alias of the node": (
        "  a: &n {step: low_pass, in: frame, with: {size: 5}}\n  b: *n\n",
        "  a: &n {step: low_pass, in: frame, with: {size: 5}}\n"
        "  b: {step: low_pass, in: frame, with: {size: 7}}\n",
    ),
    "alias of the step": (
        "  a:\n    step: &s low_pass\n    in: frame\n  b:\n    step: *s  # too\n    in: frame\n",
        "  a:\n    step: &s low_pass\n    in: frame\n"
        "  b:\n    step: *s  # too\n    with: {size: 7}\n    in: frame\n",
    ),
    "node that another stands for": (
        "  b: &n\n    step: low_pass  # for both\n    in: frame\n  a: *n\n",
        "  b: &n\n    step: low_pass  # for both\n    with: {size: 7}\n    in: frame\n"
        "  a: {step: low_pass, in: frame}\n",
    ),
    "settings that another stands for": (
        "  b: {step: low_pass, in: frame, with: &w {size: 5}}\n"
        "  a: {step: low_pass, in: frame, with: *w}\n",
        "  b: {step: low_pass, in: frame, with: &w {size: 7}}\n"
        "  a: {step: low_pass, in: frame, with: {size: 5}}\n",
    ),
    "value that another stands for": (
        "  b: {step: low_pass, in: frame, with: {size: &l 5}}\n"
        "  a: {step: low_pass, in: frame, with: {size: *l}}\n",
        "  b: {step: low_pass, in: frame, with: {size: 7}}\n"
        "  a: {step: low_pass, in: frame, with: {size: 5}}\n",
    ),
    "no settings, aliased": (
        "  b: {step: low_pass, in: frame, with: &w ~}\n"
        "  a: {step: low_pass, in: frame, with: *w}\n",
        "  b: {step: low_pass, in: frame, with: {size: 7}}\n"
        "  a: {step: low_pass, in: frame, with: ~}\n",
    ),
    "comment before the brace": (
        PLAIN + "  b: {step: low_pass,\n      in: frame   # the {pad}\n     }\n",
        PLAIN + "  b: {step: low_pass,\n      in: frame, with: {size: 7}   # the {pad}\n     }\n",
    ),
    "comma and comment before the brace": (
        PLAIN + "  b: {step: low_pass,\n      in: frame,   # the pad\n     }\n",
        PLAIN + "  b: {step: low_pass,\n      in: frame, with: {size: 7},   # the pad\n     }\n",
    ),
    "comment alone in braces": (
        PLAIN + IN_LINES + "    with: {# none yet }\n      }\n",
        PLAIN + IN_LINES + "    with: {size: 7 # none yet }\n      }\n",
    ),
    "null": (
        PLAIN + IN_LINES + "    with: ~  # none\n",
        PLAIN + IN_LINES + "    with: {size: 7}  # none\n",
    ),
    "nothing": (
        PLAIN + IN_LINES + "    with:  # none\n",
        PLAIN + IN_LINES + "    with: {size: 7}  # none\n",
    ),
    "nothing between braces": (
        PLAIN + "  b: {step: low_pass, in: frame, with: }\n",
        PLAIN + "  b: {step: low_pass, in: frame, with: {size: 7} }\n",
    ),
    "question marks": (
        PLAIN + "  b:\n    ? step\n    : low_pass\n    ? in\n    : frame\n",
        PLAIN + "  b:\n    ? step\n    : low_pass\n    with: {size: 7}\n    ? in\n    : frame\n",
    ),
    "question mark before a list": (
        PLAIN + "  b:\n    ? in\n    : - frame\n    step: low_pass\n",
        PLAIN + "  b:\n    with: {size: 7}\n    ? in\n    : - frame\n    step: low_pass\n",
    ),
    "comment behind the first key": (
        PLAIN + IN_LINES.replace("pass", "pass  # slow"),
        PLAIN + "  b:\n    step: low_pass  # slow\n    with: {size: 7}\n    in: frame\n",
    ),
    "line ends of Windows": (
        (PLAIN + IN_LINES).replace("\n", "\r\n"),
        (PLAIN + IN_LINES.replace("pass\n", "pass\n    with: {size: 7}\n")).replace("\n", "\r\n"),
    ),
    "no line end at the end": (
        PLAIN + "  b:\n    in: [frame]\n    step: low_pass\n    with:\n      size: 5",
        PLAIN + "  b:\n    in: [frame]\n    step: low_pass\n    with:\n      size: 7",
    ),
}


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_what_is_written_is_what_runs_however_the_file_is_spelled(spelling: str) -> None:
    before, after = (HEAD + nodes for nodes in SPELLINGS[spelling])
    changed = text_with(before, {"b": {"size": 7}})
    assert changed == after
    assert tg.loads(changed).key == tg.loads(before).with_settings({"b.size": 7}).key


def test_a_list_over_several_lines_is_changed_and_what_stands_behind_it_stays() -> None:
    text = HEAD + (
        "  a: {step: s, with: {all: [&n 1, 2], more: *n}}\n"
        "  b:\n    with:\n      some:  # few\n      - 1\n      - x: 2\n\n"
        "      # of all\n      rest: 3\n"
    )
    changed = text_with(text, {"b": {"some": 5}, "a": {"all": [3]}})
    assert "some:  # few\n        5\n\n      # of all\n      rest: 3\n" in changed
    assert "with: {all: [3], more: 1}" in changed


def test_an_alias_is_written_out_with_all_that_it_stands_for() -> None:
    text = HEAD + (
        "  a: &n\n    when: on\n    list: &l ['a, b', 010, 3 e]\n"
        "    text: |\n      two\n      lines\n    again: *l\n  b: *n\n"
    )
    changed = text_with(text, {"b": {"size": 7}})
    listed = "['a, b', 010, 3 e]"
    told = f'when: on, list: {listed}, text: "two\\nlines\\n", again: {listed}, with: {{size: 7}}'
    assert changed == text.replace("b: *n", f"b: {{{told}}}")


@pytest.mark.parametrize(
    "value", ["a, b", "}", "x # y", "two\nlines", "it's", [1, {"a": "b]"}], ""]
)
def test_values_may_hold_what_ends_a_value(value: object) -> None:
    for text in (FLOW, BLOCK):
        changed = text_with(text, {"footprint": {"level_v": value}})
        assert yaml.safe_load(changed)["nodes"]["footprint"]["with"] == {"level_v": value}
        assert changed.count("\n") == text.count("\n")


def test_no_number_is_no_trouble() -> None:
    text = text_with(FLOW, {"footprint": {"level_v": math.nan}})
    assert "level_v: .nan" in text_with(text, {"footprint": {"level_v": math.nan}})


@pytest.mark.parametrize("written", ["level_v: 0.02}}", "level_v: [0.02"])
def test_what_came_out_as_another_pipeline_is_refused(
    written: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(yaml_settings, "_replaced", lambda text, *_: text.replace("0.01", written))
    told = "footprint.level_v: cannot be written into the file's YAML as it is spelled"
    with pytest.raises(UsageError, match=re.escape(told)):
        text_with(FLOW, {"footprint": {"level_v": 0.03}})


def test_a_file_is_taken_apart_once_while_a_setting_is_moved(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    taken_apart: list[str] = []

    class Counting(yaml_settings._Loader):
        def __init__(self, text: str) -> None:
            super().__init__(text)
            taken_apart.append(text)

    monkeypatch.setattr(yaml_settings, "_Loader", Counting)
    text = f"{FLOW}# moved\n"
    for level_v in (0.02, 0.03, 0.04):
        text_with(text, {"footprint": {"level_v": level_v}})
    assert taken_apart == [text]
