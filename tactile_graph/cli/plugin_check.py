"""What ``tactile-graph plugins --check`` shows: what is wrong with a plugin, a line each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from tactile_graph.errors import TactileGraphError, UsageError, did_you_mean, one_of
from tactile_graph.plugins.names import OWN, Plugin
from tactile_graph.plugins.registry import Registry

if TYPE_CHECKING:
    from rich.console import Console

    from tactile_graph.testing.plugin_check import PluginReport


def show_checked(found: Registry, names: Sequence[str]) -> bool:
    """Print what is wrong with plugins, without a name all of others; return whether nothing is.

    Raises
    ------
    UsageError
        If there is no plugin of a name, or none of others.
    """
    from tactile_graph.cli.terminal import console
    from tactile_graph.testing.apart import Apart
    from tactile_graph.testing.plugin_check import examine_plugin

    out = console()
    right = True
    apart = Apart(found)
    for plugin in _asked(found, names):
        with out.status(plugin.name) as status:
            told = lambda what: status.update(f"trying {what}")  # noqa: E731
            report = examine_plugin(plugin, found, told, apart.examine)
        report.broken += [*_wrong_readers(found, plugin), *hidden_commands(plugin)]
        _show(out, report)
        right &= not report.broken
    apart.close()
    return right


def _asked(found: Registry, names: Sequence[str]) -> list[Plugin]:
    known = [p.name for p in found.plugins]
    for name in names:
        if name not in (*known, *(p.package for p in found.plugins)):
            hint = did_you_mean(name, known) or f"; there are: {one_of(known, 20)}"
            raise UsageError(f"no plugin named {name!r}{hint}")
    if names:
        return [p for p in found.plugins if {p.name, p.package} & {*names} and not p.blocked]
    others = [p for p in found.plugins if p.package != OWN and not p.blocked]
    if not others:
        own = one_of(known, 20)
        raise UsageError(f"no plugin of others is installed; --check NAME takes one of: {own}")
    return others


def hidden_commands(plugin: Plugin) -> Iterator[str]:
    """Yield what is said of a plugin's commands that the project has itself."""
    from tactile_graph.cli.app import COMMANDS

    for name in plugin.offers.get("commands", ()):
        if name in COMMANDS:
            yield f"command {name!r} of {plugin.label} is refused: tactile-graph has its own"


def _wrong_readers(found: Registry, plugin: Plugin) -> Iterator[str]:
    """Yield why the command line could not have recordings read by steps that are there."""
    from tactile_graph.steps.signature import Kind

    for plain in plugin.offers.get("readers", ()):
        name = found.spelled("readers", f"{plugin.name}.{plain}")
        try:
            signature = found.step(name)
        except TactileGraphError:  # told already
            continue
        setting = str(found.offer("readers", name).target)
        known = [s.name for s in signature.settings]
        if signature.kind is not Kind.SOURCE:
            yield f"reader {name!r}: this step is no source: it yields no frames"
        elif setting not in known:
            hint = did_you_mean(setting, known) or f"; its settings are: {one_of(known)}"
            yield f"reader {name!r}: the step has no setting {setting!r}{hint}"


def _show(out: Console, report: PluginReport) -> None:
    from rich.text import Text

    n, plugin = len(report.broken), report.plugin
    head = f"{plugin.name} ({plugin.package} {plugin.version})"
    if not n:
        offers = f"  {report.n_offers} offer{'s' if report.n_offers != 1 else ''}"
        words = Text.assemble((f"{head}: right", "bold green"), offers)
    else:
        words = Text.assemble((f"{head}: {n} broken", "bold red"))
    out.print(words, soft_wrap=True)
    for line in report.broken:
        out.print(Text(f"  {line}"), soft_wrap=True)
    for told in (*report.clashes, *report.advice):
        out.print(Text(f"  {told}", style="yellow"), soft_wrap=True)
    for name, why in report.untried.items():
        out.print(Text(f"  step {name!r} was not tried: {why}", style="yellow"), soft_wrap=True)
