"""The whole report: one HTML page that needs nothing but itself."""

from __future__ import annotations

from collections.abc import Iterator

from tactile_graph.errors import text_of
from tactile_graph_compare.output import tables
from tactile_graph_compare.records.comparison import Comparison
from tactile_graph_compare.report.album import Album
from tactile_graph_compare.report.markup import Html, section, tag
from tactile_graph_compare.report.report_section import ReportSection
from tactile_graph_compare.report.style import STYLE

POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"
"""What the page may load: nothing. A browser holds it to that."""
OFFERS = "report_sections"


def page(comparison: Comparison) -> str:
    """Return the report as HTML."""
    album = Album(comparison)
    made = [(name, one.title, _body(one, comparison, album)) for name, one in _sections()]
    shown = [(name, title, body) for name, title, body in made if body]
    links = (tag("li", tag("a", title, href=f"#{name}")) for name, title, _ in shown[1:])
    title = " · ".join(comparison.labels[:4]) + (" …" if len(comparison.labels) > 4 else "")
    told = tables.heading(comparison)
    body = tag(
        "body",
        album.defined(),
        tag("header", tag("h1", "Comparison"), tag("p", f"{told}."),
            tag("nav", tag("ul", links), aria_label="sections")),
        tag("main", (section(name, title, body) for name, title, body in shown)),
    )  # fmt: skip
    head = tag(
        "head",
        tag("meta", charset="utf-8"),
        tag("meta", name="viewport", content="width=device-width, initial-scale=1"),
        tag("meta", http_equiv="Content-Security-Policy", content=POLICY),
        tag("meta", name="color-scheme", content="light dark"),
        tag("title", f"Comparison: {title}"),
        tag("style", Html(STYLE)),
    )
    return f"<!doctype html>\n{tag('html', head, body, lang='en')}\n"


def _sections() -> Iterator[tuple[str, ReportSection]]:
    """Yield the name and the section of each on offer, in the order of the page."""
    from tactile_graph.plugins.registry import installed

    registry = installed()
    names = registry.offered(OFFERS)
    found: dict[str, ReportSection] = {name: registry.load(OFFERS, name) for name in names}
    yield from sorted(found.items(), key=lambda item: item[1].last)  # stable: as they were offered


def _body(one: ReportSection, comparison: Comparison, album: Album) -> Html | None:
    """Return what a section tells; the rest of the report does not fail with one of a plugin."""
    try:
        return one.body(comparison, album)
    except Exception as error:  # a plugin's own code may raise anything
        told = f"This section could not be made: {type(error).__name__}: {text_of(error)}"
        return tag("p", told, class_="note")
