"""How the settings that a refusal asks for are typed on a command line."""

from __future__ import annotations

import shlex
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from helpers_dialects import OBLONG, SQUARE, flat
from helpers_recordings import frames_of, write
from tactile_graph.cli import cli
from tactile_graph.errors import DataError
from tactile_graph_sources.readers.words.told import as_typed


@pytest.mark.parametrize(
    ("what", "typed"),
    [
        ("nothing says its shape; give rows and columns", "--with rows=… --with columns=…"),
        (
            "one matrix or a frame a line (of 6 x 10 cells, as they lie); give the settings rows "
            "and columns",
            "--with rows=6 --with columns=10",
        ),
        ("columns are cells, such as cells=2-65; say which cells", "--with cells=2-65"),
        ("could be any of p, q; give value_column", "--with value_column=…"),
        ("'x' is no number; say which columns are cells, such as cells=2-65", "--with cells=2-65"),
        ("nothing says which; give cells, such as cells='2-' for all", "--with cells=2-"),
        ("or of one grid (then give rows=2, columns=64); name one with sensor", "--with sensor=…"),
        (
            "it holds 3; give cells, rows and columns",
            "--with rows=… --with columns=… --with cells=…",
        ),
        (
            "the settings say rows=7, columns=9 of its shape; give rows and columns whose product "
            "is that number, or say which columns are cells, such as cells=2-65",
            "--with rows=… --with columns=… --with cells=2-65",
        ),
    ],
)
def test_what_is_asked_for_is_put_behind_with(what: str, typed: str) -> None:
    assert as_typed(what) == f" (as typed: {typed})"


def test_where_no_setting_helps_nothing_is_said() -> None:
    assert not as_typed("the file is cut off: it holds less than its header says")
    assert not as_typed("its rows and columns are damaged")
    assert not as_typed("say row and column of each cell; name the cells on one line")


def test_a_sensor_is_named_as_a_shell_takes_it() -> None:
    assert as_typed("name one with sensor", ["left hand"]).endswith("'sensor=left hand')")


def test_what_a_refusal_says_works_when_it_is_pasted(tmp_path: Path) -> None:
    path = write(tmp_path, flat(OBLONG))
    with pytest.raises(DataError) as raised:
        frames_of(path)
    typed = raised.value.what.partition("(as typed: ")[2].removesuffix(")")
    target = tmp_path / "out.csv"
    found = CliRunner().invoke(cli, ["convert", *shlex.split(typed), str(path), str(target)])
    assert found.exit_code == 0, found.output
    frames, _ = frames_of(target)
    assert np.allclose([f.image.values for f in frames], OBLONG)


@pytest.mark.slow  # pipelines are tried
def test_a_name_that_yaml_reads_otherwise_is_a_level_s_recording(tmp_path: Path) -> None:
    path = tmp_path / "2024-03-01"
    path.write_text(flat(SQUARE), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patched:
        patched.chdir(tmp_path)
        out = CliRunner().invoke(cli, ["inspect", path.name]).stdout
    assert 'noise_of={path: "2024-03-01"}' in out
