"""Bind the ``in`` of a node to the ports of its step."""

from __future__ import annotations

from typing import Any

from tactile_graph.errors import did_you_mean, one_of
from tactile_graph.pipeline.declaration import NodeDeclaration
from tactile_graph.pipeline.graph import Binding
from tactile_graph.pipeline.resolution.scope import Scope
from tactile_graph.pipeline.wiring import Ref, fit, public_fields
from tactile_graph.steps.signature import Port, Signature, list_item, type_name

Wired = str | list[str]


def bind_inputs(
    scope: Scope, declared: NodeDeclaration, signature: Signature
) -> tuple[Binding, ...]:
    """Return what is wired to each port; what does not fit is reported in the scope."""
    wired = _by_port(scope, declared, signature)
    bindings: list[Binding] = []
    n_lists = 0
    for port in signature.ports:
        if port.name not in wired:
            if port.required:
                _missing(scope, declared, signature, port)
            continue
        path = ("in", port.name) if isinstance(declared.inputs, dict) else ("in",)
        binding, over_list = _bind(scope, declared, signature, port, wired[port.name], path)
        n_lists += over_list
        if binding is not None:
            bindings.append(binding)
    complete = len(bindings) == len(wired)
    if declared.each and not n_lists and complete:
        scope.problem(declared, ": 'each' needs a list on one of its ports", "each")
    return tuple(bindings)


def _missing(scope: Scope, declared: NodeDeclaration, signature: Signature, port: Port) -> None:
    scope.problem(
        declared,
        f": port {port.name!r} of step {signature.name!r} is not wired ({type_name(port.type)})",
        *(("in",) if declared.inputs is not None else ()),
    )


def _by_port(scope: Scope, declared: NodeDeclaration, signature: Signature) -> dict[str, Wired]:
    ports = signature.ports
    wired = declared.inputs
    names = [p.name for p in ports]
    if wired is None or wired == [] or wired == {}:
        return {}
    if not ports:
        scope.problem(declared, f": step {signature.name!r} has no ports", "in")
        return {}
    if isinstance(wired, dict):
        for name in [n for n in wired if n not in names]:
            hint = did_you_mean(name, names) or f"; ports: {one_of(names)}"
            text = f": step {signature.name!r} has no port {name!r}{hint}"
            scope.problem(declared, text, "in", name, key=True)
        return {n: w for n, w in wired.items() if n in names}
    if isinstance(wired, str):
        return {names[0]: wired}
    if ports[0].item is not None and (len(ports) == 1 or len(wired) > len(ports)):
        return {names[0]: wired}
    if len(wired) > len(ports):
        text = (
            f": {len(wired)} inputs for {len(ports)} port{'s' if len(ports) > 1 else ''} of "
            f"{signature.name!r} ({one_of(names)})"
        )
        scope.problem(declared, text, "in")
    return dict(zip(names, wired, strict=False))


def _bind(
    scope: Scope,
    declared: NodeDeclaration,
    signature: Signature,
    port: Port,
    wired: Wired,
    path: tuple[str, ...],
) -> tuple[Binding | None, bool]:
    """Return the binding, and whether the node runs once for each item of it."""
    texts = [wired] if isinstance(wired, str) else wired
    is_list = isinstance(declared.inputs, list) or isinstance(wired, list)
    refs: list[Ref] = []
    collects = isinstance(wired, list)
    over_list = False
    if collects and port.item is None:
        text = f": port {port.name!r} of {signature.name!r} takes one input, not a list"
        scope.problem(declared, text, *path)
        return None, False
    wanted = port.item if collects else port.type
    for i, text in enumerate(texts):
        place: tuple[str | int, ...] = (*path, i) if is_list and collects else path
        found = scope.ref(declared, text, *place)
        if found is None:
            return None, False
        ref, kind = found
        item = list_item(kind)
        fitted = fit(ref, kind, wanted)
        if fitted is None and declared.each and item is not None and not collects:
            fitted, over_list = fit(ref, list[item], list[wanted]), True  # type: ignore[valid-type]
        if fitted is None:
            scope.problem(declared, _misfit(signature, port, text, kind, wanted, item), *place)
            return None, over_list
        refs.append(fitted)
    return Binding(port, tuple(refs), collects, over_list), over_list


def _misfit(signature: Signature, port: Port, text: str, kind: Any, wanted: Any, item: Any) -> str:
    hint, fields = "", []
    if len(getattr(kind, "_fields", ())) > 0:
        fields = [n for n, k in public_fields(kind).items() if fit(Ref("x"), k, wanted)]
    if fields:  # before a list of nodes, into which a record fits where items may be anything
        hint = f"; try {text}.{fields[0]}"
    elif port.item is not None and fit(Ref("x"), kind, port.item) is not None:
        hint = f"; as a list of nodes it is [{text}]"
    elif item is not None and fit(Ref("x"), item, wanted) is not None:
        hint = "; add 'each: true' to run it for each item"
    return (
        f": {text!r} is {_article(type_name(kind))}, but port {port.name!r} of step "
        f"{signature.name!r} takes {_article(type_name(wanted))}{hint}"
    )


def _article(name: str) -> str:
    return f"an {name}" if name[:1] in "AEIOUaeiou" else f"a {name}"
