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


def add(tally: _Tally, live: Any, plain_s: float = 0.0, through_ms: int | None = None) -> None:
    """Count a frame, with what is done behind it until a time, and nothing if there is none."""
    tally.add(live, plain_s, 1e5)
    tally.through(live.done_ns if through_ms is None else through_ms * 10**6)


def test_what_a_pipeline_that_never_catches_up_sheds_is_counted_and_its_latency_too() -> None:
    tally = _Tally()
    add(tally, live(0, 500, 30))
    add(tally, live(480, 600, 40))  # it waited while the first was answered
    assert (tally.n_shed, tally.n_shed_before, len(tally.taken())) == (0, 40, 0)
    for n in range(5):
        add(tally, live(510 + 100 * n, 700 + 100 * n, 50 + 10 * n))
    assert (tally.n_shed, tally.n_shed_before, tally.n_missed) == (40, 50, 5)
    assert tally.taken().tolist() == [190e3] * 5


def test_what_waits_for_the_first_picture_is_not_shed_under_load() -> None:
    tally = _Tally()
    add(tally, live(0, 500, 30), through_ms=560)
    add(tally, live(540, 561, 70))  # it came after the first answer, while that was drawn
    add(tally, live(562, 563, 75))
    assert (tally.ready, tally.n_shed, tally.n_shed_before) == (True, 0, 75)
    assert tally.taken().tolist() == [1e3]
    add(tally, live(564, 565, 76))
    assert (tally.n_shed, tally.n_shed_before) == (1, 75)


def test_while_plain_code_stands_in_for_the_compiler_a_pipeline_gets_ready() -> None:
    tally = _Tally()
    for n in range(4):
        add(tally, live(100 * n, 100 * n + 90, 10 * n), 0.1 * (n + 1))
    assert (tally.ready, tally.n_shed_before) == (False, 30)
    add(tally, live(400, 401, 33), 0.4)
    add(tally, live(500, 501, 36), 0.5)  # another kernel, later
    assert (tally.ready, tally.n_shed, tally.n_shed_before) == (True, 3, 33)


def test_another_run_gets_ready_anew_and_counts_on() -> None:
    tally = _Tally()
    add(tally, live(0, 1, 0))
    add(tally, live(2, 3, 0))
    add(tally, live(4, 5, 4))
    tally.begin()
    add(tally, live(6, 7, 6))
    assert (tally.n_frames, tally.n_shed, tally.n_shed_before) == (4, 4, 6)
