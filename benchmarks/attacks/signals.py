"""Attack commands with signals at any moment, and with streams that are closed.

    python benchmarks/attacks/signals.py                  # 60 tries, two minutes
    python benchmarks/attacks/signals.py --tries 2000     # an hour

Each try runs a command that writes, sends it SIGINT, SIGTERM, SIGHUP or SIGKILL at a moment drawn
at random, every second time one within 30 ms of its first file, and looks at what is left: lines
must be whole, files whole or not there, stores open; the exit code must be 128 and the signal's
number and no traceback may be shown. Some are run with standard input, output or error closed.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from attempts import Attempt, parser_of, told

from tactile_graph_sources.store import read_store

SOURCE = ("--source", "simulate", "--with", "scene=discs")
COMMANDS: dict[str, tuple[str, ...]] = {
    "run jsonl": ("run", "circle-1", *SOURCE, "--frames", "100", "-o", "out.jsonl"),
    "run csv": ("run", "circle-1", *SOURCE, "--frames", "100", "-o", "out.csv"),
    "run parquet": ("run", "circle-1", *SOURCE, "--frames", "100", "-o", "out.parquet"),
    "run images": ("run", "circle-1", *SOURCE, "--frames", "100", "--only", "frame",
                   "-o", "out.h5"),
    "run film": ("run", "circle-1", *SOURCE, "--frames", "6", "--plot", "out.gif"),
    "compare": ("compare", "circle-1", "circle-2", *SOURCE, "--frames", "30", "--json", "out.json",
                "--report", "out.html"),
    "audit": ("audit", "circle-3", *SOURCE, "--frames", "30", "--json", "out.json"),
    "convert npz": ("convert", "out.npz", *SOURCE, "--with", "frames=100"),
    "convert zarr": ("convert", "out.zarr", *SOURCE, "--with", "frames=100"),
    "record": ("record", "out.zarr", *SOURCE, "--with", "frames=100", "--chunk", "8"),
}  # fmt: skip
SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP", "SIGKILL")
LONGEST_S = 600.0
SOON_S = 0.03
CLOSED_SHARE = 0.15


def started(words: Sequence[str], folder: Path, shell: str = "") -> subprocess.Popen[bytes]:
    """Return a command that runs in a folder; ``shell`` may close its streams."""
    env = {**os.environ, "TACTILE_GRAPH_KERNELS": "plain"}
    command = [sys.executable, "-m", "tactile_graph", *words]
    if shell:
        command = ["sh", "-c", f'exec "$@" {shell}', "sh", *command]
    return subprocess.Popen(
        command, cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


# -- what is left ------------------------------------------------------------------------------


def _lines(path: Path) -> str:
    text = path.read_text()
    if text and not text.endswith("\n"):
        return "the last line is cut"
    for line in text.splitlines() if path.suffix == ".jsonl" else ():
        json.loads(line)
    return ""


def _json(path: Path) -> str:
    json.loads(path.read_text())
    return ""


def _page(path: Path) -> str:
    return "" if path.read_text().rstrip().endswith("</html>") else "the page is cut"


def _archive(path: Path) -> str:
    with np.load(path) as data:
        return "" if len(data["values"]) == 100 else "frames are missing"


def _store(path: Path) -> str:
    index = [f.index for f in read_store(path)]
    return "" if index == list(range(len(index))) else f"frames {index}"


def _stacks(path: Path) -> str:
    import h5py

    with h5py.File(path) as file:
        n, values = len(file["index"]), file.get("frame/values")
        # A run that ends before its first frame knows no grid.
        return "" if n == (0 if values is None else len(values)) else "stacks are unequal"


def _rows(path: Path) -> str:
    import pyarrow.parquet

    return "" if pyarrow.parquet.read_table(path).num_rows <= 100 else "too many rows"


def _film(path: Path) -> str:
    import imageio.v3 as iio

    return "" if len(list(iio.imiter(path))) else "no picture"


LOOKS: dict[str, Callable[[Path], str]] = {
    ".jsonl": _lines, ".csv": _lines, ".json": _json, ".html": _page, ".npz": _archive,
    ".zarr": _store, ".h5": _stacks, ".parquet": _rows, ".gif": _film,
}  # fmt: skip


def left_in(folder: Path, killed: bool) -> str:
    """Return what is wrong with the files a command left; "" if nothing is."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            if path.suffix == ".part" and not killed:
                return f"{path.name} is left behind"
            continue
        try:
            why = LOOKS[path.suffix](path)
        except Exception as error:
            why = repr(error)
        if why:
            return f"{path.name}: {why}"
    return ""


# -- tries -------------------------------------------------------------------------------------


def wait_for_a_file(running: subprocess.Popen[bytes], folder: Path) -> None:
    """Wait until a command has begun to write, or has ended."""
    while running.poll() is None and not any(folder.iterdir()):
        time.sleep(0.0005)


def once(name: str, number: signal.Signals, after_s: float, from_file: bool, folder: Path) -> str:
    """Return what is wrong after a command got a signal; "" if nothing is.

    ``after_s`` counts from the start, or from its first file.
    """
    running = started(COMMANDS[name], folder)
    if from_file:
        wait_for_a_file(running, folder)
    time.sleep(after_s)
    running.send_signal(number)
    try:
        _, said = running.communicate(timeout=LONGEST_S)
    except subprocess.TimeoutExpired:
        running.kill()
        running.communicate()
        return "does not end"
    # Until its handlers are set, which is in its first tenths of a second, a signal kills it.
    if running.returncode not in (0, 128 + number, -number):
        return f"exit code {running.returncode}: {said[-300:].decode(errors='replace')}"
    if b"Traceback" in said and running.returncode != -number:
        return f"traceback: {said[-300:].decode(errors='replace')}"
    return left_in(folder, number == signal.SIGKILL or running.returncode == -number)


def closed(name: str, stream: str, folder: Path) -> str:
    """Return what is wrong with a command that runs with a stream closed."""
    running = started(COMMANDS[name], folder, stream)
    _, said = running.communicate(timeout=LONGEST_S)
    if b"Traceback" in said or b"Error:" in said:
        return f"traceback: {said[-300:].decode(errors='replace')}"
    if stream == ">&-":
        told = running.returncode == 2 and b"standard output is closed" in said
        return "" if told else f"exit code {running.returncode}: {said[-300:]!r}"
    if running.returncode:
        return f"exit code {running.returncode}: {said[-300:].decode(errors='replace')}"
    return left_in(folder, killed=False)


def attack(n_tries: int, seed: int) -> Iterator[Attempt]:
    """Yield what came of commands, left alone, without a stream, and with a signal."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        lasts: dict[str, float] = {}
        for _ in range(n_tries):
            command = rng.choice(list(COMMANDS))
            if command not in lasts:
                begun = time.monotonic()
                why = closed(command, "", _emptied(folder))
                yield Attempt("left alone", "ended" if not why else "FAILED", f"{command}: {why}"
                              if why else "")  # fmt: skip
                lasts[command] = time.monotonic() - begun
            if rng.random() < CLOSED_SHARE:
                stream = rng.choice(("<&-", ">&-", "2>&-"))
                what, why = f"without {stream}", closed(command, stream, _emptied(folder))
            else:
                what, why = signalled(command, lasts[command], folder, rng)
            why = why and f"{command}: {why}"
            yield Attempt(what, "as promised" if not why else "FAILED", why)


def signalled(command: str, lasts_s: float, folder: Path, rng: random.Random) -> tuple[str, str]:
    """Return which signal a command got, and what is wrong with what it did then."""
    number, from_file = signal.Signals[rng.choice(SIGNALS)], rng.random() < 0.5
    after_s = rng.random() * (SOON_S if from_file else lasts_s)
    why = once(command, number, after_s, from_file, _emptied(folder))
    since = "its first file" if from_file else "its start"
    return number.name, why and f"{after_s:.3f} s from {since} on: {why}"


def _emptied(folder: Path) -> Path:
    shutil.rmtree(folder)
    folder.mkdir()
    return folder


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything went wrong."""
    args = parser_of(__doc__, 60).parse_args(arguments)
    return told(attack(args.tries, args.seed), args)


if __name__ == "__main__":
    sys.exit(main())
