"""What server and page say to each other: records that go as JSON text over a WebSocket.

Each message is one JSON object; its ``type`` is the name of the record in lower case. Every number
with a unit has it in its name. Whatever is not known is ``null``, never NaN. The page answers each
`Frame` by ``{"type": "pong", "index": …}`` once it is drawn (a page that is hidden: at once): a
viewer has at most `UNANSWERED` frames on the way, always the newest, and one that owes an answer
for `PATIENCE_S` is dropped.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Any, Literal

PROTOCOL = 1
UNANSWERED = 3
"""Frames on their way to a viewer, at most."""
PATIENCE_S = 5.0
Level = Literal["note", "warning", "error"]
Plain = dict[str, Any]


@dataclass(frozen=True)
class Hello:
    """The first message: what is looked at.

    ``live`` is true where a device sends the frames; other sources are paced here and wait when
    they are paused. ``file`` is the pipeline file to open in an editor. ``folder`` is where
    recordings and saved pipelines go.
    """

    pipeline: str
    about: str
    source: str
    live: bool
    file: str
    folder: str
    deadline_us: float | None
    version: str
    protocol: int = PROTOCOL


@dataclass(frozen=True)
class Box:
    """A node as the graph shows it; ``role`` is source, frame, step or choice."""

    name: str
    step: str
    role: str


@dataclass(frozen=True)
class Wire:
    """A line between two boxes; ``kind`` is data, guard or choice."""

    start: str
    end: str
    kind: str


@dataclass(frozen=True)
class Setting:
    """A setting of a node: what it may be, and where a slider begins and ends.

    ``low`` and ``high`` are what is allowed (``null`` without such a bound); a slider goes from
    ``slider_low`` to ``slider_high`` by ``step``. ``kind`` is number, integer, boolean, choice or
    text; a text that is not a plain one is spelled as in YAML. ``changed`` says that the value is
    not the file's but was set on the page.
    """

    name: str
    kind: str
    value: Any
    default: Any
    low: float | None = None
    high: float | None = None
    slider_low: float | None = None
    slider_high: float | None = None
    step: float | None = None
    choices: tuple[Any, ...] = ()
    unit: str = ""
    help: str = ""
    changed: bool = False


@dataclass(frozen=True)
class Apart:
    """That a node's step runs in another process, ended there after so many seconds, if at all.

    ``process`` is the name under which several nodes share one; empty where it is the node's own.
    """

    process: str
    time_limit_s: float | None


@dataclass(frozen=True)
class Node:
    """A node and its settings; ``keeps`` says whether it keeps a state from frame to frame."""

    name: str
    step: str
    about: str
    guard: str
    keeps: bool
    settings: tuple[Setting, ...]
    apart: Apart | None = None


@dataclass(frozen=True)
class Column:
    """A column that rows may have: its key there, its name and unit for people.

    ``units`` has the unit by the quantity of the frames (`Frame.pad`) where it depends on that.
    """

    key: str
    name: str
    unit: str
    units: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Graph:
    """The graph that runs now, ``version`` counting up by one at every change.

    ``yaml`` is the file with what was set on the page in it: what ``save`` writes; ``file_yaml`` is
    the same without that.
    """

    version: int
    name: str
    about: str
    yaml: str
    file_yaml: str
    boxes: tuple[Box, ...]
    wires: tuple[Wire, ...]
    nodes: tuple[Node, ...]
    outputs: tuple[str, ...]
    columns: tuple[Column, ...]
    took_ms: float = 0.0
    """From when the change was seen until it ran."""
    anew: tuple[str, ...] = ()
    """Nodes that keep a state and began anew with it; those that compute the same went on."""


@dataclass(frozen=True)
class Fault:
    """One thing wrong with the file; line and column from 1, 0 where it is nowhere in it."""

    line: int
    column: int
    text: str


@dataclass(frozen=True)
class Trouble:
    """The file as saved is wrong; the old graph keeps running. Empty: it is right again.

    ``title`` says what else is wrong: that the file is gone, or what was set on the page.
    """

    version: int
    errors: tuple[Fault, ...]
    title: str = ""


@dataclass(frozen=True)
class Frame:
    """One frame that ran: the pad, what was drawn on it, and how every node fared.

    Attributes
    ----------
    pad : mapping
        A `picture` of the frame's image: rows, columns, pitch_cm (x, y), origin_cm (x, y),
        quantity, unit, low, high, ``values``: base64 of rows times columns bytes, row by row, 0 for
        low up to 254 for high, 255 where there is no reading, ``readings``: base64 of what each
        cell reads, least byte first, NaN without a reading: float32 where seven digits tell it (4
        bytes a cell), otherwise float64; null for a large pad.
    drawing : sequence of mapping
        What the outputs draw over the pad and, where it is known, the truth: each with ``shape``,
        ``role`` (found or true), ``node``, places in cm. ``circle``: x, y, radius; ``polygon``
        (closed, ``fill`` true for an area) and ``polyline``: xy [[x, y], …]; ``points``: xy;
        ``segments``: xy [[[x, y], [x, y]], …]; ``cross``: x, y; ``text``: x, y, text.
    nodes : mapping
        Node -> outcome (ran, reused, skipped, failed), reason, us.
    pictures : mapping
        Node -> what its value looks like, of the nodes that ``show`` asked for: a list of the same
        shapes, and of ``heat`` (with ``image``, as ``pad``), ``cells`` (the same with values 0 and
        1), ``note`` (name, value).
    rows : sequence of mapping
        A row an object: output, item (from 1), outcome, type, and its fields by the keys of
        `Graph.columns`; ``…_error_…`` where the truth is known.
    decisions : sequence of str
        Nodes that were skipped for the deadline.
    back_s : float
        How long ago it came; over 0 where it is shown again.
    device_time_s : float or None
        The pad's own time, where it sends one.
    arrived_s : float or None
        When it was here, by the clock (``time.perf_counter``) of the machine that serves the page.
    """

    index: int
    time_s: float | None
    version: int
    pad: Plain
    drawing: Sequence[Plain]
    nodes: Mapping[str, Plain]
    pictures: Mapping[str, Sequence[Plain]]
    rows: Sequence[Plain]
    errors: Mapping[str, float]
    decisions: Sequence[str]
    latency_us: float | None
    back_s: float = 0.0
    label: str = ""
    gap: bool = False
    device_time_s: float | None = None
    arrived_s: float | None = None


@dataclass(frozen=True)
class Quantiles:
    """Of times in microseconds; ``null`` while there are none."""

    median: float | None = None
    p99: float | None = None
    most: float | None = None


@dataclass(frozen=True)
class Recording:
    """Whether frames are being recorded, and where to."""

    on: bool = False
    file: str = ""
    frames: int = 0
    label: str = ""
    lost: int = 0


@dataclass(frozen=True)
class Pulse:
    """Four times a second: how the pad and the bench are doing.

    Attributes
    ----------
    rate_hz : float
        Frames a second, over the last second.
    frames, lost, shed : int
        Since the start: done; marked by the source as lost before them; left out here because the
        next were waiting.
    shed_before : int
        Left out here while the pipeline got ready (code was loaded, or compiled): in no ``shed``.
    latency_us : Quantiles
        From a frame's arrival to its result, of all frames of the last seconds.
    page_latency_us : Quantiles
        From a frame's arrival to the page's word that it is drawn, of the last seconds.
    kept_s, kept_frames
        What can be scrubbed back over.
    state : str
        starting (frames come, none is answered yet), running, waiting (nothing comes), ended.
    trouble : str
        Why nothing comes (stalled, unplugged, ended by an error), as long as that lasts.
    counters : mapping
        What the source assumed and counted, in words -> how often.
    """

    rate_hz: float
    frames: int
    lost: int
    shed: int
    missed: int
    """Answers later than the deadline."""
    shed_before: int
    viewers: int
    latency_us: Quantiles
    page_latency_us: Quantiles
    recording: Recording
    paused: bool
    tared: bool
    kept_s: float
    kept_frames: int
    state: str
    trouble: str = ""
    counters: Mapping[str, int] = field(default_factory=dict)
    processes: Mapping[str, Plain] = field(default_factory=dict)
    """Of each node that runs apart (``map/node`` within a mapped pipeline) how its process fares:
    ``restarts``, whether it is ``starting`` just now, and ``why`` the last one ended."""
    beside: Plain | None = None
    """Of the variant that runs in what time is left: ``variant``, ``frames`` it answered, how many
    ``passed`` it by, ``same_outcomes``, ``differences`` (field -> mean and most), ``median_us`` and
    ``beside_median_us``, ``kept`` (numbers of the frames that differ most), ``trouble``."""


@dataclass(frozen=True)
class Told:
    """Something to say: an answer to a command, a pad unplugged or there again."""

    text: str
    level: Level = "note"


Message = Hello | Graph | Trouble | Frame | Pulse | Told

ASKED: Mapping[str, Mapping[str, type | tuple[type, ...]]] = {
    "pause": {},
    "resume": {},
    "step": {},
    "live": {},
    "scrub": {"back_s": (int, float)},
    "tare": {},
    "untare": {},
    "record": {"on": bool, "label": str},
    "set": {"node": str, "setting": str, "value": object},
    "unset": {"node": str, "setting": str},
    "show": {"nodes": list},
    "save": {"name": str},
    "pong": {"index": int},
}
"""What a page may ask, with the fields each takes; ``label`` and those of ``unset`` may be missing.

``scrub`` shows the frame that came so many seconds ago; ``step`` the next one; ``unset`` takes
back a setting, or all that was set; ``save`` writes the graph's YAML under a name into the folder.
"""


def encoded(message: Message) -> str:
    """Return a message as JSON text."""
    return json.dumps(_plain(message, type(message).__name__.lower()), separators=(",", ":"))


def _plain(record: Any, kind: str = "") -> Any:
    if hasattr(record, "__dataclass_fields__"):
        told = {"type": kind} if kind else {}
        return told | {f.name: _plain(getattr(record, f.name)) for f in fields(record)}
    if isinstance(record, tuple | list):
        return [_plain(item) for item in record]
    return record
