"""The command itself: its name, version, exit codes, and the list of its own commands."""

from __future__ import annotations

import click

from tactile_graph.cli.group import Group

EXIT_CODES = """\b
Exit codes:
  0    done; every frame gave all its outputs, or skipped them for a reason
  1    done, but some frame failed, or has an output that is no finite number
  2    not done: wrong usage, a wrong pipeline file, a file that cannot be read
  130  interrupted by Ctrl-C; what was done is kept
  143  ended by SIGTERM (129: its terminal was closed); likewise
  141  whoever read the output went away (| head)
"""

COMMANDS = {
    "run": "Run a pipeline over recordings or another source.",
    "check": "Report all that is wrong with files of pipelines, pads and the like.",
    "explain": "Say for one frame what each node did, and why.",
    "summary": "Say what results of runs come to, by recording and in all.",
    "prepare": "Compile the kernels of pipelines now, so that no first frame waits.",
    "graph": "Draw a pipeline's graph: SVG, mermaid or dot.",
    "pipelines": "List the pipelines, search them, or print one of them.",
    "steps": "List the steps, search them, or describe one of them.",
    "plugins": "List the plugins, what they offer and what is wrong with them.",
    "new": "Make a package with a step of your own, its pipeline and tests.",
    "schema": "Write a JSON Schema of pipeline and other files, for editors.",
}
"""Name -> what ``--help`` says; the command ``x`` is ``tactile_graph.cli.commands.x:x``."""


def _version(ctx: click.Context, _: click.Parameter, asked: bool) -> None:
    if asked and not ctx.resilient_parsing:
        from tactile_graph.cli.say import say
        from tactile_graph.code_version import code_version

        say(f"tactile-graph, version {code_version()}")
        ctx.exit()


@click.group(
    cls=Group,
    built_in=COMMANDS,
    epilog=EXIT_CODES,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option(
    "--version", is_flag=True, is_eager=True, expose_value=False, callback=_version,
    help="Show the version, with a digest of its code, and exit.",
)  # fmt: skip
def cli() -> None:
    """Tactile images through graphs of plugin steps that YAML files declare."""
