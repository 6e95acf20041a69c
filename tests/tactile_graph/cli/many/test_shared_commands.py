"""Commands that share their work: Ctrl-C ends every process and says what is kept; workers that are
killed cost nothing."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import pytest

from helpers_many import command

sys.path.insert(0, str(Path(__file__).parents[4] / "benchmarks" / "attacks"))
from workers import left_of, workers

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="looks at /proc, sends POSIX's signals"),
]
DISCS = ("--source", "simulate", "--with", "scene=discs")
ENDLESS = (*DISCS, "--frames", "1000000")
BEGUN_S = 120.0
AT_WORK_S = 0.5


def begun(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Return a command with two workers, in a session of its own, once one is at work."""
    running = subprocess.Popen(
        command(*words, "--workers", "2"), cwd=folder, text=True, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    until = time.monotonic() + BEGUN_S
    while running.poll() is None and not any(map(worked, workers(running.pid))):
        assert time.monotonic() < until, "no worker is at work"
        time.sleep(0.05)
    assert running.poll() is None, running.communicate()[0]
    return running


def worked(process: int) -> bool:
    """Return whether a worker has had processor time for more than to get ready."""
    with suppress(FileNotFoundError):
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
        return sum(map(int, fields[11:13])) >= AT_WORK_S * os.sysconf("SC_CLK_TCK")
    return False


@pytest.mark.parametrize("whole_group", [True, False], ids=["the terminal's", "the command's own"])
@pytest.mark.parametrize(
    ("words", "kept"),
    [
        (("compare", "circle-1", "circle-3", *ENDLESS), r"interrupted( after \d+ frames)?"),
        (("audit", "circle-3", *ENDLESS), "interrupted"),
        (("learn", "stone", *ENDLESS), "nothing was learned: all readings are, or none"),
        (("tune", "adaptive", *DISCS, "--frames", "2000"), "nothing was chosen, and nothing writt"),
        (("reproduce", "all", "--quick", "-o", "book"), r"\d+ of \d+ items are in book"),
    ],
    ids=["compare", "audit", "learn", "tune", "reproduce"],
)
def test_ctrl_c_ends_every_process_and_says_what_is_kept(
    tmp_path: Path, words: tuple[str, ...], kept: str, whole_group: bool
) -> None:
    running = begun(tmp_path, *words)
    (os.killpg if whole_group else os.kill)(running.pid, signal.SIGINT)
    said, _ = running.communicate(timeout=60)
    assert running.returncode == 130, said
    assert re.search(kept, said), said
    assert "interrupted" in said
    assert "Traceback" not in said
    assert left_of(running.pid) == []
    assert not (tmp_path / "tactile-objects.sqlite").exists()


def killed_once(folder: Path, *words: str) -> str:
    """Return what a command says of which one worker is killed."""
    running = begun(folder, *words)
    os.kill(next(filter(worked, workers(running.pid))), signal.SIGKILL)
    said, _ = running.communicate(timeout=300)
    assert running.returncode == 0, said
    assert "left out" not in said
    assert left_of(running.pid) == []
    return said


def test_a_comparison_loses_nothing_with_a_worker(tmp_path: Path) -> None:
    words = ("compare", "circle-1", "circle-3", *DISCS, "--frames", "8000")
    killed_once(tmp_path, *words, "--csv", "killed.csv", "--json", "killed.json")
    data = json.loads((tmp_path / "killed.json").read_text())
    assert (data["complete"], data["frames"]["n"]) == (True, 8000)


def test_an_audit_loses_nothing_with_a_worker(tmp_path: Path) -> None:
    words = ("audit", "circle-3", *DISCS, "--frames", "2500", "--sample", "1")
    killed_once(tmp_path, *words, "--json", "killed.json")
    data = json.loads((tmp_path / "killed.json").read_text())
    assert (data["frames"], data["frames_seen"]) == (2500, 2500)


def test_all_readings_are_learned_without_a_worker(tmp_path: Path) -> None:
    said = killed_once(tmp_path, "learn", "stone", *DISCS, "--frames", "1000")
    assert "1000 readings learned" in said


def test_guards_are_tuned_without_a_worker(tmp_path: Path) -> None:
    said = killed_once(tmp_path, "tune", "adaptive", *DISCS, "--frames", "100", "--rounds", "1")
    assert "50 frames; all numbers are of 50 other frames" in said


def test_items_are_made_again_without_a_worker(tmp_path: Path) -> None:
    items = ("figure-4.2", "erased-discs", "figure-2.8", "figure-4.4")
    killed_once(tmp_path, "reproduce", *items, "--quick", "-o", "book")
    assert len([*(tmp_path / "book").glob("*.csv")]) >= len(items)
