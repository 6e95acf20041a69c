"""What lies in the current folder is data: no process that a command begins runs a file there."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow
HOSTILE = "open({told!r}, 'a').write('ran')\nraise SystemExit(3)\n"
NAMES = ("pickle", "struct", "socket", "numba", "tactile_graph")
PIPELINE = """\
pipeline: mine
source: {step: simulate, with: {scene: discs, frames: 20}}
nodes:
  foot: {step: threshold, in: frame, with: {level: 10}, isolated: true}
outputs: [foot]
"""
STARTED = "from tactile_graph.cli import main\nif __name__ == '__main__':\n    main()\n"
STEPS = """\
import os, subprocess, sys
from tactile_graph import Image

def first(image: Image) -> int:
    return int(image.values[0, 0])

def beside(_=None):
    # A script that a step begins sees what lies beside it, too.
    script = os.path.join(os.path.dirname(__file__), "sibling.py")
    return subprocess.run([sys.executable, script], check=True, capture_output=True).stdout
"""
SCRIPT = """\
import os
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
import numpy as np
import own_steps
from tactile_graph import Frame, Image, load, loads
from tactile_graph.live import Beside
from tactile_graph.many.processes import opened

def main():
    text = "pipeline: p\\nnodes: {a: {step: own, in: frame, isolated: true}}\\noutputs: [a]"
    runner = loads(text, "p.yaml", steps={"own": own_steps.first}).runner()
    print(runner(Frame(Image(np.full((2, 2), 42.0)), 0))["a"])
    discs = load("circle-1")
    beside, result = Beside(discs), next(iter(discs.stream()))
    while not (beside.summary()["frames"] or beside.trouble):
        beside.offer(result, 1.0)
        time.sleep(0.05)
    print(beside.trouble or "beside")
    beside.close()
    workers = opened("", 1)
    print(workers.executor.submit(own_steps.beside).result(60).decode())
    kind = "forkserver" if os.name == "posix" else "spawn"
    with ProcessPoolExecutor(1, get_context(kind)) as own:
        print(own.submit(own_steps.beside).result(60).decode())
    workers.end()

if __name__ == "__main__":
    main()
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    found = tmp_path / "unpacked"
    found.mkdir()
    for name in NAMES:
        (found / f"{name}.py").write_text(HOSTILE.format(told=str(tmp_path / "told")))
    (found / "mine.yaml").write_text(PIPELINE)
    (tmp_path / "start.py").write_text(STARTED)
    return found


def started(folder: Path, *words: str) -> subprocess.Popen[str]:
    command = [sys.executable, str(folder.parent / "start.py"), *words]
    return subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip


@pytest.mark.parametrize(
    "words",
    [
        "run mine.yaml --frames 2",
        "run mine.yaml --workers 2 -o x.jsonl",
        "prepare mine.yaml mine.yaml --jobs 2",
    ],
)
def test_no_file_beside_a_pipeline_runs(folder: Path, words: str) -> None:
    process = started(folder, *words.split())
    out, _ = process.communicate(timeout=120)
    assert process.returncode == 0, out
    assert not (folder.parent / "told").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="SIGINT")
def test_nor_does_one_beside_what_live_shows(folder: Path) -> None:
    process = started(folder, "live", "mine.yaml", "--http-port", "0")
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        assert " http" in line, line + process.stdout.read()
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
    assert not (folder.parent / "told").exists()


def test_modules_beside_a_script_of_ones_own_are_found_by_all_its_processes(
    folder: Path,
) -> None:
    own = folder.parent
    (own / "own_steps.py").write_text(STEPS)
    (own / "sibling.py").write_text("import own_steps\nprint('sibling')\n")
    (own / "start.py").write_text(SCRIPT)
    process = started(folder)
    out, _ = process.communicate(timeout=120)
    assert out.split() == ["42", "beside", "sibling", "sibling"], out
    assert not (own / "told").exists()
