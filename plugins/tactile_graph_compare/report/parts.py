"""Pieces of the page that several sections are made of."""

from __future__ import annotations

from tactile_graph_compare.report.markup import Child, Html, tag


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
