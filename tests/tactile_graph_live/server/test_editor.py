"""What file and page say is brought to the bench when it is right, and told when it is not."""

from __future__ import annotations

import asyncio
import os
import pickle
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("starlette", reason="the live extra is not installed")

import tactile_graph as tg
from tactile_graph.cli.watch import files_read, stamp
from tactile_graph.errors import PipelineError, UsageError
from tactile_graph_live.bench.wire import Swap, Swapped
from tactile_graph_live.commands.live import read_source
from tactile_graph_live.server import editor as module
from tactile_graph_live.server import yaml_settings
from tactile_graph_live.server.draft import Draft
from tactile_graph_live.server.editor import Edited, Editor
from tactile_graph_live.server.messages import Trouble
from tactile_graph_live.server.watching import FileSense

FLOW = """\
pipeline: mine
source: {step: sample, with: {name: discs}}
nodes:
  footprint: {step: threshold, in: frame, with: {level_v: 0.01}}
  boundary: {step: boundary_scan, in: footprint}
outputs: [boundary]
"""


ODD = FLOW.replace("{step: sample, with: {name: discs}}", "{step: simulate, with: {scene: odd-3}}")
"""Its source may be a plugin's own, whose scenes are no files: who runs it knows."""


class Desk:
    """An editor of a file, and a bench that answers as it is told to."""

    def __init__(self, path: Path, flow: str = FLOW) -> None:
        path.write_text(flow)
        self.path = path
        self.swaps: list[Swap] = []
        self.changes: list[Edited] = []
        self.troubles: list[Trouble] = []
        self.said: list[str] = []
        self.answer: Callable[[Swap], Swapped | None] = lambda swap: Swapped(swap.version)
        self.editor = Editor(
            Draft.of(tg.load(path)), 0, FileSense(stamp, files_read, read_source),
            swap=self._swap, changed=self.changes.append, wrong=self.troubles.append,
            say=self.said.append,
        )  # fmt: skip

    def _swap(self, swap: Swap) -> None:
        self.swaps.append(swap)
        answer = self.answer(swap)
        if answer is not None:
            asyncio.get_running_loop().call_soon(self.editor.swapped, answer)

    def save(self, text: str) -> None:
        beside = self.path.with_suffix(".new")
        beside.write_text(text)
        os.replace(beside, self.path)

    def level_v(self) -> Any:
        return self.editor.now.draft.pipeline.nodes["footprint"].settings["level_v"]

    def play(self, *work: Callable[[], Awaitable[None]]) -> None:
        async def all_of_it() -> None:
            for one in work:
                await one()

        asyncio.run(all_of_it())


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    return Desk(tmp_path / "mine.yaml")


def test_what_was_said_of_the_source_at_the_start_keeps_no_change_from_running(
    tmp_path: Path,
) -> None:
    desk = Desk(tmp_path / "f.yaml", ODD)
    desk.save("# another line\n" + ODD.replace("0.01", "0.02"))
    desk.play(desk.editor.reload)
    assert desk.level_v() == 0.02
    desk.save(ODD.replace("odd-3", "odd-4"))
    desk.play(desk.editor.reload)
    assert "odd-4" in desk.troubles[-1].errors[0].text


def test_a_file_of_the_source_that_is_saved_as_it_was_starts_nothing_anew(tmp_path: Path) -> None:
    scene = tmp_path / "ball.yaml"
    text = "objects: [{shape: disc, weight_g: 150, radius_cm: 0.8}]\n"
    scene.write_text(text)
    desk = Desk(tmp_path / "f.yaml", ODD.replace("odd-3", f"'{scene}'"))
    for saved, restart in ((text, False), (text.replace("150", "200"), True)):
        scene.unlink()
        scene.write_text(saved)
        desk.play(desk.editor.reload)
        assert (desk.troubles, desk.swaps[-1].restart) == ([], restart)


def test_a_file_that_is_right_runs_and_counts_up(desk: Desk) -> None:
    desk.save(FLOW.replace("0.01", "0.02"))
    desk.play(desk.editor.reload)
    (swap,), (edited,) = desk.swaps, desk.changes
    assert pickle.loads(swap.pickled).nodes["footprint"].settings["level_v"] == 0.02
    assert (swap.version, swap.restart, desk.editor.version) == (2, False, 2)
    assert edited.graph.took_ms > 0
    assert desk.troubles == []


def test_a_file_that_is_wrong_is_told_and_changes_nothing(desk: Desk) -> None:
    desk.save(FLOW.replace("threshold", "treshold"))
    desk.play(desk.editor.reload)
    ((fault,),) = [t.errors for t in desk.troubles]
    assert (fault.line, fault.column) == (4, 21)
    assert desk.swaps == desk.changes == []
    assert desk.editor.version == 1
    desk.save(FLOW)
    desk.play(desk.editor.reload)
    assert desk.troubles[-1].errors == ()
    assert desk.editor.trouble is None


def test_a_file_that_is_gone_and_a_setting_that_does_not_run_are_no_errors_of_the_file(
    desk: Desk,
) -> None:
    desk.path.unlink()
    desk.play(desk.editor.reload)
    assert desk.troubles[-1].title == "The file is gone."
    desk.save(FLOW)
    desk.play(desk.editor.reload)
    desk.answer = lambda swap: Swapped(swap.version, "takes 8 x 8 cells")
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    assert desk.troubles[-1].title == "What was set does not run."
    desk.save(FLOW.replace("threshold", "treshold"))
    desk.play(desk.editor.reload)
    assert desk.troubles[-1].title == ""


def test_a_file_that_is_wrong_stays_so_whatever_is_set_on_the_page(desk: Desk) -> None:
    desk.save(FLOW.replace("threshold", "treshold"))
    desk.play(desk.editor.reload)
    (wrong,) = desk.troubles[0].errors
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    assert desk.level_v() == 0.02
    assert desk.troubles[-1].errors == (wrong,)
    desk.answer = lambda swap: Swapped(swap.version, "takes 8 x 8 cells")
    desk.play(desk.editor.unset)
    assert [f.text for f in desk.troubles[-1].errors] == ["takes 8 x 8 cells", wrong.text]
    desk.answer = lambda swap: Swapped(swap.version)
    desk.play(desk.editor.unset)
    assert desk.troubles[-1].errors == (wrong,)
    assert desk.editor.trouble is not None
    desk.save(FLOW)
    desk.play(desk.editor.reload)
    assert desk.troubles[-1].errors == ()
    assert desk.editor.trouble is None


def test_what_the_bench_refuses_is_told_and_the_old_graph_stays(desk: Desk) -> None:
    desk.answer = lambda swap: Swapped(swap.version, "takes 8 x 8 cells")
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    assert desk.troubles[-1].errors[0].text == "takes 8 x 8 cells"
    assert desk.level_v() == 0.01


@pytest.mark.slow
def test_an_answer_to_an_older_change_is_not_taken_for_this_ones(desk: Desk) -> None:
    desk.answer = lambda swap: Swapped(swap.version - 1)

    async def change() -> None:
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(desk.editor.set("footprint", "level_v", 0.02), 0.3)

    desk.play(change)
    assert desk.changes == []


def test_one_that_takes_long_is_told_of_and_runs_when_it_is_ready(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where it took too long to wait for, what the bench runs in the end is still what is shown."""
    monkeypatch.setattr(module, "SLOW_S", 0.01)
    monkeypatch.setattr(module, "SWAP_S", 0.05)
    desk.answer = lambda swap: None
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    assert desk.said == ["the new graph is being made ready; until then the old one runs"]
    assert "not ready after 0.05 s" in desk.troubles[-1].errors[0].text
    assert desk.changes == []
    desk.editor.swapped(Swapped(desk.swaps[-1].version))
    assert desk.level_v() == 0.02
    assert [edited.graph.version for edited in desk.changes] == [2]
    assert desk.troubles[-1].errors == ()
    desk.editor.swapped(Swapped(desk.swaps[-1].version))
    assert len(desk.changes) == 1


def test_one_that_took_too_long_runs_though_another_was_refused_since(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "SLOW_S", 0.01)
    monkeypatch.setattr(module, "SWAP_S", 0.05)
    desk.answer = lambda swap: None
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    (late,) = desk.swaps
    desk.answer = lambda swap: Swapped(swap.version, "takes 8 x 8 cells")
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.03))
    desk.editor.swapped(Swapped(late.version))
    assert desk.level_v() == 0.02
    assert [edited.graph.version for edited in desk.changes] == [2]


def test_a_bench_that_dies_of_a_change_is_not_waited_for(desk: Desk) -> None:
    desk.answer = lambda swap: asyncio.get_running_loop().call_soon(desk.editor.bench_died)
    desk.play(lambda: desk.editor.set("footprint", "level_v", 0.02))
    assert "died of this change" in desk.troubles[-1].errors[0].text
    assert desk.level_v() == 0.01


def test_of_values_that_come_fast_the_newest_is_tried(desk: Desk) -> None:
    async def drag() -> None:
        values = [0.01 * n for n in range(2, 40)]
        await asyncio.gather(*(desk.editor.set("footprint", "level_v", v) for v in values))

    desk.play(drag)
    assert desk.level_v() == pytest.approx(0.39)
    assert len(desk.swaps) < 5


def test_a_value_that_is_not_allowed_is_raised_to_who_asked(desk: Desk) -> None:
    async def change() -> None:
        with pytest.raises(PipelineError, match="level_v"):
            await desk.editor.set("footprint", "level_v", "high")

    desk.play(change)
    assert desk.swaps == []


def test_a_value_that_cannot_be_written_into_the_file_runs_nowhere(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(yaml_settings, "_with_one", lambda text, *_: f"{text}}}")

    async def change() -> None:
        with pytest.raises(UsageError, match=r"footprint\.level_v: cannot be written"):
            await desk.editor.set("footprint", "level_v", 0.02)

    desk.play(change)
    assert desk.swaps == []


def test_settings_are_taken_back_one_or_all(desk: Desk) -> None:
    desk.play(
        lambda: desk.editor.set("footprint", "level_v", 0.02),
        lambda: desk.editor.set("footprint", "above", True),
        lambda: desk.editor.unset("footprint", "level_v"),
    )
    assert desk.level_v() == 0.01
    assert "above: true" in desk.changes[-1].graph.yaml
    desk.play(desk.editor.unset)
    assert desk.changes[-1].graph.yaml == desk.changes[-1].graph.file_yaml == FLOW


def test_another_source_starts_anew_and_what_began_anew_is_told(desk: Desk) -> None:
    desk.answer = lambda swap: Swapped(swap.version, anew=("tracks",))
    desk.save(FLOW.replace("sample, with: {name: discs}", "simulate"))
    desk.play(desk.editor.reload)
    assert desk.swaps[-1].restart
    assert desk.changes[-1].graph.anew == ("tracks",)


USED = """\
pipeline: used
nodes: {footprint: {step: threshold, in: frame, with: {level_v: 0.03}}}
outputs: [footprint]
"""
USES = FLOW.replace("{step: threshold, in: frame, with: {level_v: 0.01}}", "{use: used.yaml}")


@pytest.mark.slow
def test_a_used_file_that_is_gone_is_told_and_so_are_its_return_and_other_mistakes(
    desk: Desk,
) -> None:
    used = desk.path.with_name("used.yaml")

    async def seen(n: int) -> None:
        end = asyncio.get_running_loop().time() + 10
        while len(desk.troubles) < n and asyncio.get_running_loop().time() < end:
            await asyncio.sleep(0.01)
        assert len(desk.troubles) == n

    async def work() -> None:
        watching = asyncio.create_task(desk.editor.watch())
        desk.save(USES)
        await seen(1)  # it is not there yet
        used.write_text(USED)
        await seen(2)
        used.unlink()
        await seen(3)
        desk.save(USES.replace("use:", "usee:"))
        await seen(4)
        watching.cancel()

    desk.play(work)
    texts = [" ".join(fault.text for fault in trouble.errors) for trouble in desk.troubles]
    assert "no pipeline file 'used.yaml'" in texts[0]
    assert texts[1] == ""
    assert "no pipeline file 'used.yaml'" in texts[2]
    assert "unknown key 'usee'" in texts[3]


@pytest.fixture
def played(tmp_path: Path) -> Desk:
    """Return the desk of a file whose source reads a scene and a pad."""
    source = f"{{scene: {tmp_path / 'scene.yaml'}, pad: {tmp_path / 'pad.yaml'}, frames: 9}}"
    (tmp_path / "scene.yaml").write_text("about: nothing on it\n")
    (tmp_path / "pad.yaml").write_text("about: as it comes\n")
    flow = FLOW.replace("sample, with: {name: discs}", f"simulate, with: {source}")
    return Desk(tmp_path / "mine.yaml", flow)


@pytest.mark.parametrize("name", ["scene.yaml", "pad.yaml"])
def test_what_the_source_reads_is_watched_and_starts_it_anew(played: Desk, name: str) -> None:
    file = played.path.with_name(name)
    played.save(played.path.read_text().replace("0.01", "0.02"))
    played.play(played.editor.reload)
    assert not played.swaps[-1].restart
    file.write_text("about: another\n")
    assert played.editor._watched.changed()
    played.play(played.editor.reload)
    assert played.swaps[-1].restart
    played.play(played.editor.reload, lambda: played.editor.set("footprint", "level_v", 0.05))
    assert [swap.restart for swap in played.swaps[-2:]] == [False, False]


def test_what_is_wrong_with_a_scene_is_told_until_it_is_right(played: Desk) -> None:
    scene = played.path.with_name("scene.yaml")
    scene.write_text("about: [nonsense")
    played.play(played.editor.reload)
    (fault,) = played.troubles[-1].errors
    assert "scene.yaml:1:17: this is not YAML" in fault.text
    assert played.swaps == []
    scene.write_text("about: nothing again\n")
    played.play(played.editor.reload)
    assert played.troubles[-1].errors == ()
    assert played.swaps[-1].restart


def test_a_save_is_seen_by_itself(desk: Desk) -> None:
    async def saved() -> None:
        watching = asyncio.create_task(desk.editor.watch())
        desk.save(FLOW.replace("0.01", "0.05"))
        end = asyncio.get_running_loop().time() + 10
        while not desk.changes and asyncio.get_running_loop().time() < end:
            await asyncio.sleep(0.01)
        watching.cancel()

    desk.play(saved)
    assert desk.level_v() == 0.05
