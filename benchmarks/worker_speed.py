"""Frames a second of `run --workers`, beside joblib and Dask's bag over the same function.

    python benchmarks/worker_speed.py                           # circle-3, 20,000 frames
    python benchmarks/worker_speed.py --frames 1000000 --repeated --only memory

All read the same store and write JSON lines. Two processes apart, each a plain run over half of the
frames with nothing between them, are what this machine's two cores can give: beside frames a second
stands each way's ratio to one process and to these two. joblib and Dask's bag (a way whose package
is not installed is told and left out) are given, as people write it, a function that reads a range
of frames with the library and returns their lines; the lines are joined in order. Kernels are
compiled before, and each is run once before it counts; times are of the whole command or call,
workers' start included. Memory is the most that all processes of a run held together (proportional
set size), sampled.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from throughput import GRID, discs

MB = 1e6
LOOK_S = 0.25
PORTION = 1000
ONE, APART = "one process", "two apart"
REPEATED = 5000
"""Frames that are repeated to make many."""


def command(*words: str) -> list[str]:
    return [sys.executable, "-P", "-m", "tactile_graph", *words]


def ran(*words: str) -> None:
    subprocess.run(command(*words), check=True, stderr=subprocess.DEVNULL)


def make_store(store: str, n_frames: int, repeated: bool) -> None:
    """Write simulated frames, or a few thousand of them again and again, without their truth."""
    if not repeated:
        ran("convert", store, "--source", "simulate", "--with", f"frames={n_frames}")
        return
    values = np.tile(discs(REPEATED), (-(-n_frames // REPEATED), 1, 1))[:n_frames]
    recording = f"{store}.npz"
    np.savez(recording, values=values, **GRID)  # type: ignore[arg-type]
    ran("convert", recording, store)
    Path(recording).unlink()


# -- the same by others' means ------------------------------------------------------------------


def lines_of(store: str, pipeline: str, low: int) -> str:
    """Return the lines of a range of frames: what joblib and Dask are given to do."""
    from tactile_graph import load
    from tactile_graph.cli.output.writers import JsonLines
    from tactile_graph_sources.readers.sequence.in_ranges import ranges_of_recordings

    ranges = ranges_of_recordings(Path(store))
    assert ranges is not None
    frames = ranges.read(low, min(low + PORTION, ranges.n_frames))
    lines = JsonLines()
    return "".join(lines.line(result) for result in load(pipeline).stream(frames))


def joblib_run(store: str, pipeline: str, n_frames: int, n_workers: int, output: str) -> None:
    import joblib

    lows = range(0, n_frames, PORTION)
    work = (joblib.delayed(lines_of)(store, pipeline, low) for low in lows)
    with Path(output).open("w") as file:
        file.writelines(joblib.Parallel(n_workers, return_as="generator")(work))


def bag_run(store: str, pipeline: str, n_frames: int, n_workers: int, output: str) -> None:
    import dask
    import dask.bag

    lows = list(range(0, n_frames, PORTION))
    bag = dask.bag.from_sequence(lows, partition_size=1).map(partial(lines_of, store, pipeline))
    with dask.config.set(scheduler="processes", num_workers=n_workers):
        Path(output).write_text("".join(bag.compute()))


def apart(store: str, pipeline: str, n_frames: int, output: str) -> None:
    """Run each half of the frames by a process of its own, at the same time."""
    half = n_frames // 2
    parts = [f"{output}.{k}.jsonl" for k in range(2)]
    runs = [
        subprocess.Popen(
            command("run", pipeline, store, "--frames", span, "-o", part),
            stderr=subprocess.DEVNULL,
        )
        for span, part in zip((f"0:{half}", f"{half}:{n_frames}"), parts, strict=True)
    ]
    codes = [run.wait() for run in runs]
    if any(codes):
        raise RuntimeError("a run over half of the frames failed")
    Path(output).write_bytes(b"".join(Path(part).read_bytes() for part in parts))


# -- measured ----------------------------------------------------------------------------------


def seconds(act: Callable[[], Any]) -> float:
    begun = time.perf_counter()
    act()
    return time.perf_counter() - begun


def held_mb(session: int) -> float:
    """Return what the processes of a session hold, pages that they share counted once."""
    total = 0
    for place in Path("/proc").iterdir():
        with suppress(OSError, ValueError):
            rest = (place / "stat").read_text().rpartition(")")[2].split()
            if int(rest[3]) == session:
                rollup = (place / "smaps_rollup").read_text().splitlines()
                total += sum(int(line.split()[1]) for line in rollup if line.startswith("Pss:"))
    return total * 1024 / MB


@contextmanager
def watched(session: int) -> Iterator[list[float]]:
    """Sample the memory of a session while it lasts."""
    samples: list[float] = []
    over = threading.Event()

    def look() -> None:
        while not over.wait(LOOK_S):
            samples.append(held_mb(session))

    thread = threading.Thread(target=look)
    thread.start()
    try:
        yield samples
    finally:
        over.set()
        thread.join()


def memory_of(*words: str) -> dict[str, float]:
    """Return how long a command took, and how much it held at most up to parts of that time."""
    process = subprocess.Popen(command(*words), stderr=subprocess.DEVNULL, start_new_session=True)
    begun = time.perf_counter()
    with watched(process.pid) as samples:
        code = process.wait()
    if code:
        raise RuntimeError(f"{' '.join(words)} ended with {code}")
    spent = time.perf_counter() - begun
    parts = {
        f"up to {percent} %": max(samples[: max(1, len(samples) * percent // 100)])
        for percent in (10, 50, 100)
    }
    return {"seconds": spent, **parts}


class Way(NamedTuple):
    """A way to have all frames done: what it takes a file's name for, and the package it needs."""

    act: Callable[[str], Any]
    needs: str = ""

    @property
    def missing(self) -> str:
        """The package that is not installed; "" if the way can be gone."""
        return self.needs if self.needs and importlib.util.find_spec(self.needs) is None else ""


def ways_of(store: str, pipeline: str, n_frames: int) -> dict[str, Way]:
    """Return the ways, in the order in which they are taken: what ratios are to comes first."""
    run = ("run", pipeline, store, "-o")
    given = (store, pipeline, n_frames)
    return {
        ONE: Way(lambda out: ran(*run, out)),
        APART: Way(lambda out: apart(*given, out)),
        "--workers 1": Way(lambda out: ran(*run, out, "--workers", "1")),
        "--workers 2": Way(lambda out: ran(*run, out, "--workers", "2")),
        "joblib, 1": Way(lambda out: joblib_run(*given, 1, out), needs="joblib"),
        "joblib, 2": Way(lambda out: joblib_run(*given, 2, out), needs="joblib"),
        "dask.bag, 2": Way(lambda out: bag_run(*given, 2, out), needs="dask"),
    }


def speeds(ways: Mapping[str, Way], n_frames: int, rounds: int, folder: Path) -> dict[str, float]:
    """Return frames a second of each way that can be gone, and check that all write the same.

    Prints a line for each, with the ratio to one process and to two apart.
    """
    found: dict[str, float] = {}
    contents = set()
    print(f"{'':12} {'frames/s':>9} {'of one':>7} {'of two apart':>13}", flush=True)
    for name, way in ways.items():
        if way.missing:
            print(f"{name:12} left out: {way.missing} is not installed", flush=True)
            continue
        out = str(folder / "out.jsonl")
        least_s = min(seconds(partial(way.act, out)) for _ in range(1 + rounds))
        found[name] = n_frames / least_s
        contents.add(Path(out).read_bytes())
        print(f"{name:12} {found[name]:9.0f} {ratios(found, name)}", flush=True)
    print("all write the same" if len(contents) == 1 else "NOT all write the same", flush=True)
    return found


def ratios(found: Mapping[str, float], name: str) -> str:
    """Return a way's frames a second over those of one process and of two apart, once known."""
    of_one, of_apart = (f"{found[name] / found[k]:.2f}" if k in found else "" for k in (ONE, APART))
    return f"{of_one:>7} {of_apart:>13}"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--frames", type=int, default=20_000)
    parser.add_argument("--pipeline", default="circle-3")
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument(
        "--repeated", action="store_true", help="the same few thousand frames again and again"
    )
    parser.add_argument("--only", choices=("speed", "memory"))
    parser.add_argument("--json")
    args = parser.parse_args()
    found: dict[str, Any] = {"pipeline": args.pipeline, "frames": args.frames}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        store = str(folder / "frames.zarr")
        make_store(store, args.frames, args.repeated)
        if args.only != "memory":
            found["frames a second"] = speeds(
                ways_of(store, args.pipeline, args.frames), args.frames, args.rounds, folder
            )
        if args.only != "speed":
            run = ("run", args.pipeline, store, "-o", str(folder / "memory.jsonl"))
            found["megabytes"] = {
                name: memory_of(*run, *more)
                for name, more in (("one process", ()), ("--workers 2", ("--workers", "2")))
            }
            for name, held in found["megabytes"].items():
                told = ", ".join(f"{k} {v:.0f}" for k, v in held.items() if k != "seconds")
                print(f"{name}: {held['seconds']:.0f} s; MB: {told}", flush=True)
    if args.json:
        Path(args.json).write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
