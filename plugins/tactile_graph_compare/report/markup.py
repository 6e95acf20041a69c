"""Make HTML and SVG text in which nothing that was handed in can be taken for markup."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import escape
from typing import TypeAlias

_VOID = {"meta", "br", "col", "image"}
_NOT_TEXT = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


class Html(str):
    """Text that is markup already, to be put in as it is."""

    __slots__ = ()


Child: TypeAlias = "str | Iterable[Child] | None"
"""What `tag` takes between its ends: text is escaped, `Html` is not, None is left out."""


def text(value: object) -> Html:
    """Return anything as text, safe between tags and in quoted attributes."""
    return Html(escape(_NOT_TEXT.sub("\ufffd", str(value)), quote=True))


def tag(name: str, /, *children: Child, **attributes: object) -> Html:
    """Return an element.

    Attributes are named as in Python: ``class_`` for ``class``, ``stroke_width`` for
    ``stroke-width``. True stands alone; None and False are left out.
    """
    told = "".join(_attribute(k, v) for k, v in attributes.items())
    inner = join(*children)
    if name in _VOID and not inner:
        return Html(f"<{name}{told}/>" if name == "image" else f"<{name}{told}>")
    return Html(f"<{name}{told}>{inner}</{name}>")


def _attribute(name: str, value: object) -> str:
    if value is None or value is False:
        return ""
    kept = name if name in ("viewBox", "preserveAspectRatio") else name.rstrip("_")
    kept = kept.replace("_", "-")
    if value is True:
        return f" {kept}"
    told = number(value) if isinstance(value, float) else text(value)
    return f' {kept}="{told}"'


def join(*children: Child) -> Html:
    """Return the children one after the other."""
    parts: list[str] = []
    for child in children:
        if child is None:
            continue
        if isinstance(child, str):
            parts.append(child if isinstance(child, Html) else text(child))
        else:
            parts.append(join(*child))
    return Html("".join(parts))


def number(value: float) -> str:
    """Return a coordinate, short."""
    told = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if told == "-0" else told
