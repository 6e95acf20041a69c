"""What a run of the suite writes: who did what how fast and how well, on which machine."""

from __future__ import annotations

import json
import os
import platform
import statistics
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

FORMAT = 1
PACKAGES = (
    "tactile-graph", "numpy", "scipy", "scikit-image", "numba", "opencv-python-headless",
    "circle-fit", "PyMaxflow",
)  # fmt: skip


@dataclass(frozen=True)
class Measured:
    """One contestant on one case.

    ``rounds_us`` are microseconds a call, one figure a round; the rounds of the contestants of a
    case were taken in turn, so that the same round of two of them can be paired. ``errors`` are
    absolute, by quantity, one for each answer, in the order of the frames; None for no answer.
    Where the case is a part of a stream, ``at`` are its frames' places in that, and ``frames_us``
    the time of each, the median of the rounds.
    """

    family: str
    case: str
    contestant: str
    rounds_us: tuple[float, ...]
    errors: dict[str, tuple[float | None, ...]] = field(default_factory=dict)
    nodes_run: float | None = None
    nodes: int | None = None
    note: str = ""
    at: tuple[int, ...] = ()
    frames_us: tuple[float, ...] = ()

    @property
    def median_us(self) -> float:
        return statistics.median(self.rounds_us)

    def error(self, quantity: str) -> float | None:
        """Mean absolute error of the answers given; None if there is none."""
        given = [e for e in self.errors.get(quantity, ()) if e is not None]
        return statistics.fmean(given) if given else None

    def missing(self, quantity: str) -> int:
        return sum(e is None for e in self.errors.get(quantity, ()))


@dataclass(frozen=True)
class Results:
    """A whole run."""

    measured: tuple[Measured, ...]
    machine: dict[str, Any]
    versions: dict[str, str]
    seed: int
    made: str

    def of(self, family: str) -> list[Measured]:
        return [m for m in self.measured if m.family == family]

    @property
    def families(self) -> list[str]:
        return list(dict.fromkeys(m.family for m in self.measured))


def results_of(measured: Iterable[Measured], seed: int) -> Results:
    versions = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            versions[package] = version(package)
        except PackageNotFoundError:
            continue
    machine = {
        "system": platform.system(),
        "processor": _processor(),
        "cores": os.cpu_count(),
    }
    made = datetime.now(UTC).isoformat(timespec="seconds")
    return Results(tuple(measured), machine, versions, seed, made)


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    named = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.machine()


def write(results: Results, path: Path) -> None:
    """Write a result file, whole or not at all."""
    data = {"format": FORMAT, **asdict(results)}
    partial = path.with_name(path.name + ".part")
    partial.write_text(json.dumps(data, separators=(",", ":")) + "\n", encoding="utf-8")
    partial.replace(path)


def read(path: Path) -> Results:
    """Return what a result file holds.

    Raises
    ------
    ValueError
        If it is no result file of this format.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"{path}: not a result file: {error}") from None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise ValueError(f"{path}: not a result file of format {FORMAT}")
    measured = tuple(
        Measured(
            **{
                **m,
                "rounds_us": tuple(m["rounds_us"]),
                "at": tuple(m.get("at", ())),
                "frames_us": tuple(m.get("frames_us", ())),
                "errors": {q: tuple(e) for q, e in m["errors"].items()},
            }
        )
        for m in data["measured"]
    )
    return Results(measured, data["machine"], data["versions"], data["seed"], data["made"])
