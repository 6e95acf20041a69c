"""What a node's step is called with: its settings, whatever kind of callable the step is."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from helpers_graphs import frame, registry
from tactile_graph import Image, loads
from tactile_graph.engine.outcomes.outcome import Failed


def scaled(image: Image, *, factor: int = 2, offset: int = 0) -> int:
    if factor == 0:
        raise ValueError("no factor")
    return factor * int(image.values[0, 0]) + offset


def twice(step: Callable[..., int]) -> Callable[..., int]:
    """Wrap a step as a decorator would: it hands on whatever it is given."""

    @functools.wraps(step)
    def wrapper(*args: Any, **kwargs: Any) -> int:
        return 2 * step(*args, **kwargs)

    return wrapper


def closed_over(base: int) -> Callable[..., int]:
    def add(image: Image, *, more: int = 1) -> int:
        return base + more + int(image.values[0, 0])

    return add


class Kept:
    """A class whose state is its instance's alone."""

    def __init__(self, *, step: int = 1) -> None:
        self.step, self.n = step, 0

    def __call__(self, image: Image) -> int:
        self.n += self.step
        return self.n


STEPS = {"scaled": scaled, "doubled": twice(scaled), "closed": closed_over(100), "kept": Kept}


def values(nodes: str, *numbers: float) -> list[dict[str, Any]]:
    names = [line.partition(":")[0].strip() for line in nodes.strip().splitlines()]
    body = "\n".join(f"  {line.strip()}" for line in nodes.strip().splitlines())
    text = f"pipeline: p\nnodes:\n{body}\noutputs: [{', '.join(names)}]\n"
    runner = loads(text, "p.yaml", registry(STEPS)).runner()
    return [runner(frame(n)).outcomes for n in numbers]


def test_each_node_of_a_step_has_its_own_settings_and_the_step_keeps_its_defaults() -> None:
    nodes = """a: {step: scaled, in: frame, with: {factor: 3}}
    b: {step: scaled, in: frame, with: {factor: 5, offset: 1}}
    c: {step: scaled, in: frame}"""
    assert values(nodes, 1, 2) == [{"a": 3, "b": 6, "c": 2}, {"a": 6, "b": 11, "c": 4}]
    assert scaled(frame(4).image) == 8


def test_settings_reach_a_step_behind_a_decorator() -> None:
    assert values("a: {step: doubled, in: frame, with: {factor: 3}}", 4) == [{"a": 24}]


def test_settings_reach_a_step_made_within_a_function() -> None:
    nodes = "a: {step: closed, in: frame, with: {more: 20}}\nb: {step: closed, in: frame}"
    assert values(nodes, 3) == [{"a": 123, "b": 104}]


def test_each_node_of_a_class_has_its_own_instance() -> None:
    nodes = "a: {step: kept, in: frame}\nb: {step: kept, in: frame, with: {step: 10}}"
    assert values(nodes, 1, 2) == [{"a": 1, "b": 10}, {"a": 2, "b": 20}]


def test_a_failure_of_a_step_with_settings_names_its_own_file_and_function() -> None:
    (outcomes,) = values("a: {step: scaled, in: frame, with: {factor: 0}}", 1)
    failed = outcomes["a"]
    assert isinstance(failed, Failed)
    assert "test_calls.py" in failed.where
    assert failed.where.endswith("in scaled")
