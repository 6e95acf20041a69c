"""Who wins: the best error of each quantity, the fastest, and those nobody beats in both."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tactile_graph_compare.output.tables import by_other, left_out, number, us
from tactile_graph_compare.records.comparison import Comparison, Variant
from tactile_graph_compare.records.scores import Difference, Score
from tactile_graph_compare.report.badges import chip, named, of
from tactile_graph_compare.report.markup import Child, Html, counted, tag
from tactile_graph_compare.score.statistics import time_difference_of

MOST_NAMED = 3


def headline(comparison: Comparison) -> Html:
    """Return a card for each quantity and one for time, and the front in a sentence."""
    cards = [c for q in comparison.quantities if (c := _best(comparison, q)) is not None]
    fastest = _fastest(comparison)
    cards += [fastest] if fastest is not None else []
    return tag("div", cards, class_="cards")


def _card(title: str, figure: str, who: Child, *told: Child) -> Html:
    lines = [tag("p", t) for t in told if t]
    return tag(
        "article", tag("h3", title), tag("p", figure, class_="figure"), tag("p", who), lines,
        class_="card",
    )  # fmt: skip


def _best(comparison: Comparison, quantity: str) -> Html | None:
    scores = [s for s in comparison.scores if s.quantity == quantity and s.mean is not None]
    if not scores:
        return None
    best = min(scores, key=lambda s: s.mean or 0.0)
    unit = f" {best.unit}" if best.unit else ""
    answers = f"{best.n_answered} of {best.n_answered + best.n_missing} answered"
    return _card(
        f"Smallest mean error: {quantity}",
        f"{number(best.mean, best.unit)}{unit}",
        named(comparison, best.variant),
        f"largest {number(best.largest, best.unit)}{unit}; {answers}",
        _caveat(best, scores),
        _verdict(comparison, best, len(scores)),
        _front(comparison, quantity),
    )


def _caveat(best: Score, scores: list[Score]) -> str:
    """Say so where another answers more often: an error over fewer targets is an easier one."""
    most = max(scores, key=lambda s: s.n_answered)
    if most.n_answered <= best.n_answered:
        return ""
    return f"{most.variant} answers more often: {most.n_answered} times"


def _verdict(comparison: Comparison, best: Score, n_scores: int) -> str:
    if n_scores < 2:
        return "the only one scored"
    found = comparison.difference(best.variant, best.quantity)
    if found is not None:
        return _told(found, found.reference)
    against = [
        d
        for d in comparison.differences
        if d.quantity == best.quantity and d.reference == best.variant
    ]
    close = [d.variant for d in against if d.verdict not in ("worse", "none in common")]
    if close:
        return f"no clear difference from {_some(close)}"
    return ""


def _some(labels: list[str]) -> str:
    """Return a few of the labels, and how many there are beside."""
    rest = len(labels) - MOST_NAMED
    return ", ".join(labels[:MOST_NAMED]) + (f" and {rest} more" if rest > 0 else "")


def _told(found: Difference, other: str) -> str:
    if found.verdict == "none in common":
        return f"no answer in common with {other}"
    if found.verdict == "no clear difference":
        return f"no clear difference from {other}"
    clearly = "clearly " if found.for_all else ""
    return f"{clearly}{found.verdict} than {other}"


def _front(comparison: Comparison, quantity: str) -> Html | None:
    front = [s.variant for s in comparison.scores if s.quantity == quantity and s.pareto]
    if len(comparison.variants) < 2 or not front:
        return None
    many = len(front) > MOST_NAMED
    numbers = (comparison.variant(label).number for label in front)
    shown = map(chip, numbers) if many else (named(comparison, label) for label in front)
    chips = [part for one in shown for part in (one, " ")]
    return tag("span", "Pareto front: ", chips)


def _fastest(comparison: Comparison) -> Html | None:
    timed = [v for v in comparison.variants if _spent(v) > 0.0]
    if not timed:
        return None
    best = min(timed, key=_spent)
    others = sorted((v for v in timed if v is not best), key=_spent)
    ratios = tag(
        "ul",
        (tag("li", of(v), f" takes {by_other(_ratio(v, best))}") for v in others[:4]),
        class_="plain",
    )
    meant = "×: median over the frames of the time by the fastest one's in the same frame"
    return _card(
        "Fastest",
        f"{us(best.times.median_us)} µs",
        of(best),
        f"median per frame; 95\u00a0% below {us(best.times.p95_us)}\u00a0µs",
        *([ratios, meant] if others else []),
    )


def _ratio(variant: Variant, best: Variant) -> float:
    """Return how many times as long it takes, as tables and the lineage tell it."""
    return time_difference_of(variant.label, best.label, variant.times, best.times).ratio


def _spent(variant: Variant) -> float:
    spent = variant.times.median_us
    return spent if math.isfinite(spent) else 0.0


def warnings(comparison: Comparison) -> Iterator[Html]:
    """Yield what a reader must know before the figures."""
    if comparison.interrupted:
        told = f"Interrupted after {counted(comparison.frames.n, 'frame')}: these alone are shown."
        yield tag("p", told, class_="warning")
    if comparison.n_left_out:
        died = left_out(comparison.n_left_out, comparison.frames.n)
        told = f"{died}. They count for no variant, whichever of them it was."
        yield tag("p", told, class_="warning")
    if not comparison.quantities:
        yield tag(
            "p",
            "Nobody knows what truly lay there, or no output can be compared with it: there are "
            "no errors to show"
            + (", but how far the variants agree." if comparison.agreements else "."),
            class_="warning",
        )
    for variant in comparison.variants:
        if _silent(variant, comparison.frames.n):
            yield tag("p", of(variant), " gave no output in any frame.", class_="warning")
    for note in comparison.notes:
        yield tag("p", f"{note}.", class_="note")


def _silent(variant: Variant, n_frames: int) -> bool:
    """Return whether every output was skipped or failed in every frame."""
    without = dict.fromkeys(variant.asked, 0)
    for state, output, _, _, n in variant.reasons:
        without[output] += n if state != "strange" else 0
    return n_frames > 0 and all(n == n_frames for n in without.values())
