"""``FootprintSettings``: what the steps of this family take, documented once for all of them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal

from annotated_types import Ge, Gt, Le, Lt

from tactile_graph.steps import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_likelihood.single.any_pressure import AnyPressure
from tactile_graph_likelihood.single.model import Model
from tactile_graph_likelihood.single.noise import Noise, noise_of
from tactile_graph_pads.pad import Pad, load_pad

Positive = Annotated[float, Gt(0)]
Share = Annotated[float, Gt(0), Lt(1)]
Part = Literal["sigma", "voids", "foam", "fall", "lean"]
ON_PAD = {"whole": 1.0, "mostly": 0.99, "partly": 0.0}
"""Probability, before a frame is read, that the whole outline lies on the pad."""
LARGEST_SAMPLE = 32768
"""Points at the finest precision, which take about a second."""
Load = Annotated[
    Image, Quantity("gram", "kilopascal", "raw", "counts", "level"), Grid(square_to=0.0)
]


@dataclass(frozen=True)
class FootprintSettings:
    """What is taken for granted of pad and object, and how closely the posterior is looked at.

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
    on_pad : "whole", "mostly" or "partly"
        Whether the whole outline lies on the pad, or its centre only; in 99 of a hundred cases the
        whole. Free polygons are whole.
    smallest_cm, largest_cm : float, optional
        Range of radii and half sides; 0.4 pitches and the pad's diagonal if not given.
    precision : float
        Error of the mean, over the posterior's own standard deviation, at which sampling ends,
        unless it comes to the most points before, as where few of them are worth much.
    most_points : int, optional
        Where it ends at the latest; if not given 1024, times the square of how much finer
        ``precision`` is than 0.15, up to 32768.
    seed : int
        Shifts the points at which the posterior is looked at.

    Raises
    ------
    ValueError
        If the smallest size is not below the largest.
    """

    pad: str | dict[str, Any] = "thesis"
    sigma: Positive | None = None
    voids: Annotated[float, Ge(0), Lt(1)] | None = None
    strays: Share = 1e-3
    foam_cm: Annotated[float, Ge(0)] | None = None
    gap_cm: Annotated[float, Ge(0)] | None = None
    shows_from: Annotated[float, Ge(0)] | None = None
    estimate: list[Part] = field(default_factory=list)
    pressure: Literal["any", "even"] = "any"
    on_pad: Literal["whole", "mostly", "partly"] = "partly"
    smallest_cm: Positive | None = None
    largest_cm: Positive | None = None
    precision: Annotated[float, Gt(0), Le(1)] = 0.15
    most_points: Annotated[int, Ge(32)] | None = None
    seed: Annotated[int, Ge(0)] = 0
    usual_points: ClassVar[int] = 1024

    def __post_init__(self) -> None:
        smallest, largest = self.smallest_cm, self.largest_cm
        if smallest is not None and largest is not None and smallest >= largest:
            raise ValueError(
                f"smallest_cm: must be below largest_cm, got {smallest:g} and {largest:g}"
            )

    @cached_property
    def known_pad(self) -> Pad:
        """The pad."""
        return load_pad(self.pad)

    @property
    def gap(self) -> float:
        """Distance of neighbouring elements' edges in cm: the given one, or the pad's."""
        return self.known_pad.geometry.gap_cm if self.gap_cm is None else self.gap_cm

    @property
    def points(self) -> int:
        """Points at which sampling ends at the latest: as told, or enough for the precision."""
        if self.most_points is not None:
            return self.most_points
        finer = max(type(self).precision / self.precision, 1.0)
        return math.ceil(min(self.usual_points * finer * finer, LARGEST_SAMPLE))

    @property
    def noise(self) -> Noise:
        """The pad's noise, but for what is given."""
        return noise_of(
            self.known_pad, sigma=self.sigma, voids=self.voids, strays=self.strays,
            foam_cm=self.foam_cm, least=self.shows_from,
            estimated=tuple(dict.fromkeys(self.estimate)),
        )  # fmt: skip

    def model(self, kind: int, corners: int = 0) -> Model:
        """Return the model of one kind of outline with an even face; kinds as in `outlines`."""
        return Model(
            kind,
            corners,
            noise=self.noise,
            gap_cm=self.gap,
            whole=ON_PAD[self.on_pad],
            smallest_cm=self.smallest_cm or 0.0,
            largest_cm=self.largest_cm or math.inf,
            precision=self.precision,
            most_points=self.points,
            seed=self.seed,
        )

    def asked_model(self, kind: int, corners: int = 0) -> Model | AnyPressure:
        """Return the model with the pressure that is asked for: an even one, or any."""
        even = self.model(kind, corners)
        return AnyPressure(even) if self.pressure == "any" else even


@dataclass(frozen=True)
class LocateSettings(FootprintSettings):
    """The same of a pad that need not be the one that is told, and how soon an answer is wanted.

    Points enough for a mean whose own error does not matter beside the posterior's deviation, which
    they leave uncertain itself: 768 at most, and more, by the square, if a precision finer than 0.3
    is asked for.

    Parameters
    ----------
    quick : bool
        Whether the most likely outline will do, with a normal distribution around it: less than
        half of the time where up to 4096 elements are touched. Pressures other than an even one are
        looked at where its pattern is clear; a fainter one widens the distribution.
    sampled_above_cm : float, optional
        With ``quick``: the deviation of a disc's centre from which on points around the most likely
        disc are weighed after all, 0 for always. Their mean errs some 5 % less and takes a quarter
        more time.
    """

    on_pad: Literal["whole", "mostly", "partly"] = "mostly"
    precision: Annotated[float, Gt(0), Le(1)] = 0.3
    quick: bool = False
    sampled_above_cm: Annotated[float, Ge(0)] | None = None
    usual_points: ClassVar[int] = 768


DEFAULTS = FootprintSettings()
ROUGHER = FootprintSettings(precision=0.2)
"""Where several kinds of outlines are looked at."""
