"""What one frame came to, taken down for the page."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterable
from math import inf
from typing import Any

from tactile_graph import Frame, Result
from tactile_graph.draw.display import display_list, truth_list
from tactile_graph.foreign_text import visible
from tactile_graph.inspect import FRAME, as_data, make_table, without_nan
from tactile_graph.wires import Image
from tactile_graph_live.bench.shapes import Plain, picture, readings, shapes
from tactile_graph_live.server import messages

LONGEST_REASON = 400
MOST_ROWS = 200
KEPT_S = 30.0
LEAD = ("frame", "time_s", "label")


class Photographer:
    """Takes down what frames of one pipeline came to.

    Parameters
    ----------
    pipeline : Graph
    version : int
        Of the graph, as the page counts.

    Attributes
    ----------
    shown : collection of str
        Nodes whose pictures are wanted.
    """

    def __init__(self, pipeline: Any, version: int) -> None:
        self.pipeline, self.version = pipeline, version
        self.shown: Collection[str] = ()
        self._table = make_table(pipeline, tuple(pipeline.outputs), True)
        self._range = Range()

    def snapshot(
        self,
        result: Result,
        latency_us: float | None = None,
        back_s: float = 0.0,
        arrived_s: float | None = None,
    ) -> messages.Frame:
        """Return what the page shows of a result."""
        frame = result.frame
        stories = {s.node: s for s in result.explain()}
        rows = list(self.rows(result))
        return messages.Frame(
            index=frame.index,
            time_s=frame.time_s,
            version=self.version,
            pad=self._pad(frame),
            drawing=self._drawing(result),
            nodes={n: _fared(s) for n, s in stories.items()},
            pictures={n: _look(frame, stories, n) for n in self.shown},
            rows=rows,
            errors={
                f"{row['output']}.{key}": value
                for row in reversed(rows)
                for key, value in row.items()
                if "_error_" in key and isinstance(value, int | float)
            },
            decisions=list(result.decisions),
            latency_us=latency_us,
            back_s=back_s,
            label=visible(frame.label),
            gap=frame.gap,
            device_time_s=frame.device_time_s,
            arrived_s=arrived_s,
        )

    def forget_range(self) -> None:
        """Begin the range of colours anew: readings mean something else from here on."""
        self._range = Range()

    def like(self, pad: Plain) -> None:
        """Colour frames as one was coloured that has been taken down before."""
        self._range.widen(pad["low"], pad["high"])

    def rows(self, result: Result) -> Iterable[Plain]:
        """Yield a row for each object that was found, as plain data."""
        for number, row in enumerate(self._table.rows(result)):
            if number == MOST_ROWS:
                return
            yield {k: _cell(v) for k, v in row.items() if k not in LEAD and v is not None}

    def _pad(self, frame: Frame) -> Plain:
        image = frame.image
        return {**picture(image, *self._range.of(image)), "readings": readings(image)}

    @staticmethod
    def _drawing(result: Result) -> list[Plain]:
        drawn = list(shapes(truth_list(result.frame.truth or ()), ""))
        for name, value in result.outputs.items():
            if name == FRAME:
                continue
            found = shapes(display_list([value]), name)
            drawn += [s for s in found if s["shape"] not in ("heat", "cells", "note")]
        return drawn


class Range:
    """The range of colours: from 0 to what the pad has shown of late, so that they stay the same.

    A spike is forgotten after `KEPT_S`, or twice that at most.
    """

    def __init__(self) -> None:
        self._of: tuple[Any, ...] = ()
        self._since_s = -inf
        self._before = self._now = (0.0, 0.0)

    def of(self, image: Image) -> tuple[float, float]:
        """Return lowest and highest value of late of images of this kind."""
        kind = (image.shape, image.quantity)
        if self._of and kind != self._of:
            self._before = self._now = (0.0, 0.0)
        self._of = kind
        values = image.filled(0.0)
        self.widen(float(values.min(initial=0.0)), float(values.max(initial=0.0)))
        lows, highs = zip(self._before, self._now, strict=True)
        return min(lows), max(highs)

    def widen(self, low: float, high: float) -> None:
        """Have the range hold these."""
        now_s = time.perf_counter()
        if now_s - self._since_s > KEPT_S:
            self._since_s, self._before, self._now = now_s, self._now, (0.0, 0.0)
        self._now = min(self._now[0], low), max(self._now[1], high)


def _fared(story: Any) -> Plain:
    reason = visible(story.reason)[:LONGEST_REASON]
    return {"outcome": story.state, "reason": reason, "us": round(story.time_us, 1)}


def _look(frame: Frame, stories: Any, name: str) -> list[Plain]:
    """Return the picture of a node's value; empty where it has none."""
    if name == FRAME:
        return shapes(display_list(frame), name)
    story = stories.get(name)
    if story is None or story.value is None:
        return []
    return shapes(display_list(story.value), name)


def _cell(value: Any) -> Any:
    plain = without_nan(as_data(value, full=False))
    return visible(plain) if isinstance(plain, str) else plain
