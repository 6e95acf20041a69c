"""Family ``scenes``: whole localisers on whole frames, over scenes and pad sizes."""

from __future__ import annotations

import itertools
import statistics
import time
import warnings
from collections.abc import Callable, Iterator

from suite_parts.contestants import Contestant, error_of, ours, peers
from suite_parts.records import Measured
from suite_parts.rounds_of import in_turn
from suite_parts.scenes import SCENES, Scene, scene
from tactile_graph import Frame
from tactile_graph.api.result import Result
from tactile_graph.errors import TactileGraphError

PIPELINES = (
    "contacts", "circle-1", "circle-2", "circle-3", "circle-likelihood", "adaptive",
    "rectangle-1", "rectangle-2", "rectangle-3", "ellipse-direct", "objects", "bayes-circle",
)  # fmt: skip
TOO_SLOW_S = 2.0
"""A contestant that takes longer for one frame is left out on larger pads."""


def measured(
    sizes: tuple[int, ...], frames: int, rounds: int, seed: int, told: Callable[[str], None]
) -> Iterator[Measured]:
    """Yield what every contestant makes of every scene and size."""
    too_slow: set[str] = set()
    for size, name in itertools.product(sizes, SCENES):
        told(f"{name}, {size}x{size}")
        few = max(2, frames * 16 // size)
        yield from _case(scene(name, size, few, seed), rounds, too_slow)


def _case(case: Scene, rounds: int, too_slow: set[str]) -> Iterator[Measured]:
    entered: dict[str, Contestant] = {}
    answers: dict[str, list[dict[str, float | None]]] = {}
    ran: dict[str, float] = {}
    for contestant in (*(ours(p, case.pad) for p in PIPELINES), *peers()):
        if contestant.name in too_slow:
            continue
        try:
            slowest, answers[contestant.name], ran[contestant.name] = _answers(contestant, case)
        except TactileGraphError as error:
            yield Measured("scenes", case.case, contestant.name, (), note=str(error))
            continue
        entered[contestant.name] = contestant
        if slowest > TOO_SLOW_S:
            too_slow.add(contestant.name)
    calls = {name: _cycled(c.call, case.frames) for name, c in entered.items()}
    times = in_turn(calls, rounds, round_s=0.01, most_s=0.5)
    for name, contestant in entered.items():
        yield Measured(
            "scenes",
            case.case,
            name,
            times[name],
            _columns(answers[name]),
            ran[name] if contestant.pipeline else None,
            len(contestant.pipeline.nodes) if contestant.pipeline else None,
        )


def _cycled(call: Callable[[Frame], object], frames: tuple[Frame, ...]) -> Callable[[], object]:
    source = itertools.cycle(frames)
    return lambda: call(next(source))


def _answers(
    contestant: Contestant, case: Scene
) -> tuple[float, list[dict[str, float | None]], float]:
    """Return the slowest frame's seconds, each frame's errors, and nodes run a frame."""
    contestant.call(case.frames[-1])  # compiles what compiles; the first must not be reused
    slowest, errors, ran = 0.0, [], []
    for frame in case.frames:
        start = time.perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a peer may warn; ours are tested not to
            found = contestant.call(frame)
        slowest = max(slowest, time.perf_counter() - start)
        shapes = contestant.shapes(found)
        errors.append(error_of(shapes, frame.truth or ()) or _false_alarm(shapes))
        if isinstance(found, Result):
            ran.append(sum(t > 0.0 for t in found.times_us.values()))
    return slowest, errors, statistics.fmean(ran) if ran else 0.0


def _false_alarm(shapes: list[object]) -> dict[str, float | None]:
    """Return the error on a pad on which nothing lies: how many objects were found."""
    return {"false alarms": float(len(shapes))}


def _columns(rows: list[dict[str, float | None]]) -> dict[str, tuple[float | None, ...]]:
    names = dict.fromkeys(name for row in rows for name in row)
    return {name: tuple(row.get(name) for row in rows) for name in names}
