"""Try a step on every case in this process: `check` and `apart` say what comes of it."""

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


def examined_here(
    step: str | Callable[..., Any],
    settings: Mapping[str, Any] | None = None,
    inputs: Mapping[str, Maker] | None = None,
    registry: Registry | None = None,
    trying: Callable[[str, float], None] | None = None,
) -> StepReport:
    """Return which promises a step breaks; parameters as of `check.examine_step`."""
    name = step if isinstance(step, str) else getattr(step, "__name__", repr(step))
    try:
        subject = subject_of(step, settings or {}, registry)
        if subject.signature.kind is Kind.SOURCE:
            return StepReport(name, untried="a source is tried by running it")
        found = examined(subject, Makers(registry or installed(), inputs or {}), trying or _untold)
    except PluginError as error:
        what = text_of(error).removeprefix(f"step {name!r}: ")
        return StepReport(name, (Broken(("its signature",), what),))
    except (UsageError, Unmakeable) as why:
        return StepReport(name, untried=str(why))
    return StepReport(name, tuple(found.broken), found.n_cases, found.n_values)


def _untold(case: str, limit_s: float) -> None:
    """Tell nobody."""
