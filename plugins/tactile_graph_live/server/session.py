"""A session: the bench, the pipeline that is worked on, and whoever looks at both."""

from __future__ import annotations

import asyncio
import pickle
import time
from collections import deque
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from starlette.websockets import WebSocket

from tactile_graph import Pipeline
from tactile_graph.errors import TactileGraphError, UsageError, text_of
from tactile_graph.foreign_text import visible
from tactile_graph.plugins.registry import selected
from tactile_graph_live.bench import wire
from tactile_graph_live.bench.playing import device_of, is_device
from tactile_graph_live.server import messages
from tactile_graph_live.server.asking import checked
from tactile_graph_live.server.bench_link import BenchLink
from tactile_graph_live.server.comparison import words_of, write_comparison
from tactile_graph_live.server.draft import Draft, save
from tactile_graph_live.server.editor import Edited, Editor
from tactile_graph_live.server.gaze import Gaze
from tactile_graph_live.server.messages import Level, encoded
from tactile_graph_live.server.osc import OscSender
from tactile_graph_live.server.programs import Programs
from tactile_graph_live.server.recorder import LONGEST_LABEL, Recorder
from tactile_graph_live.server.restarts import Restarts
from tactile_graph_live.server.viewers import Asked, Picture, Viewer, Viewers
from tactile_graph_live.server.vitals import Vitals
from tactile_graph_live.server.watching import FileSense

PULSE_S = 0.25
LAST_FRAMES_S = 3.0
"""How long the end of a recording is waited for."""
HOLDS = ("pause", "step", "scrub")
"""What holds the picture still."""
MOST_STARTS, STARTS_WITHIN_S = 3, 60.0
QUIET_S = 60.0
"""For so long the terminal hears no more of why something of a kind is not done; pages do."""
Say = Callable[[str, Level], None]


@dataclass(frozen=True)
class Setup:
    """What a session is begun with.

    Parameters
    ----------
    pipeline : Pipeline
    program_version : str
    folder : Path
        Where recordings and saved pipelines go.
    sense : FileSense
    order : Order
        Of the bench; its pipeline and version are the session's.
    osc : str
        ``HOST:PORT`` to send results to; empty for none.
    """

    pipeline: Pipeline
    program_version: str
    folder: Path
    sense: FileSense
    order: wire.Order
    osc: str = ""


class Session:
    """What the page shows and what it asks for come together here, in one event loop.

    Parameters
    ----------
    setup : Setup
    say : callable
        Takes what the terminal is to say.

    Raises
    ------
    UsageError
        If the address for OSC is none.
    """

    def __init__(self, setup: Setup, say: Say) -> None:
        self._setup, self._say = setup, say
        self._osc = OscSender(setup.osc) if setup.osc else None
        self._device = is_device(setup.pipeline)
        self._vitals = Vitals()
        self._restarts = Restarts()
        self._taking: _Recording | None = None
        self._recording_changes = asyncio.Lock()
        self._closing = False
        self._baseline: NDArray[np.float64] | None = None
        self._taring = False
        self._compared: asyncio.Queue[wire.Compared] = asyncio.Queue()
        self._starts: deque[float] = deque(maxlen=MOST_STARTS)
        self._tasks: set[asyncio.Task[None]] = set()
        self._refused: dict[str, float] = {}
        self.viewers = Viewers(
            lambda shown: self._send(wire.Show(tuple(sorted(shown)))), self._left
        )
        self.programs = Programs(self._tell_wants)
        self._editor = Editor(
            Draft.of(setup.pipeline),
            setup.order.seed,
            setup.sense,
            swap=self._send,
            changed=self._changed,
            wrong=self.viewers.tell,
            say=self._tell,
        )
        look = lambda: self._editor.now.lookback  # noqa: E731 -- the one of the moment
        self._gaze = Gaze(self._send, self.viewers, look, self._later, not self._device)
        self._orders = self._all_orders()
        self.failure = ""
        self.over = asyncio.Event()

    @property
    def n_frames(self) -> int:
        """Frames done so far."""
        return self._vitals.summary.n_frames

    @property
    def n_shed(self) -> int:
        """Frames shed so far, but for those of `n_shed_before`."""
        return self._vitals.summary.n_shed

    @property
    def n_shed_before(self) -> int:
        """Frames shed while the pipeline got ready."""
        return self._vitals.summary.n_shed_before

    # -- from beginning to end ---------------------------------------------------------------------

    async def run(self) -> None:
        """Begin, and go on until cancelled."""
        self._loop = asyncio.get_running_loop()
        self._start_bench()
        await asyncio.gather(self._editor.watch(), self._pulses())

    def _start_bench(self) -> None:
        self._starts.append(time.perf_counter())
        now = self._editor.now
        order = replace(
            self._setup.order,
            pickled=pickle.dumps(now.draft.pipeline),
            version=now.graph.version,
            selection=selected(),
            baseline=self._baseline,
            held=self._gaze.held,
            awaited=len(self._starts) > 1,
        )

        def take(message: wire.FromBench) -> None:
            self._in_loop(self._came, message)

        self._link = BenchLink(order, take, lambda: self._in_loop(self._gone))
        self._tell_wants()
        if self._taring:
            self._tare()
        self._send(wire.Show(tuple(sorted(self.viewers.shown))))

    def _in_loop(self, call: Callable[..., None], *arguments: Any) -> None:
        try:
            self._loop.call_soon_threadsafe(call, *arguments)
        except RuntimeError:  # the loop is closed
            return

    async def close(self) -> None:
        """End the recording properly, also one that is just begun or ended, and the bench."""
        self._closing = True
        try:
            await self._record(False, "")
            if self._setup.order.beside:
                await self._write_comparison()
        finally:
            await asyncio.to_thread(self._link.close)
            if self._osc is not None:
                self._osc.close()

    def _gone(self) -> None:
        """Start another bench where this one died, unless it does nothing else.

        It takes off what this one was tared by; frames that came meanwhile are lost.
        """
        if self.over.is_set():
            return
        often = len(self._starts) == MOST_STARTS
        if often and time.perf_counter() - self._starts[0] < STARTS_WITHIN_S:
            self._fail("the process that runs the pipeline died again and again")
            return
        recorded = ""
        if self._taking is not None:
            self._taking.broken_off()
            recorded = "; frames that come meanwhile are not recorded, which leaves a gap"
        died = "the process that runs the pipeline died; it is started anew"
        self._tell(died + recorded, "error")
        self._vitals.bench_died()
        self._editor.bench_died()
        self._gaze.bench_died()
        self._start_bench()

    def _fail(self, why: str) -> None:
        self.failure = why
        self.over.set()

    # -- what the bench says -----------------------------------------------------------------------

    def _came(self, message: wire.FromBench) -> None:
        if isinstance(message, wire.Snapshot):
            self._gaze.came(Picture(message.frame, message.arrived_ns))
        elif isinstance(message, wire.Rows):
            self._publish(message)
        elif isinstance(message, wire.Summary):
            self._vitals.add(message)
            for news in self._restarts.news(message.processes):
                self._tell(news, "warning")
        elif isinstance(message, wire.Taken):
            if self._taking is not None:
                self._taking.take(message)
                if message.last and not self._taking.ending:
                    self._tell("the source begins anew: the recording ends here", "warning")
                    self._later(self._record(False, ""))
        elif isinstance(message, wire.Kept):
            self._gaze.found(message)
        elif isinstance(message, wire.Tared):
            self._baseline, self._taring = message.baseline, False
            self._gaze.again()
        elif isinstance(message, wire.Swapped):
            self._editor.swapped(message)
        elif isinstance(message, wire.Compared):
            self._compared.put_nowait(message)
        elif isinstance(message, wire.Said):
            self._tell(message.text, message.level)
        else:
            self._ended(message)

    def _publish(self, rows: wire.Rows) -> None:
        self.programs.take(rows)
        if self._osc is not None:
            for row in rows.rows:
                self._osc.send(row)

    def _ended(self, ended: wire.Ended) -> None:
        if ended.error and not ended.n_frames and self._gaze.shown is None:
            self._fail(ended.error)
        elif ended.error:
            self._tell(ended.error, "error")
        else:
            self._tell("the source has come to its end")

    async def _pulses(self) -> None:
        while True:
            await asyncio.sleep(PULSE_S)
            self.viewers.drop_stuck()
            self.programs.drop_stuck()
            self.viewers.tell(self._pulse())

    def _pulse(self) -> messages.Pulse:
        state = messages.Recording() if self._taking is None else self._taking.state
        return self._vitals.pulse(len(self.viewers), state, self._gaze.paused)

    # -- who looks ---------------------------------------------------------------------------------

    async def serve(self, websocket: WebSocket) -> None:
        """Serve a page."""
        greeting: list[messages.Message] = [self._hello(), self._editor.now.graph, self._pulse()]
        if self._editor.trouble is not None:
            greeting.append(self._editor.trouble)
        await self.viewers.serve(websocket, greeting, self._asked, self._gaze.shown)

    async def serve_results(self, websocket: WebSocket) -> None:
        """Serve a program."""
        await self.programs.serve(websocket)

    def _hello(self) -> messages.Hello:
        pipeline = self._editor.now.draft.pipeline
        return messages.Hello(
            visible(pipeline.name),
            visible(pipeline.about),
            visible(pipeline.source.name) if pipeline.source else "",
            self._device,
            visible(pipeline.file),
            visible(str(self._setup.folder)),
            self._setup.order.deadline_us or pipeline.deadline_us,
            self._setup.program_version,
        )

    def _changed(self, edited: Edited) -> None:
        self.viewers.tell(self._hello())
        self.viewers.tell(edited.graph)
        self._gaze.told()

    def _tell(self, text: str, level: Level = "note") -> None:
        self._say(text, level)
        self.viewers.tell(messages.Told(visible(text), level))

    # -- what they ask -----------------------------------------------------------------------------

    def _all_orders(self) -> dict[str, Callable[..., None]]:
        gaze = self._gaze
        return {
            "pause": gaze.pause,
            "resume": gaze.live,
            "live": gaze.live,
            "step": gaze.step,
            "scrub": gaze.scrub,
            "tare": self._tare,
            "untare": lambda: self._send(wire.Tare(False)),
            "record": lambda on, label: self._later(self._record(on, label)),
            "set": lambda node, setting, value: self._later(self._editor.set(node, setting, value)),
            "unset": lambda node, setting: self._later(self._editor.unset(node, setting)),
            "save": lambda name: self._later(self._save(name)),
        }

    def _asked(self, viewer: Viewer, asked: Asked) -> None:
        """Do what a page asks for, or tell it why not."""
        try:
            kind, fields = checked(asked)
            if kind == "pong":
                arrived_ns = viewer.answered(fields["index"])
                if arrived_ns:
                    self._vitals.drawn(arrived_ns)
            elif kind == "show":
                viewer.shown = frozenset(fields["nodes"])
                self.viewers.shown_changed()
                self._gaze.again()
            else:
                self._orders[kind](**fields)
                if kind in HOLDS:
                    self._gaze.held_by(viewer)
        except TactileGraphError as error:
            viewer.tell("told", encoded(messages.Told(visible(str(error)), "error")))

    def _left(self, viewer: Viewer) -> None:
        if not self._closing and self._gaze.left(viewer):
            self._tell("whoever held the picture still has left: it goes on")

    def _tare(self) -> None:
        self._taring = True
        self._send(wire.Tare(True))
        if self._gaze.held:
            self._tell("what is played is held: the tare is taken off the frames that come next")

    def _send(self, message: wire.ToBench) -> None:
        self._link.send(message)

    def _later(self, work: Coroutine[Any, Any, None]) -> None:
        """Do something beside; what goes wrong with it is told."""

        async def done() -> None:
            try:
                await work
            except TactileGraphError as error:
                self._refuse(getattr(work, "__qualname__", ""), str(error))
            except Exception as error:  # a step's code may raise anything
                self._tell(f"{type(error).__name__}: {text_of(error)}", "error")

        task = asyncio.create_task(done())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _refuse(self, kind: str, why: str) -> None:
        """Tell why something is not done; the terminal not at each try, which a page may repeat."""
        now = time.perf_counter()
        if now - self._refused.get(kind, -QUIET_S) >= QUIET_S:
            self._refused[kind] = now
            self._say(why, "error")
        self.viewers.tell(messages.Told(visible(why), "error"))

    async def _save(self, name: str) -> None:
        now = self._editor.now
        text, file = now.graph.yaml, now.draft.pipeline.file
        path = await asyncio.to_thread(save, self._setup.folder, name, text, file)
        self._tell(f"wrote {path}")

    # -- recording ---------------------------------------------------------------------------------

    def _tell_wants(self) -> None:
        rows = bool(len(self.programs)) or self._osc is not None
        self._send(wire.Want(rows, self._taking is not None and not self._taking.ending))

    async def _record(self, on: bool, label: str) -> None:
        """Begin or end a recording, or go on with it under another label; one after the other."""
        label = visible(label)[:LONGEST_LABEL]
        async with self._recording_changes:
            if self._taking is not None and on:
                self._taking.label(label)
            elif not on:
                await self._stop_recording()
            elif not self._closing:
                await self._start_recording(label)

    async def _start_recording(self, label: str) -> None:
        pipeline = self._editor.now.draft.pipeline
        about = {**_origin(pipeline), "pipeline": pipeline.name}
        failed = lambda what: self._in_loop(self._broken, what)  # noqa: E731
        self._taking = taking = _Recording()
        self._tell_wants()  # at once: to make the first store takes a while
        try:
            recorder = await asyncio.to_thread(
                Recorder, self._setup.folder, pipeline.name, label, about, failed
            )
        except Exception:
            await self._last_frames(taking)
            self._taking = None
            raise
        taking.begin(recorder)
        self._tell(f"recording to {recorder.path}")

    async def _write_comparison(self) -> None:
        """Write how the variant beside has done, and the frames that tell the two apart."""
        self._send(wire.Compare())
        try:
            compared = await asyncio.wait_for(self._compared.get(), LAST_FRAMES_S)
            self._tell(words_of(compared))
            folder = self._setup.folder
            for path in await asyncio.to_thread(lambda: list(write_comparison(folder, compared))):
                self._tell(f"wrote {path}")
        except TimeoutError:
            self._tell("the comparison did not come in time", "warning")
        except TactileGraphError as error:
            self._tell(str(error), "error")

    def _broken(self, what: str) -> None:
        self._tell(f"the recording failed: {what}", "error")
        self._later(self._record(False, ""))

    async def _stop_recording(self) -> None:
        taking = self._taking
        if taking is None or taking.recorder is None:
            return
        if not await self._last_frames(taking):
            self._tell("the last frames of the recording did not come in time", "warning")
        n = await asyncio.to_thread(taking.recorder.close)
        self._taking = None
        self._tell(f"recorded {_told(taking.recorder, n)}")

    async def _last_frames(self, taking: _Recording) -> bool:
        """Have no more frames sent, and wait for those on their way; return whether they came."""
        taking.ending = True
        self._tell_wants()
        try:
            await asyncio.wait_for(taking.last.wait(), LAST_FRAMES_S)
        except TimeoutError:
            return False
        return True


class _Recording:
    """A recording from the moment it is asked for on, and whether its last frames have come.

    What comes before its recorder is there waits.
    """

    def __init__(self) -> None:
        self.recorder: Recorder | None = None
        self.ending = False
        self.last = asyncio.Event()
        self._waiting: list[Callable[[Recorder], None]] = []

    @property
    def state(self) -> messages.Recording:
        """What the page says of it."""
        return messages.Recording() if self.recorder is None else self.recorder.state

    def begin(self, recorder: Recorder) -> None:
        """Have what waited written, and what comes from now on."""
        self.recorder = recorder
        for call in self._waiting:
            call(recorder)
        self._waiting.clear()

    def take(self, taken: wire.Taken) -> None:
        """Write frames."""
        self._have(lambda recorder: recorder.take(taken.frames, taken.n_lost))
        if taken.last:
            self.last.set()

    def label(self, label: str) -> None:
        """Have frames written under another label from now on."""
        self._have(lambda recorder: setattr(recorder, "label", label))

    def broken_off(self) -> None:
        """Note that nobody knows how many frames are lost before the next one."""
        self._have(Recorder.broken_off)

    def _have(self, call: Callable[[Recorder], None]) -> None:
        if self.recorder is None:
            self._waiting.append(call)
        else:
            call(self.recorder)


def _origin(pipeline: Pipeline) -> dict[str, str]:
    """Return where the frames come from, as ``record`` keeps it; nothing names the pad here."""
    source, device = pipeline.source, device_of(pipeline)
    if source is None or device is None:
        return {"preset": "", "pad": "", "port": f"source {source.name if source else ''}"}
    told = {"preset": source.settings.get("preset"), "port": source.settings.get(device.address)}
    return {"pad": "", **{key: "" if value is None else str(value) for key, value in told.items()}}


def _told(recorder: Recorder, n_frames: int) -> str:
    """Return in words what a recording holds, and what it does not."""
    told = "no frame"
    if n_frames:
        told = f"{n_frames} frame{'s' if n_frames != 1 else ''} to {recorder.path}"
    if recorder.n_lost:
        told += f", {recorder.n_lost} lost"
    if n := recorder.n_breaks:
        times = f" {n} times" if n > 1 else ""
        told += f"; more are lost{times}, uncounted, where the pipeline's process died"
    return told


def folder_of(name: str) -> Path:
    """Return the folder for recordings, made if it is not there.

    Raises
    ------
    UsageError
        If it cannot be one.
    """
    path = Path(name)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UsageError(f"--folder {name}: {error.strerror or error}") from None
    return path.resolve()
