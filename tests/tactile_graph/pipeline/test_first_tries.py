"""What people who write their first file stumble over costs one message each, at its place."""

from __future__ import annotations

import os
import threading
from pathlib import Path
from typing import Any

import pytest

from helpers_graphs import STEPS, registry
from tactile_graph import Image, Mask, loads
from tactile_graph.api.pipeline import load
from tactile_graph.errors import PipelineError, UsageError


def pressed(image: Image) -> Mask:
    return image.mask(image.values > 0)


def shrunk(mask: Mask, *, by: int = 1, of: float = 1.0) -> Mask:
    return mask


@pytest.fixture
def reg(tmp_path: Path) -> Any:
    inner = tmp_path / "inner.yaml"
    inner.write_text(
        "{pipeline: inner, nodes: {m: {step: pressed, in: frame}, n: {step: shrunk, in: m}}, "
        "outputs: [n]}"
    )
    return registry({**STEPS, "pressed": pressed, "shrunk": shrunk}, {"inner": inner})


def problems(text: str, reg: Any) -> list[str]:
    with pytest.raises(PipelineError) as caught:
        loads(text, "p.yaml", reg)
    return [f"{p.mark.line}:{p.mark.column} {p.message}" for p in caught.value.problems if p.mark]


def test_a_name_with_an_umlaut_is_told_where_it_is_given_and_nowhere_else(reg: Any) -> None:
    text = """\
pipeline: p
nodes:
  fuß: {step: pressed, in: frame}
  klein: {step: shrunk, in: fuß}
  kleiner: {step: shrunk, in: [klein]}
outputs: [fuß, kleiner]
"""
    told = "letters a to z, digits and '_' only, not starting with a digit"
    assert problems(text, reg) == [f"3:3 node name 'fuß': {told}"]


def test_a_yes_or_no_where_a_name_is_meant_says_to_quote_it(reg: Any) -> None:
    text = "pipeline: p\nnodes:\n  m: {step: on, in: frame}\noutputs: [m]\n"
    told = "must be a text, got a yes/no: True; to YAML on is a yes/no: put it in quotes"
    assert problems(text, reg) == [f"3:13 node 'm', 'step' {told}"]


def test_a_node_called_frame_is_told_once(reg: Any) -> None:
    text = """\
pipeline: p
nodes:
  frame: {step: pressed, in: frame}
  m: {step: pressed, in: frame}
outputs: [m]
"""
    assert problems(text, reg) == ["3:3 node name 'frame' is reserved"]


def test_wrong_settings_of_an_embedded_pipeline_are_told_one_by_one(reg: Any) -> None:
    text = """\
pipeline: p
nodes:
  d: {use: inner, with: {n.by: x, n.off: 2, q.by: 1, n.of: 2.0}}
outputs: [d]
"""
    assert problems(text, reg) == [
        "3:32 node 'd', n.by: must be a whole number, got 'x'",
        "3:42 node 'd', n.off: unknown setting 'off'; did you mean 'of'?",
        "3:51 node 'd', q.by: no node named 'q'; there are: m, n",
    ]


@pytest.mark.parametrize(
    ("before", "n_columns"),
    [("a", 1), ("日本", 4), ("e\N{COMBINING ACUTE ACCENT}", 1), ("ß", 1)],
)
def test_the_caret_stands_below_its_place_whatever_the_letters(
    reg: Any, before: str, n_columns: int
) -> None:
    with pytest.raises(PipelineError) as caught:
        loads(f"{{pipeline: {before}, nods: 1}}", "p.yaml", reg)
    _, caret = caught.value.problems[-1].snippet.splitlines()
    start = len("  1 | {pipeline: ")
    assert caret.index("^") == start + n_columns + len(", ")


# -- files -------------------------------------------------------------------------------------


def test_a_pipeline_can_come_through_a_pipe(reg: Any, tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.yaml"
    os.mkfifo(pipe)
    text = "{pipeline: p, nodes: {m: {step: pressed, in: frame}}, outputs: [m]}"
    writer = threading.Thread(target=lambda: pipe.write_text(text))
    writer.start()
    assert load(pipe, reg).name == "p"
    writer.join(10.0)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "files").mkdir()
    (tmp_path / "latin.yaml").write_bytes("pipeline: p\nabout: größe\n".encode("latin-1"))
    return tmp_path


def test_a_pipeline_may_be_in_utf_16_as_windows_powershell_writes_it(
    reg: Any, folder: Path
) -> None:
    text = "{pipeline: größe, nodes: {m: {step: pressed, in: frame}}, outputs: [m]}"
    (folder / "wide.yaml").write_bytes(text.encode("utf-16"))
    assert load("wide.yaml", reg).name == "größe"


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("files", "^'files' is a folder; name a file in it$"),
        ("./files", r"^'\./files' is a folder; name a file in it$"),
        (
            "latin.yaml",
            "^pipeline file 'latin.yaml' cannot be read: it is not UTF-8 text "
            r"\(byte 0xf6 in line 2\); save it as UTF-8$",
        ),
        ("files/no.yaml", "^no pipeline file 'files/no.yaml'$"),
        ({"pipeline": "p"}, r"^a pipeline's name or file is needed, got dict; loads\(\) takes"),
        (None, "^a pipeline's name or file is needed, got NoneType; "),
        ("pipeline: p\nabout: x.yaml", "got 2 lines of text, 'pipeline: p about: x.yaml'; loads"),
    ],
)
def test_what_is_no_readable_file_is_told(reg: Any, name: Any, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        load(name, reg)


def test_a_file_that_may_not_be_read_is_not_called_missing(
    reg: Any, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def forbidden(*_: Any, **__: Any) -> Any:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "exists", forbidden)  # root may read anything
    monkeypatch.setattr(Path, "open", forbidden)
    with pytest.raises(UsageError, match=r"'files/a\.yaml' cannot be read: Permission denied$"):
        load("files/a.yaml", reg)
