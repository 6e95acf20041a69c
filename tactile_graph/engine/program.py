"""Turn a plan into plain functions over one list: the part that runs for every frame.

The list holds each slot's outcome (None while unsettled) and, behind them, each slot's time in
nanoseconds. An operation settles one slot; nothing here walks a graph or looks up a name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

from tactile_graph.compiled.kernel import is_warm, mode
from tactile_graph.engine.deadlines.allowed import Deciding, ladder, where_allowed
from tactile_graph.engine.operations.fields import field_getter
from tactile_graph.engine.operations.first_of import first_of
from tactile_graph.engine.operations.freeze import FROZEN, IMMUTABLE
from tactile_graph.engine.operations.guards import guarded
from tactile_graph.engine.operations.step_operation import (
    Block,
    Call,
    Operation,
    State,
    frozen,
    step_operation,
)
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed, Skipped, failure
from tactile_graph.engine.plan import Item, Plan
from tactile_graph.engine.written import AFTER_FRAMES, CHAINS_AFTER_FRAMES, Written
from tactile_graph.errors import Degenerate, RuleError
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.pipeline.wiring import Ref

FieldOf = Callable[[Ref], Callable[[Any], Any]]


@dataclass(frozen=True)
class Reading:
    """How a program's values are read, where they are not those of a frame that begins anew.

    Attributes
    ----------
    field_of : callable
        Gives what makes a field of a node's value.
    guard_of : callable
        Gives the guard that stands for one of the file.
    resumed : bool
        Whether a state may come with slots that are settled already: these stay as they are.
    """

    field_of: FieldOf = field_getter
    guard_of: Callable[[Guard], Guard] = lambda guard: guard
    resumed: bool = False


AS_THEY_ARE = Reading()


def make_program(
    plan: Plan,
    call_of: Callable[[Node], Call],
    blank: State,
    reading: Reading = AS_THEY_ARE,
    deciding: Deciding | None = None,
    *,
    chained: bool = True,
) -> Program:
    """Return the operations of a plan's main part.

    Parameters
    ----------
    plan : Plan
    call_of : callable
        Gives each step node's callable of its ports; stateful ones get their instance here.
    blank : list
        The state every frame starts from; outcomes that depend on no frame are kept in it.
    reading : Reading, optional
        A frame's own values, from the beginning, if not given.
    deciding : Deciding, optional
        Everything is done if not given. The plan must be one whose ladders wait.
    chained : bool
        Whether nodes that follow each other may be run by one call.
    """
    operations: list[Operation] = [_nothing] * plan.n_slots
    times_placed = _times_placed(plan)
    for item in plan.items[1:]:
        if item.view is not None:
            operation = _view(item, reading.field_of(item.view))
        else:
            operation = _operation(item, plan, call_of, operations, blank, reading, deciding)
        if times_placed[item.slot] > 1 or reading.resumed:
            operation = _unless_settled(item.slot, operation)
        operations[item.slot] = operation
    program = [operations[slot] for slot in plan.main]
    if deciding is not None or reading is not AS_THEY_ARE:
        return Program(program)
    alone = frozenset(slot for slot, times in times_placed.items() if times == 1)
    return Program(program, Written(plan, call_of, operations, alone), chained=chained)


class Program(list[Operation]):
    """The operations of a plan's main part; the same as one function, once that is worth while.

    Parameters
    ----------
    operations : list of callable
    written : Written, optional
        Writes them as one.
    chained : bool
        Whether nodes that follow each other may be run by one call.

    Attributes
    ----------
    run : callable
        Runs them all, for one frame.
    """

    def __init__(
        self, operations: list[Operation], written: Written | None = None, *, chained: bool = True
    ) -> None:
        self._written = written
        self._chained = chained
        self._frames = 0
        self.run: Operation = _one_by_one(operations)
        super().__init__(operations)
        if written is not None:
            self._be(self._counted(self.run))

    def _be(self, operation: Operation) -> None:
        self.run = operation
        self[:] = [operation]

    def _counted(self, run: Operation) -> Operation:
        def operation(state: State) -> None:
            run(state)
            self._frames += 1
            if self._frames == AFTER_FRAMES:
                self._write()

        return operation

    def _write(self) -> None:
        """Go on with the text without its chains, and with those once they are worth loading."""
        assert self._written is not None
        made = mode() == "compiled"
        if made or is_warm():
            self.write_chains(make=made)
            return
        at_once = self._written.program(chains=False)
        if not self._chained:
            self._be(at_once)
            return

        def operation(state: State) -> None:
            at_once(state)
            self._frames += 1
            if self._frames == CHAINS_AFTER_FRAMES:
                self.write_chains(make=False)

        self._be(operation)

    def unchain(self) -> None:
        """Run each node by itself from now on."""
        self._chained = False
        if self._written is not None and self._written.chains:
            self.write_chains(make=False)

    def write_chains(self, *, make: bool) -> None:
        """Go on with the text; of its chains those whose machine code is on disk, or all made."""
        if self._written is not None:
            self._be(self._written.program(chains=self._chained, make=make))


def _one_by_one(operations: list[Operation]) -> Operation:
    """Return one operation of several."""

    def operation(state: State) -> None:
        for one in operations:
            one(state)

    return operation


def _times_placed(plan: Plan) -> Counter[int]:
    """Return in how many places each slot may be settled; most are needed in one only."""
    placed = Counter(plan.main)
    for item in plan.items:
        placed.update(_guard_fields(item, plan))
        for port in item.inputs:
            placed.update(port.lazy)
    return placed


def _guard_fields(item: Item, plan: Plan) -> list[int]:
    """Return the fields of nodes that an item's guard reads: it settles them itself."""
    return [slot for slot in item.guard if plan.items[slot].view is not None]


def _nothing(state: State) -> None:
    return None


def _operation(
    item: Item,
    plan: Plan,
    call_of: Callable[[Node], Call],
    operations: list[Operation],
    blank: State,
    reading: Reading,
    deciding: Deciding | None,
) -> Operation:
    node = item.node
    assert node is not None
    blocks = [tuple(operations[s] for s in port.lazy) for port in item.inputs]
    time = plan.n_slots + item.slot
    if node.kind is NodeKind.FIRST_OF:
        choices = [(port.slots[0], block) for port, block in zip(item.inputs, blocks, strict=True)]
        rungs = choices if deciding is None else ladder(item.slot, choices, deciding)
        body = first_of(item.slot, rungs)
    elif node.kind is NodeKind.PASS:
        body = _pass(item, blocks)
    elif node.kind is NodeKind.GIVEN:
        body = _given(item)
    else:
        body = step_operation(item, node, call_of(node), time, blocks)
    if deciding is not None and item.slot in deciding.options.nodes:
        body = where_allowed(deciding.options.nodes[item.slot], body, deciding.decider)
    if node.guard is not None:
        own = _guard_fields(item, plan)
        reads = [operations[s] if s in own else itemgetter(s) for s in item.guard]
        body = guarded(item, reading.guard_of(node.guard), reads, body)
    if item.constant:
        return _once(item.slot, time, body, blank)
    return body


def _once(slot: int, time: int, body: Operation, blank: State) -> Operation:
    """Settle a slot that depends on no frame, and keep it for all frames to come."""

    def operation(state: State) -> None:
        if state[slot] is None and blank[slot] is None:
            body(state)
            value = state[slot]
            if value.__class__ not in NO_VALUE or _is_of_data(value):
                blank[slot] = value  # else another call may have what this one lacks
        elif state[slot] is None:  # frames of one block set out with the same blank
            state[slot] = blank[slot]

    return operation


def _is_of_data(value: Any) -> bool:
    """Return whether it failed for its data, as it would again."""
    return isinstance(value, Failed) and isinstance(value.error, Degenerate | RuleError)


def _unless_settled(slot: int, body: Operation) -> Operation:
    """Settle a slot that several may ask for, where none of them came before."""

    def operation(state: State) -> Any:
        if state[slot] is None:
            body(state)
        return state[slot]

    return operation


def _view(item: Item, get: Callable[[Any], Any]) -> Operation:
    """Settle a field of a node, and return it: a guard reads it by this.

    The field of the very value that the last frame gave is kept: a pad that stays empty gives one
    mask for all.
    """
    source, slot = item.source, item.slot
    known: Any = item  # no value is it
    kept: Any = None

    def operation(state: State) -> Any:
        nonlocal known, kept
        value = state[source]
        if value is known:
            state[slot] = kept
            return kept
        if value.__class__ in NO_VALUE:
            state[slot] = value
            return value
        try:
            field = get(value)
        except Exception as error:
            state[slot] = field = failure(item.name, error, (value,), "")
            return field
        if field is None:
            field = Skipped(item.name, f"{item.name} is not known")
        elif field.__class__ not in FROZEN:
            field = frozen(field, item.name)  # a property may make its array anew
        state[slot] = field
        if value.__class__ in IMMUTABLE:
            known, kept = value, field
        return field

    return operation


def _given(item: Item) -> Operation:
    slot, name = item.slot, item.name

    def operation(state: State) -> None:
        state[slot] = state[0].given[name]

    return operation


def _pass(item: Item, blocks: list[Block]) -> Operation:
    slot, source, block = item.slot, item.inputs[0].slots[0], blocks[0]

    def operation(state: State) -> None:
        for settle in block:
            settle(state)
        state[slot] = state[source]

    return operation
