"""Masks of which a row is one machine word: 64 cells are eroded or dilated by one instruction."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tactile_graph.compiled import compiled_later
from tactile_graph.wires.stacks import MaskStack
from tactile_graph_filters.morphology.elements import Element

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
