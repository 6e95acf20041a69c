"""What stands in place of characters that an output's encoding has not: the nearest in ASCII."""

from __future__ import annotations

import codecs
import sys
from typing import TextIO

ERRORS = "tactile_graph.readable"
"""The name by which codecs know it."""
_NEAREST = {
    "…": "...", "×": "x", "·": ".", "•": "*", "★": "*", "▼": "v", "°": "deg", "ß": "ss",
    "±": "+-", "≥": ">=", "≤": "<=", "→": "->", "←": "<-", "↔": "<->",
    "µ": "u", "μ": "u", "Ω": "Ohm", "\N{OHM SIGN}": "Ohm",
    "\N{HYPHEN}": "-", "\N{EN DASH}": "-", "\N{EM DASH}": "-", "\N{MINUS SIGN}": "-",
    "\N{LEFT SINGLE QUOTATION MARK}": "'", "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "“": '"', "”": '"',
    **dict.fromkeys("─━═╌╍┄┅┈┉╴╶╸╺╼╾", "-"),
    **dict.fromkeys("│┃║╎╏┆┇┊┋╵╷╹╻╽╿", "|"),
    **{chr(corner): "+" for corner in range(0x250C, 0x254C)},
    **{chr(corner): "+" for corner in range(0x2552, 0x2574)},
    **{chr(block): "#" for block in range(0x2580, 0x25A0)},
    **{chr(dots): "*" for dots in range(0x2801, 0x2900)},
}  # fmt: skip
_UNTOUCHED = ("strict", "surrogateescape")
"""How Python opens a stream for which nobody asked for anything else."""


def readable(text: str, encoding: str | None) -> str:
    """Return a text with what an encoding has not, None for one of any character, replaced."""
    if encoding is None or text.isascii() or _is_utf(encoding):
        return text
    return text.encode(encoding, ERRORS).decode(encoding)


def open_readable(stream: TextIO, left: tuple[str, ...] = _UNTOUCHED) -> None:
    """Have a stream write what its encoding has not as `readable` does, and go on.

    Parameters
    ----------
    stream : file object
    left : tuple of str
        The error handlers in whose place that is done; another was somebody's choice.
    """
    encoding, reconfigure = encoding_of(stream), getattr(stream, "reconfigure", None)
    if reconfigure and encoding and not _is_utf(encoding) and stream.errors in left:
        reconfigure(errors=ERRORS)


def open_all_readable() -> None:
    """Do so with stdout and stderr, for which Python itself chooses backslashes."""
    open_readable(sys.stdout)
    open_readable(sys.stderr, (*_UNTOUCHED, "backslashreplace"))


def encoding_of(stream: TextIO) -> str | None:
    """Return how a stream spells characters; None where it takes any, as in memory."""
    return getattr(stream, "encoding", None)


def _is_utf(encoding: str) -> bool:
    return codecs.lookup(encoding).name.startswith("utf")


def _replaced(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(map(_nearest, error.object[error.start : error.end])), error.end


def _nearest(character: str) -> str:
    """Return what is read for a character: of a letter with marks, the letter."""
    if character in _NEAREST or character.isascii():
        return _NEAREST.get(character, character)
    from unicodedata import category, normalize  # only now: nearly nobody needs it

    parts = [part for part in normalize("NFKD", character) if category(part) != "Mn"]
    return "?" if parts in ([], [character]) else "".join(map(_nearest, parts))


codecs.register_error(ERRORS, _replaced)
