"""What a source reports, as Python warnings for who gives no report of his own."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from typing import TypeVar

from tactile_graph.errors import SourceWarning
from tactile_graph.steps.injected import MOST_TOLD, Report

_Frames = TypeVar("_Frames")
OURS = "tactile_graph"
"""With this begin the names of the project's own packages: no warning is about a line of theirs."""


def warned(frames: Iterator[_Frames], source: str, report: Report) -> Iterator[_Frames]:
    """Yield the frames of a source; warn of what it leaves out and assumes, of each once.

    Parameters
    ----------
    frames : iterator
        That report to ``report``; closed with this one.
    source : str
        The step's name.
    report : Report
    """
    teller = _Teller(source, report)
    counts = report.counts
    n_told, troubles_told = 0, 0
    try:
        for frame in frames:
            if len(counts) != n_told or counts["troubles"] != troubles_told:
                teller.tell()
                n_told, troubles_told = len(counts), counts["troubles"]
            yield frame
        teller.tell()
        teller.tell_lost()
    finally:
        if (close := getattr(frames, "close", None)) is not None:
            close()


class _Teller:
    """Warns of what is new in a source's report."""

    def __init__(self, source: str, report: Report) -> None:
        self._source = f"source {source!r}"
        self._report = report
        self._told: set[str] = set()

    def tell(self) -> None:
        """Warn of what is assumed, and of the first troubles, that were not told yet."""
        for what in self._report.assumed:
            self._warn(what)
        for where, what in self._report.troubles[:MOST_TOLD]:
            self._warn(f"{where}: {what}")

    def tell_lost(self) -> None:
        """Warn of how much there was of it, where there was trouble."""
        report = self._report
        if report.counts["troubles"]:
            told = (f"{k}: {n}" for k, n in report.counts.items()
                    if k != "frames" and not k.startswith("recordings "))  # fmt: skip
            self._warn(", ".join(told))

    def _warn(self, what: str) -> None:
        if what not in self._told:
            self._told.add(what)
            warnings.warn(f"{self._source}: {what}", SourceWarning, stacklevel=_level())


def _level() -> int:
    """Return the level of the line that is not the project's, as `_Teller._warn` counts it."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith(OURS):
        frame, level = frame.f_back, level + 1
    return level
