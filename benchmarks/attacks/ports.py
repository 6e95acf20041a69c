"""Attack the decoders: damaged streams on pads that hold what the protocol uses as its marks.

    python benchmarks/attacks/ports.py                                  # 2000 frames each
    python benchmarks/attacks/ports.py --preset m1616 --frames 1000000

2 % of the frames are damaged: a byte lost, a byte flipped (half of them among the first four
of a frame), a byte inserted, or a burst (up to three frames cut out, overwritten, or inserted).
The pads are still, at random, or hold the header at a fixed place, a third or half way through a
frame; they start without it, or hold it from the first byte on. A frame is wrong if a cell holds
what was sent for no such cell near it in time (`torn`: each cell was sent, but by two frames);
cells that were overwritten are let off, as are those next to a lost character where frames are
counted out. Frames marked as doubtful are not given as good. A relock counts the frames from a
damage to the next one that comes out.
"""

from __future__ import annotations

import argparse
import dataclasses
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers_serial import KITS, Kit, chunks
from tactile_graph_sources.devices.decoder import Decoded, Decoder
from tactile_graph_sources.devices.preset_file import load_preset

HIT = 0.02
POOL = 256
CHUNK = 4096
RELOCK_MOST = 50
Pad = NDArray[np.generic]
MARKS: dict[str, tuple[str, bytes]] = {
    "flexitac-12x32": ("u1", b"\xaa\x55"),
    "flexitac-16x32": ("u1", b"\xaa\x55"),
    "flexitac-32x32": ("u1", b"\xaa\x55"),
    "m1616": (">u2", b"\xaa\xab\xac"),
    "fabric-16x16": (">u2", b"\x00\xaa\x01\x02\x00"),
    "pressure-mat-28x56": ("u1", b"\xff\xfe\xfe\xff"),
    "fulai-glove": ("<f4", b"\x00\x00\x00\x80\x7f"),  # from a second byte on: else it is infinite
}
"""How cells are written, and the bytes in them that look like a header."""


@dataclasses.dataclass
class Sent:
    """A stretch of a stream: what was sent, what became of it, and how it was hurt."""

    pads: list[Pad]
    parts: list[bytes]
    touched: NDArray[np.int64]
    hits: NDArray[np.int64]


@dataclasses.dataclass
class Row:
    """What came of one preset under one damage on one pad."""

    sent: int = 0
    given: int = 0
    doubtful: int = 0
    wrong: int = 0
    torn: int = 0
    relock: int = 0


def marked(kit: Kit, pad: Pad, share: float) -> Pad:
    """Return the pad with the kit's header in its data, at a share of the frame."""
    if kit.preset == "fabric-16x16-bare":  # its marks are the row in the top nibbles
        rows = np.arange(kit.shape[0])[:, None]
        return (pad & 0xF0F) | (rows << 4)
    dtype, mark = MARKS[kit.preset]
    raw = bytearray(pad.astype(dtype).tobytes())
    at = int(len(raw) * share) // np.dtype(dtype).itemsize * np.dtype(dtype).itemsize
    head = len(kit.encode(kit.pad(np.random.default_rng(0)), 0)) - len(raw)
    if share == 0.5:  # two headers exactly half a frame apart look the same from either
        at = (len(raw) + head) // 2 - (0 if kit.lead_in else head)
    raw[at : at + len(mark)] = mark
    return np.frombuffer(bytes(raw), dtype).reshape(kit.shape)


def flicker(kit: Kit, pad: Pad, rng: np.random.Generator) -> Pad:
    noise = rng.integers(0, 3, kit.shape)
    return np.clip(pad + noise, kit.low, kit.high)


def moving(kit: Kit, i: int, rng: np.random.Generator) -> Pad:
    """Return a pad with a blob that goes round, once in 100 frames."""
    y, x = np.mgrid[: kit.shape[0], : kit.shape[1]]
    cy = kit.shape[0] * (0.5 + 0.3 * np.sin(2 * np.pi * i / 100))
    cx = kit.shape[1] * (0.5 + 0.3 * np.cos(2 * np.pi * i / 100))
    blob = 0.8 * kit.high * np.exp(-((y - cy) ** 2 + (x - cx) ** 2) / 8.0)
    return flicker(kit, blob.astype(np.int64), rng)


def pads_of(kit: Kit, kind: str, rng: np.random.Generator) -> list[Pad]:
    """Return a pool of pads of a kind, sent over and over."""
    still = kit.pad(rng)
    if kind == "random":
        return [kit.random_pad(rng) for _ in range(POOL)]
    if kind == "still":
        return [still] * POOL
    if kind == "moving":
        return [moving(kit, i, rng) for i in range(POOL)]
    share = 0.5 if "half" in kind else 1 / 3
    if "random" in kind:
        return [marked(kit, kit.random_pad(rng), share) for _ in range(POOL)]
    if "moving" in kind:
        return [marked(kit, moving(kit, i, rng), share) for i in range(POOL)]
    if "flicker" in kind:
        return [marked(kit, flicker(kit, still, rng), share) for _ in range(POOL)]
    return [marked(kit, still, share)] * POOL


def kinds_of(kit: Kit) -> list[str]:
    """Return the kinds of pads to try on a kit; some can hold no header in their data."""
    kinds = ["random", "still", "moving"]
    if kit.preset in MARKS or kit.preset == "fabric-16x16-bare":
        kinds += ["header still", "header flicker", "header random", "header moving"]
        kinds += ["header still from the start"]
    if kit.preset in MARKS:
        kinds += ["header half still", "header half random"]
    return kinds


def lose(parts: list[bytes], i: int, rng: np.random.Generator) -> int:
    at = int(rng.integers(len(parts[i])))
    parts[i] = parts[i][:at] + parts[i][at + 1 :]
    return 0


def insert(parts: list[bytes], i: int, rng: np.random.Generator) -> int:
    at = int(rng.integers(len(parts[i]) + 1))
    parts[i] = parts[i][:at] + rng.bytes(1) + parts[i][at:]
    return 0


def flip(parts: list[bytes], i: int, rng: np.random.Generator) -> int:
    high = min(4, len(parts[i])) if rng.random() < 0.5 else len(parts[i])
    at = int(rng.integers(high))
    new = parts[i][at] ^ int(rng.integers(1, 256))
    parts[i] = parts[i][:at] + bytes([new]) + parts[i][at + 1 :]
    return 1


def burst(parts: list[bytes], i: int, rng: np.random.Generator) -> int:
    """Cut out, overwrite or insert up to three frames; return how many bytes were overwritten."""
    whole = len(parts[i])
    n = int(rng.integers(1, 3 * whole)) if rng.random() < 0.5 else int(rng.integers(1, 64))
    at = int(rng.integers(whole))
    how = rng.integers(3)
    if how == 0:
        parts[i] = parts[i][:at] + rng.bytes(n) + parts[i][at:]
        return 0
    left, first = n, at
    for k in range(i, len(parts)):
        cut = min(left, len(parts[k]) - first)
        new = b"" if how == 1 else rng.bytes(cut)
        parts[k] = parts[k][:first] + new + parts[k][first + cut :]
        left, first = left - cut, 0
        if left <= 0:
            break
    return n if how == 2 else 0


DAMAGES: dict[str, Callable[[list[bytes], int, np.random.Generator], int]] = {
    "loss": lose,
    "flip": flip,
    "insert": insert,
    "burst": burst,
}


def stretch(kit: Kit, pads: list[Pad], damage: str, first: int, rng: np.random.Generator) -> Sent:
    """Return a pool's worth of frames, damaged."""
    parts = [kit.encode(p, first + i) for i, p in enumerate(pads)]  # type: ignore[arg-type]
    hits = np.flatnonzero(rng.random(len(parts)) < HIT)
    touched = np.zeros(len(parts), np.int64)
    for i in hits.tolist():
        n = DAMAGES[damage](parts, i, rng) if parts[i] else 0
        if n:
            reach = i + 1 + n // max(1, len(parts[i]))
            touched[i : reach + 1] += n
        if kit.preset in COUNTED:
            touched[i : i + 4] += 3 + n
    return Sent(pads, parts, touched, hits)


COUNTED = ("zero-runs-16x16", "velostat-43x14", "fsr-8x8", "bnl-16x16")
"""Kits whose frames are counted out: what is hurt stays where it is."""


def feed(kit: Kit, decoder: Decoder, sent: Sent) -> Iterator[Decoded]:
    if not kit.by_silence:
        for chunk in chunks(b"".join(sent.parts), CHUNK):
            yield from decoder.feed(chunk)
        return
    for part in sent.parts:
        yield from decoder.feed(part)
        yield from decoder.boundary()


class Judge:
    """Holds what comes out against what was sent."""

    def __init__(self) -> None:
        self.row = Row()
        self.pads: list[Pad] = []
        self.ends: list[int] = []
        self.touched: list[int] = []
        self.hits: list[int] = []
        self.first = 0
        self.place = 0
        self.last_given = -1

    def send(self, sent: Sent) -> None:
        keep = 3 * POOL
        drop = max(0, len(self.pads) - keep)
        self.first += drop
        n = self.first + len(self.pads) - drop
        self.pads = self.pads[drop:] + sent.pads
        self.ends = self.ends[drop:]
        self.touched = self.touched[drop:] + sent.touched.tolist()
        for part in sent.parts:
            self.place += len(part)
            self.ends.append(self.place)
        self.hits += (n + sent.hits).tolist()
        self.row.sent += len(sent.pads)

    def judge(self, frames: Iterator[Decoded]) -> None:
        for d in frames:
            at = int(np.searchsorted(self.ends, d.end))
            self.row.given += 1
            self._relock(self.first + at)
            if getattr(d, "doubtful", False):
                self.row.doubtful += 1
            else:
                self._hold(d, at)

    def _relock(self, at: int) -> None:
        """Count how long nothing came since damage, from the first hit not yet recovered from."""
        while self.hits and self.hits[0] <= at - 1:
            hit = self.hits.pop(0)
            if self.last_given < hit + 1:
                self.row.relock = max(self.row.relock, at - hit)
        self.last_given = at

    def _hold(self, d: Decoded, at: int) -> None:
        near = [k for k in (at, at - 1, at + 1) if 0 <= k < len(self.pads)]
        if any(np.array_equal(d.values, self.pads[k]) for k in near):
            return
        let_off = max((self.touched[k] for k in near), default=0)
        if min(np.count_nonzero(d.values != self.pads[k]) for k in near) <= let_off:
            return
        around = [self.pads[k] for k in range(max(0, at - 5), min(len(self.pads), at + 5))]
        strange = np.all([d.values != p for p in around], axis=0)
        if np.count_nonzero(strange) <= let_off:
            self.row.torn += 1
        else:
            self.row.wrong += 1


def attack(kit: Kit, damage: str, kind: str, n_frames: int, seed: int) -> Row:
    """Return what comes of ``n_frames`` of a kit under a damage on a kind of pad."""
    rng = np.random.default_rng([seed, n_frames])
    decoder, judge = Decoder(load_preset(kit.preset)), Judge()
    decoder.feed(kit.lead_in)
    judge.place = len(kit.lead_in)
    pads = pads_of(kit, kind, rng)
    if "header" in kind and "start" not in kind:
        calm = [kit.pad(rng) for _ in range(40)]
        lead = Sent(calm, [kit.encode(p, i) for i, p in enumerate(calm)],
                    np.zeros(40, np.int64), np.zeros(0, np.int64))  # fmt: skip
        judge.send(lead)
        judge.judge(feed(kit, decoder, lead))
        clean = Sent(pads[:40], [kit.encode(p, i) for i, p in enumerate(pads[:40], 40)],  # type: ignore[arg-type]
                     np.zeros(40, np.int64), np.zeros(0, np.int64))  # fmt: skip
        judge.send(clean)
        judge.judge(feed(kit, decoder, clean))
    for first in range(0, n_frames, POOL):
        sent = stretch(kit, pads, damage, 80 + first, rng)
        judge.send(sent)
        judge.judge(feed(kit, decoder, sent))
    if judge.hits and judge.row.sent - judge.hits[0] > RELOCK_MOST:
        judge.row.relock = max(judge.row.relock, judge.row.sent - judge.hits[0])
    return judge.row


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", action="append", choices=[k.preset for k in KITS])
    parser.add_argument("--damage", action="append", choices=list(DAMAGES))
    parser.add_argument("--pad", action="append", help="kinds of pads, such as 'header still'")
    parser.add_argument("--frames", type=int, default=2000, help="for each line of the table")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    head = f"{'preset':20} {'damage':7} {'pad':28} {'sent':>8} {'given':>8} {'doubtful':>8}"
    print(f"{head} {'wrong':>7} {'torn':>5} {'relock':>6}")
    failed, start = 0, time.monotonic()
    for kit in KITS:
        if args.preset and kit.preset not in args.preset:
            continue
        for kind in kinds_of(kit):
            if args.pad and kind not in args.pad:
                continue
            for damage in args.damage or DAMAGES:
                r = attack(kit, damage, kind, args.frames, args.seed)
                failed += r.wrong > 0 or r.relock > RELOCK_MOST
                line = f"{kit.preset:20} {damage:7} {kind:28} {r.sent:8} {r.given:8} {r.doubtful:8}"
                print(f"{line} {r.wrong:7} {r.torn:5} {r.relock:6}", flush=True)
    seconds = time.monotonic() - start
    print(f"{failed} lines with a wrong frame or a relock over {RELOCK_MOST}; {seconds:.0f} s")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
