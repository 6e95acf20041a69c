"""Time calls in turn, fairly, however slow some of them are."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping


def in_turn(
    calls: Mapping[str, Callable[[], object]], rounds: int, round_s: float, most_s: float
) -> dict[str, tuple[float, ...]]:
    """Return microseconds a call for each contestant and round; in a round each runs once.

    It is processor time, of all threads: on a machine that others use too the clock on the wall
    would mostly tell of them, and most where a call is long.

    Parameters
    ----------
    calls : mapping
    rounds : int
    round_s : float
        A contestant's share of a round; at least one call is made.
    most_s : float
        A contestant one call of which takes longer is timed in that one call only.
    """
    counts, slow = {}, {}
    for name, call in calls.items():
        call()
        spent = _spent(call)
        if spent <= most_s:  # what compiles or remembers may do so in any of its first calls
            spent = min(spent, *(_spent(call) for _ in range(3)))
        if spent > most_s:
            slow[name] = (1e6 * spent,)
        else:
            counts[name] = max(1, round(round_s / spent))
    times: dict[str, list[float]] = {name: [] for name in counts}
    for _ in range(rounds):
        for name, n in counts.items():
            start = time.process_time()
            for _ in range(n):
                calls[name]()
            times[name].append(1e6 * (time.process_time() - start) / n)
    return {name: slow.get(name) or tuple(times[name]) for name in calls}


def _spent(call: Callable[[], object]) -> float:
    start = time.process_time()
    call()
    return time.process_time() - start
