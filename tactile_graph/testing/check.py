"""``check_step``: try a step on every case, and hold what comes of it against its promises.

A step promises that it leaves its inputs as they are, gives what its annotations say, gives the
same for the same, can be pickled and copied together with its answers, and ends every case with a
finite answer, with a reason to skip, or with an error for people, in time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from tactile_graph.errors import PluginError, UsageError, text_of
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.signature import Kind
from tactile_graph.testing.examination import Broken, examined
from tactile_graph.testing.inputs import Maker, Makers, Unmakeable
from tactile_graph.testing.subject import subject_of


@dataclass(frozen=True)
class StepReport:
    """What became of a step's trials.

    Parameters
    ----------
    step : str
    broken : tuple of Broken
    n_cases, n_values : int
        How many cases it was tried on, and in how many of them it gave a value.
    untried : str
        Why it was not tried at all; "" where it was.
    """

    step: str
    broken: tuple[Broken, ...] = ()
    n_cases: int = 0
    n_values: int = 0
    untried: str = ""

    def lines(self) -> list[str]:
        """Return a line for each broken promise."""
        return [f"step {self.step!r}: {b}" for b in self.broken]

    def __str__(self) -> str:
        if self.untried:
            return f"step {self.step!r} was not tried: {self.untried}"
        kept = f"step {self.step!r} keeps its promises: {self.n_values} of {self.n_cases} cases"
        return "\n".join(self.lines()) or f"{kept} gave a value"


class BrokenPromises(AssertionError):  # noqa: N818 -- what it tells
    """The promises a step breaks, one a line."""

    def __init__(self, report: StepReport) -> None:
        super().__init__("\n".join(report.lines()))
        self.report = report


def check_step(
    step: str | Callable[..., Any],
    *,
    settings: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Maker] | None = None,
    registry: Registry | None = None,
) -> StepReport:
    """Return what became of a step's trials, if it keeps all promises; parameters as below.

    Parameters
    ----------
    step, settings, inputs, registry
        As of `examine_step`.

    Raises
    ------
    BrokenPromises
        With a line for each promise it breaks.
    UsageError
        If it cannot be tried: a setting is missing, or nothing makes a value for a port.
    """
    report = examine_step(step, settings=settings, inputs=inputs, registry=registry)
    if report.broken:
        raise BrokenPromises(report)
    if report.untried:
        raise UsageError(f"step {report.step!r} cannot be tried: {report.untried}")
    return report


def examine_step(
    step: str | Callable[..., Any],
    *,
    settings: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Maker] | None = None,
    registry: Registry | None = None,
    trying: Callable[[str, float], None] = lambda case, limit_s: None,
) -> StepReport:
    """Return which promises a step breaks.

    Parameters
    ----------
    step : str or callable
        The name of one on offer, or the function or class itself.
    settings : mapping, optional
        As under ``with`` in a pipeline; defaults otherwise.
    inputs : mapping of str to callable, optional
        By port, what makes its value of a `Case`; otherwise values are the case's own, or made of
        it by the steps on offer.
    registry : Registry, optional
        The installed plugins if not given.
    trying : callable, optional
        Told before each call in which case it is, and how many seconds of the processor it has.
    """
    name = step if isinstance(step, str) else getattr(step, "__name__", repr(step))
    try:
        subject = subject_of(step, settings or {}, registry)
        if subject.signature.kind is Kind.SOURCE:
            return StepReport(name, untried="a source is tried by running it")
        found = examined(subject, Makers(registry or installed(), inputs or {}), trying)
    except PluginError as error:
        what = text_of(error).removeprefix(f"step {name!r}: ")
        return StepReport(name, (Broken(("its signature",), what),))
    except (UsageError, Unmakeable) as why:
        return StepReport(name, untried=str(why))
    return StepReport(name, tuple(found.broken), found.n_cases, found.n_values)
