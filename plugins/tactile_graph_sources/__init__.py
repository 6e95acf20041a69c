"""The sources family."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl


@hookimpl
def tactile_graph_steps() -> Mapping[str, str]:
    """Offer the sources."""
    return {
        "recording": "tactile_graph_sources.recording:recording",
        "replay": "tactile_graph_sources.replay:replay",
        "sample": "tactile_graph_sources.sample:sample",
        "serial": "tactile_graph_sources.serial_port:serial",
        "simulate": "tactile_graph_sources.simulate:simulate",
    }


@hookimpl
def tactile_graph_readers() -> Mapping[str, str]:
    """Offer what reads the recordings a command line names."""
    return {"recording": "path"}


@hookimpl
def tactile_graph_presets() -> Mapping[str, Path]:
    """Offer the presets of pads on a serial port."""
    return {p.stem: p for p in sorted(Path(__file__).with_name("presets").glob("*.yaml"))}


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands about devices and recordings."""
    return {
        "convert": "tactile_graph_sources.commands.convert:convert",
        "inspect": "tactile_graph_sources.commands.inspect:inspect",
        "ports": "tactile_graph_sources.commands.ports:ports",
        "record": "tactile_graph_sources.commands.record:record",
    }


@hookimpl
def tactile_graph_checks() -> Mapping[str, str]:
    """Offer what looks through recordings."""
    return {"store": "tactile_graph_sources.stores.checking:STORES"}
