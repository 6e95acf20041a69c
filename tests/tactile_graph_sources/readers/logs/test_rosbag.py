"""Folders of ROS 2's bags: the MCAP logs in them are one recording."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from helpers_dialects import OBLONG
from helpers_recordings import frames_of
from tactile_graph.errors import DataError

pytest.importorskip("mcap", reason="the 'mcap' extra is not installed")


def log(path: Path, low: int, high: int) -> None:
    """Write frames of a log, 20 ms apart."""
    from mcap.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        channel = writer.register_channel("/pad", "json", writer.register_schema("", "", b""))
        for k in range(low, high):
            data = json.dumps({"data": OBLONG[k].tolist()}).encode()
            writer.add_message(channel, k * 20_000_000, data, k * 20_000_000, k)
        writer.finish()


def bag(folder: Path, about: str) -> Path:
    (folder / "metadata.yaml").write_text(f"rosbag2_bagfile_information:\n  version: 5\n{about}")
    return folder


@pytest.mark.parametrize(
    ("names", "about"),
    [
        (["bag_0.mcap"], ""),
        (["bag_9.mcap", "bag_10.mcap"], ""),
        (["b.mcap", "a.mcap"], "  relative_file_paths: [sub/b.mcap, a.mcap, [], gone.mcap]\n"),
    ],
    ids=["one", "by number", "as the metadata order them"],
)
def test_the_logs_of_a_bag_are_one_recording(names: list[str], about: str, tmp_path: Path) -> None:
    size = len(OBLONG) // len(names)
    for k, name in enumerate(names):
        log(tmp_path / name, k * size, k * size + size)
    frames, report = frames_of(bag(tmp_path, about))
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert [f.time_s for f in frames] == pytest.approx([0.02 * k for k in range(len(OBLONG))])
    assert report.counts["recordings read as ROS 2 bag of MCAP logs"] == 1
    assert not report.troubles


@pytest.mark.parametrize("metadata", ["other: 1", "[", "rosbag2_bagfile_information: 3"])
def test_a_folder_with_other_metadata_is_no_bag(metadata: str, tmp_path: Path) -> None:
    log(tmp_path / "a.mcap", 0, 2)
    (tmp_path / "metadata.yaml").write_text(metadata)
    with pytest.raises(DataError, match="is a directory; give a file in it"):
        frames_of(tmp_path)
