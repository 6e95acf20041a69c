"""What is offered to be pasted is taken by a shell for what was meant."""

from __future__ import annotations

import os
import subprocess

import pytest

from tactile_graph.cli.pasted import pasted, pasted_path


@pytest.mark.parametrize(
    "word",
    ["a", "my mat", "it's", "$HOME", "a\nb'\\\t", "\udcff7", "\x1b[31m", "\u202eä", "ä", "*"],
)
def test_a_shell_takes_it_for_one_word_that_is_all_seen(word: str) -> None:
    told = pasted(word)
    assert told.isprintable()
    raw = subprocess.run(
        ["bash", "-c", f"printf %s {told}"], capture_output=True, check=True
    ).stdout
    assert os.fsdecode(raw) == word


def test_a_path_is_no_option() -> None:
    assert pasted_path("-x.npy") == "./-x.npy"
    assert pasted_path("x.npy") == "x.npy"
    assert pasted("-x") == "-x"
