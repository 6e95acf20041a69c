"""Pads, presets and scenes that ship: listed, checked, allowed by their schemas, documented."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from helpers_cli import call
from tactile_graph.cli.file_kinds import file_kind
from tactile_graph.cli.pages.key_tables import key_tables
from tactile_graph.plugins.registry import installed
from tactile_graph.record_schema import record_schema

KINDS = {"pad": "pads", "preset": "presets", "scene": "scenes"}
SHIPPED = [(kind, name) for kind, offers in KINDS.items() for name in installed().names(offers)]


@cache
def schema(kind: str) -> dict[str, Any]:
    made = record_schema(file_kind(installed(), kind), kind)
    jsonschema.Draft202012Validator.check_schema(made)
    return made


class _Yaml12(yaml.SafeLoader):
    """Takes 33e+3 for the number that it is to editors, and to those who read the files."""


_Yaml12.add_implicit_resolver(  # type: ignore[no-untyped-call]
    "tag:yaml.org,2002:float", re.compile(r"[-+]?[0-9][0-9.]*e[-+]?[0-9]+$"), list("-+0123456789")
)


def allowed(kind: str, text: str) -> bool:
    data = yaml.load(text, _Yaml12)
    return bool(jsonschema.Draft202012Validator(schema(kind)).is_valid(data))


@pytest.mark.parametrize(("kind", "name"), SHIPPED)
def test_every_shipped_file_is_right_and_its_schema_takes_it(kind: str, name: str) -> None:
    path = installed().path(KINDS[kind], name)
    assert allowed(kind, path.read_text("utf-8"))
    got = call("check", path, "--as", kind)
    assert got.exit_code == 0
    assert f": right  {kind}: " in got.stdout


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_says_what_it_means(kind: str) -> None:
    tables = key_tables(schema(kind))
    assert len(tables) > 3
    assert [f"{t.place}.{k.name}" for t in tables for k in t.keys if not k.meaning] == []
    assert [t.place for t in tables if not t.about] == []


@pytest.mark.parametrize("offers", KINDS.values())
def test_every_shipped_file_has_its_line_in_the_list(offers: str) -> None:
    lines = call(offers).stdout.splitlines()
    assert [line.split()[0] for line in lines] == installed().names(offers)
    assert all(len(line.split()) > 2 for line in lines)
    assert f"  {offers} " in call("--help").stdout


WRONG = [
    ("pad", "geometry: {rows: 0}", "rows must be >= 1, got 0"),
    ("pad", "geometry: {element_cm: [0.5, 1.5]}", "it is one number for both ways, as elements"),
    ("pad", "circuit: {bias_ohm: 3}", "'kind' is missing"),
    ("pad", "circuit: {kind: feedback, mux_ohm: 3}", "unknown key 'mux_ohm'"),
    ("scene", "objects: [{shape: disc, weight_g: 3}]", "'radius_cm' is missing"),
    ("scene", "hold: 0", "hold must be >= 1"),
    ("preset", "preset: a\ntransport: {baud: 3}\nframer: {kind: text}", "geometry: is missing"),
    ("preset", "extends: m1616\ntransport: {buad: 3}", "did you mean 'baud'?"),
]


@pytest.mark.parametrize(("kind", "text", "message"), WRONG)
def test_a_wrong_file_is_refused_by_check_and_by_its_schema(
    kind: str, text: str, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    got = call("check", path)
    assert got.exit_code == 2
    assert message in got.stdout
    assert not allowed(kind, text)


def test_a_scene_tells_its_furthest_place(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    disc = "shape: disc, weight_g: 3, radius_cm: 1"
    path.write_text(
        f"objects: [{{{disc}}}, {{{disc}, place: [4, 9.5]}}, {{{disc}, place: [6, 2]}}]"
    )
    assert "scene: 3 objects; places up to x 6 cm, y 9.5 cm" in call("check", path).stdout


def test_a_pad_whose_table_of_elements_is_gone_is_wrong(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(
        "learned: {reading: counts, rows: 2, columns: 2, pitch_cm: [1, 1], origin_cm: [0, 0],\n"
        "  elements: gone.csv, noise: 1, touched_from: 3}\n"
    )
    got = call("check", path)
    assert got.exit_code == 2
    assert "gone.csv" in got.stdout


def test_a_shipped_file_printed_is_where_ones_own_begins(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(call("pads", "thesis").stdout)
    assert "16 x 16 elements" in call("check", path).stdout
