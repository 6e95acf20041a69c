"""Frames at 1 kHz within a deadline: the ladder of the engine beside the best schedule there is.

Run with ``python benchmarks/deadline.py``. Discs are put down one after the other, small and large,
with empty pads between; each lies for 20 to 150 frames. What each choice takes on each frame is
measured (processor time, the least of two, or of ``--rounds``); on these times every schedule is
then run by a virtual clock, the engine's own with its real decisions. The best schedule knows all
times beforehand and what each choice is worth on the whole, and has every frame on time; no
schedule can know which answer will be lucky. ``--without`` runs the ladder also without some of its
choices, on the same times. ``--real`` runs the real ladder on the real clock instead, frames coming
by a thread of their own, and replays what was decided. The settings of the engine's scheduler were
chosen on the stream of seed 5.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from deadline_parts.real import real_run
from deadline_parts.schedules import Came, best_schedule, fixed
from deadline_parts.stream import stream
from deadline_parts.table import Array, Table, measured
from deadline_parts.virtual import on_time, same_again

from tactile_graph import load

LADDERS = Path(__file__).parent / "ladders"
PERIOD_NS = 1_000_000


def worth(table: Table) -> Array:
    """Return the mean error of each choice for every frame with an object, shape as the times."""
    means = np.nanmean(table.error_cm, axis=1)
    return np.asarray(np.where(table.loaded, means[:, None], 0.0))


def line(name: str, table: Table, came: Came, deadline_ns: int, best_cm: float) -> float:
    """Print a row of the table; return the mean error of the answers."""
    answered = came.choices >= 0
    shares = [100 * np.mean(came.choices == k) for k in range(len(table.choices))]
    picked = table.error_cm[came.choices[answered], np.flatnonzero(answered)]
    error_cm = float(np.nanmean(picked))
    times = np.where(answered, came.latency_ns, np.inf)
    share = 100 * np.mean(times <= deadline_ns)
    against = f"{error_cm / best_cm:8.3f}" if best_cm else "        "
    by_choice = "".join(f"{its:8.1f}" for its in shares)
    print(f"  {name:<26}{share:8.2f}{by_choice}{error_cm:10.4f}{against}")
    return error_cm


def compared(table: Table, deadline_ns: int, about: str = "") -> None:
    """Print every schedule for one deadline."""
    names = "".join(f"{name:>8}" for name in table.choices)
    units = f"{'%':>8}" * (len(table.choices) - 1)
    print(f"\ndeadline {deadline_ns / 1e6:g} ms{about}", flush=True)
    print(
        f"  {'schedule':<26}{'on time':>8}{names}{'error':>10}{'against':>8}\n"
        f"  {'':<26}{'%':>8}{'%':>8}{units}{'cm':>10}{'best':>8}"
    )
    known = best_schedule(table, worth(table), PERIOD_NS, deadline_ns)
    best_cm = line("best, knowing all times", table, known, deadline_ns, 0.0)
    engine, results = on_time(table, PERIOD_NS, deadline_ns)
    line("the engine's", table, engine, deadline_ns, best_cm)
    for k, choice in enumerate(table.choices):
        line(f"always {choice}", table, fixed(table, k, PERIOD_NS), deadline_ns, best_cm)
    print(f"  replayed from its decisions: {'equal' if same_again(table, results) else 'DIFFERS'}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ladder", default="on-time", help="a file of benchmarks/ladders")
    parser.add_argument("--frames", type=int, default=20_000)
    parser.add_argument("--seed", type=int, default=100)
    parser.add_argument("--deadlines", default="1.5,2,3,5,10", help="in ms")
    parser.add_argument("--without", nargs="*", default=[], help="choices to leave out as well")
    parser.add_argument("--rounds", type=int, default=2, help="of which each time is the least")
    parser.add_argument("--real", action="store_true", help="on the real clock")
    asked = parser.parse_args()
    deadlines_ns = [int(1e6 * float(d)) for d in asked.deadlines.split(",")]
    pipeline = load(LADDERS / f"{asked.ladder}.yaml")
    frames = stream(asked.frames, asked.seed)
    if asked.real:
        for deadline_ns in deadlines_ns:
            real_run(pipeline, frames, PERIOD_NS, deadline_ns)
        return
    table = measured(pipeline, frames, asked.rounds)
    print(f"{asked.ladder}: {len(frames)} frames, one each ms; seed {asked.seed}")
    for name, took, error in zip(table.choices, table.took_ns / 1e3, table.error_cm, strict=True):
        low, median, high, most = np.percentile(took[table.loaded], [1, 50, 99, 100])
        print(
            f"  {name:<8} {median:7.0f} us (1 % {low:.0f}, 99 % {high:.0f}, most {most:.0f}); "
            f"error {np.nanmean(error):.4f} cm"
        )
    for table_of, about in [(table, "")] + [
        (table.without(name), f", without {name}") for name in asked.without
    ]:
        for deadline_ns in deadlines_ns:
            compared(table_of, deadline_ns, about)


if __name__ == "__main__":
    main()
