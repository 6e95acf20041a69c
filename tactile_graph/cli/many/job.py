"""What a worker does for ``run``: frames of a portion through a pipeline, to a part of a file."""

from __future__ import annotations

import pickle
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tactile_graph.api.pipeline import Pipeline
from tactile_graph.cli.endings import exited
from tactile_graph.cli.output.outputs import Output, form_of
from tactile_graph.cli.output.tally import LOOKED_THROUGH, Tally
from tactile_graph.compiled import warm_up
from tactile_graph.engine.blocks.block import Block
from tactile_graph.engine.blocks.gathering import WORTH_BLOCKS
from tactile_graph.engine.tables.columns import columns_of
from tactile_graph.exporter import Writer, write_block
from tactile_graph.many.portion import Portion
from tactile_graph.many.processes import scratch_folder
from tactile_graph.many.reading import Reader, Reading
from tactile_graph.many.sharing import for_the_way, ready
from tactile_graph.steps.ranges import Irregular

if TYPE_CHECKING:
    from tactile_graph.api.result import Result
    from tactile_graph.engine.runner import Runner


class Job(NamedTuple):
    """What is the same for all portions of a run.

    Attributes
    ----------
    pipeline : Pipeline
    asked : tuple of str
    seed : int
    verify : bool
    ending : str
        Of the name of the file that is written.
    full, long : bool
        As of `Output`.
    reading : Reading, optional
        Where workers read the frames themselves.
    start : int
        Place in the source of the run's first frame.
    is_long : bool
        Whether machine code answers from the first frame on, as it does in long runs.
    """

    pipeline: Pipeline
    asked: tuple[str, ...]
    seed: int
    verify: bool
    ending: str
    full: bool
    long: bool
    reading: Reading | None
    start: int
    is_long: bool


class Done(NamedTuple):
    """What a portion came to.

    Attributes
    ----------
    n_frames : int
        How many frames were run; fewer than the portion has where ``error`` is told.
    part : bytes
        The file that they make alone.
    tally : Tally
    quantities : frozenset of str
        Of the frames.
    seconds : float
        How long it took.
    error : Exception or None
        What ended it early.
    irregular : str
        Why the frames could not be read on their own; "" if they could.
    """

    n_frames: int = 0
    part: bytes = b""
    tally: Tally | None = None
    quantities: frozenset[str] = frozenset()
    seconds: float = 0.0
    error: Exception | None = None
    irregular: str = ""


def done(given: bytes, portion: Portion) -> Done:
    """Return what a portion comes to; called in the workers, with what `for_workers` gave."""
    bench: _Bench = ready(given)
    begun = time.perf_counter()
    return bench.done(portion)._replace(seconds=time.perf_counter() - begun)


def for_workers(job: Job) -> bytes:
    """Return a job as workers are given it."""
    return pickle.dumps((_Bench, job))


class _Bench:
    """A job made ready."""

    def __init__(self, job: Job) -> None:
        if job.is_long:
            warm_up()
        self.job = job
        self.columns = columns_of(job.pipeline, job.asked)
        self.runner = self._new_runner()
        self.reader = Reader(None, {}) if job.reading is None else job.reading.reader()

    def _new_runner(self) -> Runner[Result]:
        return self.job.pipeline.runner(self.job.asked, self.job.seed, self.job.verify)

    def done(self, portion: Portion) -> Done:
        """Return what a portion comes to."""
        start = portion.low - self.job.start
        tally = Tally(self.columns, n_looked=max(0, LOOKED_THROUGH - start))
        ended: list[Exception] = []
        quantities: set[str] = set()
        try:
            with self._written() as (writer, part):
                try:
                    for came in self._results(portion):
                        if isinstance(came, Block):
                            tally.add_block(came)
                            write_block(writer, came)
                            quantities.add(came.frames.images.quantity)
                        else:
                            tally.add(came)
                            writer.write(came)
                            quantities.add(came.frame.image.quantity)
                except (Irregular, KeyboardInterrupt):
                    raise
                except Exception as error:  # what was done before is kept
                    ended.append(for_the_way(error))
                except BaseException as error:
                    ended.append(exited(error))
        except Irregular as why:
            return Done(irregular=str(why) or "frames that cannot be read on their own")
        tally.outputs = []  # columns hold functions, and who asked knows them
        trouble = ended[0] if ended else None
        return Done(tally.n, part[0], tally, frozenset(quantities), error=trouble)

    def _results(self, portion: Portion) -> Iterator[Result | Block[Result]]:
        if self.runner.stateful:
            self.runner = self.reader.settled(portion, self._new_runner)
        frames, pipeline = self.reader.frames(portion), self.job.pipeline
        if portion.high - self.job.start >= WORTH_BLOCKS:
            return pipeline.blocks(self.reader.stacks(portion) or frames, self.runner)
        return pipeline.results(frames, self.runner)

    @contextmanager
    def _written(self) -> Iterator[tuple[Writer, list[bytes]]]:
        """Give what takes results, and where their file is as bytes at the end."""
        job = self.job
        part: list[bytes] = []
        with tempfile.TemporaryDirectory(prefix="tactile-graph-", dir=scratch_folder()) as folder:
            form = form_of(job.ending)
            path = Path(folder, f"part.{form}")
            output = Output.of(str(path), form, job.full, job.long)
            assert output is not None
            writer, _ = output.writer(job.pipeline, job.asked)
            try:
                yield writer, part
            finally:
                writer.close()
            part.append(path.read_bytes())
