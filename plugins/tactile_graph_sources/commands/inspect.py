"""``tactile-graph inspect``: what a recording is, what is in it, and which commands work on it."""

from __future__ import annotations

import json
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from tactile_graph.cli.say import say
from tactile_graph.cli.targets import check_targets
from tactile_graph.foreign_text import pasted, pasted_path
from tactile_graph.pipeline.document import is_plain
from tactile_graph.plugins.registry import installed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.errors import TactileGraphError
    from tactile_graph.pipeline.graph import Node
    from tactile_graph.wires.frame import Frame
    from tactile_graph_sources.inspection.look import Looked, Sensor

MOST_SHOWN = 6
MOST_TRIED = 1024
"""Cells of a frame up to which what is shown is run on it first: without machine code, loops over
more would take seconds."""


class _Works(NamedTuple):
    """Which pipelines take a frame, and the first reason of those that do not.

    ``levels`` are the nodes of each that can find a level above the noise of a whole recording.
    """

    names: tuple[str, ...]
    about: dict[str, str]
    reasons: dict[str, str]
    levels: dict[str, str]


class _Tried(NamedTuple):
    """A pipeline, why it does not take a frame, and its node that finds a level, if any."""

    name: str
    about: str
    trouble: str
    level: str


@click.command()
@click.argument("files", nargs=-1, required=True, type=click.Path(readable=False, path_type=Path))
@click.option(
    "--with",
    "settings",
    metavar="KEY=VALUE",
    multiple=True,
    help="A setting of the source 'recording', such as rows=12; can be repeated.",
)
@click.option("--picture", type=click.Path(path_type=Path), help="Draw it (.png, .svg, .pdf).")
@click.option(
    "--json", "as_json", is_flag=True, help="Print a JSON object a file and sensor, for programs."
)
def inspect(
    files: tuple[Path, ...], settings: tuple[str, ...], picture: Path | None, as_json: bool
) -> None:
    """Say what the recordings FILE… are and hold, and which commands work on them.

    The format and how it was recognised, frames, grid, pitch, quantity, rate, range, noise,
    offset, broken cells, contacts; what of it is assumed; a picture; commands ready to paste.
    Where a file holds several sensors, all this of each.
    """
    from tactile_graph.errors import TactileGraphError
    from tactile_graph_sources.commands.any_source import reader_settings
    from tactile_graph_sources.inspection.look import look_into_all
    from tactile_graph_sources.inspection.picture import save_picture

    if picture is not None and len(files) > 1:
        raise click.UsageError("--picture draws one recording; give one FILE")
    check_targets([("--picture", picture)])
    told = reader_settings(settings)
    n_failed = 0
    for path in files:
        try:
            with _told_by_line(path):
                found = look_into_all(path, told)
        except TactileGraphError as error:
            if len(files) == 1:
                raise
            found = {"": error}
        n_failed += _show(path, found, settings, as_json)
        if picture is not None:
            read = [one for one in found.values() if not isinstance(one, TactileGraphError)]
            if read:
                save_picture(read, picture)
                say(f"picture: {picture}", err=as_json)
    if n_failed:
        click.get_current_context().exit(1)


@contextmanager
def _told_by_line(path: Path) -> Iterator[None]:
    """Name the file, and the line of the plugin that reads it, in errors that are none of ours."""
    from tactile_graph.engine.outcomes.notices import breaks
    from tactile_graph.errors import DataError, TactileGraphError

    try:
        yield
    except (TactileGraphError, OSError, MemoryError):
        raise
    except Exception as error:  # a plugin's own code may raise anything
        raise DataError(str(path), breaks("reader", error)) from error


def _show(
    path: Path,
    found: Mapping[str, Looked | TactileGraphError],
    settings: Sequence[str],
    as_json: bool,
) -> int:
    """Print what was found of each sensor of a file; return how many could not be read."""
    from tactile_graph.errors import TactileGraphError
    from tactile_graph_sources.inspection.words import data_of

    names = [name for name in found if name]
    if names and not as_json:
        say(f"{path}: {len(names)} sensors, each read alone: {', '.join(names)}")
    for k, (name, looked) in enumerate(found.items()):
        chosen = [*settings, f"sensor={name}"] if name else settings
        if not as_json and (k or names):
            say()
        if isinstance(looked, TactileGraphError):
            told = {"file": str(path), "sensor": name, "error": str(looked)}
            say(json.dumps(told) if as_json else f"{name}: {looked}" if name else looked)
            continue
        if as_json:
            works = _works(looked.sensors[0])
            commands = [*_commands(looked, works, chosen), _levelled(looked, works, chosen)]
            commands = [command for command in commands if command]
            say(json.dumps({**data_of(looked), "sensor": name, "commands": commands}))
        else:
            _tell(looked, chosen)
    return sum(isinstance(looked, TactileGraphError) for looked in found.values())


def _tell(looked: Looked, settings: Sequence[str]) -> None:
    from tactile_graph_sources.inspection.words import lines_of, shades_of

    for line in lines_of(looked):
        say(line)
    for sensor in looked.sensors:
        for line in shades_of(sensor):
            say(line)
    works = _works(looked.sensors[0])  # when all else is said: much may be compiled
    say("  takes it:")
    for command in _commands(looked, works, settings):
        say(f"    {command}")
    if len(works.names) > MOST_SHOWN:
        say(f"  and so do the pipelines {', '.join(works.names[MOST_SHOWN:])}")
    for line in _offset_told(looked):
        say(f"  {line}")
    levelled = _levelled(looked, works, settings)
    if levelled:
        say("  with one level for all frames, above the noise of the whole recording:")
        say(f"    {levelled}")
    for reason, names in works.reasons.items():
        say(f"  not {names}: {reason}")
    labels = [sensor.label for sensor in looked.sensors if sensor.label]
    if len(labels) > 1:
        say(f"  one sensor alone: add --with sensor={pasted(labels[0])}")
    if looked.pitch_assumed:
        say("  where the pitch is known, add --with pitch_cm=…: lengths are wrong without")
    elif _may_be_of_nobody(looked, settings):
        say("  a pitch of 1 x 1 cm stands, too, where older versions wrote what nobody had said:")
        say("  if it is of those, add --with pitch_cm=…: lengths are wrong without")


def _may_be_of_nobody(looked: Looked, settings: Sequence[str]) -> bool:
    """Return whether a recording's pitch may be one that an older version had assumed."""
    told = any(setting.partition("=")[0].strip() == "pitch_cm" for setting in settings)
    return not told and looked.sensors[0].frames[0].image.pitch_cm == (1.0, 1.0)


def _offset_told(looked: Looked) -> Iterator[str]:
    """Yield what takes off what cells read at rest, where that is much beside a press."""
    from tactile_graph.plugins.registry import installed
    from tactile_graph_sources.inspection.measure import SHARE_OF_PEAK

    measured = looked.sensors[0].measured
    height = measured.highest - measured.offset
    if abs(measured.offset) > SHARE_OF_PEAK * height and installed().has("steps", "tare"):
        yield "loads and centres, as contacts gives, are of whole readings, offset included;"
        yield "a pipeline whose first step is tare takes it off, by frames of the empty pad first"


def _commands(looked: Looked, works: _Works, settings: Sequence[str]) -> list[str]:
    """Return command lines that work on a recording, the reader's settings with them."""
    told = "".join(f" --with {pasted(s)}" for s in settings)
    path = pasted_path(str(looked.path))
    runs = [f"tactile-graph run {name} {path}{told}" for name in works.names[:MOST_SHOWN]]
    chosen = looked.chosen.replace("/", "-")
    name = "-".join(filter(None, (looked.path.stem, chosen)))
    target = pasted_path(name + other_kind(looked.path))
    offered = installed().names("commands")
    named = name if name.isprintable() and name[0].isalnum() else "my-object"
    learn = [f"tactile-graph learn {pasted(named)} {path}{told}"] if "learn" in offered else []
    if "learn-pad" in offered and not settings and looked.n_frames > 1:
        learn.append(f"tactile-graph learn-pad {path}")
    return [*runs, *learn, f"tactile-graph convert {path} {target}{told}"]


def other_kind(path: Path) -> str:
    """Return the ending of what to convert a recording to: no file it is itself, no extra more."""
    kinds = [".zarr"] if find_spec("zarr") else []
    return next(kind for kind in (*kinds, ".npz", ".csv") if kind != path.suffix)


def _levelled(looked: Looked, works: _Works, settings: Sequence[str]) -> str:
    """Return the command by which the plainest pipeline takes one level for all frames.

    Empty where none does, or there is only one frame.
    """
    name = next((n for n in works.names if works.levels[n]), "")
    if not name or looked.n_frames < 2:
        return ""
    path = str(looked.path)
    source = ", ".join([f"path: {json.dumps(path)}", *map(_in_yaml, settings)])
    value = path if not settings and is_plain(path) else f"{{{source}}}"
    told = "".join(f" --with {pasted(s)}" for s in settings)
    setting = pasted(f"{works.levels[name]}.noise_of={value}")
    return f"tactile-graph run {name} {pasted_path(path)}{told} --set {setting}"


def _in_yaml(setting: str) -> str:
    """Return a setting as it may stand among others in YAML, in quotes where it is none."""
    from tactile_graph.cli.arguments import source_settings_of
    from tactile_graph.pipeline.document import read_document

    name, _, typed = setting.partition("=")
    document = read_document(f"{{{name}: {typed}}}", "")
    given = source_settings_of("recording", [setting])
    fits = not document.problems and document.data == given
    return f"{name}: {typed if fits else json.dumps(given[name.strip()])}"


def _works(sensor: Sensor) -> _Works:
    """Return which of the installed pipelines take frames such as these.

    Those that are shown have answered the fullest of them.
    """
    from tactile_graph.compiled import answered_meanwhile
    from tactile_graph_sources.inspection.words import fullest

    frames, most = sensor.frames, fullest(sensor)
    names, about, levels = [], {}, {}
    reasons: dict[str, list[str]] = {}
    for name, text, trouble, level in _tried(frames[0]):
        about[name], levels[name] = text, level
        if trouble:
            reasons.setdefault(trouble, []).append(name)
        else:
            names.append(name)
    # The plainest first: what says of itself that it is for any recording.
    names.sort(key=lambda n: ("any" not in about[n], n))
    if frames[0].image.values.size <= MOST_TRIED:
        with answered_meanwhile():
            for name in _first(names, MOST_SHOWN):
                if trouble := _failure(name, most):
                    names.remove(name)
                    reasons.setdefault(trouble, []).append(name)
    return _Works(tuple(names), about, {r: ", ".join(n) for r, n in reasons.items()}, levels)


def _first(names: Sequence[str], n: int) -> Iterator[str]:
    """Yield names that stand among the first n, though those yielded may be taken out meanwhile."""
    seen: set[str] = set()
    while waiting := [name for name in names[:n] if name not in seen]:
        seen.add(waiting[0])
        yield waiting[0]


def _failure(name: str, frame: Frame) -> str:
    """Return why a pipeline gives no answer to a frame, empty where it does or skips it."""
    from tactile_graph.api.pipeline import load
    from tactile_graph.errors import TactileGraphError
    from tactile_graph.inspect import Failed

    pipeline = load(name)
    try:
        result = pipeline.runner()(frame)
    except TactileGraphError as error:
        return _reason(str(error))
    outcomes = [result.outcome(output) for output in pipeline.outputs]
    failed = [outcome for outcome in outcomes if isinstance(outcome, Failed)]
    if not failed or len(failed) < len(outcomes):
        return ""
    return f"its fullest frame fails: {failed[0].error}"


def _tried(frame: Frame) -> Iterator[_Tried]:
    """Yield each pipeline, and why it does not take the frame."""
    from tactile_graph.api.pipeline import load
    from tactile_graph.engine.plan import make_plan
    from tactile_graph.engine.runner import check_frame
    from tactile_graph.errors import TactileGraphError

    found = installed()
    for name in found.names("pipelines"):
        try:
            pipeline = load(name, found).with_source("recording", path="recording")
            about, level = pipeline.about, _level_node(pipeline)
        except TactileGraphError:
            continue  # what cannot be loaded says so wherever it is asked for
        try:
            check_frame(frame.image, make_plan(pipeline, tuple(pipeline.outputs)))
        except TactileGraphError as error:
            yield _Tried(name, about, _reason(str(error)), level)
        else:
            yield _Tried(name, about, "", level)


def _level_node(pipeline: Pipeline) -> str:
    """Return the node that finds a level above noise, and may do so for all frames; or empty."""
    nodes = pipeline.nodes.items()
    found = (n for n, node in nodes if node.settings.get("level") == "auto" and _takes_noise(node))
    return next(found, "")


def _takes_noise(node: Node) -> bool:
    signature = node.signature
    return signature is not None and any(s.name == "noise_of" for s in signature.settings)


def _reason(text: str) -> str:
    """Return why a pipeline refuses a frame, without its own name, so that reasons can be alike.

    What to do about it is kept where it is all there is against the pipeline.
    """
    first, *more = text.splitlines()
    first, _, hint = first.partition("; ")
    _, _, rest = first.partition(": ")
    takes = rest[rest.find(" takes ") + 1 :] if " takes " in rest else rest
    takes = takes.replace(" at port 'image'", "")
    if more or not hint or hint.startswith("tactile-graph inspect"):
        return takes
    return f"{takes}; {hint.partition(': ')[2] or hint}"  # without the file it speaks of
