"""Step ``split_contacts``: one contact for each object, touching or torn apart by voids."""

from __future__ import annotations

from math import inf
from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Gt, Le, MinLen
from numpy.typing import NDArray

from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.at_rest import counts_the_offset
from tactile_graph_filters.contacts.contacts import Contacts
from tactile_graph_filters.contacts.labelled import contacts_of
from tactile_graph_filters.nan import require_summable
from tactile_graph_filters.parting.basins import basins, taps_of
from tactile_graph_filters.parting.joined_basins import joined
from tactile_graph_filters.parting.object_scale import Cells, split_by_scale
from tactile_graph_filters.parting.partition import Partition
from tactile_graph_filters.parting.straight_cuts import joined_and_cut

MIN_CELLS, MIN_ALONE = 4, 3
"""Cells of a contact; and where they lie side by side, and nothing else near."""


class SplitContacts:
    """Tell the objects in a footprint apart by how well each fills its own convex hull.

    The readings are smoothed and cut into the basins of their peaks (a watershed). Basins are
    then joined while that lowers an energy: what each object lacks in its hull, and a price for
    every cut between cells in contact. Voids inside an object are forgiven, gaps between objects
    are not; a neck is cheap to cut, a wide disc is not, and small pieces that voids have torn off
    are joined again.

    Then the result is looked at again: pairs of groups that are likely one object are joined,
    and a group is cut along the straight line that most likely parts two objects. How likely,
    says a logistic regression on the hulls before and after, the notches and weak cells a cut
    explains, its length, its readings, and the shape of the pieces.

    Parameters
    ----------
    voids : float
        Misfit that each cell inside an object is forgiven, where a void costs 1: about twice the
        share of elements that make no contact, as many make hardly any. Higher: fewer objects.
    hold : float
        Price of a cut between two cells in contact, where a void costs 1. Higher: fewer objects.
    weak : float
        A cell counts as partly void below this share of its object's mean reading.
    usual_cells : float
        Objects of fewer cells are doubted, the more the smaller they are.
    min_cells : int or 'auto'
        Smaller contacts are left out in the end. ``auto`` is 4, or 3 side by side with no other
        contact within two cells: those are neither chance nor a piece of an object.
    smooth_cells : tuple of float
        Standard deviations, in cells, of the smoothing before the cut into basins. Each is
        tried; the one that ends in the lowest energy is taken.
    margin : int
        How many more cells each contact's own image and mask have on each side.
    recut : bool
        Whether to look again at what the basins have become: groups that are likely one object
        are joined, and straight cuts are tried through each of the others.
    cut_above, join_below : float
        Log odds of two objects over one above which a group is cut, and below which two groups
        are joined. Lower: more objects.
    working_cells : int
        Parts of a footprint of more cells are looked at on coarser ones, see
        `tactile_graph_filters.parting.object_scale`: the other settings fit objects of this many
        cells at most, and readings of several elements together are less uneven.

    Notes
    -----
    Objects are taken to be convex, 3 cells wide or more, with cells in contact counted as they
    come: a mask subdivided first needs ``usual_cells`` and ``min_cells`` to match. The settings
    were chosen on simulated scenes of the thesis pad (``benchmarks/objects.py`` measures on
    others), the regression fitted on others again (``benchmarks/split_weights.py``). Three
    objects that touch in a row are often taken for two or one: any first cut leaves a long
    piece, which speaks against it. The energy is in the manner of a description length: Leclerc
    1989, 10.1007/BF00054839.
    """

    stateless = True
    notice = staticmethod(counts_the_offset)

    def __init__(
        self,
        *,
        voids: Annotated[float, Ge(0), Le(1)] = 0.3,
        hold: Annotated[float, Ge(0)] = 0.6,
        weak: Annotated[float, Ge(0), Le(1)] = 0.5,
        usual_cells: Annotated[float, Ge(0)] = 8.0,
        min_cells: Annotated[int, Ge(1)] | Literal["auto"] = "auto",
        smooth_cells: Annotated[tuple[Annotated[float, Gt(0)], ...], MinLen(1)] = (0.6, 0.9),
        margin: Annotated[int, Ge(0)] = 0,
        recut: bool = True,
        cut_above: float = 0.0,
        join_below: float = -1.0,
        working_cells: Annotated[int, Ge(16)] = 100,
    ) -> None:
        self._rules = np.array([voids, weak, usual_cells, hold, 0.0])
        self._weak, self._recut = weak, recut
        self._cut_above, self._join_below = cut_above, join_below
        self._taps = [taps_of(sigma) for sigma in smooth_cells]
        self._least = (MIN_CELLS, MIN_ALONE) if min_cells == "auto" else (min_cells, inf)
        self._margin = margin
        self._working_cells = working_cells

    def __call__(self, image: Image, mask: Annotated[Mask, Grid.like("image")]) -> Contacts:
        """Return a contact for each object.

        Parameters
        ----------
        image : Image
            Readings: low ones hint at a gap, and load and centre are theirs.
        mask : Mask
            Which cells are in contact, on the same grid.

        Raises
        ------
        RuleError
            If image and mask differ in shape.
        DataError
            If a cell of the mask holds NaN or infinity.
        """
        require_same_shape(image=image, mask=mask)
        on = mask.values
        readings = image.values[on]
        if not readings.size:
            return Contacts((), 0)
        require_summable(image, readings)
        values = np.where(on, np.maximum(image.values, 0.0), 0.0)
        cells = Cells(values, on, on | True if image.valid is None else image.valid | on)
        if readings.size <= self._working_cells:
            labels = self._labels(cells)
        else:
            labels = split_by_scale(cells, self._labels, self._working_cells)
        return contacts_of(labels, image, self._least[0], self._margin, self._least[1])

    def _labels(self, cells: Cells) -> NDArray[np.int32]:
        """Return the number of each cell's object, 0 where the cell is off."""
        values, on, known = cells
        best, energy = np.zeros(on.shape, np.int32), np.inf
        if not on.any():
            return best
        middle = float(np.median(values[on]))
        rules = self._rules.copy()
        rules[4] = self._weak * middle
        # One strong element is no object of its own: readings above the middle count as it.
        flat = np.minimum(values, middle) if middle > 0 else on.astype(np.float64)
        for taps in self._taps:
            owner = np.empty(on.shape, np.int32)
            count = basins(flat, on, taps, owner)
            reached = joined(owner, count, values, known, rules)
            if reached < energy - 1e-9:
                best, energy = owner, reached
        if self._recut:
            joined_and_cut(
                Partition(best, values, known),
                self._weak,
                rules[4],
                self._cut_above,
                self._join_below,
            )
        return best
