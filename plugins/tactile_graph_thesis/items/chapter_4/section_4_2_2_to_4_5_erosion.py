"""Sections 4.2.2, 4.3.9 and 4.5: when erosion erases an image, and when it pays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Frame, load
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_thesis.drawing.bars import bars
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.items.chapter_4.figures_4_22_to_4_28_rectangles import with_strays
from tactile_graph_thesis.measure.rectangles import signed_errors
from tactile_graph_thesis.measure.shown_reading import DISCS, RECTANGLES, readings_of, setting
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
WAYS = {"3 × 3": "square3", "21 × 21": "square21"}
"""Elements by which section 4.3.9 erodes without its pre-filter."""
READINGS = 100
"""Of each rectangle, at most, for section 4.5."""
SEVERE_CM = 3.0
"""Error of the length from which a reading is severely affected by noise."""
DRAMATIC, ALIKE = 0.5, 0.3
"""Share of the error that is left after a dramatic improvement; change of one that is the same."""


# -- section 4.2.2 ---------------------------------------------------------------------------


def _erased_discs(work: Work) -> Made:
    second = setting("circle-2", "eroded", "element")
    elements = {"#1": setting("circle-1", "eroded", "element"), "#2": second}
    shares = {name: dict.fromkeys(elements, 0.0) for name in DISCS}
    run = load("circle-1").runner(["footprint"], seed=work.seed)
    for name in DISCS:
        masks = [run(frame)["footprint"] for frame in readings_of(work, "discs", name)]
        for title, element in elements.items():
            erode = Erode(element=element)
            shares[name][title] = float(np.mean([erode(mask).count == 0 for mask in masks]))
    return _blanks(shares, erases_some({n: of["#2"] for n, of in shares.items()}), "discs")


def erases_some(shares: dict[str, float]) -> Finding:
    """Return whether some images are blank after erosion.

    Parameters
    ----------
    shares : dict
        Object -> share of its readings that are.
    """
    words = ", ".join(f"{100 * share:.0f} % of {name}" for name, share in shares.items())
    return Finding(
        "in some cases eroding the image of 16 × 16 by element #2 results in a blank picture",
        f"blank: {words}",
        "not one blank picture",
        max(shares.values()) > 0.0,
    )


def _blanks(shares: dict[str, dict[str, float]], finding: Finding, what: str) -> Made:
    percent = {n: {w: 100.0 * s for w, s in of.items()} for n, of in shares.items()}
    columns = ("object", *(f"{w}_percent" for w in next(iter(shares.values()))))
    return Made(
        findings=(finding,),
        table=Table(columns, [(n, *of.values()) for n, of in percent.items()]),
        figure=bars(percent, "readings left blank / %", f"Blank after erosion: {what}"),
    )


# -- section 4.3.9 ---------------------------------------------------------------------------


def _erased_rectangles(work: Work) -> Made:
    run = load("rectangle-2").runner(["rotated"], seed=work.seed)
    shares: dict[str, dict[str, float]] = {}
    for name in RECTANGLES:
        masks = [run(frame)["rotated"] for frame in readings_of(work, "rectangles", name)]
        shares[name] = {
            title: float(np.mean([Erode(element=element)(mask).count == 0 for mask in masks]))
            for title, element in WAYS.items()
        }
    worst = {title: max(of[title] for of in shares.values()) for title in WAYS}
    return _blanks(shares, disappears(worst), "rectangles without the pre-filter")


def disappears(worst: dict[str, float]) -> Finding:
    """Return whether a small element already erases some images.

    Parameters
    ----------
    worst : dict
        Element -> largest share of an object's readings that it leaves blank.
    """
    words = ", ".join(f"{100 * share:.0f} % by {title}" for title, share in worst.items())
    return Finding(
        "without the pre-filter erosion makes the entire image disappear in some cases, even with "
        "an element of 3 × 3",
        f"blank of the worse rectangle: {words}",
        "not one image that 3 × 3 makes disappear",
        next(iter(worst.values())) > 0.0,
    )


# -- section 4.5 -----------------------------------------------------------------------------


def _noisy_rectangles(work: Work) -> Made:
    frames = work.frames("rectangles", 2 * work.readings)[: 2 * READINGS]
    noisy = [with_strays(frame, work.seed + k) for k, frame in enumerate(frames)]
    errors = [_lengths(name, noisy, work.seed) for name in ("rectangle-1", "rectangle-2")]
    severe = errors[0] > SEVERE_CM
    groups = {
        words: {
            name: _mean(e[some])
            for name, e in zip(("rectangle-1", "rectangle-2"), errors, strict=True)
        }
        for words, some in (("severely affected", severe), ("other cases", ~severe))
    }
    columns = ("readings", "rectangle-1_cm", "rectangle-2_cm")
    return Made(
        findings=(dramatic_on_noisy(*errors),),
        table=Table(columns, [(words, *of.values()) for words, of in groups.items()]),
        figure=bars(groups, "mean error of the length / cm", "With noise points switched on"),
        notes=(f"{int(severe.sum())} of {len(severe)} readings are severely affected.",),
    )


def _lengths(name: str, frames: list[Frame], seed: int) -> Array:
    found = signed_errors(load(name).runner(seed=seed), frames)
    return np.concatenate([np.abs(found[o][:, 1]) for o in RECTANGLES])


def _mean(values: Array) -> float:
    good = values[np.isfinite(values)]
    return float(good.mean()) if len(good) else 0.0


def dramatic_on_noisy(before_cm: Array, after_cm: Array) -> Finding:
    """Return whether a second way betters the readings noise spoils, and leaves others alone.

    Parameters
    ----------
    before_cm, after_cm : ndarray, shape (readings,)
        Errors of the length on the same readings; NaN without an answer.
    """
    both = np.isfinite(before_cm) & np.isfinite(after_cm)
    before, after = before_cm[both], after_cm[both]
    severe = before > SEVERE_CM
    (bad, less), (usual, then) = (
        (_mean(before[some]), _mean(after[some])) for some in (severe, ~severe)
    )
    return Finding(
        "morphology is a dramatic improvement in cases severely affected by noise, and performs "
        "almost the same otherwise",
        f"mean error of the length {bad:.2f} cm before, {less:.2f} cm after where it was above "
        f"{SEVERE_CM:g} cm ({int(severe.sum())} of {len(severe)} readings); {usual:.2f} and "
        f"{then:.2f} cm in the others",
        f"{100 * DRAMATIC:.0f} % of the error or more left where noise is severe, a change by "
        f"{100 * ALIKE:.0f} % elsewhere, or no such cases",
        bool(severe.any() and less < DRAMATIC * bad and abs(then - usual) < ALIKE * usual),
    )


ITEMS = (
    Item(
        "erased-discs",
        "Element #2 on whole elements",
        "Share of the readings of each disc that erosion leaves blank, on the image of 16 × 16.",
        _erased_discs,
        "The thesis' drawing of element #2 is lost; the digital disc of five cells stands for it.",
        after="4.2.2",
    ),
    Item(
        "erased-rectangles",
        "Erosion without the pre-filter",
        "Share of the readings of each rectangle, turned and rounded, that erosion leaves blank.",
        _erased_rectangles,
        "",
        after="4.3.9",
    ),
    Item(
        "noisy-rectangles",
        "Morphology on noisy rectangles",
        "Length errors of rectangle-1 and rectangle-2 with noise points switched on, where the "
        "first errs much and where it does not.",
        _noisy_rectangles,
        "Which readings are severely affected is told by the error of the first algorithm itself: "
        "an independent second way would regress to its mean there too.",
        after="4.5",
    ),
)
