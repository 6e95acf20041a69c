"""Try the steps of installed plugins in another process, which they may hang or end.

It says before each call how long that may take. Where it says nothing for far longer it is killed,
and where it has ended this is told; the next step is tried in a new one.
"""

from __future__ import annotations

import os
import sys
from contextlib import redirect_stdout
from queue import Empty
from typing import IO

from tactile_graph.engine.calls.isolated import START_S
from tactile_graph.engine.calls.isolated_worker import (
    ENDED,
    end_with_parent,
    own_channels,
    received,
    sent,
)
from tactile_graph.engine.calls.process import Process
from tactile_graph.plugins.registry import Registry, installed, restrict, selected
from tactile_graph.testing.cases import ORDINARY
from tactile_graph.testing.examination import Broken
from tactile_graph.testing.here import StepReport, examined_here
from tactile_graph.testing.trial import IDLE

READY, TRYING, DONE = "ready", "trying", "done"
GRACE_S = 10.0
"""What is allowed beside the calls themselves, such as making what goes into them."""


class Apart:
    """Examines the steps of a registry, in a process of its own where that finds the same plugins.

    Parameters
    ----------
    registry : Registry
        Steps of one that was made by hand, not of what is installed, are tried here.
    """

    def __init__(self, registry: Registry) -> None:
        self._registry = registry
        self._process: Process | None = None
        self._here = registry is not installed()

    def examine(self, name: str) -> StepReport:
        """Return which promises a step on offer breaks."""
        process = None if self._here else self._process or self._start()
        if process is None:
            return examined_here(name, registry=self._registry)
        process.send(name)
        at, limit_s = ORDINARY, START_S
        while True:
            try:
                kind, value = process.messages.get(timeout=limit_s)
            except Empty:
                what = f"was stopped, since it had not ended after {limit_s:.0f} s"
                break
            except BaseException:  # Ctrl-C, for one: its report would be taken for the next step's
                self.close()
                raise
            if kind == TRYING:
                at, limit_s = value[0], IDLE * value[1] + GRACE_S
            elif kind == DONE:
                report: StepReport = value
                return report
            else:
                what = process.end_in_words() if kind == ENDED else f"cannot be told: {value[0]}"
                break
        self.close()
        return StepReport(name, (Broken((at,), what),), n_cases=1)

    def close(self) -> None:
        """End the process, if there is one."""
        if self._process is not None:
            self._process.kill()
            self._process = None

    def _start(self) -> Process | None:
        """Return a new process; None where it finds other plugins, then and from now on."""
        self._process = process = Process(__name__)
        process.send(selected())
        try:
            found = process.messages.get(timeout=START_S)
        except Empty:
            found = ENDED, None
        if found == (READY, _rows(self._registry)):
            return process
        self._here = True
        self.close()
        return None


def _rows(registry: Registry) -> list[tuple[str, str, str]]:
    return [(p.name, p.package, p.version) for p in registry.plugins]


def serve(orders: IO[bytes], answers: IO[bytes]) -> None:
    """Examine the steps whose names come, until none comes any more."""
    sys.path[:] = received(orders)
    restrict(received(orders))
    registry = installed()
    sent(answers, (READY, _rows(registry)))

    def trying(case: str, limit_s: float) -> None:
        sent(answers, (TRYING, (case, limit_s)))

    with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere):  # a step prints in each case
        while True:
            try:
                name = received(orders)
            except EOFError:
                return
            sent(answers, (DONE, examined_here(name, registry=registry, trying=trying)))


if __name__ == "__main__":
    channels = own_channels()
    end_with_parent()
    serve(*channels)
