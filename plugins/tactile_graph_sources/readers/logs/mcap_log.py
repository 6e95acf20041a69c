"""MCAP logs: the only topic whose messages hold frames, or the one that ``sensor`` names.

Read are messages in JSON, and in ROS 2's CDR images of one channel and arrays of numbers; their
libraries of types are not needed for these.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from typing import Any

from tactile_graph.errors import DataError, did_you_mean, one_of
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choosing.choice import SeveralSensorsError
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.logs.cdr import decoder_of
from tactile_graph_sources.readers.logs.mcap_chunks import check_chunks
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.text.json_stack import Damage, Entries, entries_of, frames_of
from tactile_graph_sources.readers.words.preamble import Described

_MARK = b"\x89MCAP0\r\n"


def recognises(head: Head) -> bool:
    """Return whether the file starts as MCAP does."""
    return head.raw.startswith(_MARK)


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of a topic, at the times they were logged.

    Raises
    ------
    DataError
        If the mcap library is not installed, the file is damaged, or no topic or several could be
        meant.
    """
    where = str(reading.path)
    topics, end = _topics(reading)
    asked = reading.told.sensor
    readable = {name: topic for name, topic in topics.items() if topic.readable}
    fit = {n: t for n, t in readable.items() if asked.lower() in n.lower()}
    listed = one_of(f"{n} ({t.kind})" for n, t in topics.items()) if topics else "none"
    if asked and not fit:
        near = did_you_mean(asked, topics)
        raise DataError(where, f"no readable topic {asked!r}, there are {listed}{near}")
    if len(fit) != 1:
        told = f"several topics could be it ({one_of(fit)}); name one with sensor"
        if fit:
            raise SeveralSensorsError(where, told, fit)
        raise DataError(where, f"no topic that is read; its topics: {listed}")
    ((name, topic),) = fit.items()
    reading.sensors[name] = None
    damage = [Damage(k, name, f"a message is damaged: {what}") for k, what in topic.damage]
    entries = topic.entries(where)
    why = f"topic {name} of {topic.kind}"
    yield from frames_of(reading, entries._replace(why=f"{why}, {entries.why}"), [*damage, *end])


class _Topic:
    """The messages of a topic so far."""

    def __init__(self, encoding: str, schema: str) -> None:
        self.kind = f"{schema or 'no schema'}, {encoding}"
        self._decode = json.loads if encoding == "json" else decoder_of(encoding, schema)
        self._json = encoding == "json"
        self.times_s: list[float] = []
        self.values: list[Any] = []
        self.damage: list[tuple[int, str]] = []

    @property
    def readable(self) -> bool:
        return self._decode is not None

    def add(self, data: bytes, time_s: float) -> None:
        if self._decode is None:
            return
        try:
            value = self._decode(data)
        except ValueError as error:
            self.damage.append((len(self.values), str(error)))
            return
        self.times_s.append(time_s)
        self.values.append(value)

    def entries(self, where: str) -> Entries:
        """Return the frames; those of JSON have times of their own, if they say so."""
        if not self._json:
            return Entries(self.values, self.times_s, "time_s", Described(), "an array a message")
        found = entries_of(where, self.values)
        return found._replace(times=found.times or self.times_s, time_name=found.time_name or
                              "time_s")  # fmt: skip


def _topics(reading: Reading) -> tuple[dict[str, _Topic], list[Damage]]:
    """Return the topics by their names, and what the end of the file is, if it cannot be read."""
    where = str(reading.path)
    try:
        from mcap.reader import make_reader
    except ImportError:
        raise DataError(
            where, "is MCAP, which needs the 'mcap' extra: pip install 'tactile-graph[mcap]'"
        ) from None
    check_chunks(reading.path)
    topics: dict[str, _Topic] = {}
    try:
        with reading.path.open("rb") as file:
            for schema, channel, message in make_reader(file).iter_messages():
                name = schema.name if schema is not None else ""
                topic = topics.setdefault(channel.topic, _Topic(channel.message_encoding, name))
                topic.add(message.data, message.log_time * 1e-9)
    except Exception as error:  # the library has a dozen kinds of errors over damaged files
        if not any(topic.values for topic in topics.values()):
            told = str(error)[:120] or type(error).__name__
            raise DataError(where, f"the MCAP file cannot be read: {told}") from error
        what = f"cannot be read: {str(error)[:80]}"
        return topics, [Damage(sys.maxsize, "its end", what, 0)]
    return topics, []


FORMAT = RecordingFormat("MCAP", recognises, read)
