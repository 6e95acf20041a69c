"""Step ``force``: the grams on each element, by the pad's force law or a calibration."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from annotated_types import Ge
from numpy.typing import NDArray
from pydantic import AfterValidator

from tactile_graph.compiled import compiled_later
from tactile_graph.errors import RuleError
from tactile_graph.steps.rules import Grid, Quantity
from tactile_graph.wires import Image
from tactile_graph_filters.nan import refuse_nan

Values = NDArray[np.float64]


def _rising(curve: list[tuple[float, float]] | None) -> list[tuple[float, float]] | None:
    if curve is not None:
        points = [(0.0, 0.0), *curve] if curve and curve[0] != (0.0, 0.0) else list(curve)
        if len(points) < 2:
            raise ValueError("curve: needs at least one point (reading, grams) above (0, 0)")
        for (r0, g0), (r1, g1) in pairwise(points):
            if not (r0 < r1 < np.inf and g0 <= g1 < np.inf):
                raise ValueError(
                    "curve: points (reading, grams) must rise from (0, 0) on,"
                    f" got ({r1:g}, {g1:g}) after ({r0:g}, {g0:g})"
                )
    return curve


Curve = Annotated[list[tuple[float, float]] | None, AfterValidator(_rising)]


@compiled_later
def floored(grams, floor_g):  # type: ignore[no-untyped-def]
    """Put loads below ``floor_g`` to 0, in place; return whether no load is NaN or infinite."""
    bad = 0
    for i in range(grams.shape[0]):
        row = grams[i]
        for j in range(grams.shape[1]):
            bad += row[j] - row[j] != 0  # NaN for NaN and infinity
            if row[j] < floor_g:
                row[j] = 0.0
    return bad == 0


class Calibrated(NamedTuple):
    """What a calibration file says, as this step's own settings."""

    curve: list[tuple[float, float]] | None
    polynomial: list[float] | None
    up_to: float | None
    reading: str
    """The quantity of what is read."""
    offset: Values | None
    """What each element of the empty pad reads, where that is to be taken off."""


def load_calibrated(path: Path) -> Calibrated:
    """Return what a calibration file says."""
    from tactile_graph_pads.calibration.calibration import load_calibration

    found = load_calibration(path)
    settings = found.force_settings()
    curve = settings.get("curve")
    return Calibrated(
        None if curve is None else [(float(r), float(g)) for r, g in curve],
        settings.get("polynomial"),
        settings.get("up_to"),
        found.reading,
        np.array(found.offset) if found.offset else None,
    )


def beyond_range(image: Image, value: Image) -> str:
    """Return what to say of cells that read more than what gave their grams covers."""
    if value.valid is None:
        return ""
    read = ~value.valid if image.valid is None else image.valid & ~value.valid
    n = int(np.count_nonzero(read))
    if not n:
        return ""
    cells = "1 cell reads" if n == 1 else f"{n} cells read"
    return (
        f"{cells} more than the law, curve or polynomial covers, and what is summed leaves out "
        "their load: it is a lower bound"
    )


class Force:
    """Return the grams on each element.

    Parameters
    ----------
    pad : str or mapping, optional
        Name of a pad, its YAML file, or the pad itself: the inverse of its force law turns
        conductance into load. ``thesis`` if nothing is given.
    curve : list of (float, float), optional
        Instead: points (reading, grams), joined by straight lines from (0, 0) on.
    polynomial : list of float, optional
        Instead: grams as a polynomial of the reading, constant first; the thesis fits one of
        the fifth order to volts (section 2.4).
    up_to : float, optional
        Largest reading that the polynomial was fitted to; readings above become invalid.
    calibration : Path, optional
        Instead: a file that ``tactile-graph calibrate`` has written. Where it was told what the
        empty pad reads, the file keeps that, and it is taken off here too.
    tared : bool
        Whether that was taken off before, by ``tare`` or ``correct_readings``: it is then left.
    floor_g : float, optional
        Loads below this are 0 g. Half the turn-on load of a pad's law if nothing is given: there
        the element's conductance is lost in the converter's noise, and without a floor an empty
        thesis pad would read some 400 g. 0 for a curve or polynomial.

    Raises
    ------
    ValueError
        If more than one of ``pad``, ``curve``, ``polynomial`` and ``calibration`` is given, or
        ``curve`` does not rise, or ``polynomial`` is empty, or ``tared`` is said without a
        ``calibration``.

    Notes
    -----
    A reading beyond what the law, the curve or the polynomial covers becomes invalid: nothing is
    clipped at the top. Readings and loads at or below 0 are 0 g.
    """

    stateless = True
    notice = staticmethod(beyond_range)

    def __init__(
        self,
        *,
        pad: str | dict[str, Any] | None = None,
        curve: Curve = None,
        polynomial: list[float] | None = None,
        up_to: float | None = None,
        calibration: Path | None = None,
        tared: bool = False,
        floor_g: Annotated[float | None, Ge(0)] = None,
    ) -> None:
        kinds = {"pad": pad, "curve": curve, "polynomial": polynomial, "calibration": calibration}
        given = [name for name, setting in kinds.items() if setting is not None]
        if len(given) > 1:
            raise ValueError(f"at most one of {', '.join(kinds)}, got {' and '.join(given)}")
        if tared and calibration is None:
            raise ValueError("tared belongs to calibration, which is not given")
        self._quantity = ""
        self._offset: Values | None = None
        if calibration is not None:
            found = load_calibrated(calibration)
            curve, polynomial, up_to, self._quantity, offset = found
            self._offset = None if tared else offset
        if polynomial is not None and not polynomial:
            raise ValueError("polynomial: needs at least one coefficient, got none")
        if up_to is not None and polynomial is None:
            raise ValueError("up_to belongs to polynomial, which is not given")
        self._law: Any = None
        self._curve: Values | None = None
        self._polynomial = None if polynomial is None else np.array(polynomial[::-1])
        self._up_to = np.inf if up_to is None else up_to
        if curve is not None:
            _rising(curve)
            self._curve = np.array([(0.0, 0.0), *(p for p in curve if tuple(p) != (0.0, 0.0))])
        elif polynomial is None:
            from tactile_graph_pads.pad import load_pad

            told = load_pad("thesis" if pad is None else pad)
            self._law = told.law
            self.takes_by = "" if pad is None else "pad"
            if told.learned is not None and told.learned.curve:
                self.takes_hint = (
                    f"the law that was learned of the pad's {told.learned.reading} is its "
                    "learned.curve: give those points as curve, not the pad"
                )
        read = self._quantity if self._law is None else "siemens"
        self.takes = {"image": (read,)} if read else {}
        turn_on_g = 0.0 if self._law is None else self._law.turn_on_g
        self._floor_g = 0.5 * turn_on_g if floor_g is None else floor_g

    def __call__(
        self, image: Annotated[Image, Quantity("siemens", "volt", "counts", "raw")]
    ) -> Annotated[Image, Quantity("gram"), Grid.like("image")]:
        """Return the image in grams.

        Raises
        ------
        RuleError
            If a force law is asked to read anything but siemens, or a calibration anything but
            what it was made of, or of another grid than that of the empty pad it keeps.
        """
        if self._quantity not in ("", image.quantity):
            raise RuleError(f"the calibration reads {self._quantity}, got {image.quantity}")
        if self._law is not None and image.quantity != "siemens":
            raise RuleError(
                f"a force law reads siemens, got {image.quantity}; decouple the image first,"
                " or give curve or polynomial"
            )
        grams = self._grams(self._above(image))
        valid = image.valid
        if not floored.call(grams, self._floor_g):
            refuse_nan(image)
            known = np.isfinite(grams)
            valid = known if valid is None else valid & known
        if valid is not None:
            grams = np.where(valid, grams, 0.0)
        return Image(grams, image.pitch_cm, image.origin_cm, "gram", valid)

    def _above(self, image: Image) -> Values:
        """Return the readings less those of the empty pad, where a calibration keeps them."""
        readings = np.ascontiguousarray(image.values, np.float64)
        if self._offset is None:
            return readings
        if image.shape != self._offset.shape:
            rows, columns = self._offset.shape
            raise RuleError(
                f"the calibration keeps what an empty pad of {rows} x {columns} elements reads, "
                f"got an image of {image.rows} x {image.columns}: put this step before what "
                "changes the grid"
            )
        return np.asarray(readings - self._offset)

    def _grams(self, readings: Values) -> Values:
        """Return the loads; infinite where the reading is beyond what is known."""
        if self._curve is not None:
            of, grams = self._curve[:, 0], self._curve[:, 1]
            return np.asarray(np.interp(readings, of, grams, left=0.0, right=np.inf))
        if self._polynomial is not None:
            grams = np.maximum(np.polyval(self._polynomial, readings), 0.0)
            grams[readings <= 0.0] = 0.0
            grams[readings > self._up_to] = np.inf
            return np.asarray(grams)
        return np.asarray(self._law.load_of(readings))
