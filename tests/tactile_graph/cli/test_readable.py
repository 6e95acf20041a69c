"""Where stdout has not every character, the whole of an output is there, and can be read."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from helpers_cli import install
from tactile_graph.cli import cli
from tactile_graph.cli.readable import open_readable, readable

ENCODINGS = ("ascii", "latin-1", "cp1252", "cp437")


def call_in(encoding: str, *args: str) -> Result:
    """Run a command line whose stdout and stderr are of an encoding."""
    return CliRunner(charset=encoding, env={"COLUMNS": "160"}).invoke(cli, args)


def test_what_an_encoding_has_not_stands_as_the_nearest_in_ascii() -> None:
    told = "5 µs ±0.1 cm² × 2 → ≥ 3° … é ⁻¹ ─│┏█ Ω ☃"
    assert readable(told, "ascii") == "5 us +-0.1 cm2 x 2 -> >= 3deg ... e -1 -|+# Ohm ?"
    assert readable(told, "cp1252") == "5 µs ±0.1 cm² × 2 -> >= 3° … é -¹ -|+# Ohm ?"
    assert readable(told, "utf-8") == readable(told, None) == told


def test_a_stream_of_somebodys_own_choice_is_left() -> None:
    chosen = io.TextIOWrapper(io.BytesIO(), "ascii", "backslashreplace")
    strict = io.TextIOWrapper(io.BytesIO(), "ascii")
    every = io.TextIOWrapper(io.BytesIO(), "utf-8")
    for stream in (chosen, strict, every):
        open_readable(stream)
        stream.write("é ☃")
        stream.flush()
    assert chosen.buffer.getvalue() == b"\\xe9 \\u2603"
    assert strict.buffer.getvalue() == b"e ?"
    assert every.errors == "strict"


@pytest.mark.usefixtures("hand_made")
@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize(
    "args",
    [
        ("run", "discs"), ("explain", "discs"), ("check", "discs"), ("steps",),
        ("steps", "pressed"), ("pipelines",), ("graph", "discs"),
    ],
)  # fmt: skip
def test_commands_end_as_elsewhere_with_every_line(encoding: str, args: tuple[str, ...]) -> None:
    meant, got = call_in("utf-8", *args), call_in(encoding, *args)
    assert (got.exit_code, meant.exit_code) == (0, 0), got.output
    assert len(got.stdout.splitlines()) == len(meant.stdout.splitlines())
    assert "UnicodeEncodeError" not in got.output


@pytest.mark.usefixtures("hand_made")
def test_rows_of_a_table_stay_as_wide_as_its_head() -> None:
    lines = call_in("ascii", "steps", "pressed").stdout.splitlines()
    table = [line.rstrip() for line in lines if "|" in line]
    assert any(">" in line for line in table)
    assert len({line.rindex("|") for line in table[:2]}) == 1


@pytest.mark.usefixtures("hand_made")
def test_an_error_can_be_read_too() -> None:
    told = call_in("ascii", "run", "größe").stderr
    assert "grosse" in told


def test_text_for_programs_is_utf_8_to_the_letter(
    hand_made: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = hand_made / "greek.yaml"
    file.write_text("about: 5 µs → 7 ☃\n", "utf-8")
    install(monkeypatch, hand_made, pipelines={"greek": file})
    assert call_in("cp1252", "pipelines", "greek").stdout_bytes == file.read_bytes()
    lines = call_in("cp1252", "run", "discs", "-o", "-").stdout_bytes.decode("utf-8")
    assert [json.loads(line)["frame"] for line in lines.splitlines()] == [0, 1, 2, 3]


@pytest.mark.slow
def test_a_process_writes_all_of_its_table(tmp_path: Path) -> None:
    pytest.importorskip("tactile_graph_sources")
    env = {**os.environ, "PYTHONIOENCODING": "cp1252", "TACTILE_GRAPH_KERNELS": "plain"}
    command = [sys.executable, "-m", "tactile_graph", "run", "contacts", "--frames", "3"]
    got = subprocess.run(command, env=env, capture_output=True, cwd=tmp_path)
    assert got.returncode == 0, got.stderr
    assert [line for line in got.stdout.decode("cp1252").splitlines() if line.startswith("    2 ")]
