"""Attack the decoders: damaged streams on pads that hold what the protocol uses as its marks.

    python benchmarks/attacks/ports.py                                  # 2000 frames a line
    python benchmarks/attacks/ports.py --preset m1616 --total 1000000   # over the preset's lines
    python benchmarks/attacks/ports.py --damage none                    # what caution costs

2 % of the frames are damaged: a byte lost, a byte flipped (half of them among the first four
of a frame), a byte inserted, or a burst (up to three frames cut out, overwritten, or inserted).
The pads are still, at random, or hold the header; they start without it, or hold it from the first
byte on. Every 4096 frames the pads are others, and the header stands elsewhere; `scenes` change
every few frames. A frame is wrong if a cell holds what was sent for no such cell near it in time
(`torn`: each cell was sent, but by two frames); cells that were overwritten are let off, as are
those next to a lost character where frames are counted out. Frames marked as doubtful are not
given as good; `needless` are those of them that were right. A relock counts the frames from a
damage to the next one that comes out, `sure` to the next that is not doubtful.
"""

from __future__ import annotations

import argparse
import dataclasses
import struct
import sys
import time
import zlib
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers_serial import KITS, Kit, chunks
from tactile_graph_sources.devices.decoder import Decoded, Decoder
from tactile_graph_sources.devices.preset_file import load_preset

HIT = 0.02
POOL = 256
POOLS_ALIKE = 16
RELOCK_MOST = 50
KEPT = 3 * POOL
"""Frames sent that a frame that comes out is looked for among."""
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
"""How cells are written, and the bytes in them that look like a header.

The other kits' values cannot hold one: their marks are no values, or a silence."""
COUNTED = ("zero-runs-16x16", "velostat-43x14", "fsr-8x8", "bnl-16x16")
"""Kits whose frames are counted out: what is hurt stays where it is."""


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
    needless: int = 0
    wrong: int = 0
    torn: int = 0
    relock: int = 0
    sure: int = 0


def marked(kit: Kit, pad: Pad, share: float) -> Pad:
    """Return the pad with the kit's header in its data, at a share of the frame."""
    if kit.preset == "fabric-16x16-bare":  # its marks are the row in the top nibbles
        rows = np.arange(kit.shape[0])[:, None]
        return (pad & 0xF0F) | (rows << 4)
    dtype, mark = MARKS[kit.preset]
    raw = bytearray(pad.astype(dtype).tobytes())
    at = int(len(raw) * share) // np.dtype(dtype).itemsize * np.dtype(dtype).itemsize
    at = min(at, len(raw) - 8)
    if share == 0.5:  # two headers exactly half a frame apart look the same from either
        head = len(kit.encode(pad, 0)) - len(raw)
        at = (len(raw) + head) // 2 - (0 if kit.lead_in else head)
    raw[at : at + len(mark)] = mark
    return np.frombuffer(bytes(raw), dtype).reshape(kit.shape)


def flicker(kit: Kit, pads: NDArray[np.int64], rng: np.random.Generator) -> list[Pad]:
    """Return a pool of the pad, or of the pads, with noise."""
    noise = rng.integers(0, 3, (POOL, *kit.shape))
    return [*np.clip(pads + noise, kit.low, kit.high)]


def moving(kit: Kit, rng: np.random.Generator) -> list[Pad]:
    """Return a pool of pads with a blob that goes round, once in 100 frames."""
    turn = 2 * np.pi * np.arange(POOL)[:, None] / 100
    y, x = (np.arange(n) for n in kit.shape)
    down = np.exp(-((y - kit.shape[0] * (0.5 + 0.3 * np.sin(turn))) ** 2) / 8.0)
    along = np.exp(-((x - kit.shape[1] * (0.5 + 0.3 * np.cos(turn))) ** 2) / 8.0)
    blobs = 0.8 * kit.high * down[:, :, None] * along[:, None, :]
    return flicker(kit, blobs.astype(np.int64), rng)


def scenes(kit: Kit, mark: bool, rng: np.random.Generator) -> list[Pad]:
    """Return still scenes of 4 to 63 frames each, every other one with a header somewhere."""
    pads: list[Pad] = []
    while len(pads) < POOL:
        pad: Pad = kit.pad(rng) if rng.random() < 0.7 else kit.random_pad(rng)
        if mark and rng.random() < 0.5:
            pad = marked(kit, pad, float(rng.uniform(0.02, 0.98)))
        pads += [pad] * int(rng.integers(4, 64))
    return pads[:POOL]


def pads_of(kit: Kit, kind: str, rng: np.random.Generator) -> list[Pad]:
    """Return a pool of pads of a kind, sent over and over."""
    still = kit.pad(rng)
    if "scenes" in kind:
        return scenes(kit, "header" in kind, rng)
    plain: dict[str, Callable[[], list[Pad]]] = {
        "random": lambda: [kit.random_pad(rng) for _ in range(POOL)],
        "still": lambda: [still] * POOL,
        "moving": lambda: moving(kit, rng),
        "flicker": lambda: flicker(kit, still, rng),
    }
    if "header" in kind and "still" in kind:
        plain["still"] = lambda: [still]
    pads = next(make for name, make in plain.items() if name in kind)()
    if "header" not in kind:
        return pads
    share = 0.5 if "half" in kind else float(rng.uniform(0.02, 0.98))
    held = [marked(kit, pad, share) for pad in pads]
    return held * (POOL // len(held))


def kinds_of(kit: Kit) -> list[str]:
    """Return the kinds of pads to try on a kit; some can hold no header in their data."""
    kinds = ["random", "still", "moving", "scenes"]
    if kit.preset in MARKS or kit.preset == "fabric-16x16-bare":
        kinds += ["header still", "header flicker", "header random", "header moving"]
        kinds += ["header still from the start", "header scenes"]
    if kit.preset in MARKS:
        kinds += ["header half still", "header half random"]
    return kinds


def _counted_chunks(part: bytes, i: int) -> bytes:
    size = len(part) // 4
    ends = [size * k + size - 6 for k in range(4)]
    cut = [part[0 : ends[0]], *(part[ends[k] + 4 : ends[k + 1]] for k in range(3))]
    return b"".join(c + struct.pack("<I", 4 * i + k) for k, c in enumerate(cut)) + part[-2:]


NUMBERED: dict[str, Callable[[bytes, int], bytes]] = {
    "fsrray": lambda part, i: struct.pack("<II", 1000 * i, 1000 * i + 700) + part[8:],
    "m1616": lambda part, i: part[:-4] + struct.pack(">I", i),
    "fsr-8x8": lambda part, i: b"F,%d," % (2000 * i) + part.split(b",", 2)[2],
    "wiresens-16x16": _counted_chunks,
}
"""How an encoded frame becomes that of another number; fabric's number is one of 256 = POOL."""


class Tape:
    """Frames of a kind of pad, encoded once and numbered anew each time they are sent."""

    def __init__(self, kit: Kit, kind: str, rng: np.random.Generator) -> None:
        self.kit, self.kind, self.rng = kit, kind, rng
        self.n_pools = self.n_sent = 0
        self.pads: list[Pad] = []
        self.coded: list[bytes] = []

    def load(self, pads: list[Pad]) -> None:
        self.pads = pads
        self.coded = [self.kit.encode(p, 1 + i) for i, p in enumerate(pads)]  # type: ignore[arg-type]

    def next(self, n: int = POOL) -> tuple[list[Pad], list[bytes]]:
        """Return the next frames' pads and bytes; new pads after a while."""
        if self.n_pools % POOLS_ALIKE == 0 and n == POOL:
            self.load(pads_of(self.kit, self.kind, self.rng))
        self.n_pools += n == POOL
        parts, first = self.coded[:n], self.n_sent
        self.n_sent += n
        number = NUMBERED.get(self.kit.preset)
        if number is not None:
            parts = [number(part, first + i) for i, part in enumerate(parts)]
        return self.pads[:n], list(parts)


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


def stretch(tape: Tape, damage: str, n: int = POOL) -> Sent:
    """Return the next frames of a tape, damaged."""
    kit, rng = tape.kit, tape.rng
    pads, parts = tape.next(n)
    touched = np.zeros(n, np.int64)
    if damage == "none":
        return Sent(pads, parts, touched, np.zeros(0, np.int64))
    hits = np.flatnonzero(rng.random(n) < HIT)
    for i in hits.tolist():
        hurt = DAMAGES[damage](parts, i, rng) if parts[i] else 0
        if hurt:
            reach = i + 1 + hurt // max(1, len(parts[i]))
            touched[i : reach + 1] += hurt
        if kit.preset in COUNTED:
            touched[i : i + 4] += 3 + hurt
    return Sent(pads, parts, touched, hits)


def feed(kit: Kit, decoder: Decoder, sent: Sent, chunk: int) -> list[Decoded]:
    out: list[Decoded] = []
    if not kit.by_silence:
        for data in chunks(b"".join(sent.parts), chunk):
            out += decoder.feed(data)
        return out
    for part in sent.parts:
        out += decoder.feed(part)
        out += decoder.boundary()
    return out


class Judge:
    """Holds what comes out against what was sent."""

    def __init__(self, kit: Kit) -> None:
        self.row = Row()
        self.preset = kit.preset
        self.pads: list[Pad] = []
        self.raw: list[bytes] = []
        self.ends = np.zeros(0, np.int64)
        self.touched = np.zeros(0, np.int64)
        self.hits: dict[str, list[int]] = {"relock": [], "sure": []}
        self.last = {"relock": -1, "sure": -1}
        self.first = 0
        self.place = len(kit.lead_in)
        self.told: list[str] = []

    def send(self, sent: Sent) -> None:
        """Take note of what is sent; what is long gone is forgotten."""
        drop = max(0, len(self.pads) - KEPT)
        self.first += drop
        n = self.first + len(self.pads) - drop
        self.pads = self.pads[drop:] + sent.pads
        self.raw = self.raw[drop:] + [p.astype(np.float64).tobytes() for p in sent.pads]
        ends = self.place + np.cumsum([len(part) for part in sent.parts])
        self.place = int(ends[-1])
        self.ends = np.concatenate([self.ends[drop:], ends])
        self.touched = np.concatenate([self.touched[drop:], sent.touched])
        for hits in self.hits.values():
            hits += (n + sent.hits).tolist()
        self.row.sent += len(sent.pads)

    def judge(self, frames: Iterable[Decoded]) -> None:
        """Count what came out, right or wrong."""
        frames = list(frames)
        places = np.searchsorted(self.ends, [d.end for d in frames]).tolist()
        for d, at in zip(frames, places, strict=True):
            self.row.given += 1
            right = at < len(self.raw) and d.values.tobytes() == self.raw[at]
            verdict = "right" if right else self._verdict(d, at)
            self._relock("relock", self.first + at)
            if d.doubtful:
                self.row.doubtful += 1
                self.row.needless += verdict == "right"
            elif verdict == "right":
                self._relock("sure", self.first + at)
            else:
                self._tell(d, at, verdict)

    def _relock(self, which: str, at: int) -> None:
        """Count how long nothing came since damage, from the first hit not yet recovered from."""
        hits = self.hits[which]
        while hits and hits[0] <= at - 1:
            hit = hits.pop(0)
            if self.last[which] < hit + 1:
                setattr(self.row, which, max(getattr(self.row, which), at - hit))
        self.last[which] = at

    def _verdict(self, d: Decoded, at: int) -> str:
        near = [k for k in (at, at - 1, at + 1) if 0 <= k < len(self.pads)]
        if any(np.array_equal(d.values, self.pads[k]) for k in near):
            return "right"
        let_off = max((int(self.touched[k]) for k in near), default=0)
        if min(np.count_nonzero(d.values != self.pads[k]) for k in near) <= let_off:
            return "right"
        around = [self.pads[k] for k in range(max(0, at - 8), min(len(self.pads), at + 8))]
        strange = np.flatnonzero(np.all([d.values != p for p in around], axis=0))
        mixed = len(strange) == 1 and self._is_mixed(d, around, int(strange[0]))
        return "torn" if len(strange) <= let_off + mixed else "wrong"

    def _is_mixed(self, d: Decoded, around: list[Pad], cell: int) -> bool:
        """Return whether the bytes of a cell are the first ones of one pad, the last of another."""
        dtype = np.dtype(MARKS.get(self.preset, (">u2", b""))[0])
        got = d.values.reshape(-1)[cell].astype(dtype).tobytes()
        sent = [p.reshape(-1)[cell].astype(dtype).tobytes() for p in around]
        return any(
            any(s[:i] == got[:i] for s in sent) and any(s[i:] == got[i:] for s in sent)
            for i in range(1, dtype.itemsize)
        )

    def _tell(self, d: Decoded, at: int, verdict: str) -> None:
        setattr(self.row, verdict, getattr(self.row, verdict) + 1)
        at = min(at, len(self.pads) - 1)
        n = int(np.count_nonzero(d.values != self.pads[at]))
        self.told.append(f"{verdict}: frame {self.first + at}, {n} of {d.values.size} cells")

    def finish(self) -> Row:
        """Count damages that nothing right came after."""
        for which, hits in self.hits.items():
            if hits and self.row.sent - hits[0] > RELOCK_MOST:
                worst = max(getattr(self.row, which), self.row.sent - hits[0])
                setattr(self.row, which, worst)
        return self.row


def attack(kit: Kit, damage: str, kind: str, args: argparse.Namespace) -> Judge:
    """Return what comes of a kit under a damage on a kind of pad."""
    rng = np.random.default_rng([args.seed, zlib.crc32(f"{kit.preset} {damage} {kind}".encode())])
    decoder, judge = Decoder(load_preset(kit.preset)), Judge(kit)
    decoder.feed(kit.lead_in)
    tape = Tape(kit, kind, rng)

    def send(sent: Sent) -> None:
        judge.send(sent)
        judge.judge(feed(kit, decoder, sent, args.chunk))

    if "header" in kind and "start" not in kind:
        for pads in ([kit.pad(rng) for _ in range(40)], pads_of(kit, kind, rng)[:40]):
            tape.load(list(pads))
            send(stretch(tape, "none", 40))
    for _ in range(0, args.frames, POOL):
        send(stretch(tape, damage))
    judge.finish()
    return judge


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", action="append", choices=[k.preset for k in KITS])
    parser.add_argument("--damage", action="append", choices=[*DAMAGES, "none"])
    parser.add_argument("--pad", action="append", help="kinds of pads, such as 'header still'")
    parser.add_argument("--frames", type=int, default=2000, help="for each line of the table")
    parser.add_argument("--total", type=int, help="for each preset, over its lines")
    parser.add_argument("--chunk", type=int, default=16384, help="bytes fed at a time")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    names = [f.name for f in dataclasses.fields(Row)]
    print(f"{'preset':20} {'damage':7} {'pad':28} " + " ".join(f"{n:>8}" for n in names))
    failed, start = 0, time.monotonic()
    for kit in KITS:
        if args.preset and kit.preset not in args.preset:
            continue
        lines = [(d, k) for k in kinds_of(kit) for d in args.damage or DAMAGES]
        lines = [(d, k) for d, k in lines if not args.pad or k in args.pad]
        if args.total:
            args.frames = -(-args.total // len(lines))
        for damage, kind in lines:
            judge = attack(kit, damage, kind, args)
            row = judge.row
            failed += (row.wrong > 0 and kit.can_tell) or row.relock > RELOCK_MOST
            numbers = " ".join(f"{n:8}" for n in dataclasses.astuple(row))
            print(f"{kit.preset:20} {damage:7} {kind:28} {numbers}", flush=True)
            print(*judge.told[:5], sep="\n", end="\n" if judge.told else "", file=sys.stderr)
    seconds = time.monotonic() - start
    print(f"{failed} lines with a wrong frame or a relock over {RELOCK_MOST}; {seconds:.0f} s")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
