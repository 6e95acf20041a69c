"""What is asked of tuning."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from tactile_graph import Pipeline
from tactile_graph.errors import UsageError, did_you_mean
from tactile_graph.inspect import idle_settings
from tactile_graph.many import Place
from tactile_graph.pipeline.document import assignment
from tactile_graph_compare.variants.prepare import setting_names
from tactile_graph_tune.shares import Share

STEPS = 5
MOST_VARIANTS = 32


@dataclass(frozen=True)
class Free:
    """A setting that may be chosen, ``node.setting``, and the values it may take."""

    name: str
    values: tuple[Any, ...]


@dataclass(frozen=True)
class Request:
    """What is tuned, and for what.

    Parameters
    ----------
    pipeline : Pipeline
    answer : str
        The output whose error counts; the first that a truth can judge where empty.
    quantity : str, optional
        Of its error; the first there is if not given.
    price : float, optional
        What no answer counts, and the most that one can: who is off by it has missed.
    most_error : float, optional
        Find the cheapest whose mean error, where something lies, is no greater; no greater than
        that of the pipeline as it is if neither this nor ``most_us`` is given.
    most_missed, most_false : float, optional
        Shares of the frames where something lies that may be missed, and of those where nothing
        does that may be answered; the pipeline's own if not given.
    most_us : float, optional
        Find the least error that takes no longer, mean over the frames.
    margin : float
        Share by which the error may be greater than that of the pipeline as it is, where neither
        ``most_error`` nor ``most_us`` is given.
    fields : tuple of str
        The only fields that guards may ask; all where empty.
    kept : tuple of str
        Named conditions, and nodes by their own guard, that stay as the file has them: what the
        frames at hand do not show may need them.
    free : tuple of Free
        Settings that may be chosen, besides those that the file marks; instead of its values where
        it marks the same.
    levels : bool
        Choose only the numbers that guards compare with, and free settings: what guards ask, and
        the rungs, stay.
    rounds : int
        How often every frame is run: times are medians.
    seed : int
    shares : sequence of Share
        What share of the frames to come is of which kind; every frame counts alike if not given.
    place : Place, optional
        Where workers run everything on every frame; this process does where there is none.
    frames_of : str
        Where the frames come from, in words for the tuned file.
    """

    pipeline: Pipeline
    answer: str = ""
    quantity: str | None = None
    price: float | None = None
    most_error: float | None = None
    most_missed: float | None = None
    most_false: float | None = None
    most_us: float | None = None
    margin: float = 0.0
    fields: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()
    free: tuple[Free, ...] = ()
    levels: bool = False
    rounds: int = 3
    seed: int = 0
    shares: tuple[Share, ...] = ()
    place: Place | None = None
    frames_of: str = ""

    def variants(self) -> list[dict[str, Any]]:
        """Return every combination of the free settings' values, the file's own first.

        Raises
        ------
        UsageError
            If a setting does not exist or changes nothing, or there are too many combinations.
        """
        known = set(setting_names(self.pipeline))
        for free in self.free:
            if free.name not in known:
                hint = did_you_mean(free.name, known)
                raise UsageError(
                    f"--free {free.name}: pipeline {self.pipeline.name!r} has no such setting{hint}"
                )
            if idle_settings(self.pipeline, [free.name]):
                node = free.name.rpartition(".")[0]
                raise UsageError(f"--free {free.name}: changes nothing, no output needs {node!r}")
        every = {**self.pipeline.free, **{f.name: f.values for f in self.free}}
        n = math.prod(map(len, every.values()))
        if n > MOST_VARIANTS:
            raise UsageError(_too_many(", ".join(every), n))
        combined = product(*every.values()) if every else ()
        return [{}, *(dict(zip(every, values, strict=True)) for values in combined)]


def parse_free(text: str) -> Free:
    """Return what ``node.setting=low:high``, ``low:high:count`` or ``a,b,c`` spells.

    Values between positive bounds stand at equal ratios, others at equal distances.

    Raises
    ------
    UsageError
        If it spells none of them, or more values than can be tried.
    """
    name, sign, given = (part.strip() for part in text.partition("="))
    if not sign or "." not in name.strip(".") or not given:
        raise UsageError(f"--free {text}: must be node.setting=low:high, low:high:count, or a,b,c")
    if ":" in given:
        return Free(name, _between(name, text, given.split(":")))
    listed = assignment("--free", f"{name}=[{given}]")[1]
    if any(listed.count(v) > 1 for v in listed):
        raise UsageError(f"--free {text}: a value stands there twice")
    return Free(name, tuple(listed))


def _too_many(names: str, n: int) -> str:
    return (
        f"{names}: {n} combinations of values, at most {MOST_VARIANTS}: name fewer values "
        "(--free node.setting=low:high:count), or mark fewer settings free"
    )


def _between(name: str, text: str, parts: Sequence[str]) -> tuple[float, ...]:
    try:
        low, high = (float(p) for p in parts[:2])
        n = int(parts[2]) if len(parts) == 3 else STEPS
    except ValueError:
        n = 0
    if len(parts) > 3 or n < 2 or not low < high < np.inf:
        raise UsageError(
            f"--free {text}: must be low:high or low:high:count, low below high, 2 values or more"
        )
    if n > MOST_VARIANTS:
        raise UsageError(_too_many(name, n))
    spaced = np.geomspace if low > 0.0 else np.linspace
    return tuple(float(f"{v:.3g}") for v in spaced(low, high, n))
