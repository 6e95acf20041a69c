"""Recordings as Zarr stores: whole, appended to, and after a crash."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_recordings import frames_of
from tactile_graph import Circle, Frame
from tactile_graph.errors import DataError, UsageError
from tactile_graph.steps.injected import Report
from tactile_graph.wires import TrueObject
from tactile_graph_sources.inspection.look import look_into
from tactile_graph_sources.inspection.words import data_of, lines_of
from tactile_graph_sources.store import read_store
from tactile_graph_sources.stores import journal
from tactile_graph_sources.stores.checking import check
from tactile_graph_sources.stores.layout import is_store
from tactile_graph_sources.writers import write_store
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


def frames(n: int, shape: tuple[int, int] = (3, 4), first: int = 0) -> list[Frame]:
    rng = np.random.default_rng(first)
    return [
        Frame.of(
            rng.integers(0, 4096, shape),
            (1.3, 0.7),
            (0.5, 0.25),
            "counts",
            index=i,
            time_s=100.0 + 0.01 * i,
            device_time_s=0.02 * i if i % 2 else None,
            gap=i % 5 == 3,
        )
        for i in range(first, first + n)
    ]


def same(a: Frame, b: Frame) -> bool:
    images = a.image, b.image
    valid = [np.ones(i.shape, bool) if i.valid is None else i.valid for i in images]
    return (
        np.array_equal(a.image.values, b.image.values)
        and np.array_equal(*valid)
        and (a.image.pitch_cm, a.image.origin_cm) == (b.image.pitch_cm, b.image.origin_cm)
        and a.image.quantity == b.image.quantity
        and (a.index, a.time_s, a.truth, a.device_time_s, a.gap, a.label)
        == (b.index, b.time_s, b.truth, b.device_time_s, b.gap, b.label)
    )


@pytest.mark.parametrize("n", [1, 7, 8, 9, 40])
def test_what_is_written_is_read_back(tmp_path: Path, n: int) -> None:
    written = frames(n)
    with StoreWriter(tmp_path / "a.zarr", chunk=8, about={"preset": "m1616"}) as store:
        for frame in written:
            store.write(frame)
    report = Report()
    read = list(read_store(tmp_path / "a.zarr", report))
    assert len(read) == store.n_frames == report.n_expected == n
    assert all(same(a, b) for a, b in zip(written, read, strict=True))
    assert is_store(tmp_path / "a.zarr")
    assert [f.index for f in read_store(tmp_path / "a.zarr", start=5)] == list(range(5, n))


def test_a_store_named_from_a_folder_is_read_to_its_end_from_any_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with StoreWriter(tmp_path / "r.zarr", chunk=8) as store:
        for frame in frames(40):
            store.write(frame)
    monkeypatch.chdir(tmp_path)
    report, n = Report(), 0
    for _ in read_store(Path("r.zarr"), report):
        n += 1
        monkeypatch.chdir("/")
    assert (n, report.counts["damaged records skipped"]) == (40, 0)


def test_invalid_cells_truth_and_labels_are_kept(tmp_path: Path) -> None:
    values = np.ones((2, 2))
    values[0, 1] = np.nan
    disc = TrueObject(Circle(1.0, 2.0, 3.0), 100.0, "disc-1")
    written = [
        Frame.of(values, quantity="volt", label="left"),
        Frame.of(values, quantity="volt", index=1, truth=(disc,)),
        Frame.of(np.ones((2, 2)), quantity="volt", index=2, truth=()),
    ]
    with StoreWriter(tmp_path / "a.zarr") as store:
        for frame in written:
            store.write(frame)
    read = list(read_store(tmp_path / "a.zarr"))
    assert all(same(a, b) for a, b in zip(written, read, strict=True))


@pytest.mark.slow
def test_a_recording_is_gone_on_with(tmp_path: Path) -> None:
    """The frames are numbered on, and the first of them follows a gap."""
    path = tmp_path / "a.zarr"
    for first in (0, 11):
        with StoreWriter(path, chunk=4, append=True) as store:
            for frame in frames(11, first=first):
                store.write(frame)
    read = list(read_store(path))
    assert [f.index for f in read] == list(range(22))
    expected = np.stack([f.image.values for part in (0, 11) for f in frames(11, first=part)])
    np.testing.assert_array_equal(np.stack([f.image.values for f in read]), expected)
    assert read[11].gap


def test_a_journal_is_written_as_no_text_where_that_would_change_its_line_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened, its_open, binary = [], os.open, 1 << 29

    def noted(path: Any, flags: int, *more: Any) -> int:
        opened.append(flags)
        return its_open(path, flags & ~binary, *more)

    (tmp_path / journal.JOURNAL).write_bytes(b"")
    monkeypatch.setattr(journal, "BINARY", binary)
    monkeypatch.setattr(os, "open", noted)
    journal.append(tmp_path, b"a line\n")
    assert (tmp_path / journal.JOURNAL).read_bytes() == b"a line\n"
    assert opened[0] & binary


def test_each_session_says_when_it_began(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, given = tmp_path / "a.zarr", frames(12)
    days = ["2026-03-28T23:59:00+0100", "2026-03-29T08:00:00+0200", "2026-03-30T08:00:00+0200"]
    for day, some in zip(days, (given[:4], given[4:5], given[5:]), strict=True):
        monkeypatch.setattr(write_store, "_now", lambda day=day: day)
        with StoreWriter(path, chunk=3, append=True) as store:
            for frame in some:
                store.write(frame)
    with StoreWriter(path, append=True):
        pass  # no session without a frame
    sessions = [{"frame": n, "started": day} for n, day in zip([0, 4, 5], days, strict=True)]
    kept = json.loads((path / "zarr.json").read_text())["attributes"]
    assert (kept["started"], kept["sessions"]) == (days[0], sessions)
    (path / "zarr.json").write_text("{")
    assert check(path, repair=True).mended
    assert json.loads((path / "zarr.json").read_text())["attributes"] == kept
    looked = look_into(path, {})
    assert data_of(looked)["sessions"] == sessions
    lines = [*lines_of(looked)]
    assert "  recorded  2026-03-28 23:59:00 +0100" in lines
    assert "            2026-03-30 08:00:00 +0200, from frame 5 on" in lines


def test_the_arrays_are_what_dask_reads_in_place(tmp_path: Path) -> None:
    import zarr

    with StoreWriter(tmp_path / "a.zarr", chunk=4, about={"pad": "bench"}) as store:
        for frame in frames(10):
            store.write(frame)
    group = zarr.open_group(str(tmp_path / "a.zarr"), mode="r")
    assert group["values"].shape == (10, 3, 4)
    assert group["values"].chunks == (4, 3, 4)
    assert group.attrs["pad"] == "bench"
    assert group.attrs["quantity"] == "counts"
    np.testing.assert_array_equal(group["values"][9], frames(10)[9].image.values)


WRITER = """
import sys
import numpy as np
from tactile_graph import Frame
from tactile_graph_sources.writers.write_store import StoreWriter
store = StoreWriter(sys.argv[1], chunk=16)
for i in range(10**6):
    store.write(Frame.of(np.full((4, 4), i), quantity="counts", index=i, time_s=float(i)))
    print(i, flush=True)
"""


@pytest.mark.slow
@pytest.mark.parametrize("after", [100, 211])
def test_a_writer_that_is_killed_loses_at_most_its_last_chunk(tmp_path: Path, after: int) -> None:
    path = tmp_path / "a.zarr"
    writer = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True
    )
    assert writer.stdout is not None
    last = 0
    for line in writer.stdout:
        last = int(line)
        if last >= after:
            os.kill(writer.pid, signal.SIGKILL)
            break
    last = max([last, *(int(line) for line in writer.stdout if line.endswith("\n"))])
    writer.stdout.close()
    writer.wait(20.0)
    read = list(read_store(path))
    assert last - 16 < len(read)
    assert [f.image.values[0, 0] for f in read] == list(range(len(read)))
    with StoreWriter(path, append=True) as store:
        store.write(Frame.of(np.zeros((4, 4)), quantity="counts"))
    again = list(read_store(path))
    assert len(again) == len(read) + 1
    assert again[-1].gap


def test_rows_that_were_not_written_whole_do_not_count(tmp_path: Path) -> None:
    """Whichever array a crash leaves behind, the store opens and goes on."""
    import zarr

    path = tmp_path / "a.zarr"
    with StoreWriter(path, chunk=4) as store:
        for frame in frames(8):
            store.write(frame)
    group = zarr.open_group(str(path), mode="r+")
    for name in ("values", "time_s", "number"):
        group[name].resize((12, *group[name].shape[1:]))
    group["notes"].resize((50,))
    assert len(list(read_store(path))) == 8
    with StoreWriter(path, append=True) as store:
        store.write(frames(1, first=8)[0])
    assert [f.index for f in read_store(path)] == list(range(9))


def test_frames_that_wait_are_written_in_one_go_and_vouched_for_chunk_by_chunk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, real, writings = tmp_path / "a.zarr", journal.append, []
    monkeypatch.setattr(journal, "append", lambda p, line: writings.append(line) or real(p, line))
    written = frames(20)
    with StoreWriter(path, chunk=2) as store:
        for i, frame in enumerate(written):
            store.n_waiting = 19 - i
            store.write(frame)
    assert len(writings) == 2
    assert [b.high - b.low for b in journal.read_journal(path).blocks] == 10 * [2]
    assert all(same(a, b) for a, b in zip(written, read_store(path), strict=True))
    assert not check(path).wrong


def test_many_frames_that_were_not_written_whole_do_not_count_either(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, real = tmp_path / "a.zarr", StoreWriter._write

    def killed(self: StoreWriter, name: str, low: int, rows: object) -> None:
        if low and name == "number":
            raise KeyboardInterrupt
        real(self, name, low, rows)

    monkeypatch.setattr(StoreWriter, "_write", killed)
    store = StoreWriter(path, chunk=1)
    with contextlib.suppress(KeyboardInterrupt):
        for i, frame in enumerate(frames(20)):
            store.n_waiting = 19 - i
            store.write(frame)
    assert len(store._held) == 19
    store._held = []
    store.close()
    report = Report()
    assert len(list(read_store(path, report))) == 1
    assert not report.troubles
    assert not check(path).wrong


def test_a_flush_that_was_interrupted_is_done_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C in the middle of writing a chunk loses nothing."""
    real, calls = StoreWriter._write, []

    def interrupted(self: StoreWriter, name: str, low: int, rows: object) -> None:
        calls.append(name)
        if len(calls) == 4:
            raise KeyboardInterrupt
        real(self, name, low, rows)

    monkeypatch.setattr(StoreWriter, "_write", interrupted)

    def write() -> None:
        with StoreWriter(tmp_path / "a.zarr", chunk=5) as store:
            for frame in frames(9):
                store.write(frame)

    with pytest.raises(KeyboardInterrupt):
        write()
    read = list(read_store(tmp_path / "a.zarr"))
    assert all(same(a, b) for a, b in zip(frames(5), read, strict=True))


def test_a_frame_on_another_grid_is_refused(tmp_path: Path) -> None:
    with StoreWriter(tmp_path / "a.zarr") as store:
        store.write(frames(1)[0])
        with pytest.raises(DataError, match=r"holds 3 x 4 cells of .*; this one is 5 x 5 cells"):
            store.write(frames(1, (5, 5))[0])


def test_a_store_that_is_there_is_not_overwritten(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="is there already; append to it"):
        StoreWriter(tmp_path)


def test_other_zarr_stores_are_no_recordings(tmp_path: Path) -> None:
    import zarr

    zarr.create_group(str(tmp_path / "b.zarr"))
    with pytest.raises(DataError, match=r"b.zarr: is a Zarr store, but not a recording"):
        list(read_store(tmp_path / "b.zarr"))
    (tmp_path / "c.zarr").mkdir()
    (tmp_path / "c.zarr" / "zarr.json").write_text("{")
    with pytest.raises(DataError, match=r"c.zarr: is no Zarr store that opens"):
        list(read_store(tmp_path / "c.zarr"))


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("version", 99, "is a recording of version 99, 1, 2 and 3 can be read"),
        ("quantity", "bananas", "unknown quantity 'bananas'"),
        ("pitch_cm", [0.5], r"pitch_cm must be two numbers, got \[0.5\]"),
    ],
)
def test_attributes_that_cannot_be_true_are_refused(
    tmp_path: Path, name: str, value: object, message: str
) -> None:
    import zarr

    with StoreWriter(tmp_path / "a.zarr") as store:
        store.write(frames(1)[0])
    zarr.open_group(str(tmp_path / "a.zarr"), mode="r+").attrs[name] = value
    (tmp_path / "a.zarr" / "frames.journal").unlink()
    with pytest.raises(DataError, match=message):
        list(read_store(tmp_path / "a.zarr"))


def test_without_the_extra_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(UsageError, match=r'pip install "tactile-graph\[zarr\]"'):
        StoreWriter(tmp_path / "a.zarr")


def test_a_second_writer_is_told_who_holds_the_store(tmp_path: Path) -> None:
    path = tmp_path / "a.zarr"
    with StoreWriter(path) as store:
        store.write(frames(1)[0])
        with pytest.raises(UsageError, match=rf"is being written to by process {os.getpid()} on"):
            StoreWriter(path, append=True)
    with StoreWriter(path, append=True) as store:
        store.write(frames(1, first=1)[0])
    assert len(list(read_store(path))) == 2


def test_a_writer_without_a_frame_that_is_closed_twice_leaves_anothers_store_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.zarr"
    empty = StoreWriter(path)
    monkeypatch.setattr(empty, "flush", lambda: None)  # as where the disc is full
    empty.write(frames(1)[0])
    empty.close()
    assert not path.exists()
    with StoreWriter(path) as store:
        store.write(frames(1)[0])
        empty.close()
    assert len(list(read_store(path))) == 1


def test_doubtful_frames_stay_marked(tmp_path: Path) -> None:
    with StoreWriter(tmp_path / "a.zarr") as store:
        for i in range(2):
            store.write(Frame.of(np.ones((2, 2)), index=i, doubtful=i == 1))
    assert [f.doubtful for f in read_store(tmp_path / "a.zarr")] == [False, True]


def test_frames_keep_the_numbers_that_their_recording_gave_them(tmp_path: Path) -> None:
    given = [5, None, 2**53 + 1]
    with StoreWriter(tmp_path / "a.zarr") as store:
        for frame, number in zip(frames(3), given, strict=True):
            store.write(replace(frame, own_number=number))
    assert [f.own_number for f in read_store(tmp_path / "a.zarr")] == given
    read, _ = frames_of(tmp_path / "a.zarr")
    assert [f.own_number for f in read] == given


def test_a_store_whose_making_was_cut_short_is_made_anew(tmp_path: Path) -> None:
    (tmp_path / ".a.zarr.part" / "values").mkdir(parents=True)
    with StoreWriter(tmp_path / "a.zarr") as store:
        store.write(frames(1)[0])
    assert len(list(read_store(tmp_path / "a.zarr"))) == 1
    assert not (tmp_path / ".a.zarr.part").exists()


def test_ctrl_c_while_a_store_is_made_leaves_a_store_with_the_frame_in_hand(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Zarr writes in a thread of its own, which goes on after its caller was interrupted."""
    real = StoreWriter._make

    def interrupted(self: StoreWriter, *args: Any) -> Any:
        signal.raise_signal(signal.SIGINT)
        return real(self, *args)

    monkeypatch.setattr(StoreWriter, "_make", interrupted)
    store = StoreWriter(tmp_path / "a.zarr")
    with pytest.raises(KeyboardInterrupt):
        store.write(frames(1)[0])
    store.close()
    assert is_store(tmp_path / "a.zarr")
    assert not (tmp_path / ".a.zarr.part").exists()
    with StoreWriter(tmp_path / "a.zarr", append=True) as store:
        assert store.n_frames == 1


@pytest.mark.parametrize("fails", ["head_line", "append"])
def test_a_store_that_cannot_be_made_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fails: str
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(journal, fails, full)
    with (
        pytest.raises(UsageError, match=r"a\.zarr: cannot be written: No space"),
        StoreWriter(tmp_path / "a.zarr") as store,
    ):
        store.write(frames(1)[0])
    assert [*tmp_path.iterdir()] == []


def test_a_flipped_bit_is_never_a_value(tmp_path: Path) -> None:
    with StoreWriter(tmp_path / "a.zarr", chunk=4) as store:
        for frame in frames(8):
            store.write(frame)
    part = tmp_path / "a.zarr" / "values" / "c" / "1" / "0" / "0"
    data = bytearray(part.read_bytes())
    data[len(data) // 2] ^= 1
    part.write_bytes(bytes(data))
    report = Report()
    assert [f.index for f in read_store(tmp_path / "a.zarr", report)] == [0, 1, 2, 3]
    assert report.counts["damaged records skipped"] == 4
