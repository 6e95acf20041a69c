"""The hooks of the sources: what else recordings are read from, written to, and captured with."""

from __future__ import annotations

from collections.abc import Mapping

from tactile_graph.plugins.hookspecs import hook_of


@hook_of("tactile_graph_sources.readers.recording_format:RecordingFormat")
def tactile_graph_recording_formats() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Format of recordings -> import string of its `RecordingFormat`, which ``recording`` reads."""


@hook_of("tactile_graph_sources.writers.recording_writer:RecordingWriter", endings=True)
def tactile_graph_recording_writers() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Ending of a file's name (``.npz``) -> import string of the `RecordingWriter` of such."""


@hook_of("tactile_graph_sources.devices.capture:CaptureDevice")
def tactile_graph_devices() -> Mapping[str, str]:  # type: ignore[empty-body]
    """Way in which pads hang on a machine -> import string of its `CaptureDevice`, for record."""
