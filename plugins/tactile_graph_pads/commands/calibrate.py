"""``tactile-graph calibrate``: from recordings of known loads to a calibration file."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from tactile_graph.cli.arguments import reader_settings, with_option
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import say

if TYPE_CHECKING:
    from tactile_graph.wires import Frame
    from tactile_graph_pads.calibration.calibration import Calibration, Origin, Provenance
    from tactile_graph_pads.calibration.groups import GroupReader
    from tactile_graph_pads.calibration.lists import Loaded
    from tactile_graph_pads.calibration.points import Observation

SOURCE = "recording"
MOST_KEPT = 16_384
"""Elements of which a file can keep an offset; YAML with more values is refused."""
FITS = ("polynomial", "isotonic", "sums", "power")


class _Group(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    name = "group"

    def convert(self, value: Any, param: Any, ctx: Any) -> tuple[int, int] | str:
        if not isinstance(value, str) or value == "all":
            return value  # type: ignore[no-any-return]
        rows, _, columns = value.lower().partition("x")
        if not (rows.isdecimal() and columns.isdecimal() and int(rows) and int(columns)):
            self.fail(f"must be ROWSxCOLUMNS or 'all', got {value!r}", param, ctx)
        return int(rows), int(columns)


@click.command()
@click.argument("recordings", nargs=-1, metavar="[FILE=GRAMS | FILE]...")
@click.option("-o", "--output", type=click.Path(dir_okay=False, path_type=Path),
              help="Where the calibration goes; without it, it is only said.")  # fmt: skip
@click.option("--loads", type=click.Path(exists=True, dir_okay=False, path_type=Path),
              help="Recordings by list: YAML (file: grams), CSV (recording, load_g).")  # fmt: skip
@click.option("--fit", type=click.Choice(FITS), default="polynomial", show_default=True,
              help="The thesis' polynomial; rising straight lines through the group means; such "
              "lines that make each group's sum right; a power of the reading.")  # fmt: skip
@click.option("--order", type=click.IntRange(1, 9), default=5, show_default=True,
              help="Of the polynomial.")  # fmt: skip
@click.option("--group", type=_Group(), default="2x2", show_default=True,
              help="Neighbours that share each load: ROWSxCOLUMNS, or 'all'.")  # fmt: skip
@click.option("--at", nargs=2, type=click.IntRange(min=0), metavar="ROW COLUMN",
              help="The group's top left element; otherwise the strongest group.")  # fmt: skip
@click.option("--pad", "pad_name", help="A pad by name or file: counts become volts by it.")
@click.option("--decouple", is_flag=True,
              help="Take the pad's crosstalk out first: a curve of conductance.")  # fmt: skip
@click.option("--empty", type=click.Path(exists=True, path_type=Path),
              help="A recording of the empty pad; its median is taken off, and kept in the file "
              "for the step force to do the same.")  # fmt: skip
@with_option
@click.option("--full-scale", type=Finite(), help="Reading from which on an element is saturated.")
@click.option("--about", default="", help="A line for people, kept in the file.")
@click.option("--plot", type=click.Path(dir_okay=False, path_type=Path),
              help="Draw points, error bars and curve (.png, .svg, .pdf).")  # fmt: skip
def calibrate(recordings: tuple[str, ...], **options: Any) -> None:
    """Fit grams on an element to its reading, from recordings of known loads.

    Each FILE=GRAMS is a recording of one weight on a group of neighbouring elements; the weight
    is shared by them, and their readings are averaged (thesis section 2.4.2). A FILE alone holds
    many loads: its frames say their own.
    """
    from tactile_graph.cli.targets import check_targets
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target
    from tactile_graph_pads.calibration.calibration import write_calibration
    from tactile_graph_pads.calibration.fit import calibrated, fitted_g
    from tactile_graph_pads.calibration.lists import parse_loaded, read_loads
    from tactile_graph_pads.calibration.plot import check_picture, save_calibration_plot
    from tactile_graph_pads.calibration.points import points_of

    asked = _Options(**options)
    if asked.plot is not None:
        check_picture(asked.plot)
    if asked.output is not None:
        check_target("-o", asked.output)
    given = [*map(parse_loaded, recordings), *(read_loads(asked.loads) if asked.loads else ())]
    if not given:
        raise UsageError("nothing to calibrate from: give recordings as FILE=GRAMS, or --loads")
    written = (("-o", asked.output), ("--plot", asked.plot))
    check_targets(written, read=[one.path for one in given])
    settings = reader_settings(SOURCE, asked.source_settings)
    empty = None if asked.empty is None else _recording(asked.empty, settings)
    reader = _reader(asked, empty)
    if asked.output is not None and reader.offset is not None:
        _check_kept(reader.offset.size, str(asked.empty))
    observed = _observe(given, reader, empty, settings)
    points, fit, seen = points_of(observed.seen), asked.fit, observed.seen
    made = replace(
        calibrated(points, fit, observed.quantity, asked.order, seen),
        about=asked.about,
        provenance=_provenance(asked, observed, empty),
        offset=() if reader.offset is None else tuple(map(tuple, reader.offset.tolist())),
    )
    if observed.assumed:
        say(
            f"recordings that do not say their quantity are taken for counts of pad "
            f"{asked.pad_name}; frames of such a recording want --with quantity=counts"
        )
    _say(made, fitted_g(made.fit, points, seen if fit == "sums" else ()), fit)
    if asked.output is not None:
        write_calibration(asked.output, made)
        say(f"wrote {asked.output}")
    if asked.plot is not None:
        save_calibration_plot(asked.plot, made)
        say(f"wrote {asked.plot}")


@dataclass(frozen=True)
class _Options:
    """What the command line says, by the names of its options."""

    output: Path | None
    loads: Path | None
    fit: Any
    order: int
    group: tuple[int, int] | str
    at: tuple[int, int] | None
    pad_name: str | None
    decouple: bool
    empty: Path | None
    source_settings: tuple[str, ...]
    full_scale: float | None
    about: str
    plot: Path | None

    @property
    def group_shape(self) -> tuple[int, int] | None:
        """Rows and columns of the loaded group; None for the whole pad."""
        return None if isinstance(self.group, str) else self.group


class _Recording(NamedTuple):
    """A recording's frames, where they come from, and whether it says its pitch."""

    path: Path
    frames: list[Frame]
    origin: Origin
    pitch_known: bool


class _Observed(NamedTuple):
    """What the recordings hold: observations, where from, of what quantity and shape."""

    seen: list[Observation]
    origins: list[Origin]
    quantity: Any
    shape: tuple[int, int]
    assumed: bool
    """Whether recordings that do not say their quantity were taken for the pad's counts."""


def _provenance(asked: _Options, observed: _Observed, empty: _Recording | None) -> Provenance:
    from tactile_graph_pads.calibration.calibration import Provenance

    return Provenance(
        made_by=_made_by(),
        made_at=_now(),
        command=("tactile-graph", *sys.argv[1:]),
        pad=asked.pad_name or "",
        decoupled=asked.decouple,
        group=asked.group_shape or observed.shape,
        recordings=tuple(observed.origins),
        empty=None if empty is None else empty.origin,
    )


def _check_kept(n_elements: int, empty: str) -> None:
    """Refuse an offset that no file could keep: its grams would be wrong without."""
    from tactile_graph.errors import UsageError

    if n_elements > MOST_KEPT:
        raise UsageError(
            f"--empty {empty}: has {n_elements} elements, and a calibration file keeps what the "
            f"empty pad reads of {MOST_KEPT} at most; leave -o out, or record a part of the pad"
        )


# -- reading it ------------------------------------------------------------------------------


def _reader(asked: _Options, empty: _Recording | None) -> GroupReader:
    from tactile_graph.errors import UsageError
    from tactile_graph_pads.calibration.groups import GroupReader, empty_of
    from tactile_graph_pads.pad import load_pad

    if asked.decouple and asked.pad_name is None:
        raise UsageError("--decouple needs --pad: whose circuit is it?")
    pad = None if asked.pad_name is None else load_pad(asked.pad_name)
    rest = None if empty is None else empty_of(empty.frames, str(empty.path))
    return GroupReader(
        asked.group_shape, asked.at or None, pad, asked.decouple, asked.full_scale, rest
    )


def _recording(path: Path, settings: Mapping[str, Any]) -> _Recording:
    """Return a recording, read by whichever plugin offers that source."""
    from tactile_graph.errors import DataError, UsageError
    from tactile_graph.plugins.registry import installed
    from tactile_graph.steps.injected import Report
    from tactile_graph_pads.calibration.calibration import Origin

    steps, report = installed(), Report()
    if not steps.has("steps", SOURCE):
        raise UsageError(f"recordings need the step {SOURCE!r}: {steps.unknown('steps', SOURCE)}")
    frames = list(steps.load("steps", SOURCE)(path=path, report=report, **settings))
    if not frames:
        raise DataError(str(path), "holds no frame")
    digest = next(iter(report.digests.values()), "")
    pitch_known = not any("pitch is assumed" in what for what in report.counts)
    return _Recording(path, frames, Origin(path.name, digest, len(frames)), pitch_known)


def _check_same(first: _Recording, other: _Recording, reader: GroupReader) -> None:
    """Refuse a recording of another pad, or one that the curve would read in another unit."""
    from tactile_graph_pads.same_pad import check_same_pad

    check_same_pad(
        first.frames[0].image,
        other.frames[0].image,
        str(first.path),
        str(other.path),
        read_as=reader.read_as,
        pitch_known=first.pitch_known and other.pitch_known,
    )


def _observe(
    given: Sequence[Loaded],
    reader: GroupReader,
    empty: _Recording | None,
    settings: Mapping[str, Any],
) -> _Observed:
    from tactile_graph.errors import DataError

    seen: list[Observation] = []
    origins: list[Origin] = []
    first, assumed = empty, False
    for path, load_g in given:
        recording = _recording(path, settings)
        first = recording if first is None else first
        _check_same(first, recording, reader)
        recorded = recording.frames[0].image.quantity
        assumed |= reader.recorded_as(recorded) != recorded
        seen += reader.observations(recording.frames, load_g, str(path))
        if recording.origin not in origins:
            origins.append(recording.origin)
    assert first is not None
    if not seen:
        raise DataError("calibration", "too few loads: every frame is of the empty pad")
    image = first.frames[0].image
    quantity = reader.read_as(image.quantity)
    if quantity not in ("volt", "siemens", "counts", "raw"):
        raise DataError(
            "calibration", f"only readings can be calibrated, these are {quantity} already"
        )
    return _Observed(seen, origins, quantity, image.shape, assumed)


def _made_by() -> str:
    from tactile_graph.code_version import code_version

    return f"tactile-graph {code_version()}"


def _now() -> str:
    from datetime import UTC, datetime

    return datetime.now(UTC).isoformat(timespec="seconds")


# -- saying it -------------------------------------------------------------------------------


def _say(made: Calibration, fitted: Any, kind: str) -> None:
    from rich.table import Table

    from tactile_graph.cli.terminal import console

    table = Table(box=None, header_style="bold", pad_edge=False)
    unit = made.units.reading
    for name in ("load / g", f"reading / {unit}", "group SD / %", "single SD / %",
                 "placements", "fit / g", "off / %"):  # fmt: skip
        table.add_column(name, justify="right")
    for p, grams in zip(made.points, fitted, strict=True):
        table.add_row(
            f"{p.load_g:.4g}", f"{p.reading:.4g}",
            *(f"{100 * sd / p.reading:.1f}" for sd in (p.sd, p.sd_single)),
            str(p.placements), f"{grams:.4g}", f"{100 * (grams / p.load_g - 1):+.1f}",
        )  # fmt: skip
    say = console()
    say.print(table)
    q = made.quality
    say.print(
        f"{kind} fit of {len(made.points)} loads, for readings up to {made.up_to:.4g} "
        f"{unit}: off by {q.rms_percent:.1f} % (rms), {q.largest_percent:.1f} % at most; "
        f"{q.rms_g:.3g} g rms; R² {q.r_squared:.4f}",
        soft_wrap=True,
    )
