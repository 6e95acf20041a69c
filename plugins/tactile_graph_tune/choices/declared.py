"""A pipeline's file taken apart: what may be chosen in it, and the file with a choice put in."""

from __future__ import annotations

import copy
import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from tactile_graph import Pipeline, loads
from tactile_graph.errors import UsageError
from tactile_graph.inspect import NodeKind
from tactile_graph.pipeline.document import read_document
from tactile_graph.plugins.registry import installed
from tactile_graph_tune.choices.comparisons import (
    HOLDS,
    Comparison,
    alternatives,
    is_free,
    taken_apart,
)
from tactile_graph_tune.choices.expanded import expanded
from tactile_graph_tune.choices.text import Notes, text_of

ORDER = ("pipeline", "about", "evolves", "source", "conditions", "nodes", "outputs")
Chosen = Mapping[str, tuple[Comparison, ...]]
"""Place -> the comparisons that must all hold there; a place that is not named has none."""


@dataclass(frozen=True)
class Place:
    """Where comparisons stand: a named condition, the guard of a node, or that of a rung.

    Parameters
    ----------
    name : str
        Of the condition, or of the node.
    nodes : tuple of str
        The nodes it keeps from running.
    given : tuple of Comparison
        What the file says there.
    named : bool
        Whether it is a named condition.
    """

    name: str
    nodes: tuple[str, ...]
    given: tuple[Comparison, ...] = ()
    named: bool = False


@dataclass(frozen=True)
class Declared:
    """A pipeline's file as plain data, and the places in it where something may be chosen.

    Parameters
    ----------
    pipeline : Pipeline
        As it was opened.
    data : dict
        The file, rungs of the ladder that have no guard put into nodes of their own.
    places : dict of Place
    fixed : dict
        Node -> the parts of its guard that stay.
    ladder : str
        The ``first_of`` that answers; empty if none does.
    rungs : tuple of str
        Its choices, in the file's order.
    wrapped : dict of str
        Node made for a rung -> the choice in it.
    """

    pipeline: Pipeline
    data: dict[str, Any]
    places: dict[str, Place]
    fixed: dict[str, tuple[str, ...]]
    ladder: str
    rungs: tuple[str, ...]
    wrapped: dict[str, str]

    @property
    def given(self) -> Chosen:
        """What the file itself has chosen."""
        return {p.name: p.given for p in self.places.values() if p.given}

    def places_of(self, node: str) -> tuple[str, ...]:
        """Return the places whose comparisons guard a node."""
        return tuple(p.name for p in self.places.values() if node in p.nodes)

    def with_place(self, place: Place) -> Declared:
        """Return it with one place more."""
        return replace(self, places={**self.places, place.name: place})

    def keeping(self, names: Collection[str]) -> Declared:
        """Return it with some places as the file has them, not to be chosen."""
        places = {k: v for k, v in self.places.items() if k not in names}
        fixed = dict(self.fixed)
        for place in (p for p in self.places.values() if p.name in names):
            parts = (place.name,) if place.named else tuple(c.text for c in place.given)
            fixed |= {n: (*fixed.get(n, ()), *parts) for n in place.nodes}
        return replace(self, places=places, fixed=fixed)

    def opened(self) -> Pipeline:
        """Return the pipeline without any of the comparisons: every node that can run does."""
        return self.resolved(self.text(self.rungs, {}, whole=True))

    def resolved(self, text: str) -> Pipeline:
        """Return the pipeline of a text of this file, on the source it was opened with."""
        found = loads(text, self.pipeline.file, self.pipeline.registry)
        source = self.pipeline.source_override
        return found if source is None else found.with_source(source[0], **source[1])

    def text(
        self,
        order: tuple[str, ...],
        chosen: Chosen,
        head: Mapping[str, Any] | None = None,
        notes: Notes | None = None,
        whole: bool = False,
    ) -> str:
        """Return the file with a choice put in.

        Parameters
        ----------
        order : tuple of str
            The rungs, first first.
        chosen : mapping
        head : mapping, optional
            Entries in place of the file's own: its name, what it is about; empty for none.
        notes : Notes, optional
            Comments by place.
        whole : bool
            Whether nodes are kept that nothing reads then.
        """
        data = copy.deepcopy(self.data)
        data.update(head or {})
        data = {k: data[k] for k in _in_order(data) if data[k] != ""}
        for place in self.places.values():
            if place.named:
                its = chosen.get(place.name, ())
                alone = len(its) == 1 and alternatives(its[0].field) and its[0].sign == HOLDS
                text = " and ".join(c.text for c in its)
                data["conditions"][place.name] = text[1:-1] if alone else text
        for name in self.data["nodes"]:
            self._guard(data["nodes"][name], name, chosen)
        if self.ladder:
            gone = [] if whole else [w for w in self.wrapped if not chosen.get(w)]
            for name in gone:
                del data["nodes"][name]
            rungs = [self.wrapped[r] if r in gone else r for r in order]
            data["nodes"][self.ladder]["first_of"] = rungs
        _drop_unused(data, data["nodes"] if whole else self.pipeline.unused)
        return text_of(data, notes or Notes({}))

    def _guard(self, node: dict[str, Any], name: str, chosen: Chosen) -> None:
        parts = list(self.fixed.get(name, ()))
        for place in (self.places[p] for p in self.places_of(name)):
            texts = [c.text for c in chosen.get(place.name, ())]
            if texts:
                parts += [place.name] if place.named else texts
        node.pop("when", None)
        if parts:
            node["when"] = " and ".join(parts)


def declared(pipeline: Pipeline, answer: str) -> Declared:
    """Return a pipeline's file taken apart.

    Parameters
    ----------
    pipeline : Pipeline
    answer : str
        The output whose error counts.

    Raises
    ------
    UsageError
        If a setting was changed that this file does not hold.
    """
    data = _with_overrides(read_document(pipeline.text, pipeline.file).data, pipeline)
    data = expanded(data, pipeline.file, pipeline.registry or installed())
    target = pipeline.outputs[answer]
    node = pipeline.nodes.get(target.node)
    ladder = ""
    if node is not None and node.kind is NodeKind.FIRST_OF and target.node in data["nodes"]:
        ladder = target.node
    wrapped = _wrap(data, ladder) if ladder else {}
    rungs = tuple(data["nodes"][ladder]["first_of"]) if ladder else ()
    places, fixed = _places(data)
    places |= {w: Place(w, (w,)) for w in wrapped}
    return Declared(pipeline, data, places, fixed, ladder, rungs, wrapped)


def _with_overrides(data: dict[str, Any], pipeline: Pipeline) -> dict[str, Any]:
    """Return a file's data with the settings that were given from outside."""
    data = copy.deepcopy(data)
    for name, settings in pipeline.overrides.items():
        node, _, inner = name.partition("/")
        its = data["nodes"].get(node, {})
        if ("use" if inner else "step") not in its or "/" in inner:
            raise UsageError(
                f"--set {name}.{next(iter(settings))}: is no setting of a step in this file, so "
                "the tuned file could not hold it; set it in the file that does"
            )
        given = {f"{inner}.{k}": v for k, v in settings.items()} if inner else settings
        its["with"] = {**(its.get("with") or {}), **given}
    return data


def _wrap(data: dict[str, Any], ladder: str) -> dict[str, str]:
    """Put each rung that is no guarded node of its own into one; return these."""
    nodes, made = data["nodes"], dict[str, str]()
    rungs = [str(r) for r in nodes[ladder]["first_of"]]
    for i, rung in enumerate(rungs):
        its = nodes.get(rung, {})
        if len(its.get("first_of", ())) == 1 and "when" in its:
            continue
        name = rung.replace(".", "_") + "_good"
        while name in nodes:
            name += "_"
        made[name] = rung
        rungs[i] = name
    if made:
        data["nodes"] = {}
        for name, node in nodes.items():
            if name == ladder:
                data["nodes"] |= {m: {"first_of": [rung]} for m, rung in made.items()}
            data["nodes"][name] = node
        nodes[ladder]["first_of"] = rungs
    return made


def _places(data: Mapping[str, Any]) -> tuple[dict[str, Place], dict[str, tuple[str, ...]]]:
    nodes, conditions = data["nodes"], data.get("conditions", {})
    whole = {n: taken_apart(str(x["when"]), nodes, conditions)
             for n, x in nodes.items() if "when" in x}  # fmt: skip
    rest = [part for taken in whole.values() for part in taken.fixed]
    rest += [text for text in conditions.values() if not is_free(text, nodes)]
    # What a part that stays names has to stay, too.
    free = {k: v for k, v in conditions.items() if k not in words_in(rest)}
    places: dict[str, Place] = {}
    fixed = {}
    for name in whole:
        taken = taken_apart(str(nodes[name]["when"]), nodes, free)
        fixed[name] = taken.fixed
        if taken.comparisons:
            places[name] = Place(name, (name,), taken.comparisons)
        for condition in taken.named:
            its = taken_apart(free[condition], nodes, {}).comparisons
            known = places.get(condition, Place(condition, (), its, named=True))
            places[condition] = replace(known, nodes=(*known.nodes, name))
    return places, fixed


def _in_order(keys: Iterable[str]) -> list[str]:
    """Return the entries of a file as files have them: what it is first."""
    return sorted(keys, key=ORDER.index)


def _drop_unused(data: dict[str, Any], kept: Collection[str]) -> None:
    """Leave out conditions and nodes that nothing names any more, but for those to be kept."""
    nodes, conditions = data["nodes"], data.get("conditions", {})
    n_before = -1
    while n_before != len(nodes) + len(conditions):
        n_before = len(nodes) + len(conditions)
        named = words_in([*_read(nodes), *conditions.values(), *_leaves(data.get("outputs", []))])
        for name in [n for n in nodes if n not in named and n not in kept]:
            del nodes[name]
        for name in [c for c in conditions if not conditions[c] or c not in named]:
            del conditions[name]
    if not conditions:
        data.pop("conditions", None)


def _read(nodes: Mapping[str, Any]) -> Iterator[str]:
    """Yield what nodes say of other nodes."""
    for node in nodes.values():
        for key in ("in", "first_of", "when"):
            yield from _leaves(node.get(key, []))


def _leaves(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping | list):
        for inner in value.values() if isinstance(value, Mapping) else value:
            yield from _leaves(inner)


def words_in(texts: Iterable[str]) -> set[str]:
    """Return the names at the root of the references in some texts, quoted words left aside."""
    bare = (re.sub(r"'[^']*'|\"[^\"]*\"", "", text) for text in texts)
    return {word for text in bare for word in re.findall(r"(?<![\w.])[A-Za-z_]\w*", text)}
