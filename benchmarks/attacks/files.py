"""Attack readers with files that ask for work out of proportion: bombs, lying sizes, no end.

    python benchmarks/attacks/files.py                    # each once; ten minutes
    python benchmarks/attacks/files.py --only npz zip     # those with one of these words
    python benchmarks/attacks/files.py --tries 40 --seed 3 # forty of them, drawn at random
    python benchmarks/attacks/files.py --after 300        # goes on where a run was ended

Recordings, pipelines, conditions, pads, presets, scenes, databases and their exports, at most 20 MB
each. A file that is refused must be within 0.5 CPU seconds and 200 MB beyond what the process held
before. What is read may take in proportion to the file, its frames and their values. Every reading
is in a process of its own.
"""

from __future__ import annotations

import random
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from attempts import Attempt, parser_of, told
from hostile_documents import PIPELINE, STEP, conditions, databases, documents, pipelines
from hostile_recordings import Make, file_of, recordings
from measured import Measured, measured

from tactile_graph import Frame, load, loads
from tactile_graph.errors import TactileGraphError
from tactile_graph.steps import Report
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.devices.preset_file import load_preset
from tactile_graph_sources.recording import recording
from tactile_graph_sources.scene import load_scene

MOST_S, MOST_MB = 0.5, 200.0
ENOUGH_FRAMES, ENOUGH_VALUES = 20_000, 100_000_000
LOADED_S = 20.0
"""For each MB of YAML that is no mistake: half a millisecond a node."""
READ_S, READ_MB = 0.5, 50.0
"""For each MB of a file that is read, beyond what its frames and values may take."""
FRAME_S, FRAME_MB, VALUE_S, VALUE_MB = 5e-4, 3e-4, 1e-6, 16e-6


class Hostile(NamedTuple):
    """A file: what it is, what makes it, and what reads it."""

    what: str
    make: Make
    read: Callable[[Path], str]


def frames_of(path: Path) -> str:
    """Return how many frames and values a recording gives."""
    n = values = 0
    for frame in recording(path=path, report=Report()):
        n += 1
        values += frame.image.values.size
        if n > ENOUGH_FRAMES or values > ENOUGH_VALUES:
            break
        if not np.isfinite(frame.image.values).all():
            raise FloatingPointError("a value that is not finite")
    return f"read {n} {values}"


def one_frame(path: Path) -> str:
    pipeline = load(path)
    pipeline.run(Frame.of(np.ones((16, 16)), quantity="volt"))
    return "loaded"


def said(read: Callable[[str], object]) -> Callable[[Path], str]:
    """Return what reads a file by its name, whatever it gives."""

    def act(path: Path) -> str:
        read(str(path))
        return "loaded"

    return act


def with_condition(text: str) -> Callable[[Path], str]:
    def act(path: Path) -> str:
        quoted = "'" + text.replace("'", "''") + "'"
        nodes = PIPELINE.replace("  a:", "  f:") + (
            f"  a: {STEP[:-1]}, when: {quoted}}}\noutputs: [a]\n"
        )
        loads(nodes).run(Frame.of(np.ones((16, 16)), quantity="volt"))
        return "loaded"

    return act


def hostile() -> Iterator[Hostile]:
    """Yield every file there is."""
    for what, make in recordings():
        yield Hostile(f"recording: {what}", make, frames_of)
    for what, text in (*documents(), *pipelines()):
        content = file_of("a.yaml", lambda t=text: t().encode("utf-8", "replace"))
        yield Hostile(f"pipeline: {what}", content, one_frame)
    for kind, read in (("pad", load_pad), ("preset", load_preset), ("scene", load_scene)):
        for what, text in documents():
            content = file_of("a.yaml", lambda t=text: t().encode("utf-8", "replace"))
            yield Hostile(f"{kind}: {what}", content, said(read))
        yield Hostile(f"{kind}: no end", endless, said(read))
    for what, text in conditions():
        yield Hostile(f"condition: {what}", lambda folder: folder, with_condition(text))
    for what, make in databases():
        yield Hostile(f"database: {what}", make, lambda path: said_of(path))


USUAL = ("store: frames of billions", "TIFF wide", "store: no chunk")
"""Recordings whose reading imports what others need."""


def endless(folder: Path) -> Path:
    (folder / "a.yaml").symlink_to("/dev/zero")
    return folder / "a.yaml"


def said_of(path: Path) -> str:
    load_known(path, None)
    return "loaded"


def prepare(folder: Path, files: Sequence[Hostile]) -> None:
    """Have all imported that reading needs, that it is not counted."""
    from helpers_dialects import dialects

    for dialect in dialects():
        path = folder / "usual"
        path.write_bytes(dialect.content)
        try:
            frames_of(path)
        except TactileGraphError:
            continue
    for file in files:
        if file.what.removeprefix("recording: ") in USUAL:
            tried(file, folder)
    loads(PIPELINE + "outputs: [a]\n").run(Frame.of(np.ones((16, 16)), quantity="volt"))
    load_pad("thesis")
    load_scene("discs")
    load_preset("m1616")
    load_known(None, None)


def tried(file: Hostile, folder: Path) -> tuple[str, str]:
    """Return what came of reading a file, in a word and at length."""
    with tempfile.TemporaryDirectory(dir=folder) as name, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read(file, file.make(Path(name)))


def read(file: Hostile, path: Path) -> tuple[str, str]:
    try:
        return file.read(path), ""
    except TactileGraphError as error:
        return "refused", str(error)
    except MemoryError as error:
        return "FOREIGN", f"MemoryError: {error}"
    except Exception as error:
        return "FOREIGN", repr(error)


def allowed(came: str, megabytes: float) -> tuple[float, float]:
    """Return the seconds and the memory that reading a file may take."""
    seconds, memory = MOST_S, MOST_MB
    if came == "loaded":
        seconds += LOADED_S * megabytes
    if came.startswith("read "):
        _, n, values = came.split()
        seconds += FRAME_S * int(n) + VALUE_S * int(values) + READ_S * megabytes
        memory += FRAME_MB * int(n) + VALUE_MB * int(values) + READ_MB * megabytes
    return seconds, memory


def judged(file: Hostile, found: Measured, megabytes: float) -> Attempt:
    """Return what came of a file, and whether it took too much."""
    kind = file.what.partition(":")[0]
    came = found.came.partition(" ")[0] if found.came.startswith("read") else found.came
    why = "" if came.islower() else found.why
    most_s, most_mb = allowed(found.came, megabytes)
    if not why and (found.seconds > most_s or found.megabytes > most_mb):
        why = f"too much; allowed are {most_s:.1f} s, {most_mb:.0f} MB"
    if why:
        took = f"{found.seconds:.2f} s, {found.megabytes:.0f} MB of a file of {megabytes:.2f} MB"
        why = f"{file.what}: {took}: {found.came}: {why}; {found.why[:160]}"
    return Attempt(f"{kind}s {came}", f"most {bucket(found.megabytes)} MB", why, found.seconds)


def bucket(megabytes: float) -> int:
    """Return a round number that is not less."""
    return next((n for n in (1, 10, 50, 100, 200, 500, 1000) if megabytes <= n), 10_000)


def attack(files: Sequence[Hostile], every: Sequence[Hostile]) -> Iterator[Attempt]:
    """Yield what came of some of all files."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        prepare(folder, every)
        for file in files:
            with tempfile.TemporaryDirectory(dir=folder) as own:
                # Made by a process of its own too, or this one would grow.
                made = measured(lambda f=file, o=own: (str(f.make(Path(o))), ""))  # type: ignore[misc]
                path = Path(made.came)
                files = [path, *path.rglob("*")] if path.is_relative_to(own) else []
                size = sum(f.stat().st_size for f in files if f.is_file()) / 1e6
                found = measured(lambda f=file, p=path: read(f, p))  # type: ignore[misc]
                yield judged(file, found, size)


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything took too much or was foreign."""
    parser = parser_of(__doc__, 0)
    parser.add_argument("--only", nargs="+", default=[""], help="words, one of which is in it")
    parser.add_argument("--after", type=int, default=0, help="how many of them are left out first")
    args = parser.parse_args(arguments)
    every = [*hostile()]
    files = [f for f in every if any(word in f.what for word in args.only)][args.after :]
    if args.tries:
        files = random.Random(args.seed).sample(files, min(args.tries, len(files)))
    return told(attack(files, every), args)


if __name__ == "__main__":
    sys.exit(main())
