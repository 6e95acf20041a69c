"""``run``: tables for people, lines for programs, and what is kept when it ends early."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from helpers_cli import DISCS, Counting, broken_plugin, call, install
from tactile_graph import Frame, Mask, load
from tactile_graph.cli.output.live_table import LiveTable
from tactile_graph.engine.tables.columns import Column, columns_of
from tactile_graph.errors import UsageError
from tactile_graph.pipeline.document import assignment
from tactile_graph.steps.settings import takes_paths, takes_text
from tactile_graph.steps.signature import read_signature

pytestmark = pytest.mark.usefixtures("hand_made")


def lines(text: str) -> list[dict]:
    return [json.loads(line) for line in text.splitlines()]


def rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text().splitlines()))


# -- to people -----------------------------------------------------------------------------------


def test_people_get_a_table_with_units_and_errors_against_the_nearest_true_object_of_the_kind():
    got = call("run", "discs")
    assert got.exit_code == 0
    head, names, units = got.stdout.splitlines()[1:4]
    assert head.split() == ["circle", "error"]
    assert names.split() == ["frame", "time", "x", "y", "radius", "centre", "radius"]
    assert units.split() == ["s", "cm", "cm", "cm", "cm", "cm"]
    first = got.stdout.splitlines()[5].split()
    # Four cells of 1 cm make a circle of radius sqrt(4 / pi); the true one has radius 1.
    assert first == ["0", "0.000", "1.000", "2.000", "1.128", "0.000", "0.128"]
    assert "circle is off, on average over 4 frames, by centre 0.000 cm" in got.stdout
    assert re.search(r"4 frames in .* s \(.* a second\): 4 with all outputs", got.stdout)


def test_times_that_count_from_long_ago_still_tell_frames_apart():
    pipeline = load("discs")
    images = [f.image for f in pipeline.frames()]
    frames = [Frame(images[i], i, 12452.031 + 0.03 * i) for i in range(2)]
    results = list(pipeline.stream(frames))
    out = io.StringIO()
    columns = columns_of(pipeline, tuple(pipeline.outputs))
    table = LiveTable(Console(file=out, width=100), columns, results[0])
    for result in results:
        table.row(result)
    _, names, units, _, *rows = out.getvalue().splitlines()
    assert [row.split()[1] for row in rows] == ["12452.031", "12452.061"]
    end = rows[0].index("12452.031") + len("12452.031")
    assert end == names.index("time") + len("time") == units.index("s") + 1


@pytest.mark.parametrize(
    ("width", "kept"),
    [
        (70, ["long", "x", "y", "radius", "probability"]),
        (54, ["x", "y", "radius", "probability"]),
        (36, ["x", "probability"]),
    ],
)
def test_what_is_empty_gives_way_first_and_what_it_is_last(width: int, kept: list[str]):
    pipeline = load("discs")
    result = next(iter(pipeline.stream(islice(pipeline.frames(), 1))))
    (circle,) = columns_of(pipeline, ("circle",))
    empty = Column("circle.long_cm", "circle", "long", "cm", float)
    sure = Column("circle.radius_cm", "circle", "probability", "", float)
    columns = replace(circle, values=(empty, *circle.values, sure), errors=())
    out = io.StringIO()
    table = LiveTable(Console(file=out, width=width), [columns], result)
    shown = [c.column.field for c in table.blocks[0].cells]
    assert shown == kept
    assert [c for c in columns.values if c.field not in kept] == table.hidden


def test_a_frame_without_an_output_says_why_and_the_run_goes_on():
    got = call("run", "discs", "--with", "empty=[1]")
    assert got.exit_code == 0
    assert "    1    0.100  skipped: when footprint.count > 0 is false (footprint.count = 0)" in (
        got.stdout
    )
    assert "skipped  circle in frame 1: when footprint.count > 0" in got.stdout
    assert "4 frames" in got.stdout
    assert "3 with all outputs, 1 skipped" in got.stdout


def test_a_failed_frame_exits_with_1_and_is_counted_by_node():
    got = call("run", "discs", "--set", "circle.fail_at_x=2")
    assert got.exit_code == 1
    assert "failed   circle in frame 2: no circle about 4 cells" in got.stdout
    assert "3 with all outputs, 1 failed" in got.stdout


def test_an_unexpected_failure_of_a_step_is_told_with_its_file_and_line():
    got = call("run", "discs", "--set", "circle.crash=true")
    assert got.exit_code == 1
    assert "circle in 4 frames, first in frame 0: ZeroDivisionError: divided by nothing" in (
        got.stdout
    )
    assert re.search(r"helpers_cli\.py:\d+ in disc", got.stdout)


def test_a_failure_that_every_frame_has_is_told_in_full_once():
    out = call("run", "discs", "--set", "circle.crash=true").stdout.splitlines()
    told = [line.split(None, 2)[2] for line in out if re.match(r" +\d+ +\d", line)]
    assert told == ["failed: ZeroDivisionError: divided by nothing", *3 * ["failed: as in frame 0"]]


def test_columns_without_room_are_named(monkeypatch):
    from click.testing import CliRunner

    from tactile_graph.cli import cli

    got = CliRunner(env={"COLUMNS": "50"}).invoke(cli, ["run", "discs"])
    assert "not shown, for want of width: circle.radius_cm; -o gives them" in got.stdout
    table = got.stdout.splitlines()[1:9]
    assert max(map(len, table)) <= 50


def test_recordings_are_opened_labelled_and_their_troubles_told_by_line(tmp_path):
    (tmp_path / "a.txt").write_text("1\nbad\n2\n")
    (tmp_path / "b.txt").write_text("3\n")
    got = call("run", "loads", "a.txt", "b.txt")
    assert got.exit_code == 0
    assert "source   a.txt:2: not a number: 'bad'" in got.stdout
    body = [line.split() for line in got.stdout.splitlines() if ".txt " in line]
    assert [(r[0], r[1], r[2]) for r in body[:3]] == [
        ("0", "a.txt", "4"),
        ("1", "a.txt", "8"),
        ("2", "b.txt", "12"),
    ]


# -- to programs ---------------------------------------------------------------------------------


def test_json_lines_hold_outputs_errors_and_truth(tmp_path):
    got = call("run", "discs", "-o", "out.jsonl", "--with", "empty=[1]")
    assert got.exit_code == 0
    assert got.stdout == ""
    frames = lines((tmp_path / "out.jsonl").read_text())
    assert [f["frame"] for f in frames] == [0, 1, 2, 3]
    assert frames[0]["outputs"]["circle"]["x_cm"] == 1.0
    assert frames[0]["errors"]["circle"]["radius_cm"] == pytest.approx(0.12838, abs=1e-5)
    assert frames[0]["truth"][2] == {
        "kind": "Circle",
        "shape": {"kind": "Circle", "x_cm": 1.0, "y_cm": 2.0, "radius_cm": 1.0},
        "weight_g": None,
        "name": "disc",
    }
    assert frames[1]["outputs"]["circle"]["skipped"].startswith("when footprint.count > 0 is false")
    assert frames[1]["errors"] == {}


def test_stdout_carries_nothing_but_lines_when_asked_for_lines():
    got = call("run", "discs", "-o", "-")
    assert len(lines(got.stdout)) == 4
    assert "4 frames" in got.stderr


def test_a_format_alone_means_stdout():
    got = call("run", "discs", "--format", "csv")
    assert got.stdout.splitlines()[0].startswith("frame,time_s,label,circle.outcome,circle.x_cm")
    assert len(got.stdout.splitlines()) == 5


def test_csv_columns_are_the_same_whatever_the_first_frame_gave(tmp_path):
    call("run", "discs", "-o", "full.csv")
    call("run", "discs", "-o", "holes.csv", "--with", "empty=[0]", "--set", "circle.fail_at_x=1")
    full, holes = rows(tmp_path / "full.csv"), rows(tmp_path / "holes.csv")
    assert list(full[0]) == list(holes[0]) == [
        "frame", "time_s", "label", "circle.outcome", "circle.x_cm", "circle.y_cm",
        "circle.radius_cm", "circle.centre_error_cm", "circle.radius_error_cm",
    ]  # fmt: skip
    assert holes[0]["circle.x_cm"] == ""
    assert holes[0]["circle.outcome"].startswith("skipped: when")
    assert holes[1]["circle.outcome"] == "failed: no circle about 4 cells"
    assert holes[2] == full[2]


def test_csv_has_columns_for_every_arm_of_a_union_and_every_field(tmp_path):
    call("run", "loads", "--source", "made", "-o", "out.csv")
    first = rows(tmp_path / "out.csv")[0]
    assert list(first)[3:] == [
        "load.outcome", "load.total", "load.x_cm", "load.parts.count",
        "shape.outcome", "shape.x_cm", "shape.y_cm", "shape.radius_cm", "shape.semi_major_cm",
        "shape.semi_minor_cm", "shape.angle_deg", "shape.centre_error_cm",
        "shape.radius_error_cm", "shape.semi_major_error_cm", "shape.semi_minor_error_cm",
        "shape.angle_error_deg",
    ]  # fmt: skip
    assert first["load.parts.count"] == "2"
    assert first["shape.semi_major_cm"] == ""


def test_values_that_json_has_no_words_for_become_null(tmp_path):
    (tmp_path / "nan.yaml").write_text(
        "pipeline: nan\nnodes: {n: {step: not_finite, in: frame}}\noutputs: [n]\n"
    )
    got = call("run", "nan.yaml", "--source", "made", "--frames", "1", "-o", "-")
    assert lines(got.stdout)[0]["outputs"] == {"n": None}


def test_infinity_and_nan_are_null_for_json_has_neither():
    from tactile_graph.engine.tables.rows import without_nan

    cleaned = without_nan({"a": [{"b": float("inf"), "c": float("nan")}]})
    assert cleaned == {"a": [{"b": None, "c": None}]}


def test_lines_tell_a_big_array_by_its_shape_and_in_full_by_its_numbers(monkeypatch):
    monkeypatch.setattr("tactile_graph.engine.tables.rows.MOST_NUMBERS", 23)
    args = ["run", "discs", "--only", "footprint", "-o", "-"]
    short, full = (lines(call(*args, *more).stdout)[0] for more in ([], ["--full"]))
    assert short["outputs"]["footprint"]["values"] == {"shape": [4, 6]}
    assert full["outputs"]["footprint"]["values"][1] == [True, True, False, False, False, False]
    without = {k: v for k, v in full["outputs"]["footprint"].items() if k != "values"}
    assert without.items() <= short["outputs"]["footprint"].items()


def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        call("run", "loads", "--source", "made", "-o", f"{name}.jsonl", "--seed", seed)
    a, b, c = ((tmp_path / f"{n}.jsonl").read_bytes() for n in "abc")
    assert a == b != c


def test_an_output_file_has_its_provenance_beside_it(tmp_path):
    (tmp_path / "a.txt").write_text("1\n2\nx\n")
    got = call(
        "run", "discs", "a.txt", "-o", "out.csv", "--seed", 7, "--set", "footprint.level_v=0.25"
    )
    assert got.exit_code == 0
    meta = json.loads((tmp_path / "out.csv.meta.json").read_text())
    assert meta["complete"] is True
    assert meta["seed"] == 7
    assert meta["asked"] == ["circle"]
    assert meta["source"]["step"] == "recording"
    assert meta["source"]["sha256"] == {"a.txt": "d1"}
    assert meta["source"]["troubles"] == [{"where": "a.txt:3", "what": "not a number: 'x'"}]
    assert meta["pipeline"]["nodes"]["footprint"]["with"] == {"level_v": 0.25}
    assert meta["pipeline"]["nodes"]["circle"]["with"] == {"fail_at_x": -1.0, "crash": False}
    assert meta["plugins"] == {"hand": {"package": "hand-made", "version": "1.2"}}
    assert meta["result"]["frames"] == 2
    assert set(meta["versions"]) == {
        "tactile-graph",
        "python",
        "numpy",
        "scipy",
        "numba",
        "platform",
    }


# -- which frames, which nodes, which settings ---------------------------------------------------


@pytest.mark.parametrize(
    ("span", "expected"),
    [("2", [0, 1]), ("1:3", [1, 2]), ("2:", [2, 3]), (":1", [0])],
)
def test_frames_are_chosen_by_count(span, expected):
    got = call("run", "loads", "--source", "made", "--frames", span, "-o", "-")
    assert [f["frame"] for f in lines(got.stdout)] == expected


COUNTING = "pipeline: counting\nnodes:\n  n: {step: counting, in: frame}\noutputs: [n]\n"


def test_steps_that_keep_state_see_the_frames_before_a_part(tmp_path, monkeypatch):
    install(monkeypatch, tmp_path, steps={"counting": Counting})
    Path("counting.yaml").write_text(COUNTING)
    got = call("run", "counting.yaml", "--source", "made", "--frames", "2:", "-o", "-")
    assert "frames before 2 are run first, for state kept by n\n" in got.stderr
    rows = lines(got.stdout)
    assert [(row["frame"], row["outputs"]["n"]) for row in rows] == [(2, 3), (3, 4)]
    got = call("run", "loads", "--source", "made", "--frames", "2:", "-o", "-")
    assert "run first" not in got.stderr


def test_a_source_that_makes_its_frames_is_asked_for_as_many():
    got = call("run", "discs", "--frames", 9, "-o", "-")
    assert len(lines(got.stdout)) == 9


def test_a_source_that_ends_early_is_told(tmp_path):
    (tmp_path / "a.txt").write_text("1\n")
    got = call("run", "loads", "a.txt", "--frames", 5)
    assert got.exit_code == 0
    assert "the source ended after 1 of 5 frames" in got.stdout


def test_recordings_are_read_by_whatever_step_its_plugin_offers_for_it(tmp_path, monkeypatch):
    def lines_read(*, lines_of: list[Path] | Path) -> Iterator[Frame]:
        for text in Path(str(lines_of)).read_text().split():
            yield Frame.of(np.full((2, 2), float(text)), quantity="volt")

    readers = {"recording": "path", "lines_read": "lines_of"}
    install(monkeypatch, tmp_path, steps={"lines_read": lines_read}, readers=readers)
    (tmp_path / "a.txt").write_text("1\n2\n")
    steps = []
    for choice in ([], ["--source", "lines_read"]):
        got = call("run", "loads", "a.txt", *choice, "-o", tmp_path / "out.jsonl")
        assert got.exit_code == 0, got.stderr
        meta = json.loads((tmp_path / "out.jsonl.meta.json").read_text())
        steps.append((meta["source"]["step"], meta["result"]["frames"]))
    assert steps == [("recording", 2), ("lines_read", 2)]


def test_an_unknown_source_beside_recordings_is_told_by_what_is_near(tmp_path):
    got = call("run", "loads", "a.txt", "--source", "recordng")
    assert got.exit_code == 2
    assert "--source: no step named 'recordng'; did you mean 'recording'?" in got.stderr
    got = call("run", "loads", "a.txt", "--source", "made")
    assert "give recordings or --source made, not both: a.txt" in got.stderr


def test_without_a_step_that_reads_recordings_it_is_said(tmp_path, monkeypatch):
    install(monkeypatch, tmp_path, ("torn", "torn-package", "1", broken_plugin), readers={})
    got = call("run", "loads", "a.txt")
    assert got.exit_code == 2
    assert "no plugin offers a step that reads recordings (plugins failed to load" in got.stderr


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["--frames", "x"], "'x': must be a number of frames (20) or a range (10:30)"),
        (["--frames", "3:1"], "'3:1': holds no frame; must be like 20, 10:30, 10: or :30"),
        (["--frames", "0"], "'0': holds no frame"),
        (["--frames", "9:"], "--frames 9:…: the source gave only 4 frames"),
        (["--only", "circl"], "no node named 'circl'; did you mean 'circle'?"),
        (["--set", "circle.crush=1"], "unknown setting 'crush'; did you mean 'crash'?"),
        (["--set", "footprint.level_v=-1"], "setting footprint.level_v: must be > 0.0, got -1"),
        (["--set", "circl.crash=1"], "no node named 'circl'; did you mean 'circle'?"),
        (["--set", "circle.crash"], "--set circle.crash: must be node.setting=value"),
        (["--set", "crash=1"], "setting 'crash': it is named node.setting"),
        (["--set", "circle.crash=!!python/name:os.system"], "refused"),
        (["--set", "circle.crash=[1"], "--set circle.crash=[1: this is not YAML"),
        (["--with", "frames"], "--with frames: must be key=value"),
        (["--with", "frame=3"], "source made, frame: unknown setting 'frame'; did you mean"),
        (["--with", "frames=-3"], "source made, frames: must be >= 0, got -3"),
        (["--source", "mode"], "no step named 'mode'; did you mean 'made'?; sources are: "
                               "broken_source, made, recording"),
        (["--source", "disc"], "--source disc: this step is no source"),
        (["--source", "made", "x.txt"], "give recordings or --source made, not both: x.txt"),
        (["x.txt"], "x.txt: No such file or directory"),
        (["-o", "out.xls"], "-o out.xls: its name must end in .jsonl, .ndjson, .csv"),
        (["-o", "no/out.csv"], "-o no/out.csv: there is no folder 'no'"),
        (["-o", "."], "-o .: is a folder; name a file in it"),
        (["--plot", "strip.jpg"], "--plot strip.jpg: its name must end in .png, .svg, .pdf, .gif, "
                                  ".mp4; did you mean '.png'?"),
        (["--plot", os.devnull], "its name must end in .png, .svg, .pdf, .gif, .mp4"),
        (["--full"], "--full: a table holds single numbers only; give -o FILE.jsonl or -o -"),
        (["--full", "-o", "out.csv"], "--full: CSV holds single numbers only"),
        (["--seed", "-1"], "'--seed'"),
        (["--bogus"], "--bogus"),
    ],
)  # fmt: skip
def test_mistakes_are_told_in_words_without_a_traceback(args, message):
    got = call("run", "discs", *args)
    assert got.exit_code == 2
    assert message in got.stderr
    assert "Traceback" not in got.output
    assert got.stdout == ""


@pytest.mark.parametrize("text", ["%d.%m.%Y", "#3", "@all", "[a", "*x"])
def test_a_text_setting_takes_what_is_no_yaml_as_it_is_typed(tmp_path, monkeypatch, text):
    seen = []

    def told(mask: Mask, *, word: str | list[str] = "") -> float:
        seen.append(word)
        return mask.area_cm2

    def fed(*, word: str = "") -> Iterator[Frame]:
        seen.append(word)
        yield Frame.of(np.ones((2, 2)), quantity="volt")

    install(monkeypatch, tmp_path, steps={"told": told, "fed": fed})
    (tmp_path / "p.yaml").write_text(DISCS.replace("step: disc,", "step: told,"))
    words = ("run", tmp_path / "p.yaml", "--source", "fed", "--with", f"word={text}", "--set")
    assert call(*words, f"circle.word={text}").exit_code == 0
    assert seen == [text, text]


@pytest.mark.parametrize(
    "text",
    ["D:", "D: x", "2024", "yes", "rec #2.npz", "#3.npz", "[a].npz", "[a] #2.npz", "%a", "- a"],
)
def test_a_path_is_taken_as_it_is_typed_whatever_yaml_makes_of_it(tmp_path, monkeypatch, text):
    seen = []

    def told(mask: Mask, *, file: Path | None = None) -> float:
        seen.append(file)
        return mask.area_cm2

    def fed(*, path: Path | list[Path]) -> Iterator[Frame]:
        seen.append(path)
        yield Frame.of(np.ones((2, 2)), quantity="volt")

    install(monkeypatch, tmp_path, steps={"told": told, "fed": fed})
    (tmp_path / "p.yaml").write_text(DISCS.replace("step: disc,", "step: told,"))
    words = ("run", tmp_path / "p.yaml", "--source", "fed", "--with", f"path={text}", "--set")
    got = call(*words, f"circle.file={text}")
    assert got.exit_code == 0, got.output
    assert seen == [Path(text), Path(text)]


@pytest.mark.parametrize(
    ("text", "value"),
    [(t, t) for t in ("rec #2", "[a] #2", '"rec" #2')] + [('"rec #2"', "rec #2"), ("null", None)],
)
def test_only_quotes_and_null_are_read_as_yaml_where_a_text_or_path_is_meant(text, value):
    for takes in ([lambda _: True], [lambda _: False, lambda _: True]):
        assert assignment("--with", f"path={text}", *takes) == ("path", value)
    assert assignment("--with", "path=[a, b]", *takes) == ("path", ["a", "b"])


@pytest.mark.parametrize("kind", [Path | dict[str, Any] | None, str | dict[str, Any]])
@pytest.mark.parametrize("text", ["rec #2.npz", "#2.npz", "[x].npz", "{x}.npz", "{x"])
def test_a_text_is_taken_as_it_is_typed_beside_a_mapping(tmp_path, monkeypatch, kind, text):
    seen = []

    def told(mask: Mask, *, file: kind = "") -> float:
        seen.append(file)
        return mask.area_cm2

    told.__annotations__ |= {"mask": Mask, "file": kind, "return": float}
    install(monkeypatch, tmp_path, steps={"told": told})
    (tmp_path / "p.yaml").write_text(DISCS.replace("step: disc,", "step: told,"))
    for value in (text, "{a: 'b #c'}"):
        got = call("run", tmp_path / "p.yaml", "--set", f"circle.file={value}")
        assert got.exit_code == 0, got.output
    typed = text if kind == str | dict[str, Any] else Path(text)
    assert seen == [*[typed] * (len(seen) // 2), *[{"a": "b #c"}] * (len(seen) // 2)]


def test_a_text_is_taken_as_it_is_typed_beside_a_list_and_no_number():
    def told(*, words: str | list[str], also: Path | list[str], number: str | float) -> float:
        return 1.0

    its = read_signature("told", told)
    assert [takes_text(its, s.name) for s in its.settings] == [True, False, False]
    assert [takes_paths(its, s.name) for s in its.settings] == [False, True, False]


def test_a_file_in_brackets_is_taken_where_it_is_there(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    takes = (lambda _: False, lambda _: True)
    assert assignment("--with", "path=[a, b]", *takes) == ("path", ["a", "b"])
    (tmp_path / "[a, b]").touch()
    assert assignment("--with", "path=[a, b]", *takes) == ("path", "[a, b]")


def test_no_text_is_cut_where_nothing_tells_what_a_setting_takes():
    with pytest.raises(UsageError, match=r"'#2\.npz' is a comment of YAML"):
        assignment("--set", "a.b=rec #2.npz")
    assert assignment("--set", 'a.b="rec #2.npz"') == ("a.b", "rec #2.npz")


def test_without_a_pipeline_run_says_what_there_is():
    got = call("run")
    assert got.exit_code == 2
    assert "name a pipeline, or a file of one" in got.stderr
    assert "  discs  A disc on hand-made frames" in got.stderr


def test_a_pipeline_without_a_source_asks_for_one():
    got = call("run", "loads")
    assert got.exit_code == 2
    assert "pipeline 'loads' declares no source: give it recordings or --source" in got.stderr


def test_all_mistakes_of_a_file_are_shown_with_place_and_snippet(tmp_path):
    text = DISCS.replace("step: pressed", "step: presed").replace("[circle]", "[circl]")
    (tmp_path / "bad.yaml").write_text(text)
    got = call("run", "bad.yaml")
    assert got.exit_code == 2
    assert "bad.yaml:5:21: node 'footprint': no step named 'presed'" in got.stderr
    assert "5 |   footprint: {step: presed, in: frame" in got.stderr
    assert "bad.yaml:7:11: output 'circl': no node named 'circl'" in got.stderr
    assert "2 problems" in got.stderr


def test_a_setting_that_changes_nothing_is_told():
    changed = ("--set", "footprint.level_v=0.25")
    told = "--set footprint.level_v: changes nothing, for what is asked for does not need"
    for asked, idle in (((), False), (("--only", "load"), True), (("--only", "spare"), False)):
        got = call("run", "loads", "--source", "made", *changed, *asked, "-o", "-")
        assert got.exit_code == 0
        assert (told in got.stderr) is idle


def test_what_is_asked_for_twice_is_told_and_counted_once():
    twice = ("--only", "circle", "--only", "circle")
    once, again = (call("run", "discs", *asked).stdout for asked in (twice[:2], twice))
    assert [line.split("frames in")[0] for line in again.splitlines()] == [
        line.split("frames in")[0] for line in once.splitlines()
    ]
    assert [*load("discs").runner(["circle", "circle"]).plan.asked] == ["circle"]


def test_only_asks_for_nodes_and_fields_instead_of_the_outputs():
    got = call("run", "discs", "--only", "footprint.count", "--only", "footprint", "-o", "-")
    first = lines(got.stdout)[0]
    assert list(first["outputs"]) == ["footprint.count", "footprint"]
    assert first["outputs"]["footprint.count"] == 4


def test_settings_on_the_command_line_are_yaml(tmp_path):
    got = call("run", "discs", "--set", "footprint.level_v=5e-1", "--set", "circle.crash=no",
               "-o", "o.jsonl")  # fmt: skip
    assert got.exit_code == 0
    meta = json.loads((tmp_path / "o.jsonl.meta.json").read_text())
    assert meta["pipeline"]["nodes"]["footprint"]["with"]["level_v"] == 0.5
    assert meta["pipeline"]["nodes"]["circle"]["with"]["crash"] is False


# -- endings -------------------------------------------------------------------------------------


def test_when_the_source_fails_what_was_done_is_kept_and_told(tmp_path):
    got = call("run", "loads", "--source", "broken_source", "-o", "out.jsonl")
    assert got.exit_code == 2
    assert len(lines((tmp_path / "out.jsonl").read_text())) == 2
    assert "2 frames in" in got.stderr
    told = r"error: source 'broken_source': RuntimeError: the cable is off \(.*py:\d+ in broken_s"
    assert re.search(told, got.stderr)
    assert json.loads((tmp_path / "out.jsonl.meta.json").read_text())["complete"] is False


def test_nothing_is_written_when_the_first_frame_cannot_be_had(tmp_path):
    got = call("run", "loads", "--source", "broken_source", "--with", "after=0", "-o", "out.csv")
    assert got.exit_code == 2
    assert not (tmp_path / "out.csv").exists()


def test_no_frames_at_all_still_make_a_csv_with_its_head(tmp_path):
    got = call("run", "discs", "--with", "frames=0", "-o", "out.csv")
    assert got.exit_code == 0
    assert (tmp_path / "out.csv").read_text().count("\n") == 1


def test_debug_shows_the_traceback():
    got = call("run", "loads", "--source", "broken_source", "--debug")
    assert got.exit_code == 2
    assert "Traceback" in got.stderr
    assert "in broken_source" in got.stderr


def test_a_picture_is_drawn_of_the_first_frames_only(monkeypatch, tmp_path):
    from tactile_graph.draw import strip

    seen = []
    monkeypatch.setattr(strip, "save_strip", lambda results, path: seen.append((results, path)))
    got = call("run", "discs", "--frames", 30, "--plot", "strip.png")
    assert got.exit_code == 0
    results, path = seen[0]
    assert [r.frame.index for r in results] == list(range(12))
    assert str(path) == "strip.png"
    assert "wrote strip.png" in got.stdout


@pytest.mark.parametrize(("n", "warmed"), [(200, False), (201, True)])
def test_only_long_runs_warm_the_compiler_up(monkeypatch, n, warmed):
    calls = []
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: calls.append(1))
    call("run", "discs", "--frames", n, "-o", "-")
    assert bool(calls) is warmed


def test_runs_of_unknown_length_warm_the_compiler_up_unless_bounded(monkeypatch, tmp_path):
    (tmp_path / "a.txt").write_text("1\n")
    calls = []
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: calls.append(1))
    call("run", "loads", "a.txt", "--frames", 10)
    assert calls == []
    call("run", "loads", "a.txt")
    assert calls == [1]


# -- as a process --------------------------------------------------------------------------------


def process(*args: str, **kwargs: object) -> subprocess.Popen[bytes]:
    env = {**os.environ, "TACTILE_GRAPH_KERNELS": "plain"}
    command = [sys.executable, "-m", "tactile_graph", *args]
    return subprocess.Popen(command, env=env, stderr=subprocess.PIPE, **kwargs)  # type: ignore[call-overload]


ENDLESS = ("run", "circle-3", "--source", "simulate", "--frames", "1000000")


def test_ctrl_c_that_is_swallowed_on_its_way_ends_the_run_at_the_next_frame(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As compiled modules swallow it while they are imported, without a word."""
    from tactile_graph.cli.commands import run as module

    real = module._Run._results

    def deaf(self: module._Run) -> Iterator[object]:
        for k, result in enumerate(real(self)):
            if k == 2:
                with contextlib.suppress(KeyboardInterrupt):
                    signal.raise_signal(signal.SIGINT)
            yield result

    monkeypatch.setattr(module._Run, "_results", deaf)
    got = call("run", "discs")
    assert got.exit_code == 130
    assert "2 frames in" in got.stdout


@pytest.mark.slow
def test_ctrl_c_keeps_whole_lines_tells_what_was_done_and_exits_with_130(tmp_path):
    out = tmp_path / "out.jsonl"
    running = process(*ENDLESS, "-o", str(out))
    end = time.monotonic() + 30
    while time.monotonic() < end and (not out.exists() or out.stat().st_size < 2000):
        time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=30)
    assert running.returncode == 130, said
    text = out.read_text()
    assert text.endswith("}\n")
    n = len(lines(text))
    assert f"interrupted: {n} frames".encode() in said
    assert b"Traceback" not in said
    assert json.loads(Path(f"{out}.meta.json").read_text())["complete"] is False


@pytest.mark.slow
@pytest.mark.parametrize("to", [[], ["-o", "-"]])
def test_a_reader_that_goes_away_ends_the_run_quietly(to):
    with process(*ENDLESS, *to, stdout=subprocess.PIPE) as running:
        assert running.stdout is not None
        assert running.stderr is not None
        assert running.stdout.readline()
        running.stdout.close()
        said = running.stderr.read()
    assert running.returncode == 141
    assert said == b""


def test_troubles_are_told_at_once_while_no_frame_comes(monkeypatch, tmp_path):
    (tmp_path / "a.txt").write_text("1\nbad\n2\n")
    assert call("run", "loads", "a.txt", "-o", "o.csv").stderr.count("a.txt:2: not a number") == 1
    monkeypatch.setattr("tactile_graph.cli.commands.run.STALLED_S", -1.0)
    assert call("run", "loads", "a.txt", "-o", "o.csv").stderr.count("a.txt:2: not a number") == 2
    (tmp_path / "a.txt").write_text("1\n" + "bad\n" * 12 + "2\n")
    said = call("run", "loads", "a.txt", "-o", "o.csv").stderr
    assert said.count("not a number") == 2 * 5  # at once, and at the end
    assert said.count("… and 7 more") == 1


# -- decisions of a live run ---------------------------------------------------------------------


@pytest.mark.slow
def test_decisions_of_a_live_run_are_taken_again(tmp_path: Path) -> None:
    decided = tmp_path / "live.jsonl"
    decided.write_text('{"frame": 0}\n{"frame": 2, "deadline": ["circle"]}\n{"frame": 3}\n')
    got = call("run", "discs", "--decisions", decided, "-o", "-")
    assert got.exit_code == 0
    written = lines(got.stdout)
    assert [row["frame"] for row in written] == [0, 2, 3]
    assert [row.get("deadline") for row in written] == [None, ["circle"], None]
    assert written[1]["outputs"]["circle"] == {"skipped": "deadline", "origin": "circle"}


def test_decisions_are_followed_by_one_process_only(tmp_path: Path) -> None:
    decided = tmp_path / "live.jsonl"
    decided.write_text('{"frame": 0}\n')
    got = call("run", "discs", "--decisions", decided, "--workers", 2, "-o", tmp_path / "o.jsonl")
    assert got.exit_code == 2
    assert "--decisions: are followed by one process, without --workers" in got.stderr
