"""Frames a second of one core: circle-3 in blocks, frame by frame, and as an OpenCV script.

Run with ``python benchmarks/throughput.py``. Needs the ``bench`` extra for OpenCV and ``parquet``
for Parquet; what is not installed is left out. All contestants take the same frames, in turn, in
one process. Times are processor time, the least of all rounds: other programs then cost least. The
command line's is the time of whole processes, less that of a run over few frames (start, imports).
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from circle_frame import ORIGIN_CM, PITCH_CM, opencv_script
from numpy.typing import NDArray

from tactile_graph import Frame, Result, load
from tactile_graph.compiled import warm_up
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.runner import Runner
from tactile_graph.wires.frame_stack import FrameStack
from tactile_graph.wires.stacks import ImageStack

PIPELINES = ("circle-1", "circle-2", "circle-3")
BLOCK, SINGLE = 512, 512
GRID = {"pitch_cm": (PITCH_CM,) * 2, "origin_cm": (ORIGIN_CM,) * 2, "quantity": "volt"}
FORMS = ("csv", "jsonl", "parquet")
FEW = 2100
"""Frames of the short run that the long one is held against; enough for blocks."""


def discs(n: int) -> NDArray[np.float64]:
    """Return frames of 16 x 16 cells with a disc that wanders and grows, and a little noise."""
    rng = np.random.default_rng(0)
    rows, columns = np.indices((16, 16))
    t = np.arange(n)[:, None, None] / 50.0
    x, y = 7.5 + 2.0 * np.sin(t), 7.5 + 2.0 * np.cos(0.7 * t)
    radius = 4.0 + np.sin(0.31 * t)
    values = 0.2 * (np.hypot(rows - y, columns - x) < radius)
    return np.asarray(values + rng.normal(0.0, 1e-3, (n, 16, 16)))


def least_us(call: Callable[[], object], n: int, rounds: int) -> float:
    """Return the least processor time of a call, in us a frame."""
    call()
    best = float("inf")
    for _ in range(rounds):
        start = time.process_time()
        call()
        best = min(best, time.process_time() - start)
    return 1e6 * best / n


def engine(rounds: int) -> None:
    """Print what a frame takes, from an array of frames to the circles."""
    values = discs(BLOCK)
    frames = [
        Frame.of(v, PITCH_CM, (ORIGIN_CM,) * 2, "volt", index=i) for i, v in enumerate(values)
    ]
    times = {}
    for name in PIPELINES:
        together, alone = load(name).runner(), load(name).runner()
        times[f"{name}, a block of {BLOCK} frames"] = least_us(
            lambda r=together: in_a_block(r, values), BLOCK, rounds
        )
        times[f"{name}, frame by frame"] = least_us(
            lambda r=alone: [r(frame) for frame in frames], SINGLE, rounds
        )
    if find_spec("cv2"):
        script = opencv_script()
        times["OpenCV and NumPy, a loop"] = least_us(
            lambda: [script(v) for v in values], BLOCK, rounds
        )
    base = times.get("OpenCV and NumPy, a loop", times["circle-3, frame by frame"])
    print("us a frame, and how much faster than the loop:")
    for name, us in times.items():
        print(f"  {name:38} {us:7.2f} {base / us:7.1f}")


def in_a_block(runner: Runner[Result], values: NDArray[np.float64]) -> Block[Result]:
    images = ImageStack(values.copy(), **GRID)  # type: ignore[arg-type]
    return runner.block(FrameStack(images, np.arange(len(values))))


def nodes() -> None:
    """Print what each node of circle-3 takes in a block."""
    runner = load("circle-3").runner()
    values, n_slots, best = discs(BLOCK), runner.plan.n_slots, dict[str, float]()
    for _ in range(60):
        (group,) = in_a_block(runner, values).groups
        for item in runner.plan.nodes:
            us = group.state[n_slots + item.slot] / 1e3 / BLOCK
            best[item.name] = min(best.get(item.name, us), us)
    print("per node of circle-3, us: " + ", ".join(f"{n} {us:.2f}" for n, us in best.items()))


def command_line(n: int) -> None:
    """Print frames a second of ``tactile-graph run circle-3`` from an .npz to files."""
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for count in (FEW, n):
            files[count] = Path(folder) / f"{count}.npz"
            np.savez(files[count], values=discs(count), **GRID)  # type: ignore[arg-type]
        print(f"tactile-graph run circle-3 over {n} frames: processor time, frames a second")
        for form in FORMS:
            if form == "parquet" and not find_spec("pyarrow"):
                continue
            spent = {
                count: run_s(file, Path(folder) / f"out.{form}") for count, file in files.items()
            }
            seconds = spent[n] - spent[FEW]
            print(f"  {form:8} {spent[n]:6.2f} s in all {(n - FEW) / seconds:10,.0f} a second")


def run_s(recording: Path, output: Path) -> float:
    """Return the processor time of a run, the least of three."""
    command = [sys.executable, "-m", "tactile_graph", "run", "circle-3", recording, "-o", output]
    best = float("inf")
    for _ in range(3):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, capture_output=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        best = min(best, spent)
    return best


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--frames", type=int, default=100_000)
    parser.add_argument("--rounds", type=int, default=60)
    given = parser.parse_args()
    warm_up()
    engine(given.rounds)
    nodes()
    command_line(given.frames)
