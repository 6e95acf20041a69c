"""Contacts counted with each frame's own level, and with one of the whole recording.

    python benchmarks/level_of_recording.py ../shared/data

Of the capacitive images of the folder it is known how many contacts each shows; those of one
person's session are a recording. Of other recordings only how often the number changes from one
frame to the next is told.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph.errors import DataError

MOST_FRAMES = 50
WAYS = ("each frame's", "the recording's")


def counted(files: list[Path]) -> tuple[list[Frame], list[NDArray[np.int64]]]:
    """Return the frames of a recording, and how many contacts each shows, either way."""
    paths = [str(path) for path in files]
    pipeline = load("contacts").with_source("recording", path=paths)
    frames = list(pipeline.frames())
    frames = frames[:: max(1, len(frames) // MOST_FRAMES)]
    numbers = []
    for settings in ({}, {"footprint.noise_of": {"path": paths}}):
        found: dict[str, Any] = dict(settings)
        told = pipeline.with_settings(found)
        results = [told.run(frame).get("contacts") for frame in frames]
        numbers.append(np.array([0 if r is None else r.count for r in results]))
    return frames, numbers


def sessions(folder: Path) -> dict[str, list[Path]]:
    """Return the files of each session of capacitive images."""
    found = defaultdict(list)
    for path in sorted(folder.glob("capcontact_others/*.npz")):
        found[path.name[:5]].append(path)
    found["capcontact"] = sorted(folder.glob("capcontact/*.npz"))
    return {name: files for name, files in found.items() if files}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("data", type=Path)
    folder = parser.parse_args().data
    right, n = np.zeros(2), 0
    for name, files in sessions(folder).items():
        frames, numbers = counted(files)
        truth = np.array([len(f.truth or ()) for f in frames])
        hits = np.array([(k == truth).sum() for k in numbers])
        right, n = right + hits, n + len(frames)
        print(f"{name:20} {len(frames):4} images, right with {WAYS[0]} level {hits[0]}, "
              f"{WAYS[1]} {hits[1]}")  # fmt: skip
    print(f"{'all':20} {n:4} images, right {right[0] / n:.1%} and {right[1] / n:.1%}")
    for path in [*sorted(folder.glob("vendor_exports/*")), *sorted(folder.glob("popu_bed/*.json"))]:
        try:
            frames, numbers = counted([path])
        except DataError:
            continue  # a licence, not a recording
        changes = [int(np.count_nonzero(np.diff(k))) for k in numbers]
        print(f"{path.name:20} {len(frames):4} frames, the number changes {changes[0]} and "
              f"{changes[1]} times")  # fmt: skip


if __name__ == "__main__":
    main()
