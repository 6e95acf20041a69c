"""``AnyPadPosterior``: a posterior whose flag is about how far off it may be."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tactile_graph_likelihood.geometry.outlines import DISC, Values, sizes
from tactile_graph_likelihood.single.changed import changed, fields_of
from tactile_graph_likelihood.single.posterior import Posterior

USUAL, ALONG = 0.36, 1.25
"""Deviation of a disc's centre over ``sigma pitch sqrt(pitch / radius)``, and how much larger that
of an outline with two sizes is, whose ends are short."""

VAGUE, STRANGE = 3.5, -6.0
"""Times the usual deviation from which on an answer counts as vague, and the surprise from which on
readings count as none of the model's: above it they are those of good answers beside strays."""

LOPSIDED = 3.0
"""Standard deviations by which what an outline misses lies to a side from which on it is another
shape's. Of 24000 frames of discs and rectangles none had more than 2.9; nine dead elements in a
block come near it."""

DISC_EVENLY = 8.0
"""Independent points that one of a disc's evenly spread points is worth; of other outlines, as they
are sampled, one."""

LEAST = 1e-6  # cm: a size that is none


@dataclass(frozen=True, eq=False)
class AnyPadPosterior(Posterior):
    """A posterior on a pad that need not be the one that is told.

    Parameters
    ----------
    usual_std_cm : float
        Deviation of the centre that readings as even as told would leave.
    evenly : float
        Independent points that one of its own is worth.
    lopsided : float
        How much what the outline misses lies to a side, in standard deviations.
    in_parts : bool
        Whether what is touched lies in parts, as of two objects, or is likelier two discs that
        touch.
    filtered : bool
        Whether the image seems smoothed, median-filtered or enlarged: deviations are wider for it.
    ghosts : bool
        Whether the frame looks as if it was read from a matrix without isolation, see `ghosts`.
    """

    usual_std_cm: float = math.inf
    evenly: float = 1.0
    lopsided: float = 0.0
    in_parts: bool = False
    filtered: bool = False
    ghosts: bool = False

    @property
    def independent_points(self) -> float:
        """How many points, each by itself, would tell the covariance as well."""
        return self.evenly * self.equal_points

    @property
    def fits(self) -> bool:
        """Whether the readings place the outline about as well as they should.

        They do not where they are less likely than the model's own, whatever is estimated with the
        outline; where strays on a bare pad explain them as well; where what the outline misses lies
        to a side; where what is touched is rather two objects, or seems to hold ghosts; or where
        the centre's deviation is three and a half times the usual one.
        """
        if self.surprise <= STRANGE or self.log_evidence <= 0.0:
            return False
        if self.lopsided >= LOPSIDED or self.in_parts or self.ghosts:
            return False
        return self.centre_std_cm < VAGUE * self.usual_std_cm


def on_any_pad(
    found: Posterior,
    log_evidence: float,
    inflation: float,
    unevenness: float,
    hidden_cm2: float = 0.0,
    lopsided: float = 0.0,
    in_parts: bool = False,
    excused_cm2: float = 0.0,
) -> AnyPadPosterior:
    """Return a posterior with another evidence, its variance inflated, its usual deviation told.

    Parameters
    ----------
    found : Posterior
    log_evidence : float
    inflation : float
        Of its variance, at least 1.
    unevenness : float
        Standard deviation of ln gain, as told, times the pitch in cm to the power 3/2.
    hidden_cm2 : float
        Variance of its lengths that no fit tells of, as where a pattern of the load is left over.
    lopsided, in_parts : float, bool
        As of `AnyPadPosterior`.
    excused_cm2 : float
        Of the hidden variance, what makes no answer vague: whether it ``fits`` is judged without.
    """
    size, usual = float(found.mean[2]), USUAL
    if found.kind != DISC:
        size, usual = math.sqrt(abs(size * float(found.mean[3]))), ALONG * USUAL
    values = fields_of(found)
    usual_cm = usual * unevenness / math.sqrt(max(size, LEAST))
    values["usual_std_cm"] = math.hypot(usual_cm, math.sqrt(2.0 * excused_cm2) / VAGUE)
    values["log_evidence"] = log_evidence
    values |= _wider(found, inflation)
    if hidden_cm2 > 0.0:
        covariance, lengths = values["covariance"].copy(), 2 + sizes.call(found.kind)
        covariance.flat[: lengths * (len(covariance) + 1) : len(covariance) + 1] += hidden_cm2
        values["covariance"] = covariance
    values["evenly"] = DISC_EVENLY if found.kind == DISC else 1.0
    values["lopsided"], values["in_parts"] = lopsided, in_parts
    values["filtered"] = values["ghosts"] = False
    its = object.__new__(AnyPadPosterior)
    vars(its).update(values)  # a frozen dataclass sets its fields one by one, by a call each
    return its


def inflated(found: Posterior, inflation: float) -> Posterior:
    """Return a posterior whose variance is so many times as large, at least 1."""
    return changed(found, **wider) if (wider := _wider(found, inflation)) else found


def _wider(found: Posterior, inflation: float) -> dict[str, Values]:
    if inflation <= 1.0:
        return {}
    points = found.mean + math.sqrt(inflation) * (found.points - found.mean)
    return {"covariance": inflation * found.covariance, "points": points}
