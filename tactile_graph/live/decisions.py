"""What a live run decided, read from the lines it wrote, and the frames it was decided for."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tactile_graph.engine.deadlines.options import Recorded
from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.text_files import open_text
from tactile_graph.wires.frame import Frame

KEY = "deadline"
"""Under which a line names the nodes that were skipped to keep the deadline."""


@dataclass(frozen=True, slots=True)
class Decided:
    """What a line says: of which frame it is, and what was skipped in it."""

    where: str
    label: str
    index: int
    skipped: frozenset[str]

    @property
    def frame(self) -> tuple[str, int]:
        """What tells the frame from others."""
        return self.label, self.index


def decisions_in(path: Path, nodes: Collection[str]) -> Iterator[Decided]:
    """Yield what each of a file's JSON lines says, as these are asked for.

    Parameters
    ----------
    path : Path
        Lines with ``frame`` and, where nodes were skipped for it, ``deadline``.
    nodes : collection of str
        Of the pipeline.

    Raises
    ------
    DataError
        If a line is no such line, or names a node that the pipeline has not.
    """
    try:
        with open_text(path) as lines:
            for number, line in enumerate(lines, 1):
                yield _decided(f"{path}:{number}", line, nodes)
    except (OSError, UnicodeDecodeError) as error:
        raise DataError(str(path), f"cannot be read: {error}") from error


def _decided(where: str, line: str, nodes: Collection[str]) -> Decided:
    try:
        row: Any = json.loads(line)
    except (ValueError, RecursionError) as error:
        raise DataError(where, f"is no JSON line: {error}") from None
    index = row.get("frame") if isinstance(row, dict) else None
    if not isinstance(index, int) or isinstance(index, bool):
        raise DataError(where, "has no 'frame': lines are wanted that a run wrote (-o FILE.jsonl)")
    skipped = row.get(KEY, [])
    if not isinstance(skipped, list) or not all(isinstance(name, str) for name in skipped):
        raise DataError(where, f"{KEY!r} is a list of nodes, got {skipped!r}")
    for name in skipped:
        if name not in nodes:
            hint = did_you_mean(name, nodes) or f"; there are: {one_of(nodes)}"
            raise DataError(where, f"the pipeline has no node {name!r}{hint}")
    return Decided(where, str(row.get("label", "")), index, frozenset(skipped))


def as_decided(
    frames: Iterable[Frame], decisions: Iterable[Decided], recorded: Recorded
) -> Iterator[Frame]:
    """Yield the frames that were decided about, each with its decisions in place.

    Frames between them were never answered (lost, or shed), and no state has seen them.

    Parameters
    ----------
    frames : iterable of Frame
    decisions : iterable of Decided
        In the order of the frames.
    recorded : Recorded
        Of the runner that takes the frames, one after the other.

    Raises
    ------
    DataError
        If frames end before the decisions do.
    """
    coming = iter(frames)
    for decided in decisions:
        for frame in coming:
            if (frame.label, frame.index) == decided.frame:
                recorded.skipped = decided.skipped
                yield frame
                break
        else:
            raise DataError(
                decided.where,
                f"is of frame {decided.index}, which the source does not give (or not in this "
                "order): decisions belong to the recording they were taken on",
            )
