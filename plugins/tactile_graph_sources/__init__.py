"""The sources family."""

from collections.abc import Mapping
from pathlib import Path

from tactile_graph import hookimpl
from tactile_graph_sources import hookspecs as hookspecs

# The surest marks first.
_FORMATS = {
    "npy": "arrays.npy:FORMAT",
    "pictures": "arrays.pictures:FORMAT",
    "npz": "arrays.npz:FORMAT",
    "hdf5": "arrays.hdf5:FORMAT",
    "matlab": "arrays.matlab:FORMAT",
    "mcap": "logs.mcap_log:FORMAT",
    "tactilus": "instruments.popu_bed:FORMAT",
    "xsensor": "instruments.xsensor:FORMAT",
    "tekscan": "instruments.tekscan:FORMAT",
    "pliance": "instruments.pliance:FORMAT",
    "emed": "instruments.emed:FORMAT",
    "capfingerid": "instruments.capfingerid:FORMAT",
    "json": "text.json_stack:FORMAT",
    "table-of-cells": "text.long:FORMAT",
    "table-of-matrices": "text.stacked:FORMAT",
    "table-of-frames": "text.flat:FORMAT",
    "node-images": "arrays.node_images:STORE",
    "zarr-arrays": "arrays.zarr_arrays:FORMAT",
    "rosbag2-folder": "logs.rosbag:FOLDER",
    "picture-folder": "arrays.pictures:FOLDER",
    "recording-store": "arrays.stored_frames:STORE",
    "numbered-files": "sequence.numbered:FOLDER",
}


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
    return {"recording": "path", "replay": "path"}


@hookimpl
def tactile_graph_presets() -> Mapping[str, Path]:
    """Offer the presets of pads on a serial port."""
    return {p.stem: p for p in sorted(Path(__file__).with_name("presets").glob("*.yaml"))}


@hookimpl
def tactile_graph_scenes() -> Mapping[str, Path]:
    """Offer the scenes to simulate."""
    return {p.stem: p for p in sorted(Path(__file__).with_name("scenes").glob("*.yaml"))}


@hookimpl
def tactile_graph_file_kinds() -> Mapping[str, str]:
    """Offer what preset and scene files are."""
    return {
        "preset": "tactile_graph_sources.file_kinds:PRESET",
        "scene": "tactile_graph_sources.file_kinds:SCENE",
    }


@hookimpl
def tactile_graph_commands() -> Mapping[str, str]:
    """Offer the commands about devices, recordings and scenes."""
    return {
        "convert": "tactile_graph_sources.commands.convert:convert",
        "inspect": "tactile_graph_sources.commands.inspect:inspect",
        "ports": "tactile_graph_sources.commands.ports:ports",
        "presets": "tactile_graph_sources.commands.presets:presets",
        "record": "tactile_graph_sources.commands.record:record",
        "scenes": "tactile_graph_sources.commands.scenes:scenes",
    }


@hookimpl
def tactile_graph_checks() -> Mapping[str, str]:
    """Offer what looks through recordings."""
    return {"store": "tactile_graph_sources.stores.checking:STORES"}


@hookimpl
def tactile_graph_recording_formats() -> Mapping[str, str]:
    """Offer the formats of devices, of programs, and of plain tables."""
    return {name: f"{__name__}.readers.{home}" for name, home in _FORMATS.items()}


@hookimpl
def tactile_graph_recording_writers() -> Mapping[str, str]:
    """Offer what frames are converted to."""
    return {
        ".zarr": f"{__name__}.writers.write_store:WRITER",
        ".npz": f"{__name__}.writers.write_npz:WRITER",
        ".csv": f"{__name__}.writers.write_csv:WRITER",
    }


@hookimpl
def tactile_graph_devices() -> Mapping[str, str]:
    """Offer pads on serial ports."""
    return {"serial": f"{__name__}.devices.capture:SERIAL"}
