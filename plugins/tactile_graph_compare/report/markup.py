"""Make HTML and SVG text in which nothing that was handed in can be taken for markup."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from typing import TypeAlias

from tactile_graph.foreign_text import visible

_VOID = {"meta", "br", "col", "image"}


class Html(str):
    """Text that is markup already, to be put in as it is."""

    __slots__ = ()


Child: TypeAlias = "str | Iterable[Child] | None"
"""What `tag` takes between its ends: text is escaped, `Html` is not, None is left out."""


def text(value: object) -> Html:
    """Return anything as text, safe between tags and in quoted attributes."""
    return Html(escape(visible(str(value)), quote=True))


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


def section(name: str, title: str, *children: Child) -> Html:
    """Return a section with its heading; ``name`` is where links lead."""
    return tag("section", tag("h2", title), *children, id=name)


def plots(*found: Html | None) -> Html | None:
    """Return plots side by side as far as there is room; None without any."""
    shown = [f for f in found if f is not None]
    return tag("div", shown, class_="plots") if shown else None


def figure(drawn: Html | None, caption: Child, kind: str = "") -> Html | None:
    """Return a plot with its caption; None without a plot."""
    if drawn is None:
        return None
    return tag("figure", drawn, tag("figcaption", caption), class_=kind or None)


def scroll(name: str, *children: Child) -> Html:
    """Return something wide in a frame of its own, which a finger or a key can move."""
    return tag("div", *children, class_="scroll", role="region", aria_label=name, tabindex=0)


def details(title: Child, *children: Child, shown: bool = False, name: str = "") -> Html:
    """Return what is folded away until asked for; on paper it is open."""
    return tag("details", tag("summary", title), *children, open=shown, id=name or None)


def counted(n: int, noun: str) -> str:
    """Return ``1 frame`` or ``2 frames``."""
    return f"{n} {noun}{'' if n == 1 else 's'}"
