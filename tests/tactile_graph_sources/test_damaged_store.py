"""A store that lost a part is read as far as it goes, and says what is gone."""

from __future__ import annotations

import json
import shutil
import zlib
from pathlib import Path

import numpy as np
import pytest

from tactile_graph import Frame
from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps import Report
from tactile_graph_sources.store import read_store
from tactile_graph_sources.stores.checking import check
from tactile_graph_sources.stores.stored import UNSURE
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


@pytest.fixture
def store(tmp_path: Path) -> Path:
    path = tmp_path / "a.zarr"
    rng = np.random.default_rng(0)
    with StoreWriter(path, chunk=4) as writer:
        for i in range(10):
            writer.write(Frame.of(rng.random((3, 2)), quantity="volt", index=i, time_s=0.1 * i))
    return path


def index_and_gaps(path: Path) -> tuple[list[int], list[int], Report]:
    report = Report()
    frames = list(read_store(path, report))
    return [f.index for f in frames], [f.index for f in frames if f.gap], report


def test_a_damaged_chunk_is_lost_named_and_followed_by_a_gap(store: Path) -> None:
    part = store / "values" / "c" / "1" / "0" / "0"
    part.write_bytes(part.read_bytes()[:10])
    index, gaps, report = index_and_gaps(store)
    assert (index, gaps) == ([0, 1, 2, 3, 8, 9], [8])
    assert report.counts["damaged records skipped"] == 4
    told = "frames 4 to 7: lost: values/c/1/0/0 is damaged: its checksum is wrong"
    assert report.troubles == [(str(store), told)]


def test_a_chunk_that_is_gone_is_lost_and_named(store: Path) -> None:
    shutil.rmtree(store / "values" / "c" / "1")
    index, gaps, report = index_and_gaps(store)
    assert (index, gaps) == ([0, 1, 2, 3, 8, 9], [8])
    assert report.troubles == [(str(store), "frames 4 to 7: lost: values/c/1/0/0 is gone")]


def test_a_chunk_of_another_place_is_not_given_for_it(store: Path) -> None:
    shutil.copy(store / "values" / "c" / "0" / "0" / "0", store / "values" / "c" / "1" / "0" / "0")
    index, _, report = index_and_gaps(store)
    assert index == [0, 1, 2, 3, 8, 9]
    told = "frames 4 to 7: lost: values/c/1/0/0 is not what was written"
    assert report.troubles == [(str(store), told)]


def test_frames_of_which_no_cell_is_valid_are_no_damage(tmp_path: Path) -> None:
    """Zarr writes no chunk for them, so that it looks like one that is gone."""
    with StoreWriter(tmp_path / "a.zarr", chunk=2) as writer:
        for i in range(4):
            values = np.full((2, 2), np.nan if i < 2 else 1.0)
            writer.write(Frame.of(values, quantity="volt", index=i))
    index, _, report = index_and_gaps(tmp_path / "a.zarr")
    assert (index, report.troubles) == ([0, 1, 2, 3], [])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "how"),
    [
        *(("", "other"), ("values", "cut"), ("values", "other"), ("time_s", "gone")),
        *(
            pytest.param(name, how, marks=pytest.mark.slow)
            for name, hows in {
                "": ("gone", "cut"),
                "values": ("gone",),
                "time_s": ("cut", "other"),
                "number": ("gone", "cut", "other"),
            }.items()
            for how in hows
        ),
    ],
)
def test_damaged_metadata_are_told_and_every_frame_is_read(
    store: Path, name: str, how: str
) -> None:
    """A shape, a type or a unit that says something else would be read as other numbers."""
    whole = [f.image.values.tolist() for f in read_store(store)]
    file = store / name / "zarr.json"
    if how == "gone":
        file.unlink()
    else:
        text = file.read_text()
        other = text.replace("float64", "int64").replace("volt", "gram").replace("-1", "5")
        file.write_text(text[:50] if how == "cut" else other)
        assert file.read_text() != text
    report = Report()
    frames = list(read_store(store, report))
    assert [f.image.values.tolist() for f in frames] == whole
    assert {f.image.quantity for f in frames} == {"volt"}
    assert not any(f.doubtful for f in frames)
    told = f"{name}/zarr.json is damaged".removeprefix("/")
    assert report.troubles[0] == (str(store), told)
    assert "check --repair" in report.troubles[1][1]


def test_a_line_of_the_journal_that_is_damaged_makes_its_frames_doubtful(store: Path) -> None:
    lines = (store / "frames.journal").read_bytes().splitlines(keepends=True)
    lines[2] = lines[2].replace(b"4", b"5", 1)
    (store / "frames.journal").write_bytes(b"".join(lines))
    report = Report()
    frames = list(read_store(store, report))
    assert [f.index for f in frames if f.doubtful] == [4, 5, 6, 7]
    assert len(frames) == 10
    assert report.troubles[0] == (str(store), "line 3 of its journal is damaged")


@pytest.mark.parametrize("n_lines", [0, 1, 2, 3])
def test_a_journal_that_was_cut_short_makes_no_store_short(store: Path, n_lines: int) -> None:
    lines = (store / "frames.journal").read_bytes().splitlines(keepends=True)
    (store / "frames.journal").write_bytes(b"".join(lines[:n_lines]))
    frames = list(read_store(store))
    assert [f.index for f in frames] == list(range(10))
    assert [f.index for f in frames if f.doubtful] == list(range(4 * max(0, n_lines - 1), 10))


def test_a_journal_that_is_gone_makes_all_frames_doubtful(store: Path) -> None:
    (store / "frames.journal").unlink()
    report = Report()
    frames = list(read_store(store, report))
    assert len(frames) == 10
    assert all(f.doubtful for f in frames)
    told = "its journal is gone: what is in the arrays is given as doubtful"
    assert report.troubles[0] == (str(store), told)


def test_frames_that_nothing_numbers_are_told_as_lost(store: Path) -> None:
    shutil.rmtree(store / "number" / "c")
    (store / "frames.journal").write_bytes(
        (store / "frames.journal").read_bytes().splitlines(True)[0]
    )
    report = Report()
    assert list(read_store(store, report)) == []
    assert report.troubles[0][1] == "10 frames from 0 on are lost: nothing numbers them"


def test_a_store_of_which_nothing_can_be_read_is_an_error(store: Path) -> None:
    for part in (store / "values" / "c").rglob("*"):
        if part.is_file():
            part.write_bytes(b"junk")
    with pytest.raises(DataError, match=r"a\.zarr: not a single frame of it can be read"):
        list(read_store(store))


def as_version_2(store: Path) -> None:
    import zarr

    (store / "frames.journal").unlink()
    zarr.open_group(str(store), mode="r+").attrs["version"] = 2


def test_an_older_store_without_journal_is_read_and_not_gone_on_with(store: Path) -> None:
    whole = [f.image.values.tolist() for f in read_store(store)]
    as_version_2(store)
    report = Report()
    frames = list(read_store(store, report))
    assert [f.image.values.tolist() for f in frames] == whole
    assert (report.troubles, [f for f in frames if f.doubtful]) == ([], [])
    with pytest.raises(UsageError, match="is of version 2 of the format, which is read but not"):
        StoreWriter(store, append=True)


def test_a_chunk_of_an_older_store_that_is_gone_is_lost(store: Path) -> None:
    as_version_2(store)
    shutil.rmtree(store / "values" / "c" / "1")
    index, gaps, report = index_and_gaps(store)
    assert (index, gaps) == ([0, 1, 2, 3, 8, 9], [8])
    assert report.troubles == [(str(store), "frames 4 to 7: lost: values/c/1/0/0 is gone")]


def test_a_damaged_store_is_not_gone_on_with(store: Path) -> None:
    (store / "values" / "zarr.json").unlink()
    with pytest.raises(
        UsageError, match=r"values/zarr.json is damaged; 'tactile-graph check --rep"
    ):
        StoreWriter(store, append=True)


# -- what a value means ----------------------------------------------------------------------------


def damage_head_and_grid(store: Path) -> None:
    """Leave neither of the two places whole that tell the pitch of all frames."""
    file = store / "frames.journal"
    file.write_bytes(file.read_bytes().replace(b"volt", b"gram", 1))
    file = store / "zarr.json"
    file.write_text(file.read_text().replace("volt", "gram", 1))


def without_copies(store: Path) -> None:
    """Take the attributes out of the journal's blocks, as they were written at first."""
    file = store / "frames.journal"
    head, *lines = file.read_bytes().splitlines()
    for i, line in enumerate(lines):
        data = json.loads(line[9:])
        del data["attributes"]
        text = json.dumps(data).encode()
        lines[i] = b"%08x %s" % (zlib.crc32(text), text)
    file.write_bytes(b"\n".join([head, *lines, b""]))


@pytest.mark.slow
def test_each_line_of_the_journal_vouches_for_the_grid(store: Path) -> None:
    damage_head_and_grid(store)
    frames = list(read_store(store))
    assert {(f.image.quantity, f.doubtful) for f in frames} == {("volt", False)}
    checked = check(store, repair=True)
    assert set(checked.mended) == {"line 1 of its journal is damaged", "zarr.json is damaged"}
    assert checked.wrong == ()
    assert '"volt"' in (store / "zarr.json").read_text()


@pytest.mark.parametrize("repaired", [False, True])
def test_frames_are_doubtful_where_nothing_vouches_for_the_grid(
    store: Path, repaired: bool
) -> None:
    without_copies(store)
    whole = [f.image.values.tolist() for f in read_store(store)]
    damage_head_and_grid(store)
    if repaired:
        checked = check(store, repair=True)
        assert checked.wrong == (UNSURE,)
        assert check(store, repair=True) == checked._replace(mended=())
    report = Report()
    frames = list(read_store(store, report))
    assert [f.image.values.tolist() for f in frames] == whole
    assert all(f.doubtful for f in frames)
    assert (str(store), UNSURE) in report.troubles
    with pytest.raises(UsageError, match="nothing vouches" if repaired else "check --repair"):
        StoreWriter(store, append=True)


def test_a_store_whose_journal_has_no_copies_is_read_and_gone_on_with(store: Path) -> None:
    without_copies(store)
    assert check(store).wrong == ()
    with StoreWriter(store, append=True) as writer:
        writer.write(Frame.of(np.ones((3, 2)), quantity="volt"))
    damage_head_and_grid(store)
    frames = list(read_store(store))
    assert {(f.image.quantity, f.doubtful) for f in frames} == {("volt", False)}


def test_a_line_of_another_store_vouches_for_nothing(store: Path, tmp_path: Path) -> None:
    with StoreWriter(tmp_path / "b.zarr", chunk=4) as writer:
        for _ in range(4):
            writer.write(Frame.of(np.ones((3, 2)), quantity="gram"))
    other = (tmp_path / "b.zarr" / "frames.journal").read_bytes().splitlines(keepends=True)
    lines = (store / "frames.journal").read_bytes().splitlines(keepends=True)
    (store / "frames.journal").write_bytes(b"".join([*lines[:1], other[1], *lines[2:]]))
    report = Report()
    frames = list(read_store(store, report))
    assert [f.index for f in frames if f.doubtful] == [0, 1, 2, 3]
    assert report.troubles[0] == (str(store), "line 2 of its journal is damaged")


def test_a_damaged_version_does_not_have_the_journal_overlooked(store: Path) -> None:
    without_copies(store)
    damage_head_and_grid(store)
    file = store / "zarr.json"
    file.write_text(file.read_text().replace('"version": 3', '"version": 2'))
    assert all(f.doubtful for f in read_store(store))
