"""``Calibration``: from readings to grams by a curve that was measured, and the file it lives in.

The file is YAML and says all that is needed to use the curve and to trust it: what was read, the
fit, the range it holds in, the measured points with their scatter, and where they came from.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from annotated_types import Ge, Gt, Len
from numpy.typing import NDArray
from pydantic import Field

from tactile_graph.files import write_whole
from tactile_graph_pads.calibration.curves import Isotonic, Polynomial, PowerLaw
from tactile_graph_pads.pad import read_file
from tactile_graph_pads.records import inline, read_record

Array = NDArray[np.float64]
FORMAT: Literal["tactile-graph calibration 1"] = "tactile-graph calibration 1"
UNITS = {"volt": "V", "siemens": "S", "counts": "counts", "raw": "raw"}
_CURVE_POINTS = 65


class Grams(NamedTuple):
    """Loads found behind readings; 0 where ``valid`` is False."""

    load_g: Array
    valid: NDArray[np.bool_]


@dataclass(frozen=True)
class Point:
    """One known load and what it read as.

    Parameters
    ----------
    load_g : float
        On each element.
    reading : float
        Mean over placements, each averaged over its group of elements.
    sd : float
        Standard deviation of those group means.
    sd_single : float
        Standard deviation of single elements.
    placements, elements : int
        How many group means and single elements stand behind it.
    """

    load_g: Annotated[float, Gt(0)]
    reading: float
    sd: Annotated[float, Ge(0)]
    sd_single: Annotated[float, Ge(0)]
    placements: Annotated[int, Ge(1)]
    elements: Annotated[int, Ge(1)]
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Quality:
    """How far the fit is from the measured points, in load.

    Parameters
    ----------
    rms_g, largest_g : float
        In grams on an element.
    rms_percent, largest_percent : float
        Of each point's load.
    r_squared : float
        Share of the loads' variance that the fit explains.
    """

    rms_g: float
    largest_g: float
    rms_percent: float
    largest_percent: float
    r_squared: float
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Units:
    """What the numbers are in, said for people.

    Parameters
    ----------
    reading : str
        Of readings and offset.
    load : str
        Of loads.
    """

    reading: str = ""
    load: str = "g on each element"
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Origin:
    """A recording that a calibration was made from.

    Parameters
    ----------
    file : str
        Its name.
    sha256 : str
        Empty for a store of many files.
    frames : int
        How many it holds.
    """

    file: str
    sha256: str = ""
    frames: int = 0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Provenance:
    """Where a calibration came from, so that it can be made again.

    Parameters
    ----------
    made_by : str
        Program and version.
    made_at : str
        Date and time.
    command : tuple of str
        What was typed, word by word.
    pad : str
        Whose converter and circuit were used; empty for none.
    decoupled : bool
        Whether the circuit's crosstalk was taken out first.
    group : (int, int)
        Rows and columns of elements that were loaded together and averaged.
    recordings : tuple of Origin
        Those of loads.
    empty : Origin, optional
        The recording of the empty pad that was taken off.
    """

    made_by: str = ""
    made_at: str = ""
    command: tuple[str, ...] = ()
    pad: str = ""
    decoupled: bool = False
    group: tuple[int, int] = (2, 2)
    recordings: tuple[Origin, ...] = ()
    empty: Origin | None = None
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Calibration:
    """A measured curve from readings to grams on an element.

    Parameters
    ----------
    format : str
        Marks the file and its version.
    reading : "volt", "siemens", "counts" or "raw"
        What the curve reads: the quantity of the images it may be applied to.
    fit : Polynomial, Isotonic or PowerLaw
        Grams on an element for a reading.
    from_reading, up_to : float
        Smallest and largest calibrated reading.
    quality : Quality
    points : tuple of Point
        What was measured, by rising load.
    about : str
        One line for people.
    units : Units
    provenance : Provenance
    offset : tuple of tuple of float
        What each element of the empty pad reads, row by row from the top: the curve reads what lies
        above. Empty where readings are taken as they are.
    """

    format: Literal["tactile-graph calibration 1"]
    reading: Literal["volt", "siemens", "counts", "raw"]
    fit: Annotated[Polynomial | Isotonic | PowerLaw, Field(discriminator="kind")]
    from_reading: Annotated[float, Ge(0)]
    up_to: Annotated[float, Gt(0)]
    quality: Quality
    points: Annotated[tuple[Point, ...], Len(2)]
    about: str = ""
    units: Units = field(default_factory=Units)
    provenance: Provenance = field(default_factory=Provenance)
    offset: tuple[tuple[float, ...], ...] = ()
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        if self.from_reading >= self.up_to:
            raise ValueError(
                f"from_reading must be below up_to, got {self.from_reading:g} and {self.up_to:g}"
            )
        if len({len(row) for row in self.offset}) > 1:
            raise ValueError("offset: its rows must be of one length")
        if not np.isfinite([value for row in self.offset for value in row]).all():
            raise ValueError("offset: every element must be a finite number")
        with np.errstate(all="ignore"):
            grams = self.fit.grams(np.linspace(0.0, self.up_to, 401))
        if not (np.isfinite(grams).all() and (np.diff(grams) >= -1e-9 * abs(grams).max()).all()):
            raise ValueError(
                f"fit: grams must rise with the reading from 0 to up_to = {self.up_to:g}, "
                "these fall or overflow somewhere"
            )

    def grams_of(self, readings: Array) -> Grams:
        """Return the grams behind readings of any shape; never NaN.

        At or below 0 a reading is 0 g. Between 0 and ``from_reading`` the curve goes on to
        (0, 0). Above ``up_to`` nothing is known: the cell is invalid and holds 0, and so is one
        that is no number.

        Parameters
        ----------
        readings : ndarray of float64
            Less the offset, where one is kept.
        """
        readings = np.asarray(readings, dtype=np.float64)
        valid = readings <= self.up_to
        in_range = valid & (readings > 0.0)
        load = np.zeros(readings.shape)
        load[in_range] = np.maximum(self.fit.grams(readings[in_range]), 0.0)
        return Grams(load, valid)

    def force_settings(self) -> dict[str, Any]:
        """Return the settings that give the step ``force`` this curve, without the offset.

        A power law becomes 64 straight lines of equal ratio, a polynomial and points stay what
        they are.
        """
        if isinstance(self.fit, Polynomial):
            return {"polynomial": list(self.fit.coefficients), "up_to": self.up_to}
        if isinstance(self.fit, Isotonic):
            return {"curve": [list(p) for p in self.fit.points[1:]]}  # from (0, 0) on by itself
        low = min(self.from_reading, 0.01 * self.up_to) or 1e-3 * self.up_to
        of = np.geomspace(low, self.up_to, _CURVE_POINTS)
        of[-1] = self.up_to
        pairs = zip(of.tolist(), self.fit.grams(of).tolist(), strict=True)
        return {"curve": [list(p) for p in pairs]}


def load_calibration(calibration: str | Path | Mapping[str, Any]) -> Calibration:
    """Return a calibration from its YAML file, or from a mapping.

    Parameters
    ----------
    calibration : str, Path or mapping

    Raises
    ------
    UsageError
        If the file cannot be read.
    RecordError
        With everything wrong with it, by line and column.
    """
    if isinstance(calibration, Mapping):
        return read_record(inline(calibration, "calibration"), Calibration, "a calibration")
    document = read_file(Path(calibration), "calibration")
    return read_record(document, Calibration, "a calibration")


def write_calibration(path: str | Path, calibration: Calibration) -> None:
    """Write a calibration as YAML, whole or not at all.

    Parameters
    ----------
    path : str or Path
    calibration : Calibration
    """
    write_whole(path, calibration_text(calibration, str(path)))


def calibration_text(calibration: Calibration, path: str = "") -> str:
    """Return a calibration as the YAML text of its file, with a node of it ready for use.

    Parameters
    ----------
    calibration : Calibration
    path : str
        Where the file will be: one that keeps an offset is named by its node.
    """
    from tactile_graph.pipeline.document import in_yaml

    data = _plain(asdict(calibration))
    order = ("format", "about", "reading", "units", "from_reading", "up_to", "fit", "quality")
    data = {k: data[k] for k in (*order, "points", "provenance", "offset")}
    above = ""
    if data["offset"]:
        above = "above the empty pad's, the offset of each element at the end, "
    else:
        del data["offset"]
    if data["provenance"]["empty"] is None:
        del data["provenance"]["empty"]
    settings = {"calibration": path} if above else _plain(calibration.force_settings())
    node = in_yaml(settings, default_flow_style=True, width=10**9).strip()
    name = {"siemens": "decoupled"}.get(calibration.reading, "frame")
    head = (
        f"# Made by tactile-graph calibrate. Readings {above}at or below 0 are 0 g, those above "
        "up_to are invalid.\n"
        f"# In a pipeline:  force: {{step: force, in: {name}, with: {node}}}\n"
    )
    body = in_yaml(data, sort_keys=False, allow_unicode=True, default_flow_style=None,
                   width=100)  # fmt: skip
    return head + body


def _plain(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {str(k): _plain(v) for k, v in data.items()}
    if isinstance(data, list | tuple):
        return [_plain(v) for v in data]
    if isinstance(data, np.generic):
        return data.item()
    return data if isinstance(data, bool | int | float | str) or data is None else str(data)
