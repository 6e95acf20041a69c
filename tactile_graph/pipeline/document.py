"""Read YAML into plain data that remembers where each value stood."""

from __future__ import annotations

import os
import pathlib
import unicodedata
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any

import yaml

from tactile_graph.errors import Mark, PipelineError, Problem, UsageError, shown
from tactile_graph.files import is_named_pipe
from tactile_graph.pipeline import yaml_numbers
from tactile_graph.pipeline.yaml_numbers import in_yaml as in_yaml
from tactile_graph.pipeline.yaml_numbers import is_plain as is_plain
from tactile_graph.pipeline.yaml_numbers import on_one_line as on_one_line
from tactile_graph.pipeline.yaml_numbers import quote_for_all as quote_for_all
from tactile_graph.text_files import decoded

Path = tuple[str | int, ...]
MOST_NODES = 20_000  # a few lines of nested aliases can stand for billions of values
DEEPEST = 40
MOST_KEYS = 2_000  # of one mapping
MOST_CHARACTERS, MOST_BYTES = 400_000, 4_000_000  # PyYAML takes a second for a million line ends
MOST_PROBLEMS = 100  # nobody reads more, and each may take a millisecond to word
LONGEST_NUMBER = 1_000  # characters; the value of 1:59:59:… takes their square
OFTEN_READ = 20_000  # characters; nodes of longer texts are not kept

_SCALARS = {
    "tag:yaml.org,2002:" + kind for kind in ("null", "bool", "int", "float", "str", "timestamp")
}
_KEYS = {*_SCALARS, "tag:yaml.org,2002:merge", "tag:yaml.org,2002:value"}


def _refused(tag: str) -> str:
    return f"the tag {tag!r} is refused: pipeline files hold plain values only"


@dataclass
class Document:
    """One YAML file as plain data, with a mark for each key and value, and all its problems."""

    file: str
    text: str
    data: Any = None
    problems: list[Problem] = field(default_factory=list)
    _keys: dict[Path, Mark] = field(default_factory=dict)
    _values: dict[Path, Mark] = field(default_factory=dict)
    _switches: dict[Path, str] = field(default_factory=dict)
    _joined: set[Path] = field(default_factory=set)
    _unread: set[Path] = field(default_factory=set)

    def spelled(self, *path: str | int) -> str:
        """Return how a yes/no is written: a condition may be called ``on``, a yes to YAML.

        ``true`` and ``false`` in any case come back as conditions spell them: True, False.
        """
        text = self.raw(*path)
        return text.capitalize() if text.lower() in ("true", "false") else text

    def raw(self, *path: str | int) -> str:
        """Return how a yes/no stands in the file."""
        return self._switches[path]

    def joins_lines(self, *path: str | int) -> bool:
        """Return whether YAML made one line of a text that has several in the file."""
        return path in self._joined

    def mark(self, *path: str | int, key: bool = False) -> Mark:
        """Return where the value (or its key) at ``path`` stands, else its nearest parent."""
        while path:
            found = (self._keys.get(path) if key else None) or self._values.get(path)
            if found is not None:
                return found
            path = path[:-1]
        return self._values.get((), Mark(self.file, 1, 1))

    def problem(self, message: str, *path: str | int, key: bool = False) -> None:
        """Note a problem at ``path``; none of a value that could not be read, which is told."""
        if key or path not in self._unread:
            self.problem_at(self.mark(*path, key=key), message)

    def unread(self, mark: Mark, message: str, path: Path) -> None:
        """Note that the value at ``path`` cannot be read, and why."""
        self._unread.add(path)
        self.problem_at(mark, message)

    def has_unread(self, *path: str | int) -> bool:
        """Return whether a value at or in ``path`` could not be read."""
        return any(place[: len(path)] == path for place in self._unread)

    def problem_at(self, mark: Mark | None, message: str) -> None:
        """Note a problem at ``mark``, or nowhere in the file.

        Raises
        ------
        PipelineError
            If there are `MOST_PROBLEMS` already.
        """
        found = Problem(mark, message, self.snippet(mark) if mark else "")
        if found in self.problems:
            return
        if len(self.problems) >= MOST_PROBLEMS:
            text = f"more than {MOST_PROBLEMS} mistakes: the rest of the file was not looked at"
            raise PipelineError([*self.problems, Problem(None, text)])
        self.problems.append(found)

    @cached_property
    def _lines(self) -> list[str]:
        return self.text.splitlines()

    def snippet(self, mark: Mark) -> str:
        """Return the marked line with a caret below its column."""
        lines = self._lines
        if not 1 <= mark.line <= len(lines):
            return ""
        line = lines[mark.line - 1]
        start = max(0, mark.column - 60)
        part = line[start : start + 100].replace("\t", " ")
        label = f"  {mark.line} | {'…' if start else ''}"
        return f"{label}{part}\n{' ' * (len(label) + _columns(part[: mark.column - 1 - start]))}^"


def _columns(text: str) -> int:
    """Return how wide a terminal shows a text: some letters take two columns, some none."""
    return sum(
        0 if unicodedata.combining(c) else 2 if unicodedata.east_asian_width(c) in "WF" else 1
        for c in text
    )


def text_of_file(path: pathlib.Path, most_bytes: int = MOST_BYTES, waited_for: bool = False) -> str:
    """Return a file's text, as far as it has an end; no more of it is read than is allowed.

    Parameters
    ----------
    path : Path
    most_bytes : int
    waited_for : bool
        Whether it may be a pipe that is still to be written to, as one that a person names.

    Raises
    ------
    UsageError
        If it is longer, or a pipe.
    OSError, UnicodeDecodeError
        If it cannot be read, or is neither UTF-8 nor UTF-16 with its byte-order mark.
    """
    if not waited_for and is_named_pipe(path):
        raise UsageError(f"{str(path)!r} is a pipe; save what it gives as a file first")
    with path.open("rb") as file:
        data = file.read(most_bytes + 1)
    if len(data) > most_bytes:
        raise UsageError(f"{str(path)!r} is longer than {most_bytes} bytes")
    return decoded(data)


def read_document(text: str, file: str) -> Document:
    """Return the document; what is wrong with its YAML stands in its ``problems``."""
    document = Document(file, text)
    if len(text) > MOST_CHARACTERS:
        document.problem_at(Mark(file, 1, 1), f"the file is too long: {len(text)} characters, "
                            f"allowed are {MOST_CHARACTERS}")  # fmt: skip
        return document
    if not _clean(document):
        return document
    try:
        if len(text) > OFTEN_READ:
            _look_ahead(text)
        node = (_composed if len(text) <= OFTEN_READ else _composed.__wrapped__)(text)
        if node is None:
            document.problem_at(Mark(file, 1, 1), "the file is empty")
            return document
        document.data = _Reader(document).read(node, ())
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = Mark(file, mark.line + 1, mark.column + 1) if mark else Mark(file, 1, 1)
        document.problem_at(place, f"this is not YAML: {_yaml_words(error)}")
    except _TooMuch as error:
        document.problem_at(
            Mark(file, error.line, 1), f"this is not YAML that can be read: {error}"
        )
    except yaml.YAMLError as error:
        document.problem_at(Mark(file, 1, 1), f"this is not YAML that can be read: {error}")
    return document


@lru_cache(maxsize=128)
def _composed(text: str) -> yaml.Node | None:
    """Return YAML's nodes, which nobody changes; the same pads and pipelines are read often."""
    loader = _Loader(text)
    try:
        node: yaml.Node | None = loader.get_single_node()
    finally:
        loader.dispose()
    if node is not None:
        _measure(node)
    return node


def _look_ahead(text: str) -> None:
    """Refuse a text of too many values by libyaml, if there is one: PyYAML takes far longer."""
    if not hasattr(yaml, "CSafeLoader"):
        return
    count, within = 0, [_Collection()]
    with suppress(yaml.YAMLError):  # PyYAML says more of what is wrong
        for event in yaml.parse(text, Loader=yaml.CSafeLoader):
            if isinstance(event, yaml.CollectionEndEvent):
                within.pop()
            if not isinstance(event, yaml.NodeEvent):
                continue
            count += 1
            within[-1].n_inside += 1
            if count > MOST_NODES:
                raise _TooMuch(f"more than {MOST_NODES} values")
            if within[-1].is_mapping and within[-1].n_inside > 2 * MOST_KEYS:
                raise _TooMuch(f"a mapping of more than {MOST_KEYS} keys", within[-1].line)
            if isinstance(event, yaml.CollectionStartEvent):
                is_mapping = isinstance(event, yaml.MappingStartEvent)
                mark = event.start_mark
                within.append(_Collection(is_mapping, mark.line + 1 if mark else 1))
            if len(within) > DEEPEST + 2:
                return


@dataclass
class _Collection:
    """A mapping or sequence that is being read, and how many keys and values it holds so far."""

    is_mapping: bool = False
    line: int = 1
    n_inside: int = 0


def _yaml_words(error: yaml.MarkedYAMLError) -> str:
    """Return PyYAML's words, better ones where people stumble most."""
    text = str(error.problem or error.context)
    if "'\\t'" in text:
        return "a tab cannot stand here: YAML is indented with spaces"
    if text == "but found another document":
        return "'---' begins a second document, but a file holds one pipeline"
    if text.startswith("expected ',' or '}', but got ':'"):
        return f"{text}: a comma is missing before this key, or braces around a mapping in {{…}}"
    if text.startswith("mapping values are not allowed"):
        return f"{text}: is the line indented as the others, and a text with ': ' in it quoted?"
    return text


def _clean(document: Document) -> bool:
    """Return whether YAML's reader takes every character; note the first that it does not."""
    bad = yaml.reader.Reader.NON_PRINTABLE.search(document.text)
    if bad is None:
        return True
    before = document.text[: bad.start()]
    mark = Mark(document.file, before.count("\n") + 1, len(before) - before.rfind("\n"))
    document.problem_at(mark, f"a character that YAML does not allow: {bad.group()!r}")
    return False


class _TooMuch(Exception):  # noqa: N818 -- never leaves this module
    def __init__(self, text: str, line: int = 1) -> None:
        super().__init__(text)
        self.line = line


class _Loader(yaml_numbers.Loader):
    """Counts levels, for PyYAML descends as deep as Python's stack, and values while they come."""

    depth = 0
    count = 0

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        self.depth += 1
        self.count += 1
        if self.count > MOST_NODES:
            raise _TooMuch(f"more than {MOST_NODES} values")
        if self.depth > DEEPEST:
            raise _TooMuch(f"deeper than {DEEPEST} levels")
        node: yaml.Node | None = super().compose_node(parent, index)
        self.depth -= 1
        return node


def _measure(node: yaml.Node) -> None:
    """Refuse documents that aliases make endless or huge, before anything is built."""
    count = 0

    def visit(node: yaml.Node, depth: int, open_nodes: tuple[int, ...]) -> None:
        nonlocal count
        count += 1
        if count > MOST_NODES or depth > DEEPEST:
            raise _TooMuch(f"more than {MOST_NODES} values, or deeper than {DEEPEST} levels")
        if id(node) in open_nodes:
            raise _TooMuch("an alias that contains itself")
        if isinstance(node, yaml.CollectionNode):
            inner = (*open_nodes, id(node))
            for child in _children(node):
                visit(child, depth + 1, inner)

    visit(node, 0, ())


def _children(node: yaml.CollectionNode) -> Iterable[yaml.Node]:
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            yield key
            yield value
    else:
        yield from node.value


class _Reader:
    def __init__(self, document: Document) -> None:
        self.document = document
        self.constructor = yaml_numbers.Constructor()

    def _mark(self, node: yaml.Node) -> Mark:
        return Mark(self.document.file, node.start_mark.line + 1, node.start_mark.column + 1)

    def read(self, node: yaml.Node, path: Path) -> Any:
        self.document._values[path] = self._mark(node)
        if isinstance(node, yaml.MappingNode) and node.tag == "tag:yaml.org,2002:map":
            return self._mapping(node, path)
        if isinstance(node, yaml.SequenceNode) and node.tag == "tag:yaml.org,2002:seq":
            return [self.read(child, (*path, i)) for i, child in enumerate(node.value)]
        if isinstance(node, yaml.ScalarNode) and node.tag in _SCALARS:
            value = self._scalar(node, path)
            if isinstance(value, bool):
                self.document._switches[path] = str(node.value)
            elif self._has_lines_joined(node):
                self.document._joined.add(path)
            return value
        self.document.unread(self._mark(node), _refused(node.tag), path)
        return None

    def _has_lines_joined(self, node: yaml.ScalarNode) -> bool:
        begin, end = node.start_mark, node.end_mark
        if node.style == "|" or begin.line == end.line:
            return False
        lines = self.document.text[begin.index : end.index].splitlines()
        if node.style == ">":  # its sign has a line of its own
            del lines[0]
        return sum(not line.isspace() for line in lines if line) > 1

    def _scalar(self, node: yaml.ScalarNode, path: Path) -> Any:
        if node.tag == "tag:yaml.org,2002:timestamp":
            return node.value
        if node.tag != "tag:yaml.org,2002:str" and len(node.value) > LONGEST_NUMBER:
            text = f"a number of {len(node.value)} characters; allowed are {LONGEST_NUMBER}"
            self.document.unread(self._mark(node), text, path)
            return None
        try:
            return self.constructor.construct_object(node, deep=True)
        except (ValueError, LookupError, yaml.YAMLError):
            # A tag can call any word a number: PyYAML then stumbles in several ways.
            kind = node.tag.rpartition(":")[2]
            self.document.unread(self._mark(node), f"{shown(node.value)} is no {kind}", path)
            return None

    def _mapping(self, node: yaml.MappingNode, path: Path) -> dict[str, Any]:
        result: dict[str, Any] = {}
        for key_node, value_node in node.value:
            mark = self._mark(key_node)
            if not isinstance(key_node, yaml.ScalarNode):
                self.document.problem_at(mark, "a key must be a plain word")
                continue
            key = str(key_node.value)
            if key_node.tag not in _KEYS:
                self.document.problem_at(mark, _refused(key_node.tag))
                continue
            if key_node.tag == "tag:yaml.org,2002:merge":
                self.document.problem_at(
                    mark, "merge keys ('<<') are refused: write the values out"
                )
                continue
            if key in result:
                first = self.document._keys[(*path, key)]
                self.document.problem_at(
                    mark, f"{key!r} is given twice; the first is in line {first.line}"
                )
                continue
            self.document._keys[(*path, key)] = mark
            result[key] = self.read(value_node, (*path, key))
        return result


_WRITTEN = ('""', "''", "[]", "{}")
"""What a value begins and ends with that is written as YAML has it."""


def assignment(
    option: str,
    text: str,
    takes_text: Callable[[str], bool] = lambda _: False,
    takes_paths: Callable[[str], bool] = lambda _: False,
) -> tuple[str, Any]:
    """Return name and value of ``name=value``, the value read as YAML.

    Parameters
    ----------
    option, text : str
    takes_text : callable
        Whether a setting of some name may be any text: what is no YAML, such as ``%H:%M`` or
        ``#3``, is taken as it is typed there, and so is a text with `` #`` in it.
    takes_paths : callable
        Whether a setting of some name may be any path: all but null and what stands in quotes or
        brackets, such as ``D:``, ``2024`` or ``rec #2.npz``, is taken as it is typed there, and so
        is a file of that very name.

    Raises
    ------
    UsageError
        If there is no ``=``, or the value is no plain YAML, or a text with a comment behind it.
    """
    name, sign, value = (part.strip() for part in text.partition("="))
    form = "node.setting=value" if option == "--set" else "key=value"
    if not sign or not name:
        raise UsageError(f"{option} {text}: must be {form}")
    if not value:
        return name, ""
    document = read_document(value, f"{option} {name}")
    data = None if document.problems else document.data
    written = not document.problems and (value[0] + value[-1] in _WRITTEN or data is None)
    if takes_paths(name) and not (written and (data is None or not os.path.exists(value))):
        return name, value
    cut = isinstance(data, str | list) and " #" in value and not written
    if takes_text(name) and (document.problems or cut):
        return name, value
    if value.startswith("#") or (cut and isinstance(data, str)):
        comment = shown(value[value.find(" #") + 1 :])
        raise UsageError(f"{option} {text}: {comment} is a comment of YAML; put a text in quotes")
    if document.problems:
        raise UsageError(f"{option} {text}: {document.problems[0].message}")
    return name, data
