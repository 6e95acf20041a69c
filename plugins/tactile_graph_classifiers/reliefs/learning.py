"""Reliefs of known objects, and how the pad reads, learned from presses of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from tactile_graph_classifiers.reliefs.beyond import extend
from tactile_graph_classifiers.reliefs.descent import descend
from tactile_graph_classifiers.reliefs.laying import begun
from tactile_graph_classifiers.reliefs.pad_reading import VARIANCES, Law, PadReading
from tactile_graph_classifiers.reliefs.presses import Presses
from tactile_graph_classifiers.reliefs.relief import (
    STARTS,
    Relief,
    begun_with,
    everywhere,
    followed,
    picture_of,
    read_as,
    starts,
    stepped,
)

Array = NDArray[np.float64]
Say = Callable[[str], None]
SOFT = 0.03
"""Depth, of the usual one, over which touching begins."""
GAIN_SPREAD = 0.12
"""Of the logarithm of gains, before anything is learned."""
ROUNDS = 3
END = 0.99
"""Share of the highest reading from which on a cell may have been pressed harder than it reads."""


class Stage(NamedTuple):
    """One descent.

    Parameters
    ----------
    soft : float
        Depth, of the usual one, over which touching begins.
    wider : float
        How much wider variances are taken.
    n_steps : int
    search : str
        How presses that fit badly are looked for anew: not, by ``turns``, or ``everywhere``.
    """

    soft: float
    wider: float
    n_steps: int
    search: str = ""


FIRST = (
    Stage(0.15, 8.0, 30), Stage(0.1, 4.0, 30), Stage(0.06, 2.0, 30),
    Stage(0.04, 1.0, 40, "everywhere"), Stage(SOFT, 1.0, 60, "turns"),
)  # fmt: skip
"""What a soft relief misses at its rim is added to the variances: still cells vary by so little
that else no relief at all fits better than one laid a little wrongly, and from there none comes
back."""
AGAIN = (Stage(SOFT, 1.0, 40, "everywhere"), Stage(SOFT, 1.0, 40, "turns"))
LAST_STEPS = 30


def refit(
    relief: Relief, presses: Presses, weights: Array, pad: PadReading, search: str = ""
) -> None:
    """Fit all presses to the relief, in place; look anew for those that fit badly."""
    for number, press in enumerate(relief.presses):
        fit = stepped(relief, press, presses, number, weights, pad, 8)
        relief.misfits[number], relief.presses[number] = fit
    each = relief.misfits / presses.n_cells()
    good = 1.6 * np.quantile(each, 0.2)
    trust = np.where(each <= good, 1.0, 1e-3)
    relief.picture = picture_of(presses, relief.presses, len(relief.depth), trust)
    logs = np.column_stack([np.ones(len(each)), np.log(presses.totals())])
    relief.deep = np.linalg.lstsq(logs, relief.presses[:, 3], rcond=None)[0]
    if not search:
        return
    anywhere = search == "everywhere"
    for k in np.flatnonzero(each > good * (4.0 if anywhere else 1.0)).tolist():
        tried = everywhere(relief, presses, k) if anywhere else starts(relief, presses, k, STARTS)
        first = begun_with(relief, tried, presses, k, weights, pad)
        misfit, press = followed(relief, first, presses, k, weights, pad)
        if misfit < relief.misfits[k] - 5.0:
            relief.misfits[k], relief.presses[k] = misfit, press


def staged(
    relief: Relief, presses: Presses, pad: PadReading, stages: Sequence[Stage], trust: Array
) -> Relief:
    """Fit a relief and its presses in turns, in place; return it."""
    own = pad.weights(presses)
    for stage in stages:
        relief.soft = stage.soft * relief.usual
        missed = (stage.soft - SOFT) * relief.usual
        weights = own / (stage.wider + own * missed**2)
        descend(relief, presses, weights * trust[:, None, None], pad, stage.n_steps)
        refit(relief, presses, weights, pad, stage.search)
        trust = relief.trust(presses)
    extend(relief, presses)
    descend(relief, presses, own * trust[:, None, None], pad, LAST_STEPS)
    extend(relief, presses)
    refit(relief, presses, own, pad)
    return relief


def learned(
    presses: Presses, pad: PadReading, relief: Relief | None = None, place: int = 0
) -> Relief:
    """Return the relief of an object by its presses, from a former one where there is one."""
    stages = FIRST if relief is None else AGAIN
    relief = begun(presses, place, stages[0].soft) if relief is None else relief
    return staged(relief, presses, pad, stages, np.ones(len(presses.values)))


def improved(
    pad: PadReading,
    reliefs: Sequence[Relief],
    all_presses: Sequence[Presses],
    by_readings: bool = False,
) -> PadReading:
    """Return gains, variances and the spread of the lean by what reliefs leave over.

    Variances go with what reliefs expect: with what was read, noise of a cell that should read
    nothing would be all of its reading. While no law is chosen yet reliefs expect what is wrong,
    and variances go with the readings.
    """
    each = [r.misfits / s.n_cells() for r, s in zip(reliefs, all_presses, strict=True)]
    limit = 2.5 * float(np.median(np.concatenate(each)))
    over, under = np.zeros(pad.gains.shape), np.zeros(pad.gains.shape)
    parts, squares, doubted = [], [], []
    for relief, presses, off in zip(reliefs, all_presses, each, strict=True):
        weights = pad.weights(presses)
        for k in np.flatnonzero(off <= limit):
            i, j, m, n = presses.boxes[k]
            box = (slice(i, i + m), slice(j, j + n))
            value = read_as(relief, relief.presses[k], presses.boxes[k], pad)
            real, weight = presses.values[k][box], weights[k][box]
            by = (
                pad.parts(presses.values[k][None])[:, 0][:, *box]
                if by_readings
                else pad.parts(value[None])[:, 0]
            )
            counts = ~((real >= pad.top) & (value > real)) & presses.good[k][box]
            told = np.where(counts & (value > 0.01), weight, 0.0)
            over[box] += told * value * (real - value)
            under[box] += told * value**2
            parts.append(by[:, counts].T)
            squares.append(np.minimum((real - value)[counts] ** 2, 9.0 / weight[counts]))
            doubted.append((pad.doubts[box] * by[1])[counts])
    doubts = 1.0 / (under + 1.0 / GAIN_SPREAD**2)
    change = np.clip(over * doubts, -0.3, 0.3)
    leans = np.concatenate([r.presses[:, 4:].ravel() for r in reliefs])
    return replace(
        pad,
        gains=pad.gains * np.exp(change / pad.law.power),
        doubts=doubts,
        variances=_variances(
            pad.variances, np.concatenate(parts), np.concatenate(squares), np.concatenate(doubted)
        ),
        lean_variance=max(1.2 * float(np.mean(leans**2)), 1e-8),
    )


def _variances(before: Array, parts: Array, squares: Array, doubted: Array) -> Array:
    """Return the three variances by which readings are off as they are, gains' doubts aside."""
    variances = before
    for _ in range(3):
        weight = 1.0 / (parts @ variances + doubted)
        found = nnls(parts * weight[:, None], (squares - doubted) * weight)[0]
        variances = np.maximum(found, [1e-7, 1e-5, 1e-5])
    return variances


def _begin_again(reliefs: list[Relief], all_presses: Sequence[Presses], pad: PadReading) -> None:
    """Learn objects that fit badly anew, their presses laid on two other ones first."""
    off = [r.off_a_cell(s) for r, s in zip(reliefs, all_presses, strict=True)]
    for k in np.flatnonzero(off > 2.0 * np.median(off)).tolist():
        presses = all_presses[k]
        tried = [reliefs[k], *(learned(presses, pad, place=place) for place in (1, 2))]
        reliefs[k] = tried[int(np.argmin([one.off_a_cell(presses) for one in tried]))]


def unlearned_pad(all_presses: Sequence[Presses], law: Law) -> PadReading:
    """Return what is believed of a pad before anything is learned of it."""
    top = END * max(float(s.values.max()) for s in all_presses)
    shape = all_presses[0].values.shape[1:]
    still = np.concatenate([s.away() for s in all_presses])
    variances = np.maximum(VARIANCES, [float(np.var(still)) if still.size else 0.0, 0.0, 0.0])
    return PadReading(law, np.ones(shape), np.zeros(shape), top, variances)


def learn_reliefs(
    all_presses: Sequence[Presses], law: Law, say: Say
) -> tuple[list[Relief], PadReading]:
    """Return the reliefs of all objects, and how the pad reads: of the round that explains most.

    Parameters
    ----------
    all_presses : sequence of Presses
        Of each object.
    law : Law
    say : callable
        Takes lines about how far it is.
    """
    pad = unlearned_pad(all_presses, law)
    reliefs: list[Relief] = []
    best: tuple[float, list[Relief], PadReading] | None = None
    for k in range(ROUNDS):
        before: Sequence[Relief | None] = reliefs or [None] * len(all_presses)
        reliefs = [learned(s, pad, r) for s, r in zip(all_presses, before, strict=True)]
        if k == 0:
            _begin_again(reliefs, all_presses, pad)
        pad = improved(pad, reliefs, all_presses)
        vary, gains = math.sqrt(pad.variances[1]), float(np.log(pad.gains).std())
        say(f"round {k + 1} of {ROUNDS}: readings vary by {100 * vary:.1f} %, gains by "
            f"{100 * gains:.1f} %")  # fmt: skip
        if best is None or vary < best[0]:
            best = vary, deepcopy(reliefs), pad  # a round works on those of the one before
    assert best is not None
    _, reliefs, pad = best
    for relief, presses in zip(reliefs, all_presses, strict=True):
        refit(relief, presses, pad.weights(presses), pad)
    return reliefs, pad
