"""How large elements are, by how readings fall off over an outline's rim."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Generic, TypeVar

from tactile_graph_likelihood.geometry.outlines import Values
from tactile_graph_likelihood.single.model import Likeliest, Model
from tactile_graph_likelihood.single.readings import Gap, Readings, is_row

STEP = 0.1
"""Of a pitch: by how much gaps differ that are tried."""

MOST = 0.5
"""Of a pitch: no gap is wider, unless it is taken to be."""

SURE = 0.04
"""Of a pitch: no gap is known better."""

SLOPE = 0.8
"""By how much a radius or half a side grows with the gap where a limit holds most readings: then
what shows at all tells where the rim is."""

CLEARLY = 1.5
"""Deviations by which a told gap must be off to be another."""

EVEN = 0.25
"""Sigma of a fit up to which readings tell the gap of a pad whose gap was told."""


Top = TypeVar("Top")
"""Most likely outlines, whatever holds them."""


class Tried(Generic[Top]):
    """Outlines on elements of other gaps, each climbed to once.

    Parameters
    ----------
    climbed : callable
        Returns the outlines on other elements, from those on elements nearly as large.
    height : callable
        Returns their log posterior.
    readings : Readings
    even : Top
        The outlines on elements as they were taken to be.
    guess : Gap
    """

    def __init__(
        self,
        climbed: Callable[[Readings, Top], Top],
        height: Callable[[Top], float],
        readings: Readings,
        even: Top,
        guess: Gap,
    ) -> None:
        self._climbed, self._height = climbed, height
        self._readings, self._guess = readings, guess
        self._pitch = float(readings.grid[2])
        self._told = self._pitch - float(readings.grid[3])
        self._most = max(MOST * self._pitch, self._told) + 1e-9
        self._found: dict[float, tuple[Readings, Top]] = {0.0: (readings, even)}

    def gap_cm(self, steps: float) -> float:
        """Return the gap so many steps above the one that was taken."""
        return self._told + steps * STEP * self._pitch

    def at(self, steps: float) -> tuple[Readings, Top]:
        """Return readings and outlines on elements whose gap is so many steps above that."""
        if steps not in self._found:
            wider = self.gap_cm(steps) - self._told
            its = self._readings._replace(grid=narrower(self._readings.grid, wider))
            _, near = self._found[min(self._found, key=lambda known: abs(known - steps))]
            self._found[steps] = its, self._climbed(its, near)
        return self._found[steps]

    def log_chance(self, steps: float) -> float:
        """Return the log posterior there, with what is believed of gaps; -inf where none can be."""
        gap = self.gap_cm(steps)
        if not -1e-9 <= gap <= self._most:
            return -math.inf
        off = (gap - self._guess.middle_cm) / self._guess.std_cm
        return self._height(self.at(steps)[1]) - 0.5 * off * off

    def best(self) -> int:
        """Return the likeliest gap in whole steps: no step to either side is likelier."""
        best = 0
        for way in (1, -1):
            while self.log_chance(best + way) > self.log_chance(best):
                best += way
            if best:
                break
        return best

    def around(self, best: int) -> tuple[float, float]:
        """Return where the likeliest gap is, in steps, and its deviation in cm."""
        here, below, above = (self.log_chance(best + k) for k in (0, -1, 1))
        steps, std = float(best), math.inf
        if below > -math.inf and above > -math.inf:
            bend = 2.0 * here - below - above
            steps += 0.5 * (above - below) / bend if bend > 0.0 else 0.0
            std = 1.0 / math.sqrt(bend) if bend > 0.0 else math.inf
        elif 0.0 < (drop := here - max(below, above)) < math.inf:
            std = 1.0 / math.sqrt(2.0 * drop)
        std_cm = max(std * STEP, SURE) * self._pitch
        return steps, min(std_cm, self._guess.std_cm)

    def slope(self, best: int, size: Callable[[Top], float]) -> float:
        """Return by how much a size of the outlines grows with the gap."""
        steps = [k for k in (best - 1, best, best + 1) if self.log_chance(k) > -math.inf]
        first, last = (size(self.at(k)[1]) for k in (steps[0], steps[-1]))
        return (last - first) / (max(len(steps) - 1, 1) * STEP * self._pitch)

    def likeliest(self, size: Callable[[Top], float]) -> tuple[Readings, Top, float]:
        """Return readings and outlines on elements of the likeliest gap.

        The last is the deviation that it leaves of a size. A told gap stays unless it is clearly
        another.
        """
        best = self.best()
        steps, std_cm = self.around(best)
        if self._guess.is_told and abs(steps) * STEP * self._pitch < CLEARLY * std_cm:
            steps = 0.0
        return *self.at(steps), self.slope(best, size) * std_cm


def narrower(grid: Values, by_cm: float) -> Values:
    """Return where elements lie, as in `Readings`, whose sides are so much shorter."""
    found = grid.copy()
    found[:2] += 0.5 * by_cm
    found[3] -= by_cm
    return found


def without_gap(readings: Readings) -> Readings:
    """Return readings on elements that leave no gap."""
    grid = readings.grid
    return readings._replace(grid=narrower(grid, float(grid[3] - grid[2])))


def sized(model: Model, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
    """Return readings on elements as large as they tell, and the outline on them.

    Parameters
    ----------
    model : Model
        Of an even face.
    readings : Readings
    even : Likeliest

    Returns
    -------
    Readings
        With the deviation of lengths that is left, as nobody knows the gap better. The same on a
        single row, where the gap was said, and where it was told of the pad and readings scatter
        too much to tell another; the same but for that deviation where they do not clearly tell
        another, or a limit holds them, so that the rim tells little.
    Likeliest
    """
    guess = readings.gap
    if guess is None or even.mode.height == -math.inf or is_row(readings):
        return readings, even
    if guess.is_told and math.exp(even.mode.p[-2]) > EVEN:
        return readings, even
    if readings.unheld is not None:
        return _known_to(readings, 0.0 if guess.is_told else SLOPE * guess.std_cm), even
    tried = Tried(
        lambda its, near: model.likeliest_near(its, model.point_of(near)),
        lambda its: its.mode.height,
        readings,
        even,
        guess,
    )
    found, its, std_cm = tried.likeliest(lambda its: float(its.mode.p[2]))
    if its.mode.height == -math.inf:
        return readings, even
    return _known_to(found, std_cm), its


def _known_to(readings: Readings, std_cm: float) -> Readings:
    """Return readings whose gap leaves lengths so uncertain, beside what did."""
    return readings._replace(gap=None, length_std_cm=math.hypot(readings.length_std_cm, std_cm))
