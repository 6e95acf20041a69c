"""What a step or command says of itself, read from its source text without importing it."""

from __future__ import annotations

import ast
import importlib.util
import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from types import CodeType, FunctionType
from typing import Any

_Function = ast.FunctionDef | ast.AsyncFunctionDef


@dataclass(frozen=True)
class Outline:
    """A step in short.

    ``ports`` holds (name, type as written) of each; ``output`` the type as written, with its
    fields where they stand in the same file; ``trouble`` why nothing could be read.
    """

    summary: str = ""
    kind: str = "function"
    ports: tuple[tuple[str, str], ...] = ()
    output: str = ""
    fields: tuple[str, ...] = ()
    trouble: str = ""

    @property
    def wiring(self) -> str:
        """Ports and output in one line, as lists show them."""
        if self.trouble:
            return ""
        given = "frames" if self.kind == "source" else self.output or "?"
        taken = ", ".join(kind if name == kind.lower() else f"{name}: {kind}"
                          for name, kind in self.ports)  # fmt: skip
        return f"{taken} → {given}" if taken else f"→ {given}"


def outline(target: Any) -> Outline:
    """Return the outline of a step given by import string or as the thing itself."""
    try:
        tree, node = _found(target)
    except _NotReadable as error:
        return Outline(trouble=str(error))
    summary = first_sentence(ast.get_docstring(node) or "")
    call = _call_of(node)
    if call is None:
        return Outline(summary, trouble="it is no function and has no __call__")
    kind = "class" if isinstance(node, ast.ClassDef) else "function"
    if kind == "function" and any(isinstance(n, ast.Yield | ast.YieldFrom) for n in _own(call)):
        kind = "source"
    ports = tuple((a.arg, _type(a.annotation)) for a in _positional(call))
    output = _type(call.returns)
    return Outline(summary, kind, ports, output, _fields(tree, output))


def summary_of(target: Any) -> str:
    """Return the first sentence of a command's or step's docstring; empty if it cannot be read."""
    compiled = _compiled_doc(target) if isinstance(target, str) else ""
    if compiled:
        return first_sentence(compiled)
    try:
        return first_sentence(ast.get_docstring(_found(target)[1]) or "")
    except _NotReadable:
        return ""


def _compiled_doc(target: str) -> str:
    """Return the docstring of a function from the compiled code its module is imported from.

    That is a tenth of the work of parsing its source, which matters to ``--help``; the code is
    not run. Empty where that tells nothing.
    """
    module, _, name = target.partition(":")
    try:
        spec = importlib.util.find_spec(module)
        code = spec.loader.get_code(module)  # type: ignore[union-attr]
    except Exception:  # a parent package is imported here, and may raise anything
        return ""
    found = [c for c in code.co_consts if isinstance(c, CodeType) and c.co_name == name]
    if len(found) != 1 or not found[0].co_flags & inspect.CO_OPTIMIZED:  # none, several, a class
        return ""
    doc = FunctionType(found[0], {}).__doc__
    return inspect.cleandoc(doc) if doc else ""


def first_sentence(doc: str) -> str:
    """Return the first sentence of a docstring."""
    paragraph = " ".join(doc.partition("\n\n")[0].split())
    return re.split(r"(?<=[.!?])\s+(?=[A-Z`])", paragraph, maxsplit=1)[0]


class _NotReadable(Exception):  # noqa: N818 -- never leaves this module
    pass


def _found(target: Any) -> tuple[ast.Module, _Function | ast.ClassDef]:
    if not isinstance(target, str):
        return _from_object(target)
    module, _, name = target.partition(":")
    if not module or not name:
        raise _NotReadable(f"{target!r} is no import string 'module:name'")
    for _ in range(5):  # a name may be handed on from module to module
        tree = _tree(module)
        for node in _statements(tree):
            if isinstance(node, _Function | ast.ClassDef) and node.name == name:
                return tree, node
        module, name = _imported_from(tree, module, name)
    raise _NotReadable(f"{target} is handed on too often")


def _statements(tree: ast.Module) -> Iterator[ast.stmt]:
    """Yield the statements a module runs when it is imported, those under if and try too."""
    waiting = list(reversed(tree.body))
    while waiting:
        node = waiting.pop()
        yield node
        if isinstance(node, ast.If | ast.Try | ast.With):
            inner = [n for n in ast.iter_child_nodes(node) if isinstance(n, ast.stmt)]
            handled = [n for h in getattr(node, "handlers", ()) for n in h.body]
            waiting += reversed(inner + handled)


def _from_object(target: Any) -> tuple[ast.Module, _Function | ast.ClassDef]:
    target = getattr(target, "callback", None) or target  # what a click command runs
    try:
        tree = ast.parse(inspect.cleandoc("\n" + inspect.getsource(target)))
    except (OSError, TypeError, SyntaxError) as error:
        raise _NotReadable(f"its source cannot be read: {error}") from None
    node = tree.body[0]
    if not isinstance(node, _Function | ast.ClassDef):
        raise _NotReadable("it is no function or class")
    return tree, node


@cache
def _tree(module: str) -> ast.Module:
    try:
        spec = importlib.util.find_spec(module)
    except Exception as error:  # a parent package is imported here, and may raise anything
        raise _NotReadable(f"cannot import {module}: {error}") from None
    get_source = getattr(spec.loader, "get_source", None) if spec is not None else None
    if get_source is None:
        raise _NotReadable(f"there is no module {module}")
    try:
        return ast.parse(get_source(module) or "", str(spec.origin if spec else module))
    except (SyntaxError, ImportError, OSError) as error:
        raise _NotReadable(f"cannot read {module}: {error}") from None


def _imported_from(tree: ast.Module, module: str, name: str) -> tuple[str, str]:
    others = False
    for node in _statements(tree):
        for alias in node.names if isinstance(node, ast.ImportFrom) else ():
            if (alias.asname or alias.name) == name and isinstance(node, ast.ImportFrom):
                base = module.rsplit(".", node.level)[0] + "." if node.level else ""
                return f"{base}{node.module or ''}".rstrip("."), alias.name
            others = others or alias.name == "*"
        if name in _assigned(node):
            raise _NotReadable(f"{module} makes {name!r} when it is imported; nothing to read here")
    if others:
        raise _NotReadable(f"{module} defines no {name!r}; an 'import *' may bring it")
    raise _NotReadable(f"{module} has no {name!r}")


def _assigned(node: ast.stmt) -> list[str]:
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return [t.id for t in targets if isinstance(t, ast.Name)]


def _call_of(node: _Function | ast.ClassDef) -> _Function | None:
    if not isinstance(node, ast.ClassDef):
        return node
    calls = [n for n in node.body if isinstance(n, _Function) and n.name == "__call__"]
    return calls[0] if calls else None


def _own(function: _Function) -> Iterator[ast.AST]:
    """Yield what stands in a function, but not in functions within it."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, _Function | ast.Lambda | ast.ClassDef):
            waiting += ast.iter_child_nodes(node)


def _positional(call: _Function) -> list[ast.arg]:
    arguments = [*call.args.posonlyargs, *call.args.args]
    return [a for a in arguments if a.arg not in ("self", "cls")]


def _type(node: ast.expr | None) -> str:
    """Return an annotation as written, without ``Annotated`` and what stands beside the type."""
    if node is None:
        return ""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    return ast.unparse(_Bare().visit(ast.parse(ast.unparse(node), mode="eval"))).strip()


class _Bare(ast.NodeTransformer):
    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        """Replace ``Annotated[X, …]`` by X."""
        name = ast.unparse(node.value).rpartition(".")[2]
        if name == "Annotated" and isinstance(node.slice, ast.Tuple):
            return self.visit(node.slice.elts[0])  # type: ignore[no-any-return]
        return self.generic_visit(node)


def _fields(tree: ast.Module, output: str) -> tuple[str, ...]:
    for node in tree.body:
        if isinstance(node, ast.ClassDef) and node.name == output:
            if "NamedTuple" not in {ast.unparse(b).rpartition(".")[2] for b in node.bases}:
                return ()
            targets = [n.target for n in node.body if isinstance(n, ast.AnnAssign)]
            return tuple(t.id for t in targets if isinstance(t, ast.Name))
    return ()
