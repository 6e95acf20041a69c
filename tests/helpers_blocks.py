"""What a block of frames came to, held against the same frames one after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from tactile_graph import Frame, Pipeline
from tactile_graph.engine.outcomes.outcome import Failed, Skipped
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.testing.same import same
from tactile_graph.wires.frame_stack import in_stacks


def one_by_one(pipeline: Pipeline, frames: Sequence[Frame], **rest: Any) -> list[Any]:
    runner = pipeline.runner(**rest)
    return [runner(frame) for frame in frames]


def in_blocks(pipeline: Pipeline, frames: Sequence[Frame], size: int, **rest: Any) -> Iterator[Any]:
    runner = pipeline.runner(**rest)
    for start in range(0, len(frames), size):
        for stack in in_stacks(frames[start : start + size]):
            yield from runner.block(stack)


def told(outcome: Any) -> Any:
    """Return an outcome as plain data: what it is, where it began, and why."""
    if isinstance(outcome, Skipped):
        return ("skipped", outcome.origin, outcome.item, outcome.reason)
    if isinstance(outcome, Failed):
        where = outcome.where.rpartition("/")[2]
        return (
            "failed", outcome.origin, outcome.item, outcome.reason, where, outcome.inputs,
            outcome.step,
        )  # fmt: skip
    if isinstance(outcome, tuple):
        return tuple([told(item) for item in outcome])
    return outcome


def differences(result: Outcomes, expected: Outcomes) -> list[str]:
    """Return what of a result is not, to the last bit, what is expected."""
    found = []
    for name in [*expected.plan.asked, *expected.plan.pipeline.nodes]:
        one, other = told(result.outcome(name)), told(expected.outcome(name))
        if not same(one, other):
            found.append(f"frame {expected.frame.index}, {name}: {one} for {other}")
    if result.reused != expected.reused:
        found.append(f"frame {expected.frame.index}: reused {result.reused}")
    if [told(f) for f in result.failures] != [told(f) for f in expected.failures]:
        found.append(f"frame {expected.frame.index}: failures {result.failures}")
    if result.frame.index != expected.frame.index:
        found.append(f"frame {expected.frame.index}: got {result.frame.index}")
    return found


def assert_blocks_are_frames(
    pipeline: Pipeline, frames: Sequence[Frame], size: int = 64, **rest: Any
) -> list[Any]:
    """Return the results of frames in blocks, that are those of one after the other."""
    expected = one_by_one(pipeline, frames, **rest)
    results = [*in_blocks(pipeline, frames, size, **rest)]
    assert len(results) == len(expected)
    assert [d for r, e in zip(results, expected, strict=True) for d in differences(r, e)] == []
    return results
