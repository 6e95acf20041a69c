"""Fields of nodes on wires and in guards: read once a frame, by whoever comes first, or not."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import pytest

from helpers_graphs import STEPS, frame, registry
from tactile_graph import Frame, Image, loads
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.pipeline.wiring import Ref

READ: list[str] = []


class Record:
    """Its fields note that they are read."""

    def __init__(self, n: int) -> None:
        self._n = n

    @property
    def n(self) -> int:
        READ.append("n")
        return self._n

    @property
    def sign(self) -> int | None:
        READ.append("sign")
        return None if self._n == 0 else 1 if self._n > 0 else -1

    @property
    def inverse(self) -> float:
        READ.append("inverse")
        return 1 / self._n


def record(image: Image) -> Record:
    return Record(int(image.values[0, 0]))


def number(frame: Frame) -> int:
    return frame.index


def make(nodes: str, outputs: str) -> Any:
    body = "\n".join(f"  {line.strip()}" for line in nodes.strip().splitlines())
    text = f"pipeline: p\nnodes:\n{body}\noutputs: [{outputs}]\n"
    return loads(text, "p.yaml", registry({**STEPS, "record": record, "number": number}))


def run(nodes: str, outputs: str, n: float) -> Any:
    READ.clear()
    return make(nodes, outputs).run(frame(n))


R = "r: {step: record, in: frame}"
C = "c: {step: constant, with: {value: 7}}"


@pytest.mark.parametrize(
    ("nodes", "outputs"),
    [
        (f"{R}\n{C}\nx: {{step: add1, in: c, when: r.n > 0}}", "x"),
        (f"{R}\n{C}\nx: {{step: add1, in: c, when: r.n > 0}}", "x, r.n"),
        (f"{R}\nx: {{step: add1, in: r.n, when: r.n > 0}}", "x"),
        (
            f"""{R}
            x: {{step: add1, in: r.n, when: r.n > 0}}
            y: {{step: add1, in: x, when: r.n > 1}}
            z: {{step: add2, in: [y, r.n], when: r.n > 2}}""",
            "x, y, z",
        ),
        (
            f"""{R}
            {C}
            u: {{step: add1, in: c, when: r.n > 0}}
            v: {{step: add1, in: c, when: r.n > 1}}
            w: {{step: add2, in: [u, v], when: c > 0}}
            x: {{step: add2, in: [w, r.n]}}""",
            "x",
        ),
        (
            f"""{R}
            {C}
            a: {{step: add1, in: c, when: r.n > 9}}
            b: {{step: add1, in: r.n, when: r.n > 0}}
            x: {{first_of: [a, b, r.n]}}""",
            "x",
        ),
    ],
    ids=["one guard", "asked for too", "its port too", "a chain", "two branches", "choices"],
)
def test_a_field_is_read_once_a_frame_however_many_read_it(nodes: str, outputs: str) -> None:
    result = run(nodes, outputs, 4)
    assert result.ok
    assert READ == ["n"]


def test_a_field_is_not_read_where_nothing_needs_it() -> None:
    nodes = f"""{R}
    {C}
    a: {{step: add1, in: c, when: r.n > 0}}
    b: {{step: add1, in: a, when: r.sign > 0}}
    x: {{first_of: [a, b]}}"""
    run(nodes, "x", 4)
    assert READ == ["n"]


def test_fields_of_a_guard_are_all_read_before_it_is_judged() -> None:
    result = run(f"{R}\n{C}\nx: {{step: add1, in: c, when: r.n > 9 and r.inverse > 0}}", "x", 0)
    assert READ == ["n", "inverse"]
    failed = result.outcome("x")
    assert (failed.origin, failed.reason) == (
        "r.inverse",
        "ZeroDivisionError: division by zero",
    )


def test_a_field_that_fails_fails_every_guard_on_it_and_is_reported_once() -> None:
    nodes = f"""{R}
    {C}
    x: {{step: add1, in: c, when: r.inverse > 0}}
    y: {{step: add1, in: c, when: r.inverse < 0}}"""
    result = run(nodes, "x, y", 0)
    assert READ == ["inverse"]
    assert isinstance(result.outcome("x"), Failed)
    assert result.outcome("x") is result.outcome("y")
    assert [f.origin for f in result.failures] == ["r.inverse"]


def test_what_only_a_guard_read_can_be_looked_up() -> None:
    nodes = f"{R}\n{C}\nx: {{step: add1, in: c, when: r.sign > 0}}"
    ref = Ref("r", ("sign",))
    assert run(nodes, "x", 4).outcome_at(ref) == 1
    assert run(nodes, "x", -4).outcome("x").reason == "when r.sign > 0 is false (r.sign = -1)"
    unknown = run(nodes, "x", 0)
    assert isinstance(unknown.outcome_at(ref), Skipped)
    assert unknown.outcome("x") is unknown.outcome_at(ref)


def test_the_image_of_a_frame_is_there_whoever_reads_it_or_nobody() -> None:
    nodes = f"""i: {{step: number, in: frame}}
    {R}
    x: {{step: add1, in: i, when: frame.image.peak > 2}}"""
    p = make(nodes, "x, i")
    one = frame(3, index=5)
    assert p.run(one).outputs == {"x": 6, "i": 5}
    assert p.run(frame(1, index=5)).outputs == {"i": 5}
    assert p.run(one, only=["i"]).outputs == {"i": 5}
    asked = p.run(one, only=["frame.image", "r"])
    assert asked["frame.image"] is one.image
    assert asked["r"].n == 3


# -- fields of the items of a list -----------------------------------------------------------------


class Part(Record):
    provides: ClassVar[Mapping[type, str]] = {float: "inverse"}


class Sided(Record):
    provides: ClassVar[Mapping[type, str]] = {float: "sign"}


def parts(image: Image) -> list[Part]:
    return [Part(n) for n in (2, 0, 4)]


def sided(image: Image) -> list[Sided]:
    return [Sided(n) for n in (2, 0, -4)]


def doubled(x: float) -> float:
    return 2 * x


def each_of(step: str) -> Any:
    nodes = f"{{p: {{step: {step}, in: frame}}, d: {{step: doubled, in: p, each: true}}}}"
    steps = {"parts": parts, "sided": sided, "doubled": doubled}
    return loads(f"{{pipeline: p, nodes: {nodes}, outputs: [p, d]}}", "p", registry(steps))


def test_an_item_whose_field_cannot_be_had_fails_in_its_place() -> None:
    result = each_of("parts").run(frame(1))
    first, failed, last = result["d"]
    assert (first, last) == (1.0, 0.5)
    assert isinstance(failed, Failed)
    assert (failed.item, failed.reason) == ((1,), "ZeroDivisionError: division by zero")
    assert [type(p) for p in result["p"]] == [Part] * 3


def test_an_item_whose_field_is_not_known_is_skipped_in_its_place() -> None:
    first, skipped, last = each_of("sided").run(frame(1))["d"]
    assert (first, last) == (2, -2)
    assert isinstance(skipped, Skipped)
    assert (skipped.item, skipped.reason) == ((1,), "its sign is not known")
