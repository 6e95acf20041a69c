"""Steps in processes of their own: one that hangs or crashes costs its node, and nothing else.

The process is there before the first frame. It is given what goes into the step and gives back
what comes out, both pickled. Where it takes longer than it may it is killed, where it has ended by
itself that is told; in both cases a new one is started at once, and until that is there the node is
skipped, so that frames do not wait for it. A state the step kept is gone.
"""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import weakref
from collections.abc import Callable, Mapping
from queue import Empty, Queue
from threading import Thread
from typing import IO, Any

from tactile_graph.engine.isolated_worker import ENDED, READY, Message, received, sent
from tactile_graph.errors import Skip, TactileGraphError, UsageError
from tactile_graph.pipeline.graph import Isolation, Node
from tactile_graph.steps.signature import Kind

START_S = 60.0
"""How long a process may take to start: what a step imports may be on a slow disc."""


class OverrunError(TactileGraphError):
    """A step took longer than it may, and its process was killed."""


class CrashedError(TactileGraphError):
    """The process of a step has ended by itself."""


def isolated_step(node: Node, injected: Mapping[str, Any]) -> Callable[..., Any]:
    """Return what runs a node's step in a process of its own.

    Parameters
    ----------
    node : Node
    injected : mapping
        What its constructor is handed beside its settings.

    Raises
    ------
    UsageError
        If the step or its settings cannot be sent to another process, or do not arrive there.
    """
    signature, isolation = node.signature, node.isolation
    assert signature is not None
    assert isolation is not None
    settings = {**signature.arguments(node.settings), **injected}
    try:
        order = pickle.dumps((signature.target, settings, signature.kind is Kind.CLASS))
    except Exception as error:  # whatever pickle cannot take
        raise UsageError(
            f"node {node.name!r}: step {signature.name!r} cannot run in a process of its own: "
            f"{error}"
        ) from error
    return Isolated(node.name, order, isolation)


class Isolated:
    """Call it with what goes into the step.

    Parameters
    ----------
    name : str
        Of the node, for messages.
    order : bytes
        What the process is to run.
    isolation : Isolation
    """

    def __init__(self, name: str, order: bytes, isolation: Isolation) -> None:
        self._name, self._order, self._limit_s = name, order, isolation.time_limit_s
        self._why = ""
        self._process = _Process(order)
        self._ready = False
        self._await(START_S)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Return what the step gives.

        Raises
        ------
        OverrunError, CrashedError
            If it takes too long, or its process ends.
        Skip
            While a new process starts.
        Exception
            Whatever the step raises.
        """
        if not self._ready:
            self._await(0.0)
        self._process.send((args, kwargs))
        try:
            kind, value = self._process.messages.get(timeout=self._limit_s)
        except Empty:
            self._anew(f"took longer than its {self._limit_s:g} s")
            raise OverrunError(f"{self._why}: its process was killed, a new one starts") from None
        if kind == ENDED:
            self._anew(self._process.end_in_words())
            raise CrashedError(f"{self._why}: a new one starts")
        if isinstance(value, Exception) and kind != READY:
            raise value
        return value

    def _await(self, seconds: float) -> None:
        """Take note that the process is there.

        Raises
        ------
        Skip
            If it is not, and that is no wonder.
        UsageError
            If it cannot run the step.
        """
        try:
            kind, value = self._process.messages.get(timeout=seconds) if seconds else (
                self._process.messages.get_nowait()
            )  # fmt: skip
        except Empty:
            raise Skip(f"its process is being started anew: the last {self._why}") from None
        if kind != READY:
            told = value if kind != ENDED else self._process.end_in_words()
            self._process.messages.put((kind, value))  # it stays so
            raise UsageError(f"node {self._name!r}: its own process cannot run the step: {told}")
        self._ready = True

    def _anew(self, why: str) -> None:
        self._why, self._ready = why, False
        self._process.kill()
        self._process = _Process(self._order)


class _Process:
    """A process, and what it has said."""

    def __init__(self, order: bytes) -> None:
        command = [sys.executable, "-m", "tactile_graph.engine.isolated_worker"]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._stdin: IO[bytes] = self._process.stdin
        self.messages: Queue[Message] = Queue()
        args = (self._process.stdout, self.messages)
        Thread(target=_listen, args=args, name="isolated step", daemon=True).start()
        self.kill = weakref.finalize(self, _ended, self._process)
        self.send(sys.path)
        self.send(order)

    def send(self, message: Any) -> None:
        """Send something; where nobody is there any more, `messages` says so."""
        try:
            sent(self._stdin, message)
        except OSError:
            return

    def end_in_words(self) -> str:
        """Return how it ended."""
        code = self._process.wait()
        if code < 0:
            return f"ended its process by {signal.Signals(-code).name}"
        return f"ended its process with code {code}"


def _listen(stdout: IO[bytes], messages: Queue[Message]) -> None:
    with stdout:
        while True:
            try:
                messages.put(received(stdout))
            except EOFError:
                messages.put((ENDED, None))
                return
            except Exception as error:  # what it gave cannot be read here
                messages.put(("error", error))


def _ended(process: subprocess.Popen[bytes]) -> None:
    process.kill()
    process.wait()
    if process.stdin is not None:
        try:
            process.stdin.close()
        except OSError:
            return
