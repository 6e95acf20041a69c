"""Nodes that follow each other and are run by one call of machine code.

A chain's nodes have one input each, their steps a linked form (`tactile_graph.steps.Linked`), and
what is between them is read by the chain alone: asked for by nobody, only perhaps by a guard within
the chain. Its machine code answers frames of which every node has a value. For any other it says
so, and the nodes run as they would without it: every skip and error is theirs.

What is between stays unmade. A result that is asked for it runs the nodes then (`Later`).
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence, Set
from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock
from typing import Any

import numpy as np

from tactile_graph.compiled.chained import Chained
from tactile_graph.compiled.kernel import compiled_later
from tactile_graph.engine.operations.step_operation import Operation, State
from tactile_graph.engine.plan import Item, Plan
from tactile_graph.pipeline.conditions.conditions import Guard, reckons
from tactile_graph.pipeline.graph import Node, NodeKind
from tactile_graph.steps.linked import Linked
from tactile_graph.steps.signature import Signature
from tactile_graph.wires.image import Mask
from tactile_graph.wires.parts import MaskParts

Enter = Callable[[Any, int], Any]
"""Runs a chain on its input; takes when the call began."""
BOOL = np.dtype(np.bool_)
SHORTEST = 2
"""Nodes that are worth a chain."""
MARGIN = "values, pitch_x, pitch_y, x0, y0, count, start"


@compiled_later
def packed_parts(values, pitch_x, pitch_y, x0, y0, count):  # type: ignore[no-untyped-def]
    """Return the parts of a mask of cells, shape (rows, columns); not if it is too wide."""
    rows, columns = values.shape
    fits = columns <= 64
    words = np.empty(rows if fits else 0, np.uint64)
    for r in range(words.shape[0]):
        word = np.uint64(0)
        for c in range(columns):
            word |= np.uint64(values[r, c]) << np.uint64(c)
        words[r] = word
    return fits, MaskParts(words, columns, pitch_x, pitch_y, x0, y0, count)


@dataclass(frozen=True)
class Link:
    """One node of a chain.

    Attributes
    ----------
    item : Item
    form : Linked
    path : tuple of str
        The field of the parts before that it takes; empty for all of them.
    """

    item: Item
    form: Linked
    path: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Chain:
    """Nodes that are run by one call, in their order.

    Attributes
    ----------
    plan : Plan
    links : tuple of Link
    slots : frozenset of int
        Of the nodes and of the fields between them.
    """

    plan: Plan
    links: tuple[Link, ...]
    slots: frozenset[int] = field(default_factory=frozenset)

    @property
    def head(self) -> Item:
        """The first node."""
        return self.links[0].item

    @property
    def in_order(self) -> list[int]:
        """The slots before the last node's, in the order in which a program settles them."""
        guards = {slot for link in self.links for slot in link.item.guard}
        return [slot for slot in sorted(self.slots - guards) if slot != self.last.slot]

    @property
    def last(self) -> Item:
        """The last node: the one that gets its value."""
        return self.links[-1].item

    @cached_property
    def code(self) -> Chained:
        """The machine code, as text.

        It takes a mask's cells, pitch, origin and count, when the frame's call began, and the
        settings. It returns None where a node has no value, else when the last node but one was
        done, how long each but the last took, and the parts of the answer.
        """
        cells = np.zeros((1, 1), np.bool_)
        cells.setflags(write=False)
        arguments: dict[str, Any] = dict(
            zip(MARGIN.split(", "), (cells, 1.0, 1.0, 1.0, 1.0, 1, 1), strict=True)
        )
        names: dict[str, Any] = {"packed": packed_parts}
        lines = ["done, p0 = packed(values, pitch_x, pitch_y, x0, y0, count)"]
        before = {self._source: "p0"}
        last = "start"
        for k, link in enumerate(self.links, 1):
            names[f"link{k}"] = link.form.loops
            settings = {f"s{k}_{i}": value for i, value in enumerate(link.form.settings)}
            arguments |= settings
            lines.append("if not done: return None")
            if 1 < k < len(self.links) and link.item.guard:
                lines.append(f"if not ({self._truth(link.item, before)}): return None")
            given = ".".join([f"p{k - 1}", *link.path])
            lines.append(f"done, p{k} = link{k}({', '.join([given, *settings])})")
            if link is not self.links[-1]:
                lines.append(f"t{k} = now_ns()")
                last = f"t{k}"
            before[link.item.slot] = f"p{k}"
        n = len(self.links)
        times = [f"t{k} - {f't{k - 1}' if k > 1 else 'start'}" for k in range(1, n)]
        numbers = [f"p{n}.{name}" for name in self.answer]
        lines.append("if not done: return None")
        lines.append(f"return {', '.join([last, *times, *numbers])}")
        return Chained(lines, arguments, names)

    @property
    def _source(self) -> int:
        return self.head.inputs[0].slots[0]

    @property
    def answer(self) -> tuple[str, ...]:
        """The fields of the last node's parts."""
        fields: tuple[str, ...] = self.links[-1].form.parts._fields  # type: ignore[attr-defined]
        return fields

    def _truth(self, item: Item, before: dict[int, str]) -> str:
        """Return a guard's condition about what comes before."""
        assert item.node is not None
        assert item.node.guard is not None
        names: dict[str, str] = {}
        for i, slot in enumerate(item.guard):
            view = self.plan.items[slot].view
            assert view is not None
            names[f"v{i}"] = ".".join([before[self.plan.items[slot].source], *view.path])
        return str(spelled(item.node.guard, names))

    def entry(self, *, make: bool) -> Enter | None:
        """Return what takes the chain's input, and when the call began; None without machine code.

        It gives the answer's value, and is told where a frame is not for the chain: None.
        """
        code = self.code.machine_code(make=make)
        if code is None:
            return None
        settings = tuple(value for link in self.links for value in link.form.settings)

        def enter(mask: Any, start: int) -> Any:
            if not isinstance(mask, Mask):
                return None
            cells = mask._cells
            pitch_x, pitch_y = mask.pitch_cm
            x0, y0 = mask.origin_cm
            if (
                cells is None
                or cells.dtype is not BOOL
                or not cells.flags.c_contiguous
                or cells.ndim != 2
                or not pitch_x.__class__ is pitch_y.__class__ is x0.__class__ is float
                or y0.__class__ is not float
            ):
                return None
            return code(cells, pitch_x, pitch_y, x0, y0, mask.count, start, *settings)

        return enter


class Later:
    """Makes what a chain has left unmade, by the operations of its nodes.

    Parameters
    ----------
    chain : Chain
    operations : sequence of callable
        Of each slot. Nobody else calls those of the chain.
    """

    def __init__(self, chain: Chain, operations: Sequence[Operation]) -> None:
        last = chain.last.slot
        self._operations = [operations[slot] for slot in sorted(chain.slots) if slot != last]
        self._n_slots = chain.plan.n_slots
        self._first = chain.head.slot
        self._lock = Lock()

    def __call__(self, state: State) -> None:
        """Settle the chain's slots in a frame's state; times stay those of the frame's run."""
        n = self._n_slots
        with self._lock:
            if state[self._first] is not None:  # another thread was sooner
                return
            times = state[n : 2 * n]
            for settle in self._operations:
                settle(state)
            state[n : 2 * n] = times


def chains_of(plan: Plan, alone: Set[int], is_plain: Callable[[Item], bool]) -> list[Chain]:
    """Return the chains of a plan.

    Parameters
    ----------
    plan : Plan
    alone : set of int
        The slots that are settled in one place only.
    is_plain : callable
        Whether an item's operation can be written out.
    """
    forms: dict[int, Linked] = {}
    for item in plan.nodes:
        form = linked_form(item.node) if item.node is not None else None
        if form is not None and item.slot in alone and len(item.inputs) == 1 and is_plain(item):
            forms[item.slot] = form
    found: list[Chain] = []
    taken: set[int] = set()
    for item in reversed(plan.nodes):
        if item.slot in forms and item.slot not in taken:
            chain = _Search(plan, forms, item).chain()
            if chain is not None:
                found.append(chain)
                taken |= chain.slots
    return found


def linked_form(node: Node) -> Linked | None:
    """Return a node's form in machine code; None where its step offers none for its settings."""
    signature = node.signature
    if signature is None or node.kind is not NodeKind.STEP or node.stateful or node.each:
        return None
    return None if node.isolation is not None else form_of(signature, node.settings, node.bound)


def form_of(
    signature: Signature, settings: Mapping[str, Any], made: Callable[[], Any]
) -> Linked | None:
    """Return a step's form in machine code; None where it offers none for its settings.

    Parameters
    ----------
    signature : Signature
    settings : mapping
        Every setting of the step.
    made : callable
        Gives the step with its settings, where it is a class.
    """
    if getattr(signature.target, "linked", None) is None:
        return None
    if signature.rng or signature.gap or len(signature.ports) != 1:
        return None
    found: Linked | None = signature.form("linked", settings, made)()
    return found


class _Search:
    """The way back from a chain's last node, as far as a chain may go."""

    def __init__(self, plan: Plan, forms: Mapping[int, Linked], last: Item) -> None:
        self.plan, self.forms, self.last = plan, forms, last
        self.asked = set(plan.asked.values())
        self.slots = {last.slot}

    def chain(self) -> Chain | None:
        """Return the longest chain; None if there is none."""
        item, links = self.last, list[Link]()
        while True:
            source = self.plan.items[item.inputs[0].slots[0]]
            view = source.view
            before = source if view is None else self.plan.items[source.source]
            between = self._between(before, item)
            links.insert(0, Link(item, self.forms[item.slot], view.path if view else ()))
            if between is None:
                break
            self.slots |= between
            item = before
        if len(links) < SHORTEST or links[0].path or not self._takes_mask(links[0]):
            return None
        return Chain(self.plan, tuple(links), frozenset(self.slots))

    def _takes_mask(self, head: Link) -> bool:
        """Return whether a chain begins with a mask of cells: linked steps give packed ones."""
        node = head.item.node
        if head.item.inputs[0].slots[0] in self.forms:
            return False
        return node is not None and node.inputs[0].port.type is Mask

    def _between(self, before: Item, item: Item) -> set[int] | None:
        """Return a node's slot and those of its fields, if nobody but the next node reads them."""
        form, node = self.forms.get(before.slot), item.node
        if form is None or node is None:
            return None
        views = [i for i in self.plan.items if i.view is not None and i.source == before.slot]
        slots = {before.slot, *(view.slot for view in views)}
        readers = {i.slot for i in self.plan.items if slots & {*i.reads}} - slots
        fields: tuple[str, ...] = form.parts._fields  # type: ignore[attr-defined]
        plain = all(v.view is not None and v.view.path in [(n,) for n in fields] for v in views)
        if readers != {item.slot} or slots & self.asked or not plain:
            return None
        if any(view.view is not None and view.view.item_path for view in views):
            return None
        if node.guard is not None and (slots & {*item.guard} or item is not self.last):
            # Of the last node it is told before the chain begins, of any other within.
            views_only = {*item.guard} <= slots - {before.slot}
            if item is self.last or not views_only or spelled(node.guard) is None:
                return None
        return slots


PLAIN = (
    ast.Expression, ast.Compare, ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.Not, ast.USub,
    ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Name, ast.Load, ast.Constant,
)  # fmt: skip
"""What a condition is made of that means the same in machine code and in a function's text."""


def spelled(guard: Guard, names: Mapping[str, str] | None = None) -> str | None:
    """Return a guard's condition as text; None if it is more than comparisons with numbers.

    Parameters
    ----------
    guard : Guard
    names : mapping, optional
        What to write for ``v0``, ``v1``, …, the guard's references in their order.
    """
    tree = ast.parse(guard.meaning, mode="eval")
    for part in ast.walk(tree):
        if not isinstance(part, PLAIN):
            return None
        if isinstance(part, ast.Constant) and part.value.__class__ not in (int, float):
            return None
        if reckons(part) and any(isinstance(p, ast.Name) for p in ast.walk(part)):
            return None  # the guard's function has small numbers made wide
        if isinstance(part, ast.Name):
            part.id = (names or {}).get(part.id, part.id)
    return None if guard.groups else ast.unparse(tree)
