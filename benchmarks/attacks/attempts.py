"""What all attacks here have in common: attempts, a seed, an end, a table of what came of them."""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

MOST_SHOWN = 200


class Attempt(NamedTuple):
    """One thing that was tried.

    Parameters
    ----------
    what : str
        The kind of attack.
    came : str
        What came of it, in a word or two.
    why : str
        What is wrong with that, at length; empty if it is as promised.
    seconds : float
        How long it took.
    """

    what: str
    came: str
    why: str = ""
    seconds: float = 0.0


def parser_of(doc: str, tries: int) -> argparse.ArgumentParser:
    """Return a parser of what every attack is told."""
    parser = argparse.ArgumentParser(description=doc.partition("\n")[0])
    parser.add_argument("--tries", type=int, default=tries, help="how many at most")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="how long at most")
    parser.add_argument("--seed", type=int, default=1)
    return parser


def told(attempts: Iterable[Attempt], args: argparse.Namespace) -> int:
    """Print failures as they come and the table at the end; return 1 if there were any.

    Parameters
    ----------
    attempts : iterable of Attempt
    args : Namespace
        Of `parser_of`, or one that says as much; ``minutes`` may be missing.
    """
    begun = time.monotonic()
    until = begun + 60.0 * getattr(args, "minutes", float("inf"))
    counts: Counter[tuple[str, str]] = Counter()
    failures: Counter[str] = Counter()
    worst: dict[str, float] = {}
    try:
        for attempt in attempts:
            counts[attempt.what, attempt.came] += 1
            worst[attempt.what] = max(worst.get(attempt.what, 0.0), attempt.seconds)
            if attempt.why:
                failures[attempt.what] += 1
                if failures.total() <= MOST_SHOWN:
                    print(f"FAILED {attempt.what}: {attempt.came}: {attempt.why}", flush=True)
            if time.monotonic() > until:
                break
    except KeyboardInterrupt:  # what was tried so far counts
        print("ended by Ctrl-C", flush=True)
    _print_table(counts, failures, worst)
    seconds = time.monotonic() - begun
    words = json.dumps({k: v for k, v in vars(args).items() if v != float("inf")})
    print(f"{failures.total()} failures in {counts.total()} tries; {seconds:.0f} s; {words}")
    return 1 if failures else 0


def _print_table(
    counts: Counter[tuple[str, str]], failures: Counter[str], worst: dict[str, float]
) -> None:
    """Print a line for each kind of attack: tries, failures, the longest time, what came of it."""
    wide = max((len(what) for what in worst), default=0)
    print(f"{'attack':{wide}} {'tries':>7} {'failed':>6} {'worst s':>8}  what came of it")
    for what in sorted(worst):
        came = {c: n for (w, c), n in counts.items() if w == what}
        listed = ", ".join(f"{n} {c}" for c, n in sorted(came.items(), key=lambda x: -x[1]))
        n = sum(came.values())
        print(f"{what:{wide}} {n:7} {failures[what]:6} {worst[what]:8.3f}  {listed}")
