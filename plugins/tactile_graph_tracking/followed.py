"""One object as the tracker knows it: where it should be now, and how sure that is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

STALE = 4.0
"""Standard deviations of a place by which an acceleration may displace an object in the time
between two frames: from then on the mean velocity since the last one is surer than the filter's."""

MEMORY, BEFORE = 20, 4
"""Frames over which it is told how an object's centre scatters, about; what is told before any is
seen is worth so many."""

ODDEST = 4.0
"""Times the scatter so far, or what is expected if that is more, that a frame counts for at most: a
centre that is misplaced once, as where objects touch, says little of the others."""

ANYWHERE_CM = 1e3
"""Standard deviation of a place before anything is seen there."""

SLIGHT = 1e-12
"""Of a velocity's variance, the least that is left of it."""

State = Literal["appears", "moves", "rests", "leaves"]


@dataclass(eq=False)
class Followed:
    """An object being followed, by a Kalman filter of constant velocity.

    Parameters
    ----------
    contact : contact or shape
        As it was last seen.
    x_cm, y_cm : float
        Estimated place.
    now_s : float
        When it is first seen, on the tracker's clock.
    call : int
        In which call of the tracker.
    noise_cm : float
        Standard deviation of a contact's centre along x and along y.
    fastest_cm_s : float
        Standard deviation of the velocity of an object just met.
    """

    contact: Any
    x_cm: float
    y_cm: float
    now_s: float
    call: int
    noise_cm: float
    fastest_cm_s: float

    def __post_init__(self) -> None:
        self.number = 0
        """Its id; 0 until it is told of."""
        self.state: State = "appears"
        self.born_s = self.seen_s = self.now_s
        self.seen_x_cm, self.seen_y_cm = self.x_cm, self.y_cm
        self.expected_x_cm, self.expected_y_cm = self.x_cm, self.y_cm
        self.n_seen = 1
        self.over_s = 0.0
        """Time between the last two frames it was seen in, those of one burst being one."""
        self.is_mean = False
        """Whether its velocity is the mean over that time, whatever it was at the end."""
        self.vx_cm_s = self.vy_cm_s = 0.0
        # Variances of place and velocity and their covariance, the same along x and y.
        self.place, self.both, self.speed = self.noise_cm**2, 0.0, self.fastest_cm_s**2
        self.scatter = 1.0
        """Mean squared distance from where it was expected, over what the filter makes of it."""
        self.n_taken = 0
        """Frames it was seen in, those of one burst being one."""
        self._before: tuple[float, ...] = self._filtered(ANYWHERE_CM**2)
        self.n_taken = 1

    @property
    def speed_std_cm_s(self) -> float:
        """Standard deviation of its speed, by how its centre scatters."""
        return math.sqrt(2.0 * self.speed * self.scatter)

    def go_on(self, dt_s: float, agility_cm_s2: float, patience_s: float) -> None:
        """Move on by a time, growing unsure by what an acceleration could have done.

        Parameters
        ----------
        dt_s : float
        agility_cm_s2 : float
        patience_s : float
            No velocity is believed for longer, except for as long as it was measured over.
        """
        stale = dt_s > patience_s and agility_cm_s2 * dt_s**2 > STALE * self.noise_cm
        if self.is_mean and not stale:
            swerve = (agility_cm_s2 * self.over_s / 2.0) ** 2
            self.speed = min(self.speed + swerve, self.fastest_cm_s**2)
        self.is_mean = stale
        # After two frames a velocity is mostly noise: what it says is believed as far as it
        # stands out of that, or a gap would carry a resting object out of its own gate.
        swift = self.vx_cm_s**2 + self.vy_cm_s**2
        trust = swift / (swift + 2.0 * self.speed) if swift > 0.0 else 0.0
        reach_s = min(dt_s, max(patience_s, self.over_s))
        self.expected_x_cm = self.x_cm + trust * self.vx_cm_s * reach_s
        self.expected_y_cm = self.y_cm + trust * self.vy_cm_s * reach_s
        push = agility_cm_s2**2
        if stale:
            self.vx_cm_s = self.vy_cm_s = self.both = push = 0.0
            self.speed = self.fastest_cm_s**2
        self._pass(dt_s, push)

    def _pass(self, dt_s: float, push: float) -> None:
        """Move on by a time with a variance of the acceleration."""
        self.x_cm += self.vx_cm_s * dt_s
        self.y_cm += self.vy_cm_s * dt_s
        self.place += 2.0 * dt_s * self.both + dt_s**2 * self.speed + push * dt_s**4 / 4.0
        self.both += dt_s * self.speed + push * dt_s**3 / 2.0
        self.speed += push * dt_s**2

    def see(
        self, contact: Any, x_cm: float, y_cm: float, now_s: float, call: int, least_s: float = 0.0
    ) -> None:
        """Take in where it was seen, instead of where it was less than ``least_s`` ago."""
        dt_s = now_s - self.seen_s
        if late := dt_s < least_s:
            self._take_back(dt_s)
        self._before = self._filtered(self.place)
        self._take_in(x_cm, y_cm)
        self.over_s = self.over_s + dt_s if late else dt_s
        self.contact, self.seen_s, self.call = contact, now_s, call
        self.seen_x_cm, self.seen_y_cm = x_cm, y_cm
        self.n_seen += 1

    def _filtered(self, place: float) -> tuple[float, ...]:
        """Return what taking in where it is seen changes."""
        moves = self.x_cm, self.y_cm, self.vx_cm_s, self.vy_cm_s
        return *moves, place, self.both, self.speed, self.scatter, self.n_taken, self.is_mean

    def _take_back(self, dt_s: float) -> None:
        """Be as if it had not been seen when it was last, a moment ago."""
        self.x_cm, self.y_cm, self.vx_cm_s, self.vy_cm_s, *unsure = self._before
        self.place, self.both, self.speed, self.scatter, n_taken, is_mean = unsure
        self.n_taken, self.is_mean = int(n_taken), bool(is_mean)
        self._pass(dt_s, 0.0)

    def _take_in(self, x_cm: float, y_cm: float) -> None:
        """Correct place and velocity by where it was seen."""
        spread = self.place + self.noise_cm**2
        at, along = self.place / spread, self.both / spread
        off_x, off_y = x_cm - self.x_cm, y_cm - self.y_cm
        if self.n_taken > 1:  # what is seen first after it appears tells of its speed alone
            odd = min(0.5 * (off_x**2 + off_y**2) / spread, ODDEST * max(self.scatter, 1.0))
            self.scatter += (odd - self.scatter) / min(self.n_taken + BEFORE, MEMORY)
        self.x_cm += at * off_x
        self.y_cm += at * off_y
        self.vx_cm_s += along * off_x
        self.vy_cm_s += along * off_y
        # Over a gap of years rounding would leave a variance below zero.
        self.speed = max(self.speed - along * self.both, SLIGHT * self.speed)
        self.both *= 1.0 - at
        self.place *= 1.0 - at
        self.n_taken += 1
