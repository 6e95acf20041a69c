"""``convert`` between Zarr, npz and CSV."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_cli import plugin
from tactile_graph import Frame, hookimpl
from tactile_graph.cli import cli
from tactile_graph.cli.interrupt import Ended
from tactile_graph.errors import UsageError
from tactile_graph.plugins import registry
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph.steps.injected import Report
from tactile_graph.wires import Circle, TrueObject
from tactile_graph_sources.commands.convert import OFFERS, convert
from tactile_graph_sources.inspection.look import look_into
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.reading import PITCH_UNTOLD
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.recording_writer import RecordingWriter
from tactile_graph_sources.writers.write_npz import write_npz
from tactile_graph_sources.writers.write_store import StoreWriter

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")


@pytest.fixture
def made(tmp_path: Path) -> list[Frame]:
    rng = np.random.default_rng(0)
    frames = [
        Frame.of(rng.normal(size=(3, 5)), 1.3, quantity="volt", index=i, time_s=0.1 * i, gap=i == 2)
        for i in range(6)
    ]
    write_npz(tmp_path / "a.npz", frames)
    return frames


def run(*args: object) -> str:
    result = CliRunner().invoke(convert, [str(a) for a in args])
    assert result.exit_code == 0, result.output
    return result.output


def test_there_and_back_again_nothing_is_lost(tmp_path: Path, made: list[Frame]) -> None:
    run(tmp_path / "a.npz", tmp_path / "b.zarr")
    run(tmp_path / "b.zarr", tmp_path / "c.npz")
    for name in ("b.zarr", "c.npz"):
        read = list(recording(path=tmp_path / name, report=Report()))
        for a, b in zip(made, read, strict=True):
            np.testing.assert_array_equal(a.image.values, b.image.values)
            assert (a.time_s, a.gap, a.image.quantity) == (b.time_s, b.gap, b.image.quantity)
            assert a.image.pitch_cm == b.image.pitch_cm


@pytest.mark.parametrize("ending", [".npz", ".zarr"])
def test_frames_with_a_true_shape_of_a_plugins_own_are_kept_without_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    class Stroke(Circle):
        pass

    circle = TrueObject(Circle(1.0, 2.0, 3.0))
    truths = [(circle, TrueObject(Stroke(1.0, 2.0, 3.0))), (circle,)]
    given = [Frame.of(np.ones((2, 2)), index=k, truth=truth) for k, truth in enumerate(truths)]
    monkeypatch.setattr("tactile_graph_sources.commands.convert._frames", lambda *_: iter(given))
    said = run("--source", "simulate", tmp_path / f"a{ending}")
    told = f"left out, as a {ending} has no place for it: truth of plugins' own shapes\n"
    assert said.endswith(told)
    read = recording(path=tmp_path / f"a{ending}", report=Report())
    assert [f.truth for f in read] == [None, (circle,)]
    assert [p.name for p in tmp_path.iterdir()] == [f"a{ending}"]


def test_of_many_troubles_the_first_are_told_and_how_many_there_are(tmp_path: Path) -> None:
    lines = [",".join(["1"] * 64), *["1,2,3"] * 12, ",".join(["2"] * 64)]
    (tmp_path / "a.csv").write_text("\n".join([*[lines[0]] * 20, *lines]))
    output = run(tmp_path / "a.csv", tmp_path / "b.npz")
    assert output.count("3 values, not 64") == 5
    assert "… and 7 more" in output


def test_a_table_and_back_with_what_it_cannot_say_told(tmp_path: Path, made: list[Frame]) -> None:
    output = run(tmp_path / "a.npz", tmp_path / "b.csv")
    assert "b.csv: 6 frames" in output
    assert "left out, as a .csv has no place for it: gaps" in output
    told = ("--rows", 3, "--columns", 5, "--quantity", "volt", "--pitch-cm", 1.3)
    run(tmp_path / "b.csv", tmp_path / "c.zarr", *told)
    read = list(recording(path=tmp_path / "c.zarr", report=Report()))
    for a, b in zip(made, read, strict=True):
        np.testing.assert_array_equal(a.image.values, b.image.values)
        assert a.image.pitch_cm == b.image.pitch_cm


@pytest.mark.parametrize(
    ("pitch", "x", "y"),
    [("0.8,1.2", 0.8, 1.2), ("1.0,27", 1.0, 27.0), ("1x27", 1.0, 27.0), ("0.8 x 1.2", 0.8, 1.2),
     ("1.27", 1.27, 1.27)],
)  # fmt: skip
def test_a_pitch_is_told_of_both_sides_or_of_each(
    tmp_path: Path, made: list[Frame], pitch: str, x: float, y: float
) -> None:
    run(tmp_path / "a.npz", tmp_path / "b.npz", "--pitch-cm", pitch)
    first = next(iter(recording(path=tmp_path / "b.npz", report=Report())))
    assert first.image.pitch_cm == (x, y)


@pytest.mark.parametrize(
    ("pitch", "message"),
    [
        ("0.8,", "'' is not a valid float"),
        ("1,2,3", "'2,3' is not a valid float"),
        ("0.8,0", "0.0 is not in the range x>0"),
        ("0.8,nan", "must be a finite number in the range x>0, got nan"),
        ("1,27", "'1,27' may have a decimal comma: write 1.27, or 1x27 for two"),
        ("0,8", "'0,8' may have a decimal comma: write 0.8\n"),
    ],
)
def test_a_pitch_of_other_than_one_or_two_lengths_is_refused(
    tmp_path: Path, made: list[Frame], pitch: str, message: str
) -> None:
    told = [str(tmp_path / "a.npz"), str(tmp_path / "b.npz"), "--pitch-cm", pitch]
    result = CliRunner().invoke(convert, told)
    assert result.exit_code == 2
    assert f"Invalid value for '--pitch-cm': {message}" in result.output


@pytest.mark.slow
@pytest.mark.parametrize("step_s", [1.0, None])
def test_a_table_of_three_decimals_or_none_is_read_again(
    tmp_path: Path, step_s: float | None
) -> None:
    values = np.where(np.arange(120).reshape(20, 2, 3) % 7 < 3, 11.667, 10.0)
    times_s = [None if step_s is None else step_s * i for i in range(len(values))]
    frames = [Frame.of(v, 0.5, index=i, time_s=times_s[i]) for i, v in enumerate(values)]
    write_npz(tmp_path / "a.npz", frames)
    run(tmp_path / "a.npz", tmp_path / "a.csv")
    again = recording(path=tmp_path / "a.csv", report=Report())
    np.testing.assert_array_equal([f.image.values for f in again], values)


@pytest.mark.parametrize("error", [KeyboardInterrupt(), OSError(28, "No space left on device")])
def test_a_store_whose_writing_was_cut_short_is_not_there(
    tmp_path: Path, made: list[Frame], monkeypatch: pytest.MonkeyPatch, error: BaseException
) -> None:
    put, before = StoreWriter._put, sorted(tmp_path.rglob("*"))

    def cut_short(self: StoreWriter, frames: list[Frame]) -> None:
        if self.n_written:
            raise error
        put(self, frames)

    with monkeypatch.context() as patched:
        patched.setattr(StoreWriter, "_put", cut_short)
        patched.setattr(StoreWriter.__init__, "__defaults__", (4, False, None, None))
        args = [str(tmp_path / "a.npz"), str(tmp_path / "b.zarr")]
        got = CliRunner().invoke(cli, ["convert", *args])
    assert got.exit_code == (130 if isinstance(error, KeyboardInterrupt) else 2)
    assert f"{tmp_path / 'b.zarr'}: cannot be written: No space" in got.stderr or (
        isinstance(error, KeyboardInterrupt)
    )
    assert sorted(tmp_path.rglob("*")) == before
    assert "6 frames" in run(*args)


def test_a_store_that_is_there_is_refused_with_what_goes_on_with_it(
    tmp_path: Path, made: list[Frame]
) -> None:
    target = tmp_path / "b.zarr"
    run(tmp_path / "a.npz", target)
    got = CliRunner().invoke(convert, [str(tmp_path / "a.npz"), str(target)])
    remedies = f"remove it, or choose another name; 'record --append {target}' goes on with it"
    assert f"{target} is there already; {remedies}\n" in got.stderr


@pytest.mark.parametrize("name", ["b.npz", "b.csv"])
def test_a_file_is_written_over_if_told_and_stays_where_that_fails(
    tmp_path: Path, made: list[Frame], name: str
) -> None:
    target = tmp_path / name
    target.write_text("another")
    got = CliRunner().invoke(convert, [str(tmp_path / "a.npz"), str(target)])
    assert "or choose another name, or write over it with --overwrite" in got.stderr
    got = CliRunner().invoke(convert, [str(tmp_path / "none.npz"), str(target), "--overwrite"])
    assert got.exit_code
    assert target.read_text() == "another"
    run(tmp_path / "a.npz", target, "--overwrite")
    assert len(list(recording(path=target, report=Report()))) == len(made)


def test_no_store_is_written_over(tmp_path: Path, made: list[Frame]) -> None:
    target = tmp_path / "b.zarr"
    run(tmp_path / "a.npz", target)
    got = CliRunner().invoke(convert, [str(tmp_path / "a.npz"), str(target), "--overwrite"])
    assert f"{target} is there already; remove it" in got.stderr
    assert len(list(recording(path=target, report=Report()))) == len(made)


def test_a_store_that_cannot_be_made_is_called_as_it_was(tmp_path: Path, made: list[Frame]) -> None:
    target = tmp_path / f"{'o' * 249}.zarr"  # and no lock of such a name can lie beside it
    got = CliRunner().invoke(cli, ["convert", str(tmp_path / "a.npz"), str(target)])
    assert got.exit_code == 2
    assert f"error: {target}: cannot be written: File name too long\n" in got.stderr


def test_a_store_that_came_to_be_meanwhile_stays(tmp_path: Path, made: list[Frame]) -> None:
    write = installed().load(OFFERS, ".zarr").write
    write(tmp_path / "b.zarr", iter(made), "another")
    with pytest.raises(UsageError, match="is there already"):
        write(tmp_path / "b.zarr", iter(made[:1]), "this one")
    read = list(recording(path=tmp_path / "b.zarr", report=Report()))
    assert len(read) == len(made)


@pytest.mark.parametrize("ending", ["zarr", "npz", "csv"])
def test_frames_that_ctrl_c_alone_ends_are_kept(
    tmp_path: Path, made: list[Frame], monkeypatch: pytest.MonkeyPatch, ending: str
) -> None:
    def unplugged(*_: object) -> Iterator[Frame]:
        yield from made[:3]
        raise KeyboardInterrupt

    monkeypatch.setattr("tactile_graph_sources.commands.any_source.frames_of_source", unplugged)
    target = tmp_path / f"b.{ending}"
    got = CliRunner().invoke(cli, ["convert", "--source", "simulate", str(target)])
    assert got.exit_code == 130
    assert f"{target}: 3 frames\n" in got.stdout
    assert len(list(recording(path=target, report=Report()))) == 3


def ends_early(made: list[Frame], monkeypatch: pytest.MonkeyPatch) -> None:
    """Have SIGTERM end a source of nine frames after the third."""

    def ended(_step: str, _given: object, report: Report, _seed: int) -> Iterator[Frame]:
        report.expect(9)
        yield from made[:3]
        raise Ended(signal.SIGTERM)

    monkeypatch.setattr("tactile_graph_sources.commands.any_source.frames_of_source", ended)


@pytest.mark.parametrize("ending", ["zarr", "npz", "csv"])
@pytest.mark.parametrize("asked", [("--frames", "9"), ()])
def test_frames_that_end_by_themselves_are_kept_all_or_none(
    tmp_path: Path,
    made: list[Frame],
    monkeypatch: pytest.MonkeyPatch,
    ending: str,
    asked: tuple[str, ...],
) -> None:
    ends_early(made, monkeypatch)
    target = tmp_path / f"b.{ending}"
    if ending != "zarr":
        target.write_text("another")
    before = sorted(tmp_path.iterdir())
    words = ["convert", "--source", "simulate", *asked, "--overwrite", str(target)]
    got = CliRunner().invoke(cli, words)
    assert (got.exit_code, got.output.strip()) == (128 + signal.SIGTERM, "ended by SIGTERM")
    assert sorted(tmp_path.iterdir()) == before
    assert ending == "zarr" or target.read_text() == "another"


@pytest.mark.parametrize("asked", [("--frames", "9"), ()])
def test_frames_of_a_pad_that_a_signal_ends_are_kept_and_it_is_told(
    tmp_path: Path, made: list[Frame], monkeypatch: pytest.MonkeyPatch, asked: tuple[str, ...]
) -> None:
    ends_early(made, monkeypatch)
    target = tmp_path / "b.npz"
    got = CliRunner().invoke(cli, ["convert", "--source", "serial", *asked, str(target)])
    assert (got.exit_code, got.stderr.strip()) == (128 + signal.SIGTERM, "ended by SIGTERM")
    assert len(list(recording(path=target, report=Report()))) == 3


@pytest.mark.parametrize(
    ("target", "message"),
    [
        ("b.xyz", "TARGET must end in .zarr, .npz, .csv"),
        ("b", "got 'b'\n"),
        (".csv", "must end"),
        ("b.cvs", "got 'b.cvs'; did you mean '.csv'?"),
        ("b.csv.gz", "TARGET must end in .zarr"),
        ("b.mat", ", got 'b.mat'; MATLAB reads .csv by readtable"),
        ("a.npz", "is there already"),
    ],
)
def test_a_target_that_will_not_do_is_refused(
    tmp_path: Path, made: list[Frame], target: str, message: str
) -> None:
    result = CliRunner().invoke(convert, [str(tmp_path / "a.npz"), str(tmp_path / target)])
    assert result.exit_code == 2
    assert message in result.output


def test_an_ending_may_be_in_capitals(tmp_path: Path, made: list[Frame]) -> None:
    assert "B.CSV: 6 frames" in run(tmp_path / "a.npz", tmp_path / "B.CSV")


def test_a_target_within_the_folder_that_is_the_recording_is_refused(tmp_path: Path) -> None:
    """Or it would be a part of the recording from then on."""
    (tmp_path / "parts").mkdir()
    for i in range(2):
        (tmp_path / "parts" / f"f{i}.csv").write_text("1,2,3\n4,5,6\n")
    args = [str(tmp_path / "parts"), str(tmp_path / "parts" / "f2.csv")]
    result = CliRunner().invoke(cli, ["convert", *args])
    assert result.exit_code == 2
    assert "f2.csv: would be a part of what the command reads" in result.stderr


@pytest.mark.parametrize("words", [("inspect", "{a}"), ("convert", "{a}", "{b}")])
def test_a_file_that_may_not_be_read_is_told_as_run_tells_it(
    tmp_path: Path, made: list[Frame], monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    def shut(path: Path, _told: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    path = tmp_path / "a.npz"
    may = os.access
    monkeypatch.setattr(os, "access", lambda p, how: Path(p) != path and may(p, how))
    monkeypatch.setattr(Head, "of", shut)  # root may read any
    got = CliRunner().invoke(cli, [word.format(a=path, b=tmp_path / "b.npz") for word in words])
    assert (got.exit_code, got.stderr) == (2, f"error: {path}: cannot be read: Permission denied\n")


def test_a_source_that_is_no_recording_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("hello\n")
    args = ["convert", str(tmp_path / "a.txt"), str(tmp_path / "b.npz")]
    result = CliRunner().invoke(cli, args)
    assert result.exit_code == 2
    assert "a.txt: no recording" in result.output


def test_frames_of_any_source_are_converted_with_their_truth(tmp_path: Path) -> None:
    args = ("--source", "simulate", "--with", "scene=discs", "--frames", 3, "--seed", 4)
    assert "3 frames" in run(tmp_path / "a.npz", *args)
    run(tmp_path / "b.zarr", *args)
    one, other = (
        list(recording(path=tmp_path / name, report=Report())) for name in ("a.npz", "b.zarr")
    )
    assert len(one) == 3
    for a, b in zip(one, other, strict=True):
        assert a.truth == b.truth
        assert a.truth
        np.testing.assert_array_equal(a.image.values, b.image.values)


def test_a_source_that_makes_its_frames_makes_as_many_as_are_asked_for(tmp_path: Path) -> None:
    args = ("--source", "simulate", "--with", "scene=discs", "--frames", 23)
    assert "23 frames" in run(tmp_path / "a.npz", *args)
    assert "2 frames" in run(tmp_path / "b.npz", *args, "--with", "frames=2")


def test_truth_of_a_file_is_attached(tmp_path: Path, made: list[Frame]) -> None:
    truth = tmp_path / "truth.csv"
    truth.write_text("frames,kind,x_cm,y_cm,radius_cm,name\n0-2,circle,1,2,0.5,cup\n3-5,none,,,,\n")
    run(tmp_path / "a.npz", tmp_path / "b.npz", "--truth", truth)
    read = list(recording(path=tmp_path / "b.npz", report=Report()))
    assert [[o.name for o in f.truth or ()] for f in read] == [["cup"]] * 3 + [[]] * 3
    assert [f.time_s for f in read] == [f.time_s for f in made]


def test_several_recordings_and_any_setting_of_their_reader(
    tmp_path: Path, made: list[Frame]
) -> None:
    run(tmp_path / "a.npz", tmp_path / "a.npz", tmp_path / "b.npz", "--with", "flip=rows")
    read = list(recording(path=tmp_path / "b.npz", report=Report()))
    assert len(read) == 12
    np.testing.assert_array_equal(read[6].image.values, made[0].image.values[::-1])


def rows_read(*, rows_of: Path) -> Iterator[Frame]:
    for k, line in enumerate(rows_of.read_text().splitlines()):
        yield Frame.of(np.full((2, 2), float(line)), quantity="volt", index=k)


def test_recordings_are_read_by_the_plugins_step_that_source_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows = plugin(tmp_path, steps={"rows_read": rows_read}, readers={"rows_read": "rows_of"})
    found = Registry([*registry.found_plugins(), ("rows", "rows", "1", rows)])
    monkeypatch.setattr(registry, "installed", lambda: found)
    monkeypatch.setattr("tactile_graph_sources.commands.any_source.installed", lambda: found)
    (tmp_path / "a.rows").write_text("1\n2\n")
    run(tmp_path / "a.rows", tmp_path / "b.npz", "--source", "rows_read")
    read = list(recording(path=tmp_path / "b.npz", report=Report()))
    assert [f.image.values[0, 0] for f in read] == [1.0, 2.0]


def test_the_form_of_times_is_typed_as_it_stands(tmp_path: Path) -> None:
    lines = [f"16.11.2026 10h{k:02d}," + ",".join("12345678"[:k] + "9" * (9 - k)) for k in range(6)]
    (tmp_path / "a.csv").write_text("\n".join(["stamp,a1,a2,a3,b1,b2,b3,c1,c2,c3", *lines]))
    told = ("--with", "time_column=stamp", "--with", "time_format=%d.%m.%Y %Hh%M")
    run(tmp_path / "a.csv", tmp_path / "b.npz", *told)
    read = list(recording(path=tmp_path / "b.npz", report=Report()))
    assert [f.time_s for f in read] == [60.0 * k for k in range(6)]


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (["b.npz"], "give recordings before TARGET, or --source"),
        (["a.npz", "b.npz", "--source", "simulate"], "or --source simulate, not both"),
        (["a.npz", "b.npz", "--source", "recordng"], "did you mean 'recording'"),
        (["b.npz", "--source", "simulat"], "did you mean 'simulate'"),
        (["b.npz", "--source", "threshold"], "this step is no source"),
        (["b.npz", "--source", "simulate", "--with", "scen=discs"], "did you mean 'scene'"),
    ],
)
def test_a_source_that_will_not_do_is_refused(
    tmp_path: Path, made: list[Frame], args: list[str], message: str
) -> None:
    paths = [str(tmp_path / a) if a.endswith(".npz") else a for a in args]
    result = CliRunner().invoke(cli, ["convert", *paths])
    assert result.exit_code == 2
    assert message in result.output


def test_truth_stays_with_its_frame_where_one_is_left_out(tmp_path: Path) -> None:
    lines = [",".join(str((7 * c + k) % 11) for c in range(15)) for k in range(8)]
    lines[3] = lines[3][:9]
    (tmp_path / "bad.csv").write_text("\n".join(lines) + "\n")
    truth = tmp_path / "truth.csv"
    rows = [f"{k},circle,{k},2,0.5" for k in range(8)]
    truth.write_text("\n".join(["frames,kind,x_cm,y_cm,radius_cm", *rows]) + "\n")
    told = ("--rows", "3", "--columns", "5", "--truth", truth)
    said = run(tmp_path / "bad.csv", *told, tmp_path / "b.npz")
    assert "those that were left out, of which 3 is the first, count too" in said
    shapes = [
        f.truth[0].shape for f in recording(path=tmp_path / "b.npz", report=Report()) if f.truth
    ]
    assert [s.x_cm for s in shapes if isinstance(s, Circle)] == [0, 1, 2, 4, 5, 6, 7]
    run(tmp_path / "bad.csv", *told, "--frames", "4", tmp_path / "c.npz")
    run(tmp_path / "bad.csv", *told, "--with", "skip=2", tmp_path / "d.npz")
    shapes = [
        f.truth[0].shape for f in recording(path=tmp_path / "d.npz", report=Report()) if f.truth
    ]
    assert [s.x_cm for s in shapes if isinstance(s, Circle)] == [2, 4, 5, 6, 7]


@pytest.mark.parametrize("kept", ["b.zarr", "b.npz"])
def test_truth_by_a_recordings_own_numbers_is_found_after_it_was_converted(
    tmp_path: Path, kept: str
) -> None:
    lines = [",".join(map(str, [5 + k, *(k + c for c in range(15))])) for k in range(6)]
    (tmp_path / "a.csv").write_text("\n".join(["frame" + ",v" * 15, *lines]) + "\n")
    run(tmp_path / "a.csv", tmp_path / kept, "--rows", 3, "--columns", 5)
    (tmp_path / "truth.csv").write_text("numbers,kind,x_cm,y_cm,radius_cm\n7,circle,1,2,0.5\n")
    run(tmp_path / kept, tmp_path / "c.npz", "--truth", tmp_path / "truth.csv")
    read = list(recording(path=tmp_path / "c.npz", report=Report()))
    assert [f.own_number for f in read if f.truth] == [7]
    assert "no place for it: own numbers" in run(tmp_path / kept, tmp_path / "d.csv")


def test_truth_that_replaces_another_is_told(tmp_path: Path) -> None:
    frames = [
        Frame.of(
            np.ones((3, 5)), index=k, truth=(TrueObject(Circle(1.0, 2.0, 3.0)),) if k else None
        )
        for k in range(6)
    ]
    write_npz(tmp_path / "a.npz", frames)
    truth = tmp_path / "truth.csv"
    truth.write_text("frames,kind,x_cm,y_cm,radius_cm\n0-3,circle,1,2,0.5\n")
    said = run(tmp_path / "a.npz", tmp_path / "b.npz", "--truth", truth)
    what = "truth.csv: replaces the truth that the recording held of"
    assert f"{what} 5 frames; of 2 of them it says nothing\n" in said
    said = run(tmp_path / "a.npz", tmp_path / "c.npz", "--truth", truth, "--frames", 2)
    assert f"{what} 1 frame\n" in said
    assert "replaces the truth" not in run(tmp_path / "b.npz", tmp_path / "d.npz")


@pytest.mark.parametrize("ending", [".npz", ".zarr", ".csv"])
def test_an_assumed_pitch_stays_one(tmp_path: Path, ending: str) -> None:
    np.savez(tmp_path / "untold.npz", frames=np.arange(60.0).reshape(4, 3, 5))
    run(tmp_path / "untold.npz", tmp_path / f"once{ending}")
    run(tmp_path / f"once{ending}", tmp_path / f"twice{ending}")
    report = Report()
    read = list(recording(path=tmp_path / f"twice{ending}", report=report))
    assert report.counts[PITCH_UNTOLD] == 1
    assert [f.image.pitch_cm for f in read] == [(1.0, 1.0)] * 4
    np.testing.assert_array_equal(read[3].image.values, np.arange(45.0, 60.0).reshape(3, 5))
    told = tmp_path / f"told{ending}"
    run(tmp_path / f"twice{ending}", told, "--pitch-cm", "1")
    assert not look_into(told, {}).pitch_assumed
    assert look_into(tmp_path / f"twice{ending}", {}).pitch_assumed


def broken_writer(path: Path, frames: Iterator[Frame], about: str) -> int:
    next(frames)
    path.write_text("half")
    raise ValueError("disk is odd")


def idle_writer(path: Path, frames: Iterator[Frame], about: str) -> int:
    return len([*frames])


@pytest.mark.parametrize(
    ("write", "told"),
    [
        (broken_writer, ": its write breaks: ValueError: disk is odd ("),
        (idle_writer, " says that it wrote 6 frames, and no file is there"),
    ],
)
def test_what_is_wrong_with_a_plugins_writer_names_it(
    tmp_path: Path, made: list[Frame], monkeypatch: pytest.MonkeyPatch, write: Any, told: str
) -> None:
    @hookimpl
    def tactile_graph_recording_writers() -> dict[str, str]:
        return {".odd": "odd_writers:WRITER"}

    mine: Any = ModuleType("odd_writers")
    mine.WRITER = RecordingWriter(write)
    mine.tactile_graph_recording_writers = tactile_graph_recording_writers
    monkeypatch.setitem(sys.modules, "odd_writers", mine)
    found = Registry([*registry.found_plugins(), ("mine", "mine-pads", "1", lambda: mine)])
    monkeypatch.setattr("tactile_graph_sources.commands.convert.installed", lambda: found)
    result = CliRunner().invoke(
        cli, ["convert", *map(str, (tmp_path / "a.npz", tmp_path / "b.odd"))]
    )
    assert result.exit_code == 2
    assert f"b.odd: writer '.odd' of plugin 'mine' (package mine-pads){told}" in result.output
    assert "b.odd: 6 frames" not in result.output
