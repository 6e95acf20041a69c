"""How frames may be divided, by what the steps of a pipeline remember."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

import numpy as np
import pytest

from helpers_graphs import registry
from tactile_graph import Degenerate, Frame, Image, Skip, loads
from tactile_graph.many.division import Division, Settling, division_of
from tactile_graph.many.feed import ranges_of
from tactile_graph.many.portion import Portion
from tactile_graph.many.reading import Reader
from tactile_graph.steps.ranges import Ranges

PLAIN = """
pipeline: plain
about: without state
nodes: {footprint: {step: threshold, in: frame, with: {level_v: 0.01}}}
outputs: [footprint]
"""
MEANS = """
pipeline: means
about: the mean of some readings
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  features: {step: features, in: {image: frame, mask: footprint}}
  mean: {step: mean_reading, in: features, with: {readings: 3}}
outputs: [mean]
"""
TARED = """
pipeline: tared
about: without what lies there at first
nodes: {tared: {step: tare, in: frame}}
outputs: [tared]
"""


def none(low: int, high: int) -> Iterator[Frame]:
    return iter(())


ONE, TWO = Ranges((10,), none), Ranges((4, 6), none)


def division(text: str, ranges: Ranges | None) -> Division:
    return division_of(loads(text).runner().plan, ranges)


def test_without_state_frames_go_anywhere() -> None:
    assert division(PLAIN, None) == Division({})
    assert division(PLAIN, TWO) == Division({})


def test_state_that_ends_is_made_anew_from_the_frames_before() -> None:
    assert division(MEANS, ONE) == Division({"mean": 3})
    assert division(MEANS, TWO) == Division({"mean": 3})


def test_other_state_goes_by_recording() -> None:
    assert division(TARED, TWO) == Division({}, by_recording=True)
    assert "tared keeps state" in division(TARED, ONE).why_not


def test_frames_that_come_in_one_row_only_leave_state_whole() -> None:
    assert "convert them to .zarr" in division(MEANS, None).why_not


def test_a_source_without_ranges_has_none() -> None:
    assert ranges_of(None) is None
    assert ranges_of(loads(PLAIN + "source: {step: sample}").source) is None


def test_state_is_settled_when_a_step_ran_as_often_as_it_remembers() -> None:
    pipeline = loads(
        MEANS.replace("in: features, with", "in: features, when: frame.label == 'yes', with")
    )
    runner, settling = pipeline.runner(), Settling({"mean": 3})
    values = np.zeros((4, 4))
    values[1:3, 1:3] = 1.0
    seen = []
    for label in ("yes", "no", "yes", "no", "yes"):
        settling.add(runner(Frame.of(values, quantity="volt", label=label)))
        seen.append(settling.done)
    assert seen == [False, False, False, False, True]


@pytest.mark.parametrize("n", [0, 1])
def test_who_remembers_nothing_is_settled_at_once(n: int) -> None:
    assert Settling(dict.fromkeys("ab", 0)).done
    assert Settling({}).done


class Lately:
    """The mean of the last three peaks that it answered for."""

    remembers = 3

    def __init__(self) -> None:
        self.peaks: deque[float] = deque(maxlen=3)

    def __call__(self, image: Image) -> float:
        if image.peak < 1.0:
            raise Skip("nothing lies there")
        if image.peak > 8.0:
            raise Degenerate("too much lies there")
        self.peaks.append(image.peak)
        return sum(self.peaks) / len(self.peaks)


@pytest.mark.parametrize("between", [0.5, 9.0], ids=["skipped", "failed"])
def test_frames_without_an_answer_are_not_among_those_remembered(between: float) -> None:
    text = "pipeline: p\nnodes:\n  lately: {step: lately, in: frame}\noutputs: [lately]\n"
    pipeline = loads(text, "p.yaml", registry({"lately": Lately}))
    peaks = [2.0, 3.0, 4.0, 5.0, *[between] * 6, 6.0]

    def frames(low: int, high: int) -> Iterator[Frame]:
        return (Frame.of(np.full((2, 2), peak), index=i) for i, peak in enumerate(peaks[low:high]))

    *_, alone = pipeline.results(frames(0, len(peaks)), pipeline.runner())
    reader = Reader(Ranges((len(peaks),), frames), {"lately": 3})
    run = reader.settled(Portion(len(peaks) - 1, len(peaks)), pipeline.runner)
    (last,) = frames(len(peaks) - 1, len(peaks))
    assert run(last)["lately"] == alone["lately"] == 5.0
