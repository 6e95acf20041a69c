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
    """Offer the thesis' pad, one fitted to more of its tables, and one without anything uneven."""
    folder = Path(__file__).parent / "pads"
    return {name: folder / f"{name}.yaml" for name in ("plain", "thesis", "thesis-tables")}


@hookimpl
def tactile_graph_file_kinds() -> Mapping[str, str]:
    """Offer what the files of pads and of calibrations are."""
    return {
        "calibration": "tactile_graph_pads.calibration.calibration_kind:CALIBRATION",
        "pad": "tactile_graph_pads.pad_kind:PAD",
    }


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands that list pads, calibrate one, and learn one from recordings."""
    return {
        "pads": "tactile_graph_pads.commands.pads:pads",
        "calibrate": "tactile_graph_pads.commands.calibrate:calibrate",
        "learn-pad": "tactile_graph_pads.commands.learn_pad:learn_pad",
    }
