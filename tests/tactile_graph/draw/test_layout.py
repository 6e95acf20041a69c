"""Boxes stand in columns, apart from each other, and every wire goes rightwards around them."""

from __future__ import annotations

import os
import subprocess
import sys
from itertools import combinations, pairwise

import networkx as nx
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from helpers_draw import branched, circle_demo
from tactile_graph.draw.layers import Joint
from tactile_graph.draw.layout import COLUMN_GAP, Layout, Place, Point, layout
from tactile_graph.draw.svg import graph_svg


@st.composite
def graphs(draw: st.DrawFn) -> tuple[dict[str, tuple[float, float]], list[Joint]]:
    n = draw(st.integers(1, 12))
    sizes = {
        f"n{i}": (float(draw(st.integers(40, 200))), float(draw(st.integers(20, 120))))
        for i in range(n)
    }
    pairs = draw(st.lists(st.tuples(st.integers(0, n - 1), st.integers(0, n - 1)), max_size=24))
    rooms = st.sampled_from([0.0, 30.0, 80.0])
    pulls = st.sampled_from([0.01, 1.0])
    joints = [
        Joint(f"n{a}", f"n{b}", draw(rooms), draw(pulls))
        for a, b in (sorted(p) for p in pairs)
        if a != b
    ]
    return sizes, joints


def overlap(a: Place, b: Place) -> bool:
    apart = (
        a.x + a.width <= b.x
        or b.x + b.width <= a.x
        or a.y + a.height <= b.y
        or b.y + b.height <= a.y
    )
    return not apart


def inside(point: Point, box: Place) -> bool:
    within = box.x < point.x < box.x + box.width
    return within and box.y - 1e-9 < point.y < box.y + box.height + 1e-9


def bezier(a: Point, b: Point, t: float) -> Point:
    x = a.x + (b.x - a.x) * (1.5 * t * (1 - t) ** 2 + 1.5 * t * t * (1 - t) + t**3)
    return Point(x, a.y + (b.y - a.y) * (3 * t * t * (1 - t) + t**3))


def walked(route: tuple[Point, ...]) -> list[Point]:
    points = []
    for number, (a, b) in enumerate(pairwise(route)):
        for i in range(1, 12):
            t = i / 12
            straight = Point(a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t)
            points.append(straight if number % 2 else bezier(a, b, t))
    return points


def crossed(placed: Layout) -> list[tuple[str, Point]]:
    return [
        (name, point)
        for route in placed.routes
        for point in walked(route)
        for name, box in placed.boxes.items()
        if inside(point, box)
    ]


@given(graphs())
@settings(max_examples=60, deadline=None)
@pytest.mark.slow
def test_no_two_boxes_overlap(graph: tuple[dict[str, tuple[float, float]], list[Joint]]) -> None:
    placed = layout(*graph)
    assert placed.boxes.keys() == graph[0].keys()
    for a, b in combinations(placed.boxes.values(), 2):
        assert not overlap(a, b)


@pytest.mark.slow
@given(graphs())
@settings(max_examples=60, deadline=None)
def test_every_wire_goes_from_left_to_right_and_keeps_off_the_boxes(
    graph: tuple[dict[str, tuple[float, float]], list[Joint]],
) -> None:
    sizes, joints = graph
    placed = layout(sizes, joints)
    assert len(placed.routes) == len(joints)
    for joint, route in zip(joints, placed.routes, strict=True):
        start, end = placed.boxes[joint.start], placed.boxes[joint.end]
        assert start.x + start.width + COLUMN_GAP + joint.room <= end.x + 1e-9
        assert route[0] == Point(start.x + start.width, start.middle)
        assert route[-1].x == end.x
        assert end.y < route[-1].y < end.y + end.height
        assert all(a.x <= b.x for a, b in pairwise(route))
    assert not crossed(placed)


@pytest.mark.slow
@given(graphs())
@settings(max_examples=30, deadline=None)
def test_everything_lies_within_the_drawing(
    graph: tuple[dict[str, tuple[float, float]], list[Joint]],
) -> None:
    placed = layout(*graph)
    for box in placed.boxes.values():
        assert box.x >= -1e-9
        assert box.y >= -1e-9
        assert box.x + box.width <= placed.width + 1e-9
        assert box.y + box.height <= placed.height + 1e-9
    for point in (p for route in placed.routes for p in route):
        assert -1e-9 <= point.x <= placed.width + 1e-9
        assert -1e-9 <= point.y <= placed.height + 1e-9


def test_wires_that_need_not_cross_do_not() -> None:
    sizes = dict.fromkeys(("a", "b", "c", "w", "v", "u"), (50.0, 30.0))
    placed = layout(sizes, [Joint("a", "u"), Joint("b", "v"), Joint("c", "w")])
    tops = [placed.boxes[n].y for n in ("a", "b", "c")]
    ends = [placed.boxes[n].y for n in ("u", "v", "w")]
    assert [tops.index(t) for t in sorted(tops)] == [ends.index(t) for t in sorted(ends)]


def test_a_chain_of_data_lies_on_one_line_in_spite_of_a_long_condition() -> None:
    names = "abcdef"
    sizes = dict.fromkeys(names, (60.0, 30.0))
    joints = [Joint(a, b) for a, b in pairwise(names)] + [Joint("a", "f", 0.0, 0.01)]
    placed = layout(sizes, joints)
    middles = [placed.boxes[n].middle for n in names]
    assert max(middles) - min(middles) < 1.0
    long = placed.routes[-1]
    assert len({round(p.y, 6) for p in long[1:-1]}) == 1, "the long wire runs level"


def test_a_box_that_reads_nothing_stands_beside_what_reads_it() -> None:
    sizes = dict.fromkeys(("frame", "a", "b", "table"), (60.0, 30.0))
    joints = [Joint("frame", "a"), Joint("a", "b"), Joint("table", "b")]
    placed = layout(sizes, joints)
    assert placed.boxes["table"].x == placed.boxes["a"].x


def test_a_cycle_is_refused() -> None:
    with pytest.raises(nx.NetworkXUnfeasible, match="cycle"):
        layout({"a": (9.0, 9.0), "b": (9.0, 9.0)}, [Joint("a", "b"), Joint("b", "a")])


@pytest.mark.slow
def test_the_drawing_is_the_same_under_two_hash_seeds() -> None:
    code = (
        "from helpers_draw import branched; from tactile_graph.draw.svg import graph_svg; "
        "import sys; sys.stdout.write(graph_svg(branched(), {'dear', 'fine'}))"
    )
    drawn = set()
    for seed in ("1", "77"):
        env = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join(sys.path)}
        done = subprocess.run(
            [sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True
        )
        drawn.add(done.stdout)
    assert drawn == {graph_svg(branched(), {"dear", "fine"})}


@pytest.mark.parametrize("pipeline", [circle_demo, branched])
def test_pipelines_are_drawn_the_same_each_time(pipeline: type) -> None:
    assert graph_svg(pipeline()) == graph_svg(pipeline())
