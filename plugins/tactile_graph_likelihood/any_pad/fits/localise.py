"""``AnyPad``: fits of an outline on a pad that need not be the one that is told."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tactile_graph_likelihood.any_pad.fits.left_open import FEW
from tactile_graph_likelihood.any_pad.fits.pressure_chances import FOAM
from tactile_graph_likelihood.any_pad.fits.second_climbs import (
    among_strays,
    around_clump,
    beyond_the_edge,
)
from tactile_graph_likelihood.any_pad.fits.two_pressures import CLEARLY
from tactile_graph_likelihood.any_pad.fits.under_pressures import UnderPressures
from tactile_graph_likelihood.any_pad.observation.clump import without_alone
from tactile_graph_likelihood.any_pad.observation.learned_pad import unevenness_left
from tactile_graph_likelihood.any_pad.pad_effects.from_frame import (
    LAW,
    strays_beyond,
    variance_inflation,
)
from tactile_graph_likelihood.any_pad.pad_effects.gap import sized, without_gap
from tactile_graph_likelihood.any_pad.pad_effects.hollow import without_hollow
from tactile_graph_likelihood.any_pad.pad_effects.through_foam import without_foam
from tactile_graph_likelihood.any_pad.pad_effects.turn_on import (
    SURE,
    chance_of_a_bend,
    straightened,
    unbent,
)
from tactile_graph_likelihood.any_pad.pad_effects.unheld import unheld
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.any_pressure import (
    EVEN,
    RISE,
    asked_by,
)
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.climbs.search import SAME
from tactile_graph_likelihood.single.density.element_terms import UNKNOWN
from tactile_graph_likelihood.single.model import EVERY, MORE, SECOND, Likeliest
from tactile_graph_likelihood.single.noise import LEAST_SIGMA, Noise
from tactile_graph_likelihood.single.readings import Readings

MANY = 8.0
"""Times what is told of strays from which on an outline is searched for anew, knowing of them."""

THINNEST = 0.12
"""Half of a rectangle's breadth in pitches, at least, where nothing else is told: a book's edge."""


@dataclass(frozen=True)
class AnyPad(UnderPressures):
    """Fits of an outline that take law, gains, voids, strays and pressure from the frame itself.

    Parameters
    ----------
    told : Model
        An outline on the pad as told: the middle of every guess.
    quick : bool
        Whether no fit is sampled, but one with an angle that reaches over the pad's edge: each
        stands for itself as a normal distribution, an even face's with the law's exponent, and
        other pressures are looked at where the pattern is clear. A fainter one widens the
        posterior. On small pads only: see `suited`.
    law : float
        As in `learned`; 0 where gains were learned, since readings then scatter as these are good.
    sampled_above_cm : float
        The deviation of its centre from which on a quick disc is sampled after all.
    unevened : AnyPad, optional
        Where gains were learned: the same for readings that are not divided by them.
    foam_cm : float
        Width of foam that the pad tells of; ``told`` knows of none, since it is undone.

    Notes
    -----
    The outline is fitted with sigma and voids; also under each pressure that an even face leaves a
    pattern of. What they come to together, `posterior_around` tells.
    """

    law: float = LAW
    sampled_above_cm: float = math.inf
    unevened: AnyPad | None = None
    foam_cm: float = 0.0

    @classmethod
    def of(cls, settings: LocateSettings, kind: int) -> AnyPad:
        """Return the fits of a kind of outline; a pad that says it is even has not been asked."""
        told, untold = settings.model(kind), Noise()
        if kind == RECTANGLE:
            told = changed(told, smallest_pitches=THINNEST)
        foam_cm = told.noise.foam_cm
        told = changed(told, noise=changed(told.noise, foam_cm=0.0))
        sigma, voids = told.noise.sigma, told.noise.voids
        if sigma < LEAST_SIGMA:
            sigma, voids = untold.sigma, voids or untold.voids
        elif settings.sigma is None:
            sigma = unevenness_left(settings.known_pad, sigma)
        noise = changed(told.noise, sigma=sigma, voids=voids)
        above_cm = math.inf if settings.sampled_above_cm is None else settings.sampled_above_cm
        if sigma >= told.noise.sigma:
            its = changed(told, noise=noise)
            return cls(its, settings.quick, LAW, above_cm, foam_cm=foam_cm)
        plain = cls(told, settings.quick, LAW, above_cm, foam_cm=foam_cm)
        return cls(changed(told, noise=noise), settings.quick, 0.0, above_cm, plain, foam_cm)

    @cached_property
    def _of_wide(self) -> AnyPad:
        return changed(self.told_of_foam, quick=False)

    def suited(self, readings: Readings) -> AnyPad:
        """Return these fits, or those for more than 4096 touched elements.

        They are not quick, and know of the foam that is told, since none is undone there.
        """
        wide = readings.is_wide
        return self._of_wide if wide and (self.quick or self.foam_cm > 0.0) else self

    def first(self, readings: Readings) -> tuple[AnyPad, Readings, Likeliest]:
        """Return the even face's most likely outline as it is first found, and its readings.

        With the fits that found it; see `begun` and `cleared`.
        """
        its, even = self.begun(readings)
        return its.on_told_foam(*its.cleared(readings, even))

    def on_told_foam(
        self, readings: Readings, even: Likeliest
    ) -> tuple[AnyPad, Readings, Likeliest]:
        """Return fits that know of the foam that is told, where it is likelier and was not undone.

        Then elements have gains of their own under it.
        """
        its = self.told_of_foam
        if its is self or readings.through_foam is not None:
            return self, readings, even
        other = its.near(readings, self.told.point_of(even))
        return (its, readings, other) if other.evidence > even.evidence else (self, readings, even)

    @cached_property
    def told_of_foam(self) -> AnyPad:
        """The same fits, which know of the foam that is told."""
        if self.foam_cm <= 0.0:
            return self
        noise = changed(self.told.noise, foam_cm=self.foam_cm)
        return changed(self, told=changed(self.told, noise=noise), foam_cm=0.0)

    def begun(self, readings: Readings) -> tuple[AnyPad, Likeliest]:
        """Return the even face's most likely outline by one attempt, and the fits that found it.

        Where touched elements stand alone away from the others, a disc is first looked for near
        one of these. If strays lie beyond that, the fits know of as many, and there were two more
        attempts. Not so where more than 4096 are touched, nor of an outline with an angle, which
        would rather be caught there.
        """
        model, wide = self.fit(EVEN), readings.is_wide
        some = None if wide or self.told.kind != DISC else without_alone(readings)
        if some is None or (rough := model.likeliest(some)).mode.height == -math.inf:
            return self, model.likeliest(readings)
        if not (strays := self.strays(readings, rough)):
            return self, self.near(readings, self.told.point_of(rough))
        its = self.knowing(strays)
        model, near = its.fit(EVEN), its.near(readings, self.told.point_of(rough))
        return its, among_strays(model, readings, model.likeliest(readings, near, attempts=SECOND))

    def cleared(self, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
        """Return readings free of a limit and a law's improbable bend, of foam and a hollow.

        With their outline, and on elements as large as they tell. Only where up to 4096
        are touched.
        """
        if readings.is_wide or even.mode.height == -math.inf:
            return readings, even
        readings, even = unheld(self.fit(EVEN), readings, even)
        if (bare := unbent(readings)) is not None:
            readings, even = self._by_law(readings, even, *bare)
        if self.foam_cm > 0.0 or asked_by([even.fit], [FOAM], self.faint):
            its = without_foam(readings, self.foam_cm)
            if its is not None:
                readings, even = its, self.near(its, self.told.point_of(even))
        p = self.told.point_of(even)
        rim = without_hollow(self.told.kind, readings, p, float(p[-1]))
        if rim is not None:
            readings, even = rim, self.near(rim, p)
        return (readings, even) if readings.through_foam else self.sized(readings, even)

    def sized(self, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
        """Return readings on elements as large as they tell, and the outline on them.

        As a face that presses with its rim tells it, where residuals rise to the rim and that is
        clearly likelier: such a rim looks as if it lay between elements. Not so where more than
        4096 are touched.
        """
        found, its = sized(self.fit(EVEN), readings, even)
        if readings.gap is None or readings.is_wide or not self.rises(readings, even):
            return found, its
        bare = readings
        if not readings.gap.is_told:  # slivers that lie between elements hold such a fit fast
            bare = without_gap(readings)
        other, rising = sized(self.fit(RISE), bare, self.pressed(RISE, bare, even))
        worth = variance_inflation(rising.fit.neighbours, readings.touched) ** 2
        if rising.evidence < its.evidence + CLEARLY * worth:
            return found, its
        return other, self.near(other, self.told.point_of(its))

    def _by_law(
        self, readings: Readings, even: Likeliest, straight: Readings, denser: float
    ) -> tuple[Readings, Likeliest]:
        """Return readings with as much of the told law's bend as is probable, and their outline.

        Sizes go with the bend evenly: it is the mean over both laws, at the price of one.
        """
        other = self.near(straight, self.told.point_of(even))
        bend = chance_of_a_bend(other.mode.height + denser - even.mode.height)
        if bend > 1.0 - SURE:
            return readings, even
        if bend < SURE:
            return straight, other
        partly = straightened(readings, 1.0 - bend)
        return partly, self.near(partly, self.told.point_of(even if bend > 0.5 else other))

    def near(self, readings: Readings, point: Values | None = None) -> Likeliest:
        """Return the even face's most likely outline, as `Model.likeliest_near` finds it."""
        return self.fit(EVEN).likeliest_near(readings, point)

    def searched(self, readings: Readings, near: Likeliest) -> Likeliest:
        """Return the same after all attempts that are worth their time.

        Where a quick answer will do, a first attempt that finds no more than ``near`` is the last.
        """
        if not self.quick:
            return self.fit(EVEN).likeliest(readings, near, attempts=EVERY)
        even = self.fit(EVEN).likeliest(readings, near)
        if -math.inf < even.mode.height <= near.mode.height + SAME:
            return even._replace(unsure=False)
        return self.sought(readings, even)

    def sought(self, readings: Readings, even: Likeliest) -> Likeliest:
        """Return the same after more attempts, where the first ones left that open."""
        more = even.unsure
        return self.fit(EVEN).likeliest(readings, even, attempts=MORE) if more else even

    def strays(self, readings: Readings, even: Likeliest) -> float:
        """Return the share of strays beyond an outline, 0 unless it is far more than told."""
        found = strays_beyond(self.told, readings, self.told.point_of(even))
        return found if found > MANY * self.told.noise.strays else 0.0

    def knowing(self, strays: float) -> AnyPad:
        """Return fits that are told of so many strays."""
        return changed(self, told=changed(self.told, noise=changed(self.told.noise, strays=strays)))

    def likelier_with(
        self, strays: float, readings: Readings, even: Likeliest
    ) -> tuple[AnyPad, Likeliest]:
        """Return fits that are told of so many strays and their outline, or these if likelier."""
        knowing = self.knowing(strays)
        other = knowing.again(readings, even)
        likelier = other.evidence + self.bare_by(strays, readings) > even.evidence
        return (knowing, other) if likelier else (self, even)

    def bare_by(self, strays: float, readings: Readings) -> float:
        """Return the log likelihood of a bare pad of so many strays over that of as many as told.

        Evidence is over that of a bare pad.
        """
        told = self.told.noise.strays
        bare = int(np.count_nonzero(readings.states != UNKNOWN)) - readings.touched
        more, fewer = math.log(strays / told), math.log1p(-strays) - math.log1p(-told)
        return readings.touched * more + bare * fewer

    def again(self, readings: Readings, even: Likeliest) -> Likeliest:
        """Return what is likelier, near an outline and elsewhere, now that strays are known."""
        near, model = self.near(readings, self.told.point_of(even)), self.fit(EVEN)
        wide = readings.is_wide
        if wide and not near.unsure:
            return near
        found = model.likeliest(readings, near, attempts=MORE)
        return found if wide else among_strays(model, readings, found)

    def completed(
        self, readings: Readings, even: Likeliest, alone: bool = True
    ) -> dict[str, Likeliest]:
        """Return the most likely outlines by pressure, once one attempt found one of an even face.

        Parameters
        ----------
        readings : Readings
        even : Likeliest
        alone : bool
            Whether no other kind is compared with, which would have to know of as many strays.

        Raises
        ------
        Degenerate
            If no outline of this kind is possible.
        """
        wide, model = readings.is_wide, self.fit(EVEN)
        if not wide:
            even = self.sought(readings, even)
        if readings.touched <= FEW:
            even = around_clump(model, readings, even)
        if even.mode.height == -math.inf:
            raise self.told.impossible(readings)
        its = self
        if alone and (strays := self.strays(readings, even)):
            its, even = self.likelier_with(strays, readings, even)
        elif wide and even.unsure:
            even = model.likeliest(readings, even, attempts=MORE)
        if not wide:
            even = beyond_the_edge(its.fit(EVEN), readings, even)
        return {EVEN: even} if wide else its.under_each(readings, even)
