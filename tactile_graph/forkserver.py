"""What workers are forked from, begun out of Ctrl-C's reach."""

from __future__ import annotations

import signal
from collections.abc import Sequence

FORKED = "tactile_graph.many.forked"


def begin_forkserver(preloaded: Sequence[str] = ()) -> None:
    """Begin the process that workers are forked from, unless it runs already.

    A terminal sends Ctrl-C to it too. It imports for a second or two before it would ignore that,
    and ends in a traceback. So the signal is blocked while it is begun: it is for this process,
    which gets it right after.

    Parameters
    ----------
    preloaded : sequence of str
        Modules that it imports beside what workers need.
    """
    from multiprocessing import resource_tracker
    from multiprocessing.forkserver import ensure_running, set_forkserver_preload

    set_forkserver_preload([FORKED, *preloaded])
    resource_tracker.ensure_running()  # or it would be begun below, and unblock the signal
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        ensure_running()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
