"""Bare middles that touched elements enclose."""

import numpy as np

from tactile_graph_likelihood.several.enclosed import within


def drawn(*rows):
    """Return which elements are touched, ``x``."""
    return np.array([[mark == "x" for mark in row] for row in rows])


def test_what_touched_elements_enclose_is_within():
    on = drawn(".....", ".xxx.", ".x.x.", ".xxx.", ".....")
    assert np.argwhere(within(on)).tolist() == [[2, 2]]


def test_a_corner_closes_a_ring_and_a_missing_element_opens_it():
    assert within(drawn("..x..", ".x.x.", "x...x", ".x.x.", "..x..")).sum() == 5
    assert not within(drawn(".....", ".xxx.", ".x.x.", ".x.x.", ".....")).any()


def test_what_ends_at_the_pads_edge_is_not_enclosed():
    assert not within(drawn("x.x", "x.x", "xxx")).any()
    assert not within(drawn("...", "...")).any()
    assert not within(drawn("xx", "xx")).any()
