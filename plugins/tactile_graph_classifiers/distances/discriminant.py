"""Step ``discriminant``: the likeliest known object by all that was measured of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from annotated_types import Gt, Lt, MinLen

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.choice import CONFIDENCE
from tactile_graph_classifiers.distances.choosing import choose_once, name_once
from tactile_graph_classifiers.distances.classifier import Lookup
from tactile_graph_classifiers.distances.discriminant_model import Learned
from tactile_graph_classifiers.distances.examples import Examples
from tactile_graph_classifiers.distances.identity import UNKNOWN, Identity
from tactile_graph_classifiers.distances.left_out import largest_accepted
from tactile_graph_classifiers.measuring.measurements import Measurements


class CanonicalDiscriminant:
    """Return which known object a reading most likely is of, or that it is of none.

    Parameters
    ----------
    database : Path or mapping, optional
        The object database, or an export of one; the sample of the thesis' objects if not given.
        It is read once, when the pipeline is loaded.
    features : list of str, optional
        Which features to compare; all that were learned if not given.
    reject : bool
        Whether a reading too far from the object it most likely is of is unknown.
    confidence : float
        Share of known objects' readings to be accepted: the less, the more strangers are found.

    Raises
    ------
    DataError
        If no object has two readings.

    Notes
    -----
    A quadratic discriminant in Fisher's canonical variates of the features and their logarithms,
    covariances shrunk towards that of all objects (J. H. Friedman, 1989,
    doi:10.1080/01621459.1989.10478752). How far, and in how many variates, is chosen by leaving
    readings and whole objects out: when they are learned, and kept in the database; when the
    pipeline is loaded for exports and for features chosen here. The distance is that of
    Mahalanobis, ``margin`` one minus the likelihood of the runner-up over that of the nearest,
    ``probability`` the likelihood of the nearest over the sum of all, each to a power at which the
    names of readings left out are likeliest: of the names that stand at a probability p, a share of
    p or so is right. What is accepted is the quantile of readings left out (split conformal
    prediction).
    """

    stateless = True

    def __init__(
        self,
        *,
        database: Path | dict[str, Any] | None = None,
        features: Annotated[list[str], MinLen(1)] | None = None,
        reject: bool = True,
        confidence: Annotated[float, Gt(0), Lt(1)] = CONFIDENCE,
    ) -> None:
        self._lookup = Lookup(database, features)
        self.takes, self.takes_by, self.takes_hint = self._lookup.taken
        known = self._lookup.known
        examples = Examples.of(known)
        manner = (known.choice or choose_once(examples)).manner
        self._learned = Learned.of(examples.readings, examples.labels, manner.shrinkage)
        self._discriminant = self._learned.discriminant(manner)
        self._examples, self._manner = examples, manner
        self._confidence = confidence if reject else None
        self._most_presses = examples.most_presses()
        self._accepted: dict[int, tuple[float | None, float]] = {}
        self._median = 0.0
        self._by_left_out(1)

    def __call__(self, features: Measurements) -> Identity:
        """Return the likeliest object, the runner-up and their margin.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or the reading is in another unit.
        """
        return self.together([features])

    def together(self, presses: Sequence[Measurements]) -> Identity:
        """Return which object all of several presses are of, which one press may not tell.

        Their mean in the variates varies less than one of them does; what is accepted is learned
        from as many successive readings left out together. Where fewer were learned than that
        takes (four times as many), further presses steady the mean, but narrow no limit.

        Parameters
        ----------
        presses : sequence of Measurements
            At least one.

        Raises
        ------
        DataError
            If a feature was not measured or is not finite, or a reading is in another unit.
        """
        vectors = np.array([self._lookup.vector(one) for one in presses])
        n_presses = min(len(vectors), self._most_presses)
        with np.errstate(over="ignore", invalid="ignore"):  # told below
            mean = self._learned.located(vectors).mean(axis=0)
            scores = self._discriminant(mean[None], n_presses)
        order = np.argsort(scores.unlikeliness[0], kind="stable")[:2]
        beyond = self._manner.beyond
        squares = [float(scores.at(order[i : i + 1], beyond)[0]) for i in range(len(order))]
        if not math.isfinite(squares[0]):
            raise DataError("features", "they are too far from every known object for a number")
        limit, temperature = self._by_left_out(n_presses)
        behind = (scores.unlikeliness[0] - scores.unlikeliness[0, order[0]]) / temperature
        found = self._identity(order.tolist(), squares, limit, float(behind[order[-1]]))
        probability = 1.0 / float(np.exp(-0.5 * behind).sum())
        return replace(found, n_presses=len(presses), probability=probability)

    def _by_left_out(self, n_presses: int) -> tuple[float | None, float]:
        """Return the largest squared distance at which so many presses are accepted, and how hot.

        A mean of presses has no longer tail than one press has. Where few were left out together
        to tell, one odd press among them must not widen the limit: it is at most that of one
        press, over the median of one press times theirs. Nor are they ever surer than one press.
        """
        if n_presses not in self._accepted:
            named = name_once(self._examples, self._manner, n_presses)
            squares, limit, temperature = named.squares, None, named.temperature()
            one, at_least = self._accepted.get(1, (None, 1.0))
            if self._confidence is not None:
                limit = largest_accepted(squares, self._confidence)
                if n_presses == 1:
                    self._median = float(np.median(squares)) if squares.size else 0.0
                elif self._median > 0.0 and one is not None:
                    limit = min(limit, one * float(np.median(squares)) / self._median)
            self._accepted[n_presses] = limit, max(temperature, at_least)
        return self._accepted[n_presses]

    def _identity(
        self, order: list[int], squares: list[float], limit: float | None, behind: float
    ) -> Identity:
        objects = [self._lookup.known.objects[k] for k in order]
        known = limit is None or squares[0] <= limit
        single = len(objects) == 1
        return Identity(
            objects[0].name if known else UNKNOWN,
            objects[0].shape if known else "",
            known,
            math.sqrt(squares[0]),
            None if limit is None else math.sqrt(limit),
            objects[0].name,
            "" if single else objects[1].name,
            None if single else math.sqrt(squares[1]),
            1.0 if single else -math.expm1(-0.5 * behind),
        )
