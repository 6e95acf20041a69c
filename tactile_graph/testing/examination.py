"""The trials of a step: every case once, then the same again, pickled and copied."""

from __future__ import annotations

import copy
import pickle
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from tactile_graph.engine import chains
from tactile_graph.engine.blocks.stacked import StackedForm, form_of
from tactile_graph.engine.calls.watched import Kept
from tactile_graph.errors import Skip, text_of
from tactile_graph.steps.linked import Linked
from tactile_graph.testing.cases import ORDINARY, Case, all_cases, ordinary
from tactile_graph.testing.finite import not_finite
from tactile_graph.testing.inputs import Maker, Makers, Unmakeable
from tactile_graph.testing.links import link_trouble
from tactile_graph.testing.same import same
from tactile_graph.testing.shown import unsaid, unshown
from tactile_graph.testing.stacks import mixed, stack_trouble
from tactile_graph.testing.subject import Bound, Subject
from tactile_graph.testing.trial import FIRST_S, LEAST_S, TIMES, Trial, attempt

QUANTITIES_TRIED = ("volt", "gram", "counts", "siemens", "raw", "level", "binary", "kilopascal")
MOST_WARMING = 100
"""Ordinary frames after which a step that only skipped is taken to skip them all."""
MOST_LATE = 3
"""Calls that took too long after which no more cases are tried."""
WRITES_BEFORE = "writes into what it gave before; give a copy"
_NUMBERS = re.compile(r"0x[0-9a-f]+|[-+]?\d[\d.]*(e[-+]?\d+)?")
Inputs = dict[str, Any]


@dataclass(frozen=True)
class Broken:
    """A promise that a step breaks: in which cases, and what it did."""

    cases: tuple[str, ...]
    what: str

    def __str__(self) -> str:
        n = len(self.cases) - 1
        more = f" (and {n} more case{'s' if n > 1 else ''})" if n else ""
        return f"{self.cases[0]}{more}: {self.what}"


@dataclass
class Examination:
    """The trials of one step, and what was found by them.

    Parameters
    ----------
    subject : Subject
    makers : mapping of str to callable
        What makes each port's value of a `Case`.
    limit_s : float
        Processor time that a call may take; set from the ordinary case.
    n_cases, n_values : int
        Cases tried, and those that were answered with a value.
    n_late : int
        Calls that took too long.
    n_warming : int
        Ordinary frames a step that keeps a state skips before it first answers one.
    trying : callable
        Told before each call in which case it is, and what it may take.
    """

    subject: Subject
    makers: Mapping[str, Maker]
    limit_s: float = FIRST_S
    n_cases: int = 0
    n_values: int = 0
    n_late: int = 0
    n_warming: int = 0
    trying: Callable[[str, float], None] = lambda case, limit_s: None
    _at: str = field(default=ORDINARY, init=False)
    _found: dict[str, Broken] = field(default_factory=dict, init=False)

    @property
    def broken(self) -> list[Broken]:
        """The promises found broken; what is broken alike, but for numbers, is one."""
        return [*self._found.values()]

    def answers(self) -> bool:
        """Return whether the step gives a value for the ordinary case, at once or warmed up."""
        call, most = self.subject.call(), MOST_WARMING if self.subject.signature.stateful else 0
        for n in range(most + 1):
            trial = self._try(call, self._inputs(ordinary()))
            if trial.late:
                self.n_cases += 1
                self._tell(ORDINARY, trial.trouble())
            if not isinstance(trial.error, Skip):
                self.n_warming = n if trial.answered else 0
                return trial.answered
        return False

    def run(self) -> None:
        """Try every case that this step can tell from the others."""
        usual, *others = all_cases()
        first = self.look_at(usual, self._inputs(usual))
        kept = Kept.of_answer("answer", first.value)
        self.limit_s = max(LEAST_S, TIMES * first.seconds)
        comparable = self._look_at_copies(usual, first)
        seen = {pickle.dumps(self._inputs(usual))}
        self.look_at_stack(usual, self._inputs(usual))
        self.look_at_link(usual, self._inputs(usual))
        for case in others:
            if self.n_late >= MOST_LATE:
                break
            self._at = case.name
            try:
                inputs = self._inputs(case)
            except Unmakeable:  # of this case the steps before give nothing
                continue
            mark = pickle.dumps(inputs)
            if mark not in seen:
                seen.add(mark)
                self.look_at(case, inputs)
                self.look_at_stack(case, inputs)
                self.look_at_link(case, inputs)
        self._at = ORDINARY
        again = self._try(self._call(), self._inputs(usual))
        if kept.changed():
            self._tell(ORDINARY, WRITES_BEFORE)
        elif comparable and not _same_end(again, first):
            self._tell(ORDINARY, "gives another answer the second time; what is kept, or random?")

    def look_at(self, case: Case, inputs: Inputs) -> Trial:
        """Try a case, and note every promise that is broken in it."""
        self.n_cases += 1
        trial = self._watched(case, self._call(), inputs)
        self.n_values += trial.answered
        if self.n_warming:
            self._watched(case, self.subject.call(), inputs)
        if self.subject.signature.stateful and case.name != ORDINARY:
            used = self._call()
            before = Kept.of_answer("answer", self._try(used, self._inputs(ordinary())).value)
            self._watched(case, used, self._inputs(case))
            if before.changed():
                self._tell(case.name, WRITES_BEFORE)
        return trial

    def look_at_stack(self, case: Case, inputs: Inputs) -> None:
        """Try a step's form for many frames on the case among others, where it has one."""
        if self._form is None:
            return
        for rows in mixed(inputs, self._inputs(ordinary())):
            self._tell(case.name, stack_trouble(self._form, rows, self._one))

    def look_at_link(self, case: Case, inputs: Inputs) -> None:
        """Try a step's form for machine code on the case, where it has one."""
        if self._link is not None:
            self._tell(case.name, link_trouble(self._link, inputs, self._one))

    @cached_property
    def _link(self) -> Linked | None:
        signature = self.subject.signature
        made = self.subject.call().target
        return chains.form_of(signature, self.subject.settings, lambda: made)

    @cached_property
    def _form(self) -> StackedForm | None:
        signature = self.subject.signature
        made = self.subject.call().target
        return form_of(signature, self.subject.settings, lambda: made)

    def _watched(self, case: Case, call: Bound, inputs: Inputs) -> Trial:
        kept = Kept(inputs)
        trial = self._try(call, inputs)
        changed = kept.changed()
        if changed:
            self._tell(case.name, f"writes into its input {', '.join(changed)}; change a copy")
            return trial  # an error on the way is one of the same kind
        self._tell(case.name, trial.trouble())
        for what in trial.left:
            self._tell(case.name, f"changes {what}, which all steps share; put it back")
        if trial.answered:
            misfit = self.subject.misfit(inputs, trial.value)
            self._tell(case.name, misfit or _bad(trial.value) or unshown(trial.value))
            self._tell(case.name, unsaid(self.subject.signature, inputs, trial.value))
        return trial

    def _try(self, call: Callable[..., Any], inputs: Inputs) -> Trial:
        self.trying(self._at, self.limit_s)
        trial = attempt(call, inputs, self.limit_s, self.subject.package)
        self.n_late += trial.late
        return trial

    def _inputs(self, case: Case) -> Inputs:
        """Return new values for the ports; raises `Unmakeable`."""
        return {name: maker(case) for name, maker in self.makers.items()}

    def _call(self) -> Bound:
        """Return the step: one that is warmed up, or where it keeps no state the very same."""
        if not self.subject.signature.stateful:
            return self._one
        call = self.subject.call()
        for _ in range(self.n_warming):
            self._try(call, self._inputs(ordinary()))
        return call

    @cached_property
    def _one(self) -> Bound:
        return self.subject.call()

    def _tell(self, case: str, what: str) -> None:
        if not what:
            return
        kind = _NUMBERS.sub("#", what)
        known = self._found.get(kind)
        if known is None:
            self._found[kind] = Broken((case,), what)
        elif case not in known.cases:
            self._found[kind] = Broken((*known.cases, case), known.what)

    def _look_at_copies(self, usual: Case, first: Trial) -> bool:
        """Note what is wrong with copies of the step; return whether its answers can be copied."""
        call = self._call()
        for what, made in _copies(call):
            if isinstance(made, Exception):
                self._tell(ORDINARY, f"the step cannot be {what}: {_told(made)}")
                break
            if what == "pickled" and made.target is not call.target:  # and found by its name again
                again = self._try(made, self._inputs(usual))
                if not _same_end(again, first):
                    self._tell(ORDINARY, "the step pickled gives another answer")
        for what, made in _copies(first.value) if first.answered else ():
            if isinstance(made, Exception):
                self._tell(ORDINARY, f"its answer cannot be {what}: {_told(made)}")
                return False
            if not same(made, first.value):
                self._tell(ORDINARY, f"its answer {what} is another")
        return True


def examined(
    subject: Subject, makers: Makers, trying: Callable[[str, float], None] = lambda case, s: None
) -> Examination:
    """Return the examination of a step, images in the first quantity it gives a value for.

    Raises
    ------
    Unmakeable
        If nothing makes a value for a port.
    UsageError
        If its ``__init__`` refuses the settings.
    """
    first: Examination | None = None
    for quantity in QUANTITIES_TRIED:
        required = [p for p in subject.signature.ports if p.required]
        ports = {p.name: makers.maker(p, quantity, subject.name) for p in required}
        found = Examination(subject, ports, trying=trying)
        first = first or found
        if found.answers() or found.n_late:
            break
    else:
        assert first is not None
        found = first
    if not found.n_late:  # or every case would be waited for
        found.run()
    return found


def _bad(value: Any) -> str:
    found = not_finite(value)
    return f"gives as good what is none: {found}; raise Degenerate" if found else ""


def _same_end(one: Trial, other: Trial) -> bool:
    return one.answered == other.answered and same(one.value, other.value)


def _copies(value: Any) -> Iterator[tuple[str, Any]]:
    """Yield a value pickled and copied, each by how it is told; an error where that fails."""
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
