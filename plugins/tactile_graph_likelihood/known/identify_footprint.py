"""``identify_footprint``: which known object lies on the pad, and where, in one likelihood."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Ge, Lt

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Grid, Quantity, Spread
from tactile_graph.wires import Image
from tactile_graph_likelihood.geometry.outlines import DISC, ELLIPSE, RECTANGLE, Values
from tactile_graph_likelihood.known.known_footprints import (
    KnownFootprint,
    known_footprints,
    weight_of,
)
from tactile_graph_likelihood.known.known_sizes import KnownSizes
from tactile_graph_likelihood.settings import ROUGHER, FootprintSettings, Positive
from tactile_graph_likelihood.single.any_pressure import (
    EVEN,
    FIRST,
    AnyPressure,
    asked_by,
    log_mean,
    log_of,
    mixed,
)
from tactile_graph_likelihood.single.density.element_terms import SPAN
from tactile_graph_likelihood.single.frame_fits import FrameFits
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.noise import level_of
from tactile_graph_likelihood.single.posterior import Posterior

HOPELESS = 20.0
"""How far, in logarithms, an object's best possible evidence may lie below the best one's."""

SIZES_TELL = 15.0
"""What known sizes can add to the evidence of a free outline, at most."""

UNKNOWN = "unknown"

FREE_KINDS = (DISC, ELLIPSE, RECTANGLE)
"""What an unknown object may be."""

Kept = dict[tuple[int, int, str], tuple[float, Posterior]]
"""Object, its outline, and pressure -> log evidence with the sizes as prior, and posterior."""


class Identified(NamedTuple):
    """Which object it is, and where it lies.

    ``probability`` is that of ``name``; ``unknown`` the probability that it is none of the known
    objects, in which case ``object`` is the likeliest outline of any size.
    """

    name: str
    shape: str
    known: bool
    probability: float
    runner_up: str
    runner_up_probability: float
    unknown: float
    object: Likely


class IdentifyFootprint:
    """Return the known object that explains shape, size and weight best, located.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
    sizes : mapping
        Name -> shape and lengths, as in a scene, of objects whose sizes are known; those of
        others come from what was learned of their touched elements.
    unknown : float
        Probability, before a frame is read, that it is none of them.
    learned_level_v : float
        Voltage from which an element counted as touched when the objects were learned.
    settings : FootprintSettings

    Raises
    ------
    DataError
        If the objects were not learned in grams, without a shape, or without what their sizes
        can be found from.
    UsageError
        If ``sizes`` names an object that is not known.

    Notes
    -----
    Thesis figure 4.37 in one likelihood. An object's evidence is that of its kind of outline with
    its sizes as prior, times the density of the weight's logarithm by its readings (Student's t).
    The load's scale is log-uniform within an outline's evidence, and takes the weight's place:
    the weight's density is divided by that of the scale. The unknown object is a disc, ellipse or
    rectangle of any size and weight. Where a likely object with an even face leaves a pattern of
    pressure over, all are looked at under other pressures, the unknown one too.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        sizes: dict[str, dict[str, Any]] = {},  # noqa: B006 - settings are never changed
        unknown: Annotated[float, Ge(0), Lt(1)] = 0.05,
        learned_level_v: Positive = 0.01,
        settings: Annotated[
            FootprintSettings,
            Spread("pad", "on_pad", "smallest_cm", "largest_cm", "precision", "pressure"),
        ] = ROUGHER,
    ) -> None:
        pad = settings.known_pad
        self._even = settings.model(DISC)
        self._models: dict[tuple[int, int], AnyPressure] = {}
        self._free = [self._of(kind, 0) for kind in FREE_KINDS]
        self._others = self._free[0].others if settings.pressure == "any" else {}
        self._level = level_of(pad, learned_level_v)
        self._objects = known_footprints(database, sizes, self._even, pad, self._level)
        self._log_unknown = math.log(max(unknown, 1e-300))
        self._log_known = math.log((1.0 - unknown) / len(self._objects))

    def __call__(
        self, image: Annotated[Image, Quantity("gram"), Grid(square_to=0.0)]
    ) -> Identified:
        """Return the object.

        Parameters
        ----------
        image : Image
            Loads in grams; invalid cells say nothing.

        Raises
        ------
        Degenerate
            If nothing is touched, or nothing explains what is.
        """
        fits = FrameFits(self._even.readings(image), self._free)
        before = {EVEN: 1.0}
        if not fits.found:
            raise Degenerate("no outline explains what is touched")
        log_weight = math.log(max(weight_of(image, self._level), 1e-300))
        levels = [it.log_density(log_weight) + math.log(SPAN) + self._log_known
                  for it in self._objects]  # fmt: skip
        kept: Kept = {}
        self._look_at_known(fits, levels, before, kept)
        first = max(self._scored(fits, levels, before, kept), key=lambda one: one[0])
        # if none fits well, a known one may by another pressure
        known = [one for _, one in kept.values()] if first[1] is None else [first[2]]
        if asked := asked_by([*fits.found.values(), *known], self._others):
            before = fits.look_under(asked)
            self._look_at_known(fits, levels, before, kept)
        return _chosen(self._scored(fits, levels, before, kept))

    def _of(self, kind: int, corners: int) -> AnyPressure:
        """Return the model of a kind of outline, under any pressure."""
        if (kind, corners) not in self._models:
            even = replace(self._even, kind=kind, corners=corners)
            self._models[kind, corners] = AnyPressure(even)
        return self._models[kind, corners]

    def _unknown(self, fits: FrameFits, before: dict[str, float]) -> float:
        logs = [fits.evidence(k, before) for k in range(len(self._free))]
        return log_mean(logs, len(logs)) + self._log_unknown

    def _look_at_known(
        self, fits: FrameFits, levels: list[float], before: dict[str, float], kept: Kept
    ) -> None:
        """Find the posteriors of those objects that may be as likely as any."""
        most = max(fits.evidence(k, before) for k in range(len(self._free)))
        best = self._unknown(fits, before)
        for k in sorted(range(len(levels)), key=levels.__getitem__, reverse=True):
            if levels[k] + most + SIZES_TELL < best - HOPELESS:
                break
            for n in range(len(self._objects[k].outlines)):
                self._look_at(fits, (k, n), before, kept)
            best = max(best, levels[k] + self._evidence(k, before, kept))

    def _look_at(
        self, fits: FrameFits, outline: tuple[int, int], before: dict[str, float], kept: Kept
    ) -> None:
        """Find an outline's posteriors under each pressure."""
        kind, corners, known = self._objects[outline[0]].outlines[outline[1]]
        models = self._of(kind, corners)
        for part in before:
            model = models.even if part == EVEN else models.others[part]
            if (*outline, part) in kept:
                continue
            if part == EVEN:
                start = _start(fits, kind, known)
            elif (*outline, EVEN) in kept:
                start = np.append(kept[*outline, EVEN][1].most_likely, FIRST[part])
            else:
                continue
            try:
                found = model.posterior_of(fits.readings, start, known.belief(model))
            except Degenerate:
                continue
            log = found.log_evidence - known.log_share(model, fits.readings)
            kept[*outline, part] = log, found

    def _evidence(self, k: int, before: dict[str, float], kept: Kept) -> float:
        """Return an object's log evidence by its outlines, over all pressures."""
        logs = [log + log_of(before[key[2]]) for key, (log, _) in kept.items() if key[0] == k]
        return log_mean(logs, len(self._objects[k].outlines))

    def _scored(
        self, fits: FrameFits, levels: list[float], before: dict[str, float], kept: Kept
    ) -> list[tuple[float, KnownFootprint | None, Posterior]]:
        """Return log probability, object and posterior of all that were seen, unknown ones too."""
        free = max({k for k, _ in fits.found}, key=lambda k: fits.evidence(k, before))
        found: list[tuple[float, KnownFootprint | None, Posterior]] = [
            (self._unknown(fits, before), None, fits.posterior(free, before))
        ]
        for k in dict.fromkeys(key[0] for key in kept):
            _, n, _ = max((key for key in kept if key[0] == k), key=lambda key: kept[key][0])
            its = {part: one for (i, j, part), (_, one) in kept.items() if (i, j) == (k, n)}
            score = levels[k] + self._evidence(k, before, kept)
            posterior = its[EVEN] if [*its] == [EVEN] else mixed(its, before)
            found.append((score, self._objects[k], posterior))
        return found


def _start(fits: FrameFits, kind: int, known: KnownSizes) -> Values | None:
    """Return an outline of known sizes where one of any size was found."""
    if kind not in FREE_KINDS:
        return None
    start = fits.point((FREE_KINDS.index(kind), EVEN)).copy()
    n = len(known.mean)
    longer_first = n == 1 or start[2] >= start[3]
    start[2 : 2 + n] = known.mean if longer_first else known.mean[::-1]
    return start


def _chosen(found: list[tuple[float, KnownFootprint | None, Posterior]]) -> Identified:
    found = sorted(found, key=lambda one: -one[0])
    chances = np.exp([one[0] - found[0][0] for one in found])
    chances /= chances.sum()
    names = [UNKNOWN if one[1] is None else one[1].name for one in found]
    best = found[0][1]
    return Identified(
        names[0],
        "" if best is None else best.shape,
        best is not None,
        float(chances[0]),
        names[1] if len(names) > 1 else "",
        float(chances[1]) if len(names) > 1 else 0.0,
        float(chances[names.index(UNKNOWN)]),
        likely(found[0][2]),
    )
