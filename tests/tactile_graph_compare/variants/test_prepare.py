"""From words on a command line to variants: settings, sweeps, parents, labels."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tactile_graph import load, loads
from tactile_graph.errors import PipelineError, UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_compare.variants.one_source import first_source, on_source
from tactile_graph_compare.variants.prepare import prepare
from tactile_graph_compare.variants.request import VariantRequest, parse_request, spelled, words_of
from tactile_graph_compare.variants.sweeps import Sweep, combinations, parse_sweep


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("a.b=0.005:0.03:0.0025", tuple(round(0.005 + 0.0025 * k, 6) for k in range(11))),
        ("a.b=0.1:0.35:0.1", (0.1, 0.2, 0.3)),
        ("a.b=3:1:-1", (3, 2, 1)),
        ("a.b=1:2:0.5", (1.0, 1.5, 2.0)),
        ("a.b=-1e-3:1e-3:1e-3", (-0.001, 0.0, 0.001)),
        ("a.b=cross3, disc5", ("cross3", "disc5")),
        ("a.b=[1, 2], [3]", ([1, 2], [3])),
        ("in/a.b=true", (True,)),
    ],
)
def test_a_sweep_is_a_range_with_its_stop_or_a_list(text, values):
    assert parse_sweep(text).values == values
    assert [type(v) for v in parse_sweep(text).values] == [type(v) for v in values]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a.b", r"--sweep a.b: must be node.setting=start:stop:step or node.setting=a,b,c"),
        ("b=1:2:1", r"must be node.setting=start"),
        ("a.b=1:2:-1", r"a step of -1 does not lead from 1 to 2"),
        ("a.b=1:2:0", r"a step of 0 does not lead from 1 to 2"),
        ("a.b=0:1:0.001", r"more than 500 values"),
        ("a.b=0:1:1e-999999", r"more than 500 values"),
        ("a.b=", r"must be values as in YAML"),
        ("a.b=[1", r"must be values as in YAML"),
        ("a.b=1,1", r"a value stands there twice"),
    ],
)
def test_a_sweep_that_is_none_is_told_why(text, message):
    with pytest.raises(UsageError, match=message):
        parse_sweep(text)


def test_sweeps_go_side_by_side_or_are_crossed():
    two = [Sweep("a.x", (1, 2)), Sweep("b.y", (3, 4))]
    assert list(combinations(two, False)) == [{"a.x": 1, "b.y": 3}, {"a.x": 2, "b.y": 4}]
    assert len(list(combinations(two, True))) == 4
    with pytest.raises(UsageError, match=r"a.x has 2 values, b.y has 1 values; --product crosses"):
        list(combinations([two[0], Sweep("b.y", (3,))], False))


def test_a_variant_says_its_settings_as_a_command_line_would():
    got = parse_request("circle-3 --set footprint.level_v=0.02 --only hull --set=fine.factor=4",
                       installed())  # fmt: skip
    assert got == VariantRequest(
        "circle-3", {"footprint.level_v": 0.02, "fine.factor": 4}, ("hull",)
    )
    again = spelled("circle-3", got.settings, got.only)
    assert parse_request(again.strip("'"), installed()) == got


def test_a_setting_may_be_a_file_as_a_pipeline_may():
    pads = {"circle.pad": "my-pad.yaml", "footprint.pad": "my pad.yaml"}
    settings = "--set circle.pad=my-pad.yaml --set 'footprint.pad=my pad.yaml'"
    for name in ("locate-circle", "a dir/x y.yaml"):
        assert parse_request(f"{name} {settings}", installed()) == VariantRequest(name, pads)


def test_on_windows_a_backslash_stays_within_quotes_and_without(monkeypatch):
    text = r"circle-1 --set a.b=sub\n.csv --set 'c.d=C:\my mats\' --only hull"
    words = ["circle-1", "--set", r"a.b=sub\n.csv", "--set", "c.d=C:\\my mats\\", "--only", "hull"]
    monkeypatch.setattr(os, "name", "nt")
    assert words_of(text) == words
    again = spelled("circle-1", {"a.b": r"sub\n.csv", "c.d": "C:\\my mats\\"}, ("hull",))
    assert words_of(again.strip('"')) == words


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("circle-3 --sat a.b=1", r"'--sat' is not allowed; it is 'NAME --set"),
        ("circle-3 --set", r"--set says nothing"),
        ("circle-3 'x", r"No closing quotation"),
        ("circle-3 --set a.b", r"--set a.b: must be node.setting=value"),
    ],
)
def test_a_variant_that_is_none_is_told_why(text, message):
    with pytest.raises(UsageError, match=message):
        parse_request(text, installed())


def labels(*texts, **rest):
    found = installed()
    return [p.label for p in prepare([parse_request(t, found) for t in texts], found, **rest)]


def test_a_sweep_makes_variants_of_each_pipeline_that_has_the_setting():
    sweep = [parse_sweep("fine.factor=2,4")]
    assert labels("circle-1", "circle-3", sweeps=sweep) == [
        "circle-1", "circle-3 factor=2", "circle-3 factor=4"]  # fmt: skip
    with pytest.raises(
        UsageError, match=r"--sweep fine.factr: none .*; did you mean 'fine.factor'"
    ):
        labels("circle-3", sweeps=[parse_sweep("fine.factr=2,4")])


def test_a_sweep_of_what_no_output_needs_is_refused():
    sweep = [parse_sweep("fine.factor=2,4")]
    with pytest.raises(UsageError, match=r"--sweep fine.factor: all variants would be alike"):
        labels("circle-3 --only footprint", sweeps=sweep)
    assert len(labels("circle-3 --only footprint", "circle-3", sweeps=sweep)) == 4


def test_common_settings_go_to_whoever_has_them_and_settings_of_one_name_are_told_in_full():
    got = labels("circle-1", "circle-3", settings={"fine.factor": 4})
    assert got == ["circle-1", "circle-3 factor=4"]
    both = {"eroded.element": "cross3", "dilated.element": "cross3"}
    assert labels("circle-3", settings=both) == [
        "circle-3 eroded.element=cross3 dilated.element=cross3"]  # fmt: skip
    with pytest.raises(UsageError, match=r"--set hull.level: none of the pipelines has it"):
        labels("circle-3", settings={"hull.level": 1})
    with pytest.raises(PipelineError, match=r"footprint.level_v: .*, got 'x'"):
        labels("circle-3", settings={"footprint.level_v": "x"})


def test_lineage_pulls_parents_in_before_their_children_and_does_not_sweep_them():
    found = installed()
    sweeps = [parse_sweep("footprint.level_v=0.01,0.02")]
    got = prepare([VariantRequest("circle-3")], found, sweeps=sweeps, lineage=True)
    assert [(p.label, p.parent) for p in got] == [
        ("circle-1", ""),
        ("circle-2", "circle-1"),
        ("circle-3 level_v=0.01", "circle-2"),
        ("circle-3 level_v=0.02", "circle-2"),
    ]


def test_the_parent_is_the_nearest_ancestor_compared_set_most_alike():
    found = installed()
    texts = ("circle-1", "circle-1 --set footprint.level_v=0.02", "circle-3",
             "circle-3 --set footprint.level_v=0.02")  # fmt: skip
    got = prepare([parse_request(t, found) for t in texts], found)
    assert [p.parent for p in got] == ["", "", "circle-1", "circle-1 level_v=0.02"]


def test_the_same_variant_twice_is_an_error_and_so_is_none():
    with pytest.raises(UsageError, match=r"named twice: circle-1"):
        labels("circle-1", "circle-1")
    with pytest.raises(UsageError, match="name the pipelines"):
        labels()


def test_what_was_set_in_a_pipeline_handed_in_is_told_as_if_it_were_typed():
    circle = load("circle-3")
    fine = circle.with_settings({"fine.factor": 4})
    request = VariantRequest(fine, {"footprint.level_v": 0.05})
    got = prepare([VariantRequest(p) for p in (circle, fine)] + [request], installed())
    assert [(p.label, p.given) for p in got] == [
        ("circle-3", "circle-3"),
        ("circle-3 factor=4", "'circle-3 --set fine.factor=4'"),
        (
            "circle-3 factor=4 level_v=0.05",
            "'circle-3 --set fine.factor=4 --set footprint.level_v=0.05'",
        ),
    ]
    with pytest.raises(UsageError, match=r"named twice: circle-3 --set fine\.factor=4"):
        prepare([VariantRequest(fine), VariantRequest(fine)], installed())


def test_a_pipeline_handed_in_is_given_by_its_file_and_one_of_a_text_by_no_command(
    tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    text = load("circle-3").text
    Path("mine.yaml").write_text(text)
    own = loads(text, file="mine.yaml").with_settings({"fine.factor": 3})
    changed = loads(text + "\n", file="mine.yaml").with_settings({"fine.factor": 4})
    functions = load("circle-1", steps={"half": lambda image: image})
    got = prepare([VariantRequest(p) for p in (own, changed, functions)], installed())
    assert [p.label for p in got] == ["circle-3 factor=3", "circle-3 factor=4", "circle-1"]
    assert [p.given for p in got] == ["'mine.yaml --set fine.factor=3'", "", ""]


def test_variants_take_the_frames_of_the_first_that_has_a_source():
    found = installed()
    got = prepare(
        [VariantRequest("circle-3"), VariantRequest("circle-1"), VariantRequest("rectangle-1")],
        found,
    )
    first, notes = first_source(got)
    assert first.label == "circle-3"
    assert notes == ["all run on the source of circle-3 (sample), not on their own: rectangle-1"]


def test_a_variant_that_cannot_take_the_frames_is_named():
    got = prepare([VariantRequest("circle-3")], installed())
    with pytest.raises(PipelineError, match=r"variant circle-3, on source 'simulate': .*'scne'"):
        on_source(got, "simulate", {"scne": "discs"})
