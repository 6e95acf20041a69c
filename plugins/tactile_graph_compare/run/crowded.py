"""How much of the time other programs kept a measurement from a processor."""

from __future__ import annotations

from pathlib import Path

SCHEDULED = Path("/proc/thread-self/schedstat")
"""Linux: nanoseconds for which a thread ran, and for which it could have, in its first words."""

CROWDED = 0.1
"""Share of the time from which on it is told."""


class Waiting:
    """How long the current thread waited for a processor, from here on."""

    def __init__(self) -> None:
        self._began = _so_far()

    @property
    def share(self) -> float:
        """Share of the time that it could have run and did not, 0 where the system does not say."""
        ran, waited = (now - then for now, then in zip(_so_far(), self._began, strict=True))
        return waited / (ran + waited) if ran > 0 and waited > 0 else 0.0


def crowded(waiting: Waiting | None) -> tuple[str, ...]:
    """Return what people should know of times measured meanwhile, if they should."""
    share = 0.0 if waiting is None else waiting.share
    if share < CROWDED:
        return ()
    return (
        f"other programs kept the processor for {share:.0%} of the time: times are longer for it, "
        "and scatter; ratios of them hold better than they do",
    )


def _so_far() -> tuple[int, int]:
    try:
        ran, waited, *_ = SCHEDULED.read_text().split()
        return int(ran), int(waited)
    except (OSError, ValueError):
        return 0, 0
