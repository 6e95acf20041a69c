"""Steps in processes apart: one that hangs or crashes costs its node, and nothing else.

A process is there before the first frame, of a node alone or of all nodes that share it. It is
given what goes into a step and gives back what comes out, both pickled. Where a step takes longer
than it may its process is killed, where that has ended by itself this is told; in both cases a new
one is started at once, and until that is there its nodes are skipped, so that frames do not wait
for it. The state that its steps kept is gone.
"""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import weakref
from collections.abc import Mapping
from queue import Empty, Queue
from threading import Thread
from typing import IO, Any, NamedTuple

from tactile_graph.engine.calls.isolated_worker import (
    ENDED,
    ERROR,
    MADE,
    Message,
    received,
    sent,
)
from tactile_graph.engine.outcomes.outcome import raised_there
from tactile_graph.errors import Skip, TactileGraphError, UsageError
from tactile_graph.out_of_reach import out_of_reach
from tactile_graph.pipeline.graph import Node
from tactile_graph.steps.signature import Kind

START_S = 60.0
"""How long a process may take to start: what a step imports may be on a slow disc."""


class OverrunError(TactileGraphError):
    """A step took longer than it may, and its process was killed."""


class CrashedError(TactileGraphError):
    """The process of a step has ended by itself."""


class Order(NamedTuple):
    """A step that a process is to run, and the node it is for."""

    node: str
    pickled: bytes


def isolated_step(node: Node, injected: Mapping[str, Any], hosts: dict[str, Host]) -> Isolated:
    """Return what runs a node's step in another process.

    Parameters
    ----------
    node : Node
    injected : mapping
        What its constructor is handed beside its settings.
    hosts : dict
        The processes that nodes share, by name; one that is not there yet is added.

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
        pickled = pickle.dumps((signature.target, settings, signature.kind is Kind.CLASS))
    except Exception as error:  # whatever pickle cannot take
        raise UsageError(
            f"node {node.name!r}: step {signature.name!r} cannot run in a process of its own: "
            f"{error}"
        ) from error
    name = isolation.process
    host = hosts.get(name) or Host(name)
    if name:
        hosts[name] = host
    return Isolated(host, host.add(Order(node.name, pickled)), isolation.time_limit_s)


class ProcessState(NamedTuple):
    """How the process of a step that runs apart fares.

    Attributes
    ----------
    name : str
        Under which several nodes share it; empty for that of one node.
    n_restarts : int
        How often it was started anew.
    starting : bool
        Whether it is being started just now; its nodes are skipped meanwhile.
    why : str
        What ended the last one; empty if none has ended.
    """

    name: str
    n_restarts: int
    starting: bool
    why: str


class Isolated:
    """Call it with what goes into the step.

    Parameters
    ----------
    host : Host
    number : int
        Of the step there.
    limit_s : float or None
        How long a call may take.
    """

    def __init__(self, host: Host, number: int, limit_s: float | None) -> None:
        self.host = host
        self._number, self._limit_s = number, limit_s

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
        return self.host.run(self._number, args, kwargs, self._limit_s)


class Host:
    """A process that runs steps one at a time, and is started anew when it has ended.

    Parameters
    ----------
    name : str
        Which of several nodes' processes it is; empty for that of one node.
    """

    def __init__(self, name: str = "") -> None:
        self._name = name
        self._orders: list[Order] = []
        self._process = Process()
        self._n_made = self._n_restarts = 0
        self.n_lost = 0
        """How many calls came to nothing that the step itself gave or raised."""
        self._ended_by = self._broken = ""

    @property
    def state(self) -> ProcessState:
        """How it fares; may be asked by another thread than the one that runs steps."""
        n_known = self._n_made + self._process.messages.qsize()
        starting = n_known < len(self._orders) and not self._broken
        return ProcessState(self._name, self._n_restarts, starting, self._ended_by)

    def add(self, order: Order) -> int:
        """Have a step made, and return its number.

        Raises
        ------
        UsageError
            If the process cannot run it, or does not start.
        Skip
            While it is being started anew: frames of a new label wait no more than others.
        """
        if self._orders:
            self._be_there()
        self._orders.append(order)
        self._process.send(order.pickled)
        self._take_note(START_S)
        return len(self._orders) - 1

    def _be_there(self) -> None:
        """Raise Skip where the process is being started anew; start it if it has ended since."""
        if self._n_made < len(self._orders):
            self._take_note(0.0)
        elif not self._process.messages.empty():  # nobody has asked it for anything
            self._start_anew(0, self._process.end_in_words())
            self._take_note(0.0)

    def run(self, number: int, args: Any, kwargs: Mapping[str, Any], limit_s: float | None) -> Any:
        """Return what a step gives; raises what `Isolated` does."""
        self.n_lost += 1
        if self._n_made < len(self._orders):
            self._take_note(0.0)
        self._process.send((number, args, kwargs))
        try:
            kind, value = self._process.messages.get(timeout=limit_s)
        except Empty:
            self._start_anew(number, f"took longer than its {limit_s:g} s")
            why = f"{self._ended_by}: its process was killed, a new one starts"
            raise raised_there(OverrunError(why), "") from None
        if kind == ENDED:
            self._start_anew(number, self._process.end_in_words())
            raise raised_there(CrashedError(f"{self._ended_by}: a new one starts"), "")
        self.n_lost -= 1
        if kind == ERROR:
            raise raised_there(*value)
        return value

    def _take_note(self, seconds: float) -> None:
        """Take note of the steps that are made.

        Raises
        ------
        Skip
            If one is not, and that is no wonder.
        UsageError
            If the process cannot run it.
        """
        messages = self._process.messages
        while self._n_made < len(self._orders) and not self._broken:
            try:
                kind, value = messages.get(timeout=seconds) if seconds else messages.get_nowait()
            except Empty:
                if seconds:
                    self._broken = f"it did not start within {seconds:g} s"
                    break
                what = f"the process of {self._name}" if self._name else "its process"
                raise Skip(f"{what} is being started anew: the last {self._ended_by}") from None
            if kind == MADE:
                self._n_made += 1
            else:
                self._broken = value if kind != ENDED else self._process.end_in_words()
        if self._broken:
            node = self._orders[self._n_made].node
            what = f"the process of {self._name}" if self._name else "its own process"
            raise UsageError(f"node {node!r}: {what} cannot run the step: {self._broken}")

    def _start_anew(self, number: int, why: str) -> None:
        self._ended_by = f"{why} at node {self._orders[number].node!r}" if self._name else why
        self._n_made = 0
        self._n_restarts += 1
        self._process.kill()
        self._process = Process()
        for order in self._orders:
            self._process.send(order.pickled)


class Process:
    """A process of a module that takes messages and gives some, and what it has said.

    Parameters
    ----------
    module : str
        What runs in it; the first message it takes is ``sys.path``.
    """

    def __init__(self, module: str = "tactile_graph.engine.calls.isolated_worker") -> None:
        command = [sys.executable, "-m", module]
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
        try:
            sent(self._stdin, message)
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
