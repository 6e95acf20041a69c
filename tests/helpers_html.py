"""Read HTML strictly: every element closed in order, every attribute kept."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from html.parser import HTMLParser

VOID = {"meta", "br", "col", "img", "link"}


@dataclass
class Element:
    """An element with its attributes, the text right in it and its children."""

    name: str
    attributes: dict[str, str]
    children: list[Element] = field(default_factory=list)
    pieces: list[str] = field(default_factory=list)

    def all(self, name: str = "", class_: str = "") -> list[Element]:
        """Return descendants of a name, or of a class, in order."""
        found = []
        for child in self.children:
            classes = child.attributes.get("class", "").split()
            if (not name or child.name == name) and (not class_ or class_ in classes):
                found.append(child)
            found += child.all(name, class_)
        return found

    def one(self, name: str = "", class_: str = "", id: str = "") -> Element:
        """Return the only one."""
        found = self.all(name, class_)
        found = [e for e in found if not id or e.attributes.get("id") == id]
        assert len(found) == 1, f"{len(found)} of {name}.{class_}#{id}"
        return found[0]

    @property
    def text(self) -> str:
        """All text in it, spaces run together."""
        return re.sub(r"\s+", " ", "".join(self._texts())).strip()

    def _texts(self) -> list[str]:
        # `pieces` holds a mark where each child stands.
        children = iter(self.children)
        found: list[str] = []
        for piece in self.pieces:
            found += next(children)._texts() if piece == "\x00" else [piece]
        return found


class _Reader(HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.root = Element("", {})
        self.open = [self.root]

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        names = [k for k, _ in attrs]
        assert len(set(names)) == len(names), f"<{tag}>: an attribute twice: {names}"
        element = self._add(tag, attrs)
        if tag not in VOID:
            self.open.append(element)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._add(tag, attrs)

    def _add(self, tag: str, attrs: list[tuple[str, str | None]]) -> Element:
        element = Element(tag, {k: v or "" for k, v in attrs})
        self.open[-1].children.append(element)
        self.open[-1].pieces.append("\x00")
        return element

    def handle_endtag(self, tag: str) -> None:
        assert self.open[-1].name == tag, f"</{tag}> closes <{self.open[-1].name}>"
        self.open.pop()

    def handle_data(self, data: str) -> None:
        assert "\x00" not in data
        self.open[-1].pieces.append(data)


def read_html(text: str) -> Element:
    """Return the root of a page; an element not closed or closed twice is an error."""
    reader = _Reader()
    reader.feed(text)
    reader.close()
    assert reader.open == [reader.root], [e.name for e in reader.open]
    return reader.root
