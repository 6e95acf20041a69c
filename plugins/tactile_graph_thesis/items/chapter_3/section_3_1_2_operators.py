"""Section 3.1.2: edge operators and the boundary scan against each other."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tactile_graph import Degenerate, Mask, Points, load
from tactile_graph.wires import Image
from tactile_graph_fitters.circle.fit_circle import fit_circle
from tactile_graph_hull.boundary_scan import boundary_scan
from tactile_graph_hull.digital_gradient import digital_gradient
from tactile_graph_hull.partial_differences import partial_differences
from tactile_graph_hull.sobel import sobel
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.measure.shown_reading import DISCS, readings_of, true_shape
from tactile_graph_thesis.work import Work

LITTLE = 0.25
"""Share by which the radius error of one operator may be above the least that differs little."""


def _points(image: Image, of: float = 0.0) -> Points:
    rows, columns = np.nonzero(np.abs(image.values) > of)
    return Points(np.column_stack([image.x_cm[columns], image.y_cm[rows]]))


def _both(mask: Mask) -> Points:
    """Return where either partial difference is not 0."""
    one, other = partial_differences(mask)
    return _points(one.with_values(np.abs(one.values) + np.abs(other.values)))


OPERATORS: dict[str, Callable[[Mask], Points]] = {
    "boundary scan": boundary_scan,
    "partial differences": _both,
    "digital gradient": lambda mask: _points(digital_gradient(mask)),
    "Sobel": lambda mask: _points(sobel(mask)),
    "Sobel, above half": lambda mask: _points(sobel(mask), 0.25),
}
"""Each gives the points a circle is fitted to; Sobel's largest value is half a unit a cell."""


def _operators(work: Work) -> Made:
    run = load("circle-1").runner(["dilated"], seed=work.seed)
    errors: dict[str, list[tuple[float, float]]] = {name: [] for name in OPERATORS}
    for disc in DISCS:
        for frame in readings_of(work, "discs", disc):
            mask, true = run(frame).get("dilated"), true_shape(frame)
            if mask is None:
                continue
            for name, operator in OPERATORS.items():
                try:
                    found = fit_circle(operator(mask))
                except Degenerate:
                    continue
                centre = float(np.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
                errors[name].append((centre, abs(found.radius_cm - true.radius_cm)))
    means = {name: np.mean(some, axis=0) for name, some in errors.items()}
    groups = {name: {"centre": float(m[0]), "radius": float(m[1])} for name, m in means.items()}
    rows = [(name, *of.values(), len(errors[name])) for name, of in groups.items()]
    return Made(
        findings=(little_between({name: of["radius"] for name, of in groups.items()}),),
        table=Table(("operator", "centre_cm", "radius_cm", "readings"), rows),
        figure=bars(groups, "mean error / cm", "A circle fitted to what each operator finds"),
    )


def little_between(error_cm: dict[str, float]) -> Finding:
    """Return whether operators err about alike.

    Parameters
    ----------
    error_cm : dict
        Operator -> mean error of the radius.
    """
    words = ", ".join(f"{name} {value:.2f}" for name, value in error_cm.items())
    least, most = min(error_cm.values()), max(error_cm.values())
    return Finding(
        "there is little difference between the performances of the operators",
        f"mean error of the radius, cm: {words}",
        f"one that errs {100 * LITTLE:.0f} % more than the best",
        most < (1.0 + LITTLE) * least,
    )


ITEMS = (
    Item(
        "boundary-operators",
        "Edge operators against each other",
        "Errors of a circle fitted to the points that each operator finds on the dilated image of "
        "circle-1.",
        _operators,
        "Edge operators find cells on both sides of an edge, so their points lie half a cell or a "
        "whole one further out than those of the scan: that makes up for part of what erosion "
        "and voids take away.",
        after="3.1.2",
    ),
)
