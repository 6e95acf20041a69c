"""A runner takes the place of another: what computes the same goes on with its state."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path
from threading import Barrier, Thread
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings

from helpers_graphs import STEPS, cases, frame, registry, shown
from tactile_graph import Image, Pipeline, loads
from tactile_graph.errors import Degenerate, UsageError
from tactile_graph.wires.frame_stack import FrameStack

FLOW = """
pipeline: sums
nodes:
  number: {step: read, in: frame}
  more: {step: add1, in: number, with: {k: 1}}
  sum: {step: count, in: number}
  sum_of_more: {step: count, in: more}
outputs: [sum, sum_of_more]
"""


def pipeline(text: str = FLOW) -> Pipeline:
    return loads(text, "p.yaml", registry(STEPS))


def sums(runner: Any, index: int) -> tuple[int, int]:
    result = runner(frame(10, index))
    return result["sum"], result["sum_of_more"]


def test_a_bare_array_is_told_to_be_no_frame() -> None:
    with pytest.raises(UsageError, match=r"takes frames, got ndarray; Frame\.of"):
        pipeline().runner()(np.ones((2, 2)))  # type: ignore[arg-type]


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[weakref.ref[Any]]:
    """The runners that pipelines have made."""
    found: list[weakref.ref[Any]] = []
    make = Pipeline.runner

    def noted(*given: Any, **more: Any) -> Any:
        runner = make(*given, **more)
        found.append(weakref.ref(runner))
        return runner

    monkeypatch.setattr(Pipeline, "runner", noted)
    return found


def test_as_many_runners_are_made_as_threads_run_at_once(made: list[weakref.ref[Any]]) -> None:
    n = 40
    together = Barrier(n)

    def slow(image: Image) -> Image:
        together.wait(60)
        return image

    text = "pipeline: p\nnodes: {a: {step: slow, in: frame}}\noutputs: [a]\n"
    held = [loads(text, steps={"slow": slow})]

    def work() -> None:
        for i in range(3):
            held[0].run(frame(10 + i, i))

    threads = [Thread(target=work) for _ in range(n)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(made) == n
    held.clear()
    gc.collect()
    assert not [runner for runner in made if runner() is not None]


def test_a_thread_for_each_frame_needs_no_runner_of_its_own(made: list[weakref.ref[Any]]) -> None:
    stateless = pipeline(FLOW.replace("count", "add1"))
    got: list[Any] = []
    for i in range(20):
        thread = Thread(target=lambda i=i: got.append(stateless.run(frame(10, i))["sum"]))
        thread.start()
        thread.join()
    assert got == [11] * 20
    assert len(made) == 1


def test_a_step_may_run_the_pipeline_it_is_in(made: list[weakref.ref[Any]]) -> None:
    def halved(image: Image) -> Image:
        if image.rows == 1:
            return image
        half: Image = own.run(Image(image.values[: image.rows // 2]))["a"]
        return half

    text = "pipeline: p\nnodes: {a: {step: halved, in: frame}}\noutputs: [a]\n"
    own = loads(text, steps={"halved": halved})
    for _ in range(2):
        assert own.run(np.arange(8.0).reshape(4, 2))["a"].values.tolist() == [[0.0, 1.0]]
    assert len(made) == 3


def test_a_runner_whose_frame_is_refused_is_kept(made: list[weakref.ref[Any]]) -> None:
    stateless = pipeline(FLOW.replace("count", "add1"))
    for _ in range(3):
        with pytest.raises(UsageError):
            stateless.run("my.npy")  # type: ignore[arg-type]
    assert len(made) == 1


def test_runners_of_a_bounded_number_of_demands_are_kept() -> None:
    stateless = pipeline(FLOW.replace("count", "add1"))
    for seed in range(40):
        stateless.run(frame(10), seed=seed)
    assert [seed for _, seed in stateless._kept.free] == [*range(24, 40)]


def test_a_node_that_computes_the_same_goes_on_and_one_that_reads_another_begins_anew() -> None:
    first = pipeline().runner()
    assert [sums(first, i) for i in range(2)] == [(10, 11), (20, 22)]
    then = pipeline(FLOW.replace("k: 1", "k: 2")).runner(after=first)
    assert then.anew == ("sum_of_more",)
    assert sums(then, 2) == (30, 12)
    back = pipeline().runner(after=then)
    assert back.anew == ("sum_of_more",)
    assert sums(back, 3) == (40, 11)


def test_a_runner_that_comes_after_none_begins_everything_anew() -> None:
    assert pipeline().runner().anew == ("sum", "sum_of_more")


def test_a_node_keeps_its_state_under_another_name() -> None:
    first = pipeline().runner()
    sums(first, 0)
    then = pipeline(FLOW.replace("sum_of_more", "total")).runner(after=first)
    assert then.anew == ()
    assert then(frame(10, 1))["total"] == 22


class Gained:
    """Times what stands in a file, and counts."""

    def __init__(self, *, gain: Path) -> None:
        self.gain, self.n = int(gain.read_text()), 0

    def __call__(self, image: Image) -> int:
        self.n += 1
        return self.gain * int(image.values[0, 0]) + self.n


class Scaled:
    """Times what stands in a file."""

    def __init__(self, *, gain: Path) -> None:
        self.gain = int(gain.read_text())

    def __call__(self, image: Image) -> int:
        return self.gain * int(image.values[0, 0])


@pytest.mark.parametrize(
    "nodes",
    [
        "s: {step: gained, in: frame, with: {gain: FILE}}",
        "number: {step: scaled, in: frame, with: {gain: FILE}}\n  s: {step: count, in: number}",
    ],
    ids=["of its own", "of what it reads"],
)
def test_a_node_begins_anew_where_a_file_was_changed(tmp_path: Path, nodes: str) -> None:
    file = tmp_path / "gain.txt"
    text = f"pipeline: p\nnodes:\n  {nodes.replace('FILE', str(file))}\noutputs: [s]\n"
    known = registry({**STEPS, "gained": Gained, "scaled": Scaled})

    def fresh() -> Pipeline:
        return loads(text, "p.yaml", known)

    file.write_text("1")
    runner = fresh().runner()
    runner(frame(10))
    runner = fresh().runner(after=runner)
    assert runner.anew == ()
    runner(frame(10))
    file.write_text("7")
    changed = fresh()
    runner = changed.runner(after=runner)
    assert "s" in runner.anew
    assert runner(frame(10))["s"] == changed.run(frame(10))["s"]


def test_a_pipeline_goes_on_as_it_was_loaded_whatever_became_of_its_files(tmp_path: Path) -> None:
    file = tmp_path / "gain.txt"
    file.write_text("1")
    text = f"pipeline: p\nnodes: {{s: {{step: gained, in: frame, with: {{gain: {file}}}}}}}\n"
    graph = loads(text + "outputs: [s]\n", steps={"gained": Gained})
    runner = graph.runner()
    file.write_text("no number")
    assert graph.runner(after=runner).anew == ()


def test_a_step_that_was_redefined_begins_anew() -> None:
    def kept(plus: int) -> type:
        class Kept:
            """Add a number."""

            def __call__(self, image: Image) -> int:
                return plus + int(image.values[0, 0])

        return Kept

    text = "pipeline: p\nnodes: {s: {step: mine, in: frame}}\noutputs: [s]\n"
    first = loads(text, steps={"mine": kept(1)}).runner()
    assert first(frame(10))["s"] == 11
    then = loads(text, steps={"mine": kept(2)}).runner(after=first)
    assert then.anew == ("s",)
    assert then(frame(10))["s"] == 12


def test_the_time_that_passed_is_told_across_the_change() -> None:
    first = pipeline().runner()
    first(frame(10, 0, 1.0))
    then = pipeline(FLOW.replace("k: 1", "k: 2")).runner(after=first)
    assert then(frame(10, 1, 1.5))["sum"] == 20 + 50


@settings(
    max_examples=40,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
    database=None,
)
@given(case=cases())
def _goes_on(folder: Path, case: tuple[dict[str, Any], dict[str, Any]]) -> None:
    document, library = case
    files = {name: folder / f"{name}.yaml" for name in library}
    for name, path in files.items():
        path.write_text(shown(library[name]))
    at_home, runner = (
        loads(shown(document), "random.yaml", registry(STEPS, files)).runner() for _ in range(2)
    )
    for index, number in enumerate((0, 3, 4, 5, 1, 2)):
        one = frame(number, index, 0.5 * index)
        expected = at_home(one).explain()
        assert [(s.node, s.state, s.reason) for s in runner(one).explain()] == [
            (s.node, s.state, s.reason) for s in expected
        ]
        again = loads(shown(document), "random.yaml", registry(STEPS, files))
        runner = again.runner(after=runner)
        assert runner.anew == ()


@pytest.mark.slow
def test_any_pipeline_goes_on_as_if_nothing_had_happened(tmp_path: Path) -> None:
    _goes_on(tmp_path)


def test_an_error_that_passes_is_not_kept_for_equal_frames_nor_for_all() -> None:
    left = [1, 1]

    def busy(image: Image) -> int:
        if left:
            left.pop()
            raise OSError("device busy")
        return 1

    def table() -> int:
        return busy(None)  # type: ignore[arg-type]

    text = "pipeline: p\nnodes: {a: {step: busy, in: frame}, b: {step: table}}\noutputs: [a, b]"
    runner = loads(text, "p.yaml", registry({"busy": busy, "table": table})).runner()
    results = [runner(frame(1, i)) for i in range(3)]
    assert [len(r) for r in results] == [0, 2, 2]
    assert [r.reused for r in results] == [False, False, True]


@pytest.mark.parametrize("in_blocks", [False, True])
def test_what_items_of_a_frame_came_to_that_is_broken_off_is_not_told_of_the_next(
    in_blocks: bool,
) -> None:
    def pair(image: Image) -> list[float]:
        return [image.peak, 1.0]

    def picky(number: float) -> float:
        if number == 9.0:
            raise ValueError("not this one")
        return number

    def broken_off(image: Image) -> float:
        if image.peak == 9.0:
            raise KeyboardInterrupt
        return image.peak

    text = """
pipeline: p
nodes:
  pair: {step: pair, in: frame}
  picky: {step: picky, in: pair, each: true}
  slow: {step: broken_off, in: frame}
outputs: [picky, slow]
"""
    own = {"pair": pair, "picky": picky, "broken_off": broken_off}
    runner = loads(text, "p.yaml", registry(own)).runner()
    run = (lambda f: runner.block(FrameStack.of([f]))[0]) if in_blocks else runner
    with pytest.raises(KeyboardInterrupt):
        run(frame(9))
    result = run(frame(2))
    assert result["picky"] == (2.0, 1.0)
    assert not result.failures


def test_what_hangs_on_no_frame_and_fails_for_its_data_is_tried_once() -> None:
    n = 0

    def table() -> int:
        nonlocal n
        n += 1
        raise Degenerate("no points")

    text = "pipeline: p\nnodes: {b: {step: table}}\noutputs: [b]"
    runner = loads(text, "p.yaml", registry({"table": table})).runner()
    assert {runner(frame(i, i)).outcome("b").reason for i in range(3)} == {"no points"}
    assert n == 1
