import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from tactile_graph_filters.morphology.elements import ElementSetting, parse_element


def test_cross3_is_the_smallest_round_element_of_the_thesis():
    assert parse_element("cross3").cells.tolist() == [[0, 1, 0], [1, 1, 1], [0, 1, 0]]


@pytest.mark.parametrize(
    ("name", "rows"),
    [("disc5", [1, 3, 5, 3, 1]), ("disc7", [1, 5, 5, 7, 5, 5, 1]), ("square3", [3, 3, 3])],
)
def test_rows_of_named_elements_are_as_long_as_documented(name, rows):
    cells = parse_element(name).cells
    assert cells.sum(axis=1).tolist() == rows
    assert (cells == cells.T).all()
    assert (cells == cells[::-1]).all()


def test_a_size_may_stand_behind_a_colon_and_be_any_odd_number():
    assert (parse_element("disc:5").cells == parse_element("disc5").cells).all()
    assert parse_element("square:21").cells.shape == (21, 21)
    assert parse_element("cross:9").cells.sum() == 17


def test_a_matrix_is_taken_as_it_is_and_its_offsets_count_from_the_centre():
    element = parse_element([[0, 1, 1], [0, 0, 0], [0, 0, 0]])
    assert element.offsets.tolist() == [[-1, 0], [-1, 1]]
    assert element.reflected.offsets.tolist() == [[1, -1], [1, 0]]
    assert element.reach == (1, 1)
    assert not element.cells.flags.writeable


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("disk5", r"unknown structuring element 'disk5'; did you mean 'disc5'\?"),
        ("Cross3", "unknown structuring element 'Cross3'"),
        ("disc", "unknown structuring element 'disc'"),
        ("disc4", "'disc4': its size must be odd and at most 255, got 4"),
        ("square:257", "must be odd and at most 255, got 257"),
        ([[1, 1]], "sides must be odd, so that it has a central cell, got 1 x 2"),
        ([[1], [1]], "sides must be odd.* got 2 x 1"),
        ([], "rows must be equally long"),
        ([[]], "sides must be odd.* got 1 x 0"),
        ([[1, 1, 1], [1], [1, 1, 1]], r"rows must be equally long, got \[1, 3\]"),
        ([[0, 2, -1]], "must hold 0 and 1, got -1, 2"),
        ([[0, 0, 0]], "must hold at least one 1, got none"),
        ([[1] * 257], "sides must be at most 255"),
    ],
)
def test_what_is_no_element_is_refused_in_words(spec, words):
    with pytest.raises(ValueError, match=words):
        parse_element(spec)
    with pytest.raises(ValidationError, match="structuring element"):
        TypeAdapter(ElementSetting).validate_python(spec)


def test_a_setting_is_written_down_as_it_was_given():
    given = TypeAdapter(ElementSetting).validate_python([[0, 1, 0], [1, 1, 1], [0, 1, 0]])
    assert np.array_equal(parse_element(given).cells, parse_element("cross3").cells)
    assert TypeAdapter(ElementSetting).validate_python("disc:9") == "disc:9"


def test_repeating_an_element_is_what_dilating_so_often_comes_to():
    assert parse_element("cross3").repeated(2).cells.sum(axis=1).tolist() == [1, 3, 5, 3, 1]
    lopsided = parse_element([[0, 1, 1], [0, 0, 0], [0, 0, 0]])
    assert lopsided.repeated(1).offsets.tolist() == [[-1, 0], [-1, 1]]
    assert lopsided.repeated(3).offsets.tolist() == [[-3, 0], [-3, 1], [-3, 2], [-3, 3]]


def test_an_element_repeated_too_often_is_refused_in_words():
    with pytest.raises(ValueError, match="'disc5' repeated 64 times is longer than 255"):
        parse_element("disc5").repeated(64)
    assert parse_element("cross3").repeated(127).cells.shape == (255, 255)
