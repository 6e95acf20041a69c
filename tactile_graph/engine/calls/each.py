"""Lists on the wires: nodes that run for each item, and steps that take a list whole.

An item that fails or is skipped keeps its place, with its own outcome in it. A node over that list
hands the outcome on in the same place; a step that takes the list whole is told, or does not run.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from dataclasses import fields as fields_of
from typing import Any

from tactile_graph.engine.calls.context import Context
from tactile_graph.engine.outcomes.outcome import (
    DONE,
    NO_VALUE,
    Failed,
    Skipped,
    gaps,
    item_words,
    nothing_returned,
    raised,
    with_value,
)
from tactile_graph.engine.outcomes.outcomes import Outcomes
from tactile_graph.engine.plan import OF_ITEM
from tactile_graph.pipeline.graph import FRAME, Binding, Node, NodeKind
from tactile_graph.pipeline.resolution.embed import MASK
from tactile_graph.pipeline.wiring import arms
from tactile_graph.wires.frame import Frame

Call = Callable[..., Any]


def for_each(node: Node, step: Call, context: Context) -> Call:
    """Return the step run over the items of whichever ports hold lists it does not want whole.

    Where the list of an optional port was skipped, each item of the others takes its default.
    """
    assert node.signature is not None
    over = [b.port for b in node.inputs if b.iterates]
    order = [p.name for p in node.signature.ports]
    sink = node.signature.output is type(None) or node.signature.output is None

    def outcome_of(values: dict[str, Any], i: int) -> Any:
        item = dict(values)
        for port in over:
            whole = values[port.name]
            value = item[port.name] = whole if whole.__class__ is Skipped else whole[i]
            if value.__class__ in NO_VALUE:
                if port.required or value.__class__ is Failed:
                    return value
                item[port.name] = port.default
        try:
            result = step(**item)
        except Exception as error:
            return raised(node.name, error, tuple(item.values()), "").of_item(i)
        if result is None:
            return DONE if sink else nothing_returned(node.name, "").of_item(i)
        return result

    def call(*args: Any, **kwargs: Any) -> Any:
        values = {**dict(zip(order, args, strict=False)), **kwargs}
        names = [port.name for port in over if values[port.name].__class__ is not Skipped]
        if not names:
            return values[over[0].name]
        outcomes = []
        outer = context.item
        try:
            for i in range(_length(values, names)):
                context.item = (*outer, i)  # or every item would draw the same numbers
                outcomes.append(outcome_of(values, i))
        finally:
            context.item = outer
        context.item_failures += [o for o in outcomes if o.__class__ is Failed]
        return gathered(outcomes, node.name)

    return call


def gathered(outcomes: Sequence[Any], name: str) -> Any:
    """Return the outcomes of a node's items as its list; its own outcome if none has a value."""
    if any(o.__class__ not in NO_VALUE for o in outcomes):
        return tuple(outcomes)
    failed = next((o for o in outcomes if o.__class__ is Failed), None)
    if failed is not None:
        return failed
    return Skipped(name, "no items to run for" if not outcomes else outcomes[0].reason)


@dataclass(frozen=True, slots=True, eq=False)
class InnerFrame(Frame):
    """The frame of an item, with what takes the place of nodes."""

    given: Mapping[str, Any] = field(default_factory=dict)


OF_FRAME = tuple(f.name for f in fields_of(Frame) if (f.name,) not in OF_ITEM)
"""What the frame of an item has of the frame that is under way."""


def mapped(node: Node, context: Context) -> Call:
    """Return the embedded pipeline run over lists: of images, of what takes its nodes' places."""
    assert node.inner is not None
    run, apart = context.embedded(node.inner)
    context.apart.update({f"{node.name}/{name}": host for name, host in apart.items()})
    fields = getattr(node.output, "_fields", ())
    names = list(node.inner.outputs)
    over = [b.port.name for b in node.inputs if b.iterates]
    given = [n for n, inner in node.inner.nodes.items() if inner.kind is NodeKind.GIVEN]

    def call(**wired: Any) -> Any:
        results: list[Outcomes | None] = []
        of_frame = {name: getattr(context.frame, name) for name in OF_FRAME}
        lacking: list[Any] = []
        for i in range(_length(wired, over)):
            values = {**wired, **{name: wired[name][i] for name in over}}
            image, mask = values[FRAME], values.get(MASK)
            if image.__class__ in NO_VALUE:
                results.append(None)
                lacking.append(image)
                continue
            mask = None if mask.__class__ in NO_VALUE else mask
            its = {name: values[name] for name in given}
            inner = InnerFrame(image, mask=mask, given=its, **of_frame)
            results.append(run(inner, (*context.item, i)))
            lacking.append(None)
        context.inner_results[node.name] = results

        def column(name: str) -> Any:
            items = [
                lacking[i] if r is None else _of_item(r, name, node.name, i)
                for i, r in enumerate(results)
            ]
            return gathered(items, node.name)

        columns = [column(n) for n in names]
        if not fields or all(c.__class__ in NO_VALUE for c in columns):
            return columns[0]
        return node.output(*columns)

    return call


def _length(wired: Mapping[str, Any], over: Sequence[str]) -> int:
    """Return how many items lists have; raises ValueError where that is not the same for all."""
    counts = {name: len(wired[name]) for name in over}
    if len(set(counts.values())) > 1:
        raise ValueError(f"lists of different length at one node: {counts}")
    return next(iter(counts.values()))


def _of_item(result: Outcomes, name: str, node: str, i: int) -> Any:
    """Return what an output of a node's embedded pipeline came to for an item."""
    outcome = result.outcome(name)
    if not isinstance(outcome, Skipped | Failed):
        return outcome
    frame = result.frame
    if isinstance(frame, InnerFrame) and any(v is outcome for v in frame.given.values()):
        return outcome  # it began before the pipeline
    return outcome.within(node, i)


def told_of_gaps(node: Node, step: Call) -> Call:
    """Return the step with its lists looked through for items without a value.

    A port whose items may be None (``list[Circle | None]``) has None in such a place. For any
    other, items that were skipped are left out, as they are from a list of nodes, and one that
    failed fails the node. A step that takes several lists is skipped instead: with an item left
    out of one, items of the others would stand beside the wrong ones.
    """
    assert node.signature is not None
    whole = [b for b in node.inputs if _whole(b)]
    if not whole:
        return step
    order = [p.name for p in node.signature.ports]

    def call(*args: Any, **kwargs: Any) -> Any:
        values = {**dict(zip(order, args, strict=False)), **kwargs}
        for binding in whole:
            name = binding.port.name
            empty = gaps(values[name])
            if not empty:
                continue
            if _takes_none(binding):
                values[name] = tuple([None if v.__class__ in NO_VALUE else v for v in values[name]])
                continue
            told = _refused(node, binding, empty, len(whole))
            kept = tuple(with_value(values[name]))
            if told is not None or not kept:
                return told or empty[0]
            values[name] = kept
        return step(**values)

    return call


def _whole(binding: Binding) -> bool:
    return binding.port.item is not None and not binding.collects and not binding.iterates


def _takes_none(binding: Binding) -> bool:
    return type(None) in arms(binding.port.item)


def _refused(node: Node, binding: Binding, empty: list[Any], n_lists: int) -> Any:
    """Return what a node comes to because of a list's gaps; None where it may do without them."""
    failed = next((o for o in empty if o.__class__ is Failed), None)
    if failed is not None or n_lists == 1:
        return failed
    gap = empty[0]
    where = item_words(gap.item) or "an item"
    reason = f"{where} of {binding.refs[0]} was skipped: {gap.reason}"
    return Skipped(node.name, reason, unforeseen=True)
