"""``tactile-graph compare`` and ``audit`` as people call them."""

from __future__ import annotations

import csv
import json
import ntpath
import os
import posixpath
import re
from pathlib import Path
from types import ModuleType

import pytest

from helpers_cli import Counting, call, install
from helpers_compare import COMPARE
from tactile_graph import Image
from tactile_graph.cli.endings import PIPE_CLOSED
from tactile_graph.errors import UsageError
from tactile_graph_compare.commands.compare import _check_csv

TWO = ("compare", "discs", "next.yaml", "--frames", "10")


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def test_people_get_tables_the_lineage_and_the_saving(hand_made):
    got = call(*TWO)
    assert got.exit_code == 0, got.output
    for text in (
        "2 variants on made (frames: 10): 10 frames", "Absolute errors", "Paired differences",
        "discs → next", "added: merged, first, spare", "no clear difference",
        "merged into 5 nodes of 7, 2 of them shared",
    ):  # fmt: skip
        assert text in got.output
    assert re.search(r"centre cm +discs", got.output)


@pytest.mark.slow
@pytest.mark.parametrize("width", [60, 80, 120])
def test_tables_fit_the_terminal_and_say_what_they_leave_out(hand_made, width, monkeypatch):
    from click.testing import CliRunner

    from tactile_graph.cli import cli

    args = [*TWO, "--sweep", "footprint.level_v=0.1,0.2"]
    got = CliRunner(env={"COLUMNS": str(width)}).invoke(cli, args)
    tables = [line for line in got.output.splitlines() if "─" in line or re.match(r" \w", line)]
    assert max(map(len, tables)) <= width
    assert ("not shown, for want of width: extra" in got.output) == (width < 120)
    assert "level_v=0.1" in got.output


def test_a_row_for_each_frame_variant_and_quantity_goes_to_a_file_or_four_files_to_a_folder(
    hand_made,
):
    assert call(*TWO, "--with", "empty=[3]", "--csv", "errors.csv").exit_code == 0
    found = rows(hand_made / "errors.csv")
    assert len(found) == 9 * 2 * 2
    assert found[0] == {
        "frame": "0", "time_s": "0.0", "label": "", "variant": "discs", "quantity": "centre",
        "unit": "cm", "object": "2", "error": found[0]["error"], "answered": "1"}  # fmt: skip
    high = ("compare", "discs", "--set", "footprint.level_v=9", "--csv", "none.csv")
    assert call(*high).exit_code == 0
    assert {(r["error"], r["answered"]) for r in rows(hand_made / "none.csv")} == {("", "0")}
    assert call(*TWO, "--csv", "out").exit_code == 0
    times = rows(hand_made / "out/times.csv")
    assert len(times) == 20
    assert {r["nodes_run"] for r in times if r["variant"] == "discs"} == {"2"}
    assert len(rows(hand_made / "out/scores.csv")) == 4
    assert rows(hand_made / "out/differences.csv")[0]["verdict"] == "no clear difference"
    assert not list(hand_made.glob("**/.*.part"))


def test_the_files_are_written_though_whoever_read_along_went_away(hand_made, monkeypatch):
    def gone(*_: object) -> None:
        raise BrokenPipeError

    monkeypatch.setattr("tactile_graph_compare.output.shown.show", gone)
    assert call(*TWO, "--csv", "out", "--json", "a.json").exit_code == PIPE_CLOSED
    assert len(rows(hand_made / "out/times.csv")) == 20
    assert json.loads((hand_made / "a.json").read_text())["frames"]["n"] == 10


def test_json_holds_all_figures_and_how_they_were_made(hand_made):
    got = call(*TWO, "--json", "-", "--seed", "3")
    data = json.loads(got.stdout)
    assert data["frames"] == {"n": 10, "n_reused": 0, "n_without_truth": 0, "n_left_out": 0}
    assert [v["label"] for v in data["variants"]] == ["discs", "next"]
    assert data["lineage"][0]["added"] == ["merged", "first", "spare"]
    assert data["provenance"]["seed"] == 3
    assert len(data["provenance"]["code"]) == 64
    assert {"scipy", "numba"} <= set(data["provenance"]["versions"])
    assert data["provenance"]["variants"]["next"]["pipeline"]["nodes"]["first"]["with"]
    assert "Absolute errors" in got.stderr


def test_a_span_of_frames_is_told_and_can_be_asked_for_again(hand_made):
    call("compare", "discs", "--frames", "2:6", "--json", "out.json", "--report", "out.html")
    told = json.loads((hand_made / "out.json").read_text())["provenance"]
    assert told["frames"] == {"from": 2, "to": 6}
    page = (hand_made / "out.html").read_text()
    found = re.search(r'<pre class="command"><code>(tactile-graph .*?)</code>', page)
    assert found is not None, "what to type again stands in the report"
    assert "--frames 2:6 " in found[1]


COUNTING = """\
pipeline: counting
nodes:
  n: {step: counting, in: frame}
  peak: {step: peak, in: frame, when: n > 2}
outputs: [peak]
"""


@pytest.mark.parametrize("command", [("compare", "discs"), ("audit",)])
def test_steps_that_keep_state_see_the_frames_before_a_part(hand_made, monkeypatch, command):
    install(monkeypatch, hand_made, COMPARE, steps={"counting": Counting, "peak": chatty})
    Path("counting.yaml").write_text(COUNTING)
    words = (*command, "counting.yaml", "--source", "made", "--frames", "2:", "--json", "a.json")
    got = call(*words)
    assert got.exit_code == 0, got.output
    assert "frames before 2 are run first, for state kept by n\n" in got.stderr
    told = json.loads(Path("a.json").read_text())
    if command == ("audit",):
        assert (told["frames"], told["guards"][0]["n_stopped"]) == (2, 0)
    else:
        assert (told["frames"]["n"], told["variants"][1]["n_ok"]) == (2, 2)


def test_markdown_has_whole_tables(hand_made):
    got = call(*TWO, "--markdown", "-")
    lines = [line for line in got.stdout.splitlines() if line.startswith("|")]
    assert len({line.count("|") for line in lines[:6]}) == 1
    assert lines[1] == "| :-- | :-- | --: | --: | --: | --: | --: | --: | --: | --: |"
    # Whichever is the quicker is on the front of error and time: as they err alike, one always is.
    assert re.search(r"\b(discs|next) \\\*", got.stdout), "a star of its own, not of Markdown's"
    call(*TWO, "--markdown", "out.md")
    assert (hand_made / "out.md").read_text().startswith("2 variants on made")


def test_recordings_are_told_from_pipelines(hand_made):
    (hand_made / "a.txt").write_text("1\n2\nx\n")
    got = call("compare", "discs", "a.txt", "loads")
    assert got.exit_code == 0, got.output
    assert "2 variants on recording (path: a.txt): 2 frames, nobody knows" in got.output
    assert "a.txt:3: not a number: 'x'" in got.output


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["dics"], r"no file 'dics', and no pipeline named 'dics'; did you mean 'discs'\?"),
        (["discs", "no.npz"], r"no file 'no.npz', and no pipeline named 'no.npz'"),
        ([], r"name the pipelines to compare"),
        (["discs", "discs"], r"the same variant is named twice: discs"),
        (["discs", "--sweep", "footprint.level=1,2"],
         r"--sweep footprint.level: none .*; did you mean 'footprint.level_v'"),
        (["discs", "--set", "footprint.level=1"], r"--set footprint.level: none of the pipelines"),
        (["discs", "--only", "circel"], r"did you mean 'circle'"),
        (["discs --sat x=1"], r"'--sat' is not allowed"),
        (["discs", "--csv", "no/x.csv"], r"--csv no/x.csv: there is no folder 'no'"),
        (["discs", "--csv", "next.yaml"], r"--csv next.yaml: is a file; its name must end in .csv"),
        (["discs", "--report", "."], r"--report .: is a folder; name a file in it"),
        (["discs", "--csv", "-"], r"--csv -: name a file"),
        (["discs", "--json", "-", "--markdown", "-"], r"only one of --markdown and --json"),
        (["discs", "--truth", "t.csv"], r"convert RECORDING NEW.npz --truth t.csv' .*attach-truth"),
        (["discs", "--with", "frames=0"], r"there is nothing to compare: the source gave 0 frames"),
        (["discs", "--source", "mad"], r"--source: .*did you mean 'made'"),
        (["discs", "--source", "made", "--with", "frames=-1"], r"source made, frames: "),
    ],
)  # fmt: skip
def test_mistakes_are_told_and_nothing_is_done(hand_made, args, message):
    got = call("compare", *args)
    assert got.exit_code == 2
    assert re.search(message, got.stderr.replace("\n", " ")), got.stderr
    assert "Traceback" not in got.output


@pytest.mark.parametrize(
    "command",
    [
        ("compare", "discs", "--report", "out.html"),
        ("compare", "discs", "--csv", "out.csv"),
        ("compare", "discs", "--csv", "folder"),
        ("audit", "discs", "--json", "out.json"),
    ],
    ids=" ".join,
)
def test_a_folder_that_may_not_be_written_is_refused_before_the_work(
    hand_made, command, monkeypatch
):
    monkeypatch.setattr(os, "access", lambda *_: False)  # root may write anywhere
    got = call(*command)
    assert got.exit_code == 2
    assert got.stdout == ""
    assert f"error: {command[-2]} {command[-1]}: no permission to write in" in got.stderr


def chatty(image: Image) -> float:
    print("debug!", image.peak)  # noqa: T201 -- what authors leave in their steps
    return 1.0


def test_what_steps_print_does_not_get_into_what_programs_read(hand_made, monkeypatch):
    install(monkeypatch, hand_made, COMPARE, steps={"chatty": chatty})
    nodes = "nodes: {a: {step: chatty, in: frame}}, outputs: [a]"
    Path("p.yaml").write_text(f"{{pipeline: p, {nodes}}}")
    got = call("compare", "p.yaml", "--source", "made", "--json", "-")
    assert got.exit_code == 0
    assert json.loads(got.stdout)["frames"]["n"] == 4
    assert "debug! 1." in got.stderr


def test_what_was_done_before_a_source_broke_is_shown(hand_made):
    got = call("compare", "discs", "--source", "broken_source", "--with", "after=30")
    assert got.exit_code == 2
    assert "30 frames" in got.stdout
    assert "the cable is off" in got.stderr


@pytest.mark.parametrize(
    "word",
    ["a dir/x y.yaml", "a dir/x y.yaml --set footprint.level_v=0.02",
     "'a dir/x y.yaml' --set footprint.level_v=0.02"],
)  # fmt: skip
def test_a_file_may_stand_in_a_folder_with_spaces(hand_made, word):
    (hand_made / "a dir").mkdir()
    text = (hand_made / "next.yaml").read_text().replace("pipeline: next", "pipeline: spaced")
    (hand_made / "a dir" / "x y.yaml").write_text(text)
    got = call("compare", "discs", word, "--frames", "5")
    assert got.exit_code == 0, got.output
    assert "5 frames" in got.output


def test_ctrl_c_shows_what_is_done_so_far(hand_made, monkeypatch):
    from tactile_graph_compare.run.session import Session

    whole = Session.add

    def add(self, frame):
        if self.n == 12:
            raise KeyboardInterrupt
        return whole(self, frame)

    monkeypatch.setattr(Session, "add", add)
    got = call("compare", "discs", "next.yaml", "--frames", "30", "--json", "out.json")
    assert got.exit_code == 130
    assert "interrupted" in got.output
    assert "12 frames" in got.output
    data = json.loads((hand_made / "out.json").read_text())
    assert (data["complete"], data["frames"]["n"]) == (False, 12)


def test_ctrl_c_before_any_frame_says_so(hand_made, monkeypatch):
    from tactile_graph_compare.run.session import Session

    def add(self, frame):
        raise KeyboardInterrupt

    monkeypatch.setattr(Session, "add", add)
    got = call("compare", "discs", "next.yaml", "--frames", "30", "--json", "out.json")
    assert (got.exit_code, got.output.strip()) == (130, "interrupted before any frame")
    assert not (hand_made / "out.json").exists()


def test_an_audit_tells_what_each_guard_is_worth(hand_made):
    got = call("audit", "next.yaml", "--frames", "10", "--with", "empty=[2, 5]", "--json", "a.json")
    assert got.exit_code == 0, got.output
    words = " ".join(got.output.split())  # a cell wraps where times grow wide
    assert re.search(r"first when touched 2 ", words)
    assert re.search(r"circle first_of without first \d", words)
    guards = json.loads((hand_made / "a.json").read_text())["guards"]
    assert {(g["node"], g["kind"]) for g in guards} == {
        ("first", "when"), ("spare", "when"), ("circle", "first_of")}  # fmt: skip


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["loads", "--source", "made"], r"pipeline 'loads' has no guard and no first_of to audit"),
        (["discs", "--sample", "0.000001"], r"none of 4 frames is in the sample of 1e-06"),
        (["discs", "--sample", "0"], r"0.0 is not in the range"),
        (["discs", "--json", "no/x.json"], r"there is no folder 'no'"),
        (["discs", "--truth", "t.csv"], r"--truth t.csv: audit takes the truth that recordings"),
    ],
)
def test_an_audit_that_cannot_be_made_is_told_why(hand_made, args, message):
    got = call("audit", *args)
    assert got.exit_code == 2
    assert re.search(message, got.stderr), got.stderr


@pytest.mark.parametrize(("name", "parted"), [("new.x/", posixpath), ("new.x\\", ntpath)])
def test_a_new_folder_of_any_name_ends_in_the_systems_slash(
    name: str, parted: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("os.path.basename", parted.basename)
    _check_csv(name)
    with pytest.raises(UsageError, match=r"to make a folder of that name, write new\.x/"):
        _check_csv(name[:-1])
