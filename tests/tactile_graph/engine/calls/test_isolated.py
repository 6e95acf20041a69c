"""Steps in processes of their own: what hangs or crashes costs its node, and nothing else."""

from __future__ import annotations

import gc
import os
import signal
import subprocess
import sys
import time
import types
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import helpers_isolated as steps
import helpers_isolated_kernels as kernel_steps
from helpers_graphs import STEPS, frame, registry
from tactile_graph import Frame, Image, Pipeline, hookimpl, loads
from tactile_graph.compiled import mode
from tactile_graph.engine.calls import isolated
from tactile_graph.engine.calls.process import how_ended
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.errors import PipelineError, UsageError
from tactile_graph.pipeline.graph import Isolation
from tactile_graph.plugins.registry import Registry
from tactile_graph.wires.frame_stack import FrameStack

pytestmark = pytest.mark.slow
OWN = {
    "moody": steps.moody,
    "raises": steps.raises,
    "counting": steps.Counting,
    "timed": steps.Timed,
    "needs_file": steps.NeedsFile,
    "needs_device": steps.NeedsDevice,
    "elsewhere": steps.elsewhere,
    "readiness": kernel_steps.readiness,
    "unsendable": steps.unsendable,
    "asks": steps.asks,
    "forks": steps.forks,
    "ends_all": steps.ends_all,
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
        if "risky" in results[-1]:
            return results
        time.sleep(0.02)
    raise AssertionError(results[-1])


def test_a_step_that_hangs_is_killed_and_started_anew_while_the_others_go_on() -> None:
    runner = pipeline("step: moody, in: frame, time_limit_s: 0.5, with: {plus: 1}").runner()
    assert runner(frame(10))["risky"] == 11
    began = time.monotonic()
    hung = runner(frame(steps.HANGS, 1))
    assert 0.4 < time.monotonic() - began < 30
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
    assert outcome.where == ""  # no line of anybody's
    assert run_until_back(runner, 7)[-1]["risky"] == 7


def test_frames_equal_to_one_that_it_did_not_answer_are_not_reused_in_blocks_either() -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    stack = FrameStack.of([frame(steps.CRASHES, i) for i in range(3)])
    first, second = runner.block(stack), runner.block(stack)
    assert not [r for r in [*first, *second] if r.reused]


def test_no_call_waits_for_a_compiler_which_would_count_for_its_time() -> None:
    """It is imported before the first call, and plain code answers while it works."""
    runner = pipeline("step: readiness, in: frame, isolated: true").runner()
    imported, n_answering = runner(frame(0))["risky"]
    assert imported
    assert n_answering == ((os.cpu_count() or 1) > 1 and mode() == "auto")


def test_what_the_step_raises_and_prints_comes_through(capfd: pytest.CaptureFixture[str]) -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    failed = runner(frame(steps.FAILS)).outcome("risky")
    assert (failed.kind, failed.reason) == ("degenerate", "too little")
    assert runner(frame(steps.PRINTS))["risky"] == steps.PRINTS


def interrupt(runner: Any, given: Frame) -> None:
    """Have Ctrl-C come while a process is waited for."""

    def comes(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runner._apart["risky"]._process.messages, "get", comes)
        with pytest.raises(KeyboardInterrupt):
            runner(given)


@pytest.mark.parametrize("number", [11, steps.HANGS])
def test_a_frame_after_one_that_was_interrupted_has_its_own_answer(number: int) -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    interrupt(runner, frame(number))
    assert [runner(frame(i))["risky"] for i in (20, 30)] == [20, 30]


def test_what_an_interrupted_step_that_keeps_state_loses_is_told() -> None:
    runner = pipeline("step: counting, in: frame, isolated: true").runner()
    assert runner(frame(0))["risky"][0] == 1
    interrupt(runner, frame(1))
    told = "its process is being started anew: the last was interrupted"
    assert runner(frame(2)).outcome("risky").reason == told
    assert run_until_back(runner, 3)[-1]["risky"][0] == 1


def test_an_interrupt_while_a_step_is_made_for_a_new_label_mixes_up_nothing() -> None:
    runner = pipeline("step: counting, in: frame, isolated: true").runner()
    assert runner(frame(0))["risky"][0] == 1
    interrupt(runner, replace(frame(1), label="b"))
    assert run_until_back(runner, 2)[-1]["risky"][0] == 1
    assert runner(replace(frame(3), label="b"))["risky"][0] == 1
    assert runner(frame(4))["risky"][0] == 2


def test_a_step_that_reads_standard_input_finds_nothing_there() -> None:
    runner = pipeline("step: asks, in: frame, time_limit_s: 30").runner()
    assert runner(frame(0))["risky"] == "''"


def test_what_would_end_a_program_fails_the_node_and_is_no_ctrl_c() -> None:
    runner = pipeline("step: ends_all, in: frame, isolated: true").runner()
    reasons = [runner(frame(i)).outcome("risky").reason for i in range(2)]
    assert reasons == ["KeyboardInterrupt: enough", "OwnError: enough"]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_a_copy_that_a_step_forks_answers_nobody() -> None:
    runner = pipeline("step: forks, in: frame, isolated: true").runner()
    assert [runner(frame(i, i))["risky"] for i in range(3)] == [0, 0, 0]


def test_what_a_step_raises_is_told_as_at_home_with_the_line_of_its_code() -> None:
    at_home = pipeline("step: raises, in: frame").runner()
    away = pipeline("step: raises, in: frame, isolated: true").runner()
    for i in range(len(steps.OWN_ERRORS)):
        one, other = (run(frame(i)).outcome("risky") for run in (at_home, away))
        assert type(one) is type(other)
        told = "kind", "reason", "where"
        assert [getattr(other, t, "") for t in told] == [getattr(one, t, "") for t in told]


def test_state_and_random_numbers_are_those_of_the_step_at_home() -> None:
    at_home = pipeline("step: counting, in: frame, with: {start: 3}").runner(seed=5)
    away = pipeline("step: counting, in: frame, with: {start: 3}, isolated: true").runner(seed=5)
    for i in range(3):
        assert away(frame(0, i))["risky"] == at_home(frame(0, i))["risky"]


def test_each_label_has_its_state_in_the_nodes_one_process() -> None:
    runner = pipeline("step: counting, in: frame, time_limit_s: 60").runner()
    got = [runner(replace(frame(1, k), label=name))["risky"] for k, name in enumerate("aabab")]
    assert [first for first, *_ in got] == [1, 2, 1, 3, 2]
    assert len(runner.processes) == 1


def test_a_step_that_is_told_of_time_keeps_state_of_each_label_apart_from_home() -> None:
    runner = pipeline("step: timed, in: frame, isolated: true").runner()
    frames = [replace(frame(1, k), label=name, time_s=0.5 * k) for k, name in enumerate("aab")]
    assert [runner(f)["risky"] for f in frames] == [(1, None), (2, 0.5), (1, None)]
    assert [*runner.processes] == ["risky"]


@pytest.mark.parametrize("in_a_call", [True, False])
def test_a_new_label_does_not_wait_for_a_process_that_starts_anew(in_a_call: bool) -> None:
    runner = pipeline("step: timed, in: frame, isolated: true").runner()
    assert runner(frame(1))["risky"] == (1, None)
    if in_a_call:
        runner(frame(steps.CRASHES, 1))
    else:  # as one whose memory the system wants
        host = runner._apart["risky"]
        os.kill(host._process._process.pid, signal.SIGKILL)
        host._process._process.wait()
        while host._process.messages.empty():
            time.sleep(0.01)
    outcome = runner(replace(frame(1, 2), label="b")).outcome("risky")
    assert "is being started anew: the last ended its process by SIGKILL" in outcome.reason
    assert run_until_back(runner, 1)[-1]["risky"] == (1, None)
    assert runner(replace(frame(1, 3), label="b"))["risky"] == (1, None)


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
    told = "RuntimeError: gave what pickle cannot send from its own process: "
    assert told in runner(frame(0)).outcome("risky").reason

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
        (
            "step: moody, in: frame, time_limit_s: 2e4",
            r"'2e4'; as a number YAML takes 20000 or 2.0e\+4",
        ),
        (
            "step: moody, in: frame, time_limit_s: '.5'",
            "'.5'; as a number YAML takes 0.5 or 5.0e-1",
        ),
        ("step: moody, in: frame, isolated: 2", "'isolated' must be true or false, got 2"),
    ],
)
def test_mistakes_in_the_file_are_told_with_their_place(node: str, message: str) -> None:
    with pytest.raises(PipelineError, match=rf"p.yaml:4:\d+: node 'risky'.*{message}"):
        pipeline(node)


def test_what_was_said_of_a_step_stands_in_the_record_of_the_run() -> None:
    resolved = pipeline("step: moody, in: frame, time_limit_s: 0.5").resolved()
    assert resolved["nodes"]["risky"]["time_limit_s"] == 0.5


# -- steps that share a process ------------------------------------------------------------------

TOGETHER = """
pipeline: p
isolated: [{isolated}]
nodes:
  one: {{step: elsewhere, in: frame}}
  two: {{step: elsewhere, in: frame}}
  sum: {{step: counting, in: frame}}
  at_home: {{step: elsewhere, in: frame, isolated: false}}
  other: {{step: read, in: frame, isolated: false}}
outputs: [one, two, sum, at_home, other]
"""


def marked(isolated: str = "", **marks: float | None) -> Pipeline:
    """Return a pipeline of a plugin ``risky`` that marks steps, and of a file that names some."""
    module = types.ModuleType("risky")
    offered = {**OWN, "read": STEPS["read"]}
    module.tactile_graph_steps = hookimpl(lambda: offered)  # type: ignore[attr-defined]
    module.tactile_graph_isolated = hookimpl(lambda: marks)  # type: ignore[attr-defined]
    plugins = Registry([("risky", "risky-package", "1", lambda: module)])
    (plugin,) = plugins.plugins
    assert not plugin.error, plugin.error
    return loads(TOGETHER.format(isolated=isolated), "p.yaml", plugins)


def processes(result: Any) -> list[int]:
    return [result[name] for name in ("one", "two", "at_home")]


@pytest.mark.parametrize(
    ("isolated", "marks"),
    [("elsewhere", {}), ("risky.elsewhere", {}), ("risky.*", {}), ("", {"elsewhere": None})],
)
def test_steps_named_by_the_file_or_marked_by_their_plugin_share_a_process(
    isolated: str, marks: dict[str, float | None]
) -> None:
    one, two, at_home = processes(marked(isolated, **marks).runner()(frame(0)))
    assert one == two != at_home == os.getpid()


def test_two_names_of_the_list_are_two_processes() -> None:
    text = TOGETHER.replace("two: {{step: elsewhere", "two: {{step: moody")
    names = "elsewhere, moody, counting"
    graph = loads(text.format(isolated=names), "p.yaml", registry({**STEPS, **OWN}))
    found = {n.isolation.process for n in graph.nodes.values() if n.isolation}
    assert len(found) == 3


def test_a_step_that_ends_the_process_takes_the_state_of_those_beside_it_and_is_named() -> None:
    text = TOGETHER.replace("two: {{step: elsewhere", "two: {{step: moody").format(isolated="t.*")
    runner = loads(text, "p.yaml", registry({**STEPS, **OWN}, plugin="t")).runner()
    assert runner(frame(9))["sum"][0] == 1
    crashed = runner(frame(steps.CRASHES, 1))
    assert "ended its process by SIGKILL at node 'two'" in crashed.outcome("two").reason
    assert crashed["other"] == steps.CRASHES
    waits = runner(frame(9, 2)).outcome("sum")
    assert isinstance(waits, Skipped)
    told = "the process of t is being started anew: the last ended its process by SIGKILL"
    assert waits.reason.startswith(told)
    end = time.monotonic() + 60
    while "sum" not in (result := runner(frame(9, 3))):
        assert time.monotonic() < end
        time.sleep(0.02)
    assert result["sum"][0] == 1


def test_a_step_that_cannot_be_made_for_a_label_takes_nothing_from_the_others(
    tmp_path: Path,
) -> None:
    needed = tmp_path / "needed"
    needed.touch()
    text = f"""
pipeline: p
isolated: [t.*]
nodes:
  needy: {{step: needs_file, in: frame, with: {{path: {needed}}}}}
  other: {{step: moody, in: frame}}
outputs: [needy, other]
"""
    runner = loads(text, "p.yaml", registry({**STEPS, **OWN}, plugin="t")).runner()
    assert runner(frame(5))["needy"] == 5
    needed.unlink()
    unmade = runner(replace(frame(6, 1), label="b"))
    told = "the process of t cannot run the step: FileNotFoundError: "
    assert told in unmade.outcome("needy").reason
    assert unmade["other"] == 6
    assert runner(frame(7, 2))["needy"] == 7
    runner(frame(steps.CRASHES, 3))  # the new process cannot make that of this label either
    end = time.monotonic() + 60
    while "other" not in (unmade := runner(frame(8, 4))):
        assert time.monotonic() < end
        time.sleep(0.02)
    assert told in unmade.outcome("needy").reason
    needed.touch()
    assert runner(replace(frame(9, 5), label="b"))["needy"] == 9
    assert runner(frame(10, 6))["needy"] == 10


def test_frames_do_not_wait_each_for_a_step_that_takes_long_to_fail_when_it_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(isolated, "AGAIN", 1e6)
    needed, tries = tmp_path / "needed", tmp_path / "needed.tries"
    needed.touch()
    node = f"step: needs_device, in: frame, isolated: true, with: {{path: {needed}}}"
    runner = pipeline(node).runner()
    assert runner(frame(5))["risky"] == 5
    needed.unlink()
    tries.unlink()
    runner(frame(steps.CRASHES, 1))
    end = time.monotonic() + 60
    while isinstance(runner(frame(6, 2)).outcome("risky"), Skipped):
        assert time.monotonic() < end
        time.sleep(0.02)
    told = "its own process cannot run the step: FileNotFoundError: "
    for i in range(5):
        assert told in runner(frame(7, 3 + i)).outcome("risky").reason
    assert tries.read_text() == "++"  # by the new process, and at the first call
    monkeypatch.setattr(isolated, "time", SimpleNamespace(monotonic=lambda: 1e12))  # long after
    needed.touch()
    assert runner(frame(8, 9))["risky"] == 8


def test_a_plugin_may_say_how_long_a_call_takes_at_most() -> None:
    graph = marked(elsewhere=2.5)
    assert graph.nodes["one"].isolation == Isolation(2.5, "risky")
    assert graph.resolved()["nodes"]["one"]["time_limit_s"] == 2.5
    assert graph.nodes["at_home"].isolation is None


def test_nodes_of_pipelines_that_are_used_are_found_by_the_list_too(tmp_path: Path) -> None:
    inner = "pipeline: i\nnodes: {a: {step: elsewhere, in: frame}}\noutputs: [a]"
    (tmp_path / "i.yaml").write_text(inner)
    text = "pipeline: p\nisolated: [elsewhere]\nnodes: {used: {use: i.yaml}}\noutputs: [used]"
    graph = loads(text, str(tmp_path / "p.yaml"), registry({**STEPS, **OWN}))
    isolation = graph.nodes["used/a"].isolation
    assert isolation is not None
    assert isolation.process


def test_a_runner_that_takes_anothers_place_takes_its_processes_too() -> None:
    first = marked("elsewhere").runner()
    one, two, _ = processes(first(frame(0)))
    then = marked("elsewhere").runner(after=first)
    assert processes(then(frame(0)))[:2] == [one, two]
    assert then.anew == ()


@pytest.mark.slow
def test_a_process_is_not_taken_over_where_a_file_of_its_step_was_changed(tmp_path: Path) -> None:
    file = tmp_path / "number.txt"
    step = f"step: from_file, in: frame, isolated: true, with: {{file: {file}}}"
    text = f"pipeline: p\nnodes: {{a: {{{step}}}}}\noutputs: [a]"
    known = {"from_file": steps.FromFile}
    file.write_text("1")
    first = loads(text, steps=known).runner()
    assert first(frame(0))["a"] == 1
    file.write_text("2")
    assert loads(text, steps=known).runner(after=first)(frame(0))["a"] == 2


def test_a_runner_tells_how_the_processes_fare() -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    assert runner.processes == {"risky": ("", 0, False, "")}
    runner(frame(steps.CRASHES))
    state = runner.processes["risky"]
    assert (state.n_restarts, state.starting) == (1, True)
    assert state.why == "ended its process by SIGKILL"
    end = time.monotonic() + 60
    while runner.processes["risky"].starting:  # without a frame that asks for it
        assert time.monotonic() < end
        time.sleep(0.02)
    assert runner(frame(7))["risky"] == 7
    assert runner.processes["risky"].n_restarts == 1


def test_one_that_takes_its_place_tells_on_and_under_the_new_names() -> None:
    runner = pipeline("step: moody, in: frame, isolated: true").runner()
    runner(frame(steps.CRASHES))
    text = "pipeline: p\nnodes: {dared: {step: moody, in: frame, isolated: true}}\noutputs: [dared]"
    then = loads(text, "p.yaml", registry({**STEPS, **OWN})).runner(after=runner)
    assert {n: s.n_restarts for n, s in then.processes.items()} == {"dared": 1}


def test_processes_within_a_pipeline_that_is_mapped_are_told_of(tmp_path: Path) -> None:
    inner = "pipeline: i\nnodes: {a: {step: elsewhere, in: frame, isolated: true}}\noutputs: [a]"
    (tmp_path / "i.yaml").write_text(inner)
    text = (
        "pipeline: p\nnodes:\n  pair: {step: pair, in: frame}\n"
        "  used: {use: i.yaml, in: pair, each: true}\noutputs: [used]"
    )
    own = registry({**STEPS, **OWN, "pair": steps.pair})
    runner = loads(text, str(tmp_path / "p.yaml"), own).runner()
    assert list(runner.processes) == ["used/a"]
    assert len(runner(frame(3))["used"]) == 2


@pytest.mark.parametrize(
    ("isolated", "message"),
    [
        ("isolated: moody", "'isolated' must be a list of steps, or of plugins as"),
        ("isolated: [2]", r"'isolated' must be a list of steps, .*, got 2"),
        ("isolated: [mody]", "'isolated': no step named 'mody'; did you mean 'moody'"),
        ("isolated: [nobody.*]", "'isolated': no plugin named 'nobody'"),
    ],
)
def test_mistakes_in_the_list_are_told_with_their_place(isolated: str, message: str) -> None:
    text = f"pipeline: p\n{isolated}\nnodes: {{a: {{step: moody, in: frame}}}}\noutputs: [a]"
    with pytest.raises(PipelineError, match=rf"p.yaml:2:\d+: {message}"):
        loads(text, "p.yaml", registry({**STEPS, **OWN}))


def test_a_plugin_that_marks_what_it_has_not_is_told() -> None:
    module = types.ModuleType("risky")
    module.tactile_graph_steps = hookimpl(lambda: OWN)  # type: ignore[attr-defined]
    module.tactile_graph_isolated = hookimpl(lambda: {"mody": None})  # type: ignore[attr-defined]
    (plugin,) = Registry([("risky", "risky-package", "1", lambda: module)]).plugins
    assert "tactile_graph_isolated: it has no step 'mody'; did you mean 'moody'" in plugin.error


def test_ctrl_c_reaches_no_process_of_a_step() -> None:
    runner = pipeline("step: elsewhere, in: frame, isolated: true").runner()
    number = runner(frame(1))["risky"]
    os.kill(number, signal.SIGINT)
    time.sleep(0.2)
    assert runner(frame(2))["risky"] == number


def test_a_step_that_hangs_ends_with_who_began_its_process() -> None:
    began = subprocess.run([sys.executable, "-c", ABANDONS], stdout=subprocess.PIPE, check=True)
    number = int(began.stdout)
    for _ in range(200):
        try:
            os.kill(number, 0)
        except ProcessLookupError:
            return
        stat = Path(f"/proc/{number}/stat")
        if stat.exists() and stat.read_text().rpartition(")")[2].split()[0] == "Z":
            return  # nobody is there to take note of its end
        time.sleep(0.1)
    os.kill(number, signal.SIGKILL)
    raise AssertionError("it goes on")


ABANDONS = """
import os, pickle, subprocess, sys, time
from tactile_graph.engine.calls.isolated_worker import received, sent
worker = subprocess.Popen(
    [sys.executable, "-m", "tactile_graph.engine.calls.isolated_worker"],
    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
)
sent(worker.stdin, sys.path)
sent(worker.stdin, (0, pickle.dumps((time.sleep, {}, False))))
received(worker.stdout)
sent(worker.stdin, (0, (600,), {}))
time.sleep(0.2)
print(worker.pid, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(not hasattr(signal, "SIGRTMIN"), reason="real-time signals")
def test_a_signal_without_a_name_is_told_by_its_number() -> None:
    assert how_ended(-signal.SIGKILL) == "by SIGKILL"
    assert how_ended(-(signal.SIGRTMIN + 3)) == f"by signal {signal.SIGRTMIN + 3}"
    assert (how_ended(3), how_ended(None)) == ("with code 3", "with code None")
