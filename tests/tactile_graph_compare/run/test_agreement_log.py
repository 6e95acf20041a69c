"""Who is held against whom, in which frames, and where that is told."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from helpers_cli import call
from tactile_graph import Frame, load
from tactile_graph.errors import UsageError
from tactile_graph_compare import compare
from tactile_graph_compare.output.tables import agreement, markdown
from tactile_graph_compare.report.page import page

pytestmark = pytest.mark.usefixtures("hand_made")


def untold(n: int = 6) -> list[Frame]:
    """Return frames of which nobody knows what lies there."""
    return [replace(f, truth=None) for f in load("discs").with_source("made", frames=n).frames()]


def test_without_a_truth_each_is_held_against_each() -> None:
    c = compare(["discs", "next.yaml"], untold())
    assert (c.quantities, c.reference) == ((), "")
    assert {(a.variant, a.reference) for a in c.agreements} == {("next", "discs")}
    results = [[r.get("circle") for r in v.pipeline.stream(untold())] for v in c.variants]
    apart = [math.hypot(b.x_cm - a.x_cm, b.y_cm - a.y_cm)
             for a, b in zip(*results, strict=True)]  # fmt: skip
    centre = c.agreement("next", "discs", "centre")
    assert centre is not None
    assert centre.differences.tolist() == pytest.approx(apart)
    assert c.agreement("next", "discs", "radius").n_both == len(apart)
    assert c.agreement("discs", "next", "centre") is None
    (row, *_) = agreement(c).rows
    assert row[:3] == ("centre cm", "next", "discs")


def test_frames_with_a_truth_are_scored_instead() -> None:
    frames = [*untold(2), *load("discs").with_source("made", frames=3).frames()]
    c = compare(["discs", "next.yaml"], frames)
    assert c.agreement("next", "discs", "centre").n_both == 2
    assert c.score("next", "centre").n_answered == 3
    told = list(load("discs").with_source("made", frames=3).frames())
    assert compare(["discs", "next.yaml"], told).agreements == ()


def test_with_a_reference_every_frame_counts_and_errors_are_held_against_it() -> None:
    names = ["discs", "next.yaml", "discs --set footprint.level_v=0.2"]
    label = "discs level_v=0.2"
    c = compare(names, n_frames=5, reference=label)
    assert {(a.variant, a.reference) for a in c.agreements} == {("discs", label), ("next", label)}
    assert c.agreement("next", label, "centre").n_both == 5
    assert {(d.variant, d.reference) for d in c.differences} == {("discs", label), ("next", label)}
    assert {t.reference for t in c.time_differences} == {label}
    (evolution,) = c.lineage
    assert {d.reference for d in evolution.differences} == {evolution.parent}
    assert evolution.time.reference == evolution.parent


def test_many_variants_are_held_against_the_first() -> None:
    levels = [0.1, 0.2, 0.3, 0.4, 0.5]
    c = compare(["discs"], untold(), sweeps={"footprint.level_v": levels})
    assert {a.reference for a in c.agreements} == {"discs level_v=0.1"}
    assert len({a.variant for a in c.agreements}) == 4
    few = compare(["discs"], untold(), sweeps={"footprint.level_v": levels[:3]})
    assert len({(a.variant, a.reference) for a in few.agreements}) == 3


def test_a_reference_that_is_no_variant_is_refused_naming_them() -> None:
    with pytest.raises(UsageError, match=r"^reference discz: must be one of the variants: discs, "
                       r"next; did you mean 'discs'\?"):  # fmt: skip
        compare(["discs", "next.yaml"], reference="discz")
    got = call("compare", "discs", "next.yaml", "--reference", "nxt")
    assert got.exit_code == 2
    assert "--reference nxt: must be one of the variants" in got.stderr
    assert "did you mean 'next'?" in got.stderr


def test_a_frame_in_which_two_lie_apart_is_kept_and_says_so() -> None:
    c = compare(["discs", "discs --set footprint.level_v=0.9"], untold())
    told = {str(choice) for f in c.chosen for choice in f.choices}
    apart = [a for a in c.agreements if a.largest]
    assert {f"{a.quantity} of {a.variant} farthest from discs" for a in apart} <= told


def test_the_command_writes_it_everywhere(hand_made: Path) -> None:
    words = ("compare", "discs", "next.yaml", "--frames", "5", "--reference", "next")
    got = call(*words, "--csv", "out", "--json", "a.json", "--report", "a.html")
    assert got.exit_code == 0, got.output
    assert "Agreement" in got.output
    assert "absolute differences of what both found, in every frame" in got.output
    found = json.loads((hand_made / "a.json").read_text())
    assert found["reference"] == "next"
    assert {a["quantity"] for a in found["agreements"]} == {"centre", "radius"}
    with (hand_made / "out/agreement.csv").open(encoding="utf-8", newline="") as file:
        (centre, _) = csv.DictReader(file)
    assert (centre["variant"], centre["reference"], centre["n_both"]) == ("discs", "next", "5")
    with (hand_made / "out/apart.csv").open(encoding="utf-8", newline="") as file:
        assert len(list(csv.DictReader(file))) == 10
    assert 'id="agreement"' in (hand_made / "a.html").read_text()
    assert call("compare", "discs", "next.yaml", "--csv", "plain").exit_code == 0
    assert not (hand_made / "plain/apart.csv").exists()


def test_page_and_markdown_tell_of_agreement_where_there_are_no_errors() -> None:
    c = compare(["discs", "next.yaml"], untold())
    html = page(c)
    assert "there are no errors to show, but how far the variants agree." in html
    assert "difference of radius in cm, it less the other" in html
    assert "**Agreement**" in markdown(c)
