"""Files are found wherever settings name them."""

from __future__ import annotations

from collections import namedtuple
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from pydantic import BaseModel, ConfigDict

from helpers_graphs import registry
from tactile_graph import Image, loads
from tactile_graph.cli.many.made_of import made_of
from tactile_graph.pipeline.named_files.named_files import paths_in


@dataclass(frozen=True, slots=True)
class Table:
    file: str
    more: tuple[Path, ...] = ()
    factor: float = 1.0


class Model(BaseModel):
    model_config = ConfigDict(extra="allow")
    file: Path
    tables: list[Table] = []


Named = namedtuple("Named", "file")


@pytest.mark.parametrize(
    "value",
    [
        "a",
        {"x": ["a"]},
        {"a"},
        Named("a"),
        Table("a"),
        [Table("", (Path("a"),))],
        Model(file=Path("a")),
        Model(file=Path(), tables=[Table("a")]),
        Model(file=Path(), other={"x": "a"}),  # type: ignore[call-arg]
    ],
    ids=range(9),
)
def test_paths_are_found_wherever_a_setting_holds_them(value: Any) -> None:
    assert Path("a") in [*paths_in(value)]


def test_what_is_no_text_and_a_class_itself_name_nothing() -> None:
    assert not [*paths_in([1, None, b"a", Table, Model, " "])]


def scaled(image: Image, *, table: Table) -> float:
    return float(Path(table.file).read_text()) * image.peak


def test_an_output_hangs_on_files_that_a_record_names(tmp_path: Path) -> None:
    file = tmp_path / "factor.txt"
    text = f"pipeline: p\nnodes:\n  a: {{step: s, in: frame, with: {{table: {{file: {file}}}}}}}\n"
    digests = []
    for content in ("1", "9"):
        file.write_text(content)
        pipeline = loads(f"{text}outputs: [a]\n", "p.yaml", registry({"s": scaled}))
        digests.append(made_of(pipeline, {})[f"file {file}"])
    assert digests[0] != digests[1]
