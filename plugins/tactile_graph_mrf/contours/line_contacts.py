"""Step ``line_contacts``: one contact for each object, parted where lines are."""

from __future__ import annotations

from typing import Annotated, TypeAlias

import numpy as np
from annotated_types import Ge, Gt, Le, MinLen
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps.rules import require_same_shape
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contacts
from tactile_graph_filters.contacts.labelled import contacts_of
from tactile_graph_filters.parting.basins import basins, taps_of
from tactile_graph_filters.parting.joined_basins import joined
from tactile_graph_mrf.contours.regions import Flags, Regions

Labels: TypeAlias = NDArray[np.int32]
Reals: TypeAlias = NDArray[np.float64]


class LineContacts:
    """Tell objects apart by the lines between them.

    The raised regions that lines enclose are gathered around the peaks of the load, each region
    as a whole, so that objects are parted along lines only. Groups are then joined while that
    lowers the energy of `split_contacts`: what each object lacks in its convex hull, and a price
    for every cut between cells in contact. The same is tried with the peaks' own basins, for
    objects that touch without a line between them; the lower energy is taken. Missing elements
    within an object, or between two of its cells, are bridged.

    Parameters
    ----------
    voids : float
        Misfit that each cell inside an object is forgiven, where a void costs 1. Higher: fewer
        objects.
    hold : float
        Price of a cut between two cells in contact, where a void costs 1. Higher: fewer objects.
    weak : float
        A cell counts as partly void below this share of its object's mean reading.
    usual_cells : float
        Objects of fewer cells are doubted, the more the smaller they are.
    min_cells : int
        Smaller objects are left out in the end.
    smooth_cells : tuple of float
        Standard deviations, in cells, of the smoothing before peaks are looked for. Each is
        tried; the one that ends in the lowest energy is taken.
    bridge_cells : int
        As many missing elements in a row or a column, between two cells of one object and in no
        other, are given to it.
    margin : int
        How many more cells each object's own image and mask have on each side.

    Notes
    -----
    The thesis expects the line field to tell objects apart (section 5.5.2, item 3). Lines stand
    wherever the load steps, within an object too, since its elements are uneven: which of them
    are between objects is decided by shape.
    """

    stateless = True

    def __init__(
        self,
        *,
        voids: Annotated[float, Ge(0), Le(1)] = 0.3,
        hold: Annotated[float, Ge(0)] = 0.7,
        weak: Annotated[float, Ge(0), Le(1)] = 0.5,
        usual_cells: Annotated[float, Ge(0)] = 7.0,
        min_cells: Annotated[int, Ge(1)] = 4,
        smooth_cells: Annotated[tuple[Annotated[float, Gt(0)], ...], MinLen(1)] = (0.6, 0.9),
        bridge_cells: Annotated[int, Ge(0)] = 1,
        margin: Annotated[int, Ge(0)] = 0,
    ) -> None:
        self._rules = np.array([voids, weak, usual_cells, hold, 0.0])
        self._weak = weak
        self._taps = [taps_of(sigma) for sigma in smooth_cells]
        self._min_cells, self._bridge, self._margin = min_cells, bridge_cells, margin

    def __call__(self, image: Image, regions: Regions) -> Contacts:
        """Return a contact for each object.

        Parameters
        ----------
        image : Image
            Readings as recorded: load and centres are theirs.
        regions : Regions
            Of `line_regions`, on the same grid.

        Raises
        ------
        RuleError
            If image and regions differ in shape.
        DataError
            If a cell of an object holds NaN or infinity and is not marked as invalid.
        """
        require_same_shape(image=image, mask=regions.mask)
        fragments = numbered(
            np.where(regions.raised[regions.labels] & regions.mask.values, regions.labels, 0)
        )
        on = fragments > 0
        if not on.any():
            return Contacts((), 0)
        values = np.where(on, np.maximum(image.filled(), 0.0), 0.0).astype(np.float64)
        if not np.isfinite(values).all():
            raise DataError("image", "must be finite wherever an object lies")
        whole = image if image.valid is None else image.with_values(image.filled())
        owner = with_voids_of(self._owners(fragments, values, whole), regions.mask.values)
        owner = bridged(owner, self._bridge)
        return contacts_of(owner, whole, self._min_cells, self._margin)

    def _owners(self, fragments: Labels, values: Reals, image: Image) -> Labels:
        """Return the number of each cell's object, 0 off the objects."""
        on = fragments > 0
        known = on | True if image.valid is None else image.valid | on
        middle = float(np.median(values[on]))
        rules = self._rules.copy()
        rules[4] = self._weak * middle
        flat = np.minimum(values, middle) if middle > 0 else on.astype(np.float64)
        best, least = fragments, np.inf
        for taps in self._taps:
            basin = np.empty(on.shape, np.int32)
            basins(flat, on, taps, basin)
            for owner in (gathered(fragments, basin), basin):
                reached = joined(owner, int(owner.max()), values, known, rules)
                if reached < least - 1e-9:
                    best, least = owner, reached
        return best


def with_voids_of(owner: Labels, mask: Flags) -> Labels:
    """Return the owners, with cells of the mask that have none given to a neighbour's owner."""
    while (open_ := (owner == 0) & mask).any():
        p = np.pad(owner, 1)
        beside = np.max([p[:-2, 1:-1], p[2:, 1:-1], p[1:-1, :-2], p[1:-1, 2:]], axis=0)
        grown = np.where(open_, beside, owner)
        if np.array_equal(grown, owner):
            break
        owner = grown
    return owner


def gathered(fragments: Labels, basin: Labels) -> Labels:
    """Return the basin most of each fragment's cells are in, for all its cells; from 1."""
    count = np.zeros((int(fragments.max()) + 1, int(basin.max()) + 1), np.int64)
    np.add.at(count, (fragments.ravel(), basin.ravel()), 1)
    count[0] = 0
    return numbered(np.where(fragments > 0, count[:, 1:].argmax(axis=1)[fragments] + 1, 0))


def numbered(labels: NDArray[np.integer]) -> Labels:
    """Return labels without gaps: 0 stays, the others count from 1."""
    kinds = np.unique(labels[labels > 0])
    return np.where(labels > 0, np.searchsorted(kinds, labels) + 1, 0).astype(np.int32)


def bridged(owner: Labels, longest: int) -> Labels:
    """Return the owners, with short gaps between two cells of one owner given to it."""
    out = owner.copy()
    for given, taken in ((owner, out), (owner.T, out.T)):
        for gap in range(1, min(longest, given.shape[1] - 2) + 1):
            first, last = given[:, : -gap - 1], given[:, gap + 1 :]
            inner = [given[:, k : k - gap - 1] for k in range(1, gap + 1)]
            here = (first > 0) & (first == last) & ~np.any(inner, axis=0)
            for k in range(1, gap + 1):
                part: Flags = here & (taken[:, k : k - gap - 1] == 0)
                taken[:, k : k - gap - 1][part] = first[part]
    return out
