"""``locate_disc``, ``locate_rectangle``, ``locate_ellipse``: an outline on any pad."""

from __future__ import annotations

from typing import Annotated

from tactile_graph.steps import Spread
from tactile_graph.wires import Image
from tactile_graph_likelihood.any_pad.fits.first_fit import first_fit
from tactile_graph_likelihood.any_pad.fits.localise import AnyPad
from tactile_graph_likelihood.any_pad.fits.wide import completed_on_wide
from tactile_graph_likelihood.any_pad.observation.learned_pad import Placing
from tactile_graph_likelihood.any_pad.observation.observed import NearlySquare
from tactile_graph_likelihood.any_pad.uncertainty.around import posterior_around
from tactile_graph_likelihood.any_pad.uncertainty.ghosts import tells_of_ghosts
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.settings import LocateSettings
from tactile_graph_likelihood.single.likely import (
    LikelyCircle,
    LikelyEllipse,
    LikelyRectangle,
    likely,
)
from tactile_graph_likelihood.single.posterior import Posterior

ANY_PAD = LocateSettings()

_SAID = ("pad", "gap_cm", "on_pad", "smallest_cm", "largest_cm", "precision")
AnyPadSettings = Annotated[LocateSettings, Spread(*_SAID)]
SoonSettings = Annotated[LocateSettings, Spread(*_SAID, "quick")]
"""What may be said of one outline on any pad, and how soon it is wanted."""


class LocateOne:
    """What the three have in common.

    Parameters
    ----------
    settings : LocateSettings
    """

    stateless = True
    notice = staticmethod(tells_of_ghosts)
    _kind = DISC

    def __init__(self, settings: SoonSettings = ANY_PAD) -> None:
        self._pad, self._gap_cm = settings.known_pad, settings.gap_cm
        self._any_pad = AnyPad.of(settings, self._kind)
        self._placing = Placing(self._pad)

    def posterior(self, image: Image) -> Posterior:
        """Return the outline's posterior; parameters and errors as of a call."""
        fits, readings, even = first_fit(image, self._pad, self._gap_cm, self._any_pad)
        if readings.is_wide:
            readings, tops = completed_on_wide(fits, readings, even)
        else:
            tops = fits.completed(readings, even)
        found = posterior_around(fits, readings, tops)
        return self._placing(image, [found])[0]


class LocateDisc(LocateOne):
    """Return the posterior mean of a disc on a pad that need not be as it is told.

    Parameters
    ----------
    settings : LocateSettings

    Notes
    -----
    What counts as touched follows from the noise in the frame itself; law, gains, voids, strays and
    pressure are estimated with the outline, what the pad says being the middle of the guess. Any
    quantity that rises with load will do. ``fits`` is False where the readings leave the centre
    3.5 times as uncertain as those of a pad as told would, or are less likely than the model's own,
    or where elements that the outline misses lie to a side, as of a T.
    """

    _kind = DISC

    def __init__(
        self,
        settings: Annotated[LocateSettings, Spread(*_SAID, "quick", "sampled_above_cm")] = ANY_PAD,
    ) -> None:
        super().__init__(settings)

    def __call__(self, image: NearlySquare) -> LikelyCircle:
        """Return the disc.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the image's cells are not nearly square, or a pad was learned, of another shape,
            pitch or quantity.
        Degenerate
            If nothing rises above the noise, or no disc on the pad explains what does.
        """
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyCircle)
        return found


class LocateRectangle(LocateOne):
    """Return the posterior mean of a rectangle on any pad; see `locate_disc`."""

    _kind = RECTANGLE

    def __call__(self, image: NearlySquare) -> LikelyRectangle:
        """Return the rectangle; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyRectangle)
        return found


class LocateEllipse(LocateOne):
    """Return the posterior mean of an ellipse on any pad; see `locate_disc`."""

    _kind = ELLIPSE

    def __call__(self, image: NearlySquare) -> LikelyEllipse:
        """Return the ellipse; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyEllipse)
        return found
