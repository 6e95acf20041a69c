"""Recordings beside the pads that a pipeline is told by a file: their pitch, and another grid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from tactile_graph.cli import cli


@pytest.fixture
def there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return a folder with a recording of 12 x 9 cells that tells no pitch, and pads."""
    y, x = np.mgrid[:12, :9]
    grams = np.where((x - 4) ** 2 + (y - 5) ** 2 < 10, 60.0, 0.0)
    np.save(tmp_path / "rec.npy", np.stack([grams, grams]))
    for name, rows, columns in (("pad", 12, 9), ("turned", 9, 12)):
        (tmp_path / f"{name}.yaml").write_text(
            f"about: mine\ngeometry: {{rows: {rows}, columns: {columns},"
            " element_cm: 0.4, gap_cm: 0.1}\n"
        )
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*words: str) -> Result:
    return CliRunner().invoke(cli, [*words, "--with", "quantity=gram"])


def words_of(result: Result) -> str:
    return " ".join((result.output + result.stderr).split())


@pytest.mark.slow
def test_a_recording_without_a_pitch_has_that_of_the_pad_file(there: Path) -> None:
    result = run("run", "locate-circle", "rec.npy", "--set", "circle.pad=pad.yaml")
    assert result.exit_code == 0, result.output
    assert "12 x 9 cells of 0.5 cm" in words_of(result)
    assert "pitch is assumed to be that of pad pad.yaml, 0.5 cm" in words_of(result)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pad", "told", "words"),
    [
        ("turned.yaml", (), "12 x 9, are not those of pad turned.yaml, 9 x 12 and 0.5 cm apart"),
        (
            "pad.yaml", ("--with", "pitch_cm=0.8"),
            "12 x 9 and 0.8 cm apart, are not those of pad pad.yaml, 12 x 9 and 0.5 cm apart",
        ),
    ],
)  # fmt: skip
def test_a_pad_of_another_grid_is_told(
    there: Path, pad: str, told: tuple[str, ...], words: str
) -> None:
    result = run("run", "locate-circle", "rec.npy", "--set", f"circle.pad={pad}", *told)
    assert result.exit_code == 0, result.output
    assert words in words_of(result)


@pytest.mark.slow
def test_the_pad_of_a_pipeline_by_name_says_nothing_of_a_recording(there: Path) -> None:
    result = run("run", "locate-circle", "rec.npy", "--set", "circle.pad=thesis")
    assert result.exit_code == 0, result.output
    assert "pitch is assumed to be 1 cm" in words_of(result)
    assert "are not those of" not in words_of(result)


@pytest.mark.slow
def test_variants_that_are_compared_see_the_pitch_of_a_pad_that_one_is_told(there: Path) -> None:
    result = run("compare", "circle-2", "locate-circle --set circle.pad=pad.yaml", "rec.npy")
    assert result.exit_code == 0, result.output
    assert "recording (path: rec.npy, quantity: gram, pad: [pad.yaml])" in words_of(result)


@pytest.mark.slow
def test_a_pad_of_another_pitch_is_not_learned_from(there: Path) -> None:
    noise = 20.0 + np.random.default_rng(1).standard_normal((20, 12, 9))
    np.save(there / "empty.npy", noise)
    result = run(
        "learn-pad", "--empty", "empty.npy", "--with", "pitch_cm=0.8", "--pad", "pad.yaml",
        "-o", "new.yaml",
    )  # fmt: skip
    assert result.exit_code == 2
    assert "elements are 0.5 cm apart" in words_of(result)
    assert not (there / "new.yaml").exists()
