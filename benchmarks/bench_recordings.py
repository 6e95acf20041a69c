"""How fast recordings are read: megabytes and frames a second, medians over rounds.

    python benchmarks/bench_recordings.py [FILE …]

Without files: generated 16 x 16 films as a table, a long table, ``.npy`` and ``.npz``.
"""

from __future__ import annotations

import statistics
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from tactile_graph.steps import Report
from tactile_graph.wires import Frame
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.write_npz import write_npz

ROUNDS = 5


def measure(path: Path) -> None:
    seconds, n = [], 0
    for _ in range(ROUNDS):
        start = time.perf_counter()
        n = sum(1 for _ in recording(path=path, report=Report()))
        seconds.append(time.perf_counter() - start)
    median = statistics.median(seconds)
    size = path.stat().st_size / 1e6
    print(
        f"{path.name:28s} {size:7.2f} MB {n:6d} frames  {1e3 * median:8.1f} ms  "
        f"{size / median:7.1f} MB/s  {n / median:9.0f} frames/s"
    )


def generated(folder: Path) -> list[Path]:
    rng = np.random.default_rng(0)
    films = np.round(rng.uniform(0.0, 5.0, (2000, 16, 16)), 3)
    np.savetxt(folder / "one-frame-a-line.csv", films.reshape(2000, -1), "%.3f", ",")
    with (folder / "one-cell-a-line.csv").open("w") as file:
        file.write("frame,row,col,value\n")
        file.writelines(f"{k},{i},{j},{v}\n" for (k, i, j), v in np.ndenumerate(films[:400]))
    np.save(folder / "film.npy", films)
    write_npz(folder / "film.npz", [Frame.of(v, 1.3, quantity="volt") for v in films])
    return sorted(folder.iterdir())


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        given = [Path(argument) for argument in sys.argv[1:]]
        for path in given or generated(Path(folder)):
            measure(path)


if __name__ == "__main__":
    main()
