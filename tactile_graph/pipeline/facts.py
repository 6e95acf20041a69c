"""Follow quantity and grid along the wires and check the rules steps declare about them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from tactile_graph.pipeline.graph import FRAME, Binding, Facts, FrameRule, Node, Source
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps.rules import Grid, GridFact, Quantity
from tactile_graph.steps.signature import Signature

FactTable = Mapping[str, Facts]


def source_facts(source: Source | None) -> Facts:
    """Return what the source says of its frames before the first one comes."""
    rule = source.signature.output_quantity if source else None
    names = rule.names if rule else ()
    if source and rule and rule.port:
        names = tuple(n for n in names if n == source.settings.get(rule.port))
    return Facts(names[0] if len(names) == 1 else FRAME, GridFact(FRAME), of_frame=True)


def ref_facts(ref: Ref, facts: FactTable) -> Facts:
    """Return what is known of the image at a reference."""
    known = facts.get(ref.node, Facts())
    if ref.whole:
        return known
    return known if ref == Ref(FRAME, ("image",)) else Facts()


def output_facts(
    signature: Signature, settings: Mapping[str, Any], inputs: tuple[Binding, ...], facts: FactTable
) -> Facts:
    """Return what is known of a step's output."""
    by_port = {b.port.name: ref_facts(b.refs[0], facts) for b in inputs if b.refs}
    like, quantity = Facts(), signature.output_quantity
    if quantity is not None and quantity.port:
        like = by_port.get(quantity.port, like)
    elif quantity is not None and len(quantity.names) == 1:
        like = Facts(quantity.names[0])
    views = tuple(getattr(signature.output, "provides", {}).values())
    return replace(like, grid=_output_grid(signature.output_grid, settings, by_port), views=views)


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


Trouble = tuple[str, str]


def step_troubles(
    node: str,
    signature: Signature,
    given: Mapping[str, Any],
    settings: Mapping[str, Any],
    inputs: tuple[Binding, ...],
    facts: FactTable,
) -> tuple[list[Trouble], list[FrameRule]]:
    """Return the rules a node breaks, by port, and those that only a frame can settle."""
    troubles: list[Trouble] = []
    rules: list[FrameRule] = []
    by_port = {b.port.name: ref_facts(b.refs[0], facts) for b in inputs if b.refs}
    wanted = [(b.port.name, b.port.quantity, "") for b in inputs if b.port.quantity]
    wanted += [
        (s.quantity.port, s.quantity, s.name)
        for s in signature.settings
        if s.quantity and s.quantity.port and given.get(s.name) is not None
    ]
    for port, quantity, setting in wanted:
        known = by_port.get(port, Facts())
        if known.of_frame:
            rules.append(FrameRule(node, port, signature.name, quantity, setting=setting))
        text = quantity_trouble(signature.name, port, quantity, known.quantity, setting)
        troubles += [(port, text)] if text else []
    for binding in inputs:
        if binding.port.grid is not None:
            trouble, rule = _grid_trouble(node, signature, binding, by_port)
            troubles += [trouble] if trouble else []
            rules += [rule] if rule else []
    return troubles, rules


def quantity_troubles(node: Node, facts: FactTable) -> tuple[list[Trouble], list[FrameRule]]:
    """Return what is wrong at the ports of a step that, made with its settings, takes less.

    It says so itself: ``takes`` holds the quantities by port, ``takes_by`` the setting at fault.
    """
    made = node.callable
    takes = {p: Quantity(*names) for p, names in getattr(made, "takes", {}).items()}
    setting = getattr(made, "takes_by", "")
    troubles: list[Trouble] = []
    rules: list[FrameRule] = []
    by_port = {b.port.name: _view_facts(b.refs[0], facts) for b in node.inputs if b.refs}
    for port in takes.keys() & by_port.keys():
        known, what = by_port[port], node.what
        text = quantity_trouble(what, port, takes[port], known.quantity, setting)
        troubles += [(port, text)] if text else []
        if known.of_frame:
            rules.append(FrameRule(node.name, port, what, takes[port], setting=setting))
    return troubles, rules


def _view_facts(ref: Ref, facts: FactTable) -> Facts:
    """Return what is known of the value at a reference, or of what a record is seen as there."""
    known = facts.get(ref.node, Facts())
    return known if ref.path in [(view,) for view in known.views] else ref_facts(ref, facts)


def quantity_trouble(
    step: str, port: str, wanted: Quantity, got: str, setting: str = "", frame: bool = False
) -> str:
    """Return the words for a quantity that does not fit; none where it fits or is not known."""
    if got in ("", FRAME) or not wanted.names or got in wanted.names:
        return ""
    source = "a frame of " if frame else ""
    who = f"setting {setting!r} of step {step!r}" if setting else f"step {step!r}"
    return f"{who} takes {' or '.join(wanted.names)} at port {port!r}, got {source}{got}"


def _grid_trouble(
    node: str, signature: Signature, binding: Binding, by_port: Mapping[str, Facts]
) -> tuple[Trouble | None, FrameRule | None]:
    rule, port = binding.port.grid, binding.port.name
    assert rule is not None
    mine = by_port[port].grid
    if rule.port:
        other = by_port.get(rule.port, Facts()).grid
        if mine is not None and other is not None and mine != other:
            ratio = mine.finer / other.finer
            text = f"step {signature.name!r} needs {port!r} on the same grid as {rule.port!r}" + (
                f", but its cells are {float(1 / ratio):g} times as wide" if ratio != 1 else ""
            )
            return (port, text), None
        return None, None
    try:
        return None, coarser(
            FrameRule(node, port, signature.name, None, rule.rows, rule.columns, rule.pitch_cm,
                      rule.min_rows, rule.min_columns), mine)  # fmt: skip
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


def embedded_facts(inner: Facts, outer: Facts) -> Facts:
    """Return what is known of an embedded node's image, given what its pipeline's frame is."""
    quantity = outer if inner.of_frame else inner
    grid = None
    if inner.grid is not None and outer.grid is not None:
        grid = outer.grid.refined(int(inner.grid.finer))
    return Facts(quantity.quantity, grid, quantity.of_frame)


def embedded_rules(
    name: str, rules: Iterable[FrameRule], outer: Facts
) -> tuple[list[str], list[FrameRule]]:
    """Return which rules an embedded pipeline's frame breaks, and those left for the frame."""
    troubles: list[str] = []
    left: list[FrameRule] = []
    for inner in rules:
        rule = replace(inner, node=f"{name}/{inner.node}")
        if rule.quantity is not None:
            trouble = quantity_trouble(
                rule.step, rule.port, rule.quantity, outer.quantity, rule.setting
            )
            troubles += [f"{rule.node}: {trouble}"] if trouble else []
            left += [rule] if outer.of_frame else []
            continue
        try:
            found = coarser(rule, outer.grid)
            left += [found] if found else []
        except ValueError as error:
            troubles.append(f"{rule.node}: {error}")
    return troubles, left
