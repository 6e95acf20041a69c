"""``prepare`` compiles what pipelines need and says of each what it did."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_cli import DISCS, install
from tactile_graph.api.pipeline import Pipeline
from tactile_graph.cli.ahead import opened
from tactile_graph.cli.app import cli
from tactile_graph.cli.commands.prepare import FRAMES, prepared
from tactile_graph.wires import Frame, Mask

PLAIN = """\
pipeline: dim
source: {step: simulate, with: {scene: disc-1, frames: 20}}
nodes:
  touched: {step: threshold, in: frame, with: {level_v: 0.5}}
outputs: [touched]
"""


def written(folder: Path, text: str) -> str:
    path = folder / "dim.yaml"
    path.write_text(text)
    return str(path)


@pytest.mark.usefixtures("hand_made")
def test_frames_of_a_pipelines_own_source_are_run() -> None:
    assert prepared("discs").startswith("discs: prepared by 4 frames in ")


def test_the_first_and_the_most_loaded_frames_of_a_recording_are_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sums = np.r_[np.ones(FRAMES), np.arange(40) % 20]
    values = sums[:, None, None] * np.ones((1, 4, 4))
    np.savez(tmp_path / "film.npz", values=values, pitch_cm=1.0, quantity="volt")
    run: list[float] = []
    stream = Pipeline.stream

    def noted(self: Pipeline, frames: list[Frame]) -> Any:
        run.extend(float(frame.image.values[0, 0]) for frame in frames)
        return stream(self, frames)

    monkeypatch.setattr(Pipeline, "stream", noted)
    path = written(tmp_path, PLAIN)
    said = prepared(path, str(tmp_path / "film.npz"))
    assert said.startswith(f"{path}: prepared by {2 * FRAMES} frames in ")
    assert run == [1.0] * FRAMES + [15.0, 16.0, 17.0, 18.0, 19.0] * 2


def test_a_recording_is_for_pipelines_that_are_named(tmp_path: Path) -> None:
    got = CliRunner().invoke(cli, ["prepare", "--recording", str(tmp_path / "film.npz")])
    assert got.exit_code == 2
    assert "name the pipelines" in got.stderr
    got = CliRunner().invoke(cli, ["prepare", "circle-3", "--recording", "film.npz", "--jobs", "1"])
    assert got.exit_code == 2
    assert "film.npz: there is no such file" in got.stderr


@pytest.mark.usefixtures("hand_made")
def test_a_pipeline_without_a_source_is_left_out() -> None:
    assert prepared("loads") == "loads: not prepared, declares no source"


def test_a_pipeline_that_writes_is_left_out(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = []

    def note(mask: Mask) -> None:
        seen.append(mask)

    text = DISCS + "  noted: {step: note, in: footprint}\n"
    noting = hand_made / "noting.yaml"
    noting.write_text(text.replace("outputs: [circle]\n", "") + "outputs: [noted]\n")
    install(monkeypatch, hand_made, steps={"note": note})
    assert prepared(str(noting)) == f"{noting}: not prepared, a step of it writes"
    assert not seen


def test_a_device_is_not_opened(tmp_path: Path) -> None:
    port = "{step: serial, with: {port: /dev/no-such-port, preset: itas}}"
    text = PLAIN.replace("{step: simulate, with: {scene: disc-1, frames: 20}}", port)
    path = written(tmp_path, text)
    assert prepared(path) == f"{path}: not prepared, its source reads a device"
    assert not list(opened([path], [], []))


def test_a_pipeline_that_fails_is_told(hand_made: Path) -> None:
    wrong = hand_made / "wrong.yaml"
    wrong.write_text(DISCS.replace("pressed", "presed"))
    assert "did you mean 'pressed'" in prepared(str(wrong))


@pytest.mark.slow
def test_the_command_prepares_in_other_processes(tmp_path: Path) -> None:
    path = written(tmp_path, PLAIN)
    done = CliRunner().invoke(cli, ["prepare", path, "--jobs", "2"])
    assert (done.exit_code, f"prepared by {FRAMES} frames" in done.output) == (0, True)


def test_a_wrong_file_is_told_before_anything_is_compiled(tmp_path: Path) -> None:
    path = written(tmp_path, PLAIN.replace("threshold", "treshold"))
    done = CliRunner().invoke(cli, ["prepare", path])
    assert done.exit_code == 2
    assert "threshold" in done.output
