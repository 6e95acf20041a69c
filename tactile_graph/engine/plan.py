"""Compile a pipeline for a demand into a flat plan over slots.

A plan is a list of items in an order in which every item comes after what it reads. `Plan.main`
holds those needed for any frame. Whatever only a guard, a choice or a skippable input decides on
is *lazy*: it stands in the block of the item that may need it, and runs when that item says so.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tactile_graph.pipeline.graph import FRAME, FrameRule, Graph, Node, NodeKind
from tactile_graph.pipeline.wiring import Ref, arms


@dataclass
class Input:
    """What a port reads: slots, and what runs only when the port's turn comes."""

    slots: tuple[int, ...]
    collects: bool
    required: bool
    default: object
    name: str
    lazy: tuple[int, ...] = ()
    iterates: bool = False


@dataclass
class Item:
    """One slot of a plan: a node's outcome, or a view (field) of another slot's."""

    slot: int
    name: str
    node: Node | None = None
    view: Ref | None = None
    source: int = 0
    guard: tuple[int, ...] = ()
    inputs: tuple[Input, ...] = ()
    reads: tuple[int, ...] = ()
    constant: bool = False
    skippable: bool = False


@dataclass
class Plan:
    """Everything needed to run a pipeline for a demand, as flat data."""

    pipeline: Graph
    asked: dict[str, int]
    items: list[Item]
    main: tuple[int, ...]
    slots: dict[str, int]
    reads_frame: tuple[Ref, ...] = ()
    depth: int = 0
    rules: tuple[FrameRule, ...] = ()
    refs: dict[Ref, int] = field(default_factory=dict)
    """The slot of each node and of each view of one; two views may share their name."""
    image: int = 0
    """The slot of the frame's image; 0 if nothing reads it. Like the frame it is there at once."""

    @property
    def n_slots(self) -> int:
        """Number of slots, the frame's included."""
        return len(self.items)

    @property
    def nodes(self) -> list[Item]:
        """The items that are nodes, in order."""
        return [i for i in self.items if i.node is not None]

    @property
    def keeping(self) -> tuple[str, ...]:
        """Names of the nodes whose steps keep state."""
        return tuple(i.name for i in self.items if i.node is not None and i.node.stateful)

    @property
    def stateful(self) -> bool:
        """Whether any step in it keeps state."""
        return bool(self.keeping)

    @property
    def repeatable(self) -> bool:
        """Whether the same image gives the same result, whatever its time and number."""
        return not self.stateful and all(
            r.path[:1] == ("image",) for r in self.reads_frame
        ) and not any(
            i.node.is_sink or _varies(i.node) or i.node.kind is NodeKind.GIVEN
            for i in self.items if i.node
        )  # fmt: skip


OF_ITEM = (("image",), ("mask",))
"""What an inner frame has of its own item; all else it has of the frame that is under way."""


def _varies(node: Node) -> bool:
    """Return whether a node may answer differently to the same image."""
    if node.inner is not None:
        inner = node.inner.nodes.values()
        refs = [r for n in inner for r in n.wires()] + list(node.inner.outputs.values())
        whole = any(r.node == FRAME and r.path[:1] not in OF_ITEM for r in refs)
        return whole or any(_varies(n) for n in inner)
    return node.signature is not None and bool(node.signature.rng)


def make_plan(pipeline: Graph, asked: Sequence[str], ladders_wait: bool = False) -> Plan:
    """Return the plan for the nodes or fields asked for.

    Parameters
    ----------
    pipeline : Graph
    asked : sequence of str
    ladders_wait : bool
        Whether a ladder's first choice stands in a block like the others, so that it can be left
        undone; what comes of it is the same.

    Raises
    ------
    UsageError
        If one of them does not exist.
    """
    return _Planner(pipeline, asked, ladders_wait).plan()


def is_ladder(item: Item) -> bool:
    """Return whether an item is a ``first_of``."""
    return item.node is not None and item.node.kind is NodeKind.FIRST_OF


def _needing(rules: Iterable[FrameRule], square_to: float) -> set[str]:
    """Return the nodes that cells break a rule of which are not square to a share."""
    return {r.node for r in rules if r.square_to is not None and r.square_to <= square_to}


def _slots(bits: int) -> tuple[int, ...]:
    """Return which bits of a number are set, in order."""
    if bits < 1 << 64:
        return tuple(k for k in range(bits.bit_length()) if bits >> k & 1)
    raw = np.frombuffer(bits.to_bytes((bits.bit_length() + 7) // 8, "little"), np.uint8)
    return tuple(np.flatnonzero(np.unpackbits(raw, bitorder="little")).tolist())


class _Planner:
    def __init__(self, pipeline: Graph, asked: Sequence[str], ladders_wait: bool) -> None:
        self.pipeline = pipeline
        self.ladders_wait = ladders_wait
        self.asked = {name: pipeline.outputs.get(name) or pipeline.ref(name) for name in asked}
        self.items: list[Item] = []
        self.by_ref: dict[Ref, int] = {}
        # Sets of slots are bits of integers: as sets, those of long chains would take minutes.
        self.given = 0
        self.eager: list[int] = []

    def plan(self) -> Plan:
        self._number()
        image = self.by_ref.get(Ref(FRAME, ("image",)), 0)
        self.given = 1 | 1 << image
        for item in self.items:
            self._wire(item)
        for item in self.items:
            self._classify(item)
            self.eager.append(self._eager_of(item))
        main = self._eager(self.by_ref[r] for r in self.asked.values())
        for item in self.items:
            self._place_lazies(item, main)
        used = {r.node for r in self._refs()} | {r.node for r in self.asked.values()}
        return Plan(
            self.pipeline,
            {name: self.by_ref[r] for name, r in self.asked.items()},
            self.items,
            _slots(main & ~self.given),
            {i.name: i.slot for i in self.items if not (i.view and i.view.item_path)},
            tuple(r for r in {*self._refs(), *self.asked.values()} if r.node == FRAME),
            self._depth(),
            tuple(self._rules(used)),
            self.by_ref,
            image,
        )

    def _rules(self, used: set[str]) -> Iterable[FrameRule]:
        """Return the rules that a frame must keep.

        One about square cells is left to its step where something asked for does without: its node
        alone fails, and a choice takes the next.
        """
        every = [r for r in self.pipeline.frame_rules if r.node in used]
        squares = {r.square_to for r in every if r.square_to is not None}
        refused = {to for to in squares if self._all_fail(_needing(every, to))}
        return (r for r in every if r.square_to is None or r.square_to in refused)

    def _all_fail(self, failed: set[str]) -> bool:
        """Return whether nothing of what is asked for is left where some nodes fail."""
        for name, node in self.pipeline.nodes.items():
            read = [] if node.guard is None else [{r.node} for r in node.guard.refs]
            read += [{r.node for r in b.refs} for b in node.inputs if b.port.required and b.refs]
            read += [{r.node for r in node.choices}] if node.choices else []
            if any(names <= failed for names in read):
                failed.add(name)
        return all(r.node in failed for r in self.asked.values())

    # -- slots -------------------------------------------------------------------------------

    def _needed(self) -> list[str]:
        """Return the nodes the demand reaches, each after those it reads."""
        nodes, needed = self.pipeline.nodes, set[str]()
        waiting = [r.node for r in self.asked.values()]
        while waiting:
            name = waiting.pop()
            if name != FRAME and name not in needed:
                needed.add(name)
                waiting += [r.node for r in nodes[name].wires()]
        return [name for name in nodes if name in needed]

    def _number(self) -> None:
        """Give every node and every view of one a slot; a view follows its node."""
        views: dict[str, dict[Ref, None]] = {FRAME: {}}
        names = self._needed()
        for name in names:
            views[name] = {}
        for name in names:
            for ref in self.pipeline.nodes[name].wires():
                if not ref.whole:
                    views[ref.node][ref] = None
        for ref in self.asked.values():
            if not ref.whole:
                views[ref.node][ref] = None
        for name in [FRAME, *names]:
            self._add(Item(0, name, self.pipeline.nodes.get(name)), Ref(name))
            for ref in views[name]:
                self._add(Item(0, str(ref), view=ref, source=self.by_ref[Ref(name)]), ref)

    def _add(self, item: Item, ref: Ref) -> None:
        item.slot = self.by_ref[ref] = len(self.items)
        self.items.append(item)

    def _refs(self) -> list[Ref]:
        return [r for i in self.items if i.node is not None for r in i.node.wires()]

    def _wire(self, item: Item) -> None:
        node = item.node
        if item.view is not None:
            item.reads = (item.source,)
        elif node is not None:
            item.guard = tuple(self.by_ref[r] for r in node.guard.refs) if node.guard else ()
            if node.kind in (NodeKind.FIRST_OF, NodeKind.PASS):
                item.inputs = tuple(
                    Input((self.by_ref[r],), False, True, None, str(r)) for r in node.choices
                )
            else:
                item.inputs = tuple(
                    Input(tuple(self.by_ref[r] for r in b.refs), b.collects, b.port.required,
                          b.port.default, b.port.name, iterates=b.iterates)
                    for b in node.inputs
                )  # fmt: skip
            item.reads = item.guard + tuple(s for i in item.inputs for s in i.slots)
            if node.kind is NodeKind.GIVEN:
                item.reads = (0,)

    def _classify(self, item: Item) -> None:
        """Find out whether the item depends on no frame, and whether it can come out skipped."""
        node = item.node
        read = [self.items[s] for s in item.reads]
        if node is None:
            item.constant = item.slot != 0 and all(r.constant for r in read)
            item.skippable = any(r.skippable for r in read) or self._may_be_unknown(item)
            return
        item.constant = all(r.constant for r in read) and not (
            node.stateful or node.is_sink or _varies(node)
        )
        inputs = [any(self.items[s].skippable for s in i.slots) for i in item.inputs if i.required]
        through = all(inputs) if node.kind is NodeKind.FIRST_OF else any(inputs)
        item.skippable = node.guard is not None or (bool(inputs) and through)
        item.skippable |= any(self.items[s].skippable for s in item.guard)
        # An empty list leaves nothing to run for; an item that is given may have no value.
        item.skippable |= node.each or node.kind is NodeKind.GIVEN

    def _may_be_unknown(self, item: Item) -> bool:
        """Return whether a field may hold None, which skips whoever needs it."""
        if item.view is None or item.view.item_path:
            return False
        kinds = arms(self.pipeline.type_of(item.view))
        return any(kind is Any or kind is object or kind is type(None) for kind in kinds)

    # -- what is needed at once, and what may wait ---------------------------------------------

    def _eager_inputs(self, item: Item) -> list[Input]:
        """Return the inputs that are settled whatever the others come to."""
        node = item.node
        if node is not None and node.guard is not None:
            return []
        if is_ladder(item):
            return [] if self.ladders_wait else list(item.inputs[:1])
        eager: list[Input] = []
        for port in item.inputs:
            eager.append(port)
            if port.required and any(self.items[s].skippable for s in port.slots):
                break
        return eager

    def _eager_of(self, item: Item) -> int:
        """Return the slots that are needed whenever an item is; all it reads come before it."""
        found = 1 << item.slot
        if item.view is not None:
            found |= self.eager[item.source]
        found |= self._eager(self._before_guard(s) for s in item.guard)
        return found | self._eager(s for port in self._eager_inputs(item) for s in port.slots)

    def _eager(self, targets: Iterable[int]) -> int:
        """Return the slots that are needed whenever the targets are."""
        found = 0
        for slot in targets:
            found |= self.eager[slot]
        return found

    def _before_guard(self, slot: int) -> int:
        """Return what must be settled before a guard reads a slot: it takes fields itself."""
        item = self.items[slot]
        return slot if item.view is None else item.source

    def _place_lazies(self, item: Item, main: int) -> None:
        eager = {id(port) for port in self._eager_inputs(item)}
        if len(eager) == len(item.inputs):
            return
        done = main | self._eager(item.guard)
        for port in item.inputs:
            needed = self._eager(port.slots) & ~done & ~self.given
            if id(port) not in eager:
                # Eager inputs stand beside the item in whatever block it runs in.
                port.lazy = _slots(needed)
            if not (self.ladders_wait and is_ladder(item)):  # or it may have been left undone
                done |= needed

    def _depth(self) -> int:
        """Return how deep lazy blocks nest, for the interpreter's stack."""
        depth: dict[int, int] = {}
        for item in self.items:
            inner = [
                depth.get(s, 0) for s in (*item.reads, *(s for p in item.inputs for s in p.lazy))
            ]
            depth[item.slot] = 1 + max(inner, default=0)
        return max(depth.values(), default=0)
