"""How long one waits for a shipped pipeline: with no machine code on disk, and with all of it.

Run ``python benchmarks/first_answer.py [PIPELINE ...]``. The whole command
``tactile-graph run PIPELINE --frames 1`` on the pipeline's own source is timed, first on an empty
cache, then ``--rounds`` times on what that left; Python may keep its byte code, as it does unless
told otherwise. Besides the time that passed, processor time is given, which neighbours on the
machine change little.
"""

from __future__ import annotations

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

COMMAND = Path(sys.executable).with_name("tactile-graph")


class Cost(NamedTuple):
    wall_s: float
    processor_s: float


def cost(arguments: list[str], cache: str) -> Cost:
    """Return what a command costs that keeps its machine code in ``cache``."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache, "PYTHONDONTWRITEBYTECODE": ""}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    done = subprocess.run(
        [COMMAND, *arguments], env=environment, capture_output=True, text=True, check=False
    )
    wall_s = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode > 1:
        sys.exit(f"tactile-graph {' '.join(arguments)}: {done.stderr}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Cost(wall_s, used)


def row(name: str, arguments: list[str], rounds: int) -> None:
    """Time a command on an empty cache and on a full one, and print it as a row."""
    with tempfile.TemporaryDirectory() as cache:
        empty = cost(arguments, cache)
        cost(["prepare", arguments[1]], cache)  # waits for what is still being compiled
        warm = [cost(arguments, cache) for _ in range(rounds)]
    wall_s, processor_s = (statistics.median(column) for column in zip(*warm, strict=True))
    print(
        f"| {name} | {empty.wall_s:.1f} | {empty.processor_s:.1f} "
        f"| {wall_s:.2f} | {processor_s:.2f} |",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("pipelines", nargs="*", help="all shipped ones if none is named")
    parser.add_argument("--rounds", type=int, default=3, help="warm runs of each (3)")
    asked = parser.parse_args()
    names = asked.pipelines
    if not names:
        from tactile_graph.plugins.registry import installed

        names = installed().names("pipelines")
    print("| | empty cache, s | processor | warm, s | processor |")
    print("|---|---|---|---|---|")
    for name in names:
        row(name, ["run", name, "--frames", "1"], asked.rounds)
    if not asked.pipelines:
        both = ["compare", "circle-likelihood", "circle-3", "--frames", "2"]
        row("`compare circle-likelihood circle-3`", both, asked.rounds)


if __name__ == "__main__":
    main()
