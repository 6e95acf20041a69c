"""``footprint_by_order``: an outline from touch and the order of readings, of any pad."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Literal

import numpy as np
from annotated_types import Ge, Le

from tactile_graph.errors import Degenerate
from tactile_graph.steps import Spread
from tactile_graph.steps.rules import Grid, require_same_shape
from tactile_graph.wires import Image, Mask
from tactile_graph_filters.readings.decouple import Decouple
from tactile_graph_likelihood.any_pad.observation.observed import gap_by
from tactile_graph_likelihood.by_order.posterior import order_posterior
from tactile_graph_likelihood.geometry.outlines import FREE, REGULAR
from tactile_graph_likelihood.settings import DEFAULTS, FootprintSettings, Share
from tactile_graph_likelihood.single.density.element_terms import OFF, ON, UNKNOWN, States
from tactile_graph_likelihood.single.fit_footprint import KINDS
from tactile_graph_likelihood.single.likely import Likely, likely
from tactile_graph_likelihood.single.model import EVERY
from tactile_graph_likelihood.single.posterior import Posterior
from tactile_graph_likelihood.single.readings import Readings, is_row, readings_of

TOUCH_SIGMAS, TOUCH_LEAST = (0.7, 0.5, 1.5), 0.1
"""Of ln gain, and the least load, in the rough fit that takes all touched elements for equally
loaded; the next one where there is no answer."""


class FootprintByOrder:
    """Return the posterior of an outline from what is touched and the order of the readings.

    Parameters
    ----------
    shape, corners
        As in `fit_footprint`.
    settings : FootprintSettings
    touched_from : float
        Readings below it count as untouched, in the image's unit; 0 for all above 0.
    sliver : float
        Share of an element that must be covered for it to read anything, about.

    Notes
    -----
    Of the pad its law is not used, but the circuit that volts are freed of, and its gap where the
    image's pitch is its own; elements of another pitch have a gap of 0.12 pitches unless ``gap_cm``
    is given.

    Any strictly monotone change of the readings leaves the answer as it is. Volts of a circuit
    whose elements shadow each other are no such change of the load: an image in volts is decoupled
    first; another quantity is taken as it is. The likelihood is in `by_order.likelihood`;
    ``sliver`` is the middle of a guess, a factor of 7 wide, and is estimated with the outline. So
    is the scatter of gains where touch and order are likelier than the pad's own lets them be: with
    too large a one outlines come out small.

    ``fits`` is False where touch and order are less likely than the model's own by more than
    three standard deviations, or where they leave a pattern over, as with `fit_footprint`. The
    load that an element's place in the order stands for takes the place of its own.
    """

    stateless = True

    def __init__(
        self,
        *,
        shape: Literal["disc", "ellipse", "rectangle", "regular", "polygon"] = "disc",
        corners: Annotated[int, Ge(3), Le(12)] = 4,
        settings: Annotated[
            FootprintSettings,
            Spread(
                "pad",
                "sigma",
                "voids",
                "strays",
                "foam_cm",
                "gap_cm",
                "on_pad",
                "smallest_cm",
                "largest_cm",
                "precision",
            ),
        ] = DEFAULTS,
        touched_from: Annotated[float, Ge(0)] = 0.0,
        sliver: Share = 0.1,
    ) -> None:
        kind = KINDS[shape]
        sides = corners if kind in (REGULAR, FREE) else 0
        self.model = replace(settings, shows_from=sliver).model(kind, sides)
        noise = replace(self.model.noise, least=TOUCH_LEAST)
        self._touch = [
            replace(self.model, noise=replace(noise, sigma=s), precision=0.3) for s in TOUCH_SIGMAS
        ]
        self._touched_from, self._decouple = touched_from, Decouple(pad=settings.pad)
        self._settings = settings

    def __call__(
        self,
        image: Annotated[Image, Grid(square_to=0.0)],
        touched: Annotated[Mask, Grid.like("image")] | None = None,
    ) -> Likely:
        """Return the outline.

        Parameters
        ----------
        image : Image
            Readings that rise with load, in any quantity; invalid cells say nothing.
        touched : Mask, optional
            What counts as touched, instead of ``touched_from``.

        Raises
        ------
        RuleError
            If the image's cells are not square.
        Degenerate
            If nothing is touched, or no such outline on the pad explains what is; if volts are
            not the circuit's.
        """
        return likely(self.posterior(self._readings(image, touched)))

    def posterior(self, readings: Readings) -> Posterior:
        """Return the posterior by the touch and order of some readings."""
        touch = readings._replace(logs=np.zeros(readings.logs.shape))
        for model in self._touch:
            top = model.likeliest(touch, attempts=EVERY)
            if top.evidence > -math.inf:
                normal = model.normal_around(top, row=is_row(readings))
                return order_posterior(self.model, readings, normal)
        raise self.model.impossible(readings)

    def _readings(self, image: Image, touched: Mask | None) -> Readings:
        found = self._touched_of(image, touched)
        if image.quantity != "volt":
            return found
        siemens = self._decouple(image)
        states = found.states
        if siemens.valid is not None:
            states = np.where(siemens.valid, states, UNKNOWN).astype(np.uint8)
        return _touching(found._replace(logs=siemens.filled(0.0)), states)

    def _gap_cm(self, image: Image) -> float:
        """Return the gap of an image's elements: as told, or as is usual where the pitch is another
        than the pad's."""
        told = self._settings.gap_cm
        return gap_by(self._settings.known_pad, image.pitch_cm).middle_cm if told is None else told

    def _touched_of(self, image: Image, touched: Mask | None) -> Readings:
        gap = self._gap_cm(image)
        values = np.ascontiguousarray(image.filled(0.0), dtype=np.float64)
        if touched is None:
            # Not their logarithms: those of neighbouring numbers may be one.
            return readings_of(image, gap, self._touched_from, 0.0)._replace(logs=values)
        require_same_shape(image=image, touched=touched)
        level = image.with_values(np.where(np.isfinite(values), 1.0, values))
        found = readings_of(level, gap, 0.0, 0.0)._replace(logs=values)
        on = touched.values & (found.states == ON)
        states = np.where(on, ON, np.where(found.states == ON, OFF, found.states)).astype(np.uint8)
        return _touching(found, states)


def _touching(readings: Readings, states: States) -> Readings:
    found = readings.with_states(states)
    if found.touched == 0:
        raise Degenerate("no element is touched: no outline fits")
    return found
