"""What a run says in closing: why nodes failed, in a line each, and what is no finite number."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cli import call, install
from tactile_graph import Circle, Degenerate, Frame, Image, loads
from tactile_graph.cli.output.tally import MOST_REASONS, Tally
from tactile_graph.compiled.preparing import preparing
from tactile_graph.engine.tables.columns import columns_of


def nowhere(image: Image) -> Circle:
    peak = image.peak
    return Circle(float("nan") if peak else 9.0, 9.0, 1.0)


def endless(image: Image) -> float:
    return np.float32("inf")  # type: ignore[return-value]


class InPlace:
    """Adds up, in an array that it has given away."""

    def __init__(self) -> None:
        self.sum: Any = None

    def __call__(self, image: Image) -> Image:
        if self.sum is None:
            self.sum = image.values.copy()
        else:
            self.sum += image.values
        return image.with_values(self.sum)


def wordy(image: Image) -> float:
    raise ValueError("one\n  two " + "x" * 500)


def silent(image: Image) -> float:
    raise ValueError


@dataclass(frozen=True)
class Inner:
    q_cm: float


@dataclass(frozen=True)
class Outer:
    inner: Inner
    _own: float = float("nan")


def listed(image: Image) -> list[float | None]:
    return [1.0, None, float("nan")]


def named(image: Image) -> dict[str, list[float]]:
    return {"a": [1.0, float("-inf")]}


def array(image: Image) -> Any:
    return np.array([1.0, np.nan, np.inf])


def nested(image: Image) -> Outer:
    return Outer(Inner(float("nan")))


def circles(image: Image) -> list[Circle]:
    return [Circle(1.0, 1.0, 1.0), Circle(1.0, float("nan"), 1.0)]


def fine(image: Image) -> list[Any]:
    own = Outer(Inner(1.0))
    return [own, {"a": 10**400}, "nan", np.ma.masked_invalid([1.0, np.nan]), np.ones(2, int)]


def three(image: Image) -> list[int]:
    return [1, 2, 3]


def odd(number: int) -> float:
    if number == 2:
        raise Degenerate("2 is even")
    return number / 2


WITHIN = (listed, named, array, nested, circles, fine)
ALL = (nowhere, endless, InPlace, wordy, silent, three, odd, *WITHIN)
STEPS = {f.__name__: f for f in ALL}


@pytest.fixture(autouse=True)
def _steps(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(monkeypatch, hand_made, steps=STEPS)


def run(step: str, *args: object) -> Any:
    nodes = f"nodes: {{a: {{step: {step}, in: frame}}}}, outputs: [a]"
    Path("p.yaml").write_text(f"{{pipeline: p, {nodes}}}")
    return call("run", "p.yaml", "--source", "made", "--frames", 3, *args)


def test_an_output_that_is_no_number_is_told_counted_and_no_error_of_the_others() -> None:
    got = run("nowhere", "--with", "empty=[1]")
    assert got.exit_code == 1
    told = "strange  a.x_cm in 2 frames, first in frame 0: nan, which is no answer\n"
    assert told in got.stdout
    assert got.stdout.endswith(": 1 with all outputs, 2 not finite\n")
    assert "truth    a is off, on average over 2 frames, by radius" in got.stdout


def test_infinity_of_any_precision_is_told_and_kept_in_the_record() -> None:
    got = run("endless", "-o", "out.jsonl")
    assert got.exit_code == 1
    assert "strange  a in 3 frames, first in frame 0: inf" in got.stderr
    assert json.loads(Path("out.jsonl.meta.json").read_text())["result"]["frames_not_finite"] == 3


@pytest.mark.parametrize(
    ("step", "told"),
    [
        ("listed", "a[2] is nan"),
        ("named", "a['a'][1] is -inf"),
        ("array", "a holds 2 numbers of 3 that are not finite"),
        ("nested", "a.inner.q_cm is nan"),
        ("circles", "a[1].y_cm is nan"),
    ],
)
def test_what_is_not_finite_within_an_output_is_told_by_its_place(step: str, told: str) -> None:
    got = run(step, "-o", "out.jsonl")
    assert got.exit_code == 1
    assert f"strange  a in 3 frames, first in frame 0: {told}, which is no answer\n" in got.stderr
    assert json.loads(Path("out.jsonl.meta.json").read_text())["result"]["frames_not_finite"] == 3


def test_what_is_masked_kept_for_itself_or_no_number_is_nothing_strange() -> None:
    got = run("fine", "-o", "out.jsonl")
    assert "strange" not in got.stderr
    assert got.exit_code == 0


def test_writing_into_what_was_given_away_says_what_to_do() -> None:
    got = run("InPlace")
    assert "read-only (" in got.stdout
    assert "; what goes into and comes out of steps is read-only: change a copy\n" in got.stdout


def test_a_wordy_failure_takes_one_line_and_a_silent_one_only_its_type() -> None:
    lines = run("wordy").stdout.splitlines()
    told = next(line for line in lines if line.startswith("failed"))
    assert told.startswith("failed   a in 3 frames, first in frame 0: ValueError: one two xxx")
    assert len(told) < 500
    assert " in wordy)" in told
    assert "first in frame 0: ValueError (" in run("silent").stdout


def by_value(image: Image) -> float:
    raise Degenerate(f"total {float(image.values[0, 0]) / 7!r} is too large")


def by_name(image: Image) -> float:
    raise Degenerate(f"no {'x' * int(image.values[0, 0])} is known")


def tallied(step: Any, numbers: range) -> Tally:
    text = "pipeline: p\nnodes: {a: {step: s, in: frame}}\noutputs: [a]"
    pipeline = loads(text, steps={"s": step})
    tally = Tally(columns_of(pipeline, ("a",)))
    for i in numbers:
        tally.add(pipeline.run(Frame.of(np.full((2, 2), float(i)), index=i)))
    return tally


def closing(tally: Tally) -> list[str]:
    return [line.plain for line in tally._outcomes() if line.plain.startswith("failed")]


def test_failures_that_differ_in_numbers_alone_take_one_line() -> None:
    tally = tallied(by_value, range(40))
    told = "failed   a in 40 frames, first in frame 0: total 0.0 is too large; elsewhere with"
    assert closing(tally) == [f"{told} other numbers"]
    assert closing(tallied(by_value, range(1))) == ["failed   a in frame 0: total 0.0 is too large"]


def test_of_a_node_that_words_each_failure_otherwise_a_few_are_told_and_all_counted() -> None:
    tally = tallied(by_name, range(40))
    lines = closing(tally)
    assert len(lines) == MOST_REASONS + 1
    assert lines[1] == "failed   a in frame 1: no x is known"
    assert lines[-1].startswith(
        "failed   a in 30 frames, first in frame 10: in other words, like: "
    )
    assert tally.data()["failures_by_node"] == {"a": 40}


@pytest.mark.parametrize("step", [by_value, by_name])
def test_what_parts_of_a_run_came_to_is_what_the_whole_did_and_stays_small(step: Any) -> None:
    whole = tallied(step, range(40))
    parts = tallied(step, range(5))
    for start in range(5, 40, 5):
        later = tallied(step, range(start, start + 5))
        parts.join(Tally.of_kept(later.outputs, json.loads(json.dumps(later.kept()))))
    assert parts.kept() == whole.kept()
    assert len(parts.kept()["failed"]) <= MOST_REASONS + 1


def test_an_item_of_a_list_that_failed_is_named_and_the_frame_is_not_whole() -> None:
    nodes = "{a: {step: three, in: frame}, b: {step: odd, in: a, each: true}}"
    Path("p.yaml").write_text(f"{{pipeline: p, nodes: {nodes}, outputs: [b]}}")
    done = call("run", "p.yaml", "--source", "made", "--frames", 3, "-o", "out.csv")
    assert "failed   b in 3 frames, first in frame 0 (item 2): 2 is even" in done.stderr
    assert "0 with all outputs, 3 with items missing" in done.stderr
    assert done.exit_code == 1
    assert Path("out.csv").read_text().splitlines()[1] == "0,0.0,,item 2 failed: 2 is even,2"
    assert json.loads(Path("out.csv.meta.json").read_text())["result"]["frames_lacking_items"] == 3
    line = json.loads(call("run", "p.yaml", "--source", "made", "-o", "-").stdout.splitlines()[0])
    lacking = {"failed": "2 is even", "origin": "b", "kind": "degenerate", "item": "2"}
    assert line["outputs"]["b"] == [0.5, lacking, 1.5]


# -- notices -------------------------------------------------------------------------------------


def put_down(folder: Path, step: str, readings: Sequence[float], node: str = "c") -> None:
    """Write a recording of one cell, and a pipeline of a step."""
    (folder / "r.txt").write_text("".join(f"{reading}\n" for reading in readings))
    text = f"{{pipeline: p, nodes: {{{node}: {{step: {step}, in: frame}}}}, outputs: [{node}]}}"
    (folder / "p.yaml").write_text(text)


class Counting:
    """Says something of the frames whose peak is above 2."""

    def __call__(self, image: Image) -> float:
        return image.peak

    @staticmethod
    def notice(image: Image) -> str:
        return f"a peak of {image.peak:g} is much" if image.peak > 2 else ""


@pytest.mark.parametrize(
    ("peaks", "told"),
    [
        ([1, 3, 4], "notice   c: a peak of 3 is much (in 2 of 3 frames looked at, first in "
         "frame 1)"),
        ([5], "notice   c: a peak of 5 is much (in frame 0)"),
        ([1, 3], ""),
        ([1, 1], ""),
        ([1, 3, *[1] * 17, 5], "notice   c: a peak of 3 is much (in 2 of 20 frames looked at, "
         "first in frame 1)"),
        ([3, *[1] * 19, 5], ""),
    ],
)  # fmt: skip
def test_what_a_tenth_of_the_frames_say_is_told_in_closing_and_kept(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch, peaks: list[int], told: str
) -> None:
    install(monkeypatch, hand_made, steps={"counting": Counting})
    put_down(hand_made, "counting", peaks)
    got = call("run", "p.yaml", "r.txt", "-o", "out.jsonl")
    assert got.exit_code == 0
    lines = [line for line in (got.stdout + got.stderr).splitlines() if line.startswith("notice")]
    assert lines == ([told] if told else [])
    kept = json.loads((hand_made / "out.jsonl.meta.json").read_text())
    words = told.partition(": ")[2].partition(" (")[0]
    assert kept["result"]["notices"] == ({"c": words} if told else {})


class Talkative:
    """Says one thing of high peaks and another of low ones."""

    def __call__(self, image: Image) -> float:
        return image.peak

    @staticmethod
    def notice(image: Image) -> str:
        return f"{image.peak:g} is much" if image.peak > 2 else f"{image.peak:g} is little"


def test_notices_that_differ_in_more_than_numbers_are_counted_apart(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, hand_made, steps={"talkative": Talkative})
    put_down(hand_made, "talkative", [3, 1, 4, 5, 2])
    got = call("run", "p.yaml", "r.txt")
    lines = (got.stdout + got.stderr).splitlines()
    assert [line for line in lines if line.startswith("notice")] == [
        "notice   c: 3 is much (in 3 of 5 frames looked at, first in frame 0)",
        "notice   c: 1 is little (in 2 of 5 frames looked at, first in frame 1)",
    ]


def test_explain_says_it_of_its_frame(hand_made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(monkeypatch, hand_made, steps={"counting": Counting})
    (hand_made / "r.txt").write_text("1\n3\n")
    nodes = "nodes: {c: {step: counting, in: frame}, l: {step: counting, in: frame, when: c > 9}}"
    (hand_made / "p.yaml").write_text(f"{{pipeline: p, {nodes}, outputs: [c, l]}}")
    assert "notice" not in call("explain", "p.yaml", "r.txt").stdout
    got = call("explain", "p.yaml", "r.txt", "--frame", 1).stdout
    assert got.splitlines()[-1] == "notice  c: a peak of 3 is much"


@dataclass
class Unsure:
    x_cm: float

    @property
    def assumed(self) -> str:
        raise LookupError("what was it")


def unsure(image: Image) -> Unsure:
    return Unsure(image.peak)


def hoarse(image: Image) -> float:
    return image.peak


def lost_voice(image: Image) -> str:
    raise ValueError("no voice")


hoarse.notice = lost_voice  # type: ignore[attr-defined]


def test_a_notice_that_breaks_is_told_by_its_node_and_the_run_goes_on(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, hand_made, steps={"hoarse": hoarse, "unsure": unsure})
    (hand_made / "r.txt").write_text("1\n2\n3\n")
    nodes = "nodes: {h: {step: hoarse, in: frame}, u: {step: unsure, in: frame}}"
    (hand_made / "p.yaml").write_text(f"{{pipeline: p, {nodes}, outputs: [h, u]}}")
    got = call("run", "p.yaml", "r.txt", "-o", "out.jsonl")
    assert got.exit_code == 0
    assert len((hand_made / "out.jsonl").read_text().splitlines()) == 3
    lines = [x for x in got.stderr.splitlines() if x.startswith(("notice", "assumed"))]
    assumed, notice = lines
    assert assumed.startswith("assumed  u: its assumed breaks: LookupError: what was it (")
    assert assumed.endswith("in assumed) (in frame 0)")
    assert notice.startswith("notice   h: its notice breaks: ValueError: no voice (")
    assert "in lost_voice) (in 3 of 3 frames looked at, first in frame 0)" in notice
    explained = call("explain", "p.yaml", "r.txt")
    assert explained.exit_code == 0
    assert "notice  h: its notice breaks: ValueError: no voice" in explained.stdout


@dataclass
class Assuming:
    x_cm: float
    assumed: str = "x is 1"


def assuming(image: Image) -> Assuming:
    return Assuming(1.0)


def alike(value: Assuming) -> Assuming:
    return Assuming(value.x_cm)


def other(value: Assuming) -> Assuming:
    return Assuming(2.0, "x is 2")


def test_what_was_assumed_is_told_of_the_node_that_did_and_of_none_that_hands_it_on(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, hand_made, steps={"assuming": assuming, "alike": alike, "other": other})
    (hand_made / "r.txt").write_text("1\n2\n3\n")
    nodes = (
        "a: {step: assuming, in: frame}, as_is: {first_of: [a]}, made: {step: alike, in: as_is},"
        " b: {step: other, in: made}, c: {step: assuming, in: frame}"
    )
    (hand_made / "p.yaml").write_text(f"{{pipeline: p, nodes: {{{nodes}}}, outputs: [made, b, c]}}")
    got = call("run", "p.yaml", "r.txt", "-o", "out.jsonl")
    assert got.exit_code == 0
    assert [x for x in got.stderr.splitlines() if x.startswith("assumed")] == [
        "assumed  a: x is 1 (in frame 0)",
        "assumed  b: x is 2 (in frame 0)",
        "assumed  c: x is 1 (in frame 0)",
    ]


def by_reading(image: Image) -> Assuming:
    return Assuming(1.0, f"x is {image.values.max():g}")


def test_of_what_was_assumed_anew_in_each_frame_the_range_is_told(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(monkeypatch, hand_made, steps={"by_reading": by_reading})
    put_down(hand_made, "by_reading", [2.5, 0.5, 40], "a")
    told = "assumed  a: x is 2.5 (in frame 0; 0.5 to 40 in the frames looked at)"
    got = call("run", "p.yaml", "r.txt", "-o", "out.jsonl")
    assert got.exit_code == 0
    assert [x for x in got.stderr.splitlines() if x.startswith("assumed")] == [told]


def test_the_ranges_of_parts_are_joined() -> None:
    parts = []
    for k, low in enumerate((2.5, -1.0)):
        part = Tally([], assumed={"a": (f"x is {low:g}", k)}, ranges={"a": (low, 40.0 + k)})
        parts.append(Tally.of_kept([], json.loads(json.dumps(part.kept()))))
    parts[0].join(parts[1])
    assert parts[0].assumed == {"a": ("x is 2.5", 0)}
    assert parts[0].ranges == {"a": (-1.0, 41.0)}


@dataclass
class Columnless:
    x_cm: float
    columns_shown = ("gone_cm",)

    @property
    def gone_cm(self) -> float:
        raise AttributeError("it is gone")


@dataclass
class Summing:
    x_cm: float

    def summary(self) -> dict[str, float]:
        raise LookupError("no sum")


def columnless(image: Image) -> Columnless:
    return Columnless(image.peak)


def summing(image: Image) -> Summing:
    return Summing(image.peak)


@pytest.mark.parametrize(
    ("step", "form", "told"),
    [
        (columnless, "csv", "output 'n': its row of numbers breaks: AttributeError: "),
        (columnless, "jsonl", "output 'n': its line of JSON breaks: AttributeError: "),
        (summing, "jsonl", "output 'n': its line of JSON breaks: LookupError: no sum ("),
    ],
)
def test_a_record_that_cannot_be_written_is_told_by_its_output(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch, step: Any, form: str, told: str
) -> None:
    install(monkeypatch, hand_made, steps={"s": step})
    (hand_made / "r.txt").write_text("1\n2\n")
    text = "{pipeline: p, nodes: {n: {step: s, in: frame}}, outputs: [n]}"
    (hand_made / "p.yaml").write_text(text)
    got = call("run", "p.yaml", "r.txt", "--format", form)
    assert got.exit_code == 2
    assert f"error: {told}" in got.stderr
    call("run", "p.yaml", "r.txt", "-o", f"out.{form}")
    assert not [*hand_made.glob("out*")]


def test_the_rate_of_frames_leaves_out_the_time_of_the_compiler(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Not that of a kernel whose frame does not come any more: it is no part of the seconds."""
    for compiling_s, told in (
        (0.5, "40 frames in 12.00 s (3.333 a second): "),
        (10.0, "40 frames in 12.00 s, 10.0 s of it compiling (20 a second): "),
    ):
        tally = Tally([], n=40)
        monkeypatch.setattr(preparing, "_spent_s", preparing.spent_s + compiling_s)
        tally.join(Tally([]))
        tally.seconds = 12.0
        monkeypatch.setattr(preparing, "_spent_s", preparing.spent_s + 30.0)
        assert tally._last("").plain.startswith(told)
