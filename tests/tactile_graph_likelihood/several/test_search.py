"""What a search looks at: kinds of the same area, and whose each element is."""

import numpy as np
import pytest

from helpers_joint import DISCS, problem_of_discs
from tactile_graph_likelihood.geometry.outlines import DISC, RECTANGLE
from tactile_graph_likelihood.several.joint.joint_posterior import Outlines, gain, log_rest_of
from tactile_graph_likelihood.several.joint.maximise_jointly import likeliest_of
from tactile_graph_likelihood.several.joint.scene import Configuration, laid
from tactile_graph_likelihood.several.joint.whose import ODD, USUAL
from tactile_graph_likelihood.several.search import SPLIT, SURPLUS, Search, by_chance, split_from
from tactile_graph_likelihood.single.density.element_terms import OFF, ON

pytestmark = pytest.mark.usefixtures("plain_kernels")

KINDS = [(DISC, 0), (RECTANGLE, 0)]


def test_elements_belong_to_the_outline_that_brings_most_or_the_nearest():
    search = Search(problem_of_discs(), KINDS, 3.0, 1.0)
    found = Configuration(np.full(2, DISC), np.zeros(2, np.int64), DISCS, 0.0)
    own, _ = search.owners(found)
    assert set(np.unique(own)) == {-1, 0, 1}
    assert own[4, 4] == 0
    assert own[4, 8] == 1
    assert (own[~search.on] == -1).all()


def three_discs():
    """Return the problem of three discs in a row that touch, of an even pad."""
    bare = problem_of_discs()
    row = np.array([[x, 8.0, 2.2, 4.5, 0.0, 0.0] for x in (4.5, 9.0, 13.5)])
    found = Configuration(np.full(3, DISC), np.zeros(3, np.int64), row, 0.0)
    load = laid(bare, found).load
    states = np.where(load > 5.0, ON, OFF).astype(np.uint8)
    logs = np.log(np.where(load > 5.0, load, 1.0))
    return bare._replace(logs=logs, states=states), row


@pytest.mark.slow
def test_three_outlines_may_take_the_place_of_two_that_cover_three_objects():
    problem, row = three_discs()
    search = Search(problem, KINDS, 1.0, 1.0)
    pairs = [pair for _, pair in search.parted(search.on, problem, 3)]
    triples = search.threes(search.on, problem)
    worths = [worth for worth, _ in triples]
    assert worths == sorted(worths, reverse=True)
    best = triples[0][1]
    assert len(best) == 3
    assert np.abs(np.sort(best[:, 0]) - row[:, 0]).max() < 0.7
    place = (0, 1), search.on, 100.0
    two = search.drawn(pairs[0], problem)
    drawn = [found.count for found in search.instead(place, two, problem, True)]
    assert 3 in drawn
    assert 3 not in [found.count for found in search.instead(place, two, problem, False)]


def test_the_likeliest_of_some_starts_is_the_one_of_the_most_posterior():
    problem = problem_of_discs(3)
    starts = np.array([DISCS[0] + [off, 0.0, 0.0, 0.0, 0.0, 0.0] for off in (2.0, 0.3, -0.1, 40.0)])
    which = likeliest_of.call(problem, DISC, 0, starts)
    kinds, corners = np.array([DISC]), np.array([0])
    logs = []
    for start in starts:
        one = Outlines(kinds, corners, start[None].copy())
        rest = log_rest_of.call(problem, one)
        logs.append(rest + gain.call(problem, one) if rest > -np.inf else rest)
    assert which == int(np.argmax(logs))
    assert logs[3] == -np.inf
    assert likeliest_of.call(problem, DISC, 0, starts[3:]) == 0


def test_a_search_may_begin_with_nothing_but_what_explains_all(monkeypatch):
    search = Search(problem_of_discs(), KINDS, 3.0, 1.0)
    found = Configuration(np.full(2, DISC), np.zeros(2, np.int64), DISCS, 0.0)
    monkeypatch.setattr(search, "improved", lambda *_: None)
    monkeypatch.setattr(search, "noted", lambda its: search.every.append(its) or its)
    monkeypatch.setattr(search, "beginnings", lambda _: pytest.fail("begun anew"))
    search.divisions(6, found, anew=False)
    assert search.every == [found]
    for begin, anew in [(found, True), (found.without(1), False), (None, False)]:
        with pytest.raises(pytest.fail.Exception, match="begun anew"):
            search.divisions(6, begin, anew)


@pytest.mark.parametrize(("pieces", "climbs"), [(1, True), (2, False)])
def test_what_was_cut_is_looked_for_in_other_ways_unless_it_explains_more(
    monkeypatch, pieces, climbs
):
    search = Search(problem_of_discs(), KINDS, 3.0, 1.0)
    found = Configuration(np.full(2, DISC), np.zeros(2, np.int64), DISCS, 0.0)
    if pieces == 2:
        search.on[:, 6:8] = False
    tried = []
    monkeypatch.setattr(search, "surplus", lambda _: 0.0)
    monkeypatch.setattr(search, "begun", lambda _: found)
    monkeypatch.setattr(search, "noted", lambda its: search.every.append(its) or its)
    monkeypatch.setattr(search, "improved", lambda *_: None)
    monkeypatch.setattr(search, "draw_ladder", lambda *_: tried.append(True))
    search.divisions(6)
    assert tried == [True] * climbs


def test_of_two_numbers_alike_likely_outlines_that_are_alike_are_likelier():
    search = Search(problem_of_discs(), KINDS, 3.0, 1.0)
    alike = Configuration(np.full(2, DISC), np.zeros(2, np.int64), DISCS, 0.0)
    points = DISCS * [[1.0, 1.0, 3.0, 1.5, 1.0, 1.0], [1.0, 1.0, 0.5, 0.5, 1.0, 1.0]]
    unlike = Configuration(np.full(2, DISC), np.zeros(2, np.int64), points, 0.0)
    assert search.worth(alike) == search.worth(unlike)
    assert search.rank(alike) > search.rank(unlike) + 3.0


def test_what_chance_leaves_unexplained_of_many_elements_starts_no_search():
    """Without it every second carton of 4000 cells would be parted, a second each."""
    left = np.random.default_rng(0).standard_normal((200, 4000)) ** 2 / 2.0
    left = np.where(left > ODD, left, 0.0).sum(axis=1)
    assert (left > split_from(4000)).mean() < 0.25
    assert (left - 4000 * USUAL > SURPLUS + by_chance(4000)).mean() < 0.25
    assert (split_from(100), by_chance(100)) == (SPLIT, 0.0)
