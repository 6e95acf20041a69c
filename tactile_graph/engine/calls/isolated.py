"""Steps in processes apart: one that hangs or crashes costs its node, and nothing else.

A process is there before the first frame, of a node alone or of all nodes that share it. It is
given what goes into a step and gives back what comes out, both pickled. Where a step takes longer
than it may its process is killed, where that has ended by itself this is told; in both cases a new
one is started at once, and until that is there its nodes are skipped, so that frames do not wait
for it. The state that its steps kept is gone. Ctrl-C ends it like any step that is at work; the
next frame finds a new one, for which it waits unless state is gone, which a skip tells.
"""

from __future__ import annotations

import pickle
import time
from collections.abc import Mapping
from queue import Empty
from typing import Any, NamedTuple

from tactile_graph.engine.calls.isolated_worker import ENDED, ERROR, MADE, Message
from tactile_graph.engine.calls.process import Process
from tactile_graph.engine.outcomes.outcome import raised_there
from tactile_graph.errors import Skip, TactileGraphError, UsageError
from tactile_graph.pipeline.graph import Node
from tactile_graph.steps.signature import Kind

START_S = 60.0
"""How long a process may take to start: what a step imports may be on a slow disc."""
QUICK_S, AGAIN = 0.1, 10.0
"""A step that cannot be made is tried again at its next call if that was told as quickly, else
after so many times as long: frames do not wait each for a device that is gone."""


class OverrunError(TactileGraphError):
    """A step took longer than it may, and its process was killed."""


class CrashedError(TactileGraphError):
    """The process of a step has ended by itself."""


class Order(NamedTuple):
    """A step that a process is to run, and the node it is for."""

    node: str
    pickled: bytes
    keeps_state: bool


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
    return Isolated(
        host, host.add(Order(node.name, pickled, node.stateful)), isolation.time_limit_s
    )


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
        self._awaited: list[int] = []
        """Numbers of the steps that a new process is making, in the order it tells of them."""
        self._unmade: set[int] = set()
        """Of those that one could not make: they are tried again when they are called."""
        self._in_vain: dict[Order, tuple[float, str]] = {}
        """Of what could not be made: when it is tried again, and why it could not."""
        self._n_restarts = 0
        self.n_lost = 0
        """How many calls came to nothing that the step itself gave or raised."""
        self._ended_by = ""
        self._asking = False
        """Whether a question is under way; where the next one begins: whether it was broken off."""

    @property
    def state(self) -> ProcessState:
        """How it fares; may be asked by another thread than the one that runs steps."""
        starting = self._process.messages.qsize() < len(self._awaited)
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
        self._be_there()
        if self._orders and not self._process.messages.empty():  # nobody has asked it for anything
            self._start_anew(self._process.end_in_words())
            self._be_there()
        self._orders.append(order)
        try:
            self._make(len(self._orders) - 1)
        except BaseException:  # its call asks for it anew
            self._orders.pop()
            raise
        return len(self._orders) - 1

    def run(self, number: int, args: Any, kwargs: Mapping[str, Any], limit_s: float | None) -> Any:
        """Return what a step gives; raises what `Isolated` does."""
        self.n_lost += 1
        self._be_there()
        if number in self._unmade:
            self._make(number)
        question = pickle.dumps((number, args, kwargs))
        try:
            kind, value = self._answer(question, limit_s)
        except Empty:
            self._start_anew(f"took longer than its {limit_s:g} s", number)
            why = f"{self._ended_by}: its process was killed, a new one starts"
            raise raised_there(OverrunError(why), "") from None
        if kind == ENDED:
            self._start_anew(self._process.end_in_words(), number)
            raise raised_there(CrashedError(f"{self._ended_by}: a new one starts"), "")
        self.n_lost -= 1
        if kind == ERROR:
            raise raised_there(*value)
        return value

    def _be_there(self) -> None:
        """See that the process waits for a question; a new one where the last was broken off.

        Raises
        ------
        Skip
            While it is being started anew. One that keeps no state is waited for after Ctrl-C.
        """
        if self._asking:  # the answer may come yet, and would be taken for that of the next frame
            self._start_anew("was interrupted")
            keeps_state = any(order.keeps_state for order in self._orders)
            self._take_note(0.0 if keeps_state else START_S)
        elif self._awaited:
            self._take_note(0.0)

    def _answer(self, question: bytes, seconds: float | None) -> Message:
        """Return the answer to a question; raises Empty where it takes too long."""
        self._asking = True
        try:
            self._process.send_packed(question)
            message = self._process.messages.get(timeout=seconds)
        except Empty:
            raise
        except BaseException:  # Ctrl-C, for one: the step is to stop
            self._process.kill()
            raise
        self._asking = False
        return message

    def _make(self, number: int) -> None:
        """Have a step made, and wait for it; raises UsageError where it cannot be."""
        order, begun = self._orders[number], time.monotonic()
        until, why = self._in_vain.pop(order, (begun, ""))
        if begun < until:
            self._in_vain[order] = until, why
            raise self._cannot_run(order, why)
        try:
            kind, why = self._answer(pickle.dumps((number, order.pickled)), START_S)
        except Empty:
            kind, why = ENDED, f"it did not start within {START_S:g} s"
        else:
            why = self._process.end_in_words() if kind == ENDED else why
        if kind == MADE:
            self._unmade.discard(number)
            return
        now = time.monotonic()
        self._in_vain[order] = now + AGAIN * max(now - begun - QUICK_S, 0.0), why
        self._unmade.add(number)
        if kind == ENDED:
            self._start_anew(why, number)
        raise self._cannot_run(order, why)

    def _cannot_run(self, order: Order, why: str) -> UsageError:
        what = f"the process of {self._name}" if self._name else "its own process"
        return UsageError(f"node {order.node!r}: {what} cannot run the step: {why}")

    def _take_note(self, seconds: float) -> None:
        """Take note of the steps that a new process has made; raises Skip if one is awaited."""
        while self._awaited:
            self._asking = True  # until it is noted what has come: this may be broken off as well
            try:
                kind, _ = self._process.messages.get(seconds > 0.0, seconds or None)
            except Empty:
                self._asking = False
                what = f"the process of {self._name}" if self._name else "its process"
                raise Skip(f"{what} is being started anew: the last {self._ended_by}") from None
            if kind == MADE:
                self._in_vain.pop(self._orders[self._awaited[0]], None)
            else:
                self._unmade.add(self._awaited[0])
            if kind == ENDED:
                self._start_anew(self._process.end_in_words(), self._awaited[0])
            else:
                del self._awaited[0]
            self._asking = False

    def _start_anew(self, why: str, number: int | None = None) -> None:
        """Start another process, which makes all steps that the last one was able to make."""
        self._asking = True
        at = f" at node {self._orders[number].node!r}" if self._name and number is not None else ""
        self._ended_by = why + at
        self._n_restarts += 1
        self._process.kill()
        self._process = Process()
        self._awaited = [n for n in range(len(self._orders)) if n not in self._unmade]
        for n in self._awaited:
            self._process.send((n, self._orders[n].pickled))
        self._asking = False
