"""An output under way: what counts of it, whatever a killed run left."""

from __future__ import annotations

from pathlib import Path

import pytest

from tactile_graph.cli.many.unfinished import Unfinished
from tactile_graph.errors import UsageError

OF = {"pipeline": "p", "options": "o"}


def begun(folder: Path) -> Unfinished:
    unfinished = Unfinished(str(folder / "out.csv"))
    unfinished.begin(OF)
    unfinished.add(10, b"a\n" * 10, {"n": 10})
    unfinished.add(25, b"b\n" * 15, {"n": 25})
    return unfinished


def read(folder: Path) -> Unfinished:
    unfinished = Unfinished(str(folder / "out.csv"))
    assert unfinished.read() == OF
    return unfinished


def test_what_was_kept_is_gone_on_with(tmp_path: Path) -> None:
    begun(tmp_path).close()
    again = read(tmp_path)
    assert (again.high, again.so_far) == (25, {"n": 25})
    again.add(30, b"c\n", {"n": 26})
    assert list(again.parts()) == [b"a\n" * 10, b"b\n" * 15, b"c\n"]
    again.remove()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("cut", range(1, 60, 7))
def test_a_cut_journal_or_part_counts_as_far_as_it_is_whole(tmp_path: Path, cut: int) -> None:
    begun(tmp_path).close()
    for name in (".out.csv.journal", ".out.csv.parts"):
        whole = (tmp_path / name).read_bytes()
        (tmp_path / name).write_bytes(whole[:-cut])
        again = read(tmp_path)
        parts = list(again.parts())
        assert parts == [b"a\n" * 10, b"b\n" * 15][: len(parts)]
        assert again.high == {0: None, 1: 10, 2: 25}[len(parts)]
        again.add(99, b"more\n", {})
        again.close()
        last = read(tmp_path)
        assert list(last.parts()) == [*parts, b"more\n"]
        last.close()
        begun(tmp_path).close()


def test_a_changed_byte_ends_what_counts(tmp_path: Path) -> None:
    begun(tmp_path).close()
    file = tmp_path / ".out.csv.parts"
    data = bytearray(file.read_bytes())
    data[25] ^= 1
    file.write_bytes(data)
    again = read(tmp_path)
    assert again.high == 10
    again.close()


def test_without_a_whole_first_line_nothing_is_gone_on_with(tmp_path: Path) -> None:
    begun(tmp_path).close()
    (tmp_path / ".out.csv.journal").write_bytes(b"0 {}\n")
    assert Unfinished(str(tmp_path / "out.csv")).read() is None


def test_two_runs_do_not_write_the_same(tmp_path: Path) -> None:
    first = begun(tmp_path)
    with pytest.raises(UsageError, match="another run is writing it"):
        Unfinished(str(tmp_path / "out.csv")).begin(OF)
    first.remove()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no full device")
@pytest.mark.parametrize("which", ["parts", "journal"])
def test_a_full_disc_is_told_by_name_and_what_was_kept_counts(tmp_path: Path, which: str) -> None:
    before = begun(tmp_path)
    number = ("parts", "journal").index(which)
    before._files[number].close()
    before._files[number] = open("/dev/full", "wb")  # noqa: SIM115 -- closed by what is tested
    with pytest.raises(UsageError, match=r"out\.csv: cannot be written: No space left"):
        before.add(30, b"c\n", {"n": 26})
    before.close()
    again = read(tmp_path)
    assert (again.high, again.so_far) == (25, {"n": 25})
    again.close()


def test_what_is_left_beside_an_output_that_is_whole_goes(tmp_path: Path) -> None:
    begun(tmp_path).close()
    Unfinished(str(tmp_path / "out.csv")).clear()
    assert list(tmp_path.iterdir()) == []


def test_what_another_run_is_at_stays(tmp_path: Path) -> None:
    first = begun(tmp_path)
    Unfinished(str(tmp_path / "out.csv")).clear()
    assert sorted(p.name for p in tmp_path.iterdir()) == [".out.csv.journal", ".out.csv.parts"]
    first.remove()


def test_pipes_and_devices_keep_nothing() -> None:
    assert not Unfinished.possible("-")
    assert not Unfinished.possible("/dev/null")
    assert Unfinished.possible("out.csv")
