"""``Graph``: a resolved pipeline as a frozen record of its nodes and what is wired to them."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from functools import cached_property
from typing import Any

from tactile_graph.errors import Mark, UsageError
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.files_read import FilesRead
from tactile_graph.pipeline.plain import plain
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.own import bound
from tactile_graph.steps.rules import GridFact, Quantity
from tactile_graph.steps.signature import Kind, Port, Signature
from tactile_graph.vocabulary import QUANTITIES
from tactile_graph.wires.frame import Frame

FRAME = "frame"
Moved = Callable[[Ref], Ref]
"""Where a reference points in another graph."""


class NodeKind(Enum):
    """What a node does."""

    STEP = "step"
    FIRST_OF = "first_of"
    PASS = "pass"
    """Hands an embedded pipeline's output on."""
    MAP = "map"
    """Runs an embedded pipeline over the items of a list."""
    GIVEN = "given"
    """Of a pipeline run over a list: what is wired to it in place of a node of its own."""


@dataclass(frozen=True)
class Binding:
    """What is wired to a port: one reference, or several for a list port fed item by item.

    Where it ``iterates``, the wire carries a list and the step runs once for each item.
    """

    port: Port
    refs: tuple[Ref, ...]
    collects: bool = False
    iterates: bool = False


@dataclass(frozen=True)
class Facts:
    """What the loader knows of a node's image before the first frame.

    ``by_frame`` holds its quantity for each that frames may be in: "" where nobody knows it, and
    nothing where the node has no value then. ``views`` are the attributes through which the value
    is seen otherwise.
    """

    by_frame: Mapping[str, str] = field(default_factory=lambda: dict.fromkeys(QUANTITIES, ""))
    grid: GridFact | None = None
    views: tuple[str, ...] = ()


@dataclass(frozen=True)
class Isolation:
    """That a step runs in another process, and how long it may take there.

    Parameters
    ----------
    time_limit_s : float or None
        As long as it likes if None.
    process : str
        Nodes of the same name here share a process; of "" each has its own.
    """

    time_limit_s: float | None = None
    process: str = ""


@dataclass(frozen=True, eq=False)
class Node:
    """One node of a resolved graph."""

    name: str
    kind: NodeKind
    output: Any
    mark: Mark
    signature: Signature | None = None
    settings: dict[str, Any] = field(default_factory=dict)
    inputs: tuple[Binding, ...] = ()
    choices: tuple[Ref, ...] = ()
    guard: Guard | None = None
    each: bool = False
    inner: Graph | None = None
    facts: Facts = field(default_factory=Facts)
    key: str = ""
    callable: Callable[..., Any] | None = None
    isolation: Isolation | None = None

    @property
    def stateful(self) -> bool:
        """Whether the node keeps something from frame to frame."""
        return self.signature is not None and self.signature.stateful

    @property
    def keeps(self) -> bool:
        """Whether it keeps something from frame to frame: a state, or a process of its own."""
        return self.stateful or self.isolation is not None

    @property
    def is_sink(self) -> bool:
        """Whether the node gives no value: it writes, shows or sends."""
        return self.output is type(None) or (self.kind is NodeKind.STEP and self.output is None)

    @property
    def what(self) -> str:
        """Step, pipeline or choice, as tables show it."""
        if self.kind is NodeKind.FIRST_OF:
            return "first of " + ", ".join(str(c) for c in self.choices)
        if self.inner is not None:
            return f"each {self.inner.name}"
        if self.signature is None:
            return "pass"
        return ("each " if self.each else "") + self.signature.name

    def wires(self) -> list[Ref]:
        """Return every reference the node reads, guard first."""
        guard = list(self.guard.refs) if self.guard else []
        return guard + [r for b in self.inputs for r in b.refs] + list(self.choices)

    def rewired(self, name: str, moved: Moved) -> Node:
        """Return the node under another name, each of its references moved."""
        guard = self.guard
        if guard is not None:
            guard = replace(guard, refs=tuple(moved(r) for r in guard.refs))
        return replace(
            self,
            name=name,
            inputs=tuple(replace(b, refs=tuple(moved(r) for r in b.refs)) for b in self.inputs),
            choices=tuple(moved(c) for c in self.choices),
            guard=guard,
        )

    def bound(self, **injected: Any) -> Callable[..., Any]:
        """Return the callable of the ports, settings filled in; new state for a stateful step."""
        signature = self.signature
        assert signature is not None, f"{self.name} is no step"
        if signature.kind is not Kind.CLASS:
            return bound(signature.target, signature.arguments(self.settings))
        if self.callable is not None and not signature.stateful:
            return self.callable
        settings = signature.arguments(self.settings)
        made: Callable[..., Any] = signature.target(**settings, **injected)
        return made

    def resolved(self) -> dict[str, Any]:
        """Return the node as provenance keeps it, every setting spelled out."""
        data: dict[str, Any] = {}
        if self.kind is NodeKind.STEP and self.signature is not None:
            data["step"] = self.signature.name
        elif self.inner is not None:
            data["use"] = self.inner.resolved()
        if self.choices:
            data["first_of"] = [str(c) for c in self.choices]
        if self.inputs:
            data["in"] = {
                b.port.name: [str(r) for r in b.refs] if b.collects else str(b.refs[0])
                for b in self.inputs
            }
        if self.settings:
            data["with"] = plain(self.settings)
        if self.guard is not None:
            data["when"] = self.guard.text
        if self.each:
            data["each"] = True
        if self.isolation is not None:
            limit = self.isolation.time_limit_s
            data |= {"isolated": True} if limit is None else {"time_limit_s": limit}
        return data


def node_key(*parts: object) -> str:
    """Return a digest that is equal for nodes of equal step, settings, guard and inputs."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


@dataclass(frozen=True)
class FrameRule:
    """A demand on the frames themselves that is left to check when one comes.

    ``came`` holds what quantity they bring to the port, by their own; of others the node has no
    value. ``hint`` says what to do.
    """

    node: str
    port: str
    step: str
    came: Mapping[str, str]
    quantity: Quantity | None = None
    rows: int | None = None
    columns: int | None = None
    pitch_cm: float | None = None
    min_rows: int = 1
    min_columns: int = 1
    square_to: float | None = None
    setting: str = ""
    hint: str = ""


@dataclass(frozen=True)
class Source:
    """The source step a pipeline takes its frames from unless told otherwise."""

    signature: Signature
    settings: dict[str, Any]
    mark: Mark

    @property
    def name(self) -> str:
        """Name of the source step."""
        return self.signature.name

    @property
    def given(self) -> dict[str, Any]:
        """Those of its settings that are not the defaults."""
        defaults = {s.name: s.default for s in self.signature.settings}
        return {k: v for k, v in self.settings.items() if v is not defaults.get(k)}


@dataclass(frozen=True, eq=False)
class Graph:
    """A resolved, checked, frozen pipeline: plain data, which engine and drawings work on."""

    name: str
    about: str
    evolves: str
    source: Source | None
    nodes: Mapping[str, Node]
    outputs: Mapping[str, Ref]
    file: str
    text: str
    frame_rules: tuple[FrameRule, ...] = ()
    free: Mapping[str, tuple[Any, ...]] = field(default_factory=dict)
    """``node.setting`` -> the values it may take where a search chooses it."""
    overrides: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    source_override: tuple[str, dict[str, Any]] | None = None
    registry: Registry | None = None
    deadline_us: float | None = None
    """Within which a live run wants the result of a frame, from its arrival on."""
    files: FilesRead = field(default_factory=FilesRead.here)

    @cached_property
    def types(self) -> dict[str, Any]:
        """Type of each node's value."""
        return {FRAME: Frame, **{n: node.output for n, node in self.nodes.items()}}

    def ref(self, text: str) -> Ref:
        """Return the reference that ``node`` or ``node.field`` spells.

        Raises
        ------
        UsageError
            If there is no such node or field.
        """
        if text in self.types:
            return Ref(text)
        try:
            return resolve_reference(tuple(text.split(".")), self.types, [])[0]
        except ConditionError as error:
            raise UsageError(f"pipeline {self.name!r}: {error.message}") from None

    def type_of(self, ref: Ref) -> Any:
        """Return the type of the value at a reference."""
        return resolve_reference((ref.node, *ref.path), self.types, [])[1]

    @cached_property
    def key(self) -> str:
        """Digest that is equal for pipelines that compute the same."""
        return node_key([(k, self.nodes[r.node].key if r.node in self.nodes else r.node, r.path)
                         for k, r in self.outputs.items()])  # fmt: skip

    @property
    def writes(self) -> bool:
        """Whether a step is a sink: then a second run would write twice."""
        return any(node.is_sink for node in self.nodes.values())

    @cached_property
    def unused(self) -> list[str]:
        """Nodes that no output needs; they run only when asked for."""
        needed = self.needed(self.outputs.values())
        return [n for n in self.nodes if n not in needed and not self.nodes[n].is_sink]

    def needed(self, asked: Iterable[Ref]) -> set[str]:
        """Return the nodes that what is asked for may need."""
        needed: set[str] = set()
        waiting = [r.node for r in asked]
        while waiting:
            name = waiting.pop()
            if name not in needed and name in self.nodes:
                needed.add(name)
                waiting += [r.node for r in self.nodes[name].wires()]
        return needed

    def resolved(self) -> dict[str, Any]:
        """Return the graph as plain data with every setting spelled out, as provenance keeps it."""
        return {
            "pipeline": self.name,
            "source": None
            if self.source is None
            else {"step": self.source.name, "with": plain(self.source.settings)},
            **({} if self.deadline_us is None else {"deadline_us": self.deadline_us}),
            "nodes": {name: node.resolved() for name, node in self.nodes.items()},
            "outputs": {name: str(ref) for name, ref in self.outputs.items()},
        }
