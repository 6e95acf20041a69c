"""Check that a step's signature holds together: defaults fit, rules name what is there."""

from __future__ import annotations

import dataclasses
import sys
import types
import typing
from collections.abc import Callable, Collection, Iterator
from dataclasses import replace
from typing import Any, Union, get_args, get_origin

import annotated_types as at

from tactile_graph.errors import PluginError, did_you_mean, one_of, shown
from tactile_graph.quantities import unknown_quantity
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.steps.signature import Kind, Setting, Signature, strip, type_name
from tactile_graph.steps.stacked import stacked_kinds

RULES = ("annotated_types", "pydantic")
"""Packages whose classes, beside a type, are rules that a value must keep."""
_UNION = (Union, types.UnionType)
_PLAIN: dict[Any, Any] = {bool: (bool,), int: (int,), float: (int, float), str: (str,)}
_LIMITS: tuple[tuple[type, str, str, Callable[[Any, Any], bool]], ...] = (
    (at.Gt, "gt", ">", lambda value, limit: value > limit),
    (at.Ge, "ge", ">=", lambda value, limit: value >= limit),
    (at.Lt, "lt", "<", lambda value, limit: value < limit),
    (at.Le, "le", "<=", lambda value, limit: value <= limit),
)


def check_signature(signature: Signature) -> None:
    """Check what a step's author may have got wrong, before anybody uses the step.

    Raises
    ------
    PluginError
        With the first thing that does not hold together.
    """
    for trouble in (
        *_kinds(signature),
        *_defaults(signature),
        *_rules(signature),
        *_output(signature),
    ):
        raise PluginError(f"step {signature.name!r}: {trouble}")
    if signature.kind is not Kind.SOURCE:
        stacked_kinds(signature)


def _kinds(signature: Signature) -> Iterator[str]:
    """Yield which settings have a type that could not be read from a file."""
    for setting in signature.settings:
        kind = next(filter(_is_bare_typed_dict, _within(setting.annotation)), None)
        if kind is not None:
            yield (
                f"setting {setting.name!r}: {type_name(kind)} is a typing.TypedDict, which before "
                "Python 3.12 cannot be checked; take the TypedDict of typing_extensions, which "
                "comes with pydantic"
            )


def _is_bare_typed_dict(kind: Any) -> bool:
    """Return whether pydantic refuses a typed dict since Python's own tells too little of itself.

    https://docs.pydantic.dev/latest/errors/usage_errors/#typed-dict-version
    """
    before = sys.version_info < (3, 12)
    return before and typing.is_typeddict(kind) and type(kind).__module__ == "typing"


def _within(annotation: Any) -> Iterator[Any]:
    """Yield a type and those it is made of."""
    bare, _ = strip(annotation)
    yield bare
    for arm in get_args(bare):
        yield from _within(arm)


def _defaults(signature: Signature) -> Iterator[str]:
    for setting in signature.settings:
        if not setting.required:
            what = f"default of setting {setting.name!r}"
            why = _misfit(setting, setting.annotation, setting.default)
            if why:
                yield f"{what} {why}, got {shown(setting.default)}"
            elif _is_constrained(setting.annotation):
                from tactile_graph.steps.settings import validate_settings  # loads pydantic

                given = {setting.name: setting.default}
                its = replace(signature, settings=(setting,))
                yield from (f"{what} {told}" for _, told in validate_settings(its, given)[1])


def _is_constrained(annotation: Any) -> bool:
    """Return whether a setting has rules beside the limits that are looked at here."""
    limits = tuple(kind for kind, *_ in _LIMITS)
    return any(
        type(rule).__module__.partition(".")[0] in RULES and not isinstance(rule, limits)
        for rule in strip(annotation)[1]
    )


def _misfit(setting: Setting, annotation: Any, value: Any) -> str:
    """Return what a default should be and is not; types of a plugin's own are not looked into."""
    bare, metadata = strip(annotation)
    if get_origin(bare) in _UNION:
        troubles = [_misfit(setting, arm, value) for arm in get_args(bare)]
        fits = "" in troubles
        return _limit(metadata, value) if fits else next(filter(None, troubles))
    if get_origin(bare) is typing.Literal:
        return "" if value in get_args(bare) else f"must be one of {type_name(bare)}"
    if bare is type(None):
        return "" if value is None else "must be None"
    if value is None and bare not in (Any, object):
        return f"must be {type_name(bare)}, or the annotation {type_name(bare)} | None"
    allowed = _PLAIN.get(bare)
    if allowed is None:
        return ""
    if not isinstance(value, allowed) or (isinstance(value, bool) and bare is not bool):
        return f"must be {type_name(bare)}"
    return _limit(metadata, value)


def _limit(metadata: tuple[Any, ...], value: Any) -> str:
    if not isinstance(value, int | float):
        return ""
    for rule in metadata:
        for kind, name, sign, holds in _LIMITS:
            if isinstance(rule, kind) and not holds(value, getattr(rule, name)):
                return f"must be {sign} {getattr(rule, name)}"
    return ""


def _rules(signature: Signature) -> Iterator[str]:
    """Yield what is wrong with rules that name another port or a setting."""
    ports = [p.name for p in signature.ports]
    settings = [s.name for s in signature.settings]
    named: list[tuple[str, Quantity | Grid | None]] = [
        (f"port {p.name!r}", rule) for p in signature.ports for rule in (p.quantity, p.grid)
    ]
    named += [(f"setting {s.name!r}", s.quantity) for s in signature.settings]
    named += [("the return", r) for r in (signature.output_quantity, signature.output_grid)]
    for where, rule in named:
        if rule is None:
            continue
        what = f"the {type(rule).__name__} of {where} names"
        unknown = unknown_quantity(rule.names if isinstance(rule, Quantity) else ())
        if unknown:
            yield f"{where}: {unknown}"
        by_setting = signature.kind is Kind.SOURCE and isinstance(rule, Quantity)
        if by_setting and rule.port in settings:
            continue
        if rule.port and rule.port not in ports:
            hint = did_you_mean(rule.port, ports) or f"; ports: {one_of(ports)}"
            yield f"{what} {rule.port!r}, which is no port{hint}"
        finer = rule.finer_by if isinstance(rule, Grid) else 1
        if isinstance(finer, str) and finer not in settings:
            hint = did_you_mean(finer, settings) or f"; settings: {one_of(settings)}"
            yield f"{what} {finer!r}, which is no setting{hint}"


def _output(signature: Signature) -> Iterator[str]:
    output = signature.output
    if get_origin(output) in _UNION and type(None) in get_args(output):
        yield (
            f"it may return None ({type_name(output)}): where there is no answer, "
            "raise Degenerate with the reason"
        )
    if signature.kind is not Kind.SOURCE and _yields_frames(output):
        yield (
            "it promises frames, but is no generator function: "
            "yield them, or 'yield from' what has them"
        )

    yield from filter(None, map(_absent_column, _within(output)))


def _absent_column(kind: Any) -> str:
    """Return which field a dataclass says tables show and has not; of others only values tell."""
    of: Any = get_origin(kind) or kind
    there = None
    if dataclasses.is_dataclass(of) and not hasattr(of, "__getattr__"):
        there = [*dir(of), *(f.name for f in dataclasses.fields(of))]
    odd = odd_columns(of, there)
    return f"its answer {type_name(of)} {odd}" if odd else ""


def odd_columns(
    kind: Any, there: Collection[str] | None, has: Callable[[str], bool] = lambda _: False
) -> str:
    """Return what is wrong with the names that tables show of a type; "" where nothing is.

    Parameters
    ----------
    kind : type
        Of a value that a step gives.
    there : collection of str or None
        What such a value has; None where only the value tells.
    has : callable
        Whether it has a name that is not among these.

    Returns
    -------
    str
    """
    shown = getattr(kind, "columns_shown", ())
    if not isinstance(shown, Collection) or isinstance(shown, str):
        got = type(shown).__name__
        return f"has a {got} as its columns_shown: it must be a tuple of names, the class's own"
    if there is None:
        return ""
    absent = next((name for name in shown if name not in there and not has(name)), None)
    if absent is None:
        return ""
    return f"lacks {absent!r} of its columns_shown{did_you_mean(absent, there)}"


def _yields_frames(output: Any) -> bool:
    from tactile_graph.wires.frame import Frame

    origin = getattr(get_origin(output), "__name__", "")
    return origin in ("Iterator", "Generator") and get_args(output)[:1] == (Frame,)
