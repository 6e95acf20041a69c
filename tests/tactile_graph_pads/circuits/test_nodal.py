"""The reference solver itself, on networks that can be solved by hand."""

from fractions import Fraction

import numpy as np
import pytest

from helpers_circuits import spread_siemens
from tactile_graph_pads.circuits.nodal import measured_ratio, node_voltages


def test_two_resistors_divide_the_voltage_in_exact_numbers():
    volts = node_voltages(
        3, [(0, 1, Fraction(1, 3)), (1, 2, Fraction(1, 6))], {0: Fraction(9), 2: Fraction(0)}
    )
    assert volts == [9, 6, 0]


def test_a_balanced_bridge_carries_no_current_across():
    edges = [(0, 1, 1.0), (0, 2, 2.0), (1, 3, 3.0), (2, 3, 6.0), (1, 2, 17.0)]
    volts = node_voltages(4, edges, {0: 1.0, 3: 0.0})
    assert volts[1] == pytest.approx(volts[2])
    assert volts[1] == pytest.approx(0.25)


def test_a_node_without_a_way_to_a_source_is_at_zero():
    assert node_voltages(4, [(0, 1, 1.0), (2, 3, 1.0)], {0: 5.0}) == [5.0, 5.0, 0.0, 0.0]


def test_parallel_conductances_add():
    volts = node_voltages(3, [(0, 1, 1.0), (1, 0, 2.0), (1, 2, 3.0)], {0: 4.0, 2: 0.0})
    assert volts[1] == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("kind", "driver", "mux"), [("divider", 40.0, 70.0), ("floating", 40.0, 70.0)]
)
def test_it_agrees_with_a_dense_linear_solver(kind, driver, mux):
    siemens, bias = spread_siemens(3, (3, 4)), 33e3
    found = np.array(measured_ratio(kind, siemens.tolist(), bias, driver, mux))
    for i in range(3):
        for j in range(4):
            matrix, right = np.zeros((7, 7)), np.zeros(7)
            for a in range(3):
                for b in range(4):
                    e = np.zeros(7)
                    e[a], e[3 + b] = 1.0, -1.0
                    matrix += siemens[a, b] * np.outer(e, e)
                if kind == "divider" or a == i:
                    matrix[a, a] += 1.0 / driver
            right[i] = 1.0 / driver
            matrix[3 + j, 3 + j] += 1.0 / (bias + mux)
            volts = np.linalg.solve(matrix, right)
            assert found[i, j] == pytest.approx(volts[3 + j] * bias / (bias + mux), rel=1e-9)
