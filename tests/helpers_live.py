"""The command ``live`` as a process of its own, and pages that look at it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from helpers_serial import FakePad, Kit

PIPELINE = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint, when: footprint.count > 0}
  circle: {step: fit_circle, in: boundary}
outputs: [circle]
"""
COUNTS = """\
pipeline: counts
nodes:
  above: {step: threshold_otsu, in: frame}
  boundary: {step: boundary_scan, in: above.mask, when: above.mask.count > 2}
  circle: {step: fit_circle, in: boundary}
outputs: [circle]
"""
PATIENCE_S = 30.0
FLOW = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  smooth: {step: low_pass, in: frame}   # as it comes
  footprint: {step: threshold, in: smooth, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint}
outputs: [boundary]
"""


class Command:
    """A running ``tactile-graph live``.

    Parameters
    ----------
    process : Popen
    address : str
        ``http://…/`` of its page.
    """

    def __init__(self, process: subprocess.Popen[str], address: str) -> None:
        self.process, self.address = process, address

    @property
    def port(self) -> int:
        return int(self.address.partition("?")[0].rstrip("/").rpartition(":")[2])

    def children(self) -> list[int]:
        task = f"/proc/{self.process.pid}/task/{self.process.pid}/children"
        return [int(c) for c in Path(task).read_text().split()]

    def bench(self) -> int:
        """Return the number of the process that runs the pipeline."""
        return next(c for c in self.children() if "spawn_main" in words_of(c))

    def end(self, number: int = signal.SIGINT) -> tuple[int, str]:
        """End it; return its exit code and what it printed."""
        self.process.send_signal(number)
        out, _ = self.process.communicate(timeout=PATIENCE_S)
        return self.process.returncode, out


def words_of(process: int) -> str:
    """Return how a process was begun; "" once it has ended."""
    try:
        return Path(f"/proc/{process}/cmdline").read_text(errors="replace")
    except (FileNotFoundError, ProcessLookupError):
        return ""


def _with_ctrl_c() -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@contextmanager
def running(folder: Path, *arguments: str, port: str = "0") -> Iterator[Command]:
    """Run the command in a folder until the block ends."""
    command = [sys.executable, "-m", "tactile_graph", "live", *arguments, "--http-port", port]
    process = subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        preexec_fn=_with_ctrl_c, env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert " http" in line, line + process.stdout.read()
        yield Command(process, "http" + line.rpartition(" http")[2].strip())
    finally:
        if process.poll() is None:
            process.terminate()
            try:
                process.communicate(timeout=PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                raise


class Page:
    """A page that looks: a WebSocket, and what came through it.

    Parameters
    ----------
    command : Command
    path : str
        ``live`` or ``results``.
    headers : mapping, optional
        More of the request.
    """

    def __init__(
        self, command: Command, path: str = "live", headers: dict[str, str] | None = None
    ) -> None:
        from websockets.sync.client import connect

        address, _, query = command.address.partition("?")
        url = f"ws{address.removeprefix('http')}{path}" + (f"?{query}" if query else "")
        self._open = ExitStack()
        self.socket = self._open.enter_context(
            connect(url, max_size=None, compression=None, additional_headers=headers)
        )
        self.got: list[dict[str, Any]] = []

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._open.close()

    def ask(self, kind: str, **fields: Any) -> None:
        self.socket.send(json.dumps({"type": kind, **fields}))

    def next(self, left_s: float = PATIENCE_S) -> dict[str, Any]:
        """Return the next message; pictures are answered, as a page does."""
        message: dict[str, Any] = json.loads(self.socket.recv(timeout=left_s))
        if message["type"] == "frame":
            self.ask("pong", index=message["index"])
        self.got.append(message)
        return message

    def until(self, kind: str, **fields: Any) -> dict[str, Any]:
        """Return the next message of a kind, and with these fields, if any are named."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            message = self.next(end - time.monotonic())
            if message["type"] == kind and all(message[k] == v for k, v in fields.items()):
                return message
        raise AssertionError(f"no {kind} with {fields} came; the last: {self.got[-1:]}")

    def told(self, part: str) -> dict[str, Any]:
        """Return the next word that holds a part."""
        while part not in (message := self.until("told"))["text"]:
            pass
        return message


class Sending:
    """A pad that sends forty frames a second as long as it is plugged in."""

    def __init__(self, pad: FakePad, kit: Kit) -> None:
        self._pad, self._kit = pad, kit
        self.pad_lock = threading.Lock()
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._send)

    def __enter__(self) -> Sending:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        self._thread.join(10)
        self._pad.unplug()

    @contextmanager
    def unplugged(self) -> Iterator[None]:
        """Have the pad unplugged until the block ends."""
        with self.pad_lock:
            self._pad.unplug()
            try:
                yield
            finally:
                self._pad.plug_in()

    def _send(self) -> None:
        rng = np.random.default_rng(0)
        number = 0
        while not self._end.wait(0.025):
            with self.pad_lock:
                self._pad.send(self._kit.encode(self._kit.pad(rng), number))
            number += 1
