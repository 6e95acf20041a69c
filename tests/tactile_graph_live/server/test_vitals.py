"""How the pad and the bench are doing."""

from __future__ import annotations

import json
import time
from dataclasses import replace

import numpy as np
import pytest

from tactile_graph.live import ProcessState
from tactile_graph_live.bench.wire import Summary
from tactile_graph_live.server import vitals as module
from tactile_graph_live.server.messages import Recording, encoded
from tactile_graph_live.server.vitals import Vitals


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    found = Clock()
    monkeypatch.setattr(module.time, "perf_counter", found)
    return found


def summary(n_frames: int, latencies: list[float], state: str = "running") -> Summary:
    times = np.array(latencies, np.float32)
    counters = {"bytes": 9}
    return Summary(
        times, n_frames, 2, 3, 1, 12.345, 67, state, True, counters, n_shed_before=5  # type: ignore[arg-type]
    )  # fmt: skip


def test_the_rate_is_that_of_the_last_second(clock: Clock) -> None:
    vitals = Vitals()
    n = 0
    for rate in (100, 400):
        for _ in range(20):
            clock.now += 0.25
            n += rate // 4
            vitals.add(summary(n, []))
    assert vitals.rate_hz() == pytest.approx(400)
    vitals.add(summary(n, [], "ended"))
    assert vitals.rate_hz() == 0.0


def test_counts_go_on_where_a_bench_died(clock: Clock) -> None:
    vitals = Vitals()
    vitals.add(summary(100, []))
    vitals.bench_died()
    clock.now += 0.25
    vitals.add(summary(25, []))
    vitals.add(summary(50, []))
    pulse = vitals.pulse(0, Recording(), paused=False)
    assert (pulse.frames, pulse.lost, pulse.shed, pulse.missed) == (150, 4, 6, 2)
    assert pulse.shed_before == 10
    assert pulse.rate_hz == 200.0


def test_latencies_of_all_frames_of_the_last_seconds_are_told(clock: Clock) -> None:
    vitals = Vitals()
    vitals.add(summary(1, [1e6]))
    clock.now += 5.0
    vitals.add(summary(101, [*map(float, range(1, 101))]))
    pulse = vitals.pulse(2, Recording(), paused=True)
    assert (pulse.latency_us.median, pulse.latency_us.most) == (50.5, 100.0)
    assert (pulse.viewers, pulse.paused, pulse.tared, pulse.kept_s) == (2, True, True, 12.35)
    assert (pulse.lost, pulse.shed, pulse.missed) == (2, 3, 1)
    clock.now += 5.0
    assert vitals.pulse(0, Recording(), paused=False).latency_us.median is None


def test_how_processes_fare_goes_to_the_page_as_json() -> None:
    vitals = Vitals()
    processes = {"hull": ProcessState("hull", 2, True, "took longer than its \x1b 0.5 s")}
    vitals.add(replace(summary(1, []), processes=processes))
    told = json.loads(encoded(vitals.pulse(1, Recording(), paused=False)))["processes"]
    assert told["hull"]["restarts"] == 2
    assert told["hull"]["starting"] is True
    assert "\x1b" not in told["hull"]["why"]


def test_what_a_page_took_is_told_apart(clock: Clock) -> None:
    vitals = Vitals()
    vitals.drawn(time.perf_counter_ns() - 20_000_000)
    page = vitals.pulse(1, Recording(), paused=False).page_latency_us
    assert page.median is not None
    assert 20_000 <= page.median < 60_000
