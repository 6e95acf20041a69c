"""Step ``contacts``: the separate contacts of a footprint, with area, load and centre."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, TypeVar

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.at_rest import counts_the_offset
from tactile_graph_filters.contacts.labels import label
from tactile_graph_filters.images.crop import Box, cut_image, origin_of, widened
from tactile_graph_filters.nan import refuse_unbounded


@dataclass(frozen=True, eq=False)
class Contact:
    """One contact of a footprint; ports that take an image or a mask take it as it is.

    Parameters
    ----------
    number : int
        From 1, in reading order of the contacts' first cells.
    n_cells : int
    area_cm2 : float
        Of its cells, gaps between the elements included.
    load : float
        Sum of its readings, in the image's unit.
    peak : float
        Largest of its readings.
    x_cm, y_cm : float
        Centre of its load: mean of the cell centres weighted by the readings above 0; its
        centroid where no reading is.
    centroid_x_cm, centroid_y_cm : float
        Mean of its cell centres.
    box : tuple of int
        First row, row after the last, first column, column after the last, margin included.
    _whole : Image
    _labels : ndarray of int32, shape (rows, columns)
        What its own image and mask are cut from when they are asked for.
    """

    number: int
    n_cells: int
    area_cm2: float
    load: float
    peak: float
    x_cm: float
    y_cm: float
    centroid_x_cm: float
    centroid_y_cm: float
    box: Box
    _whole: Image = field(repr=False)
    _labels: NDArray[np.int32] = field(repr=False)
    columns_shown: ClassVar[tuple[str, ...]] = (
        "x_cm",
        "y_cm",
        "area_cm2",
        "load",
        "peak",
    )
    image_unit: ClassVar[tuple[str, ...]] = ("load", "peak")
    provides: ClassVar[Mapping[type, str]] = {Image: "image", Mask: "mask"}

    @property
    def mask(self) -> Mask:
        """Its cells within its box, in their place on the pad."""
        top, bottom, left, right = self.box
        own = self._labels[top:bottom, left:right] == self.number
        return Mask(own, self._whole.pitch_cm, origin_of(self.box, self._whole))

    @property
    def image(self) -> Image:
        """Its readings within its box; 0 in every cell that is not its own."""
        part = cut_image(self._whole, self.box)
        return part.with_values(np.where(self.mask.values, part.values, 0.0))


SomeContact = TypeVar("SomeContact", bound=Contact)


class Contacts(NamedTuple):
    """The contacts of a footprint."""

    contacts: tuple[Contact, ...]
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody asks a record for


def contacts_of(found: Iterable[Contact]) -> Contacts:
    """Return contacts as a step gives them; errors as of `all_placed`."""
    kept = all_placed(found)
    return Contacts(kept, len(kept))


def all_placed(found: Iterable[SomeContact]) -> tuple[SomeContact, ...]:
    """Return contacts whose area and places are numbers.

    Parameters
    ----------
    found : iterable of Contact

    Raises
    ------
    DataError
        If the area or a place of one is not finite.
    """
    kept = tuple(found)
    for c in kept:
        # A sum of numbers is finite where all are, and where they do not nearly overflow.
        if not isfinite(c.area_cm2 + c.x_cm + c.y_cm + c.centroid_x_cm + c.centroid_y_cm):
            raise DataError(
                f"contact {c.number}",
                f"its area and place must be finite, got {c.area_cm2:g} cm² at "
                f"({c.x_cm:g}, {c.y_cm:g}) cm, cells at ({c.centroid_x_cm:g}, "
                f"{c.centroid_y_cm:g}) cm",
            )
    return kept


def contacts(
    image: Image,
    mask: Annotated[Mask, Grid.like("image")],
    *,
    connectivity: Literal[4, 8] = 8,
    min_cells: Annotated[int, Ge(1)] = 1,
    margin: Annotated[int, Ge(0)] = 0,
) -> Contacts:
    """Return the connected parts of the mask with their area, load and centre.

    Parameters
    ----------
    image : Image
        Readings, for load and centre.
    mask : Mask
        Which cells are in contact, on the same grid.
    connectivity : int
        Whether cells that touch at a corner belong together (8) or not (4); thesis figure 3.3.
    min_cells : int
        Smaller contacts are left out.
    margin : int
        How many more cells each contact's own image and mask have on each side.

    Returns
    -------
    Contacts

    Raises
    ------
    RuleError
        If image and mask differ in shape.
    DataError
        If a cell of the mask holds NaN or infinity.
    """
    require_same_shape(image=image, mask=mask)
    labels = np.empty(mask.shape, np.int32)
    values = np.ascontiguousarray(image.values, np.float64)
    table = label(values, mask.values, connectivity == 8, labels)
    labels.setflags(write=False)
    if not np.isfinite(table).all():
        refuse_unbounded(image, "the load of a contact, or its moment")
    found = [
        _contact(number, sums, image, labels, margin)
        for number, sums in enumerate(table.tolist(), 1)
        if sums[0] >= min_cells
    ]
    return Contacts(tuple(found), len(found))


contacts.notice = counts_the_offset  # type: ignore[attr-defined]


def _contact(
    number: int, sums: list[Any], image: Image, labels: NDArray[np.int32], margin: int
) -> Contact:
    n, load, peak, sum_x, sum_y, pressed, moment_x, moment_y, top, bottom, left, right = sums
    (x, y), (pitch_x, pitch_y) = image.origin_cm, image.pitch_cm
    at_x, at_y = sum_x / n, sum_y / n
    load_x, load_y = (moment_x / pressed, moment_y / pressed) if pressed > 0 else (at_x, at_y)
    box = (int(top), int(bottom) + 1, int(left), int(right) + 1)
    return Contact(
        number,
        int(n),
        n * image.cell_area_cm2,
        load,
        peak,
        x + (load_x + 0.5) * pitch_x,
        y + (load_y + 0.5) * pitch_y,
        x + (at_x + 0.5) * pitch_x,
        y + (at_y + 0.5) * pitch_y,
        widened(box, margin, image.shape),
        image,
        labels,
    )
