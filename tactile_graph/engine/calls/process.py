"""``Process``: a process of a module that is sent messages, and what it has said."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import weakref
from queue import Queue
from threading import Thread
from typing import IO, Any

from tactile_graph.engine.calls.isolated_worker import ENDED, ERROR, Message, received, written
from tactile_graph.out_of_reach import out_of_reach


class Process:
    """A process of a module that takes messages and gives some, and what it has said.

    Parameters
    ----------
    module : str
        What runs in it; the first message it takes is ``sys.path``.
    """

    def __init__(self, module: str = "tactile_graph.engine.calls.isolated_worker") -> None:
        command = [sys.executable, "-P", "-m", module]
        with out_of_reach():
            self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._stdin: IO[bytes] = self._process.stdin
        self.messages: Queue[Message] = Queue()
        args = (self._process.stdout, self.messages)
        Thread(target=_listen, args=args, name="isolated step", daemon=True).start()
        self.kill = weakref.finalize(self, _ended, self._process)
        self.send(sys.path)

    def send(self, message: Any) -> None:
        """Send something; where nobody is there any more, `messages` says so."""
        self.send_packed(pickle.dumps(message))

    def send_packed(self, data: bytes) -> None:
        """Send what is pickled already."""
        try:
            written(self._stdin, data)
        except OSError:
            return

    def end_in_words(self) -> str:
        """Return how it ended."""
        return f"ended its process {how_ended(self._process.wait())}"


def how_ended(code: int | None) -> str:
    """Return how a process ended, by the code that it left: ``by SIGKILL``, ``with code 3``."""
    if code is None or code >= 0:
        return f"with code {code}"
    try:
        return f"by {signal.Signals(-code).name}"
    except ValueError:  # most real-time signals have no name
        return f"by signal {-code}"


def _listen(stdout: IO[bytes], messages: Queue[Message]) -> None:
    with stdout:
        while True:
            try:
                messages.put(received(stdout))
            except EOFError:
                messages.put((ENDED, None))
                return
            except Exception as error:  # what it gave cannot be read here
                messages.put((ERROR, (error, "")))


def _ended(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
    if process.stdin is not None:
        try:
            process.stdin.close()
        except OSError:
            return
