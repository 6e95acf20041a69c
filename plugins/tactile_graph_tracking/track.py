"""Step ``track``: ids for contacts, kept from frame to frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.steps import TimeGap
from tactile_graph_tracking.followed import Followed, State
from tactile_graph_tracking.pairing import paired
from tactile_graph_tracking.places import placed, places_cm
from tactile_graph_tracking.tracked_object import TrackedObject

STIR = 1.5
"""A resting object moves once it is this many times faster than a moving one comes to rest."""
ALONE = 2.0
"""What staying alone costs: as much as a pair at the gate whose areas have nothing in common."""

REST_CM_S, STANDS_OUT = 1.0, 2.0
"""The speed of rest that is found: so much, and no less than so many of its deviations."""

PATIENCE_S, UNSEEN = 0.05, 2
"""The patience that is found: so long, and no fewer frames."""

GATE_CM, GATE_PITCHES = 2.6, 2.0
"""The gate that is found: so wide, and no fewer pitches."""

LEAST, LONGEST_S, USUAL_FRAMES = 0.25, 0.2, 200
"""Frames that follow in less than this share of the usual time are handed over in one burst: only
the last of it came about when it was taken. Usual is the mean over about so many frames, a pause
counted as so long."""

Reals = NDArray[np.float64]


class Tracks(NamedTuple):
    """The objects that are followed, by id."""

    tracks: tuple[TrackedObject, ...]
    """Those on the pad, and those that leave just now."""
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody asks a record for
    """How many are on the pad."""
    n_so_far: int
    """How many there have been since the start."""


class Track:
    """Give each contact the id of the object it was in the frames before.

    Each object is expected where its velocity takes it in the true time since the last frame.
    Contacts and objects are paired so that the sum of costs is least: squared distance, and a
    squared log ratio of areas, which helps to tell objects apart that cross. An object not seen
    for ``patience_s`` leaves; until then it may come back under its id. Where frames come so far
    apart that the velocity before tells little, the velocity is the mean since the last frame.
    Of frames that come in one burst the last stands for all.

    Parameters
    ----------
    gate_cm : float or 'auto'
        Farthest from where it is expected that an object is still recognised. ``auto`` is 2.6 cm,
        or two pitches of the contacts' cells if that is more.
    patience_s : float or 'auto'
        How long an object may go unseen; after longer it leaves. One that is there again right
        after a gap in the recording stays, however long the gap was. ``auto`` is 0.05 s, and two
        frames where these take longer: one that misses a single frame keeps its id.
    noise_cm : float
        Standard deviation of a contact's centre along x and along y.
    agility_cm_s2 : float
        Acceleration that objects are expected to undergo. Lower: steadier velocities.
    rest_cm_s : float or 'auto'
        Slower objects rest. It is a speed on the pad, however large the cells are: where cells are
        small, give less. ``auto`` is 1 cm/s, or where that is more twice the deviation of the
        object's speed, which follows from the frames seen and from how its centre scatters.
    confirm_frames : int
        An object is told of from the so many-th frame on in which it is seen.
    frame_s : float
        Time from frame to frame where the source keeps none.
    most : int
        So many objects are kept in mind; of more, those unseen longest leave.

    Notes
    -----
    Global nearest neighbour (Blackman and Popoli 1999, Design and Analysis of Modern Tracking
    Systems, chapter 6) over a filter of constant velocity with random accelerations. The order
    of the contacts within a frame has no influence.
    """

    def __init__(
        self,
        *,
        gate_cm: Annotated[float, Gt(0)] | Literal["auto"] = "auto",
        patience_s: Annotated[float, Ge(0)] | Literal["auto"] = 0.5,
        noise_cm: Annotated[float, Gt(0)] = 0.15,
        agility_cm_s2: Annotated[float, Gt(0)] = 30.0,
        rest_cm_s: Annotated[float, Ge(0)] | Literal["auto"] = 1.0,
        confirm_frames: Annotated[int, Ge(1)] = 1,
        frame_s: Annotated[float, Gt(0)] = 0.02,
        most: Annotated[int, Ge(1)] = 256,
    ) -> None:
        self._gate_cm = GATE_CM if gate_cm == "auto" else gate_cm
        self._gate_is_found = gate_cm != "auto"
        self._patience_s, self._unseen = (
            (PATIENCE_S, UNSEEN) if patience_s == "auto" else (patience_s, 0)
        )
        self._noise_cm, self._agility_cm_s2 = noise_cm, agility_cm_s2
        self._rest_cm_s, self._stands_out = (
            (REST_CM_S, STANDS_OUT) if rest_cm_s == "auto" else (rest_cm_s, 0.0)
        )
        self._confirm_frames = confirm_frames
        self._frame_s, self._most = frame_s, most
        self._usual_s, self._n_gaps = frame_s, 1
        self._now_s, self._call, self._last_id = 0.0, 0, 0
        self._all: list[Followed] = []

    def __call__(self, contacts: Sequence[Any | None], *, gap_s: TimeGap = None) -> Tracks:
        """Return the objects on the pad, and those that leave.

        Parameters
        ----------
        contacts : list
            Contacts, shapes, decisions on a shape: see `placed`. None where one could not be
            fitted: its object goes unseen in this frame.
        gap_s : float, optional
            Time since the last call.

        Raises
        ------
        DataError
            If one of them has no finite centre.
        """
        seen = [c for c in contacts if c is not None]
        xy = places_cm(seen, "track")
        if not self._gate_is_found and seen:
            self._find_gate(seen[0])
        areas = np.array([_area_cm2(c) for c in seen])
        order = np.lexsort((areas, xy[:, 0], xy[:, 1]))
        self._go_on(gap_s)
        self._see([seen[i] for i in order], xy[order], areas[order])
        gone = self._given_up()
        told = [self._told(one) for one in self._all if one.call == self._call]
        here = [one for one in told if one is not None]
        left = [_record(one, "leaves", self._now_s) for one in gone if one.number]
        return Tracks(tuple(sorted([*here, *left], key=_id)), len(here), self._last_id)

    def _find_gate(self, contact: Any) -> None:
        """Take the gate from the pitch of a contact's cells, if it has cells."""
        mask = getattr(contact, "mask", None)
        if mask is not None:
            self._gate_cm = max(GATE_CM, GATE_PITCHES * max(mask.pitch_cm))
        self._gate_is_found = mask is not None

    def _go_on(self, gap_s: float | None) -> None:
        """Let the time since the last call pass."""
        # A clock that was set back must not make objects run backwards.
        dt_s = max(0.0, self._frame_s if gap_s is None else gap_s)
        self._now_s += dt_s
        self._call += 1
        if gap_s is not None:
            self._n_gaps = min(self._n_gaps + 1, USUAL_FRAMES)
            self._usual_s += (min(dt_s, LONGEST_S) - self._usual_s) / self._n_gaps
        for one in self._all:
            one.go_on(dt_s, self._agility_cm_s2, self._patience_s)

    def _see(self, contacts: list[Any], xy: Reals, areas: Reals) -> None:
        """Tell each object which contact it is, and follow those that are nobody's."""
        pairs = paired(self._costs(xy, areas), ALONE)
        least_s = LEAST * self._usual_s
        for k, i in pairs:
            x_cm, y_cm = xy[i].tolist()
            self._all[k].see(contacts[i], x_cm, y_cm, self._now_s, self._call, least_s)
        known = {i for _, i in pairs}
        fastest_cm_s = self._gate_cm / self._frame_s
        self._all += [
            Followed(
                c,
                float(xy[i, 0]),
                float(xy[i, 1]),
                self._now_s,
                self._call,
                self._noise_cm,
                fastest_cm_s,
            )
            for i, c in enumerate(contacts)
            if i not in known
        ]

    def _costs(self, xy: Reals, areas: Reals) -> Reals:
        """Return what each object and contact cost as a pair: up to 2, infinite past the gate."""
        expected = np.array([(one.expected_x_cm, one.expected_y_cm) for one in self._all]).reshape(
            -1, 2
        )
        was = np.array([_area_cm2(one.contact) for one in self._all])
        off = expected[:, None] - xy[None]
        near = (off**2).sum(axis=2) / self._gate_cm**2
        both = (was[:, None] > 0) & (areas > 0)
        ratio = np.divide(was[:, None], areas, out=np.ones(both.shape), where=both)
        return np.where(near <= 1.0, near + np.minimum(1.0, np.log(ratio) ** 2), np.inf)

    def _given_up(self) -> list[Followed]:
        """Forget those unseen for too long, and those too many; return them."""
        limit_s = self._patience_s + 1e-9  # a whole number of frames is still in time
        kept = [
            one
            for one in self._all
            if self._now_s - one.seen_s <= limit_s or self._call - one.call < self._unseen
        ]
        if len(kept) > self._most:
            longest_seen = sorted(kept, key=lambda one: (-one.seen_s, one.number or math.inf))
            chosen = {id(one) for one in longest_seen[: self._most]}
            kept = [one for one in kept if id(one) in chosen]
        stays = {id(one) for one in kept}
        gone = [one for one in self._all if id(one) not in stays]
        self._all = kept
        return gone

    def _told(self, one: Followed) -> TrackedObject | None:
        """Return the record of an object just seen; None while it is not confirmed."""
        if one.n_seen < self._confirm_frames:
            return None
        if one.number == 0:
            self._last_id += 1
            one.number = self._last_id
        elif one.state == "appears":
            one.state = "moves" if _speed(one) >= self._limit_cm_s(one) else "rests"
        else:
            limit = self._limit_cm_s(one) * (STIR if one.state == "rests" else 1.0)
            one.state = "moves" if _speed(one) >= limit else "rests"
        return _record(one, one.state, self._now_s)

    def _limit_cm_s(self, one: Followed) -> float:
        """Return the speed below which an object rests."""
        return max(self._rest_cm_s, self._stands_out * one.speed_std_cm_s)


def _speed(one: Followed) -> float:
    return math.hypot(one.vx_cm_s, one.vy_cm_s)


def _area_cm2(contact: Any) -> float:
    return float(getattr(placed(contact), "area_cm2", 0.0))


def _record(one: Followed, state: State, now_s: float) -> TrackedObject:
    return TrackedObject(
        one.number,
        state,
        now_s - one.born_s,
        one.seen_x_cm,
        one.seen_y_cm,
        one.vx_cm_s,
        one.vy_cm_s,
        _area_cm2(one.contact),
        one.contact,
    )


def _id(track: TrackedObject) -> int:
    return track.id
