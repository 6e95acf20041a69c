"""The arguments commands share that open a pipeline on a source."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from tactile_graph.cli.completions import (
    complete_node,
    complete_pipeline,
    complete_set,
    complete_source,
    complete_with,
    is_source,
)
from tactile_graph.cli.told_pads import reads_for_told_pads
from tactile_graph.errors import UsageError
from tactile_graph.pipeline.named_files.named_files import is_there
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline
    from tactile_graph.steps.signature import Signature
    from tactile_graph.wires.frame import Frame

F = TypeVar("F", bound=Callable[..., Any])
COUNT = "frames"
"""The setting by which a source that makes its frames is told how many."""


@dataclass(frozen=True)
class Span:
    """Which frames of a source, by count from 0: from ``start`` up to, not with, ``stop``."""

    start: int = 0
    stop: int | None = None

    @property
    def most(self) -> int | None:
        """How many frames it can be; None if there is no end."""
        return None if self.stop is None else self.stop - self.start

    def of(self, frames: Iterator[Frame]) -> Iterator[Frame]:
        """Return those frames."""
        return islice(frames, self.start, self.stop)

    def expected(self, n_source: int | None) -> int | None:
        """Return how many frames to expect of a source that gives ``n_source``, if known."""
        if n_source is None:
            return self.most
        stop = n_source if self.stop is None else min(self.stop, n_source)
        return max(0, stop - self.start)


def parse_span(ctx: click.Context, param: click.Parameter, value: str | None) -> Span:
    """Return the span that ``N`` or ``A:B`` spells.

    Raises
    ------
    click.BadParameter
        If it spells none, or one that holds no frame.
    """
    if value is None:
        return Span()
    found = re.fullmatch(r"(\d+)|(\d*):(\d*)", value.strip())
    if found is None:
        raise click.BadParameter(
            f"{value!r}: must be a number of frames (20) or a range (10:30)", ctx, param
        )
    start = int(found[2] or 0)
    stop = int(found[1]) if found[1] else int(found[3]) if found[3] else None
    if max(start, stop or 0) > sys.maxsize:
        raise click.BadParameter(f"{value!r}: more frames than can be counted", ctx, param)
    if stop is not None and stop <= start:
        raise click.BadParameter(
            f"{value!r}: holds no frame; must be like 20, 10:30, 10: or :30", ctx, param
        )
    return Span(start, stop)


def pipeline_argument(command: F) -> F:
    """Add PIPELINE."""
    return click.argument("pipeline", required=False, shell_complete=complete_pipeline)(command)


def with_option(command: F) -> F:
    """Add ``--with``."""
    return click.option(
        "--with", "source_settings", metavar="KEY=VALUE", multiple=True,
        shell_complete=complete_with,
        help="A setting of the source, as under 'with:' in YAML; can be repeated.",
    )(command)  # fmt: skip


def source_options(command: F) -> F:
    """Add RECORDING… and the options that choose a source and change settings."""
    for add in reversed(
        (
            click.argument("recordings", metavar="[RECORDING]...", nargs=-1),
            click.option("--source", metavar="STEP", shell_complete=complete_source,
                         help="Take frames from this source step."),
            with_option,
            click.option(
                "--set", "settings", metavar="NODE.SETTING=VALUE", multiple=True,
                shell_complete=complete_set,
                help="A setting of a node instead of the file's, the value as in YAML "
                "(0.02, [1, 2], true); can be repeated.",
            ),
            click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True,
                         help="Seed of everything random."),
            click.option("--only", metavar="NODE", multiple=True, shell_complete=complete_node,
                         help="Ask for this node or node.field instead of the pipeline's outputs; "
                         "can be repeated."),
        )
    ):  # fmt: skip
        command = add(command)
    return command


def open_pipeline(
    name: str | None,
    recordings: Sequence[str] = (),
    source: str | None = None,
    source_settings: Sequence[str] = (),
    settings: Sequence[str] = (),
    span: Span | None = None,
) -> Pipeline:
    """Return the pipeline a command line names, with its source and settings.

    Should kernels have to be compiled then, another process helps while the command lasts.

    Raises
    ------
    UsageError
        If something that is named does not exist, or no source is left.
    PipelineError
        If the file or a setting is wrong.
    """
    from tactile_graph.api.pipeline import load
    from tactile_graph.pipeline.document import assignment
    from tactile_graph.steps.settings import takes_paths, takes_text

    found = registry.installed()
    if name is None:
        raise UsageError(f"name a pipeline, or a file of one\n{offered()}")
    pipeline = load(name, found)
    takes = [partial(_takes, pipeline, kind) for kind in (takes_text, takes_paths)]
    replaced = dict(assignment("--set", s, *takes) for s in settings)
    step = source_named(pipeline, recordings, source, source_settings, span or Span())
    if replaced or step:
        pipeline = pipeline.with_settings(replaced, step)
    pipeline = reads_for_told_pads(pipeline)
    _help_preparing(name, recordings, settings)
    return pipeline


def _takes(pipeline: Pipeline, kind: Callable[[Signature, str], bool], name: str) -> bool:
    """Return whether ``node.setting`` is of a kind, as may be any text."""
    node, _, setting = name.rpartition(".")
    signature = pipeline.nodes[node].signature if node in pipeline.nodes else None
    return signature is not None and kind(signature, setting)


def source_settings_of(step: str, texts: Sequence[str]) -> dict[str, Any]:
    """Return settings of a source from texts such as ``rows=12``, not checked yet.

    Raises
    ------
    UsageError
        If a text is none.
    """
    from tactile_graph.pipeline.document import assignment
    from tactile_graph.steps.settings import takes_paths, takes_text

    found = registry.installed()
    known = found.step(step) if found.has("steps", step) else None
    takes = [partial(kind, known) for kind in (takes_text, takes_paths)] if known else []
    return dict(assignment("--with", text, *takes) for text in texts)


def _help_preparing(name: str, recordings: Sequence[str], settings: Sequence[str]) -> None:
    """Let another process help, while the command lasts, when kernels have to be compiled.

    It runs the pipeline over the recordings or its own source: a device is opened only once.
    """
    command = click.get_current_context(silent=True)
    if command is not None:
        from tactile_graph.compiled import Work, prepared_beside

        work = Work((name,), tuple(settings), tuple(recordings), registry.selected())
        command.with_resource(prepared_beside(work))


def offered() -> str:
    """Return the pipelines there are, a line each."""
    from tactile_graph.cli.commands.pipelines import heads

    found = heads(registry.installed())
    width = max((len(h.name) for h in found), default=0)
    lines = [f"  {h.name:<{width}}  {h.about or h.trouble}" for h in found]
    return "\n".join(["there are:", *lines]) if lines else "no plugin offers any"


def source_named(
    pipeline: Pipeline,
    recordings: Sequence[str],
    step: str | None,
    given: Sequence[str],
    span: Span,
) -> tuple[str, dict[str, Any]] | None:
    """Return the source a command line names, step and settings; None for the pipeline's own.

    Raises
    ------
    UsageError
        If there is none, or it is not allowed.
    """
    own = pipeline.source
    found = registry.installed()
    if step is not None and found.has("steps", step):
        step = found.spelled("steps", step)
    base: dict[str, Any] = {}
    if recordings:
        _refuse_no_recordings(pipeline, recordings)
        step, base = reader_of(recordings, step)
    elif step is None:
        if own is None:
            raise UsageError(
                f"pipeline {pipeline.name!r} declares no source: give it recordings or --source"
            )
        step = own.name
    if own is not None and step == own.name and not recordings:
        base = own.given
    base.update(source_settings_of(step, given))
    wanted = {text.partition("=")[0].strip() for text in given}
    if not recordings and COUNT not in wanted and span.stop is not None and takes_count(step):
        base[COUNT] = span.stop
    if own is not None and step == own.name and not (recordings or given or COUNT in base):
        return None
    checked_source(step, base, bool(recordings))
    return step, base


def reader_settings(step: str, texts: Sequence[str]) -> dict[str, Any]:
    """Return the settings, checked, that ``--with`` gives a step that reads recordings.

    Raises
    ------
    UsageError
        If one is wrong, is none, or names the recording, which stands on the command line.
    """
    given = source_settings_of(step, texts)
    if not given:
        return {}
    _, target = _reader(step, ["RECORDING"])
    if target in given:
        raise UsageError(f"--with {target}: recordings are named on the command line")
    checked = checked_source(step, {target: "RECORDING", **given}, recordings=True)
    return {name: checked[name] for name in given}


def _refuse_no_recordings(pipeline: Pipeline, words: Sequence[str]) -> None:
    """Refuse words that stand where recordings do, and are a pipeline or a setting."""
    for word in words:
        node, _, setting = word.partition("=")[0].rpartition(".")
        if is_there(Path(word)):
            continue
        if registry.installed().has("pipelines", word):
            raise UsageError(
                f"{word!r} is a pipeline, and no recording is called so; {pipeline.name!r} stands"
                " before it already, and one is run at a time"
            )
        if "=" in word and node in pipeline.nodes and setting:
            raise UsageError(f"{word!r} is no recording; a setting is given by --set {word}")


def reader_of(recordings: Sequence[str], step: str | None = None) -> tuple[str, dict[str, Any]]:
    """Return the source that reads recordings, the one named or the first, and what it is told.

    Raises
    ------
    UsageError
        If there is none, or the one named reads no recordings.
    """
    named, setting = _reader(step, recordings)
    return named, {setting: recordings[0] if len(recordings) == 1 else list(recordings)}


def _reader(step: str | None, recordings: Sequence[str]) -> tuple[str, str]:
    """Return the source step that reads recordings, the one named or the first, and its setting."""
    found = registry.installed()
    named = step or found.reader()
    if named is None:
        raise UsageError(f"no plugin offers a step that reads recordings{found.missing_plugins()}")
    if not found.has("steps", named):
        raise _no_source(named)
    if not found.has("readers", named):
        raise UsageError(f"give recordings or --source {named}, not both: {recordings[0]}")
    return named, str(found.offer("readers", named).target)


def _no_source(step: str) -> UsageError:
    """Return the error for a name that no step has, with the sources there are."""
    found = registry.installed()
    names = [n for n in found.names("steps") if is_source(n)]
    return UsageError(f"--source: {found.unknown('steps', step)}; sources are: {', '.join(names)}")


def takes_count(step: str) -> bool:
    """Return whether a step is there that is told how many frames to make."""
    found = registry.installed()
    return found.has("steps", step) and any(s.name == COUNT for s in found.step(step).settings)


def checked_source(step: str, given: dict[str, Any], recordings: bool) -> dict[str, Any]:
    """Return what the command line says of the source, checked: it is no mistake of the file.

    Raises
    ------
    UsageError
        With everything wrong with it.
    """
    from tactile_graph.steps.settings import validate_settings
    from tactile_graph.steps.signature import Kind

    found = registry.installed()
    if not found.has("steps", step):
        if not recordings:
            raise _no_source(step)
        raise UsageError(f"recordings need the step {step!r}: {found.unknown('steps', step)}")
    signature = found.step(step)
    if signature.kind is not Kind.SOURCE:
        raise UsageError(f"--source {step}: this step is no source: it yields no frames")
    values, troubles = validate_settings(signature, given)
    lines = [f"source {step}, {'.'.join(map(str, p)) + ': ' if p else ''}{m}" for p, m in troubles]
    if lines:
        raise UsageError("\n".join(lines))
    return values
