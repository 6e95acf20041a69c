"""A server for the page that says what a test wants, and notes what the page asks."""

from __future__ import annotations

import asyncio
import json
import math
import socket
import threading
import time
from base64 import b64encode
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from typing import Any

import numpy as np
import uvicorn

from tactile_graph_live.server.app import make_app
from tactile_graph_live.server.guard import Door

Plain = dict[str, Any]
ROWS, COLUMNS, PITCH_CM = 8, 10, 1.3
NAMES = ("footprint", "boundary", "circle")
PATIENCE_S = 30.0
BEAT_S = 2.0  # a page takes six seconds without a word for a server that hangs


def hello(**more: Any) -> Plain:
    """Return a greeting."""
    return {"type": "hello", "pipeline": "rings", "about": "rings on a pad", "source": "simulate",
            "live": False, "file": "rings.yaml", "folder": "/recordings", "deadline_us": 2000.0,
            "version": "0.1.0", "protocol": 1} | more  # fmt: skip


def setting(name: str, kind: str, value: Any, **more: Any) -> Plain:
    """Return a setting of a node."""
    return {"name": name, "kind": kind, "value": value, "default": value, "low": None, "high": None,
            "slider_low": None, "slider_high": None, "step": None, "choices": [], "unit": "",
            "help": f"What {name} is for.", "changed": False} | more  # fmt: skip


def graph(version: int = 1, names: tuple[str, ...] = NAMES, **more: Any) -> Plain:
    """Return a graph of nodes in a row, the first of them with a setting of each kind."""
    settings = [
        setting("level_v", "number", 0.02, low=0.0, slider_low=0.0, slider_high=0.1, step=0.001,
                unit="V"),
        setting("factor", "integer", 2, low=1.0, slider_low=1.0, slider_high=8.0, step=1.0),
        setting("above", "boolean", False),
        setting("element", "choice", "disc5", choices=["disc5", "square3"]),
        setting("noise_of", "text", ""),
    ]  # fmt: skip
    chain = ("frame", *names)
    boxes = [{"name": n, "step": f"{n}_step", "role": "frame" if n == "frame" else "step"}
             for n in chain]  # fmt: skip
    wires = [{"start": a, "end": b, "kind": "data"} for a, b in pairwise(chain)]
    nodes = [{"name": n, "step": f"{n}_step", "about": f"What {n} does.", "guard": "",
              "keeps": n == names[-1],
              "settings": settings if i == 0 else []} for i, n in enumerate(names)]  # fmt: skip
    columns = [{"key": k, "name": k.removesuffix("_cm").replace("_", " "), "unit": "cm"}
               for k in ("x_cm", "y_cm", "radius_cm", "centre_error_cm")]  # fmt: skip
    yaml = "pipeline: rings\nnodes:\n  footprint: {level_v: 0.02}\n"
    return {"type": "graph", "version": version, "name": "rings", "about": "rings on a pad",
            "yaml": yaml, "file_yaml": yaml, "boxes": boxes,
            "wires": wires, "nodes": nodes, "outputs": [names[-1]], "columns": columns,
            "took_ms": 1.0, "anew": []} | more  # fmt: skip


def picture(
    values: list[int] | bytes, readings: list[float] | None = None, kind: str = "<f8", **more: Any
) -> Plain:
    """Return cells as the page gets them: by their colours, and what they read if that is given."""
    exact = None if readings is None else np.array(readings, kind).tobytes()
    return {"rows": ROWS, "columns": COLUMNS, "pitch_cm": [PITCH_CM, PITCH_CM],
            "origin_cm": [0.0, 0.0], "quantity": "volt", "unit": "V", "low": 0.0, "high": 3.0,
            "values": b64encode(bytes(values)).decode(),
            "readings": exact and b64encode(exact).decode()} | more  # fmt: skip


def frame(index: int, names: tuple[str, ...] = NAMES, **more: Any) -> Plain:
    """Return a frame with a ring that wanders to and fro."""
    x, y = 6.0 + 3 * math.sin(index / 20), 5.0 + 2 * math.cos(index / 27)
    cells = []
    for cell in range(ROWS * COLUMNS):
        row, column = divmod(cell, COLUMNS)
        away = math.hypot((column + 0.5) * PITCH_CM - x, (row + 0.5) * PITCH_CM - y)
        cells.append(int(max(0.0, 254 * (1 - away / 4))))
    ring = {"shape": "circle", "role": "found", "node": names[-1], "x": x, "y": y, "radius": 2.0}
    cross = {"shape": "cross", "role": "found", "node": names[-1], "x": x, "y": y}
    rms = {"shape": "note", "node": names[-1], "name": "rms", "value": "0.1"}
    pictures = {
        "frame": [{"shape": "heat", "node": "frame", "image": picture(cells)}],
        names[0]: [{"shape": "cells", "node": names[0],
                    "image": picture([int(c > 120) for c in cells])}],
        names[-1]: [ring, cross, rms],
    }  # fmt: skip
    row = {"output": names[-1], "item": 1, "outcome": "ok", "type": "Circle", "x_cm": x, "y_cm": y,
           "radius_cm": 2.0, "centre_error_cm": 0.1}  # fmt: skip
    return {"type": "frame", "index": index, "time_s": index / 30, "version": 1,
            "pad": picture(cells, [3.0 * level / 254 for level in cells]), "drawing": [ring, cross],
            "nodes": {n: {"outcome": "ran", "reason": "", "us": 12.0 + i}
                      for i, n in enumerate(names)},
            "pictures": pictures, "rows": [row], "errors": {}, "decisions": [],
            "latency_us": 900.0, "back_s": 0.0, "label": "", "gap": False} | more  # fmt: skip


def pulse(**more: Any) -> Plain:
    """Return a pulse of a bench that runs."""
    times = {"median": 800.0, "p99": 1900.0, "most": 2500.0}
    recording = {"on": False, "file": "", "frames": 0, "label": "", "lost": 0}
    return {"type": "pulse", "rate_hz": 500.2, "frames": 12345, "lost": 0, "shed": 0,
            "shed_before": 0, "missed": 0, "viewers": 1, "latency_us": times,
            "page_latency_us": times, "recording": recording, "paused": False, "tared": False,
            "kept_s": 60.0, "kept_frames": 30000,
            "state": "running", "counters": {}, "beside": None} | more  # fmt: skip


class Double:
    """Stands for a session: greets each page, says what it is told to, notes what it is asked.

    Attributes
    ----------
    greeting : list
        Messages that a page gets first.
    asked : list
        What pages sent, without their answers to frames.
    answered : list of int
        Indices of the frames they said were drawn.
    hangs : bool
        Whether no word comes between what a test says. Else a slow machine lets a page believe so,
        which connects anew and forgets what it was told.
    """

    def __init__(self, *greeting: Plain, hangs: bool = False) -> None:
        self.greeting = list(greeting or (hello(), graph(), pulse(), frame(0)))
        self.hangs = hangs
        self.asked: list[Plain] = []
        self.answered: list[int] = []
        self.address = ""
        self._sockets: list[Any] = []
        self._loop: asyncio.AbstractEventLoop | None = None

    def renew(self) -> None:
        """Be as at first, once the pages of another test have gone."""
        wait_for(lambda: not self._sockets, "all pages have gone")
        self.greeting = [hello(), graph(), pulse(), frame(0)]
        self.asked.clear()
        self.answered.clear()

    async def serve(self, websocket: Any) -> None:
        """Serve a page until it goes."""
        self._loop = asyncio.get_running_loop()
        # Before the greeting: once a page shows it, a test may speak.
        self._sockets.append(websocket)
        beats = None if self.hangs else asyncio.create_task(self._beat(websocket))
        try:
            for message in self.greeting:
                await websocket.send_text(json.dumps(message))
            while True:
                told = json.loads(await websocket.receive_text())
                if told["type"] == "pong":
                    self.answered.append(told["index"])
                else:
                    self.asked.append(told)
        except Exception:  # however it goes away
            self._sockets.remove(websocket)
        finally:
            if beats:
                beats.cancel()

    @staticmethod
    async def _beat(websocket: Any) -> None:
        """Say now and then what is no message, and so changes nothing."""
        while True:
            await asyncio.sleep(BEAT_S)
            await websocket.send_text(" ")

    async def serve_results(self, websocket: Any) -> None:
        """No program looks."""

    def say(self, *messages: Plain | str) -> None:
        """Send messages to all pages; a text goes as it is."""
        wait_for(lambda: bool(self._sockets), "a page is there")
        assert self._loop is not None
        for message in messages:
            text = message if isinstance(message, str) else json.dumps(message)
            for websocket in list(self._sockets):
                told = websocket.send_text(text)
                asyncio.run_coroutine_threadsafe(told, self._loop).result(PATIENCE_S)

    def heard(self, kind: str, within_s: float = PATIENCE_S) -> Plain:
        """Return the newest that pages asked of a kind; waits for it, and forgets all."""
        wait_for(
            lambda: any(a["type"] == kind for a in self.asked), f"a page asks {kind}", within_s
        )
        found = [a for a in self.asked if a["type"] == kind][-1]
        self.asked.clear()
        return found


def wait_for(holds: Callable[[], bool], what: str, within_s: float = PATIENCE_S) -> None:
    """Wait until something holds, or fail in its words."""
    end = time.monotonic() + within_s
    while not holds():
        assert time.monotonic() < end, f"not within {within_s:g} s: {what}"
        time.sleep(0.01)


def drawn(page: Any, words: str) -> None:
    """Wait until a frame is drawn that is told so (``frame 7``)."""
    told = page.locator("#when")
    wait_for(lambda: words in told.inner_text().split(" · "), f"{words} is drawn")


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        return int(taken.getsockname()[1])


@contextmanager
def served(double: Double, port: int = 0, token: str = "") -> Iterator[Double]:
    """Serve the page with a double behind it, under the policy of the real server."""
    door = Door("127.0.0.1", port or free_port(), token)
    double.address = door.address
    config = uvicorn.Config(make_app(double, door), door.host, door.port,  # type: ignore[arg-type]
                            log_level="error", ws="websockets-sansio",
                            timeout_graceful_shutdown=1)  # fmt: skip
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    wait_for(lambda: server.started, "the double listens", 20)
    try:
        yield double
    finally:
        server.should_exit = True
        thread.join(10)
