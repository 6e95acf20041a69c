"""``Item``: a table, figure or study of the thesis and how it is made; ``Made``: what came out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from tactile_graph_thesis.work import Work


@dataclass(frozen=True)
class Finding:
    """A conclusion of the thesis beside what comes out here.

    Parameters
    ----------
    thesis : str
        What the thesis concludes.
    found : str
        What comes out here, in numbers.
    refuted_by : str
        What was settled beforehand to speak against it: what would have to come out.
    holds : bool
        Whether that did not come out.

    Raises
    ------
    ValueError
        If nothing could refute it.
    """

    thesis: str
    found: str
    refuted_by: str
    holds: bool

    def __post_init__(self) -> None:
        if not self.refuted_by.strip():
            raise ValueError(f"finding {self.thesis!r}: refuted_by must say what would refute it")


class Table(NamedTuple):
    """Rows of plain values.

    Parameters
    ----------
    columns : tuple of str
        Names that carry the units.
    rows : sequence of tuple
    """

    columns: tuple[str, ...]
    rows: Sequence[tuple[Any, ...]]


class Compared(NamedTuple):
    """One number of ours beside the thesis'.

    Parameters
    ----------
    what : str
        Which object and quantity.
    unit : str
    ours : float
        NaN where there was no reading with an answer.
    thesis : float, optional
        None where the thesis has no such number.
    low, high : float, optional
        Between these lie nine in ten of what groups of readings, as many as the thesis', give.
    limit : bool
        Whether the thesis only says "less than" its number.
    largest : bool
        Whether it is the maximum of several readings: it grows with their number, which the thesis
        does not give, and is counted apart from averages.
    """

    what: str
    unit: str
    ours: float
    thesis: float | None = None
    low: float | None = None
    high: float | None = None
    limit: bool = False
    largest: bool = False

    @property
    def ratio(self) -> float | None:
        """Ours over the thesis', where both are numbers."""
        if self.thesis is None or self.thesis == 0.0 or not math.isfinite(self.ours):
            return None
        return self.ours / self.thesis

    @property
    def within(self) -> bool | None:
        """Whether the thesis' number lies in our range; None where there is no such range."""
        if self.thesis is None or self.low is None or self.high is None:
            return None
        return self.low <= self.thesis <= self.high


@dataclass(frozen=True, eq=False)
class Made:
    """What an item came to.

    Parameters
    ----------
    compared : tuple of Compared
        Numbers beside the thesis'.
    findings : tuple of Finding
        What the thesis concludes, and whether it comes out.
    table : Table, optional
        The data behind the figure, for a CSV file.
    figure : matplotlib Figure, optional
    svg : str
        A drawing that is no matplotlib figure.
    notes : tuple of str
        Remarks with numbers of this run.
    """

    compared: tuple[Compared, ...] = ()
    findings: tuple[Finding, ...] = ()
    table: Table | None = None
    figure: Figure | None = None
    svg: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Item:
    """A table or figure of the thesis, or a study that belongs to a section of it.

    Parameters
    ----------
    id : str
        ``table-4.5``, ``figure-4.5``, or the name of a study.
    title : str
    shows : str
        What is to be seen, in a sentence or two.
    make : callable
        ``make(work)`` returns a `Made`.
    why : str
        Where ours differs from the thesis', and why. Numbers of a run stand in `Made.notes`.
    study : str
        Another name for it: that of the study whose figure it is.
    after : str
        The number of the figure or section it stands after, where its own does not say it.
    """

    id: str
    title: str
    shows: str
    make: Callable[[Work], Made]
    why: str = ""
    study: str = ""
    after: str = ""

    @property
    def name(self) -> str:
        """What people call it: ``table 4.5``."""
        return self.id.replace("-", " ") if self.number else self.id

    @property
    def number(self) -> str:
        """``4.5``; empty for a study."""
        kind, dash, number = self.id.partition("-")
        return number if dash and kind in ("table", "figure") else ""

    @property
    def place(self) -> tuple[tuple[int, ...], bool]:
        """Sorts items in the order of the thesis."""
        return tuple(map(int, (self.after or self.number).split("."))), bool(self.after)
