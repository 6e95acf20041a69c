"""A pad on a port looked at live: what the page costs the frames, and how soon it shows them.

A process plays the pad on a pseudo terminal: frames of 16 x 16 cells with a time stamp and a
checksum. ``tactile-graph live`` reads them in processes of its own; viewers are WebSocket clients
of a third. All stamps are of one clock (``CLOCK_MONOTONIC``).

    python benchmarks/live.py                        # every phase, a minute and a half
    python benchmarks/live.py --rate 300 --touch 1   # something on the pad all the time
    python benchmarks/live.py --minutes 10           # memory
"""

from __future__ import annotations

import argparse
import asyncio
import binascii
import json
import multiprocessing
import os
import socket
import struct
import subprocess
import sys
import tempfile
import time
import tty
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import websockets

import tactile_graph as tg

PRESET = """\
preset: stamped
about: 16 x 16 cells with a time stamp and a checksum
transport: {baud: 2000000}
framer:
  kind: packet
  layout:
    - {part: magic, bytes: AA 55}
    - {part: time, type: u32le, unit_s: 1.0e-6}
    - {part: cells, type: u16le}
    - {part: crc16, variant: ccitt-false, order: be, after: 2}
geometry: {rows: 16, columns: 16, pitch_cm: 1.3, valid_range: [0, 4095]}
"""
WRAP_S = 2**32 * 1e-6
N_FRAMES = 200
ROUND_S = 2.0
"""Of this, something lies on the pad for the share ``--touch``."""


# -- the pad -------------------------------------------------------------------------------------


def pads(touch: float, rate_hz: float) -> list[bytes]:
    """Return the cells of two seconds' frames: the empty pad, then discs put down on it."""
    n = round(ROUND_S * rate_hz)
    empty = tg.load("locate").with_source("simulate", scene="empty", frames=n, output="counts")
    discs = tg.load("locate").with_source("simulate", scene="disc-1", frames=n, output="counts")
    n_touched = round(touch * n)
    frames = [*list(empty.frames(0))[: n - n_touched], *list(discs.frames(0))[:n_touched]]
    return [np.rint(np.clip(f.image.values, 0, 4095)).astype("<u2").tobytes() for f in frames]


def play(ready: Any, end: Any, sent: Any, cells: list[bytes], rate_hz: float) -> None:
    """Send frames on a pseudo terminal, each when its time has come, until told to end."""
    master, slave = os.openpty()
    tty.setraw(slave)
    ready.put(os.ttyname(slave))
    start = time.perf_counter()
    number = 0
    while not end.is_set():
        wait_s = start + number / rate_hz - time.perf_counter()
        if wait_s > 0:
            time.sleep(wait_s)
        stamp = time.perf_counter_ns() // 1000 & 0xFFFFFFFF
        body = struct.pack("<I", stamp) + cells[number % len(cells)]
        crc = struct.pack(">H", binascii.crc_hqx(body, 0xFFFF))
        os.write(master, b"\xaa\x55" + body + crc)
        number += 1
        sent.value = number


# -- viewers -------------------------------------------------------------------------------------


@dataclass
class Seen:
    """What one viewer saw."""

    pictures: int = 0
    to_result_ms: list[float] = field(default_factory=list)
    to_page_ms: list[float] = field(default_factory=list)
    pulses: list[dict[str, Any]] = field(default_factory=list)
    ended: str = ""


def since(stamp_s: float, now_s: float) -> float:
    """Return the milliseconds from a stamp that wraps to a time."""
    return ((now_s - stamp_s) % WRAP_S) * 1e3


async def look(address: str, seconds: float, show: Sequence[str] = ()) -> Seen:
    """Look for so long, answering each picture as a page does."""
    seen = Seen()
    end = time.perf_counter() + seconds
    async with websockets.connect(
        f"{address}live", max_size=None, compression=None, open_timeout=120
    ) as page:
        await page.send(json.dumps({"type": "show", "nodes": list(show)}))
        while (left := end - time.perf_counter()) > 0:
            try:
                text = await asyncio.wait_for(page.recv(), left)
            except TimeoutError:
                break
            now_s = time.perf_counter()
            message = json.loads(text)
            if message["type"] == "pulse":
                seen.pulses.append(message)
            if message["type"] != "frame":
                continue
            await page.send(json.dumps({"type": "pong", "index": message["index"]}))
            seen.pictures += 1
            if message["device_time_s"] is not None and message["arrived_s"] is not None:
                stamp_s = message["device_time_s"]
                done_s = message["arrived_s"] + message["latency_us"] / 1e6
                seen.to_result_ms.append(since(stamp_s, done_s))
                seen.to_page_ms.append(since(stamp_s, now_s))
    return seen


@dataclass
class Taken:
    """What a program took: milliseconds from the pad to each result, and how the outputs fared."""

    to_result_ms: list[float] = field(default_factory=list)
    outcomes: Counter[str] = field(default_factory=Counter)


async def take_all(address: str, seconds: float) -> Taken:
    """Take every result as a program does."""
    taken = Taken()
    end = time.perf_counter() + seconds
    async with websockets.connect(f"{address}results", max_size=None, compression=None) as program:
        while (left := end - time.perf_counter()) > 0:
            try:
                row = json.loads(await asyncio.wait_for(program.recv(), left))
            except TimeoutError:
                break
            if row["type"] == "result":
                done_s = row["arrived_s"] + row["latency_us"] / 1e6
                taken.to_result_ms.append(since(row["device_time_s"], done_s))
                taken.outcomes["deadline" if row["deadline"] else row["rows"][0]["outcome"]] += 1
    return taken


def deaf(address: str) -> socket.socket:
    """Return a viewer that asks for everything, and reads nothing."""
    host, _, port = address.removeprefix("ws://").rstrip("/").partition(":")
    viewer = socket.create_connection((host, int(port)))
    viewer.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    viewer.sendall(
        f"GET /live HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
    )
    return viewer


# -- processes -----------------------------------------------------------------------------------


@dataclass
class Running:
    """The command as it runs: its address, its own process and the bench's."""

    process: subprocess.Popen[str]
    address: str
    bench: int

    def memory_mb(self) -> tuple[float, float]:
        """Return what server and bench hold in memory."""
        return resident_mb(self.process.pid), resident_mb(self.bench)

    def cpu_s(self) -> tuple[float, float]:
        """Return the processor time of server and bench so far."""
        return cpu_s(self.process.pid), cpu_s(self.bench)


def resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def cpu_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def start(pipeline: str, port: str, folder: Path, more: Sequence[str]) -> Running:
    preset = folder / "stamped.yaml"
    preset.write_text(PRESET)
    command = [sys.executable, "-m", "tactile_graph", "live", pipeline, "--port", port,
               "--preset", str(preset), "--http-port", "0",
               "--folder", str(folder), *more]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=folder)
    assert process.stdout is not None
    line = process.stdout.readline()
    address = "ws" + line.rpartition(" http")[2].strip()
    for _ in range(100):
        time.sleep(0.1)
        children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        named = [int(c) for c in children if "spawn_main" in _command_of(c)]
        if named:
            return Running(process, address, named[-1])
    raise SystemExit("no bench process came")


def _command_of(pid: str) -> str:
    return Path(f"/proc/{pid}/cmdline").read_text().replace("\0", " ")


# -- phases --------------------------------------------------------------------------------------


def said(values: Sequence[float]) -> str:
    if not values:
        return "none"
    median, p99, most = np.percentile(values, (50, 99, 100))
    return f"median {median:.2f}, 99 % {p99:.2f}, most {most:.2f} ms ({len(values)})"


async def phase(title: str, running: Running, sent: Any, seconds: float, viewers: int) -> None:
    """Look with so many viewers, and print what they saw and what it cost."""
    probe = await look(running.address, 0.6)
    n_sent, before = sent.value, probe.pulses[-1]
    cpu, clock = running.cpu_s(), time.perf_counter()
    looks = [
        look(running.address, seconds, ("frame", "footprint", "object")) for _ in range(viewers)
    ]
    seen = await asyncio.gather(*looks) if viewers else [await _wait(seconds)]
    wall = time.perf_counter() - clock
    share = [(b - a) / wall for a, b in zip(cpu, running.cpu_s(), strict=True)]
    n_sent = sent.value - n_sent
    probe = await look(running.address, 0.6)
    after = probe.pulses[-1]
    n = {k: after[k] - before[k] for k in ("frames", "lost", "shed")}
    quantiles = [p["latency_us"] for s in seen[:1] for p in s.pulses[8:]] or [after["latency_us"]]
    print(f"{title}: {seconds:g} s, about {n_sent} frames sent, {n['frames']} done (with 0.6 s of "
          f"a look before and after), {n['lost']} lost, {n['shed']} shed")  # fmt: skip
    worst = max(q["p99"] for q in quantiles)
    middle = float(np.median([q["median"] for q in quantiles]))
    print(f"  arrival to result, all frames: median {middle / 1e3:.2f}, worst 99 % of any 4 s "
          f"{worst / 1e3:.2f} ms")  # fmt: skip
    if viewers:
        print(f"  sensor to result, as seen: {said([v for s in seen for v in s.to_result_ms])}")
        print(f"  sensor to page: {said([v for s in seen for v in s.to_page_ms])}")
        rates = [s.pictures / seconds for s in seen]
        print(f"  pictures a second: {min(rates):.1f} to {max(rates):.1f}")
    print(f"  processor: server {share[0]:.0%}, bench {share[1]:.0%} of a core; memory "
          f"{running.memory_mb()[0]:.0f} and {running.memory_mb()[1]:.0f} MB")  # fmt: skip


async def _wait(seconds: float) -> Seen:
    await asyncio.sleep(seconds)
    return Seen()


async def phase_all(running: Running, seconds: float) -> None:
    taken = await take_all(running.address, seconds)
    n = sum(taken.outcomes.values())
    shares = ", ".join(f"{word} {k / n:.0%}" for word, k in taken.outcomes.most_common(4))
    print(f"every result to a program: {seconds:g} s")
    print(f"  sensor to result: {said(taken.to_result_ms)}; of the first output: {shares}")


async def phase_deaf(running: Running, sent: Any, seconds: float) -> None:
    viewer = deaf(running.address)
    try:
        began = time.perf_counter()
        await phase("with a viewer that does not read", running, sent, seconds, 1)
        last = (await look(running.address, 0.6)).pulses[-1]
        print(f"  viewers left after {time.perf_counter() - began:.0f} s, with the one that looks "
              f"now: {last['viewers']}")  # fmt: skip
    finally:
        viewer.close()


async def remember(running: Running, minutes: float) -> None:
    """Print the memory of both processes over time, with a viewer that looks and a deaf one."""
    end = time.perf_counter() + 60 * minutes
    viewer = deaf(running.address)
    while time.perf_counter() < end:
        try:
            seen = await look(running.address, min(30.0, max(1.0, end - time.perf_counter())))
        except (websockets.ConnectionClosed, TimeoutError):  # this process was held up
            continue
        server, bench = running.memory_mb()
        last = seen.pulses[-1]
        print(f"  {minutes - (end - time.perf_counter()) / 60:5.1f} min: server {server:.1f} MB, "
              f"bench {bench:.1f} MB, {last['kept_frames']} frames kept, {last['shed']} shed",
              flush=True)  # fmt: skip
    viewer.close()


async def measure(running: Running, sent: Any, options: argparse.Namespace) -> None:
    await look(running.address, options.warm)
    if options.minutes:
        await remember(running, options.minutes)
        return
    await phase("nobody looks", running, sent, options.seconds, 0)
    await phase("one viewer", running, sent, options.seconds, 1)
    await phase("ten viewers", running, sent, options.seconds, 10)
    await phase_deaf(running, sent, options.seconds)
    await phase_all(running, options.seconds)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--pipeline", default="locate")
    parser.add_argument("--rate", type=float, default=500.0, help="frames a second")
    parser.add_argument("--touch", type=float, default=0.5, help="share of time with something on")
    parser.add_argument("--seconds", type=float, default=15.0, help="of each phase")
    parser.add_argument("--warm", type=float, default=8.0, help="seconds before the first phase")
    parser.add_argument("--minutes", type=float, default=0.0, help="only memory, for so long")
    parser.add_argument("more", nargs="*", help="options for the command, behind --")
    options = parser.parse_args()
    context = multiprocessing.get_context("spawn")
    ready, end, sent = context.Queue(), context.Event(), context.Value("q", 0)
    cells = pads(options.touch, options.rate)
    pad = context.Process(target=play, args=(ready, end, sent, cells, options.rate), daemon=True)
    pad.start()
    with tempfile.TemporaryDirectory() as folder:
        running = start(options.pipeline, ready.get(), Path(folder), options.more)
        try:
            print(f"{options.pipeline}, 16 x 16 at {options.rate:g} frames/s, something on the pad "
                  f"for {options.touch:.0%} of the time")  # fmt: skip
            asyncio.run(measure(running, sent, options))
        finally:
            running.process.terminate()
            print((running.process.communicate()[0] or "").strip().splitlines()[-1:])
            end.set()
            pad.join(5)


if __name__ == "__main__":
    main()
