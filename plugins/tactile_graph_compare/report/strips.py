"""Picture strips of the chosen frames: a row of node pictures for each variant."""

from __future__ import annotations

from collections.abc import Sequence

from tactile_graph.wires.cells_png import heat_stops
from tactile_graph_compare.output.tables import signed
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.frames import Choice, ChosenFrame, NodeStory
from tactile_graph_compare.report.album import Album, Range
from tactile_graph_compare.report.badges import named
from tactile_graph_compare.report.markup import Html, counted, details, join, scroll, tag

MOST_BYTES = 1_600_000
"""Of pictures; frames beyond it are left out, and it is said."""
OPEN_FRAMES = 3
_RANK = {"worst": 0, "apart": 1, "no answer": 2, "regular": 3}


def strips(comparison: Comparison, album: Album) -> Html:
    """Return a strip for each chosen frame, in order; the first of the worst unfolded."""
    ranked = sorted(comparison.chosen, key=lambda f: min(_RANK[c.why] for c in f.choices))
    made: dict[int, Html] = {}
    for i, frame in enumerate(ranked):
        if album.size > MOST_BYTES:
            break
        strip = scroll(f"frame {frame.frame.index}", _strip(comparison, album, frame))
        made[frame.position] = details(
            _title(frame), strip, shown=i < OPEN_FRAMES, name=f"frame-{frame.position}"
        )
        album.size += len(strip)
        album.shown.add(frame.position)
    left_out = len(ranked) - len(made)
    told = f"{counted(left_out, 'more chosen frame')} left out, to keep the page small."
    note = tag("p", told, class_="note") if left_out else None
    return join([made[p] for p in sorted(made)], note)


def key() -> Html:
    """Return what the lines mean."""
    items = (
        tag("li", tag("span", class_=f"stroke {kind}"), f" {word}")
        for kind, word in (("found", "found"), ("true", "true"))
    )
    return tag("ul", items, class_="legend")


def told_choices(choices: Sequence[Choice]) -> str:
    """Return why a frame was kept, variants of equal reasons together."""
    found: dict[str, list[str]] = {}
    for c in choices:
        if c.why == "regular":
            found.setdefault(str(c), [])
        elif c.why == "worst":
            found.setdefault(f"worst {c.quantity} of ", []).append(c.variant)
        elif c.why == "apart":
            pair = f"{c.variant} from {c.reference}"
            found.setdefault(f"{c.quantity} farthest apart: ", []).append(pair)
        else:
            found.setdefault(f"no {c.quantity} from ", []).append(c.variant)
    return "; ".join(k + ", ".join(labels) for k, labels in found.items())


def _title(frame: ChosenFrame) -> Html:
    of = frame.frame
    told = f"Frame {of.index}"
    told += f", {of.time_s:.3f}".rstrip("0").rstrip(".") + " s" if of.time_s is not None else ""
    told += f", {of.label}" if of.label else ""
    return join(tag("b", told), " · ", told_choices(frame.choices))


# -- the table -----------------------------------------------------------------------------------


def _strip(comparison: Comparison, album: Album, frame: ChosenFrame) -> Html:
    stories = [s for of in frame.stories.values() for s in of.values()]
    shown = album.pictured | {s.node for s in stories if s.state in ("skipped", "failed")}
    columns = [n for n in node_order(frame, comparison.labels) if n in shown]
    rows = [_row(comparison, album, frame, label, columns) for label in comparison.labels]
    return tag(
        "table",
        head_of(album, frame, columns),
        tag("tbody", rows),
        class_="strip",
        style=f"--n:{len(columns) + 1}",
    )


def node_order(frame: ChosenFrame, labels: Sequence[str]) -> list[str]:
    """Return the variants' own names of nodes, equal ones as one, in an order fit for all."""
    order: list[str] = []
    for label in labels:
        at = 0
        for name in frame.stories[label]:
            if name in order:
                at = order.index(name) + 1
            else:
                order.insert(at, name)
                at += 1
    return order


def head_of(album: Album, frame: ChosenFrame, columns: Sequence[str]) -> Html:
    """Return the heads of frame and nodes, those of images with their range of colours."""
    heads = [_head("frame", album.range(frame, ""))]
    heads += [_head(name, album.range(frame, name)) for name in columns]
    corner = tag("th", tag("span", "variant", class_="unseen"), scope="col")
    return tag("thead", tag("tr", corner, heads))


def _head(name: str, scale: Range | None) -> Html:
    if scale is None:
        return tag("th", name, scope="col")
    low, high, unit = scale
    bar = tag("span", class_="bar", style=f"background:linear-gradient(90deg,{_STOPS})")
    ends = tag("span", tag("span", f"{low:.2g}"), bar, tag("span", f"{high:.2g} {unit}"),
               class_="scale")  # fmt: skip
    return tag("th", name, ends, scope="col")


_STOPS = ",".join(heat_stops())


def _row(
    comparison: Comparison, album: Album, frame: ChosenFrame, label: str, columns: Sequence[str]
) -> Html:
    mine = [c for c in frame.choices if c.variant == label]
    badges = [tag("span", _badge(c), class_="badge") for c in mine]
    units, found = comparison.units, frame.errors.get(label, {})
    errors = [tag("small", told_error(q, e, units.get(q, ""))) for q, e in found.items()]
    head = tag("th", named(comparison, label), badges, errors, scope="row")
    cells = [tag("td", album.frame(frame))]
    cells += [cell(album, frame, frame.stories[label].get(n), label) for n in columns]
    return tag("tr", head, cells, class_="worst" if mine else None)


def _badge(choice: Choice) -> str:
    words = {"worst": "★ worst", "apart": "↔ farthest", "no answer": "no"}
    return f"{words[choice.why]} {choice.quantity}"


def told_error(quantity: str, error: float, unit: str) -> str:
    """Return a signed error in words."""
    if quantity == "identity":
        return f"identity {'wrong' if error else 'right'}"
    if quantity == "count":
        return f"count {error:+.0f}"
    return f"{quantity} {signed(error, unit)} {unit}"


def cell(
    album: Album, frame: ChosenFrame, story: NodeStory | None, label: str, kind: str = "found"
) -> Html:
    """Return a node's picture, or why there is none."""
    if story is None:
        return tag("td", tag("span", "–", title="no such node"), class_="none")
    if story.state == "ran":
        return tag("td", album.value(frame, story, label, kind))
    if story.state == "not asked":
        return tag("td", "not asked", class_="none", title=story.reason)
    at = f"at {story.origin}: " if story.origin not in ("", story.node) else ""
    told = f"{at}{story.reason}"
    short = told if len(told) <= 90 else told[:89] + "…"
    return tag(
        "td", tag("b", story.state), tag("small", short), class_=f"none {story.state}", title=told
    )
