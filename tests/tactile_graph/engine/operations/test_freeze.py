"""What a step returns is frozen as far as it goes, whatever it is made of."""

from __future__ import annotations

import copy
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from helpers_graphs import frame, registry
from tactile_graph import Image, loads
from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.engine.written import AFTER_FRAMES

if TYPE_CHECKING:
    from decimal import Decimal


@dataclass
class Record:
    array: Any
    inner: Any = None
    never_set: int = field(init=False)


@dataclass(frozen=True)
class Hidden:
    """A record whose annotation only a type checker can read."""

    n: Decimal


def array() -> np.ndarray[Any, Any]:
    return np.zeros(3)


@pytest.mark.parametrize(
    "wrap",
    [
        lambda a: a,
        lambda a: [a],
        lambda a: (1, [a]),
        lambda a: {"x": a},
        lambda a: Record(a),
        lambda a: [Record(1, (a,))],
    ],
    ids=range(6),
)
def test_arrays_become_read_only_wherever_they_are(wrap: Any) -> None:
    a = array()
    freeze(wrap(a))
    with pytest.raises(ValueError, match="read-only"):
        a[0] = 1.0


def test_nothing_is_copied_and_lists_become_tuples() -> None:
    a = array()
    frozen = freeze([a, (1, 2)])
    assert isinstance(frozen, tuple)
    assert frozen[0] is a
    pair = (1, 2)
    assert freeze(pair) is pair


@pytest.mark.parametrize("value", [None, 1, "x", Hidden(3), object(), range(3)])  # type: ignore[arg-type]
def test_what_holds_no_array_is_left_as_it_is(value: Any) -> None:
    assert freeze(value) is value


@dataclass(frozen=True, slots=True)
class Track:
    level: list[float]
    by_name: dict[str, list[float]]


@pytest.mark.parametrize("wrap", [lambda it: it, lambda it: Record(0, it), lambda it: (it,)])
def test_a_list_within_a_record_is_the_results_own(wrap: Any) -> None:
    track = Track([1.0], {"a": [2.0]})
    frozen = freeze(wrap(track))
    got = getattr(frozen, "inner", frozen[0] if isinstance(frozen, tuple) else frozen)
    track.level.append(3.0)
    track.by_name["a"].append(3.0)
    assert got == Track([1.0], {"a": [2.0]})
    assert track.level == [1.0, 3.0]  # the step's own stays as it is


@dataclass(eq=False)
class Node:
    near: list[Any]


@dataclass
class Net:
    nodes: list[Node]
    first: Node


def test_a_record_that_is_named_twice_stays_one() -> None:
    node = Node([1])
    net = freeze(Net([node, Node([2])], node))
    assert net.nodes[0] is net.first
    assert net.nodes[0] is not node
    assert net.nodes[0].near == [1]


def test_a_plain_record_is_copied_by_its_fields_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(copy, "copy", lambda _: pytest.fail("slower by half"))
    node = Node([1])
    assert freeze(node).near == [1]
    assert freeze(node) is not node


class Sealed(Node):
    def __copy__(self) -> Any:
        raise TypeError("not to be copied")


def test_a_record_that_lets_nobody_copy_it_stays_itself() -> None:
    sealed = Sealed([1])
    assert freeze(sealed) is sealed


@dataclass(frozen=True)
class Shut:
    array: Any
    inner: Any = None


def test_a_record_without_a_list_is_not_copied() -> None:
    record = Shut(array(), (1, Shut(array())))
    assert freeze(record) is record


@pytest.mark.parametrize("wrap", [lambda it: it, lambda it: Shut(0, it), lambda it: (it,)])
def test_a_record_whose_fields_can_be_set_is_the_results_own(wrap: Any) -> None:
    record = Record(1.0)
    frozen = freeze(wrap(record))
    got = getattr(frozen, "inner", None) or (frozen[0] if isinstance(frozen, tuple) else frozen)
    record.array = 2.0
    assert got.array == 1.0


def answers(step: Any, n: int = 3) -> list[Any]:
    text = "pipeline: p\nnodes:\n  a: {step: s, in: frame}\noutputs: [a]\n"
    runner = loads(text, "p.yaml", registry({"s": step})).runner()
    return [runner(frame(i)).outcome("a") for i in range(n)]


class History:
    def __init__(self) -> None:
        self.level: list[float] = []

    def __call__(self, image: Image) -> Track:
        self.level.append(float(image.total))
        return Track(self.level, {})


def test_a_state_that_is_handed_out_in_a_record_changes_no_earlier_result() -> None:
    assert [len(got.level) for got in answers(History)] == [1, 2, 3]


@dataclass
class Count:
    n: int = 0


class Counter:
    def __init__(self) -> None:
        self.count = Count()

    def __call__(self, image: Image) -> Count:
        self.count.n += 1
        return self.count


def test_a_record_that_a_step_goes_on_filling_changes_no_earlier_result() -> None:
    assert [got.n for got in answers(Counter)] == [1, 2, 3]


def selfish(image: Image) -> Record:
    record = Record(0)
    record.inner = Record(1, [record])
    return record


@pytest.mark.parametrize(
    "n",
    [
        pytest.param(2, id="called"),
        pytest.param(AFTER_FRAMES + 2, id="written", marks=pytest.mark.slow),
    ],
)
def test_a_record_that_holds_itself_fails_its_node_alone(n: int) -> None:
    for got in answers(selfish, n)[-2:]:
        assert isinstance(got, Failed)
        assert got.origin == "a"
        assert got.reason.startswith("TypeError: what the step returned holds itself, or is nested")
        assert not got.where  # no line of code is to blame


def test_a_record_that_ends_what_it_holds_is_not_copied() -> None:
    @dataclass(eq=False)
    class Handle:
        n: int

        def __del__(self) -> None:
            ended.append(self.n)

    ended: list[int] = []
    handle = Handle(3)
    assert freeze(handle) is handle
    assert not ended
