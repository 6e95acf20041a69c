"""Images and masks of nodes as stacks: what is missing is told apart, and nothing is left half."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_cli import call, install
from tactile_graph import Frame, Image, Mask
from tactile_graph.cli.output import array_files, node_images
from tactile_graph.errors import Skip

FORMS = ("out.h5", "out.zarr")


def pushed(*, frames: int = 5) -> Iterator[Frame]:
    """Frames whose first cell is their number; cell (1, 2) of frame 3 is broken."""
    for k in range(frames):
        values = np.full((3, 4), 0.5)
        values[0, 0] = k
        if k == 3:
            values[1, 2] = np.nan
        yield Frame.of(values, (1.5, 2.0), (0.25, -1.0), "volt", index=k, time_s=0.1 * k)


def on_but_for_two(image: Image) -> Mask:
    """Skip frame 1, fail in frame 2."""
    if image.values[0, 0] == 1:
        raise Skip("not now")
    if image.values[0, 0] == 2:
        raise ValueError("broken")
    return image.mask(image.values > 1.0)


def never(image: Image) -> Mask:
    raise Skip("never")


def moving(image: Image) -> Image:
    return Image(image.values.copy(), image.pitch_cm, (float(image.values[0, 0] > 1), 0.0))


FILE = """
pipeline: kept
source: {step: pushed}
nodes:
  lit: {step: lit, in: frame}
  dark: {step: never, in: frame}
  moving: {step: moving, in: frame}
  n: {step: total, in: frame}
outputs: [lit, n]
"""


def total(image: Image) -> float:
    return image.total


@pytest.fixture(autouse=True)
def _steps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    steps: dict[str, Any] = {"pushed": pushed, "lit": on_but_for_two, "never": never}
    install(monkeypatch, tmp_path, steps={**steps, "moving": moving, "total": total})
    Path("kept.yaml").write_text(FILE)


def stacks(name: str) -> Any:
    if name.endswith(".h5"):
        return pytest.importorskip("h5py").File(name)
    return pytest.importorskip("zarr").open_group(name, mode="r")


def need(name: str) -> None:
    pytest.importorskip("h5py" if name.endswith(".h5") else "zarr")


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMS)
def test_stacks_hold_cells_places_and_times_and_tell_what_is_missing(name: str) -> None:
    need(name)
    got = call("run", "kept.yaml", "--only", "frame", "--only", "lit", "--only", "dark", "-o", name)
    assert got.exit_code == 1, "a frame failed"
    kept = stacks(name)
    assert kept["index"][:].tolist() == [0, 1, 2, 3, 4]
    np.testing.assert_allclose(kept["time_s"][:], [0.0, 0.1, 0.2, 0.3, 0.4])
    assert kept["time_s"].attrs["unit"] == "s"
    frame, on = kept["frame/values"], kept["lit/values"]
    assert frame[:, 0, 0].tolist() == [0, 1, 2, 3, 4]
    assert np.argwhere(np.isnan(frame[:])).tolist() == [[3, 1, 2]]
    told = {k: np.asarray(v).tolist() for k, v in frame.attrs.items()}
    assert told == {
        "node": "frame", "step": "", "kind": "image", "pitch_cm": [1.5, 2.0],
        "origin_cm": [0.25, -1.0], "quantity": "volt", "unit": "V", "axes": "frame, row, column",
    }  # fmt: skip
    assert kept["lit/outcome"][:].tolist() == [0, 1, 2, 0, 0]
    assert on[:, 0, 0].tolist() == [0, 255, 255, 1, 1]
    assert on[:, 2, 2].tolist() == [0, 255, 255, 0, 0]
    assert on.attrs["kind"] == "mask"
    assert kept["dark/outcome"][:].tolist() == [1] * 5
    assert "values" not in kept["dark"]
    assert kept["dark/outcome"].attrs["meaning"] == "0 value, 1 skipped, 2 failed"
    made = json.loads(Path(f"{name}.meta.json").read_text())
    assert made["complete"] is True
    assert not [n for n in os.listdir() if n.endswith(".part")]


@pytest.mark.parametrize("name", FORMS)
@pytest.mark.parametrize("chunk", [1, 2, 3])
def test_chunks_fill_wherever_the_first_value_comes(
    name: str, chunk: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    need(name)
    monkeypatch.setattr(node_images, "MOST_A_CHUNK", chunk)
    monkeypatch.setattr(node_images, "SMALL_CHUNK", chunk)
    call("run", "kept.yaml", "--frames", "1:5", "--only", "lit", "-o", name)
    kept = stacks(name)
    assert kept["lit/outcome"][:].tolist() == [1, 2, 0, 0]
    assert kept["lit/values"][:, 0, 0].tolist() == [255, 255, 1, 1]
    assert kept["lit/values"].chunks == (chunk, 3, 4)


def test_what_is_no_image_is_refused_before_the_work_naming_what_is() -> None:
    got = call("run", "kept.yaml", "-o", "out.h5")
    assert got.exit_code == 2
    assert "'n' is no image and no mask" in got.stderr
    assert "choose with --only among dark, frame, lit, moving" in got.stderr
    assert not Path("out.h5").exists()


@pytest.mark.parametrize("name", FORMS)
def test_a_grid_that_moves_ends_the_run_and_keeps_what_was_before(name: str) -> None:
    need(name)
    got = call("run", "kept.yaml", "--only", "moving", "-o", name)
    assert got.exit_code == 2
    assert (
        f"{name}: 'moving' is in frame 2 another image of 3 x 4 cells of 1.5 x 2 cm from (1,"
        in (got.stderr)
    )
    assert stacks(name)["moving/values"].shape == (2, 3, 4)
    assert json.loads(Path(f"{name}.meta.json").read_text())["complete"] is False


@pytest.mark.parametrize("name", FORMS)
def test_a_store_is_replaced_by_the_next_whole_one_and_nothing_else_is(name: str) -> None:
    need(name)
    for frames in (5, 2):
        call("run", "kept.yaml", "--frames", frames, "--only", "frame", "-o", name)
    assert stacks(name)["index"].shape == (2,)
    Path("folder.zarr").mkdir()
    got = call("run", "kept.yaml", "--only", "frame", "-o", "folder.zarr")
    assert got.exit_code == 2
    assert "folder.zarr: is a folder and no store of images; name another" in got.stderr
    assert [n for n in os.listdir() if "part" in n] == []


@pytest.mark.parametrize("name", FORMS)
def test_a_disc_that_is_full_leaves_nothing(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    need(name)

    def full(self: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(array_files.Growing, "flush", full)
    got = call("run", "kept.yaml", "--only", "frame", "-o", name)
    assert got.exit_code == 2
    assert f"error: {name}: cannot be written: No space left on device" in got.stderr
    assert f"wrote {name}" not in got.stderr
    assert [n for n in os.listdir() if n.endswith(("part", name))] == []


@pytest.mark.skipif(sys.platform == "win32", reason="has no limit of a file's size")
def test_hdf5_that_may_grow_no_more_is_told_and_leaves_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its library crashes as it closes a file of which a write failed."""
    import resource

    need("out.h5")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2048, before[1]))
    try:
        got = call("run", "kept.yaml", "--only", "frame", "-o", "out.h5")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert got.exit_code == 2
    assert "error: out.h5: cannot be written: File too large; nothing of it is kept" in got.stderr
    assert [n for n in os.listdir() if n.endswith(("part", "h5", "json"))] == []


@pytest.mark.parametrize(("name", "library"), [("out.h5", "h5py"), ("out.zarr", "zarr")])
def test_without_its_library_it_says_what_to_install(
    name: str, library: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    got = call("run", "kept.yaml", "--only", "frame", "-o", name)
    assert got.exit_code == 2
    assert f'need {library}: pip install "tactile-graph[' in got.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--format", "hdf5"), "-o -: images cannot go to stdout; give a name"),
        (("-o", "a.h5", "--long"), "--long: HDF5: holds images; give -o FILE.csv"),
        (("-o", "a.zarr", "--full"), "--full: a Zarr store holds images; give -o FILE.jsonl"),
        (("-o", "a.zar"), "its name must end in .jsonl, .ndjson, .csv, .parquet, .dataset, .h5, "),
        (("-o", "a.zar"), "or give --format; did you mean '.zarr'?"),
    ],
)
def test_what_has_no_place_in_stacks_is_refused(words: tuple[str, ...], said: str) -> None:
    got = call("run", "kept.yaml", "--only", "frame", *words)
    assert got.exit_code == 2
    assert said in got.stderr
    assert not [n for n in os.listdir() if n.startswith("a.")]
