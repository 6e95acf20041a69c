"""Error against time: one point a variant, and the Pareto front through those none beats."""

from __future__ import annotations

from itertools import pairwise

from tactile_graph.draw.svg_text import text_width
from tactile_graph_compare.output.tables import number, us
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.records.scores import Score
from tactile_graph_compare.report.axes import Scale, bottom_axis, left_axis, plot, scale_of
from tactile_graph_compare.report.badges import class_of
from tactile_graph_compare.report.markup import Html, tag

WIDTH, HEIGHT = 380.0, 330.0
LEFT, RIGHT, TOP, BOTTOM = 62.0, 368.0, 14.0, 284.0
RADIUS = 8.0
Box = tuple[float, float, float, float]
Spot = tuple[float, float]


def error_title(quantity: str, unit: str, what: str = "mean error of ") -> str:
    """Return what stands on an axis of errors; an identity is right or wrong."""
    if quantity == "identity":
        return "share of identities that are wrong" if what else "identity wrong (1) or right (0)"
    return f"{what}{quantity}" + (f" in {unit}" if unit else "")


def scatter(comparison: Comparison, quantity: str) -> Html | None:
    """Return mean error against median time; None where no variant has both."""
    scores = [s for s in comparison.scores if s.quantity == quantity and s.mean is not None]
    times = {v.label: v.times for v in comparison.variants}
    scores = [s for s in scores if times[s.variant].median_us > 0.0]
    scores.sort(key=lambda s: s.pareto)  # those on the front are drawn last, over the others
    if not scores:
        return None
    spots = [(times[s.variant].median_us, s.mean or 0.0) for s in scores]
    x = scale_of([t for t, _ in spots], LEFT, RIGHT, close=True)
    y = scale_of([e for _, e in spots], BOTTOM, TOP, close=True)
    numbers = {v.label: v.number for v in comparison.variants}
    taken: list[Box] = [(x(t) - RADIUS, y(e) - RADIUS, x(t) + RADIUS, y(e) + RADIUS)
                        for t, e in spots]  # fmt: skip
    corners = _corners(scores, spots, x, y)
    lines = [
        (min(a[0], b[0]) - 1, min(a[1], b[1]) - 1, max(a[0], b[0]) + 1, max(a[1], b[1]) + 1)
        for a, b in pairwise(corners)
    ]
    parts = [
        *bottom_axis(x, BOTTOM, TOP, f"median time per frame in µs{_log(x)}"),
        *left_axis(y, LEFT, RIGHT, error_title(quantity, scores[0].unit) + _log(y)),
        *_front(corners),
        *(_spot(s, at, x, y, numbers[s.variant], times[s.variant].p95_us)
          for s, at in zip(scores, spots, strict=True)),
    ]  # fmt: skip
    parts += [
        q for s, at in zip(scores, spots, strict=True) for q in _name(s, at, x, y, taken, lines)
    ]
    return plot(WIDTH, HEIGHT, f"Error of {quantity} against time", parts)


def _log(scale: Scale) -> str:
    return " (log)" if scale.log else ""


def _corners(
    scores: list[Score], spots: list[Spot], x: Scale, y: Scale
) -> list[tuple[float, float]]:
    """Return the edge of what is beaten in pixels: a step down at each variant on the front.

    Only of those that answer most often: who answers less often beats none that answers more.
    """
    most = max(s.n_answered for s in scores)
    front = sorted(
        at for s, at in zip(scores, spots, strict=True) if s.pareto and s.n_answered == most
    )
    lower = [at for i, at in enumerate(front) if all(at[1] < b[1] for b in front[:i])]
    found: list[tuple[float, float]] = []
    for time, error in lower:
        found += [(x(time), found[-1][1] if found else TOP), (x(time), y(error))]
    return [*found, (RIGHT, found[-1][1])] if found else []


def _front(corners: list[tuple[float, float]]) -> list[Html]:
    if not corners:
        return []
    path = "M" + "L".join(f"{px:.1f} {py:.1f}" for px, py in corners)
    return [
        tag("path", d=f"{path}V{TOP:.1f}Z", class_="beaten"),
        tag("path", d=path, class_="front"),
    ]


def _spot(score: Score, at: tuple[float, float], x: Scale, y: Scale, n: int, p95_us: float) -> Html:
    unit = f" {score.unit}" if score.unit else ""
    told = (
        f"{score.variant}: mean {number(score.mean, score.unit)}{unit}, "
        f"95 % below {number(score.p95, score.unit)}{unit}; median {us(at[0])} µs, "
        f"95 % below {us(p95_us)} µs; {score.n_answered} answers, {score.n_missing} missing"
        + ("; on the Pareto front" if score.pareto else "")
    )
    kind = "" if score.pareto else " off"
    return tag(
        "g",
        tag("title", told),
        tag("circle", cx=x(at[0]), cy=y(at[1]), r=RADIUS, class_="spot"),
        tag("text", str(n), x=x(at[0]), y=y(at[1]) + 4, class_="num mid"),
        class_=class_of(n) + kind,
    )


def _name(
    score: Score, at: Spot, x: Scale, y: Scale, taken: list[Box], lines: list[Box]
) -> list[Html]:
    """Return the label where it covers nothing, at worst a line; else none: the number says it."""
    label = score.variant if len(score.variant) <= 26 else score.variant[:25] + "…"
    width = text_width(label, 11.0)
    px, py = x(at[0]), y(at[1])
    right, left, middle = px + RADIUS + 3, px - RADIUS - 3 - width, px - width / 2
    above, below = py - RADIUS - 8, py + RADIUS + 8
    places = [(right, py), (left, py), (middle, below), (middle, above), (px + 4, below),
              (px + 4, above), (px - width - 4, below), (px - width - 4, above)]  # fmt: skip
    for covered in ([*taken, *lines], taken):
        for start, line in places:
            box = (start, line - 7, start + width, line + 7)
            inside = (
                box[0] >= LEFT + 4 and box[2] <= RIGHT + 8 and box[1] >= TOP and box[3] <= BOTTOM
            )
            if inside and not any(_overlap(box, t) for t in covered):
                taken.append(box)
                return [tag("text", label, x=start, y=line + 4, class_="tick halo")]
    return []


def _overlap(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
