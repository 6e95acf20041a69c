"""Settings written into a pipeline's YAML in their place: all else stays, comments too."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from copy import copy
from functools import lru_cache
from typing import Any, NamedTuple

import yaml

from tactile_graph.errors import UsageError, one_of
from tactile_graph.pipeline.document import on_one_line, read_document

Settings = Mapping[str, Mapping[str, Any]]
"""Node -> setting -> value."""
ON_ONE_LINE: Mapping[str, Any] = {"width": 10**9, "allow_unicode": True}
LINE_END = re.compile(r"\r?\n|\Z")


def text_with(text: str, settings: Settings) -> str:
    """Return a pipeline's YAML with settings changed in it; all else stays, comments too.

    Parameters
    ----------
    text : str
        A pipeline file without faults.
    settings : mapping
        Node -> setting -> value; of ``used/node`` it is written where ``used`` is declared.

    Raises
    ------
    UsageError
        If the YAML is spelled so that they cannot be written into it.
    """
    wanted = read_document(text, "").data
    changed = text
    try:
        for node, values in settings.items():
            declared, _, within = node.partition("/")
            for setting, value in values.items():
                name = f"{within}.{setting}" if within else setting
                changed = _with_one(changed, declared, name, on_one_line(value))
                _enter(wanted, declared, name, value)
        right = changed == text or _holds(changed, wanted)
    except yaml.YAMLError:
        right = False
    if right:
        return changed
    names = [f"{node}.{setting}" for node, values in settings.items() for setting in values]
    nodes = sorted({node.partition("/")[0] for node in settings})
    raise UsageError(
        f"{', '.join(names)}: cannot be written into the file's YAML as it is spelled; spell there "
        f"{one_of(nodes)} like this: {{step: …, in: …, with: {{setting: value}}}}"
    )


# -- whether it came out right -------------------------------------------------------------------


def _enter(data: Any, node: str, setting: str, value: Any) -> None:
    """Change a setting in what a file declares, as plain data."""
    body = data["nodes"][node]
    body["with"] = {**(body.get("with") or {}), setting: value}


def _holds(text: str, wanted: Any) -> bool:
    document = read_document(text, "")
    return not document.problems and _as_text(document.data) == _as_text(wanted)


def _as_text(data: Any) -> str:
    return json.dumps(data, sort_keys=True, default=str)  # nan is no nan, and 1 is 1.0 and True


# -- the places of nodes -------------------------------------------------------------------------


class _Alias(NamedTuple):
    """An alias as a node that has its own place, and the node it stands for."""

    node: yaml.Node
    anchored: yaml.Node


class _Loader(yaml.SafeLoader):
    """Composes nodes so that aliases keep their places."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.aliases: list[_Alias] = []

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Return the next node; of an alias a copy, for it stands elsewhere."""
        event = self.peek_event()  # type: ignore[no-untyped-call]
        node: yaml.Node | None = super().compose_node(parent, index)
        if node is None or not isinstance(event, yaml.AliasEvent):
            return node
        own = copy(node)
        own.start_mark, own.end_mark = event.start_mark, event.end_mark
        if isinstance(own, yaml.CollectionNode):
            own.flow_style = True
        self.aliases.append(_Alias(own, node))
        return own


class _Entry(NamedTuple):
    """A key of a mapping, and its value."""

    key: yaml.Node
    value: yaml.Node


@lru_cache(maxsize=8)
def _composed(text: str) -> tuple[yaml.Node | None, list[_Alias]]:
    """Return a text's nodes, which nobody changes: while a setting is moved its file stays."""
    loader = _Loader(text)
    try:
        return loader.get_single_node(), loader.aliases
    finally:
        loader.dispose()


def _entry(mapping: yaml.Node | None, key: str) -> _Entry | None:
    if not isinstance(mapping, yaml.MappingNode):
        return None
    return next((_Entry(k, v) for k, v in mapping.value if k.value == key), None)


def _entries(root: yaml.Node | None, keys: Sequence[str]) -> Iterator[_Entry]:
    """Yield the entries that lead from the root to a place, as far as there are any."""
    at = root
    for key in keys:
        entry = _entry(at, key)
        if entry is None:
            return
        yield entry
        at = entry.value


def _inside(node: yaml.Node) -> Iterator[yaml.Node]:
    """Yield a node and all that it holds."""
    yield node
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield from _inside(key)
            yield from _inside(value)
    elif isinstance(node, yaml.SequenceNode):
        for item in node.value:
            yield from _inside(item)


def _end(node: yaml.Node) -> int:
    """Return where a node's last character stands: a block's mark is at what comes behind it."""
    if isinstance(node, yaml.CollectionNode) and not node.flow_style and node.value:
        last = node.value[-1]
        return _end(last[1] if isinstance(node, yaml.MappingNode) else last)
    return int(node.end_mark.index)


# -- changes of the text -------------------------------------------------------------------------


def _with_one(text: str, node: str, setting: str, value: str) -> str:
    way = ("nodes", node, "with", setting)
    text = _apart(text, way)
    found = list(_entries(_composed(text)[0], way))
    if len(found) < 2:
        return text
    declared = found[1].value
    if len(found) == 2:
        return _added(text, declared, "with", f"{{{setting}: {value}}}")
    if not isinstance(found[2].value, yaml.MappingNode):  # ``with:`` and nothing behind it
        return _replaced(text, found[2], f"{{{setting}: {value}}}")
    if len(found) == 3:
        return _added(text, found[2].value, setting, value)
    return _replaced(text, found[3], value)


def _apart(text: str, way: Sequence[str]) -> str:
    """Return the text with those aliases written out which a change at a place would change too."""
    root, aliases = _composed(text)
    entries = list(_entries(root, way))
    own = {id(alias.node) for alias in aliases}
    first = next((i for i, e in enumerate(entries) if id(e.value) in own), len(entries))
    changed = {id(e.value) for e in entries[: first + 1]}
    if entries and len(entries) == len(way) and first == len(entries):
        changed |= {id(node) for node in _inside(entries[-1].value)}
    for alias in sorted(aliases, key=lambda alias: -int(alias.node.start_mark.index)):
        if id(alias.node) in changed or id(alias.anchored) in changed:
            mark, end = alias.node.start_mark, alias.node.end_mark
            text = text[: mark.index] + _written_out(alias.anchored) + text[end.index :]
    return text


def _written_out(node: yaml.Node) -> str:
    """Return a node's YAML on one line, without anchors and aliases."""
    listed = yaml.SequenceNode("tag:yaml.org,2002:seq", [_on_one_line(node)], flow_style=True)
    return str(yaml.serialize(listed, Dumper=yaml.SafeDumper, **ON_ONE_LINE)).strip()[1:-1]


def _on_one_line(node: yaml.Node) -> yaml.Node:
    if isinstance(node, yaml.MappingNode):
        pairs = [(_on_one_line(key), _on_one_line(value)) for key, value in node.value]
        return yaml.MappingNode(node.tag, pairs, flow_style=True)
    if isinstance(node, yaml.SequenceNode):
        return yaml.SequenceNode(node.tag, [_on_one_line(n) for n in node.value], flow_style=True)
    assert isinstance(node, yaml.ScalarNode)
    in_lines = "\n" in node.value or node.style in ("|", ">")
    return yaml.ScalarNode(node.tag, node.value, style='"' if in_lines else node.style)


def _replaced(text: str, entry: _Entry, value: str) -> str:
    """Return the text with another value behind a key."""
    start = entry.value.start_mark.index
    end = start + len(text[start : _end(entry.value)].rstrip())
    if text[:start].endswith(":"):
        value = f" {value}"
    key, old = entry.key.start_mark, entry.value.start_mark
    if old.line > key.line and old.column <= key.column:  # only a list may stand so far left
        value = f"  {value}"
    return text[:start] + value + text[end:]


def _added(text: str, mapping: yaml.Node, key: str, value: str) -> str:
    """Return the text with a key added to a mapping, written as the mapping is."""
    if not isinstance(mapping, yaml.MappingNode):
        return text
    if mapping.flow_style:
        return _added_between_braces(text, mapping, f"{key}: {value}")
    first, its = mapping.value[0]
    start = first.start_mark.index
    lead = text[text.rfind("\n", 0, start) + 1 : start]
    if lead.strip() == "?":
        start -= len(lead) - lead.index("?")
    indent = " " * (first.start_mark.column - (first.start_mark.index - start))
    in_line = isinstance(its, yaml.ScalarNode) and its.start_mark.line == its.end_mark.line
    line_end = LINE_END.search(text, _end(its) if in_line else start)
    assert line_end is not None
    newline = line_end[0] or "\n"
    if in_line:
        at = line_end.start()
        return f"{text[:at]}{newline}{indent}{key}: {value}{text[at:]}"
    return f"{text[:start]}{key}: {value}{newline}{indent}{text[start:]}"


def _added_between_braces(text: str, mapping: yaml.MappingNode, entry: str) -> str:
    """Return the text with an entry behind the last one: a comment may stand before the brace."""
    if mapping.value:
        at, entry = _end(mapping.value[-1][1]), f", {entry}"
    else:
        at = text.index("{", mapping.start_mark.index) + 1
    gap = " " if text.startswith("#", at) else ""
    return f"{text[:at]}{entry}{gap}{text[at:]}"
