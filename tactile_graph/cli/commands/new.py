"""``tactile-graph new``: a plugin's package, ready to install, test, and change."""

from __future__ import annotations

from pathlib import Path

import click

from tactile_graph.cli.package.kinds import KINDS

_KINDS = "\n".join(f"  {name:9} {kind.about}" for name, kind in KINDS.items())


@click.command(epilog=f"\b\nKinds:\n{_KINDS}")
@click.argument("name")
@click.option(
    "--kind", type=click.Choice(list(KINDS)), default="filter", show_default=True,
    help="What its step is.",
)  # fmt: skip
@click.option("--step", metavar="STEP", help="The step's name, where it is not the package's.")
@click.option(
    "--into", metavar="FOLDER", default=".", help="Where the package's folder is made.",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
)  # fmt: skip
def new(name: str, kind: str, step: str | None, into: Path) -> None:
    """Make a package with a step, a pipeline, tests and a workflow, as a folder NAME.

    It installs, passes its tests, and runs as it stands; then change it.
    """
    from tactile_graph.cli.package.making import make_package, repository_around, words_of
    from tactile_graph.cli.package.names import names_of
    from tactile_graph.cli.say import say
    from tactile_graph.foreign_text import pasted

    names = names_of(name, step, kind)
    folder = into / name
    files = make_package(names, kind, folder)
    say(f"{folder}: a {kind}, {len(files)} files")
    for path in files:
        say(f"  {path}")
    around = repository_around(folder)
    if around is not None:
        say(
            f"It lies in the git repository {around}: GitHub runs its workflow only from the "
            ".github/workflows of that repository, or once the package is one of its own."
        )
    say("Next:")
    for command in (
        f"cd {pasted(str(folder))}",
        'pip install -e ".[test]"',
        "pytest",
        f"tactile-graph steps {names.step}",
        f"tactile-graph {words_of(names, kind)['try_it']}",
    ):
        say(f"  {command}")
