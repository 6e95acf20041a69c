"""Units of time behind the names of columns and arrays, and ones that nobody knows."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from helpers_recordings import blobs, flat_text, frames_of, npz_bytes, write

VALUES = blobs(6, 5, 7)


def times_of(tmp_path: Path, name: str, step: float, **settings: str) -> list[float | None]:
    """Return the times (s) of frames whose column of times is called so."""
    header = ",".join([name, *(f"r{r}c{c}" for r in range(5) for c in range(7))])
    lines = [f"{step * k:g},{x}" for k, x in enumerate(flat_text(VALUES).splitlines())]
    frames, _ = frames_of(write(tmp_path, "\n".join([header, *lines])), **settings)
    return [f.time_s for f in frames]


@pytest.mark.parametrize(
    ("name", "step", "step_s"),
    [
        ("Time (hours)", 5, 18000.0),
        ("time_h", 5, 18000.0),
        ("time [h]", 0.5, 1800.0),
        ("Zeit [Std.]", 1, 3600.0),
        ("time (d)", 5, 432000.0),
        ("Tiempo (días)", 1, 86400.0),
        ("time (minutes)", 5, 300.0),
        ("time (nanoseconds)", 5, 5e-9),
    ],
)
def test_times_are_in_the_unit_that_their_name_says(
    name: str, step: float, step_s: float, tmp_path: Path
) -> None:
    assert times_of(tmp_path, name, step) == pytest.approx([step_s * k for k in range(6)])


@pytest.mark.parametrize(("unit", "step_s"), [("h", 3600.0), ("d", 86400.0)])
def test_hours_and_days_can_be_told(unit: str, step_s: float, tmp_path: Path) -> None:
    assert times_of(tmp_path, "time", 1, time_unit=unit)[1] == step_s


def test_a_unit_that_is_none_is_told_with_what_is_assumed(tmp_path: Path) -> None:
    told = (
        "recordings with times assumed to be in milliseconds, as 'ticks' is no unit of time that "
        "is known (give time_unit)"
    )
    header = ",".join(["Time (ticks)", *(f"r{r}c{c}" for r in range(5) for c in range(7))])
    lines = [f"{20 * k},{x}" for k, x in enumerate(flat_text(VALUES).splitlines())]
    table = write(tmp_path, "\n".join([header, *lines]), "a.csv")
    archive = write(
        tmp_path, npz_bytes(frames=VALUES, **{"time (ticks)": 20.0 * np.arange(6)}), "a.npz"
    )
    rows = [{"time [ticks]": 20 * k, "values": m.tolist()} for k, m in enumerate(VALUES)]
    objects = write(tmp_path, json.dumps(rows), "a.json")
    counts = [frames_of(path)[1].counts for path in (table, archive, objects)]
    assert [c[told] for c in counts] == [1, 1, 1]


@pytest.mark.parametrize("name", ["Height (h)", "Depth [d]"])
def test_letters_that_stand_for_other_things_make_no_time(name: str, tmp_path: Path) -> None:
    assert times_of(tmp_path, name, 5) == [None] * 6
