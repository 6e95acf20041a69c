"""Keep some frames whole: a few regular ones, and where each variant is worst; no more."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, NamedTuple

from tactile_graph import Result
from tactile_graph.wires.frame import Frame
from tactile_graph_compare.records.frames import Choice
from tactile_graph_compare.run.stories import Stories


class Seen(NamedTuple):
    """What is kept of a frame that was run elsewhere."""

    frame: Frame
    reused: bool


class Told(NamedTuple):
    """What is kept of a frame that was run elsewhere, and cannot be run again alone."""

    frame: Frame
    stories: Stories


Held = Result | Seen | Told
"""What is kept of a frame."""


@dataclass
class _Worst:
    position: int
    result: Held
    error: float


@dataclass
class FrameChooser:
    """Chooses frames while they go by; holds a bounded number of results at any time.

    Parameters
    ----------
    n_regular : int
        Frames at even distances. While nobody knows how many there will be, twice as many are
        held, and every other one dropped when they are too many.
    most : int
        Frames kept in all.
    """

    n_regular: int = 4
    most: int = 40
    _regular: dict[int, Held] = field(default_factory=dict, init=False)
    _stride: int = field(default=1, init=False)
    _worst: dict[tuple[str, str], _Worst] = field(default_factory=dict, init=False)
    _silent: dict[tuple[str, str], _Worst] = field(default_factory=dict, init=False)
    _apart: dict[tuple[tuple[str, str], str], _Worst] = field(default_factory=dict, init=False)

    def add(
        self,
        position: int,
        result: Result,
        worst: Mapping[str, Mapping[str, float]],
        apart: Mapping[tuple[str, str], Mapping[str, float]] = MappingProxyType({}),
    ) -> None:
        """Look at a frame.

        Parameters
        ----------
        position : int
            Its row.
        result : Result
        worst : mapping
            Variant -> quantity -> its worst error, or NaN.
        apart : mapping
            (variant, reference) -> quantity -> how far they lie apart.
        """
        if not self.most:
            return
        if self.n_regular and position % self._stride == 0:
            self._regular[position] = result
            self._thin()
        for variant, errors in worst.items():
            for quantity, error in errors.items():
                self._look(position, result, (variant, quantity), error)
        for pair, differences in apart.items():
            for quantity, off in differences.items():
                known = self._apart.get((pair, quantity))
                if off and (known is None or off > known.error):
                    self._apart[pair, quantity] = _Worst(position, result, off)

    def _thin(self) -> None:
        while len(self._regular) > 2 * self.n_regular:
            self._stride *= 2
            self._regular = {p: r for p, r in self._regular.items() if p % self._stride == 0}

    def anew(self) -> FrameChooser:
        """Return one that keeps as many frames, and has none yet."""
        return FrameChooser(self.n_regular, self.most)

    def as_sent(self, told: Callable[[Result], Told] | None = None) -> FrameChooser:
        """Return one that can be pickled.

        Parameters
        ----------
        told : callable, optional
            Makes of a result what is sent. Without it that is what results are made of again.
        """

        def seen(held: Held) -> Held:
            if isinstance(held, Seen | Told):
                return held
            return Seen(held.frame, held.reused) if told is None else told(held)

        def all_seen(of: dict[Any, _Worst]) -> dict[Any, _Worst]:
            return {key: replace(at, result=seen(at.result)) for key, at in of.items()}

        sent = self.anew()
        sent._stride = self._stride
        sent._regular = {p: seen(r) for p, r in self._regular.items()}
        sent._worst, sent._silent = all_seen(self._worst), all_seen(self._silent)
        sent._apart = all_seen(self._apart)
        return sent

    def join(self, later: FrameChooser, shift: int = 0) -> None:
        """Keep what was chosen elsewhere, among later frames.

        Parameters
        ----------
        later : FrameChooser
        shift : int
            Added to its positions: what frames before it were left out since.
        """
        self._stride = max(self._stride, later._stride)
        both = {**self._regular, **{p + shift: r for p, r in later._regular.items()}}
        self._regular = {p: r for p, r in both.items() if p % self._stride == 0}
        self._thin()
        pairs: list[tuple[dict[Any, _Worst], dict[Any, _Worst]]] = [
            (self._worst, later._worst),
            (self._silent, later._silent),
            (self._apart, later._apart),
        ]
        for mine, its in pairs:
            for key, at in its.items():
                known = mine.get(key)
                if known is None or abs(at.error) > abs(known.error):
                    mine[key] = replace(at, position=at.position + shift)

    def _look(self, position: int, result: Result, key: tuple[str, str], error: float) -> None:
        if math.isnan(error):
            if key not in self._silent:
                self._silent[key] = _Worst(position, result, error)
            return
        known = self._worst.get(key)
        if error and (known is None or abs(error) > abs(known.error)):
            self._worst[key] = _Worst(position, result, error)

    def chosen(self) -> list[tuple[int, Held, tuple[Choice, ...]]]:
        """Return the frames kept, in order, each with why."""
        choices: dict[int, list[Choice]] = {}
        results: dict[int, Held] = {}

        def choose(position: int, result: Held, choice: Choice) -> None:
            if position in choices or len(choices) < self.most:
                choices.setdefault(position, []).append(choice)
                results[position] = result

        for position in _spread(sorted(self._regular), self.n_regular):
            choose(position, self._regular[position], Choice("regular"))
        for (variant, quantity), at in self._worst.items():
            choose(at.position, at.result, Choice("worst", variant, quantity, at.error))
        for (variant, quantity), at in self._silent.items():
            choose(at.position, at.result, Choice("no answer", variant, quantity))
        for ((variant, reference), quantity), at in self._apart.items():
            choice = Choice("apart", variant, quantity, at.error, reference)
            choose(at.position, at.result, choice)
        return [(p, results[p], tuple(choices[p])) for p in sorted(choices)]


def _spread(positions: list[int], most: int) -> list[int]:
    """Return at most so many of the positions, the first and the last among them."""
    if len(positions) <= most:
        return positions
    if most == 1:
        return positions[:1]
    step = (len(positions) - 1) / (most - 1)
    return [positions[round(i * step)] for i in range(most)]
