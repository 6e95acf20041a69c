"""Errors say what people need to know of them."""

from __future__ import annotations

import importlib
import py_compile
from pathlib import Path

import pytest

from tactile_graph.errors import text_of
from tactile_graph.plugins.mistakes import why


def test_bytecode_that_is_cut_off_is_told_by_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = tmp_path / "module_of_cut_bytecode.py"
    source.write_text("x = [1, 2, 3]\n")
    compiled = Path(py_compile.compile(str(source), doraise=True))
    compiled.write_bytes(compiled.read_bytes()[:-20])
    monkeypatch.syspath_prepend(tmp_path)
    importlib.invalidate_caches()
    with pytest.raises(EOFError) as caught:
        importlib.import_module(source.stem)
    told = f"marshal data too short: {compiled} is damaged; delete its folder, which Python makes"
    assert text_of(caught.value) == f"{told} anew"
    assert why(caught.value).startswith(f"EOFError: {told} anew")


def test_who_speaks_of_such_data_without_an_import_is_left_alone() -> None:
    assert text_of(EOFError("marshal data too short")) == "marshal data too short"
