"""``run contacts`` on the vendors' exports gives the vendors' own forces, centres and sums."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from helpers_recordings import (
    blobs,
    emed_says,
    emed_text,
    pliance_says,
    pliance_text,
    shared,
    tekscan_says,
    tekscan_text,
    write,
    xsensor_says,
    xsensor_text,
)
from tactile_graph.cli import cli

REAL = pytest.mark.parametrize(
    "real", [pytest.param(True, marks=pytest.mark.slow), False], ids=["real", "look-alike"]
)


def loads_of(recording: Path, folder: Path) -> list[dict[str, Any]]:
    """Return the output ``load`` of every frame, as the command writes it."""
    out = folder / "out.jsonl"
    result = CliRunner().invoke(cli, ["run", "contacts", str(recording), "-o", str(out)])
    assert result.exit_code == 0, result.output
    return [
        {**row["outputs"]["load"], "time_s": row.get("time_s")}
        for row in map(json.loads, out.read_text(encoding="utf-8").splitlines())
    ]


@REAL
def test_xsensor(real: bool, tmp_path: Path) -> None:
    text = xsensor_text({"LF": blobs(3, 31, 11), "RF": blobs(3, 31, 11, seed=1)})
    path = shared("vendor_exports/xsensor_data.csv") if real else write(tmp_path, text)
    found, said = loads_of(path, tmp_path), xsensor_says(path)
    assert len(found) == len(said)
    for ours, vendor in zip(found, said, strict=True):
        assert ours["force_n"] == pytest.approx(vendor["load_n"], rel=0.005, abs=0.006)
        assert ours["peak"] == pytest.approx(vendor["peak"] * 0.133322387415, rel=1e-9)


@REAL
def test_tekscan(real: bool, tmp_path: Path) -> None:
    text = tekscan_text(blobs(4, 28, 28, decimals=0))
    path = shared("vendor_exports/iscan_test.csv") if real else write(tmp_path, text)
    assert [load["total"] for load in loads_of(path, tmp_path)] == tekscan_says(path)


@REAL
def test_pliance(real: bool, tmp_path: Path) -> None:
    """The vendor's x runs from the right edge of a mat 14.784 cm wide."""
    text = pliance_text(blobs(5, 29, 28, decimals=3))
    path = shared("vendor_exports/pliance_test.asc") if real else write(tmp_path, text)
    found, said = loads_of(path, tmp_path), pliance_says(path)
    assert len(found) == len(said)
    for ours in found:
        force_n, x_cm, y_cm = said[round(ours["time_s"], 4)]
        assert ours["force_n"] == pytest.approx(force_n, rel=0.005, abs=0.0006)
        assert (14.784 - ours["x_cm"], ours["y_cm"]) == pytest.approx((x_cm, y_cm), abs=0.01)


@REAL
def test_emed(real: bool, tmp_path: Path) -> None:
    data = emed_text(blobs(3, 12, 9)).encode("latin-1")
    path = shared("vendor_exports/emed_test.lst") if real else write(tmp_path, data)
    found, said = loads_of(path, tmp_path), emed_says(path)
    assert len(found) == len(said)
    for ours, (rows, _) in zip(found, said, strict=True):
        # Each printed row force is rounded to 0.01 N.
        rounding = 0.005 * len(rows)
        assert ours["force_n"] == pytest.approx(sum(rows.values()), rel=0.005, abs=rounding)


@REAL
@pytest.mark.parametrize("name", ["FrasP01L.asf", "fscan_testL.asf"])
def test_f_scan_films_in_kilopascal_run_too(name: str, real: bool, tmp_path: Path) -> None:
    """They carry no vendor's figure of a frame; every frame answers: force is pressure x area."""
    text = tekscan_text(blobs(3, 60, 21, seed=len(name)), "KPa", "5.08 mm")
    path = shared(f"vendor_exports/{name}") if real else write(tmp_path, text)
    found = loads_of(path, tmp_path)
    assert len(found) == (205 if real else 3)
    assert all(load["force_n"] == pytest.approx(load["total"] * 0.0258064) for load in found)
