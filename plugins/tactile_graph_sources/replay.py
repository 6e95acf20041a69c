"""The source step ``replay``: a recording at the pace it was made, or any other."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Annotated

from annotated_types import Gt

from tactile_graph.errors import DataError
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph_sources.recording import recording

LOOK_S = 0.2
"""How often it is looked, in a pause, whether a frame is wanted still."""


def replay(
    *,
    path: Path,
    speed: Annotated[float, Gt(0.0)] | None = 1.0,
    rate_hz: Annotated[float, Gt(0.0)] | None = None,
    longest_pause_s: Annotated[float, Gt(0.0)] | None = None,
    loop: bool = False,
    report: Report,
) -> Iterator[Frame]:
    """Frames of a recording, each when its turn has come.

    Parameters
    ----------
    path : Path
        A Zarr store, or any file the source ``recording`` reads.
    speed : float, optional
        2 plays twice as fast as it was recorded; None as fast as frames are taken.
    rate_hz : float, optional
        Frames a second at speed 1, instead of the recorded times; needed where there are none.
    longest_pause_s : float, optional
        Cut longer pauses to so many seconds of recorded time.
    loop : bool
        Start over at the end, for ever.
    report : Report

    Yields
    ------
    Frame
        As recorded, times included; the first of each further round is marked as after a gap.

    Raises
    ------
    DataError
        If the recording keeps no time, ``rate_hz`` is not given and ``speed`` is not None.
    """
    clock = _Clock(speed, longest_pause_s)
    index = 0
    while True:
        for position, frame in enumerate(recording(path=path, report=report)):
            if speed is not None:
                moment = _moment(path, frame, position, rate_hz)
                if not clock.wait_for(moment, starts=position == 0, report=report):
                    return
            again = position == 0 and index > 0
            yield replace(frame, index=index, gap=frame.gap or again)
            index += 1
        if not loop or index == 0:
            return


def _moment(path: Path, frame: Frame, position: int, rate_hz: float | None) -> float:
    if rate_hz is not None:
        return position / rate_hz
    if frame.time_s is None:
        raise DataError(str(path), f"frame {position} has no time; give rate_hz, or speed: null")
    return frame.time_s


class _Clock:
    """Waits until a moment of the recording is due; never tries to catch up on a slow taker."""

    def __init__(self, speed: float | None, longest_pause_s: float | None) -> None:
        self.speed = speed or 1.0
        self.longest_pause_s = longest_pause_s
        self._due = 0.0
        self._last: float | None = None

    def wait_for(self, moment: float, starts: bool, report: Report) -> bool:
        """Return whether a frame is wanted still once the moment is there."""
        now = time.perf_counter()
        if self._last is None or starts:
            self._due = now
        else:
            step = max(0.0, moment - self._last)  # a clock set back must not stop the play
            if self.longest_pause_s is not None:
                step = min(step, self.longest_pause_s)
            self._due = max(self._due + step / self.speed, now - 1.0)
        self._last = moment
        while (left := self._due - time.perf_counter()) > 0:
            if not report.wanted:
                return False
            time.sleep(min(left, LOOK_S))
        return True
