"""``Reader``: the thread that reads a port, decodes, and comes back after an unplug."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Iterator

from tactile_graph_sources.devices.decoder import Decoded, Decoder
from tactile_graph_sources.devices.inbox import Arrived, Inbox
from tactile_graph_sources.devices.port import Port, UnpluggedError
from tactile_graph_sources.devices.preset import Packet, Preset
from tactile_graph_sources.devices.reply import ReplyFramer

FIRST_BACKOFF_S = 0.5
LONGEST_BACKOFF_S = 5.0
READ_WAIT_S = 0.05
CHUNKS_KEPT = 4096
QUIET_S = 0.05
"""At least so long nothing comes before replies count as all there: drivers hold bytes back."""
LONGEST_SETTLING = 3.0
"""Timeouts after which a line that is never silent is asked again; what comes then is doubtful."""


class Reader:
    """Reads frames off a port into an inbox until stopped.

    Parameters
    ----------
    preset : Preset
    url : str
    baud : int, optional
        Instead of the preset's.
    newest : bool
        Which frames are kept when they are not taken in time; see `Inbox`.
    timeout_s : float
        Without a frame for so long the link is ``stalled``.
    queue_size : int
    awaited : bool
        Whether a port that cannot be opened at the start is waited for, as it is later.

    Raises
    ------
    UnpluggedError
        If the port cannot be opened at the start, and is not waited for.
    """

    def __init__(
        self,
        preset: Preset,
        url: str,
        baud: int | None = None,
        newest: bool = False,
        timeout_s: float = 2.0,
        queue_size: int = 1024,
        awaited: bool = False,
    ) -> None:
        self.preset = preset
        self.url = url
        self.baud = baud
        self.timeout_s = timeout_s
        self.decoder = Decoder(preset)
        self.counts = self.decoder.counts
        self.inbox = Inbox(newest, queue_size, self.counts)
        self.state = "waiting"
        self._events: deque[str] = deque(maxlen=1000)
        self._chunks: deque[tuple[int, float]] = deque(maxlen=CHUNKS_KEPT)
        self._stop = threading.Event()
        self._last_good = time.perf_counter()
        self._bytes_then = 0
        self._wait_s = min(READ_WAIT_S, preset.transport.silence_s)
        self._byte_s = 10.0 / (baud or preset.transport.baud)
        framer = self.decoder.framer
        self._replies = framer if isinstance(framer, ReplyFramer) else None
        self._n_owed = 0  # replies that were asked for and may still come
        self._doubtful = False
        self._port: Port | None = None
        try:
            self._port = self._open()
        except UnpluggedError as error:
            if not awaited:
                raise
            self._lost(error)
        self._thread = threading.Thread(target=self._run, name=f"serial {url}", daemon=True)
        self._thread.start()

    def events(self) -> Iterator[str]:
        """Yield what happened since last asked: lost, back, stalled."""
        while self._events:
            yield self._events.popleft()

    def stop(self) -> None:
        """Stop reading and close the port."""
        self._stop.set()
        self.inbox.close()
        self._thread.join(timeout=5.0)

    def _open(self) -> Port:
        return Port(self.url, self.preset.transport, self.baud, self._wait_s)

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                self._session()
        except Exception as error:  # whoever takes the frames must hear of it
            self.inbox.fail(error)
        finally:
            if self._port is not None:
                self._port.close()

    def _session(self) -> None:
        """Read until the port goes away, then wait for it to come back."""
        port = self._port or self._reopened()
        if port is None:
            return
        self._port = port
        try:
            request = self.preset.request
            if request is not None and request.when == "frame":
                self._ask(port, request.send)
            else:
                self._listen(port, request.send if request else b"")
        except UnpluggedError as error:
            self._lost(error)
            port.close()  # here and not in stop(): a close from another thread breaks the read
            self._port = None
            self.decoder.reset()

    def _lost(self, error: UnpluggedError) -> None:
        self.state = "lost"
        self._events.append(f"lost ({error}); waiting for it to come back")

    def _reopened(self) -> Port | None:
        delay = FIRST_BACKOFF_S
        while not self._stop.wait(delay):
            try:
                port = self._open()
            except UnpluggedError:
                delay = min(2.0 * delay, LONGEST_BACKOFF_S)
                continue
            self.counts.reconnects += 1
            self.state = "waiting"
            self._events.append("back")
            self._last_good = time.perf_counter()
            return port
        return None

    def _listen(self, port: Port, request: bytes) -> None:
        """Read a pad that sends by itself."""
        if request:
            port.write(request)
        last_byte = time.perf_counter()
        silent = False
        while not self._stop.is_set():
            data = port.read()
            now = time.perf_counter()
            if data:
                self._take(data, now)
                last_byte, silent = now, False
            elif not silent and now - last_byte >= self.preset.transport.silence_s:
                self._keep(self.decoder.boundary())
                silent = True
            if self._stalled(now) and request:
                port.write(request)  # the pad may have missed it while it was starting

    def _ask(self, port: Port, request: bytes) -> None:
        """Ask a pad for one frame after the other."""
        in_step = False
        self._n_owed = 1  # whoever read the port before may have asked, too
        while not self._stop.is_set():
            late = port.pending()
            if late:
                self._take(late, time.perf_counter())
            if late and self._replies:
                self._settle(port, self._replies)
                self.decoder.discard()  # as long as a reply or not: it was not asked for
                in_step = False
            self._keep(self.decoder.boundary())
            good = self.counts.good
            port.write(request)
            self._n_owed += 1
            prompt = self._await_reply(port) and in_step and not self._doubtful
            waited = False
            if self._replies and prompt:
                self._n_owed = max(0, self._n_owed - 1)
            elif self._replies:
                waited = self._settle(port, self._replies)
            self._keep(self.decoder.boundary())
            in_step = self.counts.good > good
            if not waited:  # that is no stall
                self._stalled(time.perf_counter())

    def _await_reply(self, port: Port) -> bool:
        """Read a reply; return whether it came in time, and nothing behind it."""
        good = self.counts.good
        deadline = time.perf_counter() + self._reply_s()
        while not self._stop.is_set():
            data = port.read()
            now = time.perf_counter()
            if data:
                self._take(data, now)
            if self.counts.good > good:
                return True
            if self.decoder.complete:
                if self._replies:
                    time.sleep(2.0 * self._byte_s)  # its excess is here by then
                extra = port.pending()  # a reply that is too long is no frame
                if extra:
                    self._take(extra, now)
                return not extra
            if now > deadline:
                self._stalled(now)
                return False
        return False

    def _settle(self, port: Port, replies: ReplyFramer) -> bool:
        """Read on until nothing comes; return whether the rest of a reply was waited for in vain.

        For as long as a reply takes on the wire, or for a timeout where the rest of one may still
        come: whoever asks before gets that, and the beginning of the next, for a reply.
        """
        quiet_s = max(QUIET_S, self._on_wire_s())
        start = last = time.perf_counter()
        while not self._stop.is_set():
            data = port.read()
            now = time.perf_counter()
            if data:
                self._take(data, now)
                last = now
            rest = self._doubtful or (replies.in_part and replies.n_whole < self._n_owed)
            if now - last >= (self.timeout_s if rest else quiet_s):
                self._n_owed = 0 if rest else max(0, self._n_owed - replies.n_whole)
                self._doubtful = False
                return rest
            if now - start >= LONGEST_SETTLING * self.timeout_s:
                self._doubtful = True
                break
        return False

    def _reply_s(self) -> float:
        """How long a reply may take: twice its time on the wire and some for the scan."""
        return min(self.timeout_s, 0.25 + 2.0 * self._on_wire_s())

    def _on_wire_s(self) -> float:
        """How long the largest reply takes on the wire."""
        packet = isinstance(self.preset.framer, Packet)
        return (4 if packet else 8) * self.preset.geometry.n_cells * self._byte_s

    def _take(self, data: bytes, now: float) -> None:
        self._chunks.append((self.counts.bytes + len(data), now))
        self._keep(self.decoder.feed(data))

    def _keep(self, frames: list[Decoded]) -> None:
        if not frames:
            return
        self._last_good, self._bytes_then = time.perf_counter(), self.counts.bytes
        self.state = "streaming"
        if self._doubtful:
            self.counts.doubtful += len(frames)  # none of these were doubtful by their framing
            frames = [f._replace(doubtful=True) for f in frames]
        self.inbox.put([Arrived(f, self._time_of(f.end)) for f in frames])

    def _time_of(self, end: int) -> float:
        """Return when the byte before ``end`` came; frames held back for a look-ahead are older."""
        while len(self._chunks) > 1 and self._chunks[0][0] < end:
            self._chunks.popleft()
        return self._chunks[0][1]

    def _stalled(self, now: float) -> bool:
        """Note when no frame came for too long, and say why if the bytes tell."""
        if now - self._last_good < self.timeout_s:
            return False
        self._last_good = now  # once per timeout
        self.counts.timeouts += 1
        if self.state != "stalled":
            self.state = "stalled"
            self._events.append(f"stalled: {self._hint()}")
        return True

    def _hint(self) -> str:
        n = self.counts.bytes - self._bytes_then
        if n == 0:
            return (
                f"nothing came for {self.timeout_s:g} s; is it the right port "
                "('tactile-graph ports' lists them), and is the pad on?"
            )
        g = self.preset.geometry
        found = self.decoder.hint()
        return (
            f"{n} bytes came in {self.timeout_s:g} s but no frame; is the baud rate "
            f"{self.baud or self.preset.transport.baud}, the size {g.rows} x {g.columns}, the kit "
            f"{self.preset.preset!r}?" + (f" ({found})" if found else "")
        )
