"""Presets: those that ship load, a user's own file is one, every fault is named with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers_serial import KITS
from tactile_graph.cli.watch import Stamp, files_read
from tactile_graph.errors import UsageError
from tactile_graph.plugins.registry import installed
from tactile_graph_sources.devices.preset_file import PresetError, load_preset

GOOD = """\
preset: mine
transport: {baud: 9600}
framer:
  kind: packet
  layout:
    - {part: magic, bytes: AA 55}
    - {part: cells, type: u8}
geometry:
  rows: 4
  columns: 5
"""


@pytest.fixture
def write(tmp_path: Path):
    def writer(text: str, name: str = "mine.yaml") -> str:
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return str(path)

    return writer


def test_every_shipped_preset_loads_under_its_own_name_and_is_tested() -> None:
    names = installed().names("presets")
    assert [load_preset(n).preset for n in names] == names
    assert {k.preset for k in KITS} == set(names)


def test_a_users_own_file_is_a_preset(write) -> None:
    preset = load_preset(write(GOOD))
    assert preset.geometry.n_cells == 20


def test_a_preset_may_extend_another_by_name_or_file(write) -> None:
    path = write("preset: small\nextends: flexitac-12x32\ngeometry: {rows: 3}\n")
    preset = load_preset(path)
    assert (preset.geometry.rows, preset.geometry.columns) == (3, 32)
    again = load_preset(write(f"preset: b\nextends: {Path(path).name}\n", "b.yaml"))
    assert again.geometry == preset.geometry


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("baud:", "buad:", r"mine.yaml:2:13: transport.buad: unknown key; did you mean 'baud'"),
        (
            "baud: 9600",
            "baud: -1",
            r":2:19: transport.baud: input should be greater than 0, got -1",
        ),
        ("kind: packet", "kind: pakcet", r":4:3: framer: must be one of .*got 'pakcet'.*'packet'"),
        ("  kind: packet\n", "", r":4:3: framer: needs the key 'kind'"),
        ("type: u8", "type: u9", r":7:27: framer.layout.1.type: must be 'u8'.* got 'u9'"),
        ("AA 55", "AA 5", r":6:28: framer.layout.0.bytes: must be bytes in hex.*'AA 5'"),
        ("AA 55", "11", r"framer.layout.0.bytes: must be bytes in hex.*quotes"),
        (
            "    - {part: cells, type: u8}\n",
            "",
            "framer: layout must hold exactly one part 'cells'",
        ),
        ("part: magic, ", "", "framer.layout.0: needs the key 'part'"),
        ("rows: 4", "rows: 4\n  rows: 5", r":10:3: 'rows' is given twice; the first is in line 9"),
        ("rows: 4\n", "", r"geometry.rows: is missing"),
        ("rows: 4", "rows: 4\n  row_map: [0, 1, 1, 3]", "row_map must name each of 0 to 3 once"),
        ("rows: 4", "rows: 4\n  valid_range: [9, 1]", "valid_range must go from low to high"),
        ("rows: 4", "rows: 4\n  quantity: bananas", r"quantity: .*unknown quantity 'bananas'"),
        ("rows: 4", "rows: 4\n  order: cols", r"order: must be 'rows' or 'columns', got 'cols'"),
        ("geometry:", "assembler: chunks\ngeometry:", "'chunks' needs one part 'start'"),
        ("    - {part: magic, bytes: AA 55}\n", "", "it needs a request for each frame"),
        ("kind: packet", "kind: [", "not YAML"),
        ("preset: mine", "extends: mine.yaml", "'extends' goes round in a circle"),
    ],
)
def test_faults_are_named_with_their_place(write, old: str, new: str, message: str) -> None:
    assert old in GOOD
    with pytest.raises(PresetError, match=message):
        load_preset(write(GOOD.replace(old, new, 1)))


@pytest.mark.parametrize(
    ("framer", "message"),
    [
        ("framer: {kind: text}\nassembler: cells", "'cells' needs framer kind 'packet'"),
        ("framer: {kind: delimited, end: FF}\nassembler: rows", "needs assembler 'full'"),
        ("framer: {kind: delimited, end: FF FE}", "must be one byte in hex"),
        (
            "framer:\n  kind: packet\n  layout:\n    - {part: start, type: u8}\n"
            "    - {part: magic, bytes: AA}\n    - {part: cells, type: u8}\nassembler: chunks",
            "'chunks' needs 'count'",
        ),
    ],
)
def test_choices_that_do_not_go_together_are_refused(write, framer: str, message: str) -> None:
    text = f"preset: x\ntransport: {{baud: 9600}}\n{framer}\ngeometry: {{rows: 4, columns: 5}}\n"
    with pytest.raises(PresetError, match=message):
        load_preset(write(text))


def test_all_faults_of_a_file_are_named_in_one_run(write) -> None:
    text = GOOD.replace("baud: 9600", "baud: 0, dtrr: true").replace("rows: 4", "rows: x")
    with pytest.raises(PresetError) as caught:
        load_preset(write(text))
    assert len(caught.value.problems) == 3


@pytest.mark.parametrize("text", ["~\n", "- a\n- b\n", "just words\n"])
def test_a_file_that_is_no_mapping_is_refused(write, text: str) -> None:
    with pytest.raises(PresetError, match="must be a mapping with keys preset"):
        load_preset(write(text))


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PresetError, match="is not UTF-8 text"):
        load_preset(str(path))


def test_an_unknown_name_says_what_is_near() -> None:
    with pytest.raises(UsageError, match=r"no preset named 'flexitac-12x33'; did you mean 'flexi"):
        load_preset("flexitac-12x33")
    with pytest.raises(UsageError, match=r"preset file 'no/such.yaml' does not exist"):
        load_preset("no/such.yaml")


def test_who_watches_files_hears_of_a_preset_that_is_not_there(tmp_path: Path) -> None:
    found: dict[str, Stamp] = {}
    with files_read(found), pytest.raises(UsageError, match="does not exist"):
        load_preset(str(tmp_path / "mine.yaml"))
    assert found == {str(tmp_path / "mine.yaml"): None}
