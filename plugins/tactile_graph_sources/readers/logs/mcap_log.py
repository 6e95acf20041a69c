"""MCAP logs: the only topic whose messages hold frames, or the one that ``sensor`` names.

Read are messages in JSON, and of ROS 1 and 2 (CDR) images of one channel and arrays of numbers;
their libraries of types are not needed for these.
"""

from __future__ import annotations

import json
from bisect import bisect_left
from collections.abc import Iterator
from typing import Any

from tactile_graph.errors import DataError, did_you_mean, one_of, without
from tactile_graph.wires import Frame
from tactile_graph_sources.readers.choice import SeveralSensorsError
from tactile_graph_sources.readers.head import Head
from tactile_graph_sources.readers.logs.cdr import decoder_of
from tactile_graph_sources.readers.logs.mcap_chunks import check_chunks
from tactile_graph_sources.readers.logs.mcap_records import MAGIC, Lost, Message, messages_of
from tactile_graph_sources.readers.reading import Reading
from tactile_graph_sources.readers.recording_format import RecordingFormat
from tactile_graph_sources.readers.text.json_stack import Damage, Entries, entries_of, frames_of
from tactile_graph_sources.readers.words.preamble import Described


def recognises(head: Head) -> bool:
    """Return whether the file starts as MCAP does."""
    return head.raw.startswith(MAGIC)


def read(reading: Reading) -> Iterator[Frame]:
    """Yield the frames of a topic, at the times they were logged.

    Raises
    ------
    DataError
        If the mcap library is not installed, the file is damaged, or no topic or several could be
        meant.
    """
    where = str(reading.path)
    topics = _topics(reading)
    asked = reading.told.sensor
    readable = {name: topic for name, topic in topics.items() if topic.readable}
    fit = {n: t for n, t in readable.items() if asked.lower() in n.lower()}
    listed = one_of(f"{n} ({t.kind})" for n, t in topics.items()) if topics else "none"
    if asked and not fit:
        near = did_you_mean(asked, topics)
        raise DataError(where, f"no readable topic {asked!r}, there are {listed}{near}")
    if not asked:
        fit = _without_unread(reading, fit)
    if len(fit) != 1:
        told = f"several topics could be it ({one_of(fit)}); name one with sensor"
        if fit:
            raise SeveralSensorsError(where, told, fit)
        raise DataError(where, f"no topic that is read; its topics: {listed}")
    ((name, topic),) = fit.items()
    reading.sensors[name] = None
    if topic.is_empty:
        raise DataError(where, f"no message of topic {name} can be read: {topic.damage[0][1]}")
    entries = topic.entries(where)
    reading.refuse_settings(*(["time_unit"] if topic.own_times else []))
    why = f"topic {name} of {topic.kind}"
    damage = [
        Damage(before, name, f"a message is damaged: {what}") for before, what in topic.damaged()
    ]
    yield from frames_of(reading, entries._replace(why=f"{why}, {entries.why}"), damage)


class _Topic:
    """The messages of a topic so far."""

    def __init__(self, encoding: str, schema: str) -> None:
        self.kind = f"{schema or 'no schema'}, {encoding}"
        self._decode = json.loads if encoding == "json" else decoder_of(encoding, schema)
        self._json = encoding == "json"
        self._messages: list[tuple[int, Any, bool]] = []
        """Time, what it holds, and whether messages before it are lost."""
        self.damage: list[tuple[int, str]] = []
        """Time and trouble of each message that cannot be read."""
        self.gap = False
        """Whether messages before the next one are lost."""
        self.own_times = False
        """Whether times are those that the messages say, not those of the log."""

    @property
    def readable(self) -> bool:
        return self._decode is not None

    @property
    def is_empty(self) -> bool:
        return not self._messages

    def damaged(self) -> Iterator[tuple[int, str]]:
        """Yield how many messages that can be read come before a damaged one, and its trouble."""
        times = sorted(time_ns for time_ns, _, _ in self._messages)
        for time_ns, what in sorted(self.damage):
            yield bisect_left(times, time_ns), what

    def add(self, data: bytes, time_ns: int) -> None:
        if self._decode is None:
            return
        try:
            value = self._decode(data)
        except (ValueError, RecursionError) as error:
            self.damage.append((time_ns, str(error)))
            return
        self._messages.append((time_ns, value, self.gap))
        self.gap = False

    def entries(self, where: str) -> Entries:
        """Return the frames; those of JSON have times of their own, if they say so."""
        messages = sorted(self._messages, key=lambda message: message[0])
        times = [time_ns * 1e-9 for time_ns, _, _ in messages]
        values = [value for _, value, _ in messages]
        gaps = frozenset(k for k, (_, _, gap) in enumerate(messages) if gap)
        if not self._json:
            return Entries(values, times, "time_s", Described(), "an array a message", gaps)
        found = entries_of(where, values)
        self.own_times = found.times is not None
        return found._replace(
            times=found.times or times,
            time_name=found.time_name or "time_s",
            gaps=gaps if len(found.values) == len(values) else frozenset(),
        )


def _without_unread(reading: Reading, topics: dict[str, _Topic]) -> dict[str, _Topic]:
    """Return topics without those, such as of coloured images, that give no frame; it is told."""
    unread = [name for name, topic in topics.items() if topic.is_empty]
    if len(unread) == len(topics):
        return topics
    for name in unread:
        why = topics[name].damage[0][1]
        reading.assume(f"topic {name} left out, as no message of it can be read: {why}")
    return {name: topic for name, topic in topics.items() if name not in unread}


def _topics(reading: Reading) -> dict[str, _Topic]:
    where = str(reading.path)
    topics: dict[str, _Topic] = {}
    lost: list[Lost] = []
    try:
        check_chunks(reading.path)
        with reading.path.open("rb") as file:
            for found in messages_of(file):
                if isinstance(found, Message):
                    topic = topics.setdefault(found.topic, _Topic(found.encoding, found.schema))
                    topic.add(found.data, found.time_ns)
                    continue
                lost.append(found)
                for topic in topics.values() if found.messages else ():
                    topic.gap = True
    except ImportError as error:
        missing = "is MCAP, which needs the 'mcap' extra: pip install \"tactile-graph[mcap]\""
        raise DataError(where, without("mcap", error, missing)) from error
    if lost and not topics:
        raise DataError(where, f"it holds no message that can be read: {lost[0].what}")
    for one in lost:
        if one.messages:
            reading.report.count("damaged records skipped")
        told = "; what stands before is read" if one.messages and one.at_end else ""
        reading.report.trouble(reading.at(one.place), one.what + told)
    return topics


FORMAT = RecordingFormat("MCAP", recognises, read)
