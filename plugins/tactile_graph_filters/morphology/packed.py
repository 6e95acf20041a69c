"""Masks of which a row is one machine word: 64 cells are eroded or dilated by one instruction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later, compiled_twin_of
from tactile_graph.wires import Mask, packed_mask
from tactile_graph.wires.parts import MaskParts
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import Element
from tactile_graph_filters.morphology.erosion import BOOL

Words = NDArray[np.uint64]
_HALVES = (
    (np.uint64(16), np.uint64(0x0000FFFF0000FFFF)),
    (np.uint64(8), np.uint64(0x00FF00FF00FF00FF)),
    (np.uint64(4), np.uint64(0x0F0F0F0F0F0F0F0F)),
    (np.uint64(2), np.uint64(0x3333333333333333)),
    (np.uint64(1), np.uint64(0x5555555555555555)),
)
"""How far the upper half of each group of bits moves, and which bits are then left."""
_ONE, _TWO, _FOUR, _TOP = np.uint64(1), np.uint64(2), np.uint64(4), np.uint64(56)
_ODD = np.uint64(0x5555555555555555)
_PAIRS = np.uint64(0x3333333333333333)
_NIBBLES = np.uint64(0x0F0F0F0F0F0F0F0F)
_BYTES = np.uint64(0x0101010101010101)
_ALL = np.uint64(2**64 - 1)
WORD = np.dtype(np.uint64)
Cells = NDArray[np.bool_]
Around = NDArray[np.int64]
"""Of an element, for masks of one frame: row 0 is whether to dilate and how many rows it reaches,
the others are its cells, as (down, right) from its origin."""


def doubled(words: Words) -> Words:
    """Return words in which each of the lower 32 bits stands twice, shape as given."""
    spread = words.copy()
    for shift, kept in _HALVES:
        spread = (spread | (spread << shift)) & kept
    return spread | (spread << _ONE)


def combined(masks: MaskStack, element: Element, *, dilate: bool) -> MaskStack | None:
    """Return several masks eroded, or dilated, by an element; cells outside count as off.

    None where a row, or the element's, is wider than a word.
    """
    words = masks.words
    if words is None or element.reach[1] >= MaskStack.WIDEST:
        return None
    n, rows, columns = masks.shape
    out, counts = np.empty((n, rows), np.uint64), np.empty(n, np.int64)
    within = np.uint64((1 << columns) - 1)
    combined_each.call(words, element.offsets, dilate, within, out, counts)
    return MaskStack.packed(out, columns, masks.pitch_cm, masks.origin_cm, counts)


@compiled_later
def combined_each(words, offsets, dilate, within, out, counts):  # type: ignore[no-untyped-def]
    """Write the rows of several masks, each the AND (OR) of those that an element reaches."""
    rows = words.shape[1]
    none = np.uint64(0)
    for k in range(words.shape[0]):
        given, made = words[k], out[k]
        for r in range(rows):
            made[r] = none if dilate else within
        for i in range(offsets.shape[0]):
            down, right = offsets[i, 0], offsets[i, 1]
            low, high = min(rows, max(0, -down)), max(0, min(rows, rows - down))
            shift = np.uint64(abs(right))
            if dilate and right >= 0:
                for r in range(low, high):
                    made[r] |= given[r + down] >> shift
            elif dilate:
                for r in range(low, high):
                    made[r] |= given[r + down] << shift
            elif right >= 0:
                for r in range(low, high):
                    made[r] &= given[r + down] >> shift
            else:
                for r in range(low, high):
                    made[r] &= given[r + down] << shift
            for r in range(0 if dilate else low):  # an element reaches over the edge
                made[r] = none
            for r in range(rows if dilate else high, rows):
                made[r] = none
        count = 0
        for r in range(rows):
            x = made[r] & within
            made[r] = x
            x = x - ((x >> _ONE) & _ODD)
            x = (x & _PAIRS) + ((x >> _TWO) & _PAIRS)
            x = (x + (x >> _FOUR)) & _NIBBLES
            count += int((x * _BYTES) >> _TOP)
        counts[k] = count


def around(element: Element, *, dilate: bool) -> Around | None:
    """Return an element as kernels take it; None where it is wider than a word."""
    rows, columns = element.reach
    if columns >= Mask.WIDEST:
        return None
    table = np.array([(int(dilate), rows), *element.offsets.tolist()], np.int64)
    table.setflags(write=False)
    return table


def combined_mask(mask: Mask, element: Around) -> Mask | None:
    """Return a mask eroded, or dilated; cells outside count as off. None if it is too wide."""
    words = mask.words
    if words is None:
        values = mask.values
        rows, columns = values.shape
        if not 0 < columns <= Mask.WIDEST:
            return None
        out = np.empty(rows, WORD)
        usual = values.dtype is BOOL and values.flags.c_contiguous
        count = (combined_cells.direct if usual else combined_cells.call)(values, element, out)
    else:
        rows, columns = mask.shape
        out = np.empty(rows, WORD)
        count = combined_rows.direct(words, columns, element, out)
    return packed_mask(out, columns, mask.pitch_cm, mask.origin_cm, count)


def _rows_of(values: Cells) -> Words:
    """Return cells of shape (rows, columns) as words."""
    rows, columns = values.shape
    raw = np.zeros((rows, 8), np.uint8)
    raw[:, : -(-columns // 8)] = np.packbits(values, axis=-1, bitorder="little")
    return raw.view("<u8").reshape(rows).astype(WORD)


def _doubled_plain(values: Cells, out: Words) -> int:
    """Write each row of ``values`` into two of ``out``, each cell into two bits of a word.

    Returns how many cells are then on.
    """
    out[:] = np.repeat(doubled(_rows_of(values)), 2)
    return 4 * int(np.count_nonzero(values))


@compiled_twin_of(_doubled_plain)
def doubled_cells(values, out):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    count = 0
    for r in range(values.shape[0]):
        word = _word(values[r])
        count += ones(word)
        for shift, kept in _HALVES:
            word = (word | (word << shift)) & kept
        word |= word << _ONE
        out[2 * r] = word
        out[2 * r + 1] = word
    return 4 * count


@compiled_later
def ones(word):  # type: ignore[no-untyped-def]
    """Return how many bits of a word are 1."""
    x = word - ((word >> _ONE) & _ODD)
    x = (x & _PAIRS) + ((x >> _TWO) & _PAIRS)
    x = (x + (x >> _FOUR)) & _NIBBLES
    return int((x * _BYTES) >> _TOP)


@compiled_later
def doubled_parts(mask):  # type: ignore[no-untyped-def]
    """Do what `doubled_cells` does to the parts of a mask; not if it is wider than half a word."""
    fits = mask.columns <= 32
    rows = mask.words.shape[0] if fits else 0
    out = np.empty(2 * rows, np.uint64)
    for r in range(rows):
        word = mask.words[r]
        for shift, kept in _HALVES:
            word = (word | (word << shift)) & kept
        word |= word << _ONE
        out[2 * r] = word
        out[2 * r + 1] = word
    pitch_x, pitch_y = mask.pitch_x / 2, mask.pitch_y / 2
    columns, count = 2 * mask.columns, 4 * mask.count
    return fits, MaskParts(out, columns, pitch_x, pitch_y, mask.x0, mask.y0, count)


@compiled_later
def _word(row):  # type: ignore[no-untyped-def]
    """Return a row of cells as a word."""
    word = np.uint64(0)
    for c in range(row.shape[0]):
        word |= np.uint64(row[c]) << np.uint64(c)
    return word


def _combined_plain(words: Words, columns: int, element: Around, out: Words) -> int:
    """Write rows each the AND (OR) of those that an element reaches; return how many cells are on.

    ``words`` and ``out`` are of shape (rows,).
    """
    dilate, reach = element[0].tolist()
    rows, within = len(words), np.uint64((1 << columns) - 1)
    given = np.zeros(rows + 2 * reach, WORD)
    given[reach : reach + rows] = words
    out[:] = 0 if dilate else within
    for down, right in element[1:].tolist():
        there = given[reach + down : reach + down + rows]
        there = there >> np.uint64(right) if right >= 0 else there << np.uint64(-right)
        out[:] = out | there if dilate else out & there
    out &= within
    return int(np.unpackbits(out.view(np.uint8)).sum())


@compiled_twin_of(_combined_plain)
def combined_rows(words, columns, element, out):  # type: ignore[no-untyped-def]
    """Do the same in loops."""
    given = _with_margin(words.shape[0], element[0, 1])
    for r in range(words.shape[0]):
        given[element[0, 1] + r] = words[r]
    return _combined_into(given, columns, element, out)


@compiled_later
def combined_parts(mask, element):  # type: ignore[no-untyped-def]
    """Do the same to the parts of a mask: the linked form of steps that have an element."""
    out = np.empty(mask.words.shape[0], np.uint64)
    count = combined_rows(mask.words, mask.columns, element, out)
    grid = mask.pitch_x, mask.pitch_y, mask.x0, mask.y0
    return True, MaskParts(out, mask.columns, grid[0], grid[1], grid[2], grid[3], count)


def _combined_cells_plain(values: Cells, element: Around, out: Words) -> int:
    """Do the same to cells, shape (rows, columns)."""
    return _combined_plain(_rows_of(values), values.shape[1], element, out)


@compiled_twin_of(_combined_cells_plain)
def combined_cells(values, element, out):  # type: ignore[no-untyped-def]
    """Do the same to cells in loops."""
    given = _with_margin(values.shape[0], element[0, 1])
    for r in range(values.shape[0]):
        given[element[0, 1] + r] = _word(values[r])
    return _combined_into(given, values.shape[1], element, out)


@compiled_later
def _with_margin(rows, reach):  # type: ignore[no-untyped-def]
    """Return room for rows, with empty ones above and below."""
    given = np.empty(rows + 2 * reach, np.uint64)
    for r in range(reach):
        given[r] = np.uint64(0)
        given[reach + rows + r] = np.uint64(0)
    return given


@compiled_later
def _combined_into(given, columns, element, out):  # type: ignore[no-untyped-def]
    """Combine rows that stand within a margin; return how many cells are on."""
    rows, reach, dilate = out.shape[0], element[0, 1], element[0, 0] != 0
    within = _ALL >> np.uint64(64 - columns)
    for r in range(rows):
        out[r] = np.uint64(0) if dilate else within
    for i in range(1, element.shape[0]):
        there, right = given[reach + element[i, 0] :], element[i, 1]
        shift = np.uint64(abs(right))
        if dilate and right >= 0:
            for r in range(rows):
                out[r] |= there[r] >> shift
        elif dilate:
            for r in range(rows):
                out[r] |= there[r] << shift
        elif right >= 0:
            for r in range(rows):
                out[r] &= there[r] >> shift
        else:
            for r in range(rows):
                out[r] &= there[r] << shift
    count = 0
    for r in range(rows):
        out[r] &= within
        count += ones(out[r])
    return count
