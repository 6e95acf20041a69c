"""Images of nodes that a run wrote are a recording again, one node of them."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from helpers_recordings import frames_of
from tactile_graph import load
from tactile_graph.errors import DataError

FORMS = {"h5": "h5py", "zarr": "zarr"}


@pytest.fixture(params=FORMS)
def kept(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    pytest.importorskip(FORMS[request.param], reason="the extra is not installed")
    monkeypatch.chdir(tmp_path)
    path = Path(f"kept.{request.param}")
    done = call("run", "circle-3", "--only", "frame", "--only", "eroded", "-o", str(path))
    assert done.exit_code == 0, done.output
    return path


@pytest.mark.slow
def test_each_node_lies_where_it_lay(kept: Path) -> None:
    truth = list(load("circle-3").stream(only=["eroded"]))
    for node in ("frame", "eroded"):
        frames, _ = frames_of(kept, sensor=node)
        assert len(frames) == len(truth)
        for frame, result in zip(frames, truth, strict=True):
            image = result.frame.image if node == "frame" else result["eroded"]
            np.testing.assert_array_equal(frame.image.values, image.values)
            assert frame.image.pitch_cm == image.pitch_cm
            assert frame.image.origin_cm == image.origin_cm
            assert frame.image.quantity == ("volt" if node == "frame" else "binary")
            assert frame.time_s == result.frame.time_s


@pytest.mark.slow
def test_of_several_nodes_one_is_to_be_named_and_inspect_shows_each(kept: Path) -> None:
    with pytest.raises(DataError, match="images of several nodes: eroded, frame; name one with se"):
        frames_of(kept)
    with pytest.raises(DataError, match=r"no image of a node 'erode', .*did you mean 'eroded'"):
        frames_of(kept, sensor="erode")
    found = [json.loads(line) for line in call("inspect", str(kept), "--json").stdout.splitlines()]
    assert [one["sensor"] for one in found] == ["eroded", "frame"]
    assert [one["sensors"][0]["quantity"] for one in found] == ["binary", "volt"]
    done = call("run", "contacts", str(kept), "--with", "sensor=frame")
    assert done.exit_code == 0, done.output


@pytest.mark.slow
def test_frames_without_a_value_are_left_out_and_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("h5py", reason="the extra is not installed")
    monkeypatch.chdir(tmp_path)
    film = np.zeros((4, 8, 8))
    film[[0, 2, 3], 3:5, 3:6] = 1.0
    np.savez("film.npz", values=film, quantity=np.array("volt"))
    Path("guarded.yaml").write_text(
        "pipeline: guarded\nabout: only where there is load\nnodes:\n"
        "  footprint: {step: threshold, in: frame, with: {level_v: 0.5}}\n"
        "  grown: {step: dilate, in: footprint, when: footprint.count > 0}\noutputs: [grown]\n"
    )
    done = call("run", "guarded.yaml", "film.npz", "--only", "grown", "-o", "one.h5")
    assert done.exit_code == 0, done.output
    frames, report = frames_of(Path("one.h5"))  # one node: none is to be named
    assert len(frames) == 3
    assert [f.gap for f in frames] == [False, True, False]
    assert report.counts["frames in which 'grown' has no value"] == 1


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS)
def test_nodes_of_an_embedded_pipeline_go_by_their_own_names(
    form: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip(FORMS[form], reason="the extra is not installed")
    monkeypatch.chdir(tmp_path)
    Path("outer.yaml").write_text(
        "pipeline: outer\nabout: x\nsource: {step: sample, with: {name: discs}}\nnodes:\n"
        "  disc: {use: circle-3, in: frame}\noutputs: [disc]\n"
    )
    only = ["--only", "disc/eroded", "--only", "disc/footprint"]
    done = call("run", "outer.yaml", *only, "-o", f"kept.{form}")
    assert done.exit_code == 0, done.output
    path = Path(f"kept.{form}")
    assert len(frames_of(path, sensor="disc/eroded")[0]) == 6
    with pytest.raises(DataError, match="several nodes: disc/eroded, disc/footprint"):
        frames_of(path)


@pytest.mark.slow
def test_a_damaged_one_says_so(kept: Path) -> None:
    if kept.is_dir():
        shutil.rmtree(kept / "frame" / "outcome")
        with pytest.raises(DataError, match="node 'frame' cannot be read"):
            frames_of(kept, sensor="frame")
        (kept / "zarr.json").write_text("{")
        with pytest.raises(DataError, match="Zarr store"):
            frames_of(kept, sensor="frame")
    else:
        kept.write_bytes(kept.read_bytes()[:3000])
        with pytest.raises(DataError, match="HDF5 file cannot be read"):
            frames_of(kept, sensor="frame")


@pytest.mark.parametrize(
    ("shape", "n", "told"),
    [
        ((2, 1900, 1900), 2, "each image is in more than 1,000 pieces"),
        ((2, 10**5, 10**5), 2, "images of 10,000,000,000 cells; allowed are 4,000,000"),
        (
            (10**10, 2, 2),
            10**10,
            "outcomes and times unpack to 90,000 MB, of which 0.0 are written",
        ),
    ],
)
def test_images_that_were_never_written_are_refused_before_they_are_read(
    tmp_path: Path, shape: tuple[int, ...], n: int, told: str
) -> None:
    h5py = pytest.importorskip("h5py", reason="the extra is not installed")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["format"] = "tactile-graph node images"
        values = file.create_dataset("a/values", shape, "f8", chunks=(1, 2, 2))
        about = {"kind": "image", "quantity": "volt", "pitch_cm": (1, 1), "origin_cm": (0, 0)}
        values.attrs.update(about)
        file.create_dataset("a/outcome", (n,), "u1", chunks=(1,))
        file.create_dataset("time_s", (n,), "f8", chunks=(1,))
    with pytest.raises(DataError, match=told):
        frames_of(tmp_path / "a.h5")
