"""``locate_disc``, ``locate_rectangle``, ``locate_ellipse``: an outline on any pad."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge

from tactile_graph.steps import Spread
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.learned_pad import Placing
from tactile_graph_likelihood.any_pad.localise import AnyPad
from tactile_graph_likelihood.any_pad.observed import observed
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.settings import FootprintSettings
from tactile_graph_likelihood.single.likely import (
    LikelyCircle,
    LikelyEllipse,
    LikelyRectangle,
    likely,
)
from tactile_graph_likelihood.single.posterior import Posterior

QUICK = FootprintSettings(precision=0.3, most_points=768, on_pad="mostly")
"""Points enough for a mean whose own error does not matter beside the posterior's deviation."""

AnyPadSettings = Annotated[
    FootprintSettings,
    Spread("pad", "gap_cm", "on_pad", "smallest_cm", "largest_cm", "precision"),
]
"""What may be said of one outline on any pad."""


class Located:
    """What the three have in common; parameters as of `LocateDisc`."""

    stateless = True
    _kind = DISC

    def __init__(
        self,
        settings: AnyPadSettings = QUICK,
        *,
        quick: bool = False,
    ) -> None:
        self._set(settings, AnyPad.of(settings, self._kind, quick))

    def _set(self, settings: FootprintSettings, any_pad: AnyPad) -> None:
        self._pad, self._gap_cm = settings.known_pad, settings.gap_cm
        self._any_pad = any_pad
        self._placing = Placing(self._pad)

    def posterior(self, image: Image) -> Posterior:
        """Return the outline's posterior; parameters and errors as of a call."""
        readings = observed(image, self._pad, self._gap_cm)
        fits = self._any_pad.suited(readings)
        readings, even = fits.first(readings)
        found = fits.around(readings, fits.completed(readings, even))
        return self._placing(image, [found])[0]


class LocateDisc(Located):
    """Return the posterior mean of a disc on a pad that need not be as it is told.

    Parameters
    ----------
    quick : bool
        Whether the most likely disc will do, with a normal distribution around it: less than half
        of the time on pads of up to 1024 elements. Pressures other than an even one are looked at
        where its pattern is clear; a fainter one widens the distribution.
    sampled_above_cm : float, optional
        With ``quick``: the centre's deviation from which on points around the most likely disc are
        weighed after all, 0 for always. Their mean errs some 5 % less and takes a quarter more
        time.
    settings : FootprintSettings

    Notes
    -----
    What counts as touched follows from the noise in the frame itself; law, gains, voids, strays and
    pressure are estimated with the outline, what the pad says being the middle of the guess. Any
    quantity that rises with load will do. ``fits`` is False where the readings leave the centre
    3.5 times as uncertain as those of a pad as told would, or are less likely than the model's own.
    """

    _kind = DISC

    def __init__(
        self,
        settings: AnyPadSettings = QUICK,
        *,
        quick: bool = False,
        sampled_above_cm: Annotated[float, Ge(0)] | None = None,
    ) -> None:
        self._set(settings, AnyPad.of(settings, self._kind, quick, sampled_above_cm))

    def __call__(self, image: Image) -> LikelyCircle:
        """Return the disc.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the image's cells are not nearly square.
        Degenerate
            If nothing rises above the noise, or no disc on the pad explains what does.
        """
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyCircle)
        return found


class LocateRectangle(Located):
    """Return the posterior mean of a rectangle on any pad.

    Parameters
    ----------
    quick : bool
        Whether the most likely rectangle will do, with a normal distribution around it; see
        `locate_disc`.
    settings : FootprintSettings
    """

    _kind = RECTANGLE

    def __call__(self, image: Image) -> LikelyRectangle:
        """Return the rectangle; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyRectangle)
        return found


class LocateEllipse(Located):
    """Return the posterior mean of an ellipse on any pad.

    Parameters
    ----------
    quick : bool
        Whether the most likely ellipse will do, with a normal distribution around it; see
        `locate_disc`.
    settings : FootprintSettings
    """

    _kind = ELLIPSE

    def __call__(self, image: Image) -> LikelyEllipse:
        """Return the ellipse; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyEllipse)
        return found
