"""``Deadline``: what of a frame still fits into its time, told from how long such things took.

For each option the usual time is followed for frames of about the same footprint, and beside it by
what factors single times have strayed from the usual, apart for footprints of another order: on an
empty pad a rare frame may take two hundred times the usual. From these follows the risk that an
option takes longer than what is left when the spared ones are paid for. It is begun where the risk
is no more than what is allowed; and what is allowed is raised while frames are on time and lowered
with each that is late, so that in the long run the promised share of frames is on time whatever the
times are distributed like (adaptive conformal inference; Gibbs and Candes, NeurIPS 2021).
"""

from __future__ import annotations

from bisect import bisect_right, insort
from collections import deque
from collections.abc import Callable, Mapping
from math import exp, inf, log, log2
from time import perf_counter_ns
from typing import Any, TypeVar

import numpy as np

from tactile_graph.engine.options import Option, Options, Work
from tactile_graph.engine.outcome import NO_VALUE
from tactile_graph.wires.frame import Frame

Known = TypeVar("Known", float, "Strayed")

LATE_SHARE = 0.0005
"""Of frames: what is aimed at, half of what is promised. How many frames of a run are late scatters
around it, and those that wait behind a late one may be late too."""
WINDOW = 1000
"""How many last times, of an order of footprints, tell how far single ones stray."""
KINDS_ALIKE = 4
"""Kinds of frames whose times stray alike: footprints within a factor of two."""
FOLLOWS = 0.1
"""Share of the way that the usual time goes towards each new one."""
FADES = 0.03
"""How much shorter the usual time is held for (as a logarithm) with each refusal: what is refused
is not timed, and one slow spell must not shut it out for ever."""
PACE = 0.02
"""How fast the allowed risk follows what becomes of frames."""
RESERVE_RISK = 0.01
"""Share of times that may exceed what is kept for what must be done: not for any rare stall."""
NEXT_RISK = 0.003
"""Share of times that may exceed what is kept for the next frame's second choice."""
PERIOD_FOLLOWS = 0.1
"""Share of the way that the time between frames goes towards each new one."""
ANSWERS_FOLLOW = 0.02
"""Share of the way that the share of frames with a value goes towards each new one."""
MUCH = log(3.0)
"""A last choice is not spared where one before it is quicker by more than this factor."""
FIRST_RISK, MOST_RISK = 0.01, 0.3


class Strayed:
    """By what factors the last times have strayed from the usual one, as logarithms."""

    __slots__ = ("_in_order", "_last")

    def __init__(self) -> None:
        self._last: deque[float] = deque()
        self._in_order: list[float] = []

    def add(self, strayed: float) -> None:
        """Add one; of more than `WINDOW` the oldest is forgotten."""
        self._last.append(strayed)
        insort(self._in_order, strayed)
        if len(self._last) > WINDOW:
            del self._in_order[bisect_right(self._in_order, self._last.popleft()) - 1]

    def beyond(self, most: float) -> float:
        """Return the share that exceeds what is at most allowed."""
        n = len(self._in_order)
        return (n - bisect_right(self._in_order, most)) / n

    def high(self, risk: float) -> float:
        """Return what is exceeded by a share of them."""
        n = len(self._in_order)
        return self._in_order[min(int((1.0 - risk) * n), n - 1)]


class Expected:
    """How long an option takes, as it has taken so far."""

    __slots__ = ("_answers", "_faded", "_strayed", "_usual", "answers_in")

    def __init__(self) -> None:
        self.answers_in: float | None = None
        """Logarithm of the usual time, of frames of any kind, where it came out with a value."""
        self._answers: dict[int, float] = {}
        self._usual: dict[int, float] = {}
        self._strayed: dict[int, Strayed] = {}
        self._faded = 0.0

    def usual(self, kind: int) -> float | None:
        """Return the logarithm of the usual time, that of the most similar kind known."""
        return nearest(self._usual, kind)

    def risk(self, kind: int, left_ns: float) -> float:
        """Return the share of times, on frames of a kind, that exceed what is left."""
        usual = self.usual(kind)
        if usual is None:  # it is tried once
            return 0.0
        if left_ns <= 0:
            return 1.0
        return self._strayed_of(kind).beyond(log(left_ns) - usual + self._faded)

    def high_ns(self, kind: int, risk: float) -> float:
        """Return the time that is exceeded with a risk; 0 where nothing is known."""
        usual = self.usual(kind)
        if usual is None:
            return 0.0
        return exp(usual + self._strayed_of(kind).high(risk))

    def _strayed_of(self, kind: int) -> Strayed:
        found = nearest(self._strayed, kind // KINDS_ALIKE)
        assert found is not None  # there is one since a first time was taken
        return found

    def answers(self, kind: int) -> float:
        """Return the share of frames of about a kind of which it comes out with a value."""
        found = nearest(self._answers, kind // KINDS_ALIKE)
        return 1.0 if found is None else found

    def took(self, kind: int, ns: float, has_value: bool) -> None:
        """Take a time into account, and whether a value came of it."""
        time, usual = log(max(ns, 1.0)), self.usual(kind)
        if has_value:
            before = time if self.answers_in is None else self.answers_in
            self.answers_in = before + FOLLOWS * (time - before)
        strayed = 0.0 if usual is None else time - usual
        # After many refusals nothing of late is known: then this one time counts for all.
        follows = max(FOLLOWS, 1.0 - exp(-self._faded))
        self._usual[kind] = time - (1.0 - follows) * strayed if kind in self._usual else time
        self._faded = 0.0
        order = kind // KINDS_ALIKE
        self._strayed.setdefault(order, Strayed()).add(strayed)
        share = self._answers.get(order, float(has_value))
        self._answers[order] = share + ANSWERS_FOLLOW * (has_value - share)

    def refused(self) -> None:
        """Hold it for a little shorter, since nobody has seen what it would have taken."""
        self._faded += FADES


class Deadline:
    """Decides for each frame what still fits; one for each runner.

    Set ``due_ns`` before each frame, by the clock's time.

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
        self.allowed_risk: float = FIRST_RISK if after is None else after.allowed_risk
        self._clock = clock
        self._before = after
        self._expected: list[Expected] = []
        self._works: list[Work] = []
        self._spared: list[Option] = []
        self._next: dict[int, Option] = {}
        self._kind = 0
        self._last_due_ns: int | None = None
        self._period_ns = inf
        self._begun: list[int] = []
        self._ventured = False
        self._blamed = False

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
        for (ladder, place), option in options.choices.items():
            below = options.choices.get((ladder, place + 1))
            if below is not None and not below.spared:
                self._next[option.number] = below

    def begin(self, frame: Frame) -> None:
        """Begin a frame: what it is like tells how long it takes."""
        self._kind = kind_of(frame)
        self._begun.clear()  # an interrupted frame may have left some
        self._ventured = False
        if (last := self._last_due_ns) is not None:
            passed, period = self.due_ns - last, self._period_ns
            known = period < inf
            self._period_ns = period + PERIOD_FOLLOWS * (passed - period) if known else passed
        self._last_due_ns = self.due_ns

    def allows(self, option: Option, state: list[Any]) -> bool:
        """Return whether the option is done in time, with no more than the allowed risk."""
        now = self._clock()
        if not self._is_spared(option):
            left_ns = self.due_ns - now - self._least_ns(option, state) - self._next_ns(option)
            expected, kind = self._expected[option.number], self._kind
            if expected.risk(kind, left_ns) > self.allowed_risk * expected.answers(kind):
                expected.refused()
                return False
            self._ventured = True
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

    def _next_ns(self, option: Option) -> float:
        """Return how long the next frame must not wait, to have time for the choice below this."""
        below = self._next.get(option.number)
        if below is None:
            return 0.0
        own_ns = self._expected[option.number].high_ns(self._kind, NEXT_RISK)
        if own_ns <= self._period_ns:  # no frame has to wait for it
            return 0.0
        return self._expected[below.number].high_ns(self._kind, NEXT_RISK)

    def ended(self, option: Option, state: list[Any]) -> None:
        """Take into account how long the option has taken."""
        has_value = state[option.slot].__class__ not in NO_VALUE
        took_ns = self._clock() - self._begun.pop()
        self._expected[option.number].took(self._kind, took_ns, has_value)

    def end(self) -> None:
        """Allow more or less, by whether the frame was on time.

        A late frame in which nothing was begun that might not have been, and that did not wait
        behind a late one in which something was, would have been late in any case.
        """
        late = self._clock() > self.due_ns
        self._blamed = late and (self._ventured or self._blamed)
        risk = self.allowed_risk + PACE * (LATE_SHARE - self._blamed)
        self.allowed_risk = min(max(risk, 0.0), MOST_RISK)


def nearest(known: Mapping[int, Known], kind: int) -> Known | None:
    """Return what is known of a kind, or of the one most similar to it; None where nothing is."""
    found = known.get(kind)
    if found is None and known:
        return known[min(known, key=lambda other: abs(other - kind))]
    return found


def kind_of(frame: Frame) -> int:
    """Return a number that frames of about as large a footprint share: how much is loaded."""
    values = frame.image.values
    high = np.count_nonzero(values > 0.5 * (values.max() + values.min()))
    return int(4 * log2(high + 1))
