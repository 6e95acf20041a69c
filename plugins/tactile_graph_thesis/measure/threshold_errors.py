"""Error of circle-3's radius against the threshold, on the discs of table 4.1 (section 4.1)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph import load
from tactile_graph_thesis.measure.circles import signed_circle_errors
from tactile_graph_thesis.numbers import numbers
from tactile_graph_thesis.work import Work

Array = NDArray[np.float64]
SCENE = "threshold-discs"
LEVELS, QUICK_LEVELS = 11, 6
"""Thresholds tried."""


class ThresholdErrors(NamedTuple):
    """Errors of the radius for every level, disc and reading.

    Parameters
    ----------
    level_v : ndarray, shape (levels,)
    names : tuple of str
        Of the discs.
    weight_g, radius_cm : ndarray, shape (discs,)
    error_cm : ndarray, shape (levels, discs, readings)
        Found less true; a reading without an answer counts as less its own radius.
    """

    level_v: Array
    names: tuple[str, ...]
    weight_g: Array
    radius_cm: Array
    error_cm: Array

    @property
    def mean_cm(self) -> Array:
        """Mean size of the errors, shape (levels, discs)."""
        return np.asarray(np.abs(self.error_cm).mean(axis=2))

    def at(self, level_v: float) -> int:
        """Return which level is nearest to one.

        Parameters
        ----------
        level_v : float
        """
        return int(np.abs(self.level_v - level_v).argmin())

    def label(self, disc: int) -> str:
        """Return a disc's name, weight and radius.

        Parameters
        ----------
        disc : int
        """
        return f"{self.names[disc]}, {self.weight_g[disc]:g} g, {self.radius_cm[disc]:g} cm"


def threshold_errors(work: Work) -> ThresholdErrors:
    """Return the errors of circle-3 over the thesis' range of thresholds.

    Parameters
    ----------
    work : Work
    """
    return work.once("thresholds", lambda: _measured(work))


def _measured(work: Work) -> ThresholdErrors:
    from tactile_graph_sources.scene import load_scene

    said = numbers("threshold")
    n_levels = QUICK_LEVELS if work.quick else LEVELS
    levels = np.linspace(said["low_v"], said["high_v"], n_levels)
    discs = [group[0] for group in load_scene(SCENE).in_turn]
    frames = work.frames(SCENE, len(discs) * work.readings)
    base = load("circle-3")
    runners = [
        base.with_settings({"footprint.level_v": float(v)}).runner(seed=work.seed) for v in levels
    ]
    names = tuple(d.name for d in discs)
    errors = signed_circle_errors(frames, runners, names)[..., 2]
    true = {f.truth[0].name: f.truth[0] for f in frames[: len(discs)] if f.truth}
    radius = np.array([getattr(true[n].shape, "radius_cm", np.nan) for n in names])
    return ThresholdErrors(levels, names, np.array([d.total_g for d in discs]), radius, errors)
