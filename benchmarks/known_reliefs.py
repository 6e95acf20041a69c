"""How much one press tells: objects named by who knows every relief and how the pad reads.

    python benchmarks/known_reliefs.py --pads strip --seeds 11 --presses 5

Objects, pads and presses are those of `identify_objects`. Here nothing is learned: to every press
the press of each object that reads most like it is fitted (place, turn, lean, force and drift, by
least squares over all cells, priors as presses are drawn), and the object that fits best is named.
A stranger's press is fitted to the 21 others, and is found where it fits them worse than all but a
share of known objects' presses fit their own. Known presses start from where they truly lay, those
of others from two of twelve turns each, of which the five best are followed: what is missed for
that counts as told apart, so that the numbers are bounds from above.

That one press does not hold what five do would be shown by less than 90 % of strangers found here
where 5 % of known presses are lost.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from pressed_objects import BORNE, INSTRUMENTS, SOWN, Instrument, Pad, Thing, catalogue
from scipy import ndimage
from scipy.optimize import least_squares

Values = NDArray[np.float64]
LOST = (0.01, 0.036, 0.05)
TURNS, OF_EACH, FOLLOWED = 12, 2, 5
DRIFT = 0.04
"""Of the logarithm of all gains from session to session, as `Pad` draws it."""


class Knowing(Pad):
    """A pad whose presses say how they were made, and that tells what others would read.

    A press is x and y (cm), turn, lean along both axes, and logarithms of force and of drift.
    """

    def __init__(self, it: Instrument, rng: np.random.Generator, gains_known: bool) -> None:
        super().__init__(it, rng)
        self.believed = self.gains if gains_known else np.ones_like(self.gains)
        self.spread = 0.02 if gains_known else it.gain_spread
        tilt = it.tilt / 1.7  # the deviation of a lean up to it
        self.deviations = np.array([tilt, tilt, it.force_spread, DRIFT])
        p = it.pitch_cm
        self.steps = np.array([0.3 * p, 0.3 * p, 0.05, 0.01, 0.01, 0.1, 0.02])

    def pressed(self, thing: Thing) -> tuple[Values, Values]:
        """Return counts of a press, and the press."""
        it, rng = self.instrument, self.rng
        at = [n * it.pitch_cm * rng.uniform(0.25, 0.75) for n in (it.columns, it.rows)]
        turn, size = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(0.0, it.tilt)
        force = math.log(thing.force) + it.force_spread * rng.standard_normal()
        lean = size * math.cos(7.0 * turn), size * math.sin(7.0 * turn)
        press = np.array([*at, turn, *lean, force, 0.0])
        return self._read(self._pressed(self._depth(thing, press), math.exp(force))), press

    def _depth(self, thing: Thing, press: Values) -> Values:
        x, y, turn, lean_u, lean_v = press[:5]
        cos, sin = math.cos(turn), math.sin(turn)
        u = (self.x - x) * cos + (self.y - y) * sin
        v = (self.y - y) * cos - (self.x - x) * sin
        depth = thing.relief(u, v)
        return np.where(np.isfinite(depth), depth + lean_u * u + lean_v * v, np.inf)

    def expected(self, thing: Thing, press: Values) -> Values:
        """Return the counts of a press without noise, above the zeros."""
        it, depth = self.instrument, self._depth(thing, press)
        sorted_ = np.sort(depth[np.isfinite(depth)])
        if not sorted_.size:
            return np.zeros(self.gains.shape)
        sums, n = np.cumsum(sorted_), np.arange(1, sorted_.size + 1)
        wanted = BORNE * depth.size * math.exp(press[5]) * it.cover_cm
        k = max(int(np.searchsorted(n * sorted_ - sums, wanted, "right")), 1)
        height = (wanted + sums[k - 1]) / k
        pressure = np.where(np.isfinite(depth), np.maximum(height - depth, 0.0), 0.0) / it.cover_cm
        for axis in (0, 1):
            pressure = ndimage.convolve1d(pressure, self.taps, axis=axis, mode="constant")
        load = pressure.reshape(it.rows, SOWN, it.columns, SOWN).mean(axis=(1, 3))
        felt = np.maximum(load * self.believed * math.exp(press[6]) - it.threshold, 0.0) ** it.law
        return np.asarray(np.minimum(it.full_scale * felt, it.full_scale))

    def misfit(self, thing: Thing, counts: Values, press: Values) -> float:
        """Return minus twice the log likelihood, up to a constant, of the press that fits best."""
        it = self.instrument
        above = counts - 0.5 * it.zero_counts
        still = it.noise_counts**2 + (1.0 + it.zero_counts**2) / 12.0
        deviation = np.sqrt(still + (self.spread * it.law * np.maximum(above, 0.0)) ** 2)
        usual = np.array([0.0, 0.0, math.log(thing.force), 0.0])

        def residuals(off: Values) -> Values:
            at = press + off * self.steps
            cells = ((above - self.expected(thing, at)) / deviation).ravel()
            return np.concatenate([cells, (at[3:] - usual) / self.deviations])

        found = least_squares(residuals, np.zeros(7), diff_step=0.05, max_nfev=12)
        return 2.0 * float(found.cost)


class Start(NamedTuple):
    """A press to begin with: of which object, and how far its counts are off."""

    off: float
    thing: int
    press: Values


def starts(pad: Knowing, things: Sequence[Thing], counts: Values) -> Iterator[Start]:
    """Yield two presses of every object, with the centre and about the load of the counts."""
    it = pad.instrument
    y, x = (np.mgrid[: it.rows, : it.columns] + 0.5) * it.pitch_cm
    load = np.maximum(counts - 4.0 * it.noise_counts - it.zero_counts, 0.0)
    centre = np.array([(x * load).sum(), (y * load).sum()]) / load.sum()
    for k, thing in enumerate(things):
        begun = []
        for turn in 2.0 * math.pi * np.arange(TURNS) / TURNS:
            press = np.array([*centre, turn, 0.0, 0.0, math.log(thing.force), 0.0])
            for _ in range(2):
                read = pad.expected(thing, press)
                total = float(read.sum())
                if total > 0.0:
                    press[:2] += centre - np.array([(x * read).sum(), (y * read).sum()]) / total
                    ratio = float(np.clip(math.log(load.sum() / total), -1.0, 1.0))
                    press[5] += ratio / max(it.law, 0.5)
            off = float(((counts - pad.expected(thing, press)) ** 2).sum())
            begun.append(Start(off, k, press))
        yield from sorted(begun, key=lambda s: s.off)[:OF_EACH]


def measured(pad: Knowing, things: Sequence[Thing], n_presses: int) -> tuple[Values, Values]:
    """Return the misfit of each press to its own object, and the least one to another."""
    own, other = [], []
    for k, thing in enumerate(things):
        for _ in range(n_presses):
            pad.begin_session()
            counts, press = pad.pressed(thing)
            own.append(pad.misfit(thing, counts, press))
            begun = [s for s in starts(pad, things, counts) if s.thing != k]
            best = sorted(begun, key=lambda s: s.off)[:FOLLOWED]
            other.append(min(pad.misfit(things[s.thing], counts, s.press) for s in best))
    return np.array(own), np.array(other)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pads", nargs="*", choices=INSTRUMENTS, default=[*INSTRUMENTS])
    parser.add_argument("--seeds", nargs="*", type=int, default=[11])
    parser.add_argument("--presses", type=int, default=5)
    parser.add_argument("--gains-known", action="store_true")
    asked = parser.parse_args(arguments)
    for name in asked.pads:
        for seed in asked.seeds:
            rng, it = np.random.default_rng([seed]), INSTRUMENTS[name]
            pad = Knowing(it, rng, asked.gains_known)
            own, other = measured(pad, catalogue(it, rng), asked.presses)
            found = ", ".join(
                f"{100 * (other > np.quantile(own, 1.0 - lost)).mean():.1f} % where "
                f"{100 * lost:g} % are lost" for lost in LOST
            )  # fmt: skip
            print(f"{name}, catalogue {seed}: {100 * (own < other).mean():.1f} % named right; "
                  f"strangers found: {found}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
