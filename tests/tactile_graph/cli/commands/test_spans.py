"""``run --frames A:B``: some of the frames come to the same in stacks as one after the other."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from helpers_cli import call
from tactile_graph import Degenerate, Frame, Image, Mask, Pipeline, hookimpl
from tactile_graph.engine.blocks import gathering
from tactile_graph.plugins import registry
from tactile_graph.wires.frame_stack import FrameStack


class Counting:
    """The frames that it ran on, in a list as long as their number, and the cells they had on."""

    def __init__(self) -> None:
        self.n = 0

    def __call__(self, mask: Mask) -> list[int]:
        self.n += 1
        if self.n % 5 == 0:
            raise Degenerate(f"five more, {self.n}")
        return [self.n] * (mask.count % 3)


def drawn(mask: Mask, *, rng: np.random.Generator) -> float:
    """A random number of the frame's own."""
    if mask.count % 4 == 3:
        raise ZeroDivisionError(f"{mask.count} cells")
    return float(rng.random())


def sent(*, n: int = 40) -> Iterator[Frame]:
    """Frames of a source that gives one after the other, of two sensors."""
    for i, values in enumerate(film(n)):
        image = Image(values, (1.0, 1.0), (0.0, 0.0), "volt")
        yield Frame(image, i, 0.1 * i, label=("", "other")[i % 7 == 6])


def sent_stacked(*, n: int = 40) -> Iterator[Frame | FrameStack]:
    """The same frames, in stacks where they are of one sensor."""
    frames = [*sent(n=n)]
    for start in range(0, n, 7):
        yield FrameStack.of(frames[start : start + 6])
        yield from frames[start + 6 : start + 7]


sent.stacked = sent_stacked  # type: ignore[attr-defined]

VOLT = ("--with", "quantity=volt", "--with", "pitch_cm=1")
FOOTPRINT = "  footprint: {step: threshold, in: frame, with: {level_v: 0.5}}\n"
DRAWN = "  drawn: {step: drawn, in: footprint}\n"
COUNTED = "  counted: {step: counting, in: footprint}\n"
PIPELINES = {
    "stateless": f"nodes:\n{FOOTPRINT}{DRAWN}outputs: [footprint, drawn]\n",
    "stateful": f"nodes:\n{FOOTPRINT}{DRAWN}{COUNTED}outputs: [drawn, counted]\n",
}


def film(n: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Return frames of some cells each, among them empty ones and such as come again."""
    values = 1.0 * (np.random.default_rng(3).random((n, 5, 6)) < 0.4)
    values[4::9] = 0.0
    values[12:14] = values[11]
    return values


@pytest.fixture(autouse=True)
def steps(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    plugin = ModuleType("own")
    given = {"counting": Counting, "drawn": drawn, "sent": sent}
    vars(plugin)["tactile_graph_steps"] = hookimpl(function_of(given))
    rows = [*registry.found_plugins(), ("own", "given", "", lambda: plugin)]
    monkeypatch.setattr(registry, "found_plugins", lambda: rows)
    registry.installed.cache_clear()
    monkeypatch.setattr("tactile_graph.compiled.warm_up", lambda: None)
    monkeypatch.chdir(tmp_path)
    for name, text in PIPELINES.items():
        Path(f"{name}.yaml").write_text(f"pipeline: {name}\n{text}")
    np.save("film.npy", film(40))
    rows_told = [",".join(map(str, values.ravel())) for values in film(40)]
    rows_told[8] = "1.0,what"
    cells = ",".join(f"r{r}c{c}" for r in range(5) for c in range(6))
    Path("film.csv").write_text("\n".join([cells, *rows_told]) + "\n")
    yield
    registry.installed.cache_clear()


def function_of(steps: dict[str, Any]) -> Callable[[], dict[str, Any]]:
    def tactile_graph_steps() -> dict[str, Any]:
        return steps

    return tactile_graph_steps


def written(pipeline: str, source: tuple[str, ...], name: str, *more: str) -> tuple[str, str, Any]:
    """Return what a run writes, what it says, and what it notes about its source."""
    asked = (f"{pipeline}.yaml", *source, "--seed", "5", "-o", name, *more)
    got = call("run", *asked)
    assert got.exit_code in (0, 1), got.output
    said = re.sub(r" in [^:]*", "", got.stderr)
    note = json.loads(Path(f"{name}.meta.json").read_text())
    return Path(name).read_text(), said, (note["source"], note["result"])


@pytest.mark.slow
@pytest.mark.parametrize("pipeline", PIPELINES)
@pytest.mark.parametrize("span", ["3:17", "14", "9:"])
@pytest.mark.parametrize(
    "source",
    [("film.npy", *VOLT), ("film.csv", *VOLT), ("--source", "sent")],
    ids=["that can seek", "that cannot", "that sends"],
)
def test_a_part_comes_to_the_same_in_stacks(
    pipeline: str, source: tuple[str, ...], span: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name, *more in (("out.jsonl", "--full"), ("out.csv",), ("out.csv", "--long")):
        asked = (pipeline, source, name, "--frames", span, *more)
        expected = written(*asked)
        with monkeypatch.context() as patched:
            patched.setattr(gathering, "WORTH_BLOCKS", 1)
            patched.delattr(Pipeline, "frames")  # nothing is read but in stacks
            assert written(*asked) == expected


@pytest.mark.slow
def test_of_frames_in_stacks_only_those_asked_for_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gathering, "WORTH_BLOCKS", 1)
    monkeypatch.delattr(Pipeline, "frames")
    *_, (source, _) = written("stateful", ("film.npy", *VOLT), "out.csv", "--frames", "3:17")
    assert source["counts"]["frames"] == 17


@pytest.mark.slow
def test_frames_before_a_part_lead_the_state_in_stacks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gathering, "WORTH_BLOCKS", 1)
    monkeypatch.delattr(Pipeline, "frames")
    asked = "stateful", ("film.npy", *VOLT), "out.jsonl", "--full"
    whole, _, _ = written(*asked)
    part, said, _ = written(*asked, "--frames", "13:27")
    assert "frames before 13 are run first" in said
    assert part.splitlines() == whole.splitlines()[13:27]
