"""Dead lines are bridged, live ones never, however empty they are."""

from __future__ import annotations

import numpy as np
import pytest

from tactile_graph.wires import Image, Mask
from tactile_graph_filters.contacts.bridge_lines import bridge_lines
from tactile_graph_filters.contacts.contacts import contacts


def pressed(dead_rows: tuple[int, ...] = (), dead_columns: tuple[int, ...] = ()) -> Image:
    """One object over rows 2 to 8 and columns 3 to 9 of a noisy pad, some lines reading 0."""
    values = np.random.default_rng(0).normal(0.0, 0.01, (12, 14))
    values[2:9, 3:10] += 1.0
    values[list(dead_rows)] = 0.0
    values[:, list(dead_columns)] = 0.0
    return Image(values)


def n_contacts(image: Image, most: int = 2) -> int:
    mask = Mask(image.values > 0.5)
    return contacts(image, bridge_lines(image, mask, most=most)).count


@pytest.mark.parametrize(
    ("rows", "columns"), [((5,), ()), ((), (6,)), ((4, 5), ()), ((5,), (6,)), ((0, 11), (5,))]
)
def test_what_dead_lines_part_is_one_again(rows: tuple[int, ...], columns: tuple[int, ...]) -> None:
    image = pressed(rows, columns)
    assert n_contacts(image) == 1


def test_no_more_lines_than_told_are_bridged() -> None:
    assert n_contacts(pressed((4, 5)), most=1) == 2
    assert n_contacts(pressed((5,)), most=0) == 2


def test_lines_without_a_valid_cell_are_dead() -> None:
    values = pressed().values.copy()
    valid = np.ones(values.shape, bool)
    valid[5] = False
    values[5] = 0.0
    assert n_contacts(Image(values, valid=valid)) == 1


def test_two_objects_an_unloaded_row_apart_stay_two() -> None:
    values = np.random.default_rng(0).normal(0.0, 0.01, (12, 14))
    values[2:5, 3:10] += 1.0
    values[6:9, 3:10] += 1.0
    assert n_contacts(Image(values)) == 2
    silent = np.zeros((12, 14))
    silent[2:5, 3:10] = silent[6:9, 3:10] = 1.0
    assert n_contacts(Image(silent)) == 2


def test_without_a_dead_line_the_mask_is_the_very_same() -> None:
    image = pressed()
    mask = Mask(image.values > 0.5)
    assert bridge_lines(image, mask) is mask
    nothing = Image(np.zeros((5, 5)))
    empty = Mask(np.zeros((5, 5), bool))
    assert bridge_lines(nothing, empty) is empty


def test_only_cells_of_dead_lines_change() -> None:
    on = np.random.default_rng(2).random((12, 14)) < 0.5
    image = pressed((3, 4), (6,))
    found = bridge_lines(image, Mask(on), most=2).values
    dead = np.zeros((12, 14), bool)
    dead[[3, 4]] = dead[:, 6] = True
    assert np.array_equal(found[~dead], on[~dead])
    live = [j for j in range(14) if j != 6]
    for row in found[3:5, live]:
        assert np.array_equal(row, (on[2] & on[5])[live])
