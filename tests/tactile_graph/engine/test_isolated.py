"""Steps in processes of their own: what hangs or crashes costs its node, and nothing else."""

from __future__ import annotations

import gc
import os
import time
from typing import Any

import pytest

import helpers_isolated as steps
from helpers_graphs import STEPS, frame, registry
from tactile_graph import Image, Pipeline, loads
from tactile_graph.engine.outcome import Failed, Skipped
from tactile_graph.errors import PipelineError, UsageError

pytestmark = pytest.mark.slow
OWN = {
    "moody": steps.moody,
    "counting": steps.Counting,
    "elsewhere": steps.elsewhere,
    "unsendable": steps.unsendable,
}


def pipeline(node: str, more: str = "") -> Pipeline:
    text = f"""
pipeline: p
nodes:
  risky: {{{node}}}
  other: {{step: read, in: frame}}
{more}
outputs: [risky, other]
"""
    return loads(text, "p.yaml", registry({**STEPS, **OWN}))


def run_until_back(runner: Any, number: int, seconds: float = 60.0) -> list[Any]:
    """Return the results until the step has a value again."""
    end, results = time.monotonic() + seconds, []
    while time.monotonic() < end:
        results.append(runner(frame(number, len(results))))
        runner.forget()
        if "risky" in results[-1]:
            return results
        time.sleep(0.02)
    raise AssertionError(results[-1])


def test_a_step_that_hangs_is_killed_and_started_anew_while_the_others_go_on() -> None:
    runner = pipeline("step: moody, in: frame, time_limit_s: 0.5, with: {plus: 1}").runner()
    assert runner(frame(10))["risky"] == 11
    began = time.monotonic()
    hung = runner(frame(steps.HANGS, 1))
    assert 0.4 < time.monotonic() - began < 5
    outcome = hung.outcome("risky")
    assert isinstance(outcome, Failed)
    assert "took longer than its 0.5 s: its process was killed, a new one starts" in outcome.reason
    assert hung["other"] == steps.HANGS
    results = run_until_back(runner, 20)
    assert results[-1]["risky"] == 21
    skipped = [r.outcome("risky") for r in results[:-1]]
    assert skipped  # frames do not wait for the new process
    assert all(isinstance(s, Skipped) for s in skipped)
    told = "its process is being started anew: the last took longer than its 0.5 s"
    assert {s.reason for s in skipped} == {told}
    assert all(r["other"] == 20 for r in results)


def test_a_step_that_crashes_fails_its_node_and_is_started_anew() -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    outcome = runner(frame(steps.CRASHES)).outcome("risky")
    assert isinstance(outcome, Failed)
    assert "ended its process by SIGKILL: a new one starts" in outcome.reason
    assert run_until_back(runner, 7)[-1]["risky"] == 7


def test_what_the_step_raises_and_prints_comes_through(capfd: pytest.CaptureFixture[str]) -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    failed = runner(frame(steps.FAILS)).outcome("risky")
    assert (failed.kind, failed.reason) == ("degenerate", "too little")
    assert runner(frame(steps.PRINTS))["risky"] == steps.PRINTS


def test_state_and_random_numbers_are_those_of_the_step_at_home() -> None:
    at_home = pipeline("step: counting, in: frame, with: {start: 3}").runner(seed=5)
    away = pipeline("step: counting, in: frame, with: {start: 3}, isolated: true").runner(seed=5)
    for i in range(3):
        assert away(frame(0, i))["risky"] == at_home(frame(0, i))["risky"]


def test_it_runs_in_another_process_which_ends_with_the_runner() -> None:
    runner = pipeline("step: elsewhere, in: frame, isolated: true").runner()
    process = runner(frame(0))["risky"]
    assert process != os.getpid()
    del runner
    gc.collect()
    for _ in range(200):
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return
        time.sleep(0.02)
    raise AssertionError("it still runs")


def test_what_cannot_be_sent_is_told() -> None:
    runner = pipeline("step: unsendable, in: frame, isolated: true").runner()
    assert "RuntimeError: gave " in runner(frame(0)).outcome("risky").reason

    def local(image: Image) -> int:
        return 0

    text = "pipeline: p\nnodes: {risky: {step: local, in: frame, isolated: true}}\noutputs: [risky]"
    with pytest.raises(UsageError, match="node 'risky': step 'local' cannot run in a process of"):
        loads(text, "p.yaml", registry({"local": local})).runner()


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ("first_of: [other], isolated: true", "'isolated' belongs to a node that has a 'step'"),
        ("use: other, time_limit_s: 1", "'time_limit_s' belongs to a node that has a 'step'"),
        ("step: moody, in: frame, time_limit_s: 0", "'time_limit_s' must be a number above 0, got"),
        ("step: moody, in: frame, time_limit_s: soon", "must be a number above 0, got a text"),
        ("step: moody, in: frame, isolated: 2", "'isolated' must be true or false, got 2"),
    ],
)
def test_mistakes_in_the_file_are_told_with_their_place(node: str, message: str) -> None:
    with pytest.raises(PipelineError, match=rf"p.yaml:4:\d+: node 'risky'.*{message}"):
        pipeline(node)


def test_what_was_said_of_a_step_stands_in_the_record_of_the_run() -> None:
    resolved = pipeline("step: moody, in: frame, time_limit_s: 0.5").resolved()
    assert resolved["nodes"]["risky"]["time_limit_s"] == 0.5
