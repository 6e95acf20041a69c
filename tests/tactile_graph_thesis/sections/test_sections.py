"""What the text states: every section has an entry, and every entry something that stands."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from tactile_graph_thesis.catalogue import items
from tactile_graph_thesis.item import Finding, Item, Made
from tactile_graph_thesis.making import Outcome
from tactile_graph_thesis.sections.judging import (
    BUILT,
    COMES_OUT,
    DOES_NOT,
    FAILED,
    NOT_HERE,
    OPEN,
    SHOWN,
    counted,
    finding_of,
    judged,
)
from tactile_graph_thesis.sections.reading import Claim, Section, chapters, pipeline_texts

SECTIONS = """
2.1.1 2.1.2 2.2 2.2.1 2.2.2 2.2.3 2.3 2.3.1 2.3.2 2.4 2.4.1 2.4.2 2.4.3 2.5
3.1 3.1.1 3.1.2 3.1.3 3.1.4 3.1.5 3.1.6 3.2
4.1 4.2 4.2.1 4.2.2 4.2.3 4.2.4 4.2.5 4.2.6 4.2.7 4.2.8 4.3 4.3.1 4.3.2 4.3.3 4.3.4 4.3.5 4.3.6
4.3.7 4.3.8 4.3.9 4.4 4.4.1 4.4.2 4.4.3 4.5
5.1 5.1.1 5.1.2 5.1.3 5.2 5.2.1 5.2.2 5.2.3 5.3 5.3.1 5.3.2 5.4 5.4.1 5.4.2 5.5.1 5.5.2 5.6
6.1.1 6.1.2 6.1.3 6.1.4
"""
"""Every section of chapters 2 to 6 with a text of its own; 2.1, 5.5 and 6.1 are headings only."""
FIGURES = (
    *(f"2.{k}" for k in range(1, 20)),
    *(f"3.{k}" for k in range(1, 7)),
    *(f"4.{k}" for k in range(1, 44)),
    *(f"5.{k}" for k in range(1, 15)),
    "6.1",
)
TABLES = ("2.1", "2.2", *(f"4.{k}" for k in range(1, 11)), "5.1", "5.2")


def sections() -> list[Section]:
    return [section for chapter in chapters() for section in chapter.sections]


def claims() -> Iterator[tuple[str, Claim]]:
    for section in sections():
        for claim in section.claims:
            yield f"{section.number}: {claim.says}", claim


def test_every_section_has_an_entry_or_a_stated_reason() -> None:
    assert [section.number for section in sections()] == SECTIONS.split()
    for section in sections():
        assert bool(section.claims) != bool(section.none), section.number


def test_every_figure_and_table_of_the_thesis_stands_in_one_section_with_its_caption() -> None:
    figures = [n for section in sections() for n in section.figures]
    assert figures == list(FIGURES)
    assert [n for section in sections() for n in section.tables] == list(TABLES)
    captions = [c for section in sections() for c in section.captions.values()]
    assert all(captions)


def test_every_statement_is_held_against_one_thing_that_is_there() -> None:
    known = {item.id for item in items()}
    for where, claim in claims():
        said = [bool(claim.items), bool(claim.built), bool(claim.not_here), bool(claim.open)]
        assert sum(said) == 1, where
        assert {*claim.items} <= known, where
        assert bool(claim.command) == bool(claim.built), where
        assert claim.finding or not claim.against, where
        assert not claim.says.endswith("."), where


def test_items_that_a_section_places_are_there() -> None:
    known = {item.id for item in items()}
    for section in sections():
        assert {*section.studies} <= known, section.number


def test_the_pipelines_of_sections_are_on_offer_with_their_texts() -> None:
    texts = pipeline_texts()
    assert "circle-3" in texts
    assert texts["thesis-lines"].startswith("pipeline: thesis-lines")
    for name, text in texts.items():
        assert re.search(rf"^pipeline: {re.escape(name)}$", text, re.M)


def item(*findings: Finding, name: str = "x") -> Outcome:
    return Outcome(Item(name, "X", "Shown.", lambda _: Made()), Made(findings=findings))


UP = Finding("it goes up", "by 2", "a fall", True)
DOWN = Finding("it goes down", "by -2", "a rise", False)
Y_DOWN = Finding("it goes up", "by 0", "a fall", False)


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (Claim("a", ("x",), "goes up"), COMES_OUT),
        (Claim("a", ("x",), "goes down"), DOES_NOT),
        (Claim("a", ("x",), "goes up", against=True), DOES_NOT),
        (Claim("a", ("x",), "goes down", against=True), COMES_OUT),
        (Claim("a", ("x", "y"), "goes up"), DOES_NOT),
        (Claim("a", ("x",)), SHOWN),
        (Claim("a", ("x",), "goes"), FAILED),  # two findings: which is meant is not said
        (Claim("a", ("x",), "sideways"), FAILED),
        (Claim("a", ("gone",), "goes up"), FAILED),
        (Claim("a", built="so"), BUILT),
        (Claim("a", not_here="why"), NOT_HERE),
        (Claim("a", open="what"), OPEN),
    ],
)
def test_a_verdict_is_the_findings_and_all_items_must_agree(claim: Claim, verdict: str) -> None:
    found = {"x": item(UP, DOWN), "y": item(Y_DOWN)}
    assert judged(claim, found).verdict == verdict


def test_a_finding_that_begins_with_the_words_goes_before_one_that_holds_them() -> None:
    also = Finding("with drivers too it goes up", "by 1", "a fall", False)
    assert finding_of(Claim("a", ("x",), "it goes up"), item(also, UP)) is UP
    assert finding_of(Claim("a", ("x",), "drivers"), item(also, UP)) is also


def test_an_item_that_could_not_be_made_is_told_as_such() -> None:
    outcome = Outcome(Item("x", "X", "Shown.", lambda _: Made()), None, "oh")
    found = judged(Claim("a", ("x",), "goes up"), {"x": outcome})
    assert (found.verdict, found.because) == (FAILED, ("x",))
    assert found.commands == ("tactile-graph reproduce x",)


@pytest.mark.parametrize(
    ("claim", "verdict", "commands"),
    [
        (Claim("a", built="so", command="tactile-graph steps"), BUILT, ("tactile-graph steps",)),
        (Claim("a", not_here="hardware"), NOT_HERE, ()),
        (Claim("a", open="to do"), OPEN, ()),
    ],
)
def test_what_no_item_measures_says_why_and_what_shows_it(
    claim: Claim, verdict: str, commands: tuple[str, ...]
) -> None:
    found = judged(claim, {})
    assert (found.verdict, found.commands) == (verdict, commands)
    assert found.because == (claim.built or claim.not_here or claim.open,)


def test_verdicts_are_counted_by_kind_without_those_that_do_not_occur() -> None:
    told = [judged(c, {"x": item(UP)}) for c in (Claim("a", ("x",)), Claim("b", built="c"))]
    assert counted([*told, told[0]]) == {SHOWN: 2, BUILT: 1}
