"""``footprint_disc``, ``footprint_rectangle``, ``footprint_ellipse``: one shape's posterior."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

from annotated_types import Ge, Gt, Le, Lt

from tactile_graph.steps import Quantity
from tactile_graph.wires import Circle, Ellipse, Image, Rectangle
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE
from tactile_graph_likelihood.single.any_pressure import AnyPressure
from tactile_graph_likelihood.single.likely import (
    LikelyCircle,
    LikelyEllipse,
    LikelyRectangle,
    likely,
)
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.noise import noise_of

Positive = Annotated[float, Gt(0)]
Share = Annotated[float, Gt(0), Lt(1)]
Part = Literal["sigma", "voids", "foam", "fall", "lean"]
Load = Annotated[Image, Quantity("gram", "kilopascal", "raw", "counts", "level")]


class Footprint:
    """What the three have in common: a model from settings.

    Parameters
    ----------
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
        Whether the whole outline lies on the pad, or its centre only.
    smallest_cm, largest_cm : float, optional
        Range of radii and half sides; 0.4 pitches and the pad's diagonal if not given.
    precision : float
        Error of the mean, over the posterior's own standard deviation, at which sampling ends.
    most_points : int
        Where it ends at the latest.
    seed : int
        Shifts the points at which the posterior is looked at.
    """

    stateless = True
    _kind = DISC

    def __init__(
        self,
        *,
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
        self.model = model_of(
            self._kind, 0, pad, sigma, voids, strays, foam_cm, gap_cm, shows_from, estimate,
            on_pad, smallest_cm, largest_cm, precision, most_points, seed,
        )  # fmt: skip
        model = AnyPressure(self.model) if pressure == "any" else self.model
        self.posterior = model.posterior


def model_of(
    kind: int,
    corners: int,
    pad: str | Path | dict[str, Any],
    sigma: float | None,
    voids: float | None,
    strays: float,
    foam_cm: float | None,
    gap_cm: float | None,
    shows_from: float | None,
    estimate: list[Part],
    on_pad: str,
    smallest_cm: float | None,
    largest_cm: float | None,
    precision: float,
    most_points: int,
    seed: int,
) -> Model:
    """Return the model that the settings of `Footprint` mean."""
    from tactile_graph_pads.pad import load_pad

    if smallest_cm is not None and largest_cm is not None and smallest_cm >= largest_cm:
        raise ValueError(
            f"smallest_cm: must be below largest_cm, got {smallest_cm:g} and {largest_cm:g}"
        )
    known = load_pad(pad)
    noise = noise_of(
        known, sigma=sigma, voids=voids, strays=strays, foam_cm=foam_cm, least=shows_from,
        estimated=tuple(dict.fromkeys(estimate)),
    )  # fmt: skip
    gap = known.geometry.gap_cm if gap_cm is None else gap_cm
    whole = on_pad == "whole"
    return Model(
        kind, corners, noise, gap, whole, smallest_cm or 0.0, largest_cm or math.inf, precision,
        most_points, seed,
    )  # fmt: skip


class FootprintDisc(Footprint):
    """Return the posterior mean of a disc, with its uncertainty; see `fit_footprint`."""

    _kind = DISC

    def __call__(self, image: Load, start: Circle | None = None) -> LikelyCircle:
        """Return the disc.

        Parameters
        ----------
        image : Image
            Loads; invalid cells say nothing.
        start : Circle, optional
            Where to begin; the touched elements' moments otherwise.

        Raises
        ------
        Degenerate
            If nothing is touched, or no disc on the pad explains what is.
        """
        found = likely(self.posterior(image, start))
        assert isinstance(found, LikelyCircle)
        return found


class FootprintRectangle(Footprint):
    """Return the posterior mean of a rectangle; settings as of `footprint_disc`."""

    _kind = RECTANGLE

    def __call__(self, image: Load, start: Rectangle | None = None) -> LikelyRectangle:
        """Return the rectangle; parameters and errors as for a disc."""
        found = likely(self.posterior(image, start))
        assert isinstance(found, LikelyRectangle)
        return found


class FootprintEllipse(Footprint):
    """Return the posterior mean of an ellipse; settings as of `footprint_disc`."""

    _kind = ELLIPSE

    def __call__(self, image: Load, start: Ellipse | None = None) -> LikelyEllipse:
        """Return the ellipse; parameters and errors as for a disc."""
        found = likely(self.posterior(image, start))
        assert isinstance(found, LikelyEllipse)
        return found
