"""Figures as bytes: the same figure gives the same bytes."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 130
UNDATED = {"svg": {"Date": None}, "pdf": {"CreationDate": None}}


def pictures(figure: Figure, kinds: tuple[str, ...] = ("svg", "png")) -> dict[str, bytes]:
    """Return a figure as SVG and PNG, or other kinds.

    Parameters
    ----------
    figure : matplotlib Figure
        Its layout stays as it is found here.
    kinds : tuple of str
        As matplotlib names formats.
    """
    import matplotlib as mpl

    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laying out takes longer than drawing, and once is enough
    made = {}
    for kind in kinds:
        data = io.BytesIO()
        with mpl.rc_context({"svg.hashsalt": "tactile-graph"}):
            metadata = UNDATED.get(kind)
            figure.savefig(data, format=kind, dpi=DPI, metadata=metadata)
        made[kind] = data.getvalue()
    return made
