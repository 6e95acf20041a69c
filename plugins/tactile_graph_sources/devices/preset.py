"""What a kit's preset may say: five separate choices, as records that check themselves."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, ConfigDict, Discriminator, Field, field_validator, model_validator

from tactile_graph.quantities import QuantityName

Number = Literal["u8", "i8", "u16le", "u16be", "u32le", "u32be", "i16le", "i16be", "f32le"]
DTYPES: dict[str, str] = {
    "u8": "u1", "i8": "i1", "u16le": "<u2", "u16be": ">u2", "u32le": "<u4", "u32be": ">u4",
    "i16le": "<i2", "i16be": ">i2", "f32le": "<f4",
}  # fmt: skip


def _hex(value: object) -> object:
    if not isinstance(value, str):
        raise ValueError("must be bytes in hex, such as 'AA 55'; put it in quotes")
    try:
        return bytes.fromhex(value)
    except ValueError:
        raise ValueError(f"must be bytes in hex, such as 'AA 55', got {value!r}") from None


class Record(BaseModel):
    """Base of all preset records: frozen, unknown keys refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Transport(Record):
    """Choice 1: the port's own settings.

    Parameters
    ----------
    baud : int
        Bits a second on the line.
    dtr, rts : bool, optional
        State of the control lines as the port is opened; the driver's own by default.
    silence_s : float
        A pause this long ends a reply.
    """

    baud: Annotated[int, Field(gt=0)]
    dtr: bool | None = None
    rts: bool | None = None
    silence_s: Annotated[float, Field(gt=0)] = 0.02


class Request(Record):
    """Choice 2: what the host sends to get frames, and when.

    Parameters
    ----------
    send : bytes
        In hex, such as ``'AA 55'``, or letters after ``text:``.
    when : "start" or "frame"
        Once after the port is opened, or for each frame.
    """

    send: bytes
    when: Literal["start", "frame"] = "frame"

    @field_validator("send", mode="before")
    @classmethod
    def _text_or_hex(cls, value: object) -> object:
        if isinstance(value, str) and value.startswith("text:"):
            return value[5:].encode()
        return _hex(value)


class Magic(Record):
    """Bytes that are always the same.

    Parameters
    ----------
    part : "magic"
    bytes : bytes
        In hex, such as ``AA 55``.
    """

    part: Literal["magic"]
    bytes: bytes

    @field_validator("bytes", mode="before")
    @classmethod
    def _from_hex(cls, value: object) -> object:
        return _hex(value)


class Skip(Record):
    """Bytes without a known meaning.

    Parameters
    ----------
    part : "skip"
    size : int
        How many.
    """

    part: Literal["skip"]
    size: Annotated[int, Field(gt=0)]


class Cells(Record):
    """The values: all cells, or one row, chunk or cell, by the assembler.

    Parameters
    ----------
    part : "cells"
    type : str
        Number format of a cell: unsigned, signed or floating, its bits, little or big endian.
    count : int, optional
        Cells in one packet, where that is not what the assembler says.
    mask : int, optional
        Bits of a cell's number that are its value; all by default.
    row_tag : bool
        Whether the four top bits of each number count the row.
    """

    part: Literal["cells"]
    type: Number
    count: Annotated[int, Field(gt=0)] | None = None
    mask: Annotated[int, Field(gt=0)] | None = None
    row_tag: bool = False


class Value(Record):
    """A number beside the cells.

    Parameters
    ----------
    part : str
        What it is: ``sequence`` counts units, ``time`` is the device's clock, ``length`` must
        equal ``equals``, ``start`` is the first cell (or row) of a chunk, ``device`` tells apart
        pads that share a line.
    type : str
        Its number format.
    equals : int, optional
        The only right value; packets of any other are refused.
    first : int
        What the first cell (or row) is called.
    unit_s : float
        Seconds that one step of a clock takes.
    """

    part: Literal["sequence", "time", "length", "start", "device"]
    type: Number
    equals: int | None = None
    first: int = 0
    unit_s: Annotated[float, Field(gt=0)] = 1e-6


class Checksum(Record):
    """A CRC over all bytes from ``after`` to itself.

    Parameters
    ----------
    part : "crc16"
    variant : str
        Which CRC: polynomial, start value and reflection go by these names.
    order : "le" or "be"
        Whether its low or its high byte comes first.
    after : int
        Bytes at the packet's beginning that it leaves out.
    """

    part: Literal["crc16"]
    variant: Literal["ccitt-false", "xmodem", "modbus", "kermit", "arc"]
    order: Literal["le", "be"] = "be"
    after: Annotated[int, Field(ge=0)] = 0


Part: TypeAlias = Annotated[Magic | Skip | Cells | Value | Checksum, Discriminator("part")]


class Packet(Record):
    """Choice 3a: units of fixed size.

    Parameters
    ----------
    kind : "packet"
    layout : tuple of parts
        What follows what in a packet; exactly one part is ``cells``.
    """

    kind: Literal["packet"]
    layout: tuple[Part, ...]

    @model_validator(mode="after")
    def _one_cells(self) -> Packet:
        if sum(isinstance(p, Cells) for p in self.layout) != 1:
            raise ValueError("layout must hold exactly one part 'cells'")
        return self


class Text(Record):
    """Choice 3b: lines of numbers, as ``12,-3,4.5,nan``; ``nan`` is an element without a value.

    Parameters
    ----------
    kind : "text"
    numbers : "any" or "whole"
        Whether they may have a sign, a point and an exponent, or are whole numbers from 0 on; then
        a line that holds anything else is refused, as damaged on its way.
    prefix : str
        What a line of values begins with; other lines are passed over.
    separator : str
        One character between the numbers.
    trailing_separator : bool
        Whether one stands behind the last number too.
    time_unit_s : float, optional
        Given where a time comes first: seconds that one step of it takes.
    size_prefix : str
        What the line that announces the size begins with.
    """

    kind: Literal["text"]
    numbers: Literal["any", "whole"] = "any"
    prefix: str = ""
    separator: Annotated[str, Field(min_length=1, max_length=1)] = ","
    trailing_separator: bool = False
    time_unit_s: Annotated[float, Field(gt=0)] | None = None
    size_prefix: str = ""


class Delimited(Record):
    """Choice 3c: bytes up to an end byte.

    Parameters
    ----------
    kind : "delimited"
    end : bytes
        The end byte in hex, such as ``FF``.
    coding : "plain" or "zero_runs"
        A byte a cell, or runs of zeros as ``00 n``.
    """

    kind: Literal["delimited"]
    end: bytes
    coding: Literal["plain", "zero_runs"] = "plain"

    @field_validator("end", mode="before")
    @classmethod
    def _one_byte(cls, value: object) -> object:
        end = _hex(value)
        if not isinstance(end, bytes) or len(end) != 1:
            raise ValueError(f"must be one byte in hex, such as 'FF', got {value!r}")
        return end


class Geometry(Record):
    """Choice 5: how the cells on the wire lie on the pad.

    Parameters
    ----------
    rows, columns : int
        Number of cells down and across, as they come.
    order : "rows" or "columns"
        Whether a row or a column is sent as a whole.
    transpose : bool
        Whether rows and columns are swapped then.
    flip : str
        Whether the order of the rows, the columns or both is reversed then.
    row_map, column_map : tuple of int, optional
        Where each row (column) that comes lies on the pad, counted from 0.
    valid_range : (float, float), optional
        Least and greatest value that a cell can have; a frame with any other is refused.
    invert_from : float, optional
        A value v becomes ``invert_from - v``, where readings fall under pressure.
    quantity : str
        What the values mean: counts, volt, gram, …
    pitch_cm : float or (float, float)
        Distance of neighbouring centres; x and y where they differ.
    """

    rows: Annotated[int, Field(gt=0)]
    columns: Annotated[int, Field(gt=0)]
    order: Literal["rows", "columns"] = "rows"
    transpose: bool = False
    flip: Literal["none", "rows", "columns", "both"] = "none"
    row_map: tuple[int, ...] | None = None
    column_map: tuple[int, ...] | None = None
    valid_range: tuple[float, float] | None = None
    invert_from: float | None = None
    quantity: QuantityName = "counts"
    pitch_cm: float | tuple[float, float] = 1.0

    @model_validator(mode="after")
    def _maps(self) -> Geometry:
        for name, got, n in (
            ("row_map", self.row_map, self.rows),
            ("column_map", self.column_map, self.columns),
        ):
            if got is not None and sorted(got) != list(range(n)):
                raise ValueError(f"{name} must name each of 0 to {n - 1} once, got {list(got)}")
        if self.valid_range is not None and self.valid_range[0] > self.valid_range[1]:
            raise ValueError(f"valid_range must go from low to high, got {self.valid_range}")
        return self

    @property
    def n_cells(self) -> int:
        """Cells in a frame."""
        return self.rows * self.columns


class Preset(Record):
    """One kit: transport, request, framer, assembler and geometry.

    Parameters
    ----------
    preset : str
        Its name.
    about : str
        One line for people.
    cannot_tell : str
        What the protocol cannot tell, for people.
    transport : Transport
    request : Request, optional
    framer : Packet, Text or Delimited
        Choice 3: how units are found in the stream.
    assembler : str
        Choice 4: what one unit brings: a full frame, a row, a chunk or one cell.
    geometry : Geometry
    """

    preset: str
    about: str = ""
    cannot_tell: str = ""
    transport: Transport
    request: Request | None = None
    framer: Annotated[Packet | Text | Delimited, Discriminator("kind")]
    assembler: Literal["full", "rows", "chunks", "cells"] = "full"
    geometry: Geometry

    @model_validator(mode="after")
    def _agree(self) -> Preset:
        self._check_layout()
        if self.framer.kind != "packet" and self.assembler in ("chunks", "cells"):
            raise ValueError(f"assembler {self.assembler!r} needs framer kind 'packet'")
        if isinstance(self.framer, Delimited) and self.assembler != "full":
            raise ValueError("framer kind 'delimited' needs assembler 'full'")
        if self.framed_by_silence and self.request is None and self.framer.kind == "packet":
            raise ValueError(
                "a layout without magic, row_tag or crc16 cannot be found in a stream; "
                "it needs a request for each frame"
            )
        return self

    def _check_layout(self) -> None:
        if not isinstance(self.framer, Packet):
            return
        starts = [p for p in self.framer.layout if isinstance(p, Value) and p.part == "start"]
        if self.assembler != "full" and len(starts) != 1:
            raise ValueError(f"assembler {self.assembler!r} needs one part 'start' in the layout")
        if self.assembler == "chunks" and self.cells.count is None:
            raise ValueError("assembler 'chunks' needs 'count' at the part 'cells'")

    @property
    def cells(self) -> Cells:
        """The layout's part that holds the values; packets only."""
        assert isinstance(self.framer, Packet)
        return next(p for p in self.framer.layout if isinstance(p, Cells))

    @property
    def framed_by_silence(self) -> bool:
        """Whether only the end of a reply, or a pause, tells where a frame ends."""
        if isinstance(self.framer, Packet):
            return not any(
                isinstance(p, Magic | Checksum) or (isinstance(p, Cells) and p.row_tag)
                for p in self.framer.layout
            )
        return isinstance(self.framer, Text) and self.assembler == "rows"


def unit_cells(preset: Preset) -> int:
    """Return how many cells one unit (packet, line) brings."""
    g = preset.geometry
    if isinstance(preset.framer, Packet) and preset.cells.count is not None:
        return preset.cells.count
    return {"full": g.n_cells, "rows": g.columns, "chunks": g.n_cells, "cells": 1}[preset.assembler]


def meaning_of(preset: Preset) -> dict[str, Any]:
    """Return by key what tells what a preset's values mean: its name, its numbers, its geometry.

    What only tells how they come (port, framing, allowed range) is left out.
    """
    told = preset.geometry.model_dump(mode="json", exclude={"valid_range"}, exclude_defaults=True)
    if isinstance(preset.framer, Packet):
        cells = preset.cells.model_dump(mode="json", exclude_defaults=True)
        told |= {f"cells.{key}": value for key, value in cells.items() if key != "part"}
    return {"preset": preset.preset, **told}
