"""``Study``: one question of thesis chapter 2, how it is answered, and what it came to."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import numpy as np

from tactile_graph.errors import UsageError, did_you_mean, one_of
from tactile_graph_pads.pad import Pad

if TYPE_CHECKING:
    from matplotlib.figure import Figure

R = TypeVar("R")


class Finding(NamedTuple):
    """A conclusion of the thesis beside what comes out here."""

    thesis: str
    found: str
    holds: bool


class Table(NamedTuple):
    """What a study came to as rows of plain values; the columns' names carry the units."""

    columns: tuple[str, ...]
    rows: Sequence[tuple[Any, ...]]


@dataclass(frozen=True)
class Study(Generic[R]):
    """One study.

    Parameters
    ----------
    name : str
        As the command takes it.
    figure : str
        Which figure of the thesis it belongs to.
    about : str
        What is varied and what is looked at, in a line.
    run : callable
        ``run(pad, rng)`` returns plain arrays in a named tuple.
    table : callable
        Those arrays as rows.
    findings : callable
        What the thesis concludes, and whether it comes out.
    plot : callable
        Draws them on an empty figure.
    """

    name: str
    figure: str
    about: str
    run: Callable[[Pad, np.random.Generator], R]
    table: Callable[[R], Table]
    findings: Callable[[R], list[Finding]]
    plot: Callable[[Figure, R], None]


_HERE = "tactile_graph_thesis.chapter_2"
STUDIES: Mapping[str, str] = {
    "bias-sensitivity": f"{_HERE}.bias:BIAS_SENSITIVITY",
    "bias-loaded": f"{_HERE}.bias:BIAS_LOADED",
    "bias-coupling": f"{_HERE}.bias:BIAS_COUPLING",
    "bias-random": f"{_HERE}.bias_random:BIAS_RANDOM",
    "bump": f"{_HERE}.footprints:BUMP",
    "foam": f"{_HERE}.footprints:FOAM",
    "characteristic": f"{_HERE}.characteristic:CHARACTERISTIC",
    "error-bars": f"{_HERE}.characteristic:ERROR_BARS",
    "curve": f"{_HERE}.curve:CURVE",
    "weight-area": f"{_HERE}.weight_area:WEIGHT_AREA",
    "samples": f"{_HERE}.samples:SAMPLES",
    "converter": f"{_HERE}.converter:CONVERTER",
}
"""Name -> where its `Study` is; imported when asked for."""


def study_names() -> tuple[str, ...]:
    """Return the studies' names in the order of the thesis' figures."""
    return tuple(STUDIES)


def load_study(name: str) -> Study[Any]:
    """Return a study by its name.

    Raises
    ------
    UsageError
        If there is none of that name.
    """
    if name not in STUDIES:
        hint = did_you_mean(name, STUDIES) or f"; there are: {one_of(STUDIES, 30)}"
        raise UsageError(f"no study named {name!r}{hint}")
    module, _, attribute = STUDIES[name].partition(":")
    study: Study[Any] = getattr(import_module(module), attribute)
    return study
