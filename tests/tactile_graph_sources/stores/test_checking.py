"""What is wrong with a store is named; what another part of it vouches for is mended."""

from __future__ import annotations

import errno
import json
import os
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from tactile_graph import Circle, Frame
from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps import Report
from tactile_graph.wires import TrueObject
from tactile_graph_sources.store import read_store
from tactile_graph_sources.stores import journal
from tactile_graph_sources.stores.checking import check
from tactile_graph_sources.stores.stored import UNSURE
from tactile_graph_sources.writers.write_store import StoreWriter

zarr = pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
ABOUT = "10 frames of 3 x 2 cells, volt, version 3"


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "a.zarr"
    rng = np.random.default_rng(0)
    with StoreWriter(path, chunk=4) as writer:
        for i in range(10):
            disc = (TrueObject(Circle(1.0, 2.0, float(i + 1)), 5.0, "disc"),)
            values = rng.random((3, 2))
            writer.write(Frame.of(values, quantity="volt", index=i, time_s=0.1 * i, truth=disc))
    return path


def plain(path: Path) -> list[object]:
    return [
        (f.index, f.image.values.tolist(), f.time_s, f.truth, f.gap, f.doubtful)
        for f in read_store(path)
    ]


def test_a_store_that_is_as_it_was_written_is_right(store: Path) -> None:
    assert check(store) == (ABOUT, (), (), ())
    assert check(store, repair=True) == (ABOUT, (), (), ())


@pytest.mark.slow  # many stores
@pytest.mark.parametrize("name", ["", "values", "time_s", "gap", "notes", "number"])
def test_metadata_are_written_anew(store: Path, name: str) -> None:
    whole = plain(store)
    (store / name / "zarr.json").write_text("{")
    told = f"{name}/zarr.json is damaged".removeprefix("/")
    assert check(store) == (ABOUT, (told,), (), ())
    assert check(store, repair=True) == (ABOUT, (), (told,), ())
    report = Report()
    assert len(list(read_store(store, report))) == 10
    assert report.troubles == []
    assert plain(store) == whole
    group = zarr.open_group(str(store), mode="r")
    assert group["values"].shape == (10, 3, 2)
    np.testing.assert_array_equal(group["number"][:], np.arange(10))


def test_what_was_said_of_the_group_besides_stays(store: Path) -> None:
    group = zarr.open_group(str(store), mode="r+")
    group.attrs["mine"] = 7
    group.attrs["quantity"] = "gram"
    assert check(store, repair=True).mended == ("zarr.json is damaged",)
    assert dict(zarr.open_group(str(store), mode="r").attrs).items() >= {
        ("mine", 7),
        ("quantity", "volt"),
    }


@pytest.mark.slow  # many stores
@pytest.mark.parametrize("name", ["time_s", "gap", "notes", "notes_end", "number"])
@pytest.mark.parametrize("gone", [False, True])
def test_arrays_other_than_the_values_are_written_anew_from_the_journal(
    store: Path, name: str, gone: bool
) -> None:
    if name == "gap":
        zarr.open_group(str(store), mode="r+")["gap"][3] = True
    elif gone:
        shutil.rmtree(store / name / "c")
    else:
        (store / name / "c" / "0").write_bytes(b"junk")
    whole = plain(store)
    assert len(check(store).wrong) >= 1
    checked = check(store, repair=True)
    assert checked.wrong == ()
    assert plain(store) == whole
    (store / "frames.journal").unlink()  # what is left are the arrays
    assert [p[:4] for p in plain(store)] == [p[:4] for p in whole]  # type: ignore[index]


@pytest.mark.slow
def test_a_damaged_journal_is_written_anew_and_its_frames_stay_doubtful(store: Path) -> None:
    whole = plain(store)
    (store / "frames.journal").write_bytes(
        (store / "frames.journal").read_bytes().replace(b"rows", b"bows", 1)
    )
    checked = check(store, repair=True)
    assert checked.wrong == ()
    assert "line 2 of its journal is damaged" in checked.mended
    assert [p[:-1] for p in plain(store)] == [p[:-1] for p in whole]  # type: ignore[index]
    assert [f.index for f in read_store(store) if f.doubtful] == [0, 1, 2, 3]
    assert check(store, repair=True) == (ABOUT, (), (), ())


@pytest.mark.slow
def test_lost_frames_stay_told_as_lost(store: Path) -> None:
    """Mending neither brings them back nor hides that they were there."""
    (store / "values" / "c" / "2" / "0" / "0").unlink()
    (store / "frames.journal").unlink()
    told = "frames 8 to 9: lost: values/c/2/0/0 is gone"
    assert told in check(store).wrong
    assert check(store, repair=True).wrong == (UNSURE, told)
    assert check(store, repair=True) == (ABOUT, (UNSURE, told), (), ())
    report = Report()
    assert [f.index for f in read_store(store, report)] == list(range(8))
    assert report.troubles == [(str(store), UNSURE), (str(store), told)]


def test_frames_that_nothing_numbers_stay_told_as_lost(store: Path) -> None:
    shutil.rmtree(store / "number" / "c")
    (store / "frames.journal").unlink()
    checked = check(store, repair=True)
    assert checked.wrong == (UNSURE, "frames 0 to 9: lost: nothing numbers them")
    with pytest.raises(DataError, match="not a single frame"):
        list(read_store(store))


def test_what_a_killed_writer_left_is_swept_away(store: Path) -> None:
    (store / "values" / "c" / "0" / "0" / "0.abc.partial").write_bytes(b"half")
    group = zarr.open_group(str(store), mode="r+")
    group["values"].resize((14, 3, 2))
    with (store / "frames.journal").open("ab") as lines:
        lines.write(b"0123abcd {")
    left = (
        "the last line of its journal was not finished",
        "values/zarr.json tells of 14 frames, there are 10",
        "1 file that a writer left unfinished",
    )
    assert check(store) == (ABOUT, (), (), left)
    assert check(store, repair=True) == (ABOUT, (), left, ())
    assert len(plain(store)) == 10


def test_a_line_of_which_a_full_disc_took_a_part_is_none_of_the_journal(
    store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Or the next one, once there is room, would be taken for its end."""
    write, said = os.write, [9]

    def some(file: int, data: bytes) -> int:
        if not said:
            raise OSError(errno.ENOSPC, "No space left on device")
        return write(file, data[: said.pop()])

    with StoreWriter(store, append=True) as writer:
        writer.write(Frame.of(np.ones((3, 2)), quantity="volt"))
        with monkeypatch.context() as patched:
            patched.setattr(journal, "os", SimpleNamespace(**{**vars(os), "write": some}))
            with pytest.raises(UsageError, match="No space left"):
                writer.flush()
    assert check(store).wrong == ()
    assert len(plain(store)) == 11


@pytest.mark.slow
def test_frames_are_gone_on_with_after_mending(store: Path) -> None:
    (store / "time_s" / "zarr.json").unlink()
    check(store, repair=True)
    with StoreWriter(store, append=True) as writer:
        writer.write(Frame.of(np.ones((3, 2)), quantity="volt"))
    assert [f.index for f in read_store(store)] == list(range(11))
    assert check(store).wrong == ()


def test_a_store_that_is_written_to_is_not_mended(store: Path) -> None:
    with StoreWriter(store, append=True):
        (store / "time_s" / "zarr.json").unlink()
        with pytest.raises(UsageError, match="is being written to by process"):
            check(store, repair=True)


def test_another_zarr_store_is_no_recording(tmp_path: Path) -> None:
    zarr.create_group(str(tmp_path / "b.zarr"))
    with pytest.raises(DataError, match="is a Zarr store, but not a recording"):
        check(tmp_path / "b.zarr")


def test_a_shape_that_would_fill_the_memory_is_refused(store: Path) -> None:
    (store / "frames.journal").unlink()
    file = store / "values" / "zarr.json"
    data = json.loads(file.read_text())
    data["shape"] = [10, 10**9, 10**9]
    file.write_text(json.dumps(data))
    with pytest.raises(DataError, match=r"values/zarr.json is damaged"):
        list(read_store(store))


def test_frames_of_a_cut_journal_that_nothing_numbers_any_more_stay_told_as_lost(
    store: Path,
) -> None:
    """They are less than a chunk, as a killed writer leaves them, and yet were whole."""
    lines = (store / "frames.journal").read_bytes().splitlines(keepends=True)
    (store / "frames.journal").write_bytes(b"".join(lines[:-1]))
    shutil.rmtree(store / "number")
    told = "frames 8 to 9: lost: nothing numbers them"
    assert check(store, repair=True).wrong == (told,)
    report = Report()
    assert len(list(read_store(store, report))) == 8
    assert report.troubles == [(str(store), told)]


def test_a_store_that_could_not_be_begun_leaves_the_right_to_write_to_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disc was full when it was to be written down who writes."""
    path = tmp_path / "a.zarr"

    def full(*_: object, **__: object) -> None:
        (tmp_path / ".a.zarr.writer").touch()
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_text", full)
        with pytest.raises(UsageError, match="No space left"):
            StoreWriter(path)
    assert not list(tmp_path.glob(".*.writer"))
    StoreWriter(path).close()
