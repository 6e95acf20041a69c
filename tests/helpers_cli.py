"""A hand-made plugin with small steps, and pipelines of them, for the command line's tests."""

from __future__ import annotations

import types
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from annotated_types import Ge, Gt
from click.testing import CliRunner, Result

from tactile_graph import Circle, Degenerate, Ellipse, Frame, Image, Mask, Rectangle, hookimpl
from tactile_graph.steps import Grid, Quantity, Report
from tactile_graph.wires import TrueObject


def made(
    *,
    frames: Annotated[int, Ge(0)] = 4,
    empty: tuple[int, ...] = (),
    rng: np.random.Generator,
    report: Report,
) -> Iterator[Frame]:
    """Frames of a disc that moves to the right, with their truth.

    Parameters
    ----------
    frames : int
        How many.
    empty : tuple of int
        Frames in which nothing lies on the pad.
    """  # fmt: skip
    report.expect(frames)
    for i in range(frames):
        values = np.zeros((4, 6))
        if i not in empty:
            values[1:3, i % 5 : i % 5 + 2] = 1.0 + 0.01 * rng.random()
        truth = () if i in empty else (
            TrueObject(Rectangle(0.0, 0.0, 1.0, 1.0, 0.0)), TrueObject(Circle(9.0, 9.0, 1.0)),
            TrueObject(Circle(i % 5 + 1.0, 2.0, 1.0), name="disc"))  # fmt: skip
        yield Frame.of(values, 1.0, quantity="volt", index=i, time_s=0.1 * i, truth=truth)


def recording(*, path: Path | list[Path], report: Report) -> Iterator[Frame]:
    """Frames of ``.txt`` files, a number a line; words are troubles."""
    paths = path if isinstance(path, list) else [path]
    n = 0
    for one in paths:
        report.digest(str(one), "d1")
        for i, line in enumerate(Path(one).read_text().splitlines(), 1):
            if not line.replace(".", "").isdigit():
                report.trouble(f"{one}:{i}", f"not a number: {line!r}")
                continue
            label = Path(one).name
            yield Frame.of(np.full((2, 2), float(line)), quantity="volt", index=n, label=label)
            n += 1


def broken_source(*, after: int = 2) -> Iterator[Frame]:
    """Frames, and then an error."""
    for i in range(after):
        yield Frame.of(np.ones((2, 2)), quantity="volt", index=i)
    raise RuntimeError("the cable is off")


def pressed(
    image: Annotated[Image, Quantity("volt")], *, level_v: Annotated[float, Gt(0)] = 0.5
) -> Annotated[Mask, Grid.like("image")]:
    """Return the cells that are pressed.

    Parameters
    ----------
    image : Image
        In volts.
    level_v : float
        From where on a cell is on.
    """
    return image.mask(image.values >= level_v)


def disc(mask: Mask, *, fail_at_x: float = -1.0, crash: bool = False) -> Circle:
    """Return the circle of the mask's area about its centre."""
    rows, columns = np.nonzero(mask.values)
    if crash:
        raise ZeroDivisionError("divided by nothing")
    if columns.size == 0 or columns.min() == fail_at_x:
        raise Degenerate(f"no circle about {columns.size} cells")
    x, y = float(mask.x_cm[columns].mean()), float(mask.y_cm[rows].mean())
    return Circle(x, y, float(np.sqrt(mask.area_cm2 / np.pi)))


class Load(NamedTuple):
    """A load and where it lies."""

    total: float
    x_cm: float | None
    parts: list[int]


def load(image: Image) -> Load:
    """Return the load."""
    return Load(image.total, 1.0 if image.total else None, [1, 2])


def either(mask: Mask, *, kind: Literal["circle", "ellipse"] = "circle") -> Circle | Ellipse:
    """Return one of two shapes."""
    return Circle(1.0, 1.0, 1.0) if kind == "circle" else Ellipse(1.0, 1.0, 2.0, 1.0, 0.0)


def merge(masks: list[Mask]) -> Mask:
    """Return the cells on in any."""
    return masks[0].with_values(np.logical_or.reduce([m.values for m in masks]))


def not_finite(image: Image) -> float:
    """Return a number that is none."""
    return float("nan")


STEPS: dict[str, Any] = {
    f.__name__: f
    for f in (made, recording, broken_source, pressed, disc, load, either, merge, not_finite)
}

DISCS = """\
pipeline: discs
about: A disc on hand-made frames
source: {step: made, with: {frames: 4}}
nodes:
  footprint: {step: pressed, in: frame, with: {level_v: 0.5}}
  circle: {step: disc, in: footprint, when: footprint.count > 0}
outputs: [circle]
"""
LOADS = """\
pipeline: loads
about: Load
evolves: discs
nodes:
  load: {step: load, in: frame}
  footprint: {step: pressed, in: frame}
  shape: {step: either, in: footprint}
  spare: {step: merge, in: [footprint]}
outputs: [load, shape]
"""


def plugin(folder: Path, **more: Any) -> Callable[[], types.ModuleType]:
    """Return a loader of the plugin; its pipelines are written into the folder."""
    paths = {}
    for name, text in (("discs", DISCS), ("loads", LOADS)):
        paths[name] = folder / f"{name}.yaml"
        paths[name].write_text(text)
    module = types.ModuleType("hand_made")

    @hookimpl
    def tactile_graph_steps() -> Mapping[str, Any]:
        return {**STEPS, **more.get("steps", {})}

    @hookimpl
    def tactile_graph_pipelines() -> Mapping[str, Path]:
        return {**paths, **more.get("pipelines", {})}

    @hookimpl
    def tactile_graph_commands() -> Mapping[str, str]:
        return dict(more.get("commands", {}))

    @hookimpl
    def tactile_graph_readers() -> Mapping[str, str]:
        return dict(more.get("readers", {"recording": "path"}))

    hooks = (
        tactile_graph_steps,
        tactile_graph_readers,
        tactile_graph_pipelines,
        tactile_graph_commands,
    )
    for hook in hooks:
        setattr(module, hook.__name__, hook)
    return lambda: module


def broken_plugin() -> types.ModuleType:
    """Fail as a plugin with a missing dependency does."""
    raise ImportError("No module named 'antigravity'")


class _Installed(dict[str, str]):
    """Something that has the installed plugins looked for anew whenever it changes."""

    def __setitem__(self, name: str, value: str) -> None:
        super().__setitem__(name, value)
        self._look_anew()

    def __delitem__(self, name: str) -> None:
        super().__delitem__(name)
        self._look_anew()

    def _look_anew(self) -> None:
        from tactile_graph.plugins import registry

        registry.installed.cache_clear()


def install(
    monkeypatch: Any, folder: Path, *others: tuple[str, str, str, Any], **more: Any
) -> None:
    """Make the hand-made plugin the only one beside the core, with others after it."""
    from tactile_graph.plugins import registry

    monkeypatch.setitem(_Installed(), "plugins", "hand-made")  # first, so undone last
    rows = [
        (registry.CORE, "tactile-graph", "", registry.core),
        ("hand", "hand-made", "1.2", plugin(folder, **more)),
        *others,
    ]
    monkeypatch.setattr(registry, "found_plugins", lambda: rows)
    monkeypatch.setattr(registry, "_override", None)
    monkeypatch.delenv(registry.ENVIRONMENT, raising=False)
    registry.installed.cache_clear()


def call(*args: object) -> Result:
    """Run a command line in this process."""
    from tactile_graph.cli import cli

    return CliRunner(env={"COLUMNS": "160"}).invoke(cli, [str(a) for a in args])


class Counting:
    """How many frames it ran on."""

    def __init__(self) -> None:
        self.n = 0

    def __call__(self, image: Image) -> int:
        self.n += 1
        return self.n
