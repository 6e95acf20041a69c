"""Kill every command that writes a file, at random moments, over what an earlier run left.

    python benchmarks/attacks/kills.py                     # 60 kills
    python benchmarks/attacks/kills.py --tries 20000       # 1,000 of each command
    python benchmarks/attacks/kills.py --only learn run    # those with one of these words

Each command runs in a fork of this process, which has all imported, and gets SIGKILL at a moment
drawn at random, every second time one within 30 ms of its first change to the folder. Every second
time what an earlier run wrote is there already. What stands under the name then must be whole: what
was there or what the command makes. Lines that are written as they come must be whole lines. A
database must hold what it held, or all that was to be learned. A name that was there must be.
What writers of stores leave is told by `stores.py`.
"""

from __future__ import annotations

import importlib
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import yaml
from attempts import Attempt, parser_of, told
from databases import same
from signals import LOOKS, SOURCE

from tactile_graph import load
from tactile_graph.cli.app import cli
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_sources.writers.write_npz import write_npz

SOON_S = 0.03
SAID, IMPORTED = "said", "imported"
"""Files that have what a command writes to standard error, and what it imported."""
GRAMS = (60, 100, 200, 300, 400, 600, 800, 1200)
LOADS = tuple(f"../in/load-{g}.npz={g}" for g in GRAMS)
DATABASE = ("--database", "objects.sqlite")
COMMANDS: dict[str, tuple[str, ...]] = {
    "run jsonl": ("run", "circle-1", *SOURCE, "--frames", "20", "-o", "a.jsonl"),
    "run csv": ("run", "circle-1", *SOURCE, "--frames", "20", "-o", "a.csv"),
    "run parquet": ("run", "circle-1", *SOURCE, "--frames", "20", "-o", "a.parquet"),
    "run h5": ("run", "circle-1", *SOURCE, "--frames", "20", "--only", "frame", "-o", "a.h5"),
    "run images": ("run", "circle-1", *SOURCE, "--frames", "20", "--only", "frame",
                   "-o", "images.zarr"),
    "run film": ("run", "circle-1", *SOURCE, "--frames", "2", "--plot", "a.gif"),
    "compare": ("compare", "circle-1", "circle-2", *SOURCE, "--frames", "5", "--json", "a.json",
                "--report", "a.html"),
    "audit": ("audit", "circle-3", *SOURCE, "--frames", "5", "--json", "a.json"),
    "convert npz": ("convert", "a.npz", *SOURCE, "--with", "frames=100"),
    "convert csv": ("convert", "b.csv", *SOURCE, "--with", "frames=50"),
    "learn": ("learn", "stone", "../in/load-400.npz", *DATABASE),
    "forget": ("forget", "cup", *DATABASE),
    "objects --import": ("objects", "--import", "../in/more.yaml", *DATABASE),
    "objects --export": ("objects", "--export", "a.yaml", "--overwrite", *DATABASE),
    "learn-pad": ("learn-pad", "--empty", "../in/empty.npz", *LOADS, "-o", "pad.yaml",
                  "--overwrite", "--plots", "a.html"),
    "calibrate": ("calibrate", *LOADS, "-o", "a.yaml", "--plot", "a.svg"),
    "graph": ("graph", "circle-3", "-o", "a.svg"),
    "schema": ("schema", "-o", "a.json"),
    "inspect": ("inspect", "../in/load-400.npz", "--picture", "a.svg"),
    "new": ("new", "my-step"),
}  # fmt: skip


# -- what is left ------------------------------------------------------------------------------


def _pictures(path: Path) -> str:
    return "" if path.read_text().rstrip().endswith("</svg>") else "the picture is cut"


def _yaml(path: Path) -> str:
    if path.name == "pad.yaml":
        load_pad(str(path))
    return "" if isinstance(yaml.safe_load(path.read_text()), dict) else "the text is cut"


def _archive(path: Path) -> str:
    with np.load(path) as data:
        return "" if len(data["values"]) == 100 else "frames are missing"


def _images(path: Path) -> str:
    import zarr

    group = zarr.open_group(str(path), mode="r")
    n = {group[name].shape[0] for name in ("frame/values", "index")}
    return "" if n == {20} else f"{n} frames"


def _package(path: Path) -> str:
    n = sum(p.is_file() for p in path.rglob("*"))
    return "" if n >= 5 and (path / "pyproject.toml").is_file() else f"{n} files"


LOOKS_HERE: dict[str, Callable[[Path], str]] = {
    **LOOKS, ".svg": _pictures, ".yaml": _yaml, ".npz": _archive, ".zarr": _images, "": _package,
}  # fmt: skip


def _database(path: Path, allowed: Sequence[Path]) -> str:
    known = load_known(path, None)
    for other in (load_known(d, None) for d in allowed):
        # How objects are told apart is kept after they are, and found anew where it is not.
        if same(replace(known, choice=known.choice or other.choice), other):
            return ""
    return "holds neither what it held nor all that was to come"


class Left(NamedTuple):
    """What a command that was let end leaves, the database it left by its name, and its time."""

    folder: Path
    databases: tuple[Path, ...]
    seconds: float

    @property
    def names(self) -> set[str]:
        """The files and folders it made."""
        return {p.name for p in self.folder.iterdir() if not p.name.startswith(".")}


def wrong_in(folder: Path, there: set[str], left: Left) -> str:
    """Return what is wrong with what a killed command left; "" if nothing is."""
    found = {p.name: p for p in folder.iterdir() if not p.name.startswith(".")}
    if there - found.keys():
        return f"{sorted(there - found.keys())[0]} was there and is gone"
    for name, path in found.items():
        if name.endswith((".sqlite-wal", ".sqlite-shm", ".sqlite-journal")):
            continue
        if name.replace(".unfinished", "") not in left.names:  # beside an older one, which stays
            return f"{name} is nothing that it makes"
        try:
            if path.suffix == ".sqlite":
                why = _database(path, left.databases)
            else:
                why = LOOKS_HERE[path.suffix](path)
        except Exception as error:
            why = repr(error)
        if why:
            return f"{name}: {why}"
    return ""


# -- killing -----------------------------------------------------------------------------------


def forked(words: Sequence[str], folder: Path) -> int:
    """Return the process that runs a command in a folder."""
    pid = os.fork()
    if pid:
        return pid
    os.dup2(os.open(folder.parent / SAID, os.O_RDWR | os.O_CREAT | os.O_TRUNC), 2)
    os.dup2(os.open(os.devnull, os.O_RDWR), 1)
    folder = folder.resolve()
    os.chdir(folder)
    code = 1
    try:
        cli.main(list(words))
    except SystemExit as done:
        code = int(done.code or 0)
    finally:
        (folder.parent / IMPORTED).write_text("\n".join(sys.modules))
        os._exit(code)


def state(folder: Path) -> Mapping[str, int]:
    """Return the names in a folder and when each was changed."""
    found = {}
    for path in folder.iterdir():
        try:
            found[path.name] = path.stat().st_mtime_ns
        except FileNotFoundError:
            continue
    return found


def ended(pid: int) -> bool:
    return os.waitpid(pid, os.WNOHANG)[0] == pid


class Killing:
    """Commands, what each leaves when it is let end, and what a killed one does."""

    def __init__(self, work: Path) -> None:
        self.work, self.lefts = work, {}  # type: tuple[Path, dict[str, Left]]
        self.before = work / "before"
        self._write_inputs(work / "in")
        for folder in (self.before, work / "out"):
            folder.mkdir()
        for name in ("cup", "key"):
            words = ("learn", name, f"../in/{name}.npz", *DATABASE)
            self._let_end(words, self.before)
        shutil.copy(self.before / "objects.sqlite", work / "in" / "more.sqlite")
        words = ("learn", "stone", "load-400.npz", "--database", "more.sqlite")
        self._let_end(words, work / "in")
        for words in (("forget", "cup", "--database", "more.sqlite"),
                      ("forget", "key", "--database", "more.sqlite"),
                      ("objects", "--export", "more.yaml", "--database",
                       "more.sqlite")):  # fmt: skip
            self._let_end(words, work / "in")

    def _write_inputs(self, folder: Path) -> None:
        folder.mkdir()
        sys.path.insert(0, str(Path(__file__).parents[2] / "tests"))
        from helpers_calibration import frame

        pad: Pad = load_pad("plain")
        frames = [frame(pad, 0.0, k) for k in range(12)]
        write_npz(folder / "empty.npz", frames)
        for name, grams in (("cup", 300), ("key", 1000), *((f"load-{g}", g) for g in GRAMS)):
            one = [frame(pad, grams, k, (3 + k % 2, 4)) for k in range(4)]
            write_npz(folder / f"{name}.npz", one)

    def _import(self) -> None:
        """Import what the last command did, that no fork of this process takes its time for it."""
        for name in (self.work / IMPORTED).read_text().split():
            with suppress(Exception):  # some are no modules by their own name
                importlib.import_module(name)

    def _let_end(self, words: Sequence[str], folder: Path) -> float:
        begun = time.monotonic()
        _, status = os.waitpid(forked(words, folder), 0)
        if status:
            said = (folder.parent / SAID).read_text()
            raise RuntimeError(f"{' '.join(words)} fails even when it is let end: {said}")
        return time.monotonic() - begun

    def left(self, name: str) -> Left:
        """Return what a command leaves."""
        if name not in self.lefts:
            folder = self.work / f"left by {name}"
            for _ in range(2):
                self._lay_out(name, folder, None)
                seconds = self._let_end(COMMANDS[name], folder)
                self._import()
            states = tuple(f / "objects.sqlite" for f in (self.before, folder))
            self.lefts[name] = Left(folder, tuple(s for s in states if s.exists()), seconds)
        return self.lefts[name]

    def _lay_out(self, name: str, folder: Path, older: Path | None) -> None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        if older is not None:
            shutil.copytree(older, folder, dirs_exist_ok=True)
        if "--database" in COMMANDS[name]:
            shutil.copy(self.before / "objects.sqlite", folder)

    def once(self, name: str, rng: random.Random) -> tuple[str, str]:
        """Return what came of killing a command once, and what is wrong with that."""
        left, folder = self.left(name), self.work / "out"
        older = rng.random() < 0.5 and name != "new"
        self._lay_out(name, folder, left.folder if older else None)
        there, since, begun = {p.name for p in folder.iterdir()}, state(folder), time.monotonic()
        pid, done = forked(COMMANDS[name], folder), False
        after_s = rng.random() * 1.1 * left.seconds
        if rng.random() < 0.5:
            while not (done := ended(pid)) and state(folder) == since:
                time.sleep(0.0005)
            begun, after_s = time.monotonic(), rng.random() * SOON_S
        while not done and time.monotonic() < begun + after_s:
            time.sleep(0.0005)
            done = ended(pid)
        if not done:
            os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
        changed = "killed when it had written" if state(folder) != since else "killed before it did"
        why = wrong_in(folder, there, left)
        return ("ended" if done else changed), why and f"{name} after {after_s:.3f} s: {why}"


def attack(names: Sequence[str], n_tries: int, seed: int) -> Iterator[Attempt]:
    """Yield what came of killing commands, each in turn."""
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        load("circle-1").run  # noqa: B018 -- what is imported once is not imported in each fork
        killing = Killing(Path(folder))
        for i in range(n_tries):
            name = names[i % len(names)]
            came, why = killing.once(name, rng)
            yield Attempt(name, "FAILED" if why else came, why)


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything was left that is not whole."""
    parser = parser_of(__doc__, 60)
    parser.add_argument("--only", nargs="+", default=[""], help="words, one of which is in it")
    args = parser.parse_args(arguments)
    names = [n for n in COMMANDS if any(word in n for word in args.only)]
    return told(attack(names, args.tries, args.seed), args)


if __name__ == "__main__":
    sys.exit(main())
