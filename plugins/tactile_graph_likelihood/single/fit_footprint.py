"""``fit_footprint``: the posterior of an outline of any shape."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from annotated_types import Ge, Gt, Le, Lt

from tactile_graph.wires import Circle, Ellipse, Polygon, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, FREE, RECTANGLE, REGULAR
from tactile_graph_likelihood.single.any_pressure import AnyPressure
from tactile_graph_likelihood.single.footprint_of import Load, Part, Positive, Share, model_of
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
    pad : str or mapping
        Name of a pad, its YAML file, or the pad itself: gap, unevenness, foam and the least load
        that shows come from it, unless given here.
    sigma : float, optional
        Standard deviation of the logarithm of an element's gain.
    voids : float, optional
        Share of covered elements that read nothing.
    strays : float
        Probability that a reading has nothing to do with the object.
    foam_cm : float, optional
        Width over which foam spreads the load.
    gap_cm : float, optional
        Distance of neighbouring elements' edges.
    shows_from : float, optional
        Readings below it count as nothing, in the image's unit.
    estimate : list
        What of sigma, voids, foam and the pressure's fall and lean is estimated with the object.
    pressure : "any" or "even"
        Whether the object may press unevenly: leaning, less towards its rim, or through foam.
        Looked at where an even face leaves that pattern over, and weighed by the evidence.
    on_pad : "whole" or "partly"
        Whether the whole outline lies on the pad, or its centre only. Free polygons are whole.
    smallest_cm, largest_cm : float, optional
        Range of radii and half sides; 0.4 pitches and the pad's diagonal if not given.
    precision : float
        Error of the mean, over the posterior's own standard deviation, at which sampling ends.
    most_points : int
        Where it ends at the latest.
    seed : int
        Shifts the points at which the posterior is looked at.

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
        pad: str | dict[str, Any] = "thesis",
        sigma: Positive | None = None,
        voids: Annotated[float, Ge(0), Lt(1)] | None = None,
        strays: Share = 1e-3,
        foam_cm: Annotated[float, Ge(0)] | None = None,
        gap_cm: Annotated[float, Ge(0)] | None = None,
        shows_from: Annotated[float, Ge(0)] | None = None,
        estimate: list[Part] = [],  # noqa: B006 - settings are never changed
        pressure: Literal["any", "even"] = "any",
        on_pad: Literal["whole", "partly"] = "partly",
        smallest_cm: Positive | None = None,
        largest_cm: Positive | None = None,
        precision: Annotated[float, Gt(0), Le(1)] = 0.15,
        most_points: Annotated[int, Ge(32)] = 1024,
        seed: Annotated[int, Ge(0)] = 0,
    ) -> None:
        kind = KINDS[shape]
        self.model = model_of(
            kind, corners if kind in (REGULAR, FREE) else 0, pad, sigma, voids, strays, foam_cm,
            gap_cm, shows_from, estimate, on_pad, smallest_cm, largest_cm, precision,
            most_points, seed,
        )  # fmt: skip
        model = AnyPressure(self.model) if pressure == "any" else self.model
        self.posterior = model.posterior

    def __call__(
        self, image: Load, start: Circle | Ellipse | Rectangle | Polygon | None = None
    ) -> Likely:
        """Return the outline.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.
        start : Circle, Ellipse, Rectangle or Polygon, optional
            Where to begin, of the same shape; the touched elements' moments otherwise.

        Raises
        ------
        ValueError
            If ``start`` is of another shape, or the image's cells are not square.
        Degenerate
            If nothing is touched, or no such outline on the pad explains what is.
        """
        return likely(self.posterior(image, start))
