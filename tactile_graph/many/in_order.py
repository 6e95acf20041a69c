"""Portions of frames done by workers, what they come to in order, whatever becomes of a worker.

No more portions are under way than the workers can use, so that memory stays flat however far the
frames come ahead of what is written. What a worker had when it died is done again. A frame at which
workers die each time is found by halving, told, and left out.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Future
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from tactile_graph.errors import DataError
from tactile_graph.foreign_text import tell
from tactile_graph.many.executor_kind import Opened, Place
from tactile_graph.many.portion import Portion

AHEAD = 2
"""Portions under way for each worker: one that it does, and one that waits for it."""
TOLERATED = 2
"""Deaths with a portion under way before it is done with no other beside it."""
DEADLY = 2
"""Deaths over the same frames, alone, by which these are to blame."""
MOST_IN_A_ROW = 8
"""Frames one after the other that kill, each alone, after which no more are tried: it is no frame
that is to blame then."""
ISOLATED = "A step that is 'isolated: true' is named by its node, and costs that alone"
BROKE = (BrokenExecutor, OSError, EOFError)
"""What an executor raises that is given work and cannot have it done any more."""
PATIENCE_S = 5.0
"""How long to wait for a portion before the executor is asked whether it still takes work: a
process pool of Python 3.11 that breaks while it is given work may forget that without a word."""
Done = TypeVar("Done")


@dataclass
class _Under:
    """A portion under way."""

    portion: Portion
    future: Future[Any]
    n_deaths: int = 0


class InOrder(Generic[Done]):
    """An executor at work on portions.

    Parameters
    ----------
    place : Place
        Where; it is opened when the first portion comes.
    work : callable
        A function of a module, called by workers with ``given`` and a portion.
    given : bytes
        What is the same for all of them.
    left_out : callable
        Told the place of each frame that is left out because workers died of it.
    without : iterable of int
        Places of frames that are known to be left out.
    ahead : int
        Portions under way for each worker.
    """

    def __init__(
        self,
        place: Place,
        work: Callable[[bytes, Portion], Done],
        given: bytes,
        left_out: Callable[[int], None],
        without: Iterable[int] = (),
        ahead: int = AHEAD,
    ) -> None:
        self._place = place
        self._work = work
        self._given = given
        self._tell = left_out
        self._ahead = ahead
        self._opened: Opened | None = None
        self._under: deque[_Under] = deque()
        self._without = frozenset(without)
        self._why = ""
        self._row: list[int] = []
        self.n_deaths = 0
        """How often a worker died."""

    @property
    def n_workers(self) -> int:
        """How many portions are done at the same time."""
        return self._at_work().n_workers

    def __enter__(self) -> InOrder[Done]:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()

    def results(self, portions: Iterator[Portion]) -> Iterator[tuple[Portion, Done]]:
        """Yield each portion and what it came to, in order; errors of the work are raised.

        A portion is taken only when there is room for it: when what an earlier one came to was
        taken.
        """
        more = True
        while more or self._under:
            while more and len(self._under) < self._ahead * self.n_workers + 1:
                portion = next(portions, None)
                more = portion is not None
                if portion is not None:
                    self._under.append(self._submitted(portion))
            if self._under:
                done = self._first_done()
                yield self._under.popleft().portion, done

    def drop(self) -> None:
        """Forget the portions under way: others are to come in their place."""
        self._under.clear()
        self._end()

    # -- what becomes of a portion -------------------------------------------------------------

    def _at_work(self) -> Opened:
        if self._opened is None:
            self._opened = self._place.opened()
        return self._opened

    def _end(self) -> None:
        """End the executor and whatever it is at; another is opened when there is more to do.

        Nothing that it was given is cancelled one by one: a process pool of Python 3.11 in which
        a worker dies right after that never says what became of the rest.
        """
        if self._opened is not None:
            self._opened.end()
            self._opened = None

    def _submitted(self, portion: Portion, n_deaths: int = 0) -> _Under:
        portion = portion.leaving_out(self._without)
        try:
            future = self._at_work().executor.submit(self._work, self._given, portion)
        except BROKE as error:  # since, which the portions under way do not know
            future = Future()
            future.set_exception(BrokenExecutor(str(error)))
        return _Under(portion, future, n_deaths)

    def _first_done(self) -> Done:
        """Return what the first portion under way came to, done again for as long as it takes."""
        first = self._under[0]
        while True:
            try:
                return self._waited(first.future)
            except self._deaths as death:
                self._mend(death)
            if first.n_deaths >= TOLERATED:
                return self._alone(first)
            first = self._under[0]

    @property
    def _deaths(self) -> tuple[type[BaseException], ...]:
        """What tells that a worker died, or that the executor is of no use any more."""
        return (*self._at_work().died, BrokenExecutor)

    def _waited(self, future: Future[Done]) -> Done:
        """Return what a portion came to; who waits long asks now and then whether work is taken.

        Raises
        ------
        BrokenExecutor
            If the executor takes no work any more and says nothing of what it was given, or has
            cancelled it.
        """
        told = False
        while True:
            try:
                return future.result(timeout=PATIENCE_S)
            except CancelledError as error:  # not by us: whoever handed out its work is gone
                raise BrokenExecutor("what was under way was cancelled") from error
            except TimeoutError:
                if future.done():  # an error of the work, or what came right now
                    return future.result()
            try:
                self._at_work().executor.submit(int)
                alone = self._is_without_workers()
            except BROKE as error:
                raise BrokenExecutor(str(error)) from error
            if alone and not told:
                tell(f"{self._place.kind.called}: there is no worker; waiting for one")
            told = alone

    def _is_without_workers(self) -> bool:
        """Return whether an executor whose workers come and go has none."""
        n_there = self._at_work().n_there
        return n_there is not None and n_there() == 0

    def _mend(self, death: BaseException) -> None:
        """Open another executor where this one broke, and submit again what was lost with it."""
        self.n_deaths += 1
        opened = self._at_work()
        broken = isinstance(death, BrokenExecutor)
        if broken:
            self._end()
        for under in self._under:
            if (broken and not _has_result(under.future)) or _died(under.future, opened.died):
                again = self._submitted(under.portion, under.n_deaths + 1)
                under.portion, under.future = again.portion, again.future
                under.n_deaths = again.n_deaths

    # -- which frame is to blame ---------------------------------------------------------------

    def _alone(self, under: _Under) -> Done:
        """Return what a portion comes to with no other beside it, so that nobody else can die."""
        self._end()
        result = self._blameless(under)
        for other in list(self._under)[1:]:
            if not _has_result(other.future):
                again = self._submitted(other.portion)
                other.portion, other.future, other.n_deaths = again.portion, again.future, 0
        return result

    def _blameless(self, under: _Under) -> Done:
        portion = under.portion
        n_vain = 0
        while True:
            for _ in range(DEADLY):
                lived, result = self._tried(portion)
                if lived and result is not None:
                    under.portion = portion
                    return result
            place = self._deadly_place(portion)
            n_vain += place is None
            if place in self._without or n_vain >= MOST_IN_A_ROW:
                raise DataError(
                    "workers",
                    f"they die after some frames, whichever these are, {self._why}; no more are "
                    f"tried. {ISOLATED}",
                )
            if place is not None:
                self._without |= {place}
                self._tell(place)
                self._look_at_row(place)
                portion = portion.leaving_out(self._without)

    def _look_at_row(self, place: int) -> None:
        """Note a frame that kills; raise DataError after `MOST_IN_A_ROW` without one between."""
        self._row = [*self._row, place] if place - 1 in self._row[-1:] else [place]
        if len(self._row) >= MOST_IN_A_ROW:
            raise DataError(
                f"frames {self._row[0]} to {place}",
                f"each ended its worker, the last time {self._why}; no more are tried. {ISOLATED}",
            )

    def _deadly_place(self, portion: Portion) -> int | None:
        """Return the frame without which the frames before it kill nobody; None if none does.

        The fewest first frames that kill are found by halving; the last of them is to blame.

        Raises
        ------
        DataError
            If workers die without any frame.
        """
        if not any(self._tried(portion.first(0))[0] for _ in range(DEADLY)):
            raise DataError("workers", f"they die before their first frame, {self._why}")
        lives, kills = 0, portion.n_frames
        while kills - lives > 1:
            half = (lives + kills) // 2
            if self._tried(portion.first(half))[0]:
                lives = half
            else:
                kills = half
        again = self._tried(portion.first(kills))[0]  # or somebody else killed it in the meantime
        return None if again else portion.low + kills - 1

    def _tried(self, portion: Portion) -> tuple[bool, Done | None]:
        """Return whether a worker lives through a portion, and what it came to."""
        while True:
            try:
                under = self._submitted(portion)
                return True, self._waited(under.future)
            except self._deaths as death:
                self.n_deaths += 1
                self._why = str(death)
                if isinstance(death, BrokenExecutor):
                    self._end()
                return False, None


def _has_result(future: Future[Any]) -> bool:
    return future.done() and not future.cancelled() and future.exception() is None


def _died(future: Future[Any], died: tuple[type[BaseException], ...]) -> bool:
    return future.done() and not future.cancelled() and isinstance(future.exception(), died)
