"""``stress`` shows a table, lists what broke, and writes its report in three forms."""

import csv
import json
import os

import pytest
from click.testing import CliRunner

from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_stress.commands.stress import _of_packages, stress
from tactile_graph_stress.report.markdown import markdown
from tactile_graph_stress.report.table import troubles
from tactile_graph_stress.study import Row
from tactile_graph_stress.subject import KINDS
from tactile_graph_stress.verdict import Outcome, Verdict


def run(*args):
    return CliRunner().invoke(stress, [str(a) for a in args], catch_exceptions=False)


def test_the_command_is_offered():
    assert installed().load("commands", "stress") is stress


@pytest.mark.slow
def test_the_table_counts_what_cases_came_to(tmp_path):
    path = tmp_path / "out.csv"
    result = run("orientation", "hull_graham", "-o", path)
    assert result.exit_code == 0
    rows = list(csv.DictReader(path.read_text().splitlines()))
    mine = [r for r in rows if r["step"] == "hull_graham"]
    line = next(line for line in result.output.splitlines() if "hull_graham" in line)
    n_exact = sum(r["outcome"] == "exact" for r in mine)
    n_up = sum(r["outcome"] == "gave up" for r in mine)
    assert line.split()[:3] == ["hull_graham", str(n_exact), str(n_up)]
    assert n_exact > 20
    assert all(float(r["units"]) <= 10.0 for r in mine if r["outcome"] == "exact")


@pytest.mark.slow
def test_the_report_says_where_and_with_what_words_a_step_gives_up(tmp_path):
    path = tmp_path / "out.md"
    assert run("orientation", "-o", path).exit_code == 0
    text = path.read_text()
    assert "Made by `tactile-graph stress orientation` with Python" in text
    assert "### orientation" in text
    assert "| Degenerate: n points: no direction | empty: no point |" in text
    run("orientation", "-o", tmp_path / "out.json", "--seed", 3)
    made = json.loads((tmp_path / "out.json").read_text())
    assert made["command"] == "tactile-graph stress orientation --seed 3"
    assert {c["outcome"] for c in made["cases"]} <= {o.value for o in Outcome}


@pytest.mark.slow
def test_full_has_more_cases_than_quick(tmp_path):
    for mode in ("quick", "full"):
        run("hull_graham", f"--{mode}", "-o", tmp_path / f"{mode}.json")
    quick, full = (
        json.loads((tmp_path / f"{m}.json").read_text())["cases"] for m in ("quick", "full")
    )
    assert len(full) > 1.5 * len(quick)
    assert {c["case"] for c in quick} <= {c["case"] for c in full}


def test_what_broke_is_said_in_table_and_report():
    row = Row("mine", "circle", "p", "NaN", "a NaN", Verdict(Outcome.BROKEN, note="x_cm is nan"))
    assert [str(t) for t in troubles([row])] == ["BROKEN mine, NaN, a NaN: x_cm is nan"]
    assert "**BROKEN 1/1**" in markdown([row], "command")
    assert "- **BROKEN** `mine`, NaN: a NaN: x_cm is nan" in markdown([row], "command")


@pytest.mark.slow
def test_ctrl_c_shows_and_writes_the_steps_that_are_done(tmp_path, monkeypatch):
    from tactile_graph_stress import study

    whole = study.stressed

    def interrupted(subject, *args):
        if subject.name == "hull_qhull":
            yield next(whole(subject, *args))
            raise KeyboardInterrupt
        yield from whole(subject, *args)

    monkeypatch.setattr(study, "stressed", interrupted)
    path = tmp_path / "out.csv"
    result = run("hull_graham", "hull_qhull", "-o", path)
    assert result.exit_code == 130
    assert {r["step"] for r in csv.DictReader(path.read_text().splitlines())} == {"hull_graham"}
    assert "interrupted: 1 of 2 steps\n" in result.stderr


@pytest.mark.parametrize(
    ("args", "words"),
    [
        (["-o", "out.txt"], r"its name must end in .md, .csv, .json"),
        (["-o", os.devnull], r"its name must end in .md, .csv, .json"),
        (["-o", "no/such/out.md"], r"there is no folder 'no/such'"),
        (["nothing"], r"no step, kind or plugin named 'nothing' can be stressed"),
        (["--seed", "-1"], r"--seed must be >= 0, got -1"),
    ],
)
def test_wrong_usage_is_told(args, words):
    with pytest.raises(UsageError, match=words):
        run(*args)


NO_LEVEL = "step 'threshold' cannot be stressed: level_v or level must be given, got neither"


@pytest.mark.parametrize(
    ("names", "why"),
    [
        (["threshold"], [NO_LEVEL]),
        (["simulate"], ["step 'simulate' cannot be stressed: a source"]),
        (["simulate", "threshold"], ["step 'simulate' cannot be stressed: a source", NO_LEVEL]),
    ],
)
def test_where_no_named_step_is_stressed_it_says_why_and_writes_nothing(tmp_path, names, why):
    with pytest.raises(UsageError) as told:
        run(*names, "-o", tmp_path / "out.csv")
    assert str(told.value).splitlines() == why
    assert [*tmp_path.iterdir()] == []


@pytest.mark.slow
def test_named_steps_that_are_not_stressed_say_why_beside_those_that_are():
    result = run("threshold", "orientation", "simulate")
    assert result.exit_code == 0
    assert "  orientation " in result.stdout
    assert set(result.stderr.splitlines()) >= {
        NO_LEVEL, "step 'simulate' cannot be stressed: a source",
    }  # fmt: skip


@pytest.mark.slow
def test_of_a_plugin_it_says_how_many_steps_are_not_stressed_and_how_to_read_why():
    result = run("hull")
    assert result.exit_code == 0
    told = "1 step is not stressed; name one to read why: tactile-graph stress simplify_polygon"
    assert told in result.stderr.splitlines()


def test_a_package_stands_for_its_plugins_that_have_steps():
    names = _of_packages(("tactile-graph", "icm"), installed())
    assert {"mrf", "hull"} <= set(names)
    assert "compare" not in names
    assert names[-1] == "icm"


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)  # which every step is of one of
def test_no_built_in_step_breaks(kind):
    result = run(kind)
    assert result.exit_code == 0, result.output
