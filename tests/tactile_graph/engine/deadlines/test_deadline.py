"""Deadlines: what would not be done in time is skipped, and done again in the same way later."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from helpers_graphs import STEPS, frame, registry
from tactile_graph import Frame, Image, Pipeline, loads
from tactile_graph.engine.deadlines.deadline import kind_of, waits_longer
from tactile_graph.engine.outcomes.outcome import Skipped
from tactile_graph.live import Deadline, Recorded
from tactile_graph.steps import TimeGap

MS = 1_000_000


class Time:
    """A clock that only work moves on."""

    def __init__(self) -> None:
        self.now_ns = 0

    def __call__(self) -> int:
        return self.now_ns


TIME = Time()
COSTS: dict[str, Callable[[int], int]] = {}
"""What each step takes, by the frame's number, in nanoseconds."""
RAN: list[str] = []


def work(frame: Frame, *, tag: str) -> int:
    RAN.append(tag)
    TIME.now_ns += COSTS[tag](frame.index)
    return frame.index


def after(a: int, *, tag: str) -> int:
    RAN.append(tag)
    TIME.now_ns += COSTS[tag](a)
    return a


def unsure(frame: Frame, *, tag: str) -> float:
    RAN.append(tag)
    TIME.now_ns += COSTS[tag](frame.index)
    return float(frame.index % 2)


class Followed:
    """Counts its frames and adds up the gaps it is told."""

    def __init__(self, *, tag: str) -> None:
        self.tag, self.n, self.gone_s = tag, 0, 0.0

    def __call__(self, a: int, *, gap: TimeGap) -> tuple[int, float]:
        TIME.now_ns += COSTS[self.tag](a)
        self.n += 1
        self.gone_s += gap or 0.0
        return self.n, self.gone_s


def drawn(image: Image, *, rng: np.random.Generator) -> float:
    return float(rng.random())


OWN = {f.__name__.lower(): f for f in (work, after, unsure, Followed, drawn)}

LADDER = """
pipeline: ladder
nodes:
  shared: {step: work, in: frame, with: {tag: shared}}
  best: {step: after, in: shared, with: {tag: best}}
  middle: {step: after, in: shared, with: {tag: middle}}
  cheap: {step: after, in: shared, with: {tag: cheap}}
  answer: {first_of: [best, middle, cheap]}
outputs: [answer]
"""
TIMES = {"shared": 10_000, "best": MS, "middle": 100_000, "cheap": 20_000}


def pipeline(text: str) -> Pipeline:
    return loads(text, "p.yaml", registry({**STEPS, **OWN}))


def _constant(ns: int, index: int) -> int:
    return ns


@pytest.fixture(autouse=True)
def costs() -> None:
    TIME.now_ns = 0
    RAN.clear()
    COSTS.clear()
    COSTS.update({tag: partial(_constant, ns) for tag, ns in TIMES.items()})


class Timed:
    """Frames of a pipeline with a deadline, each begun when the last is done."""

    def __init__(self, text: str, **rest: Any) -> None:
        self.deadline = Deadline(TIME)
        self.runner = pipeline(text).runner(decider=self.deadline, **rest)
        self.index = -1

    def __call__(self, within_ns: int, number: int = 0) -> Any:
        self.index += 1
        RAN.clear()
        self.deadline.due_ns = TIME.now_ns + within_ns
        return self.runner(frame(number, self.index, self.index * 0.1))


def test_the_best_choice_that_fits_is_taken_and_the_others_are_not_begun() -> None:
    timed = Timed(LADDER)
    for _ in range(3):  # how long they take is not known yet
        timed(10 * MS)
    for within, choice, skipped in (
        (10 * MS, "best", ()),
        (MS // 2, "middle", ("best",)),
        (50_000, "cheap", ("best", "middle")),
    ):
        for _ in range(3):
            result = timed(within)
        assert [*RAN] == ["shared", choice]
        assert result.decisions == skipped
        assert result["answer"] == timed.index


def test_what_is_skipped_says_so() -> None:
    timed = Timed(LADDER)
    timed(10 * MS)
    result = timed(MS // 2)
    outcome = result.outcome("best")
    assert isinstance(outcome, Skipped)
    assert (outcome.origin, outcome.reason) == ("best", "deadline")


def test_the_last_choice_is_taken_however_late_it_is() -> None:
    timed = Timed(LADDER)
    for _ in range(4):
        result = timed(-1)
    assert result.decisions == ("best", "middle")
    assert [*RAN] == ["shared", "cheap"]


def test_a_last_choice_that_is_not_the_quickest_is_skipped_where_it_would_not_fit() -> None:
    text = LADDER.replace("[best, middle, cheap]", "[unsure, best]").replace(
        "  answer:",
        "  doubtful: {step: unsure, in: frame, with: {tag: cheap}}\n"
        "  unsure: {first_of: [shared], when: doubtful > 0}\n  answer:",
    )
    timed = Timed(text)
    for _ in range(4):
        assert not timed(10 * MS).decisions
    results = [timed(MS // 2) for _ in range(2)]
    assert [r.decisions for r in results] == [("best",), ()]  # even frames want the long way
    assert "answer" not in results[0]
    assert results[0].outcome("answer").origin == "best"


def test_time_is_kept_for_what_comes_in_any_case() -> None:
    """What follows the ladder and is itself spared must still fit behind the choice."""
    text = LADDER.replace(
        "outputs: [answer]",
        "  longest: {step: after, in: shared, with: {tag: longest}}\n"
        "  long: {step: after, in: shared, with: {tag: long}}\n"
        "  last: {first_of: [longest, long]}\noutputs: [answer, last]",
    )
    COSTS["longest"], COSTS["long"] = (lambda _: 7 * MS), (lambda _: 5 * MS)
    timed = Timed(text)
    timed(100 * MS)
    timed(-1)
    result = timed(59 * MS // 10)  # of which 5 ms are kept for `long`
    assert result.decisions == ("best", "longest")
    assert [*RAN] == ["shared", "middle", "long"]


def test_one_that_takes_its_place_knows_the_times_of_what_computes_the_same() -> None:
    """After a change nothing is tried anew that is still there, under whatever name."""
    timed = Timed(LADDER)
    for _ in range(3):
        timed(10 * MS)
    changed = LADDER.replace("best", "finest", 1).replace("[best,", "[finest,")
    changed = changed.replace("with: {tag: middle}", "with: {tag: other}")
    COSTS["other"] = COSTS["middle"]
    RAN.clear()
    before = timed.deadline
    timed.deadline = Deadline(TIME, before)
    timed.runner = pipeline(changed).runner(decider=timed.deadline, after=timed.runner)
    assert timed.deadline.allowed_risk == before.allowed_risk
    result = timed(MS // 2)
    assert result.decisions == ("finest",)  # 1 ms, as is known; the other is tried
    assert [*RAN] == ["shared", "other"]
    forgetful = Timed(changed)
    assert forgetful(MS // 2).decisions == ()


def test_where_a_choice_needs_more_than_before_its_time_is_found_out_anew() -> None:
    """What was shared with all frames is now run by the choice alone."""
    shared = LADDER.replace("outputs: [answer]", "outputs: [answer, shared]")
    alone = LADDER.replace("cheap: {step: after, in: shared", "cheap: {step: work, in: frame")
    timed = Timed(shared.replace("[best, middle, cheap]", "[best, cheap]"))
    for _ in range(3):
        timed(10 * MS)
    after = Deadline(TIME, timed.deadline)
    text = alone.replace("[best, middle, cheap]", "[best, cheap]")
    pipeline(text).runner(decider=after, after=timed.runner)
    assert len(after._works) == 2
    assert [e.usual(0) for e in after._expected] == [None, None]


def test_equal_choices_of_two_ladders_do_not_share_their_times_by_mistake() -> None:
    text = LADDER.replace(
        "outputs: [answer]",
        "  again: {step: after, in: shared, with: {tag: best}}\n"
        "  twice: {first_of: [again, cheap]}\noutputs: [answer, twice]",
    )
    timed = Timed(text)
    timed(100 * MS)
    after = Deadline(TIME, timed.deadline)
    pipeline(text).runner(decider=after, after=timed.runner)
    assert after._expected == timed.deadline._expected
    assert len({id(e) for e in after._expected}) == len(after._expected)


def test_a_node_outside_ladders_that_would_not_fit_is_skipped_and_what_needs_it() -> None:
    COSTS["slow"] = lambda _: 5 * MS
    timed = Timed(
        """
pipeline: plain
nodes:
  first: {step: work, in: frame, with: {tag: shared}}
  slow: {step: after, in: first, with: {tag: slow}}
  needs: {step: after, in: slow, with: {tag: cheap}}
outputs: [first, needs]
"""
    )
    timed(10 * MS)
    result = timed(MS)
    assert result.decisions == ("slow",)
    assert list(result) == ["first"]
    assert result.outcome("needs").origin == "slow"


def test_a_refused_choice_is_tried_again_in_the_end() -> None:
    """One slow spell must not shut a choice out for ever: nobody times what is refused."""
    COSTS["best"] = lambda i: 50 * MS if i < 5 else MS
    timed = Timed(LADDER)
    taken = [not timed(3 * MS).decisions for _ in range(400)]
    assert not any(taken[6:20])
    assert all(taken[-20:])


def test_a_long_first_time_on_one_kind_of_frame_is_forgotten_among_others() -> None:
    """What is loaded for the first frame must not shut out all that are like it."""
    small, large = np.zeros((4, 4)), np.ones((4, 4))
    small[0, 0], large[0, 0] = 1.0, 0.0
    COSTS["best"] = lambda i: 50 * MS if i == 0 else MS
    deadline = Deadline(TIME)
    runner = pipeline(LADDER).runner(decider=deadline)
    taken = []
    for index in range(2000):
        deadline.due_ns = TIME.now_ns + 3 * MS
        seen = runner(Frame.of(large if index % 4 else small, 1.0, index=index))
        taken.append(not seen.decisions)
    assert not any(taken[1:20])
    assert all(taken[-40:])


def test_frames_that_have_waited_leave_room_for_what_one_falls_back_on() -> None:
    """Though the better choice would still be done in time."""
    timed = Timed(LADDER)
    for _ in range(3):
        timed(20 * MS)
    first_that_waits_too_long = None
    for waited in range(1, 16):
        timed.deadline.arrived_ns = TIME.now_ns - waited * MS
        if timed((20 - waited) * MS).decisions:
            first_that_waits_too_long = waited
            break
    took, least = TIMES["best"] + TIMES["shared"], TIMES["cheap"]
    room_ms = (20 * MS - took - least) / MS
    assert first_that_waits_too_long == pytest.approx(0.6 * room_ms, abs=1.5)


@pytest.mark.parametrize(("beneath", "share"), [(0, 1.0), (1, 0.6), (2, 0.2), (9, 0.2)])
def test_each_choice_further_up_leaves_more_room(beneath: int, share: float) -> None:
    assert 1.0 / (1.0 + waits_longer(beneath)) == pytest.approx(share)


@pytest.mark.slow
def test_a_stream_too_fast_for_the_best_choice_is_on_time_all_the_same() -> None:
    """A frame each 1 ms; 1.3 ms for the best choice, one time in a hundred three times that."""
    rng = np.random.default_rng(5)
    times = (1.3 * MS * rng.lognormal(0.0, 0.47, 6000)).astype(int).tolist()
    COSTS["best"] = lambda i: times[i]
    COSTS["middle"] = lambda i: MS // 20
    timed, late, best = Timed(LADDER), 0, 0
    begun_ns = TIME.now_ns
    for i in range(len(times)):
        arrived_ns = begun_ns + i * MS
        TIME.now_ns = max(TIME.now_ns, arrived_ns)
        timed.deadline.arrived_ns = arrived_ns
        result = timed(arrived_ns + 10 * MS - TIME.now_ns)
        late += TIME.now_ns > timed.deadline.due_ns
        best += not result.decisions
    assert late <= 6
    assert best / len(times) > 0.5


def test_a_frame_of_noise_is_of_another_kind_than_a_large_object() -> None:
    """Times on one say nothing of the other, though as many cells read high."""
    rng = np.random.default_rng(1)
    noise = rng.normal(0.0, 0.002, (16, 16))
    large = np.where(noise > 0.0, 1.0, 0.0)
    n_high = [int((v > 0.5 * (v.min() + v.max())).sum()) for v in (noise, large)]
    assert 0.3 < n_high[0] / n_high[1] < 3.0
    kinds = [kind_of(Frame.of(v, 1.0)) for v in (noise, large, 1.5 * large)]
    assert abs(kinds[0] - kinds[1]) > 64
    assert kinds[1] == kinds[2]


def test_a_missing_cell_leaves_a_frame_its_kind() -> None:
    values = np.zeros((16, 16))
    values[4:9, 4:9] = 1.0
    missing = values.copy()
    missing[0, 0] = np.nan
    assert kind_of(Frame.of(missing, 1.0)) == kind_of(Frame.of(values, 1.0))


@pytest.mark.parametrize("fill", [0.0, 3.0, np.nan, np.inf])
def test_a_frame_of_one_value_or_of_none_has_a_kind(fill: float) -> None:
    assert isinstance(kind_of(Frame.of(np.full((4, 4), fill), 1.0)), int)


@pytest.mark.slow
def test_in_the_long_run_no_more_than_the_promised_share_is_late() -> None:
    """Times nobody can predict, heavy in the tail, beside a deadline that some exceed."""
    rng = np.random.default_rng(3)
    times = np.minimum(rng.lognormal(np.log(MS), 0.5, 20_000), 20 * MS).astype(int).tolist()
    COSTS["best"] = lambda i: times[i]
    timed = Timed(LADDER)
    late = n_best = 0
    for _ in times:
        result = timed(4 * MS)
        late += timed.deadline.due_ns < TIME.now_ns
        n_best += not result.decisions
    assert late / len(times) < 0.0025
    assert n_best / len(times) > 0.3


STATEFUL = """
pipeline: states
nodes:
  number: {step: work, in: frame, with: {tag: shared}}
  follow: {step: followed, in: number, with: {tag: best}}
  noise: {step: drawn, in: frame}
  plain: {step: after, in: number, with: {tag: cheap}}
  answer: {first_of: [follow, plain]}
outputs: [answer, noise]
"""


def test_a_state_that_was_skipped_is_kept_and_told_the_true_gap() -> None:
    timed = Timed(STATEFUL)
    values = [timed(w * MS).get("answer") for w in (9, 9, 0, 0, 9)]
    assert values[1] == (2, pytest.approx(0.1))
    assert values[2:4] == [2, 3]  # the number itself: the plain choice
    assert values[4] == (3, pytest.approx(0.4))


@pytest.mark.slow
def test_what_was_decided_gives_the_same_again_bit_for_bit() -> None:
    rng = np.random.default_rng(1)
    times = rng.lognormal(np.log(MS), 1.0, 300).astype(int).tolist()
    COSTS["best"] = lambda i: times[i]
    timed = Timed(STATEFUL, seed=4)
    results = [timed(2 * MS, i % 7) for i in range(300)]
    decisions = [r.decisions for r in results]
    assert 10 < sum(map(bool, decisions)) < 290
    recorded = Recorded()
    again = pipeline(STATEFUL).runner(seed=4, decider=recorded)
    for i, result in enumerate(results):
        recorded.skipped = decisions[i]
        other = again(frame(i % 7, i, i * 0.1))
        assert other.outputs == result.outputs
        assert other.decisions == result.decisions
        assert repr(other.outcomes) == repr(result.outcomes)


def test_an_equal_frame_is_computed_again_where_the_last_had_to_do_with_less() -> None:
    text = """
pipeline: still
nodes:
  best: {step: drawn_from, in: frame}
  cheap: {step: read, in: frame}
  answer: {first_of: [best, cheap]}
outputs: [answer]
"""

    def drawn_from(image: Image) -> float:
        TIME.now_ns += MS
        return 0.5

    deadline = Deadline(TIME)
    still = loads(text, "p.yaml", registry({**STEPS, "drawn_from": drawn_from}))
    runner = still.runner(decider=deadline)
    values = []
    for index, within in enumerate((9, 0, 0, 9, 9)):
        deadline.due_ns = TIME.now_ns + within * MS
        result = runner(frame(3 if index else 4, index))
        values.append((result["answer"], result.reused))
    assert values == [(0.5, False), (3, False), (3, False), (0.5, False), (0.5, True)]
