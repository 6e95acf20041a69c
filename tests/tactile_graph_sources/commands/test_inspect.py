"""``inspect``: what a recording is and holds, and what takes it."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

from helpers_dialects import film, flat
from helpers_recordings import shared, xsensor_text
from tactile_graph import Frame
from tactile_graph.cli import cli
from tactile_graph_sources.commands import inspect
from tactile_graph_sources.writers.write_npz import write_npz

RNG = np.random.default_rng(0)


def run(*args: object, code: int = 0) -> str:
    result = CliRunner().invoke(cli, ["inspect", *(str(a) for a in args)])
    assert result.exit_code == code, result.output
    return result.output if code else result.stdout


def looked(*args: object) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(run(*args, "--json"))
    return found


@pytest.fixture
def nothing_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Pipelines are told from what they take alone: running them is another test's."""
    monkeypatch.setattr(inspect, "MOST_TRIED", 0)


@pytest.fixture
def mat(tmp_path: Path) -> Path:
    """A film of counts with noise 1.5, a dead, a stuck, a noisy and a missing cell, and garbage."""
    values = film(60, 10, 12)
    values[:36] = np.minimum(values[:36], 14.0)  # nothing lies there yet
    values += RNG.normal(0, 1.5, values.shape)
    values[:, 5, 6] = 11.0
    values[:, 1, 2] = 500.0
    values[:, 8, 9] += RNG.normal(0, 40.0, 60)
    values[:, 0, 11] = np.nan
    frames = [
        Frame.of(v, 0.8, quantity="counts", index=k, time_s=0.02 * k) for k, v in enumerate(values)
    ]
    garbage = Frame.of(RNG.integers(0, 65536, (10, 12)), 0.8, quantity="counts", time_s=-0.02)
    write_npz(tmp_path / "mat.npz", [garbage, *frames])
    return tmp_path / "mat.npz"


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
def test_where_the_grid_begins_is_said_unless_that_is_the_corner_of_the_pad(
    tmp_path: Path,
) -> None:
    for name, origin_cm in (("a.npz", (9.75, -2.0)), ("b.npz", (0.0, 0.0))):
        frame = Frame.of(np.eye(3), 0.5, quantity="counts", origin_cm=origin_cm)
        write_npz(tmp_path / name, [frame])
    assert "\n  origin    (9.75, -2) cm, its top left corner\n" in run(tmp_path / "a.npz")
    assert "origin" not in run(tmp_path / "b.npz")


@pytest.mark.slow  # much is compiled
@pytest.mark.usefixtures("nothing_tried")
def test_it_measures_what_the_film_was_made_with(mat: Path) -> None:
    found = looked(mat)
    (sensor,) = found["sensors"]
    assert found["counts"] == {"frames of garbage left out": 1}
    assert (sensor["n_frames"], sensor["shape"]) == (60, [10, 12])
    assert sensor["rate_hz"] == pytest.approx(50.0)
    # Counts of 10 to 14 at random and the noise: variances add.
    assert sensor["noise"] == pytest.approx(np.hypot(1.5, np.sqrt(2.0)), rel=0.3)
    assert sensor["offset"] == pytest.approx(12.0, abs=3.5)
    assert sensor["dead"] == [[5, 6]]
    assert sensor["stuck"] == [[1, 2]]
    assert sensor["noisy"] == [[8, 9]]
    assert sensor["missing"] == [[0, 11]]
    assert not sensor["pitch_assumed"]
    assert max(sensor["n_contacts"][:36]) <= 1  # the stuck cell and one of the noisy
    assert max(sensor["n_contacts"]) >= 2


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
@pytest.mark.parametrize(("pitch_cm", "more", "doubted"), [
    (1.0, (), True), (1.0, ("--with", "pitch_cm=1"), False), (0.8, (), False),
])  # fmt: skip
def test_a_pitch_that_older_versions_wrote_where_nobody_said_it_is_doubted(
    tmp_path: Path, pitch_cm: float, more: tuple[str, ...], doubted: bool
) -> None:
    frame = Frame.of(RNG.normal(0, 1.5, (4, 5)), pitch_cm, quantity="counts")
    write_npz(tmp_path / "old.npz", [frame])
    said = run(tmp_path / "old.npz", *more)
    assert ("stands, too, where older versions wrote what nobody had said" in said) == doubted
    assert ("add --with pitch_cm=…" in said) == doubted


@pytest.mark.slow
def test_what_lies_there_from_first_to_last_is_a_contact_and_not_how_the_pad_rests(
    tmp_path: Path,
) -> None:
    values = np.random.default_rng(0).integers(0, 4, (9, 16, 16)).astype(float)
    values[:, 3:7, 4:9] += 300.0
    values[5:, 11:14, 11:14] += 200.0
    path = tmp_path / "lies.npz"
    np.savez(path, frames=values)
    (sensor,) = looked(path)["sensors"]
    assert sensor["n_contacts"] == [1] * 5 + [2] * 4
    assert sensor["n_lasting"] == 1
    assert "1 a frame as a rule, 1 to 2, 1 of them in every frame" in run(path)


@pytest.mark.slow  # much is compiled
@pytest.mark.usefixtures("nothing_tried")
def test_people_read_the_same_and_see_the_fullest_frame(mat: Path) -> None:
    text = run(mat)
    assert "format    NumPy .npz" in text
    assert "pitch     0.8 x 0.8 cm (known), so 9.6 x 8 cm" in text
    assert "dead      1 at (row, column) (5, 6)" in text
    assert "counted   frames of garbage left out: 1" in text
    lines = text.splitlines()
    frame = [line for line in lines if line.startswith("  |")]
    assert len(frame) == 10
    assert frame[0].endswith("xx|")
    assert len({c for line in frame for c in line.strip(" |x")}) > 3


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
def test_readings_that_fall_are_told_with_what_turns_them_round(tmp_path: Path) -> None:
    values = np.random.default_rng(0).normal(220.0, 1.0, (20, 8, 10))
    values[10:, 2:5, 3:7] -= 60.0
    np.save(tmp_path / "fall.npy", values)
    said = " ".join(run(tmp_path / "fall.npy").split())
    assert "patches of two cells or more that fall" in said
    told = re.search(
        r"falling by up to (\S+) raw in 10 frames, .* (invert_from=2\d\d\S*) turns", said
    )
    assert told is not None
    turned = run(tmp_path / "fall.npy", "--with", told[2])
    assert "falling" not in turned
    assert f" --with {told[2]}" in turned
    (sensor,) = looked(tmp_path / "fall.npy")["sensors"]
    assert sensor["falls"]["frames"] == 10
    assert sensor["fullest"] >= 10


def test_what_it_is_is_said_before_any_pipeline_is_tried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(frames: object) -> None:
        raise RuntimeError("while kernels are compiled")

    monkeypatch.setattr(inspect, "_works", interrupted)
    np.save(tmp_path / "a.npy", film(3, 6, 10))
    result = CliRunner().invoke(cli, ["inspect", str(tmp_path / "a.npy")])
    assert result.exit_code != 0
    assert "grid      6 rows x 10 columns" in result.stdout


@pytest.mark.slow  # much is compiled
def test_objects_in_another_unit_than_the_samples_are_refused_with_how_to_learn_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    frames = [Frame.of(v, 1.0, quantity="kilopascal") for v in film(12, 8, 8)]
    write_npz(Path("mug.npz"), frames)
    shown = run("mug.npz")
    (refused,) = (line for line in shown.splitlines() if "  not identify," in line)
    assert "got a frame of kilopascal; the objects were learned in gram; learn them" in refused
    assert "    tactile-graph learn-pad mug.npz" in shown.splitlines()
    assert "    tactile-graph learn mug mug.npz" in shown.splitlines()
    for words in ("learn mug mug.npz", "identify mug.npz"):
        assert CliRunner().invoke(cli, words.split()).exit_code == 0


@pytest.mark.slow  # much is compiled
def test_where_cells_rest_at_much_tare_is_named(tmp_path: Path, nothing_tried: None) -> None:
    values = RNG.normal(0.0, 1.0, (20, 6, 8))
    values[10:, 2:4, 3:5] += 80.0
    for name, rest in (("zero.npy", 0.0), ("high.npy", 500.0)):
        np.save(tmp_path / name, values + rest)
        told = "first step is tare" in run(tmp_path / name)
        assert told == (rest > 0.0)


def test_the_commands_it_gives_work_as_they_stand(tmp_path: Path) -> None:
    path = tmp_path / "my mat.csv"
    path.write_text(flat(film(12, 6, 10)))
    found = looked(path, "--with", "rows=6", "--with", "columns=10")
    assert found["assumed"] == ["whose pitch is assumed to be 1 cm"]
    contacts = next(c for c in found["commands"] if " run contacts " in c)
    convert = next(c for c in found["commands"] if " convert " in c)
    assert shlex.split(contacts)[3] == str(path)
    for command in (contacts + " --frames 2", convert.replace("my mat.zarr", f"{tmp_path}/a.npz")):
        result = CliRunner().invoke(cli, shlex.split(command)[1:])
        assert result.exit_code == 0, result.output


NO_YAML = ("*.npy", "[b].npy", "%d.npy", "@x.npy", "&x.npy", "!x.npy", "{a}.npy", '"q.npy',
           "-x.npy", "2024-13-01", "\udcff.npy", "a\nb.npy")  # fmt: skip


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
@pytest.mark.parametrize("name", NO_YAML)
def test_names_that_are_no_yaml_are_inspected_and_the_commands_take_them(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with (tmp_path / name).open("wb") as file:
        np.save(file, film(30, 12, 12))
    found = json.loads(run("--json", "--", name))
    levelled, convert = (
        next(c for c in found["commands"] if part in c) for part in (" --set ", " convert ")
    )
    words = as_the_shell_has_them(levelled)
    assert Path(words[3]) == Path(name)
    assert not words[3].startswith("-")
    value = yaml.safe_load(words[-1].partition("noise_of=")[2])
    assert name == (value["path"] if isinstance(value, dict) else value)
    assert Path(as_the_shell_has_them(convert)[2]) == Path(name)


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
def test_a_setting_that_is_no_yaml_is_quoted_where_it_stands_in_yaml(tmp_path: Path) -> None:
    lines = ["time," + ",".join(f"p{k}" for k in range(30))]
    lines += [
        f"3/1/24 12:00:{k:02d}," + ",".join(f"{v:.0f}" for v in frame.ravel())
        for k, frame in enumerate(film(30, 5, 6))
    ]
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    given = {"rows": 5, "columns": 6, "time_format": "%m/%d/%y %H:%M:%S"}
    typed = [f"--with={name}={value}" for name, value in given.items()]
    levelled = next(c for c in looked(tmp_path / "a.csv", *typed)["commands"] if " --set " in c)
    said = as_the_shell_has_them(levelled)[-1].partition("noise_of=")[2]
    values = {name: str(value) for name, value in yaml.safe_load(said).items()}
    assert values == {"path": str(tmp_path / "a.csv"), **{k: str(v) for k, v in given.items()}}


def as_the_shell_has_them(command: str) -> list[str]:
    """Return the words of a command line, as bash hands them over."""
    told = ["bash", "-c", f"printf '%s\\0' {command}"]
    raw = subprocess.run(told, capture_output=True, check=True).stdout
    return [os.fsdecode(word) for word in raw.split(b"\0")[:-1]]


@pytest.mark.parametrize(
    ("name", "zarr", "ending"),
    [("a.csv", True, ".zarr"), ("a.zarr", True, ".npz"), ("a.csv", False, ".npz"),
     ("a.npz", False, ".csv")],
)  # fmt: skip
def test_it_is_converted_to_what_it_is_not_and_needs_no_extra(
    name: str, zarr: bool, ending: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(inspect, "find_spec", lambda _: object() if zarr else None)
    assert inspect.other_kind(Path(name)) == ending


@pytest.mark.slow
def test_pipelines_that_cannot_take_it_are_named_with_the_reason(mat: Path) -> None:
    assert "takes volt, got a frame of counts" in run(mat)


@pytest.mark.slow
def test_what_fails_on_the_fullest_frame_is_not_among_the_commands(tmp_path: Path) -> None:
    """Volts far above what the circuit can give: they say which cells are touched, but no load."""
    values = np.zeros((14, 8, 8))
    values[:, 2:5, 2:6] = RNG.uniform(100.0, 900.0, (14, 3, 4))
    write_npz(
        tmp_path / "v.npz",
        [Frame.of(v, 1.0, (0, 0), "volt", index=k) for k, v in enumerate(values)],
    )
    shown = run(tmp_path / "v.npz")
    assert "not circle-by-order: its fullest frame fails: no element is touched" in shown
    commands = [line.split() for line in shown.splitlines() if " tactile-graph run " in line]
    assert len(commands) >= 6
    for command in commands:
        text = " ".join(command[1:])
        result = CliRunner().invoke(cli, shlex.split(text))
        assert result.exit_code == 0, (text, result.output)


@pytest.mark.slow
def test_each_sensor_is_told_for_itself_and_drawn(tmp_path: Path) -> None:
    path = tmp_path / "walk.csv"
    path.write_text(xsensor_text({"LF": film(9, 6, 5), "RF": film(9, 7, 5, seed=1)}))
    text = run(path, "--picture", tmp_path / "a.png")
    assert "sensor    LF" in text
    assert "grid      7 rows x 5 columns" in text
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_one_frame_has_contacts_and_no_noise(tmp_path: Path) -> None:
    np.save(tmp_path / "a.npy", film(1, 12, 14)[0])
    (sensor,) = looked(tmp_path / "a.npy")["sensors"]
    assert sensor["noise"] is None
    assert sensor["n_contacts"] == [2]


@pytest.mark.slow
def test_a_file_that_is_none_is_an_error_and_costs_the_others_nothing(
    tmp_path: Path, mat: Path
) -> None:
    (tmp_path / "a.txt").write_text("hello\n")
    assert "a.txt: no recording" in run(tmp_path / "a.txt", code=2)
    text = run(tmp_path / "a.txt", mat, code=1)
    assert "a.txt: no recording" in text
    assert "grid      10 rows x 12 columns" in text
    assert "give one FILE" in run(mat, mat, "--picture", tmp_path / "a.png", code=2)
    assert "row: unknown" in run(mat, "--with", "row=3", code=2)


@pytest.mark.slow
def test_nothing_is_dead_or_stuck_on_a_vendors_insoles() -> None:
    for sensor in looked(shared("vendor_exports/xsensor_data.csv"))["sensors"]:
        assert (sensor["dead"], sensor["stuck"]) == ([], [])
        assert sensor["quantity"] == "kilopascal"


@pytest.mark.slow
@pytest.mark.usefixtures("nothing_tried")
@pytest.mark.parametrize("n", [64, 110])
def test_cells_dead_far_below_how_the_others_rest_hide_neither_noise_nor_offset(
    n: int, tmp_path: Path
) -> None:
    rng = np.random.default_rng(n)
    dead = (rng.permutation(256) < n).reshape(16, 16)
    films = np.rint(rng.normal(20.0, 1.5, (40, 16, 16)))
    films[np.arange(40), 5 + np.arange(40) % 6, 8] += 200.0
    np.save(tmp_path / "a.npy", np.where(dead, 0.0, films))
    (sensor,) = looked(tmp_path / "a.npy")["sensors"]
    assert sensor["dead"] == np.argwhere(dead).tolist()
    assert (sensor["noise"], sensor["offset"]) == pytest.approx((1.5, 18.0), rel=0.25)
    assert sensor["offset_spread"] < 3.0


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0.6, 1.0, 3.0])
def test_the_noise_of_whole_counts_is_that_before_they_were_rounded(
    sigma: float, tmp_path: Path
) -> None:
    np.save(tmp_path / "a.npy", np.rint(RNG.normal(50.0, sigma, (200, 12, 12))))
    (sensor,) = looked(tmp_path / "a.npy")["sensors"]
    assert sensor["noise"] == pytest.approx(sigma, rel=0.25)


@pytest.fixture
def pair(tmp_path: Path) -> Path:
    """Two sensors of other grids in a table, the right one loaded later than the left."""
    left, right = film(12, 5, 6), film(12, 4, 5, seed=1)
    named = [f"{side}_r{r}c{c}" for side, f in (("left", left), ("right", right))
             for r, c in np.ndindex(f.shape[1:])]  # fmt: skip
    rows = (np.concatenate([left[k].ravel(), right[k].ravel()]) for k in range(12))
    lines = [",".join(f"{v:.0f}" for v in row) for row in rows]
    path = tmp_path / "pair.csv"
    path.write_text("\n".join([",".join(named), *lines]) + "\n")
    return path


@pytest.mark.slow
def test_of_several_sensors_each_is_shown_with_commands_that_choose_it(
    pair: Path, tmp_path: Path
) -> None:
    text = run(pair, "--picture", tmp_path / "pair.png")
    assert text.startswith(f"{pair}: 2 sensors, each read alone: left, right\n")
    assert "grid      5 rows x 6 columns" in text
    assert "grid      4 rows x 5 columns" in text
    assert (tmp_path / "pair.png").read_bytes().startswith(b"\x89PNG")
    found = [json.loads(line) for line in run(pair, "--json").splitlines()]
    assert [one["sensor"] for one in found] == ["left", "right"]
    for one, shape in zip(found, ([5, 6], [4, 5]), strict=True):
        assert one["sensors"][0]["shape"] == shape
        command = next(c for c in one["commands"] if " run contacts " in c)
        assert command.endswith(f" --with sensor={one['sensor']}")
        levelled = one["commands"][-1]
        assert f'footprint.noise_of={{path: "{pair}", sensor: {one["sensor"]}}}' in levelled
        for each in (command, levelled):
            done = CliRunner().invoke(cli, shlex.split(each)[1:])
            assert done.exit_code == 0, done.output


@pytest.mark.slow
def test_a_sensor_that_cannot_be_read_does_not_hide_the_others(tmp_path: Path) -> None:
    np.savez(tmp_path / "two.npz", flat=np.ones((30, 256)), whole=film(12, 6, 10))
    text = run(tmp_path / "two.npz", code=1)
    assert "flat: " in text
    assert "give rows and columns" in text
    assert "grid      6 rows x 10 columns" in text
    first, second = (
        json.loads(line) for line in run(tmp_path / "two.npz", "--json", code=1).splitlines()
    )
    assert (first["sensor"], second["sensor"]) == ("flat", "whole")
    assert "give rows and columns" in first["error"]
