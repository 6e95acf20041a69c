"""Recordings in many dialects: each read right or refused with the remedy, none silently wrong.

    python benchmarks/dialects.py                       # the table
    python benchmarks/dialects.py --mutations 20000     # and as many damaged copies of the files

A file is read right if values, shape, times, quantity and pitch are those it was written with. One
that must be refused is read again with the settings that the refusal asks for. A damaged copy may
give frames or a `DataError`; any other exception, a warning, a value that is not finite and more
than five seconds of computing are faults.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from helpers_dialects import Dialect, became, dialects, mutated
from helpers_export_dialects import export_dialects
from helpers_more_dialects import more_dialects
from helpers_stranger_dialects import stranger_dialects
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.recording import recording

SLOWEST_S = 5.0


def table(files: list[Dialect], folder: Path) -> int:
    """Print what becomes of each file; return how many are not as they should be."""
    wrong, counted = 0, Counter[str]()
    for dialect in files:
        found = became(dialect, folder)
        good, words = found.fits(dialect), found.words
        outcome = found.outcome
        if dialect.refused and dialect.told:
            again = became(dialect, folder, dialect.told)
            good = good and again.outcome == "read"
            outcome += f", {again.outcome} as told"
        counted[outcome] += 1
        wrong += not good
        print(f"{'' if good else 'WRONG ':6}{dialect.name:48} {outcome:24} {words[:110]}")
    print(f"{len(files)} files: {dict(counted)}; not as they should be: {wrong}")
    return wrong


def mutations(files: list[Dialect], folder: Path, n: int, seed: int) -> int:
    """Read damaged copies; return how many did what none may do."""
    rng = np.random.default_rng(seed)
    counted, faults, slowest = Counter[str](), 0, (0.0, "")
    path = folder / "mutated"
    for k in range(n):
        dialect = files[k % len(files)]
        path.write_bytes(mutated(dialect.content, rng))
        since = time.process_time()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                frames = list(recording(path=path, report=Report()))
            if not all(np.isfinite(f.image.values).all() for f in frames):
                raise FloatingPointError("a value that is not finite")
            counted["frames"] += 1
        except DataError:
            counted["refused"] += 1
        except Exception:
            faults += 1
            kept = Path(tempfile.gettempdir()) / f"dialect-{seed}-{k}"
            kept.write_bytes(path.read_bytes())
            print(f"{dialect.name}, mutation {k}, kept as {kept}\n{traceback.format_exc(limit=-4)}")
        took = time.process_time() - since
        slowest = max(slowest, (took, dialect.name))
        faults += took > SLOWEST_S
    print(
        f"{n} mutations: {dict(counted)}; faults: {faults}; "
        f"slowest {slowest[0]:.2f} s ({slowest[1]})"
    )
    return faults


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--mutations", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    files = [*dialects(), *more_dialects(), *export_dialects(), *stranger_dialects()]
    with tempfile.TemporaryDirectory() as name:
        wrong = table(files, Path(name))
        wrong += mutations(files, Path(name), asked.mutations, asked.seed)
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
