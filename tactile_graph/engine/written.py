"""A plan's program written out as one Python function: the same operations, without calls between.

Between the steps of a short pipeline the engine's own calls add up to an eighth of a frame. Once
enough frames have come to be worth the writing, their operations are put one behind the other as
text, and Python compiles that. Nodes of one or two plain inputs, fields and guards are written out;
whatever is more (lists, choices, sinks, what several may settle) is called as before.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence, Set
from keyword import iskeyword
from time import perf_counter_ns
from typing import Any

from tactile_graph.compiled.chained import Chained
from tactile_graph.compiled.kernel import SWITCH_AFTER_CALLS, is_warm, mode
from tactile_graph.engine.chains import Chain, Enter, Later, chains_of, spelled
from tactile_graph.engine.operations.fields import field_getter
from tactile_graph.engine.operations.freeze import FROZEN, IMMUTABLE
from tactile_graph.engine.operations.step_operation import (
    Call,
    Operation,
    frozen,
    settled,
    step_label,
)
from tactile_graph.engine.outcomes.outcome import (
    NO_VALUE,
    Skipped,
    failure,
    raised,
)
from tactile_graph.engine.outcomes.outcomes import LATER
from tactile_graph.engine.plan import Input, Item, Plan
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import Node, NodeKind

AFTER_FRAMES = 200
"""Python compiles the text in the time that writing saves in some thousand frames."""
CHAINS_AFTER_FRAMES = 1_000
"""Their machine code takes a tenth of a second to load, and saves some microseconds a frame."""
DEEPEST = 12
"""Guards within guards that are written out; Python's own limit is at twenty blocks."""


class Written:
    """The lines of a program, and the names they use.

    Parameters
    ----------
    plan : Plan
    call_of : callable
        Gives each step node's callable of its ports.
    operations : sequence of callable
        Of each slot, for what is not written out.
    alone : set of int
        The slots that are settled in one place only.
    """

    def __init__(
        self,
        plan: Plan,
        call_of: Callable[[Node], Call],
        operations: Sequence[Operation],
        alone: Set[int],
    ) -> None:
        self.chains: list[Chain] = []
        self.plan, self.call_of, self.operations, self.alone = plan, call_of, operations, alone
        self.lines: list[str] = []
        self.names: dict[str, Any] = {
            "clock": perf_counter_ns, "FROZEN": FROZEN, "NO_VALUE": NO_VALUE,
            "Skipped": Skipped, "raised": raised, "failure": failure, "settled": settled,
            "field": _field,
        }  # fmt: skip

    def program(self, *, chains: bool = True, make: bool = False) -> Operation:
        """Return one function that settles a plan's main part as its operations do.

        Parameters
        ----------
        chains : bool
            Whether nodes that follow each other may be run by one call.
        make : bool
            Whether the machine code of chains is made where it is not on disk.
        """
        self.lines = []
        self.chains = self._chains(make) if chains else []
        self.settle_all(self.plan.main, 1, set())
        lines = self.lines or ["    pass"]  # of a run that asks for the frames alone
        text = "\n".join(["def program(state):", *lines])
        exec(compile(text, f"<program of {self.plan.pipeline.name}>", "exec"), self.names)
        program: Operation = self.names["program"]
        return program

    def _chains(self, make: bool) -> list[Chain]:
        """Return the chains that have machine code, and name what their calls need."""
        if not (make or "numba" in sys.modules) or not Chained.possible():
            return []
        found = []
        for chain in chains_of(self.plan, self.alone, _is_plain):
            enter = chain.entry(make=make)
            if enter is not None:
                slot = chain.last.slot
                at_once = make or is_warm() or mode() == "compiled"
                self.names[f"enter{slot}"] = enter if at_once else self._trusted(slot, enter)
                self.names[f"made{slot}"] = chain.links[-1].form.made
                self.names[f"later{slot}"] = (Later(chain, self.operations),)
                found.append(chain)
        return found

    def _trusted(self, slot: int, enter: Enter) -> Enter:
        """Return what leaves frames to a chain's nodes until their own kernels are machine code.

        Plain loops may answer otherwise in the last bit. Which ones answer must not hang on whether
        a chain's machine code is on disk.
        """
        left = SWITCH_AFTER_CALLS

        def seen(value: Any, start: int) -> Any:
            nonlocal left
            left -= enter(value, start) is not None
            if left < 0:
                self.names[f"enter{slot}"] = enter
            return None

        return seen

    def settle_all(self, slots: Sequence[int], depth: int, known: set[int]) -> None:
        """Settle slots in their order, those of a chain by one call."""
        i = 0
        while i < len(slots):
            run = self._run_from(slots[i:])
            if run is None:
                self.settle(slots[i], depth, known)
                i += 1
            else:
                self._chained(run, depth, known)
                self.write(depth, f"state[{run.last.slot}] = v{run.last.slot}")
                i += len(run.in_order) + 1

    def _run_from(self, slots: Sequence[int]) -> Chain | None:
        """Return the chain that the first of slots are, the last node's with them."""
        for chain in self.chains:
            run, node = [*chain.in_order, chain.last.slot], chain.last.node
            if node is not None and node.guard is None and list(slots[: len(run)]) == run:
                return chain
        return None

    def write(self, depth: int, text: str) -> None:
        """Add lines at a depth."""
        self.lines += ["    " * depth + line for line in text.strip("\n").splitlines()]

    def settle(self, slot: int, depth: int, known: set[int]) -> None:
        """Settle a slot as ``v`` and whether it has a value as ``ok``, both with its number."""
        item = self.plan.items[slot]
        if depth > DEEPEST or slot not in self.alone or not _is_plain(item):
            self.names[f"o{slot}"] = self.operations[slot]
            self.write(depth, f"o{slot}(state)")
            return
        if item.view is not None:
            self._field(item, depth, known)
        elif item.node is not None and item.node.guard is not None:
            self._guarded(item, item.node.guard, depth, known)
        else:
            self._called(item, depth, known)
        self.write(depth, f"state[{slot}] = v{slot}")
        known.add(slot)

    def read(self, slot: int, depth: int, known: set[int]) -> None:
        """Make a slot that is settled in the state known by its names."""
        if slot not in known:
            given = slot in (0, self.plan.image)  # the frame and its image are always there
            there = "True" if given else f"v{slot}.__class__ not in NO_VALUE"
            self.write(depth, f"v{slot} = state[{slot}]\nok{slot} = {there}")
            known.add(slot)

    def _handed_on(self, slot: int, sources: Sequence[int], depth: int) -> None:
        """Write that what lacks a value is handed on; what is done else is to follow."""
        for n, source in enumerate(sources):
            self.write(
                depth,
                f"""
{"el" if n else ""}if not ok{source}:
    v{slot} = v{source}
    ok{slot} = False
""",
            )

    def _field(self, item: Item, depth: int, known: set[int]) -> None:
        assert item.view is not None
        slot, source = item.slot, item.source
        self.read(source, depth, known)
        get = f"v{source}.{'.'.join(item.view.path)}"
        if item.view.item_path or any(map(iskeyword, item.view.path)):
            self.names[f"get{slot}"] = field_getter(item.view)
            get = f"get{slot}(v{source})"
        self.write(
            depth,
            f"""
if ok{source}:
    try:
        v{slot} = {get}
    except Exception as error:
        v{slot} = failure({item.name!r}, error, (v{source},), "")
        ok{slot} = False
    else:
        ok{slot} = True
        if v{slot}.__class__ not in FROZEN:
            v{slot} = field({item.name!r}, v{slot})
            ok{slot} = v{slot}.__class__ not in NO_VALUE
else:
    v{slot} = v{source}
    ok{slot} = False
""",
        )

    def _called(self, item: Item, depth: int, known: set[int]) -> None:
        """Write what runs before a node's inputs are read, and the call of its step."""
        lazy = [slot for port in item.inputs for slot in port.lazy]
        for chain in self.chains:
            n = len(chain.in_order)
            if chain.last is item and lazy[-n:] == chain.in_order:
                self.settle_all(lazy[:-n], depth, known)
                self._chained(chain, depth, known)
                return
        self.settle_all(lazy, depth, known)
        self._call(item, depth, known)

    def _call(self, item: Item, depth: int, known: set[int]) -> None:
        """Write the call of a step whose inputs are settled."""
        assert item.node is not None
        slot, time, what = item.slot, self.plan.n_slots + item.slot, step_label(item.node)
        self.names[f"call{slot}"] = self.call_of(item.node)
        sources = [port.slots[0] for port in item.inputs]
        for source in sources:
            self.read(source, depth, known)
        self._handed_on(slot, sources, depth)
        values = ", ".join(f"v{source}" for source in sources)
        self.write(
            depth,
            f"""
else:
    start = clock()
    try:
        v{slot} = call{slot}({values})
    except Exception as error:
        state[{time}] = clock() - start
        v{slot} = raised({item.name!r}, error, ({values},), {what!r})
        ok{slot} = False
    else:
        state[{time}] = clock() - start
        ok{slot} = True
        if v{slot}.__class__ not in FROZEN:
            v{slot} = settled(v{slot}, {item.name!r}, {what!r})
            ok{slot} = v{slot}.__class__ not in NO_VALUE
""",
        )

    def _guarded(self, item: Item, guard: Guard, depth: int, known: set[int]) -> None:
        """Write a guard, and the node below it.

        Frame after frame nothing lies on the pad. Where a guard reads one field, and its step gave
        the very value that it did not hold for last time, field and skip are that time's too.
        """
        slot, read = item.slot, self.plan.items[item.guard[0]]
        if len(item.guard) > 1 or read.view is None or {read.slot, read.source} <= known:
            self._told(item, guard, depth, known)
        else:
            self.read(read.source, depth, known)
            self.names[f"kept{slot}"] = [guard, ()]  # no value is it
            self.names["IMMUTABLE"] = IMMUTABLE
            self.write(
                depth,
                f"""
if v{read.source} is kept{slot}[0]:
    v{read.slot}, v{slot} = kept{slot}[1]
    state[{read.slot}] = v{read.slot}
    ok{read.slot} = True
    ok{slot} = False
else:
""",
            )
            self._told(item, guard, depth + 1, known)
            self.write(
                depth + 1,
                f"""
if not ok{slot} and ok{read.slot} and v{read.source}.__class__ in IMMUTABLE:
    if v{slot}.__class__ is Skipped:
        kept{slot}[:] = v{read.source}, (v{read.slot}, v{slot})
""",
            )
        self.write(depth, f"if ok{slot}:")
        self._called(item, depth + 1, set(known))

    def _told(self, item: Item, guard: Guard, depth: int, known: set[int]) -> None:
        """Write what tells whether a guard holds, and what its node comes to where it does not."""
        slot = item.slot
        for source in item.guard:
            if self.plan.items[source].view is not None and source not in known:
                self.settle(source, depth, known)
        for source in item.guard:
            self.read(source, depth, known)
        holds = self._holds(item, guard)
        self.names[f"skip{slot}"] = _skipping(item.name, guard)
        self._handed_on(slot, item.guard, depth)
        values = ", ".join(f"v{source}" for source in item.guard)
        self.write(
            depth,
            f"""
else:
    try:
        ok{slot} = True if {holds} else False
    except Exception as error:
        v{slot} = failure({item.name!r}, error, ({values},), {f"when {guard.text}"!r})
        ok{slot} = False
    else:
        if not ok{slot}:
            v{slot} = skip{slot}({values})
            ok{slot} = False
""",
        )

    def _holds(self, item: Item, guard: Guard) -> str:
        """Return what tells whether a guard holds for the values it reads."""
        values = [f"v{source}" for source in item.guard]
        text = spelled(guard, {f"v{i}": value for i, value in enumerate(values)})
        if text is not None:
            return text
        self.names[f"holds{item.slot}"] = guard.function
        return f"holds{item.slot}({', '.join(values)})"

    def _chained(self, chain: Chain, depth: int, known: set[int]) -> None:
        """Write the call of a chain, and what is done where it has no answer."""
        head, item = chain.head, chain.last
        slot, n_slots, source = item.slot, self.plan.n_slots, head.inputs[0].slots[0]
        assert head.node is not None
        assert item.node is not None
        for guarding in head.guard:
            if self.plan.items[guarding].view is not None and guarding not in known:
                self.settle(guarding, depth, known)
        for read in (*head.guard, source):
            self.read(read, depth, known)
        there = " and ".join(dict.fromkeys(f"ok{read}" for read in (*head.guard, source)))
        guard = head.node.guard
        holds = "True" if guard is None else self._holds(head, guard)
        numbers = [f"n{k}" for k in range(len(chain.answer))]
        times = {n_slots + link.item.slot: f"t{k}" for k, link in enumerate(chain.links[:-1])}
        told = "\n    ".join(f"state[{place}] = {name}" for place, name in times.items())
        self.write(
            depth,
            f"""
got = None
if {there}:
    try:
        if {holds}:
            got = enter{slot}(v{source}, clock())
            if got is not None:
                {", ".join(["last", *times.values(), *numbers])} = got
                v{slot} = made{slot}({", ".join(numbers)})
    except Exception:
        got = None
if got is not None:
    {told}
    state[{LATER}] = {"state[" + str(LATER) + "] + " if len(self.chains) > 1 else ""}later{slot}
    ok{slot} = True
    if v{slot}.__class__ not in FROZEN:
        v{slot} = settled(v{slot}, {item.name!r}, {step_label(item.node)!r})
        ok{slot} = v{slot}.__class__ not in NO_VALUE
    state[{n_slots + slot}] = clock() - last
else:
""",
        )
        inner = set(known)
        for before in chain.in_order:
            self.settle(before, depth + 1, inner)
        self._call(item, depth + 1, inner)
        known.add(slot)


def _is_plain(item: Item) -> bool:
    """Return whether an item's operation can be written out."""
    if item.view is not None:
        return True
    node = item.node
    if node is None or item.constant or node.kind is not NodeKind.STEP:
        return False
    if node.each or node.is_sink or (node.guard is not None and node.guard.groups):
        return False
    return _plain_ports(node, item.inputs)


def _plain_ports(node: Node, ports: tuple[Input, ...]) -> bool:
    """Return whether a step takes what its ports read by place, with nothing to settle between."""
    if not all(p.required and not p.collects for p in ports):
        return False
    if len(ports) == 1:
        return True
    assert node.signature is not None
    in_order = [p.name for p in node.signature.ports[:2]] == [p.name for p in ports]
    return len(ports) == 2 and in_order and not any(p.lazy for p in ports)


def _field(name: str, value: Any) -> Any:
    """Return a field that is not frozen by its type as an outcome."""
    return Skipped(name, f"{name} is not known") if value is None else frozen(value, name)


def _skipping(name: str, guard: Guard) -> Callable[..., Skipped]:
    """Return what gives the skip for values of which a guard does not hold.

    Frame after frame nothing lies on the pad: the last skip is kept for the very same value.
    """
    if len(guard.refs) != 1:
        return lambda *values: Skipped(name, guard.reason, values)
    known: Any = guard  # no value is it
    kept = Skipped(name, guard.reason)

    def skip(value: Any) -> Skipped:
        nonlocal known, kept
        if value is not known:
            kept = Skipped(name, guard.reason, (value,))
            known = value if value.__class__ in IMMUTABLE else guard
        return kept

    return skip
