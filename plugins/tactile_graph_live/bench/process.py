"""The bench's process: made ready for time, ended with the server."""

from __future__ import annotations

import os
import signal
import sys
import threading
from multiprocessing.connection import Connection

from tactile_graph.compiled import warm_up
from tactile_graph.errors import TactileGraphError
from tactile_graph.out_of_reach import end_safe_path
from tactile_graph.plugins.registry import restrict
from tactile_graph_live.bench import wire
from tactile_graph_live.bench.bench import Bench
from tactile_graph_live.bench.outbox import Outbox
from tactile_graph_live.bench.settled import Settled

ENDS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""Signals that end a program, sent to all of its processes by terminals and service managers."""
SWITCH_S = 0.0005
"""Between threads: a frame's reader must not wait 5 ms for a step's loop."""
TICK_S = 0.25


def main(pipe: Connection, order: wire.Order) -> None:
    """Run a bench until the server says so, or is gone."""
    end_safe_path()
    for number in ENDS:  # they are the server's, which tells us, and may want the last frames
        signal.signal(number, signal.SIG_IGN)
    if sys.stderr is not None:
        os.dup2(2, 1)  # stdout may be kept for programs
    restrict(order.selection)
    warm_up()
    sys.setswitchinterval(SWITCH_S)
    outbox = Outbox(pipe.send)
    try:
        bench = Bench(order, outbox, Settled())
    except TactileGraphError as error:  # a process of a step that cannot be started, say
        outbox.note(wire.Ended(str(error), 0))
        outbox.end()
        return
    threading.Thread(target=_listen, args=(pipe, bench), daemon=True).start()
    threading.Thread(target=_tick, args=(bench,), daemon=True).start()
    bench.run()
    outbox.end()


def _listen(pipe: Connection, bench: Bench) -> None:
    while True:
        try:
            message = pipe.recv()
        except (EOFError, OSError):
            os._exit(0)  # the server is gone
        bench.told(message)


def _tick(bench: Bench) -> None:
    event = threading.Event()
    while not event.wait(TICK_S):
        bench.tick()
