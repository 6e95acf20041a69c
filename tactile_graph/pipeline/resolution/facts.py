"""Follow quantity and grid along the wires and check the rules steps declare about them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.graph import FRAME, Binding, Facts, FrameRule, Node, Source
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps.rules import Grid, GridFact, Quantity
from tactile_graph.steps.signature import Signature
from tactile_graph.vocabulary import QUANTITIES

UNSAID = "raw"
"""The quantity of frames of which nobody said what their values mean."""

FactTable = Mapping[str, Facts]


def frame_facts() -> Facts:
    """Return what is known of frames, whoever gives them."""
    return Facts({q: q for q in QUANTITIES}, GridFact(FRAME), ("image",))


def source_quantities(source: Source | None) -> tuple[str, ...]:
    """Return the quantities that frames of a source may be in, all where it does not say."""
    rule = source.signature.output_quantity if source else None
    if source is None or rule is None:
        return tuple(QUANTITIES)
    told = source.settings.get(rule.port) if rule.port else None
    return (str(told),) if told else rule.names or tuple(QUANTITIES)


def ref_facts(ref: Ref, facts: FactTable) -> Facts:
    """Return what is known of the value at a reference."""
    known = facts.get(ref.node, Facts())
    if ref.whole or (not ref.item_path and ref.path in [(view,) for view in known.views]):
        return known
    return Facts(dict.fromkeys(known.by_frame, ""))


# -- whether there is a value ----------------------------------------------------------------


def where_reached(
    facts: FactTable, guard: Guard | None, inputs: Sequence[Binding] = ()
) -> list[str]:
    """Return the quantities of frames for which a node with this guard and inputs can run."""
    refs = [*(guard.refs if guard else ()), *(b.refs[0] for b in inputs if _needed(b))]
    settled = [ref_facts(ref, facts).by_frame for ref in refs]
    several = [
        [ref_facts(ref, facts).by_frame for ref in b.refs]
        for b in inputs
        if b.collects and b.port.required and b.refs
    ]
    return [
        q
        for q in QUANTITIES
        if all(q in by_frame for by_frame in settled)
        and all(any(q in by_frame for by_frame in some) for some in several)
        and (guard is None or guard.settled(_known(guard, q, facts)) is not False)
    ]


def _needed(binding: Binding) -> bool:
    return bool(binding.refs) and binding.port.required and not binding.collects


def _known(guard: Guard, quantity: str, facts: FactTable) -> dict[Ref, str]:
    """Return which of the quantities that a guard reads are known for frames of one."""
    known: dict[Ref, str] = {}
    for ref in guard.refs:
        if ref.path[-1:] == ("quantity",):
            of_image = Ref(ref.node, ref.path[:-1])
            found = ref_facts(of_image, facts).by_frame.get(quantity, "")
            known |= {ref: found} if found else {}
    return known


def limited(facts: Facts, quantities: Sequence[str]) -> Facts:
    """Return facts of a value that is there for frames of these quantities alone."""
    return replace(facts, by_frame={q: g for q, g in facts.by_frame.items() if q in quantities})


# -- what a node gives -----------------------------------------------------------------------


def output_facts(
    signature: Signature,
    settings: Mapping[str, Any],
    inputs: tuple[Binding, ...],
    facts: FactTable,
    guard: Guard | None,
) -> Facts:
    """Return what is known of a step's output."""
    by_port = _by_port(inputs, facts)
    like, rule = Facts(), signature.output_quantity
    if rule is not None and rule.port:
        like = by_port.get(rule.port, like)
    elif rule is not None and len(rule.names) == 1:
        like = Facts(dict.fromkeys(QUANTITIES, rule.names[0]))
    reached = where_reached(facts, guard, inputs)
    views = tuple(getattr(signature.output, "provides", {}).values())
    return Facts(
        {q: like.by_frame.get(q, "") for q in reached},
        _output_grid(signature.output_grid, settings, by_port),
        views,
    )


def _by_port(inputs: Sequence[Binding], facts: FactTable) -> dict[str, Facts]:
    return {b.port.name: ref_facts(b.refs[0], facts) for b in inputs if b.refs}


def choice_facts(choices: Sequence[Ref], facts: FactTable, guard: Guard | None) -> Facts:
    """Return what is known of the first of several that has a value."""
    known = [ref_facts(choice, facts) for choice in choices]
    by_frame: dict[str, str] = {}
    for q in where_reached(facts, guard):
        found = {one.by_frame[q] for one in known if q in one.by_frame}
        if found:
            by_frame[q] = found.pop() if len(found) == 1 else ""
    grids, views = {one.grid for one in known}, {one.views for one in known}
    return Facts(
        by_frame,
        grids.pop() if len(grids) == 1 else None,
        views.pop() if len(views) == 1 else (),
    )


def _output_grid(
    rule: Grid | None, settings: Mapping[str, Any], by_port: Mapping[str, Facts]
) -> GridFact | None:
    if rule is None or not rule.port:
        return None
    known = by_port.get(rule.port, Facts()).grid
    factor = settings.get(rule.finer_by) if isinstance(rule.finer_by, str) else rule.finer_by
    if known is None or not isinstance(factor, int) or factor < 1:
        return None
    return known.refined(factor)


# -- what steps demand -----------------------------------------------------------------------

Trouble = tuple[str, str]


def step_troubles(
    node: Node, given: Mapping[str, Any], facts: FactTable, frames: Sequence[str]
) -> tuple[list[Trouble], list[FrameRule]]:
    """Return the rules a node breaks, by port, and those that only a frame can settle.

    Parameters
    ----------
    node : Node
    given : mapping
        The settings that somebody spelled out.
    facts : mapping
        By node.
    frames : sequence of str
        Quantities that the source's frames may be in.
    """
    signature = node.signature
    assert signature is not None
    wanted = [(b.port.name, b.port.quantity, "") for b in node.inputs if b.port.quantity]
    wanted += [
        (s.quantity.port, s.quantity, s.name)
        for s in signature.settings
        if s.quantity and s.quantity.port and given.get(s.name) is not None
    ]
    rules = [
        FrameRule(node.name, port, signature.name, _at_port(node, port, facts), quantity,
                  setting=setting)
        for port, quantity, setting in wanted
    ]  # fmt: skip
    troubles, kept = _checked(rules, frames)
    by_port = _by_port(node.inputs, facts)
    for binding in node.inputs:
        if binding.port.grid is not None:
            trouble, rule = _grid_trouble(node, binding, by_port)
            troubles += [trouble] if trouble else []
            kept += [rule] if rule else []
    return troubles, kept


def quantity_troubles(
    node: Node, facts: FactTable, frames: Sequence[str]
) -> tuple[list[Trouble], list[FrameRule]]:
    """Return what is wrong at the ports of a step that, made with its settings, takes less.

    It says so itself: ``takes`` holds the quantities by port, ``takes_by`` the setting at fault,
    ``takes_hint`` what to do.
    """
    made, ports = node.callable, {b.port.name for b in node.inputs if b.refs}
    setting, hint = getattr(made, "takes_by", ""), getattr(made, "takes_hint", "")
    return _checked(
        [
            FrameRule(node.name, port, node.what, _at_port(node, port, facts), Quantity(*names),
                      setting=setting, hint=hint)
            for port, names in getattr(made, "takes", {}).items()
            if port in ports
        ],
        frames,
    )  # fmt: skip


def _at_port(node: Node, port: str, facts: FactTable) -> dict[str, str]:
    """Return the quantity of what comes to a port, by that of the frame, where the node runs."""
    known = _by_port(node.inputs, facts).get(port, Facts()).by_frame
    return {q: known.get(q, "") for q in node.facts.by_frame}


def _checked(
    rules: Iterable[FrameRule], frames: Sequence[str]
) -> tuple[list[Trouble], list[FrameRule]]:
    """Return which rules no frame of the source can keep, and those that some frame breaks."""
    troubles: list[Trouble] = []
    kept: list[FrameRule] = []
    for rule in rules:
        here = [rule.came[q] for q in frames if q in rule.came]
        texts = [quantity_trouble(rule, got) for got in here]
        troubles += [(rule.port, texts[0])] if texts and all(texts) else []
        kept += [rule] if any(quantity_trouble(rule, got) for got in rule.came.values()) else []
    return troubles, kept


def quantity_trouble(rule: FrameRule, got: str, frame: str = "") -> str:
    """Return the words for a quantity that does not fit; none where it fits or is not known.

    Parameters
    ----------
    rule : FrameRule
    got : str
    frame : str
        Quantity of the frame at hand, if there is one.
    """
    names = rule.quantity.names if rule.quantity else ()
    if not got or not names or got in names:
        return ""
    came = (
        got if not frame else f"a frame of {got}" if frame == got else f"{got} of a {frame} frame"
    )
    step = f"step {rule.step!r}"
    who = f"setting {rule.setting!r} of {step}" if rule.setting else step
    hint = f"; {rule.hint}" if rule.hint else ""
    if not hint and frame == got == UNSAID:
        hint = f"; if its values are {names[0]}, say so: --with quantity={names[0]}"
    elif not hint and frame == got:
        hint = f"; tactile-graph inspect names the pipelines that take recordings of {got}"
    return f"{who} takes {' or '.join(names)} at port {rule.port!r}, got {came}{hint}"


def _grid_trouble(
    node: Node, binding: Binding, by_port: Mapping[str, Facts]
) -> tuple[Trouble | None, FrameRule | None]:
    rule, port, step = binding.port.grid, binding.port.name, node.what
    assert rule is not None
    mine = by_port[port].grid
    if rule.port:
        other = by_port.get(rule.port, Facts()).grid
        if mine is not None and other is not None and mine != other:
            ratio = mine.finer / other.finer
            text = f"step {step!r} needs {port!r} on the same grid as {rule.port!r}" + (
                f", but its cells are {float(1 / ratio):g} times as wide" if ratio != 1 else ""
            )
            return (port, text), None
        return None, None
    try:
        return None, coarser(
            FrameRule(node.name, port, step, dict.fromkeys(node.facts.by_frame, ""), None,
                      rule.rows, rule.columns, rule.pitch_cm, rule.min_rows, rule.min_columns,
                      rule.square_to),
            mine)  # fmt: skip
    except ValueError as error:
        return (port, str(error)), None


def coarser(rule: FrameRule, grid: GridFact | None) -> FrameRule | None:
    """Return what a rule about an image of that grid demands of the frame; None if unknown.

    Raises
    ------
    ValueError
        If no frame can fulfil it.
    """
    if grid is None or grid.origin != FRAME:
        return None
    factor = int(grid.finer)
    for count in (rule.rows or 0, rule.columns or 0):
        if count % factor:
            raise ValueError(
                f"step {rule.step!r} takes {count} rows or columns at port {rule.port!r}, but "
                f"there each cell was cut into {factor} a side"
            )
    return replace(
        rule,
        rows=None if rule.rows is None else rule.rows // factor,
        columns=None if rule.columns is None else rule.columns // factor,
        pitch_cm=None if rule.pitch_cm is None else rule.pitch_cm * factor,
        min_rows=-(-rule.min_rows // factor),
        min_columns=-(-rule.min_columns // factor),
    )


# -- pipelines within pipelines --------------------------------------------------------------


def embedded_facts(inner: Facts, outer: Facts) -> Facts:
    """Return what is known of an embedded node's image, given what its pipeline's frame is."""
    grid = None
    if inner.grid is not None and outer.grid is not None:
        grid = outer.grid.refined(int(inner.grid.finer))
    return Facts(_composed(inner.by_frame, outer), grid, inner.views)


def _composed(inner: Mapping[str, str], outer: Facts) -> dict[str, str]:
    """Return an embedded pipeline's quantities by that of the outer frames."""
    always = {*inner.values()}
    unknown = always.pop() if len(always) == 1 else ""
    return {
        q: inner[its] if its else unknown
        for q, its in outer.by_frame.items()
        if (its in inner if its else inner)
    }


def embedded_rules(
    name: str, rules: Iterable[FrameRule], outer: Facts, frames: Sequence[str]
) -> tuple[list[str], list[FrameRule]]:
    """Return which rules an embedded pipeline's frame breaks, and those left for the frame."""
    troubles: list[str] = []
    left: list[FrameRule] = []
    for inner in rules:
        rule = replace(inner, node=f"{name}/{inner.node}", came=_composed(inner.came, outer))
        if rule.quantity is not None:
            texts, kept = _checked([rule], frames)
            troubles += [f"{rule.node}: {text}" for _, text in texts]
            left += kept
            continue
        try:
            found = coarser(rule, outer.grid)
            left += [found] if found else []
        except ValueError as error:
            troubles.append(f"{rule.node}: {error}")
    return troubles, left
