"""The command does not begin where nothing could be found."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tactile_graph.cli.entry import main
from tactile_graph.pipeline.load import load_graph

GONE = "error: the current folder is gone: it was deleted, or made anew under the same name; "


def gone() -> str:
    raise FileNotFoundError(2, "No such file or directory")


def test_a_current_folder_that_is_gone_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(os, "getcwd", gone)
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    assert capsys.readouterr().err == f"{GONE}change into one that is there (cd)\n"


@pytest.mark.slow
def test_no_command_begins_there(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    folder.mkdir()
    code = "import os; os.rmdir(os.getcwd()); from tactile_graph.cli import main; main()"
    told = ["-I", "-c", code, "run", "contacts", "a.npy", "--workers", "2"]
    got = subprocess.run(
        [sys.executable, *told], cwd=folder, capture_output=True, text=True, check=False
    )
    assert got.returncode == 2
    assert got.stderr.startswith(GONE)
    assert "Traceback" not in got.stderr


def test_a_pipeline_loads_without_a_current_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "getcwd", gone)
    monkeypatch.setattr(Path, "cwd", gone)
    assert load_graph("circle-1").name == "circle-1"


@pytest.mark.slow
def test_a_thread_that_goes_on_is_named_before_it_is_waited_for() -> None:
    code = (
        "import sys, threading, time\n"
        "from tactile_graph.cli import app, entry\n"
        "def work(): time.sleep(1.0)\n"
        "app.cli.main = lambda: threading.Thread(target=work, name='pump').start()\n"
        "entry.WAIT_S = 0.1\n"
        "entry.main()\n"
    )
    got = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert got.returncode == 0
    assert got.stderr == "waiting for threads that go on: pump; Ctrl-C ends them\n"
