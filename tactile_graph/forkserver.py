"""What workers are forked from, begun out of Ctrl-C's reach."""

from __future__ import annotations

from collections.abc import Sequence

from tactile_graph.out_of_reach import out_of_reach, safe_path

FORKED = "tactile_graph.many.forked"


def begin_forkserver(preloaded: Sequence[str] = ()) -> None:
    """Begin the process that workers are forked from, unless it runs already.

    It imports for a second or two before it would ignore Ctrl-C.

    Parameters
    ----------
    preloaded : sequence of str
        Modules that it imports beside what workers need.
    """
    from multiprocessing import resource_tracker
    from multiprocessing.forkserver import ensure_running, set_forkserver_preload

    set_forkserver_preload([FORKED, *preloaded])
    with safe_path():
        resource_tracker.ensure_running()  # or it would be begun below, and unblock the signal
        with out_of_reach():
            ensure_running()
