"""Steps that another process can import, some of which hang or crash."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import numpy as np

from tactile_graph import Degenerate, Image, Skip
from tactile_graph.steps import TimeGap

HANGS, CRASHES, FAILS, PRINTS = 1, 2, 3, 4


def moody(image: Image, *, plus: int = 0) -> int:
    """Return the process' number of calls' worth of the image, or hang, crash, or fail."""
    number = int(image.values[0, 0])
    if number == HANGS:
        time.sleep(600)
    if number == CRASHES:
        os.kill(os.getpid(), signal.SIGKILL)
    if number == FAILS:
        raise Degenerate("too little")
    if number == PRINTS:
        sys.stdout.write("something for people\n")
    return number + plus


class FromFile:
    """Gives what stood in a file when it was made."""

    def __init__(self, *, file: Path) -> None:
        self.number = int(file.read_text())

    def __call__(self, image: Image) -> int:
        return self.number


class FewError(Degenerate):
    """An error that pickle cannot make anew."""

    def __init__(self, what: str, n: int) -> None:
        super().__init__(f"{n} {what}")


class WarmingError(Skip):
    """A skip that pickle cannot make anew."""

    def __init__(self, n: int, of: int) -> None:
        super().__init__(f"{n} of {of}")


class OddError(Exception):
    """Another that pickle cannot make anew."""

    def __init__(self, one: str, other: str) -> None:
        super().__init__(f"{one} and {other}")


OWN_ERRORS = (FewError("cells", 3), WarmingError(1, 2), OddError("left", "right"), ValueError("no"))


def raises(image: Image) -> int:
    """Raise an error of its own."""
    raise OWN_ERRORS[int(image.values[0, 0])]


def pair(image: Image) -> list[Image]:
    """Return the image twice."""
    return [image, image]


class Counting:
    """Counts its calls, in whichever process it is."""

    def __init__(self, *, start: int = 0, rng: np.random.Generator) -> None:
        self.n = start
        self.drawn = float(rng.random())

    def __call__(self, image: Image) -> tuple[int, float]:
        """Return how many calls there were, and what was drawn once."""
        self.n += 1
        return self.n, self.drawn


class NeedsFile:
    """Is made only where a file is there; crashes where the image says so."""

    def __init__(self, *, path: str) -> None:
        with open(path):
            pass

    def __call__(self, image: Image) -> int:
        """Return what the image says."""
        if image.values[0, 0] == CRASHES:
            os.kill(os.getpid(), signal.SIGKILL)
        return int(image.values[0, 0])


class NeedsDevice(NeedsFile):
    """Looks a while for a file that is not there; notes beside it how often it was made."""

    def __init__(self, *, path: str) -> None:
        with open(f"{path}.tries", "a") as tries:
            tries.write("+")
        if not os.path.exists(path):
            time.sleep(0.3)
        super().__init__(path=path)


class Timed:
    """Counts its calls and is told of time; crashes where the image says so."""

    def __init__(self) -> None:
        self.n = 0

    def __call__(
        self, image: Image, *, gap_s: TimeGap = None, rng: np.random.Generator
    ) -> tuple[int, float | None]:
        """Return how many calls there were, and the time since the last."""
        if image.values[0, 0] == CRASHES:
            os.kill(os.getpid(), signal.SIGKILL)
        self.n += 1
        return self.n, gap_s


def elsewhere(image: Image) -> int:
    """Return the number of the process."""
    return os.getpid()


def unsendable(image: Image) -> object:
    """Return what cannot be sent to another process."""
    return lambda: None


def asks(image: Image) -> str:
    """Read a line of standard input."""
    return repr(sys.stdin.readline())


def forks(image: Image) -> int:
    """Return in two processes; the code of the other in the first."""
    copy = os.fork()
    return os.waitstatus_to_exitcode(os.waitpid(copy, 0)[1]) if copy else 7


class OwnError(BaseException):
    """What no `except Exception` takes."""


def ends_all(image: Image) -> int:
    """Raise what would end a program."""
    raise (KeyboardInterrupt, OwnError)[int(image.values[0, 0])]("enough")
