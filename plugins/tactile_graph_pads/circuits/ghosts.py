"""``ghosts``: whether a frame looks as if it was read from a matrix whose idle lines float."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of

Values = NDArray[np.float64]
Cells = NDArray[np.bool_]

LOADED = 0.5
"""Share of a loaded element's typical reading from which on one counts as loaded itself."""

NEAR, FAR = 2, 4
"""Elements from a loaded one: within the first foam and a round edge read something, too, and those
that it is compared with are no further away than the second."""

WITHIN_FAR, WITHIN_NEAR = 1, 2
"""How `distances` says so of an element."""

FEWEST = 6
"""Elements at crossings, and beside them, that tell anything."""

MOST_SILENT = 0.1
"""Share of the crossings' elements that may read nothing."""

MANY = 512
"""Readings that tell what a loaded element typically reads."""

LEAST_GHOST, STAND_OUT = 0.02, 2.0
"""Share of a loaded element's reading that ghosts reach, and how far they stand out of what is read
beside the crossings."""

LEAST_FRAMES, LEAST_SHARE, MOST_LOOKED_AT = 3, 0.5, 200
"""Frames with ghosts, and their share of those that could tell, from which on a recording is said
to hold some; and the frames of one that are looked at."""

UNTOLD, NONE, GHOSTS = -1, 0, 1
"""What a frame comes to: nothing that could tell, no ghosts, some."""

EVERY = np.ones((0, 0), np.bool_)
"""Stands for elements all of which count."""
EVERY.setflags(write=False)

ADVICE = (
    "a pad that says 'circuit: {kind: floating, bias_ohm: …, supply_v: …}' takes ghosts out of "
    "readings in volts"
)


def _ghosts_plain(above: Values, shows: Cells, known: Cells) -> int:
    """Return whether there are readings where one object's rows cross another's columns.

    Parameters
    ----------
    above : ndarray, shape (rows, columns)
        Readings above the frame's zero, of any unit.
    shows : ndarray of bool, the same shape
        Where they are more than noise.
    known : ndarray of bool
        Elements that count; of shape (0, 0) if all do.

    Returns
    -------
    int
        `UNTOLD` where nothing could tell: of one object, or of several whose crossings lie between
        them or read as much as they do, a frame looks as on any other pad.

    Notes
    -----
    A crossing has loaded elements in its row and in its column, none within two elements, and does
    not lie between two. If it reads something, and most of what lies as far from them beside those
    rows and columns does not, the reading came along these. Most: rows of a rim, which is loaded by
    less than half, have weak ghosts of their own.
    """
    counts = known if known.size else np.ones(above.shape, np.bool_)
    seen = above[shows & counts]
    if len(seen) < FEWEST:
        return UNTOLD
    seen = np.sort(seen[:: max(1, len(seen) // MANY)])
    low = int(np.searchsorted(seen, 0.5 * seen[(9 * len(seen) - 9) // 10]))
    typical = float(seen[(low + len(seen)) // 2])
    loaded = shows & counts & (above >= LOADED * typical)
    along = np.logical_and.outer(loaded.any(axis=1), loaded.any(axis=0))
    near = _within(loaded, NEAR)
    crossings = along & counts & ~near & ~_between(loaded, 0) & ~_between(loaded, 1)
    beside = _within(loaded, FAR) & counts & ~near & ~along
    n, m = int(np.count_nonzero(crossings)), int(np.count_nonzero(beside))
    if n < FEWEST:
        return UNTOLD
    level = np.where(shows, above, 0.0)
    ghost = np.sort(level[crossings])[int(MOST_SILENT * n)]
    if ghost <= LEAST_GHOST * typical:
        return NONE
    if m < FEWEST:
        return UNTOLD
    return GHOSTS if ghost > STAND_OUT * np.sort(level[beside])[m // 2] else NONE


@compiled_twin_of(_ghosts_plain)
def ghosts(above, shows, known):  # type: ignore[no-untyped-def]
    """Do the same in loops, which end where no crossing could tell."""
    (rows, columns), every = above.shape, known.size == 0
    seen, total = np.empty(above.size), 0
    for i in range(rows):
        for j in range(columns):
            if shows[i, j] and (every or known[i, j]):
                seen[total] = above[i, j]
                total += 1
    if total < FEWEST:
        return UNTOLD
    seen = np.sort(seen[: total : max(1, total // MANY)])
    low = np.searchsorted(seen, 0.5 * seen[(9 * len(seen) - 9) // 10])
    typical = seen[(low + len(seen)) // 2]
    loaded = np.zeros((rows, columns), np.bool_)
    left, right = np.full(rows, columns), np.full(rows, -1)
    top, bottom = np.full(columns, rows), np.full(columns, -1)
    for i in range(rows):
        for j in range(columns):
            if shows[i, j] and (every or known[i, j]) and above[i, j] >= LOADED * typical:
                loaded[i, j] = True
                left[i], right[i] = min(left[i], j), j
                top[j], bottom[j] = min(top[j], i), i
    crossing, n, silent = np.empty(above.size), 0, 0
    for i in range(rows):
        for j in range(columns):
            if right[i] < 0 or bottom[j] < 0 or not (every or known[i, j]):
                continue
            if left[i] <= j <= right[i] or top[j] <= i <= bottom[j] or is_near(loaded, i, j):
                continue
            crossing[n] = above[i, j] if shows[i, j] else 0.0
            silent += 1 if crossing[n] <= LEAST_GHOST * typical else 0
            n += 1
    if n < FEWEST:
        return UNTOLD
    if silent > int(MOST_SILENT * n):
        return NONE
    away, beside, m = distances(loaded), np.empty(above.size), 0
    for i in range(rows):
        for j in range(columns):
            its = away[i, j] == WITHIN_FAR and (every or known[i, j])
            if its and (right[i] < 0 or bottom[j] < 0):
                beside[m] = above[i, j] if shows[i, j] else 0.0
                m += 1
    if m < FEWEST:
        return UNTOLD
    ghost, other = np.sort(crossing[:n])[int(MOST_SILENT * n)], np.sort(beside[:m])[m // 2]
    return GHOSTS if ghost > STAND_OUT * other else NONE


@compiled_later
def is_near(loaded: Cells, i: int, j: int) -> bool:
    """Return whether a loaded element is near one."""
    rows, columns = loaded.shape
    for k in range(max(i - NEAR, 0), min(i + NEAR + 1, rows)):
        for m in range(max(j - NEAR, 0), min(j + NEAR + 1, columns)):
            if loaded[k, m]:
                return True
    return False


@compiled_later
def distances(loaded: Cells) -> NDArray[np.uint8]:
    """Return which elements lie within `NEAR` of loaded ones, which within `FAR`; 0 beyond."""
    rows, columns = loaded.shape
    found = np.zeros((rows, columns), np.uint8)
    for i in range(rows):
        for j in range(columns):
            if loaded[i, j]:
                for k in range(max(i - FAR, 0), min(i + FAR + 1, rows)):
                    for m in range(max(j - FAR, 0), min(j + FAR + 1, columns)):
                        if abs(k - i) <= NEAR and abs(m - j) <= NEAR:
                            found[k, m] = WITHIN_NEAR
                        elif found[k, m] == 0:
                            found[k, m] = WITHIN_FAR
    return found


def ghosts_in(
    frames: Values, level: float, known: Cells, rest: Values | float = 0.0
) -> tuple[int, int]:
    """Return in how many frames there seem to be ghosts, and how many could tell.

    Parameters
    ----------
    frames : ndarray, shape (frames, rows, columns)
        Of many some are looked at.
    level : float
        Above ``rest``, from which on a reading is more than noise.
    known : ndarray of bool, shape (rows, columns)
        Elements that count.
    rest : ndarray, shape (rows, columns), or float
        What elements read that nothing touches.
    """
    some = frames[:: -(-len(frames) // MOST_LOOKED_AT) or 1]
    found = [ghosts.call(its - rest, its - rest >= level, known) for its in some]
    return found.count(GHOSTS), len(found) - found.count(UNTOLD)


def ghosts_told(n_ghosts: int, n_telling: int) -> str:
    """Return what to say of a recording by what `ghosts_in` found; empty where it is too little."""
    if n_ghosts < max(LEAST_FRAMES, LEAST_SHARE * n_telling):
        return ""
    return (
        f"{n_ghosts} of {n_telling} frames in which rows of one object cross columns of another "
        "read something there, and not beside them: this may be a matrix without isolation; "
        f"{ADVICE}"
    )


def _between(loaded: Cells, axis: int) -> Cells:
    """Return what has loaded elements on both sides, or is one."""
    before = np.logical_or.accumulate(loaded, axis=axis)
    after = np.flip(np.logical_or.accumulate(np.flip(loaded, axis), axis=axis), axis)
    found: Cells = before & after
    return found


def _within(loaded: Cells, reach: int) -> Cells:
    """Return what lies so few rows and columns from a loaded element."""
    down = loaded.copy()
    for k in range(1, reach + 1):
        down[k:] |= loaded[:-k]
        down[:-k] |= loaded[k:]
    found = down.copy()
    for k in range(1, reach + 1):
        found[:, k:] |= down[:, :-k]
        found[:, :-k] |= down[:, k:]
    return found
