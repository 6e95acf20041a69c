"""Time one step on frames of growing size, in a process that a bound of processor time ends."""

from __future__ import annotations

import multiprocessing
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from growth_parts.scenes import FED_TOO, case, given, settings_of

from tactile_graph.engine.operations.freeze import freeze
from tactile_graph.errors import TactileGraphError, text_of
from tactile_graph.plugins.registry import installed
from tactile_graph.testing.cases import Case
from tactile_graph.testing.examination import QUANTITIES_TRIED
from tactile_graph.testing.inputs import Makers, Unmakeable
from tactile_graph.testing.subject import subject_of

Call = Callable[..., Any]
COPY = "(a copy of the image)"
"""What only goes through memory once: how far from 1 an exponent may be by caches alone."""
COMPILING_S = 240.0
FEEDING_S = 60.0
FIRST_S = 60.0
ROUNDS = 7
ROUND_S = 0.01
MOST_WARMING = 30
SMALL = 16


@dataclass(frozen=True)
class Point:
    """What a step came to on one size of one scene.

    Parameters
    ----------
    step, family, scene : str
    side : int
        Cells along each side of the pad.
    rounds_s : tuple of float
        Processor seconds of a call, one figure a round; empty where there are none.
    told : str
        Why there is no time, or no answer in that time; "" where there is one.
    """

    step: str
    family: str
    scene: str
    side: int
    rounds_s: tuple[float, ...] = ()
    told: str = ""


class Doing(NamedTuple):
    """What a child does next, as it is told should that take more processor time than allowed."""

    what: str
    most_s: float


@dataclass(frozen=True)
class Bounds:
    """How long is waited.

    Parameters
    ----------
    call_s : float
        Processor seconds a call may take.
    """

    call_s: float

    @property
    def point_s(self) -> float:
        """Processor seconds of a point: calls to warm up, and its rounds."""
        return 3 * self.call_s


def family_of(step: str) -> str:
    """Return whose step it is."""
    return "" if step == COPY else installed().offer("steps", step).plugin.name


def points_of(step: str, scene: str, sides: list[int], bounds: Bounds) -> Iterator[Point]:
    """Yield a step's times on a scene, the smallest pad first, up to the first over a bound."""
    point = Point(step, family_of(step), scene, 0)
    context = multiprocessing.get_context("fork")  # what the parent imported is there at once
    here, there = context.Pipe(duplex=False)
    child = context.Process(target=_child, args=(there, point, sides, bounds))
    child.start()
    there.close()
    doing, last = Doing("its first call", COMPILING_S), point
    try:
        for side in sides:
            last = replace(point, side=side)
            while isinstance(got := _received(here, child, doing), Doing):
                doing = got
            yield got
            if not got.rounds_s:
                return
    except TimeoutError:
        yield replace(last, told=doing.what)
    except EOFError:
        yield replace(last, told=f"ended without an answer: {doing.what}")
    finally:
        child.kill()
        child.join()


def _received(pipe: Connection, child: BaseProcess, doing: Doing) -> Any:
    """Return what a child sends; raises `TimeoutError` when it worked longer than it said.

    Its own limit (``RLIMIT_CPU``) would make the clock of its processor time a coarse one.
    """
    before_s = _processor_s(child)
    while not pipe.poll(0.1):
        if _processor_s(child) - before_s > doing.most_s:
            raise TimeoutError
    return pipe.recv()


def _processor_s(process: BaseProcess) -> float:
    fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _child(pipe: Connection, point: Point, sides: list[int], bounds: Bounds) -> None:
    os.nice(5)
    try:
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(point, Path(folder))
            for i, side in enumerate(sides):
                pipe.send(_timed(pipe, trial, side, bounds, first=i == 0))
    except (Unmakeable, TactileGraphError) as error:
        pipe.send(replace(point, told=_line(error)))


def _timed(pipe: Connection, trial: Trial, side: int, bounds: Bounds, first: bool) -> Point:
    compiling_s = COMPILING_S if first else 0.0
    pipe.send(Doing("what it is given takes too long to make", FEEDING_S + compiling_s))
    call, inputs = trial.ready(side)
    over = f"over {bounds.call_s:g} s a call"
    # Larger pads may need kernels that smaller ones did not.
    pipe.send(Doing(f"over {FIRST_S:g} s, compiling counted", FIRST_S))
    _answer(call, inputs)
    pipe.send(Doing(over, bounds.call_s))
    for _ in range(MOST_WARMING if trial.stateful else 1):
        start = time.process_time()
        told = _answer(call, inputs)
        spent = time.process_time() - start
        if not told:
            break
    pipe.send(Doing(over, bounds.point_s))
    return replace(trial.point, side=side, rounds_s=_rounds(call, inputs, spent), told=told)


def _answer(call: Callable[..., Any], inputs: Mapping[str, Any]) -> str:
    """Return "" where the step gives a value, and otherwise why not."""
    try:
        with np.errstate(all="ignore"):
            call(**inputs)
    except TactileGraphError as error:
        return _line(error)
    return ""


def _line(error: Exception) -> str:
    return " ".join(text_of(error).split())


def _rounds(call: Call, inputs: Mapping[str, Any], about_s: float) -> tuple[float, ...]:
    calls = max(1, int(ROUND_S / max(about_s, 1e-7)))
    rounds = ROUNDS if about_s < 0.1 else 3 if about_s < 1.0 else 2
    found = []
    for _ in range(rounds):
        start = time.process_time()
        for _ in range(calls):
            _answer(call, inputs)
        found.append((time.process_time() - start) / calls)
    return tuple(found)


class Trial:
    """A step, and what it is given on a pad of any size.

    Parameters
    ----------
    point : Point
        Whose step and scene.
    folder : Path
        For the pads of steps that need a learned one.
    """

    def __init__(self, point: Point, folder: Path) -> None:
        self.point, self.folder = point, folder
        self.signature = None if point.step == COPY else installed().step(point.step)
        self.stateful = self.signature is not None and self.signature.stateful
        self.quantity = "volt" if self.signature is None else self._quantity()

    def ready(self, side: int) -> tuple[Call, dict[str, Any]]:
        """Return the step with a state of its own, and its inputs."""
        if self.signature is None:
            return (lambda image: image.values.copy()), {"image": self._frame(side).image("volt")}
        return self._call(side), self._inputs(side, self.quantity)

    def _frame(self, side: int) -> Case:
        return case(self.point.scene, side)

    def _call(self, side: int) -> Call:
        return subject_of(self.point.step, settings_of(self.point.step, side, self.folder)).call()

    def _inputs(self, side: int, quantity: str) -> dict[str, Any]:
        assert self.signature is not None
        makers = Makers(installed(), given(self.point.scene, side))
        frame = self._frame(side)
        return {
            port.name: freeze(makers.maker(port, quantity, self.point.step)(frame))
            for port in self.signature.ports
            if port.required or port.name in FED_TOO
        }

    def _quantity(self) -> str:
        """Return the first quantity of images that the step answers for on a small pad."""
        for quantity in QUANTITIES_TRIED:
            try:
                inputs = self._inputs(SMALL, quantity)
            except Unmakeable:
                continue
            call = self._call(SMALL)
            if not all(_answer(call, inputs) for _ in range(MOST_WARMING if self.stateful else 1)):
                return quantity
        return QUANTITIES_TRIED[0]
