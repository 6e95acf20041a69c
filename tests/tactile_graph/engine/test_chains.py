"""Nodes that are run by one call come to what they come to one by one, and are seen likewise."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from threading import Thread
from time import perf_counter_ns
from typing import Any

import numpy as np
import pytest

from helpers_modes import answered_by
from tactile_graph import Frame, Pipeline, load, loads
from tactile_graph.compiled.chained import Chained
from tactile_graph.engine import program, written
from tactile_graph.engine.chains import chains_of, linked_form, spelled
from tactile_graph.engine.outcomes.outcomes import LATER
from tactile_graph.engine.runner import Runner
from tactile_graph.pipeline.conditions.conditions import compile_condition
from tactile_graph.wires import Circle, Mask

INDICES = np.indices((16, 16))


def discs() -> list[Frame]:
    """Return frames that are empty, hold a few cells, discs of many sizes, and no empty cell."""
    rng = np.random.default_rng(5)
    radii = [0.0, 0.6, 1.1, 1.6, 2.1, 2.6, 3.3, 4.2, 5.1, 6.4, 7.3, 30.0]
    values = [0.2 * (np.hypot(INDICES[0] - 8.2, INDICES[1] - 6.9) < r) for r in radii]
    values += [np.where(INDICES[0] == 3, 0.2, 0.0), np.where(INDICES[1] % 5 == 0, 0.2, 0.0)]
    noisy = [v + rng.normal(0.0, 1e-3, v.shape) for v in values]
    of = [Frame.of(v, 1.3, (-0.15, -0.15), "volt", index=i) for i, v in enumerate(noisy)]
    broken = noisy[8].copy()
    broken[4:6, 2:9] = np.nan
    wide = np.zeros((20, 70))
    wide[4:14, 20:33] = 0.2
    return [
        *of,
        Frame.of(broken, 1.3, (-0.15, -0.15), "volt"),
        Frame.of(noisy[8], (1.3, 0.7), (2.0, -4.0), "volt"),
        Frame.of(np.kron(noisy[8], np.ones((2, 2))), 0.65, (0.0, 0.0), "volt"),
        Frame.of(wide, 0.5, (0.0, 0.0), "volt"),
        Frame.of(1e3 * noisy[7], 1.3, (0.0, 0.0), "gram"),
    ]


def told(result: Any) -> dict[str, str]:
    """Return what every node came to, to the bit."""
    found = {}
    for name, outcome in result.outcomes.items():
        array = getattr(outcome, "xy_cm", getattr(outcome, "values", None))
        bits = "" if array is None else f" {array.dtype} {array.shape} {array.tobytes().hex()}"
        grid = f" {outcome.pitch_cm} {outcome.origin_cm}" if isinstance(outcome, Mask) else ""
        found[name] = f"{outcome!r}{grid}{bits}"
    return found


def unguarded() -> Pipeline:
    return loads(re.sub(r", when: [^}]*", "", load("circle-3").text))


@pytest.fixture
def in_python(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Let chains run as the Python that their text is."""
    code: Callable[..., Any] = lambda self, make: self.loops(perf_counter_ns)  # noqa: E731
    monkeypatch.setattr(Chained, "possible", staticmethod(lambda: True))
    monkeypatch.setattr(Chained, "machine_code", code)
    with answered_by("plain"):
        yield


def chained(pipeline: Pipeline, *asked: str) -> Runner[Any]:
    runner = pipeline.runner(asked or None)
    runner.prepare()
    return runner


def names(pipeline: Pipeline, *asked: str) -> list[list[str]]:
    """Return the nodes of the chains of a runner, in the order of the file."""
    runner = chained(pipeline, *asked)
    written = runner._operations._written
    assert written is not None
    return [[link.item.name for link in chain.links] for chain in written.chains]


LONGEST = ["fine", "eroded", "dilated", "boundary", "hull", "circle"]


@pytest.mark.usefixtures("in_python")
@pytest.mark.parametrize("made", ["circle-1", "circle-2", "circle-3", unguarded])
def test_every_node_comes_to_the_same(made: str | Callable[[], Pipeline]) -> None:
    pipeline = load(made) if isinstance(made, str) else made()
    alone, together = pipeline.runner(), chained(pipeline)
    n_chained = 0
    for frame in discs():
        expected, got = alone(frame), together(frame)
        n_chained += bool(got._state[LATER])
        timed, spent = ([n for n, t in r.times_us.items() if t > 0] for r in (expected, got))
        assert spent == timed
        assert repr(got) == repr(expected)
        before = got.times_us
        assert told(got) == told(expected)
        assert got.times_us == before
        assert [(f.origin, f.reason, f.where, f.step) for f in got.failures] == [
            (f.origin, f.reason, f.where, f.step) for f in expected.failures
        ]
    assert n_chained > 5


@pytest.mark.slow
@pytest.mark.parametrize("name", ["circle-1", "circle-3"])
def test_machine_code_comes_to_the_same(name: str) -> None:
    if not Chained.possible():
        pytest.skip("no chains with this numba or system")
    alone, together = load(name).runner(), chained(load(name))
    n_chained = 0
    for frame in discs():
        expected, got = alone(frame), together(frame)
        n_chained += bool(got._state[LATER])
        assert told(got) == told(expected)
    assert n_chained > 5


@pytest.mark.usefixtures("in_python")
def test_a_chain_is_as_long_as_nobody_asks_for_what_is_between() -> None:
    assert names(load("circle-3")) == [LONGEST]
    assert names(unguarded()) == [LONGEST]
    assert names(load("circle-3"), "circle", "boundary") == [LONGEST[:4]]
    parts = [["fine", "eroded"]]
    assert names(load("circle-3"), "hull", "circle", "eroded") == parts
    assert names(load("circle-3"), "circle", "eroded.count") == parts
    assert names(load("contacts")) == []


TWO = """
pipeline: two
source: {step: sample, with: {name: discs}}
nodes:
  low: {step: threshold, in: frame, with: {level_v: 0.01}}
  high: {step: threshold, in: frame, with: {level_v: 0.19}}
  eroded: {step: erode, in: low, when: low.count > 0}
  wide: {step: boundary_scan, in: eroded}
  wide_hull: {step: hull, in: wide}
  inner: {step: boundary_scan, in: high, when: high.count > 0}
  inner_hull: {step: hull, in: inner}
  best: {first_of: [inner_hull, wide_hull]}
outputs: [wide_hull, inner_hull, best]
"""


@pytest.mark.usefixtures("in_python")
def test_a_frame_may_have_several_chains() -> None:
    assert names(loads(TWO)) == [["inner", "inner_hull"], ["eroded", "wide", "wide_hull"]]
    alone, together = loads(TWO).runner(), chained(loads(TWO))
    counts = set()
    for frame in discs()[:-1]:
        expected, got = alone(frame), together(frame)
        counts.add(len(got._state[LATER]))
        assert told(got) == told(expected)
    assert counts == {0, 1, 2}


@pytest.mark.usefixtures("in_python")
def test_what_is_between_is_made_once_and_by_whoever_asks_first() -> None:
    runner, frame = chained(load("circle-3")), discs()[8]
    result = runner(frame)
    again = runner(frame)
    assert again.reused
    hulls: list[Any] = []
    threads = [Thread(target=lambda: hulls.append(result.outcome("hull"))) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len({hull.xy_cm.tobytes() for hull in hulls}) == 1
    assert result["hull"] is result["hull"]
    assert again["hull"].xy_cm.tobytes() == hulls[0].xy_cm.tobytes()


@pytest.mark.usefixtures("in_python")
def test_a_chain_that_raises_leaves_the_frame_to_its_nodes() -> None:
    pipeline, frame = load("circle-3"), discs()[8]
    runner = chained(pipeline)
    written = runner._operations._written
    assert written is not None

    def broken(mask: Any, start: int) -> Any:
        raise MemoryError

    slot = written.chains[0].last.slot
    written.names[f"enter{slot}"] = broken
    assert told(runner(frame)) == told(pipeline.runner()(frame))


@pytest.mark.usefixtures("in_python")
def test_a_runner_whose_nodes_run_each_alone_has_no_chains() -> None:
    runner, frames = chained(load("circle-3")), discs()
    assert runner(frames[8])._state[LATER]
    assert not runner.each_alone()(frames[9])._state[LATER]
    runner.prepare()
    assert not runner(frames[8])._state[LATER]


@pytest.mark.usefixtures("in_python")
def test_verified_runs_have_no_chains() -> None:
    pipeline, frame = load("circle-3"), discs()[8]
    runner = pipeline.runner(verify=True)
    runner.prepare()
    assert not runner(frame)._state[LATER]


@pytest.mark.usefixtures("in_python")
def test_a_chain_found_on_disk_waits_until_its_nodes_answer_by_machine_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(program, "AFTER_FRAMES", 1)
    monkeypatch.setattr(program, "CHAINS_AFTER_FRAMES", 2)
    monkeypatch.setattr(written, "SWITCH_AFTER_CALLS", 3)
    monkeypatch.setitem(sys.modules, "numba", sys)
    runner, frames = load("circle-3").runner(), discs()
    small, large = frames[1], frames[5:12]
    assert runner(small)["footprint"].count > 0
    ran = [bool(runner(frame)._state[LATER]) for frame in (large[0], small, *large[1:])]
    assert ran == [False] * 6 + [True, False]  # the last has no empty cell


def test_a_condition_is_told_to_machine_code_where_it_means_the_same() -> None:
    types = {"m": Mask, "c": Circle}
    told = [
        ("m.count > 0", "p.count > 0"),
        ("0 < m.count < 9 and not m.count == 3", "0 < p.count < 9 and (not p.count == 3)"),
        ("m.count / 2 > 1", None),
        ("max(m.count, 2) > 3", None),
    ]
    for text, expected in told:
        assert spelled(compile_condition(text, types), {"v0": "p.count"}) == expected


def test_a_step_has_no_linked_form_for_settings_that_its_loops_do_not_know() -> None:
    text = load("circle-3").text
    forms = {
        n: linked_form(node) is not None
        for n, node in loads(text.replace("factor: 2", "factor: 3")).nodes.items()
    }
    assert forms == {"footprint": False, "fine": False} | dict.fromkeys(LONGEST[1:], True)
    bordered = loads(text.replace("{element: disc5}", "{element: disc5, border: true}", 1))
    assert linked_form(bordered.nodes["eroded"]) is None
    plan = load("circle-3").runner().plan
    assert chains_of(plan, frozenset(), lambda item: True) == []
