"""What steps change of their process stays with them, and a copy that one forks ends with it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from helpers_cli import call, install
from helpers_graphs import frame, registry
from tactile_graph import Image, loads
from tactile_graph.plugins.registry import installed

TEXT = "{{pipeline: p, nodes: {{a: {{step: {}, in: frame}}}}, outputs: [a]}}"


class Wanders:
    """Goes to another folder once, and looks for its file there."""

    def __init__(self) -> None:
        os.chdir(Path(__file__).parent)

    def __call__(self, image: Image) -> str:
        return str(Path(Path(__file__).name).exists())


def wanders_each_time(image: Image) -> float:
    os.chdir("/")
    return image.peak


def strict(image: Image) -> float:
    np.seterr(all="raise")
    return image.peak


@pytest.mark.parametrize(("step", "told"), [(Wanders, "True"), (wanders_each_time, "1.0")])
def test_recordings_and_output_are_found_where_the_command_began(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: object, told: str
) -> None:
    install(monkeypatch, tmp_path, steps={"wanders": step})
    monkeypatch.chdir(tmp_path)
    for name in ("one.txt", "two.txt"):  # the second is opened when the steps have gone away
        Path(name).write_text("1\n2\n")
    Path("p.yaml").write_text(TEXT.format("wanders"))
    for options in ((), ("--frames", "4")):
        got = call("run", "p.yaml", "one.txt", "two.txt", "-o", "out.csv", *options)
        assert (got.exit_code, Path.cwd()) == (0, tmp_path), got.output
        lines = Path("out.csv").read_text().splitlines()
        assert len(lines) == 5
        assert lines[1].endswith(told)
    installed.cache_clear()


@pytest.mark.skipif(np.__version__ < "2", reason="asking NumPy 1 takes too long")
def test_numpy_raises_for_others_only_within_the_frame_of_a_step_that_has_it_raise() -> None:
    runner = loads(TEXT.format("strict"), "p.yaml", registry({"strict": strict})).runner()
    with np.errstate(all="warn"):
        assert runner(frame(1))["a"] == 1.0
        assert np.geterr()["divide"] == "warn"


FORKS = """
import os, sys
from pathlib import Path
from tactile_graph import Frame, Image, loads
sys.path.insert(0, sys.argv[1])
from helpers_graphs import frame, registry

def forks(image: Image, *, how: str = "") -> int:
    copy = os.fork()
    if not copy and how == "exits":
        sys.exit(3)
    if not copy and how == "raises":
        raise ValueError
    return os.waitstatus_to_exitcode(os.waitpid(copy, 0)[1]) if copy else 7

text = "{{pipeline: p, nodes: {{a: {{step: forks, in: frame, with: {{how: {}}}}}}}, outputs: [a]}}"
for how in ("exits", "raises", "returns"):
    runner = loads(text.format(how), "p.yaml", registry({"forks": forks})).runner()
    print(how, runner(frame(1))["a"], flush=True)
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_the_copy_that_a_step_forks_does_none_of_the_others_work() -> None:
    helpers = str(Path(__file__).parents[3])
    got = subprocess.run(
        [sys.executable, "-c", FORKS, helpers], capture_output=True, text=True, check=False
    )
    assert got.stdout.splitlines() == ["exits 3", "raises 0", "returns 0"], got.stderr
