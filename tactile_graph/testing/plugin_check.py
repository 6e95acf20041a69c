"""Everything a plugin offers, imported and tried: what is wrong with it, a line each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any, get_args, get_origin

from tactile_graph.errors import (
    PipelineError,
    TactileGraphError,
    did_you_mean,
    one_of,
    shown,
    text_of,
)
from tactile_graph.exporter import Exporter, Holds
from tactile_graph.plugins.names import Plugin, qualified, singular
from tactile_graph.plugins.registry import Registry
from tactile_graph.steps.signature import type_name
from tactile_graph.testing.here import StepReport, examined_here

FILES = ("pads", "presets", "scenes")


@dataclass
class PluginReport:
    """What became of what a plugin offers.

    Parameters
    ----------
    plugin : Plugin
    broken : list of str
        A line for each thing that is wrong.
    untried : dict of str to str
        Why a step was not tried, by name.
    clashes : list of str
        A line for each of its names that another plugin has too; that breaks nothing.
    advice : list of str
        A line for each of its steps that could be of more use; that breaks nothing.
    n_offers : int
        How many things were looked at.
    """

    plugin: Plugin
    broken: list[str] = field(default_factory=list)
    untried: dict[str, str] = field(default_factory=dict)
    clashes: list[str] = field(default_factory=list)
    advice: list[str] = field(default_factory=list)
    n_offers: int = 0


def examine_plugin(
    plugin: Plugin,
    registry: Registry,
    told: Callable[[str], None] = lambda what: None,
    examine: Callable[[str], StepReport] | None = None,
) -> PluginReport:
    """Return what is wrong with all that a plugin offers.

    Parameters
    ----------
    plugin : Plugin
        One of the registry.
    registry : Registry
    told : callable, optional
        Told what is looked at next, such as ``step 'median'``.
    examine : callable, optional
        Tries a step by its name; `examined_here` in this process if not given.
    """
    examine = examine or partial(examined_here, registry=registry)
    report = PluginReport(plugin)
    if plugin.error:
        report.broken.append(plugin.error)
    for kind in registry.kinds:
        for plain in plugin.offers.get(kind, ()):
            name = registry.spelled(kind, qualified(plugin.name, plain))
            what = f"{singular(kind)} {name!r}"
            told(what)
            report.n_offers += 1
            if kind == "steps":
                _look_at_step(report, registry, examine, name)
            else:
                report.broken += [f"{what}: {w}" for w in _wrong(registry, kind, name)]
    report.clashes += [told for told in registry.clashes if plugin.label in told]
    return report


def _look_at_step(
    report: PluginReport, registry: Registry, examine: Callable[[str], StepReport], name: str
) -> None:
    found = examine(name)
    report.broken += found.lines()
    if found.untried:
        report.untried[name] = found.untried
    elif not found.broken and not found.n_values:
        report.untried[name] = "it gave no value in any case"
    if found.n_values and (kind := _unnamed(registry.step(name).output)):
        report.advice.append(
            f"step {name!r} gives {kind}, of which tables only show how many items there are; a "
            "NamedTuple gives each a name, a column, and wires of its own"
        )


def _unnamed(output: Any) -> str:
    """Return the type of an output that is a plain tuple of numbers or texts, else empty."""
    items = get_args(output) if get_origin(output) is tuple else ()
    plain = any(isinstance(k, type) and issubclass(k, bool | int | float | str) for k in items)
    return type_name(output) if plain and Ellipsis not in items else ""


def _wrong(registry: Registry, kind: str, name: str) -> Iterator[str]:
    """Yield what is wrong with an offer that is no step."""
    try:
        if kind == "pipelines":
            from tactile_graph.pipeline.load import load_graph

            load_graph(name, registry)
        elif kind in FILES:
            _read(registry, kind, name)
        elif kind == "readers":
            registry.step(name)
        elif registry.is_imported(kind):
            yield from _wrong_holding(registry.load(kind, name))
    except PipelineError as error:
        yield from (str(p).partition("\n")[0] for p in error.problems)
    except TactileGraphError as error:
        yield " ".join(text_of(error).split())


def _wrong_holding(offer: Any) -> Iterator[str]:
    """Yield why an exporter could not be told what it is to be given."""
    allowed = get_args(Holds)
    if isinstance(offer, Exporter) and offer.holds not in allowed:
        hint = did_you_mean(offer.holds, allowed)
        yield f"it holds {shown(offer.holds)}, must be one of {one_of(allowed)}{hint}"


def _read(registry: Registry, kind: str, name: str) -> None:
    """Read the file of a pad, preset or scene, as whatever uses it does."""
    from tactile_graph.plugins.file_kind import FileKind

    for known in registry.names("file_kinds"):
        reader = registry.load("file_kinds", known)
        if isinstance(reader, FileKind) and reader.offers == kind:
            reader.read(str(registry.path(kind, name)))
