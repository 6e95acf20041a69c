"""Every shipped pipeline on five units and three grids: it answers, or says what it lacks.

    python benchmarks/any_units.py                            # 54 pipelines, 810 combinations
    python benchmarks/any_units.py --pipelines identify-any circle-3

Each frame shows one round object in the middle of a pad of 16x16, 28x28 or 12x40 cells, read raw,
in counts, volts, grams or kilopascals. Every pipeline runs as it is shipped, with nothing set. It

- answers, where every output has a value or was skipped by a condition of the pipeline's own;
- says so before, where it refuses the frame before any step ran. It must then also refuse to be
  loaded with a source that says it gives this unit, by the same words;
- finds nothing, where a fit says of the object that it is none of its kind;
- says so late, where a step failed on the frame for any other reason;
- breaks, where it ended in an exception that is none of the project's own.

The last must be 0, and so the one before it, but for `identify-reliefs`, which learned on one pad.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from tactile_graph import Frame, load
from tactile_graph.errors import Degenerate, PipelineError, RuleError
from tactile_graph.plugins.registry import installed

GRIDS = ((16, 16), (28, 28), (12, 40))
PEAKS = {"raw": 500.0, "counts": 900.0, "volt": 1.2, "gram": 60.0, "kilopascal": 30.0}
OUTCOMES = ("answers", "says so before", "finds nothing", "says so late", "breaks")
LATE = OUTCOMES[-2:]


class Outcome(NamedTuple):
    """What a pipeline did with a frame.

    Parameters
    ----------
    pipeline, quantity : str
    grid : (int, int)
    what : str
        One of `OUTCOMES`.
    why : str
        Its own words, where it did not answer.
    """

    pipeline: str
    quantity: str
    grid: tuple[int, int]
    what: str
    why: str = ""


def disc(grid: tuple[int, int], quantity: str, seed: int = 0) -> Frame:
    """Return a round object in the middle of the pad, of uneven load, with noise around."""
    rng = np.random.default_rng(seed)
    rows, columns = grid
    y, x = np.mgrid[:rows, :columns]
    dome = 1.0 - ((x - columns / 2) ** 2 + (y - rows / 2) ** 2) / (0.28 * min(grid)) ** 2
    values = np.sqrt(np.clip(dome, 0.0, None)) * (1.0 + 0.1 * rng.normal(size=grid))
    values = PEAKS[quantity] * (values + 0.003 * rng.normal(size=grid))
    whole = quantity in ("raw", "counts")
    return Frame.of(np.round(values) if whole else values, 1.0, quantity=quantity)


def outcomes(name: str) -> Iterator[Outcome]:
    """Yield what a pipeline does with every unit and grid."""
    pipeline = load(name)
    for quantity in PEAKS:
        for grid in GRIDS:
            what, why = "answers", ""
            try:
                for failed in pipeline.run(disc(grid, quantity)).failures:
                    nothing = isinstance(failed.error, Degenerate)
                    what, why = "finds nothing" if nothing else "says so late", failed.reason
            except RuleError as error:
                what, why = "says so before", str(error)
                if not refused_when_loaded(name, quantity, why):
                    what = "says so late"
            except Exception as error:
                what, why = "breaks", f"{type(error).__name__}: {error}"
            yield Outcome(name, quantity, grid, what, why)


def refused_when_loaded(name: str, quantity: str, why: str) -> bool:
    """Return whether a source that says it gives the unit is refused, for the same reason."""
    takes = why.splitlines()[0].partition(", got ")[0].partition(" takes ")[2]
    try:
        load(name).with_source("recording", path="any.npz", quantity=quantity)
    except PipelineError as error:
        return f" takes {takes}, got {quantity}" in str(error)
    return False


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    names = installed().names("pipelines")
    parser.add_argument("--pipelines", nargs="*", choices=names, default=names, metavar="NAME")
    args = parser.parse_args(arguments)
    found: list[Outcome] = []
    print(f"{'pipeline':<22}" + "".join(f"{quantity:>12}" for quantity in PEAKS))
    for name in args.pipelines:
        here = [*outcomes(name)]
        found += here
        cells = [{o.what for o in here if o.quantity == quantity} for quantity in PEAKS]
        words = ["lacks" if one == {"says so before"} else "FAILS" if one.intersection(LATE)
                 else "answers" for one in cells]  # fmt: skip
        print(f"{name:<22}" + "".join(f"{word:>12}" for word in words), flush=True)
    counts = Counter(one.what for one in found)
    print(f"\nof {len(found)}: " + ", ".join(f"{counts[what]} {what}" for what in OUTCOMES))
    for one in found:
        if one.what in (*LATE, "finds nothing"):
            print(f"{one.what}: {one.pipeline}, {one.quantity}, {one.grid}: {one.why}")


if __name__ == "__main__":
    main()
