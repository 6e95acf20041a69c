"""The live source: a pad on a serial port."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import numpy as np
from annotated_types import Ge, Gt

from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image

if TYPE_CHECKING:
    from tactile_graph_sources.devices.inbox import Arrived
    from tactile_graph_sources.devices.preset import Preset
    from tactile_graph_sources.devices.reader import Reader

REPORT_EVERY_S = 0.2


def serial(
    *,
    port: str,
    preset: str,
    baud: Annotated[int, Gt(0)] | None = None,
    newest: bool = False,
    timeout_s: Annotated[float, Gt(0.0)] = 2.0,
    give_up_s: Annotated[float, Gt(0.0)] | None = None,
    n_frames: Annotated[int, Ge(1)] | None = None,
    seconds: Annotated[float, Gt(0.0)] | None = None,
    queue_size: Annotated[int, Ge(1)] = 1024,
    report: Report,
) -> Iterator[Frame]:
    """Frames of a pad on a serial port, as they come; after an unplug it waits for the pad.

    Parameters
    ----------
    port : str
        A device such as ``/dev/ttyACM0`` or ``COM3``, or a pyserial URL (``socket://``,
        ``rfc2217://``, …).
    preset : str
        The kit's name, or a YAML file that describes it.
    baud : int, optional
        Instead of the preset's.
    newest : bool
        Take only the newest frame (for viewers: bounded delay, the rest is counted as dropped).
        Otherwise every frame, and the pad is held back when they are not taken in time.
    timeout_s : float
        Without a frame for so long the link counts as stalled, with a hint in the report.
    give_up_s : float, optional
        End with an error after so long without a frame; None waits for ever.
    n_frames : int, optional
        End after so many frames.
    seconds : float, optional
        Take the frames that come in so long; end then, whether any came or not.
    queue_size : int
        Frames that may wait to be taken.
    report : Report
        Takes the link's counters, what happened to it and how many frames wait; once none are
        wanted the port is read no more, and what came before ends the frames. It tells whether a
        port that cannot be opened at the start is waited for.

    Yields
    ------
    Frame
        ``time_s`` is the host's clock (`time.perf_counter`) when the last byte came,
        ``device_time_s`` the pad's own clock, ``gap`` true where frames were lost on the way just
        before this one, ``doubtful`` where the protocol cannot tell whether frames start there.

    Raises
    ------
    UsageError
        If the port cannot be opened at the start and is not waited for, or the preset is not known.
    DataError
        If no frame came for ``give_up_s``.
    """
    from tactile_graph_sources.devices.preset_file import load_preset

    kit = load_preset(preset)
    reader = _opened(kit, port, baud, newest, timeout_s, queue_size, report.awaited)
    if n_frames is not None:
        report.expect(n_frames)
    teller = _Teller(reader, report)
    report.n_waiting = 0
    end = math.inf if seconds is None else time.perf_counter() + seconds
    try:
        index = 0
        while n_frames is None or index < n_frames:
            arrived = _next(reader, teller, give_up_s, end)
            report.n_waiting = len(reader.inbox)
            if arrived is None:
                return
            yield _frame(arrived, index, kit, port)
            index += 1
    finally:
        reader.stop()
        report.n_waiting = len(reader.inbox)
        teller.tell(force=True)


class _Teller:
    """Carries the link's counters and events over to the report, in the caller's own thread."""

    def __init__(self, reader: Reader, report: Report) -> None:
        self.reader = reader
        self.report = report
        self._told: dict[str, int] = {}
        self._next = 0.0

    def tell(self, force: bool = False) -> None:
        now = time.perf_counter()
        if now < self._next and not force:
            return
        self._next = now + REPORT_EVERY_S
        for event in self.reader.events():
            self.report.trouble(self.reader.url, event)
        for name, n in self.reader.counts.as_dict().items():
            new = n - self._told.get(name, 0)
            if new:
                self.report.count(name, new)
                self._told[name] = n


def _opened(
    kit: Preset,
    port: str,
    baud: int | None,
    newest: bool,
    timeout_s: float,
    queue_size: int,
    awaited: bool,
) -> Reader:
    from tactile_graph_sources.devices.port import UnpluggedError
    from tactile_graph_sources.devices.port_list import list_ports
    from tactile_graph_sources.devices.port_words import refusal
    from tactile_graph_sources.devices.reader import Reader

    try:
        return Reader(kit, port, baud, newest, timeout_s, queue_size, awaited)
    except UnpluggedError as error:
        names = [p.device for p in list_ports()]
        raise UsageError(refusal(port, error.__cause__ or error, names)) from error


def _next(reader: Reader, teller: _Teller, give_up_s: float | None, end: float) -> Arrived | None:
    """Return the next frame that came before ``end``, if it was taken later too; or None.

    Once no frame is wanted any more the port is free for others, and only what came before is
    returned.
    """
    start = time.perf_counter()
    while teller.report.wanted:
        teller.tell()
        left = end - time.perf_counter()
        arrived = reader.inbox.get(max(0.0, min(REPORT_EVERY_S, left)))
        if arrived is not None:
            return arrived if arrived.time_s <= end else None
        if left <= 0:
            return None
        if give_up_s is not None and time.perf_counter() - start > give_up_s:
            teller.tell(force=True)
            raise DataError(reader.url, f"no frame for {give_up_s:g} s ({reader.state})")
    reader.stop()
    arrived = reader.inbox.get(0.0)
    return None if arrived is None or arrived.time_s > end else arrived


def _frame(arrived: Arrived, index: int, kit: Preset, port: str) -> Frame:
    decoded = arrived.frame
    g = kit.geometry
    pitch = (g.pitch_cm, g.pitch_cm) if isinstance(g.pitch_cm, float | int) else g.pitch_cm
    values, valid = decoded.values, ~np.isnan(decoded.values)
    if not valid.all():
        values = np.where(valid, values, 0.0)
    return Frame(
        Image(values, pitch, (0.0, 0.0), g.quantity, None if valid.all() else valid),
        index,
        arrived.time_s,
        device_time_s=decoded.device_time_s,
        gap=decoded.gap,
        label=port,
        doubtful=decoded.doubtful,
    )
