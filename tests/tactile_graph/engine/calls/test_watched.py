"""A step that gets round what is read-only is found, and others get their answers all the same."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pytest

from tactile_graph import Frame, Image, Polygon
from tactile_graph.engine.calls.watched import Kept, arrays_in, watched
from tactile_graph.errors import PluginError


class Pair(NamedTuple):
    one: object
    other: object


@dataclass(frozen=True, slots=True)
class Record:
    image: Image
    more: tuple[object, ...] = ()


def image(value: float = 1.0) -> Image:
    return Frame.of(np.full((2, 3), value)).image


def test_arrays_are_found_wherever_they_are_held() -> None:
    polygon = Polygon(np.zeros((3, 2)))
    value = Pair([Record(image(), ({"a": np.ones(2)},))], Frame.of(np.ones((2, 2))))
    assert len(list(arrays_in((value, value, polygon, 7, "text")))) == 4


def test_what_was_written_into_is_told_by_name_and_put_back() -> None:
    given = {"image": image(), "other": image(2.0)}
    kept = Kept(given)
    assert kept.changed() == []
    values = given["other"].values
    values.setflags(write=True)
    values[0, 0] = np.nan
    assert kept.changed() == ["other"]
    np.testing.assert_array_equal(values, np.full((2, 3), 2.0))
    assert kept.changed() == []


def test_a_step_that_writes_into_its_input_fails() -> None:
    def clipped(image: Image) -> Image:
        image.values.setflags(write=True)
        image.values[image.values > 0.5] = 0.5
        return image

    given = image()
    step = watched(clipped, "step clipped of mine")
    told = "step clipped of mine writes into input 1, which others read: change a copy"
    with pytest.raises(PluginError, match=told):
        step(given)
    with pytest.raises(PluginError, match="writes into image, which"):
        step(image=given)
    assert (given.values == 1.0).all()


@dataclass
class Found:
    peaks: list[float]
    total: float = 0.0
    _known: dict[str, float] = field(default_factory=dict)


@dataclass
class Number:
    n: int = 0

    def __copy__(self) -> Number:
        raise TypeError("there is one of it")


@pytest.mark.parametrize(
    "write",
    [
        lambda found, table: found.peaks.sort(),
        lambda found, table: setattr(found, "total", 99.0),
        lambda found, table: table.pop("a"),
        lambda found, table: table["in"][0].add(3),
    ],
)
def test_a_step_that_writes_into_a_list_dict_set_or_record_fails(write: Any) -> None:
    def step(found: Found, table: dict[str, Any]) -> float:
        found._known["asked"] = 1.0  # what it keeps for itself
        write(found, table)
        return 1.0

    found, table = Found([3.0, 1.0]), {"a": 1.0, "in": ({1, 2},)}
    with pytest.raises(PluginError, match=r"writes into (found|table), which others read"):
        watched(step, "step mine")(found=found, table=table)
    assert (found.peaks, found.total, table) == ([3.0, 1.0], 0.0, {"a": 1.0, "in": ({1, 2},)})


def test_a_step_may_go_on_with_the_list_it_gave_but_not_with_the_record() -> None:
    peaks, number = [1.0], Number()

    def listed() -> list[float]:
        peaks.append(1.0)
        return peaks

    def counted() -> Number:
        number.n += 1
        return number

    step = watched(listed, "step listed")
    assert [len(step()), len(step())] == [2, 3]
    step = watched(counted, "step counted")
    step()
    with pytest.raises(PluginError, match="step counted writes into what it gave before"):
        step()


def test_a_step_that_writes_into_what_it_gave_before_fails() -> None:
    mean = np.zeros((2, 3))

    def smoothed(image: Image) -> Image:
        mean.setflags(write=True)
        mean[:] = 0.5 * (mean + image.values)
        return image.with_values(mean)

    step = watched(smoothed, "step smoothed of mine")
    first = step(image())
    with pytest.raises(PluginError, match="step smoothed of mine writes into what it gave before"):
        step(image(3.0))
    assert (first.values == 0.5).all()


def test_after_that_it_gives_nothing_more_for_its_state_is_not_what_it_made_of_it() -> None:
    number = Number()

    def counted() -> Number:
        number.n += 1
        return number

    step = watched(counted, "step counted")
    assert step().n == 1
    for _ in range(3):
        with pytest.raises(PluginError, match="step counted writes into what it gave before"):
            step()


def test_a_step_that_hands_on_what_it_got_may_get_the_same_array_filled_anew() -> None:
    step = watched(lambda image: image, "step same of mine")
    values = np.ones((2, 3))
    buffer = Image(values, (1.0, 1.0), (0.0, 0.0), "raw")
    for value in (1.0, 2.0):
        values.setflags(write=True)
        values[:] = value
        assert step(buffer) is buffer
