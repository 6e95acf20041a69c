"""Counters of a link: what came, what was good, and what was bad by cause."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field


@dataclass
class LinkCounts:
    """What a decoder and its link have seen; all numbers only ever grow."""

    bytes: int = 0
    good: int = 0
    doubtful: int = 0
    bad: Counter[str] = field(default_factory=Counter)
    discarded_bytes: int = 0
    discarded_pieces: int = 0
    """Rows, chunks or cells that came whole, of frames that did not."""
    resyncs: int = 0
    timeouts: int = 0
    sequence_gaps: int = 0
    dropped: int = 0
    held_back: int = 0
    reconnects: int = 0

    def as_dict(self) -> dict[str, int]:
        """Return name and number of every counter, ready for a report."""
        rows = {
            "bytes": self.bytes,
            "good frames": self.good,
            "doubtful frames": self.doubtful,
            "discarded bytes": self.discarded_bytes,
            "discarded pieces": self.discarded_pieces,
            "resyncs": self.resyncs,
            "timeouts": self.timeouts,
            "sequence gaps": self.sequence_gaps,
            "dropped frames": self.dropped,
            "held back": self.held_back,
            "reconnects": self.reconnects,
        }
        return rows | {f"bad frames: {cause}": n for cause, n in sorted(self.bad.items())}

    @property
    def n_bad(self) -> int:
        """Bad frames of all causes."""
        return self.bad.total()
