"""Lists of recordings and loads are read, or refused by file and line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tactile_graph.errors import DataError, PipelineError, UsageError
from tactile_graph_pads.calibration.lists import Loaded, parse_loaded, read_loads


def test_lists_of_loads_are_read_relative_to_their_folder(tmp_path: Path) -> None:
    expected = [Loaded(tmp_path / f"load-{g}.npz", float(g)) for g in (100, 200)]
    (tmp_path / "l.yaml").write_text("load-100.npz: 100\nload-200.npz: 200\n")
    (tmp_path / "m.yml").write_text("- load-100.npz: 100\n- load-200.npz: 200\n")
    (tmp_path / "l.csv").write_text("recording, load_g\nload-100.npz, 100\nload-200.npz,200\n")
    for name in ("l.yaml", "m.yml", "l.csv"):
        assert read_loads(tmp_path / name) == expected


def test_a_list_from_a_spreadsheet_is_read_as_it_was_saved(tmp_path: Path) -> None:
    path = tmp_path / "l.csv"
    path.write_bytes("\ufeffrecording;load_g\r\na.npz;100,5\r\nb.npz;20\r\n".encode())
    assert read_loads(path) == [Loaded(tmp_path / "a.npz", 100.5), Loaded(tmp_path / "b.npz", 20.0)]
    path.write_text("load_g\trecording\n7\ta.npz\n")
    assert read_loads(path) == [Loaded(tmp_path / "a.npz", 7.0)]
    path.write_bytes("recording\tload_g\r\nä.npz\t7\r\n".encode("utf-16"))  # "Unicode text"
    assert read_loads(path) == [Loaded(tmp_path / "ä.npz", 7.0)]
    path.write_bytes("recording;load_g\nä.npz;7\n".encode("latin-1"))
    with pytest.raises(DataError, match=r"l\.csv:2: is not UTF-8 text; save it as UTF-8"):
        read_loads(path)
    path.write_text("recording;load_g\na.npz;1,500\n")  # of thousands, or of grams?
    with pytest.raises(UsageError, match=r"l\.csv:2: a load is a number .*, got '1,500'"):
        read_loads(path)


def test_a_wrong_load_of_a_list_names_its_recording(tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_text("a.npz: 1\nb.npz: x\n")
    with pytest.raises(UsageError, match=r"l\.yaml, b\.npz: a load is a number .*, got 'x'"):
        read_loads(tmp_path / "l.yaml")


def test_a_list_without_its_columns_is_refused(tmp_path: Path) -> None:
    (tmp_path / "l.csv").write_text("file,grams\na,1\n")
    with pytest.raises(DataError, match=r"l.csv:1: needs the columns recording and load_g"):
        read_loads(tmp_path / "l.csv")


def test_a_list_that_is_none_is_refused(tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_text("hello")
    with pytest.raises(DataError, match=r"must map recordings to grams, got 'hello'"):
        read_loads(tmp_path / "l.yaml")
    (tmp_path / "l.yaml").write_text("a: [1")
    with pytest.raises(PipelineError, match=r"l.yaml:.*this is not YAML"):
        read_loads(tmp_path / "l.yaml")


@pytest.mark.parametrize("weight", ["x", "0", "-5", "nan", "inf", ""])
def test_a_load_is_a_weight(weight: str) -> None:
    with pytest.raises(UsageError, match="a load is a number of grams above 0, got"):
        parse_loaded(f"a.npz={weight}")


def test_a_file_whose_name_holds_an_equals_sign_is_a_file(tmp_path: Path) -> None:
    path = tmp_path / "a=3.npz"
    path.touch()
    assert parse_loaded(str(path)) == Loaded(path, None)
    assert parse_loaded(f"{path}=40") == Loaded(path, 40.0)
