"""The progress bar comes only for long work on a terminal."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from tactile_graph.cli.output import progress
from tactile_graph.cli.output.progress import Bar


def drawn(terminal: bool, shown: bool = True, total: int | None = 50) -> str:
    out = io.StringIO()
    bar = Bar(Console(file=out, force_terminal=terminal, width=100), "discs", shown)
    for i in range(1, 11):
        bar.at(i, total)
    bar.stop()
    return out.getvalue()


@pytest.fixture
def at_once(monkeypatch):
    monkeypatch.setattr(progress, "WORTH_A_BAR_S", -1.0)
    monkeypatch.setattr(progress, "REDRAW_S", -1.0)


@pytest.mark.usefixtures("at_once")
def test_a_bar_says_what_runs_and_how_far_it_is():
    assert "discs" in drawn(terminal=True)
    assert "/50" in drawn(terminal=True)
    assert "/?" in drawn(terminal=True, total=None)


def test_long_work_need_not_wait_for_it():
    out = io.StringIO()
    bar = Bar(Console(file=out, force_terminal=True, width=100), "discs")
    bar.now(300)
    bar.stop()
    assert "/300" in out.getvalue()


def test_short_work_shows_no_bar():
    assert drawn(terminal=True) == ""


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize(("terminal", "shown"), [(False, True), (True, False)])
def test_no_bar_away_from_a_terminal_or_beside_the_table(terminal, shown):
    assert drawn(terminal, shown) == ""


@pytest.mark.usefixtures("at_once")
@pytest.mark.parametrize("terminal", [False, True])
def test_away_from_a_terminal_it_may_be_a_single_line(terminal):
    out = io.StringIO()
    console = Console(file=out, force_terminal=terminal, width=100)
    bar = Bar(console, "painting", things="pictures", elsewhere="painting {done} of {total}")
    for i in range(3, 6):
        bar.at(i, 50)
    bar.stop()
    told = out.getvalue()
    assert ("pictures" in told) == terminal
    assert (told == "painting 3 of 50\n") != terminal
