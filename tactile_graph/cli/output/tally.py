"""Count what the frames of a run came to, and say it in closing."""

from __future__ import annotations

import math
import re
import time
from collections.abc import Callable, Iterator
from dataclasses import astuple, dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.text import Text

from tactile_graph.api.result import Result
from tactile_graph.cli.output.live_table import shown
from tactile_graph.compiled.preparing import WORTH_A_LINE_S, preparing
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.outcomes.notices import assumed_by, notices
from tactile_graph.engine.outcomes.outcome import Failed, Skipped, item_words
from tactile_graph.engine.tables.block_columns import Part, known_finite, parts_of
from tactile_graph.engine.tables.columns import OutputColumns, values_of
from tactile_graph.engine.tables.strange import strange_within
from tactile_graph.steps.injected import Report
from tactile_graph.wires.stacks import Stack

LOOKED_THROUGH = 100
"""Frames at the beginning in which nodes are asked what they assume, and have to say."""
OFTEN = 0.1
"""Share of those frames from which on what a step says of them is told."""
COUNTS = (
    "n", "n_failed", "n_skipped", "n_lacking", "n_not_finite", "n_items_failed",
)  # fmt: skip
LONGEST_REASON = 300
MOST_REASONS = 10
"""Of one node, that differ in more than numbers: further ones are counted together."""
OTHERWISE = "…"
_DECIMAL = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_NUMBER = re.compile(r"0x[\da-f]+|[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", re.I)
READ_ONLY = "; what goes into and comes out of steps is read-only: change a copy"


@dataclass
class _Kept:
    """How often something happened, and what is to be said of the first time."""

    text: str
    item: tuple[int, ...]
    first_frame: int
    last_frame: int = -1
    n: int = 0
    """Frames; several items of one frame count once."""
    words: str = ""
    """What was said the first time, in full."""
    varies: bool = False
    """Whether other times had other words."""

    def join(self, later: _Kept) -> None:
        """Take in what came of later frames."""
        self.n += later.n - (later.first_frame == self.last_frame)
        self.last_frame = later.last_frame
        self.varies |= later.varies or later.words != self.words


@dataclass
class _Error:
    unit: str
    n: int = 0
    total: float = 0.0
    most: float = 0.0

    def join(self, later: _Error) -> None:
        """Take in what came of later frames."""
        self.n += later.n
        self.total += later.total
        self.most = max(self.most, later.most)

    def add(self, value: float) -> None:
        self.n += 1
        self.total += abs(value)
        self.most = max(self.most, abs(value))


@dataclass
class _Noticed:
    """What a node had to say in the frames looked through.

    ``told`` holds, by words without their numbers, the first text, its frame, and how many frames
    said the like.
    """

    n_ran: int = 0
    told: dict[str, tuple[str, int, int]] = field(default_factory=dict)

    def add(self, text: str, frame: int) -> None:
        self.n_ran += 1
        if text:
            first, at, n = self.told.get(key := _NUMBER.sub("#", text), (text, frame, 0))
            self.told[key] = (first, at, n + 1)

    def join(self, later: _Noticed) -> None:
        """Take in what came of later frames."""
        self.n_ran += later.n_ran
        for key, (text, frame, more) in later.told.items():
            first, at, n = self.told.get(key, (text, frame, 0))
            self.told[key] = (first, at, n + more)

    @property
    def usual(self) -> list[tuple[str, str]]:
        """What a tenth of the frames or more said, and in how many; one may be a faulty reading.

        Where that said something but no two the like, the first of it.
        """
        often = [kind for kind in self.told.values() if self._is_often(kind[2])]
        n = sum(n for _, _, n in self.told.values())
        if not often and self._is_often(n):
            text, frame, _ = next(iter(self.told.values()))
            often = [(text, frame, n)]
        return [(text, self._times(frame, n)) for text, frame, n in often]

    def _is_often(self, n: int) -> bool:
        return n >= OFTEN * self.n_ran and (n > 1 or n == self.n_ran == 1)

    def _times(self, frame: int, n: int) -> str:
        if self.n_ran == 1:
            return f"in frame {frame}"
        return f"in {n} of {self.n_ran} frames looked at, first in frame {frame}"


@dataclass
class Tally:
    """What a run, or a part of one, came to so far.

    Parameters
    ----------
    outputs : list of OutputColumns
    n_looked : int
        How many frames at the beginning are looked through.
    n, n_failed, n_skipped : int
        Frames, those of which an output failed, and those of which one was skipped and none failed.
    n_lacking : int
        Frames with all outputs, in the lists of which items failed or were skipped.
    n_not_finite : int
        Frames with all outputs and items, of which one holds NaN or infinity.
    n_items_failed : int
    assumed : dict
        What a node took that nobody said, and in which frame first.
    ranges : dict
        By node, the least and the largest of the first numbers in what it took, in the same words.
    noticed : dict
        By node, what it has to say of its answers.
    failed, skipped, not_finite : dict
        By node and reason, how often and where first. Reasons of failures that differ in numbers
        alone are one; beyond the first few of a node they are one as well.
    errors : dict
        By output and quantity, against the truth.
    started, seconds : float
        On the clock of `time.perf_counter`, and from then to the last frame.
    prepared_s, compiling_s : float
        Time that the compiler had taken before, and that it took from then to the last frame.
    """

    outputs: list[OutputColumns]
    n_looked: int = LOOKED_THROUGH
    n: int = 0
    n_failed: int = 0
    n_skipped: int = 0
    n_lacking: int = 0
    n_not_finite: int = 0
    n_items_failed: int = 0
    assumed: dict[str, tuple[str, int]] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    noticed: dict[str, _Noticed] = field(default_factory=dict)
    failed: dict[tuple[str, str], _Kept] = field(default_factory=dict)
    skipped: dict[tuple[str, str], _Kept] = field(default_factory=dict)
    not_finite: dict[tuple[str, str], _Kept] = field(default_factory=dict)
    errors: dict[str, dict[str, _Error]] = field(default_factory=dict)
    started: float = field(default_factory=time.perf_counter)
    seconds: float = 0.0
    prepared_s: float = field(default_factory=lambda: preparing.spent_s)
    compiling_s: float = 0.0

    def add(self, result: Result) -> None:
        """Count a frame."""
        self.n += 1
        if self.n <= self.n_looked:
            self._assumed(result)
            self._noticed(result)
        classes = {result.outcome(o.output).__class__ for o in self.outputs}
        self.n_failed += Failed in classes
        self.n_skipped += Skipped in classes and Failed not in classes
        for failure in result.failures:
            words = failure.reason.partition("\n")[0][:LONGEST_REASON]
            key = self._place((failure.origin, _NUMBER.sub("#", words)))
            self._keep(self.failed, key, result, failure, _why, words)
        strange = False
        for output in self.outputs:
            outcome = result.outcome(output.output)
            if isinstance(outcome, Skipped):
                self._keep(self.skipped, (output.output, outcome.origin), result, outcome)
            elif not isinstance(outcome, Failed):
                values = values_of(result, output)
                strange = self._look(output, values, result, outcome) or strange
                self._compare(output, values)
        good = Failed not in classes and Skipped not in classes
        empty = [gap for found in result.gaps.values() for gap in found]
        for gap in empty:
            if isinstance(gap, Skipped):
                self._keep(self.skipped, (gap.origin, gap.origin), result, gap)
        self.n_lacking += good and bool(empty)
        self.n_items_failed += sum(isinstance(gap, Failed) for gap in empty)
        self.n_not_finite += strange and good and not empty
        self._now()

    def _place(self, key: tuple[str, str]) -> tuple[str, str]:
        """Return under which node and reason a failure is counted: its own where there is room."""
        if key in self.failed:
            return key
        n_reasons = sum(node == key[0] for node, _ in self.failed)
        return key if n_reasons < MOST_REASONS else (key[0], OTHERWISE)

    def _now(self) -> None:
        """Note the time: what is compiled for a frame that does not come any more is beyond it."""
        self.seconds = time.perf_counter() - self.started
        self.compiling_s = preparing.spent_s - self.prepared_s

    def add_block(self, block: Block[Result]) -> None:
        """Count several frames, as `add` counts each."""
        more = block.frames.says_more
        single = np.ones(len(block), np.bool_)
        alike: list[Part] = []
        for part in parts_of(block, [o.output for o in self.outputs]):
            if not self._finite(part):
                continue
            alike.append(part)
            single[part.rows] = more[part.rows]
            single[part.rows[0]] = True  # the first of its kind says how it is told
        single[: max(self.n_looked - self.n, 0)] = True
        rows = np.flatnonzero(single).tolist()
        for row in rows:
            self.add(block[row])
        for part in alike:
            self._add_alike(part.outcomes, block.frames.index[part.rows[~single[part.rows]]])
        self.n += len(block) - len(rows)
        self._now()

    def _finite(self, part: Part) -> bool:
        """Return whether frames of a block are known to be good or skipped, by arrays."""
        for output in self.outputs:
            outcomes = part.outcomes[output.output]
            if isinstance(outcomes, Stack) and not known_finite(outcomes):
                return False
        return True

    def _add_alike(self, outcomes: dict[str, Any], frames: NDArray[np.int64]) -> None:
        """Count frames that came to the same as one counted before: values, and the same skips."""
        if not len(frames):
            return
        skipped = {name: o for name, o in outcomes.items() if not isinstance(o, Stack)}
        self.n_skipped += len(frames) if skipped else 0
        for name, told in skipped.items():
            kept = self.skipped[(name, told[0].origin)]
            kept.n += len(frames)
            kept.first_frame = min(kept.first_frame, int(frames[0]))
            kept.last_frame = max(kept.last_frame, int(frames[-1]))

    @staticmethod
    def _keep(
        where: dict[tuple[str, str], _Kept],
        key: tuple[str, str],
        result: Result,
        outcome: Any,
        said: Callable[[Any], str] = lambda outcome: str(outcome.reason),
        words: str = "",
    ) -> None:
        frame = result.frame.index
        kept = where.get(key)
        if kept is None:
            item = tuple(getattr(outcome, "item", ()))
            kept = where[key] = _Kept(said(outcome), item, frame, words=words)
        kept.n += kept.last_frame != frame or kept.n == 0
        kept.last_frame = frame
        kept.varies |= words != kept.words

    def _assumed(self, result: Result) -> None:
        """Note what nodes took that nobody said."""
        told = {i.name: assumed_by(result.outcome(i.name)) for i in result.plan.nodes}
        for name, text in told.items():
            if not text:
                continue
            if name in self.assumed:
                self._widen(name, text)
            else:
                node = result.plan.pipeline.nodes[name]
                refs = (*node.choices, *(ref for bound in node.inputs for ref in bound.refs))
                if text not in {told.get(ref.node) for ref in refs}:  # else it was handed on
                    self.assumed[name] = (text, result.frame.index)
                    self._widen(name, text)

    def _widen(self, node: str, text: str) -> None:
        """Note the first number in what a node took, which may be another in each frame.

        Words at the end may be, too.
        """
        words = _DECIMAL.sub("#", self.assumed[node][0])
        found, its = _DECIMAL.search(text), _DECIMAL.sub("#", text)
        if found is not None and (its.startswith(words) or words.startswith(its)):
            number = float(found[0])
            low, high = self.ranges.get(node, (number, number))
            self.ranges[node] = (min(low, number), max(high, number))

    def _noticed(self, result: Result) -> None:
        """Note what steps had to say beside their values."""
        for node, text in notices(result).items():
            self.noticed.setdefault(node, _Noticed()).add(text, result.frame.index)

    def _look(
        self, output: OutputColumns, values: dict[str, Any], result: Result, outcome: Any
    ) -> bool:
        """Note each value that is no number and should be one; return whether there is any."""
        strange = [c.key for c in output.values if not _finite(values.get(c.key))]
        for key in strange:
            self._keep(self.not_finite, (key, ""), result, values[key], str)
        within = "" if strange else strange_within(outcome)
        if within:
            told = f"{output.output}{within}"
            self._keep(self.not_finite, (output.output, ""), result, told, str)
        return bool(strange or within)

    def _compare(self, output: OutputColumns, values: dict[str, Any]) -> None:
        errors = self.errors.setdefault(output.output, {})
        for column in output.errors:
            value = values.get(column.key)
            if value is not None and _finite(value):
                errors.setdefault(column.field, _Error(column.unit)).add(value)

    def data(self) -> dict[str, Any]:
        """Return the counts as plain data."""
        failed: dict[str, int] = {}
        for (node, _), kept in self.failed.items():
            failed[node] = failed.get(node, 0) + kept.n
        return {
            "frames": self.n,
            "frames_failed": self.n_failed,
            "frames_skipped": self.n_skipped,
            "frames_lacking_items": self.n_lacking,
            "frames_not_finite": self.n_not_finite,
            "failures_by_node": failed,
            "assumed": {node: told for node, (told, _) in self.assumed.items()},
            "notices": {
                node: "; ".join(text for text, _ in found.usual)
                for node, found in self.noticed.items()
                if found.usual
            },
        }

    # -- of several parts --------------------------------------------------------------------

    def join(self, later: Tally) -> None:
        """Take in what later frames came to, counted elsewhere."""
        for name in COUNTS:
            setattr(self, name, getattr(self, name) + getattr(later, name))
        for node, told in later.assumed.items():
            self.assumed.setdefault(node, told)
        for node, (low, high) in later.ranges.items():
            least, most = self.ranges.get(node, (low, high))
            self.ranges[node] = (min(low, least), max(high, most))
        _join(self.noticed, later.noticed)
        for key, kept in later.failed.items():
            _join(self.failed, {self._place(key): kept})
        _join(self.skipped, later.skipped)
        _join(self.not_finite, later.not_finite)
        for output, errors in later.errors.items():
            _join(self.errors.setdefault(output, {}), errors)
        self._now()

    def kept(self) -> dict[str, Any]:
        """Return all of it as plain data, which `of_kept` makes a tally of again."""
        data: dict[str, Any] = {name: getattr(self, name) for name in COUNTS}
        data["assumed"] = {node: [*told] for node, told in self.assumed.items()}
        data["ranges"] = {node: [*told] for node, told in self.ranges.items()}
        data["noticed"] = {node: astuple(n) for node, n in self.noticed.items()}
        for name in ("failed", "skipped", "not_finite"):
            data[name] = [[*key, *astuple(k)] for key, k in getattr(self, name).items()]
        data["errors"] = {
            output: {name: astuple(e) for name, e in errors.items()}
            for output, errors in self.errors.items()
        }
        return data

    @classmethod
    def of_kept(cls, outputs: list[OutputColumns], data: dict[str, Any]) -> Tally:
        """Return the tally that plain data tell of."""
        tally = cls(outputs, **{name: data[name] for name in COUNTS})
        tally.assumed = {node: (text, frame) for node, (text, frame) in data["assumed"].items()}
        tally.ranges = {node: (low, high) for node, (low, high) in data["ranges"].items()}
        for node, (n_ran, told) in data["noticed"].items():
            tally.noticed[node] = _Noticed(n_ran, {key: (*kind,) for key, kind in told.items()})
        for name in ("failed", "skipped", "not_finite"):
            rows = {(a, b): _Kept(t, tuple(item), *n) for a, b, t, item, *n in data[name]}
            setattr(tally, name, rows)
        tally.errors = {
            output: {name: _Error(*e) for name, e in errors.items()}
            for output, errors in data["errors"].items()
        }
        return tally

    # -- in closing --------------------------------------------------------------------------

    def close(self, console: Console, report: Report, interrupted: str = "") -> None:
        """Print what the run came to and what the source had to say.

        ``interrupted`` says what ended it before its end, if anything did.
        """
        lines = [*self._errors(), *self._outcomes(), *_source(report), self._last(interrupted)]
        for line in lines:
            console.print(line, soft_wrap=True)

    def _errors(self) -> Iterator[Text]:
        for output, errors in self.errors.items():
            parts = [
                f"{name} {shown(e.total / e.n, e.unit)} {e.unit} (most {shown(e.most, e.unit)})"
                for name, e in errors.items()
            ]
            n = max((e.n for e in errors.values()), default=0)
            if parts:
                frames = "frame" if n == 1 else "frames"
                text = f"{output} is off, on average over {n} {frames}, by {', '.join(parts)}"
                yield _labelled("truth", "magenta", text)

    def _outcomes(self) -> Iterator[Text]:
        for (node, reason), kept in self.failed.items():
            other = reason == OTHERWISE
            like = "in other words, like: " if other else ""
            more = "; elsewhere with other numbers" if kept.varies and not other else ""
            yield _labelled("failed", "red", f"{node} {_times(kept)}: {like}{kept.text}{more}")
        for (key, _), kept in self.not_finite.items():
            text = f"{key} {_times(kept)}: {kept.text}, which is no answer"
            yield _labelled("strange", "red", text)
        for node, (told, frame) in self.assumed.items():
            low, high = self.ranges.get(node, (0.0, 0.0))
            others = f"; {low:g} to {high:g} in the frames looked at" if low < high else ""
            yield _labelled("assumed", "cyan", f"{node}: {told} (in frame {frame}{others})")
        for node, found in self.noticed.items():
            for text, times in found.usual:
                yield _labelled("notice", "yellow", f"{node}: {text} ({times})")
        for (output, origin), kept in self.skipped.items():
            at = "" if origin in ("", output) else f"{origin}: "
            text = f"{output} {_times(kept)}: {at}{kept.text}"
            yield _labelled("skipped", "yellow", text)

    def _last(self, interrupted: str) -> Text:
        told, running_s = "", self.seconds
        if self.compiling_s > WORTH_A_LINE_S:
            told = f", {self.compiling_s:.1f} s of it compiling"
            running_s -= self.compiling_s
        rate = f" ({self.n / running_s:.4g} a second)" if running_s > 0 and self.n else ""
        frames = "frame" if self.n == 1 else "frames"
        text = Text.assemble(
            (f"{interrupted}: " if interrupted else "", "bold red"),
            (f"{self.n} {frames} in {self.seconds:.2f} s{told}{rate}", "bold"),
        )
        if not self.n:
            return text
        good = self.n - self.n_failed - self.n_skipped - self.n_lacking - self.n_not_finite
        parts = [(f"{good} with all outputs", "green" if good else "")]
        parts += [(f"{self.n_lacking} with items missing", "red")] if self.n_lacking else []
        parts += [(f"{self.n_not_finite} not finite", "red")] if self.n_not_finite else []
        parts += [(f"{self.n_skipped} skipped", "yellow")] if self.n_skipped else []
        parts += [(f"{self.n_failed} failed", "red")] if self.n_failed else []
        for i, (part, style) in enumerate(parts):
            text.append(", " if i else ": ")
            text.append(part, style=style)
        return text


_Part = TypeVar("_Part", _Kept, _Noticed, _Error)


def _join(mine: dict[Any, _Part], later: dict[Any, _Part]) -> None:
    for key, part in later.items():
        if key in mine:
            mine[key].join(part)
        else:
            mine[key] = part


def _finite(value: Any) -> bool:
    return not isinstance(value, float | np.floating) or math.isfinite(value)


def _why(failure: Failed) -> str:
    """Return why a node failed in one line, with what to do where that is known."""
    text = " ".join(failure.reason.split()).removesuffix(":")
    if len(text) > LONGEST_REASON:
        text = f"{text[:LONGEST_REASON]}…"
    if failure.kind == "error":
        # A condition has no file: it says itself where the trouble is.
        where = failure.step if failure.where.startswith("<condition>") else failure.where
        text += f" ({where})" if where else ""
        text += READ_ONLY if "read-only" in failure.reason else ""
    return text


def _times(kept: _Kept) -> str:
    first = f"frame {kept.first_frame}"
    first += f" ({item_words(kept.item)})" if kept.item else ""
    return f"in {first}" if kept.n == 1 else f"in {kept.n} frames, first in {first}"


def _source(report: Report) -> Iterator[Text]:
    told = {k: n for k, n in report.counts.items() if k not in ("frames", "troubles")}
    if told:
        yield _labelled("source", "cyan", ", ".join(f"{k}: {n}" for k, n in told.items()))
    for line in report.few_troubles():
        yield _labelled("source", "cyan", line)


def _labelled(label: str, style: str, text: str) -> Text:
    return Text.assemble((f"{label:<8}", style), " ", text)
