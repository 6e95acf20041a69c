"""``AnyPad``: the posterior of an outline on a pad that need not be the one that is told."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tactile_graph.errors import Degenerate
from tactile_graph_likelihood.any_pad.clump import without_alone
from tactile_graph_likelihood.any_pad.filtered import as_filtered
from tactile_graph_likelihood.any_pad.from_frame import (
    AS_LOADS,
    LAW,
    contrast_of,
    evened_by_foam,
    is_partly_hidden,
    learned,
    strays_beyond,
    variance_inflation,
)
from tactile_graph_likelihood.any_pad.gap import sized
from tactile_graph_likelihood.any_pad.hollow import without_hollow
from tactile_graph_likelihood.any_pad.learned_pad import unevenness_left
from tactile_graph_likelihood.any_pad.left_open import (
    FEW,
    PATTERN,
    UNSEEN,
    fewness,
    hidden_by,
    is_scattered,
    looseness,
    unseen_share,
)
from tactile_graph_likelihood.any_pad.lopsided import lopsided
from tactile_graph_likelihood.any_pad.posterior import (
    AnyPadPosterior,
    evenly_spread,
    inflated,
    on_any_pad,
    resized,
    stretched,
    within,
)
from tactile_graph_likelihood.any_pad.pressure_chances import (
    FOAM,
    log_chances,
    on_foam,
    shared_by,
)
from tactile_graph_likelihood.any_pad.second_climbs import (
    among_strays,
    around_clump,
    beyond_the_edge,
)
from tactile_graph_likelihood.any_pad.through_foam import has_no_foam, without_foam
from tactile_graph_likelihood.any_pad.turn_on import (
    SURE,
    chance_of_a_bend,
    straightened,
    unbent,
)
from tactile_graph_likelihood.any_pad.unheld import unheld
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE, Values, sizes, unknowns
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.any_pressure import (
    CLEAR,
    EVEN,
    FIRST,
    FOAM_ODDS,
    WIDER,
    Pattern,
    asked_by,
    mixed,
)
from tactile_graph_likelihood.single.changed import changed
from tactile_graph_likelihood.single.element_terms import CONTRAST, UNKNOWN
from tactile_graph_likelihood.single.maximise import Mode
from tactile_graph_likelihood.single.model import EVERY, MORE, SECOND, Likeliest, Model
from tactile_graph_likelihood.single.noise import LEAST_SIGMA, SPREADS, Noise
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.problem import LARGE_PAD
from tactile_graph_likelihood.single.readings import Readings, is_row
from tactile_graph_likelihood.single.search import SAME

FAINT = Pattern(1.0, 0.4, 2.5)
"""From which on another pressure is worth its time; where a quick answer will do, it is `CLEAR`."""

NEGLIGIBLE = 0.03
"""Probability over the likeliest pressure's below which one is left out."""

PRESSED = {"lean": 0.8, "fall": 0.8, "foam": 2.8}
"""Share that is added to the variance where a pressure of one or two numbers explains the load: no
face presses quite like that, and foam shares gains that the fit takes for the outline's."""

TOLD_FOAM = 0.8
"""The same under foam that is told, whose width nobody knows to better than a tenth."""

UNSURER = 1.3
"""Times the variance of a normal distribution around an outline with an angle that a sample of it
would come to, for a quick answer: between two rows of elements nothing holds its sides."""

UNSUREST = 2.3
"""The same of a rectangle under a pressure, which has nine unknowns, for any other answer."""

SHARPER = 0.6
"""As `FAINT`, the fall of a rectangle: its own shape tells more of that."""

MANY = 8.0
"""Times what is told of strays from which on an outline is searched for anew, knowing of them."""

FEW_POINTS = 64
"""Points in which the posterior of what is rather noise is looked at, as wide as the pad."""

FINER = 2.0
"""By how much more precisely an outline is sampled the fewer elements are touched."""

THINNEST = 0.12
"""Half of a rectangle's breadth in pitches, at least, where nothing else is told: a book's edge."""

PRESSURES: dict[str, list[float]] = {EVEN: [], **FIRST}
"""What each pressure estimates beside an even face's numbers, where its fit begins."""


@dataclass(frozen=True)
class AnyPad:
    """Fits of an outline that take law, gains, voids, strays and pressure from the frame itself.

    Parameters
    ----------
    told : Model
        An outline on the pad as told: the middle of every guess.
    law : float
        As in `learned`; 0 where gains were learned, since readings then scatter as these are good.
    quick : bool
        Whether no fit is sampled, but one with an angle that reaches over the pad's edge: each
        stands for itself as a normal distribution, an even face's with the law's exponent, and
        other pressures are looked at where the pattern is clear. A fainter one widens the
        posterior. On small pads only: see `suited`.
    sampled_above_cm : float
        The deviation of its centre from which on a quick disc is sampled after all.
    unevened : AnyPad, optional
        Where gains were learned: the same for readings that are not divided by them.
    foam_cm : float
        Width of foam that the pad tells of; ``told`` knows of none, since it is undone.

    Notes
    -----
    The outline is fitted with sigma and voids; also under each pressure that an even face leaves a
    pattern of. On a pad of more than 1024 elements a pattern only widens the posterior. The
    likeliest of these fits is sampled with the noise that it has found, an even face with the law's
    exponent; the others stand for themselves as normal distributions, by their evidence over what
    neighbouring elements share.
    """

    told: Model
    law: float = LAW
    quick: bool = False
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
            return cls(its, LAW, settings.quick, above_cm, foam_cm=foam_cm)
        plain = cls(told, LAW, settings.quick, above_cm, foam_cm=foam_cm)
        return cls(changed(told, noise=noise), 0.0, settings.quick, above_cm, plain, foam_cm)

    @cached_property
    def _on_large_pads(self) -> AnyPad:
        return changed(self.told_of_foam, quick=False)

    def suited(self, readings: Readings) -> AnyPad:
        """Return these fits, or those for pads of more than 1024 elements.

        They are not quick, and know of the foam that is told, since none is undone there.
        """
        large = readings.states.size > LARGE_PAD
        return self._on_large_pads if large and (self.quick or self.foam_cm > 0.0) else self

    @cached_property
    def _kept(self) -> dict[str, Model]:
        return {}

    def _fit(self, pressure: str) -> Model:
        """Return the model that estimates sigma and voids with the outline, under a pressure."""
        found = self._kept.get(pressure)
        if found is None:
            own = ["contrast"] if self.quick else []
            parts = own if pressure == EVEN else [pressure]
            found = self._kept[pressure] = self._search(self.told.noise, *parts, "sigma", "voids")
        return found

    @cached_property
    def _count(self) -> int:
        return unknowns.call(self.told.kind, self.told.corners) + 1

    def _with(self, noise: Noise, *estimated: str) -> Model:
        return changed(self.told, noise=changed(noise, estimated=estimated))

    def _search(self, noise: Noise, *estimated: str) -> Model:
        """Return a model that goes over the pad's edge, unless it must not, as if there were none.

        Where the edge makes a step in the prior, a search would be caught before it.
        """
        whole = 1.0 if self.told.whole >= 1.0 else 0.0
        return changed(self._with(noise, *estimated), whole=whole)

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
        attempts. Not so on pads of more than 1024 elements, nor of an outline with an angle, which
        would rather be caught there.
        """
        model, large = self._fit(EVEN), readings.states.size > LARGE_PAD
        some = None if large or self.told.kind != DISC else without_alone(readings)
        if some is None or (rough := model.likeliest(some)).mode.height == -math.inf:
            return self, model.likeliest(readings)
        if not (strays := self.strays(readings, rough)):
            return self, self.near(readings, self.told.point_of(rough))
        its = self.knowing(strays)
        model, near = its._fit(EVEN), its.near(readings, self.told.point_of(rough))
        return its, among_strays(model, readings, model.likeliest(readings, near, attempts=SECOND))

    def cleared(self, readings: Readings, even: Likeliest) -> tuple[Readings, Likeliest]:
        """Return readings free of a limit and a law's improbable bend, of foam and a hollow.

        With their outline, and on elements as large as they tell. Only on pads of up to 1024
        elements.
        """
        if readings.states.size > LARGE_PAD or even.mode.height == -math.inf:
            return readings, even
        model = self._fit(EVEN)
        readings, even = unheld(model, readings, even)
        if (bare := unbent(readings)) is not None:
            readings, even = self._by_law(readings, even, *bare)
        if self.foam_cm > 0.0 or asked_by([even.fit], [FOAM], self._faint):
            its = without_foam(readings, self.foam_cm)
            if its is not None:
                readings, even = its, self.near(its, self.told.point_of(even))
        p = self.told.point_of(even)
        rim = without_hollow(self.told.kind, readings, p, float(p[-1]))
        if rim is not None:
            readings, even = rim, self.near(rim, p)
        return (readings, even) if readings.through_foam else sized(model, readings, even)

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
        return self._fit(EVEN).likeliest_near(readings, point)

    def searched(self, readings: Readings, near: Likeliest) -> Likeliest:
        """Return the same after all attempts that are worth their time.

        Where a quick answer will do, a first attempt that finds no more than ``near`` is the last.
        """
        if not self.quick:
            return self._fit(EVEN).likeliest(readings, near, attempts=EVERY)
        even = self._fit(EVEN).likeliest(readings, near)
        if -math.inf < even.mode.height <= near.mode.height + SAME:
            return even._replace(unsure=False)
        return self.sought(readings, even)

    def sought(self, readings: Readings, even: Likeliest) -> Likeliest:
        """Return the same after more attempts, where the first ones left that open."""
        more = even.unsure
        return self._fit(EVEN).likeliest(readings, even, attempts=MORE) if more else even

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
        near, model = self.near(readings, self.told.point_of(even)), self._fit(EVEN)
        large = readings.states.size > LARGE_PAD
        if large and not near.unsure:
            return near
        found = model.likeliest(readings, near, attempts=MORE)
        return found if large else among_strays(model, readings, found)

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
        large, model = readings.states.size > LARGE_PAD, self._fit(EVEN)
        if not large:
            even = self.sought(readings, even)
        if readings.touched <= FEW:
            even = around_clump(model, readings, even)
        if even.mode.height == -math.inf:
            raise self.told.impossible(readings)
        its = self
        if alone and (strays := self.strays(readings, even)):
            its, even = self.likelier_with(strays, readings, even)
        elif large and even.unsure:
            even = model.likeliest(readings, even, attempts=MORE)
        if not large:
            even = beyond_the_edge(its._fit(EVEN), readings, even)
        found = {EVEN: even}
        asked = [] if large else asked_by([even.fit], FIRST, CLEAR if self.quick else self._faint)
        if asked and "fall" not in asked and self._has_no_foam(readings):
            asked = [part for part in asked if part != FOAM]  # that of own gains falls to the rim
        hidden = bool(asked) and self._reaches_beyond(readings, even)
        for part in asked:
            if hidden and part != FOAM:
                continue
            top = its._pressed(part, readings, even)
            if hidden and self._reaches_beyond(readings, top):
                continue
            if top.mode.height > -math.inf:
                found[part] = top
        return found

    @cached_property
    def _faint(self) -> Pattern:
        return FAINT._replace(fall=SHARPER) if self.told.kind == RECTANGLE else FAINT

    def _reaches_beyond(self, readings: Readings, top: Likeliest) -> bool:
        """Return whether a most likely outline is partly beyond the pad's edge.

        Foam, which makes outlines too large, may be why.
        """
        return is_partly_hidden(self.told.kind, readings, self.told.point_of(top))

    def _pressed(self, part: str, readings: Readings, even: Likeliest) -> Likeliest:
        n, p = self._count, self.told.point_of(even)
        begin = np.concatenate([p[:n], PRESSURES[part], p[-2:]])
        if part == "fall":
            begin[2 : 2 + sizes.call(self.told.kind)] *= 1.0 + WIDER
        return self._fit(part).likeliest_near(readings, begin)

    def around(self, readings: Readings, tops: Mapping[str, Likeliest]) -> Posterior:
        """Return the posterior around the most likely outlines, over all pressures."""
        # A pressure is told by all of a face: elements count for as much less along both axes.
        shared = shared_by(tops.values(), readings.touched) ** 2
        odds = FOAM_ODDS * self._foam_by_scatter(tops, readings)
        logs = log_chances(tops, shared, readings.touched, odds)
        best = max(logs, key=logs.__getitem__)
        shares = {part: math.exp(log - logs[best]) for part, log in logs.items()}
        found = {best: self._looked_at(best, readings, tops[best])}
        for part, share in shares.items():
            if part != best and share > NEGLIGIBLE:
                found[part] = self._normal(part, readings, tops[part])
        its = found[best]
        if len(found) > 1:
            weighed = {p: changed(f, log_evidence=math.log(shares[p])) for p, f in found.items()}
            its = mixed(weighed, dict.fromkeys(weighed, 1.0))
        elif best != EVEN:
            its = changed(its, pressures={best: 1.0})
        if readings.through_foam is not None:
            its = changed(its, pressures=on_foam(its.pressures))
        total = sum(shares.values())
        pressed = sum(share * self._wider(part) for part, share in shares.items()) / total
        evidence = tops[EVEN].evidence + logs[best] - logs[EVEN]
        hidden = self._hidden(its.alike, readings, len(tops)) + readings.length_std_cm**2
        whole = self._on_any_pad(its, readings, evidence, pressed, hidden)
        if best == EVEN and (missed := self._missed(readings, tops[EVEN])) > 0.0:
            whole = changed(whole, lopsided=missed)
        if is_row(readings):
            whole = within(whole, *self.told.range_cm(readings))
        large = readings.states.size > LARGE_PAD
        if self.told.kind != RECTANGLE or self.quick or large:
            return whole
        whole = resized(whole, UNSEEN * unseen_share(tops[EVEN].fit.fall))
        return whole if self._reaches_beyond(readings, tops[best]) else evenly_spread(whole)

    def _missed(self, readings: Readings, even: Likeliest) -> float:
        """Return how much what an even face's outline misses lies to a side, 0 where foam blurs it.

        Nor is it looked at on a pad of more than 1024 elements.
        """
        foam = self.told.noise.foam_cm > 0.0 or readings.through_foam is not None
        if foam or readings.states.size > LARGE_PAD:
            return 0.0
        point = self.told.point_of(even)
        return lopsided.call(self.told.kind, point, readings.grid, readings.states)

    @staticmethod
    def _has_no_foam(readings: Readings) -> bool:
        """Return whether no foam shares elements' gains."""
        return readings.through_foam is None and has_no_foam(readings)

    def _foam_by_scatter(self, tops: Mapping[str, Likeliest], readings: Readings) -> float:
        """Return by how much readings' scatter makes foam more probable than a round face."""
        if "fall" not in tops or FOAM not in tops:
            return 1.0
        if self._has_no_foam(readings):
            return 0.0
        told = math.log(self.told.noise.sigma)
        by_foam, by_face = (float(tops[part].mode.p[-2]) - told for part in (FOAM, "fall"))
        return evened_by_foam(by_foam, by_face, readings.touched)

    def _wider(self, part: str) -> float:
        """Return by how much the variance under a pressure is larger than that of its fit."""
        told = TOLD_FOAM if part == EVEN and self.told.noise.foam_cm > 0.0 else 0.0
        wider = 1.0 + PRESSED.get(part, told)
        if self.told.kind == DISC:
            return wider
        if self.quick:
            return UNSURER * wider
        return UNSUREST * wider if part != EVEN and self.told.kind == RECTANGLE else wider

    def _hidden(self, alike: float, readings: Readings, n_looked_at: int) -> float:
        """Return the variance in cm^2 of lengths that a pattern hides where it is not looked into.

        Parameters
        ----------
        alike : float
            As of the posterior.
        readings : Readings
        n_looked_at : int
            Pressures, the even one counted.
        """
        if self.quick:
            left = hidden_by(alike, readings) if n_looked_at == 1 else 0.0
            return left + looseness(readings)
        large = readings.states.size > LARGE_PAD
        return hidden_by(PATTERN, readings) if large and alike > PATTERN else 0.0

    def _on_any_pad(
        self, its: Posterior, readings: Readings, evidence: float, pressed: float, hidden: float
    ) -> AnyPadPosterior:
        """Return a posterior widened by its pressure, and by what a pattern may hide.

        ``pressed`` is a factor on its variance, ``hidden`` a variance in cm^2 of its lengths.
        """
        unevenness = self.told.noise.sigma * float(readings.grid[2]) ** 1.5
        whole = on_any_pad(its, evidence, pressed, unevenness, hidden)
        if readings.filtered:
            whole = as_filtered(whole, float(readings.grid[2]))
        return stretched(whole, readings)

    def _normal(self, part: str, readings: Readings, top: Likeliest) -> Posterior:
        """Return the normal distribution around a fit, widened by what neighbours share."""
        row = is_row(readings)
        if part == EVEN and self.quick:
            its = self.told.normal_around(top, self._count + 1, self._pull(readings, top), row)
        else:
            own = 0 if part == EVEN else len(PRESSURES[part])
            its = self.told.normal_around(top, self._count + own, row=row)
        return inflated(its, variance_inflation(top.fit.neighbours, readings.touched))

    def _pull(self, readings: Readings, top: Likeliest) -> Values:
        """Return the slope of what the fit's own scatter says of the law's exponent."""
        pull = np.zeros(self._count + 1)
        contrast = contrast_of(self.told.noise, float(top.mode.p[-2]), readings, self.law)
        pull[-1] = (contrast.power - self.told.noise.contrast) / SPREADS[CONTRAST] ** 2
        return pull

    def _looked_at(self, part: str, readings: Readings, top: Likeliest) -> Posterior:
        """Return a likeliest fit's posterior: sampled, but for an outline with an angle pressed.

        That has nine unknowns and more, for which few points are worse than none. Nor is a sample
        taken whose points are worth fewer than there are unknowns, as where strays explain all
        there is, unless it promises less than a normal distribution around the top.
        """
        if self.quick and not self._reaches_beyond(readings, top):
            normal = self._normal(part, readings, top)
            if self.told.kind != DISC or normal.centre_std_cm <= self.sampled_above_cm:
                return normal
        if part != EVEN and self.told.kind != DISC:
            return self._normal(part, readings, top)
        try:
            found = self._sampled(part, readings, top)
        except Degenerate:
            return self._normal(part, readings, top)
        if found.equal_points > self._count:
            return found
        return max(found, self._normal(part, readings, top), key=lambda its: its.centre_std_cm)

    def _sampled(self, part: str, readings: Readings, top: Likeliest) -> Posterior:
        """Return the posterior under a pressure, with the noise that its fit has found.

        Where neighbours are alike, readings scatter less about their own mean than gains do, by as
        much as elements are shared.
        """
        point = self.told.point_of(top)
        shared = variance_inflation(top.fit.neighbours, readings.touched)
        large = readings.states.size > LARGE_PAD
        strays = strays_beyond(self.told, readings, point)
        contrast, by_law = AS_LOADS, part == EVEN and not large
        if by_law:
            contrast = contrast_of(self.told.noise, float(point[-2]), readings, self.law)
        noise = learned(self.told.noise, point[-2:], readings.touched, strays, contrast, shared)
        loose = looseness(readings)
        if part == EVEN and self.quick and self.told.kind == DISC:
            return self._with(noise, "contrast").posterior_around(
                readings, _first(top, 1 + self._count), loose
            )
        # Of few elements a point costs little, and the posterior is far from normal.
        precision = self.told.precision / (1.0 + FINER * fewness(readings))
        estimated = "contrast" if by_law else part
        noise = changed(noise, estimated=() if estimated == EVEN else (estimated,))
        model = changed(self.told, noise=noise, precision=precision)
        if by_law:
            begin = point[: self._count + 1].copy()
            begin[-1] = noise.contrast
            if is_scattered(self.told.kind, readings, point):
                model = changed(model, most_points=FEW_POINTS)
            return model.posterior_near(readings, begin, loose)
        mode = _first(top, self._count + len(PRESSURES[part]))
        return model.posterior_around(readings, mode, loose)


def _first(top: Likeliest, count: int) -> Mode:
    """Return the first numbers of a top, the others known."""
    return Mode(top.mode.p[:count].copy(), top.mode.root[:count, :count].copy(), top.mode.height)
