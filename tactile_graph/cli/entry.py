"""Where the command begins; all else is imported within reach of Ctrl-C."""

from __future__ import annotations

import gc
import io
import os
import sys
from typing import Any

NEW_OBJECTS = 100_000
"""Until garbage is searched for among them: imports make as many that stay."""
WAIT_S = 2.0
"""Until it is said for whom the process waits at its end."""


def main() -> None:
    """Run the command line and exit."""
    _open_streams()
    _stand_in_a_folder()
    gc.set_threshold(NEW_OBJECTS, *gc.get_threshold()[1:])
    try:
        from tactile_graph.cli.early import begin_workers

        begin_workers(sys.argv[1:])
        from tactile_graph.cli.app import cli
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        sys.exit(130)
    try:
        cli.main()
    except KeyboardInterrupt:  # another one, after what was to be said was said
        sys.exit(130)
    finally:
        _end_at_once()
        _tell_who_goes_on()


def _end_at_once() -> None:
    """From here on Ctrl-C ends this process without a word, while Python shuts down."""
    import signal

    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def _tell_who_goes_on() -> None:
    """Say after a while which threads Python waits for before it ends; those of plugins, mostly."""
    import threading

    def going_on() -> list[str]:
        others = (t for t in threading.enumerate() if t is not threading.main_thread())
        return [t.name for t in others if not t.daemon]

    def tell() -> None:
        if names := ", ".join(going_on()):
            sys.stderr.write(f"waiting for threads that go on: {names}; Ctrl-C ends them\n")

    if going_on():
        timer = threading.Timer(WAIT_S, tell)
        timer.daemon = True
        timer.start()


def _open_streams() -> None:
    """Refuse a standard output that is closed; a standard error that is goes nowhere.

    The next file opened would take the number of one that is closed, and what libraries print with
    it; processes that share work take those numbers for themselves.
    """
    for number in (0, 1, 2):
        try:
            os.fstat(number)
        except OSError:
            os.set_inheritable(os.open(os.devnull, os.O_RDWR), True)  # gets the lowest: this one
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 -- until the end
    elif isinstance(_raw_of(sys.stderr), io.FileIO):
        sys.stderr = io.TextIOWrapper(
            io.BufferedWriter(_Patient(sys.stderr.fileno(), "w", closefd=False)),
            sys.stderr.encoding, sys.stderr.errors, line_buffering=True,
        )  # fmt: skip
    if sys.stdout is None:
        sys.stderr.write("error: standard output is closed (>&-); send it to /dev/null instead\n")
        sys.exit(2)


def _raw_of(stream: Any) -> object:
    """Return what a stream writes to in the end, without a buffer (``-u``) or with one."""
    buffer = getattr(stream, "buffer", None)
    return getattr(buffer, "raw", buffer)


class _Patient(io.FileIO):
    """A standard error that lets go what it cannot write: its disc is full, its reader gone.

    What a command says is not what it does: its exit code stays what it is.
    """

    def write(self, data: Any) -> int:
        try:
            return super().write(data)
        except OSError:
            return memoryview(data).nbytes


def _stand_in_a_folder() -> None:
    """Refuse to begin where the current folder was deleted: nothing is found from there.

    What libraries do there fails in many places, the processes that share work among them, and
    none says why.
    """
    try:
        os.getcwd()
    except FileNotFoundError:
        sys.stderr.write(
            "error: the current folder is gone: it was deleted, or made anew under the same name; "
            "change into one that is there (cd)\n"
        )
        sys.exit(2)
