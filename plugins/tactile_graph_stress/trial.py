"""``Trial``: a step in a pipeline of its own, run on one case after another."""

from __future__ import annotations

import linecache
import types
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, Pipeline, Result, TactileGraphError, hookimpl, loads
from tactile_graph.errors import PluginError
from tactile_graph.inspect import CrashedError, OverrunError, Skipped
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.wires import Image, Mask, Points
from tactile_graph_stress.finite import not_finite
from tactile_graph_stress.subject import TURNING, Subject

Given = Points | Mask | Image

NODE = "subject"
"""The node of the step that is tried, in the pipeline of its own."""

FORGED = ("numpy", "scipy", "skimage", "numba")
"""Packages whose own errors no step may hand on: they are not written for its user."""

MOST_WARMING = 100
"""Frames after which a step that only skipped itself is taken to skip all."""


@dataclass(frozen=True)
class Came:
    """What came of one run: a value, a typed refusal (``gave_up``), or what broke."""

    value: Any = None
    gave_up: str = ""
    broke: str = ""


class Trial:
    """Runs a subject through the engine, as a pipeline file would.

    Parameters
    ----------
    subject : Subject
    seed : int
        Of steps that take randomness.
    registry : Registry, optional
        Where steps are looked up; the installed plugins if not given.

    Attributes
    ----------
    is_apart : bool
        Whether it has a process of its own.
    """

    def __init__(self, subject: Subject, seed: int = 0, registry: Registry | None = None) -> None:
        self.subject = subject
        self._seed = seed
        known = registry or installed()
        names = [subject.name, *subject.suppliers]
        small = _small(names, known)
        self.is_apart = bool(small.plugins[0].offers["isolated"])
        self._pipeline = loads(_text(subject), registry=small)
        self._runners: dict[str, Callable[[Frame], Result]] = {}

    def anew(self, given: Given, settings: Mapping[str, Any] | None = None) -> Came:
        """Return what comes of a case from the start, as if none had been run before."""
        self._runners.clear()
        return self.run(given, settings)

    def run(self, given: Given, settings: Mapping[str, Any] | None = None) -> Came:
        """Return what comes of a case; never raises."""
        frame = _frame(given)
        before = frame.image.values.tobytes()
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                value = self._result(frame, settings or {})[NODE]
            except PluginError as error:  # the step gave something else than it promises
                came = Came(broke=str(error))
            except TactileGraphError as error:  # no value, or a rule of the frame or of a setting
                came = _without_value(error)
                if isinstance(_cause(error), (CrashedError, OverrunError)):
                    self._runners.clear()  # a new one waits for its process
            except Exception as error:
                came = Came(broke=f"the run crashed with {type(error).__name__}: {error}")
            else:
                bad = not_finite(value)
                came = Came(broke=bad) if bad else Came(value=value)
        if frame.image.values.tobytes() != before:
            return Came(broke="writes into its input; change a copy")
        return Came(broke=f"warning escaped: {caught[0].message}") if caught else came

    def _result(self, frame: Frame, settings: Mapping[str, Any]) -> Result:
        """Return what a new runner gives; a step that warms up sees the frame until it answers."""
        run = self._runner(settings)
        result = run(frame)
        for _ in range(MOST_WARMING * self.subject.signature.stateful):
            outcome = result.outcome(NODE)
            if not (isinstance(outcome, Skipped) and outcome.origin == NODE):
                break
            result = run(frame)
        return result

    def _runner(self, settings: Mapping[str, Any]) -> Callable[[Frame], Result]:
        key = repr(sorted(settings.items()))
        if key not in self._runners or self.subject.signature.stateful:
            pipeline = self._pipeline
            if self.is_apart:
                self._runners.clear()  # each has a process
            if settings:
                pipeline = pipeline.with_settings({f"{NODE}.{k}": v for k, v in settings.items()})
            self._runners[key] = _checked(pipeline, pipeline.runner(seed=self._seed))
        return self._runners[key]


def _checked(pipeline: Pipeline, runner: Callable[[Frame], Result]) -> Callable[[Frame], Result]:
    """Return a runner that holds the step to what it promises."""

    def run(frame: Frame) -> Result:
        result = runner(frame)
        if pipeline.promises.waiting:
            pipeline.promises.check(result)
        return result

    return run


def _cause(error: TactileGraphError) -> Any:
    """Return the error a step raised, or that stands for how its process was ended."""
    return getattr(getattr(error, "outcome", None), "error", error)


def _without_value(error: TactileGraphError) -> Came:
    """Return what an outcome without a value stands for."""
    cause = _cause(error)
    if isinstance(cause, (CrashedError, OverrunError)):
        reason = str(cause).partition(" at node")[0]
        return Came(gave_up=reason) if isinstance(cause, OverrunError) else Came(broke=reason)
    reason = f"{type(cause).__name__}: {cause}"
    where = getattr(getattr(error, "outcome", None), "where", "")
    return Came(gave_up=reason) if _typed(cause, where) else Came(broke=f"untyped {reason}")


def _typed(error: object, where: str) -> bool:
    """Return whether an error was raised for people: of the project, or a ValueError on purpose.

    ``where`` is the engine's "file:line in function".
    """
    if isinstance(error, TactileGraphError):
        return True
    file, _, line = where.partition(" in ")[0].rpartition(":")
    if type(error) is not ValueError or any(f"/{package}/" in file for package in FORGED):
        return False
    return line.isdigit() and "raise" in linecache.getline(file, int(line))


def _frame(given: Given) -> Frame:
    if isinstance(given, Points):
        # A frame must have a cell: the first row is a stand-in that `_points` takes away.
        xy = given.xy_cm
        return Frame(Image(np.vstack([np.zeros((1, 2), xy.dtype), xy])))
    if isinstance(given, Mask):
        values = given.values.astype(np.float64)
        return Frame(Image(values, given.pitch_cm, given.origin_cm, "level"))
    return Frame(given)


def _points(image: Image) -> Points:
    """Return the rows of an image, but for the first, as points."""
    xy: NDArray[np.float64] = image.values[1:]
    return Points(xy)


def _mask(image: Image) -> Mask:
    """Return the valid cells above half the peak."""
    with np.errstate(invalid="ignore"):
        on = image.filled() > 0.5 * image.peak
    return image.mask(on)


class _Offer:
    def __init__(self, steps: Mapping[str, Any], limits_s: Mapping[str, float | None]) -> None:
        self._steps = dict(steps)
        self._limits_s = dict(limits_s)

    @hookimpl
    def tactile_graph_steps(self) -> Mapping[str, Any]:
        return self._steps

    @hookimpl
    def tactile_graph_isolated(self) -> Mapping[str, float | None]:
        return self._limits_s


def _small(names: Sequence[str], known: Registry) -> Registry:
    """Return a registry of these steps and of those that make what a case brings.

    A step that its plugin has run in a process apart runs so here.
    """
    steps = {name: known.load("steps", name) for name in names}
    limits_s = {}
    for name in names:
        own = known.offer("steps", name)
        apart = own.plugin.offers.get("isolated", {})
        if own.name in apart:
            limits_s[name] = apart[own.name]
    made = {**steps, "stress_points": _points, "stress_mask": _mask}
    offer: Any = _Offer(made, limits_s)
    module: types.ModuleType = offer
    return Registry([("stress", "tactile-graph", "", lambda: module)])


def _text(subject: Subject) -> str:
    """Return the pipeline file that feeds the subject."""
    feed = "frame" if subject.feed == "image" else "given"
    lines = ["pipeline: stress", "nodes:"]
    if subject.feed != "image":
        lines.append(f"  given: {{step: stress_{subject.feed}, in: frame}}")
    elif "mask" in subject.wires.values():
        lines.append("  mask: {step: stress_mask, in: frame}")
    for supplier in subject.suppliers:
        source = f"[{feed}, orientation]" if supplier == TURNING else feed
        lines.append(f"  {supplier}: {{step: {supplier}, in: {source}}}")
    into = {port: feed if wire == subject.feed else wire for port, wire in subject.wires.items()}
    ports = ", ".join(f"{port}: {wire}" for port, wire in into.items())
    lines.append(f"  {NODE}: {{step: {subject.name}, in: {{{ports}}}}}")
    return "\n".join([*lines, f"outputs: [{NODE}]", ""])
