"""Images with noise of a known kind, for ``field_noise.py``: drawn from the prior, or flat parts.

All are 16 by 16 cells of whole levels, with two more cells below and apart from them that hold
the lowest and the highest level: so the model's levels are those of the images, and what they
cost is exactly what they were drawn by.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.samplers.gibbs import gibbs

Array = NDArray[np.float64]
TERMS = ("gaussian", "laplace", "student_t", "poisson", "outliers")
SIZE, LEVELS = 16, 64
FREEDOM, SHARE = 2.0, 0.1
"""Of the Student noise and of the outliers, in the making and in the terms."""
NO_DATA = 1e5
"""A scale of noise, in levels, at which data say nothing."""


@dataclass(frozen=True)
class Prior:
    """What is known of the images: none of it depends on the noise.

    ``step`` and ``spread`` are in levels: the deviation of a step within a smooth part, and of a
    cell from the middle of the scale. An edge makes a pair exp(``edge``) times as unlikely.
    """

    step: float
    edge: float
    spread: float

    def model(self, term: str, sigma: float) -> Model:
        """Return the model of this prior and of noise of scale ``sigma``, in levels."""
        return Model(
            n_levels=LEVELS,
            noise=term,  # type: ignore[arg-type]
            sigma=sigma,
            freedom=FREEDOM,
            outlier_share=SHARE,
            lines="none",
            smoothness="truncated_quadratic",
            lambda_d=(sigma / self.step) ** 2,
            truncation=self.height,
            lambda_prior=(sigma / self.spread) ** 2,
        )

    @property
    def height(self) -> float:
        """Levels from which on a step is an edge."""
        return self.step * (2.0 * self.edge) ** 0.5


SMOOTH = Prior(step=LEVELS / 20, edge=1.5, spread=LEVELS / 6)
"""By which the images of the first kind are drawn: about one pair in seven is an edge."""


def pinned(values: Array) -> tuple[Image, Mask, Image]:
    """Return the image with the two cells that pin its scale, the region, the expected load."""
    image, region = np.zeros((SIZE + 2, SIZE)), np.zeros((SIZE + 2, SIZE), np.bool_)
    image[:SIZE], image[-1, -1] = values, LEVELS - 1.0
    region[:SIZE] = region[-1, 0] = region[-1, -1] = True
    return Image(image), Mask(region), Image(np.full(image.shape, 0.5 * (LEVELS - 1)))


def drawn(rng: np.random.Generator, prior: Prior = SMOOTH, n_sweeps: int = 300) -> Array:
    """Return an image drawn from the prior: Gibbs samples at temperature 1, with no data."""
    image, region, expected = pinned(np.full((SIZE, SIZE), 0.5 * (LEVELS - 1)))
    found = gibbs(
        image, region, expected, rng=rng, model=prior.model("gaussian", NO_DATA),
        temperature=1.0, cooling=1.0, n_sweeps=n_sweeps, energy_scale=0.5 / NO_DATA**2,
    )  # fmt: skip
    return found.image.values[:SIZE]


def flat(rng: np.random.Generator) -> Array:
    """Return a disc and a rectangle, each of one level, on a floor; steps of 1/4 or 1/2 range."""
    i, j = np.indices((SIZE, SIZE))
    floor, *levels = rng.permutation([0.25, 0.5, 0.75]) * LEVELS
    truth = np.full((SIZE, SIZE), floor)
    top, left = rng.integers(1, 8, 2)
    height, width = rng.integers(4, 8, 2)
    truth[top : top + height, left : left + width] = levels[0]
    radius = rng.uniform(2.5, 4.5)
    y, x = rng.uniform(radius, SIZE - radius, 2)
    truth[(i - y) ** 2 + (j - x) ** 2 < radius**2] = levels[1]
    return truth


def read(kind: str, truth: Array, sigma: float, rng: np.random.Generator) -> Array:
    """Return the image as read, whole levels: noise as the term of that name expects it.

    Readings off the scale are drawn again.
    """
    seen = np.rint(_noisy(kind, truth, sigma, rng))
    while (off := (seen < 0.0) | (seen > LEVELS - 1.0)).any():
        seen = np.where(off, np.rint(_noisy(kind, truth, sigma, rng)), seen)
    return seen


def _noisy(kind: str, truth: Array, sigma: float, rng: np.random.Generator) -> Array:
    shape = truth.shape
    if kind == "gaussian":
        return truth + sigma * rng.standard_normal(shape)
    if kind == "laplace":
        return truth + rng.laplace(0.0, sigma / np.sqrt(2.0), shape)
    if kind == "student_t":
        return truth + sigma * rng.standard_t(FREEDOM, shape)
    if kind == "poisson":
        # Variance in proportion to the load, sigma² in the middle; level -1 bears nothing.
        gain = 0.5 * (LEVELS + 1.0) / sigma**2
        return np.asarray(rng.poisson((truth + 1.0) * gain) / gain - 1.0)
    noisy = truth + sigma * rng.standard_normal(shape)
    return np.where(rng.random(shape) < SHARE, rng.uniform(-0.5, LEVELS - 0.5, shape), noisy)
