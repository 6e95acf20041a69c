"""``Instrument``: the grid and pitch that a database's readings were recorded with."""

from __future__ import annotations

from typing import NamedTuple

SAME = 0.02
"""By how much pitches may differ that pass for one."""


class Instrument(NamedTuple):
    """The grid that readings were recorded with.

    Parameters
    ----------
    rows, columns : int
    pitch_x_cm, pitch_y_cm : float
        From element to element.
    """

    rows: int
    columns: int
    pitch_x_cm: float
    pitch_y_cm: float

    @classmethod
    def of(cls, rows: int, columns: int, pitch_x_cm: float, pitch_y_cm: float) -> Instrument:
        """Return one of plain numbers, as a database holds and seals them; of whatever numbers."""
        return cls(int(rows), int(columns), float(pitch_x_cm), float(pitch_y_cm))

    def __str__(self) -> str:
        """Grid and pitch, for people."""
        return (
            f"{self.rows} x {self.columns} elements {self.pitch_x_cm:.4g} x {self.pitch_y_cm:.4g}"
            " cm apart"
        )

    def same_pitch(self, other: Instrument) -> bool:
        """Return whether elements of both are as far apart."""
        pairs = zip(self[2:], other[2:], strict=True)
        return all(abs(one / two - 1.0) <= SAME for one, two in pairs)

    def same_as(self, other: Instrument) -> bool:
        """Return whether both have one grid and pitch."""
        return self[:2] == other[:2] and self.same_pitch(other)
