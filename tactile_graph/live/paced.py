"""``paced``: a recording's frames at the pace they were taken at."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from tactile_graph.errors import UsageError
from tactile_graph.live.asked import checked_rate
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.given import as_frames

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tactile_graph.wires.image import Image


def paced(
    frames: Iterable[Frame | Image | NDArray[np.generic]],
    rate_hz: float | None = None,
    *,
    clock_s: Callable[[], float] = time.perf_counter,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[Frame]:
    """Yield frames when they are due: a recording, or a simulation, then comes like a live pad.

    Parameters
    ----------
    frames : iterable of Frame, Image or ndarray
    rate_hz : float, optional
        Frames a second; by the frames' own times if not given.
    clock_s, sleep : callable
        Seconds now, and what waits for some.

    Raises
    ------
    UsageError
        If no rate is given and a frame has no time, the rate is not above 0, or what is given has
        no frames.
    """
    checked_rate(rate_hz)
    given = as_frames(frames)
    start_s = clock_s()
    first_s: float | None = None
    for n, frame in enumerate(given):
        if rate_hz is not None:
            due_s = start_s + n / rate_hz
        elif frame.time_s is None:
            raise UsageError(f"frame {frame.index} has no time: give a rate in frames a second")
        else:
            first_s = frame.time_s if first_s is None else first_s
            due_s = start_s + frame.time_s - first_s
        if (wait_s := due_s - clock_s()) > 0:
            sleep(wait_s)
        yield frame
