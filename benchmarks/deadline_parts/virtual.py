"""The engine's own decisions on a virtual clock, which only the table's times move on."""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from deadline_parts.schedules import Came
from deadline_parts.table import ANSWER, Table
from tactile_graph import Circle, Frame, Pipeline, Skip, hookimpl, loads
from tactile_graph.live import Deadline, Recorded
from tactile_graph.plugins.registry import Registry

LADDER = """
pipeline: stand-ins
nodes:
{nodes}
  circle: {{first_of: [{names}]}}
outputs: [circle]
"""


class Clock:
    """Nanoseconds since the first frame."""

    def __init__(self) -> None:
        self.now_ns = 0

    def __call__(self) -> int:
        """Return the time."""
        return self.now_ns


def stand_ins(table: Table, clock: Clock) -> Pipeline:
    """Return a ladder whose steps take the table's time and give the table's answers."""
    own = np.diff(table.took_ns, axis=0, append=0.0)
    own = np.where(table.loaded, table.took_ns, -own)  # on an empty pad each hands on to the next

    def step_of(k: int) -> Callable[[Frame], Circle]:
        def step(frame: Frame) -> Circle:
            clock.now_ns += max(int(own[k, frame.index]), 0)
            answer = table.answers[k][frame.index]
            if answer is None:
                raise Skip("nothing was found")
            found: Circle = answer
            return found

        return step

    nodes = "\n".join(f"  {name}: {{step: {name}, in: frame}}" for name in table.choices)
    text = LADDER.format(nodes=nodes, names=", ".join(table.choices))
    steps = {name: step_of(k) for k, name in enumerate(table.choices)}
    return loads(text, "stand-ins.yaml", _registry(steps))


def _registry(steps: Mapping[str, Any]) -> Registry:
    module = types.ModuleType("stand_ins")

    @hookimpl
    def tactile_graph_steps() -> Mapping[str, Any]:
        return steps

    module.tactile_graph_steps = tactile_graph_steps  # type: ignore[attr-defined]
    return Registry([("stand_ins", "benchmark", "1", lambda: module)])


def on_time(table: Table, period_ns: int, deadline_ns: int) -> tuple[Came, list[Any]]:
    """Return what the engine's decisions come to, and the results."""
    clock = Clock()
    deadline = Deadline(clock)
    runner = stand_ins(table, clock).runner(decider=deadline)
    results, choices, latency = [], [], []
    for i, frame in enumerate(table.frames):
        clock.now_ns = max(clock.now_ns, i * period_ns)
        deadline.arrived_ns = i * period_ns
        deadline.due_ns = deadline.arrived_ns + deadline_ns
        result = runner(frame)
        results.append(result)
        choices.append(len(result.decisions))
        latency.append(clock.now_ns - i * period_ns)
    return Came(np.array(choices), np.array(latency, float)), results


def same_again(table: Table, results: list[Any]) -> bool:
    """Return whether the recorded decisions give every answer again, bit for bit."""
    recorded = Recorded()
    runner = stand_ins(table, Clock()).runner(decider=recorded)
    for frame, result in zip(table.frames, results, strict=True):
        recorded.skipped = result.decisions
        if runner(frame).get(ANSWER) != result.get(ANSWER):
            return False
    return True
