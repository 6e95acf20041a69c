"""A click group whose commands, plugins' too, are imported only when they are called."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from difflib import SequenceMatcher
from pathlib import Path
from typing import Any

import click

from tactile_graph.cli import endings, shared
from tactile_graph.cli.say import say
from tactile_graph.errors import TactileGraphError, did_you_mean, one_of
from tactile_graph.pipeline.named_files.named_files import is_there
from tactile_graph.plugins import registry

LEAST_ALIKE = 0.75
"""Ratio of matching letters from which a word may be a command's name that was mistyped."""


def _preparing_told(ctx: click.Context) -> AbstractContextManager[None]:
    """Have it told what is compiled; the help of a command compiles nothing."""
    if not {*ctx.help_option_names}.isdisjoint([*ctx._protected_args, *ctx.args]):
        return nullcontext()
    from tactile_graph.compiled.preparing import Line, told_by

    return told_by(Line())


def _options(command: click.Command, ctx: click.Context) -> list[str]:
    """Return how a command's options are spelled."""
    return [text for option in command.get_params(ctx) for text in option.opts]


def _spelled_alike(word: str, name: str) -> bool:
    """Return whether a word is so near to a command's name that it may be a slip, or a part."""
    word, name = word.casefold(), name.casefold()
    in_part = min(len(word), len(name)) >= 3 and (name.startswith(word) or word.startswith(name))
    return in_part or SequenceMatcher(None, name, word).ratio() >= LEAST_ALIKE


def _same_word(one: str, other: str) -> bool:
    """Return whether two words are one but for an ending: figure and figures, draw and drawing."""
    short, long = sorted((one, other), key=len)
    return len(short) >= 4 and long.startswith(short) and len(long) - len(short) <= 3


def _is_pipeline(name: str) -> bool:
    return registry.installed().has("pipelines", name) or name.endswith((".yaml", ".yml"))


@contextmanager
def _told_of_options(given: Sequence[str]) -> Iterator[None]:
    """Have it told what may be meant by an option that is not there."""
    try:
        yield
    except click.NoSuchOption as error:
        hint = _misplaced(error, given)
        if not hint:
            raise
        raise click.UsageError(error.format_message().rstrip(".") + hint, error.ctx) from error


def _misplaced(error: click.NoSuchOption, given: Sequence[str]) -> str:
    """Return what may be meant by an option that a command has not: another place, two hyphens."""
    ctx = error.ctx
    if ctx is None:
        return ""
    for word in given:
        if not word.startswith("--") and f"-{word}" in _options(ctx.command, ctx):
            return f"; did you mean '-{word}'?"
    if isinstance(ctx.command, Group):
        names = ctx.command.list_commands(ctx)
        name = next((word for word in given if word in names), None)
        if name is not None:
            spelled = f"{ctx.command_path} {name} {error.option_name} …"
            return f"; a command's options stand behind it: '{spelled}'"
    return ""


class Group(click.Group):
    """Commands by name; ``--help`` imports none of them.

    ``built_in`` maps the name of each own command to what ``--help`` says of it.
    """

    def __init__(self, *args: Any, built_in: Mapping[str, str], **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.built_in = dict(built_in)
        shared.add_options(self)

    # -- finding -----------------------------------------------------------------------------

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the project's own commands, then the plugins'."""
        return [*self.built_in, *self._offered()]

    def _offered(self) -> list[str]:
        return [n for n in registry.installed().names("commands") if n not in self.built_in]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command, imported; None if there is none of that name.

        Raises
        ------
        PluginError
            If a plugin's command cannot be imported or is none.
        """
        command: click.Command
        if cmd_name in self.built_in:
            from importlib import import_module

            command = getattr(import_module(f"tactile_graph.cli.commands.{cmd_name}"), cmd_name)
        elif registry.installed().has("commands", cmd_name):
            command = registry.installed().load("commands", cmd_name)
        else:
            return None
        shared.add_options(command)
        return command

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command the first argument names, or say what is near it."""
        name = args[0]
        if self.get_command(ctx, name) is None and not name.startswith("-"):
            ctx.fail(f"no command named {name!r}{self._meant(ctx, args)}")
        return super().resolve_command(ctx, args)

    def _meant(self, ctx: click.Context, args: list[str]) -> str:
        """Return what somebody may have meant who typed no command."""
        name, names, program = args[0], self.list_commands(ctx), ctx.info_name
        if f"--{name}" in _options(self, ctx):
            of = f"{args[1]} " if args[1:] and args[1] in names else ""
            return f"; it is an option: '{program} {of}--{name}'"
        if _is_pipeline(name):
            return f"; a pipeline is run by '{program} run {name}'"
        near = did_you_mean(name, [n for n in names if _spelled_alike(name, n)])
        if self._is_recording(name) and not (near and Path(name).stem == name):  # a folder, say
            pipeline = next(filter(_is_pipeline, args), "PIPELINE")
            return f"; a pipeline is run over recordings by '{program} run {pipeline} {name}'"
        missing = registry.installed().missing_plugins()
        near = near or ("" if missing else self._about(name))
        return (near or f"; there are: {one_of(names, 30)}") + missing

    def _is_recording(self, name: str) -> bool:
        """Return whether a word is called as files are, and no command of any plugin."""
        plugins = [plugin.name for plugin in registry.installed().plugins]
        ending = Path(name).suffix and name.partition(".")[0] not in plugins
        return is_there(Path(name)) or "/" in name or bool(ending)

    def _about(self, word: str) -> str:
        """Return which command says that it is about such a thing, or an empty text."""
        said = {**self.built_in, **{name: self._summary(name) for name in self._offered()}}
        words = [(w.strip(".,:;()'"), name) for name, text in said.items() for w in text.split()]
        about = [(w.lower(), name) for w, name in words if not w.isupper()]  # NAME is a place
        near = [(w, name) for w, name in about if _same_word(word.lower(), w)]
        found = next((its for its in near if its[0] == word.lower()), next(iter(near), None))
        return f"; {found[1]!r} is about {found[0]!r}" if found else ""

    # -- help --------------------------------------------------------------------------------

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the two lists of commands."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.built_in.items()))
        offered = [(name, self._summary(name)) for name in self._offered()]
        if offered:
            with formatter.section("Commands of plugins"):
                formatter.write_dl(offered)
        down = [(p.name, p.error) for p in registry.installed().plugins if p.error]
        if down:
            with formatter.section("Plugins that failed to load, commands of theirs with them"):
                formatter.write_dl(down)

    def _summary(self, name: str) -> str:
        from tactile_graph.plugins.outline import summary_of

        offer = registry.installed().offer("commands", name)
        return summary_of(offer.target) or f"(of {offer.plugin.label})"

    # -- running -----------------------------------------------------------------------------

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Take the command line apart; where it is empty the help says what there is."""
        if not args and not ctx.resilient_parsing:
            say(ctx.get_help(), err=True)
            ctx.exit(endings.NOT_DONE)
        return super().parse_args(ctx, args)

    def invoke(self, ctx: click.Context) -> None:
        """Run the command asked for; what it returns is no exit code."""
        try:
            with _preparing_told(ctx):
                super().invoke(ctx)
        except BrokenPipeError:
            endings.stop_writing()
            ctx.exit(endings.PIPE_CLOSED)

    def main(
        self,
        args: Sequence[str] | None = None,
        prog_name: str | None = None,
        complete_var: str | None = None,
        standalone_mode: bool = True,
        **extra: Any,
    ) -> Any:
        """Run a command line; unless told otherwise, show what went wrong and exit."""
        given = list(sys.argv[1:] if args is None else args)
        inner: Callable[..., Any] = super().main
        completing = (complete_var or "_TACTILE_GRAPH_COMPLETE") in os.environ

        def run() -> Any:
            try:
                with _told_of_options(given):
                    return inner(given, prog_name or "tactile-graph", complete_var, False, **extra)
            except (click.ClickException, TactileGraphError):
                if not completing:
                    raise
                return None  # a shell asks in the middle of a line: it would stand in it

        return sys.exit(endings.ending(run, "--debug" in given)) if standalone_mode else run()
