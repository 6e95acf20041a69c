"""``Pipeline``: a frozen graph, ready to run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from threading import get_ident
from typing import TYPE_CHECKING, Any

from tactile_graph.errors import Mark, PipelineError, Problem, UsageError
from tactile_graph.pipeline.node import FRAME, FrameRule, Node, node_key
from tactile_graph.pipeline.plain import plain as plain
from tactile_graph.pipeline.plain import plain_node
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import Ref
from tactile_graph.steps.injected import Report
from tactile_graph.steps.signature import Signature
from tactile_graph.wires.frame import Frame

if TYPE_CHECKING:
    import networkx
    import numpy as np
    from numpy.typing import NDArray
    from rich.console import RenderableType

    from tactile_graph.engine.result import Result
    from tactile_graph.engine.runner import Runner
    from tactile_graph.pipeline.promises import Promises
    from tactile_graph.plugins.registry import Registry


@dataclass(frozen=True)
class Source:
    """The source step a pipeline takes its frames from unless told otherwise."""

    signature: Signature
    settings: dict[str, Any]
    mark: Mark

    @property
    def name(self) -> str:
        """Name of the source step."""
        return self.signature.name


@dataclass(frozen=True, eq=False)
class Pipeline:
    """A resolved, checked, frozen graph. Make one with `tactile_graph.load`."""

    name: str
    about: str
    evolves: str
    source: Source | None
    nodes: Mapping[str, Node]
    outputs: Mapping[str, Ref]
    file: str
    text: str
    frame_rules: tuple[FrameRule, ...] = ()
    overrides: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    source_override: tuple[str, dict[str, Any]] | None = None
    registry: Registry | None = None

    # -- running -----------------------------------------------------------------------------

    def run(
        self, frame: Frame | NDArray[np.generic], only: Sequence[str] | None = None, seed: int = 0
    ) -> Result:
        """Return the result for one frame; stateful steps start anew.

        Parameters
        ----------
        frame : Frame or ndarray, shape (rows, columns)
            A bare array becomes a frame of pitch 1 cm and quantity ``raw``.
        only : sequence of str, optional
            Nodes or ``node.field`` to ask for instead of the pipeline's outputs.
        seed : int
            Seed of the steps that take randomness.

        Raises
        ------
        RuleError
            If the frame's quantity, shape or pitch breaks a rule of a step.
        """
        result = self._runner(tuple(only or ()), seed)(_as_frame(frame))
        if self.promises.waiting:
            self.promises.check(result)
        return result

    def stream(
        self,
        frames: Iterable[Frame | NDArray[np.generic]] | None = None,
        only: Sequence[str] | None = None,
        seed: int = 0,
    ) -> Iterator[Result]:
        """Yield the result of each frame, in order; stateful steps keep their state.

        Parameters
        ----------
        frames : iterable of Frame or ndarray, optional
            The pipeline's own source if not given.
        only, seed
            As in `run`.
        """
        runner = self.runner(only, seed)
        for frame in self.frames(seed) if frames is None else frames:
            result = runner(_as_frame(frame))
            if self.promises.waiting:
                self.promises.check(result)
            yield result

    def runner(self, only: Sequence[str] | None = None, seed: int = 0) -> Runner:
        """Return a callable of frames that keeps state, for loops of your own."""
        from tactile_graph.engine.runner import Runner

        return Runner(self, tuple(only or self.outputs), seed)

    def _runner(self, only: tuple[str, ...], seed: int) -> Runner:
        """Return a fresh runner, or the last one where no step keeps state."""
        kept: dict[Any, Runner] = self._kept
        key = (only, seed, get_ident())  # a runner serves one thread
        runner = kept.get(key)
        if runner is None or runner.stateful:
            runner = kept[key] = self.runner(only, seed)
            if len(kept) > 16:
                kept.pop(next(iter(kept)))
        return runner

    @cached_property
    def _kept(self) -> dict[Any, Runner]:
        return {}

    @cached_property
    def promises(self) -> Promises:
        """What the steps promise and have not been seen to keep yet."""
        from tactile_graph.pipeline.promises import Promises

        return Promises(self.nodes.values(), self.registry)

    def frames(self, seed: int = 0, report: Report | None = None) -> Iterator[Frame]:
        """Return the frames of the pipeline's own source.

        Raises
        ------
        UsageError
            If the pipeline declares none.
        DataError
            If the source raises what is not for people.
        """
        if self.source is None:
            raise UsageError(f"pipeline {self.name!r} declares no source: give it frames")
        from tactile_graph.engine.sources import open_source
        from tactile_graph.pipeline.source_errors import told

        source = self.source
        frames = open_source(source.signature, source.settings, seed, report or Report())
        return told(source.name, frames)

    # -- variants ----------------------------------------------------------------------------

    def with_settings(self, settings: Mapping[str, Any]) -> Pipeline:
        """Return the pipeline with some settings replaced, checked like a file.

        Parameters
        ----------
        settings : mapping
            ``{"node.setting": value}``; ``"node/inner.setting"`` inside an embedded pipeline.

        Raises
        ------
        PipelineError
            If a node, a setting or a value is not allowed.
        """
        from tactile_graph.pipeline.load import rebuild

        overrides = {k: dict(v) for k, v in self.overrides.items()}
        for name, value in settings.items():
            node, dot, setting = name.rpartition(".")
            if not dot:
                raise PipelineError([Problem(None, f"setting {name!r}: it is named node.setting")])
            overrides.setdefault(node, {})[setting] = value
        return rebuild(self, overrides, self.source_override)

    def with_source(self, step: str, **settings: Any) -> Pipeline:
        """Return the pipeline with another source; rules about quantities are checked again."""
        from tactile_graph.pipeline.load import rebuild

        return rebuild(self, self.overrides, (step, settings))

    # -- looking in --------------------------------------------------------------------------

    @cached_property
    def types(self) -> dict[str, Any]:
        """Type of each node's value."""
        return {FRAME: Frame, **{n: node.output for n, node in self.nodes.items()}}

    def ref(self, text: str) -> Ref:
        """Return the reference that ``node`` or ``node.field`` spells.

        Raises
        ------
        UsageError
            If there is no such node or field.
        """
        if text in self.types:
            return Ref(text)
        try:
            return resolve_reference(tuple(text.split(".")), self.types, [])[0]
        except ConditionError as error:
            raise UsageError(f"pipeline {self.name!r}: {error.message}") from None

    def type_of(self, ref: Ref) -> Any:
        """Return the type of the value at a reference."""
        return resolve_reference((ref.node, *ref.path), self.types, [])[1]

    @cached_property
    def key(self) -> str:
        """Digest that is equal for pipelines that compute the same."""
        return node_key([(k, self.nodes[r.node].key if r.node in self.nodes else r.node, r.path)
                         for k, r in self.outputs.items()])  # fmt: skip

    @cached_property
    def unused(self) -> list[str]:
        """Nodes that no output needs; they run only when asked for."""
        needed: set[str] = set()
        waiting = [r.node for r in self.outputs.values()]
        while waiting:
            name = waiting.pop()
            if name not in needed and name in self.nodes:
                needed.add(name)
                waiting += [r.node for r in self.nodes[name].wires()]
        return [n for n in self.nodes if n not in needed and not self.nodes[n].is_sink]

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

    def resolved(self) -> dict[str, Any]:
        """Return the graph as plain data with every setting spelled out, as provenance keeps it."""
        return {
            "pipeline": self.name,
            "source": None
            if self.source is None
            else {"step": self.source.name, "with": plain(self.source.settings)},
            "nodes": {name: plain_node(node) for name, node in self.nodes.items()},
            "outputs": {name: str(ref) for name, ref in self.outputs.items()},
        }


def _as_frame(frame: Any) -> Frame:
    return frame if frame.__class__ is Frame else Frame.of(frame)
