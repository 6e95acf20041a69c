"""Results as OSC."""

from __future__ import annotations

import socket
import struct
from typing import Any

import pytest

from tactile_graph.errors import UsageError
from tactile_graph_live.bench.wire import Row
from tactile_graph_live.server.osc import LARGEST, OscSender, bundles, message, messages_of


def read_text(raw: bytes, at: int) -> tuple[str, int]:
    end = raw.index(b"\0", at)
    return raw[at:end].decode(), end + 4 - end % 4


def read(raw: bytes) -> tuple[str, Any]:
    """Return address and value of a message, by the letter of the specification."""
    address, at = read_text(raw, 0)
    tags, at = read_text(raw, at)
    assert len(raw) % 4 == 0
    if tags == ",s":
        return address, read_text(raw, at)[0]
    if tags in (",T", ",F"):
        return address, tags == ",T"
    return address, struct.unpack(">i" if tags == ",i" else ">f", raw[at:])[0]


def unbundled(raw: bytes) -> list[bytes]:
    assert raw[:16] == b"#bundle\0" + bytes(7) + b"\1"
    found, at = [], 16
    while at < len(raw):
        (size,) = struct.unpack(">i", raw[at : at + 4])
        found.append(raw[at + 4 : at + 4 + size])
        at += 4 + size
    return found


ROW = Row(7, 0.5, "", None, 1.0, 900.0, (), (
    {"output": "circle", "outcome": "ok", "type": "Circle", "x_cm": 1.5, "fits": True},
    {"output": "contacts", "item": 1, "outcome": "ok", "number": 3, "name": "cup"},
    {"output": "contacts", "item": 2, "outcome": "skipped: why"},
    {"output": "hull", "outcome": "failed: why"},
))  # fmt: skip


@pytest.mark.parametrize("value", [1.5, -3, True, False, "cup", ""])
def test_a_message_is_read_back(value: Any) -> None:
    assert read(message("/a/b", value)) == ("/a/b", value)


def test_numbers_beyond_32_bits_go_as_floats_of_the_largest_size() -> None:
    assert read(message("/a", 2**40)) == ("/a", float(2**40))
    assert read(message("/a", 1e300))[1] == pytest.approx(3.4028e38, rel=1e-4)


def test_a_frame_is_its_number_its_values_and_how_many_there_are() -> None:
    assert [read(m) for m in messages_of(ROW)] == [
        ("/frame", 7),
        ("/circle/0/x_cm", 1.5),
        ("/circle/0/fits", True),
        ("/contacts/1/number", 3),
        ("/contacts/1/name", "cup"),
        ("/circle/count", 1),
        ("/contacts/count", 1),
        ("/hull/count", 0),
    ]


def test_names_hold_nothing_that_an_address_may_not() -> None:
    row = Row(0, None, "", None, 0.0, 0.0, (), ({"output": "a/b *", "outcome": "ok", "x y": 1},))
    assert read(list(messages_of(row))[1])[0] == "/a_b__/0/x_y"


def test_bundles_fit_into_packets_and_lose_nothing() -> None:
    parts = [message(f"/x/{i}", float(i)) for i in range(300)]
    packed = list(bundles(parts))
    assert max(map(len, packed)) <= LARGEST
    assert [m for bundle in packed for m in unbundled(bundle)] == parts


def test_a_frame_arrives_by_udp() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.bind(("127.0.0.1", 0))
        receiver.settimeout(5)
        sender = OscSender(f"127.0.0.1:{receiver.getsockname()[1]}")
        sender.send(ROW)
        sender.close()
        assert unbundled(receiver.recv(2000)) == list(messages_of(ROW))


def test_an_address_where_nobody_listens_stops_nothing() -> None:
    sender = OscSender("127.0.0.1:9")
    for _ in range(3):
        sender.send(ROW)
    sender.close()


@pytest.mark.parametrize("target", ["9000", "host:", ":9000", "127.0.0.1:0", "127.0.0.1:99999"])
def test_what_is_no_address_is_refused(target: str) -> None:
    with pytest.raises(UsageError, match="must be HOST:PORT"):
        OscSender(target)
