"""What ``run --resume`` finds under its output's name: all that is asked for, or another's."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.cli.many.made_of import changed, device
from tactile_graph.cli.many.unfinished import Unfinished
from tactile_graph.cli.output.outputs import FOLDER, Output
from tactile_graph.errors import UsageError
from tactile_graph.provenance import sidecar

OF_ALL_RUNS = ("versions", "code")
"""Of what runs into one data set are made alike: each may be of another recording, and the set
itself tells another pipeline."""


def stays(output: str) -> bool:
    """Return whether an output is there when the run is over: no pipe, no device."""
    return Unfinished.possible(output) or Path(output).is_dir()


def is_done(pipeline: Pipeline, output: Output, of: Mapping[str, str]) -> bool:
    """Return whether an output stands there, whole, made of the same; if so, nothing else of it.

    Raises
    ------
    UsageError
        If nobody can tell: frames that come only once, an output that is not kept.
    """
    if not stays(output.name):
        raise UsageError(f"--resume: what went to {output.name} is not known")
    port = device(pipeline)
    if port:
        raise UsageError(f"--resume: {port} gives its frames only once")
    note = _note(output)
    whole = note.get("complete") is True and note.get("bytes") == n_bytes(output.name)
    done = whole and note.get("made_of") == of
    if done:
        Unfinished(output.name).clear()
    return done


def refuse_other(output: Output, of: Mapping[str, str]) -> None:
    """Refuse to write over an output of other content; over nothing, or its own half, one may.

    Raises
    ------
    UsageError
    """
    if not n_bytes(output.name):
        return
    note = _note(output)
    before = note.get("made_of")
    if not isinstance(before, dict):
        told = f"is there, and {sidecar(output.name).name} does not say what it is made of"
    else:
        is_set = output.ending == FOLDER
        names = {*OF_ALL_RUNS, *_again(before, of)} if is_set else {*before, *of}
        other = changed(*({n: d for n, d in its.items() if n in names} for its in (before, of)))
        if not other and (is_set or note.get("complete") is False):
            return
        told = f"is made of other content: {other}" if other else "was changed after it was written"
    raise UsageError(
        f"--resume: {output.name} {told}; name another file, or write it anew without --resume"
    )


def _again(before: Mapping[str, str], now: Mapping[str, str]) -> set[str]:
    """Return what must be as it was of the recordings that a data set was last given; else none."""
    of = {name for name in (*before, *now) if name not in (*OF_ALL_RUNS, "options")}
    return {"options"} if all(before.get(name) == now.get(name) for name in of) else set()


def n_bytes(output: str) -> int:
    """Return how long an output is, of a folder all that is in it; 0 where nothing is."""
    place = Path(output)
    files = place.rglob("*") if place.is_dir() else [place]
    return sum(file.stat().st_size for file in files if file.is_file())


def _note(output: Output) -> dict[str, Any]:
    try:
        data = json.loads(sidecar(output.name).read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return data if isinstance(data, dict) else {}
