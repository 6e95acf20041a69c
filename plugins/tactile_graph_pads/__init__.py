"""Pads: their physics (coverage, force law, circuits) and the YAML files that describe them."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the pads' steps."""
    return {}


@hookimpl
def tactile_graph_pads() -> Mapping[str, Path]:
    """Offer the thesis' pad, and the same without anything uneven or random."""
    folder = Path(__file__).parent / "pads"
    return {"plain": folder / "plain.yaml", "thesis": folder / "thesis.yaml"}


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands that calibrate a pad, and that learn one from recordings."""
    return {
        "calibrate": "tactile_graph_pads.commands.calibrate:calibrate",
        "learn-pad": "tactile_graph_pads.commands.learn_pad:learn_pad",
    }
