"""What is said of steps' processes that had to be started anew: at once, then now and then."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping

from tactile_graph.live import ProcessState

QUIET_S = 30.0
"""For so long nothing more is said of a process: one may crash on every frame."""


class Restarts:
    """Follows how often processes were started anew."""

    def __init__(self) -> None:
        self._told: dict[str, tuple[int, float]] = {}

    def news(self, processes: Mapping[str, ProcessState]) -> Iterator[str]:
        """Yield what there is to say of the processes of nodes, each once for all that share it."""
        whose = {state.name or node: (node, state) for node, state in processes.items()}
        now = time.perf_counter()
        for key, (node, state) in whose.items():
            n_told, at_s = self._told.get(key, (0, -QUIET_S))
            if state.n_restarts < n_told:  # another one since the file was changed
                n_told = 0
            if state.n_restarts > n_told and now - at_s >= QUIET_S:
                self._told[key] = state.n_restarts, now
                yield _in_words(node, state)
            elif n_told == 0 and key in self._told:
                self._told[key] = 0, at_s
        self._told = {key: told for key, told in self._told.items() if key in whose}


def _in_words(node: str, state: ProcessState) -> str:
    who = "a step" if state.name else f"node {node!r}"
    which = f"the process of {state.name}" if state.name else "its process"
    often = f", for the {_ordinal(state.n_restarts)} time" if state.n_restarts > 1 else ""
    return f"{who} {state.why}: {which} is started anew{often}"


def _ordinal(n: int) -> str:
    ending = {1: "st", 2: "nd", 3: "rd"}.get(n % 10, "th") if n % 100 not in (11, 12, 13) else "th"
    return f"{n}{ending}"
