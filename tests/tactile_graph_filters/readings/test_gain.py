import gzip
import lzma
import os

import numpy as np
import pytest

from helpers_filters import image_of, same_grid
from tactile_graph.errors import DataError, RuleError
from tactile_graph_filters.readings.gain import Gain


def test_readings_are_divided_by_the_product_of_the_gains():
    image = image_of([[2.0, 8.0], [3.0, 12.0]], "siemens")
    found = Gain(rows=[1.0, 1.5], columns=[1.0, 2.0], elements=[[2.0, 1.0], [1.0, 1.0]])(image)
    assert found.values.tolist() == [[1.0, 4.0], [2.0, 4.0]]
    assert found.quantity == "siemens"
    assert same_grid(image, found)


def test_an_element_with_gain_zero_becomes_invalid():
    found = Gain(columns=[1.0, 0.0])(image_of([[2.0, 8.0], [3.0, 12.0]]))
    assert found.valid.tolist() == [[True, False], [True, False]]
    assert found.values.tolist() == [[2.0, 0.0], [3.0, 0.0]]
    both = Gain(columns=[1.0, 0.0])(image_of([[0.0, 8.0]], valid=[[False, True]]))
    assert both.valid.tolist() == [[False, False]]


@pytest.mark.parametrize("ending", [".npy", ".csv", ".csv.gz"])
def test_gains_can_be_read_from_a_file(tmp_path, ending):
    path = tmp_path / f"gains{ending}"
    if ending == ".npy":
        np.save(path, np.array([[1.0, 4.0]]))
    elif ending == ".csv.gz":
        path.write_bytes(gzip.compress(b"1,4\n"))
    else:
        path.write_text("1,4\n")
    assert Gain(elements=str(path))(image_of([[2.0, 8.0]])).values.tolist() == [[2.0, 2.0]]


@pytest.mark.parametrize(
    ("ending", "data"),
    [
        (".csv", b"1\r2\r"),
        (".csv", b"1\r\r\n2\r\r\n"),
        (".csv.lzma", lzma.compress(b"1\n2\n", lzma.FORMAT_ALONE)),
    ],
)
def test_lines_may_end_as_on_any_machine_and_be_packed_as_numpy_knows(tmp_path, ending, data):
    path = tmp_path / f"gains{ending}"
    path.write_bytes(data)
    assert Gain(elements=str(path))(image_of([[2.0], [8.0]])).values.tolist() == [[2.0], [4.0]]


def test_a_file_that_is_no_table_is_refused(tmp_path):
    path = tmp_path / "gains.csv"
    path.write_text("1,two\n")
    with pytest.raises(DataError, match=r"gains\.csv: must hold a table of gains"):
        Gain(elements=str(path))
    with pytest.raises(DataError, match=r"none\.csv: must hold a table of gains"):
        Gain(elements=str(tmp_path / "none.csv"))


def test_a_file_far_larger_than_any_pad_is_not_read(tmp_path):
    array, packed = tmp_path / "gains.npy", tmp_path / "gains.csv.gz"
    np.lib.format.open_memmap(array, "w+", np.float64, (20_000, 20_000))  # takes no room
    packed.write_bytes(gzip.compress(b"1," * 10_000_000, 1))
    for path, words in ((array, "3,200 MB or more, allowed are 16"), (packed, "16 MB or more")):
        with pytest.raises(DataError, match=words):
            Gain(elements=str(path))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
def test_what_has_no_end_is_not_opened(tmp_path):
    pipe = tmp_path / "gains.csv"
    os.mkfifo(pipe)
    for path in (pipe, "/dev/zero"):
        with pytest.raises(DataError, match="is no plain file"):
            Gain(elements=str(path))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({}, "at least one of rows, columns and elements"),
        ({"rows": [-1.0]}, "rows: a gain must be 0 or more, got -1.0"),
        ({"columns": [float("nan")]}, "columns: a gain must be 0 or more, got nan"),
        ({"elements": [[1.0], [1.0, 2.0]]}, "elements: must be equally long rows"),
        ({"rows": [1.0] * 3, "elements": [[1.0], [2.0]]}, "3 rows and 1 columns .* fit 2 x 1"),
    ],
)
def test_gains_that_make_no_sense_are_refused(settings, words):
    with pytest.raises(ValueError, match=words):
        Gain(**settings)


def test_an_image_of_another_size_is_refused():
    with pytest.raises(RuleError, match="gains for 3 rows, got an image with 2"):
        Gain(rows=[1.0, 1.0, 1.0])(image_of([[1.0], [1.0]]))
