"""The process beside a command that waits for the compiler: it compiles what takes long.

No command for people. `tactile_graph.compiled.prepared_beside` starts it with what the command
itself does, as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from itertools import islice, zip_longest
from typing import TYPE_CHECKING, Any

from tactile_graph.compiled import Kernel, plain_and_noted, warm_up
from tactile_graph.compiled.race import Race
from tactile_graph.plugins import registry
from tactile_graph.plugins.devices import reads_device
from tactile_graph.steps.injected import Report

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline

FRAMES = 10
"""Of a pipeline's source; by then most of what may be needed has been."""


class Needed:
    """The kernels that plain code called, each with the types it was called with."""

    def __init__(self) -> None:
        self._found: dict[tuple[Kernel[Any, Any], tuple[Any, ...]], None] = {}
        self._n_compiled = 0
        self._since = time.monotonic()

    def note(self, kernel: Kernel[Any, Any], args: tuple[Any, ...]) -> None:
        """Take a call in."""
        from numba.core.typing.typeof import Purpose, typeof

        self._found[kernel, tuple(typeof(arg, Purpose.argument) for arg in args)] = None

    def compile_new(self) -> bool:
        """Compile what was noted since the last time; return whether the other process gains."""
        from tactile_graph.compiled.machine_code import make_ahead
        from tactile_graph.compiled.reach import Reach

        found = [*self._found][self._n_compiled :]
        self._n_compiled = len(self._found)
        race = Race([Reach(kernel.loops).sizes for kernel, _ in found])
        gains = False
        while (i := race.next(time.monotonic() - self._since)) is not None:
            kernel, types = found[i]
            make_ahead(kernel.loops, types)
            gains = True
        return gains


def compile_ahead(pipelines: list[Pipeline]) -> None:
    """Compile what the first frames of pipelines need, as long as that helps."""
    needed = Needed()
    with plain_and_noted(needed.note):
        streams = [islice(p.stream(report=Report()), FRAMES) for p in pipelines]
        for _ in zip_longest(*streams):
            if not needed.compile_new():
                return  # plain code would only take the processor away


def opened(names: list[str], settings: list[str], recordings: list[str]) -> Iterator[Pipeline]:
    """Yield the pipelines that can be run a second time: they read no device, and none writes."""
    from tactile_graph.cli.arguments import open_pipeline
    from tactile_graph.errors import TactileGraphError

    for name in names:
        try:
            pipeline = open_pipeline(name, recordings, settings=settings)
            of_device = pipeline.source is not None and reads_device(pipeline.source.name)
        except TactileGraphError:
            continue  # the command itself says what is wrong
        if not (pipeline.writes or of_device):
            yield pipeline


def main(said: str) -> None:
    """Do what the JSON text says."""
    asked = json.loads(said)
    registry.restrict(asked["plugins"])
    if asked["warm"]:
        warm_up()
    compile_ahead(list(opened(asked["pipelines"], asked["settings"], asked["recordings"])))


if __name__ == "__main__":
    main(sys.argv[1])
