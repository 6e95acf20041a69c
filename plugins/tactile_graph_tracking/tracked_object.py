"""``TrackedObject``: an object on the pad with an id and a past."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from tactile_graph.draw.display import Drawn, Label, Outline, Rim, display_list
from tactile_graph.wires import Image, Mask
from tactile_graph_tracking.followed import State

SHOWN_S = 0.1
"""How far ahead pictures show where an object goes."""


@dataclass(frozen=True, eq=False)
class TrackedObject:
    """An object on the pad, known since it appeared; taken as the image or mask of its contact.

    Parameters
    ----------
    id : int
        From 1, never given again.
    state : str
        ``appears`` in its first frame, then ``moves`` or ``rests``, and ``leaves`` once, when it
        is given up.
    age_s : float
        Time since it appeared.
    x_cm, y_cm : float
        Centre of its contact; where it was last seen when it leaves.
    vx_cm_s, vy_cm_s : float
        Estimated velocity, x right and y down.
    area_cm2 : float
        Of its contact.
    contact : contact or shape
        What the tracker was given.
    """

    id: int
    state: State
    age_s: float
    x_cm: float
    y_cm: float
    vx_cm_s: float
    vy_cm_s: float
    area_cm2: float
    contact: Any = field(repr=False)
    columns_shown: ClassVar[tuple[str, ...]] = (
        *("id", "state", "age_s", "x_cm", "y_cm"),
        *("vx_cm_s", "vy_cm_s", "area_cm2"),
    )
    provides: ClassVar[Mapping[type, str]] = {Image: "image", Mask: "mask"}

    @property
    def image(self) -> Image | None:
        """Its contact's own image; None of a shape, which has none."""
        image: Image | None = getattr(self.contact, "image", None)
        return image

    @property
    def mask(self) -> Mask | None:
        """Its contact's own mask; None of a shape, which has none."""
        mask: Mask | None = getattr(self.contact, "mask", None)
        return mask

    def drawing(self) -> Iterator[Drawn]:
        """Yield its outline, its number, and as a line the way it goes in a tenth of a second."""
        seen = self.contact if self.mask is None else [self.mask]
        yield from (r for r in display_list(seen) if isinstance(r, Rim | Outline))
        here = np.array([self.x_cm, self.y_cm])
        if self.speed_cm_s > 0.0:
            way = here + np.outer([0.0, SHOWN_S], [self.vx_cm_s, self.vy_cm_s])
            yield Outline(way, closed=False)
        yield Label(self.x_cm, self.y_cm, str(self.id))

    @property
    def speed_cm_s(self) -> float:
        """Length of the velocity."""
        return math.hypot(self.vx_cm_s, self.vy_cm_s)
