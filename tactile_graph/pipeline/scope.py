"""``Scope``: what is known while a graph is being resolved."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tactile_graph.pipeline.node import FRAME, Facts, FrameRule, Node
from tactile_graph.wires import Frame


@dataclass
class Scope:
    """Names that may be referred to, with the types, facts and keys of their values."""

    types: dict[str, Any] = field(default_factory=lambda: {FRAME: Frame})
    facts: dict[str, Facts] = field(default_factory=dict)
    nodes: dict[str, Node] = field(default_factory=dict)
    keys: dict[str, str] = field(default_factory=lambda: {FRAME: FRAME})
    rules: list[FrameRule] = field(default_factory=list)

    def add(self, node: Node) -> None:
        """Enter a resolved node."""
        self.nodes[node.name] = node
        self.types[node.name] = node.output
        self.facts[node.name] = node.facts
        self.keys[node.name] = node.key
