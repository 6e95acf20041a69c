"""Conditions of ``when``: a small whitelisted expression language over nodes and their fields."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Mapping, Sequence, Sized
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal, get_args, get_origin

import numpy as np

from tactile_graph.errors import did_you_mean, shown
from tactile_graph.pipeline.comparable import fields_hint, is_scalar, sort_of
from tactile_graph.pipeline.references import ConditionError, resolve_reference
from tactile_graph.pipeline.wiring import Ref, arms
from tactile_graph.steps.signature import list_item, type_name

FUNCTIONS: dict[str, Callable[..., Any]] = {"abs": abs, "len": len, "max": max, "min": min}
LONGEST = 2_000
LONGEST_SPELLED = 4_000
DEEPEST = 100

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
    """

    text: str
    refs: tuple[Ref, ...]
    function: Callable[..., Any]
    meaning: str

    def reason(self, values: tuple[Any, ...]) -> str:
        """Return why a node was skipped: the condition and what it read."""
        read = ", ".join(
            f"{ref} = {v:.6g}" if isinstance(v, float) else f"{ref} = {_short(v)}"
            for ref, v in zip(self.refs, values, strict=True)
        )
        return f"when {self.text} is false" + (f" ({read})" if read else "")


def _one_line(text: str) -> str:
    """Return the text as one line: a YAML block keeps its line ends, Python minds them."""
    return text.strip().replace("\n", " ")


def _short(value: Any) -> str:
    if isinstance(value, bool | int | str | np.generic):
        return f"{value.item() if isinstance(value, np.generic) else value!r}"
    return f"{len(value)} items" if isinstance(value, Sized) else f"a {type(value).__name__}"


def names_in(text: str) -> set[str]:
    """Return the names at the root of a condition's references; empty if it cannot be parsed."""
    try:
        tree = ast.parse(_one_line(text), mode="eval")
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
        if not compiler.is_truth(tree):
            raise ConditionError(compiler.not_truth(tree))
        _check_depth(tree)
        meaning = ast.unparse(tree)
        function = _function(compiler, tree)
        return Guard(" ".join(text.split()), tuple(compiler.refs), function, meaning)
    except (RecursionError, MemoryError):
        raise ConditionError(f"nested deeper than {DEEPEST} levels") from None


def _check_depth(tree: ast.AST) -> None:
    level: list[ast.AST] = [tree]
    for _ in range(DEEPEST):
        level = [child for node in level for child in ast.iter_child_nodes(node)]
    if level:
        raise ConditionError(f"nested deeper than {DEEPEST} levels")


def _function(
    compiler: _Compiler, tree: ast.expr, refs: Sequence[Ref] | None = None
) -> Callable[..., Any]:
    refs = compiler.refs if refs is None else refs
    arguments = [ast.arg(f"v{i}") for i in range(len(refs))]
    body = ast.Lambda(ast.arguments([], arguments, None, [], [], None, []), tree)
    code = compile(ast.fix_missing_locations(ast.Expression(body)), "<condition>", "eval")
    function: Callable[..., Any] = eval(code, {"__builtins__": {}, **FUNCTIONS})  # whitelisted
    return function


class _Compiler:
    def __init__(
        self, types: Mapping[str, Any], named: Mapping[str, str], also: Iterable[str]
    ) -> None:
        self.types = types
        self.also = tuple(also)
        self.named = named
        self.refs: list[Ref] = []
        self.kinds: list[Any] = []
        self.spelled = 0

    def parse(self, text: str, within: tuple[str, ...]) -> ast.expr:
        self.spelled += len(text)
        if len(text) > LONGEST or self.spelled > LONGEST_SPELLED:
            # Conditions that name each other twice over double with each name.
            raise ConditionError(f"longer than {LONGEST} characters")
        try:
            tree = ast.parse(_one_line(text), mode="eval")
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
                    f"{', '.join(FUNCTIONS)}",
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
            if not self.is_comparable(part):
                raise ConditionError(self.not_comparable(part), getattr(node, "col_offset", 0))
        if isinstance(node, ast.BinOp):
            self.refuse_arithmetic(node)
        if isinstance(node, ast.Compare):
            self.refuse_mixed(node)
            self.refuse_settled(node)
            self.refuse_impossible(node)
        return node

    def refuse_arithmetic(self, node: ast.BinOp) -> None:
        """Refuse texts and lists: a few signs of these can ask for all memory there is."""
        for side in (node.left, node.right):
            if isinstance(side, ast.Tuple | ast.List):
                raise ConditionError("arithmetic takes numbers, not a list", side.col_offset)
            if self.sort(side) == "text":
                text = f"arithmetic takes numbers, and {self.spell(side)} is a text"
                raise ConditionError(text, getattr(node, "col_offset", 0))

    def refuse_settled(self, node: ast.Compare) -> None:
        """Refuse a comparison that reads no node: it comes out the same in every frame."""
        if any(isinstance(part, ast.Name) for part in ast.walk(node)):
            return
        try:
            always = bool(_function(self, node, ())())
        except Exception as error:  # 1 / 0 > 2
            always_words = f"cannot be told ({error})"
        else:
            always_words = f"is always {str(always).lower()}"
        text = f"{ast.unparse(node)} reads no node: it {always_words}"
        raise ConditionError(text, getattr(node, "col_offset", 0))

    def refuse_impossible(self, node: ast.Compare) -> None:
        """Refuse to look for a text that a field never holds: one of a few is all it can be."""
        sides = [node.left, *node.comparators]
        for (left, right), operator in zip(pairwise(sides), node.ops, strict=True):
            if not isinstance(operator, ast.Eq | ast.NotEq | ast.In | ast.NotIn):
                continue
            for field, other in ((left, right), (right, left)):
                allowed = _literals(self.kind(field))
                for given in _constants(other) if allowed else []:
                    if given not in allowed:
                        known = ", ".join(repr(a) for a in allowed)
                        hint = did_you_mean(str(given), [str(a) for a in allowed])
                        text = f"{self.spell(field)} is never {given!r}; it is one of {known}{hint}"
                        raise ConditionError(text, getattr(node, "col_offset", 0))

    def refuse_mixed(self, node: ast.Compare) -> None:
        """Refuse to compare a number with a text: it fails, or never holds, in every frame."""
        sides = [node.left, *node.comparators]
        for left, right in pairwise(sides):
            sorts = self.sort(left), self.sort(right)
            if None not in sorts and sorts[0] != sorts[1]:
                words = " and ".join(
                    f"{self.spell(side)} is a {sort}"
                    for side, sort in zip((left, right), sorts, strict=True)
                )
                text = f"{words}: they cannot be compared"
                raise ConditionError(text, getattr(node, "col_offset", 0))

    def sort(self, node: ast.expr) -> str | None:
        """Return ``number`` or ``text``, None where nobody knows."""
        if isinstance(node, ast.Constant):
            return "text" if isinstance(node.value, str) else "number"
        found = {sort_of(arm) for arm in arms(self.kind(node))}
        return found.pop() if len(found) == 1 else None

    def spell(self, node: ast.expr) -> str:
        if isinstance(node, ast.Name):
            return str(self.refs[int(node.id[1:])])
        return ast.unparse(node)

    def call(self, node: ast.Call, within: tuple[str, ...]) -> ast.expr:
        name = node.func.id if isinstance(node.func, ast.Name) else ""
        if name not in FUNCTIONS or node.keywords:
            raise ConditionError(
                f"only {', '.join(FUNCTIONS)} can be called in a condition", node.col_offset
            )
        node.args = [self.rewrite(a, within) for a in node.args]
        if not node.args or (name in ("len", "abs") and len(node.args) != 1):
            raise ConditionError(f"{name}() takes one argument", node.col_offset)
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
        ref, kind = resolve_reference(chain, self.types, [*self.named, *self.also], offset)
        if ref not in self.refs:
            self.refs.append(ref)
            self.kinds.append(kind)
        return ast.Name(f"v{self.refs.index(ref)}", ast.Load())

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
            f"{self.refs[int(node.id[1:])]} is a {type_name(kind)}, "  # type: ignore[attr-defined]
            f"not a yes/no or a number{fields_hint(kind)}"
        )

    def not_comparable(self, node: ast.expr) -> str:
        kind = self.kind(node)
        return (
            f"{self.refs[int(node.id[1:])]} is a {type_name(kind)} "  # type: ignore[attr-defined]
            f"and cannot be compared{fields_hint(kind)}"
        )


def _typo_hint(text: str) -> str:
    """Return what other languages' signs are here."""
    signs = {r"&&": "write 'and' for '&&'", r"\|\|": "write 'or' for '||'",
             r"(?<![<>=!])=(?!=)": "to compare, write '=='",
             r"!(?!=)": "write 'not' for '!'", r"\?": "there is no '?'"}  # fmt: skip
    return "".join(f"; {hint}" for sign, hint in signs.items() if re.search(sign, text))


def _literals(kind: Any) -> tuple[Any, ...]:
    """Return all that a value can be; nothing where it is not one of a few texts or numbers."""
    found = arms(kind) if kind is not None else ()
    if not found or not all(get_origin(arm) is Literal for arm in found):
        return ()
    return tuple(value for arm in found for value in get_args(arm))


def _constants(node: ast.expr) -> list[Any]:
    """Return the constants a field is compared with: one, or those of a list."""
    parts = node.elts if isinstance(node, ast.Tuple | ast.List) else [node]
    return [part.value for part in parts if isinstance(part, ast.Constant)]


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
