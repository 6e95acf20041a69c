"""The pictures of a report: each drawn once, and shown wherever it is wanted."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any

import numpy as np

from tactile_graph.draw.display import display_list, images_in, is_picture, printed, truth_list
from tactile_graph.draw.grid_png import pale_uri
from tactile_graph.draw.paint_svg import LONGEST_NOTE, SvgPicture, View
from tactile_graph.inspect import scalars
from tactile_graph.quantities import unit_of
from tactile_graph_compare.output.tables import us
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.frames import ChosenFrame, NodeStory
from tactile_graph_compare.report.markup import Html, join, tag

SHOWN = 0.52
"""Size of a picture on the page against its own pixels."""
MOST_NOTES = 4
Range = tuple[float, float, str]


class Album:
    """Holds what was drawn, to be put once at the head of the page."""

    def __init__(self, comparison: Comparison) -> None:
        self._ranges = _ranges(comparison)
        self.pictured = _pictured(comparison)
        self.size = 0
        self.shown: set[int] = set()
        """Positions of the frames that have a strip."""
        self._names: dict[Hashable, str] = {}
        self._defined: list[Html] = []
        self._notes: dict[Hashable, list[str]] = {}

    def defined(self) -> Html:
        """Return all drawings, themselves unseen."""
        return tag(
            "svg", tag("defs", self._defined), width=0, height=0, class_="album",
            aria_hidden="true",
        )  # fmt: skip

    def once(self, key: Hashable, make: Callable[[], Html], kind: str | None = None) -> Html:
        """Return a reference to a drawing, made when it is first wanted."""
        if key not in self._names:
            name = f"p{len(self._names)}"
            made = make()
            self._names[key] = name
            self._defined.append(tag("g", made, id=name) if made else Html(""))
            self.size += len(made)
        return tag("use", href=f"#{self._names[key]}", class_=kind)

    def range(self, chosen: ChosenFrame, node: str) -> Range | None:
        """Return least, largest and unit of a node's images; of the frame where it is empty."""
        return self._ranges.get((chosen.position, node))

    # -- pictures ----------------------------------------------------------------------------

    def value(
        self, chosen: ChosenFrame, story: NodeStory, variant: str, kind: str = "found"
    ) -> Html:
        """Return a node's value over the frame, with the truth; words where it has no place."""
        drawing = self._drawing(chosen, story)
        told = f"{story.node} of {variant}, {us(story.time_us)} µs{_told(story)}"
        notes = self._noted(drawing)
        if not (drawing.grids or drawing.lines):
            return tag("div", notes, class_="bare", title=told)
        layers = [] if drawing.grids else [self._ground(chosen, drawing.view)]
        layers += self.layers(chosen, story, kind)
        return join(self.svg(chosen, drawing.view, layers, told), notes)

    def frame(self, chosen: ChosenFrame) -> Html:
        """Return the frame itself."""
        view = View.of(chosen.frame.image)
        low, high, _ = self.range(chosen, "") or (0.0, 1.0, "")

        def make() -> Html:
            return _markup(SvgPicture(view, display_list(chosen.frame), low, high).grids)

        layers = [self.once(("frame", chosen.position), make)]
        return self.svg(chosen, view, layers, f"frame {chosen.frame.index}")

    def layers(self, chosen: ChosenFrame, story: NodeStory, kind: str) -> list[Html]:
        """Return a value's grids and lines."""
        drawing = self._drawing(chosen, story)
        key = (chosen.position, story.merged, story.node)
        found = (
            [self.once(("grids", *key), lambda: _markup(drawing.grids))] if drawing.grids else []
        )
        lines = [self.once(("lines", *key), lambda: _markup(drawing.lines), kind)]
        return found + (lines if drawing.lines else [])

    def svg(self, chosen: ChosenFrame, view: View, layers: list[Html], told: str) -> Html:
        """Return layers as a picture, the truth over them."""
        return tag(
            "svg", tag("title", told), layers, self._truth(chosen, view),
            viewBox=f"0 0 {view.width:.0f} {view.height:.0f}", width=round(SHOWN * view.width),
            height=round(SHOWN * view.height), class_="pic", role="img", aria_label=told,
        )  # fmt: skip

    def over(self, chosen: ChosenFrame, before: NodeStory, after: NodeStory, told: str) -> Html:
        """Return the lines of two values over the frame."""
        view = View.of(chosen.frame.image)
        layers = [self._ground(chosen, view)]
        layers += self.layers(chosen, before, "before") + self.layers(chosen, after, "found")
        return self.svg(chosen, view, layers, told)

    # -- pieces ------------------------------------------------------------------------------

    def _drawing(self, chosen: ChosenFrame, story: NodeStory) -> SvgPicture:
        low, high, _ = self.range(chosen, story.node) or (0.0, 1.0, "")
        return SvgPicture(View.of(chosen.frame.image), display_list(story.value), low, high)

    def _ground(self, chosen: ChosenFrame, view: View) -> Html:
        image = chosen.frame.image
        return self.once(
            ("ground", chosen.position), lambda: Html(view.grid(image, pale_uri(image)))
        )

    def _truth(self, chosen: ChosenFrame, view: View) -> Html | None:
        if not chosen.frame.truth:
            return None
        truth = chosen.frame.truth

        def make() -> Html:
            return _markup(SvgPicture(view, truth_list(truth)).lines)

        return self.once(("truth", chosen.position), make, "true")

    def _noted(self, drawing: SvgPicture) -> Html:
        lines = drawing.notes[:MOST_NOTES]
        rest = len(drawing.notes) - len(lines)
        lines += [f"and {rest} more"] if rest else []
        return join(*(tag("small", line) for line in lines))


def _markup(elements: list[str]) -> Html:
    return Html("".join(elements))


def _told(story: NodeStory) -> str:
    shown = [
        f"{k.lstrip('.')} {printed(v, LONGEST_NOTE)}"
        for k, v in scalars("", story.value).items()
        if k
    ]
    return f": {', '.join(shown[:8])}" if shown else ""


def _pictured(comparison: Comparison) -> set[str]:
    """Return the names of nodes that have a place on the pad in some frame."""
    found = (s for f in comparison.chosen for of in f.stories.values() for s in of.values())
    return {s.node for s in found if s.state == "ran" and is_picture(s.value)}


def _ranges(comparison: Comparison) -> Mapping[tuple[int, str], Range]:
    """Return the range of each node's images in each frame, the same for all variants."""
    images: dict[tuple[int, str], list[Any]] = {}
    for frame in comparison.chosen:
        images[frame.position, ""] = [frame.frame.image]
        for story in (s for of in frame.stories.values() for s in of.values()):
            if story.state == "ran":
                images.setdefault((frame.position, story.node), []).extend(images_in(story.value))
    return {key: _range(of) for key, of in images.items() if of}


def _range(images: list[Any]) -> Range:
    shown = [i.values if i.valid is None else i.values[i.valid] for i in images]
    known = [v[np.isfinite(v)] for v in shown]
    low = min([0.0, *(float(v.min()) for v in known if v.size)])
    high = max((float(v.max()) for v in known if v.size), default=1.0)
    quantity = images[0].quantity
    return low, high if high > low else low + 1.0, unit_of(quantity)
