"""What one pipeline of a lineage changed against the one it evolved from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tactile_graph_compare.records.frames import DifferenceImage
from tactile_graph_compare.records.scores import Difference, TimeDifference


@dataclass(frozen=True)
class SettingChange:
    """What of a node is another: a setting by its name, or ``step``, ``in``, ``when`` …"""

    what: str
    before: Any
    after: Any

    def __str__(self) -> str:
        return f"{self.what}: {_word(self.before)} -> {_word(self.after)}"


def _word(value: Any) -> str:
    """Return a value as a pipeline file has it; ``none`` where it has none."""
    if value is None:
        return "none"
    return str(value).lower() if isinstance(value, bool) else str(value)


@dataclass(frozen=True)
class NodeChange:
    """A node that parent and child both have by name, and what differs."""

    node: str
    changes: tuple[SettingChange, ...]


@dataclass(frozen=True, eq=False)
class Evolution:
    """One step of the lineage: what the child did to its parent, and what that did.

    ``added``, ``removed`` and ``kept`` are node names; ``kept`` nodes are the same in themselves,
    though what they read may have changed. ``images`` are the difference images of the chosen
    frames, where the two differ.
    """

    parent: str
    child: str
    added: tuple[str, ...]
    removed: tuple[str, ...]
    changed: tuple[NodeChange, ...]
    kept: tuple[str, ...]
    differences: tuple[Difference, ...]
    time: TimeDifference
    images: tuple[DifferenceImage, ...]
