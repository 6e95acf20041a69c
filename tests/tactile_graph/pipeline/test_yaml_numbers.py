"""Numbers are what YAML 1.2 says, in files, behind options, and in what is written for them."""

from __future__ import annotations

import math
from typing import Any

import pytest
import yaml

from tactile_graph.pipeline.document import assignment, read_document
from tactile_graph.pipeline.yaml_numbers import in_yaml

READ = [
    ("010", 10), ("08", 8), ("+010", 10), ("-010", -10), ("-09", -9), ("00", 0), ("0", 0),
    ("0_10", 10), ("1_000", 1000), ("0o10", 8), ("0x10", 16), ("0xfF", 255), ("-0x10", -16),
    ("0b11", 3), ("1", 1), ("-12", -12), ("010.5", 10.5), ("09.5", 9.5), ("1.0e-2", 0.01),
    (".5", 0.5), ("-.5", -0.5), ("+.5", 0.5), ("-.5e-3", -0.0005),
    ("-.inf", -math.inf), ("1.", 1.0), ("!!int 010", 10), ("!!int \"08\"", 8),
    # texts, also to 1.2
    ("0:30", "0:30"), ("1:30", "1:30"), ("1:30.5", "1:30.5"), ("0o8", "0o8"), ("1.2.3", "1.2.3"),
    ('"08"', "08"), ("'010'", "010"), ("08a", "08a"), ("2024-03-01", "2024-03-01"),
    # texts to PyYAML, and told how to be written
    ("1e-2", "1e-2"), ("2e4", "2e4"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "value"), READ)
def test_a_number_is_what_yaml_1_2_says(text: str, value: object) -> None:
    document = read_document(f"factor: {text}\nlist: [{text}]\n", "p.yaml")
    assert document.problems == []
    name, behind_option = assignment("--set", f"fine.factor={text}")
    assert name == "fine.factor"
    for got in (document.data["factor"], *document.data["list"], behind_option):
        assert got == value
        assert type(got) is type(value)


@pytest.mark.parametrize("text", ["!!int 1:30", "!!int eight", "!!int 0x", "!!int ''"])
def test_what_a_tag_calls_a_number_and_is_none_is_refused(text: str) -> None:
    (problem,) = read_document(f"factor: {text}\n", "p.yaml").problems
    assert problem.message.endswith(" is no int")


@pytest.mark.parametrize(
    "value",
    [
        "08",
        "010",
        "0o10",
        "-09",
        "1:30",
        "1e-2",
        "-.5",
        "12",
        10,
        8,
        -3,
        0.5,
        "a",
        ["08", 8],
        {"08": "9"},
    ],
)
def test_what_is_written_is_read_as_the_same_by_both(value: Any) -> None:
    written = in_yaml(value, default_flow_style=True)
    assert read_document(f"v: {written.removesuffix(chr(10) + '...' + chr(10))}", "p").data == {
        "v": value
    }
    assert yaml.safe_load(written) == value


@pytest.mark.parametrize("word", ["y", "N", "1e3", "0o17", "-.5e-3"])
def test_texts_that_other_readers_of_yaml_take_for_more_stand_in_quotes(word: str) -> None:
    assert in_yaml([word], default_flow_style=True) == f"['{word}']\n"
