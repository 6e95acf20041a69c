"""What workers are forked from, begun before this process has imported anything itself."""

from __future__ import annotations

from collections.abc import Sequence

STORES = {".zarr": "zarr"}
"""Which library reads recordings of an ending, where it takes long to import."""


def asks_for_workers(words: Sequence[str]) -> bool:
    """Return whether a command line asks for workers on this machine."""
    options = {word.partition("=")[0] for word in words}
    return "--workers" in options and "--on" not in options


def begin_workers(words: Sequence[str]) -> None:
    """Begin to get ready what workers are forked from, if a command line asks for any."""
    if not asks_for_workers(words):
        return
    import multiprocessing

    if "forkserver" not in multiprocessing.get_all_start_methods():
        return
    from tactile_graph.forkserver import begin_forkserver

    ends = (word.rstrip("/") for word in words)
    needed = {library for end in ends for e, library in STORES.items() if end.endswith(e)}
    begin_forkserver(sorted(needed))
