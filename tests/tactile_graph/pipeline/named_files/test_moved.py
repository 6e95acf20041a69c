"""A pipeline's text for another folder: what it names there, and what it leaves as it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from tactile_graph import load, loads
from tactile_graph.errors import UsageError
from tactile_graph.inspect import moved, named_from

INNER = """\
pipeline: inner
nodes:
  found: {step: threshold, in: frame, with: {level_v: 0.01}}
outputs: [found]
"""
OUTER = """\
pipeline: outer   # the whole
evolves: sub/inner.yaml
nodes:
  a: {use: sub/inner.yaml, in: frame}   # the first
  b:
    use: &it 'sub/inner.yaml'
    in: frame
  c: {use: *it, in: frame}
outputs: [a, b, c]
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "pipes/sub").mkdir(parents=True)
    (tmp_path / "out").mkdir()
    (tmp_path / "pipes/sub/inner.yaml").write_text(INNER)
    (tmp_path / "pipes/outer.yaml").write_text(OUTER)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_files_are_named_from_the_other_folder_and_all_else_stays(folder: Path) -> None:
    there = Path("out/outer.yaml")
    there.write_text(moved(OUTER, "pipes/outer.yaml", there))
    expected = OUTER.replace("'sub/inner.yaml'", "sub/inner.yaml")
    assert there.read_text() == expected.replace("sub/inner", "../pipes/sub/inner")
    assert list(load(there).nodes) == list(load("pipes/outer.yaml").nodes)


def test_in_the_same_folder_nothing_changes(folder: Path) -> None:
    assert moved(OUTER, "pipes/outer.yaml", "pipes/other.yaml") == OUTER
    assert moved(OUTER, "pipes/outer.yaml", folder / "pipes/other.yaml") == OUTER


@pytest.mark.parametrize("name", ["a,b.yaml", "a: b.yaml", "a #b.yaml", "ä].yaml"])
def test_odd_names_of_files_can_be_read_again(folder: Path, name: str) -> None:
    Path("pipes", name).write_text(INNER)
    text = f"pipeline: odd\nnodes:\n  a: {{use: '{name}', in: frame}}\noutputs: [a]\n"
    there = moved(text, "pipes/odd.yaml", "out/odd.yaml")
    assert f"../pipes/{name}" in there
    assert loads(there, "out/odd.yaml").outputs


def test_a_name_that_means_the_same_file_stays(folder: Path) -> None:
    whole = str(folder / "pipes/sub/inner.yaml")
    assert named_from(whole, "pipes/outer.yaml", "out/x.yaml") == whole
    assert named_from("circle-3", "pipes/outer.yaml", "out/x.yaml") == "circle-3"
    assert named_from("none.yaml", "pipes/outer.yaml", "out/x.yaml") == "none.yaml"


def test_a_name_that_means_another_file_there_is_written_anew(folder: Path) -> None:
    Path("out/sub").mkdir()
    Path("out/sub/inner.yaml").write_text(INNER.replace("0.01", "0.5"))
    named = named_from("sub/inner.yaml", "pipes/outer.yaml", "out/x.yaml")
    assert named == "../pipes/sub/inner.yaml"


def test_a_file_of_the_current_folder_is_named_anew_only_where_another_hides_it(
    folder: Path,
) -> None:
    Path("inner.yaml").write_text(INNER)
    assert named_from("inner.yaml", "pipes/outer.yaml", "out/x.yaml") == "inner.yaml"
    Path("out/inner.yaml").write_text(INNER.replace("0.01", "0.5"))
    assert named_from("inner.yaml", "pipes/outer.yaml", "out/x.yaml") == "../inner.yaml"


def test_from_a_folder_behind_a_link_the_file_is_found_as_well(folder: Path) -> None:
    (folder / "far/away").mkdir(parents=True)
    (folder / "link").symlink_to(folder / "far/away")
    there = Path("link/outer.yaml")
    there.write_text(moved(OUTER, "pipes/outer.yaml", there))
    assert "../../pipes/sub/inner.yaml" in there.read_text()
    assert load(there).outputs


def test_what_would_be_wrong_there_is_not_handed_out(folder: Path) -> None:
    with pytest.raises(UsageError, match=r"it would be wrong: out/x.yaml:4.*gone.yaml"):
        moved(OUTER.replace("a: {use: sub/inner", "a: {use: gone"), "pipes/outer.yaml",
              "out/x.yaml")  # fmt: skip
