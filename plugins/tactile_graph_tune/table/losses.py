"""What an answer costs in error, and what none does."""

from __future__ import annotations

import math
from typing import Any

from tactile_graph import Pipeline
from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.score.answers import answers_of
from tactile_graph_compare.score.quantities import in_order
from tactile_graph_compare.score.scoring import GATE_CM, Scorer

PRICES = {"cm": GATE_CM, "°": 45.0, "cm²": 50.0}
"""Unit -> what no answer, and one where nothing lies, counts; 1 for those without a unit."""


class LossOf:
    """Tells what the answer at one reference costs, frame by frame.

    Parameters
    ----------
    pipeline : Pipeline
    name : str
        Node or ``node.field`` that answers.
    quantity : str
    price : float
    """

    def __init__(self, pipeline: Pipeline, name: str, quantity: str, price: float) -> None:
        self._scorer = Scorer(answers_of(pipeline, (name,)))
        self._quantity = quantity
        self._price = price
        self._n = 0

    def __call__(self, frame: Frame, outcomes: Any) -> float:
        """Return the error, at most the price; NaN where the truth says nothing of the quantity."""
        if frame.truth is None:
            return math.nan
        before = self._extra()
        worst = self._scorer.add(self._n, frame, outcomes)
        self._n += 1
        if not frame.truth:
            return self._price if self._extra() > before else 0.0
        if self._quantity not in worst:
            return math.nan
        error = abs(worst[self._quantity])
        return self._price if math.isnan(error) else min(error, self._price)

    def _extra(self) -> int:
        return sum(e.n_extra for e in self._scorer.errors.values())


def quantity_of(pipeline: Pipeline, answer: str, asked: str | None) -> tuple[str, str]:
    """Return the quantity whose error counts, and its unit.

    Raises
    ------
    UsageError
        If the output answers nothing that could be held against a truth, or not that.
    """
    answers = answers_of(pipeline, (answer,))
    known = in_order(answers.quantities)
    if not known:
        raise UsageError(f"output {answer!r}: no truth says how right it is")
    if asked is not None and asked not in known:
        hint = did_you_mean(asked, known)
        raise UsageError(f"--error {asked}: {answer!r} has {one_of(list(known))}{hint}")
    quantity = asked or known[0]
    return quantity, answers.units[quantity]
