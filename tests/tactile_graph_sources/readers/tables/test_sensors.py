"""Several sensors in one file: each can be had, and none is read without being named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from helpers_dialects import film
from tactile_graph.errors import DataError
from tactile_graph.steps import Report
from tactile_graph_sources.readers.tables.sensors import sensors_of
from tactile_graph_sources.recording import recording

LEFT, RIGHT, THUMB = film(12, 8, 8), film(12, 8, 8, seed=1), film(12, 4, 6, seed=2)
Name = Callable[[str, int, int, int], str]


def wide(names: Sequence[str], sensors: Sequence[np.ndarray], name: Name) -> str:
    """Return a table with a line a frame and all sensors' cells in it."""
    head = ["time_s"]
    for sensor, values in zip(names, sensors, strict=True):
        _, rows, columns = values.shape
        head += [name(sensor, r, c, r * columns + c) for r in range(rows) for c in range(columns)]
    lines = [",".join(head)]
    for k in range(len(sensors[0])):
        cells = np.concatenate([values[k].ravel() for values in sensors])
        lines.append(",".join([f"{k / 50:g}", *(f"{v:g}" for v in cells)]))
    return "\n".join(lines) + "\n"


def read(path: Path, **settings: object) -> np.ndarray:
    frames = list(recording(path=path, report=Report(), **settings))  # type: ignore[arg-type]
    return np.array([f.image.values for f in frames])


NAMES: dict[str, Name] = {
    "rows and columns": lambda s, r, c, i: f"{s}_r{r}_c{c}",
    "x and y": lambda s, r, c, i: f"{s}_x{c}_y{r}",
    "numbers": lambda s, r, c, i: f"{s}_{i}",
    "numbers from 1": lambda s, r, c, i: f"{s}{i + 1}",
    "brackets": lambda s, r, c, i: f"{s}[{r}][{c}]",
    "points": lambda s, r, c, i: f"{s}.{i}",
    "taxels": lambda s, r, c, i: f"{s}_taxel{i + 1}",
}


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize("names", [("left", "right"), ("L", "R"), ("palm", "index")])
def test_columns_of_two_sensors_are_told_apart_by_how_they_begin(
    names: tuple[str, str], name: Name, tmp_path: Path
) -> None:
    path = tmp_path / "two.csv"
    path.write_text(wide(names, (LEFT, RIGHT), name))
    asked = rf"several sensors: {names[0]} \(64 cells\), {names[1]} \(64 cells\); name one with sen"
    with pytest.raises(DataError, match=asked):
        read(path)
    assert (read(path, sensor=names[0]) == LEFT).all()
    assert (read(path, sensor=names[1].lower()) == RIGHT).all()


def test_sensors_of_different_sizes_and_numbered_ones(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    path.write_text(wide(("palm", "thumb"), (LEFT, THUMB), NAMES["numbers"]))
    with pytest.raises(DataError, match=r"palm \(64 cells\), thumb \(24 cells\)"):
        read(path)
    assert (read(path, sensor="palm") == LEFT).all()
    assert (read(path, sensor="thumb", rows=4, columns=6) == THUMB).all()
    path.write_text(wide(("sensor1", "sensor2"), (LEFT, RIGHT), NAMES["taxels"]))
    assert (read(path, sensor="sensor2") == RIGHT).all()
    path.write_text(wide(("triangle0", "triangle1"), (LEFT, RIGHT), NAMES["taxels"]))
    with pytest.raises(DataError, match=r"several sensors: triangle0 \(64 cells\)"):
        read(path)


def test_few_long_rows_may_be_square_sensors_and_both_can_be_said(tmp_path: Path) -> None:
    path = tmp_path / "two.csv"
    path.write_text(wide(("s1", "s2"), (LEFT, RIGHT), NAMES["numbers"]))
    both = (
        r"s1 \(64 cells\), s2 \(64 cells\), or of one grid of 2 x 64 cells \(then give rows=2, col"
    )
    with pytest.raises(DataError, match=both):
        read(path)
    assert (read(path, sensor="s2") == RIGHT).all()
    grid = read(path, rows=2, columns=64)
    assert (grid[:, 1] == RIGHT.reshape(12, 64)).all()


@pytest.mark.parametrize(
    ("sensor", "message"),
    [
        ("middle", "no sensor 'middle', there are: left hand, right hand"),
        ("hand", "sensor=hand may be any of left hand, right hand; name one of them in full"),
    ],
)
def test_a_sensor_that_is_none_or_several_is_told(
    sensor: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "two.csv"
    path.write_text(wide(("left hand", "right hand"), (LEFT, RIGHT), NAMES["numbers"]))
    with pytest.raises(DataError, match=message):
        read(path, sensor=sensor)


def test_lines_of_several_sensors_are_told_apart_by_a_column(tmp_path: Path) -> None:
    flat, long = tmp_path / "flat.csv", tmp_path / "long.csv"
    lines = ["time," + "sensor," + ",".join(f"v{i}" for i in range(64))]
    cells = ["time,sensor,row,col,value"]
    for k in range(12):
        for name, values in (("left", LEFT[k]), ("right", RIGHT[k])):
            lines.append(f"{k / 50:g},{name}," + ",".join(f"{v:g}" for v in values.ravel()))
            cells += [f"{k / 50:g},{name},{r},{c},{v:g}" for (r, c), v in np.ndenumerate(values)]
    flat.write_text("\n".join(lines))
    long.write_text("\n".join(cells))
    for path in (flat, long):
        with pytest.raises(DataError, match="as column 'sensor' says: left, right; name one with"):
            read(path)
        assert (read(path, sensor="left") == LEFT).all()
        assert (read(path, sensor="right") == RIGHT).all()


@pytest.mark.parametrize(
    "names",
    [
        [f"v{i}" for i in range(64)],
        [f"r{r}c{c}" for r in range(8) for c in range(8)],
        [f"{row}{i}" for row in "ABCDEFGH" for i in range(1, 9)],
        [f"S{r}_{c}" for r in range(8) for c in range(8)],
        [f"Zeile{r}_Spalte{c}" for r in range(8) for c in range(8)],
        [f"p{i}" for i in range(64)] + ["temp1", "temp2", "imu_1", "imu_2", "imu_3"],
        ["a", "b", "time"],
        ["1" * 100_000, "_1" * 50_000],
        [],
    ],
)
def test_one_sensor_is_not_taken_for_several(names: list[str]) -> None:
    assert sensors_of(names).columns == {}


@pytest.mark.slow
def test_every_command_that_reads_names_the_sensors_and_takes_the_choice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("two.csv").write_text(wide(("left", "right"), (LEFT, RIGHT), NAMES["numbers"]))
    assert "2 sensors, each read alone: left, right" in call("inspect", "two.csv").stdout
    assert call("inspect", "two.csv", "--with", "sensor=right").exit_code == 0
    for command in (["run", "contacts"], ["convert"]):
        command += ["two.csv", "out.npz"] if command == ["convert"] else ["two.csv"]
        got = call(*command)
        assert got.exit_code == 2
        assert "left (64 cells), right (64 cells); name one with sensor" in got.stderr
        assert call(*command, "--with", "sensor=right").exit_code == 0
    assert (read(Path("out.npz")) == RIGHT).all()
