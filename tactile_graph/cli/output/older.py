"""What a run that ends early leaves of an output of which there is an older, whole one.

The older one stays; what came of the run lies beside it: ``out.unfinished.csv`` by ``out.csv``.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

from tactile_graph.files import is_plain
from tactile_graph.provenance import sidecar


def unfinished_by(output: str) -> str:
    """Return the name that lies beside an older, whole output; "" where there is none.

    An output that is known to be of a run that ended early is none, nor is an empty file.
    """
    place = Path(output)
    if not (place.is_dir() or (is_plain(output) and place.exists() and place.stat().st_size)):
        return ""
    if _ended_early(output):
        return ""
    target = Path(os.path.realpath(place)) if place.is_symlink() else place
    return str(target.with_name(f"{target.stem}.unfinished{target.suffix}"))


def stays(output: str) -> str:
    """Return what to say of an older output that a run that ended early has left alone."""
    return f"the older {output} stays"


def only_first(n: int) -> str:
    """Return what there is in an output of a run that an error ended."""
    return f"only the first {n} frames are in it" if n > 1 else "only the first frame is in it"


def _ended_early(output: str) -> bool:
    try:
        return json.loads(sidecar(output).read_bytes())["complete"] is False
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False
