"""Damaged object databases and exports: what is read of them is what was written, or refused.

    python benchmarks/attacks/databases.py [--tries 100000] [--seed 1]

A database of a few objects is damaged by flipped bytes, runs of zeros, lost ends, swapped and
copied blocks, and by rows deleted or changed behind the plugin's back; then it is read. Allowed is
a `DataError` or just what was written; counted are other answers and other exceptions. Exports are
damaged as texts: as people may edit these, another answer is no fault, another exception is.
"""

from __future__ import annotations

import sqlite3
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from attempts import Attempt, parser_of, told

from tactile_graph.errors import DataError
from tactile_graph_classifiers.database.known import Known
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.database.text import to_text
from tactile_graph_classifiers.distances.choosing import choose
from tactile_graph_classifiers.distances.examples import Examples

FEATURES = ("weight", "area_cm2", "axis_ratio", "holes")
BLOCK = 512
SLOW_S = 0.5


def written(path: Path) -> Known:
    """Make a database, and return what it holds."""
    rng = np.random.default_rng(0)
    lessons = [
        Lesson(name, "disc", rng.normal(10.0 * k + 5.0, 1.0, (8, 4)), [f"{name} frame {i}"
                                                                      for i in range(8)])
        for k, name in enumerate(("cup", "Würfel", "stone", "key"))
    ]  # fmt: skip
    store = ObjectDatabase(path)
    store.learn(Setting(FEATURES, "raw", "describe"), lessons)
    known = store.known()
    store.keep(choose(Examples.of(known)), known)
    return store.known()


def same(a: Known, b: Known) -> bool:
    """Return whether two databases say the same."""
    return (
        a.same_readings(b)
        and (a.quantity, a.pipeline, a.choice) == (b.quantity, b.pipeline, b.choice)
        and all(
            (x.shape, x.sources, x.statistics.n) == (y.shape, y.sources, y.statistics.n)
            and np.array_equal(x.statistics.mean, y.statistics.mean)
            and np.array_equal(x.statistics.scatter, y.statistics.scatter)
            for x, y in zip(a.objects, b.objects, strict=True)
        )
    )


def damaged(data: bytes, rng: np.random.Generator) -> bytes:
    """Return the bytes of a file with some damage."""
    some = bytearray(data)
    at = int(rng.integers(len(some)))
    kind = rng.integers(6)
    if kind == 0:
        return bytes(some[:at])
    if kind == 1:
        some[at : at + int(rng.integers(1, BLOCK))] = b""
    elif kind == 2:
        n = min(int(rng.integers(1, 2 * BLOCK)), len(some) - at)
        some[at : at + n] = bytes(n)
    elif kind == 3 and len(some) > 2 * BLOCK:
        one, other = rng.integers(0, len(some) // BLOCK, 2) * BLOCK
        some[one : one + BLOCK] = some[other : other + BLOCK]
    else:
        where = slice(0, 100) if rng.random() < 0.1 else slice(0, len(some))
        for _ in range(int(rng.integers(1, 9))):
            k = int(rng.integers(where.start, min(where.stop, len(some))))
            some[k] = int(rng.integers(256))
    return bytes(some)


TABLES = {
    "about": ("quantity", "pipeline"), "features": ("name",), "readings": ("source", "object_id"),
    "choice": ("shrinkage", "variates"), "objects": ("name", "shape", "n_readings", "learned_at"),
    "reading_values": ("value", "feature_id"), "means": ("mean",), "scatters": ("scatter",),
}  # fmt: skip
VALUES = ("1", "2.5", "'x'", "NULL", "x'ff'", "0", "-1", "1e300", "'gram'")


def edited(path: Path, rng: np.random.Generator) -> None:
    """Delete or change rows, its constraints switched off, as another program might."""
    table = str(rng.choice(list(TABLES)))
    column, value = str(rng.choice(TABLES[table])), str(rng.choice(VALUES))
    some = "" if rng.random() < 0.3 else f" WHERE abs(random()) % {rng.integers(2, 9)} = 0"
    change = (
        f"DELETE FROM {table}" if rng.random() < 0.4 else f"UPDATE {table} SET {column}={value}"
    )
    connection = sqlite3.connect(path)
    try:
        connection.execute("PRAGMA ignore_check_constraints = ON")
        connection.execute(change + some)
        connection.commit()
    except sqlite3.Error:  # NULL, or twice the same: then nothing is changed
        connection.rollback()
    finally:
        connection.close()


def attack(tries: int, seed: int, folder: Path) -> Iterator[Attempt]:
    """Yield what came of files, by what was attacked."""
    rng = np.random.default_rng(seed)
    path, export = folder / "objects.sqlite", folder / "objects.yaml"
    known = written(path)
    whole, text = path.read_bytes(), to_text(known).encode()
    for i in range(tries):
        kind = ("bytes", "bytes", "rows", "export")[i % 4]
        file = export if kind == "export" else path
        path.with_name(path.name + "-journal").unlink(missing_ok=True)
        path.with_name(path.name + "-wal").unlink(missing_ok=True)
        file.write_bytes(text if kind == "export" else whole)
        if kind == "rows":
            edited(path, rng)
        else:
            file.write_bytes(damaged(file.read_bytes(), rng))
        began = time.process_time()
        came = outcome(file, known)
        seconds = time.process_time() - began
        came = "SLOW" if seconds > SLOW_S else came
        may_differ = kind == "export" and came == "ANOTHER ANSWER"
        came = "another answer" if may_differ else came
        why = "" if came.islower() else f"try {i}: {came}"
        yield Attempt(f"database, {kind}", came.partition(":")[0], why, seconds)


def outcome(file: Path, known: Known) -> str:
    """Return what comes of reading a file."""
    try:
        found = load_known(file, None)
    except DataError:
        return "refused"
    except Exception as error:
        return f"FOREIGN {type(error).__name__}: {error}"[:200]
    return "the same" if same(found, known) else "ANOTHER ANSWER"


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if any answer was another one, or any exception foreign."""
    args = parser_of(__doc__ or "", 100_000).parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        return told(attack(args.tries, args.seed, Path(folder)), args)


if __name__ == "__main__":
    sys.exit(main())
