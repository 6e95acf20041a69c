"""What frames of several recordings are labelled with."""

from __future__ import annotations

from pathlib import Path


def labels_of(paths: list[Path]) -> list[str]:
    """Return what frames of several files are labelled with: names, with folders if names recur."""
    names = [path.name for path in paths]
    longest = max(len(path.parts) for path in paths)
    for n_parts in range(2, longest + 1):
        if len({*names}) == len({*paths}):
            break
        names = ["/".join(path.parts[-n_parts:]) for path in paths]
    return names
