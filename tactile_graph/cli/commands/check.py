"""``tactile-graph check``: everything wrong with files of pipelines, pads and the like, at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from tactile_graph.cli.endings import NOT_DONE
from tactile_graph.cli.file_kinds import PIPELINE, YAML, file_kind, kind_names, kind_of
from tactile_graph.errors import PipelineError, TactileGraphError, UsageError, shown
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from rich.console import Console
    from rich.text import Text

    from tactile_graph.api.pipeline import Pipeline


class Target(NamedTuple):
    """A name or path to check; the kind is empty where the file itself is to tell it."""

    name: str
    kind: str = ""


def complete_file(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return names of what can be checked and YAML files that begin so, for the shell."""
    found = registry.installed()
    offers = ["pipelines", *(file_kind(found, k).offers for k in found.names("file_kinds"))]
    names = sorted({n for kind in offers for n in found.names(kind)})
    return [n for n in names if n.startswith(incomplete)] + [
        str(p) for p in Path().glob(f"{incomplete}*.y*ml")
    ]


@click.command(epilog="Exit codes: 0 all are right, 2 some are not; of --watch at the last look.")
@click.argument("files", metavar="[FILE|NAME]...", nargs=-1, shell_complete=complete_file)
@click.option("--as", "kind", metavar="KIND", default="",
              help="What they are: pipeline, pad, preset, scene, or what else plugins read. "
              "Otherwise the keys of a file tell.")  # fmt: skip
@click.option(
    "--watch", "watched", is_flag=True,
    help="Look again at every save of the files, and of those they use, until Ctrl-C.",
)  # fmt: skip
@click.option("--repair", is_flag=True, help="Mend what can be mended of recordings.")
def check(files: tuple[str, ...], kind: str, watched: bool, repair: bool) -> None:
    """Report all that is wrong with files of pipelines, pads, presets or scenes, and with stores.

    Of a pipeline the pad, scene, preset or recording that its source names is opened too.

    Installed ones go by name; without any, all that are installed are checked.
    """
    from tactile_graph.cli.terminal import console

    out = console()
    targets = targets_of(registry.installed(), files, kind)
    if watched:
        from tactile_graph.cli.watch import watch

        right = watch(lambda: show_outcomes(out, targets, repair), _paths(targets), out)
    else:
        right = show_outcomes(out, targets, repair)
    if not right:
        click.get_current_context().exit(NOT_DONE)


def _paths(targets: Sequence[Target]) -> list[str]:
    """Return the files that are named as such; those of names are found when they are read."""
    return [t.name for t in targets if Path(t.name).suffix in YAML or "/" in t.name]


def targets_of(found: registry.Registry, files: Sequence[str], kind: str) -> list[Target]:
    """Return what is to be checked: the files and names given, or else all that are installed.

    Raises
    ------
    UsageError
        If there is no such kind, or nothing to check.
    """
    if kind and kind != PIPELINE:
        file_kind(found, kind)
    if files:
        return [Target(name, kind) for name in files]
    kinds = [kind] if kind else kind_names(found)
    targets = [Target(name, k) for k in kinds for name in found.names(_offers(found, k))]
    if not targets:
        raise UsageError(f"name a {kind or PIPELINE} or a file of one: no plugin offers any")
    return targets


def _offers(found: registry.Registry, kind: str) -> str:
    return "pipelines" if kind == PIPELINE else file_kind(found, kind).offers


def show_outcomes(out: Console, targets: Sequence[Target], repair: bool = False) -> bool:
    """Print of each whether it is right, or all that is wrong; return whether all are right."""
    from rich.text import Text

    from tactile_graph.cli.file_checks import check_for, show_checked
    from tactile_graph.cli.problems import show_problems

    n_wrong = 0
    for target in targets:
        try:
            of_file = None if target.kind else check_for(registry.installed(), target.name)
            if of_file is not None:
                checked = of_file.check(Path(target.name), repair)
                n_wrong += not show_checked(out, target.name, checked, repair)
                continue
            out.print(_right(target), soft_wrap=True)
        except TactileGraphError as error:
            n_wrong += 1
            out.print(Text.assemble((f"{target.name}: wrong", "bold red")), soft_wrap=True)
            if isinstance(error, PipelineError):
                show_problems(out, error)
            else:
                out.print(str(error), style="red", soft_wrap=True)
    return n_wrong == 0


def _right(target: Target) -> Text:
    """Return what there is to say of something right; raises what is wrong with it."""
    from rich.text import Text

    from tactile_graph.api.pipeline import load
    from tactile_graph.cli.source_files import problems_of_source

    found = registry.installed()
    kind = target.kind or kind_of(found, target.name)
    if kind == PIPELINE:
        pipeline = load(target.name, found)
        problems = problems_of_source(found, pipeline.source) if pipeline.source else []
        if problems:
            raise PipelineError(problems)
        return _right_pipeline(pipeline)
    known = file_kind(found, kind)
    told = known.tell(known.read(target.name))
    return Text.assemble((f"{target.name}: right", "bold green"), f"  {kind}: {told}")


def _right_pipeline(pipeline: Pipeline) -> Text:
    from rich.text import Text

    from tactile_graph.pipeline.load import evolves_in_circle
    from tactile_graph.pipeline.unseen import unseen_ends

    n = len(pipeline.nodes)
    source = (
        f"takes frames from {pipeline.source.name}" if pipeline.source else "declares no source"
    )
    text = Text.assemble((f"{pipeline.name}: right", "bold green"))
    text.append(f"  {n} node{'s' if n != 1 else ''} → {', '.join(pipeline.outputs)}; {source}")
    if pipeline.evolves:
        text.append(f"; evolves {pipeline.evolves}")
        if circle := evolves_in_circle(pipeline):
            text.append(f"\n  evolves in a circle: {circle}", style="yellow")
    if pipeline.free:
        free = (f"{name}: {', '.join(map(shown, v))}" for name, v in pipeline.free.items())
        text.append(f"\n  free for tune: {'; '.join(free)}", style="dim")
    if pipeline.unused:
        text.append(f"\n  no output needs: {', '.join(pipeline.unused)}", style="yellow")
    for told in unseen_ends(pipeline):
        text.append(f"\n  {told}", style="yellow")
    return text
