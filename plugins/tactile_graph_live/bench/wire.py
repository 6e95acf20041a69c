"""What bench and server say to each other over the pipe between their processes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame
from tactile_graph.live import ProcessState
from tactile_graph_live.server.messages import Frame as Shown
from tactile_graph_live.server.messages import Level

FEW, MANY = 16, 64
"""Frames that wait grow old: without a deadline, which keeps them from that, few may."""
State = Literal["starting", "running", "waiting", "ended"]


@dataclass(frozen=True)
class Order:
    """With what a bench begins.

    Parameters
    ----------
    pickled : bytes
        The pipeline: unpickled only once the plugins are chosen.
    version : int
    seed : int
    deadline_us : float or None
    rate_hz : float or None
        Of frames that are played; by their own times if None.
    once : bool
        Whether what is played ends, instead of starting over.
    unpaced : bool
        Whether frames are taken as fast as they come.
    capacity : int or None
        How many frames may wait for the pipeline; then the oldest is shed. `FEW` if None, or
        `MANY` where there is a deadline.
    selection : str
        The plugins that are chosen.
    beside : bytes
        A variant to run in what time is left, pickled; empty for none.
    baseline : (rows, columns) array or None
        What an earlier bench was tared by.
    held : bool
        Whether what is played waits from the beginning.
    awaited : bool
        Whether a device that is not there is waited for from the beginning: it was there before.
    """

    pickled: bytes
    version: int = 1
    seed: int = 0
    deadline_us: float | None = None
    rate_hz: float | None = None
    once: bool = False
    unpaced: bool = False
    capacity: int | None = None
    selection: str = ""
    beside: bytes = b""
    baseline: NDArray[np.float64] | None = None
    held: bool = False
    awaited: bool = False


# -- from the bench ------------------------------------------------------------------------------


@dataclass(frozen=True)
class Snapshot:
    """A frame for the page, and when the sensor's was here (``time.perf_counter_ns``)."""

    frame: Shown
    arrived_ns: int


@dataclass(frozen=True)
class Row:
    """What one frame came to, for programs.

    ``arrived_s`` is by ``time.perf_counter``; ``deadline`` names the nodes skipped to keep it, as
    ``tactile-graph run --decisions`` takes them.
    """

    frame: int
    time_s: float | None
    label: str
    device_time_s: float | None
    arrived_s: float
    latency_us: float
    deadline: tuple[str, ...]
    rows: tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class Rows:
    """Results of frames, in order; ``n_lost`` of them went because the server was not ready."""

    rows: tuple[Row, ...]
    n_lost: int


@dataclass(frozen=True)
class Taken:
    """Frames as the source gave them, to be recorded; ``n_lost`` before them could not be kept.

    After the ``last`` no more are taken until they are wanted again; it comes unasked where the
    source begins anew.
    """

    frames: tuple[Frame, ...]
    n_lost: int
    last: bool = False


@dataclass(frozen=True)
class Summary:
    """All frames since the last summary in numbers; counts are since the start.

    ``latencies_us`` has one for each frame, float32. ``processes`` says how those of nodes fare
    that run in one of their own, ``trouble`` why no frame comes, as long as that lasts. Frames shed
    while the pipeline got ready are ``n_shed_before``, and not in ``n_shed``.
    """

    latencies_us: NDArray[np.float32]
    n_frames: int
    n_lost: int
    n_shed: int
    n_missed: int
    kept_s: float
    kept_frames: int
    state: State
    tared: bool
    counters: Mapping[str, int]
    beside: dict[str, Any] | None = None
    processes: Mapping[str, ProcessState] = field(default_factory=dict)
    trouble: str = ""
    n_shed_before: int = 0


@dataclass(frozen=True)
class Kept:
    """Frames of the last minute: the one asked for stands last, those before it lead up to it.

    ``newer`` says whether a newer one is there.
    """

    ticket: int
    frames: tuple[Frame, ...]
    back_s: float
    newer: bool
    baseline: NDArray[np.float64] | None


@dataclass(frozen=True)
class Tared:
    """What is taken off the readings from now on; None where that was taken back."""

    baseline: NDArray[np.float64] | None


@dataclass(frozen=True)
class Swapped:
    """The pipeline of this version runs, or why it does not.

    ``anew`` names the nodes which keep something from frame to frame and begin anew.
    """

    version: int
    error: str = ""
    anew: tuple[str, ...] = ()


@dataclass(frozen=True)
class Said:
    """Something the source or the bench has to say."""

    text: str
    level: Level = "note"


@dataclass(frozen=True)
class Ended:
    """The source gives no more; ``error`` says why, if that was no good end."""

    error: str
    n_frames: int


@dataclass(frozen=True)
class Compared:
    """How the variant beside has done, and the frames on which the two differ most.

    ``said`` has for each of ``frames`` the difference, and what each of the two says.
    """

    summary: dict[str, Any]
    frames: tuple[Frame, ...]
    said: tuple[dict[str, Any], ...]


FromBench = Snapshot | Rows | Taken | Summary | Kept | Tared | Swapped | Said | Ended | Compared

# -- to the bench --------------------------------------------------------------------------------


@dataclass(frozen=True)
class Swap:
    """Run another pipeline, pickled; ``restart`` where its source is another one too."""

    version: int
    pickled: bytes
    restart: bool


@dataclass(frozen=True)
class Show:
    """Take pictures of these nodes."""

    nodes: tuple[str, ...]


@dataclass(frozen=True)
class Tare:
    """Take what lies there now for nothing, or take that back."""

    on: bool


@dataclass(frozen=True)
class Hold:
    """Have what is played wait, or go on."""

    on: bool


@dataclass(frozen=True)
class OneMore:
    """While held: play one frame."""


@dataclass(frozen=True)
class Fetch:
    """Give a kept frame: the first after ``after``, or the one that came ``back_s`` ago."""

    ticket: int
    after: int | None
    back_s: float
    lead: int


@dataclass(frozen=True)
class Want:
    """Which streams are wanted: a row for each frame, the frames themselves."""

    rows: bool
    frames: bool


@dataclass(frozen=True)
class Compare:
    """Say how the variant beside has done."""


@dataclass(frozen=True)
class End:
    """End the bench."""


ToBench = Swap | Show | Tare | Hold | OneMore | Fetch | Want | Compare | End
