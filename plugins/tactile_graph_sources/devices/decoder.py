"""``Decoder``: bytes in, frames out; knows nothing of ports, threads or clocks."""

from __future__ import annotations

from itertools import compress, repeat
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tactile_graph_sources.devices.assembly import BetweenSilences, Pieces, Sequence, Whole
from tactile_graph_sources.devices.counters import LinkCounts
from tactile_graph_sources.devices.delimited import DelimitedFramer
from tactile_graph_sources.devices.device_clock import DeviceClock
from tactile_graph_sources.devices.geometry import Placement
from tactile_graph_sources.devices.layout import Layout
from tactile_graph_sources.devices.packet import PacketFramer
from tactile_graph_sources.devices.preset import Packet, Preset, Text
from tactile_graph_sources.devices.reply import ReplyFramer
from tactile_graph_sources.devices.text import TextFramer
from tactile_graph_sources.devices.units import Assembled, Units


class Decoded(NamedTuple):
    """One frame: values (rows, columns), device clock, loss just before it, place of its end.

    Values are NaN where the pad sent none.

    ``doubtful`` is true where the protocol cannot tell whether a frame starts there.
    """

    values: NDArray[np.float64]
    device_time_s: float | None
    gap: bool
    end: int
    doubtful: bool = False


class Decoder:
    """Turns a kit's bytes into frames, whatever the chunks they come in.

    Parameters
    ----------
    preset : Preset
    """

    def __init__(self, preset: Preset) -> None:
        self.preset = preset
        self.counts = LinkCounts()
        self.placement = Placement(preset.geometry, missing=isinstance(preset.framer, Text))
        self.framer = _framer(preset, self.counts)
        self.assembler = _assembler(preset, self.framer, self.counts)
        self._clock = _clock(preset)
        self._by_silence = preset.framed_by_silence
        self._one_reply = preset.assembler == "full"
        self._lost = False
        self._out_of_range = ""

    @property
    def complete(self) -> bool:
        """Whether a whole reply is there and only its silence is waited for."""
        if isinstance(self.framer, ReplyFramer):
            return self.framer.complete
        return isinstance(self.framer, PacketFramer) and self.framer.complete and self._one_reply

    def feed(self, data: bytes) -> list[Decoded]:
        """Take bytes, return the frames that they complete."""
        self.counts.bytes += len(data)
        return self._frames(self.framer.feed(data))

    def boundary(self) -> list[Decoded]:
        """Take note of a silence (the end of a reply, a pause), return what it completes.

        A kit whose frames are found by what they hold takes no notice: a pause inside a line is
        the host's own hiccup.
        """
        if isinstance(self.framer, PacketFramer):
            self.framer.boundary()
        return self._frames(self.framer.boundary()) if self._by_silence else []

    def reset(self) -> None:
        """Start afresh after a reconnect; the next frame is marked as following a gap."""
        self.discard()
        self.assembler.reset()
        if self._clock is not None:
            self._clock.reset()
        self._lost = self.counts.good > 0

    def discard(self) -> None:
        """Drop what has come of the next unit."""
        self.framer.reset()

    def hint(self) -> str:
        """Return what the bytes themselves say about why no frame is found; may be empty."""
        counted = self.assembler.hint() if isinstance(self.assembler, BetweenSilences) else ""
        return "; ".join(filter(None, (self._out_of_range, self.framer.hint(), counted)))

    def _frames(self, runs: list[Units]) -> list[Decoded]:
        out: list[Decoded] = []
        for units in runs:
            for batch in self.assembler.feed(units):
                self._emit(batch, out)
        return out

    def _emit(self, batch: Assembled, out: list[Decoded]) -> None:
        cells, ends, gap, time = batch.cells, batch.ends, batch.gap, batch.time
        times = self._clock.seconds(time) if self._clock and time is not None else None
        good = self.placement.in_range(cells)
        ends_well = bool(good[-1])
        if good.any():
            self._out_of_range = ""
        if not good.all():
            self._refuse(cells[~good])
            gap = (gap | np.concatenate([[False], ~good[:-1]]))[good]
            times = None if times is None else list(compress(times, good))
            cells, ends = cells[good], ends[good]
        if len(cells):
            lost = gap.tolist()
            lost[0] = (lost[0] or self._lost) and self.counts.good > 0
            self.counts.good += len(cells)
            self.counts.doubtful += len(cells) * batch.doubtful
            images = self.placement.images(cells)
            clock = repeat(None) if times is None else times
            out.extend(map(Decoded, images, clock, lost, ends.tolist(), repeat(batch.doubtful)))
            self._lost = False
        if not ends_well:
            self._lost = True

    def _refuse(self, cells: NDArray[Any]) -> None:
        self.counts.bad["out of range"] += len(cells)
        known = cells[~np.isnan(cells)] if self.placement.missing else cells
        self._out_of_range = (
            f"values of {known.min():g} to {known.max():g} came, "
            f"the preset allows {self.placement.range or 'finite ones'}"
        )


Framer = PacketFramer | ReplyFramer | DelimitedFramer | TextFramer


def _framer(preset: Preset, counts: LinkCounts) -> Framer:
    if isinstance(preset.framer, Packet):
        layout = Layout(preset)
        if preset.framed_by_silence:
            return ReplyFramer(layout, counts)
        return PacketFramer(layout, counts)
    if isinstance(preset.framer, Text):
        return TextFramer(preset, counts)
    return DelimitedFramer(preset, counts)


def _assembler(
    preset: Preset, framer: Framer, counts: LinkCounts
) -> Whole | Pieces | BetweenSilences:
    places = framer.layout.places if isinstance(framer, PacketFramer | ReplyFramer) else {}
    number = places.get("sequence")
    sequence = Sequence(256**number.dtype.itemsize if number else 1, counts)
    g = preset.geometry
    if preset.assembler == "full":
        return Whole(sequence)
    if isinstance(preset.framer, Text):
        return BetweenSilences(g.rows, preset.transport.silence_s, counts)
    return Pieces(g.n_cells, g.columns if preset.assembler == "rows" else 1, sequence, counts)


def _clock(preset: Preset) -> DeviceClock | None:
    framer = preset.framer
    if isinstance(framer, Text):
        return DeviceClock(framer.time_unit_s, 2**32) if framer.time_unit_s else None
    if isinstance(framer, Packet):
        place = Layout(preset).places.get("time")
        if place is not None:
            return DeviceClock(place.value.unit_s, 256**place.dtype.itemsize)
    return None
