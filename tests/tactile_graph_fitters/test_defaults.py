"""Every step's defaults against a literal copy: pipelines that leave a setting out rely on it."""

from __future__ import annotations

from pathlib import Path

import yaml

from helpers_settings import defaults
from tactile_graph_fitters import tactile_graph_steps

LITERAL = yaml.safe_load((Path(__file__).parent / "defaults.yaml").read_text(encoding="utf-8"))


def test_every_default_is_the_literal_one() -> None:
    assert defaults(tactile_graph_steps()) == LITERAL
