"""``chapters``: every section of the thesis' text with what it states, from the YAML files here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
CHAPTERS = (2, 3, 4, 5, 6)


@dataclass(frozen=True)
class Claim:
    """A statement of the text, in our words, and what it is held against.

    One of ``items``, ``built``, ``not_here`` and ``open`` says what becomes of it.

    Parameters
    ----------
    says : str
    items : tuple of str
        Ids of the items that measure or show it.
    finding : str
        Words in the finding, of each of the items, that tells whether it comes out; empty where
        an item only shows it.
    against : bool
        Whether a finding that comes out contradicts it.
    built : str
        How it holds by the way things are made here.
    not_here : str
        Why nothing here can measure it.
    open : str
        What is missing to measure it, which could be done.
    command : str
        What shows it, where no item does.
    """

    says: str
    items: tuple[str, ...] = ()
    finding: str = ""
    against: bool = False
    built: str = ""
    not_here: str = ""
    open: str = ""
    command: str = ""


@dataclass(frozen=True)
class Section:
    """A section of the text.

    Parameters
    ----------
    number, title : str
    claims : tuple of Claim
    none : str
        Why it has none.
    figures, tables : mapping
        Those that stand in it: number -> what its caption says.
    studies : tuple of str
        Ids of our items that belong to it and are neither.
    pipelines : tuple of str
        Those that its items are made with.
    """

    number: str
    title: str
    claims: tuple[Claim, ...]
    none: str
    figures: Mapping[str, str]
    tables: Mapping[str, str]
    studies: tuple[str, ...]
    pipelines: tuple[str, ...]

    @property
    def captions(self) -> dict[str, str]:
        """Return ``figure-4.5`` and ``table-4.3`` with their captions."""
        figures = {f"figure-{n}": caption for n, caption in self.figures.items()}
        return figures | {f"table-{n}": caption for n, caption in self.tables.items()}

    @property
    def items(self) -> tuple[str, ...]:
        """Return the ids that may stand in it: studies, figures, tables."""
        return (*self.studies, *self.captions)


@dataclass(frozen=True)
class Chapter:
    """A chapter of the text.

    Parameters
    ----------
    number : int
    title : str
    opening : str
        What it is about, in a sentence.
    sections : tuple of Section
    """

    number: int
    title: str
    opening: str
    sections: tuple[Section, ...]


@cache
def chapters() -> tuple[Chapter, ...]:
    """Return chapters 2 to 6."""
    return tuple(_chapter(number) for number in CHAPTERS)


def pipeline_texts() -> dict[str, str]:
    """Return the files of the pipelines that sections name, name -> text."""
    from tactile_graph.plugins.registry import installed

    found = installed()
    names = {name for chapter in chapters() for s in chapter.sections for name in s.pipelines}
    files = {name: Path(found.offer("pipelines", name).target) for name in sorted(names)}
    return {name: file.read_text(encoding="utf-8") for name, file in files.items()}


def _chapter(number: int) -> Chapter:
    import yaml

    data = yaml.safe_load((FOLDER / f"chapter_{number}.yaml").read_text(encoding="utf-8"))
    sections = tuple(map(_section, data["sections"]))
    return Chapter(data["chapter"], data["title"], data["opening"], sections)


def _section(data: Mapping[str, Any]) -> Section:
    return Section(
        data["section"],
        data["title"],
        tuple(map(_claim, data.get("claims", ()))),
        data.get("none", ""),
        data.get("figures", {}),
        data.get("tables", {}),
        tuple(data.get("studies", ())),
        tuple(data.get("pipelines", ())),
    )


def _claim(data: Mapping[str, Any]) -> Claim:
    told = dict(data)
    item = told.pop("item", ())
    return Claim(items=(item,) if isinstance(item, str) else tuple(item), **told)
