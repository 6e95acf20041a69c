"""No command writes over what it reads, or two things into one file, whatever they are called."""

from __future__ import annotations

import hashlib
import os
import shutil
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from tactile_graph import load
from tactile_graph.cli import cli
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import UsageError

pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
INNER = """
pipeline: inner
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
outputs: [footprint]
"""
OUTER = """
pipeline: outer
source: {step: recording, with: {path: film.npz}}
nodes:
  inside: {use: inner.yaml, in: frame}
  footprint: {step: threshold, in: frame, with: {level: auto, noise_of: noise.npz}}
  parts: {step: contacts, in: {image: frame, mask: footprint}}
  items: {use: item.yaml, in: parts.contacts, each: true}
outputs: [inside, footprint, items]
"""
SIMULATED = ("--source", "simulate", "--with", "scene=discs")


def call(*args):
    return CliRunner().invoke(cli, [str(a) for a in args])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with a file of each kind that a command reads."""
    folder = tmp_path_factory.mktemp("made")
    for name in ("film.npz", "store.zarr"):
        got = call("convert", folder / name, *SIMULATED, "--frames", 4)
        assert got.exit_code == 0, got.output
    (folder / "p.yaml").write_text(call("pipelines", "circle-1").output)
    (folder / "pad.yaml").write_text(call("pads", "thesis").output)
    (folder / "inner.yaml").write_text(INNER)
    (folder / "item.yaml").write_text(INNER.replace("inner", "item"))
    (folder / "truth.csv").write_text("frame,x_cm,y_cm,radius_cm\n0,1,1,1\n")
    (folder / "loads.csv").write_text("recording,load_g\nfilm.npz,100\n")
    (folder / "errors").mkdir()
    (folder / "errors" / "errors.csv").write_text("frame,x_cm,y_cm,radius_cm\n0,1,1,1\n")
    (folder / "tactile-objects.sqlite").write_text("")
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    shutil.copytree(made, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder: Path) -> dict[str, str]:
    return {
        str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest()
        for p in folder.rglob("*") if p.is_file()
    }  # fmt: skip


READ = "would overwrite what the command reads"
FILM = ["film.npz", "--frames", "2"]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["run", "p.yaml", *FILM, "-o", "p.yaml", "--format", "jsonl"], f"-o p.yaml: {READ}"),
        (["run", "circle-1", *FILM, "-o", "film.npz", "--format", "csv"], f"-o film.npz: {READ}"),
        (["run", "circle-1", "store.zarr", "-o", "store.zarr/zarr.json", "--format", "csv"],
         "-o store.zarr/zarr.json: would overwrite a part of what the command reads (store.zarr)"),
        (["run", "circle-1", *SIMULATED, "--with", "pad=pad.yaml", "-o", "pad.yaml", "--format",
          "csv"], "-o pad.yaml: would overwrite what --with names"),
        (["run", "circle-1", *FILM, "--decisions", "truth.csv", "-o", "truth.csv"],
         "-o truth.csv: would overwrite what --decisions names"),
        (["run", "circle-1", *FILM, "--workers", "2", "-o", "./film.npz", "--format", "jsonl"],
         f"-o ./film.npz: {READ} (film.npz)"),
        (["run", "circle-1", *FILM, "-o", "x.png", "--format", "csv", "--plot", "./x.png"],
         "--plot ./x.png: is the file of -o too"),
        (["graph", "p.yaml", "-o", "p.yaml", "--format", "dot"], f"-o p.yaml: {READ}"),
        (["schema", "p.yaml", "-o", "p.yaml"], f"-o p.yaml: {READ}"),
        (["compare", "circle-1", "circle-3", "store.zarr", "--json", "store.zarr/zarr.json"],
         "would overwrite a part of what the command reads (store.zarr)"),
        (["compare", "circle-1", "p.yaml --set footprint.level_v=0.02", *FILM, "--markdown",
          "p.md"], "--markdown p.md: would overwrite a file of pipeline 'circle-1'"),
        (["compare", "circle-1", "circle-3", "errors/errors.csv", "--csv", "errors"],
         f"--csv errors/errors.csv: {READ}"),
        (["compare", "circle-1", "circle-3", *FILM, "--csv", "o.json/", "--json", "o.json"],
         "--json o.json: is the file of --csv too"),
        (["audit", "circle-1", "store.zarr", "--json", "store.zarr/zarr.json"],
         "would overwrite a part of what the command reads (store.zarr)"),
        pytest.param(["tune", "circle-1", *FILM, "--truth", "t.json", "--json", "t.json"],
         "--json t.json: would overwrite what --truth names", marks=pytest.mark.slow),
        pytest.param(["tune", "circle-1", *FILM, "--held-out", "store.zarr", "--json",
          "store.zarr/zarr.json"],
         "would overwrite a part of what --held-out names (store.zarr)", marks=pytest.mark.slow),
        (["inspect", "film.npz", "--picture", "film.npz"], f"--picture film.npz: {READ}"),
        (["record", "store.zarr", "--append", "--source", "recording", "--with",
          "path=store.zarr"], "TARGET store.zarr: would overwrite what --with names"),
        (["calibrate", "film.npz=100", "-o", "film.npz"], f"-o film.npz: {READ}"),
        (["calibrate", "--loads", "loads.csv", "-o", "film.npz"], f"-o film.npz: {READ}"),
        (["calibrate", "--loads", "loads.csv", "-o", "loads.csv"],
         "-o loads.csv: would overwrite what --loads names"),
        (["learn-pad", "-e", "film.npz", "--pad", "pad.yaml", "-o", "pad.yaml"],
         "-o pad.yaml: would overwrite what --pad names"),
        (["learn-pad", "film.npz", "--places", "new.elements.csv", "-o", "new.yaml"],
         "-o new.elements.csv: would overwrite what --places names"),
        (["objects", "--export", "tactile-objects.sqlite"],
         "--export tactile-objects.sqlite: would overwrite what --database names"),
    ],
)  # fmt: skip
def test_no_command_writes_over_what_it_reads(folder: Path, words: list[str], told: str) -> None:
    if "new.elements.csv" in words:
        (folder / "new.elements.csv").write_text("recording,x_cm,y_cm\n")
    os.link("p.yaml", "p.md")
    os.link("truth.csv", "t.json")
    before = contents(folder)
    got = call(*words)
    assert (got.exit_code, got.stdout) == (2, "")
    assert told in got.stderr
    assert got.stderr.endswith("; name another file\n")
    assert contents(folder) == before


COMPARE = ["compare", "circle-1", "circle-3", *FILM]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ([*COMPARE, "--report", "x.txt"], "--report x.txt: its name must end in .html\n"),
        ([*COMPARE, "--markdown", "p.yaml"], "p.yaml: its name must end in .md, .markdown\n"),
        ([*COMPARE, "--json", "y.jsn"], "y.jsn: its name must end in .json; did you mean '.json'?"),
        ([*COMPARE, "--csv", "x.xlsx"], "--csv x.xlsx: must be a file whose name ends in .csv, or"),
        ([*COMPARE, "--csv", "p.yaml"], "--csv p.yaml: is a file; its name must end in .csv"),
        (["audit", "circle-1", *FILM, "--json", "p.yaml"], "--json p.yaml: its name must end in "),
        pytest.param(["tune", "circle-1", *FILM, "--json", "p.yaml"],
         "--json p.yaml: its name must end in .json\n", marks=pytest.mark.slow),
    ],
)  # fmt: skip
def test_a_file_of_another_kind_is_not_written_over(
    folder: Path, words: list[str], told: str
) -> None:
    before = contents(folder)
    got = call(*words)
    assert (got.exit_code, got.stdout) == (2, "")
    assert told in got.stderr
    assert contents(folder) == before


@pytest.mark.parametrize("linked", [os.symlink, os.link])
def test_links_are_seen_through(folder: Path, linked) -> None:
    linked(folder / "film.npz", folder / "link.jsonl")
    got = call("run", "circle-1", *FILM, "-o", "link.jsonl")
    assert f"-o link.jsonl: {READ} (film.npz)" in got.stderr
    linked(folder / "pad.yaml", folder / "table.csv")
    got = call("reproduce", "table-4.5", "--pad", "pad.yaml", "--csv", "table.csv")
    assert "--csv table.csv: would overwrite what --pad names (pad.yaml)" in got.stderr
    os.symlink("one.csv", "other.csv")  # neither is there yet
    with pytest.raises(UsageError, match=r"^--json other.csv: is the file of -o too"):
        check_targets([("-o", "one.csv"), ("--json", "other.csv")])


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("outer.yaml", "a file of pipeline 'outer'"),
        ("inner.yaml", "a file of pipeline 'outer'"),
        ("item.yaml", "a file of pipeline 'item'"),
        ("film.npz", "what setting 'path' of the source names"),
        ("noise.npz", "what setting 'noise_of' of node 'footprint' names"),
    ],
)
def test_a_pipeline_is_made_of_files_too(folder: Path, name: str, told: str) -> None:
    shutil.copy("film.npz", "noise.npz")
    (folder / "outer.yaml").write_text(OUTER)
    with pytest.raises(UsageError, match=rf"^-o {name}: would overwrite {told}; name another"):
        check_targets([("-o", name)], [load("outer.yaml")])


def test_a_folder_that_is_read_gets_no_file_that_would_be_one_of_its_frames(folder: Path) -> None:
    @click.command()
    @click.argument("recordings", nargs=-1)
    @click.option("-o", "output")
    def written(recordings, output):
        check_targets([("-o", output)])

    (folder / "errors" / "f1.csv").write_text("1,2")
    with pytest.raises(
        UsageError, match=r"^-o errors/f2\.CSV: would be a part of what the command"
    ):
        CliRunner().invoke(written, ["errors", "-o", "errors/f2.CSV"], catch_exceptions=False)
    for name in ("f1.png", "f2.png", "f3.png"):  # pictures, and outputs of earlier runs beside
        (folder / "errors" / name).write_text("")
    got = CliRunner().invoke(written, ["errors", "-o", "errors/f2.csv"], catch_exceptions=False)
    assert got.exit_code == 0


def test_what_may_be_named_is_let_through(folder: Path) -> None:
    @click.command()
    @click.argument("recordings", nargs=-1)
    @click.option("--in", "folder")
    @click.option("-o", "output")
    @click.option("--json", "data")
    def written(recordings, folder, output, data):
        check_targets([("-o", output), ("--json", data)])

    (folder / "old.csv").write_text("")
    for words in (
        ["film.npz", "-o", "old.csv", "--json", "new.json"],
        ["film.npz", "-o", "-", "--json", "-"],
        ["/dev/null", "-o", "/dev/null", "--json", "/dev/null"],
        ["store.zarr", "-o", "new.zarr"],
        ["errors", "-o", "errors/new.jsonl"],
        ["errors=old.csv=1", "-o", "new.csv"],
        ["no-such.csv", "-o", "no-such.csv"],
        [],
    ):
        got = CliRunner().invoke(written, words, catch_exceptions=False)
        assert got.exit_code == 0, words
    check_targets([("-o", "film.npz")])  # outside of a command nobody knows what is read
    with pytest.raises(UsageError, match="a part of what the command reads"):
        CliRunner().invoke(written, ["errors", "-o", "errors/errors.csv"], catch_exceptions=False)


@pytest.mark.parametrize(
    "words",
    [
        ["run", "circle-1", *FILM, "-o", "circle-1/o.csv"],
        ["run", "circle-1", *FILM, "--only", "boundary", "-o", "boundary/o.csv"],
        ["graph", "circle-1", "-o", "circle-1/g.svg"],
        ["compare", "circle-1", "circle-3", *FILM, "--json", "circle-3/c.json"],
        ["audit", "circle-3", *FILM, "--json", "circle-3/a.json"],
        ["run", "circle-1", *FILM, "--format", "jsonl", "--only", "boundary", "-o", "boundary/b"],
    ],
    ids=" ".join,
)
def test_a_name_is_no_folder_that_is_called_the_same(folder: Path, words: list[str]) -> None:
    (folder / words[-1]).parent.mkdir()
    for _ in range(2):  # the second time there is a file in it
        got = call(*words)
        assert got.exit_code == 0, got.output


def test_a_folder_that_a_setting_names_may_be_written_into(folder: Path) -> None:
    (folder / "outer.yaml").write_text(OUTER.replace("noise.npz", "store.zarr"))
    loaded = load("outer.yaml")
    check_targets([("-o", "store.zarr/zarr.json")], [loaded])
    with pytest.raises(UsageError, match="what setting 'noise_of' of node 'footprint' names"):
        check_targets([("-o", "store.zarr")], [loaded])


def test_the_name_of_a_pad_is_no_file_that_is_called_the_same(folder: Path) -> None:
    words = ["record", "glove-1", "--source", "simulate", "--frames", "2", "--pad", "glove-1"]
    for more in ([], ["--append"]):
        got = call(*words, *more)
        assert got.exit_code == 0, got.output
    assert (folder / "glove-1").exists()
