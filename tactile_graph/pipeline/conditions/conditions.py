"""Conditions of ``when``: a small whitelisted expression language over nodes and their fields."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Mapping, Sequence, Sized
from dataclasses import dataclass
from keyword import iskeyword
from typing import Any

import numpy as np

from tactile_graph.errors import one_of, shown
from tactile_graph.pipeline.conditions.comparable import fields_hint, is_scalar
from tactile_graph.pipeline.conditions.nonsense import (
    FUNCTIONS,
    any_hint,
    no_arithmetic,
    no_call,
    no_truth,
    nonsense,
)
from tactile_graph.pipeline.conditions.over_items import OVER_ITEMS, resolve_of_items, spelled_out
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import Ref, arms
from tactile_graph.steps.signature import list_item, type_name

LONGEST = 2_000
LONGEST_SPELLED, SHORTEST_SPELLED = 4_000, 50
"""Characters of all that a condition names, each counted as that many at least."""
DEEPEST = 100
MOST_TOLD = 4
"""Items of a list whose numbers a reason shows."""

SIGNS = {
    r"&&": "write 'and' for '&&'",
    r"\|\|": "write 'or' for '||'",
    r"=>": "write '>=' for '=>'",
    r"=<": "write '<=' for '=<'",
    r"<>": "write '!=' for '<>'",
    r"\bis\b": "write '==' for 'is'",
    r"(?<![<>=!])=(?![=<>])": "to compare, write '=='",
    r"!(?!=)": "write 'not' for '!'",
    r"\b(AND|OR|NOT)\b": "'and', 'or' and 'not' are written small",
    r"\?": "there is no '?'",
    r"(?<![\w.])[\d.]+[A-Za-z%°µ]": "a number stands alone, without a unit",
}
"""What people write who think of another language -> what to write instead."""

_ITS_OWN_WORDS = ("and", "or", "not", "in", "is", "if", "else", "True", "False", "None")
"""Words of Python that conditions have, or of which something else is told."""

_TEXT_OR_COMMENT = re.compile(r"""(?P<text>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')|\#[^\n]*""")

_ALLOWED = (
    ast.Expression, ast.BoolOp, ast.And, ast.Or, ast.UnaryOp, ast.Not, ast.USub, ast.UAdd,
    ast.BinOp, ast.Add, ast.Sub, ast.Mult, ast.Div, ast.FloorDiv, ast.Mod,
    ast.Compare, ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn,
    ast.Call, ast.Name, ast.Attribute, ast.Constant, ast.Load, ast.Tuple, ast.List,
)  # fmt: skip


@dataclass(frozen=True)
class Guard:
    """A compiled condition: what it reads, and the function of those values.

    ``text`` is what the file says, ``meaning`` the same with named conditions spelled out and the
    references numbered: two guards of equal meaning and references hold for the same frames.
    ``groups`` are the references to items of the same list, one for each ``any``, ``all`` or
    ``count``: the function takes them side by side, for items that have a value.
    """

    text: str
    refs: tuple[Ref, ...]
    function: Callable[..., Any]
    meaning: str
    groups: tuple[tuple[int, ...], ...] = ()

    def reason(self, values: tuple[Any, ...]) -> str:
        """Return why a node was skipped: the condition and what it read."""
        told = (f"{r.spelled} = {_short(v)}" for r, v in zip(self.refs, values, strict=True))
        read = ", ".join(dict.fromkeys(told))
        return f"when {self.text} is false" + (f" ({read})" if read else "")

    def __reduce__(self) -> tuple[Callable[..., Guard], tuple[Any, ...]]:
        """Pickle without the function, which is made again of the meaning."""
        return _made_again, (self.text, self.refs, self.meaning, self.groups)

    def settled(self, known: Mapping[Ref, str | int]) -> bool | None:
        """Return what comes out where all that is known are these values; None if that is open."""
        values = {f"v{i}": known[ref] for i, ref in enumerate(self.refs) if ref in known}
        tree = ast.parse(self.meaning, mode="eval").body
        return _settled(tree, values) if values else None


def _made_again(
    text: str, refs: tuple[Ref, ...], meaning: str, groups: tuple[tuple[int, ...], ...]
) -> Guard:
    return Guard(text, refs, _function(meaning, len(refs), groups), meaning, groups)


def _settled(node: ast.expr, values: Mapping[str, str | int]) -> bool | None:
    if isinstance(node, ast.BoolOp):
        parts = [_settled(part, values) for part in node.values]
        decides = isinstance(node.op, ast.Or)
        if decides in parts:
            return decides
        return None if None in parts else not decides
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        inner = _settled(node.operand, values)
        return None if inner is None else not inner
    names = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)} - FUNCTIONS.keys()
    if not names <= values.keys():
        return None
    code = compile(ast.Expression(node), "<condition>", "eval")
    try:
        return bool(eval(code, {"__builtins__": {}, **FUNCTIONS}, dict(values)))  # whitelisted
    except Exception:  # fails for the frame too, which says why
        return None


def without_comments(text: str) -> str:
    """Return the text with blanks in place of comments, each of which ends with its line."""
    return _TEXT_OR_COMMENT.sub(lambda m: m["text"] or " " * len(m[0]), text)


def one_line(text: str) -> str:
    """Return the text as one line: a YAML block keeps its line ends, Python minds them."""
    return without_comments(text).strip().replace("\n", " ")


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, bool | int | str | np.generic):
        return f"{value.item() if isinstance(value, np.generic) else value!r}"
    if isinstance(value, tuple) and value and all(isinstance(v, int | float) for v in value):
        more = f", … of {len(value)}" if len(value) > MOST_TOLD else ""
        return f"[{', '.join(map(_short, value[:MOST_TOLD]))}{more}]"
    return f"{len(value)} items" if isinstance(value, Sized) else f"a {type(value).__name__}"


def names_in(text: str) -> set[str]:
    """Return the names at the root of a condition's references; empty if it cannot be parsed."""
    try:
        tree = ast.parse(one_line(text), mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    called = {id(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)}
    return {n.id for n in ast.walk(tree) if isinstance(n, ast.Name) and id(n) not in called}


def compile_condition(
    text: str,
    types: Mapping[str, Any],
    named: Mapping[str, str] | None = None,
    also: Iterable[str] = (),
) -> Guard:
    """Return the guard that ``text`` spells.

    Parameters
    ----------
    text : str
        The condition.
    types : mapping
        Node name -> type of its value; also ``use`` outputs as ``node.output``.
    named : mapping, optional
        Named conditions, by name.
    also : iterable of str
        Nodes that are there too, but cannot be read yet: for what errors say.

    Raises
    ------
    ConditionError
        If it is no condition: bad syntax, something not allowed, an unknown node or field.
    """
    compiler = _Compiler(types, named or {}, also)
    try:
        tree = compiler.parse(text, ())
        if not isinstance(tree, ast.Constant) or isinstance(tree.value, str):
            words = no_truth(tree, compiler)
            if words:
                raise ConditionError(words)
        if not compiler.is_truth(tree):
            raise ConditionError(compiler.not_truth(tree))
        _check_depth(tree)
        meaning = ast.unparse(tree)
        refs, groups = tuple(compiler.refs), tuple(compiler.groups)
        function = _function(meaning, len(refs), groups)
        return Guard(" ".join(one_line(text).split()), refs, function, meaning, groups)
    except (RecursionError, MemoryError):
        raise ConditionError(f"nested deeper than {DEEPEST} levels") from None


def _check_depth(tree: ast.AST) -> None:
    level: list[ast.AST] = [tree]
    for _ in range(DEEPEST):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
    if level:
        raise ConditionError(f"nested deeper than {DEEPEST} levels")


def _function(meaning: str, n_refs: int, groups: Sequence[tuple[int, ...]]) -> Callable[..., Any]:
    arguments = [ast.arg(f"v{i}") for i in range(n_refs)]
    rows = _Reckoned().visit(spelled_out(meaning, groups))
    body = ast.Lambda(ast.arguments([], arguments, None, [], [], None, []), rows)
    code = compile(ast.fix_missing_locations(ast.Expression(body)), "<condition>", "eval")
    function: Callable[..., Any] = eval(
        code, {"__builtins__": {}, "zip": zip, "wide": _wide, **FUNCTIONS}
    )
    return function  # of a whitelisted text


class _Reckoned(ast.NodeTransformer):
    """Writes ``wide(v0)`` for each value that is reckoned with, not only compared."""

    def __init__(self) -> None:
        self._within = False

    def visit(self, node: ast.AST) -> Any:
        before = self._within
        self._within |= reckons(node)
        try:
            return super().visit(node)
        finally:
            self._within = before

    def visit_Name(self, node: ast.Name) -> ast.expr:
        its = node.id[1:].isdigit() and isinstance(node.ctx, ast.Load)
        return ast.Call(ast.Name("wide", ast.Load()), [node], []) if its and self._within else node


def reckons(node: ast.AST) -> bool:
    """Return whether a part of a condition makes another number of those that it reads."""
    if isinstance(node, ast.UnaryOp):
        return isinstance(node.op, ast.USub)
    if isinstance(node, ast.Call):
        return isinstance(node.func, ast.Name) and node.func.id == "abs"
    return isinstance(node, ast.BinOp)


def _signed(value: Any) -> Any:
    number = int(value)
    return np.int64(number) if number <= _LARGEST else number


_LARGEST = int(np.iinfo(np.int64).max)
_SMALL = (np.bool_, np.int8, np.int16, np.int32, np.intc, np.uint8, np.uint16, np.uint32, np.uintc)
_WIDER: dict[type, Callable[[Any], Any]] = {
    **dict.fromkeys(_SMALL, np.int64),
    **dict.fromkeys((np.uint64, np.ulonglong), _signed),
    np.float16: np.float64,
}


def _wide(value: Any) -> Any:
    """Return a number that does not overflow early: of NumPy's types, some end at 127.

    It stays one of NumPy's, which divide by 0.
    """
    wider = _WIDER.get(value.__class__)
    return value if wider is None else wider(value)


class _Compiler:
    def __init__(
        self, types: Mapping[str, Any], named: Mapping[str, str], also: Iterable[str]
    ) -> None:
        self.types = types
        self.also = tuple(also)
        self.named = named
        self.refs: list[Ref] = []
        self.kinds: list[Any] = []
        self.lists: list[Ref | None] = []
        """Of each reference the list it reads the items of."""
        self.groups: list[tuple[int, ...]] = []
        self.over: list[int] | None = None
        """What is read of items by the ``any``, ``all`` or ``count`` under way."""
        self.spelled = 0

    def parse(self, text: str, within: tuple[str, ...]) -> ast.expr:
        self.spelled += max(len(text), SHORTEST_SPELLED)
        if len(text) > LONGEST or self.spelled > LONGEST_SPELLED:
            # Conditions that name each other twice over double with each name.
            raise ConditionError(f"longer than {LONGEST} characters")
        text = one_line(text)
        try:
            tree = ast.parse(text, mode="eval")
        except SyntaxError as error:
            message = f"{shown(text)} is no condition: {error.msg}{_typo_hint(text)}"
            raise ConditionError(message, max(0, (error.offset or 1) - 1)) from None
        except ValueError as error:
            raise ConditionError(f"cannot be read: {error}") from None
        _check_depth(tree)
        for node in ast.walk(tree):
            if not isinstance(node, _ALLOWED):
                raise ConditionError(
                    f"{type(node).__name__.lower()} is not allowed in a condition; allowed are "
                    "and, or, not, comparisons, + - * / // %, numbers, texts, node fields, "
                    f"{', '.join(FUNCTIONS)}{_typo_hint(text)}",
                    getattr(node, "col_offset", 0),
                )
        return self.rewrite(tree.body, within)

    def rewrite(self, node: ast.expr, within: tuple[str, ...]) -> ast.expr:
        if isinstance(node, ast.Call):
            return self.call(node, within)
        chain = _chain(node)
        if chain is not None:
            return self.reference(chain, node.col_offset, within)
        if isinstance(node, ast.Attribute):
            raise ConditionError("a field can only be taken from a node", node.col_offset)
        if isinstance(node, ast.Constant) and not isinstance(node.value, int | float | str):
            raise ConditionError(f"{node.value!r} is not allowed in a condition", node.col_offset)
        for part in _truth_parts(node):
            words = no_truth(part, self)
            if words:
                raise ConditionError(words, part.col_offset)
        for field, value in ast.iter_fields(node):
            if isinstance(value, ast.expr):
                setattr(node, field, self.rewrite(value, within))
            elif isinstance(value, list):
                new = [self.rewrite(v, within) if isinstance(v, ast.expr) else v for v in value]
                setattr(node, field, new)
        for part in _truth_parts(node):
            if not self.is_truth(part):
                raise ConditionError(self.not_truth(part), getattr(node, "col_offset", 0))
        for part in _compared_parts(node):
            if isinstance(part, ast.Call) and ast.unparse(part.func) in ("any", "all"):
                name = ast.unparse(part.func)
                raise ConditionError(
                    f"{name}() is a yes or no; count() is a number", part.col_offset
                )
            if not self.is_comparable(part):
                words = self.not_comparable(part) + any_hint(node, part, self)
                raise ConditionError(words, getattr(node, "col_offset", 0))
        words = ""
        if isinstance(node, ast.Compare):
            words = nonsense(node, self)
        elif isinstance(node, ast.BinOp):
            words = no_arithmetic(node, self)
        if words:
            raise ConditionError(words, getattr(node, "col_offset", 0))
        return node

    def spell(self, node: ast.expr) -> str:
        if isinstance(node, ast.Name):
            return self.refs[int(node.id[1:])].spelled
        return ast.unparse(node)

    def call(self, node: ast.Call, within: tuple[str, ...]) -> ast.expr:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS or node.keywords:
            raise ConditionError(
                f"only {', '.join(FUNCTIONS)} can be called in a condition", node.col_offset
            )
        if name in OVER_ITEMS:
            return self.over_items(node, name, within)
        node.args = [self.rewrite(a, within) for a in node.args]
        if not node.args or (name in ("len", "abs") and len(node.args) != 1):
            raise ConditionError(f"{name}() takes one argument", node.col_offset)
        words = no_call(name, node.args, self)
        if words:
            raise ConditionError(words, node.col_offset)
        return node

    def over_items(self, node: ast.Call, name: str, within: tuple[str, ...]) -> ast.expr:
        at = node.col_offset
        if self.over is not None:
            raise ConditionError(
                f"{name}() cannot stand within another any(), all() or count()", at
            )
        if len(node.args) != 1:
            like = f"{name}(fits.radius_cm > 1)"
            raise ConditionError(f"{name}() takes one condition over items, like {like}", at)
        over: list[int] = []
        self.over = over
        node.args = [self.rewrite(node.args[0], within)]
        self.over = None
        (inner,) = node.args
        lists = sorted({str(self.lists[i]) for i in over})
        if not lists:
            raise ConditionError(
                f"{name}() is over the items of a list, and none is read in it", at
            )
        if len(lists) > 1:
            raise ConditionError(f"{name}() is over the items of one list, got {one_of(lists)}", at)
        words = no_truth(inner, self) or ("" if self.is_truth(inner) else self.not_truth(inner))
        if words:
            raise ConditionError(words, at)
        self.groups.append(tuple(over))
        return node

    def reference(self, chain: tuple[str, ...], offset: int, within: tuple[str, ...]) -> ast.expr:
        root = chain[0]
        if root in self.named and len(chain) == 1:
            if root in within:
                loop = " -> ".join((*within[within.index(root) :], root))
                raise ConditionError(f"condition {root!r} refers to itself: {loop}", offset)
            try:
                return self.parse(self.named[root], (*within, root))
            except ConditionError as error:
                raise ConditionError(error.message, offset, error.named or root) from None
        if root in ("true", "false") and root not in self.types:
            raise ConditionError(f"{root} is written {root.capitalize()} in a condition", offset)
        item = resolve_of_items(chain, self.types, offset)
        if item is not None and self.over is not None:
            return self.value(item.ref, item.kind, item.of)
        if item is not None and len(item.ref.item_path) > 0:
            what = (
                f"{item.of} is a list: fields of its items are read within any(), all() or count()"
            )
            raise ConditionError(what, offset)
        ref, kind = resolve_reference(chain, self.types, [*self.named, *self.also], offset)
        return self.value(ref, kind)

    def value(self, ref: Ref, kind: Any, of: Ref | None = None) -> ast.expr:
        """Return the name of a value that is read: of each item of a list, or as it is."""
        known = [*zip(self.refs, self.lists, strict=True)]
        index = known.index((ref, of)) if of is None and (ref, of) in known else len(known)
        if of is not None and self.over is not None:
            index = next((i for i in self.over if known[i] == (ref, of)), index)
        if index == len(known):
            self.refs.append(ref)
            self.kinds.append(kind)
            self.lists.append(of)
        if of is not None and self.over is not None and index not in self.over:
            self.over.append(index)
        return ast.Name(f"v{index}", ast.Load())

    def kind(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Name) and node.id[:1] == "v" and node.id[1:].isdigit():
            return self.kinds[int(node.id[1:])]
        return None

    def is_truth(self, node: ast.expr) -> bool:
        kind = self.kind(node)
        return kind is None or all(is_scalar(a) or list_item(a) is not None for a in arms(kind))

    def is_comparable(self, node: ast.expr) -> bool:
        kind = self.kind(node)
        return kind is None or all(is_scalar(a) for a in arms(kind))

    def not_truth(self, node: ast.expr) -> str:
        kind = self.kind(node)
        return (
            f"{self.spell(node)} is a {type_name(kind)}, "
            f"not a yes/no or a number{fields_hint(kind)}"
        )

    def not_comparable(self, node: ast.expr) -> str:
        kind = self.kind(node)
        return (
            f"{self.spell(node)} is a {type_name(kind)} and cannot be compared{fields_hint(kind)}"
        )


def _typo_hint(text: str) -> str:
    """Return what other languages' signs are here."""
    hints = [hint for sign, hint in SIGNS.items() if re.search(sign, text)]
    hints += [
        f"{word!r} is a word of Python: a condition can read nothing of that name"
        for word in re.findall(r"\w+", _TEXT_OR_COMMENT.sub("", text))
        if iskeyword(word) and word not in _ITS_OWN_WORDS
    ]
    return "".join(f"; {hint}" for hint in dict.fromkeys(hints))


def _chain(node: ast.expr) -> tuple[str, ...] | None:
    if isinstance(node, ast.Name):
        return (node.id,)
    if isinstance(node, ast.Attribute):
        inner = _chain(node.value)
        return None if inner is None else (*inner, node.attr)
    return None


def _truth_parts(node: ast.expr) -> list[ast.expr]:
    if isinstance(node, ast.BoolOp):
        return node.values
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return [node.operand]
    return []


def _compared_parts(node: ast.expr) -> list[ast.expr]:
    if isinstance(node, ast.Compare):
        return [
            node.left,
            *(c for c in node.comparators if not isinstance(c, ast.Tuple | ast.List)),
        ]
    if isinstance(node, ast.BinOp):
        return [node.left, node.right]
    return []
