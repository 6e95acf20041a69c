"""``Work``: the settings of one reproduction, and what several items share, done once."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any, TypeVar

from tactile_graph_thesis.numbers import numbers

if TYPE_CHECKING:
    from tactile_graph import Frame

T = TypeVar("T")
READINGS = 500
QUICK_READINGS = 60


class Work:
    """What an item is made with.

    Parameters
    ----------
    seed : int
        Everything random comes from it.
    readings : int
        Of each object, for the tables of errors.
    quick : bool
        Fewer pads and levels in the longer studies.
    """

    def __init__(self, seed: int = 0, readings: int = READINGS, quick: bool = False) -> None:
        self.seed, self.readings, self.quick = seed, readings, quick
        self._done: dict[Hashable, Any] = {}

    @property
    def group(self) -> int:
        """How many readings the thesis took of each object; fewer where there are fewer."""
        return min(int(numbers("readings")["each"]), self.readings)

    def once(self, key: Hashable, make: Callable[[], T]) -> T:
        """Return what ``make`` gives, calling it for the first of equal keys only.

        Parameters
        ----------
        key : hashable
        make : callable
        """
        if key not in self._done:
            self._done[key] = make()
        found: T = self._done[key]
        return found

    def frames(self, scene: str, n: int) -> list[Frame]:
        """Return ``n`` simulated frames of a scene on the thesis' pad.

        Parameters
        ----------
        scene : str
        n : int
        """
        from tactile_graph import load

        def made() -> list[Frame]:
            pipeline = load("circle-1").with_source("simulate", scene=scene, frames=n)
            return list(pipeline.frames(self.seed))

        return self.once(("frames", scene, n), made)
