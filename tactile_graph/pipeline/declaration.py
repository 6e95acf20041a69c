"""What a pipeline file declares, checked for shape only: keys, kinds of values, names."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from decimal import Decimal
from math import inf
from typing import Any

from tactile_graph.errors import did_you_mean, key_typo, one_of, shown
from tactile_graph.pipeline.document import Document, Path

TOP_KEYS = (
    "pipeline", "about", "evolves", "source", "deadline_us", "isolated", "conditions", "nodes",
    "outputs",
)  # fmt: skip
NODE_KEYS = (
    "step", "use", "first_of", "in", "with", "free", "when", "each", "time_limit_s", "isolated",
    "about",
)  # fmt: skip
OF_STEPS = ("time_limit_s", "isolated")
"""Keys of nodes that run a step themselves."""
SOURCE_KEYS = ("step", "with")
RESERVED = ("frame", "and", "or", "not", "in", "is", "if", "else", "True", "False", "None")
MOST_NODES = 2_000
MEANT = {
    **dict.fromkeys(("input", "inputs", "from", "reads"), "in"),
    **dict.fromkeys(("setting", "settings", "params", "parameters", "options", "args"), "with"),
    **dict.fromkeys(("if", "condition", "only_if"), "when"),
    **dict.fromkeys(("for", "foreach", "for_each", "map"), "each"),
    **dict.fromkeys(("type", "function", "filter", "op"), "step"),
    **dict.fromkeys(("description", "comment", "note"), "about"),
    **dict.fromkeys(("steps", "graph"), "nodes"),
    "name": "pipeline",
}
"""What keys are called elsewhere -> what they are called here."""
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*\Z")
_REF = re.compile(r"[A-Za-z_][A-Za-z0-9_]*(\.[A-Za-z_][A-Za-z0-9_]*)*\Z")


@dataclass
class NodeDeclaration:
    """One node as the file has it."""

    name: str
    path: Path
    step: str | None = None
    use: str | None = None
    first_of: list[str] | None = None
    inputs: Any = None
    settings: dict[str, Any] = field(default_factory=dict)
    free: dict[str, list[Any]] = field(default_factory=dict)
    when: str | None = None
    each: bool = False
    time_limit_s: float | None = None
    isolated: bool | None = None


@dataclass
class Declaration:
    """A whole pipeline file as it stands, with the document it was read from."""

    document: Document
    name: str = ""
    about: str = ""
    evolves: str = ""
    source_step: str | None = None
    source_settings: dict[str, Any] = field(default_factory=dict)
    deadline_us: float | None = None
    isolated: list[str] = field(default_factory=list)
    conditions: dict[str, str] = field(default_factory=dict)
    nodes: dict[str, NodeDeclaration] = field(default_factory=dict)
    outputs: list[str] = field(default_factory=list)


def _number_typo(value: Any) -> str:
    """Return how a number is written that YAML 1.1 reads as a text: 2e4, or one in quotes."""
    try:
        number = float(value) if isinstance(value, str) else inf
    except ValueError:
        return ""
    if not 1e-9 < number < 1e15:
        return ""
    plain = f"{number:.12f}".rstrip("0").rstrip(".")
    mantissa, exponent = f"{Decimal(plain).normalize():e}".split("e")
    mantissa += "" if "." in mantissa else ".0"
    return f"; as a number YAML takes {plain} or {mantissa}e{exponent}"


def kind_of(value: Any) -> str:
    """Return what a person calls the kind of a YAML value."""
    kinds = {
        dict: "a mapping",
        list: "a list",
        str: "a text",
        bool: "a yes/no",
        type(None): "nothing",
    }
    kind = kinds.get(type(value))
    if kind is None:
        return shown(value)
    if value in ({}, [], ""):
        return f"an empty {kind.removeprefix('a ')}"
    return kind if value is None else f"{kind}: {shown(value)}"


def _key_hint(name: str, allowed: tuple[str, ...]) -> str:
    """Return what was meant by an unknown key, or else what is allowed."""
    hint = key_typo(name, allowed) or did_you_mean(name, allowed)
    if not hint and MEANT.get(name.lower()) in allowed:
        hint = f"; did you mean {MEANT[name.lower()]!r}?"
    if hint:
        return hint
    settings = f"; a setting stands under 'with': {{{name}: …}}" if "with" in allowed else ""
    return f"; allowed: {', '.join(allowed)}{settings}"


class _Declarer:
    def __init__(self, document: Document) -> None:
        self.document = document
        self.result = Declaration(document)
        self.named: frozenset[str] = frozenset()

    def problem(self, message: str, *path: str | int, key: bool = False) -> None:
        self.document.problem(message, *path, key=key)

    def keys(self, data: dict[str, Any], allowed: tuple[str, ...], path: Path, what: str) -> None:
        for name in data:
            if name not in allowed:
                hint = _key_hint(name, allowed)
                self.problem(f"{what}: unknown key {name!r}{hint}", *path, name, key=True)

    def text(self, data: dict[str, Any], key: str, *path: str | int, what: str) -> str:
        value = data.get(key)
        if value is None or isinstance(value, str):
            return value or ""
        if isinstance(value, int | float) and not isinstance(value, bool):
            return shown(value)
        hint = ""
        if isinstance(value, bool):
            hint = f"; to YAML {self.document.raw(*path, key)} is a yes/no: put it in quotes"
        self.problem(f"{what} must be a text, got {kind_of(value)}{hint}", *path, key)
        return ""

    def above_0(self, data: dict[str, Any], key: str, *path: str | int, what: str) -> float | None:
        value = data.get(key)
        if value is None:
            return None
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if number and 0 < value < inf:
            return float(value)
        told = f"got {kind_of(value)}{_number_typo(value)}"
        self.problem(f"{what} must be a number above 0, {told}", *path, key)
        return None

    def yes_or_no(self, data: dict[str, Any], key: str, path: Path, what: str) -> bool:
        value = data.get(key, False)
        if not isinstance(value, bool):
            text = f"{what}, {key!r} must be true or false, got {kind_of(value)}"
            self.problem(text, *path, key)
        return value is True

    def top(self) -> Declaration:
        data = self.document.data
        if not isinstance(data, dict):
            if not self.document.problems:
                self.problem(f"a pipeline file is a mapping, got {kind_of(data)}")
            return self.result
        self.keys(data, TOP_KEYS, (), "pipeline file")
        self.result.name = self.text(data, "pipeline", what="'pipeline'")
        if data.get("pipeline") in (None, ""):
            self.problem("'pipeline' is missing: every file names its pipeline", "pipeline")
        self.result.about = self.text(data, "about", what="'about'")
        self.result.evolves = self.text(data, "evolves", what="'evolves'")
        self.source(data.get("source"))
        self.result.deadline_us = self.above_0(data, "deadline_us", what="'deadline_us'")
        self.isolated(data.get("isolated"))
        self.conditions(data.get("conditions"))
        self.nodes(data.get("nodes"))
        self.outputs(data)
        return self.result

    def isolated(self, data: Any) -> None:
        if data is None:
            return
        wanted = "'isolated' must be a list of steps, or of plugins as plugin.*"
        if not isinstance(data, list):
            self.problem(f"{wanted}, got {kind_of(data)}", "isolated")
            return
        for i, name in enumerate(data):
            if isinstance(name, str) and name:
                self.result.isolated.append(name)
            else:
                self.problem(f"{wanted}, got {kind_of(name)}", "isolated", i)

    def source(self, data: Any) -> None:
        if data is None:
            return
        if not isinstance(data, dict):
            hint = f"; write {{step: {data}}}" if isinstance(data, str) else ""
            self.problem(
                f"'source' must be {{step: …, with: …}}, got {kind_of(data)}{hint}", "source"
            )
            return
        self.keys(data, SOURCE_KEYS, ("source",), "source")
        step = self.text(data, "step", "source", what="source, 'step'")
        if data.get("step") in (None, "") and not self.document.has_unread("source", "step"):
            self.problem("source: 'step' is missing", "source")
        self.result.source_step = step or None
        self.result.source_settings = self.mapping(data.get("with"), ("source", "with"), "source")

    def mapping(self, data: Any, path: Path, what: str) -> dict[str, Any]:
        if data is None:
            return {}
        if not isinstance(data, dict):
            self.problem(f"{what}: 'with' must be a mapping, got {kind_of(data)}", *path)
            return {}
        return data

    def conditions(self, data: Any) -> None:
        if data is None:
            return
        if not isinstance(data, dict):
            self.problem(f"'conditions' must be a mapping, got {kind_of(data)}", "conditions")
            return
        if len(data) > MOST_NODES:
            self.problem(f"{len(data)} conditions; allowed are {MOST_NODES}", "conditions")
            return
        for name, text in data.items():
            path = ("conditions", name)
            self.name(name, path, "condition")
            if isinstance(text, bool):
                text = self.document.spelled(*path)
            elif isinstance(text, int | float):
                text = shown(text)
            if not isinstance(text, str):
                self.problem(
                    f"condition {name!r} must be an expression, got {kind_of(text)}", *path
                )
                continue
            self.result.conditions[name] = text

    def name(self, name: str, path: Path, what: str) -> None:
        if not _NAME.match(name):
            self.problem(
                f"{what} name {name!r}: letters a to z, digits and '_' only, "
                "not starting with a digit",
                *path, key=True,
            )  # fmt: skip
        elif name in RESERVED:
            self.problem(f"{what} name {name!r} is reserved", *path, key=True)

    def nodes(self, data: Any) -> None:
        if not isinstance(data, dict) or not data:
            what = "is missing: it maps a name to each node" if data is None else (
                f"must be a mapping of nodes, got {kind_of(data)}")  # fmt: skip
            self.problem(f"'nodes' {what}", "nodes")
            return
        if len(data) > MOST_NODES:
            self.problem(f"{len(data)} nodes; allowed are {MOST_NODES}", "nodes")
            return
        self.named = frozenset(data)
        for name, body in data.items():
            path: Path = ("nodes", name)
            self.name(name, path, "node")
            if name == RESERVED[0]:
                continue  # or every node that reads the frame would be told the same
            if name in self.result.conditions:
                self.problem(f"{name!r} is both a node and a condition", *path, key=True)
            if isinstance(body, dict):
                self.result.nodes[name] = self.node(name, path, body)
            else:
                self.problem(f"node {name!r} must be a mapping, got {kind_of(body)}", *path)

    def node(self, name: str, path: Path, body: dict[str, Any]) -> NodeDeclaration:
        what = f"node {name!r}"
        node = NodeDeclaration(name, path)
        self.keys(body, NODE_KEYS, path, what)
        kinds = [k for k in ("step", "use", "first_of") if k in body]
        if len(kinds) != 1:
            got = " and ".join(repr(k) for k in kinds) or "none"
            self.problem(
                f"{what}: exactly one of 'step', 'use', 'first_of' is needed, got {got}", *path
            )
        node.step = self.text(body, "step", *path, what=f"{what}, 'step'") or None
        node.use = self.text(body, "use", *path, what=f"{what}, 'use'") or None
        for key in [k for k in ("step", "use", "when") if body.get(k, "x") in (None, "")]:
            if not self.document.has_unread(*path, key):
                self.problem(f"{what}: {key!r} is empty", *path, key, key=True)
        self.text(body, "about", *path, what=f"{what}, 'about'")
        if "first_of" in body:
            node.first_of = self.refs(body["first_of"], (*path, "first_of"), f"{what}, 'first_of'")
            for key in ("in", "with", "free", "each"):
                if key in body:
                    self.problem(
                        f"{what}: {key!r} makes no sense beside 'first_of'", *path, key, key=True
                    )
        node.inputs = self.inputs(body.get("in"), (*path, "in"), what)
        node.settings = self.mapping(body.get("with"), (*path, "with"), what)
        node.free = self.free(body.get("free"), (*path, "free"), what)
        when = body.get("when")
        given = {"when": self.document.spelled(*path, "when")} if isinstance(when, bool) else body
        node.when = self.text(given, "when", *path, what=f"{what}, 'when'") or None
        node.each = self.yes_or_no(body, "each", path, what)
        if body.get("isolated") is not None:
            node.isolated = self.yes_or_no(body, "isolated", path, what)
        limit = "time_limit_s"
        node.time_limit_s = self.above_0(body, limit, *path, what=f"{what}, {limit!r}")
        for key in OF_STEPS if "step" not in body else ():
            if key in body:
                text = f"{what}: {key!r} belongs to a node that has a 'step'"
                self.problem(text, *path, key, key=True)
        return node

    def free(self, data: Any, path: Path, what: str) -> dict[str, list[Any]]:
        if data is None:
            return {}
        wanted = "a mapping of settings to lists of the values they may take"
        if not isinstance(data, dict):
            self.problem(f"{what}: 'free' must be {wanted}, got {kind_of(data)}", *path)
            return {}
        for name, values in data.items():
            if not isinstance(values, list) or not values:
                text = f"{what}, 'free': {name!r} needs a list of the values it may take"
                self.problem(f"{text}, got {kind_of(values)}", *path, name)
        return {k: v for k, v in data.items() if isinstance(v, list) and v}

    def refs(self, data: Any, path: Path, what: str) -> list[str]:
        if not isinstance(data, list) or not data:
            self.problem(f"{what} must be a list of nodes, got {kind_of(data)}", *path)
            return []
        return [r for i, r in enumerate(data) if self.ref(r, (*path, i), what)]

    def ref(self, value: Any, path: Path, what: str) -> bool:
        if isinstance(value, str) and _REF.match(value):
            return True
        if isinstance(value, str) and value in self.named and "." not in value:
            return True  # what is wrong with the name is told where it is given
        hint = ""
        if isinstance(value, str) and "/" in value:
            hint = "; what is inside an embedded pipeline is to be seen by --only"
        self.problem(f"{what}: a node or node.field is needed, got {kind_of(value)}{hint}", *path)
        return False

    def inputs(self, data: Any, path: Path, what: str) -> Any:
        where = f"{what}, 'in'"
        if data is None:
            return None
        if isinstance(data, list):
            return self.refs(data, path, where)
        if isinstance(data, dict):
            result: dict[str, Any] = {}
            for port, value in data.items():
                if isinstance(value, list):
                    result[port] = self.refs(value, (*path, port), f"{where}, {port}")
                elif self.ref(value, (*path, port), f"{where}, {port}"):
                    result[port] = value
            return result
        return data if self.ref(data, path, where) else None

    def outputs(self, data: dict[str, Any]) -> None:
        if "outputs" not in data:
            self.problem(
                f"'outputs' is missing: a list of nodes out of {one_of(self.result.nodes)}"
            )
            return
        value = data["outputs"]
        value = [value] if isinstance(value, str) else value
        outputs = self.refs(value, ("outputs",), "'outputs'")
        for i, name in enumerate(outputs):
            if name in outputs[:i]:
                self.problem(f"output {name!r} is given twice", "outputs", i)
        self.result.outputs = list(dict.fromkeys(outputs))


def declare(document: Document) -> Declaration:
    """Return what the document declares; problems go to the document."""
    return _Declarer(document).top()
