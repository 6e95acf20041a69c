"""A pad that sends other text than its kit says is told apart by how its lines begin."""

from __future__ import annotations

import pytest

from tactile_graph_sources.devices.decoder import Decoder
from tactile_graph_sources.devices.preset_file import load_preset


@pytest.mark.parametrize(
    ("kit", "data", "hint"),
    [
        (
            "velostat-43x14",
            b"temperature 23.5 degrees\n" * 3,
            "a line begins with 'temperature 23.5 deg', the preset expects it to begin with 'F,'",
        ),
        (
            "bnl-16x16",
            b"x\n\xffready\n" * 3,
            r"a line begins with '\xffready', the preset expects it to begin with a number",
        ),
    ],
)
def test_the_hint_says_how_lines_begin(kit: str, data: bytes, hint: str) -> None:
    decoder = Decoder(load_preset(kit))
    assert decoder.feed(data) == []
    assert decoder.hint() == hint
