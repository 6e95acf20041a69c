"""Frames of the last minute shown again, by the pipeline as it is now."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from tactile_graph import Pipeline, Result
from tactile_graph.inspect import Runner, make_plan
from tactile_graph_live.bench.snapshot import Photographer
from tactile_graph_live.bench.tare import less
from tactile_graph_live.bench.wire import Kept
from tactile_graph_live.server.messages import Frame

LEAD = 30
"""Frames before the one looked at that a pipeline with state is run on first."""


class Lookback:
    """Runs kept frames through a pipeline of its own, so that the bench is not held up.

    Parameters
    ----------
    pipeline : Pipeline
    version : int
    seed : int
    """

    def __init__(self, pipeline: Pipeline, version: int, seed: int) -> None:
        self.version = version
        self._pipeline, self._seed = pipeline, seed
        self._photographer = Photographer(pipeline, version)
        self.lead = LEAD if make_plan(pipeline, tuple(pipeline.outputs)).stateful else 0
        self._runner: Runner[Result] | None = None
        self._tared = False

    def frame(self, kept: Kept, shown: Collection[str], pad: dict[str, Any] | None) -> Frame:
        """Return what the last of the frames comes to, after those before it.

        Parameters
        ----------
        kept : Kept
        shown : collection of str
            Nodes whose pictures are wanted.
        pad : mapping, optional
            A picture in whose range of colours it is shown.
        """
        runner = self._runner_of_its_own()
        for frame in kept.frames:
            result = runner(less(frame, kept.baseline))
        runner.forget()  # looked at again, it is run again
        if self._tared != (kept.baseline is not None):
            self._tared = not self._tared
            self._photographer.forget_range()
        if pad is not None:
            self._photographer.like(pad)
        self._photographer.shown = shown
        return self._photographer.snapshot(result, None, kept.back_s)

    def _runner_of_its_own(self) -> Runner[Result]:
        """Return a runner without a state; the last one where it can have none."""
        if self._runner is None or self.lead:
            self._runner = self._pipeline.runner(seed=self._seed)
        return self._runner
