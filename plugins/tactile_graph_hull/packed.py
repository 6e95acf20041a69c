"""The boundary of footprints of which a row is one machine word."""

from __future__ import annotations

import numpy as np

from tactile_graph.compiled import compiled_later

_ONE, _HASH, _TOP = np.uint64(1), np.uint64(0x03F79D71B4CB0A89), np.uint64(58)
_SHIFTS = tuple(np.uint64(1 << k) for k in range(6))
_PLACE = np.empty(64, np.int64)
for _k in range(64):
    _PLACE[(((1 << _k) * int(_HASH)) & (2**64 - 1)) >> 58] = _k
"""Where a word's only bit is, by the top of its product with `_HASH`, which no two share."""


@compiled_later
def highest(word):  # type: ignore[no-untyped-def]
    """Return a word of the highest bit of a word; 0 of 0."""
    below = word
    for shift in _SHIFTS:
        below |= word >> shift
        word = below
    return below ^ (below >> _ONE)


@compiled_later
def first_met(words, seen):  # type: ignore[no-untyped-def]
    """Write into ``seen`` the cells of a mask's rows that are met first from any of four sides."""
    rows = words.shape[0]
    above = below = np.uint64(0)
    for r in range(rows):
        word = words[r]
        seen[r] = highest(word) | (word & (~word + _ONE)) | (word & ~above)
        above |= word
    for r in range(rows - 1, -1, -1):
        word = words[r]
        seen[r] |= word & ~below
        below |= word


@compiled_later
def centres_of(seen, pitch_x, pitch_y, x0, y0, place, xy, n):  # type: ignore[no-untyped-def]
    """Write the centres of cells behind the first ``n`` of ``xy``, by rising x, then y.

    ``place`` is room for a number more than there are columns. Returns how many there are then.
    """
    columns = place.shape[0] - 1
    for c in range(columns + 1):
        place[c] = 0
    for r in range(seen.shape[0]):
        left = seen[r]
        while left:
            bit = left & (~left + _ONE)
            place[_PLACE[(bit * _HASH) >> _TOP] + 1] += 1
            left ^= bit
    place[0] = n
    for c in range(columns):
        place[c + 1] += place[c]
    n = place[columns]
    for r in range(seen.shape[0]):
        left = seen[r]
        while left:
            bit = left & (~left + _ONE)
            c = _PLACE[(bit * _HASH) >> _TOP]
            xy[place[c], 0] = x0 + (c + 0.5) * pitch_x
            xy[place[c], 1] = y0 + (r + 0.5) * pitch_y
            place[c] += 1
            left ^= bit
    return n


@compiled_later
def scanned_words(words, columns, pitch_x, pitch_y, x0, y0, xy, starts):  # type: ignore[no-untyped-def]
    """Do what `scanned_each` does to masks of at most 64 columns, by their rows."""
    seen = np.empty(words.shape[1], np.uint64)
    place = np.empty(columns + 1, np.int64)
    n = 0
    starts[0] = 0
    for k in range(words.shape[0]):
        first_met(words[k], seen)
        n = centres_of(seen, pitch_x, pitch_y, x0, y0, place, xy, n)
        starts[k + 1] = n
