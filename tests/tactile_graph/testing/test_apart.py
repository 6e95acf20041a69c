"""Steps that end their process, or never return, are told; no other step's trial is lost."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tactile_graph.cli.plugin_check import show_checked
from tactile_graph.plugins import registry
from tactile_graph.testing import apart, examine_step
from tactile_graph.testing.apart import Apart

pytestmark = pytest.mark.slow
PLUGIN = """
import os
import time

from tactile_graph import Mask, hookimpl


def ends(mask: Mask) -> int:
    if not mask.count:
        os._exit(3)
    return mask.count


def never_returns(mask: Mask) -> int:
    while not mask.count:
        try:
            time.sleep(0.01)
        except BaseException:  # what stops it too
            continue
    return mask.count


def good(mask: Mask) -> int:
    print("a line for each case", flush=True)
    return mask.count


def forks(mask: Mask) -> int:
    if not (copy := os.fork()):
        raise SystemExit
    os.waitpid(copy, 0)
    return mask.count


@hookimpl
def tactile_graph_steps():
    return {"ends": ends, "never_returns": never_returns, "good": good, "forks": forks}


@hookimpl
def tactile_graph_isolated():
    return {"ends": 0.5}
"""


@pytest.fixture
def found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[registry.Registry]:
    about = tmp_path / "rough-0.1.dist-info"
    about.mkdir()
    (tmp_path / "rough.py").write_text(PLUGIN)
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: rough\nVersion: 0.1\n")
    (about / "entry_points.txt").write_text("[tactile_graph]\nrough = rough\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(registry, "_override", "rough")
    registry.installed.cache_clear()
    yield registry.installed()
    registry.installed.cache_clear()


def test_a_step_that_ends_its_process_or_never_returns_costs_its_own_trial(
    found: registry.Registry, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(apart, "GRACE_S", 0.0)
    monkeypatch.setattr(apart, "IDLE", 0.4)
    start_s = time.monotonic()
    assert not show_checked(found, ["rough"])
    assert time.monotonic() - start_s < 60.0
    case = "an image without cells"
    assert capsys.readouterr().out.splitlines() == [
        "rough (rough 0.1): 2 broken",
        f"  step 'ends': {case}: ended its process with code 3",
        f"  step 'never_returns': {case}: was stopped, since it had not ended after 2 s",
    ]


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
def test_the_copy_of_a_step_that_forks_answers_for_no_step(found: registry.Registry) -> None:
    trier = Apart(found)
    reports = [trier.examine(name) for name in ("forks", "good", "forks", "good")]
    trier.close()
    assert [r.step for r in reports] == ["forks", "good", "forks", "good"]
    assert not [line for r in reports for line in r.lines()]


def test_what_a_step_prints_in_its_trials_is_not_shown(
    found: registry.Registry, capfd: pytest.CaptureFixture[str]
) -> None:
    trier = Apart(found)
    assert not trier.examine("good").lines()
    trier.close()
    assert "a line for each case" not in "".join(capfd.readouterr())


def test_a_trial_that_is_interrupted_answers_for_no_other_step(
    found: registry.Registry, monkeypatch: pytest.MonkeyPatch
) -> None:
    def comes(**_: object) -> None:
        raise KeyboardInterrupt

    trier = Apart(found)
    trier.examine("good")
    with monkeypatch.context() as patch:
        assert trier._process is not None
        patch.setattr(trier._process.messages, "get", comes)
        with pytest.raises(KeyboardInterrupt):
            trier.examine("forks")
    assert trier.examine("good").step == "good"
    trier.close()


def test_a_step_that_its_plugin_has_run_apart_is_examined_apart(found: registry.Registry) -> None:
    told = "step 'ends': an image without cells: ended its process with code 3"
    for step in ("ends", "rough.ends", found.load("steps", "ends")):
        assert str(examine_step(step)) == told


def test_steps_of_a_registry_that_is_not_what_is_installed_are_tried_here(
    found: registry.Registry,
) -> None:
    rows = [("mine", "my-package", "1", lambda: __import__("rough"))]
    trier = Apart(registry.Registry(rows))
    assert trier.examine("good").n_values > 15
    assert trier._process is None
