"""``check_step``: try a step on every case, and hold what comes of it against its promises.

A step promises that it leaves its inputs as they are, gives what its annotations say, gives the
same for the same, can be pickled and copied together with its answers, and ends every case with a
finite answer, with a reason to skip, or with an error for people, in time.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from contextlib import closing
from typing import Any

from tactile_graph.errors import UsageError
from tactile_graph.plugins.names import qualified
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.testing.apart import Apart
from tactile_graph.testing.here import StepReport, examined_here
from tactile_graph.testing.inputs import Maker


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
    trying: Callable[[str, float], None] | None = None,
) -> StepReport:
    """Return which promises a step breaks.

    An installed one that its plugin has run in a process apart is tried in one, unless settings,
    inputs or ``trying`` are given.

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
    marked = "" if settings or inputs or trying else _marked(step, registry)
    if not marked:
        return examined_here(step, settings, inputs, registry, trying)
    with closing(Apart(installed())) as apart:
        return apart.examine(marked)


def _marked(step: str | Callable[..., Any], registry: Registry | None) -> str:
    """Return the name of a step that its installed plugin has run apart; "" of any other."""
    known = installed()
    if registry is not None and registry is not known:
        return ""
    for plugin in known.plugins:
        for name in plugin.offers.get("isolated", ()):
            spelled = known.spelled("steps", qualified(plugin.name, name))
            of = plugin.offers["steps"][name]
            if step in (spelled, qualified(plugin.name, name)) or _is(step, of):
                return spelled
    return ""


def _is(step: str | Callable[..., Any], offered: str | Callable[..., Any]) -> bool:
    """Return whether a step is what a plugin offers, which is not imported for that."""
    if isinstance(offered, str):
        module, _, name = offered.partition(":")
        return step is getattr(sys.modules.get(module), name, offered)
    return step is offered
