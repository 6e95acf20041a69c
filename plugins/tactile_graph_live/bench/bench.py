"""The bench: a source's frames through a pipeline, looked at now and then, told what to do."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import inf
from threading import Condition

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline, Result
from tactile_graph.compiled import Meanwhile, answered_meanwhile
from tactile_graph.errors import TactileGraphError, text_of
from tactile_graph.inspect import check_frame, make_plan
from tactile_graph.live import Beside, LiveResult, LiveRun
from tactile_graph.steps import Report
from tactile_graph_live.bench import wire
from tactile_graph_live.bench.outbox import Outbox
from tactile_graph_live.bench.playing import Player, player
from tactile_graph_live.bench.ring import Ring
from tactile_graph_live.bench.snapshot import Photographer
from tactile_graph_live.bench.tare import Taring, less
from tactile_graph_live.server.messages import Level

PICTURE_NS = 1_000_000_000 // 30
LATEST_NS = 3 * PICTURE_NS
"""A picture is taken when no frame waits, but at last after so long."""
SUMMARY_NS = 250_000_000
SILENT_S = 1.0
LATE_S = 0.5
"""Frames may come so long after word that they do not: they were on their way."""
WOULD_END = (
    "the source has ended, and a change would start it over, which ends the recording: "
    "end that, then change again"
)
CLOSE_S = 6.0
"""The longest that is waited for a source to close before the next is opened."""
Live = LiveResult[Result]


class Bench:
    """Runs a pipeline over a source until told to end.

    Parameters
    ----------
    order : wire.Order
    outbox : Outbox
        Takes what the server is to know.
    between : callable, optional
        Called before the first frame, and behind each.
    """

    def __init__(
        self, order: wire.Order, outbox: Outbox, between: Callable[[], None] | None = None
    ) -> None:
        self._order, self._outbox, self._between = order, outbox, between or _nothing
        self._pipeline: Pipeline = pickle.loads(order.pickled)
        self._photographer = Photographer(self._pipeline, order.version)
        self._next_photographer: Photographer | None = None
        self._ring = Ring()
        self._tally = _Tally()
        self._newest: Frame | None = None
        self._newest_s = time.perf_counter()
        self._shown: tuple[str, ...] = ()
        self._baseline = order.baseline
        self._taring: Taring | None = None
        self._wants = wire.Want(False, False)
        self._recorded_all = False
        self._other_source = False
        self._held = order.held
        self._ended = self._restart = self._idle = False
        self._changed = Condition()
        self._next_picture_ns = self._next_summary_ns = 0
        self._report = Report()
        self._trouble, self._trouble_s = "", 0.0
        self._meanwhile: Meanwhile | None = None
        self._beside: Beside | None = None
        if order.beside:
            self._beside = Beside(pickle.loads(order.beside), seed=order.seed)
        self._begin(order.awaited)

    def _begin(self, awaited: bool) -> None:
        """Make ready to read the source from its beginning; wait for a device that was there."""
        order = self._order
        first = 0 if self._newest is None else self._newest.index + 1
        counts, self._report = self._report.counts, Report(listener=self._heard)
        self._report.counts.update(counts)
        self._report.awaited = awaited
        self._trouble = ""
        self._player: Player = player(
            self._pipeline,
            order.seed,
            self._report,
            rate_hz=order.rate_hz,
            once=order.once,
            unpaced=order.unpaced,
            first=first,
        )
        self._player.hold(self._held)
        has_deadline = (order.deadline_us or self._pipeline.deadline_us) is not None
        self._run: LiveRun[Result] = LiveRun(
            self._pipeline,
            self._frames(),
            seed=order.seed,
            deadline_us=order.deadline_us,
            capacity=order.capacity or (wire.MANY if has_deadline else wire.FEW),
        )
        self._run.beside = self._beside
        self._tally.begin()
        if self._restart or self._ended:  # asked for meanwhile, of the one before
            self._stop()

    # -- the loop ----------------------------------------------------------------------------------

    def run(self) -> None:
        """Answer frames until told to end; where a source ends, wait for what comes next."""
        self._between()
        while not self._ended:
            error = self._answer_all()
            if self._ended:
                break
            if not self._restart:
                self._trouble, self._trouble_s = error, inf
                self._summarise("ended")
                self._outbox.note(wire.Ended(error, self._tally.n_frames))
            with self._changed:
                self._idle = True
                while not (self._restart or self._ended):
                    self._changed.wait()
                self._restart = self._idle = False
            self._await_close()
            if not self._ended:
                self._part()
                self._begin(awaited=True)
        if self._beside is not None:
            self._beside.close()

    def _answer_all(self) -> str:
        """Answer the frames of one source; return what went wrong, if anything."""
        try:
            with answered_meanwhile(patience_s=inf) as self._meanwhile:
                self._time_counts(self._pipeline)
                for live in self._run:
                    self._answered(live)
        except TactileGraphError as error:
            return str(error)
        except Exception as error:  # a source or a step may raise anything
            return f"{type(error).__name__}: {text_of(error)}"
        finally:
            self._stop()
        return ""

    def _stop(self) -> None:
        """Take no more frames of this source, be it that it waits for one."""
        self._report.wanted = False
        self._player.end()
        self._run.stop()

    def _await_close(self) -> None:
        """Wait until the source is closed: the next may be on the same port."""
        latest = time.perf_counter() + CLOSE_S
        while not (self._player.closed.wait(0.05) or self._ended):
            if time.perf_counter() > latest:
                self._say("the source before does not end; what it holds is not free", "warning")
                return

    def _part(self) -> None:
        """End what may not go on with a source that begins: a recording, another pad's tare."""
        if self._wants.frames:
            self._wants, self._recorded_all = replace(self._wants, frames=False), True
            self._outbox.last_frame()
        if self._other_source:
            self._other_source = False
            self._taring = None if self._taring is None else Taring()
            if self._baseline is not None:
                self._take_off(None)
                self._say("the source may be another one: the tare is gone; tare anew", "warning")

    def _time_counts(self, pipeline: Pipeline) -> None:
        """Wait for the compiler where times are learnt: those of plain code would be kept."""
        timed = (self._order.deadline_us or pipeline.deadline_us) is not None
        if self._meanwhile is not None and (timed or self._beside is not None):
            self._meanwhile.patience_s = -1.0

    def _answered(self, live: Live) -> None:
        """Take down a frame that is done."""
        plain_s = 0.0 if self._meanwhile is None else self._meanwhile.spent_s
        self._tally.add(live, plain_s, self._run.deadline_us)
        if self._wants.rows:
            self._outbox.row(self._row(live))
        now = live.done_ns
        if now >= self._next_picture_ns and (
            self._run.n_waiting == 0 or now >= self._next_picture_ns + LATEST_NS
        ):
            self._next_picture_ns = max(self._next_picture_ns + PICTURE_NS, now)
            snapshot = self._looking(live).snapshot(
                live.result, live.latency_us, arrived_s=live.arrived_ns / 1e9
            )
            # Of the first frames the time it took to get ready says nothing about the page.
            self._outbox.show(wire.Snapshot(snapshot, live.arrived_ns if self._tally.ready else 0))
        if now >= self._next_summary_ns:
            self._summarise("running")
        self._between()
        self._tally.through(time.perf_counter_ns())

    def _looking(self, live: Live) -> Photographer:
        """Return the photographer of the pipeline that gave the result."""
        new = self._next_photographer
        if new is not None and live.result.plan.pipeline is new.pipeline:
            self._photographer, self._next_photographer = new, None
        self._photographer.shown = self._shown
        return self._photographer

    def _row(self, live: Live) -> wire.Row:
        frame = live.result.frame
        rows = tuple(self._looking(live).rows(live.result))
        return wire.Row(
            frame.index, frame.time_s, frame.label, frame.device_time_s, live.arrived_ns / 1e9,
            live.latency_us, live.decisions, rows,
        )  # fmt: skip

    def tick(self) -> None:
        """Say how it is going although no frame comes; called now and then by another thread."""
        if time.perf_counter_ns() >= self._next_summary_ns + SUMMARY_NS and not (
            self._ended or self._idle
        ):
            silent = time.perf_counter() - self._newest_s > SILENT_S
            begun = self._tally.n_frames > 0 or self._newest is None
            self._summarise("waiting" if silent else "running" if begun else "starting")

    def _summarise(self, state: wire.State) -> None:
        self._next_summary_ns = time.perf_counter_ns() + SUMMARY_NS
        kept_s, kept_frames = self._ring.kept()
        tally = self._tally
        self._outbox.note(
            wire.Summary(
                tally.taken(), tally.n_frames, tally.n_lost, tally.n_shed, tally.n_missed,
                kept_s, kept_frames, state, self._baseline is not None,
                dict(self._report.counts),
                None if self._beside is None else self._beside.summary(),
                self._run.processes,
                self._why_silent(state),
                tally.n_shed_before,
            )
        )  # fmt: skip

    def _why_silent(self, state: wire.State) -> str:
        """Return what the source said of why no frame comes; "" where one does, or waits here."""
        comes = state == "running" or self._newest_s > self._trouble_s + LATE_S
        waits = state != "ended" and self._player.in_hand
        return "" if comes or waits else self._trouble

    # -- the reader --------------------------------------------------------------------------------

    def _frames(self) -> Iterator[Frame]:
        """Yield the source's frames, kept as they came and less the baseline."""
        for frame in self._player:
            self._newest, self._newest_s = frame, time.perf_counter()
            self._ring.add(frame, self._newest_s)
            if self._wants.frames:
                self._outbox.frame(frame)
            if self._taring is not None:
                self._tare_by(frame)
            yield less(frame, self._baseline)

    def _tare_by(self, frame: Frame) -> None:
        assert self._taring is not None
        baseline = self._taring.add(frame)
        if baseline is not None:
            n, self._taring = self._taring.n_frames, None
            self._take_off(baseline)
            self._say(f"tared by the median of {n} frames")

    # -- what it is told ---------------------------------------------------------------------------

    def told(self, message: wire.ToBench) -> None:
        """Do as the server says; called by another thread."""
        if isinstance(message, wire.Swap):
            self._swap(message)
        elif isinstance(message, wire.Show):
            self._shown = message.nodes
        elif isinstance(message, wire.Tare):
            self._tare(message.on)
        elif isinstance(message, wire.Hold):
            self._held = message.on
            self._player.hold(message.on)
        elif isinstance(message, wire.OneMore):
            self._next_picture_ns = 0
            self._player.one_more()
        elif isinstance(message, wire.Fetch):
            self._fetch(message)
        elif isinstance(message, wire.Want):
            self._want(message)
        elif isinstance(message, wire.Compare):
            self._compare()
        else:
            self._end()

    def _want(self, message: wire.Want) -> None:
        if self._recorded_all:  # it may be that the server does not know yet
            self._recorded_all = message.frames
            message = replace(message, frames=False)
        if self._wants.frames and not message.frames:
            self._outbox.last_frame()
        self._wants = message

    def _swap(self, message: wire.Swap) -> None:
        """Run another pipeline from the next frame on, if it takes the frames that come.

        Where the source is another one, or has ended, it is closed and read from its beginning.
        """
        restart = message.restart or self._idle
        anew: tuple[str, ...] = ()
        if self._idle and self._wants.frames and not message.restart:
            self._outbox.note(wire.Swapped(message.version, WOULD_END))
            return
        try:
            pipeline: Pipeline = pickle.loads(message.pickled)
            self._next_photographer = Photographer(pipeline, message.version)  # before a frame ran
            self._time_counts(pipeline)
            if restart:
                anew = pipeline.runner(seed=self._order.seed).anew  # that it can be made
            else:
                if self._newest is not None:
                    _try(pipeline, less(self._newest, self._baseline))
                anew = self._run.swap(pipeline)
        except Exception as error:
            words = str(error) if isinstance(error, TactileGraphError) else text_of(error)
            self._outbox.note(wire.Swapped(message.version, words or type(error).__name__))
            return
        self._pipeline = pipeline
        if restart:
            with self._changed:
                self._restart = True
                self._other_source = self._other_source or message.restart
                self._stop()
                self._changed.notify_all()
        self._next_picture_ns = 0
        self._outbox.note(wire.Swapped(message.version, anew=anew))

    def _tare(self, on: bool) -> None:
        self._taring = Taring() if on else None
        if not on:
            self._take_off(None)
            self._say("the readings are shown as they come")

    def _take_off(self, baseline: NDArray[np.float64] | None) -> None:
        self._baseline = baseline
        self._photographer.forget_range()
        self._outbox.note(wire.Tared(baseline))

    def _fetch(self, message: wire.Fetch) -> None:
        found = (
            self._ring.back(message.back_s, message.lead)
            if message.after is None
            else self._ring.after(message.after, message.lead)
        )
        frames, back_s, newer = found
        kept = wire.Kept(message.ticket, tuple(frames), back_s, newer, self._baseline)
        self._outbox.note(kept)

    def _compare(self) -> None:
        if self._beside is None:
            return
        kept = self._beside.agreement.kept
        said = tuple(
            {"frame": k.frame.index, "difference": k.difference, "first": k.first,
             "beside": k.beside} for k in kept
        )  # fmt: skip
        summary = self._beside.summary()
        self._outbox.note(wire.Compared(summary, tuple(k.frame for k in kept), said))

    def _end(self) -> None:
        with self._changed:
            self._ended = True
            self._stop()
            self._changed.notify_all()

    def _heard(self, where: str, what: str) -> None:
        """Pass on what the source says, and keep it: it may be why no frame comes."""
        self._trouble, self._trouble_s = f"{where}: {what}", time.perf_counter()
        self._say(self._trouble, "warning")

    def _say(self, text: str, level: Level = "note") -> None:
        self._outbox.note(wire.Said(text, level))


def _nothing() -> None:
    """Do nothing."""


def _try(pipeline: Pipeline, frame: Frame) -> None:
    """See that a pipeline takes a frame, and have its kernels compiled before the next comes."""
    check_frame(frame.image, make_plan(pipeline, tuple(pipeline.outputs)))
    apart = any(node.isolation is not None for node in pipeline.nodes.values())
    if not apart and not pipeline.writes:  # no process is started twice, nothing written twice
        pipeline.run(frame)


class _Tally:
    """Counts frames, and keeps their latencies until they are asked for.

    What was shed before the pipeline was ready counts as the time it took to get so, and not as
    lost to load. It is ready with the first frame that came after one was answered, drawn and told,
    and was answered without plain code, which stands in while the compiler works.
    """

    def __init__(self) -> None:
        self.n_frames = self.n_lost = self.n_missed = 0
        self.n_shed = 0
        self.n_shed_before = 0
        self._latencies: list[float] = []
        self.begin()

    def begin(self) -> None:
        """Count on in a new run, whose own counts begin at 0."""
        self.ready, self._shed_in_run, self._lost_in_run = False, 0, 0
        self._first_through_ns, self._plain_s = inf, 0.0

    def add(self, live: Live, plain_s: float, deadline_us: float | None) -> None:
        """Count a frame, ``plain_s`` being what plain code has taken in this run so far."""
        new = live.shed - self._shed_in_run
        self._shed_in_run = live.shed
        self.n_lost += live.lost - self._lost_in_run
        self._lost_in_run = live.lost
        self.n_frames += 1
        before = not self.ready
        self.n_shed_before += new * before  # those shed before this one came earlier than it
        self.n_shed += new * (not before)
        self.ready = self.ready or self._gets_ready(live, plain_s)
        if not self.ready:
            return
        latency_us = live.latency_us
        self._latencies.append(latency_us)
        self.n_missed += deadline_us is not None and latency_us > deadline_us

    def _gets_ready(self, live: Live, plain_s: float) -> bool:
        by_plain, self._plain_s = plain_s > self._plain_s, plain_s
        return live.arrived_ns >= self._first_through_ns and not by_plain

    def through(self, now_ns: int) -> None:
        """Note that all is done that a frame asks for; a first picture takes long."""
        self._first_through_ns = min(self._first_through_ns, now_ns)

    def taken(self) -> NDArray[np.float32]:
        """Return the latencies since they were taken last, in microseconds."""
        latencies, self._latencies = self._latencies, []
        return np.array(latencies, dtype=np.float32)
