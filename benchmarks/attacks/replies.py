"""Attack the reading of pads that are asked for each frame: replies that pause, and more.

    python benchmarks/attacks/replies.py                           # half a minute a line
    python benchmarks/attacks/replies.py --preset itas --seconds 600

A pad on a pseudo terminal answers each request; one reply in twelve is hurt: it pauses for up to
1.2 s somewhere, loses a byte, gains one, or does not come. Bytes come at the pace of the line, 64
at a time. All cells of a frame are alike and those of the next one differ, so that a frame of two
replies shows, and so does one with a byte too many. `given` counts the frames given as good, `torn`
those of them whose cells differ.
"""

from __future__ import annotations

import argparse
import struct
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))

from helpers_serial import FakePad
from tactile_graph.steps.injected import Report
from tactile_graph_sources.serial_port import serial

HIT = 1.0 / 12.0
LONGEST_PAUSE_S = 1.2
REPLIES: dict[str, Callable[[int], bytes]] = {
    "itas": lambda i: bytes([1 + i % 250]) * 256,
    "fsrray": lambda i: struct.pack("<II256H", 9000 * i, 9000 * i + 900, *[1 + i % 4000] * 256),
}
BYTE_S = {"itas": 10.0 / 115_200, "fsrray": 10.0 / 500_000}
PACKET = 64
DAMAGES = ("pause", "loss", "insert", "silence")


def pieces(reply: bytes, damage: str, rng: np.random.Generator) -> list[bytes]:
    """Return a reply in pieces, between which the pad pauses."""
    at = int(rng.integers(len(reply)))
    if damage == "pause":
        return [reply[:at], reply[at:]]
    if damage == "loss":
        return [reply[:at] + reply[at + 1 :]]
    if damage == "insert":
        return [reply[:at] + b"\x55" + reply[at:]]
    return []


def packets(part: bytes) -> list[bytes]:
    """Return what an adapter hands on at a time; the last bytes come together."""
    first = len(part) % PACKET or PACKET
    return [part[:first], *(part[k : k + PACKET] for k in range(first, len(part), PACKET))]


def answer(
    pad: FakePad, preset: str, damage: str, rng: np.random.Generator, over: threading.Event
) -> None:
    """Play the pad's part."""
    i = 0
    while pad.asked(1, over):
        i += 1
        reply = REPLIES[preset](i)
        parts = pieces(reply, damage, rng) if i > 1 and rng.random() < HIT else [reply]
        for k, part in enumerate(parts):
            if k:
                time.sleep(float(rng.uniform(0.0, LONGEST_PAUSE_S)))
            for sent in packets(part):
                pad.send(sent)
                time.sleep(len(sent) * BYTE_S[preset])


def attack(preset: str, damage: str, seconds: float, seed: int) -> tuple[int, int, int]:
    """Return how many frames were given as good, how many were torn, how many doubtful."""
    rng = np.random.default_rng([seed, DAMAGES.index(damage)])
    over = threading.Event()
    given = torn = doubtful = 0
    with tempfile.TemporaryDirectory() as folder:
        pad = FakePad(Path(folder) / "tty")
        player = threading.Thread(target=answer, args=(pad, preset, damage, rng, over))
        player.start()
        for frame in serial(port=str(pad.link), preset=preset, seconds=seconds, report=Report()):
            doubtful += frame.doubtful
            given += not frame.doubtful
            torn += not frame.doubtful and len(np.unique(frame.image.values)) > 1
        over.set()
        player.join()
        pad.unplug()
    return given, torn, doubtful


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--preset", action="append", choices=[*REPLIES])
    parser.add_argument("--damage", action="append", choices=DAMAGES)
    parser.add_argument("--seconds", type=float, default=30.0, help="for each line of the table")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    print(f"{'preset':10} {'damage':8} {'given':>8} {'torn':>8} {'doubtful':>8}")
    failed = 0
    for preset in args.preset or REPLIES:
        for damage in args.damage or DAMAGES:
            given, torn, doubtful = attack(preset, damage, args.seconds, args.seed)
            failed += torn > 0 or given == 0
            print(f"{preset:10} {damage:8} {given:8} {torn:8} {doubtful:8}", flush=True)
    print(f"{failed} lines with a torn frame, or with none")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
