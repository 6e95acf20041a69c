"""``summary`` counts, averages and names what results hold, alike in every format of file."""

from __future__ import annotations

import json
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cli import call
from tactile_graph.cli.output.data_set import MANIFEST
from tactile_graph.cli.summary import reading
from tactile_graph.cli.summary import summary as summaries
from tactile_graph.cli.summary.reading import chunks
from tactile_graph.cli.summary.summary import Summary

CSV = """\
frame,time_s,label,circle.outcome,circle.x_cm,circle.turned_rad,circle.centre_error_cm,circle.fine
0,0.0,a.npz,ok,1.0,0.1,0.5,True
1,0.5,a.npz,ok,3.0,3.1,-1.5,False
2,1.0,a.npz,skipped: nothing lies there,,,,
3,0.0,b.npz,failed: fewer than 3 points,,,,
4,2.0,b.npz,ok,nan,0.2,,True
"""
LONG = """\
frame,time_s,label,output,item,outcome,type,x_cm,total
0,0.0,,load,,ok,Load,,5
0,0.0,,objects.contacts,1,ok,Contact,1,
0,0.0,,objects.contacts,2,ok,Contact,2,
1,0.1,,load,,ok,Load,,7
1,0.1,,objects.contacts,,no items,,,
"""


@pytest.fixture(autouse=True)
def _here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    Path("out.csv").write_text(CSV)
    Path("long.csv").write_text(LONG)


def of(*names: str) -> Any:
    done = call("summary", *names, "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_frames_outcomes_and_quantities_are_counted_of_each_recording_and_in_all() -> None:
    told = of("out.csv")
    assert (told["frames"], told["lasts_s"]) == (5, 3.0)
    assert told["outcomes"]["circle"] == {
        "ok": 3, "skipped: nothing lies there": 1, "failed: fewer than 3 points": 1,
    }  # fmt: skip
    x = told["quantities"]["circle.x_cm"]
    assert (x["unit"], x["n"], x["not_finite"]) == ("cm", 2, 1)
    assert (x["mean"], x["median"], x["least"], x["most"]) == (2.0, 2.0, 1.0, 3.0)
    assert told["texts"]["circle.fine"] == {"yes": 2, "no": 1}
    first, second = told["recordings"]
    assert [r["recording"] for r in (first, second)] == ["a.npz", "b.npz"]
    assert (first["frames"], first["lasts_s"], second["frames"]) == (3, 1.0, 2)
    assert second["outcomes"]["circle"] == {"failed: fewer than 3 points": 1, "ok": 1}
    assert second["quantities"]["circle.x_cm"]["mean"] is None


def test_a_joined_recording_lasts_as_long_as_its_parts() -> None:
    head = "frame,time_s,load.outcome,load.total\n"
    times = [100.0, 101.0, 102.0, 0.0, 1.0, "", 3.0]
    Path("joined.csv").write_text(head + "".join(f"{k},{t},ok,5\n" for k, t in enumerate(times)))
    assert of("joined.csv")["lasts_s"] == 5.0
    assert (
        "7 frames, 5 s by their times (1 frames a second)" in call("summary", "joined.csv").stdout
    )


def test_frames_a_little_out_of_order_last_no_longer() -> None:
    head = "frame,time_s,load.outcome,load.total\n"
    times = [0.1 * k - 0.15 * (k in (7, 20, 33)) for k in range(50)]
    Path("out_of_order.csv").write_text(
        head + "".join(f"{k},{t:.2f},ok,5\n" for k, t in enumerate(times))
    )
    assert of("out_of_order.csv")["lasts_s"] == pytest.approx(4.9)


def test_errors_are_by_their_size_and_angles_have_no_mean() -> None:
    told = of("out.csv")["quantities"]
    error = told["circle.centre_error_cm"]
    assert (error["mean"], error["most"], error["bias"]) == (1.0, 1.5, -0.5)
    assert told["circle.turned_rad"]["mean"] is None
    assert told["circle.turned_rad"]["median"] == 0.2


@pytest.mark.parametrize("n", [500, 20_000])
@pytest.mark.parametrize("centre", [0.0, 86.0, 90.0])
def test_angles_of_axes_are_told_from_where_fewest_lie(centre: float, n: int) -> None:
    angles = centre + np.random.default_rng(0).uniform(-4.0, 4.0, n)
    wrapped = (angles + 90.0) % 180.0 - 90.0
    rows = [f"{i},ok,{a}" for i, a in enumerate(wrapped)]
    Path("axes.csv").write_text("\n".join(["frame,r.outcome,r.angle_deg", *rows]))
    told = of("axes.csv")["quantities"]["r.angle_deg"]
    expected = [angles.min(), *np.quantile(angles, (0.05, 0.5, 0.95)), angles.max()]
    got = [told[key] for key in ("least", "p5", "median", "p95", "most")]
    assert got == pytest.approx(expected, abs=0.1)
    assert told["mean"] is None


def test_angles_below_0_alone_stay_there() -> None:
    rng = np.random.default_rng(0)
    for _ in range(20):  # however the difference of two of them is rounded
        rows = [f"{i},ok,{a}" for i, a in enumerate(rng.uniform(-80.0, -1.0, 20))]
        Path("axes.csv").write_text("\n".join(["frame,r.outcome,r.angle_deg", *rows]))
        assert of("axes.csv")["quantities"]["r.angle_deg"]["most"] < 0.0


def test_angles_all_around_have_no_order() -> None:
    rows = [f"{i},ok,{a}" for i, a in enumerate(np.linspace(-89.0, 90.0, 180))]
    Path("axes.csv").write_text("\n".join(["frame,r.outcome,r.angle_deg", *rows]))
    told = of("axes.csv")["quantities"]["r.angle_deg"]
    assert told["n"] == 180
    assert {told[key] for key in ("mean", "least", "p5", "median", "p95", "most")} == {None}
    assert call("summary", "axes.csv").exit_code == 0


def test_rows_of_objects_are_told_by_their_output() -> None:
    told = of("long.csv")
    assert told["frames"] == 2
    assert told["outcomes"] == {"load": {"ok": 2}, "objects.contacts": {"ok": 2, "no items": 1}}
    assert told["quantities"]["objects.contacts.x_cm"]["mean"] == 1.5
    assert told["quantities"]["load.total"]["n"] == 2


@pytest.mark.slow
def test_all_formats_come_to_the_same() -> None:
    pytest.importorskip("pyarrow")
    names = ["out.csv", "out.parquet", "out.jsonl", "out.dataset"]
    for name in names:
        done = call("run", "circle-1", "--frames", 6, "-o", name)
        assert done.exit_code == 0, done.output
    told = [of(name) for name in names]
    for one in told[1:]:
        assert (one["frames"], one["outcomes"]) == (told[0]["frames"], told[0]["outcomes"])
        for key, numbers in told[0]["quantities"].items():
            got = one["quantities"][key]
            assert got.pop("unit") == numbers["unit"]
            assert got == pytest.approx({k: v for k, v in numbers.items() if k != "unit"}), key
    assert "circle.centre_error_cm" in told[0]["quantities"]


@pytest.mark.parametrize("name", ["r.csv", "r.jsonl"])
def test_results_that_powershell_sent_to_a_file_come_to_the_same(name: str) -> None:
    rows = [{"frame": k, "outputs": {"load": {"total": float(k)}}} for k in range(3)]
    lines = "".join(json.dumps(row) + "\n" for row in rows)
    path, text = Path(name), CSV if name == "r.csv" else lines
    path.write_text(text)
    told = call("summary", name).stdout
    path.write_text(text, encoding="utf-16")
    got = call("summary", name)
    assert got.exit_code == 0, got.stderr
    assert got.stdout == told


def test_what_was_skipped_and_items_of_lists_are_told_of_json_lines() -> None:
    rows = [
        {"frame": 0, "outputs": {"c": {"skipped": "empty", "origin": "c"}, "n": 3}},
        {"frame": 1, "outputs": {"c": [{"x_cm": 1.0}, {"failed": "no", "origin": "c"}], "n": 4}},
    ]
    Path("out.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    told = of("out.jsonl")
    assert told["outcomes"]["c"] == {"skipped: empty": 1, "failed: no": 1}
    assert told["quantities"]["c.x_cm"]["n"] == 1
    assert told["quantities"]["n"]["mean"] == 3.5


def test_numbers_of_lists_count_whether_or_not_an_item_failed() -> None:
    failed = {"failed": "too dark", "origin": "b", "kind": "degenerate", "item": "2"}
    lists: list[list[Any]] = [[10.0, 20.0], [30.0], [1.0, failed], [failed], []]
    lines = [
        {
            "frame": i,
            "outputs": {"b": b, "held": {"corners": [[1, 2], [3, 4]], "each": [failed, 5]}},
        }
        for i, b in enumerate(lists)
    ]
    Path("lists.jsonl").write_text("\n".join(map(json.dumps, lines)) + "\n")
    told = of("lists.jsonl")
    b = told["quantities"]["b"]
    assert (b["n"], b["mean"], b["least"], b["most"]) == (4, 15.25, 1.0, 30.0)
    assert told["outcomes"]["b"] == {"ok": 3, "failed: too dark": 2}
    assert "held.corners" not in told["quantities"]
    assert "held.each" not in told["quantities"]


def test_people_get_what_fits_and_are_told_the_rest() -> None:
    done = call("summary", "out.csv")
    assert "out.csv: 5 frames of 2 recordings, 3 s by their times" in done.stdout
    assert "3 ran, 1 skipped, 1 failed" in done.stdout
    assert "1 skipped: nothing lies there" in done.stdout
    (row,) = (line.split() for line in done.stdout.splitlines() if line.startswith("circle x"))
    assert row == ["circle", "x", "cm", "2", "(+1", "no", "number)", "2.000", "1.100", "2.000",
                   "2.900", "1.000", "3.000"]  # fmt: skip
    assert "circle fine: yes 2, no 1" in done.stdout


@pytest.mark.parametrize(
    ("width", "gone"),
    [(120, ""), (60, "5 %, 95 % ("), (40, "5 %, median, 95 %, least, most (")],
)
def test_a_narrow_terminal_shows_names_and_numbers_whole_and_says_what_is_left_out(
    width: int, gone: str
) -> None:
    from click.testing import CliRunner

    from tactile_graph.cli import cli

    Path("a.csv").write_text(CSV)
    out = CliRunner(env={"COLUMNS": str(width)}).invoke(cli, ["summary", "a.csv"]).output
    words = out.split()
    assert {"circle", "turned", "error", "unit", "mean", "rad", "cm"} <= set(words), out
    assert "1.000" in words, out
    assert (f"not shown for want of width: {gone}" in out) == bool(gone)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a,b\n1,2\n", "bad: is no result of a run: has no columns 'frame' and '….outcome'"),
        (CSV.encode() + b"5,1\n", "bad:7: has 2 cells, the header 8"),
        (b"PAR1 and no more", "bad: is no whole Parquet file"),
        (b'{"outputs": {}}\n{"x"\n', "bad:2: is no JSON"),
        (b'{"frame":0,"outputs":' + b'{"a":' * 9000 + b"1" + b"}" * 9001, "bad:1: is no line of a"),
        (b"{}\n", "bad:1: is no line of a run: has no 'outputs'"),
        (b"\xff\xfe\x00", "bad: is no result file: no UTF-8"),
    ],
)
def test_what_is_no_result_is_told_where_and_why(content: bytes, said: str) -> None:
    if b"PAR1" in content:
        pytest.importorskip("pyarrow")
    Path("bad").write_bytes(content)
    done = call("summary", "bad")
    assert done.exit_code == 2
    assert said in done.stderr


def test_units_and_a_manifest_that_are_nested_too_deep_tell_nothing() -> None:
    Path("a.csv").write_text("frame,load.outcome,load.total\n0,value,1\n")
    Path("a.csv.meta.json").write_text("[" * 9000)
    assert call("summary", "a.csv").exit_code == 0
    Path("folder").mkdir()
    Path("folder", MANIFEST).write_text("[" * 9000)
    assert "folder: is no data set" in call("summary", "folder").stderr


def test_a_folder_that_is_no_data_set_and_a_missing_file_are_told() -> None:
    Path("folder").mkdir()
    assert "folder: is no data set" in call("summary", "folder").stderr
    assert "none.csv: cannot be read" in call("summary", "none.csv").stderr


def test_several_files_are_recordings_of_their_own() -> None:
    Path("other.csv").write_text(CSV)
    told = of("out.csv", "other.csv")
    assert told["frames"] == 10
    assert [r["recording"] for r in told["recordings"]][::2] == [
        "out.csv: a.npz",
        "other.csv: a.npz",
    ]


@pytest.mark.slow
def test_more_rows_and_more_recordings_take_no_more_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "ROWS_A_CHUNK", 500)
    monkeypatch.setattr(summaries, "WHOLE_RECORDINGS", 4)
    rng = np.random.default_rng(1)
    most = {}
    for n_recordings in (20, 40):
        lines = [f"{k},{k},r{k * n_recordings // 20_000},ok,{x}"
                 for k, x in enumerate(rng.normal(size=20_000))]  # fmt: skip
        Path("many.csv").write_text("frame,time_s,label,c.outcome,c.x_cm\n" + "\n".join(lines))
        tracemalloc.start()
        found = Summary()
        for chunk in chunks(Path("many.csv")):
            found.add(chunk, "many.csv")
        most[n_recordings] = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert (found.frames, len(found.recordings)) == (20_000, n_recordings)
    assert most[40] < 1.3 * most[20]


def test_numbers_in_different_units_are_different_quantities() -> None:
    head = "frame,time_s,label,load.outcome,load.total,load.x_cm\n"
    for name, total, unit in (("v", 1, "V"), ("g", 1000, "g")):
        Path(f"{name}.csv").write_text(f"{head}0,0.0,,ok,{total},2\n1,0.5,,ok,{3 * total},4\n")
        Path(f"{name}.csv.meta.json").write_text(json.dumps({"columns": {"load.total": unit}}))
    for names in (("v.csv", "g.csv"), ("g.csv", "v.csv")):
        told = of(*names)
        means = {k: (q["unit"], q["n"], q["mean"]) for k, q in told["quantities"].items()}
        assert means == {
            "load.total [V]": ("V", 2, 2.0), "load.total [g]": ("g", 2, 2000.0),
            "load.x_cm": ("cm", 4, 3.0),
        }  # fmt: skip
        units = [r["quantities"]["load.total"]["unit"] for r in told["recordings"]]
        assert units == ["V" if name == "v.csv" else "g" for name in names]
    lines = [line.split() for line in call("summary", "v.csv", "g.csv").stdout.splitlines()]
    rows = [line[:5] for line in lines if line[:1] == ["load"] and line[3:4] in (["2"], ["4"])]
    assert rows == [
        ["load", "total", "V", "2", "2"], ["load", "total", "g", "2", "2000"],
        ["load", "x", "cm", "4", "3.000"],
    ]  # fmt: skip


def test_a_column_that_no_unit_is_told_of_goes_with_the_others() -> None:
    """JSON lines tell none of sums of readings, nor a CSV file without the file beside it."""
    head = "frame,time_s,label,load.outcome,load.total\n"
    for name, total in (("a", 1), ("b", 3)):
        Path(f"{name}.csv").write_text(f"{head}0,0.0,,ok,{total}\n1,0.5,,ok,{total}\n")
    Path("a.csv.meta.json").write_text(json.dumps({"columns": {"load.total": "g"}}))
    for names in (("a.csv", "b.csv"), ("b.csv", "a.csv")):
        told = of(*names)
        (quantity,) = told["quantities"].values()
        assert (quantity["unit"], quantity["n"], quantity["mean"]) == ("g", 4, 2.0)
        assert [r["quantities"]["load.total"]["n"] for r in told["recordings"]] == [2, 2]


def test_where_no_number_is_finite_the_ends_are_left_empty() -> None:
    line = '{"frame": 1, "outputs": {"c": {"x_cm": 1e400}, "n": %s}}\n' % 10**400
    Path("inf.jsonl").write_text(line)
    done = call("summary", "inf.jsonl")
    assert done.exit_code == 0, done.output
    (row,) = (line.split() for line in done.stdout.splitlines() if line.startswith("c x"))
    assert row == ["c", "x", "cm", "0", "(+1", "no", "number)"]
    assert (of("inf.jsonl")["quantities"]["n"]["n"], "inf " in done.stdout) == (0, False)


@pytest.mark.parametrize("again", ["out.csv", "./out.csv", "link.csv"])
def test_a_file_that_is_given_twice_is_refused(again: str) -> None:
    Path("link.csv").symlink_to("out.csv")
    done = call("summary", "out.csv", again)
    assert done.exit_code == 2
    assert "is given twice" in done.stderr
    assert ("(also as out.csv)" in done.stderr) == (again == "link.csv")
    assert call("summary", "out.csv", "long.csv").exit_code == 0


def test_frames_without_numbers_are_refused_in_every_format() -> None:
    pq = pytest.importorskip("pyarrow.parquet")
    arrow = pytest.importorskip("pyarrow")
    Path("x.csv").write_text("frame,n.outcome\none,ok\n")
    pq.write_table(arrow.table({"frame": ["one"], "n.outcome": ["ok"]}), "x.parquet")
    Path("x.jsonl").write_text('{"frame": "one", "outputs": {}}\n')
    for name in ("x.csv", "x.parquet"):
        done = call("summary", name)
        assert done.exit_code == 2
        assert f"{name}: is no result of a run: column 'frame' must hold numbers, got 'one'" in (
            done.stderr
        )
    done = call("summary", "x.jsonl")
    assert "x.jsonl:1: is no line of a run: 'frame' must be a number, got 'one'" in done.stderr


def test_numbers_under_names_of_long_tables_are_numbers_in_others() -> None:
    Path("type.csv").write_text("frame,type.outcome,type\n0,ok,1.5\n1,ok,2.5\n")
    assert of("type.csv")["quantities"]["type"]["mean"] == 2.0
