"""The likelihood that the least error is found by: certain in all, its shares the simulator's."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from tactile_graph import Circle, Rectangle

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import least_on_kinds as least
from second_simulator import BASE, KINDS, Bench

pytestmark = pytest.mark.slow  # its loops are compiled


@pytest.mark.parametrize("shape", [Circle(9.3, 8.1, 5.1), Rectangle(9.3, 8.1, 11.0, 5.0, 0.4)])
@pytest.mark.parametrize("kind", ["noise 0.2 mV", "leaning face", "round face", "hollow face"])
def test_shares_are_those_of_the_simulators_points(kind, shape):
    bench = Bench(KINDS[kind], np.random.default_rng(1))
    u, v = bench._places(shape)
    pressed = np.where(u * u + v * v <= 1.0, np.maximum(bench.kind.pressure(u, v), 0.0), 0.0)
    n = bench.y.size // bench.kind.rows
    counted = pressed.reshape(bench.kind.rows, n, bench.kind.columns, n).mean(axis=(1, 3))
    face, p = least.FACES.index(bench.kind.pressure.__name__), least.point(shape, 0.0, 0.4)
    shares = [[least.share(p, 1.3 * j, 1.3 * i, 1.0, face) for j in range(16)] for i in range(16)]
    assert np.abs(np.array(shares) - counted).max() < 0.05
    assert np.sum(shares) == pytest.approx(counted.sum(), rel=0.01)


def known_at(log_load, state, kind=BASE):
    one = np.ones((1, 1))
    numbers = np.array([1.3, 1.0, kind.sigma, kind.voids, kind.strays, kind.turn_on_g])
    return least.Known(
        np.full((1, 1), state), log_load * one, log_load * one, 1e-3 * one, 0.0 * one, numbers, 0
    )


@pytest.mark.parametrize("strays", [0.0, 0.04])
@pytest.mark.parametrize("mean_g", [8.0, 30.0, 150.0])
def test_what_an_element_may_read_is_certain_in_all(mean_g, strays):
    kind = replace(BASE, strays=strays)
    logs = np.linspace(math.log(2.0), math.log(5000.0), 4000)
    on = [math.exp(least.reading(known_at(x, least.ON, kind), 0, 0, mean_g)) for x in logs]
    none = math.exp(least.reading(known_at(0.0, least.OFF, kind), 0, 0, mean_g))
    assert none + float(trapezoid(on, logs)) == pytest.approx(1.0, abs=0.02)


def test_a_frame_is_likelier_where_its_object_lies():
    bench = Bench(KINDS["noise 3 mV"], np.random.default_rng(3))
    (frame,) = bench.frames(1)
    told, (true,) = least.known(bench.kind, bench, frame), frame.truth
    log_load = math.log(true.weight_g / true.shape.area_cm2 * 1.69)
    here = least.log_likelihood(told, least.point(true.shape, log_load, 0.0))
    for off in ((1.5, 0.0, 0.0), (0.0, -1.5, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)):
        p = least.point(true.shape, log_load, 0.0)
        p[:3] += off
        assert least.log_likelihood(told, p) < here - 3.0
