"""The book as one HTML page with everything inside it."""

from __future__ import annotations

import base64
import re
from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path

from tactile_graph_thesis.book.summary import NEAR_PERCENT, all_told, conclusions, table_lines
from tactile_graph_thesis.book.text import number
from tactile_graph_thesis.item import Compared, Finding
from tactile_graph_thesis.making import Outcome

STYLE = Path(__file__).parent / "book.css"
BROAD, TALL = 1.8, 1.3
"""Width by height from which a picture is broad, and up to which it is tall."""
NEAR = f"within {', '.join(map(str, NEAR_PERCENT))} %"
TITLE = "The thesis' tables and figures, made again"


def page(found: Sequence[Outcome], pictures: Mapping[str, bytes], how: Mapping[str, str]) -> str:
    """Return the book.

    Parameters
    ----------
    found : sequence of Outcome
    pictures : mapping
        Item's id -> its figure as SVG.
    how : mapping
        How the book was made: name -> value.
    """
    sections = "\n".join(_section(o, pictures.get(o.item.id)) for o in found)
    style = STYLE.read_text(encoding="utf-8")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{TITLE}</title>\n<style>\n{style}</style>\n</head>\n<body>\n<header>\n"
        f"<h1>{TITLE}</h1>\n<p>Ours beside the thesis', the ratio of the two, and where they "
        "differ, why. Everything here is computed on a simulated pad whose truth is known.</p>\n"
        f"{_how(how)}</header>\n<main>\n{_summary(found)}{_contents(found)}{sections}\n"
        "</main>\n</body>\n</html>\n"
    )


def _how(how: Mapping[str, str]) -> str:
    rows = "".join(f"<dt>{escape(k)}</dt><dd>{escape(v)}</dd>" for k, v in how.items())
    return f"<dl class=how>{rows}</dl>\n"


# -- what stands before the items ------------------------------------------------------------


def _summary(found: Sequence[Outcome]) -> str:
    parts = ["<section id=summary><h2>Summary</h2>\n"]
    lines = table_lines(found)
    if lines:
        rows = [
            [
                _link(x.id, x.name),
                escape(x.title),
                str(x.averages),
                str(x.maxima),
                f"{x.within} of {x.with_range}" if x.with_range else "–",
            ]
            for x in lines
        ]
        rows.append(["", "together", *map(str, all_told(lines)), ""])
        heads = ("", "", f"averages {NEAR}", f"maxima {NEAR}", "thesis' within our range")
        parts.append(_grid(heads, rows, text=2))
    parts += _counted(conclusions(found))
    failed = [o for o in found if o.made is None]
    if failed:
        parts.append("<p class=failed>Could not be made:</p>\n<ul>")
        parts += [f"<li>{_link(o.item.id, o.item.name)}: {escape(o.error)}</li>\n" for o in failed]
        parts.append("</ul>\n")
    return "".join(parts) + "</section>\n"


def _counted(told: Sequence[tuple[Outcome, Finding]]) -> list[str]:
    """Return how many conclusions come out, and those that do not."""
    if not told:
        return []
    holding = f"<p>{sum(f.holds for _, f in told)} of {len(told)} conclusions come out."
    failing = [
        f"<li>{_link(o.item.id, o.item.name)}: {escape(f.thesis)}. Here: {escape(f.found)}.</li>\n"
        for o, f in told
        if not f.holds
    ]
    if not failing:
        return [holding, "</p>\n"]
    return [holding, " These do not:</p>\n<ul>", *failing, "</ul>\n"]


def _contents(found: Sequence[Outcome]) -> str:
    entries = "".join(
        f"<li>{_link(o.item.id, o.item.name)} {escape(o.item.title)}</li>\n" for o in found
    )
    return f"<nav><h2>Contents</h2>\n<ul class=contents>\n{entries}</ul></nav>\n"


# -- an item ---------------------------------------------------------------------------------


def _section(outcome: Outcome, svg: bytes | None) -> str:
    item, made = outcome.item, outcome.made
    parts = [
        f'<section class=item id="{escape(item.id)}">\n'
        f"<h2><span>{escape(item.name)}</span> {escape(item.title)}</h2>\n"
        f"<p>{escape(item.shows)}</p>\n"
    ]
    if made is None:
        parts.append(f"<p class=failed>Could not be made: {escape(outcome.error)}</p>\n")
    else:
        if svg is not None:
            parts.append(_picture(svg, f"{item.name}: {item.title}"))
        if made.compared:
            parts.append(_compared(made.compared))
        if made.findings:
            parts.append(_findings(made.findings))
        parts += [f"<p class=note>{escape(note)}</p>\n" for note in made.notes]
    if item.why:
        parts.append(f"<p class=why><b>Where we differ, and why.</b> {escape(item.why)}</p>\n")
    return "".join(parts) + "<p class=up><a href=#summary>top</a></p></section>\n"


def _picture(svg: bytes, words: str) -> str:
    data = base64.b64encode(svg).decode()
    kind = f" class={name}" if (name := _kind(svg)) else ""
    source = f"data:image/svg+xml;base64,{data}"
    return f'<figure{kind}><img alt="{escape(words)}" src="{source}"></figure>\n'


def _kind(svg: bytes) -> str:
    """Return whether a picture is too broad for a phone, or too tall for half a printed page."""
    box = re.search(rb'viewBox="([^"]*)"', svg)
    width, height = (float(v) for v in box[1].split()[2:]) if box else (1.0, 1.0)
    return "broad" if width > BROAD * height else "tall" if width < TALL * height else ""


def _compared(compared: Sequence[Compared]) -> str:
    ranged = any(c.low is not None for c in compared)
    heads = ["", "unit", "ours", *(["nine in ten of ours"] if ranged else []), "thesis", "ratio"]
    rows = []
    for c in compared:
        thesis = "–" if c.thesis is None else ("&lt; " if c.limit else "") + f"{c.thesis:g}"
        between = [f"{number(c.low)} – {number(c.high)}"] if ranged else []
        rows.append(
            [escape(c.what), escape(c.unit), number(c.ours), *between, thesis, number(c.ratio)]
        )
    return _grid(heads, rows, text=2)


def _findings(findings: Sequence[Finding]) -> str:
    rows = []
    for f in findings:
        mark = "<b class=yes>comes out</b>" if f.holds else "<b class=no>does not come out</b>"
        rows.append(
            f"<li>{escape(f.thesis)}: {mark}<br><span>{escape(f.found)}</span>"
            f"<br><small>What would refute it: {escape(f.refuted_by)}.</small></li>\n"
        )
    return f"<ul class=findings>{''.join(rows)}</ul>\n"


def _grid(heads: Sequence[str], rows: Sequence[Sequence[str]], text: int) -> str:
    """Return a table; the first ``text`` columns are words, the others numbers."""
    head = "".join(f"<th>{h}</th>" for h in heads)
    body = "".join(
        "<tr>"
        + "".join(f"<td{'' if k < text else ' class=n'}>{c}</td>" for k, c in enumerate(row))
        + "</tr>\n"
        for row in rows
    )
    table = f"<table><thead><tr>{head}</tr></thead>\n<tbody>{body}</tbody></table>"
    return f"<div class=wide>{table}</div>\n"


def _link(name: str, words: str) -> str:
    return f'<a href="#{escape(name)}">{escape(words)}</a>'
