"""``check`` and ``schema`` know the files that ``calibrate`` writes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import yaml

from helpers_cli import call
from tactile_graph.cli.commands.schema import complete_kind
from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.cli.pages.key_tables import key_tables
from tactile_graph.plugins.registry import installed
from tactile_graph.record_schema import record_schema
from tactile_graph_pads.calibration.calibration import (
    Calibration,
    Origin,
    Provenance,
    write_calibration,
)
from tactile_graph_pads.calibration.fit import calibrated
from tactile_graph_pads.calibration.points import Observation, points_of


def made(kind: str = "isotonic") -> Calibration:
    loads = np.geomspace(12.0, 700.0, 9)
    volts = 2.5 * loads**1.46 / (loads**1.46 + 1200.0)
    seen = [Observation(float(g), np.full(4, v)) for g, v in zip(loads, volts, strict=True)]
    plain = calibrated(points_of(seen), kind, "volt", observations=seen)  # type: ignore[arg-type]
    told = Provenance("tactile-graph 1", "now", ("a",), recordings=(Origin("a.npz"),))
    return replace(plain, provenance=told)


@pytest.mark.parametrize(
    ("kind", "offset"),
    [("polynomial", ()), ("isotonic", ((0.1, 0.2), (0.3, 0.4))), ("power", ())],
)
def test_a_file_that_was_written_is_right_and_its_schema_takes_it(
    kind: str, offset: tuple[tuple[float, ...], ...], tmp_path: Path
) -> None:
    curve = made(kind)
    told = replace(curve.provenance, empty=Origin("e.npz") if offset else None)
    path = tmp_path / "c.yaml"
    write_calibration(path, replace(curve, offset=offset, provenance=told))
    got = call("check", path)
    assert got.exit_code == 0
    assert f"c.yaml: right  calibration: {kind} curve of 9 loads, volt from " in got.stdout
    assert ("above what an empty pad of 2 x 2 elements reads" in got.stdout) == bool(offset)
    schema = json.loads(call("schema", path).stdout)
    assert schema["title"] == "tactile-graph calibration"
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(yaml.safe_load(path.read_text()))


def test_a_wrong_file_is_told_by_line(tmp_path: Path) -> None:
    path = tmp_path / "c.yaml"
    write_calibration(path, made())
    path.write_text(path.read_text().replace("reading: volt", "reading: ohm"))
    got = call("check", path)
    assert got.exit_code == 2
    assert "c.yaml:5:10: reading should be 'volt'" in got.stdout


def test_none_is_installed_by_name() -> None:
    got = call("check", "--as", "calibration")
    assert got.exit_code == 2
    assert "name a calibration or a file of one: no plugin offers any" in got.stderr


def test_every_key_says_what_it_means() -> None:
    tables = key_tables(record_schema(file_kind(installed(), "calibration"), "calibration"))
    assert [f"{t.place}.{k.name}" for t in tables for k in t.keys if not k.meaning] == []
    assert [t.place for t in tables if not t.about] == []


def test_the_shell_completes_the_kind() -> None:
    assert complete_kind(None, None, "cal") == ["calibration"]  # type: ignore[arg-type]
