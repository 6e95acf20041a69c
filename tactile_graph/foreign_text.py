"""Text from names and files, made safe to show, to paste, and to open as a spreadsheet."""

from __future__ import annotations

import csv
import io
import os
import re
import shlex
import sys
from collections.abc import Iterable
from typing import Any

_HIDDEN = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f"  # control characters, ESC among them, but tab and new line
    "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # what turns the direction of the text around it
    "\u2028\u2029\ufeff\ufff9-\ufffb\ud800-\udfff\ufffe\uffff\U000e0000-\U000e007f]"
)
_ASCII_HIDDEN = bytes([*range(9), *range(11, 32), 127])
_SPECIAL = re.compile(r"[^\w.:/\\+=~-]")
"""What cmd.exe or PowerShell may take for more than a letter of a word."""
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def visible(text: str) -> str:
    r"""Return a text in which characters that are not seen, but act, stand as ``\u001b``.

    A terminal obeys them, and what shows text turns it round by them. JSON stays what it is: this
    is how it spells them.
    """
    if text.isascii():  # nearly all is, and is looked through in a tenth of the time
        raw = text.encode()
        if len(raw.translate(None, _ASCII_HIDDEN)) == len(raw):
            return text
    return _HIDDEN.sub(_spelled, text)


def tell(text: str) -> None:
    """Say a line on stderr at once, whatever command waits."""
    sys.stderr.write(visible(text) + "\n")
    sys.stderr.flush()


def _spelled(found: re.Match[str]) -> str:
    units = found[0].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[i : i + 4]}" for i in range(0, len(units), 4))


def pasted(word: str) -> str:
    r"""Return a word as a shell (bash, zsh, ksh) takes it for one, all of it seen.

    What is not seen, and bytes that are no UTF-8, stand as ``$'\377'``. On Windows it is in double
    quotes where it must be, as its programs take them (``subprocess.list2cmdline``).
    """
    if os.name == "nt":
        return _for_windows(visible(word))
    if visible(word) == word and "\n" not in word and "\t" not in word:
        return shlex.quote(word)
    return f"$'{''.join(map(_in_octal, word))}'"


def pasted_path(path: str) -> str:
    """Return a path likewise, and so that none is taken for an option."""
    return pasted(f"./{path}" if path.startswith("-") else path)


def pasted_words(words: Iterable[str]) -> str:
    """Return a command line of several words."""
    return " ".join(map(pasted, words))


def _for_windows(word: str) -> str:
    if word and not _SPECIAL.search(word):
        return word
    doubled = re.sub(r'(\\*)("|\Z)', lambda m: m[1] * 2 + m[2].replace('"', '\\"'), word)
    return f'"{doubled}"'


def _in_octal(character: str) -> str:
    if character in "'\\":
        return f"\\{character}"
    if visible(character) == character and character not in "\n\t":
        return character
    is_byte = "\udc80" <= character <= "\udcff"  # that is no UTF-8
    raw = character.encode("utf-8", "surrogateescape" if is_byte else "surrogatepass")
    return "".join(f"\\{byte:03o}" for byte in raw)


def html_text(text: str) -> str:
    """Return a text as it may stand in an element of HTML, or in a quoted attribute."""
    from html import escape  # only now: a command's help must not pay for it

    return escape(visible(text))


def csv_line(cells: Iterable[Any]) -> str:
    """Return a line of CSV; a text that a spreadsheet would run as a formula gets a ``'`` first."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(
        _unharmed(c) if isinstance(c, str) else c for c in cells
    )
    return text.getvalue()


def _unharmed(cell: str) -> str:
    formula = cell.lstrip(" ").startswith(_FORMULA) and not _is_number(cell)
    return visible(f"'{cell}" if formula else cell)


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True
