"""The report: well-formed, whole, alone, and safe whatever names it is given."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_html import Element, read_html
from tactile_graph import Frame, load, loads
from tactile_graph.foreign_text import visible
from tactile_graph_compare import Comparison, compare
from tactile_graph_compare.output.export import as_json
from tactile_graph_compare.output.tables import evolution_lines, number, us
from tactile_graph_compare.report import strips, write_report
from tactile_graph_compare.report.page import page
from tactile_graph_compare.score.statistics import time_difference_of, times_of

pytestmark = pytest.mark.usefixtures("hand_made")

HOSTILE = "\"'><script>alert(1)</script>&amp;</title></style><!-- \x07\ud800"


def both(**rest: Any) -> Comparison:
    return compare(["discs", "next.yaml"], **{"n_frames": 10, **rest})


def checked(comparison: Comparison) -> Element:
    """Return the page, after what must hold of any."""
    text = page(comparison)
    root = read_html(text)
    everything = root.all()
    ids = [e.attributes["id"] for e in everything if "id" in e.attributes]
    assert len(set(ids)) == len(ids)
    assert not {e.name for e in everything} & {"script", "link", "img", "iframe", "object"}
    for element in everything:
        for name, value in element.attributes.items():
            if name in ("href", "src"):
                inner = value.startswith("data:image/png;base64,")
                assert inner or value.removeprefix("#") in ids, value
            if name in ("d", "x", "y", "cx", "cy", "r", "width", "height", "viewBox", "points"):
                assert not re.search("nan|inf", value), f"{element.name} {name}={value}"
            assert not name.startswith("on")
        if element.name == "table":
            assert element.all("th")
            assert all(th.attributes["scope"] for th in element.all("th"))
        if element.name == "svg" and "aria-hidden" not in element.attributes:
            assert element.attributes["role"] == "img"
            assert element.attributes["aria-label"]
    assert not re.search(r"url\((?!#)", text)
    assert "@import" not in text
    return root


def test_how_many_times_as_long_it_takes_is_the_same_everywhere() -> None:
    found = both()
    quick = times_of([1.0, 1.0, 10.0] * 3)
    slow = times_of([3.0, 30.0, 11.0] * 3)  # 11 times by the medians, 3 in the middle frame
    first, second = (
        replace(v, times=t) for v, t in zip(found.variants, (quick, slow), strict=True)
    )
    time = time_difference_of(second.label, first.label, slow, quick)
    found = replace(
        found, variants=(first, second), time_differences=(time,),
        lineage=tuple(replace(e, time=time) for e in found.lineage),
    )  # fmt: skip
    root = checked(found)
    cards = {c.one("h3").text: c for c in root.all("article") if c.attributes["class"] == "card"}
    assert f"{second.label} takes × 3.00" in " ".join(cards["Fastest"].text.split())
    sections = {s.attributes["id"]: s.text for s in root.all("section")}
    assert "× 3.00" in sections["times"]
    assert "× 3.00" in sections["lineage"]
    assert "× 11" not in root.text
    assert "× 3.00" in " ".join(evolution_lines(found.lineage[0]))
    data = json.loads(as_json(found))
    assert data["time_differences"][0]["ratio"] == data["lineage"][0]["time_ratio"] == 3.0


def test_it_holds_every_section_with_its_heading() -> None:
    root = checked(both(source_settings={"empty": [0]}))
    found = {s.attributes["id"]: s.one("h2").text for s in root.all("section")}
    assert found == {
        "summary": "Summary",
        "graph": "The merged graph",
        "pareto": "Error against time",
        "errors": "Errors",
        "differences": "Paired differences",
        "times": "Times",
        "lineage": "Lineage",
        "frames": "Chosen frames",
        "timeline": "What ran",
        "making": "How it was made",
    }
    links = [a.attributes["href"] for a in root.one("nav").all("a")]
    assert links == [f"#{name}" for name in list(found)[1:]]


@pytest.mark.slow
def test_the_summary_names_the_best_of_each_quantity_and_the_fastest() -> None:
    c = both()
    cards = {card.one("h3").text: card for card in checked(c).all("article", "card")}
    for quantity in c.quantities:
        best = min((s for s in c.scores if s.quantity == quantity), key=lambda s: s.mean)
        card = cards[f"Smallest mean error: {quantity}"]
        assert card.one(class_="figure").text == f"{number(best.mean, 'cm')} cm"
        assert best.variant in card.all("span", "variant")[0].text
    fastest = min(c.variants, key=lambda v: v.times.median_us)
    assert cards["Fastest"].one(class_="figure").text == f"{us(fastest.times.median_us)} µs"


def test_a_smaller_error_over_fewer_answers_is_told_apart() -> None:
    c = both()
    scores = tuple(
        replace(s, mean=0.5, n_answered=1, n_missing=9)
        if s.variant == "discs"
        else replace(s, mean=1.0)
        for s in c.scores
    )
    card = checked(replace(c, scores=scores)).all("article", "card")[0]
    assert "1 of 10 answered" in card.text
    assert "next answers more often: 10 times" in card.text


def test_the_graph_shows_every_node_credits_it_and_thickens_what_is_new() -> None:
    c = both(source_settings={"empty": [0]})
    drawing = checked(c).one("section", id="graph").one("figure", "graph").one("svg")
    boxes = {}
    for group in drawing.all("g"):
        texts = [t.text for t in group.all("text")]
        if texts and group.all("title"):
            boxes[texts[0]] = (texts, [r.attributes for r in group.all("rect")])
    for node in c.graph.nodes:
        texts, rects = boxes[node.name]
        assert rects[0]["stroke-width"] == ("4" if node.new_in else "1.3")
        numbers = [str(v.number) for v in c.variants if v.label in node.variants]
        plates = len(rects) - 1
        assert texts[-plates:] == (["all"] if len(numbers) == 2 else numbers)
        assert f"{us(node.time_us)} µs · ran {node.n_ran}" in texts
    assert any(n.new_in for n in c.graph.nodes)
    assert not all(n.new_in for n in c.graph.nodes)


def test_tables_hold_the_scores_and_stress_the_best() -> None:
    c = both()
    means = {"discs": 0.5, "next": 0.25}
    c = replace(c, scores=tuple(replace(s, mean=means[s.variant]) for s in c.scores))
    table = checked(c).one("section", id="errors").one("table", "data")
    assert [th.text for th in table.one("thead").all("th")][:3] == ["quantity", "variant", "mean"]
    assert [b.all("th")[0].text for b in table.all("tbody")] == ["centre cm", "radius cm"]
    for body, quantity in zip(table.all("tbody"), c.quantities, strict=True):
        for i, (tr, label) in enumerate(zip(body.all("tr"), c.labels, strict=True), 1):
            star = " ★" if c.score(label, quantity).pareto else ""
            assert tr.all("th")[-1].text == f"{i} {label}{star}"
            mean = tr.all("td")[0]
            assert mean.text == number(means[label], "cm")
            assert bool(mean.all("b")) == (label == "next")


def test_chosen_frames_mark_the_worst_and_say_why_nothing_came() -> None:
    c = both(source_settings={"empty": [0]})
    section = checked(c).one("section", id="frames")
    assert len(section.all("details")) == len(c.chosen)
    for frame in c.chosen:
        block = section.one("details", id=f"frame-{frame.position}")
        rows = block.one("tbody").all("tr")
        assert len(rows) == 2
        for variant, row in zip(c.variants, rows, strict=True):
            worst = [x.quantity for x in frame.choices
                     if x.variant == variant.label and x.why == "worst"]  # fmt: skip
            badges = [b.text for b in row.all(class_="badge")]
            assert badges == [f"★ worst {q}" for q in worst]
    empty = section.one("details", id="frame-0").text
    assert "skipped" in empty
    assert "when footprint.count > 0 is false" in empty


def test_pictures_hold_what_was_found_and_what_is_true() -> None:
    c = both()
    root = checked(c)
    drawn = {g.attributes["id"]: g for g in root.one("svg", "album").all("g")}
    rows = root.one("section", id="frames").all("tr")
    last = rows[-1].all("svg", "pic")[-1]
    uses = {u.attributes.get("class"): u.attributes["href"][1:] for u in last.all("use")}
    frame = c.chosen[-1]
    found = frame.value("next", "circle")
    scale = 200.0 / 6.0  # the pad is 6 cm wide and 4 cm high
    circle = drawn[uses["found"]].all("circle", "ink")[0].attributes
    assert float(circle["cx"]) == pytest.approx(found.x_cm * scale, abs=0.01)
    assert float(circle["r"]) == pytest.approx(found.radius_cm * scale, abs=0.01)
    assert last.attributes["viewbox"] == "0 0 200 133"
    truth = [float(e.attributes["cx"]) for e in drawn[uses["true"]].all("circle", "ink")]
    expected = [t.shape.x_cm * scale for t in frame.frame.truth if hasattr(t.shape, "radius_cm")]
    assert truth == pytest.approx(expected, abs=0.01)


@pytest.mark.slow
def test_lineage_tells_what_was_done_and_what_that_did() -> None:
    c = both()
    step = checked(c).one("section", id="lineage").one("article")
    assert step.one("h3").text == "1 discs → 2 next"
    told = step.one("dl").text
    assert "addedmerged first spare" in told
    assert "first of: – first, spare" in told
    assert "keptfootprint" in told
    assert f"time: × {c.lineage[0].time.ratio:.2f}" in step.one("ul", "effect").text


def test_the_timeline_has_a_bar_for_each_run_of_frames() -> None:
    c = both(source_settings={"empty": [0]})
    drawing = checked(c).one("section", id="timeline").all("svg")[1]
    node = next(g for g in drawing.all("g") if g.one("title").text.startswith("spare:"))
    # Frame 0 is empty; the first choice fails in 1 and 6, which the spare one answers for.
    assert node.one("title").text == "spare: ran in 2, skipped in 1, not asked in 7"
    runs = {p.attributes["class"]: p.attributes["d"].count("M") for p in node.all("path")}
    assert runs == {"ran": 2, "skipped": 1, "idle": 2}
    marks = [a.attributes["href"] for a in drawing.all("a")]
    assert marks == [f"#frame-{f.position}" for f in c.chosen]


@pytest.mark.slow
def test_it_says_how_to_make_it_again() -> None:
    c = both(source_settings={"empty": [0]}, seed=3)
    command = checked(c).one("section", id="making").one("pre", "command").text
    assert command == (
        "tactile-graph compare discs next.yaml --source made --with frames=10 "
        "--with 'empty=[0]' --frames 10 --seed 3 --report report.html"
    )
    typed = {**c.provenance, "command": ["/bin/tactile-graph", "compare", "a b", "--report", "x"]}
    again = checked(replace(c, provenance=typed)).one("pre", "command").text
    assert again == "tactile-graph compare 'a b' --report x"


def test_frames_that_were_handed_in_are_asked_for_as_a_recording() -> None:
    section = checked(compare(["discs", "next.yaml"], frames(5))).one("section", id="making")
    assert "The frames were handed in by a program." in section.text
    command = section.one("pre", "command").text
    assert (
        command == "tactile-graph compare discs next.yaml RECORDING --seed 0 --report report.html"
    )


def test_a_pipeline_that_no_command_can_name_is_told_in_place_of_a_command() -> None:
    own = loads(f"{load('discs').text}\n# mine\n").with_settings({"footprint.level_v": 0.3})
    section = checked(compare(["discs", own], n_frames=3)).one("section", id="making")
    assert "no command makes it again" in section.text
    assert "discs level_v=0.3" in section.text
    assert "tactile-graph compare" not in section.text


# -- names that would break a careless page ---------------------------------------------------


def hostile(c: Comparison) -> Comparison:
    """Return it with every name a user can choose replaced by one that looks like markup."""
    new = {label: f"{label}{HOSTILE}" for label in c.labels}
    name = new.__getitem__
    return replace(
        c,
        variants=tuple(
            replace(v, label=name(v.label), given=HOSTILE, parent=new.get(v.parent, ""),
                    reasons=(("skipped", HOSTILE, HOSTILE, HOSTILE, 1),), asked=(HOSTILE,))
            for v in c.variants
        ),
        source=HOSTILE,
        notes=(HOSTILE,),
        graph=replace(c.graph, nodes=tuple(
            replace(n, what=HOSTILE, guard=HOSTILE,
                    own_names={name(k): o for k, o in n.own_names.items()},
                    new_in=tuple(map(name, n.new_in)))
            for n in c.graph.nodes)),
        scores=tuple(replace(s, variant=name(s.variant)) for s in c.scores),
        differences=tuple(replace(d, variant=name(d.variant), reference=name(d.reference))
                          for d in c.differences),
        time_differences=tuple(replace(d, variant=name(d.variant), reference=name(d.reference))
                               for d in c.time_differences),
        lineage=tuple(replace(e, parent=name(e.parent), child=name(e.child), added=(HOSTILE,))
                      for e in c.lineage),
        chosen=tuple(
            replace(f, frame=replace(f.frame, label=HOSTILE),
                    choices=tuple(replace(x, variant=new.get(x.variant, "")) for x in f.choices),
                    stories={name(k): {n: replace(s, reason=HOSTILE, origin=HOSTILE)
                                       for n, s in v.items()} for k, v in f.stories.items()},
                    errors={name(k): v for k, v in f.errors.items()})
            for f in c.chosen),
        provenance={"command": ["tactile-graph", "compare", HOSTILE],
                    "versions": {HOSTILE: HOSTILE}, "variants": {HOSTILE: {"pipeline": HOSTILE}}},
    )  # fmt: skip


def test_hostile_names_stay_text() -> None:
    root = checked(hostile(both(source_settings={"empty": [0]})))
    readable = visible(HOSTILE)
    for section in ("summary", "errors", "differences", "times", "lineage", "frames", "timeline",
                    "making"):  # fmt: skip
        assert "<script>alert(1)</script>&amp;" in root.one("section", id=section).text, section
    assert readable.strip() in root.one("head").one("title").text


def test_a_hostile_pipeline_file_stays_text(tmp_path: Path) -> None:
    text = Path("next.yaml").read_text()
    (tmp_path / "<b>&x.yaml").write_text(text)
    root = checked(compare([str(tmp_path / "<b>&x.yaml")], n_frames=3))
    assert "<b>&x.yaml" in root.one("section", id="making").text


# -- little or nothing to show -----------------------------------------------------------------


def frames(n: int, value: float = 1.0, label: str = "") -> list[Frame]:
    values = np.zeros((4, 6))
    values[1:3, 1:3] = value
    return [Frame.of(values + 0.001 * i, 1.0, quantity="volt", index=i, label=label)
            for i in range(n)]  # fmt: skip


def test_without_truth_there_are_times_but_no_errors() -> None:
    root = checked(compare(["discs", "next.yaml"], frames(5)))
    shown = {s.attributes["id"] for s in root.all("section")}
    assert not shown & {"errors", "pareto", "differences"}
    assert {"times", "graph", "frames"} <= shown
    assert "Nobody knows what truly lay there" in root.one("section", id="summary").text


@pytest.mark.parametrize("n", [1, 2])
def test_one_variant_and_few_frames(n: int) -> None:
    root = checked(both(n_frames=n) if n == 2 else compare(["discs"], n_frames=1))
    assert root.one("section", id="frames").all("svg", "pic")


def test_frames_that_give_nothing_at_all() -> None:
    c = compare(["discs", "next.yaml"], frames(5, 0.0))
    told = checked(c).one("section", id="summary")
    assert [w.text for w in told.all("p", "warning")][1:] == [
        "1 discs gave no output in any frame.",
        "2 next gave no output in any frame.",
    ]


@pytest.mark.slow
def test_steps_that_fail_or_give_no_number_leave_no_nan() -> None:
    crashing = loads(Path("discs.yaml").read_text().replace("{step: disc, in: footprint",
        "{step: disc, in: footprint, with: {fail_at_x: 1}").replace("discs", "crashing"),
        "x.yaml")  # fmt: skip
    c = compare(["discs", crashing], frames(4))
    root = checked(c)
    assert "crashing gave no output in any frame" in root.one("section", id="summary").text
    assert "no circle about" in root.one("section", id="frames").text
    nowhere = tuple(replace(s, errors=np.full_like(s.errors, np.nan), mean=None, median=None,
                            p95=None, largest=None, bias=None, n_answered=0)
                    for s in both().scores)  # fmt: skip
    assert "no answer at all" not in checked(replace(both(), scores=nowhere)).text
    some = tuple(n if n.variant == "next" else s
                 for n, s in zip(nowhere, both().scores, strict=True))  # fmt: skip
    assert "no answer at all" in checked(replace(both(), scores=some)).text


@pytest.mark.slow
def test_values_that_are_not_finite_are_drawn_without() -> None:
    c = both(n_frames=3)
    frame = c.chosen[0]
    story = frame.stories["next"]["circle"]
    bad = replace(story.value, x_cm=float("nan"), radius_cm=float("inf"))
    stories = {**frame.stories, "next": {**frame.stories["next"],
                                         "circle": replace(story, value=bad)}}  # fmt: skip
    checked(replace(c, chosen=(replace(frame, stories=stories), *c.chosen[1:])))


@pytest.mark.slow
def test_twelve_variants_are_told_apart_by_number() -> None:
    c = compare(["discs"], sweeps={"footprint.level_v": [0.1 * i for i in range(1, 13)]},
                n_frames=6)  # fmt: skip
    root = checked(c)
    legend = root.one("section", id="summary").one("ul", "legend")
    assert [li.one("span", "chip").text for li in legend.all("li")] == [
        str(i) for i in range(1, 13)
    ]


def test_what_was_interrupted_says_so() -> None:
    root = checked(replace(both(), interrupted=True))
    assert "Interrupted after 10 frames" in root.one("section", id="summary").text


# -- size and file -----------------------------------------------------------------------------


@pytest.mark.slow
def test_pictures_beyond_the_budget_are_left_out_and_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    c = both()
    monkeypatch.setattr(strips, "MOST_BYTES", 0)
    section = checked(c).one("section", id="frames")
    kept = len(section.all("details"))
    assert kept < len(c.chosen)
    assert f"{len(c.chosen) - kept} more chosen frame" in section.text


def test_equal_pictures_are_drawn_once() -> None:
    c = both()
    root = checked(c)
    uris = [i.attributes["href"] for i in root.all("image")]
    footprints = sum("footprint" in f.stories["discs"] for f in c.chosen)
    # Of each chosen frame: itself, in grey beneath, footprint and merged, at most.
    assert len(uris) <= 4 * footprints


def test_the_file_is_written_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    c = both(n_frames=2)
    path = tmp_path / "r.html"
    write_report(c, path)
    before = path.read_bytes()
    assert before.startswith(b"<!doctype html>")
    read_html(before.decode())
    monkeypatch.setattr("tactile_graph_compare.report.page.section", partial(_fail))
    with pytest.raises(RuntimeError, match="no"):
        write_report(c, str(path))
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.glob("*r.html*")] == ["r.html"]


def _fail(*_: object) -> None:
    raise RuntimeError("no")
