"""Machine code is kept on disk; a damaged, full or missing disk costs time, never an answer."""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from numba.core import caching, config

import helpers_kernels
from tactile_graph.cli.commands import prepare
from tactile_graph.compiled import kept, machine_code, whole
from tactile_graph.compiled.preparing import Line, preparing, told_by

LOOPS = helpers_kernels.doubled.loops
VALUES = np.arange(5.0)
DAMAGES: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda content: b"",
    "cut off": lambda content: content[: len(content) // 2],
    "zeros": lambda content: bytes(len(content)),
    "a hole": lambda content: content[:600] + bytes(100) + content[700:],
}
LITTLE = """
pipeline: little
about: One step over frames that come with the project.
source: {step: sample, with: {name: discs}}
nodes: {load: {step: load, in: frame}}
outputs: [load]
"""
WAYS = pytest.mark.parametrize("entry", [whole.entry_of, machine_code._numbas_own])


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(preparing, "not_kept", "")
    monkeypatch.setattr(preparing, "on_first", None)
    return tmp_path


@pytest.fixture
def told(capsys: pytest.CaptureFixture[str]) -> Iterator[Callable[[], str]]:
    with told_by(Line()):
        yield lambda: capsys.readouterr().err


def answered(entry: Any) -> tuple[float, int]:
    """Return an answer, and how often machine code was found on disk for it."""
    return entry(VALUES, 3), sum(entry.stats.cache_hits.values())


@pytest.mark.slow
@WAYS
def test_a_damaged_file_counts_as_missing_and_is_made_anew(entry: Any, folder: Path) -> None:
    assert answered(entry(LOOPS)) == (6.0, 0)
    for ending in ("nbi", "nbc"):
        for damage in DAMAGES.values():
            for file in folder.rglob(f"*.{ending}"):
                file.write_bytes(damage(file.read_bytes()))
            assert answered(entry(LOOPS)) == (6.0, 0)
            assert answered(entry(LOOPS)) == (6.0, 1)


@pytest.mark.slow
def test_data_of_other_types_is_not_taken_for_those_of_the_index(folder: Path) -> None:
    """As they lie there where an index was begun anew and the disk was full before its data."""
    whole.entry_of(LOOPS)(VALUES.astype(np.float32), 3)
    (index,) = folder.rglob("*.nbi")
    (data,) = folder.rglob("*.nbc")
    others = data.read_bytes()
    index.unlink()
    assert answered(whole.entry_of(LOOPS)) == (6.0, 0)
    data.write_bytes(others)
    assert answered(whole.entry_of(LOOPS)) == (6.0, 0)


@pytest.mark.slow
@WAYS
def test_on_a_full_disk_the_code_is_used_and_it_is_told_once(
    entry: Any, folder: Path, told: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(caching.IndexDataCacheFile, "_save_data", full)
    assert answered(entry(LOOPS)) == answered(entry(LOOPS)) == (6.0, 0)
    lines = told().splitlines()
    assert len(lines) == 1
    assert lines[0].startswith(f"hint: machine code cannot be kept for the next time ({folder}")
    told_last = "No space left on device); set NUMBA_CACHE_DIR to a folder that takes it"
    assert lines[0].endswith(told_last)


@pytest.fixture
def nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no folder be one that can be written to."""

    def refused(_self: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(caching._CacheLocator, "ensure_cache_path", refused)


@pytest.mark.slow
@WAYS
def test_without_a_folder_the_code_is_used_and_it_is_told_once(
    entry: Any, folder: Path, told: Any, nowhere: None
) -> None:
    assert answered(entry(LOOPS)) == answered(entry(LOOPS)) == (6.0, 0)
    assert told() == (
        f"hint: machine code cannot be kept for the next time (NUMBA_CACHE_DIR={folder}, the "
        "package's folder and the user's cache cannot be written to); "
        "set NUMBA_CACHE_DIR to a folder that takes it\n"
    )


def test_without_a_folder_no_other_process_is_asked(
    nowhere: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(preparing, "on_first", lambda: None)
    entry = whole.entry_of(LOOPS)
    types = (numba.typeof(VALUES), numba.int64)
    assert isinstance(entry._cache, kept.Unkept)
    assert machine_code.on_disk(entry, types)
    assert not entry.on_disk(types)  # a chain is not made for it
    assert preparing.on_first is None


def test_prepare_does_not_call_prepared_what_was_not_kept(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TACTILE_GRAPH_KERNELS", "plain")
    file = folder / "little.yaml"
    file.write_text(LITTLE)
    assert prepare.prepared(str(file)).startswith(f"{file}: prepared by 6 frames")
    preparing.unkept("a reason")
    told = f"{file}: not prepared, machine code cannot be kept for the next time (a reason); "
    assert prepare.prepared(str(file)).startswith(told)
