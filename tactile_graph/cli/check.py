"""``tactile-graph check``: everything wrong with pipeline files, at once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.arguments import complete_pipeline
from tactile_graph.cli.endings import NOT_DONE
from tactile_graph.errors import PipelineError, TactileGraphError, UsageError
from tactile_graph.plugins import registry

if TYPE_CHECKING:
    from tactile_graph.api.pipeline import Pipeline


@click.command(epilog="Exit codes: 0 all are right, 2 some are not.")
@click.argument("pipelines", metavar="[PIPELINE]...", nargs=-1, shell_complete=complete_pipeline)
@click.option("--repair", is_flag=True, help="Mend what can be mended of recordings.")
def check(pipelines: tuple[str, ...], repair: bool) -> None:
    """Report all that is wrong with pipeline files or names; without any, with all installed.

    Recordings in Zarr stores are looked through as well.
    """
    from rich.text import Text

    from tactile_graph.api.pipeline import load
    from tactile_graph.cli.file_checks import check_for, show_checked
    from tactile_graph.cli.problems import show_problems
    from tactile_graph.cli.terminal import console

    found = registry.installed()
    names = pipelines or tuple(found.names("pipelines"))
    if not names:
        raise UsageError("name a pipeline or a file of one: no plugin offers any")
    out = console()
    wrong = 0
    for name in names:
        try:
            of_file = check_for(found, name)
            if of_file is not None:
                checked = of_file.check(Path(name), repair)
                wrong += not show_checked(out, name, checked, repair)
                continue
            out.print(_right(load(name, found)), soft_wrap=True)
        except TactileGraphError as error:
            wrong += 1
            out.print(Text.assemble((f"{name}: wrong", "bold red")), soft_wrap=True)
            if isinstance(error, PipelineError):
                show_problems(out, error)
            else:
                out.print(str(error), style="red", soft_wrap=True)
    if wrong:
        click.get_current_context().exit(NOT_DONE)


def _right(pipeline: Pipeline) -> Any:
    from rich.text import Text

    n = len(pipeline.nodes)
    source = (
        f"takes frames from {pipeline.source.name}" if pipeline.source else "declares no source"
    )
    text = Text.assemble((f"{pipeline.name}: right", "bold green"))
    text.append(f"  {n} node{'s' if n != 1 else ''} → {', '.join(pipeline.outputs)}; {source}")
    if pipeline.evolves:
        text.append(f"; evolves {pipeline.evolves}")
    if pipeline.unused:
        text.append(f"\n  no output needs: {', '.join(pipeline.unused)}", style="yellow")
    return text
