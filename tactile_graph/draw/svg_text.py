"""Lines of text in a drawing: how wide they are at most, and how SVG spells them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from xml.sax.saxutils import escape, quoteattr

TITLE_PX = 13.0
SMALL_PX = 11.0
LINE_PX = 15.0
INK, SOFT = "#16202e", "#46546a"
_NOT_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


@dataclass(frozen=True)
class Line:
    """A line of text and how it is set."""

    text: str
    size: float = SMALL_PX
    bold: bool = False
    italic: bool = False
    ink: str = SOFT

    @property
    def width(self) -> float:
        """In pixels, at most."""
        return text_width(self.text, self.size) * (1.08 if self.bold else 1.0)


def text_width(text: str, size: float) -> float:
    """Return about how wide a text is at most, in pixels, whichever sans-serif font is there."""
    return size * sum(_em(c) for c in text)


def _em(char: str) -> float:
    if char in "iljtfrI.,:;|!'()[]{}/ -":
        return 0.37
    if char in "mwMW@%":
        return 0.97
    if ord(char) > 0x2E7F:
        return 1.05
    return 0.72 if char.isupper() or ord(char) > 0x7F else 0.62


def px(value: float) -> str:
    """Return a length, a tenth of a pixel being fine enough."""
    return f"{value:.1f}".removesuffix(".0")


def escaped(text: str) -> str:
    """Return a text as it may stand in an element."""
    return escape(_NOT_XML.sub("\ufffd", text))


def quoted(text: str) -> str:
    """Return a text as the value of an attribute, quotes and all."""
    return quoteattr(_NOT_XML.sub("\ufffd", text))
