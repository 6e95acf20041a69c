"""What tests of many frames share: executors that do as they are told, and a plugin that kills."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import chdir, contextmanager
from multiprocessing import get_all_start_methods
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from tactile_graph.cli import cli
from tactile_graph.forkserver import begin_forkserver
from tactile_graph.many.executor_kind import ExecutorKind, Opened, Place
from tactile_graph.plugins.registry import installed

PLUGIN = '''
import os
import sys
import time
from collections import deque

from tactile_graph import Frame, Image, hookimpl


@hookimpl
def tactile_graph_steps():
    return {"deadly": "deadly:deadly", "counted": "deadly:Counted", "lately": "deadly:Lately"}


def deadly(
    frame: Frame, *, at: list[int] = [], exits_at: int = -1, stops_at: int = -1, slow_s: float = 0.0
) -> Image:
    """Give the image, or end the process in one way or other."""
    if frame.index in at:
        os.kill(os.getpid(), 9)
    if frame.index == exits_at:
        sys.exit("gives up")
    if frame.index == stops_at:
        raise KeyboardInterrupt
    if frame.index == 1:
        os.write(1, b"as C does\\n")
    time.sleep(slow_s)
    return frame.image


class Lately:
    """Give the mean total of the last few frames that it ran on."""

    def __init__(self, *, frames: int = 5) -> None:
        self.totals = deque(maxlen=frames)
        self.remembers = frames

    def __call__(self, frame: Frame) -> float:
        """Return it."""
        self.totals.append(frame.image.total)
        return float(sum(self.totals) / len(self.totals))


class Counted:
    """Count frames for ever, so that no frame can do without those before it."""

    def __init__(self) -> None:
        self.n = 0

    def __call__(self, frame: Frame) -> float:
        """Return how many frames came."""
        self.n += 1
        return float(self.n)
'''
PIPELINE = """
pipeline: deadly
about: Kills whoever runs some of its frames
source: {step: sample}
nodes:
  image: {step: deadly, in: frame}
  footprint: {step: threshold, in: image, with: {level_v: 0.01}}
outputs: [footprint]
"""


def write_plugin(folder: Path) -> None:
    """Write the plugin, as if it were installed there, and a pipeline of its step."""
    about = folder / "deadly-0.0.dist-info"
    about.mkdir()
    (folder / "deadly.py").write_text(PLUGIN)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: deadly\nVersion: 0.0\n")
    (about / "entry_points.txt").write_text("[tactile_graph]\ndeadly = deadly\n")
    (folder / "deadly.yaml").write_text(PIPELINE)


def command(*words: str) -> list[str]:
    """Return the words that run the command line in a process of its own."""
    return [sys.executable, "-P", "-m", "tactile_graph", *words]


def surroundings(folder: Path) -> dict[str, str]:
    """Return the environment in which the plugin of a folder is installed."""
    return {**os.environ, "PYTHONPATH": str(folder)}


def ran(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the command line in a folder, and return what came of it."""
    return subprocess.run(
        command(*words), cwd=folder, env=surroundings(folder), capture_output=True, text=True,
        timeout=300, check=False,
    )  # fmt: skip


@contextmanager
def installed_here(folder: Path) -> Iterator[None]:
    """Have the plugin of a folder installed in this process, and in workers that it starts."""
    if "forkserver" in get_all_start_methods():
        begin_forkserver(["zarr"])  # once, as a command line that names a store does
    sys.path.insert(0, str(folder))
    installed.cache_clear()
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        sys.modules.pop("deadly", None)
        installed.cache_clear()


def ran_here(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the command line in a folder as `ran` does, but in this process: its workers alone start.

    A process of its own takes longer to import than these runs take.
    """
    with installed_here(folder), chdir(folder):
        got = CliRunner().invoke(cli, [*words])
    return subprocess.CompletedProcess([*words], got.exit_code, got.stdout, got.stderr)


class Here(Executor):
    """Does at once what it is given; frames among ``deadly`` break it for good.

    Parameters
    ----------
    deadly : set of int
    chance : list of int
        Frames that break it once each, and are taken out then.
    """

    def __init__(self, deadly: set[int], chance: list[int]) -> None:
        self.deadly, self.chance, self.broken = deadly, chance, False

    def submit(self, function: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        if self.broken:
            raise BrokenExecutor
        future: Future[Any] = Future()
        portion = args[1]
        frames = set(range(portion.low, portion.high)) - portion.without
        once = [f for f in self.chance if f in frames]
        if once:
            self.chance.remove(once[0])
        self.broken = bool(once or frames & self.deadly)
        if self.broken:
            future.set_exception(BrokenExecutor())
        else:
            try:
                future.set_result(function(*args))
            except Exception as error:
                future.set_exception(error)
        return future


def place(deadly: set[int] | None = None, chance: list[int] | None = None, n: int = 2) -> Place:
    """Return an executor in this process, opened as often as it breaks."""
    once = chance if chance is not None else []

    def opened(address: str, n_workers: int | None) -> Opened:
        return Opened(Here(deadly or set(), once), n, lambda: None)

    return Place(ExecutorKind("this process", opened), "", n)
