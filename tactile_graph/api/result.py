"""``Result``: what a frame came to, as a user holds it: a row, a picture, a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tactile_graph.engine.outcomes.outcomes import Outcomes

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import RenderableType


class Result(Outcomes):
    """The outcome of one frame; as a mapping, the outputs that have a value.

    ``result["circle"]`` is the output's value; `NoResult` says why where there is none.
    """

    __slots__ = ()

    @property
    def ok(self) -> bool:
        """Whether every output asked for has a value, and every item of its lists.

        A value that is not finite is none, as for the exit code of ``run``.
        """
        from tactile_graph.engine.tables.strange import strange_within

        return super().ok and not any(map(strange_within, self.values()))

    def row(self) -> dict[str, Any]:
        """Return the outputs flattened into named scalars, as tables and CSV have them."""
        from tactile_graph.engine.tables.rows import result_row

        return result_row(self)

    def picture(self, *names: str) -> Figure:
        """Return a figure of the named nodes' values (all, if none is named), axes in cm."""
        from tactile_graph.draw.strip import strip_figure

        return strip_figure([self], list(names) or None)

    def _repr_png_(self) -> bytes:
        from tactile_graph.draw.strip import figure_png

        return figure_png(self.picture())

    def __rich__(self) -> RenderableType:
        from tactile_graph.draw.tables import result_table

        return result_table(self)
