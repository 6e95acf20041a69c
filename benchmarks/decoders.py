"""Decoders of pads on a serial port: throughput, and what gets through when bytes are lost.

    python benchmarks/decoders.py                       # all kits, 1 000 000 frames in all
    python benchmarks/decoders.py --kit flexitac-12x32 --frames 1000000

Each kit's frames are encoded by the tests' own encoder, not by the decoder's tables. In 2 % of
the frames one byte, at random, is left out; a frame that comes out and is none of those sent is
corrupt. Throughput is per second of processor time, as decoders wait for nothing. 2 Mbaud bring
0.2 MB/s, so 20 times that is 4 MB/s.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from helpers_serial import KITS, Kit, chunks
from tactile_graph_sources.devices.decoder import Decoded, Decoder
from tactile_graph_sources.devices.preset_file import load_preset

LOST = 0.02
POOL = 512
TWO_MBAUD_MB_S = 0.2


def pool(kit: Kit, rng: np.random.Generator) -> tuple[list[bytes], set[bytes]]:
    """Return encoded frames, half as users see them and half at random, and their values."""
    pads = [kit.pad(rng) if i % 2 else kit.random_pad(rng) for i in range(POOL)]
    sent = {pad.astype(np.float64).tobytes() for pad in pads}
    return [kit.encode(pad, i) for i, pad in enumerate(pads)], sent


def lossy(frame: bytes, rng: np.random.Generator) -> bytes:
    at = int(rng.integers(len(frame)))
    return frame[:at] + frame[at + 1 :]


def send(kit: Kit, decoder: Decoder, frames: list[bytes]) -> list[Decoded]:
    """Feed a block of frames as the link would: by silence, or in chunks of 8192 bytes."""
    out: list[Decoded] = []
    if kit.by_silence:
        for frame in frames:
            out += decoder.feed(frame)
            out += decoder.boundary()
        return out
    for chunk in chunks(b"".join(frames), 8192):
        out += decoder.feed(chunk)
    return out


def losses(kit: Kit, n_frames: int, seed: int) -> tuple[Decoder, int]:
    """Return the decoder after ``n_frames`` with losses, and how many corrupt ones passed."""
    rng = np.random.default_rng(seed)
    encoded, sent = pool(kit, rng)
    decoder = Decoder(load_preset(kit.preset))
    decoder.feed(kit.lead_in)
    if kit.by_silence:
        decoder.boundary()
    corrupt = 0
    for _ in range(0, n_frames, POOL):
        hit = rng.random(POOL) < LOST
        block = [lossy(f, rng) if h else f for f, h in zip(encoded, hit, strict=True)]
        corrupt += sum(d.values.tobytes() not in sent for d in send(kit, decoder, block))
    return decoder, corrupt


def throughput(kit: Kit, seed: int, rounds: int = 5) -> float:
    """Return MB a second of processor time, the median of some rounds."""
    encoded, _ = pool(kit, np.random.default_rng(seed))
    size = sum(map(len, encoded))
    rates = []
    for _ in range(rounds):
        decoder = Decoder(load_preset(kit.preset))
        start = time.process_time()
        send(kit, decoder, encoded)
        rates.append(size / (time.process_time() - start) / 1e6)
    return float(np.median(rates))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kit", action="append", choices=[k.preset for k in KITS])
    parser.add_argument("--frames", type=int, default=1_000_000, help="in all, over the kits")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    kits = [k for k in KITS if not args.kit or k.preset in args.kit]
    each = -(-args.frames // len(kits) // POOL) * POOL
    print(f"{each} frames a kit, a byte lost in {100 * LOST:g} % of them, seed {args.seed}")
    print(f"{'kit':20} {'MB/s':>7} {'x 2 Mbaud':>9} {'good':>9} {'bad':>7} {'corrupt':>8}")
    wrong = 0
    notes = []
    for kit in kits:
        rate = throughput(kit, args.seed)
        decoder, corrupt = losses(kit, each, args.seed)
        c = decoder.counts
        row = f"{kit.preset:20} {rate:7.1f} {rate / TWO_MBAUD_MB_S:9.0f} {c.good:9} {c.n_bad:7}"
        print(f"{row} {corrupt:8}{'' if kit.can_tell else ' *'}", flush=True)
        wrong += corrupt if kit.can_tell else 0
        if decoder.preset.cannot_tell:
            notes.append(f"* {kit.preset}: the protocol cannot tell {decoder.preset.cannot_tell}")
    print(*notes, sep="\n")
    print(f"corrupt frames where look-ahead or a check applies: {wrong}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
