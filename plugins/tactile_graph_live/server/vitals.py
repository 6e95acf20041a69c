"""How the pad and the bench are doing, of the last seconds, for the pulse."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from tactile_graph.foreign_text import visible
from tactile_graph.inspect import without_nan
from tactile_graph.live import ProcessState
from tactile_graph_live.bench.wire import Summary
from tactile_graph_live.server.messages import Plain, Pulse, Quantiles, Recording

WINDOW_S = 4.0
RATE_S = 1.0
Times = NDArray[np.float32]
EMPTY = Summary(np.zeros(0, np.float32), 0, 0, 0, 0, 0.0, 0, "starting", False, {})


class Vitals:
    """Gathers what the bench and the viewers tell of times and counts."""

    def __init__(self) -> None:
        self.summary = self._before = EMPTY
        self._latencies: deque[tuple[float, Times]] = deque()
        self._pages: deque[tuple[float, Times]] = deque()
        self._counts: deque[tuple[float, int]] = deque()

    def add(self, summary: Summary) -> None:
        """Take a summary of the bench."""
        now = time.perf_counter()
        before = self._before
        self.summary = summary = replace(
            summary,
            n_frames=before.n_frames + summary.n_frames,
            n_lost=before.n_lost + summary.n_lost,
            n_shed=before.n_shed + summary.n_shed,
            n_missed=before.n_missed + summary.n_missed,
            n_shed_before=before.n_shed_before + summary.n_shed_before,
        )
        self._latencies.append((now, summary.latencies_us))
        self._counts.append((now, summary.n_frames))
        while len(self._counts) > 2 and self._counts[1][0] < now - RATE_S:
            self._counts.popleft()

    def bench_died(self) -> None:
        """Count on from here: the next bench begins at 0."""
        self._before = self.summary

    def drawn(self, arrived_ns: int) -> None:
        """Note that a viewer has drawn a frame that arrived then."""
        us = (time.perf_counter_ns() - arrived_ns) / 1e3
        self._pages.append((time.perf_counter(), np.array([us], np.float32)))

    def rate_hz(self) -> float:
        """Return how many frames a second were done of late."""
        if len(self._counts) < 2 or self.summary.state == "ended":
            return 0.0
        (first_s, first), (last_s, last) = self._counts[0], self._counts[-1]
        return (last - first) / (last_s - first_s) if last_s > first_s else 0.0

    def pulse(self, viewers: int, recording: Recording, paused: bool) -> Pulse:
        """Return what the page is told."""
        its = self.summary
        return Pulse(
            rate_hz=round(self.rate_hz(), 1),
            frames=its.n_frames,
            lost=its.n_lost,
            shed=its.n_shed,
            shed_before=its.n_shed_before,
            missed=its.n_missed,
            viewers=viewers,
            latency_us=_quantiles(self._latencies),
            page_latency_us=_quantiles(self._pages),
            recording=recording,
            paused=paused,
            tared=its.tared,
            kept_s=round(its.kept_s, 2),
            kept_frames=its.kept_frames,
            state=its.state,
            trouble=visible(its.trouble),
            counters={visible(what): n for what, n in its.counters.items()},
            processes=_told(its.processes),
            beside=None if its.beside is None else without_nan(its.beside),
        )


def _told(processes: Mapping[str, ProcessState]) -> dict[str, Plain]:
    return {
        node: {"restarts": s.n_restarts, "starting": s.starting, "why": visible(s.why)}
        for node, s in processes.items()
    }


def _quantiles(gathered: deque[tuple[float, Times]]) -> Quantiles:
    """Return quantiles of the last seconds, and forget what is older."""
    while gathered and gathered[0][0] < time.perf_counter() - WINDOW_S:
        gathered.popleft()
    if not (times := [t for _, t in gathered if len(t)]):
        return Quantiles()
    every = np.concatenate(times)
    median, p99, most = np.percentile(every, (50, 99, 100)).tolist()
    return Quantiles(round(median, 1), round(p99, 1), round(most, 1))
