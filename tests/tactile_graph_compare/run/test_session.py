"""Times compare: orders of variants are balanced, and what is made once is in none of them."""

from __future__ import annotations

import time
from collections import Counter
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from helpers_graphs import STEPS, registry
from tactile_graph import Frame, Image, loads
from tactile_graph.compiled.preparing import preparing
from tactile_graph.plugins.registry import installed
from tactile_graph_compare import Comparison, compare
from tactile_graph_compare.output.export import time_rows
from tactile_graph_compare.run.audit import Auditor
from tactile_graph_compare.run.frame_choice import Seen
from tactile_graph_compare.run.session import WARM_FRAMES, Session, balanced_orders
from tactile_graph_compare.variants.prepare import prepare
from tactile_graph_compare.variants.request import VariantRequest
from tactile_graph_tune.rerun import rerun
from tactile_graph_tune.table.record import Judged, Rounds, record


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6, 7])
def test_each_comes_at_each_place_and_behind_each_other_equally_often(n: int) -> None:
    rows = balanced_orders(n, 100)
    assert all(sorted(row) == list(range(n)) for row in rows)
    places = Counter((place, k) for row in rows for place, k in enumerate(row))
    assert len(places) == n * n
    assert len(set(places.values())) == 1
    behind = Counter(pair for row in rows for pair in pairwise(row))
    assert len(behind) == n * (n - 1)
    assert len(set(behind.values())) <= 1


def test_of_many_variants_eight_different_ones_come_first() -> None:
    assert len({row[0] for row in balanced_orders(20, 8)}) == 8


MADE_S = 0.1
LATE = WARM_FRAMES + 2
"""The frame in which a branch runs for the first time, long after all is warm."""


class Branching:
    """Calls a kernel in `LATE` alone, which takes its time to be compiled."""

    def __init__(self) -> None:
        self.calls: list[int] = []
        self.made = False

    def __call__(self, image: Image) -> int:
        index = int(image.values[0, 0])
        self.calls.append(index)
        if index == LATE and not self.made:
            self.made = True
            time.sleep(MADE_S)
            preparing.n_made += 1
        return index


class Keeping:
    """The same, with state."""

    def __init__(self) -> None:
        self._its = BRANCHING

    def __call__(self, image: Image) -> int:
        return self._its(image)


BRANCHING = Branching()
FRAMES = [Frame.of(np.full((2, 2), float(k)), index=k) for k in range(LATE + 2)]


@pytest.fixture
def branching(monkeypatch: pytest.MonkeyPatch) -> Branching:
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    monkeypatch.setattr(preparing, "n_made", 0)
    made = Branching()
    monkeypatch.setitem(globals(), "BRANCHING", made)
    return made


def pipeline(step: Any) -> Any:
    text = "pipeline: p\nnodes: {a: {step: branching, in: frame}}\noutputs: [a]"
    return loads(text, registry=registry({**STEPS, "branching": step}))


def branch(image: Image) -> int:
    return BRANCHING(image)


def compared(step: Any) -> Comparison:
    return compare([pipeline(step)], FRAMES)


def test_a_frame_with_which_machine_code_comes_is_run_again_and_its_own_time_counts(
    branching: Branching,
) -> None:
    found = compared(branch)
    (variant,) = found.variants
    assert branching.made
    assert branching.calls[WARM_FRAMES:].count(LATE) == 2
    assert np.isfinite(variant.times.per_frame_us).all()
    assert variant.times.per_frame_us[LATE] < 1e6 * MADE_S
    assert found.saving.merged_s < MADE_S
    assert [n.n_ran for n in found.graph.nodes] == [len(FRAMES)]


def test_where_steps_keep_state_it_is_run_once_and_has_no_time(branching: Branching) -> None:
    found = compared(Keeping)
    (variant,) = found.variants
    assert branching.calls[WARM_FRAMES:].count(LATE) == 1
    known = np.isfinite(variant.times.per_frame_us)
    assert np.flatnonzero(~known).tolist() == [LATE]
    assert found.saving.merged_s < MADE_S
    (node,) = found.graph.nodes
    assert node.total_s < MADE_S
    spent, reused = list(time_rows(found))[LATE][4:6]
    assert (spent, reused) == ("", 0)


@pytest.mark.parametrize("step", [branch, Keeping])
def test_what_a_guard_saves_holds_no_compiling(branching: Branching, step: Any) -> None:
    text = "pipeline: p\nnodes: {n: {step: read, in: frame}, a: {step: branching, in: frame, "
    text += "when: n < 0}}\noutputs: [a, n]"
    auditor = Auditor(loads(text, registry=registry({**STEPS, "branching": step})))
    for frame in FRAMES:
        auditor.add(frame)
    auditor.summarise()
    (guard,) = auditor.guards
    assert branching.made
    assert len(guard.saved_us) == len(FRAMES)
    assert guard.saved_us[LATE] < 1e6 * MADE_S


def test_times_of_frames_that_are_shown_are_of_machine_code_that_is_ready(
    branching: Branching, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where workers noted them, nothing was warmed up in this process."""
    warmed: list[bool] = []
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: warmed.append(True))
    session = Session(prepare([VariantRequest(pipeline(branch))], installed()))
    told = session.told(Seen(FRAMES[LATE], False))
    assert branching.made
    assert warmed
    assert told.stories["p"]["a"].time_us < 1e6 * MADE_S


def test_last_runs_of_tuning_hold_no_compiling(
    branching: Branching, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tactile_graph_tune.rerun.LossOf", lambda *a: lambda frame, at: 0.0)
    monkeypatch.setattr(time, "process_time", time.perf_counter)  # who sleeps takes none
    times_us, _ = rerun({"p": pipeline(branch)}, FRAMES, Judged("a", "q", "", 1.0), 1, 0)["p"]
    assert branching.made
    assert times_us[LATE] < 1e6 * MADE_S


def test_tables_of_tuning_hold_no_compiling(
    branching: Branching, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tactile_graph_tune.table.record.LossOf", lambda *a: lambda frame, at: 0.0)
    monkeypatch.setattr("tactile_graph_tune.table.record.warm_up", lambda: None)
    judged, rounds = Judged("a", "q", "", 1.0), Rounds(1, 0, lambda n, of: None)
    (table,) = record([pipeline(branch)], (), FRAMES, judged, rounds)
    assert branching.made
    assert table.nodes["a"].time_us[LATE] < 1e6 * MADE_S
