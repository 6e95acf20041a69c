"""``Beside``: another variant on the frames of a live run, in what time is left.

It runs in a process of its own, of the lowest priority, which is given the newest frame whenever it
is done with one; all others pass it by. The run itself only lays each result down.
"""

from __future__ import annotations

import heapq
import subprocess
import sys
import weakref
from collections import deque
from collections.abc import Mapping, Sequence
from contextlib import suppress
from itertools import count
from math import inf, isfinite
from statistics import median
from threading import Condition, Lock, Thread
from typing import IO, Any, NamedTuple

from tactile_graph.engine.calls.isolated_worker import received, sent
from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.tables.rows import scalars
from tactile_graph.out_of_reach import out_of_reach
from tactile_graph.wires.frame import Frame

KEEP = 20
"""Frames that are kept, those where the two differ most."""
LAST_TIMES = 1000
Scalars = dict[str, dict[str, Any] | None]
"""Of each output its named scalars, or None where it has no value."""


def scalars_of(result: Outcomes) -> Scalars:
    """Return the named scalars of each output of a result."""
    outcomes = {name: result.outcome(name) for name in result.plan.asked}
    return {
        name: None if outcome.__class__ in NO_VALUE else scalars(name, outcome)
        for name, outcome in outcomes.items()
    }


class Differing(NamedTuple):
    """A frame on which the two differ: by how much, beside what is usual, and what each says."""

    difference: float
    frame: Frame
    first: Scalars
    beside: Scalars


class FieldDifference(NamedTuple):
    """How far apart a number of both lies: on the mean, and at most."""

    n: int
    mean: float
    most: float


class Agreement:
    """How far two variants agree, frame by frame; bounded, however long they run.

    Parameters
    ----------
    keep : int
        How many frames are kept.
    """

    def __init__(self, keep: int = KEEP) -> None:
        self.n = self.n_same = 0
        self.fields: dict[str, FieldDifference] = {}
        self._kept: list[tuple[float, int, Differing]] = []
        self._keep, self._number = keep, count()

    def add(self, frame: Frame, first: Scalars, beside: Scalars) -> None:
        """Take what both say of a frame into account; only outputs that both have count."""
        both = [name for name in first if name in beside]
        same = all((first[name] is None) == (beside[name] is None) for name in both)
        self.n += 1
        self.n_same += same
        apart = 0.0 if same else inf
        for name in both:
            apart = max(apart, self._apart(first[name] or {}, beside[name] or {}))
        if apart > 0.0:
            entry = (apart, -next(self._number), Differing(apart, frame, first, beside))
            put = heapq.heappush if len(self._kept) < self._keep else heapq.heappushpop
            put(self._kept, entry)

    def _apart(self, first: Mapping[str, Any], beside: Mapping[str, Any]) -> float:
        """Return how many times its usual difference the number lies apart that does so most."""
        most = 0.0
        for key, one in first.items():
            other = beside.get(key)
            if not _is_number(one) or not _is_number(other):
                most = inf if other is not None and one != other else most
                continue
            by = abs(one - other)
            n, mean, largest = self.fields.get(key, FieldDifference(0, 0.0, 0.0))
            mean += (by - mean) / (n + 1)
            self.fields[key] = FieldDifference(n + 1, mean, max(largest, by))
            most = max(most, by / mean if mean > 0.0 else 0.0)
        return most

    @property
    def kept(self) -> list[Differing]:
        """The frames where they differ most, the worst first."""
        return [differing for _, _, differing in sorted(self._kept, reverse=True)]


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


class Beside:
    """A variant that runs beside a live run; give it to `LiveRun.beside`.

    Parameters
    ----------
    variant : Pipeline
        One that another process can load: by installed plugins.
    only : sequence of str, optional
    seed : int
        As of the run.
    keep : int
        How many frames are kept, those where the two differ most.
    """

    def __init__(
        self, variant: Any, *, only: Sequence[str] | None = None, seed: int = 0, keep: int = KEEP
    ) -> None:
        self.variant = variant
        self.agreement = Agreement(keep)
        self.n_passed = 0
        """How many frames passed it by."""
        self.trouble = ""
        """What ended it, if anything did."""
        self._first_us: deque[float] = deque(maxlen=LAST_TIMES)
        self._beside_us: deque[float] = deque(maxlen=LAST_TIMES)
        self._newest: tuple[Outcomes, float] | None = None
        self._came, self._lock, self._closed = Condition(), Lock(), False
        order = (variant, only, seed)
        command = [sys.executable, "-P", "-m", "tactile_graph.live.beside_worker"]
        with out_of_reach():
            self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self._end = weakref.finalize(self, _ended, self._process)
        self._thread = Thread(target=self._go, args=(order,), name="beside", daemon=True)
        self._thread.start()

    def offer(self, result: Outcomes, took_us: float) -> None:
        """Lay a result down; the variant takes the newest when it is free. Never waits."""
        with self._came:
            self.n_passed += self._newest is not None
            self._newest = result, took_us
            self._came.notify()

    def close(self) -> None:
        """End the process; what was told stays to be read."""
        with self._came:
            self._closed = True
            self._came.notify()
        self._end()
        self._thread.join()

    def summary(self) -> dict[str, Any]:
        """Return in plain data how far the two agree, and what they take."""
        with self._lock:
            agreement = self.agreement
            return {
                "variant": self.variant.name,
                "frames": agreement.n,
                "passed": self.n_passed,
                "same_outcomes": agreement.n_same,
                "differences": {
                    key: {"mean": field.mean, "most": field.most}
                    for key, field in agreement.fields.items()
                },
                "median_us": median(self._first_us) if self._first_us else None,
                "beside_median_us": median(self._beside_us) if self._beside_us else None,
                "kept": [differing.frame.index for differing in agreement.kept],
                "trouble": self.trouble,
            }

    # -- the thread between the two --------------------------------------------------------------

    def _go(self, order: Any) -> None:
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        try:
            sent(stdin, sys.path)
            sent(stdin, order)
            while (taken := self._take()) is not None:
                self._one(stdin, stdout, *taken)
        except Exception as error:  # it ended, or what it runs cannot be sent
            ended = isinstance(error, OSError | EOFError)
            self.trouble = "" if self._closed else "its process ended" if ended else str(error)
        finally:
            self._end()
            for pipe in (stdin, stdout):
                with suppress(OSError):  # what was to be flushed has nobody to read it
                    pipe.close()

    def _take(self) -> tuple[Outcomes, float] | None:
        with self._came:
            while self._newest is None and not self._closed:
                self._came.wait()
            taken, self._newest = self._newest, None
            return None if self._closed else taken

    def _one(self, stdin: IO[bytes], stdout: IO[bytes], result: Outcomes, took_us: float) -> None:
        sent(stdin, result.frame)
        beside, ns = received(stdout)
        with self._lock:
            self.agreement.add(result.frame, scalars_of(result), beside)
            self._first_us.append(took_us)
            self._beside_us.append(ns / 1e3)


def _ended(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
