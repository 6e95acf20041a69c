"""Learn a correction of place from contacts whose true place is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_pads.learning.patch import N_PLACE, PatchKind, patches, to_the_power
from tactile_graph_pads.learning.place import PlaceCorrection, terms
from tactile_graph_pads.learning.touching import contacts_of, paired

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
LEAST_PLACES, LEAST_GROUPS = 20, 6
"""Known places, and recordings (or stretches of one) that hold them, to learn from."""
MOST_PLACES = 3000
FOLDS = 8
HALVINGS = 3
REACHES = (3, 4, 5)
POWERS = (1.0, 0.7, 0.5)
PATCH_RIDGES = tuple(float(r) for r in np.geomspace(3e-3, 10.0, 8))
PLACE_RIDGES = ((1e-2, 0.03), (1e-2, 0.1), (1e-2, 1.0), (1e-2, 100.0), (100.0, 100.0))
"""Of the terms of first order in the place, and of those of second and third."""
RADIUS_STEPS = 3.5
"""Points of a patch along the radius of the median contact, at most."""


class KnownContacts(NamedTuple):
    """Contacts whose true place is known: the frame (its values, good elements and all centres)
    each lies in, its own number there, true centre, and group; n of each. And of how many places
    told, in frames that something touches, how many met a contact."""

    frames: tuple[tuple[Array, Array], ...]
    frame: NDArray[np.int64]
    number: NDArray[np.int64]
    centres: Array
    true: Array
    group: NDArray[np.int64]
    radius_cells: float
    n_told: int
    n_met: int

    @property
    def off_cells(self) -> float:
        """Median distance of the contacts from what is known to lie there; NaN without any."""
        return float(np.median(np.hypot(*(self.true - self.centres).T))) if self.n_met else np.nan

    @property
    def unlike(self) -> bool:
        """Whether the places can hardly be those of the contacts: most meet none, or theirs lie off
        by more than a cell and a quarter of a contact's radius in the median."""
        far = max(1.0, 0.25 * self.radius_cells)
        return 2 * self.n_met < self.n_told or self.off_cells > far


class HeldOut(NamedTuple):
    """Errors in cells (x, y) of contacts that a correction was not learned from, before and after
    it, and the deviation it states; (n, 2) each."""

    before: Array
    after: Array
    stated: Array

    @property
    def off(self) -> Array:
        """Distances after the correction, shape (n,)."""
        return np.asarray(np.hypot(*self.after.T))

    @property
    def off_before(self) -> Array:
        """Distances before it, shape (n,)."""
        return np.asarray(np.hypot(*self.before.T))

    @property
    def over_stated(self) -> float:
        """Root mean square of the errors over the deviations stated."""
        return float(np.sqrt(np.mean((self.after / self.stated) ** 2)))


class LearnedPlace(NamedTuple):
    """A correction, and how it does on recordings held out: in blocks, and in halves of the
    recordings that are as unlike as can be."""

    correction: PlaceCorrection
    blocks: HeldOut
    halves: HeldOut
    n_groups: int

    @property
    def helps(self) -> bool:
        """Whether places come out nearer, even in halves unlike those it was learned from."""
        return bool(self.halves.off.mean() < self.halves.off_before.mean())


def known_contacts(
    frames: Sequence[Array], true: Sequence[Array], group: NDArray[np.int64], level: float
) -> KnownContacts:
    """Return the contacts that lie nearest to what is known to lie there.

    Parameters
    ----------
    frames : sequence of ndarray, shape (rows, columns)
        Readings above the offset.
    true : sequence of ndarray, shape (k, 2)
        (column, row) in cells from the first cell's middle.
    group : ndarray of int, shape (n,)
        Frames that are held out together.
    level : float
    """
    held: list[tuple[Array, Array]] = []
    rows: list[tuple[int, int, Array, Array, int]] = []
    sizes: list[int] = []
    n_told = 0
    for values, places, of in zip(frames, true, group.tolist(), strict=True):
        found = contacts_of(values, level)
        n_told += len(places) if len(found.centres) else 0  # one place may be told of all frames
        gate = max(2.5, 1.2 * float(np.sqrt(found.cells.max(initial=1) / np.pi)))
        pairs = paired(found.centres, places, gate)
        for i, j in pairs:
            rows.append((len(held), i, found.centres[i], places[j], of))
            sizes.append(int(found.cells[i]))
        if pairs:
            held.append((values, found.centres))
    kept = rows[:: max(1, -(-len(rows) // MOST_PLACES))]
    return KnownContacts(
        tuple(held),
        np.array([r[0] for r in kept], np.int64),
        np.array([r[1] for r in kept], np.int64),
        np.array([r[2] for r in kept]).reshape(-1, 2),
        np.array([r[3] for r in kept]).reshape(-1, 2),
        np.array([r[4] for r in kept], np.int64),
        float(np.sqrt(np.median(sizes) / np.pi)) if sizes else 0.0,
        n_told,
        len(rows),
    )


def learned_place(known: KnownContacts, good: Flags) -> LearnedPlace:
    """Return the correction that does best on halves of the recordings unlike those it learned.

    Parameters
    ----------
    known : KnownContacts
        At least `LEAST_PLACES` in `LEAST_GROUPS` groups.
    good : ndarray of bool, shape (rows, columns)

    Notes
    -----
    A Bayesian linear regression of the error on place and patch (`PlaceCorrection`); size, power
    and middle of the patch, and the widths of the priors, are those with the smallest mean error
    where one half of the recordings is told by the other. Halves lie on either side of the median
    along the first three principal components of the recordings' mean patches: what is learned
    from some people, objects or postures is tried on others. The stated deviation is scaled to be
    true there.
    """
    step = max(1.0, known.radius_cells / RADIUS_STEPS)
    windows = (0.0, max(1.0, 0.75 * known.radius_cells))
    folds: list[Fold] = []
    best: tuple[float, PatchKind, tuple[float, float, float]] | None = None
    shares = {
        (reach, window): _shares(known, good, PatchKind(reach, step, 1.0, window))
        for reach, window in product(REACHES, windows)
    }
    for power, reach, window in product(POWERS, REACHES, windows):
        kind = PatchKind(reach, step, power, window)
        problem = _problem(known, good, kind, shares[reach, window])
        if not folds:
            folds = unlike_halves(problem.terms[:, N_PLACE:], known.group)
        told = _told(problem, folds)
        for ridges in ((*p, r) for p in PLACE_RIDGES for r in PATCH_RIDGES):
            off = _mean_error(told, ridges)
            if best is None or off < best[0]:
                best = (off, kind, ridges)
    assert best is not None
    return _made(known, good, best[1], best[2], folds)


Fold = tuple[Flags, Flags]
"""Which contacts are learned from, and which are told."""


class _Problem(NamedTuple):
    """Terms (n, f), wanted corrections (n, 2) in cells, and what the terms are made with."""

    terms: Array
    wanted: Array
    mean_patch: Array
    scale: float
    shape: tuple[int, int]


def _shares(known: KnownContacts, good: Flags, kind: PatchKind) -> tuple[Array, Array]:
    """Return the patches of contacts to the power 1, and the centres they lie on."""
    first = replace(kind, power=1.0)
    each = [patches(values, good, centres, first) for values, centres in known.frames]
    pairs = list(zip(known.frame.tolist(), known.number.tolist(), strict=True))
    return np.array([each[f][0][k] for f, k in pairs]), np.array([each[f][1][k] for f, k in pairs])


def _problem(
    known: KnownContacts, good: Flags, kind: PatchKind, shares: tuple[Array, Array]
) -> _Problem:
    taken, middles = to_the_power(shares[0], kind.power), shares[1]
    mean = taken.mean(axis=0)
    scale = max(float(np.sqrt(((taken - mean) ** 2).sum(axis=1).mean())), 1e-12)
    shape = (good.shape[0], good.shape[1])
    return _Problem(
        terms(taken, middles, shape, mean, scale), known.true - middles, mean, scale, shape
    )


def _precision(n_terms: int, ridges: tuple[float, float, float]) -> Array:
    first, higher, patch = ridges
    return np.concatenate(
        [[1e-9], np.full(2, first), np.full(N_PLACE - 3, higher), np.full(n_terms - N_PLACE, patch)]
    )


def _errors(
    problem: _Problem, folds: Sequence[Fold], ridges: tuple[float, float, float]
) -> tuple[Array, Array]:
    """Return errors (m, 2) and growths of the variance (m,) of all that the folds tell."""
    off, grown = [], []
    for learned, told in folds:
        weights, covariance = _regression(problem, learned, ridges)
        f = problem.terms[told]
        off.append(problem.wanted[told] - f @ weights)
        grown.append(1.0 + np.einsum("ij,ij->i", f @ covariance, f))
    return np.concatenate(off), np.concatenate(grown)


class _Told(NamedTuple):
    """What of a fold hangs on no prior: products of what is learned, and what it is to tell."""

    square: Array
    by_wanted: Array
    terms: Array
    wanted: Array


def _told(problem: _Problem, folds: Sequence[Fold]) -> list[_Told]:
    found = []
    for learned, told in folds:
        f, wanted = problem.terms[learned], problem.wanted[learned]
        found.append(_Told(f.T @ f, f.T @ wanted, problem.terms[told], problem.wanted[told]))
    return found


def _mean_error(folds: Sequence[_Told], ridges: tuple[float, float, float]) -> float:
    """Return the mean distance of what the folds tell: as `_errors`, without the deviation."""
    off = []
    for one in folds:
        matrix = one.square.copy()
        matrix.flat[:: len(matrix) + 1] += _precision(len(matrix), ridges)
        off.append(one.wanted - one.terms @ np.linalg.solve(matrix, one.by_wanted))
    return float(np.hypot(*np.concatenate(off).T).mean())


def _regression(
    problem: _Problem, learned: Flags, ridges: tuple[float, float, float]
) -> tuple[Array, Array]:
    f, wanted = problem.terms[learned], problem.wanted[learned]
    covariance = np.linalg.inv(f.T @ f + np.diag(_precision(f.shape[1], ridges)))
    return np.asarray(covariance @ (f.T @ wanted)), np.asarray(covariance, np.float64)


def _made(
    known: KnownContacts, good: Flags, kind: PatchKind, ridges: tuple[float, float, float],
    folds: Sequence[Fold],
) -> LearnedPlace:  # fmt: skip
    problem = _problem(known, good, kind, _shares(known, good, kind))
    off, grown = _errors(problem, folds, ridges)
    std = np.sqrt((off**2 / grown[:, None]).mean(axis=0))
    weights, covariance = _regression(problem, np.ones(len(known.true), np.bool_), ridges)
    correction = PlaceCorrection(
        kind, problem.shape, problem.mean_patch, problem.scale, weights, covariance, std
    )
    before = known.true - known.centres

    def held_out(of: Sequence[Fold]) -> HeldOut:
        off, grown = _errors(problem, of, ridges)
        told = np.concatenate([before[t] for _, t in of])
        return HeldOut(told, off, np.sqrt(grown)[:, None] * std)

    blocks = held_out(_blocks(known.group))
    return LearnedPlace(correction, blocks, held_out(folds), len(np.unique(known.group)))


def _blocks(group: NDArray[np.int64]) -> list[Fold]:
    """Return folds of groups that follow one another."""
    groups, of = np.unique(group, return_inverse=True)
    block = of * min(FOLDS, len(groups)) // len(groups)
    return [(block != k, block == k) for k in range(int(block.max()) + 1)]


def unlike_halves(taken: Array, group: NDArray[np.int64]) -> list[Fold]:
    """Return halves of the groups, each told by the other, as unlike as can be.

    Parameters
    ----------
    taken : ndarray, shape (n, p)
        Patches.
    group : ndarray of int, shape (n,)
    """
    groups, of = np.unique(group, return_inverse=True)
    means = np.array([taken[of == k].mean(axis=0) for k in range(len(groups))])
    along = np.linalg.svd(means - means.mean(axis=0), full_matrices=False)[0]
    folds: list[Fold] = []
    for k in range(min(HALVINGS, along.shape[1])):
        high = (along[:, k] > np.median(along[:, k]))[of]
        folds += [(high, ~high), (~high, high)]
    return folds
