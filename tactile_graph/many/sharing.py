"""``Sharing``: any work over frames, or over numbered tasks, shared among workers.

What is made once in each worker is then called with one portion after the other. What portions
come to comes in order, so that whoever joins it gets what one process would have given.
"""

from __future__ import annotations

import pickle
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from tactile_graph.errors import DataError, TactileGraphError
from tactile_graph.many.executor_kind import Place
from tactile_graph.many.in_order import AHEAD, InOrder
from tactile_graph.many.portion import Portion
from tactile_graph.many.sent import PortionSize, sent
from tactile_graph.steps.ranges import Irregular
from tactile_graph.wires.frame import Frame

if TYPE_CHECKING:
    from tactile_graph.many.feed import Feed

KILLER = "workers died of it each time: left out"
MOST_KEPT = 2
"""What a worker keeps ready of what it was given."""
T = TypeVar("T")
Work = Callable[[Portion], T]


class Sharing(Generic[T]):
    """Workers that share some work; a context in which they live.

    Parameters
    ----------
    place : Place
        Where they are.
    make : callable
        A class or function of a module: ``make(argument)`` is called once in each worker and
        returns what is called with portions there.
    argument : object
        Can be pickled.
    ahead : int
        Portions under way for each worker: more where they differ much in length.

    Attributes
    ----------
    left_out : list of int
        Places of frames, or numbers of tasks, of which workers died each time.
    """

    def __init__(
        self, place: Place, make: Callable[[Any], Work[T]], argument: Any, ahead: int = AHEAD
    ) -> None:
        self.left_out: list[int] = []
        given = pickle.dumps((make, argument))
        self._in_order: InOrder[_Came] = InOrder(
            place, _done, given, self.left_out.append, ahead=ahead
        )

    def __enter__(self) -> Sharing[T]:
        return self

    def __exit__(self, *error: object) -> None:
        self._in_order.__exit__(*error)

    def over_frames(self, frames: Iterator[Frame], n_before: int = 0) -> Iterator[T]:
        """Yield what each portion of the frames came to.

        Parameters
        ----------
        frames : iterator of Frame
        n_before : int
            How many frames before its own each portion brings along.

        Raises
        ------
        Exception
            Whatever the work or the frames raise, when all before it was yielded.
        """
        size, watched = PortionSize(), _Watched(frames)
        for _, came in self._portions(sent(watched, 0, size, n_before), size):
            yield came
        if watched.error is not None:
            raise watched.error

    def over_feed(self, feed: Feed) -> Iterator[T]:
        """Yield what each portion of a feed came to that workers read themselves.

        Raises
        ------
        Irregular
            If they cannot: everything is to be done again, by one process.
        Exception
            Whatever the work raises, when all before it was yielded.
        """
        done = feed.start
        try:
            portions = feed.portions(feed.start, self._in_order.n_workers)
            for portion, came in self._portions(portions, feed.size):
                done = portion.high
                yield came
        except Irregular as why:
            feed.send(str(why))
            raise
        finally:
            feed.end(done)

    def _portions(
        self, portions: Iterator[Portion], size: PortionSize
    ) -> Iterator[tuple[Portion, T]]:
        for portion, came in self._in_order.results(portions):
            size.took(portion.n_frames, came.seconds)
            yield portion, came.value()

    def over_tasks(self, n: int) -> Iterator[T]:
        """Yield what each of ``n`` tasks came to; a task's number is its portion's place."""
        portions = (Portion(k, k + 1) for k in range(n))
        for _, came in self._in_order.results(portions):
            yield came.value()


class _Watched:
    """Frames up to an error, which is kept: it is told when those before it are done."""

    def __init__(self, frames: Iterator[Frame]) -> None:
        self._frames = frames
        self.error: Exception | None = None

    def __iter__(self) -> Iterator[Frame]:
        return self

    def __next__(self) -> Frame:
        if self.error is None:
            try:
                return next(self._frames)
            except StopIteration:
                raise
            except Exception as error:
                self.error = error
        raise StopIteration


# -- in the workers ----------------------------------------------------------------------------


class _Came(NamedTuple):
    """What a portion came to, the error that ended it if one did, and how long it took."""

    what: Any
    error: Exception | None
    seconds: float

    def value(self) -> Any:
        if self.error is not None:
            raise self.error
        return self.what


_ready = threading.local()
"""What was made ready, of each thread: a runner serves one."""


def ready(given: bytes) -> Any:
    """Return what is made of a pickled ``(make, argument)``, once in each worker."""
    kept: OrderedDict[bytes, Any] = _ready.__dict__.setdefault("kept", OrderedDict())
    if given not in kept:
        make, argument = pickle.loads(given)
        kept[given] = make(argument)
        while len(kept) > MOST_KEPT:
            kept.popitem(last=False)
    return kept[given]


def _done(given: bytes, portion: Portion) -> _Came:
    what, error = None, None
    begun = time.perf_counter()
    try:
        work = ready(given)
        begun = time.perf_counter()
        what = work(portion)
    except Exception as raised:
        error = for_the_way(raised)
    return _Came(what, error, time.perf_counter() - begun)


def for_the_way(error: Exception) -> Exception:
    """Return an error as it can be sent to another process."""
    try:
        pickle.loads(pickle.dumps(error))
    except Exception:
        if isinstance(error, TactileGraphError):
            return TactileGraphError(str(error))
        return DataError("a worker", f"{type(error).__name__}: {error}")
    return error
