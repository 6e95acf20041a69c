"""``Scope``: what a graph is resolved from, what is known of it so far, where problems go."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from tactile_graph.errors import Mark
from tactile_graph.pipeline.conditions.conditions import Guard
from tactile_graph.pipeline.declaration import Declaration, NodeDeclaration
from tactile_graph.pipeline.document import Document
from tactile_graph.pipeline.files_read import FilesRead
from tactile_graph.pipeline.graph import FRAME, Facts, FrameRule, Graph, Node
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import UNKNOWN, Ref, when_known
from tactile_graph.plugins.registry import Registry
from tactile_graph.vocabulary import QUANTITIES
from tactile_graph.wires import Frame

Overrides = Mapping[str, Mapping[str, Any]]
"""Node name -> settings that replace the file's."""

Loader = Callable[[str, Overrides], Graph]
"""Loads the pipeline a ``use`` names, with overrides for its nodes."""


@dataclass
class Scope:
    """One declaration under way to a graph; its problems go to its document.

    Parameters
    ----------
    declaration : Declaration
    registry : Registry
    load : Loader
        For ``use``.
    overrides : mapping
        Node name -> settings from outside (``--set``, ``with_settings``, ``use … with``).
    files : FilesRead

    Attributes
    ----------
    types, facts, keys, nodes : dict
        By the names that may be referred to: type, facts and key of each value, and its node.
    frames : tuple of str
        Quantities that the source's frames may be in.
    free : dict
        ``node.setting`` -> the values it may take where a search chooses it.
    """

    declaration: Declaration
    registry: Registry
    load: Loader
    overrides: Overrides
    files: FilesRead
    types: dict[str, Any] = field(default_factory=lambda: {FRAME: Frame}, init=False)
    facts: dict[str, Facts] = field(default_factory=dict, init=False)
    nodes: dict[str, Node] = field(default_factory=dict, init=False)
    keys: dict[str, str] = field(default_factory=lambda: {FRAME: FRAME}, init=False)
    frames: tuple[str, ...] = field(default_factory=lambda: tuple(QUANTITIES), init=False)
    rules: list[FrameRule] = field(default_factory=list, init=False)
    free: dict[str, tuple[Any, ...]] = field(default_factory=dict, init=False)
    condition_errors: list[tuple[NodeDeclaration, ConditionError]] = field(
        default_factory=list, init=False
    )

    @property
    def document(self) -> Document:
        """The file, and what is wrong with it."""
        return self.declaration.document

    @property
    def place(self) -> str:
        """The file's path that means the same from any folder."""
        return self.files.place(self.document.file)

    def add(self, node: Node) -> None:
        """Enter a resolved node."""
        self.nodes[node.name] = node
        self.types[node.name] = node.output
        self.facts[node.name] = node.facts
        self.keys[node.name] = node.key

    def add_unknown(self, name: str) -> None:
        """Enter a node whose own problems have been reported: it fits everywhere."""
        self.types[name] = UNKNOWN

    def problem(
        self, node: NodeDeclaration, message: str, *path: str | int, key: bool = False
    ) -> None:
        """Note what is wrong with a node, at a place within it."""
        joint = "" if message[:1] in ",:" else ": "
        self.document.problem(f"node {node.name!r}{joint}{message}", *node.path, *path, key=key)

    def mark(self, declared: NodeDeclaration) -> Mark:
        """Return where the file names the node."""
        return self.document.mark(*declared.path, key=True)

    def given(self, declared: NodeDeclaration) -> dict[str, Any]:
        """Return the settings that the file spells out for a node, or who overrides it."""
        return {**declared.settings, **self.overrides.get(declared.name, {})}

    def ref(self, declared: NodeDeclaration, text: str, *path: str | int) -> tuple[Ref, Any] | None:
        """Return reference and type for ``node.field``, or report what is wrong with it."""
        try:
            known = list(self.declaration.nodes)
            ref, kind = resolve_reference(tuple(text.split(".")), self.types, known)
            return ref, when_known(kind) if ref.path else kind
        except ConditionError as error:
            self.problem(declared, f": {error.message}", *path)
            return None

    def ref_key(self, ref: Ref) -> tuple[object, ...]:
        """Return what makes two references equal."""
        return (self.keys.get(ref.node, ref.node), ref.path, ref.item_path)

    def guard_key(self, guard: Guard | None) -> object:
        """Return what makes two guards equal."""
        return None if guard is None else (guard.meaning, [self.ref_key(r) for r in guard.refs])
