from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tactile_graph.files import whole_file
from tactile_graph.part_files import part_of

KILLED = """
import os, signal, sys
from pathlib import Path
from tactile_graph.part_files import part_of
part = part_of(Path(sys.argv[1]))
part.mkdir() if sys.argv[2] == "folder" else part.touch()
os.kill(os.getpid(), signal.SIGKILL)
"""

killed = pytest.mark.skipif(os.name == "nt", reason="asking for a process would end it there")


def _killed(target: Path, kind: str) -> Path:
    ended = subprocess.run([sys.executable, "-c", KILLED, str(target), kind])
    assert ended.returncode == -signal.SIGKILL
    (part,) = target.parent.glob(".*.part")
    return part


@killed
@pytest.mark.slow
@pytest.mark.parametrize("kind", ["file", "folder"])
def test_what_a_killed_process_left_of_a_file_goes_with_the_next(tmp_path: Path, kind: str) -> None:
    target = tmp_path / "a[1].h5"
    left = _killed(target, kind)
    with whole_file(target) as file:
        assert not left.exists()
        file.write(b"whole")
    assert [path.name for path in tmp_path.iterdir()] == [target.name]


@killed
@pytest.mark.slow
def test_another_files_parts_stay(tmp_path: Path) -> None:
    left = _killed(tmp_path / "b.h5", "file")
    part_of(tmp_path / "a.h5")
    assert left.exists()


def test_parts_of_those_that_live_of_other_machines_and_strange_names_stay(tmp_path: Path) -> None:
    own = part_of(tmp_path / "a.h5")
    machine = own.name.split(".")[-2].rpartition("-")[0]
    names = [
        own.name,
        f".a.h5.{machine}-{os.getppid()}.part",
        ".a.h5.0badcafe-999999999.part",  # of another machine
        ".a.h5.joined.part",
        f".a.h5.{machine}-.part",
    ]
    for name in names:
        (tmp_path / name).touch()
    assert part_of(tmp_path / "a.h5") == own
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(names)
