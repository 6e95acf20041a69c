"""What is counted of the frames a bench answers, and what was shed before it was ready."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from tactile_graph_live.bench.bench import _Tally


def live(arrived_ms: int, done_ms: int, shed: int) -> Any:
    return SimpleNamespace(
        arrived_ns=arrived_ms * 10**6,
        done_ns=done_ms * 10**6,
        latency_us=1e3 * (done_ms - arrived_ms),
        shed=shed,
        lost=0,
    )


def test_what_a_pipeline_that_never_catches_up_sheds_is_counted_and_its_latency_too() -> None:
    tally = _Tally()
    tally.add(live(0, 500, 30), 0.0, None)
    tally.add(live(480, 600, 40), 0.0, None)  # it waited while the first was answered
    assert (tally.n_shed, tally.n_shed_before, len(tally.taken())) == (0, 40, 0)
    for n in range(5):
        tally.add(live(510 + 100 * n, 700 + 100 * n, 50 + 10 * n), 0.0, 1e5)
    assert (tally.n_shed, tally.n_shed_before, tally.n_missed) == (50, 40, 5)
    assert tally.taken().tolist() == [190e3] * 5


def test_while_plain_code_stands_in_for_the_compiler_a_pipeline_gets_ready() -> None:
    tally = _Tally()
    for n in range(4):
        tally.add(live(100 * n, 100 * n + 90, 10 * n), 0.1 * (n + 1), None)
    assert (tally.ready, tally.n_shed_before) == (False, 30)
    tally.add(live(400, 401, 33), 0.4, None)
    tally.add(live(500, 501, 33), 0.5, None)  # another kernel, later
    assert (tally.ready, tally.n_shed, tally.n_shed_before) == (True, 3, 30)


def test_another_run_gets_ready_anew_and_counts_on() -> None:
    tally = _Tally()
    tally.add(live(0, 1, 0), 0.0, None)
    tally.add(live(2, 3, 4), 0.0, None)
    tally.begin()
    tally.add(live(4, 5, 6), 0.0, None)
    assert (tally.n_frames, tally.n_shed, tally.n_shed_before) == (3, 4, 6)
