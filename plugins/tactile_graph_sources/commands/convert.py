"""``tactile-graph convert``: frames of any source in another format, with their truth."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.completions import complete_source, complete_with
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import say
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import PluginError, TactileGraphError
from tactile_graph.foreign_text import pasted
from tactile_graph.plugins.names import OWN, Offer
from tactile_graph.plugins.registry import installed

if TYPE_CHECKING:
    from tactile_graph.steps.injected import Report
    from tactile_graph.wires.frame import Frame
    from tactile_graph_sources.writers.recording_writer import RecordingWriter

OFFERS = "recording_writers"


class Pitch(Finite):
    """A pitch in cm: a number above 0, or two of them, of columns and of rows."""

    def __init__(self) -> None:
        super().__init__(min=0, min_open=True)

    def convert(self, value: Any, param: Any, ctx: Any) -> Any:
        """Return the number, or both; a comma between whole ones may be a decimal one."""
        if re.fullmatch(r"\d+,\d+", text := str(value).strip()):
            point, both = text.replace(",", "."), text.replace(",", "x")
            ways = f"{point}, or {both} for two" if float(both.partition("x")[0]) else point
            self.fail(f"{text!r} may have a decimal comma: write {ways}", param, ctx)
        x, *y = re.split(r"\s*[,x×]\s*", text, maxsplit=1)
        one = super().convert(x, param, ctx)
        return (one, super().convert(y[0], param, ctx)) if y else one


@click.command()
@click.argument(
    "recordings",
    metavar="[RECORDING]...",
    nargs=-1,
    type=click.Path(readable=False, path_type=Path),
)
@click.argument("target", type=click.Path(path_type=Path))
@click.option(
    "--source",
    metavar="STEP",
    shell_complete=complete_source,
    help="Take frames from this source step instead.",
)
@click.option(
    "--with",
    "settings",
    metavar="KEY=VALUE",
    multiple=True,
    shell_complete=complete_with,
    help="A setting of the source, such as order=columns; can be repeated.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
              help="Seed of everything random.")  # fmt: skip
@click.option(
    "--frames",
    "n_frames",
    type=click.IntRange(min=1),
    help="Only the first so many; a source that makes its frames makes as many.",
)
@click.option("--rows", type=click.IntRange(min=1), help="Rows, where the file cannot tell.")
@click.option("--columns", type=click.IntRange(min=1), help="Columns, likewise.")
@click.option("--pitch-cm", metavar="FLOAT[,FLOAT]", type=Pitch(),
              help="Pitch, likewise; 0.8,1.2 or 1x2 of columns and of rows.")  # fmt: skip
@click.option("--quantity", help="What the values mean, likewise.")
@click.option(
    "--truth",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    help="What truly lay on the pad: a table of one object a line, or JSON; it replaces what the "
    "recording says of that.",
)
@click.option("--overwrite", is_flag=True, help="Write over a file that is there.")
def convert(
    recordings: tuple[Path, ...],
    target: Path,
    source: str | None,
    settings: tuple[str, ...],
    seed: int,
    n_frames: int | None,
    truth: Path | None,
    overwrite: bool,
    **told: Any,
) -> None:
    """Convert recordings, or the frames of a source, to TARGET: .zarr, .npz or .csv by its name.

    Plugins may write other files: 'tactile-graph plugins' lists what is installed.

    RECORDING is a Zarr store or any file that the source 'recording' reads, or a plugin's that
    --source names. Without any the frames are those of --source, such as a simulated one.
    """
    from tactile_graph.errors import UsageError
    from tactile_graph.plugins.devices import reads_device
    from tactile_graph.steps.injected import Report

    ending = _check(recordings, target, source, overwrite)
    writer: RecordingWriter = installed().load(OFFERS, ending)
    offer = installed().offer(OFFERS, ending)
    report, kept, opened = Report(), _Carried(), ExitStack()
    try:
        wanted = (source, settings, told, n_frames)
        frames = _frames(recordings, *wanted, seed, report)
        if truth is not None:
            from tactile_graph_sources.readers.words.truth_file import with_truth

            frames = opened.enter_context(closing(with_truth(frames, truth, report)))
        if source is not None and reads_device(source):
            frames = kept.until_ended(frames)  # what a pad gave is not to be had again
        elif source is not None and n_frames is None and not installed().has("readers", source):
            frames = kept.until_ended(frames, report)
        about = ", ".join(r.name for r in recordings) or str(source)
        with opened:
            n = _written(offer, target, kept.watch(islice(frames, n_frames)), about, report)
    except ValueError as error:
        raise UsageError(str(error)) from error
    if n or kept.ended is None:
        say(f"{target}: {n} frame{'s' if n != 1 else ''}")
    for what, count in report.counts.items():
        if what.startswith("recordings"):
            say(f"{what}: {count}", err=True)
    for line in report.few_troubles():
        say(line, err=True)
    lost = [name for name in kept.names if name in writer.loses]
    if lost:
        say(f"left out, as a {ending} has no place for it: {', '.join(lost)}", err=True)
    if kept.ended is not None:
        raise kept.ended


def _check(recordings: Sequence[Path], target: Path, source: str | None, overwrite: bool) -> str:
    """Return the ending of the target that says who writes it, in small letters."""
    from tactile_graph.cli.arguments import reader_of
    from tactile_graph.errors import did_you_mean
    from tactile_graph.files import check_target
    from tactile_graph_sources.stores.layout import is_store

    kinds = installed().offered(OFFERS)
    name = target.name
    fitting = [k for k in kinds if name.lower().endswith(k) and len(name) > len(k)]
    if not fitting:
        near = did_you_mean(target.suffix.lower(), kinds) if target.suffix else ""
        if target.suffix.lower() == ".mat" and ".csv" in kinds:
            near = "; MATLAB reads .csv by readtable"
        raise click.UsageError(f"TARGET must end in {', '.join(kinds)}, got {name!r}{near}")
    if not recordings and source is None:
        raise click.UsageError("give recordings before TARGET, or --source")
    if recordings and source is not None:
        reader_of([*map(str, recordings)], source)  # of a source that makes its frames: refused
    if target.is_dir() or (target.exists() and not overwrite):
        remedy = "" if target.is_dir() else ", or write over it with --overwrite"
        if is_store(target):
            remedy = f"; 'record --append {pasted(str(target))}' goes on with it"
        told = f"{target} is there already; remove it, or choose another name{remedy}"
        raise click.UsageError(told)
    check_target("TARGET", target)
    check_targets([("TARGET", target)])
    return max(fitting, key=len)


def _frames(
    recordings: Sequence[Path],
    source: str | None,
    settings: tuple[str, ...],
    told: dict[str, Any],
    n_frames: int | None,
    seed: int,
    report: Report,
) -> Iterator[Frame]:
    from tactile_graph.cli.arguments import reader_of, source_settings_of
    from tactile_graph_sources.commands.any_source import as_many, frames_of_source

    typed = source_settings_of(source or "recording", settings)
    given = {**typed, **{k: v for k, v in told.items() if v is not None}}
    if source is None:
        given["path"] = [str(r) for r in recordings]
    elif recordings:
        given |= reader_of([*map(str, recordings)], source)[1]
    else:
        given = as_many(source, given, n_frames)
    return frames_of_source(source or "recording", given, report, seed)


def _written(
    offer: Offer, target: Path, frames: Iterator[Frame], about: str, report: Report
) -> int:
    """Write frames, a pitch that is assumed as such; return how many there were.

    Raises
    ------
    PluginError
        If another plugin's writer breaks, or says that it wrote what is not there.
    """
    from tactile_graph_sources.readers.reading import PITCH_UNTOLD

    writer: RecordingWriter = offer.target
    first = list(islice(frames, 1))  # with it is known whether anybody says the pitch
    write = writer.write_untold if PITCH_UNTOLD in report.counts else None
    with _named(offer, target):
        n = (write or writer.write)(target, chain(first, frames), about)
    if n and not target.exists():
        told = f"says that it wrote {n} frame{'s' if n != 1 else ''}, and no file is there"
        raise PluginError(f"{target}: {_who(offer)} {told}")
    return n


def _who(offer: Offer) -> str:
    return f"writer {offer.name!r} of {offer.plugin.label}"


@contextmanager
def _named(offer: Offer, target: Path) -> Iterator[None]:
    """Name another plugin's writer and the file in errors that are none of ours."""
    from tactile_graph.engine.outcomes.notices import breaks

    try:
        yield
    except (TactileGraphError, MemoryError):
        raise
    except Exception as error:  # a plugin's own code may raise anything
        if offer.plugin.package == OWN or getattr(error, "filename", None) is not None:
            raise
        raise PluginError(f"{target}: {_who(offer)}: {breaks('write', error)}") from error


class _Carried:
    """Notes what frames carry beside their values, which not every file has a place for."""

    def __init__(self) -> None:
        self.names: dict[str, None] = {}
        self.ended: KeyboardInterrupt | None = None

    def until_ended(self, frames: Iterator[Frame], report: Report | None = None) -> Iterator[Frame]:
        """Yield frames until they end, or a signal ends them of which the report knows no end."""
        try:
            yield from frames
        except KeyboardInterrupt as error:
            if report is not None and report.n_expected is not None:
                raise
            self.ended = error

    def watch(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        from tactile_graph_sources.readers.words.truth import own_shapes
        from tactile_graph_sources.writers.recording_writer import OWN_SHAPES

        for frame in frames:
            for name, there in (
                ("truth", frame.truth is not None),
                ("device time", frame.device_time_s is not None),
                ("gaps", frame.gap),
                ("doubts", frame.doubtful),
                ("labels", bool(frame.label)),
                ("own numbers", frame.own_number not in (None, frame.index)),
                (OWN_SHAPES, bool(own_shapes(frame.truth))),
            ):
                if there:
                    self.names[name] = None
            yield frame
