"""One object as the tracker knows it: where it should be now, and how sure that is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

State = Literal["appears", "moves", "rests", "leaves"]


@dataclass
class Followed:
    """An object being followed, with a constant-velocity Kalman filter.

    Parameters
    ----------
    number : int
        Its id, never given again.
    born_s, seen_s : float
        When it was first and last seen, on the tracker's clock.
    x_cm, y_cm, vx_cm_s, vy_cm_s : float
        Estimated place and velocity.
    place, both, speed : float
        Variance of the place, covariance, variance of the velocity; the same along x and y.
    contact : contact or shape
        As it was last seen.
    n_seen : int
    state : str
    """

    number: int
    born_s: float
    seen_s: float
    x_cm: float
    y_cm: float
    contact: Any
    place: float
    speed: float
    both: float = 0.0
    vx_cm_s: float = 0.0
    vy_cm_s: float = 0.0
    n_seen: int = 1
    state: State = "appears"

    def go_on(self, dt_s: float, agility_cm_s2: float) -> None:
        """Move on by a time, growing unsure by what an acceleration could have done."""
        self.x_cm += self.vx_cm_s * dt_s
        self.y_cm += self.vy_cm_s * dt_s
        push = agility_cm_s2**2
        self.place += 2.0 * dt_s * self.both + dt_s**2 * self.speed + push * dt_s**4 / 4.0
        self.both += dt_s * self.speed + push * dt_s**3 / 2.0
        self.speed += push * dt_s**2

    def see(self, contact: Any, x_cm: float, y_cm: float, noise_cm: float, now_s: float) -> None:
        """Take in where it was seen."""
        spread = self.place + noise_cm**2
        at, along = self.place / spread, self.both / spread
        off_x, off_y = x_cm - self.x_cm, y_cm - self.y_cm
        self.x_cm += at * off_x
        self.y_cm += at * off_y
        self.vx_cm_s += along * off_x
        self.vy_cm_s += along * off_y
        self.speed -= along * self.both
        self.both *= 1.0 - at
        self.place *= 1.0 - at
        self.contact, self.seen_s = contact, now_s
        self.n_seen += 1
