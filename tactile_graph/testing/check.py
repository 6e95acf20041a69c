"""``check_step``: try a step on every case, and hold what comes of it against the promises.

A step promises that it leaves its inputs as they are, gives what its annotations say, gives the
same for the same, can be pickled and copied together with its answers, and ends every case with a
finite answer, with a reason to skip, or with an error for people, in time.
"""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tactile_graph.engine.promises import broken_rule, misfit
from tactile_graph.engine.watched import Kept
from tactile_graph.errors import TactileGraphError, UsageError, text_of
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.checks import check_signature
from tactile_graph.steps.settings import spelled, validate_settings
from tactile_graph.steps.signature import Kind, Signature, read_signature
from tactile_graph.testing.cases import ORDINARY, Case, cases
from tactile_graph.testing.finite import not_finite
from tactile_graph.testing.inputs import Maker, Makers, Unmakeable
from tactile_graph.testing.same import same
from tactile_graph.testing.trial import FIRST_S, LEAST_S, TIMES, Trial, attempt

SEED = 7
QUANTITIES_TRIED = ("volt", "gram", "counts", "siemens", "raw", "level", "binary", "kilopascal")


@dataclass(frozen=True)
class Broken:
    """A promise that a step breaks: in which cases, and what it did."""

    cases: tuple[str, ...]
    what: str

    def __str__(self) -> str:
        more = f" (and {len(self.cases) - 1} more cases)" if len(self.cases) > 1 else ""
        return f"{self.cases[0]}{more}: {self.what}"


@dataclass
class StepReport:
    """What became of a step's trials.

    Parameters
    ----------
    step : str
    broken : list of Broken
    n_cases, n_values : int
        How many cases it was tried on, and in how many of them it gave a value.
    untried : str
        Why it was not tried at all; "" where it was.
    """

    step: str
    broken: list[Broken] = field(default_factory=list)
    n_cases: int = 0
    n_values: int = 0
    untried: str = ""

    def lines(self) -> list[str]:
        """Return a line for each broken promise."""
        return [f"step {self.step!r}: {b}" for b in self.broken]


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
    """Raise if a step breaks a promise; see `examine_step`.

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
) -> StepReport:
    """Return which promises a step breaks.

    Parameters
    ----------
    step : str or callable
        The name of one on offer, or the function or class itself.
    settings : mapping, optional
        As under ``with`` in a pipeline; defaults otherwise.
    inputs : mapping of str to callable, optional
        By port, what makes its value of a `Case`; otherwise values are the case's own, or made by
        the steps on offer.
    registry : Registry, optional
        The installed plugins if not given.
    """
    known = registry or installed()
    name = step if isinstance(step, str) else getattr(step, "__name__", repr(step))
    try:
        signature = known.step(step) if isinstance(step, str) else read_signature(name, step)
        check_signature(signature)
    except TactileGraphError as error:
        return StepReport(name, [Broken(("its signature",), _without_name(error, name))])
    values, troubles = validate_settings(signature, dict(settings or {}))
    if troubles:
        path, what = troubles[0]
        return StepReport(name, untried=f"{spelled(path)}: {what}" if path else what)
    subject = _Subject(signature, values)
    if signature.kind is Kind.SOURCE:
        return subject.report(untried="a source is tried by running it")
    try:
        return _examined(subject, Makers(known, inputs or {}))
    except Unmakeable as why:
        return subject.report(untried=str(why))


def _without_name(error: TactileGraphError, name: str) -> str:
    return text_of(error).removeprefix(f"step {name!r}: ")


@dataclass(frozen=True)
class _Subject:
    """A step with its settings."""

    signature: Signature
    settings: Mapping[str, Any]

    def call(self) -> _Bound:
        """Return the step, ready for its ports; new state, the same random numbers each time.

        Raises
        ------
        Exception
            Whatever its ``__init__`` raises.
        """
        signature = self.signature
        settings = signature.arguments(self.settings)
        injected: dict[str, Any] = {}
        if signature.rng:
            injected[signature.rng] = np.random.default_rng(SEED)
        if signature.kind is not Kind.CLASS:
            return _Bound(signature.target, {**settings, **injected})
        at_init = injected if signature.rng_at_init else {}
        made = signature.target(**settings, **at_init)
        at_call = {} if signature.rng_at_init else injected
        if signature.gap:
            at_call[signature.gap] = None
        return _Bound(made, at_call)

    @property
    def package(self) -> str:
        """Whose lines errors are told by."""
        return self.signature.target.__module__.partition(".")[0]

    def report(self, **rest: Any) -> StepReport:
        """Return a report on it."""
        return StepReport(self.signature.name, **rest)


@dataclass(frozen=True)
class _Bound:
    """A step and what it is called with beside its ports; pickled as these."""

    target: Callable[..., Any]
    rest: Mapping[str, Any]

    def __call__(self, **inputs: Any) -> Any:
        return self.target(**inputs, **copy.deepcopy(dict(self.rest)))


@dataclass
class _Examination:
    """The trials of one step, and what was found by them."""

    subject: _Subject
    makers: Mapping[str, Maker]
    limit_s: float = FIRST_S
    found: dict[str, list[str]] = field(default_factory=dict)
    n_cases: int = 0
    n_values: int = 0

    def tell(self, case: str, what: str) -> None:
        """Note what is wrong in a case; the same of several cases is told once."""
        if what and case not in self.found.setdefault(what, []):
            self.found[what].append(case)

    def inputs(self, case: Case) -> dict[str, Any]:
        """Return new values for the ports.

        Raises
        ------
        Unmakeable
            If one cannot be made of this case.
        """
        return {name: maker(case) for name, maker in self.makers.items()}

    def tried(self, case: Case, call: Callable[..., Any] | None = None) -> Trial:
        """Return what a step, new unless given, comes to in a case."""
        subject = self.subject
        inputs = self.inputs(case)
        return attempt(call or subject.call(), inputs, self.limit_s, subject.package)


def _examined(subject: _Subject, makers: Makers) -> StepReport:
    usual, *others = cases()
    try:
        ports = _ports(subject, makers, usual)
    except Unmakeable:
        raise
    except Exception as error:  # the step's own __init__
        return subject.report(untried=f"it refuses these settings: {text_of(error)}")
    found = _Examination(subject, ports)
    first = _looked_at(found, usual, found.inputs(usual))
    found.limit_s = max(LEAST_S, TIMES * first.seconds)
    _copies(found, usual, first)
    seen = {pickle.dumps(found.inputs(usual))}
    for case in others:
        try:
            inputs = found.inputs(case)
        except Unmakeable:
            continue
        mark = pickle.dumps(inputs)
        if mark not in seen:  # many cases differ in what this step does not take
            seen.add(mark)
            _looked_at(found, case, inputs)
    _again(found, usual, first)
    broken = [Broken(tuple(names), what) for what, names in found.found.items()]
    return subject.report(broken=broken, n_cases=found.n_cases, n_values=found.n_values)


def _ports(subject: _Subject, makers: Makers, usual: Case) -> dict[str, Maker]:
    """Return what makes its inputs, images in the first quantity that it gives a value for."""
    first: dict[str, Maker] | None = None
    for quantity in QUANTITIES_TRIED:
        name = subject.signature.name
        ports = {
            p.name: makers.maker(p, quantity, name) for p in subject.signature.ports if p.required
        }
        first = first or ports
        if _Examination(subject, ports).tried(usual).answered:
            return ports
    assert first is not None
    return first


def _looked_at(found: _Examination, case: Case, inputs: dict[str, Any]) -> Trial:
    """Try a case, and note every promise that is broken in it."""
    subject = found.subject
    kept = Kept(inputs)
    found.n_cases += 1
    trial = attempt(subject.call(), inputs, found.limit_s, subject.package)
    found.n_values += trial.answered
    found.tell(case.name, trial.trouble())
    changed = kept.changed()
    if changed:
        found.tell(case.name, f"writes into its input {', '.join(changed)}; change a copy")
    if trial.answered:
        found.tell(case.name, _misfit(subject, inputs, trial.value))
    return trial


def _misfit(subject: _Subject, inputs: Mapping[str, Any], value: Any) -> str:
    """Return what is wrong with a value; "" where nothing is."""
    signature = subject.signature
    if value is None:
        is_sink = signature.output in (None, type(None))
        return "" if is_sink else "returns None; raise Degenerate or Skip with the reason"
    wrong = misfit(value, signature.output) or broken_rule(
        signature, subject.settings, inputs.get, value
    )
    if wrong:
        return wrong
    not_good = not_finite(value)
    return f"gives as good what is none: {not_good}; raise Degenerate" if not_good else ""


# -- the same again --------------------------------------------------------------------------


def _again(found: _Examination, usual: Case, first: Trial) -> None:
    """Try the ordinary case once more, after all others."""
    again = found.tried(usual)
    if again.answered != first.answered or not same(again.value, first.value):
        found.tell(ORDINARY, "gives another answer the second time; is something kept, or random?")


def _copies(found: _Examination, usual: Case, first: Trial) -> None:
    """Hold pickled and copied steps and answers against the originals."""
    call = found.subject.call()
    for what, made in _pickled_and_copied(call):
        if isinstance(made, Exception):
            found.tell(ORDINARY, f"the step cannot be {what}: {_told(made)}")
        elif made.target is call.target:
            continue  # a function is found by its name again
        elif not same(found.tried(usual, made).value, first.value):
            found.tell(ORDINARY, f"the step {what} gives another answer")
    if not first.answered:
        return
    for what, made in _pickled_and_copied(first.value):
        if isinstance(made, Exception):
            found.tell(ORDINARY, f"its answer cannot be {what}: {_told(made)}")
        elif not same(made, first.value):
            found.tell(ORDINARY, f"its answer {what} is another")


def _pickled_and_copied(value: Any) -> Iterator[tuple[str, Any]]:
    ways: tuple[tuple[str, Callable[[Any], Any]], ...] = (
        ("pickled", lambda it: pickle.loads(pickle.dumps(it))),
        ("copied", copy.deepcopy),
    )
    for what, way in ways:
        try:
            yield what, way(value)
        except Exception as error:
            yield what, error


def _told(error: Exception) -> str:
    return f"{type(error).__name__}: {' '.join(text_of(error).split())}"
