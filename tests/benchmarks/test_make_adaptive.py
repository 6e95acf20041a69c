"""What tune makes of a shipped pipeline is shipped only where it is surely no worse."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import make_adaptive  # noqa: E402
from tuned import CASES, Told, small_discs  # noqa: E402

from tactile_graph import Pipeline, load, loads  # noqa: E402
from tactile_graph_tune.split import Interval  # noqa: E402
from tactile_graph_tune.table.record import Judged  # noqa: E402
from tactile_graph_tune.tuned import Weight  # noqa: E402

BY_HAND = make_adaptive.BY_HAND["legible"]
EVEN = Interval(0.0, -0.001, 0.001)


def told(ratio: float = 0.5, **more: float) -> Told:
    hand = Weight(*(Interval(x, x, x) for x in (900.0, 0.1, 0.02, 0.04)))
    kinds = dict.fromkeys(Weight._fields, EVEN) | {
        k: Interval(x / 2, 0.0, x) for k, x in more.items()
    }
    time = Interval(ratio, ratio - 0.1, ratio + 0.1)
    more_of_it = Weight(**kinds)
    return Told(
        "c", "f", 9, hand, hand, time, more_of_it, 1.0, 1.0, 0.9, 0.9, hand, time, more_of_it
    )  # fmt: skip


def certain_where(pipeline: Pipeline, condition: str) -> Pipeline:
    """Return the pipeline where the cheap fit is taken under another condition."""
    text, n = re.subn(r"^  certain: .*$", f"  certain: {condition}", pipeline.text, flags=re.M)
    assert n == 1
    return loads(text)


def test_every_product_is_tuned_against_itself_by_its_numbers_alone():
    cases = [CASES[name] for name in make_adaptive.PRODUCTS]
    assert [case.by_hand for case in cases] == list(make_adaptive.PRODUCTS)
    assert all(case.levels for case in cases)


@pytest.mark.parametrize(
    ("its", "why"),
    [
        (told(), []),
        (told(error=0.006), ["the error may be +0.006 more than 0.100"]),
        (told(missed=0.011), ["missed: maybe +1.1 % of the frames"]),
        (told(false=0.02), ["false: maybe +2.0 % of the frames"]),
        (told(0.95), []),
        (told(0.96), ["it may take 1.06 of the time"]),
    ],
)
def test_whatever_may_be_worse_by_more_than_its_margin_is_told(its, why):
    assert list(make_adaptive.refuted_by(its)) == why


@pytest.mark.slow  # much is compiled
def test_small_things_that_are_lost_speak_against_shipping():
    small = small_discs(8, 0)
    today = load("locate-circle")
    worse = loads(today.text.replace(" or footprint.rise > 1.5", ""))
    (why,) = make_adaptive.lost(today, worse, small)
    assert why.startswith("of 8 small discs ")
    assert not [*make_adaptive.lost(worse, today, small)]


def test_what_is_written_has_the_shipped_name_words_and_parent():
    own = load("adaptive")
    bare = own.text[own.text.index("pipeline: adaptive") :].replace(f"  # {BY_HAND}\n", "")
    text = "# by tune\n" + bare.replace("pipeline: adaptive", "pipeline: adaptive-tuned")
    text = text.replace(f"about: {own.about}", "about: Every way").replace("locate-circle", "other")
    made = make_adaptive.shipped("adaptive", text)
    assert made.startswith("# by tune\npipeline: adaptive\n")
    assert made.count(f"  # {BY_HAND}\n  legible: ") == 1
    again = loads(made)
    assert (again.about, again.evolves, again.key) == (own.about, own.evolves, own.key)


@pytest.mark.slow  # much is compiled
def test_clean_frames_that_take_longer_speak_against_shipping():
    clean, judged = make_adaptive.clean_frames(8, 0), Judged("circle", "centre", "cm", 2.0)
    assert len(clean) == 8
    today = load("adaptive")
    never = certain_where(today, "even.n_cells > 300")
    (why,) = make_adaptive.slower(today, never, clean, judged)
    assert why.startswith("clean frames take ")
    assert list(make_adaptive.slower(never, today, clean, judged)) == []


@pytest.mark.slow  # much is compiled
def test_radii_that_are_further_off_speak_against_shipping():
    today = load("adaptive")
    trusting = certain_where(today, "even.n_cells > 1")
    some = make_adaptive.discs(96, 0)
    assert len(some) == 96
    centre, radius = make_adaptive.vaguer(today, trusting, some, 0)
    assert centre.startswith("the centre may be off by +")
    assert radius.startswith("the radius may be off by +")
    assert list(make_adaptive.vaguer(today, today, some, 0)) == []
