"""Axes of the small plots: a scale from numbers to pixels, its ticks, and the lines of both."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from tactile_graph_compare.report.markup import Html, tag

LOG_FROM = 8.0
"""Ratio of the largest to the smallest value from which an axis is logarithmic."""
CLOSE = 1.6
"""Ratio up to which they are close together."""
MOST_TICKS = 6


@dataclass(frozen=True)
class Scale:
    """Maps ``low`` … ``high`` to pixels ``start`` … ``end``, evenly or by logarithm."""

    low: float
    high: float
    start: float
    end: float
    log: bool = False

    def __call__(self, value: float) -> float:
        """Return where a value lies; beyond the ends, at the end."""
        value = min(max(value, self.low), self.high)
        share = (
            math.log(value / self.low) / math.log(self.high / self.low)
            if self.log
            else (value - self.low) / (self.high - self.low)
        )
        return self.start + share * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Return round values within, about half a dozen."""
        return self._log_ticks() if self.log else _even_ticks(self.low, self.high)

    def _log_ticks(self) -> list[float]:
        first, last = math.floor(math.log10(self.low)), math.ceil(math.log10(self.high))
        for steps in ((1, 2, 5), (1, 3), (1,)):
            found = [s * 10.0**d for d in range(first, last + 1) for s in steps]
            found = [t for t in found if self.low * 0.999 <= t <= self.high * 1.001]
            if len(found) <= MOST_TICKS + 1:
                break
        while len(found) > MOST_TICKS + 1:
            found = found[::2]
        return found if len(found) > 1 else [self.low, self.high]


def _even_ticks(low: float, high: float) -> list[float]:
    rough = (high - low) / MOST_TICKS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1, 2, 5, 10) if s * power >= rough * 0.999)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [round(i * step, 12) for i in range(first, last + 1)]


def scale_of(
    values: Iterable[float],
    start: float,
    end: float,
    *,
    log: bool | None = None,
    close: bool = False,
) -> Scale:
    """Return a scale that holds the finite values with a little room.

    Without ``log`` it is logarithmic where all are positive and spread over more than
    `LOG_FROM`; an even one begins at 0, but where ``close`` is true and positive values lie so
    close together that they could not be told apart; it then leaves room for names, too.
    """
    found = [v for v in values if math.isfinite(v)]
    if log is None:
        log = bool(found) and min(found) > 0.0 and max(found) >= LOG_FROM * min(found)
    if log:
        found = [v for v in found if v > 0.0] or [1.0]
        room = max(max(found) / min(found), 1.5) ** (0.16 if close else 0.08)
        return Scale(min(found) / room, max(found) * room, start, end, True)
    if close and len(found) > 1 and 0.0 < max(found) < CLOSE * min(found):
        room = max(0.15 * (max(found) - min(found)), 0.01 * max(found))
        return Scale(min(found) - room, max(found) + room, start, end)
    low, high = min([0.0, *found]), max([0.0, *found])
    if high == low:
        high = low + 1.0
    room = 0.06 * (high - low)
    return Scale(low - room if low < 0.0 else 0.0, high + room if high > 0.0 else 0.0, start, end)


def tick_text(value: float, digits: int = 4) -> str:
    """Return a tick's number, short."""
    plain = 10.0**digits <= abs(value) < 1e7
    told = f"{value:.0f}" if plain else f"{value:.{digits}g}"
    return told.replace("-", "\N{MINUS SIGN}") if "e" not in told else told


def bottom_axis(scale: Scale, y: float, top: float, title: str) -> list[Html]:
    """Return grid lines from ``y`` up to ``top``, numbers below, and the title below these."""
    made = []
    for tick in scale.ticks():
        x = scale(tick)
        made.append(tag("path", d=f"M{x:.1f} {y:.1f}V{top:.1f}", class_="grid"))
        made.append(tag("text", tick_text(tick), x=x, y=y + 15, class_="tick mid"))
    made.append(tag("path", d=f"M{scale.start:.1f} {y:.1f}H{scale.end:.1f}", class_="axis"))
    middle = (scale.start + scale.end) / 2
    return [*made, tag("text", title, x=middle, y=y + 33, class_="label mid")]


def left_axis(scale: Scale, x: float, right: float, title: str) -> list[Html]:
    """Return grid lines from ``x`` to ``right``, numbers on the left, the title on their left."""
    made = []
    for tick in scale.ticks():
        y = scale(tick)
        made.append(tag("path", d=f"M{x:.1f} {y:.1f}H{right:.1f}", class_="grid"))
        made.append(tag("text", tick_text(tick), x=x - 6, y=y + 4, class_="tick end"))
    made.append(tag("path", d=f"M{x:.1f} {scale.start:.1f}V{scale.end:.1f}", class_="axis"))
    middle = (scale.start + scale.end) / 2
    turned = f"translate(13 {middle:.1f}) rotate(-90)"
    return [*made, tag("text", title, transform=turned, class_="label mid")]


def plot(width: float, height: float, name: str, *parts: object) -> Html:
    """Return an SVG of that size with what it shows in words."""
    inner = [p for p in parts if isinstance(p, Html)]
    inner += [q for p in parts if isinstance(p, list) for q in p]
    return tag(
        "svg", tag("title", name), inner, viewBox=f"0 0 {width:.0f} {height:.0f}", role="img",
        aria_label=name, class_="plot", width=width, height=height,
    )  # fmt: skip
