"""``Work``: the settings of one reproduction, and what several items share, done once."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tactile_graph_thesis.numbers import numbers

if TYPE_CHECKING:
    from tactile_graph import Frame
    from tactile_graph_pads.pad import Pad

T = TypeVar("T")
PAD = "thesis"
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
    pad_name : str
        Name or YAML file of the pad that everything is read on.
    """

    def __init__(
        self, seed: int = 0, readings: int = READINGS, quick: bool = False, pad_name: str = PAD
    ) -> None:
        self.seed, self.readings, self.quick, self.pad_name = seed, readings, quick, pad_name
        self._done: dict[Hashable, Any] = {}

    def settings(self) -> tuple[int, int, bool, str]:
        """Return what an equal one is made with."""
        return self.seed, self.readings, self.quick, self.pad_name

    @property
    def group(self) -> int:
        """How many readings the thesis took of each object; fewer where there are fewer."""
        return min(int(numbers("readings")["each"]), self.readings)

    @cached_property
    def pad(self) -> Pad:
        """The pad that everything is read on.

        Raises
        ------
        UsageError
            If there is none of that name.
        """
        from tactile_graph_pads.pad import load_pad

        return load_pad(self.pad_name)

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

    def on_pad(self, study: Callable[[Pad, np.random.Generator], T]) -> T:
        """Return what a study finds on the pad, with randomness of its own, done once.

        Parameters
        ----------
        study : callable
            From the pad and a generator seeded for it alone.
        """
        return self.once(study, lambda: study(self.pad, np.random.default_rng(self.seed)))

    def frames(self, scene: str, n: int) -> list[Frame]:
        """Return ``n`` simulated frames of a scene on the pad.

        Parameters
        ----------
        scene : str
        n : int
        """
        from tactile_graph import load

        def made() -> list[Frame]:
            settings = {"scene": scene, "frames": n, "pad": self.pad_name}
            return list(load("circle-1").with_source("simulate", **settings).frames(self.seed))

        return self.once(("frames", scene, n), made)
