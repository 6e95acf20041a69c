"""MCAP logs: the topic that holds frames is found or asked for, and damage is told."""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest

from helpers_dialects import OBLONG, mutated
from helpers_recordings import frames_of
from tactile_graph.errors import DataError
from tactile_graph_sources.readers.logs.cdr import decoder_of

pytest.importorskip("mcap", reason="the 'mcap' extra is not installed")
Topic = tuple[str, str, Iterable[bytes]]
START_NS, STEP_NS = 5_000_000_000, 20_000_000


def log(path: Path, **topics: Topic) -> Path:
    """Write a log; a topic is its encoding, its schema and its messages, 20 ms apart."""
    from mcap.writer import Writer

    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        for name, (encoding, schema, messages) in topics.items():
            kind = writer.register_schema(name=schema, encoding="", data=b"")
            channel = writer.register_channel(f"/{name}", encoding, kind)
            for k, data in enumerate(messages):
                time = START_NS + k * STEP_NS
                writer.add_message(channel, time, data, time, k)
        writer.finish()
    return path


def in_json(frames: np.ndarray, **more: object) -> list[bytes]:
    return [json.dumps({"data": f.tolist(), **more}).encode() for f in frames]


def padded(data: bytes, to: int) -> bytes:
    return data + b"\0" * (-len(data) % to)


def text(words: str) -> bytes:
    return struct.pack("<I", len(words) + 1) + words.encode() + b"\0"


def image(frame: np.ndarray, encoding: str, dtype: str, big: bool = False, extra: int = 0) -> bytes:
    """Return a message of sensor_msgs/msg/Image in CDR."""
    rows, columns = frame.shape
    body = padded(struct.pack("<II", 3, 4) + text("mat"), 4) + struct.pack("<II", rows, columns)
    body = padded(body + text(encoding) + bytes([big]), 4)
    lines = [line.astype((">" if big else "<") + dtype).tobytes() + b"\7" * extra for line in frame]
    body += struct.pack("<II", len(lines[0]), sum(map(len, lines))) + b"".join(lines)
    return b"\0\1\0\0" + body


def multi_array(frame: np.ndarray, dtype: str, sizes: Iterable[int]) -> bytes:
    """Return a message of std_msgs/msg/…MultiArray in CDR."""
    dims = list(sizes)
    body = struct.pack("<I", len(dims))
    for size in dims:
        body = padded(body + text("axis"), 4) + struct.pack("<II", size, 0)
    body += struct.pack("<II", 0, frame.size)
    return b"\0\1\0\0" + padded(body, np.dtype(dtype).itemsize) + frame.astype(dtype).tobytes()


def values(path: Path, **told: object) -> np.ndarray:
    return np.array([f.image.values for f in frames_of(path, **told)[0]])


def test_json_messages_give_frames_at_the_times_of_the_log(tmp_path: Path) -> None:
    path = log(tmp_path / "a.mcap", pad=("json", "Pad", in_json(OBLONG, unit="kPa")))
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert [f.time_s for f in frames] == pytest.approx([5.0 + 0.02 * k for k in range(12)])
    assert frames[0].image.quantity == "kilopascal"
    assert report.counts["recordings read as MCAP"] == 1


def test_json_messages_that_say_when_they_were_taken_are_believed(tmp_path: Path) -> None:
    messages = [json.dumps({"t": 0.5 * k, "data": f.tolist()}).encode()
                for k, f in enumerate(OBLONG)]  # fmt: skip
    frames, _ = frames_of(log(tmp_path / "a.mcap", pad=("json", "Pad", messages)))
    assert frames[3].time_s == 1.5


@pytest.mark.parametrize(
    ("encoding", "dtype"), [("mono16", "u2"), ("32FC1", "f4"), ("64FC1", "f8"), ("16SC1", "i2")]
)
@pytest.mark.parametrize("big", [False, True])
@pytest.mark.parametrize("extra", [0, 3])
def test_images_of_ros_give_frames(
    tmp_path: Path, encoding: str, dtype: str, big: bool, extra: int
) -> None:
    messages = [image(f, encoding, dtype, big, extra) for f in OBLONG]
    path = log(tmp_path / "a.mcap", pad=("cdr", "sensor_msgs/msg/Image", messages))
    np.testing.assert_array_equal(values(path), OBLONG)


@pytest.mark.parametrize(
    ("name", "dtype"), [("Float32", "f4"), ("Float64", "f8"), ("UInt16", "u2")]
)
def test_arrays_of_ros_give_frames_by_their_axes_or_by_what_is_told(
    tmp_path: Path, name: str, dtype: str
) -> None:
    schema = f"std_msgs/msg/{name}MultiArray"
    shaped = [multi_array(f, dtype, (6, 10)) for f in OBLONG]
    np.testing.assert_array_equal(
        values(log(tmp_path / "a.mcap", pad=("cdr", schema, shaped))), OBLONG
    )
    flat = log(
        tmp_path / "b.mcap", pad=("cdr", schema, [multi_array(f, dtype, ()) for f in OBLONG])
    )
    with pytest.raises(DataError, match="give rows and columns"):
        frames_of(flat)
    np.testing.assert_array_equal(values(flat, rows=6, columns=10), OBLONG)


def test_several_topics_are_asked_about_and_those_of_other_kinds_named(tmp_path: Path) -> None:
    camera = image(OBLONG[0], "rgb8", "u1")
    path = log(
        tmp_path / "a.mcap",
        left=("json", "Pad", in_json(OBLONG)),
        right=("json", "Pad", in_json(OBLONG + 1)),
        camera=("protobuf", "foxglove.RawImage", [camera]),
    )
    with pytest.raises(DataError, match=r"several topics could be it .*name one with sensor"):
        frames_of(path)
    np.testing.assert_array_equal(values(path, sensor="right"), OBLONG + 1)
    with pytest.raises(
        DataError, match=r"no readable topic '/camera', there are /camera \(foxglove"
    ):
        frames_of(path, sensor="/camera")
    other = log(tmp_path / "b.mcap", camera=("protobuf", "foxglove.RawImage", [camera]))
    with pytest.raises(DataError, match=r"no topic that is read; its topics: /camera \(foxglove"):
        frames_of(other)


def test_a_damaged_message_is_left_out_and_counted(tmp_path: Path) -> None:
    messages = [image(f, "mono16", "u2") for f in OBLONG]
    messages[2] = messages[2][:40]
    messages[5] = image(OBLONG[5], "rgb8", "u1")
    path = log(tmp_path / "a.mcap", pad=("cdr", "sensor_msgs/msg/Image", messages))
    frames, report = frames_of(path)
    np.testing.assert_array_equal(
        [f.image.values for f in frames], np.delete(OBLONG, (2, 5), axis=0)
    )
    assert report.counts["damaged records skipped"] == 2
    assert any("an image of rgb8" in what for _, what in report.troubles)


def test_a_log_that_is_damaged_is_read_as_far_as_it_goes_or_refused(tmp_path: Path) -> None:
    whole = log(tmp_path / "a.mcap", pad=("json", "Pad", in_json(OBLONG))).read_bytes()
    rng = np.random.default_rng(4)
    path, refused = tmp_path / "b.mcap", 0
    for _ in range(150):
        path.write_bytes(mutated(whole, rng))
        try:
            frames_of(path)
        except DataError:
            refused += 1
    assert refused > 10
    path.write_bytes(whole[:30])
    with pytest.raises(DataError, match="the MCAP file cannot be read"):
        frames_of(path)


def test_without_the_library_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = log(tmp_path / "a.mcap", pad=("json", "Pad", in_json(OBLONG)))
    monkeypatch.setitem(sys.modules, "mcap.reader", None)
    with pytest.raises(
        DataError, match=r"needs the 'mcap' extra: pip install 'tactile-graph\[mcap"
    ):
        frames_of(path)


def test_types_that_need_their_definitions_are_not_read() -> None:
    assert decoder_of("ros1", "sensor_msgs/Image") is None
    assert decoder_of("cdr", "geometry_msgs/msg/Pose") is None
    assert decoder_of("cdr", "std_msgs/msg/StringMultiArray") is None
