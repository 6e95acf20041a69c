"""Figures 5.8 and 5.9 and the study of section 5.4.1: a rectangle on an even floor, with noise."""

from __future__ import annotations

import time
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.contours.contours import contours
from tactile_graph_mrf.contours.line_regions import line_regions
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.energy.line_field import Restored
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.samplers.gibbs import gibbs
from tactile_graph_thesis.measure.restorations import Restoration

Array = NDArray[np.float64]
Way = Literal["thesis", "annealed", "restore"]

MODEL = Model(lambda_d=1.0, lambda_l=1000.0)
"""Lines pay from steps of 35 levels on."""
RECTANGLE = (slice(5, 11), slice(3, 13))
"""Its rows and columns."""
FLOOR, TOP, NOISE = 50.0, 150.0, 15.0
"""Grey levels outside, on the rectangle, and the noise's standard deviation."""
RANGE_LEVELS = 199.0
"""Of an image of 200 levels, to whose steps numbers are brought."""
TITLES: dict[Way, str] = {
    "thesis": "gibbs, squared levels",
    "annealed": "gibbs, thousands",
    "restore": "restore",
}
"""What each way is called in pictures."""


def corrupted(rng: np.random.Generator) -> tuple[Image, Image]:
    """Return the original image and the one with noise.

    Parameters
    ----------
    rng : numpy.random.Generator

    Notes
    -----
    The thesis gives neither in numbers; these are ours.
    """
    on = np.zeros((16, 16), np.bool_)
    on[RECTANGLE] = True
    truth = Image(np.where(on, TOP, FLOOR), quantity="level")
    return truth, truth.with_values(truth.values + NOISE * rng.standard_normal(on.shape))


def figure_5_8(seed: int = 0, way: Way = "thesis") -> Restoration:
    """Return a rectangle on an even floor: original, corrupted, restored without and with lines.

    Figure 5.9 is the ``lines``.

    Parameters
    ----------
    seed : int
    way : str
        ``thesis``: `gibbs` with the schedule of section 5.4.1 (T0 = 5, cooled by 0.9 over 110
        sweeps from a random start, 200 levels), the energy in squared levels. ``annealed``: the
        same with the energy in thousands of these, beside which T0 is hot. ``restore``: the least
        energy.
    """
    rng = np.random.default_rng(seed)
    truth, observed = corrupted(rng)
    bare = replace(MODEL, lines="none")
    if way == "restore":
        smooth, lined = (restore(observed, model=model) for model in (bare, MODEL))
    else:
        scale = 1.0 if way == "thesis" else 0.001
        smooth, lined = (
            gibbs(observed, rng=rng, model=model, energy_scale=scale) for model in (bare, MODEL)
        )
    return Restoration(
        "simulated rectangle",
        truth,
        observed,
        smooth.image,
        lined.image,
        lined.lines,
        contours(rectangle(truth)),
        None,
        TITLES[way],
        lined.energy,
        "grey level",
    )


def rectangle(image: Image) -> Mask:
    """Return the cells of the rectangle.

    Parameters
    ----------
    image : Image
    """
    on = np.zeros(image.shape, np.bool_)
    on[RECTANGLE] = True
    return image.mask(on)


def cells_amiss(made: Restoration) -> int:
    """Return how many cells the lines enclose beside the rectangle, or leave out of it.

    Parameters
    ----------
    made : Restoration
    """
    found = line_regions(made.lined, made.lines).mask.values
    return int((found != rectangle(made.lined).values).sum())


# -- section 5.4.1 ---------------------------------------------------------------------------


class Schedule(NamedTuple):
    """An annealing schedule: temperature of the first sweep, factor, number of sweeps."""

    temperature: float
    cooling: float
    n_sweeps: int

    def __str__(self) -> str:
        return f"T0 {self.temperature:g}, {self.cooling:g}, {self.n_sweeps} sweeps"


CHOSEN = Schedule(5.0, 0.9, 110)
"""What the thesis settles on."""
VARIED = {
    "start temperature": CHOSEN._replace(temperature=2.0),
    "cooling": CHOSEN._replace(cooling=0.95),
    "iterations": CHOSEN._replace(n_sweeps=95),
}
"""What it tried instead, one at a time."""
HOT = CHOSEN._replace(temperature=5000.0)
"""Not in the thesis: hot beside squared levels."""
QUICK = HOT._replace(cooling=0.5)
"""The same, cooled to the chosen schedule's start within ten sweeps."""


class Annealed(NamedTuple):
    """One schedule against the chosen one, over the same images.

    Parameters
    ----------
    schedule : Schedule
    rms_levels : ndarray, shape (n,)
        How far each restored image is off the original, with lines.
    off_chosen_levels : float
        Its mean less that of the chosen schedule.
    energy : float
        Mean, in squared levels.
    """

    schedule: Schedule
    rms_levels: Array
    off_chosen_levels: float
    energy: float


def schedules(
    seed: int, n: int, energy_scale: float = 1.0, more: tuple[Schedule, ...] = (HOT,)
) -> list[Annealed]:
    """Return what each schedule of section 5.4.1 comes to, the chosen one first.

    Parameters
    ----------
    seed : int
        Of the first image.
    n : int
        How many images, each with a seed of its own.
    energy_scale : float
        1 is the energy in squared levels.
    more : tuple of Schedule
        Tried besides.
    """
    found: list[Annealed] = []
    for schedule in (CHOSEN, *VARIED.values(), *more):
        made = [_restored(seed + k, schedule, energy_scale) for k in range(n)]
        rms = np.array([off for off, _ in made])
        against = found[0].rms_levels.mean() if found else rms.mean()
        energy = float(np.mean([result.energy for _, result in made]))
        found.append(Annealed(schedule, rms, float(rms.mean() - against), energy))
    return found


def _restored(seed: int, schedule: Schedule, scale: float) -> tuple[float, Restored]:
    rng = np.random.default_rng(seed)
    truth, observed = corrupted(rng)
    result = gibbs(observed, rng=rng, model=MODEL, energy_scale=scale, **schedule._asdict())
    return float(np.sqrt(np.mean((result.image.values - truth.values) ** 2))), result


N_LEVELS = (50, 100, 150, 200, 250)


class StateSpace(NamedTuple):
    """One size of the state space.

    Parameters
    ----------
    n_levels : int
    step_percent : float
        Of the image's range, between two neighbouring states.
    off_finest : float
        How far the restored images lie from those of the largest state space (rms), in 1/199 of
        the range.
    time_us : float
        Shortest time of a restoration.
    """

    n_levels: int
    step_percent: float
    off_finest: float
    time_us: float


def state_spaces(seed: int, n: int) -> list[StateSpace]:
    """Return what the size of the state space does to an image restored without lines.

    Parameters
    ----------
    seed : int
        Of the first image.
    n : int
        How many images, each with a seed of its own.
    """
    images: dict[int, list[Array]] = {}
    times: dict[int, float] = {}
    for n_levels in N_LEVELS:
        model = replace(MODEL, lines="none", n_levels=n_levels)
        for k in range(n):
            rng = np.random.default_rng(seed + k)
            _, observed = corrupted(rng)
            start = time.perf_counter()
            restored = gibbs(observed, rng=rng, model=model).image
            spent = 1e6 * (time.perf_counter() - start)
            times[n_levels] = min(times.get(n_levels, np.inf), spent)
            span = float(np.ptp(observed.values))
            images.setdefault(n_levels, []).append(RANGE_LEVELS * restored.values / span)
    finest = images[N_LEVELS[-1]]
    return [
        StateSpace(
            size,
            100.0 / (size - 1),
            float(np.sqrt(np.mean((np.array(made) - np.array(finest)) ** 2))),
            times[size],
        )
        for size, made in images.items()
    ]
