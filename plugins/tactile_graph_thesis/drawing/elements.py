"""Structuring elements, drawn in cells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tactile_graph_thesis.drawing.panels import OFF, ON

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def elements_figure(specs: dict[str, Any]) -> Figure:
    """Return a figure of structuring elements, in cells.

    Parameters
    ----------
    specs : dict
        Title -> element, as pipeline files name it.
    """
    from matplotlib.colors import ListedColormap

    from tactile_graph_filters.morphology.elements import parse_element
    from tactile_graph_pads.calibration.plot import new_figure

    figure = new_figure(3.2 * len(specs) + 0.6, 3.6)
    parts = figure.subplots(1, len(specs), squeeze=False).flat
    for axes, (title, spec) in zip(parts, specs.items(), strict=True):
        cells = parse_element(spec).cells
        down, right = (n // 2 + 0.5 for n in cells.shape)
        axes.imshow(
            cells, ListedColormap([OFF, ON]), vmin=0, vmax=1, extent=(-right, right, down, -down)
        )
        axes.plot(0, 0, "+", color="white", ms=10)
        axes.set(
            title=f"{title}: {spec}", xlabel="cells right of the origin", ylabel="cells below it"
        )
    return figure
