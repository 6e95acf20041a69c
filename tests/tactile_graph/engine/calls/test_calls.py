"""What a node's step is called with: its settings, whatever kind of callable the step is."""

from __future__ import annotations

import functools
import gc
import weakref
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from helpers_graphs import STEPS as STEPS_OF_ALL
from helpers_graphs import frame, registry
from tactile_graph import Degenerate, Frame, Image, loads
from tactile_graph.engine.calls.gaps import Gaps
from tactile_graph.engine.calls.sources import Numbering
from tactile_graph.engine.outcomes.outcome import Failed
from tactile_graph.errors import DataError, PipelineError, UsageError
from tactile_graph.steps import Report, TimeGap


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


class Gapped:
    """A class with a state that is told of time."""

    def __init__(self) -> None:
        self.n = 0

    def __call__(self, image: Image, *, gap_s: TimeGap = None) -> str:
        self.n += 1
        return f"{self.n} {gap_s}"


def test_each_label_has_its_own_state_and_clock() -> None:
    text = "pipeline: p\nnodes: {a: {step: gapped, in: frame}}\noutputs: [a]\n"
    runner = loads(text, "p.yaml", registry({"gapped": Gapped})).runner()
    rows = [("left", 0.0), ("right", 0.0), ("left", 0.5), ("right", 0.25), ("", 9.0)]
    got = [runner(Frame.of(np.ones((2, 2)), time_s=t, label=name))["a"] for name, t in rows]
    assert got == ["1 None", "1 None", "2 0.5", "2 0.25", "1 None"]
    assert runner.n_states == 3


@pytest.mark.parametrize(
    ("times_s", "told"),
    [
        ([0.0, 0.5, None, 1.5, 2.0], [None, 0.5, 0.5, 0.5, 0.5]),
        ([0.0, 0.5, None, None, 2.25], [None, 0.5, 0.5, 0.5, 0.75]),
        ([0.0, 0.5, None, 0.75, 1.25], [None, 0.5, 0.5, 0.0, 0.25]),  # known times never move
        ([0.0, 0.5, 9.0, None, 10.0], [None, 0.5, 8.5, 0.5, 0.5]),  # a pause
        ([0.0, 0.5, None, 0.25, 0.75], [None, 0.5, 0.5, -0.75, 0.5]),  # a clock set back
        ([0.0, None, 1.0, None], [None, None, 0.5, 0.5]),
        ([None, None, 3.0], [None, None, None]),
        ([7.0, 7.0, 7.0, 7.0], [None, None, None, None]),  # a clock that stands tells no time
        ([7.0, 7.0, 7.0, 8.5, 8.5], [None, None, None, 0.5, 0.0]),
    ],
)
def test_a_frame_without_a_time_shares_that_between_the_known_ones(
    times_s: list[float | None], told: list[float | None]
) -> None:
    gaps = Gaps()
    frames = [Frame.of(np.ones((2, 2)), index=k, time_s=t) for k, t in enumerate(times_s)]
    assert [gaps.before(frame) for frame in frames] == told


@pytest.mark.parametrize(
    ("times_s", "device_s", "told"),
    [
        # Two bursts of an even clock.
        ([5.0, 5.0, 5.0, 5.3, 5.3], [9.0, 9.1, 9.2, 9.3, 9.4], [None, 0.1, 0.1, 0.1, 0.1]),
        # Begun anew, set by years, and no stamp: by arrival.
        ([5.0, 5.1, 5.2, 5.4], [9.0, 9.2, 0.0, 0.2], [None, 0.2, 0.1, 0.2]),
        ([5.0, 5.1, 5.2], [9.0, 1.7e9, 1.7e9 + 0.2], [None, 0.1, 0.2]),
        ([5.0, 5.1, 5.3, 5.4], [9.0, None, 9.5, 9.7], [None, 0.1, 0.2, 0.2]),
        # Thousandths that are told as seconds are none for long.
        ([0.0, 0.01, 0.02, 0.03], [0.0, 50.0, 100.0, 150.0], [None, 50.0, 0.01, 0.01]),
    ],
)
def test_the_gap_is_by_the_devices_clock_where_that_is_sound(
    times_s: list[float], device_s: list[float | None], told: list[float | None]
) -> None:
    gaps = Gaps()
    for k, (time_s, own_s, gap_s) in enumerate(zip(times_s, device_s, told, strict=True)):
        frame = Frame.of(np.ones((2, 2)), index=k, time_s=time_s)
        found = gaps.before(replace(frame, device_time_s=own_s))
        assert found == (None if gap_s is None else pytest.approx(gap_s))


def test_a_step_that_writes_has_one_instance_whatever_the_labels() -> None:
    made: list[int] = []

    class Writes:
        def __init__(self) -> None:
            made.append(1)

        def __call__(self, image: Image) -> None:
            return None

    text = "pipeline: p\nnodes: {a: {step: writes, in: frame}}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"writes": Writes}))
    made.clear()
    runner = pipeline.runner()
    for name in ("left", "right"):
        runner(Frame.of(np.ones((2, 2)), label=name))
    assert len(made) == 1


def test_a_failure_of_a_step_with_settings_names_its_own_file_and_function() -> None:
    (outcomes,) = values("a: {step: scaled, in: frame, with: {factor: 0}}", 1)
    failed = outcomes["a"]
    assert isinstance(failed, Failed)
    assert "test_calls.py" in failed.where
    assert failed.where.endswith("in scaled")


@dataclass
class Open:
    items: list[float] = field(default_factory=list)


def grown(image: Image, *, c: list[float] = [1.0]) -> float:  # noqa: B006 - that is the point
    c.append(1.0)
    return float(sum(c))


def emptied(image: Image, *, by: dict[str, list[float]]) -> float:
    by["a"].append(float(len(by)))
    return float(sum(by.popitem()[1]))


def opened(image: Image, *, c: Open = Open([2.0])) -> float:  # noqa: B008
    c.items.append(1.0)
    return sum(c.items)


class Growing:
    """Keeps the list that it was set to, and adds to it."""

    def __init__(self, *, c: list[float] = [1.0]) -> None:  # noqa: B006
        self.c = c

    def __call__(self, image: Image) -> float:
        self.c.append(1.0)
        return sum(self.c)


CHANGING = {"grown": grown, "emptied": emptied, "opened": opened, "growing": Growing}


def test_what_a_step_does_to_a_list_it_was_set_to_reaches_no_other_frame_run_or_load() -> None:
    text = """pipeline: p
nodes:
  a: {step: grown, in: frame}
  b: {step: grown, in: frame, with: {c: [5.0]}}
  c: {step: emptied, in: frame, with: {by: {a: [3.0]}}}
  d: {step: opened, in: frame}
outputs: [a, b, c, d]
"""
    its = registry(CHANGING)
    for _ in range(2):
        pipeline = loads(text, "p.yaml", its)
        before = pipeline.resolved()
        for _ in range(2):
            for result in pipeline.stream([frame(1), frame(2), frame(3)]):
                assert dict(result) == {"a": 2.0, "b": 6.0, "c": 4.0, "d": 3.0}
        assert pipeline.resolved() == before


def test_a_step_that_keeps_state_begins_each_run_with_the_list_it_was_set_to() -> None:
    text = "pipeline: p\nnodes:\n  a: {step: growing, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry(CHANGING))
    frames = [frame(1), frame(2), frame(3)]
    for _ in range(2):
        assert [r["a"] for r in pipeline.stream(frames)] == [2.0, 3.0, 4.0]
    assert pipeline.nodes["a"].settings == {"c": [1.0]}


def test_results_that_are_kept_stay_as_they_were() -> None:
    class Counting:
        def __init__(self) -> None:
            self.seen: dict[str, float] = {"n": 0.0}

        def __call__(self, image: Image) -> dict[str, float]:
            self.seen["n"] += 1.0
            return self.seen

    text = "pipeline: p\nnodes:\n  a: {step: counting, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"counting": Counting}))
    results = [*pipeline.stream([frame(1), frame(2), frame(3)])]
    assert [r["a"]["n"] for r in results] == [1.0, 2.0, 3.0]


def noisy(image: Image, *, rng: np.random.Generator) -> float:
    return float(rng.random())


def test_a_stream_closes_its_source_however_its_loop_is_left() -> None:
    closed = []

    def source() -> Iterator[np.ndarray[Any, Any]]:
        try:
            while True:
                yield np.ones((2, 2))
        finally:
            closed.append(True)

    pipeline = loads("{pipeline: p, nodes: {l: {step: load, in: frame}}, outputs: [l]}")
    held = source()
    with pipeline.stream(held) as results:
        for result in results:
            assert result["l"].total == 4.0
            break
    assert closed == [True]
    assert next(results, None) is None
    with pytest.raises(UsageError, match=r"the stream was closed; pipeline.stream\(\) makes a new"):
        results.to_pandas()
    untouched = pipeline.stream([np.ones((2, 2))])
    untouched.close()
    assert next(untouched, None) is None
    own = pipeline.with_source("sample", name="discs")
    with own.stream() as results:
        assert next(results).frame.index == 0
    assert next(results, None) is None


def test_bare_arrays_of_a_stream_are_numbered_and_differ_in_their_random_numbers() -> None:
    text = "pipeline: p\nnodes:\n  a: {step: noisy, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"noisy": noisy}))
    arrays = np.zeros((5, 2, 2))
    results = [*pipeline.stream(arrays)]
    assert [r.frame.index for r in results] == [0, 1, 2, 3, 4]
    assert len({r["a"] for r in results}) == 5
    numbered = [Frame.of(a, index=i) for i, a in enumerate(arrays)]
    assert [r["a"] for r in pipeline.stream(numbered)] == [r["a"] for r in results]
    assert pipeline.run(arrays[0])["a"] == results[0]["a"]


def test_frames_of_a_source_that_numbers_none_are_numbered_and_others_left() -> None:
    number = Numbering()
    given = [(0, ""), (0, ""), (0, ""), (0, "b"), (0, "b"), (7, "b"), (0, "b"), (1, "b")]
    frames = [Frame(Image(np.zeros((2, 2))), i, label=label) for i, label in given]
    assert [number(f).index for f in frames] == [0, 1, 2, 0, 1, 7, 0, 1]
    with pytest.raises(ValueError, match="an index counts from 0, got -1"):
        Frame.of(np.zeros((2, 2)), index=-1)


def test_frames_of_sensors_that_take_turns_are_numbered_each_by_its_own() -> None:
    def by_turns() -> Iterator[Frame]:
        for _ in range(3):
            for label in "ab":
                yield Frame.of(np.zeros((2, 2)), label=label)

    text = (
        "pipeline: p\nsource: {step: by_turns}\nnodes: {n: {step: noisy, in: frame}}\noutputs: [n]"
    )
    steps = {"by_turns": by_turns, "noisy": noisy}
    results = [*loads(text, steps=steps).stream()]
    assert [(r.frame.label, r.frame.index) for r in results] == [
        (label, i) for i in range(3) for label in "ab"
    ]
    assert len({r["n"] for r in results}) == 3


def test_a_seed_below_0_is_told() -> None:
    text = "pipeline: p\nnodes:\n  a: {step: noisy, in: frame}\noutputs: [a]\n"
    pipeline = loads(text, "p.yaml", registry({"noisy": noisy}))
    with pytest.raises(UsageError, match="seed: must be a whole number >= 0, got -1"):
        pipeline.run(np.zeros((2, 2)), seed=-1)


def bad_unit() -> Iterator[Frame]:
    yield Frame.of(np.zeros((2, 2)), quantity="volts")


def ended() -> Iterator[Frame]:
    raise Degenerate("nothing more")
    yield


def cut() -> Iterator[Frame]:
    raise RuntimeError("cable\nout")
    yield


SOURCES = {"bad_unit": bad_unit, "ended": ended, "cut": cut}
FROM = "pipeline: p\nsource: {{step: {}}}\nnodes:\n  a: {{step: constant}}\noutputs: [a]\n"


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("bad_unit", "unknown quantity 'volts'"),
        ("ended", "source 'ended': nothing more"),
        ("cut", "source 'cut': RuntimeError: cable out ("),
    ],
)
def test_what_a_source_raises_is_told_with_the_line_of_its_own_code(
    source: str, words: str
) -> None:
    pipeline = loads(FROM.format(source), "p.yaml", registry({**STEPS_OF_ALL, **SOURCES}))
    with pytest.raises(DataError, match=rf"test_calls\.py:\d+ in {source}\)") as caught:
        list(pipeline.stream())
    assert words in str(caught.value)


def test_a_source_that_is_put_in_is_told_without_a_line_of_the_file() -> None:
    pipeline = loads(FROM.format("ended"), "p.yaml", registry({**STEPS_OF_ALL, **SOURCES}))
    for step, settings, words in (
        ("endet", {}, "source: no step named 'endet'"),
        ("constant", {}, "source: step 'constant' is no source"),
        ("ended", {"n": 1}, "source, n: unknown setting 'n'"),
    ):
        with pytest.raises(PipelineError) as caught:
            pipeline.with_source(step, **settings)
        assert str(caught.value).startswith(words)
        assert "p.yaml" not in str(caught.value)
        assert "^" not in str(caught.value)


def test_one_output_may_be_asked_for_by_its_name() -> None:
    text = "pipeline: p\nnodes:\n  ab: {step: noisy, in: frame}\noutputs: [ab]\n"
    pipeline = loads(text, "p.yaml", registry({"noisy": noisy}))
    assert set(pipeline.run(np.zeros((2, 2)), only="ab")) == {"ab"}


def test_a_stream_that_has_ended_holds_no_frames() -> None:
    frames = (frame(n) for n in range(3))
    held = weakref.ref(frames)
    text = "pipeline: p\nnodes: {a: {step: scaled, in: frame}}\noutputs: [a]\n"
    results = loads(text, "p.yaml", registry(STEPS)).stream(frames)
    assert len(list(results)) == 3
    del frames
    gc.collect()
    assert held() is None


def test_a_source_whose_own_attribute_is_called_stacked_yields_its_frames() -> None:
    def presses() -> Iterator[Frame]:
        yield Frame.of(np.ones((2, 2)), quantity="volt")

    presses.stacked = False  # type: ignore[attr-defined]
    text = (
        "pipeline: p\nsource: {step: presses}\nnodes: {a: {step: scaled, in: frame}}\noutputs: [a]"
    )
    pipeline = loads(text, "p.yaml", registry({"presses": presses, "scaled": scaled}))
    assert len([*pipeline.frames_in_stacks(0, Report())]) == 1
