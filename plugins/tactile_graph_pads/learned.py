"""``Learned``: what recordings have taught about a pad, as its YAML file and table say it."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from numpy.typing import NDArray

from tactile_graph.errors import DataError, RuleError, one_of, shown
from tactile_graph.files import write_whole
from tactile_graph.text_files import decoded
from tactile_graph.wires import Image

Array = NDArray[np.float64]
Reading = Literal["counts", "volt", "siemens", "gram", "kilopascal", "raw", "level"]
Positive = Annotated[float, Gt(0)]
GOOD = "good"
STATES = (GOOD, "dead", "stuck", "noisy", "missing")
"""Of an element: as it should be; silent under loads, or without any noise; loaded when nothing
lies on it; scattering far more than the others; never read at all."""
ASSUMED_PITCH_CM = (1.0, 1.0)
"""What images have whose recording says no pitch, which tells nothing."""
SAME_PITCH = 1e-3
"""Share by which pitches of one pad may differ, as rounded."""
COLUMNS = ("row", "column", "offset", "noise", "gain", "state")


class Elements(NamedTuple):
    """What each element is like; every array has the shape (rows, columns).

    ``offset`` and ``noise`` (one standard deviation of a reading) are in the unit of the readings,
    ``gain`` has no unit and a median of 1, ``state`` holds one of `STATES`.
    """

    offset: Array
    noise: Array
    gain: Array
    state: NDArray[np.str_]

    @property
    def good(self) -> NDArray[np.bool_]:
        """Which elements can be believed, shape (rows, columns)."""
        return np.asarray(self.state == GOOD)


class AtRest(NamedTuple):
    """What elements read while nothing lies on them; every array has the shape (rows, columns).

    ``offset`` is 0 where elements are ``stuck``, ``noise`` the deviation of a reading with what
    the pad has drifted, ``good`` says which can be believed.
    """

    offset: Array
    noise: Array
    good: NDArray[np.bool_]
    stuck: NDArray[np.bool_]


@dataclass(frozen=True)
class TurnOn:
    """The least reading that shows beside nothing at all.

    Parameters
    ----------
    reading : float
        Where the distribution of readings under objects begins, in the unit of ``of``.
    of : str
        Quantity of these readings: as recorded, or grams where a pad's circuit and law were told.
    contrast : float
        How much denser readings are just above than just below, in standard deviations.
    """

    reading: Positive
    of: Reading
    contrast: float = 0.0
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}


@dataclass(frozen=True)
class Learned:
    """What recordings have taught about a pad; the section ``learned`` of its file.

    Parameters
    ----------
    reading : str
        Quantity of the recordings; offset, noise and levels are in its unit.
    rows, columns : int
        Number of elements down and across, as the recordings say.
    pitch_cm, origin_cm : (float, float)
        Distance of neighbouring centres and the top left corner of the first cell, x and y, as the
        recordings say.
    elements : str
        The table of offset, noise, gain and state of each element: a CSV file beside the pad's.
    noise : float
        Standard deviation of a reading, median of the good elements.
    touched_from : float
        Reading above the offset from which an element counts as touched.
    drift : float
        How far the empty pad's readings moved from the first to the last frame, median of the
        elements.
    saturated_from : float, optional
        Reading as recorded at which elements stop.
    gain_of : str, optional
        Quantity that the gains belong to: that of the recordings, or grams where a pad's circuit
        and law were told. None where no gains stand out from chance.
    turn_on : TurnOn, optional
    curve : tuple of (float, float)
        Rising law from a reading above the offset to grams on the element, from 0 g on; empty
        for none.
    place : str
        The correction of place: a file beside the pad's; empty for none.
    """

    reading: Reading
    rows: Annotated[int, Ge(1)]
    columns: Annotated[int, Ge(1)]
    pitch_cm: tuple[Positive, Positive]
    origin_cm: tuple[float, float]
    elements: str
    noise: Annotated[float, Ge(0)]
    touched_from: Positive
    drift: float = 0.0
    saturated_from: float | None = None
    gain_of: Reading | None = None
    turn_on: TurnOn | None = None
    curve: tuple[tuple[float, float], ...] = ()
    place: str = ""
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def beside(self, folder: Path) -> Learned:
        """Return the same with its files named from a folder on."""
        place = str(folder / self.place) if self.place else ""
        return replace(self, elements=str(folder / self.elements), place=place)

    def require_pitch(self, image: Image) -> None:
        """Refuse an image of another pitch than that of the recordings; an assumed one is none.

        Raises
        ------
        RuleError
        """
        mine, its = self.pitch_cm, image.pitch_cm
        if mine == its or ASSUMED_PITCH_CM in (mine, its):
            return
        if any(abs(a - b) > SAME_PITCH * a for a, b in zip(mine, its, strict=True)):
            raise RuleError(
                f"the pad was learned at a pitch of {mine[0]:g} x {mine[1]:g} cm, got "
                f"{its[0]:g} x {its[1]:g} cm: take the pad that was learned from such recordings, "
                "or say pitch_cm where the recording is wrong"
            )

    @cached_property
    def table(self) -> Elements:
        """Every element, read from the file ``elements``.

        Raises
        ------
        DataError
            If the file is not there, or not a table of this pad.
        """
        return read_elements(Path(self.elements), (self.rows, self.columns))

    @cached_property
    def at_rest(self) -> AtRest:
        """What frames are freed of; errors as of `table`."""
        table = self.table
        good, stuck = table.good, np.asarray(table.state == "stuck")
        offset = np.where(stuck, 0.0, table.offset)
        found = AtRest(offset, np.hypot(table.noise, self.drift), good, stuck)
        for each in found:
            each.setflags(write=False)
        return found


def write_elements(path: Path, elements: Elements) -> None:
    """Write the table of elements as CSV, one a line, whole or not at all."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row, column in np.ndindex(elements.offset.shape):
        offset, noise, gain = (f"{a[row, column]:.6g}" for a in elements[:3])
        writer.writerow((row, column, offset, noise, gain, elements.state[row, column]))
    write_whole(path, text.getvalue())


def read_elements(path: Path, shape: tuple[int, int]) -> Elements:
    """Return the table of elements that a CSV file holds.

    Parameters
    ----------
    path : Path
    shape : (int, int)
        Rows and columns that the table must have.

    Raises
    ------
    DataError
        If it cannot be read, or lacks an element, or holds what no element can be.
    """
    try:
        text = decoded(path.read_bytes())
        apart = next((mark for mark in ";\t" if mark in text.partition("\n")[0]), ",")
        lines = list(csv.DictReader(io.StringIO(text), delimiter=apart))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise DataError(str(path), f"the table of elements cannot be read: {error}") from error
    if lines and (missing := set(COLUMNS) - set(lines[0])):
        lacking = [name for name in COLUMNS if name in missing]
        raise DataError(
            f"{path}:1",
            f"needs the columns {','.join(COLUMNS)}; lacks {one_of(lacking)}, "
            f"got {shown(text.partition(chr(10))[0].strip())}",
        )
    numbers = np.full((3, *shape), np.nan)
    state, given = np.full(shape, "", dtype="U8"), np.zeros(shape, int)
    for n, line in enumerate(lines, 2):
        row, column, *values = _entry(line, f"{path}:{n}", shape, "," if apart != "," else ".")
        if first := int(given[row, column]):
            raise DataError(
                f"{path}:{n}",
                f"row {row}, column {column} is given twice; the first is in line {first}",
            )
        numbers[:, row, column], given[row, column] = values, n
        state[row, column] = line["state"]
    if not given.all():
        row, column = np.argwhere(given == 0)[0].tolist()
        raise DataError(str(path), f"lacks the element in row {row}, column {column}")
    offset, noise, gain = numbers
    return Elements(offset, noise, gain, state)


def _entry(
    line: dict[str, str], where: str, shape: tuple[int, int], point: str
) -> tuple[int, int, float, float, float]:
    """Return an element's place, offset, noise and gain; ``point`` stands before decimals."""
    place = [_number(line, name, where, int) for name in COLUMNS[:2]]
    numbers = [_number(line, name, where, float, point) for name in COLUMNS[2:5]]
    row, column = int(place[0]), int(place[1])
    if not (0 <= row < shape[0] and 0 <= column < shape[1]):
        raise DataError(
            where, f"row {row}, column {column} is not on a pad of {shape[0]} x {shape[1]}"
        )
    offset, noise, gain = numbers
    for wrong, rule in (
        (not math.isfinite(offset), f"offset must be finite, got {offset:g}"),
        (not 0.0 <= noise < math.inf, f"noise must be finite and >= 0, got {noise:g}"),
        (not 0.0 < gain < math.inf, f"gain must be finite and > 0, got {gain:g}"),
    ):
        if wrong:
            raise DataError(where, rule)
    if line["state"] not in STATES:
        raise DataError(where, f"state must be one of {one_of(STATES)}, got {line['state']!r}")
    return row, column, offset, noise, gain


def _number(
    line: dict[str, str], name: str, where: str, kind: type[float], point: str = "."
) -> float:
    text = line[name]
    try:
        return kind(text.replace(point, "."))
    except (AttributeError, ValueError):
        what = "a whole number" if kind is int else "a number"
        got = "nothing: the line ends before it" if text is None else shown(text)
        raise DataError(where, f"{name} must be {what}, got {got}") from None
