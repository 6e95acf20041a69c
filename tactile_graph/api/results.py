"""``Results``: the results of a stream of frames, one after the other or as a pandas table."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from tactile_graph.api.result import Result
from tactile_graph.errors import UsageError, without
from tactile_graph.pipeline.graph import Graph
from tactile_graph.steps.injected import Report

if TYPE_CHECKING:
    import pandas as pd

MISSING = "to_pandas needs pandas: pip install pandas"


class Results(Iterator[Result]):
    """The results of a stream of frames; each is computed when it is taken.

    In a ``with`` its source is closed at the end, however the loop over it is left.

    Parameters
    ----------
    pipeline : Graph
    asked : tuple of str
        What is asked of it.
    results : iterator of Result
    source : iterable, optional
        Where the frames come from; a generator is closed with the stream.
    report : Report, optional
        Of that source; an empty one where frames were handed in.
    """

    def __init__(
        self,
        pipeline: Graph,
        asked: tuple[str, ...],
        results: Iterator[Result],
        source: Iterable[Any] = (),
        report: Report | None = None,
    ) -> None:
        self.report = report or Report()
        self._pipeline = pipeline
        self._asked = asked
        self._results = results
        self._source = source
        self._closed = False
        self._taken = False
        self._broken = ""
        self._told = False

    def __next__(self) -> Result:
        try:
            result = next(self._results)
        except StopIteration:
            if not self._broken:
                self._source = ()  # nothing is left in it to be closed, or held
            if self._broken and not self._told:
                self._told = True  # once: who goes on after any error would never come to the end
                raise UsageError(
                    f"the stream ended with {self._broken}, and has no further frames; "
                    "pipeline.stream() makes a new one"
                ) from None
            raise
        except BaseException as error:  # whatever raised is over: it would seem to have ended well
            self._broken = type(error).__name__
            raise
        self._taken, self._broken = True, ""
        return result

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the stream, and close its source where that is a generator: a port is free again."""
        self._closed = True
        for frames in (self._results, self._source):
            if isinstance(frames, Generator):
                frames.close()

    def to_pandas(self, *, long: bool = False) -> pd.DataFrame:
        """Run the frames that are left, and return their results as a table.

        Parameters
        ----------
        long : bool
            A row a frame and object, every item of every list; else a row a frame.

        Returns
        -------
        pandas.DataFrame
            ``attrs["units"]`` holds the unit of each column of numbers: ``1`` for bare ones, ""
            where nobody knows it or frames differ in it. Missing numbers are NaN.

        Raises
        ------
        UsageError
            If pandas is not installed, the stream was closed, or no frames are left of those there
            were.
        """
        if self._closed:
            raise UsageError("the stream was closed; pipeline.stream() makes a new one")
        try:
            import pandas as pd
        except ImportError as error:
            raise UsageError(without("pandas", error, MISSING)) from error
        from tactile_graph.engine.tables.table import make_table, units_of

        table = make_table(self._pipeline, self._asked, long)
        rows: list[dict[str, Any]] = []
        quantities: set[str] = set()
        taken_before, self._told = self._taken, False
        n_frames = 0
        try:
            for result in self:
                quantities.add(result.frame.image.quantity)
                rows += table.rows(result)
                n_frames += 1
        except Exception as error:
            told = "taken one by one, their results are kept"
            error.add_note(f"{n_frames} frames came before that, and their rows are lost; {told}")
            raise
        if taken_before and not quantities:
            raise UsageError(
                "no frames are left: all results of the stream were taken before; "
                "pipeline.stream() makes a new one"
            )
        found = pd.DataFrame(rows, columns=[column.key for column in table.columns])
        units = units_of(table, quantities)
        for column in table.columns:
            if column.key in units and found[column.key].isna().all():  # pandas cannot know: object
                whole = not rows and issubclass(column.kind, int | np.integer)
                found[column.key] = found[column.key].astype(int if whole else float)
        found.attrs["units"] = units
        return found
