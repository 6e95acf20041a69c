"""Section 3.1.3: what dilation, erosion and a skeleton do to an image with noise points."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tactile_graph import Mask
from tactile_graph_filters.morphology.dilate import Dilate
from tactile_graph_filters.morphology.erode import Erode
from tactile_graph_filters.morphology.skeleton import skeleton
from tactile_graph_thesis.drawing.panels import draw_mask, finish, panels
from tactile_graph_thesis.item import Finding, Item, Made, Table
from tactile_graph_thesis.work import Work

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SIDE, RADIUS, PITCH_CM = 16, 5.2, 1.3
NOISE_CELLS = ((1, 2), (2, 13), (13, 1), (14, 14), (8, 15))
"""Row and column of lone cells that are switched on beside a disc."""
ROUNDS = 4


class Shaped(NamedTuple):
    """A disc with lone noise cells, and what the operations make of it.

    Parameters
    ----------
    clean, noisy : Mask
        Without and with the noise cells.
    eroded, dilated, stick : Mask
        The noisy image after each operation alone.
    opened : tuple of Mask
        After erosion and dilation, once, twice and so on.
    """

    clean: Mask
    noisy: Mask
    eroded: Mask
    dilated: Mask
    stick: Mask
    opened: tuple[Mask, ...]

    @property
    def noise_left(self) -> int:
        """How many of the noise cells are on after one erosion and dilation."""
        return sum(bool(self.opened[0].values[cell]) for cell in NOISE_CELLS)


def shaped() -> Shaped:
    """Return a disc of 16 by 16 cells with noise after each operation, by structuring element 1."""
    rows, columns = np.indices((SIDE, SIDE)) + 0.5
    disc = np.hypot(rows - SIDE / 2, columns - SIDE / 2) <= RADIUS
    dirty = disc.copy()
    for cell in NOISE_CELLS:
        dirty[cell] = True
    erode, dilate = Erode(element="cross3"), Dilate(element="cross3")
    clean, noisy = Mask(disc, (PITCH_CM, PITCH_CM)), Mask(dirty, (PITCH_CM, PITCH_CM))
    opened = [dilate(erode(noisy))]
    while len(opened) < ROUNDS:
        opened.append(dilate(erode(opened[-1])))
    return Shaped(clean, noisy, erode(noisy), dilate(noisy), skeleton(noisy), tuple(opened))


def _morphology(work: Work) -> Made:
    found = work.once("morphology", shaped)
    masks = {
        "as read": found.noisy,
        "eroded": found.eroded,
        "eroded, then dilated": found.opened[0],
        "dilated": found.dilated,
        "skeleton": found.stick,
    }
    return Made(
        findings=(shrinks(found), takes_noise_away(found), saturates(found)),
        table=Table(("image", "cells"), [(name, mask.count) for name, mask in masks.items()]),
        figure=_figure(masks),
    )


def shrinks(found: Shaped) -> Finding:
    """Return whether erosion shrinks, dilation expands and a skeleton is thin.

    Parameters
    ----------
    found : Shaped
    """
    before, thick = found.noisy.count, thick_cells(found.stick)
    return Finding(
        "erosion shrinks the image, dilation expands it, a skeleton is a stick figure",
        f"of {before} cells {found.eroded.count} after erosion, {found.dilated.count} after "
        f"dilation, {found.stick.count} in the skeleton, {thick} squares of four on cells there",
        "no fewer cells after erosion, no more after dilation, or a square of four in the skeleton",
        found.eroded.count < before < found.dilated.count and thick == 0,
    )


def thick_cells(mask: Mask) -> int:
    """Return how many squares of four neighbours are on, which a stick figure has none of.

    Parameters
    ----------
    mask : Mask
    """
    on = mask.values
    return int((on[1:, 1:] & on[:-1, 1:] & on[1:, :-1] & on[:-1, :-1]).sum())


def takes_noise_away(found: Shaped) -> Finding:
    """Return whether erosion takes noise and object points, and dilation gives the latter back.

    Parameters
    ----------
    found : Shaped
    """
    whole = found.clean.count
    eroded, opened = (
        int((m.values & found.clean.values).sum()) for m in (found.eroded, found.opened[0])
    )
    return Finding(
        "erosion takes noise points away and points of the object too, dilation gives these back",
        f"{found.noise_left} of {len(NOISE_CELLS)} noise cells are left; of the object's {whole} "
        f"cells {eroded} after erosion, {opened} after dilation",
        "a noise cell left, or less than nine tenths of the object after dilation",
        found.noise_left == 0 and eroded < whole and opened >= 0.9 * whole,
    )


def saturates(found: Shaped) -> Finding:
    """Return whether repeating erosion and dilation soon changes nothing.

    Parameters
    ----------
    found : Shaped
    """
    counts = [mask.count for mask in found.opened]
    still = all(bool((a.values == found.opened[0].values).all()) for a in found.opened[1:])
    return Finding(
        "repeated, the operation soon changes nothing any more",
        f"cells after {len(counts)} rounds: {', '.join(map(str, counts))}",
        "an image that a second round changes",
        still,
    )


def _figure(masks: dict[str, Mask]) -> Figure:
    figure, axes = panels(len(masks), panel_in=2.4)
    for one, mask in zip(axes, masks.values(), strict=True):
        draw_mask(one, mask)
    return finish(figure, axes, [f"{name}, {m.count} cells" for name, m in masks.items()])


ITEMS = (
    Item(
        "morphology",
        "Erosion, dilation, skeleton",
        "A disc with lone noise cells after each operation, by structuring element #1.",
        _morphology,
        "A drawn disc, not a reading: what the operations do by themselves is to be seen.",
        after="3.1.3",
    ),
)
