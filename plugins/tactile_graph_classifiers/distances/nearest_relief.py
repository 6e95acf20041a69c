"""Step ``nearest_relief``: the known object whose learned relief reads most like the press."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
from annotated_types import Gt, Lt
from numpy.typing import NDArray

from tactile_graph.errors import DataError
from tactile_graph.wires import Image
from tactile_graph_classifiers.database.known import OtherPadError
from tactile_graph_classifiers.database.opening import load_reliefs
from tactile_graph_classifiers.distances.choosing import choose
from tactile_graph_classifiers.distances.classifier import Lookup
from tactile_graph_classifiers.distances.discriminant_model import Learned
from tactile_graph_classifiers.distances.examples import Examples
from tactile_graph_classifiers.distances.identity import UNKNOWN, Identity
from tactile_graph_classifiers.distances.left_out import largest_accepted
from tactile_graph_classifiers.measuring.measurements import Measurements
from tactile_graph_classifiers.measuring.reader import pressed
from tactile_graph_classifiers.reliefs.known_reliefs import KnownReliefs
from tactile_graph_classifiers.reliefs.leaving_out import parts_of
from tactile_graph_classifiers.reliefs.naming import misfits_to
from tactile_graph_classifiers.reliefs.presses import Presses

Array = NDArray[np.float64]
CONFIDENCE = 0.93
"""Share of known objects' presses that is to be accepted, unless told."""
LIKELY = 6
"""To so many objects, the likeliest by what was measured, a press is fitted."""
SHARE = 0.25
"""To which power the squared distance of the measurements counts beside the misfit."""
PARTLY_OFF = 0.2
"""Share of the highest reading that the pad's edge reads where an object goes on beyond it; the
blur of one that lies beside the edge reads less."""


class NearestRelief:
    """Return which known object's relief reads most like a press, or that none does.

    Parameters
    ----------
    database : Path, optional
        The object database, its reliefs learned by ``tactile-graph learn-reliefs``; the sample of
        the thesis' objects if not given. It is read once, when the pipeline is loaded.
    reject : bool
        Whether a press too far from the object it is most like is unknown.
    confidence : float
        Share of known objects' presses to be accepted: the less, the more strangers are found.

    Raises
    ------
    DataError
        If an object has no relief of its present readings.

    Notes
    -----
    Place, turn, depth and lean of the press are fitted to the reliefs of the objects that are
    likeliest by the measurements (as `discriminant` finds them). The distance is the misfit of the
    cells over what is usual for the object, times a low power of the discriminant's squared
    distance over what is usual for it. What is accepted is the quantile of presses left out while
    reliefs and discriminant were learned (cross-conformal prediction: V. Vovk, 2015,
    doi:10.1007/s10472-013-9368-4). What reaches the pad's edge may go on beyond: its press is
    unknown, and a note says why, where the runner-up would be accepted too.
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | None = None,
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = CONFIDENCE,
    ) -> None:
        known, kept = load_reliefs(database)
        self._lookup = Lookup.of(known, database is not None)
        self.takes, self.takes_by, self.takes_hint = self._lookup.taken
        self._reliefs = KnownReliefs.from_kept(kept, known.where)
        examples = Examples.of(known)
        self._manner = (known.choice or choose(examples)).manner
        self._learned = Learned.of(examples.readings, examples.labels, self._manner.shrinkage)
        self._discriminant = self._learned.discriminant(self._manner)
        squares = self._left_out_squares(examples)
        self._usual_square = float(np.median(squares))
        left_out = np.concatenate(
            [own / usual for own, usual in
             zip(self._reliefs.left_out, self._reliefs.usual, strict=True)]
        )  # fmt: skip
        scores = self._scores(left_out, squares)
        self._limit = None
        if reject:
            self._limit = largest_accepted(scores[np.isfinite(scores)], confidence)

    def __call__(self, image: Image, features: Measurements) -> Identity:
        """Return the object the press is most like, the runner-up and their margin.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, the image is of another pad or in
            another unit, or nothing touches.
        """
        vector = self._lookup.vector(features)
        found = self._discriminant(self._learned.located(vector[None]))
        order = np.argsort(found.unlikeliness[0], kind="stable")[:LIKELY]
        squares = (found.squares + self._manner.beyond * found.beside)[0, order]
        press = self._press(image)
        misfits = misfits_to([self._reliefs.reliefs[k] for k in order], self._reliefs.pad, press)[0]
        scores = self._scores(misfits / self._reliefs.usual[order], squares)
        best = np.argsort(scores, kind="stable")[:2]
        partly_off = bool(press.cut(PARTLY_OFF)[0])
        return self._identity(order[best].tolist(), scores[best].tolist(), partly_off)

    def _press(self, image: Image) -> Presses:
        reliefs, where = self._reliefs, self._lookup.known.where
        shape, pitch_cm = reliefs.pad.gains.shape, reliefs.pitch_cm
        if image.shape != shape or any(abs(p / pitch_cm - 1.0) > 0.02 for p in image.pitch_cm):
            raise OtherPadError(
                "image",
                f"{image.shape[0]} x {image.shape[1]} cells of {image.pitch_cm[0]:g} cm; reliefs"
                f" in {where} were learned on {shape[0]} x {shape[1]} of {pitch_cm:g} cm",
            )
        try:
            return Presses.of([pressed(image)], reliefs.full_scale)
        except ValueError as error:
            raise DataError("image", str(error)) from None

    def _scores(self, misfits: Array, squares: Array) -> Array:
        """Return how far presses are: misfits over the usual, and squared distances, together."""
        return np.asarray(misfits * (squares / self._usual_square) ** SHARE)

    def _left_out_squares(self, examples: Examples) -> Array:
        """Return the squared distance of each reading to its own object learned without it.

        They are left out in parts as their presses were.
        """
        parts = np.concatenate([parts_of(int(n)) for n in np.bincount(examples.labels)])
        out = np.full(len(parts), np.nan)
        for part in np.unique(parts):
            left = parts == part
            kept = examples.labels[~left]
            if len(np.unique(kept)) < len(self._reliefs.names):
                continue
            learned = Learned.of(examples.readings[~left], kept, self._manner.shrinkage)
            found = learned.discriminant(self._manner)(learned.located(examples.readings[left]))
            out[left] = found.at(examples.labels[left], self._manner.beyond)
        return out

    def _identity(self, order: list[int], scores: list[float], partly_off: bool) -> Identity:
        objects = [self._lookup.known.objects[k] for k in order]
        single, note = len(objects) == 1, ""
        known = self._limit is None or scores[0] <= self._limit
        if self._limit is not None and partly_off and not single and scores[1] <= self._limit:
            known, note = False, f"reaches the pad's edge, and may be {objects[1].name} too"
        return Identity(
            objects[0].name if known else UNKNOWN,
            objects[0].shape if known else "",
            bool(known),
            scores[0],
            self._limit,
            objects[0].name,
            "" if single else objects[1].name,
            None if single else scores[1],
            1.0 if single else 1.0 - scores[0] / scores[1] if scores[1] > 0.0 else 0.0,
            note=note,
        )
