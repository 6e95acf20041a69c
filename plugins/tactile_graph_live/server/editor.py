"""The pipeline as it is worked on, brought to the bench when it is right, told when it is not."""

from __future__ import annotations

import asyncio
import os
import pickle
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from tactile_graph.errors import TactileGraphError
from tactile_graph_live.bench.wire import Swap, Swapped
from tactile_graph_live.server.draft import Draft, faults
from tactile_graph_live.server.graph_message import graph_message
from tactile_graph_live.server.lookback import Lookback
from tactile_graph_live.server.messages import Fault, Graph, Trouble
from tactile_graph_live.server.unawaited import unawaited
from tactile_graph_live.server.watching import SETTLE_S, Contents, FileSense, Watched

SLOW_S = 2.0
"""After so long it is told that a pipeline is still being made ready."""
SWAP_S = 60.0
"""The longest that is waited for it: a bench may have to compile."""


@dataclass(frozen=True)
class Edited:
    """A pipeline that runs: how it came to be, and what the page knows of it."""

    draft: Draft
    graph: Graph
    lookback: Lookback


class Editor:
    """Keeps the bench at what file and page say.

    Parameters
    ----------
    draft : Draft
    seed : int
    sense : FileSense
    swap : callable
        Has the bench run a pipeline; its answer comes to `swapped`.
    changed : callable
        Called when another pipeline runs.
    wrong : callable
        Called with what is wrong, or that nothing is any more.
    say : callable
        Called with what else is to be known.
    """

    def __init__(
        self,
        draft: Draft,
        seed: int,
        sense: FileSense,
        *,
        swap: Callable[[Swap], None],
        changed: Callable[[Edited], None],
        wrong: Callable[[Trouble], None],
        say: Callable[[str], None],
    ) -> None:
        self._seed = seed
        self._swap, self._changed, self._wrong, self._say = swap, changed, wrong, say
        self._version = 1
        self._read_source = sense.read_source
        self._borne: set[str] = set()
        self._watched = Watched(sense, [draft.pipeline.file])
        self.now = self._edited(replace(draft, source_files=self._watch_all_of(draft)), 1)
        self.trouble: Trouble | None = None
        self._of_file: tuple[Fault, ...] = ()
        self._lock = asyncio.Lock()
        self._answer: asyncio.Future[Swapped] | None = None
        self._late: dict[int, tuple[Edited, float, bool]] = {}
        self._waiting: dict[tuple[str, str], Any] = {}

    @property
    def version(self) -> int:
        """Version of the pipeline that runs."""
        return self.now.graph.version

    def _edited(self, draft: Draft, version: int) -> Edited:
        pipeline = draft.pipeline
        lookback = Lookback(pipeline, version, self._seed)
        graph = graph_message(pipeline, version, (draft.text, draft.file_text), draft.set_here)
        return Edited(draft, graph, lookback)

    # -- the file ----------------------------------------------------------------------------------

    async def watch(self) -> None:
        """Follow the file, for ever."""
        while True:
            await self._watched.change()
            await self.reload()

    async def reload(self) -> None:
        """Bring the file as it is now to the bench, or tell what is wrong with it."""
        began = time.perf_counter()
        async with self._lock:
            try:
                draft = await unawaited(self._read)
            except Exception as error:  # a plugin may raise anything while it is imported
                await asyncio.sleep(SETTLE_S)
                if not self._watched.changed():
                    self._of_file = faults(error, self.now.draft.pipeline.file)
                    self._tell(self._of_file)
                return
            await self._apply(draft, began, of_file=True)

    def _watch_all_of(self, draft: Draft) -> Contents:
        """Watch all that is read with a file that is right; return what its source reads."""

        def read_source() -> None:
            try:
                self._read_source(draft.pipeline)
            except TactileGraphError as error:  # the bench tells what keeps it from its frames
                self._borne = _texts(error, draft)

        return self._watched.contents(self._watched.take(draft.read_again, read_source)[1])

    def _read(self) -> Draft:
        found: list[Draft] = []

        def read_source() -> None:
            try:
                self._read_source(found[0].pipeline)
            except TactileGraphError as error:  # a setting `scene` of a plugin's may be no file
                if not _texts(error, found[0]) <= self._borne:
                    raise

        _, source_files = self._watched.take(
            lambda: found.append(self.now.draft.read_again()), read_source
        )
        return replace(found[0], source_files=self._watched.contents(source_files))

    # -- the page ----------------------------------------------------------------------------------

    async def set(self, node: str, setting: str, value: Any) -> None:
        """Change a setting; where one is moved fast only the newest value is tried.

        Raises
        ------
        TactileGraphError
            If the value is not allowed.
        """
        self._waiting[node, setting] = value
        began = time.perf_counter()
        async with self._lock:
            if (node, setting) not in self._waiting:
                return  # who waited before us has set the newest already
            value = self._waiting.pop((node, setting))
            draft = await unawaited(self.now.draft.with_value, node, setting, value)
            await self._apply(draft, began)

    async def unset(self, node: str = "", setting: str = "") -> None:
        """Take back what was set on the page, all of it if no setting is named."""
        began = time.perf_counter()
        async with self._lock:
            draft = await unawaited(self.now.draft.without_values, node, setting)
            await self._apply(draft, began)

    # -- the bench ---------------------------------------------------------------------------------

    def swapped(self, answer: Swapped) -> None:
        """Take the bench's answer, be it so late that nobody waits for it any more."""
        waiting = self._answer
        if waiting is not None and not waiting.done() and answer.version == self._version:
            waiting.set_result(answer)
        elif (late := self._late.pop(answer.version, None)) is not None and not answer.error:
            self._runs(answer, *late)

    def bench_died(self) -> None:
        """Wait no more for its answers."""
        self._late.clear()
        if self._answer is not None and not self._answer.done():
            died = "the process that runs the pipeline died of this change"
            self._answer.set_result(Swapped(self._version, died))

    async def _apply(self, draft: Draft, began: float, of_file: bool = False) -> None:
        self._version += 1
        self._answer = asyncio.get_running_loop().create_future()
        restart = not draft.same_source(self.now.draft)
        self._swap(Swap(self._version, pickle.dumps(draft.pipeline), restart))
        edited = await unawaited(self._edited, draft, self._version)
        answer = await self._answered(self._answer)
        if self._answer.cancelled():
            self._late[self._version] = edited, began, of_file
        if not answer.error:
            self._runs(answer, edited, began, of_file)
        elif of_file:
            self._of_file = (Fault(0, 0, answer.error),)
            self._tell(self._of_file)
        else:
            self._tell((Fault(0, 0, answer.error), *self._of_file))

    async def _answered(self, answer: asyncio.Future[Swapped]) -> Swapped:
        """Return the bench's answer, or that there was none."""
        done, _ = await asyncio.wait({answer}, timeout=SLOW_S)
        if not done:
            self._say("the new graph is being made ready; until then the old one runs")
            done, _ = await asyncio.wait({answer}, timeout=SWAP_S - SLOW_S)
        if done:
            return answer.result()
        answer.cancel()
        slow = f"it is not ready after {SWAP_S:g} s; it will run if it gets so"
        return Swapped(self._version, slow)

    def _runs(self, answer: Swapped, edited: Edited, began: float, of_file: bool) -> None:
        """Take note that another pipeline runs: the file's, or what was set on the page."""
        if of_file:
            self._of_file = ()
        took_ms = round((time.perf_counter() - began) * 1e3, 1)
        graph = replace(edited.graph, took_ms=took_ms, anew=answer.anew)
        self.now = replace(edited, graph=graph)
        self._changed(self.now)
        if self.trouble is not None:  # a setting that is right makes no file right
            self._tell(self._of_file)

    def _tell(self, errors: tuple[Fault, ...]) -> None:
        title = ""
        if not os.path.lexists(self.now.draft.pipeline.file):
            title = "The file is gone."
        elif errors and not self._of_file:
            title = "What was set does not run."
        trouble = Trouble(self._version, errors, title)
        self.trouble = trouble if errors else None
        self._wrong(trouble)


def _texts(error: TactileGraphError, draft: Draft) -> set[str]:
    """Return what is wrong with a file, wherever it stands there."""
    return {fault.text for fault in faults(error, draft.pipeline.file)}
