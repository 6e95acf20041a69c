"""Follow quantity and grid along the wires and check the rules steps declare about them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tactile_graph.pipeline.node import FRAME, Binding, Facts, FrameRule
from tactile_graph.pipeline.pipeline import Source
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps.rules import Grid, GridFact, Quantity
from tactile_graph.steps.signature import Signature

FactTable = Mapping[str, Facts]


def source_facts(source: Source | None) -> Facts:
    """Return what the source says of its frames before the first one comes."""
    names = (
        source.signature.output_quantity.names
        if source and source.signature.output_quantity
        else ()
    )
    return Facts(names[0] if len(names) == 1 else FRAME, GridFact(FRAME))


def ref_facts(ref: Ref, facts: FactTable) -> Facts:
    """Return what is known of the image at a reference."""
    known = facts.get(ref.node, Facts())
    if not ref.path:
        return known
    return known if ref.node == FRAME and ref.path == ("image",) else Facts()


def output_facts(
    signature: Signature, settings: Mapping[str, Any], inputs: tuple[Binding, ...], facts: FactTable
) -> Facts:
    """Return what is known of a step's output."""
    by_port = {b.port.name: ref_facts(b.refs[0], facts) for b in inputs if b.refs}
    return Facts(
        _output_quantity(signature.output_quantity, by_port),
        _output_grid(signature.output_grid, settings, by_port),
    )


def _output_quantity(rule: Quantity | None, by_port: Mapping[str, Facts]) -> str:
    if rule is None:
        return ""
    if rule.port:
        return by_port.get(rule.port, Facts()).quantity
    return rule.names[0] if len(rule.names) == 1 else ""


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
        got = by_port.get(port, Facts()).quantity
        if got == FRAME:
            rules.append(FrameRule(node, port, signature.name, quantity))
        elif got and quantity.names and got not in quantity.names:
            troubles.append((port, quantity_text(signature.name, port, quantity, got, setting)))
    for binding in inputs:
        if binding.port.grid is not None:
            trouble, rule = _grid_trouble(node, signature, binding, by_port)
            troubles += [trouble] if trouble else []
            rules += [rule] if rule else []
    return troubles, rules


def quantity_text(step: str, port: str, wanted: Quantity, got: str, setting: str = "") -> str:
    """Return the words for a quantity that does not fit."""
    who = f"setting {setting!r} of step {step!r}" if setting else f"step {step!r}"
    return f"{who} takes {' or '.join(wanted.names)} at port {port!r}, got {got}"


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
    if mine is None or mine.origin != FRAME:
        return None, None
    factor = int(mine.finer) if mine.finer.denominator == 1 else 1
    return None, FrameRule(
        node, port, signature.name, None,
        _divided(rule.rows, factor), _divided(rule.columns, factor),
        None if rule.pitch_cm is None else rule.pitch_cm * factor,
        -(-rule.min_rows // factor), -(-rule.min_columns // factor),
    )  # fmt: skip


def _divided(count: int | None, factor: int) -> int | None:
    return None if count is None else count // factor
