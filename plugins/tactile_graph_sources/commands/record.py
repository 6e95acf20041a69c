"""``tactile-graph record``: a pad on a port, or any other source, into a Zarr store."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import suppress
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.completions import complete_source, complete_with
from tactile_graph.cli.numbers import Finite
from tactile_graph.cli.say import clock, say
from tactile_graph.cli.targets import check_targets
from tactile_graph.foreign_text import pasted

if TYPE_CHECKING:
    from tactile_graph.errors import DataError
    from tactile_graph.steps.injected import Report
    from tactile_graph.wires.frame import Frame
    from tactile_graph_sources.writers.write_store import StoreWriter

SHOW_EVERY_S = 0.5
BEHIND = 500
"""Frames that have come and are not written at which it is told; a queue takes about 1000."""
UNTOLD = ("bytes", "good frames", "frames", "troubles")
FILES = (".npz", ".npy", ".csv", ".jsonl", ".json", ".txt")
EXIT_CODES = """\b
Exit codes:
  0    done; frames were written, until Ctrl-C or the pad was given up too
  2    not done: no frame was written, or something went wrong on the way
  143  ended by SIGTERM (129: its terminal was closed); what came is kept
"""


@click.command(epilog=EXIT_CODES)
@click.argument("target", type=click.Path(path_type=Path))
@click.option("--port", help="Device or pyserial URL; see 'ports'.")
@click.option("--device", default="serial", show_default=True,
              help="How the pad hangs on this machine; plugins may know other ways.")  # fmt: skip
@click.option("--preset", help="The kit's name, or a YAML file.")
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
    help="A setting of that source, or of the device's, as under 'with:'; can be repeated.",
)
@click.option("--baud", type=click.IntRange(min=1), help="Instead of the preset's.")
@click.option("--frames", "n_frames", type=click.IntRange(min=1), help="End after so many.")
@click.option("--seconds", type=Finite(min=0, min_open=True), help="End after so long.")
@click.option("--pad", default="", help="Name of the pad, kept with the recording.")
@click.option("--append", is_flag=True, help="Go on with a recording that is there.")
@click.option(
    "--chunk",
    type=click.IntRange(min=1),
    default=256,
    show_default=True,
    help="Frames written at a time; a crash loses at most so many.",
)
@click.option(
    "--give-up",
    type=Finite(min=0, min_open=True),
    help="End after so many seconds without a frame; otherwise it waits for the pad.",
)
def record(
    target: Path,
    port: str | None,
    device: str,
    preset: str | None,
    source: str | None,
    settings: tuple[str, ...],
    baud: int | None,
    n_frames: int | None,
    seconds: float | None,
    pad: str,
    append: bool,
    chunk: int,
    give_up: float | None,
) -> None:
    """Record every frame of a pad, or of another source, into the Zarr store TARGET, until Ctrl-C.

    Frames carry the host's time, the pad's own time where it sends one, and marks where some were
    lost. A pad that is unplugged is waited for. Ctrl-C ends the reading, and what has come by then
    is written; a second one ends at once.
    """
    from tactile_graph.cli.endings import NOT_DONE
    from tactile_graph.cli.interrupt import Ended, Interrupts, code_of, words_of
    from tactile_graph.errors import TactileGraphError, UsageError
    from tactile_graph.steps.injected import Report
    from tactile_graph_sources.commands.captured import captured
    from tactile_graph_sources.stores.layout import is_store
    from tactile_graph_sources.writers.write_store import StoreWriter

    told = {"preset": preset, "baud": baud, "give_up_s": give_up}
    step, given = captured(port, device, told, source)
    _check_target(target)
    report = Report(listener=partial(_heard, source is None))
    limits = {"n_frames": n_frames, "seconds": seconds}
    frames = _frames(step, given, settings, limits, report)
    failure: Exception | None = None
    gone: list[DataError] = []
    ended: KeyboardInterrupt | None = None
    store: StoreWriter | None = None
    with Interrupts() as interrupts:
        interrupts.politely = partial(_read_no_more, report)
        try:
            about = _about(preset, pad, port or f"source {source}")
            with StoreWriter(target, chunk, append, about) as store:
                kept = frames if give_up is None else _until_gone(frames, gone)
                _keep(kept, store, report, interrupts.again)
            ended = interrupts.heeded
        except KeyboardInterrupt as error:
            ended = error  # what was held is written by now
        except TactileGraphError as error:
            failure = error
        finally:
            if isinstance(frames, Generator):
                frames.close()
    there = store is not None and is_store(target)  # or it was moved away meanwhile
    if store is not None and (failure is None or (there and store.n_written > store.n_before)):
        _tell(store, report, by_port=source is None)
        if ended is not None and ended is not interrupts.heeded and (n := report.n_waiting):
            say(f"  not written: {_frames_in_words(n)} that had come", err=True)
    if failure is not None:
        if isinstance(failure, UsageError) and there:
            say(f"'record --append {pasted(str(target))}' goes on with it", err=True)
        raise failure
    if ended is not None and (store is None or isinstance(ended, Ended)):
        say(words_of(ended), err=True)
        click.get_current_context().exit(code_of(ended))
    for why in gone:
        say(f"given up: {why}", err=True)
    if store is None or store.n_written == store.n_before:
        click.get_current_context().exit(NOT_DONE)


def _heard(by_port: bool, where: str, what: str) -> None:
    """Say what the source tells; of a port, when it was."""
    say(f"{clock()}  {where}: {what}" if by_port else f"{where}: {what}", err=True)


def _about(preset: str | None, pad: str, port: str) -> dict[str, Any]:
    """Return what is kept with the recording, the preset by content too: its file may change."""
    told: dict[str, Any] = {"preset": preset or "", "pad": pad, "port": port}
    if preset is None:
        return told
    from tactile_graph.errors import TactileGraphError
    from tactile_graph_sources.devices.preset import meaning_of
    from tactile_graph_sources.devices.preset_file import load_preset

    with suppress(TactileGraphError):  # the device says so, where it knows no such preset either
        told["meaning"] = meaning_of(load_preset(preset))
    return told


def _until_gone(frames: Iterator[Frame], gone: list[DataError]) -> Iterator[Frame]:
    """Yield the frames of a source that gives up as it was told; add why, where some came."""
    from tactile_graph.errors import DataError

    came = False
    try:
        for frame in frames:
            came = True
            yield frame
    except DataError as error:
        if not came:
            raise
        gone.append(error)


def _frames(
    step: str,
    given: Mapping[str, Any],
    texts: tuple[str, ...],
    limits: Mapping[str, Any],
    report: Report,
) -> Iterator[Frame]:
    """Return the frames of a source, as many and as long as it is told; it may end by itself."""
    from tactile_graph.cli.arguments import source_settings_of
    from tactile_graph.plugins.registry import installed
    from tactile_graph_sources.commands.any_source import as_many, frames_of_source

    known = [s.name for s in installed().step(step).settings]
    own = {k: v for k, v in limits.items() if k in known and v is not None}
    told = as_many(step, {**given, **source_settings_of(step, texts), **own}, limits["n_frames"])
    frames = frames_of_source(step, told, report)
    if set(own) == {k for k, v in limits.items() if v is not None}:
        return frames
    return _until(islice(frames, limits["n_frames"]), limits["seconds"])


def _check_target(target: Path) -> None:
    """Refuse what could not be written, or would be looked for in vain, before the work."""
    from tactile_graph.errors import UsageError
    from tactile_graph.files import check_target

    if target.suffix.lower() in FILES:
        name = target.with_suffix(".zarr").name
        raise UsageError(
            f"TARGET {target}: a recording is a Zarr store; record {name}, and "
            f"'tactile-graph convert' makes a {target.suffix} of it"
        )
    if not target.exists():
        check_target("TARGET", target)
    check_targets([("TARGET", target)])


def _until(frames: Iterator[Frame], seconds: float | None) -> Iterator[Frame]:
    end = None if seconds is None else time.perf_counter() + seconds
    for frame in frames:
        yield frame
        if end is not None and time.perf_counter() > end:
            return


def _read_no_more(report: Report) -> bool:
    """Have a source that reads on meanwhile end with what it has read; return whether it is one."""
    if report.n_waiting is not None:
        report.wanted = False
    return report.n_waiting is not None


def _keep(
    frames: Iterator[Frame], store: StoreWriter, report: Report, again: Callable[[], None]
) -> None:
    """Write the frames; on a terminal, say how many and how fast; say once that many wait.

    ``again`` is called after each and raises a signal that was swallowed on its way here.
    """
    shown = sys.stderr.isatty()
    since, n = time.perf_counter(), 0
    told = False
    for frame in frames:
        store.n_waiting = report.n_waiting or 0
        store.write(frame)
        again()
        if store.n_waiting >= BEHIND and not told:
            told = True
            many = _frames_in_words(store.n_waiting)
            say(f"{many} wait to be written; a larger --chunk is faster", err=True)
        n += 1
        now = time.perf_counter()
        if shown and now - since > SHOW_EVERY_S:
            rate = n / (now - since)
            click.echo(f"\r{store.n_frames} frames, {rate:.0f} a second ", nl=False, err=True)
            since, n = now, 0
    if shown:
        say("", err=True)


def _frames_in_words(n: int) -> str:
    return f"{n} frame{'s' if n != 1 else ''}"


def _tell(store: StoreWriter, report: Report, by_port: bool) -> None:
    """Say what is written, and what the link was like, leaving out what is as it should be."""
    from tactile_graph_sources.writers.recording_writer import OWN_SHAPES

    n = store.n_written
    if n == store.n_before:
        came = report.counts["good frames"] + report.counts["frames"]
        what = "ended before the first frame was kept" if came else "no frame came"
        say(f"{store.path}: {what}, and nothing was written", err=True)
        n_bytes = report.counts["bytes"]
        if by_port:
            say(f"  {n_bytes} byte{'s' if n_bytes != 1 else ''} came from the port", err=True)
        return
    say(f"{store.path}: {_frames_in_words(n)}")
    if store.own_shapes:
        say(f"  left out: {OWN_SHAPES} ({', '.join(store.own_shapes)})", err=True)
    names = [n for n in sorted(report.counts) if n not in UNTOLD]
    for name in names:
        say(f"  {name}: {report.counts[name]}", err=True)
