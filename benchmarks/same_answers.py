"""Whether two checkouts answer alike, bit for bit, in every shipped pipeline.

Run ``python benchmarks/same_answers.py OLD NEW`` with two folders that hold a checkout and its
environment in ``.venv``. Each checkout runs every pipeline on simulated frames of its own making,
with compiled kernels, and dumps what each output came to: numbers by their bits, arrays by their
digest, skips by reason and origin. Records are told by the names of their fields, not by the name
of their class, so that a class may be renamed. Exit code 1 if anything differs.
"""

from __future__ import annotations

import argparse
import dataclasses
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

SEED = 12
Rows = dict[tuple[str, int], dict[str, str]]


def flat(value: Any, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield (path, token) of everything a value holds; equal tokens mean equal bits."""
    if isinstance(value, np.ndarray):
        digest = hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()[:16]
        yield path, f"{value.dtype} {value.shape} {digest}"
    elif isinstance(value, float | np.floating):
        yield path, float(value).hex()
    elif value is None or isinstance(value, str | bytes | bool | int | np.integer | np.bool_):
        yield path, repr(value.item() if isinstance(value, np.generic) else value)
    elif isinstance(value, BaseException):
        yield path, str(value)
    elif dataclasses.is_dataclass(value):
        for field in dataclasses.fields(value):
            if not field.name.startswith("_"):
                yield from flat(getattr(value, field.name), f"{path}.{field.name}")
    elif hasattr(value, "_fields"):
        for name in value._fields:
            yield from flat(getattr(value, name), f"{path}.{name}")
    elif isinstance(value, dict):
        for key in sorted(value, key=str):
            yield from flat(value[key], f"{path}[{key}]")
    elif isinstance(value, tuple | list):
        yield path, f"{len(value)} items"
        for i, item in enumerate(value):
            yield from flat(item, f"{path}[{i}]")
    elif hasattr(value, "reason") and hasattr(value, "origin"):
        yield path, f"{value.origin}: {value.reason}"
    else:
        names = [n for k in type(value).__mro__ for n in getattr(k, "__slots__", ())]
        names += list(getattr(value, "__dict__", ()))
        for name in sorted({n for n in names if not n.startswith("_")}):
            yield from flat(getattr(value, name), f"{path}.{name}")


def dump(names: list[str], frames: int) -> None:
    """Print a line of JSON for each pipeline and frame; runs inside the checkout."""
    from tactile_graph import load
    from tactile_graph.plugins.registry import installed

    for name in names or installed().names("pipelines"):
        pipeline = load(name)
        source = pipeline.source
        given = {"scene": "discs"}
        if source is not None and source.name == "simulate":
            given = {k: v for k, v in source.settings.items() if v is not None}
        pipeline = pipeline.with_source("simulate", **{**given, "frames": frames})
        for result in pipeline.stream(seed=SEED):
            found: dict[str, str] = dict(flat(result.frame.image, "frame"))
            for output in pipeline.outputs:
                found.update(flat(result.outcome(output), output))
            print(json.dumps([name, result.frame.index, found]), flush=True)


def dumped(checkout: Path, names: list[str], frames: int, target: Path) -> None:
    """Write what a checkout answers to a file."""
    python = checkout / ".venv/bin/python"
    if not python.is_file():
        sys.exit(f"{checkout}: holds no environment .venv")
    command = [python, Path(__file__).resolve(), "--dump", "--frames", str(frames), *names]
    with target.open("w") as lines, tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "TACTILE_GRAPH_KERNELS": "compiled"}
        subprocess.run(command, stdout=lines, cwd=folder, env=environment, check=True)


def rows(path: Path) -> Rows:
    """Return what a dump holds: (pipeline, frame) -> field -> token."""
    lines = (json.loads(line) for line in path.read_text().splitlines())
    return {(name, index): found for name, index, found in lines}


def told(old: dict[str, Any], new: dict[str, Any]) -> tuple[list[str], list[str]]:
    """Return the fields that differ, and those that only one of both has."""
    differ = [k for k in old.keys() & new.keys() if old[k] != new[k]]
    return sorted(differ), sorted(old.keys() ^ new.keys())


def compared(name: str, old: Rows, new: Rows) -> bool:
    """Print how one pipeline's answers compare; return whether all are equal."""
    both = [k for k in old if k[0] == name and k in new]
    lonely = [k for k in old.keys() ^ new.keys() if k[0] == name]
    tellings = {k: told(old[k], new[k]) for k in both}
    differ = {k: fields for k, (fields, _) in tellings.items() if fields}
    n_values = sum(len(old[k]) for k in both)
    print(f"{name:22} {len(both):4} frames {n_values:8} values {len(differ):4} frames differ")
    for key, fields in [*differ.items()][:2]:
        for field in fields[:4]:
            print(f"    frame {key[1]} {field}: {old[key][field]} / {new[key][field]}")
    if lonely:
        print(f"    {len(lonely)} frames only in one")
    alone = {re.sub(r"\d+", "", f) for _, fields in tellings.values() for f in fields}
    if alone:
        print(f"    fields only in one: {', '.join(sorted(alone)[:8])}")
    return not (differ or lonely)


def main() -> int:
    """Compare two checkouts."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("given", nargs="*", help="OLD NEW [PIPELINE ...]; a dump's file will do")
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--dump", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--keep", type=Path, help="folder for the dumps, old.jsonl and new.jsonl")
    asked = parser.parse_args()
    if asked.dump:
        dump(asked.given, asked.frames)
        return 0
    if len(asked.given) < 2:
        parser.error("name two checkouts")
    folder = asked.keep or Path(tempfile.mkdtemp())
    found = []
    for side, given in zip(("old", "new"), map(Path, asked.given[:2]), strict=True):
        path = given if given.is_file() else folder / f"{side}.jsonl"
        if given.is_dir():
            dumped(given.resolve(), asked.given[2:], asked.frames, path)
        found.append(rows(path))
    names = asked.given[2:] or dict.fromkeys(k[0] for k in [*found[0], *found[1]])
    equal = [compared(name, *found) for name in names]
    return 0 if all(equal) else 1


if __name__ == "__main__":
    raise SystemExit(main())
