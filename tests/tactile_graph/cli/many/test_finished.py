"""``run --resume`` over an output that is there: done already if it is the same, else refused."""

from __future__ import annotations

from pathlib import Path
from subprocess import CompletedProcess

import pytest

from helpers_many import ran_here
from tactile_graph.cli.many import made_of

pytestmark = pytest.mark.slow
ASKED = {
    ".csv": (), ".jsonl": (), ".parquet": (), ".zarr": ("--only", "footprint"),
    ".h5": ("--only", "footprint"), "/": (),
}  # fmt: skip
NEEDS = {".parquet": "pyarrow", ".zarr": "zarr", ".h5": "h5py", "/": "pyarrow"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return where two recordings lie."""
    path = tmp_path_factory.mktemp("finished")
    for name in ("a.npz", "b.npz"):
        words = ("convert", name, "--source", "simulate", "--with", "scene=discs", "--frames", "5")
        got = ran_here(path, *words, "--seed", str(ord(name[0])))
        assert got.returncode == 0, got.stderr
    return path


def run(folder: Path, name: str, *words: str, of: str = "a.npz") -> CompletedProcess[str]:
    """Run over a recording into an output."""
    return ran_here(folder, "run", "circle-1", of, "-o", name, *words)


def content(folder: Path, name: str) -> dict[str, bytes]:
    """Return all that stands in an output, by its path."""
    place = folder / name
    files = sorted(place.rglob("*")) if place.is_dir() else [place]
    return {str(p.relative_to(folder)): p.read_bytes() for p in files if p.is_file()}


@pytest.mark.parametrize("ending", ASKED)
@pytest.mark.parametrize("more", [(), ("--workers", "2")], ids=["alone", "workers"])
def test_what_other_content_made_is_never_written_over(
    folder: Path, monkeypatch: pytest.MonkeyPatch, ending: str, more: tuple[str, ...]
) -> None:
    if ending in NEEDS:
        pytest.importorskip(NEEDS[ending], reason="its extra is not installed")
    name, words = f"{'many' if more else 'one'}{ending}", (*ASKED[ending], *more, "--resume")
    assert run(folder, name, *words).returncode == 0
    before = content(folder, name)
    assert "is done already" in run(folder, name, *words).stderr
    if ending != "/":  # a data set has other recordings too, and its own word for other pipelines
        got = run(folder, name, *words, "--set", "footprint.level_v=0.02")
        assert "is made of other content: the pipeline or its settings; name" in got.stderr
        got = run(folder, name, *words, of="b.npz")
        assert "the pipeline or its settings, a.npz, b.npz; name another file" in got.stderr
    monkeypatch.setattr(made_of, "code_digest", lambda _: "other")
    got = run(folder, name, *words)
    assert got.returncode == 2
    assert "other content: the code of the project or of a plugin; name" in got.stderr
    assert content(folder, name) == before


def test_a_data_set_takes_another_recording_in(folder: Path) -> None:
    pytest.importorskip("pyarrow", reason="the 'parquet' extra is not installed")
    for of in ("a.npz", "b.npz"):
        assert run(folder, "set/", "--resume", of=of).returncode == 0
    assert len([*(folder / "set").glob("recording=*")]) == 2


@pytest.mark.parametrize("note", [True, False])
def test_what_no_resumed_run_made_is_not_written_over(folder: Path, note: bool) -> None:
    assert run(folder, "plain.csv").returncode == 0
    if not note:
        (folder / "plain.csv.meta.json").unlink()
    before = content(folder, "plain.csv")
    got = run(folder, "plain.csv", "--resume")
    assert got.returncode == 2
    told = "plain.csv is there, and plain.csv.meta.json does not say what it is made of"
    assert f"{told}; name another file, or write it anew without --resume" in got.stderr
    assert content(folder, "plain.csv") == before


def test_what_was_changed_since_is_not_written_over(folder: Path) -> None:
    assert run(folder, "edited.csv", "--resume").returncode == 0
    with (folder / "edited.csv").open("a") as file:
        file.write("mine\n")
    got = run(folder, "edited.csv", "--resume")
    assert got.returncode == 2
    assert "edited.csv was changed after it was written; name another file" in got.stderr
    assert (folder / "edited.csv").read_text().endswith("mine\n")


def test_an_empty_file_is_written_over(folder: Path) -> None:
    (folder / "empty.csv").touch()
    assert run(folder, "empty.csv", "--resume").returncode == 0
    assert (folder / "empty.csv").stat().st_size


def test_a_data_set_loses_no_frames_of_a_recording_that_it_holds(folder: Path) -> None:
    assert run(folder, "ds/", "--frames", "8", "--resume").returncode == 0
    before = content(folder, "ds")
    again = run(folder, "ds/", "--frames", "3", "--resume")
    assert (again.returncode, content(folder, "ds")) == (2, before)
    assert "is made of other content: what is asked of it" in again.stderr
    assert "is done already" in run(folder, "ds/", "--frames", "8", "--resume").stderr
    assert run(folder, "ds/", "--frames", "3", "--resume", of="b.npz").returncode == 0
