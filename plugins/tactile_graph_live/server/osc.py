"""Results as OSC (Open Sound Control 1.0) over UDP: a bundle a frame, a message a number.

Source: M. Wright, "The Open Sound Control 1.0 Specification", 2002.
"""

from __future__ import annotations

import re
import socket
import struct
from collections.abc import Iterable, Iterator
from typing import Any

from tactile_graph.errors import UsageError
from tactile_graph_live.bench.wire import Row

LARGEST = 1400
"""Bytes of a bundle: one packet on any network."""
_HEAD = b"#bundle\0" + struct.pack(">Q", 1)  # time tag 1: at once
_FORBIDDEN = re.compile(r"[^A-Za-z0-9_.+-]")
LEFT_OUT = ("output", "item", "outcome", "type")
INT32 = 2**31


def message(address: str, value: bool | int | float | str) -> bytes:
    """Return one OSC message: an address and a value."""
    if isinstance(value, bool):
        return _text(address) + _text(",T" if value else ",F")
    if isinstance(value, int) and -INT32 <= value < INT32:
        return _text(address) + _text(",i") + struct.pack(">i", value)
    if isinstance(value, int | float):
        return _text(address) + _text(",f") + struct.pack(">f", _single(float(value)))
    return _text(address) + _text(",s") + _text(value)


def _single(value: float) -> float:
    """Return a value within the range of single precision, whose packing fails beyond."""
    most = 3.4028234e38
    return max(-most, min(most, value))


def _text(text: str) -> bytes:
    """Return a text as OSC has it: ASCII, ended by a zero, filled up to four bytes."""
    raw = text.encode("ascii", "replace").replace(b"\0", b"?") + b"\0"
    return raw + bytes(-len(raw) % 4)


def bundles(messages: Iterable[bytes]) -> Iterator[bytes]:
    """Yield bundles of messages, each of which fits into a packet."""
    bundle = _HEAD
    for one in messages:
        part = struct.pack(">i", len(one)) + one
        if len(bundle) > len(_HEAD) and len(bundle) + len(part) > LARGEST:
            yield bundle
            bundle = _HEAD
        bundle += part
    yield bundle


def messages_of(row: Row) -> Iterator[bytes]:
    """Yield the messages of a frame: ``/frame``, and ``/output/item/field`` for each value.

    An output that is no list has item 0; ``/output/count`` says how many there are.
    """
    yield message("/frame", row.frame)
    counts: dict[str, int] = {}
    for found in row.rows:
        output = _part(str(found["output"]))
        there = found.get("outcome") == "ok"
        counts[output] = counts.get(output, 0) + there
        if there:
            at = f"/{output}/{found.get('item', 0)}"
            for name, value in found.items():
                if name not in LEFT_OUT and isinstance(value, bool | int | float | str):
                    yield message(f"{at}/{_part(name)}", value)
    for output, n in counts.items():
        yield message(f"/{output}/count", n)


def _part(name: str) -> str:
    return _FORBIDDEN.sub("_", name) or "_"


class OscSender:
    """Sends results to one address; what cannot be sent is let go.

    Parameters
    ----------
    target : str
        ``HOST:PORT``.

    Raises
    ------
    UsageError
        If that is no address.
    """

    def __init__(self, target: str) -> None:
        host, colon, port = target.rpartition(":")
        host = host.strip("[]")
        if not (colon and host and port.isdecimal() and 0 < int(port) < 65536):
            raise UsageError(f"--osc {target}: must be HOST:PORT, as 127.0.0.1:9000")
        try:
            found = socket.getaddrinfo(host, int(port), type=socket.SOCK_DGRAM)
        except OSError as error:
            raise UsageError(f"--osc {target}: {error.strerror or error}") from None
        family, kind, protocol, _, address = found[0]
        self._address: tuple[Any, ...] = address
        self._socket = socket.socket(family, kind, protocol)
        self._socket.setblocking(False)
        self.n_unsent = 0

    def send(self, row: Row) -> None:
        """Send what a frame came to."""
        for bundle in bundles(messages_of(row)):
            try:
                self._socket.sendto(bundle, self._address)
            except OSError:  # nobody listens, or the network has no room: the next frame comes soon
                self.n_unsent += 1

    def close(self) -> None:
        """Send no more."""
        self._socket.close()
