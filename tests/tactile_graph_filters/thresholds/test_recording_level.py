"""One level for all frames, above the noise that a whole recording shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call
from tactile_graph import load
from tactile_graph.errors import DataError, RuleError, UsageError
from tactile_graph.wires import Image
from tactile_graph_filters.thresholds.noise_level import OF_PEAK, noise_level
from tactile_graph_filters.thresholds.recording_level import recording_level
from tactile_graph_filters.thresholds.threshold import Threshold

NOISE, BASE, LOAD = 2.0, 100.0, 900.0


@pytest.fixture(scope="module")
def frames() -> np.ndarray:
    """Frames of a pad at rest near 100; something lies on it in every second half of 40."""
    rng = np.random.default_rng(4)
    values = rng.normal(BASE, NOISE, (40, 12, 12))
    values[20:, 3:7, 4:8] += LOAD
    return values


@pytest.fixture(scope="module")
def recording(frames: np.ndarray, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("recording") / "r.npy"
    np.save(path, frames)
    return path


def test_the_level_is_that_of_a_frame_with_the_recordings_noise_and_peak(
    frames: np.ndarray, recording: Path
) -> None:
    found = recording_level(recording)
    loaded = [noise_level(Image(f, quantity="raw")) for f in frames[20:]]
    assert found.quantity == "raw"
    assert found.level == pytest.approx(np.median(loaded), rel=0.03)
    assert found.told.endswith(f"r.npy, 40 frames{OF_PEAK}")


@pytest.mark.parametrize("side", [4, 6, 8])
def test_noise_that_is_cut_off_is_told_by_several_frames_of_a_small_pad(
    side: int, tmp_path: Path
) -> None:
    values = np.maximum(np.rint(np.random.default_rng(side).normal(0.0, 3.0, (80, side, side))), 0)
    values[40:, 1:3, 1:3] += 200.0
    np.save(tmp_path / "r.npy", values)
    assert recording_level(tmp_path / "r.npy").level == pytest.approx(30.0, rel=0.15)
    np.save(tmp_path / "r.npy", np.where(values > 100.0, values, 0.0))  # without noise: of the peak
    assert recording_level(tmp_path / "r.npy").level == pytest.approx(0.03 * values.max())


@pytest.mark.parametrize(("steps", "turn"), [(1.0, 0.41), (5.0, 0.1), (5.0, 0.41), (5.0, 3.0)])
def test_hum_that_is_cut_off_lies_below_the_level_of_an_empty_recording(
    steps: float, turn: float, tmp_path: Path
) -> None:
    rng = np.random.default_rng(3)
    turns = rng.uniform(0.0, 2.0 * np.pi, (40, 1, 1)) + turn * np.arange(16)[:, None]
    values = steps * np.sin(turns) + rng.normal(0.0, 0.4 * steps, (40, 16, 16))
    values = np.maximum(np.rint(values), 0.0)
    np.save(tmp_path / "r.npy", values)
    found = recording_level(tmp_path / "r.npy")
    assert values.max() < found.level < 15.0 * steps
    assert found.told.startswith("the noise of ")


def test_a_recording_that_shows_no_noise_says_so(tmp_path: Path) -> None:
    values = np.zeros((3, 16, 16))
    values[:, 4:8, 4:8] = 200.0
    np.save(tmp_path / "r.npy", values)
    assert recording_level(tmp_path / "r.npy").told.startswith("the zero, as no noise shows, of ")


@pytest.mark.slow
def test_every_frame_is_parted_by_the_same_level(frames: np.ndarray, recording: Path) -> None:
    """Frame by frame an empty pad has a lower level than a loaded one, and a level of its own."""
    one, each = Threshold(level="auto", noise_of=recording), Threshold(level="auto")
    masks = [one(Image(f.copy(), quantity="raw")) for f in frames]
    own = {each(Image(f.copy(), quantity="raw")).level for f in frames}  # type: ignore[attr-defined]
    assert {m.level for m in masks} == {recording_level(recording).level}  # type: ignore[attr-defined]
    assert len(own) == 40
    assert [m.count for m in masks] == [0] * 20 + [16] * 20
    told = masks[-1].assumed  # type: ignore[attr-defined]
    assert "on, which is above the noise of" in told
    assert told.endswith(f"r.npy, 40 frames{OF_PEAK}")


def test_a_mapping_says_how_the_recording_is_read(recording: Path) -> None:
    told = {"path": str(recording), "skip": 20, "quantity": "gram"}
    found = recording_level(told)
    assert found.quantity == "gram"
    assert found.told.endswith(f"20 frames{OF_PEAK}")


@pytest.mark.parametrize(
    ("noise_of", "error", "message"),
    [
        (Path("gone.csv"), DataError, "gone.csv: there is no such file"),
        ({"path": "a.csv", "rwos": 3}, UsageError, "noise_of, rwos: unknown setting 'rwos'; did"),
        ({"path": "a.csv", "rows": 0}, UsageError, "noise_of, rows: must be > 0"),
    ],
)  # fmt: skip
def test_what_is_no_recording_is_told(
    noise_of: Path | dict[str, object], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        Threshold(level="auto", noise_of=noise_of)


@pytest.mark.slow
def test_it_belongs_to_auto_and_to_images_of_its_unit(recording: Path) -> None:
    with pytest.raises(ValueError, match="noise_of belongs to level: auto, got level 3"):
        Threshold(level=3, noise_of=recording)
    counts = Image(np.ones((2, 2)), quantity="counts")
    with pytest.raises(RuleError, match="noise_of is for images in raw, got counts"):
        Threshold(level="auto", noise_of=recording)(counts)
    volts = Image(np.ones((2, 2)), quantity="volt")
    both = Threshold(level_v=0.5, level="auto", noise_of=recording)
    assert both(volts).count == 4


def test_a_pipeline_takes_it_from_outside_and_a_run_says_so(recording: Path) -> None:
    got = call("run", "contacts", recording, "--set", f"footprint.noise_of={recording}")
    assert got.exit_code == 0
    assert "r.npy, 40 frames" in got.stdout
    source = ("recording", {"path": str(recording)})
    pipeline = load("contacts").with_settings({"footprint.noise_of": str(recording)}, source)
    assert pipeline.nodes["footprint"].settings["noise_of"] == recording


def test_presses_and_drift_of_a_pad_of_few_cells_are_no_noise(tmp_path: Path) -> None:
    values = np.rint(np.random.default_rng(1).normal(20.0, 0.3, (110, 2, 2)))
    values[10:60] += 200.0  # most of the frames that fit into one
    np.save(tmp_path / "r.npy", values)
    assert recording_level(tmp_path / "r.npy").level < 40.0
    np.save(tmp_path / "r.npy", np.rint(np.linspace(0.0, 30.0, 100))[:, None, None].repeat(16, 2))
    assert recording_level(tmp_path / "r.npy").level < 20.0
