"""``footprint_disc``, ``footprint_rectangle``, ``footprint_ellipse``: one shape's posterior."""

from __future__ import annotations

from typing import Annotated

from tactile_graph.steps import Spread
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.settings import DEFAULTS, FootprintSettings, Load
from tactile_graph_likelihood.single.likely import (
    LikelyCircle,
    LikelyEllipse,
    LikelyRectangle,
    likely,
)


class Footprint:
    """What the three have in common: a model from settings.

    Parameters
    ----------
    settings : FootprintSettings
    """

    stateless = True
    _kind = DISC

    def __init__(self, settings: Annotated[FootprintSettings, Spread()] = DEFAULTS) -> None:
        self.model = settings.model(self._kind)
        self.posterior = settings.asked_model(self._kind).posterior


class FootprintDisc(Footprint):
    """Return the posterior mean of a disc, with its uncertainty; see `fit_footprint`."""

    _kind = DISC

    def __call__(self, image: Load) -> LikelyCircle:
        """Return the disc.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.

        Raises
        ------
        Degenerate
            If nothing is touched, or no disc on the pad explains what is.
        """
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyCircle)
        return found


class FootprintRectangle(Footprint):
    """Return the posterior mean of a rectangle; settings as of `footprint_disc`."""

    _kind = RECTANGLE

    def __call__(self, image: Load) -> LikelyRectangle:
        """Return the rectangle; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyRectangle)
        return found


class FootprintEllipse(Footprint):
    """Return the posterior mean of an ellipse; settings as of `footprint_disc`."""

    _kind = ELLIPSE

    def __call__(self, image: Load) -> LikelyEllipse:
        """Return the ellipse; parameters and errors as for a disc."""
        found = likely(self.posterior(image))
        assert isinstance(found, LikelyEllipse)
        return found
