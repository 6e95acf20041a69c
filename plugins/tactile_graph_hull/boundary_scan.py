"""``boundary_scan``: the outermost cells of a footprint, seen from four sides."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.steps import Linked
from tactile_graph.wires import Mask, Points, packed_mask, quick_points
from tactile_graph.wires.parts import MaskParts, PointsParts, points_of
from tactile_graph.wires.stacks import MaskStack, PointsStack
from tactile_graph_hull.packed import centres_of, first_met, scanned_words
from tactile_graph_hull.parts import several_parts

BLOCK = 16  # cells looked at together
WIDEST = MaskStack.WIDEST
ONE = np.uint64(1)


def boundary_scan(mask: Mask) -> Points:
    """Return the centres of the first on-cells met from the left, right, top and bottom.

    Parameters
    ----------
    mask : Mask
        The footprint.

    Returns
    -------
    Points
        Each boundary cell once, by rising x and, where x is the same, by rising y; none for an
        empty mask. Holes and bays that no side looks into have no boundary here.

    Notes
    -----
    The points are centres of cells, so a circle fitted to them is smaller than the footprint's
    outline by about half a cell. `boundary_mask` gives the same cells as a mask. Source: thesis
    3.1.2 and 4.2.3, figures 3.2 and 4.12.
    """
    pitch_x, pitch_y = mask.pitch_cm
    x0, y0 = mask.origin_cm
    words = mask.words
    if words is not None:
        usual = pitch_x.__class__ is pitch_y.__class__ is x0.__class__ is y0.__class__ is float
        scan = scanned_packed.direct if usual else scanned_packed.call
        return quick_points(scan(words, mask.shape[1], pitch_x, pitch_y, x0, y0))
    values = mask.values
    if not values.flags.c_contiguous:
        values = np.ascontiguousarray(values)
    scanned = scanned_rows if values.shape[1] <= WIDEST else scanned_centres
    return quick_points(scanned.call(values, pitch_x, pitch_y, x0, y0))


def boundary_scan_stacked(mask: MaskStack) -> PointsStack:
    """Return the boundaries of several footprints."""
    n, rows, columns = mask.shape
    xy, starts = np.empty((2 * n * (rows + columns), 2)), np.empty(n + 1, np.int64)
    words, grid = mask.words, (*mask.pitch_cm, *mask.origin_cm)
    if words is not None:
        scanned_words.call(words, columns, *grid, xy, starts)
    else:
        scanned_each.call(mask.values, *grid, xy, starts)
    return PointsStack(xy[: starts[n]], starts)


def boundary_scan_linked() -> Linked:
    """Return the form for masks as machine code hands them on."""
    return Linked(scanned_parts, PointsParts, points_of)


boundary_scan.notice = several_parts  # type: ignore[attr-defined]
boundary_scan.stacked = boundary_scan_stacked  # type: ignore[attr-defined]
boundary_scan.linked = boundary_scan_linked  # type: ignore[attr-defined]


def seen_cells(mask: NDArray[np.bool_], scans: tuple[str, ...]) -> NDArray[np.bool_]:
    """Return the cells that any of the scans meets first, shape (rows, columns)."""
    rows, columns = mask.shape
    seen = np.zeros(mask.shape, dtype=np.bool_)
    if mask.size:
        r, c = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
        if "left" in scans:
            seen[r, mask.argmax(axis=1)[r]] = True
        if "right" in scans:
            seen[r, columns - 1 - mask[:, ::-1].argmax(axis=1)[r]] = True
        if "top" in scans:
            seen[mask.argmax(axis=0)[c], c] = True
        if "bottom" in scans:
            seen[rows - 1 - mask[::-1].argmax(axis=0)[c], c] = True
    return seen


def _scanned_centres(
    mask: NDArray[np.bool_], pitch_x: float, pitch_y: float, x0: float, y0: float
) -> NDArray[np.float64]:
    """Return the centres of the cells all four scans meet first, shape (N, 2), column by column."""
    columns, rows = np.nonzero(seen_cells(mask, ("left", "right", "top", "bottom")).T)
    return np.column_stack([x0 + (columns + 0.5) * pitch_x, y0 + (rows + 0.5) * pitch_y])


@compiled_twin_of(_scanned_centres)
def scanned_centres(
    mask: NDArray[np.bool_], pitch_x: float, pitch_y: float, x0: float, y0: float
) -> NDArray[np.float64]:
    """Do the same in loops: one pass over the rows, then the columns' cells in order."""
    rows, columns = mask.shape
    # Narrow counters, so that eight columns are updated by one instruction.
    top, bottom = np.full(columns, rows, dtype=np.int32), np.full(columns, -1, dtype=np.int32)
    # Rows whose left (right) end is in a column, as lists: first row there, next row of the same.
    left_first, right_first = np.full(columns, rows), np.full(columns, rows)
    left_next, right_next = np.full(rows + 1, rows), np.full(rows + 1, rows)
    for r in range(rows - 1, -1, -1):
        left, right = _first_on(mask[r]), columns - 1
        if left == columns:
            continue
        while not mask[r, right]:
            right -= 1
        left_next[r], left_first[left] = left_first[left], r
        right_next[r], right_first[right] = right_first[right], r
        for c in range(left, right + 1):
            on = mask[r, c]
            top[c] = r if on else top[c]
            bottom[c] = max(bottom[c], r if on else -1)
    centres = np.empty((2 * (rows + columns), 2))
    n = 0
    for c in range(columns):
        if bottom[c] < 0:
            continue
        x = x0 + (c + 0.5) * pitch_x
        r, last = int(top[c]), int(bottom[c])
        left, right = left_first[c], right_first[c]
        while r < rows:
            centres[n, 0], centres[n, 1] = x, y0 + (r + 0.5) * pitch_y
            n += 1
            if left <= r:
                left = left_next[left]
            if right <= r:
                right = right_next[right]
            following = min(left, right)
            r = last if r < last < following else following
    return centres[:n]


@compiled_twin_of(_scanned_centres)
def scanned_rows(
    mask: NDArray[np.bool_], pitch_x: float, pitch_y: float, x0: float, y0: float
) -> NDArray[np.float64]:
    """Do the same to a mask of at most 64 columns, each row packed into a machine word."""
    rows, columns = mask.shape
    words, seen = np.empty(rows, np.uint64), np.empty(rows, np.uint64)
    for r in range(rows):
        row, word = mask[r], np.uint64(0)
        for c in range(columns):
            word |= np.uint64(row[c]) << np.uint64(c)
        words[r] = word
    first_met(words, seen)
    place, centres = np.empty(columns + 1, np.int64), np.empty((2 * (rows + columns), 2))
    n = centres_of(seen, pitch_x, pitch_y, x0, y0, place, centres, 0)
    return centres[:n]


def _scanned_packed(
    words: NDArray[np.uint64], columns: int, pitch_x: float, pitch_y: float, x0: float, y0: float
) -> NDArray[np.float64]:
    """Do the same to a mask whose rows are packed, bit c being column c."""
    mask = packed_mask(words, columns, (1.0, 1.0), (0.0, 0.0), 0)
    return _scanned_centres(mask.values, pitch_x, pitch_y, x0, y0)


@compiled_twin_of(_scanned_packed)
def scanned_packed(
    words: NDArray[np.uint64], columns: int, pitch_x: float, pitch_y: float, x0: float, y0: float
) -> NDArray[np.float64]:
    """Do the same to a mask whose rows are packed, in loops."""
    rows = words.shape[0]
    within = np.uint64(0)
    for c in range(columns):
        within |= ONE << np.uint64(c)
    seen = np.empty(rows, np.uint64)
    first_met(words, seen)
    for r in range(rows):  # a bit beyond the columns would be counted beyond their room
        seen[r] &= within
    place, centres = np.empty(columns + 1, np.int64), np.empty((2 * (rows + columns), 2))
    n = centres_of(seen, pitch_x, pitch_y, x0, y0, place, centres, 0)
    return centres[:n]


@compiled_later
def scanned_parts(mask: MaskParts) -> tuple[bool, PointsParts]:
    """Do the same to the parts of a mask."""
    grid = mask.pitch_x, mask.pitch_y, mask.x0, mask.y0
    return True, PointsParts(scanned_packed(mask.words, mask.columns, *grid))


@compiled_later
def _first_on(row: NDArray[np.bool_]) -> int:
    """Return where the first on-cell is, the row's length if there is none."""
    start = 0
    while start + BLOCK <= row.shape[0]:
        any_on = False
        for c in range(start, start + BLOCK):  # without a way out: one or two instructions
            any_on |= row[c]
        if any_on:
            break
        start += BLOCK
    while start < row.shape[0] and not row[start]:
        start += 1
    return start


@compiled_later
def scanned_each(masks, pitch_x, pitch_y, x0, y0, xy, starts):  # type: ignore[no-untyped-def]
    """Write the boundaries of several masks one behind the other, and where each starts."""
    n = 0
    starts[0] = 0
    for k in range(masks.shape[0]):
        centres = scanned_centres(masks[k], pitch_x, pitch_y, x0, y0)
        for i in range(centres.shape[0]):
            xy[n, 0], xy[n, 1] = centres[i, 0], centres[i, 1]
            n += 1
        starts[k + 1] = n
