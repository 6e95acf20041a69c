"""Step ``correct_place``: contacts where a learned pad says they truly lie, and how surely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, ClassVar, NamedTuple

import numpy as np

from tactile_graph.errors import RuleError, UsageError
from tactile_graph.wires import Image
from tactile_graph_filters.contacts.contacts import Contact, all_placed
from tactile_graph_filters.nan import require_finite


@dataclass(frozen=True, eq=False)
class PlacedContact(Contact):
    """A contact with the deviation of its centre.

    Parameters
    ----------
    x_std_cm, y_std_cm : float
        Standard deviation of ``x_cm`` and of ``y_cm``.
    """

    x_std_cm: float
    y_std_cm: float
    columns_shown: ClassVar[tuple[str, ...]] = (
        "x_cm",
        "y_cm",
        "x_std_cm",
        "y_std_cm",
        "area_cm2",
        "load",
        "peak",
    )


class PlacedContacts(NamedTuple):
    """The contacts of an image, each with the deviation of its centre, and how many there are."""

    contacts: tuple[PlacedContact, ...]
    count: int  # type: ignore[assignment]


class CorrectPlace:
    """Return the contacts with their centres where objects at known places taught they lie.

    Parameters
    ----------
    pad : str or mapping
        A file that ``tactile-graph learn-pad`` has written from objects at known places.

    Raises
    ------
    UsageError
        If the pad has learned no correction of place.
    DataError
        If the correction's file cannot be read.

    Notes
    -----
    The readings around each contact, and where on the pad it lies, say how far and whither its
    centre is to be moved: a Bayesian linear regression, whose deviation was made true on
    recordings unlike those it was learned from. All contacts of the frame are needed, since a
    cell counts for the nearest one alone.
    """

    stateless = True

    def __init__(self, *, pad: str | dict[str, Any]) -> None:
        from tactile_graph_pads.learning.place import read_place
        from tactile_graph_pads.pad import learned_of

        learned = learned_of(pad)
        if not learned.place:
            raise UsageError(
                f"pad {pad!r} has no correction of place: learn it from objects at known places, "
                "by tactile-graph learn-pad"
            )
        self._place, self._learned = read_place(Path(learned.place)), learned

    def __call__(self, image: Image, contacts: Sequence[Contact]) -> PlacedContacts:
        """Return the contacts; all but the centre as it was.

        Raises
        ------
        RuleError
            If the image has another shape, quantity or pitch than the pad.
        DataError
            If a valid cell holds NaN or infinity, or a contact comes to lie at no finite place.
        """
        reading = self._learned.reading
        if image.shape != self._place.shape or image.quantity != reading:
            rows, columns = self._place.shape
            raise RuleError(
                f"the correction is of {reading} on {rows} x {columns} elements, got "
                f"{image.quantity} on {image.rows} x {image.columns}"
            )
        self._learned.require_pitch(image)
        require_finite(image)
        good = np.ones(image.shape, np.bool_) if image.valid is None else image.valid
        pitch, origin = np.array(image.pitch_cm), np.array(image.origin_cm)
        at = np.array([(c.x_cm, c.y_cm) for c in contacts]).reshape(-1, 2)
        found = self._place.correct(
            np.asarray(image.values, np.float64), good, (at - origin) / pitch - 0.5
        )
        places = origin + (found.centres + 0.5) * pitch
        stds = found.std_cells * pitch
        placed = all_placed(
            _placed(c, *place, *std)
            for c, place, std in zip(contacts, places.tolist(), stds.tolist(), strict=True)
        )
        return PlacedContacts(placed, len(placed))


def _placed(
    contact: Contact, x_cm: float, y_cm: float, x_std_cm: float, y_std_cm: float
) -> PlacedContact:
    held = {f.name: getattr(contact, f.name) for f in fields(Contact)}
    held |= {"x_cm": x_cm, "y_cm": y_cm}
    return PlacedContact(**held, x_std_cm=x_std_cm, y_std_cm=y_std_cm)
