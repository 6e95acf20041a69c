"""From requests to pipelines with labels: settings, sweeps, parents."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from tactile_graph import Pipeline, load
from tactile_graph.errors import PipelineError, UsageError, did_you_mean, one_of
from tactile_graph.inspect import Graph, idle_settings, plain
from tactile_graph.plugins.registry import Registry, installed
from tactile_graph_compare.variants.request import (
    VariantRequest,
    as_yaml,
    name_of,
    spelled,
)
from tactile_graph_compare.variants.sweeps import Sweep, combinations


class Words(NamedTuple):
    """What people call what they give, on a command line or in a program."""

    settings: str
    sweeps: str
    crossed: str
    reference: str


TYPED = Words("--set", "--sweep", "--product", "--reference")
CALLED = Words("settings", "sweeps", "crossed=True", "reference")


@dataclass(frozen=True, eq=False)
class PreparedVariant:
    """A variant ready to run: its pipeline, its label, and how to ask for it again.

    ``given`` is empty where no command can: the pipeline is a program's own.
    """

    label: str
    pipeline: Pipeline
    asked: tuple[str, ...]
    given: str
    parent: str = ""


@dataclass(frozen=True, eq=False)
class _Loaded:
    request: VariantRequest
    pipeline: Pipeline
    settings: Mapping[str, Any]
    """All that was set of it: in the pipeline handed in, its own, the common ones, of sweeps."""


def prepare(
    requests: Sequence[VariantRequest],
    registry: Registry,
    settings: Mapping[str, Any] | None = None,
    sweeps: Sequence[Sweep] = (),
    crossed: bool = False,
    lineage: bool = False,
    words: Words = TYPED,
) -> list[PreparedVariant]:
    """Return the variants, each with its label.

    Parameters
    ----------
    requests : sequence of VariantRequest
    registry : Registry
    settings : mapping, optional
        For every pipeline that has the node and the setting.
    sweeps : sequence of Sweep
        Likewise; each pipeline that has one becomes as many variants.
    crossed : bool
        Whether several sweeps are crossed with one another instead of going side by side.
    lineage : bool
        Whether the pipelines that those asked for evolved from are compared too, before them.
    words : Words
        What these are called where they come from, for errors.

    Raises
    ------
    UsageError, PipelineError
        If something does not exist, is not allowed, or is named twice.
    """
    if not requests:
        raise UsageError("name the pipelines to compare")
    loaded = [_load(r, registry) for r in requests]
    if lineage:
        loaded = list(_with_parents(loaded, registry))
    common = settings or {}
    _check_names([*common], [x.pipeline for x in loaded], words.settings)
    swept = [x.pipeline for x in loaded if x.request.swept]
    _check_names([s.name for s in sweeps], swept, words.sweeps)
    _check_effect([s.name for s in sweeps], [x for x in loaded if x.request.swept], words.sweeps)
    loaded = [_set(x, {k: v for k, v in common.items() if has_setting(x.pipeline, k)})
              for x in loaded]  # fmt: skip
    everything = [y for x in loaded for y in _swept(x, sweeps, crossed, words)]
    return _with_parent_labels([_prepared(x, everything) for x in everything], everything)


def _load(request: VariantRequest, registry: Registry) -> _Loaded:
    name = request.name
    pipeline = name if isinstance(name, Pipeline) else load(name, registry)
    own = {f"{node}.{k}": v for node, given in pipeline.overrides.items() for k, v in given.items()}
    return _set(_Loaded(request, pipeline, own), request.settings)


def _set(loaded: _Loaded, settings: Mapping[str, Any]) -> _Loaded:
    if not settings:
        return loaded
    changed = loaded.pipeline.with_settings(settings)
    return replace(loaded, pipeline=changed, settings={**loaded.settings, **settings})


def _with_parents(loaded: Sequence[_Loaded], registry: Registry) -> Iterator[_Loaded]:
    """Yield the variants, each behind those it evolved from that nobody named."""
    names = {x.pipeline.name for x in loaded}
    for one in loaded:
        line: list[_Loaded] = []
        child = one.pipeline
        while child.evolves:
            parent = _load(VariantRequest(_parent_named(child), swept=False), registry)
            if parent.pipeline.name in names:
                break
            names.add(parent.pipeline.name)
            line.insert(0, parent)
            child = parent.pipeline
        yield from line
        yield one


def _swept(
    loaded: _Loaded, sweeps: Sequence[Sweep], crossed: bool, words: Words
) -> Iterator[_Loaded]:
    own = [s for s in sweeps if loaded.request.swept and has_setting(loaded.pipeline, s.name)]
    if not own:
        yield loaded
        return
    for settings in combinations(own, crossed, words.crossed):
        yield _set(loaded, settings)


def referred(prepared: Sequence[PreparedVariant], name: str, words: Words = TYPED) -> str:
    """Return the label of the variant that is meant, by its label or as it was given.

    Raises
    ------
    UsageError
        If it is none of them.
    """
    for one in prepared:
        if name in (one.label, one.given, one.given.strip("'")):
            return one.label
    labels = [p.label for p in prepared]
    hint = did_you_mean(name, labels)
    raise UsageError(
        f"{words.reference} {name}: must be one of the variants: {one_of(labels)}{hint}"
    )


# -- settings by name ------------------------------------------------------------------------


def setting_names(pipeline: Graph) -> Iterator[str]:
    """Yield every ``node.setting`` of a pipeline, those of embedded ones included."""
    for name, node in pipeline.nodes.items():
        if node.signature is not None:
            yield from (f"{name}.{s.name}" for s in node.signature.settings)
        if node.inner is not None:
            yield from (f"{name}/{inner}" for inner in setting_names(node.inner))


def has_setting(pipeline: Pipeline, name: str) -> bool:
    """Return whether a pipeline has the node and the setting of ``node.setting``."""
    return name in set(setting_names(pipeline))


def _check_names(names: Sequence[str], pipelines: Sequence[Pipeline], option: str) -> None:
    """Check that each setting is one of some pipeline's."""
    known = {n for p in pipelines for n in setting_names(p)}
    for name in names:
        if name not in known:
            hint = did_you_mean(name, known)
            raise UsageError(f"{option} {name}: none of the pipelines has it{hint}")


def _check_effect(names: Sequence[str], swept: Sequence[_Loaded], option: str) -> None:
    """Refuse a sweep of which all variants would be alike."""
    for name in names:
        having = [x for x in swept if has_setting(x.pipeline, name)]
        if all(idle_settings(x.pipeline, [name], x.request.only) for x in having):
            node = name.rpartition(".")[0]
            raise UsageError(
                f"{option} {name}: all variants would be alike, for no output that is asked for"
                f" needs {node!r}"
            )


# -- labels ----------------------------------------------------------------------------------


def _prepared(one: _Loaded, everything: Sequence[_Loaded]) -> PreparedVariant:
    pipeline, only = one.pipeline, one.request.only
    for name in only:
        pipeline.ref(name)  # says what is wrong with it
    named = one.request.name
    name = name_of(named) if isinstance(named, Pipeline) else str(named)
    words = spelled(name or pipeline.name, one.settings, only)
    label = _label(one)
    if sum(_label(other) == label for other in everything) > 1:
        label = words.strip("'")
    asked = only or tuple(pipeline.outputs)
    return PreparedVariant(label, pipeline, asked, words if name else "")


def _label(one: _Loaded) -> str:
    """Return the pipeline's name and what was set, settings by their bare names if that will do."""
    bare = [k.rpartition(".")[2] for k in one.settings]
    words = [one.pipeline.name]
    for key, short in zip(one.settings, bare, strict=True):
        words.append(f"{short if bare.count(short) == 1 else key}={_short(one.settings[key])}")
    if one.request.only:
        words.append("only " + ", ".join(one.request.only))
    return " ".join(words)


def _short(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else as_yaml(value)


def _with_parent_labels(
    prepared: Sequence[PreparedVariant], loaded: Sequence[_Loaded]
) -> list[PreparedVariant]:
    seen: set[str] = set()
    found = []
    for one, its in zip(prepared, loaded, strict=True):
        if one.label in seen:
            raise UsageError(f"the same variant is named twice: {one.label}")
        seen.add(one.label)
        parent = _parent(its, loaded)
        label = "" if parent is None else prepared[parent].label
        found.append(replace(one, parent=label))
    return found


def _parent(one: _Loaded, everything: Sequence[_Loaded]) -> int | None:
    """Return which variant it evolves from; of several, one with as many equal settings as can be.

    Where the parent itself is not compared, its own parent is taken, and so on.
    """
    child: Pipeline | None = one.pipeline
    met = {one.pipeline.name}
    while child is not None and child.evolves:
        ancestor = _own_name(child.evolves, child.registry or installed())
        if ancestor in met:
            return None
        met.add(ancestor)
        candidates = [i for i, x in enumerate(everything) if x.pipeline.name == ancestor]
        if candidates:
            return max(candidates, key=lambda i: (_alike(everything[i], one), -i))
        child = _loaded_parent(child)
    return None


def _alike(a: _Loaded, b: _Loaded) -> int:
    return sum(k in b.settings and plain(b.settings[k]) == plain(v) for k, v in a.settings.items())


def _parent_named(child: Pipeline) -> str | Path:
    """Return what a pipeline evolved from, as `load` takes it."""
    is_file = child.evolves.endswith((".yaml", ".yml"))
    return Path(child.file).parent / child.evolves if is_file else child.evolves


def _own_name(name: str, registry: Registry) -> str:
    """Return what a pipeline is called in its own file, without its plugin's name."""
    if name.endswith((".yaml", ".yml")):
        return Path(name).stem
    return registry.offer("pipelines", name).name if registry.has("pipelines", name) else name


def _loaded_parent(child: Pipeline) -> Pipeline | None:
    """Return what a pipeline that is not compared evolved from; None if that cannot be had."""
    try:
        return load(_parent_named(child), child.registry)
    except (UsageError, PipelineError):
        return None
