"""What checks are made of: numbers that are none, answers that are the same, calls that end."""

from __future__ import annotations

import math
import re
import threading
import time
from typing import Any, NamedTuple

import numpy as np
import pytest

from tactile_graph import Circle, Image, Mask, Points
from tactile_graph.draw.display import Outline
from tactile_graph.errors import Degenerate
from tactile_graph.testing import trial as trials
from tactile_graph.testing.finite import not_finite
from tactile_graph.testing.same import same
from tactile_graph.testing.shown import unshown
from tactile_graph.testing.trial import attempt
from tactile_graph.wires.measure import Measure


class Pair(NamedTuple):
    circle: Circle
    values: Any


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (1.0, ""),
        (math.nan, "the answer is nan"),
        (Pair(Circle(1.0, math.inf, 2.0), 3), "circle.y_cm is inf"),
        (Pair(Circle(1.0, 2.0, 3.0), np.array([1.0, np.nan])), "values holds 1 of 2 numbers"),
        ((1.0, -math.inf), "1 is -inf"),
        ({"a": math.nan}, "a is nan"),
        (Points(np.array([[0.0, np.nan]])), "xy_cm holds 1 of 2"),
        (Image(np.array([[np.inf, 1.0]])), "values holds 1 of 2"),
        (Image(np.array([[np.inf, 1.0]]), valid=np.array([[False, True]])), ""),
        (Mask(np.array([[True]]), (math.inf, 1.0)), "pitch_cm holds 1 of 2"),
        (Image(np.ma.array([[1.0, 2.0]], mask=[[True, False]])), ""),
        (np.ma.array([1.0, np.nan], mask=[False, True]), ""),
        (np.ma.array([1.0, np.nan, 2.0], mask=[True, False, False]), "holds 1 of 2"),
    ],
)
def test_a_number_that_is_none_is_told_by_its_path(value: Any, told: str) -> None:
    found = not_finite(value)
    assert told in found
    assert bool(found) == bool(told)


class Drawn(NamedTuple):
    """Draws what it is told to."""

    records: Any

    def drawing(self) -> Any:
        return self.records


class Measured:
    """Says that it is measured by what it has not, or what is off by itself."""

    x_cm = y_cm = 1.0

    def __init__(self, *measures: Measure) -> None:
        self.length_cm = 2.0
        type(self).error_measures = measures  # type: ignore[attr-defined]


class Shown:
    columns_shown = ("nothing",)


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: Circle(1.0, 2.0, 3.0), ""),
        (lambda: Shown(), "its columns cannot be had: AttributeError: 'Shown' object has no"),
        (lambda: Drawn([3]), "its drawing cannot be had: PluginError: Drawn.drawing() must give"),
        (lambda: Drawn([Outline(np.zeros(4))]), "places have the shape (4,), (places, 2) is"),
        (lambda: Measured(Measure("width_cm")), "its error against the truth cannot be had: Attr"),
        (lambda: [Measured(Measure("length_cm", lambda a, b: 1.0))], "itself is 1, not 0"),
        (lambda: Measured(Measure("length_cm")), ""),
    ],
)
def test_what_an_answer_cannot_show_of_itself_is_told(make: Any, told: str) -> None:
    found = unshown(make())
    assert told in found
    assert bool(found) == bool(told)


def test_the_same_is_of_one_type_and_content() -> None:
    one = Pair(Circle(1.0, 2.0, math.nan), np.arange(3.0))
    assert same(one, Pair(Circle(1.0, 2.0, math.nan), np.arange(3.0)))
    assert not same(one, Pair(Circle(1.0, 2.5, math.nan), np.arange(3.0)))
    assert not same(one, Pair(Circle(1.0, 2.0, math.nan), np.arange(3)))
    assert not same(Image(np.eye(2)), Image(np.eye(2), quantity="volt"))
    assert same([Image(np.eye(2))], [Image(np.eye(2))])
    assert not same({"a": 1}, {"b": 1})


class Bare:
    """A record that does not say when another equals it."""

    def __init__(self, x_cm: float, **more: Any) -> None:
        self.x_cm, self.more = x_cm, more
        self.whole = self


class BareSlots:
    __slots__ = ("_x_cm",)

    def __init__(self, x_cm: float) -> None:
        self._x_cm = x_cm


@pytest.mark.parametrize("kind", [Bare, BareSlots])
def test_records_that_say_nothing_of_equality_are_compared_by_content(kind: Any) -> None:
    assert same(kind(1.0), kind(1.0))
    assert same([kind(math.nan)], [kind(math.nan)])
    assert not same(kind(1.0), kind(2.0))


def test_a_record_with_more_in_it_is_another() -> None:
    assert not same(Bare(1.0, y_cm=np.arange(2)), Bare(1.0, y_cm=np.arange(3)))
    assert same(Bare(1.0, y_cm=np.arange(2)), Bare(1.0, y_cm=np.arange(2)))
    one, other = Bare(1.0), Bare(1.0)
    other.extra = 1.0  # type: ignore[attr-defined]
    assert not same(one, other)
    assert not same(other, one)
    assert not same(lambda: 1, lambda: 2)


def test_a_call_that_takes_too_long_is_stopped() -> None:
    def endless() -> None:
        while True:
            try:
                math.sqrt(2.0)
            except Exception:  # which must not take the stop for an error of its own
                continue

    trial = attempt(endless, {}, 0.05)
    assert trial.late
    assert "was stopped after" in trial.trouble()


@pytest.mark.slow
def test_a_call_that_only_waits_is_stopped_by_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trials, "WAITS_S", 1.2)
    found = attempt(lambda: time.sleep(60.0), {}, 60.0)
    assert found.late
    assert re.fullmatch(
        r"was stopped after 0.0 s of the processor, \d+ s by the clock", found.trouble()
    )


def test_beside_the_main_thread_a_call_is_only_told_to_be_late() -> None:
    ended: list[Any] = []
    thread = threading.Thread(target=lambda: ended.append(attempt(lambda: 1, {}, -1.0)))
    thread.start()
    thread.join()
    assert ended[0].late


def test_warnings_are_no_trouble_and_errors_for_people_neither() -> None:
    assert attempt(lambda: float(np.float64(1e300) ** 2), {}, 1.0).answered

    def refuses() -> None:
        raise Degenerate("nothing is pressed")

    trial = attempt(refuses, {}, 1.0)
    assert (trial.answered, trial.trouble()) == (False, "")
