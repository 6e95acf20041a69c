"""A program written out as one function comes to what its operations come to, call by call."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from helpers_graphs import CALLS, STEPS, cases, frame, registry, shown
from tactile_graph import Frame, load, loads
from tactile_graph.engine import program
from tactile_graph.engine.operations.step_operation import Operation
from tactile_graph.engine.outcomes.outcome import Skipped

UNHEALTHY = [HealthCheck.too_slow, HealthCheck.data_too_large]
FRAMES = [frame(n, i, t) for i, (n, t) in enumerate([(0, 0.0), (3, 0.5), (4, 0.6), (5, 2.0)])]
NEVER = 10**9


def told(pipeline: Any, after: int, patch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """Return outcomes, calls, failures' places and who took time, frame by frame."""
    patch.setattr(program, "AFTER_FRAMES", after)
    runner, found = pipeline.runner(), []
    for one in FRAMES:
        CALLS.clear()
        result = runner(one)
        timed = [name for name, us in result.times_us.items() if us]
        failures = [(f.origin, f.where, f.inputs, f.step) for f in result.failures]
        found.append((repr(result.outcomes), CALLS.copy(), failures, timed))
    return found


@pytest.mark.slow
def test_random_pipelines_come_to_the_same_written_or_not(tmp_path: Path) -> None:
    n_written = 0

    @settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=UNHEALTHY)
    @given(case=cases())
    def equal(case: tuple[dict[str, Any], dict[str, Any]]) -> None:
        nonlocal n_written
        document, library = case
        files = {name: tmp_path / f"{name}.yaml" for name in library}
        for name, path in files.items():
            path.write_text(shown(library[name]))
        pipeline = loads(shown(document), "random.yaml", registry(STEPS, files))
        with pytest.MonkeyPatch.context() as patch:
            expected = told(pipeline, NEVER, patch)
            assert told(pipeline, 1, patch) == expected
            n_written += 1

    equal()
    assert n_written == 60


def discs(n: int) -> list[Frame]:
    rng, (rows, columns) = np.random.default_rng(5), np.indices((16, 16))
    values = [0.2 * (np.hypot(rows - 8, columns - 7) < radius) for radius in range(n)]
    noisy = [v + rng.normal(0.0, 1e-3, v.shape) for v in values]
    return [Frame.of(v, 1.3, (-0.15, -0.15), "volt", index=i) for i, v in enumerate(noisy)]


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    ["circle-1", "circle-3", "contacts", pytest.param("rectangle-3", marks=pytest.mark.slow)],
)
def test_a_shipped_pipeline_comes_to_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    frames = [*discs(8), *discs(14)]  # empty ones, small ones, whole ones
    monkeypatch.setattr(program, "AFTER_FRAMES", NEVER)
    expected = [repr(load(name).runner()(f).outcomes) for f in frames]
    monkeypatch.setattr(program, "AFTER_FRAMES", 3)
    written: list[Operation] = []
    write = program.Written.program
    monkeypatch.setattr(
        program.Written,
        "program",
        lambda self, **how: written.append(write(self, **how)) or written[-1],
    )
    runner = load(name).runner()
    assert [repr(runner(f).outcomes) for f in frames] == expected
    assert len(written) == 1


def test_the_skip_of_a_pad_that_stays_empty_is_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    runner = load("circle-3").runner()
    empty = [Frame.of(np.full((16, 16), 1e-4 * i), 1.3, (0.0, 0.0), "volt") for i in range(4)]
    skips = [runner(f).outcome("circle") for f in empty]
    assert isinstance(skips[-1], Skipped)
    assert skips[-1].reason == "when touched is false (footprint.count = 0)"
    assert skips[2] is skips[3]


def test_a_run_that_needs_no_node_is_written_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    monkeypatch.setattr(program, "CHAINS_AFTER_FRAMES", 2)
    runner = load("circle-3").runner(["frame"])
    for one in discs(4):
        assert runner(one).outcome("frame") is one


def test_a_field_may_be_named_by_a_word_of_python(monkeypatch: pytest.MonkeyPatch) -> None:
    class Worded:
        def __init__(self, number: int) -> None:
            setattr(self, "class", number)

    Worded.__annotations__ = {"class": int}

    def worded(a: int) -> Worded:
        return Worded(a)

    worded.__annotations__ = {"a": int, "return": Worded}
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    text = """
pipeline: worded
nodes:
  number: {step: read, in: frame}
  worded: {step: worded, in: number}
  more: {step: add1, in: worded.class}
outputs: [more]
"""
    runner = loads(text, "worded.yaml", registry({**STEPS, "worded": worded})).runner()
    assert [runner(one).outcome("more") for one in FRAMES] == [1, 4, 5, 6]


def test_text_in_a_condition_and_in_names_cannot_end_the_text(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    text = """
pipeline: "quote ' and \\" and \\n line"
nodes:
  number: {step: read, in: frame}
  sure: {step: add1, in: number, when: 'frame.label != "''''''" and number > 2'}
outputs: [sure]
"""
    runner = loads(text, "quoted.yaml", registry(STEPS)).runner()
    outcomes = [runner(one).outcome("sure") for one in FRAMES]
    assert [o for o in outcomes if not isinstance(o, Skipped)] == [4, 5, 6]


def test_time_is_told_of_each_step(monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(a: int) -> int:
        time.sleep(0.002)
        return a

    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    text = """
pipeline: timed
nodes:
  number: {step: read, in: frame}
  slow: {step: slow, in: number}
outputs: [slow]
"""
    runner = loads(text, "timed.yaml", registry({**STEPS, "slow": slow})).runner()
    assert all(runner(one).times_us["slow"] > 1900.0 for one in FRAMES)


def test_what_an_empty_pad_came_to_is_kept_while_it_stays_empty(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rng = np.random.default_rng(9)
    grids = [(1.3, 1.3), (1.3, 1.3), (0.9, 1.3), (1.3, 1.3)]
    empty = [
        Frame.of(rng.normal(0.0, 1e-3, (16, 16)), grid, (-0.15, -0.15), "volt") for grid in grids
    ]
    frames = [*empty, discs(8)[7], *empty, discs(8)[2], *empty]
    monkeypatch.setattr(program, "AFTER_FRAMES", NEVER)
    expected = [repr(load("circle-3").runner()(f).outcomes) for f in frames]
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    runner = load("circle-3").runner()
    results = [runner(f) for f in frames]
    assert [repr(r.outcomes) for r in results] == expected
    assert results[6].outcome("footprint") is results[5].outcome("footprint")
    assert results[6].outcome("circle") is results[5].outcome("circle")
    assert results[2].outcome("footprint").pitch_cm == (0.9, 1.3)
    assert results[4].outcome("circle").radius_cm > 0
