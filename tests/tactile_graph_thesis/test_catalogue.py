"""The catalogue: every figure and table that an algorithm makes is there and is found by name."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

from tactile_graph.errors import UsageError
from tactile_graph_thesis.catalogue import CONTENTS, chosen, items

TABLES = ("4.3", "4.4", "4.5", "4.7", "4.8", "4.9", "5.2")
FIGURES = (
    *("2.2", *(f"2.{k}" for k in range(8, 20))),
    *("3.2", "3.5", "3.6"),
    *(f"4.{k}" for k in range(1, 44)),
    *(f"5.{k}" for k in range(8, 15)),
)
WISHES = (
    *("subpixel", "noise-algorithms", "noise-circles", "noise-rectangles"),
    "direct-ellipse",
)
SCHEDULE = ("annealing", "state-space")
TEXT = ("coupling-directions", "morphology", "broken-image", "line-patterns", "finer-pad")
CLAIMS = (
    *("current-limit", "stack-order", "boundary-operators", "variable-threshold"),
    *("residual-voltages", "erased-discs", "rotation-order", "one-pad", "erased-rectangles"),
    *("noisy-rectangles", "heavier-side", "site-isolation", "hysteresis", "heavier-smaller"),
)
RESTORED = ("restoration-filters", "noise-models", "load-prior")
STUDIES = ("converter", "samples", *TEXT, *SCHEDULE, *CLAIMS, *WISHES, *RESTORED)


def test_every_table_and_figure_is_there_once() -> None:
    expected = [*(f"table-{n}" for n in TABLES), *(f"figure-{n}" for n in FIGURES), *STUDIES]
    assert sorted(i.id for i in items()) == sorted(expected)


def test_the_order_is_that_of_the_thesis() -> None:
    ids = [i.id for i in items()]
    figures = [i for i in ids if i.startswith("figure")]
    assert figures == sorted(figures, key=lambda i: [int(p) for p in i[7:].split(".")])
    for table, before, after in (
        ("table-4.3", "figure-4.12", "figure-4.13"),
        ("table-4.5", "figure-4.20", "figure-4.21"),
        ("annealing", "figure-4.43", "figure-5.8"),
        ("table-5.2", "figure-5.13", "figure-5.14"),
    ):
        assert ids.index(before) < ids.index(table) < ids.index(after)
    assert tuple(ids[:4]) == ("hysteresis", "figure-2.2", "current-limit", "converter")
    last = (*WISHES, *RESTORED)
    assert tuple(ids[-len(last) :]) == last


def test_a_number_is_both_the_table_and_the_figure() -> None:
    assert [i.id for i in chosen(("4.5",))] == ["figure-4.5", "table-4.5"]
    assert [i.id for i in chosen(("table-4.5",))] == ["table-4.5"]
    assert [i.id for i in chosen(("subpixel", "2.8", "figure-2.8"))] == ["figure-2.8", "subpixel"]


def test_a_study_of_chapter_2_is_the_figure_it_makes() -> None:
    assert [i.id for i in chosen(("bias-sensitivity",))] == ["figure-2.8"]
    assert [i.id for i in chosen(("weight-area", "2.19"))] == ["figure-2.19"]
    names = [n for i in items() for n in {i.id, i.study} if n]
    assert len(names) == len(set(names))


def test_a_file_is_named_after_what_it_makes() -> None:
    for room, modules in CONTENTS.items():
        for module in modules:
            made = import_module(f"tactile_graph_thesis.items.{room}.{module}").ITEMS
            kind, first, last = told(module)
            assert room == f"chapter_{first[0]}"
            for item in made:
                number = item.number or item.after
                assert first <= tuple(map(int, number.split("."))) <= last, (module, item.id)
                assert (item.id if item.number else "section").startswith(kind), (module, item.id)


def told(module: str) -> tuple[str, tuple[int, ...], tuple[int, ...]]:
    """Return what the name of a module says: figure, table or section, and its range."""
    kind, *words = module.split("_")
    parts = " ".join(w if w.isdigit() else "|" for w in words).split("|")
    ranges = [tuple(map(int, part.split())) for part in parts if part.strip()]
    return kind.rstrip("s"), ranges[0], ranges[-1]


def test_no_file_of_an_item_is_left_out() -> None:
    import tactile_graph_thesis.items as rooms

    for room, modules in CONTENTS.items():
        there = {path.stem for path in (Path(rooms.__path__[0]) / room).glob("*_[0-9]*.py")}
        assert there == set(modules)


def test_all_is_everything() -> None:
    assert chosen(("all",)) == list(items())


def test_an_unknown_name_is_told_with_the_nearest() -> None:
    with pytest.raises(UsageError, match=r"named 'figur-4.5'; did you mean 'figure-4.5'"):
        chosen(("figur-4.5",))
    with pytest.raises(UsageError, match=r"no table, figure or study named 'zzz'; 'tactile-graph"):
        chosen(("zzz",))
    with pytest.raises(UsageError, match=r"named 'wieght-area'; did you mean 'weight-area'"):
        chosen(("wieght-area",))
    with pytest.raises(UsageError, match="no table, figure or study named ''"):
        chosen(("",))


def test_reasons_hold_no_number_of_a_run() -> None:
    """A number in a fixed text would stay when the run says otherwise: only places may have one."""
    places = r"(tables?|figures?|sections?|equations?|circle-|rectangle-|element #)\s?[\d.]+"
    for item in items():
        text = re.sub(places + r"( to [\d.]+| and [\d.]+|, [\d.]+)*", "", item.why, flags=re.I)
        text = re.sub(r"(DISC|RECTANGLE) I+", "", text)
        assert not re.search(r"\d", text), f"{item.id}: {item.why}"


def test_every_item_says_what_is_to_be_seen() -> None:
    for item in items():
        assert item.title, item.id
        assert item.shows.endswith("."), item.id
        assert not item.why or item.why.endswith("."), item.id
