"""``Pipeline``: a graph that runs, draws and varies itself; ``load`` and ``loads`` make one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tactile_graph.api.arguments import (
    checked_names,
    checked_seed,
    checked_settings,
    checked_step,
    checked_text,
)
from tactile_graph.errors import PipelineError, Problem, UsageError, one_of, shown
from tactile_graph.pipeline.files_read import FilesRead
from tactile_graph.pipeline.graph import FRAME, Graph
from tactile_graph.pipeline.load import load_graph, parse_again, parse_graph, resolve_again
from tactile_graph.pipeline.resolution.resolve import SourceOverride
from tactile_graph.pipeline.resolution.scope import Overrides
from tactile_graph.plugins.registry import Registry, installed, installed_and
from tactile_graph.steps.injected import Report
from tactile_graph.wires.frame import Frame
from tactile_graph.wires.given import as_frame, as_frames

if TYPE_CHECKING:
    import networkx
    import numpy as np
    from numpy.typing import NDArray
    from rich.console import RenderableType

    from tactile_graph.api.result import Result
    from tactile_graph.api.results import Results
    from tactile_graph.engine.blocks.block import Block
    from tactile_graph.engine.deadlines.options import Decider
    from tactile_graph.engine.outcomes.promises import Promises
    from tactile_graph.engine.runner import Runner
    from tactile_graph.live.live_stream import LiveStream
    from tactile_graph.wires.frame_stack import FrameStack
    from tactile_graph.wires.image import Image

Steps = Mapping[str, Callable[..., Any]]
_Asked = tuple[tuple[str, ...], int]
MOST_KEPT = 16
"""Of how many demands, names asked for and seed, a pipeline keeps runners for `Pipeline.run`."""


def load(
    name: str | Path, registry: Registry | None = None, *, steps: Steps | None = None
) -> Pipeline:
    """Return the pipeline of that name or in that file.

    Parameters
    ----------
    name : str or Path
        A name some plugin offers, or a path ending in ``.yaml`` or ``.yml``.
    registry : Registry, optional
        Where steps and names are looked up; the installed plugins if not given.
    steps : mapping of str to callable, optional
        Steps of a script or notebook by the names that the file has for them, beside those of the
        installed plugins; not with ``registry``.

    Raises
    ------
    PipelineError
        With every problem of the file.
    UsageError
        If there is no such pipeline or file, both ``registry`` and ``steps`` are given, or steps
        are no mapping of names to functions.
    """
    return Pipeline.of(load_graph(name, _registry(registry, steps)))


def _registry(registry: Registry | None, steps: Steps | None) -> Registry | None:
    if registry is not None and not isinstance(registry, Registry):
        got = type(registry).__name__
        raise UsageError(f"registry must be a Registry, got {got}; steps={{…}} takes functions")
    if steps is None:
        return registry
    if registry is not None:
        raise UsageError("steps: a registry is given, which has its own; give one of the two")
    if not isinstance(steps, Mapping):
        name = getattr(steps, "__name__", "")
        hint = f"; give {{{name!r}: {name}}}" if name.isidentifier() else ""
        got = type(steps).__name__
        raise UsageError(f"steps must be a mapping of names to functions, got {got}{hint}")
    for name, step in steps.items():
        if not isinstance(name, str):
            raise UsageError(f"steps: names are texts, got {shown(name)}")
        if not (callable(step) or isinstance(step, str)):
            raise UsageError(f"steps: {name!r} is {shown(step)}, no function")
    return installed_and(steps)


def loads(
    text: str,
    file: str = "<text>",
    registry: Registry | None = None,
    *,
    steps: Steps | None = None,
) -> Pipeline:
    """Return the pipeline that YAML text declares.

    Parameters
    ----------
    text : str
    file : str
        The name its errors carry.
    registry : Registry, optional
    steps : mapping of str to callable, optional
        Both as in `load`.

    Raises
    ------
    PipelineError
        With every problem of the text.
    UsageError
        If it is no text, both ``registry`` and ``steps`` are given, or steps are no mapping of
        names to functions.
    """
    return Pipeline.of(parse_graph(checked_text(text), file, _registry(registry, steps)))


class _Kept:
    """The runners that nobody uses just now; one serves one thread at a time, of any age.

    There is no lock: each line that changes something is one operation of a dict or a list.
    """

    def __init__(self) -> None:
        self.free: dict[_Asked, list[Runner[Result]]] = {}

    def take(self, asked: _Asked) -> Runner[Result] | None:
        """Return a runner that nobody else has until it is given back; None where there is none."""
        try:
            return self.free[asked].pop()
        except (KeyError, IndexError):
            return None

    def give_back(self, asked: _Asked, runner: Runner[Result]) -> None:
        """Keep a runner for the next call."""
        self.free.setdefault(asked, []).append(runner)
        if len(self.free) > MOST_KEPT:
            for oldest in list(self.free)[:-MOST_KEPT]:
                self.free.pop(oldest, None)


@dataclass(frozen=True, eq=False, repr=False)
class Pipeline(Graph):
    """A resolved, checked, frozen graph, ready to run. Make one with `tactile_graph.load`."""

    @classmethod
    def of(cls, graph: Graph) -> Pipeline:
        """Return the pipeline of a graph."""
        return cls(**{f.name: getattr(graph, f.name) for f in fields(graph)})

    def __copy__(self) -> Pipeline:
        return self

    def __deepcopy__(self, memo: object) -> Pipeline:
        return self

    def __reduce__(self) -> tuple[Callable[..., Pipeline], tuple[Any, ...]]:
        """Pickle by texts, settings and source: another process resolves them by its own plugins.

        Raises
        ------
        UsageError
            If it was loaded with a registry of its own, which no other process has.
        """
        if self.registry is not None and self.registry is not installed():
            raise UsageError(
                f"pipeline {self.name!r} has a registry of its own, or steps: not to be pickled"
            )
        given = (self.text, self.file, dict(self.overrides), self.source_override)
        return _unpickled, (*given, self.source is not None, self.files)

    # -- running -----------------------------------------------------------------------------

    def run(
        self,
        frame: Frame | Image | NDArray[np.generic],
        only: Sequence[str] | None = None,
        seed: int = 0,
    ) -> Result:
        """Return the result for one frame; stateful steps start anew.

        Parameters
        ----------
        frame : Frame, Image or ndarray, shape (rows, columns)
            A bare array becomes a frame of pitch 1 cm and quantity ``raw``.
        only : sequence of str, optional
            Nodes or ``node.field`` to ask for instead of the pipeline's outputs; none means these.
        seed : int
            Seed of the steps that take randomness.

        Raises
        ------
        RuleError
            If the frame's quantity, shape or pitch breaks a rule of a step.
        FrameError
            If what is given makes no frame, as of `Frame.of`; it is a ValueError as well.
        UsageError
            If it is a path, or several frames; if ``only`` or ``seed`` is of the wrong type.
        """
        seed = seed if seed.__class__ is int else checked_seed(seed)
        asked = checked_names(only), seed
        runner = self._kept.take(asked) or self.runner(*asked)
        try:
            result = runner(as_frame(frame))
        finally:
            if not runner.stateful:
                self._kept.give_back(asked, runner)
        if self.promises.waiting:
            self.promises.check(result)
        return result

    def stream(
        self,
        frames: Iterable[Frame | Image | NDArray[np.generic]] | None = None,
        only: Sequence[str] | None = None,
        seed: int = 0,
        report: Report | None = None,
    ) -> Results:
        """Return the results of the frames, in order, as they are taken; stateful steps keep state.

        Frames of another label (of another recording or sensor) find none of it. Where a loop over
        them may end early, ``with pipeline.stream() as results`` closes the source.

        Parameters
        ----------
        frames : iterable of Frame, Image or ndarray, optional
            The pipeline's own source if not given. Bare arrays are numbered as they come, frames
            keep their number, by which steps draw their random ones.
        only, seed
            As in `run`.
        report : Report, optional
            Takes what the pipeline's own source reports, as ``report`` of the results has it
            besides. Without it `SourceWarning` tells what is left out and assumed.

        Raises
        ------
        UsageError
            As of `run`, and if frames are one frame by itself. What makes no frame is told when it
            comes.
        """
        from tactile_graph.api.results import Results

        runner = self.runner(only, seed)
        asked = tuple(runner.plan.asked)
        told = Report() if report is None else report
        if frames is None:
            given = frames = self._opened(seed, told, in_stacks=False, warns=report is None)
        else:
            given = as_frames(frames)
        return Results(self, asked, self.results(given, runner), frames, told)

    def live(
        self,
        source: Iterable[Frame | Image | NDArray[np.generic]] | None = None,
        only: Sequence[str] | None = None,
        seed: int = 0,
        deadline_us: float | None = None,
        capacity: int = 64,
        unread: int = 1024,
        report: Report | None = None,
    ) -> LiveStream[Result]:
        """Return the results of frames as these come, for ``async for``; it may be closed early.

        Frames are read and answered by threads of their own, in order; those that come too fast are
        shed, the oldest first, as `LiveResult` says. For a loop without ``async`` there is
        `tactile_graph.live.LiveRun`.

        Parameters
        ----------
        source : iterable of Frame, Image or ndarray, optional
            The pipeline's own source if not given. Read as fast as it gives frames: for a recording
            see `tactile_graph.live.paced`.
        only, seed
            As in `run`.
        deadline_us : float, optional
            Microseconds from a frame's arrival within which its result is wanted: what would not
            be done in time is skipped.
        capacity, unread : int
            How many frames may wait to be answered, and how many results to be taken, before the
            oldest go; at least 1.
        report : Report, optional
            Its ``wanted`` is false once the stream is closed. A generator is closed at the frame it
            gives next: one that waits (for a queue, a socket) looks at it now and then, and ends.

        Raises
        ------
        UsageError
            If ``source`` is a path, or nothing that has frames one after the other.
        """
        from tactile_graph.live.live_run import LiveRun
        from tactile_graph.live.live_stream import LiveStream

        run = LiveRun(
            self, source, only=only, seed=seed, deadline_us=deadline_us, capacity=capacity,
            report=report,
        )  # fmt: skip
        return LiveStream(run, unread)

    def results(
        self, frames: Iterable[Frame | Image | NDArray[np.generic]], runner: Runner[Result]
    ) -> Iterator[Result]:
        """Yield the results of the frames, each as it comes, by a runner of this pipeline."""
        for index, frame in enumerate(frames):
            result = runner(frame if frame.__class__ is Frame else as_frame(frame, index))
            if self.promises.waiting:
                self.promises.check(result)
            yield result

    def blocks(
        self, frames: Iterable[Frame | FrameStack], runner: Runner[Result] | None = None
    ) -> Iterator[Result | Block[Result]]:
        """Yield what `results` does, many frames at once where a step of the pipeline can.

        Parameters
        ----------
        frames : iterable of Frame or FrameStack
            Gathered as they come; what a slow source gives is not kept waiting.
        runner : Runner, optional
            Of this pipeline; for its outputs if not given.
        """
        from tactile_graph.engine.blocks.gathering import Share, flat, gathered

        runner = runner or self.runner()
        if not runner.in_blocks:
            yield from self.results(flat(frames), runner)
            return
        share = Share()
        for stack in gathered(frames):
            for part in share.parts(stack):
                block = runner.block(part)
                for result in block.kinds() if self.promises.waiting else ():
                    self.promises.check(result)
                yield block

    def runner(
        self,
        only: Sequence[str] | None = None,
        seed: int = 0,
        verify: bool = False,
        decider: Decider | None = None,
        after: Runner[Result] | None = None,
    ) -> Runner[Result]:
        """Return a callable of frames that keeps state, for loops of your own.

        It takes no bare arrays: `Frame.of` makes frames of them. It does not hold what steps give
        against what they promise, as `run` and `stream` do.

        With ``verify`` a step fails that writes into what others read; this costs time. A
        ``decider`` says for each frame what is left undone: a `tactile_graph.live.Deadline`, or
        what was `tactile_graph.live.Recorded` of one. Where it comes ``after`` a runner of the same
        seed, and takes its place, nodes that compute the same go on with their state.
        """
        from tactile_graph.api.result import Result
        from tactile_graph.engine.runner import Runner, RunSettings

        settings = RunSettings(checked_seed(seed), verify, decider, after)
        return Runner(self, checked_names(only), Result, settings)

    @cached_property
    def _kept(self) -> _Kept:
        return _Kept()

    @cached_property
    def promises(self) -> Promises:
        """What the steps promise and have not been seen to keep yet."""
        from tactile_graph.engine.outcomes.promises import Promises

        return Promises(self.nodes.values(), self.registry)

    def frames(self, seed: int = 0, report: Report | None = None) -> Iterator[Frame]:
        """Return the frames of the pipeline's own source.

        Without a ``report``, which takes what it has to say, `SourceWarning` tells what is left
        out and assumed.

        Raises
        ------
        UsageError
            If the pipeline declares none.
        DataError
            If the source raises what is not for people.
        """
        return self._opened(seed, report or Report(), in_stacks=False, warns=report is None)

    def frames_in_stacks(
        self, seed: int = 0, report: Report | None = None
    ) -> Iterator[Frame | FrameStack]:
        """Return the same frames, many at once where the source has them so; for `blocks`."""
        return self._opened(seed, report or Report(), in_stacks=True, warns=report is None)

    def _opened(self, seed: int, report: Report, in_stacks: bool, warns: bool) -> Iterator[Any]:
        if self.source is None:
            raise UsageError(f"pipeline {self.name!r} declares no source: give it frames")
        from tactile_graph.api.warned import warned
        from tactile_graph.engine.calls.sources import open_source

        frames = open_source(self.source, checked_seed(seed), report, in_stacks)
        return warned(frames, self.source.name, report) if warns else frames

    # -- variants ----------------------------------------------------------------------------

    def with_settings(self, settings: Mapping[str, Any], source: SourceOverride = None) -> Pipeline:
        """Return the pipeline with some settings replaced, checked like a file.

        Parameters
        ----------
        settings : mapping
            ``{"node.setting": value}``; ``"node/inner.setting"`` inside an embedded pipeline.
        source : tuple of (step name, settings), optional
            Another source, put in at once: the settings may be right for its frames only.

        Raises
        ------
        PipelineError
            If a node, a setting or a value is not allowed.
        UsageError
            If settings are no mapping of texts.
        """
        overrides = {k: dict(v) for k, v in self.overrides.items()}
        for name, value in checked_settings(settings).items():
            node, dot, setting = name.rpartition(".")
            if not dot:
                meant = [f"{n}.{name}" for n, node in self.nodes.items() if name in node.settings]
                hint = f"; did you mean {one_of(meant, 5)}?" if meant else ""
                told = f"setting {name!r}: it is named node.setting{hint}"
                raise PipelineError([Problem(None, told)])
            overrides.setdefault(node, {})[setting] = value
        return self._again(overrides, source or self.source_override)

    def with_source(self, step: str, **settings: Any) -> Pipeline:
        """Return the pipeline with another source; rules about quantities are checked again."""
        return self._again(self.overrides, (checked_step(step), settings))

    def _again(self, overrides: Overrides, source: SourceOverride) -> Pipeline:
        return Pipeline.of(resolve_again(self, overrides, source))

    # -- looking in --------------------------------------------------------------------------

    def graph(self) -> networkx.DiGraph[str]:
        """Return the graph for networkx: nodes by name, an edge for each wire."""
        import networkx as nx

        graph: nx.DiGraph[str] = nx.DiGraph(name=self.name)
        graph.add_node(FRAME, kind="frame")
        for name, node in self.nodes.items():
            graph.add_node(name, kind=node.kind.value, step=node.what, output=name in self._asked)
            for binding in node.inputs:
                for ref in binding.refs:
                    graph.add_edge(ref.node, name, port=binding.port.name, kind="data")
            for ref in node.choices:
                graph.add_edge(ref.node, name, kind="choice")
            for ref in node.guard.refs if node.guard else ():
                if not graph.has_edge(ref.node, name):
                    graph.add_edge(ref.node, name, kind="guard")
        return graph

    @cached_property
    def _asked(self) -> set[str]:
        return {r.node for r in self.outputs.values()}

    def svg(self) -> str:
        """Return the graph as SVG text, laid out from left to right."""
        from tactile_graph.draw.svg import graph_svg

        return graph_svg(self)

    def _repr_svg_(self) -> str:
        return self.svg()

    def __rich__(self) -> RenderableType:
        from tactile_graph.draw.tables import pipeline_table

        return pipeline_table(self)

    def __repr__(self) -> str:
        return f"<Pipeline {self.name}: {', '.join(self.nodes)} -> {', '.join(self.outputs)}>"


def _unpickled(
    text: str,
    file: str,
    overrides: Overrides,
    source: SourceOverride,
    with_source: bool = True,
    files: FilesRead | None = None,
) -> Pipeline:
    files = files or FilesRead.here()
    pipeline = Pipeline.of(parse_again(text, file, None, overrides, source, files))
    return pipeline if with_source else replace(pipeline, source=None)
