"""Open a source: its settings filled in, its randomness seeded, its frames watched."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tactile_graph.engine.outcomes.outcome import raised_at
from tactile_graph.errors import DataError, Degenerate, Skip, TactileGraphError, UsageError, text_of
from tactile_graph.files import lies_beside
from tactile_graph.pipeline.graph import Source
from tactile_graph.steps.injected import Report
from tactile_graph.steps.stacked import stacked_form
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.frame_stack import FrameStack


def open_source(
    source: Source, seed: int, report: Report, in_stacks: bool = False
) -> Iterator[Any]:
    """Yield the frames of a source.

    Parameters
    ----------
    source : Source
        The step and its validated settings.
    seed : int
        Seeds the source's generator, if it takes one.
    report : Report
        Receives the source's counters and troubles.
    in_stacks : bool
        Whether it may yield a `FrameStack` for many frames, where its step has such a form.

    Raises
    ------
    DataError
        If the source yields something that is no frame, or raises what nobody wrote for people:
        which source, what, and where in its code.
    """
    try:
        yield from _frames(source, seed, report, in_stacks)
    except (Degenerate, Skip) as error:  # words of steps, which go on with the next frame
        told = " ".join(str(error).split())
        raise DataError(f"source {source.name!r}", f"{told} ({raised_at(error)})") from error
    except (UsageError, DataError) as error:
        hint = lies_beside(source.mark.file, source.settings, str(error))
        if not hint:
            raise
        if isinstance(error, DataError):
            raise DataError(error.where, error.what + hint) from error
        raise UsageError(f"{error}{hint}") from error
    except TactileGraphError:
        raise
    except (Exception, SystemExit) as error:  # a source may raise anything
        if isinstance(error, OSError) and error.filename is not None:
            raise  # it names the file
        text = " ".join(f"{type(error).__name__}: {text_of(error)}".split()).removesuffix(":")
        raise DataError(f"source {source.name!r}", f"{text} ({raised_at(error)})") from error


def _frames(source: Source, seed: int, report: Report, in_stacks: bool) -> Iterator[Any]:
    signature = source.signature
    form = stacked_form(signature) if in_stacks else None
    target = signature.target if form is None else form
    injected: dict[str, Any] = {}
    if signature.rng:
        injected[signature.rng] = np.random.default_rng(seed)
    if signature.report:
        injected[signature.report] = report
    frames = target(**signature.arguments(source.settings), **injected)
    number = Numbering()
    try:
        for frame in frames:
            if form is not None and isinstance(frame, FrameStack):
                report.counts["frames"] += len(frame)
                yield frame
                continue
            if not isinstance(frame, Frame):
                raise DataError(
                    f"source {source.name!r}",
                    f"it must yield frames, got {type(frame).__name__}",
                )
            report.counts["frames"] += 1
            yield number(frame)
    finally:
        frames.close()


class Numbering:
    """Number the frames of a source that leaves all of them 0, by sensor; others stay as they are.

    Steps draw their random numbers by the frame's.
    """

    def __init__(self) -> None:
        self._last: dict[str, tuple[int, int]] = {}
        """By label, the number that the last frame came with, and the one that it got."""

    def __call__(self, frame: Frame) -> Frame:
        """Return the next frame."""
        given = frame.index
        before, number = self._last.get(frame.label, (-1, 0))
        if given == before == 0:
            frame = frame.with_index(number + 1)
        self._last[frame.label] = given, frame.index
        return frame
