"""Kill runs with workers at random moments, whole or a worker of them, and resume to the same file.

    python benchmarks/attacks/workers.py                   # 20 kills of each kind
    python benchmarks/attacks/workers.py --tries 400       # 200 of each
    python benchmarks/attacks/workers.py --kills 2         # of a run; then it is let end
    python benchmarks/attacks/workers.py --nice 0          # among others that are as urgent

A run of `circle-1` with two workers over a store, or over an unpacked `.npz`, gets SIGKILL at a
moment drawn at random, until it ends by itself: after each kill no process of it may be left, the
output must not stand under its name, and `--resume` goes on. Or one of its workers gets SIGKILL,
again and again, and the run must end by itself. The file must be, to the byte, the one that one
process writes.
"""

from __future__ import annotations

import argparse
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from attempts import Attempt, parser_of, told

from tactile_graph import load

LONGEST_S = 3.0
GONE_S = 10.0
NAME = "out.csv"
RECORDINGS = ("frames.zarr", "frames.npz")


def begun(folder: Path, nice: int, *words: str) -> subprocess.Popen[bytes]:
    """Return a command in a session of its own."""
    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        ["nice", "-n", str(nice), sys.executable, "-P", "-m", "tactile_graph", *words],
        cwd=folder, stdout=nowhere, stderr=nowhere, start_new_session=True,
    )  # fmt: skip


def processes(session: int) -> dict[int, int]:
    """Return the living processes of a session, and whose children they are."""
    found = {}
    for place in Path("/proc").iterdir():
        with suppress(OSError, ValueError):
            rest = (place / "stat").read_text().rpartition(")")[2].split()
            if int(rest[3]) == session and rest[0] != "Z":
                found[int(place.name)] = int(rest[1])
    return found


def workers(run: int) -> list[int]:
    """Return the processes that work for a run: children of its children."""
    living = processes(run)
    return [p for p, parent in living.items() if living.get(parent) == run]


def left_of(run: int) -> list[int]:
    """Return what processes of a killed run are left after some seconds."""
    until = time.monotonic() + GONE_S
    while processes(run) and time.monotonic() < until:
        time.sleep(0.05)
    return list(processes(run))


def write_array(store: Path, array: Path) -> None:
    """Write the frames of a store as an array, unpacked and without their truth."""
    frames = [*load("circle-1").with_source("recording", path=store).frames()]
    values, image = np.stack([frame.image.values for frame in frames]), frames[0].image
    np.savez(
        array, values=values, pitch_cm=image.pitch_cm, origin_cm=image.origin_cm,
        quantity=image.quantity,
    )  # fmt: skip


class Killing:
    """A folder with a store and an array, and the files that one process makes of them."""

    def __init__(self, folder: Path, most_kills: int, n_frames: int, nice: int) -> None:
        self.folder, self.most_kills, self.nice = folder, most_kills, nice
        self._let_end("convert", "frames.zarr", "--source", "simulate", "--with",
                      f"frames={n_frames}")  # fmt: skip
        write_array(folder / "frames.zarr", folder / "frames.npz")
        self.wholes = {}
        for recording in RECORDINGS:
            self._let_end("run", "circle-1", recording, "-o", "one.csv")
            self.wholes[recording] = (folder / "one.csv").read_bytes()
        self.over("frames.zarr")

    def over(self, recording: str) -> None:
        """Take a recording for the runs that come."""
        self.recording, self.whole = recording, self.wholes[recording]

    def _let_end(self, *words: str) -> None:
        if begun(self.folder, self.nice, *words).wait():
            raise RuntimeError(f"{' '.join(words)} fails even when it is let end")

    def _begun(self, *more: str) -> subprocess.Popen[bytes]:
        words = ("run", "circle-1", self.recording, "--workers", "2", "-o", NAME, *more)
        return begun(self.folder, self.nice, *words)

    def the_whole(self, rng: random.Random) -> tuple[str, str]:
        """Kill a run, and those that resume it; return what came of it, and what is wrong."""
        output = self.folder / NAME
        output.unlink(missing_ok=True)
        run, n_kills = self._begun(), 0
        while n_kills < self.most_kills:
            with suppress(subprocess.TimeoutExpired):
                run.wait(rng.random() * LONGEST_S)
                break
            os.kill(run.pid, signal.SIGKILL)
            run.wait()
            n_kills += 1
            if left := left_of(run.pid):
                return "LEFT", f"{len(left)} processes are left {GONE_S:g} s after the kill"
            if output.exists() and output.read_bytes() != self.whole:
                return "CUT", "what stands under its name is not whole"
            run = self._begun("--resume")
        return self._ended(run, f"{n_kills} kills")

    def a_worker(self, rng: random.Random) -> tuple[str, str]:
        """Kill workers of a run; return what came of it, and what is wrong."""
        (self.folder / NAME).unlink(missing_ok=True)
        run, n_kills = self._begun(), 0
        while run.poll() is None and n_kills < self.most_kills:
            time.sleep(rng.random() * LONGEST_S / 2)
            at_work = workers(run.pid)
            if at_work:
                with suppress(ProcessLookupError):
                    os.kill(rng.choice(at_work), signal.SIGKILL)
                    n_kills += 1
        return self._ended(run, f"{n_kills} kills")

    def _ended(self, run: subprocess.Popen[bytes], came: str) -> tuple[str, str]:
        code = run.wait()
        if code:
            return "FAILED", f"it ends with {code} after {came}"
        same = (self.folder / NAME).read_bytes() == self.whole
        hidden = [p.name for p in self.folder.glob(f".{NAME}*")]
        if not same:
            return "OTHER", f"another file than one process writes, after {came}"
        return came, f"{hidden} are left" if hidden else ""


def attack(args: argparse.Namespace) -> Iterator[Attempt]:
    """Yield what came of killing runs, and their workers, in turn."""
    rng = random.Random(args.seed)
    with tempfile.TemporaryDirectory() as folder:
        killing = Killing(Path(folder), args.kills, args.frames, args.nice)
        for i in range(args.tries):
            recording = RECORDINGS[i // 2 % 2]
            killing.over(recording)
            what = f"{'a worker' if i % 2 else 'the whole'}, {recording.partition('.')[2]}"
            since = time.monotonic()
            came, why = (killing.a_worker if i % 2 else killing.the_whole)(rng)
            yield Attempt(what, came, why, time.monotonic() - since)


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything was lost, cut or left running."""
    parser = parser_of(__doc__ or "", 40)
    parser.add_argument("--kills", type=int, default=5, help="of one run at most")
    parser.add_argument("--frames", type=int, default=4000, help="of a recording")
    parser.add_argument("--nice", type=int, default=10, help="how far others come first")
    args = parser.parse_args(arguments)
    return told(attack(args), args)


if __name__ == "__main__":
    sys.exit(main())
