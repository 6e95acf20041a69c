"""Ablations of a pipeline: each lacks one guard, or the first choices of a ``first_of``."""

from __future__ import annotations

from dataclasses import dataclass, replace

from tactile_graph import Pipeline
from tactile_graph.inspect import Node, NodeKind


@dataclass(frozen=True, eq=False)
class Ablation:
    """A pipeline in which one guard always holds, or one hand-over has happened."""

    node: str
    kind: str
    text: str
    pipeline: Pipeline

    @property
    def label(self) -> str:
        """What it is called among the variants."""
        return f"{self.node} {self.kind} {self.text}"


def ablations_of(pipeline: Pipeline) -> list[Ablation]:
    """Return an ablation for each guard and each hand-over that something asked for may meet."""
    unused = set(pipeline.unused)
    found = []
    for name, node in pipeline.nodes.items():
        if name in unused:
            continue
        if node.guard is not None:
            changed = _with(pipeline, replace(node, guard=None))
            found.append(Ablation(name, "when", node.guard.text, changed))
        if node.kind is NodeKind.FIRST_OF:
            for i in range(1, len(node.choices)):
                left = ", ".join(map(str, node.choices[:i]))
                changed = _with(pipeline, replace(node, choices=node.choices[i:]))
                found.append(Ablation(name, "first_of", f"without {left}", changed))
    return found


def _with(pipeline: Pipeline, node: Node) -> Pipeline:
    return replace(pipeline, nodes={**pipeline.nodes, node.name: node})
