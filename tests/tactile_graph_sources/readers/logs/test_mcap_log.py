"""MCAP logs: the topic that holds frames is found or asked for, and damage is told."""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

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


def in_ros_1(frame: np.ndarray, schema: str) -> bytes:
    """Return a message of sensor_msgs/Image or std_msgs/UInt16MultiArray as ROS 1 writes it."""
    (rows, columns), data = frame.shape, frame.astype("<u2").tobytes()
    if schema.endswith("Image"):
        head = struct.pack("<IIII", 7, 3, 4, 3) + b"mat" + struct.pack("<II", rows, columns)
        head += struct.pack("<I", 6) + b"mono16" + struct.pack("<BII", 0, 2 * columns, len(data))
        return head + data
    axes = [struct.pack("<I", 4) + b"axis" + struct.pack("<II", n, 0) for n in frame.shape]
    return struct.pack("<I", 2) + b"".join(axes) + struct.pack("<II", 0, frame.size) + data


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


@pytest.mark.parametrize("schema", ["sensor_msgs/Image", "std_msgs/UInt16MultiArray"])
def test_messages_of_ros_1_give_frames_and_cut_ones_are_told(tmp_path: Path, schema: str) -> None:
    messages = [in_ros_1(f, schema) for f in OBLONG]
    np.testing.assert_array_equal(
        values(log(tmp_path / "a.mcap", pad=("ros1", schema, messages))), OBLONG
    )
    messages[1] = messages[1][:-1]
    frames, report = frames_of(log(tmp_path / "b.mcap", pad=("ros1", schema, messages)))
    assert len(frames) == len(OBLONG) - 1
    assert "a message is damaged: it is cut off" in report.troubles[0][1]


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


def test_a_topic_of_which_nothing_can_be_read_is_no_second_one(tmp_path: Path) -> None:
    coloured = in_ros_1(OBLONG[0], "sensor_msgs/Image").replace(b"mono16", b"yuv422")
    camera = ("ros1", "sensor_msgs/Image", [coloured])
    path = log(tmp_path / "a.mcap", pad=("json", "Pad", in_json(OBLONG)), camera=camera)
    frames, report = frames_of(path)
    np.testing.assert_array_equal([f.image.values for f in frames], OBLONG)
    assert any("topic /camera left out, as no message of it" in told for told in report.counts)
    with pytest.raises(DataError, match="no message of topic /camera can be read"):
        frames_of(path, sensor="camera")


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


PACKINGS = ("", "lz4", "zstd")
MANY = np.random.default_rng(8).integers(0, 4000, (60, 6, 10)).astype(float)
END = struct.Struct("<BQQQI8s")


def chunked(
    path: Path, packing: str | None, messages: Iterable[bytes], kind: str = "json"
) -> bytes:
    """Return a log in chunks of some 3 kB that are packed so, or without chunks."""
    from mcap.writer import CompressionType, Writer

    names = {"": CompressionType.NONE, "lz4": CompressionType.LZ4, "zstd": CompressionType.ZSTD}
    with path.open("wb") as file:
        writer = Writer(
            file,
            chunk_size=3000,
            compression=names[packing or ""],
            use_chunking=packing is not None,
            enable_data_crcs=packing is None,
        )
        writer.start()
        schema = writer.register_schema("std_msgs/msg/Float32MultiArray", "", b"")
        channel = writer.register_channel("/pad", kind, schema)
        for k, data in enumerate(messages):
            writer.add_message(channel, START_NS + k * STEP_NS, data, k, k)
        writer.finish()
    return path.read_bytes()


def index_of(whole: bytes) -> int:
    return int(END.unpack(whole[-END.size :])[2])


def chunks_of(whole: bytes) -> list[tuple[int, int]]:
    """Return where each chunk, or message without one, begins and ends."""
    found, at = [], 8
    while at < index_of(whole):
        kind, size = struct.unpack_from("<BQ", whole, at)
        found += [(at, at + 9 + size)] if kind in (5, 6) else []
        at += 9 + size
    return found


def read_of(path: Path, content: bytes) -> tuple[list[int], list[int], Any]:
    """Return the numbers of the frames by their times, those after a gap, and the report.

    Each has the values that were logged.
    """
    path.write_bytes(content)
    frames, report = frames_of(path)
    numbers = [round((f.time_s - 5.0) / 0.02) for f in frames if f.time_s is not None]
    for number, frame in zip(numbers, frames, strict=True):
        np.testing.assert_array_equal(frame.image.values, MANY[number])
    return numbers, [n for n, f in zip(numbers, frames, strict=True) if f.gap], report


@pytest.mark.slow
@pytest.mark.parametrize("packing", [*PACKINGS, None])
def test_a_log_that_is_cut_off_is_read_up_to_there_and_says_so(
    tmp_path: Path, packing: str | None
) -> None:
    path = tmp_path / "a.mcap"
    whole = chunked(path, packing, in_json(MANY))
    numbers, _, report = read_of(path, whole)
    assert numbers == [*range(60)]
    assert not report.troubles
    chunks = chunks_of(whole)
    start, stop = chunks[len(chunks) // 2]
    last = chunks[-1][1]
    between, _, report = read_of(path, whole[:start])
    assert between == [*range(len(between))]
    assert "its end" in report.troubles[0][0]
    assert report.counts["damaged records skipped"] == 1
    within, _, report = read_of(path, whole[: stop - 9])
    assert within == [*range(len(within))]
    assert len(within) >= len(between)
    part = "a message" if packing is None else "a chunk"
    told = f"the log is cut off within {part}: {stop - 18 - start:,} of its {stop - 9 - start:,} "
    assert told in report.troubles[0][1]
    assert read_of(path, whole[:last])[0] == [*range(60)]
    for cut in (index_of(whole), index_of(whole) + 30, len(whole) - 20, len(whole) - 1):
        numbers, _, report = read_of(path, whole[:cut])
        assert numbers == [*range(60)]
        assert "damaged records skipped" not in report.counts
        assert report.troubles[0][1] == (
            "the index of the log is cut off or damaged; all messages before it are read"
        )


def test_of_a_chunk_that_is_cut_off_the_messages_that_are_there_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    whole = chunked(path, "", in_json(MANY))
    start, stop = chunks_of(whole)[3]
    before = len(read_of(path, whole[:start])[0])
    assert len(read_of(path, whole[: stop - 9])[0]) > before


@pytest.mark.parametrize("size", [8, 12, 20, 30])
def test_a_log_that_is_cut_off_before_its_first_message_says_so(tmp_path: Path, size: int) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(log(path, pad=("json", "Pad", in_json(OBLONG))).read_bytes()[:size])
    with pytest.raises(DataError, match="it holds no message that can be read: the log is cut off"):
        frames_of(path)


@pytest.mark.parametrize("packing", PACKINGS)
def test_a_chunk_with_a_damaged_byte_is_left_out_and_the_next_frame_follows_a_gap(
    tmp_path: Path, packing: str
) -> None:
    """Without its checksum a value would be wrong, and nobody would know."""
    path = tmp_path / "a.mcap"
    messages = [multi_array(f, "f4", (6, 10)) for f in MANY]
    damaged = bytearray(chunked(path, packing, messages, "cdr"))
    start, stop = chunks_of(bytes(damaged))[1]
    damaged[(start + stop) // 2] ^= 1
    numbers, gaps, report = read_of(path, bytes(damaged))
    lost = sorted({*range(60)} - {*numbers})
    assert lost == [*range(lost[0], lost[-1] + 1)]
    assert gaps == [lost[-1] + 1]
    assert f":byte {start}" in report.troubles[0][0]
    assert report.counts["damaged records skipped"] == 1


def test_behind_a_damaged_length_it_is_read_on_at_the_next_chunk_of_the_index(
    tmp_path: Path,
) -> None:
    path = tmp_path / "a.mcap"
    damaged = bytearray(chunked(path, "zstd", in_json(MANY)))
    start, _ = chunks_of(bytes(damaged))[1]
    damaged[start + 3] ^= 0x40
    numbers, gaps, report = read_of(path, bytes(damaged))
    assert len(numbers) > 40
    assert len(gaps) == 1
    assert "bytes are damaged; it is read on behind them" in report.troubles[0][1]


def test_a_damaged_value_outside_of_chunks_is_told_by_the_checksum_of_all(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    damaged = bytearray(chunked(path, None, [multi_array(f, "f4", (6, 10)) for f in MANY], "cdr"))
    damaged[chunks_of(bytes(damaged))[-1][1] - 2] ^= 1
    path.write_bytes(damaged)
    frames, report = frames_of(path)
    assert len(frames) == 60
    assert "checksum of the log is wrong: some values may be" in report.troubles[0][1]


def test_zeros_behind_a_log_that_was_never_ended_are_its_end(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    whole = chunked(path, "lz4", in_json(MANY))
    start, _ = chunks_of(whole)[1]
    numbers, _, report = read_of(path, whole[:start] + bytes(5000))
    assert len(numbers) >= 5
    assert f"zeros stand behind its {start:,} bytes" in report.troubles[0][1]


def test_a_channel_that_is_damaged_is_taken_from_the_index(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    damaged = bytearray(chunked(path, "", in_json(MANY)))
    damaged[chunks_of(bytes(damaged))[0][0] + 200] ^= 1
    numbers, _, _ = read_of(path, bytes(damaged))
    assert len(numbers) > 40


def test_messages_are_read_by_the_times_of_the_log_whatever_their_order(tmp_path: Path) -> None:
    from mcap.writer import Writer

    path = tmp_path / "a.mcap"
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=3000)
        writer.start()
        channel = writer.register_channel("/pad", "json", 0)
        for k, data in reversed([*enumerate(in_json(MANY))]):
            writer.add_message(channel, START_NS + k * STEP_NS, data, k, k)
        writer.finish()
    assert read_of(path, path.read_bytes())[0] == [*range(60)]


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


def test_without_the_library_it_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = log(tmp_path / "a.mcap", pad=("json", "Pad", in_json(OBLONG)))
    monkeypatch.setitem(sys.modules, "mcap.records", None)
    with pytest.raises(
        DataError, match=r"needs the 'mcap' extra: pip install \"tactile-graph\[mcap"
    ):
        frames_of(path)


def test_types_that_need_their_definitions_are_not_read() -> None:
    assert decoder_of("ros1", "geometry_msgs/Pose") is None
    assert decoder_of("protobuf", "sensor_msgs/Image") is None
    assert decoder_of("cdr", "geometry_msgs/msg/Pose") is None
    assert decoder_of("cdr", "std_msgs/msg/StringMultiArray") is None


def test_a_unit_is_told_of_times_in_messages_alone(tmp_path: Path) -> None:
    rows = [json.dumps({"time": k, "data": f.tolist()}).encode() for k, f in enumerate(OBLONG)]
    own = log(tmp_path / "own.mcap", pad=("json", "", rows))
    assert frames_of(own, time_unit="ms")[0][3].time_s == pytest.approx(3e-3)
    bare = log(tmp_path / "bare.mcap", pad=("json", "", in_json(OBLONG)))
    with pytest.raises(DataError, match="time_unit: its times, if it has any, are in the unit"):
        frames_of(bare, time_unit="ms")
