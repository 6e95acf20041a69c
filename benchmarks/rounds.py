"""Time callables side by side in rounds, so that a drifting machine hurts all alike."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Timed:
    """Microseconds per call of one contestant: one figure a round."""

    name: str
    rounds_us: tuple[float, ...]

    @property
    def median_us(self) -> float:
        return statistics.median(self.rounds_us)

    def ratio_to(self, other: Timed) -> tuple[float, float, float]:
        """Median and middle half of the round-by-round ratios to another contestant."""
        ratios = [a / b for a, b in zip(self.rounds_us, other.rounds_us, strict=True)]
        low, middle, high = statistics.quantiles(ratios, n=4)
        return middle, low, high


def time_side_by_side(
    contestants: Mapping[str, Callable[[], object]], rounds: int = 21, round_s: float = 0.02
) -> dict[str, Timed]:
    """Return the times of each contestant; in every round each runs once, in turn.

    Each round's figure is the mean over as many calls as fit into ``round_s`` seconds.
    """
    counts = {name: _calls_in(call, round_s) for name, call in contestants.items()}
    times: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(rounds):
        for name, call in contestants.items():
            n = counts[name]
            start = time.perf_counter()
            for _ in range(n):
                call()
            times[name].append(1e6 * (time.perf_counter() - start) / n)
    return {name: Timed(name, tuple(t)) for name, t in times.items()}


def _calls_in(call: Callable[[], object], seconds: float) -> int:
    for _ in range(3):
        call()
    n = 1
    while True:
        start = time.perf_counter()
        for _ in range(n):
            call()
        spent = time.perf_counter() - start
        if spent > seconds / 4:
            return max(1, round(n * seconds / spent))
        n *= 4


def print_table(times: Mapping[str, Timed], reference: str) -> None:
    """Print medians and the ratio of each contestant to the reference, with its middle half."""
    base = times[reference]
    print(f"{'':34}{'median us':>11}{'ratio':>9}   middle half of the rounds")
    for name, timed in times.items():
        middle, low, high = timed.ratio_to(base)
        print(f"{name:34}{timed.median_us:11.2f}{middle:9.3f}   {low:.3f} .. {high:.3f}")
    print(f"ratios are to: {reference}; {len(base.rounds_us)} rounds\n")
