"""The book's chapters: what each section states with its verdict, and its tables and figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from html import escape

from tactile_graph_thesis.making import Outcome
from tactile_graph_thesis.sections.judging import (
    COMES_OUT,
    DOES_NOT,
    FAILED,
    KINDS,
    Judged,
    counted,
    judged,
)
from tactile_graph_thesis.sections.reading import Chapter, Section, chapters

NO_PICTURE = (
    "The thesis' own drawing is not at hand, and none is made here: it shows what is built or "
    "defined, not what is measured."
)
NO_TABLE = "Objects or a data sheet's numbers: nothing to measure."
CLASSES = {COMES_OUT: "yes", DOES_NOT: "no", FAILED: "no"}
TOP = "<p class=up><a href=#summary>top</a></p>\n"


def found_by(found: Sequence[Outcome]) -> dict[str, Outcome]:
    """Return outcomes by the ids of their items.

    Parameters
    ----------
    found : sequence of Outcome
    """
    return {one.item.id: one for one in found}


def verdicts(found: Sequence[Outcome]) -> dict[str, int]:
    """Return how many statements of the whole text have each verdict.

    Parameters
    ----------
    found : sequence of Outcome
    """
    by = found_by(found)
    return counted(
        judged(claim, by)
        for chapter in chapters()
        for section in chapter.sections
        for claim in section.claims
    )


# -- what stands before the chapters ---------------------------------------------------------


def verdict_table(found: Sequence[Outcome]) -> str:
    """Return the count of verdicts by chapter and kind.

    Parameters
    ----------
    found : sequence of Outcome
    """
    by = found_by(found)
    rows = []
    for chapter in chapters():
        claims = [claim for section in chapter.sections for claim in section.claims]
        rows.append((chapter, counted(judged(claim, by) for claim in claims)))
    kinds = [kind for kind in KINDS if any(kind in counts for _, counts in rows)]
    head = "".join(f"<th>{escape(kind)}</th>" for kind in kinds)
    body = "".join(
        f"<tr><td>{_link(f'chapter-{c.number}', f'Chapter {c.number}')}</td>"
        f"{_counts(n, kinds)}</tr>\n"
        for c, n in rows
    )
    total = {kind: sum(n.get(kind, 0) for _, n in rows) for kind in kinds}
    return (
        "<h3>What the text states</h3>\n<div class=wide><table class=verdicts><thead><tr>"
        f"<th>statements</th>{head}<th>all</th></tr></thead>\n<tbody>{body}"
        f"<tr class=all><td>All</td>{_counts(total, kinds)}</tr>\n</tbody></table></div>\n"
    )


def _counts(counts: Mapping[str, int], kinds: Sequence[str]) -> str:
    cells = "".join(f"<td class=n>{counts.get(kind, 0) or '–'}</td>" for kind in kinds)
    return f"{cells}<td class=n>{sum(counts.values())}</td>"


def contents(found: Sequence[Outcome]) -> str:
    """Return the list of chapters and sections, with the items of each.

    Parameters
    ----------
    found : sequence of Outcome
    """
    by = found_by(found)
    placed = places(by)
    parts = ["<nav><h2>Contents</h2>\n"]
    for chapter in chapters():
        entries = "".join(
            f"<li>{_link(f'section-{s.number}', f'{s.number} {s.title}')}"
            f"{_items_of(placed[s.number], by)}</li>\n"
            for s in chapter.sections
        )
        parts.append(
            f"<details><summary>{_heading(chapter)}</summary>\n"
            f"<ul class=contents>\n{entries}</ul></details>\n"
        )
    return "".join((*parts, "</nav>\n"))


def _heading(chapter: Chapter) -> str:
    return _link(f"chapter-{chapter.number}", f"Chapter {chapter.number}: {chapter.title}")


def _link(name: str, words: str) -> str:
    return f'<a href="#{escape(name)}">{escape(words)}</a>'


def _items_of(names: Sequence[str], by: Mapping[str, Outcome]) -> str:
    words = ", ".join(_link(name, by[name].item.name) for name in names if name in by)
    return f"<br><small>{words}</small>" if words else ""


def places(by: Mapping[str, Outcome]) -> dict[str, list[str]]:
    """Return which items and captions stand in each section, every item once.

    An item that no section names stands in the last section of the text that comes before it.

    Parameters
    ----------
    by : mapping
        Item's id -> its outcome.
    """
    sections = [s for chapter in chapters() for s in chapter.sections]
    placed = {s.number: list(s.items) for s in sections}
    named = {name for names in placed.values() for name in names}
    for name, outcome in by.items():
        if name not in named:
            placed[_before(outcome.item.place[0], sections)].append(name)
    return placed


def _before(place: tuple[int, ...], sections: Sequence[Section]) -> str:
    numbers = [(tuple(map(int, s.number.split("."))), s.number) for s in sections]
    at_or_before = [name for number, name in numbers if number <= place]
    return at_or_before[-1] if at_or_before else numbers[0][1]


# -- a chapter -------------------------------------------------------------------------------


def chapter_pages(
    found: Sequence[Outcome],
    item_page: Callable[[Outcome, str], str],
    pipelines: Mapping[str, str],
) -> str:
    """Return all chapters.

    Parameters
    ----------
    found : sequence of Outcome
    item_page : callable
        From an outcome, and the caption of the thesis' figure or table, to its part of the page.
    pipelines : mapping
        Name -> text of the pipelines that the sections name.
    """
    by = found_by(found)
    placed = places(by)
    return "".join(_chapter(c, by, placed, item_page, pipelines) for c in chapters())


def _chapter(
    chapter: Chapter,
    by: Mapping[str, Outcome],
    placed: Mapping[str, Sequence[str]],
    item_page: Callable[[Outcome, str], str],
    pipelines: Mapping[str, str],
) -> str:
    parts = [
        f'<section class=chapter id="chapter-{chapter.number}">\n'
        f"<h2><span>{chapter.number}</span> {escape(chapter.title)}</h2>\n"
        f"<p>{escape(chapter.opening)}</p>\n"
    ]
    for section in chapter.sections:
        parts.append(_opening(section, by))
        parts += [_file(name, pipelines[name]) for name in section.pipelines if name in pipelines]
        captions = section.captions
        names = placed[section.number]
        parts += [item_page(by[name], captions.get(name, "")) for name in names if name in by]
        parts += _not_made({n: caption for n, caption in captions.items() if n not in by})
        parts.append(f"{TOP}</section>\n")
    return "".join((*parts, "</section>\n"))


def _opening(section: Section, by: Mapping[str, Outcome]) -> str:
    """Return a section's heading and what it states."""
    head = (
        f'<section class=part id="section-{section.number}">\n'
        f"<h3><span>{section.number}</span> {escape(section.title)}</h3>\n"
    )
    if not section.claims:
        return f"{head}<p class=note>States nothing to be tried: it {escape(section.none)}.</p>\n"
    rows = "".join(_statement(c.says, c.items, judged(c, by), by) for c in section.claims)
    return f"{head}<ul class=claims>\n{rows}</ul>\n"


def _statement(says: str, items: Iterable[str], verdict: Judged, by: Mapping[str, Outcome]) -> str:
    kind = CLASSES.get(verdict.verdict, "plain")
    links = ", ".join(_link(name, by[name].item.name) for name in items if name in by)
    because = escape("; ".join(verdict.because))
    if len(verdict.because) > 1:  # all of them stand with the items
        because = f"each of {len(verdict.because)}, see there"
    where = f"{links}: {because}" if links else because
    commands = " ".join(f"<code>{escape(command)}</code>" for command in verdict.commands[:3])
    more = " …" if len(verdict.commands) > 3 else ""
    return (
        f"<li><b class={kind}>{escape(verdict.verdict)}</b> {escape(_sentence(says))}"
        f"<br><small>{where}</small>"
        + (f"<br><small class=command>{commands}{more}</small>" if commands else "")
        + "</li>\n"
    )


def _sentence(words: str) -> str:
    return f"{words[:1].upper()}{words[1:]}."


def _file(name: str, text: str) -> str:
    return (
        f"<details class=file><summary>Pipeline <code>{escape(name)}</code></summary>\n"
        f"<pre>{escape(text)}</pre></details>\n"
    )


def _not_made(captions: Mapping[str, str]) -> list[str]:
    """Return what is said of figures and of tables that nothing here makes."""
    parts = []
    for kind, why in (("figure", NO_PICTURE), ("table", NO_TABLE)):
        told = [
            f'<span id="{escape(name)}"><b>{escape(name.replace("-", " "))}</b> '
            f"“{escape(caption)}”</span>"
            for name, caption in captions.items()
            if name.startswith(kind)
        ]
        if told:
            parts.append(f"<p class=lost>Not made: {', '.join(told)}. {why}</p>\n")
    return parts
