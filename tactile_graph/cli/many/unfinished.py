"""An output under way, as it lies on disc until it is whole: its parts, and a journal of them.

Both are hidden files beside the output. A line of the journal is a CRC-32 in hexadecimal, a space
and JSON: the first says what the output is made of, each other which frames a part holds, where
the part ends, the CRC-32 of it, and what the run came to so far. A part counts when its line does;
whatever a killed run left behind them is cut off.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from tactile_graph.cli.output.one_run import journal_of, refuse_if_written, refused
from tactile_graph.errors import UsageError
from tactile_graph.files import is_plain, said
from tactile_graph.locks import Lock


class Unfinished:
    """The parts of an output, and what vouches for them.

    Parameters
    ----------
    output : str
        Path of the output to be.

    Attributes
    ----------
    high : int or None
        Place in the source of the first frame that is in no part; None without any part.
    so_far : mapping or None
        What was told with the last part.
    """

    def __init__(self, output: str) -> None:
        place = Path(output)
        self.output = output
        self._parts = place.with_name(f".{place.name}.parts")
        self._journal = journal_of(output)
        self._lock = Lock(self._journal)
        self._files: list[IO[bytes]] = []
        self._ends: list[int] = []
        self.high: int | None = None
        self.so_far: Mapping[str, Any] | None = None

    @staticmethod
    def possible(output: str) -> bool:
        """Return whether an output can be gone on with: no pipe, no device."""
        return output != "-" and is_plain(output)

    def begin(self, made_of: Mapping[str, str]) -> None:
        """Begin anew.

        Raises
        ------
        UsageError
            If another process is at it, or it cannot be written.
        """
        self._take()
        self._open("wb")
        self._ends, self.high, self.so_far = [], None, None
        self._line({"made_of": made_of})

    def read(self) -> Mapping[str, str] | None:
        """Return what an unfinished output is made of, and find what is in it; None without any.

        Raises
        ------
        UsageError
            If another process is at it.
        """
        if not self._journal.exists():
            return None
        self._take()
        self._parts.touch()
        self._open("r+b")
        parts, journal = self._files
        made_of: Mapping[str, str] | None = None
        kept = 0
        for number, line in enumerate(journal):
            data = _parsed(line)
            if data is None or (number > 0 and not self._vouches(data, parts)):
                break
            if number == 0:
                made_of = data.get("made_of")
            kept += len(line)
        if made_of is None:
            self.close()
            return None
        journal.truncate(kept)
        journal.seek(kept)
        parts.truncate(self._end)
        parts.seek(self._end)
        return made_of

    def add(self, high: int, part: bytes, so_far: Mapping[str, Any]) -> None:
        """Take in a part: all frames up to, not with, ``high``.

        Raises
        ------
        UsageError
            If it cannot be written.
        """
        end = self._end + len(part)
        with said(self.output):
            self._files[0].write(part)
            self._files[0].flush()
        self._line({"high": high, "end": end, "crc": zlib.crc32(part), "so_far": so_far})
        self._note(high, end, so_far)

    def parts(self) -> Iterator[bytes]:
        """Yield the parts in order."""
        with self._parts.open("rb") as file:
            begin = 0
            for end in self._ends:
                yield file.read(end - begin)
                begin = end

    def close(self) -> None:
        """Leave it as it is, for another to go on with."""
        for file in self._files:
            with suppress(OSError):  # of a full disc: what the journal does not tell was not kept
                file.close()
        self._files = []
        self._lock.release()

    def end(self, kept: bool) -> None:
        """Leave it for another to go on with if anything is kept in it; else take it away."""
        if kept or not self._files:
            self.close()
        else:
            self.remove()

    def remove(self) -> None:
        """Take it away: the output stands under its name."""
        self._parts.unlink(missing_ok=True)
        self._journal.unlink(missing_ok=True)
        self.close()

    def clear(self) -> None:
        """Take away what a run left that was killed when its output stood under its name."""
        if self._journal.exists() and self._lock.take():
            self.remove()

    # -- within --------------------------------------------------------------------------------

    def _take(self) -> None:
        before = self._journal.exists()
        with said(self.output):
            if not self._lock.take():
                raise refused(self.output)
        try:
            refuse_if_written(self.output)
        except UsageError:
            if not before:
                self._journal.unlink()
            self._lock.release()
            raise

    def _open(self, how: str) -> None:
        with said(self.output):
            self._files = [p.open(how) for p in (self._parts, self._journal)]

    def _line(self, data: Mapping[str, Any]) -> None:
        text = json.dumps(data, separators=(",", ":")).encode()
        with said(self.output):
            self._files[1].write(b"%08x %s\n" % (zlib.crc32(text), text))
            self._files[1].flush()

    def _vouches(self, data: Mapping[str, Any], parts: IO[bytes]) -> bool:
        """Return whether a part is as its line says; if so, note it."""
        if zlib.crc32(parts.read(data["end"] - self._end)) != data["crc"]:
            return False
        self._note(data["high"], data["end"], data["so_far"])
        return True

    @property
    def _end(self) -> int:
        return self._ends[-1] if self._ends else 0

    def _note(self, high: int, end: int, so_far: Mapping[str, Any]) -> None:
        self._ends.append(end)
        self.high, self.so_far = high, so_far


def _parsed(line: bytes) -> dict[str, Any] | None:
    """Return what a line says; None if it is not as it was written."""
    if not line.endswith(b"\n") or line[:8] != b"%08x" % zlib.crc32(line[9:-1]):
        return None
    data = json.loads(line[9:-1])
    return data if isinstance(data, dict) else None
