"""Records of the frames that are kept whole: every node's value, for every variant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires.frame import Frame
from tactile_graph.wires.image import Image, Mask


@dataclass(frozen=True, eq=False)
class NodeStory:
    """What a node of a variant came to in a kept frame.

    Parameters
    ----------
    node : str
        The variant's own name of it.
    merged : str
        Its name in the merged graph.
    state : str
        ``ran``, ``skipped``, ``failed`` or ``not asked``.
    reason : str
        Why it was skipped or failed, in the variant's own names; else empty.
    origin : str
        The variant's own node (or ``node.field``) where that began; else empty.
    time_us : float
    value : object
        What came out where it ran, else None.
    """

    node: str
    merged: str
    state: str
    reason: str
    origin: str
    time_us: float
    value: Any


@dataclass(frozen=True, eq=False)
class Choice:
    """Why a frame was kept: ``regular``, ``worst`` of a variant's quantity, ``no answer``, or
    ``apart``, where it lies farthest from a ``reference``.
    """

    why: str
    variant: str = ""
    quantity: str = ""
    error: float | None = None
    reference: str = ""

    def __str__(self) -> str:
        if self.why == "regular":
            return "one of every so many"
        if self.why == "no answer":
            return f"{self.variant} gave no {self.quantity}"
        if self.why == "apart":
            return f"{self.quantity} of {self.variant} farthest from {self.reference}"
        return f"worst {self.quantity} of {self.variant}"


@dataclass(frozen=True, eq=False)
class ChosenFrame:
    """A frame that is kept with the values of all nodes.

    Parameters
    ----------
    position : int
        Row of it in every array over frames.
    frame : Frame
    choices : tuple of Choice
        Why it was chosen; at least one.
    stories : mapping
        Label of each variant -> node's own name -> its story, in the order of the variant's file.
    errors : mapping
        Label -> quantity -> signed error in this frame (of the worst object), where it answered.
    """

    position: int
    frame: Frame
    choices: tuple[Choice, ...]
    stories: Mapping[str, Mapping[str, NodeStory]]
    errors: Mapping[str, Mapping[str, float]]

    def value(self, variant: str, node: str) -> Any:
        """Return what came out of a variant's node; None where it gave no value."""
        story = self.stories[variant].get(node)
        return None if story is None else story.value

    def difference(self, node: str, parent: str, child: str) -> DifferenceImage | None:
        """Return the difference of two variants' equally named node; None where there is none.

        Both must have come out as images or both as masks, on the same grid.
        """
        before, after = self.value(parent, node), self.value(child, node)
        if not _alike(before, after):
            return None
        off = np.asarray(after.values, dtype=np.float64) - np.asarray(before.values, np.float64)
        off.setflags(write=False)
        return DifferenceImage(self.position, node, before, after, off)


@dataclass(frozen=True, eq=False)
class DifferenceImage:
    """One node's image in two variants, and the child's less the parent's, cell by cell.

    ``values`` has the shape (rows, columns) of both; of masks it holds -1, 0 and 1.
    """

    position: int
    node: str
    before: Image | Mask
    after: Image | Mask
    values: NDArray[np.float64]

    @property
    def n_changed(self) -> int:
        """Cells that differ."""
        return int(np.count_nonzero(self.values))


def _alike(a: Any, b: Any) -> bool:
    both = isinstance(a, Image) and isinstance(b, Image) and a.quantity == b.quantity
    both = both or (isinstance(a, Mask) and isinstance(b, Mask))
    return bool(both and a.shape == b.shape and a.pitch_cm == b.pitch_cm
                and a.origin_cm == b.origin_cm)  # fmt: skip
