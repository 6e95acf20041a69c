"""Steps that follow a list and are kept from the frames in which it is empty: that is told."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from helpers_cli import call, install
from helpers_graphs import registry
from tactile_graph import Image, Mask, load, loads
from tactile_graph.pipeline.unseen import unseen_ends
from tactile_graph.plugins.registry import installed
from tactile_graph.steps import TimeGap


class Found(NamedTuple):
    things: tuple[int, ...]
    count: int  # type: ignore[assignment]


def pressed(image: Image) -> Mask:
    return image.mask(image.values > 0)


def found(mask: Mask) -> Found:
    return Found((1,) * mask.count, mask.count)


class Follow:
    def __call__(self, things: list[int], *, gap_s: TimeGap = None) -> int:
        return len(things)


class Counted:
    def __call__(self, things: list[int]) -> int:
        return len(things)


class Timed:
    def __call__(self, mask: Mask, *, gap_s: TimeGap = None) -> int:
        return mask.count


STEPS = {"pressed": pressed, "found": found, "follow": Follow, "counted": Counted, "timed": Timed}
TEXT = """\
pipeline: followed
nodes:
  cells: {step: pressed, in: frame}
  others: {step: pressed, in: frame}
  found: {step: found, in: cells%s}
  one: {step: %s, in: %s%s}
outputs: [%s]
"""


def told(
    own: str, *, before: str = "", step: str = "follow", of: str = "found.things"
) -> list[str]:
    whens = [f', when: "{text}"' if text else "" for text in (before, own)]
    return unseen_ends(loads(TEXT % (whens[0], step, of, whens[1], "one"), "p", registry(STEPS)))


@pytest.mark.parametrize(
    "guard", ["found.count > 0", "found.count", "found.count >= 2 and others.count < 5"]
)
def test_a_step_skipped_where_its_list_is_empty_is_told(guard: str) -> None:
    (words,) = told(guard)
    assert words.startswith(f"node 'one': never sees its list empty, for 'when: {guard}' skips it")
    assert words.endswith("Without the condition the two are told apart")


@pytest.mark.parametrize("own", ["cells.count > 0", ""])
def test_so_is_one_skipped_by_what_its_list_is_made_of(own: str) -> None:
    (words,) = told(own, before="" if own else "cells.count > 0")
    assert ("of node 'found'" in words) == (not own)


@pytest.mark.parametrize(
    ("own", "settings"),
    [
        ("", {}),
        ("found.count < 9", {}),
        ("others.count > 0", {}),
        ("found.count > 0 or others.count > 0", {}),
        ("found.count > 0", {"step": "counted"}),
        ("found.count > 0", {"step": "timed", "of": "cells"}),
    ],
)
def test_nothing_is_told_where_the_empty_list_is_seen_or_nothing_is_followed(
    own: str, settings: dict[str, str]
) -> None:
    assert told(own, **settings) == []


def test_a_pipeline_of_contacts_skips_them_where_nothing_is_loaded() -> None:
    text = (
        "{pipeline: p, nodes: {found: {use: contacts, in: frame}, "
        "one: {step: track, in: found.contacts.contacts}}, outputs: [one]}"
    )
    (words,) = unseen_ends(loads(text))
    assert "'when: load.loaded' of node 'found/contacts' skips it there" in words


@pytest.mark.slow
def test_no_installed_pipeline_does_so() -> None:
    for name in installed().names("pipelines"):
        assert unseen_ends(load(name)) == [], name


def test_what_is_not_asked_for_is_not_told() -> None:
    text = TEXT % ("", "follow", "found.things", ", when: found.count > 0", "found")
    pipeline = loads(text, "p", registry(STEPS))
    assert unseen_ends(pipeline) == []
    assert len(unseen_ends(pipeline, ["one"])) == 1


def test_check_and_run_tell_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    install(monkeypatch, tmp_path, steps=STEPS)
    monkeypatch.chdir(tmp_path)
    text = TEXT % ("", "follow", "found.things", ", when: found.count > 0", "one")
    Path("p.yaml").write_text(f"source: {{step: made}}\n{text}")
    words = "node 'one': never sees its list empty, for 'when: found.count > 0' skips it there"
    assert f"\n  {words}" in call("check", "p.yaml").stdout
    got = call("run", "p.yaml")
    assert got.exit_code == 0
    assert got.stderr.startswith(words)
