"""Processes on this machine that each have a pipe of their own to whoever gives them work.

A process may die at any moment, even while it is saying what its work came to. In the pool of the
standard library processes share one pipe and its lock, so that one which dies over half an answer
leaves everybody waiting for the rest of it. Here nobody else writes to a pipe: it is at its end
when its process is.
"""

from __future__ import annotations

import pickle
import threading
import traceback
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from multiprocessing.connection import Connection
from multiprocessing.context import BaseContext
from multiprocessing.process import BaseProcess
from multiprocessing.util import Finalize
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple, ParamSpec, TypeVar

from tactile_graph.out_of_reach import end_safe_path, safe_path

FIRST_OF_ALL = 100
"""Priority at this process' end: before the other processes are waited for."""
P = ParamSpec("P")
T = TypeVar("T")


class DeadWorkerError(RuntimeError):
    """A process ended before it had said what its work came to."""


class RaisedThereError(RuntimeError):
    """Where in the worker an error was raised: the cause of that error, here."""


class _Call(NamedTuple):
    future: Future[Any]
    function: Callable[..., Any]
    args: tuple[Any, ...]
    kwargs: dict[str, Any]


class _Came(NamedTuple):
    """What a call came to."""

    result: Any = None
    error: BaseException | None = None
    where: str = ""


class WorkerProcesses(Executor):
    """An executor of processes that are started anew when they die.

    A call's future raises `DeadWorkerError` if the process died that was at it; other calls do not
    notice.

    Parameters
    ----------
    n_workers : int
        How many processes, at least 1.
    context : multiprocessing context
        How they are started; not by a plain fork, by which they would hold each other's pipes.
    begin : callable
        ``begin(lifeline, *given)``, a function of a module, is called in each process before its
        first work. The lifeline is at its end when the executor is, or when this process dies.
    given : tuple
    """

    def __init__(
        self,
        n_workers: int,
        context: BaseContext,
        begin: Callable[..., None],
        given: tuple[Any, ...] = (),
    ) -> None:
        lifeline, self._held = context.Pipe(duplex=False)  # workers have no other end of it
        self._close_lifeline = Finalize(None, self._held.close, exitpriority=FIRST_OF_ALL)
        self._calls: SimpleQueue[_Call | None] = SimpleQueue()
        self._ended = False
        self._killed = False
        self._lines = [_Line(context, begin, (lifeline, *given)) for _ in range(n_workers)]
        self._threads = [
            threading.Thread(target=self._serve, args=(line,), daemon=True) for line in self._lines
        ]
        for thread in self._threads:
            thread.start()

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Have a function of a module called in one of the processes.

        Raises
        ------
        RuntimeError
            If the executor has ended.
        """
        if self._ended:
            raise RuntimeError("workers that have ended take no work")
        future: Future[T] = Future()
        self._calls.put(_Call(future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Take no more work; end each process when what was given is done, or cancelled."""
        self._ended = True
        with suppress(Empty):
            while cancel_futures:
                if (call := self._calls.get_nowait()) is not None:
                    call.future.cancel()
        self._calls.put(None)
        if wait:
            for thread in self._threads:
                thread.join()
            self._close_lifeline()

    def kill(self) -> None:
        """End the processes now, whatever they are at; nothing is waited for."""
        self._ended = self._killed = True
        self._close_lifeline()
        for line in self._lines:
            line.kill()
        self.shutdown(wait=False)

    def _serve(self, line: _Line) -> None:
        """Give a process work: the next one before what the last one came to is unpacked."""
        call = self._next()
        if call is not None:
            line.give(call)
        while call is not None:
            answer = line.answer()
            following = self._next(wait=False)
            if following is not None:
                line.give(following)
            _settle(call.future, answer)
            if following is None and (following := self._next()) is not None:
                line.give(following)
            call = following
        line.close()

    def _next(self, wait: bool = True) -> _Call | None:
        """Return a call that nobody cancelled; None at the end, or if there is none to be had."""
        while not self._killed:
            try:
                call = self._calls.get(block=wait)
            except Empty:
                return None
            if call is None:
                self._calls.put(None)  # for whoever asks again
                return None
            if call.future.set_running_or_notify_cancel():
                return call
        return None


class _Line:
    """A process and the pipe to it; another process, when there is work, after one that died."""

    def __init__(
        self, context: BaseContext, begin: Callable[..., None], given: tuple[Any, ...]
    ) -> None:
        self._context = context
        self._begin = begin
        self._given = given
        self._process: BaseProcess | None = None
        self._pipe: Connection | None = None
        self._failed: BaseException | None = None
        self._killed = False

    def give(self, call: _Call) -> None:
        """Send a call; what prevents that is what it comes to."""
        self._failed = None
        try:
            data = pickle.dumps(call[1:], protocol=pickle.HIGHEST_PROTOCOL)
        except Exception as error:  # whatever is asked of somebody else's object
            self._failed = error
            return
        try:
            if self._pipe is None:
                self._pipe = self._started()
            self._pipe.send_bytes(data)
        except Exception as error:  # whatever keeps a process from being started
            self._failed = self._died(error)

    def answer(self) -> bytes | BaseException:
        """Return what the call that was given came to, packed, or why there is no knowing."""
        if self._failed is not None:
            return self._failed
        assert self._pipe is not None  # of what was given
        try:
            return self._pipe.recv_bytes()
        except (OSError, EOFError) as error:
            return self._died(error)

    def close(self) -> None:
        """Have the process end when it has nothing to do."""
        if self._pipe is not None:
            self._pipe.close()
            self._pipe = None

    def kill(self) -> None:
        """End the process at once."""
        self._killed = True
        process = self._process  # which another thread may let go right now
        if process is not None:
            process.kill()

    def _started(self) -> Connection:
        here, there = self._context.Pipe()
        process = self._context.Process(  # type: ignore[attr-defined]  # of every real context
            target=_work, args=(there, self._begin, self._given)
        )
        with safe_path():
            process.start()
        there.close()
        self._process = process
        if self._killed:  # while it was starting
            process.kill()
        return here

    def _died(self, error: Exception) -> DeadWorkerError:
        """Return what is said of a process whose pipe is at its end."""
        from tactile_graph.engine.calls.process import how_ended

        self.close()
        code = None
        if self._process is not None:
            self._process.kill()
            self._process.join()
            code = self._process.exitcode
            self._process = None
        died = DeadWorkerError(f"a worker ended {how_ended(code)}: {error}".removesuffix(": "))
        died.__cause__ = error
        return died


def _settle(future: Future[Any], answer: bytes | BaseException) -> None:
    """Tell a future what its call came to."""
    if isinstance(answer, BaseException):
        future.set_exception(answer)
        return
    try:
        came: _Came = pickle.loads(answer)
    except Exception as error:  # an error or a result that does not unpickle
        future.set_exception(error)
        return
    if came.error is None:
        future.set_result(came.result)
    else:
        came.error.__cause__ = RaisedThereError(f"\n{came.where}")
        future.set_exception(came.error)


# -- in the worker ---------------------------------------------------------------------------------


def _work(pipe: Connection, begin: Callable[..., None], given: tuple[Any, ...]) -> None:
    end_safe_path()
    begin(*given)
    while True:
        try:
            data = pipe.recv_bytes()
        except (EOFError, OSError):
            return
        pipe.send_bytes(_packed(_came(data)))


def _came(data: bytes) -> _Came:
    try:
        function, args, kwargs = pickle.loads(data)
        return _Came(function(*args, **kwargs))
    except BaseException as error:  # told to whoever asked for it
        from tactile_graph.engine.outcomes.outcome import raised_at, raised_there

        told = raised_there(error, raised_at(error))
        return _Came(error=told, where=traceback.format_exc())


def _packed(came: _Came) -> bytes:
    try:
        return pickle.dumps(came, protocol=pickle.HIGHEST_PROTOCOL)
    except Exception as error:  # of the result, or of the error
        return pickle.dumps(_Came(error=TypeError(f"{error}"), where=came.where))
