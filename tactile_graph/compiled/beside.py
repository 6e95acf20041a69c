"""While one process waits for the compiler, another prepares what will be needed next."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tactile_graph.compiled.preparing import preparing

if TYPE_CHECKING:
    import subprocess


@contextmanager
def prepared_beside(files: Sequence[str], plugins: str = "") -> Iterator[None]:
    """Let a process of its own prepare pipelines as soon as this one has to compile a kernel.

    When all is on disk none is started. It is stopped on leaving: it may slow nobody down later,
    and whatever it has finished is kept.

    Parameters
    ----------
    files : sequence of str
        Of pipelines; what is no file is left out.
    plugins : str, optional
        The selection of plugins that may load.
    """
    found = [file for file in files if Path(file).is_file()]
    started: list[subprocess.Popen[bytes]] = []

    def start() -> None:
        started.append(_preparing_process(found, plugins))
        preparing.beside = ", ".join(Path(file).stem for file in found)

    preparing.on_first = start if found and (os.cpu_count() or 1) > 1 else None
    try:
        yield
    finally:
        preparing.on_first = None
        preparing.beside = ""
        for process in started:
            process.terminate()
            process.wait()


def _preparing_process(files: Sequence[str], plugins: str) -> subprocess.Popen[bytes]:
    import subprocess

    command = ["-m", "tactile_graph", "prepare", "--jobs", "1", f"--plugins={plugins}", "--"]
    nowhere = subprocess.DEVNULL
    return subprocess.Popen(
        [sys.executable, "-P", *command, *files], stdin=nowhere, stdout=nowhere, stderr=nowhere
    )
