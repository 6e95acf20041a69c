"""Settings of any class: equal as plain data, and so in keys, only where they hold the same."""

from __future__ import annotations

import re
from collections import OrderedDict, defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field, make_dataclass
from datetime import UTC, date, datetime, time, timedelta, timezone
from decimal import Decimal
from enum import Enum
from fractions import Fraction
from functools import cached_property, partial
from itertools import count
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from pydantic import BaseModel, Field, PrivateAttr

from helpers_graphs import registry
from tactile_graph import Image, loads
from tactile_graph.pipeline import by_value
from tactile_graph.pipeline.graph import node_key
from tactile_graph.pipeline.plain import plain


@dataclass(frozen=True)
class Gain:
    by: Any = field(default=1.0, repr=False)


@dataclass(frozen=True)
class Other:
    by: Any = field(default=1.0, repr=False)


@dataclass
class Spelled:
    by: Any
    name: str = "usual"


@dataclass(frozen=True)
class Quiet:
    by: Any

    def __repr__(self) -> str:
        return "Quiet"


class Model(BaseModel):
    by: float = Field(default=1.0, repr=False)
    _kept: int = PrivateAttr(default=0)


class Pair(NamedTuple):
    one: Any
    other: int = 2

    def __repr__(self) -> str:
        return "Pair"


class Colour(Enum):
    RED = 1
    BLUE = 2

    def __str__(self) -> str:
        return "colour"

    __repr__ = __str__


class Mute:
    def __init__(self, by: Any) -> None:
        self.by = by

    def __repr__(self) -> str:
        return "mute"

    @cached_property
    def worked_out(self) -> float:
        return 2.0


class Slotted:
    __slots__ = ("by",)

    def __init__(self, by: Any) -> None:
        self.by = by

    def __str__(self) -> str:
        return "slotted"


class Unsendable(Mute):
    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError("stays here")


def longer(by: float) -> Any:
    values = np.zeros(2000)
    values[1000] = by
    return values


def scaled(by: float) -> Callable[[float], float]:
    return lambda value: value * by


def noisy(image: Image, *, gain: Gain) -> float:
    return image.peak * float(gain.by)


PAIRS = {
    "left out of its text": (Gain(1.0), Gain(7.0)),
    "of two classes": (Gain(1.0), Other(1.0)),
    "nested": (Spelled(Gain(1.0)), Spelled(Gain(7.0))),
    "in a list": ([Gain(1.0)], [Gain(7.0)]),
    "in a mapping": ({"a": Spelled([Gain(1.0)])}, {"a": Spelled([Gain(7.0)])}),
    "its own text": (Quiet(1.0), Quiet(7.0)),
    "long array in a record": (Spelled(longer(1.0)), Spelled(longer(7.0))),
    "close numbers in a record": (Spelled(np.array([1.0])), Spelled(np.array([1.0 + 1e-12]))),
    "array": (np.array([1.0]), np.array([7.0])),
    "array of another type": (np.array([1, 2], np.uint8), np.array([1, 2])),
    "empty array": (np.zeros((0, 2)), np.zeros((0,))),
    "array of objects": (np.array([Gain(1.0)]), np.array([Gain(7.0)])),
    "masked array": (np.ma.array([1.0], mask=[True]), np.ma.array([1.0], mask=[False])),
    "model": (Model(by=1.0), Model(by=7.0)),
    "named tuple in a record": (Spelled(Pair(1)), Spelled(Pair(7))),
    "named tuple": (Pair(Gain(1.0)), Pair(Gain(7.0))),
    "enum": (Colour.RED, Colour.BLUE),
    "enum in a record": (Spelled(Colour.RED), Spelled(Colour.BLUE)),
    "set": ({Gain(1.0)}, {Gain(7.0)}),
    "frozen set in a record": (Spelled(frozenset({Gain(1.0)})), Spelled(frozenset({Gain(7.0)}))),
    "object": (Mute(1.0), Mute(7.0)),
    "object with slots": (Slotted(1.0), Slotted(7.0)),
    "object that is not to be pickled": (Unsendable(1.0), Unsendable(7.0)),
    "partial": (partial(noisy, gain=Gain(1.0)), partial(noisy, gain=Gain(7.0))),
    "closure": (scaled(1.0), scaled(7.0)),
    "function": (longer, scaled),
    "pattern": (re.compile("a" * 300 + "b"), re.compile("a" * 300 + "c")),
    "path": (Path("a"), Path("b")),
    "bytes": (b"a", b"b"),
    "decimal": (Decimal("1.0"), Decimal("1.00")),
    "fraction": (Fraction(1, 3), Fraction(1, 7)),
    "time of a zone": (
        datetime(2024, 1, 1, tzinfo=ZoneInfo("UTC")),
        datetime(2024, 1, 1, tzinfo=ZoneInfo("Etc/GMT")),
    ),
    "second hour of the same name": (time(2, 30), time(2, 30, fold=1)),
    "duration": (timedelta(microseconds=1), timedelta(microseconds=2)),
    "ordered": (Spelled(OrderedDict(a=1)), Spelled(OrderedDict(a=7))),
    "mapping that is only read": (
        Spelled(MappingProxyType({"a": Gain(1.0)})),
        Spelled(MappingProxyType({"a": Gain(7.0)})),
    ),
    "method": (Decimal(1).is_nan, Decimal(7).is_nan),
    "keys of one text": ({1: "a", "1": "b"}, {1: "c", "1": "b"}),
}


@pytest.mark.parametrize(("one", "other"), PAIRS.values(), ids=PAIRS)
def test_what_differs_is_told_apart(one: Any, other: Any) -> None:
    assert node_key(plain(one)) != node_key(plain(other))
    assert node_key(plain(one)) == node_key(plain(one))


@pytest.mark.parametrize(
    "made",
    [
        lambda: Gain(1.0), lambda: Spelled(longer(7.0)), lambda: Model(by=1.0), lambda: Mute([1.0]),
        lambda: Slotted(1.0), lambda: partial(noisy, gain=Gain(1.0)), lambda: {Gain(1.0), Gain(2)},
        lambda: datetime(2024, 1, 1, tzinfo=ZoneInfo("UTC")), lambda: re.compile("a" * 300),
        lambda: np.ma.array([1.0], mask=[True]), lambda: Spelled(MappingProxyType({"a": 1})),
    ],
)  # fmt: skip
def test_what_holds_the_same_is_equal_whoever_made_it(made: Callable[[], Any]) -> None:
    assert plain(made()) == plain(made())


def test_what_was_given_and_what_was_worked_out_changes_nothing() -> None:
    assert plain(Model()) == plain(Model(by=1.0))
    one = Mute(1.0)
    before = plain(one)
    assert one.worked_out == 2.0
    assert plain(one) == before


@pytest.mark.parametrize(
    "value",
    [
        Spelled(1.0), Spelled([1, ("a",), {"b": None}, b"c"]), Spelled(Path("a/b")),
        Spelled(Spelled(True), "own"), Spelled(frozenset({1})), Spelled(set()),
        Spelled(Decimal("1.5")), Spelled(datetime(2024, 1, 1)), Spelled(np.float32(0.1)),
        make_dataclass("Empty", [])(), Path("a/b"), b"a", Decimal("1.50"), date(2024, 1, 1),
        datetime(2024, 1, 1, 12), time(3), timedelta(1), Fraction(1, 3), 1j,
    ],
)  # fmt: skip
def test_a_text_that_tells_all_is_the_one_that_python_gives(value: Any) -> None:
    """The key of a node seeds its random numbers: these stay those of earlier versions."""
    assert plain(value) == str(value)


def test_numbers_and_lists_stay_as_they_are() -> None:
    given = {"a": (1, 2.5, "x", None, True), "b": np.array([[1.0], [2.0]]), 3: {2, 1}}
    assert plain(given) == {"a": [1, 2.5, "x", None, True], "b": [[1.0], [2.0]], "3": [1, 2]}


def test_a_fixed_offset_and_what_holds_itself_have_a_text() -> None:
    east = datetime(2024, 1, 1, tzinfo=timezone(timedelta(hours=1)))
    assert plain(east) != plain(east.replace(tzinfo=UTC))
    loop = Mute(None)
    loop.by = loop
    assert plain(loop) == plain(loop) != plain(Mute(None))


def test_nodes_whose_settings_differ_in_what_no_text_shows_have_keys_of_their_own() -> None:
    node = "{{step: noisy, in: frame, with: {{gain: {{by: {}}}}}}}"
    text = f"pipeline: p\nnodes:\n  n: {node}\noutputs: [n]"
    one, other = (loads(text.format(by), "p.yaml", registry({"noisy": noisy})) for by in (1.0, 7.0))
    assert one.nodes["n"].key != other.nodes["n"].key
    assert one.resolved() != other.resolved()


def test_numbers_of_numpy_as_keys_are_told_as_the_ones_they_are_equal_to() -> None:
    given = {np.int64(3): 1, np.float64(0.5): 2, np.str_("a"): 3}
    assert repr(plain(given)) == "{'3': 1, '0.5': 2, 'a': 3}"


@pytest.mark.parametrize("made", [lambda: Unsendable(1.0), lambda: scaled(1.0)])
def test_what_cannot_be_looked_into_is_told_alike_in_the_next_run(
    made: Callable[[], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The key of a node seeds its random numbers: with the same seed they are drawn again."""
    runs = []
    for _ in range(2):
        monkeypatch.setattr(by_value, "_untold", {})
        monkeypatch.setattr(by_value, "_numbers", defaultdict(count))
        runs.append([plain(Mute(made())) for _ in range(2)])
    assert runs[0] == runs[1]
    assert len({*runs[0]}) == 2
