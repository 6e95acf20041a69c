"""Only a command line that asks for workers on this machine begins them early."""

from __future__ import annotations

import pytest

from tactile_graph.cli.early import asks_for_workers


@pytest.mark.parametrize(
    ("words", "asks"),
    [
        ("run circle-1 a.zarr --workers 2 -o a.csv", True),
        ("compare circle-1 circle-3 a.npz --workers=2", True),
        ("run circle-1 a.zarr --workers 2 --on tcp://host:8786 -o a.csv", False),
        ("run circle-1 a.zarr --on=tcp://host:8786 -o a.csv", False),
        ("run workers -o a.csv", False),
        ("--help", False),
    ],
)
def test_who_asks(words: str, asks: bool) -> None:
    assert asks_for_workers(words.split()) is asks
