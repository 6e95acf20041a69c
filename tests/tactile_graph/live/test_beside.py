"""A variant beside a live run: how far it agrees, told without ever holding the run up."""

from __future__ import annotations

import time
from math import inf
from typing import Any

import pytest

from helpers_graphs import frame
from tactile_graph import load
from tactile_graph.live import Beside, LiveRun
from tactile_graph.live.beside import Agreement


def said(x: float | None) -> dict[str, Any]:
    return {"circle": None if x is None else {"circle.x_cm": x, "circle.name": "disc"}}


def test_frames_where_they_differ_most_are_kept_the_worst_first() -> None:
    agreement = Agreement(keep=3)
    apart = [0.1, 0.1, 0.5, 0.1, 0.0, 0.9, 0.1]
    for i, by in enumerate(apart):
        agreement.add(frame(0, i), said(1.0), said(1.0 + by))
    agreement.add(frame(0, 7), said(1.0), said(None))
    assert (agreement.n, agreement.n_same) == (8, 7)
    n, mean, most = agreement.fields["circle.x_cm"]
    assert (n, mean, most) == (7, pytest.approx(1.8 / 7), pytest.approx(0.9))
    assert [kept.frame.index for kept in agreement.kept] == [7, 5, 2]
    assert agreement.kept[0].difference == inf


def test_words_that_differ_count_as_far_apart_and_equal_answers_are_not_kept() -> None:
    agreement = Agreement()
    agreement.add(frame(0, 0), said(1.0), said(1.0))
    assert agreement.kept == []
    other = {"circle": {"circle.x_cm": 1.0, "circle.name": "plate"}}
    agreement.add(frame(0, 1), said(1.0), other)
    assert [kept.difference for kept in agreement.kept] == [inf]


def test_only_outputs_that_both_have_are_held_against_each_other() -> None:
    agreement = Agreement()
    agreement.add(frame(0, 0), {**said(1.0), "mask": {"mask.count": 3}}, said(1.0))
    assert (agreement.n_same, agreement.kept) == (1, [])


@pytest.mark.slow
def test_a_variant_runs_beside_and_says_how_far_it_agrees() -> None:
    first, variant = load("circle-1"), load("circle-3")
    frames = list(first.frames())
    beside = Beside(variant, keep=2)
    try:
        run = LiveRun(first, frames * 3)
        run.beside = beside
        assert len(list(run)) == 3 * len(frames)  # it has held nothing up, and nothing was shed
        assert run.n_shed == 0
        end = time.monotonic() + 60
        while beside.summary()["frames"] < 1 and time.monotonic() < end:
            time.sleep(0.02)
        told = beside.summary()
        assert told["variant"] == "circle-3"
        assert told["frames"] >= 1
        assert told["frames"] + told["passed"] <= 3 * len(frames)
        assert told["differences"]["circle.radius_cm"]["most"] > 0
        assert told["trouble"] == ""
    finally:
        beside.close()


@pytest.mark.slow
def test_a_variant_whose_process_ends_is_told_and_the_run_goes_on() -> None:
    first = load("circle-1")
    beside = Beside(load("circle-3"))
    beside._process.kill()
    run = LiveRun(first, first.frames())
    run.beside = beside
    assert len(list(run)) > 0
    end = time.monotonic() + 20
    while not beside.trouble and time.monotonic() < end:
        time.sleep(0.02)
    assert beside.trouble == "its process ended"
    beside.close()
