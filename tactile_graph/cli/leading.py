"""``led``: a part of a source's frames, for steps that keep state from those before it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING

from tactile_graph.errors import RuleError, one_of

if TYPE_CHECKING:
    from tactile_graph.cli.arguments import Span
    from tactile_graph.engine.plan import Plan
    from tactile_graph.wires.frame import Frame


def led(
    frames: Iterator[Frame], span: Span, plan: Plan, run: Callable[[Frame], object]
) -> Iterator[Frame]:
    """Return the frames of a span; steps that keep state have seen those before them.

    Parameters
    ----------
    frames : iterator of Frame
        All that the source gives.
    span : Span
    plan : Plan
        What is run.
    run : callable
        Runs a frame through the steps that keep state, and notes nothing of it.
    """
    from tactile_graph.cli.terminal import console
    from tactile_graph.compiled import warm_up
    from tactile_graph.engine.blocks.gathering import is_long

    start, keeping = span.start, plan.keeping
    if not start or not keeping:
        return span.of(frames)

    def say(text: str) -> None:
        console(stderr=True).print(text, style="yellow", soft_wrap=True)

    sinks = [i.name for i in plan.nodes if i.node is not None and i.node.is_sink]
    if sinks:  # they would write what is not asked for
        say(f"state begins anew at frame {start} ({one_of(keeping)}): {sinks[0]} writes frames")
        return span.of(frames)
    say(f"frames before {start} are run first, for state kept by {one_of(keeping)}")
    if is_long(start):
        warm_up()
    for frame in islice(frames, start):
        with suppress(RuleError):  # of another recording, as those of another pad
            run(frame)
    return islice(frames, span.most)
