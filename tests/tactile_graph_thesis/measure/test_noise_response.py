"""Pipelines with noise in them, and what comes of it."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph import load
from tactile_graph_thesis.measure.noise_response import (
    CIRCLE,
    CONTACTS,
    MOVED,
    VOIDS,
    VOLTS,
    Noise,
    answers,
    circle_values,
    noisy,
    response,
    responses,
)


@pytest.mark.parametrize("pipeline", ["circle-3", "rectangle-1"])
def test_noise_stands_between_a_node_and_all_that_reads_it(pipeline: str) -> None:
    made = noisy(pipeline, "footprint", CONTACTS, 0.1)
    readers = [n for n, d in load(pipeline).graph().pred.items() if "footprint" in d]
    graph = made.graph()
    assert list(graph.pred["footprint_noisy"]) == ["footprint"]
    for name in readers:
        kinds = {p: d["kind"] for p, d in graph.pred[name].items()}
        assert kinds.get("footprint", "guard") == "guard"  # conditions see it without the noise
    data = [n for n in readers if load(pipeline).graph()["footprint"][n]["kind"] == "data"]
    assert data
    assert all(graph.has_edge("footprint_noisy", n) for n in data)


def test_noise_of_no_size_changes_nothing() -> None:
    frames = list(load("circle-3").with_source("simulate", frames=6).frames(3))
    clean = answers(load("circle-3"), frames, circle_values, 0)
    none = Noise("none", "flip_cells", "on", "share", (0.0,))
    for place, noise in (("frame", VOLTS), ("footprint", none), ("boundary", MOVED)):
        found = response(
            answers(noisy("circle-3", place, noise, 0.0), frames, circle_values, 0), clean
        )
        assert found.moved.tolist() == [0.0, 0.0]
        assert found.missing == 0.0


@pytest.mark.slow
def test_erosion_takes_lone_contacts_away_and_makes_voids_worse() -> None:
    frames = list(load("circle-3").with_source("simulate", frames=30).frames(3))
    places = {"fine": (CONTACTS, VOIDS), "eroded": (CONTACTS, VOIDS)}
    found = responses(CIRCLE._replace(places=places), frames, 0)
    contacts, voids = (
        [found[node, noise.name][3].moved[1] for node in places] for noise in (CONTACTS, VOIDS)
    )
    assert contacts[0] < 0.2 * contacts[1]
    assert voids[0] > 2.0 * voids[1]


def test_readings_without_an_answer_are_told() -> None:
    value = np.zeros(3)
    found = response([None, value, value], [value, value, None])
    assert found.missing == 0.5
    assert response([None], [value]).missing == 1.0


def test_angles_move_modulo_half_turns() -> None:
    found = response([np.array([89.0, 1.0])], [np.array([-89.0, 0.0])])
    assert found.moved[0] == pytest.approx(2.0)
