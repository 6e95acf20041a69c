"""``led``: a part of a source's frames, for steps that keep state from those before it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import TYPE_CHECKING

from tactile_graph.errors import RuleError, one_of

if TYPE_CHECKING:
    from tactile_graph.cli.arguments import Span
    from tactile_graph.engine.blocks.gathering import Taken
    from tactile_graph.engine.plan import Plan
    from tactile_graph.wires.frame import Frame
    from tactile_graph.wires.frame_stack import FrameStack


def led(
    frames: Taken,
    span: Span,
    plan: Plan | None,
    run: Callable[[Frame], object],
    block: Callable[[FrameStack], object] | None = None,
) -> Iterator[Frame | FrameStack]:
    """Yield the frames of a span; steps that keep state have seen those before them.

    Parameters
    ----------
    frames : Taken
        All that the source gives.
    span : Span
    plan : Plan or None
        What is run; None where no state is to see them.
    run, block : callable
        Run a frame, or a stack of frames if the source was asked for stacks, through the steps
        that keep state, and note nothing of it.
    """
    before = frames.next(span.start)
    if plan is not None and _leads(span.start, plan):
        _lead(before, span.start, run, block)
    else:
        for _ in before:
            pass
    yield from frames.next(span.most)


def led_one_by_one(
    frames: Iterator[Frame], span: Span, plan: Plan, run: Callable[[Frame], object]
) -> Iterator[Frame]:
    """Yield what `led` does of a source that gives no stacks."""
    from tactile_graph.engine.blocks.gathering import Taken, flat

    return flat(led(Taken(frames), span, plan, run))


def _leads(start: int, plan: Plan) -> bool:
    """Return whether steps are to see the frames before those asked for; say what is done."""
    from tactile_graph.cli.terminal import remark

    keeping = plan.keeping
    if not start or not keeping:
        return False
    sinks = [i.name for i in plan.nodes if i.node is not None and i.node.is_sink]
    if sinks:  # they would write what is not asked for
        remark(f"state begins anew at frame {start} ({one_of(keeping)}): {sinks[0]} writes frames")
        return False
    remark(f"frames before {start} are run first, for state kept by {one_of(keeping)}")
    return True


def _lead(
    frames: Iterator[Frame | FrameStack],
    n: int,
    run: Callable[[Frame], object],
    block: Callable[[FrameStack], object] | None,
) -> None:
    """Show steps that keep state some frames."""
    from tactile_graph.compiled import warm_up
    from tactile_graph.engine.blocks.gathering import Share, is_long
    from tactile_graph.wires.frame import Frame
    from tactile_graph.wires.frame_stack import FrameStack

    if is_long(n):
        warm_up()
    share = Share()
    for some in frames:
        for part in share.parts(some) if isinstance(some, FrameStack) else (some,):
            with suppress(RuleError):  # of another recording, as those of another pad
                if isinstance(part, Frame):
                    run(part)
                elif block is not None:
                    block(part)
