"""While one process waits for the compiler, another compiles what will be needed next."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

from tactile_graph.compiled.kernel import is_warm
from tactile_graph.compiled.preparing import preparing

if TYPE_CHECKING:
    import subprocess

AHEAD = "tactile_graph.cli.ahead"
"""The program of the other process."""


class Work(NamedTuple):
    """What both processes do, in words that a command line can hold.

    Attributes
    ----------
    pipelines : tuple of str
        Names or files.
    settings : tuple of str
        Of every pipeline, as ``node.setting=value``.
    recordings : tuple of str
        What they run over in place of their own sources.
    plugins : str
        The selection of plugins that may load.
    """

    pipelines: tuple[str, ...]
    settings: tuple[str, ...] = ()
    recordings: tuple[str, ...] = ()
    plugins: str = ""


@contextmanager
def prepared_beside(work: Work) -> Iterator[None]:
    """Let a process of its own help as soon as this one has to compile a kernel.

    It takes the first frames through plain code, which tells what kernels they call and with what
    types, and compiles those by which this process gains most. When all is on disk none is
    started. It is stopped on leaving: it may slow nobody down later, and whatever it has
    finished is kept.
    """
    started: list[subprocess.Popen[bytes]] = []

    def start() -> None:
        started.append(_process(work))
        preparing.helped = True

    preparing.on_first = start if work.pipelines and (os.cpu_count() or 1) > 1 else None
    try:
        yield
    finally:
        preparing.on_first = None
        preparing.helped = False
        for process in started:
            process.terminate()
            process.wait()


def _process(work: Work) -> subprocess.Popen[bytes]:
    import subprocess

    nowhere = subprocess.DEVNULL
    said = json.dumps({**work._asdict(), "warm": is_warm()})
    return subprocess.Popen(
        [sys.executable, "-P", "-m", AHEAD, said], stdin=nowhere, stdout=nowhere, stderr=nowhere
    )
