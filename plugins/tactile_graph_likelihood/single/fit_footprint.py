"""``fit_footprint``: the posterior of an outline of any shape."""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Ge, Le

from tactile_graph.steps import Spread
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, FREE, RECTANGLE, REGULAR
from tactile_graph_likelihood.settings import DEFAULTS, FootprintSettings, Load
from tactile_graph_likelihood.single.likely import Likely, likely

KINDS = {
    "disc": DISC,
    "ellipse": ELLIPSE,
    "rectangle": RECTANGLE,
    "regular": REGULAR,
    "polygon": FREE,
}


class FitFootprint:
    """Return the posterior mean of an outline, with its uncertainty and evidence.

    Parameters
    ----------
    shape : str
        ``regular`` is a regular polygon, ``polygon`` any convex one.
    corners : int
        Of a polygon.
    settings : FootprintSettings

    Notes
    -----
    An element covered by the share c of its area reads nothing with the probability v of a void,
    else s c g with the load s of a fully covered element and a lognormal gain g; what falls
    below the least load that shows reads nothing too. Priors are proper: place uniform over the
    pad, sizes log-uniform over their range, s log-uniform over four decades, angle uniform,
    corners of a free polygon uniform over all convex ones. The posterior is looked at from its
    top by adaptive importance sampling.

    With ``pressure: any`` the answer is a mixture: an even face with a probability of 0.7
    beforehand, a leaning one 0.15, one whose load falls to its rim, round or through foam, 0.15.

    ``fits`` is False where the readings are less likely than the model's own by more than three
    standard deviations, or where the gains left over have a pattern: neighbours alike, a lean to
    one side, a fall or rise towards the rim.
    """

    stateless = True

    def __init__(
        self,
        *,
        shape: Literal["disc", "ellipse", "rectangle", "regular", "polygon"] = "disc",
        corners: Annotated[int, Ge(3), Le(12)] = 4,
        settings: Annotated[FootprintSettings, Spread()] = DEFAULTS,
    ) -> None:
        kind = KINDS[shape]
        sides = corners if kind in (REGULAR, FREE) else 0
        self.model = settings.model(kind, sides)
        self.posterior = settings.asked_model(kind, sides).posterior

    def __call__(self, image: Load) -> Likely:
        """Return the outline.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.

        Raises
        ------
        RuleError
            If the image's cells are not square.
        Degenerate
            If nothing is touched, or no such outline on the pad explains what is.
        """
        return likely(self.posterior(image))
