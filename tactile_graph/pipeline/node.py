"""``Node``: one step (or choice, or embedded pipeline) of a resolved graph."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any

from tactile_graph.errors import Mark
from tactile_graph.pipeline.conditions import Guard
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps.rules import GridFact, Quantity
from tactile_graph.steps.signature import Kind, Port, Signature

if TYPE_CHECKING:
    from tactile_graph.pipeline.pipeline import Pipeline

FRAME = "frame"


class NodeKind(Enum):
    """What a node does."""

    STEP = "step"
    FIRST_OF = "first_of"
    PASS = "pass"
    """Hands an embedded pipeline's output on."""
    MAP = "map"
    """Runs an embedded pipeline over the items of a list."""


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

    ``quantity`` is the name of a quantity, or `FRAME` for "that of the frame", or "". With
    ``of_frame`` it is the frame's, whether the source names it or not: who runs the pipeline on
    other frames is told.
    """

    quantity: str = ""
    grid: GridFact | None = None
    of_frame: bool = False


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
    inner: Pipeline | None = None
    facts: Facts = Facts()
    key: str = ""
    callable: Callable[..., Any] | None = None

    @property
    def stateful(self) -> bool:
        """Whether the node keeps something from frame to frame."""
        return self.signature is not None and self.signature.stateful

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

    def bound(self, **injected: Any) -> Callable[..., Any]:
        """Return the callable of the ports, settings filled in; new state for a stateful step."""
        signature = self.signature
        assert signature is not None, f"{self.name} is no step"
        if signature.kind is not Kind.CLASS:
            settings = signature.arguments(self.settings)
            return partial(signature.target, **settings) if settings else signature.target
        if self.callable is not None and not signature.stateful:
            return self.callable
        made: Callable[..., Any] = signature.target(
            **signature.arguments(self.settings), **injected
        )
        return made


def node_key(*parts: object) -> str:
    """Return a digest that is equal for nodes of equal step, settings, guard and inputs."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


@dataclass(frozen=True)
class FrameRule:
    """A demand on the frames themselves that is left to check when one comes."""

    node: str
    port: str
    step: str
    quantity: Quantity | None = None
    rows: int | None = None
    columns: int | None = None
    pitch_cm: float | None = None
    min_rows: int = 1
    min_columns: int = 1
    setting: str = ""
