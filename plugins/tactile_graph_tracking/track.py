"""Step ``track``: ids for contacts, kept from frame to frame."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.steps import TimeGap
from tactile_graph.wires import Image, Mask
from tactile_graph_tracking.followed import Followed, State
from tactile_graph_tracking.pairing import paired
from tactile_graph_tracking.places import places_cm

STIR = 1.5
"""A resting object moves once it is this many times faster than a moving one comes to rest."""


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
        What the step was given.
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
        "id", "state", "age_s", "x_cm", "y_cm", "vx_cm_s", "vy_cm_s", "area_cm2",
    )  # fmt: skip
    provides: ClassVar[Mapping[type, str]] = {Image: "image", Mask: "mask"}

    @property
    def image(self) -> Image:
        """Its contact's own image."""
        image: Image = self.contact.image
        return image

    @property
    def mask(self) -> Mask:
        """Its contact's own mask."""
        mask: Mask = self.contact.mask
        return mask

    @property
    def speed_cm_s(self) -> float:
        """Length of the velocity."""
        return math.hypot(self.vx_cm_s, self.vy_cm_s)


class Tracks(NamedTuple):
    """The objects followed, by id."""

    tracks: tuple[TrackedObject, ...]
    """Those on the pad, and those that leave just now."""
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody asks a record for
    """How many are on the pad."""
    n_seen: int
    """How many there have been so far."""


class Track:
    """Give each contact the id of the object it was in the frames before.

    Each object is expected where its velocity takes it in the true time since the last frame,
    and contacts and objects are paired so that the sum of the costs is least: squared distance
    over what is expected of it, and a squared log ratio of areas, which keeps objects apart that
    cross. An object not seen for ``patience_s`` leaves; until then it may come back under its id.

    Parameters
    ----------
    gate_cm : float
        Farthest from where it is expected that an object is still recognised.
    patience_s : float
        How long an object may go unseen; longer, and it leaves. A gap in the recording makes
        nobody leave who is there after it.
    noise_cm : float
        Standard deviation of a contact's centre along x and along y.
    agility_cm_s2 : float
        Acceleration objects are expected to undergo. Lower: steadier velocities.
    rest_cm_s : float
        Slower objects rest.
    confirm_frames : int
        An object is told of from the so many-th frame on in which it was seen.
    frame_s : float
        Time from frame to frame where the source keeps none.
    most : int
        So many objects are kept in mind; of more, those unseen longest leave.

    Notes
    -----
    Global nearest neighbour (Blackman and Popoli 1999, Design and Analysis of Modern Tracking
    Systems, section 6.4) on a filter of constant velocity with random accelerations. The order
    of the contacts within a frame has no influence.
    """

    def __init__(
        self,
        *,
        gate_cm: Annotated[float, Gt(0)] = 2.6,
        patience_s: Annotated[float, Ge(0)] = 0.5,
        noise_cm: Annotated[float, Gt(0)] = 0.15,
        agility_cm_s2: Annotated[float, Gt(0)] = 30.0,
        rest_cm_s: Annotated[float, Ge(0)] = 1.0,
        confirm_frames: Annotated[int, Ge(1)] = 1,
        frame_s: Annotated[float, Gt(0)] = 0.02,
        most: Annotated[int, Ge(1)] = 256,
    ) -> None:
        self._gate_cm, self._patience_s = gate_cm, patience_s
        self._noise_cm, self._agility_cm_s2 = noise_cm, agility_cm_s2
        self._rest_cm_s, self._confirm_frames = rest_cm_s, confirm_frames
        self._frame_s, self._most = frame_s, most
        self._now_s = 0.0
        self._last_id = 0
        self._n_confirmed = 0
        self._all: list[Followed] = []

    def __call__(self, contacts: list[Any], *, gap_s: TimeGap = None) -> Tracks:
        """Return the objects on the pad, and those that leave.

        Parameters
        ----------
        contacts : list
            Contacts, shapes, or anything else with ``x_cm`` and ``y_cm``.
        gap_s : float, optional
            Time since the last call.

        Raises
        ------
        DataError
            If one of them has no finite centre.
        """
        xy = places_cm(contacts, "track")
        areas = np.array([float(getattr(c, "area_cm2", 0.0)) for c in contacts])
        order = np.lexsort((areas, xy[:, 0], xy[:, 1]))
        given, xy, areas = [contacts[i] for i in order], xy[order], areas[order]
        # A clock set back must not make objects run backwards.
        dt_s = max(0.0, self._frame_s if gap_s is None else gap_s)
        self._now_s += dt_s
        for one in self._all:
            one.go_on(min(dt_s, self._patience_s), self._agility_cm_s2)
        pairs = paired(self._costs(xy, areas), self._limit)
        for k, i in pairs:
            x_cm, y_cm = xy[i].tolist()
            self._all[k].see(given[i], x_cm, y_cm, self._noise_cm, self._now_s)
        matched = {i for _, i in pairs}
        for i in range(len(given)):
            if i not in matched:
                self._meet(given[i], *xy[i].tolist())
        gone = self._gone()
        told = [self._told(one) for one in self._all if one.seen_s == self._now_s and self._is_confirmed(one)]
        count = len(told)
        told += [self._leaving(one) for one in gone if self._is_confirmed(one)]
        return Tracks(tuple(sorted(told, key=lambda t: t.id)), count, self._n_confirmed)

    @property
    def _limit(self) -> float:
        return 1.0

    def _costs(self, xy: NDArray[np.float64], areas: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what each pair of an object and a contact costs; infinite beyond the gate."""
        raise NotImplementedError

    def _meet(self, contact: Any, x_cm: float, y_cm: float) -> None:
        raise NotImplementedError
