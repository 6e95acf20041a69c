"""``Deadline``: what of a frame still fits into its time, told from how long such things took.

For each option the usual time is followed for frames of about the same footprint, and beside it by
what factors single times have strayed from the usual. From these follows the risk that an option
takes longer than what is left when the spared ones are paid for. It is begun where the risk is no
more than what is allowed; and what is allowed is raised while frames are on time and lowered with
each that is late, so that in the long run the promised share of frames is on time whatever the
times are distributed like (adaptive conformal inference; Gibbs and Candes, NeurIPS 2021).

Frames that come faster than the best choice answers wait ever longer. Were each choice begun as
long as it just fits, all frames would come to wait up to the deadline, where each rare long time
makes one late, and only the cheapest choices still fit. So the better of a ladder are begun only
while frames have waited little.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections import deque
from collections.abc import Callable
from math import exp, inf, log, log2
from time import perf_counter_ns
from typing import Any

import numpy as np

from tactile_graph.engine.deadlines.options import Option, Options, Work
from tactile_graph.engine.outcomes.outcome import NO_VALUE
from tactile_graph.wires.frame import Frame

LATE_SHARE = 0.0008
"""Of frames: a little less than the one in a thousand of which it is said that it may be late."""
HEADROOM = 0.4
"""Share of the time in which a frame may wait that each choice leaves to those after it in its
ladder: so there is room for what one falls back on, and a rare long time is not at once late."""
MOST_HEADROOM = 0.8
WINDOW = 1000
"""How many last times tell how far single ones stray."""
FOLLOWS = 0.1
"""Share of the way that the usual time goes towards each new one."""
FADES = 0.03
"""How much shorter the usual time is held for (as a logarithm) with each refusal: what is refused
is not timed, and one slow spell must not shut it out for ever."""
PACE = 0.02
"""How fast the allowed risk follows what becomes of frames."""
RESERVE_RISK = 0.01
"""Share of times that may exceed what is kept for what must be done: not for any rare stall."""
MUCH = log(3.0)
"""A last choice is not spared where one before it is quicker by more than this factor."""
LEAST_RISK, FIRST_RISK, MOST_RISK = 0.002, 0.01, 0.3
LEAST_NS = 10_000.0
"""Shorter times count as this long: by how many times 1 us is longer than 10 ns tells nothing."""


class Expected:
    """How long an option takes, as it has taken so far."""

    __slots__ = ("_faded", "_strayed", "_strayed_in_order", "_usual", "answers_in")

    def __init__(self) -> None:
        self.answers_in: float | None = None
        """Logarithm of the usual time, of frames of any kind, where it came out with a value."""
        self._usual: dict[int, float] = {}
        self._strayed: deque[float] = deque()
        self._strayed_in_order: list[float] = []
        self._faded: dict[int, float] = {}

    def usual(self, kind: int) -> float | None:
        """Return the logarithm of the usual time, that of the most similar kind known."""
        known = self._usual
        if kind in known or not known:
            return known.get(kind)
        return known[min(known, key=lambda other: abs(other - kind))]

    def risk(self, kind: int, left_ns: float) -> float:
        """Return the share of times, on frames of a kind, that exceed what is left."""
        usual = self.usual(kind)
        if usual is None:  # it is tried once
            return 0.0
        if left_ns <= 0:
            return 1.0
        strayed = self._strayed_in_order
        most = log(left_ns) - usual + self._faded.get(kind, 0.0)
        return (len(strayed) - bisect_right(strayed, most)) / len(strayed)

    def high_ns(self, kind: int, risk: float) -> float:
        """Return the time that is exceeded with a risk; 0 where nothing is known."""
        usual = self.usual(kind)
        if usual is None:
            return 0.0
        strayed = self._strayed_in_order
        return exp(usual + strayed[min(int((1.0 - risk) * len(strayed)), len(strayed) - 1)])

    def took(self, kind: int, ns: float, has_value: bool) -> None:
        """Take a time into account, and whether a value came of it."""
        time, usual = log(max(ns, LEAST_NS)), self.usual(kind)
        if has_value:
            before = time if self.answers_in is None else self.answers_in
            self.answers_in = before + FOLLOWS * (time - before)
        strayed = 0.0 if usual is None else time - usual
        # After many refusals nothing of late is known: then this one time counts for all.
        follows = max(FOLLOWS, 1.0 - exp(-self._faded.pop(kind, 0.0)))
        self._usual[kind] = time - (1.0 - follows) * strayed if kind in self._usual else time
        self._strayed.append(strayed)
        insort(self._strayed_in_order, strayed)
        if len(self._strayed) > WINDOW:
            gone = self._strayed.popleft()
            del self._strayed_in_order[bisect_right(self._strayed_in_order, gone) - 1]

    def refused(self, kind: int) -> None:
        """Hold it for a little shorter, since nobody has seen what it would have taken.

        On frames of this kind only: times on others say nothing of a first one that took long.
        """
        self._faded[kind] = self._faded.get(kind, 0.0) + FADES


class Deadline:
    """Decides for each frame what still fits; one for each runner.

    Set ``due_ns``, and ``arrived_ns`` where the frame has waited, before each frame, by the
    clock's time.

    Parameters
    ----------
    clock : callable
        Nanoseconds now.
    after : Deadline, optional
        In whose place it comes, by the same clock; decides no more once this one does. What is
        known there of the times of options of equal work is known here, and how much is allowed.
    """

    def __init__(
        self, clock: Callable[[], int] = perf_counter_ns, after: Deadline | None = None
    ) -> None:
        self.due_ns = 0
        self.arrived_ns: int | None = None
        self.allowed_risk: float = FIRST_RISK if after is None else after.allowed_risk
        self._clock = clock
        self._before = after
        self._expected: list[Expected] = []
        self._works: list[Work] = []
        self._spared: list[Option] = []
        self._kind = 0
        self._waited_ns = 0
        self._begun: list[int] = []

    def prepare(self, options: Options) -> None:
        """Take note of what there is to decide about."""
        known: dict[Work, list[Expected]] = {}
        if self._before is not None:
            for work, expected in zip(self._before._works, self._before._expected, strict=True):
                known.setdefault(work, []).append(expected)
            self._before = None
        self._works = [option.work for option in options]
        self._expected = [known[w].pop(0) if known.get(w) else Expected() for w in self._works]
        self._spared = [o for o in options if o.spared and o.always]

    def begin(self, frame: Frame) -> None:
        """Begin a frame: what it is like tells how long it takes."""
        self._kind = kind_of(frame)
        self._waited_ns = 0 if self.arrived_ns is None else max(self._clock() - self.arrived_ns, 0)
        self._begun.clear()  # an interrupted frame may have left some

    def allows(self, option: Option, state: list[Any]) -> bool:
        """Return whether the option is done in time, with no more than the allowed risk."""
        now = self._clock()
        if not self._is_spared(option):
            left_ns = self.due_ns - now - self._least_ns(option, state)
            left_ns -= self._waited_ns * waits_longer(option.beneath)
            expected = self._expected[option.number]
            if expected.risk(self._kind, left_ns) > self.allowed_risk:
                expected.refused(self._kind)
                return False
        self._begun.append(now)
        return True

    def _is_spared(self, option: Option) -> bool:
        """Return whether it is done in any case: a last choice unless another is much quicker."""
        if not option.spared or not option.instead:
            return option.spared
        own = self._expected[option.number].answers_in
        others = [self._expected[number].answers_in for number in option.instead]
        return own is None or all(other is None or own < other + MUCH for other in others)

    def _least_ns(self, option: Option, state: list[Any]) -> float:
        """Return how long all else takes which must be done in any case, and is not yet."""
        return sum(
            self._expected[spared.number].high_ns(self._kind, RESERVE_RISK)
            for spared in self._spared
            if spared is not option and state[spared.settles] is None and self._is_spared(spared)
        )

    def ended(self, option: Option, state: list[Any]) -> None:
        """Take into account how long the option has taken."""
        has_value = state[option.slot].__class__ not in NO_VALUE
        took_ns = self._clock() - self._begun.pop()
        self._expected[option.number].took(self._kind, took_ns, has_value)

    def end(self) -> None:
        """Allow more or less, by whether the frame was on time."""
        late = self._clock() > self.due_ns
        risk = self.allowed_risk + PACE * (LATE_SHARE - late)
        self.allowed_risk = min(max(risk, LEAST_RISK), MOST_RISK)


def waits_longer(beneath: int) -> float:
    """Return by how much longer than it has a frame counts as having waited.

    With none beneath a choice but the last, which is always done, only the deadline counts: 0. With
    more, frames may wait a share of their time before it is begun: what they have waited counts as
    if it were that share of what it is taken for.
    """
    return 1.0 / (1.0 - min(HEADROOM * beneath, MOST_HEADROOM)) - 1.0


def kind_of(frame: Frame) -> int:
    """Return a number that frames share on which steps have as much to do.

    How many cells read high tells how large the footprint is; how far readings reach, to within a
    factor of eight, tells frames of noise alone, where any number of cells may.
    """
    values = frame.image.values
    low, high = float(np.fmin.reduce(values, axis=None)), float(np.fmax.reduce(values, axis=None))
    n_high = np.count_nonzero(values > 0.5 * (low + high))
    reach = round(log2(high - low) / 3) if 0 < high - low < inf else -512
    return 64 * reach + int(4 * log2(n_high + 1))
