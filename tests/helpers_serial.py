"""What the kits send, written down independently of the decoders; and pads to send."""

from __future__ import annotations

import binascii
import os
import select
import struct
import threading
import tty
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Pad = NDArray[np.int64]


def _zero_runs(pad: Pad) -> bytes:
    out, zeros = bytearray(), 0
    for value in [*pad.ravel().tolist(), -1]:
        if value == 0:
            zeros += 1
            if zeros == 254:
                out += bytes([0, 254])
                zeros = 0
            continue
        if zeros:
            out += bytes([0, zeros])
            zeros = 0
        if value > 0:
            out.append(value)
    return bytes(out) + b"\xff"


def _fabric(pad: Pad, i: int) -> bytes:
    body = b"\x01" + struct.pack(">H", 512) + struct.pack(">256H", *pad.ravel()) + bytes([i % 256])
    return b"\xaa" + body + struct.pack(">H", binascii.crc_hqx(body, 0xFFFF)) + b"\xcc"


def _bare(pad: Pad, i: int) -> bytes:
    return b"".join(struct.pack(">16H", *((row << 12) | pad[row])) for row in range(16))


def _wiresens(pad: Pad, i: int) -> bytes:
    flat = pad.ravel().tolist()
    return b"".join(
        struct.pack("<bH64HI", 1, start, *flat[start : start + 64], 4 * i + start // 64) + b"wr"
        for start in range(0, 256, 64)
    )


def _glove(pad: Pad, i: int) -> bytes:
    return b"".join(
        bytes([0x3C + k, 0x01]) + struct.pack(">H", (k % 16 << 12) | (4095 - v)) + b"\x00"
        for k, v in enumerate(pad.ravel().tolist())
    )


def _lines(pad: Pad, i: int) -> bytes:
    return b"".join(b"".join(b"%d," % v for v in row) + b"\r\n" for row in pad.tolist())


def _csv(pad: Pad) -> bytes:
    return ",".join(map(str, pad.ravel().tolist())).encode()


@dataclass
class Kit:
    """A kit: its preset, pad size, the values it can send, its encoder."""

    preset: str
    shape: tuple[int, int]
    high: int
    encode: Callable[[Pad, int], bytes]
    low: int = 0
    by_silence: bool = False
    pieces: int = 1
    can_tell: bool = True
    device_time: Callable[[int], float] | None = None
    lead_in: bytes = b""
    followers: int = 1
    junk: bytes = field(default=b"rst:0x1 (POWERON_RESET)\r\nready\r\n")

    def pad(self, rng: np.random.Generator) -> Pad:
        """Return a pad as a user sees it: mostly empty, one blob, some noise."""
        rows, columns = self.shape
        y, x = np.ogrid[:rows, :columns]
        cy, cx = rng.uniform(0, rows), rng.uniform(0, columns)
        blob = self.high * np.exp(-((y - cy) ** 2 + (x - cx) ** 2) / 8.0)
        noise = rng.integers(0, 3, self.shape)
        return np.clip(blob.astype(np.int64) + noise, self.low, self.high)

    def random_pad(self, rng: np.random.Generator) -> Pad:
        """Return a pad of any values at all that the kit can send."""
        return rng.integers(self.low, self.high + 1, self.shape)


def _flexitac(rows: int) -> Kit:
    return Kit(
        f"flexitac-{rows}x32",
        (rows, 32),
        255,
        lambda pad, i: b"\xaa\x55" + pad.astype(np.uint8).tobytes(),
        followers=2,
    )


KITS = [
    _flexitac(12),
    _flexitac(16),
    _flexitac(32),
    Kit(
        "fsrray",
        (16, 16),
        4095,
        lambda pad, i: struct.pack("<II", 1000 * i, 1000 * i + 700) + pad.astype("<u2").tobytes(),
        by_silence=True,
        device_time=lambda i: 1e-3 * i,
        followers=0,
    ),
    Kit(
        "m1616",
        (16, 16),
        4095,
        lambda pad, i: b"\xaa\xab\xac" + pad.astype(">u2").tobytes() + struct.pack(">I", i),
    ),
    Kit("fabric-16x16", (16, 16), 4095, _fabric, followers=0),
    Kit("fabric-16x16-bare", (16, 16), 4095, _bare),
    Kit(
        "itas",
        (16, 16),
        255,
        lambda pad, i: pad.astype(np.uint8).tobytes(),
        low=1,
        by_silence=True,
        followers=0,
    ),
    Kit("zero-runs-16x16", (16, 16), 254, lambda pad, i: _zero_runs(pad), can_tell=False,
        lead_in=b"\xff", followers=0),
    Kit(
        "pressure-mat-28x56",
        (28, 56),
        255,
        lambda pad, i: pad.astype(np.uint8).tobytes() + b"\xff\xfe\xfe\xff",
        lead_in=b"\xff\xfe\xfe\xff",
        followers=0,
    ),
    Kit("velostat-43x14", (43, 14), 1023, lambda pad, i: b"F," + _csv(pad) + b"\n",
        can_tell=False, followers=0),
    Kit(
        "fsr-8x8",
        (8, 8),
        4095,
        lambda pad, i: (b"CFG,8,8\r\n" if i == 0 else b"")
        + b"F,%d," % (2000 * i)
        + _csv(pad)
        + b"\r\n",
        can_tell=False,
        device_time=lambda i: 2e-3 * i,
        followers=0,
    ),
    Kit("bnl-16x16", (16, 16), 1023, _lines, by_silence=True, can_tell=False,
        followers=0),
    Kit("wiresens-16x16", (16, 16), 4095, _wiresens, pieces=4, lead_in=b"wr",
        followers=0),
    Kit("tactile-glove", (8, 8), 4095, _glove, pieces=64, lead_in=b"\x00", followers=1),
    Kit(
        "fulai-glove",
        (16, 16),
        4095,
        lambda pad, i: pad.astype("<f4").tobytes() + b"\x00\x00\x80\x7f",
        lead_in=b"\x00\x00\x80\x7f",
        followers=0,
    ),
]  # fmt: skip


def chunks(data: bytes, size: int) -> Iterable[bytes]:
    """Cut a stream as a port might deliver it."""
    return (data[i : i + size] for i in range(0, len(data), size))


class FakePad:
    """A pad on a pseudo terminal behind a link, to be unplugged and plugged in again."""

    def __init__(self, link: Path) -> None:
        self.link = link
        self.plug_in()

    def plug_in(self) -> None:
        """Appear: the link leads to a new terminal."""
        self.host_end, self._far_end = os.openpty()
        tty.setraw(self._far_end)
        beside = self.link.with_suffix(".new")
        beside.symlink_to(os.ttyname(self._far_end))
        beside.replace(self.link)

    def unplug(self) -> None:
        """Go away; what the host has not read is lost."""
        self.link.unlink()
        os.close(self.host_end)
        os.close(self._far_end)

    def send(self, data: bytes) -> None:
        """Send all of ``data``."""
        while data:
            data = data[os.write(self.host_end, data) :]

    def asked(self, n: int, unless: threading.Event) -> bytes:
        """Return ``n`` bytes the host sent; empty once ``unless`` is set."""
        got = b""
        while len(got) < n and not unless.is_set():
            ready, _, _ = select.select([self.host_end], [], [], 0.05)
            if ready:
                got += os.read(self.host_end, n - len(got))
        return got
