"""``tactile-graph schema``: a JSON Schema of pipeline, pad and other files, or all their keys."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tactile_graph.cli.endings import NOT_DONE
from tactile_graph.cli.file_kinds import PIPELINE, YAML, file_kind, kind_names, kind_of
from tactile_graph.cli.say import hand_over, say
from tactile_graph.cli.targets import check_targets
from tactile_graph.errors import UsageError
from tactile_graph.files import check_target, named_from_folder, write_whole
from tactile_graph.foreign_text import visible
from tactile_graph.plugins import registry
from tactile_graph.text_files import encoding_with_mark, with_mark

if TYPE_CHECKING:
    from tactile_graph.cli.pages.key_tables import KeyTable
    from tactile_graph.pipeline.completions import Nameable


def complete_kind(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the kinds of files, and the YAML files, that begin so, for the shell."""
    files = [str(p) for p in Path().glob(f"{incomplete}*.y*ml")]
    return [n for n in kind_names(registry.installed()) if n.startswith(incomplete)] + files


@click.command(
    epilog="--install is for editors with a YAML language server: VS Code with the extension YAML "
    "of Red Hat, Neovim, Emacs, Helix, Zed. Run it again when a file has got new nodes."
)
@click.argument("names", metavar="[KIND|FILE]...", nargs=-1, shell_complete=complete_kind)
@click.option("-o", "--output", metavar="FILE", help="Write to a file instead of stdout.")
@click.option("--keys", is_flag=True, help="Print tables of all keys for people instead.")
@click.option("--install", is_flag=True, help="Write a schema for each FILE (all pipelines of this "
              "folder if none is named), the line in it that names the schema, and the settings of "
              "VS Code.")  # fmt: skip
def schema(names: tuple[str, ...], output: str | None, keys: bool, install: bool) -> None:
    """Write a JSON Schema (draft 2020-12) of what the installed plugins allow in a file.

    KIND is pipeline (the default), pad, preset, scene, or what else plugins read. The schema of a
    FILE is of its kind; that of a pipeline completes the names of its own nodes too.
    """
    if install:
        if keys or output is not None:
            raise UsageError("--install writes where editors look: it takes no --keys and no -o")
        if not _install(names):
            click.get_current_context().exit(NOT_DONE)
        return
    if len(names) > 1:
        raise UsageError(f"one schema at a time, got {len(names)}; --install takes several files")
    name = names[0] if names else PIPELINE
    if output not in (None, "-"):
        check_target("-o", str(output))
        check_targets([("-o", output)])
    if keys:
        if output is not None:
            raise UsageError("--keys prints tables for people: it takes no -o")
        _show_keys(name)
        return
    made = _of_file(Path(name)) if name.endswith(YAML) else _made(name)
    text = json.dumps(made, indent=2, ensure_ascii=False) + "\n"
    if output in (None, "-"):
        hand_over(text)
    else:
        write_whole(str(output), text)
        say(f"wrote {output}", err=True)


def _made(kind: str, names: Nameable | None = None) -> dict[str, Any]:
    found = registry.installed()
    if kind != PIPELINE:
        from tactile_graph.record_schema import record_schema

        return record_schema(file_kind(found, kind), kind)
    from tactile_graph.schema import pipeline_schema

    made, troubles = pipeline_schema(found, names)
    for trouble in troubles:
        click.echo(f"{click.style('left open:', fg='yellow')} {visible(str(trouble))}", err=True)
    return made


def _of_file(path: Path) -> dict[str, Any]:
    """Return the schema of a file: of its kind, and of a pipeline with its own names."""
    text = _text_of(path)
    kind = kind_of(registry.installed(), str(path))
    if kind != PIPELINE:
        return _made(kind)
    from tactile_graph.pipeline.completions import nameable

    return _made(kind, nameable(text, str(path), registry.installed()))


def _text_of(path: Path) -> str:
    try:
        return with_mark(path.read_bytes())
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise UsageError(f"{path} cannot be read: it is no text in UTF-8 or UTF-16") from None


def _install(names: tuple[str, ...]) -> bool:
    """Write what editors need for files, and return whether all could be written."""
    from tactile_graph.cli import editor

    files = [Path(name) for name in names] or _pipelines_here()
    lines = {file: editor.with_modeline(_text_of(file), file) for file in files}
    for file, text in lines.items():
        path = editor.write_schema(file, _of_file(file))
        if text != _text_of(file):
            write_whole(file, text.encode(encoding_with_mark(file.read_bytes())))
        say(f"{file}: its schema is {path}", err=True)
    named = [Path(named_from_folder(file)) for file in files]
    below = [file for file in named if ".." not in file.parts and not file.is_absolute()]
    return _install_settings(below)


def _install_settings(files: list[Path]) -> bool:
    from tactile_graph.cli import editor

    settings = editor.SETTINGS
    try:
        before = _text_of(settings) if settings.exists() else None
        text = editor.settings_text(before, files)
    except UsageError as error:
        say(visible(str(error)), err=True)
        return False
    settings.parent.mkdir(exist_ok=True)
    write_whole(settings, text)
    say(f"{settings}: names the schemas to VS Code", err=True)
    return True


def _pipelines_here() -> list[Path]:
    files = sorted(path for end in YAML for path in Path().glob(f"*{end}"))
    found = [f for f in files if re.search(r"^\ufeff?pipeline[ \t]*:", _text_of(f), re.M)]
    if not found:
        raise UsageError("no pipeline file is in this folder; name one: schema --install FILE")
    return found


def _show_keys(kind: str) -> None:
    from tactile_graph.cli.pages.key_tables import key_tables
    from tactile_graph.cli.terminal import console

    if kind == PIPELINE:
        raise UsageError(
            "--keys is for files of one record, such as pad; the keys of a pipeline are those of "
            "its steps: tactile-graph steps NAME"
        )
    out = console()
    for table in key_tables(_made(kind)):
        _show_table(out, kind, table)


def _show_table(out: Any, kind: str, table: KeyTable) -> None:
    from rich import box
    from rich.padding import Padding
    from rich.table import Table
    from rich.text import Text

    out.print(Text.assemble((table.place or f"a {kind} file", "bold"), f"  {table.about}"))
    shown = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    shown.add_column("key", style="cyan", no_wrap=True)
    for head in ("holds", "default", ""):
        shown.add_column(head, overflow="fold")
    for key in table.keys:
        shown.add_row(*(Text(cell) for cell in key))
    out.print(Padding(shown, (0, 0, 0, 2)))
