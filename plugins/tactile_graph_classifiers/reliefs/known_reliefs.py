"""``KnownReliefs``: learned reliefs in memory, and as the arrays that a database keeps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tactile_graph_classifiers.database.relief_rows import Kept
from tactile_graph_classifiers.database.rows import damaged
from tactile_graph_classifiers.reliefs.pad_reading import LEAST, MOST, Law, PadReading
from tactile_graph_classifiers.reliefs.relief import Relief

Array = NDArray[np.float64]
HELD = (0.5, 2.0)
"""Within so many times that of all objects an object's usual misfit is held: else one that was
learned badly would take in the presses of others."""

BADLY = 5.0
"""So many times the misfit of others' presses tells of an object that was not learned."""


POORLY = 0.25
"""Readings that vary by more than this share beside what reliefs explain are explained poorly."""


@dataclass(frozen=True, eq=False)
class KnownReliefs:
    """Reliefs of known objects.

    Parameters
    ----------
    pad : PadReading
    full_scale : float
        Reading that counts as 1.
    pitch_cm : float
        Of the pad they were learned on.
    names : tuple of str
    reliefs : tuple of Relief
    usual : ndarray, shape (K,)
        Median misfit of each object's presses, left out.
    left_out : tuple of ndarray, shape (n,) each
        Misfit of each reading's press to its own relief learned without it; NaN where there is
        none.
    """

    pad: PadReading
    full_scale: float
    pitch_cm: float
    names: tuple[str, ...]
    reliefs: tuple[Relief, ...]
    usual: Array
    left_out: tuple[Array, ...]

    @classmethod
    def of(
        cls,
        pad: PadReading,
        scale: tuple[float, float],
        names: Sequence[str],
        reliefs: Sequence[Relief],
        left_out: Sequence[Array],
    ) -> KnownReliefs:
        """Return what was learned, each object's usual misfit found from those left out.

        Parameters
        ----------
        pad : PadReading
        scale : (float, float)
            Full scale, and pitch in cm.
        names, reliefs, left_out : sequence
            Of each object.
        """
        medians = np.array([_median(some) for some in left_out])
        middle = np.nanmedian(medians) if np.isfinite(medians).any() else 1.0
        usual = np.clip(np.where(np.isfinite(medians), medians, middle), *np.multiply(HELD, middle))
        return cls(pad, *scale, tuple(names), tuple(reliefs), usual, tuple(left_out))

    def badly_learned(self) -> list[str]:
        """Return the objects whose left out presses are far further off than those of others."""
        medians = np.array([_median(some) for some in self.left_out])
        far = medians > BADLY * np.nanmedian(medians) if np.isfinite(medians).any() else []
        return [name for name, badly in zip(self.names, far, strict=False) if badly]

    def explained_poorly(self) -> float:
        """Return the share by which readings vary beside what reliefs explain; 0 if by little."""
        vary = float(np.sqrt(self.pad.variances[1]))
        return vary if vary > POORLY else 0.0

    def kept(self) -> Kept:
        """Return them as the database keeps them."""
        pad = self.pad
        numbers = [self.full_scale, pad.top, pad.lean_variance, self.pitch_cm]
        of_pad = {
            "law": np.array([pad.law]),
            "gains": pad.gains,
            "doubts": pad.doubts,
            "variances": pad.variances[None],
            "numbers": np.array([numbers]),
        }
        objects = {}
        for name, it, usual, left in zip(
            self.names, self.reliefs, self.usual, self.left_out, strict=True
        ):
            own = np.array([[it.usual, it.soft, *it.deep, usual]])
            objects[name] = {"depth": it.depth, "picture": it.picture, "numbers": own,
                             "left_out": left[None]}  # fmt: skip
        return Kept(of_pad, objects)

    @classmethod
    def from_kept(cls, kept: Kept, where: str) -> KnownReliefs:
        """Return what a database has kept.

        Parameters
        ----------
        kept : Kept
        where : str
            The database, for errors.

        Raises
        ------
        DataError
            If a number is none that could have been learned.
        """
        numbers = kept.pad["numbers"][0].tolist()
        full_scale, top, lean_variance, pitch_cm = numbers
        law = Law(*kept.pad["law"][0].tolist())
        bounds = zip(LEAST, law, MOST, strict=True)
        positive = [kept.pad["gains"], kept.pad["variances"], kept.pad["numbers"]]
        positive += [arrays["numbers"][:, [0, 1, 4]] for arrays in kept.objects.values()]
        good = all(a <= x <= b for a, x, b in bounds) and min(map(np.min, positive)) > 0.0
        if not good or kept.pad["doubts"].min() < 0.0:
            raise damaged(where, "a number about the pad or a relief is out of range")
        gains, doubts, variances = (kept.pad[name] for name in ("gains", "doubts", "variances"))
        pad = PadReading(law, gains, doubts, top, variances[0], lean_variance)
        reliefs = []
        for arrays in kept.objects.values():
            usual, soft, *deep = arrays["numbers"][0, :4].tolist()
            reliefs.append(
                Relief(arrays["depth"], np.zeros((0, 6)), usual, soft, np.zeros(0),
                       arrays["picture"], np.array(deep))
            )  # fmt: skip
        of_each = kept.objects.values()
        usual = np.array([arrays["numbers"][0, 4] for arrays in of_each])
        left_out = tuple(arrays["left_out"][0] for arrays in of_each)
        return cls(pad, full_scale, pitch_cm, tuple(kept.objects), tuple(reliefs), usual, left_out)


def _median(values: Array) -> float:
    return float(np.nanmedian(values)) if np.isfinite(values).any() else np.nan
