"""``Case``: one input, and what is known about the right answer to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from tactile_graph.wires import Image, Mask, Points
from tactile_graph_stress.affine import Affine
from tactile_graph_stress.similarity import Similarity

Given = Points | Mask | Image

GROUPS = (
    "scale", "offset", "turn", "order", "twice", "arc", "aspect", "line", "near line",
    "few", "float32", "size", "cells", "truth", "NaN", "empty",
)  # fmt: skip
"""The columns of the report, in order; groups of plugins' own stand behind them."""


@dataclass(frozen=True)
class Case:
    """One input.

    Parameters
    ----------
    group : str
        One of `GROUPS`, or another.
    name : str
        What is special, in a few words.
    given : Points, Mask or Image
    base : Points, Mask or Image, optional
        The plain input of which this one is ``law`` of.
    law : Similarity or Affine, optional
        What the answer must have gone through if the base's answer goes through it.
    settings : mapping
        Of the step, for this input.
    must_refuse : bool
        Whether any answer is wrong.
    facts : mapping
        What a reference needs to know besides.
    """

    group: str
    name: str
    given: Given
    base: Given | None = None
    law: Similarity | Affine | None = None
    settings: Mapping[str, Any] = field(default_factory=dict)
    must_refuse: bool = False
    facts: Mapping[str, Any] = field(default_factory=dict)
