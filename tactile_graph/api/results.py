"""``Results``: the results of a stream of frames, one after the other or as a pandas table."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tactile_graph.api.result import Result
from tactile_graph.errors import UsageError
from tactile_graph.pipeline.graph import Graph

if TYPE_CHECKING:
    import pandas as pd

MISSING = "to_pandas needs pandas, which is not installed: pip install pandas"


class Results(Iterator[Result]):
    """The results of a stream of frames; each is computed when it is taken.

    Parameters
    ----------
    pipeline : Graph
    asked : tuple of str
        What is asked of it.
    results : iterator of Result
    """

    def __init__(self, pipeline: Graph, asked: tuple[str, ...], results: Iterator[Result]) -> None:
        self._pipeline = pipeline
        self._asked = asked
        self._results = results

    def __next__(self) -> Result:
        return next(self._results)

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
            where nobody knows it or frames differ in it.

        Raises
        ------
        UsageError
            If pandas is not installed.
        """
        try:
            import pandas as pd
        except ImportError:
            raise UsageError(MISSING) from None
        from tactile_graph.engine.tables.table import make_table, units_of

        table = make_table(self._pipeline, self._asked, long)
        rows: list[dict[str, Any]] = []
        quantities: set[str] = set()
        for result in self:
            quantities.add(result.frame.image.quantity)
            rows += table.rows(result)
        found = pd.DataFrame(rows, columns=[column.key for column in table.columns])
        found.attrs["units"] = units_of(table, quantities)
        return found
