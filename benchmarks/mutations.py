"""What the tests notice: small changes to the code, one at a time, that should fail a test.

    python benchmarks/mutations.py thesis mrf filters fitters --mutants 60 -o found.json
    python benchmarks/mutations.py --again found.json -o found.json     # survivors once more
    python benchmarks/mutations.py --again found.json --compiled ...    # by machine code
    python benchmarks/mutations.py --table found.json ...               # for docs/mutations.md

A mutant is a module with one comparison, operator, number, flag, condition or returned value
changed, or a shipped pipeline with one setting changed. It is never written into the tree: a
process of its own imports the changed code, and runs first the family's tests of files that name
the module, then all others that call into it, those marked slow among them. Kernels are answered
by their plain loops, so that no machine code of yesterday answers for them; those of families
that call a mutant's (``BY_MACHINE_CODE``) are not changed, and are compiled. ``--compiled`` lets
tests that are too slow for that judge the survivors, each with a copy of the machine code on disk.
A sample is drawn from all places in a family with a seed; the interval is Wilson's, at 95 %.

A number of at most a millionth is a bound on rounding, and taken a million times as large, since
half as much again tells nothing (below `NEVER_REACHED` it only keeps from dividing by nothing, and
is left out); one in the shape of ``np.empty``, which is mere room, one smaller.

Left out: annotations, texts, what only draws, prints or writes, flags that only refuse what no
right code does (``strict`` of a zip, ``frozen``), the 1 of ``reshape(-1)`` (any negative number
asks for the rest), and tests that take more processor time than
``SLOW_S`` each by plain loops, ``COMPILED_SLOW_S`` by machine code (their number is told).
"""

from __future__ import annotations

import argparse
import ast
import copy
import importlib.util
import json
import math
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.machinery import ModuleSpec, SourceFileLoader
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import yaml

ROOT = Path(__file__).resolve().parents[1]
FAMILIES = ("thesis", "mrf", "filters", "fitters")
PRESENTING = ("drawing", "book", "commands", "__init__.py")
"""Rooms and files that only present; what draws within others goes by `DRAWS`."""
DRAWS = re.compile(r"\baxes\b|\bfigure\b|\bpanels\(|_FIGURE\b")
GUARDS = ("strict", "frozen")
"""Flags that refuse what no right code does: lists of two lengths in a zip, a changed record."""
THESIS_WAYS = ("circle-1", "circle-2", "circle-3", "rectangle-1", "rectangle-2", "identify")
ROUNDING, BEYOND_ROUNDING = 1e-6, 1e6
"""The largest bound on rounding, and what is none any more, in such bounds."""
NEVER_REACHED = 1e-100
"""Numbers below it only keep a division or a logarithm from 0."""
UNWARNED = ("-W", "ignore::pytest.PytestAssertRewriteWarning")
"""Of modules imported before the tests, once for all mutants."""
BY_MACHINE_CODE = ("thesis", "pipelines")
"""Families without kernels of their own."""
SLOW_S, COMPILED_SLOW_S = 1.0, 3.0
"""Of a test, in plain loops and by machine code."""
MUTANT_S = 20
"""Processor time after which a test of a mutant is stopped, which is a failure."""
LEAST_TIMEOUT_S = 120.0
COMPILED_S = 600.0
EVERY = ("test_defaults", "test_constants")
"""Tests of what every module is imported with; they name none."""
POLL_S = 0.05
NO_SUCH_TEST = 4
"""Exit code of pytest."""
TESTS_AT_ONCE_S = 5.0
"""Of tests that take about as long together, one process after the other runs as many."""
PLAIN = "TACTILE_GRAPH_KERNELS"
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitAnd,
}


@dataclass(frozen=True)
class Mutant:
    """One change.

    Parameters
    ----------
    family, path : str
        The file from the tree's root.
    line : int
    kind : str
        ``comparison``, ``operator``, ``number``, ``flag``, ``condition``, ``returned``,
        ``default`` or ``setting``.
    before, after : str
        The changed expression, or the line of YAML.
    place : int
        Which of the file's changes it is.
    """

    family: str
    path: str
    line: int
    kind: str
    before: str
    after: str
    place: int

    @property
    def module(self) -> str:
        """The name it is imported by."""
        parts = Path(self.path).with_suffix("").parts
        return ".".join(parts[1:])


# -- changes of Python -------------------------------------------------------------------------


class Change(NamedTuple):
    """One change of a module.

    Attributes
    ----------
    line : int
    kind, before, after : str
    at : int
        Which node of the module's walk is replaced.
    node : ast.AST
        By what.
    """

    line: int
    kind: str
    before: str
    after: str
    at: int
    node: ast.AST


def changes(tree: ast.Module) -> Iterator[Change]:
    """Yield every change of a module.

    Parameters
    ----------
    tree : ast.Module
        Is left as it is.
    """
    defaults, out, room = _defaults(tree), _left_out(tree), _room(tree)
    for k, node in enumerate(ast.walk(tree)):
        if id(node) in out:
            continue
        for kind, other in _smaller(node) if id(node) in room else _changed(node):
            shown = "default" if id(node) in defaults else kind
            line: int = node.lineno  # type: ignore[attr-defined]
            yield Change(line, shown, _words(node), _words(other), k, other)


def _words(node: ast.AST) -> str:
    """Return an expression as text; of a statement with a body its head only."""
    return ast.unparse(node).partition("\n")[0]


def changed_module(tree: ast.Module, change: Change) -> ast.Module:
    """Return the module with one node replaced.

    Parameters
    ----------
    tree : ast.Module
        Is changed.
    change : Change
    """
    old = next(node for i, node in enumerate(ast.walk(tree)) if i == change.at)
    for parent in list(ast.walk(tree)):
        for name, value in ast.iter_fields(parent):
            if value is old:
                setattr(parent, name, change.node)
            elif isinstance(value, list):
                value[:] = [change.node if one is old else one for one in value]
    return ast.fix_missing_locations(tree)


def _changed(node: ast.AST) -> Iterator[tuple[str, Any]]:
    """Yield the kind and the changed node of every change of one node."""
    if isinstance(node, ast.Compare):
        for k, op in enumerate(node.ops):
            for other in COMPARISONS[type(op)]:
                yield "comparison", _but(node, ops=[*node.ops[:k], other(), *node.ops[k + 1 :]])
    elif isinstance(node, (ast.BinOp, ast.AugAssign)) and type(node.op) in OPERATORS:
        yield "operator", _but(node, op=OPERATORS[type(node.op)]())
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
        yield "operator" if isinstance(node.op, ast.USub) else "condition", node.operand
    elif isinstance(node, ast.BoolOp):
        other_op = ast.Or() if isinstance(node.op, ast.And) else ast.And()
        yield "condition", _but(node, op=other_op)
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float, bool):
        if type(node.value) is float and 0.0 < abs(node.value) < NEVER_REACHED:
            return
        kind = "flag" if type(node.value) is bool else "number"
        yield kind, _but(node, value=_other(node.value))
    elif isinstance(node, (ast.If, ast.IfExp, ast.While)):
        yield "condition", _but(node, test=ast.UnaryOp(ast.Not(), node.test))
    elif isinstance(node, ast.Return) and node.value is not None and not _is_none(node.value):
        yield "returned", _but(node, value=ast.Constant(None))


def _smaller(node: ast.AST) -> Iterator[tuple[str, Any]]:
    """Yield a number less 1."""
    assert isinstance(node, ast.Constant)
    assert isinstance(node.value, int)
    yield "number", _but(node, value=node.value - 1)


def _but(node: ast.AST, **fields: Any) -> ast.AST:
    """Return a node with other fields, below it the same nodes."""
    twin = copy.copy(node)
    for name, value in fields.items():
        setattr(twin, name, value)
    return twin


def _is_none(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _other(value: Any) -> Any:
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    if 0.0 < abs(value) <= ROUNDING:
        return BEYOND_ROUNDING * value
    return 1.5 * value if value and math.isfinite(value) else 1.0


def _defaults(tree: ast.Module) -> set[int]:
    """Return what stands in the defaults of functions."""
    found = [
        default
        for node in ast.walk(tree)
        if isinstance(node, ast.arguments)
        for default in (*node.defaults, *node.kw_defaults)
        if default is not None
    ]
    return {id(n) for default in found for n in ast.walk(default)}


def _room(tree: ast.Module) -> set[int]:
    """Return the whole numbers that stand in the shape of ``np.empty``."""
    shapes = [
        node.args[0]
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and ast.unparse(node.func) == "np.empty"
    ]
    found = [
        n for shape in shapes for n in (shape.elts if isinstance(shape, ast.Tuple) else [shape])
    ]
    return {id(n) for n in found if isinstance(n, ast.Constant)}


def _left_out(tree: ast.Module) -> set[int]:
    """Return the nodes of annotations, texts, mere guards, and functions that draw."""
    roots: list[ast.AST] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.keyword) and node.arg in GUARDS:
            roots.append(node)
        roots += [v for n in ("annotation", "returns") if (v := getattr(node, n, None))]
        if isinstance(node, (ast.JoinedStr, ast.Subscript)) and _only_words(node):
            roots.append(node)
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith(".reshape"):
            roots += [a.operand for a in node.args if isinstance(a, ast.UnaryOp)]
        if isinstance(node, ast.FunctionDef) and DRAWS.search(ast.unparse(node)):
            roots.append(node)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            roots.append(node)
    return {id(n) for root in roots for n in ast.walk(root)}


def _only_words(node: ast.AST) -> bool:
    """Return whether a node is a text, or the type of something."""
    return isinstance(node, ast.JoinedStr) or ast.unparse(node).startswith(("NDArray[", "tuple["))


# -- changes of pipelines ----------------------------------------------------------------------

NUMBER = re.compile(r"(?<=: )-?\d+(?:\.\d+)?(?=[,}\s]|$)")
FLAG = re.compile(r"(?<=: )(?:true|false)\b")


def setting_changes(text: str) -> Iterator[tuple[int, str, str, str]]:
    """Yield line, before, after and the changed text, for every setting that is a number or flag.

    Parameters
    ----------
    text : str
        Of a pipeline; its source, which the command line replaces, is left as it is.
    """
    lines = text.splitlines(keepends=True)
    at = next((k for k, line in enumerate(lines) if line.startswith("nodes:")), len(lines))
    for k in range(at, len(lines)):
        for match in (*NUMBER.finditer(lines[k]), *FLAG.finditer(lines[k])):
            after = str(_other(json.loads(match[0]))).lower()
            line = lines[k][: match.start()] + after + lines[k][match.end() :]
            changed = "".join([*lines[:k], line, *lines[k + 1 :]])
            yield k + 1, lines[k].strip(), line.strip(), changed


# -- every place of a family -------------------------------------------------------------------


def python_files(family: str) -> list[Path]:
    """Return the modules of a family that compute something.

    Parameters
    ----------
    family : str
    """
    home = ROOT / "plugins" / f"tactile_graph_{family}"
    return [
        path
        for path in sorted(home.rglob("*.py"))
        if not set(PRESENTING) & set(path.relative_to(home).parts)
    ]


def pipeline_files() -> list[Path]:
    """Return the pipelines of the thesis' ways."""
    ours = ROOT / "pipelines" / "tactile_graph_pipelines"
    return [
        *sorted((ROOT / "plugins/tactile_graph_thesis/pipelines").glob("*.yaml")),
        *(ours / f"{name}.yaml" for name in THESIS_WAYS),
    ]


def mutants_of(family: str) -> list[Mutant]:
    """Return every change of a family; ``pipelines`` are the settings of the thesis' ways.

    Parameters
    ----------
    family : str
    """
    found = []
    for path in pipeline_files() if family == "pipelines" else python_files(family):
        name, text = str(path.relative_to(ROOT)), path.read_text(encoding="utf-8")
        if family == "pipelines":
            told = [(at, "setting", a, b) for at, a, b, _ in setting_changes(text)]
        else:
            told = [one[:4] for one in changes(ast.parse(text))]
        found += [Mutant(family, name, *one, place) for place, one in enumerate(told)]
    return found


# -- one mutant against the tests --------------------------------------------------------------


class Changed(SourceFileLoader):
    """Loads one module changed, in place of what is on disk."""

    def __init__(self, name: str, path: str, code: CodeType) -> None:
        super().__init__(name, path)
        self._code = code

    def get_code(self, fullname: str) -> CodeType:
        """Return the changed code."""
        return self._code


class Finder:
    """Finds the changed module before anything else does."""

    def __init__(self, name: str, path: str, code: CodeType) -> None:
        self._name, self._path, self._code = name, path, code

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        """Return the changed module's spec, None for any other."""
        if name != self._name:
            return None
        loader = Changed(name, self._path, self._code)
        return importlib.util.spec_from_file_location(name, self._path, loader=loader)


def install(mutant: Mutant) -> None:
    """Make this process use the changed code or pipeline.

    Parameters
    ----------
    mutant : Mutant
    """
    path = ROOT / mutant.path
    text = path.read_text(encoding="utf-8")
    if mutant.kind == "setting":
        _read_instead(path, list(setting_changes(text))[mutant.place][3])
        return
    tree = ast.parse(text)
    changed = changed_module(tree, list(changes(tree))[mutant.place])
    code = compile(changed, str(path), "exec", dont_inherit=True)
    sys.meta_path.insert(0, Finder(mutant.module, str(path), code))  # type: ignore[arg-type]


def _read_instead(path: Path, text: str) -> None:
    """Let this process read a file as if it held another text."""
    as_text, as_bytes = Path.read_text, Path.read_bytes

    def read_text(self: Path, *args: Any, **kwargs: Any) -> str:
        return text if self.resolve() == path else as_text(self, *args, **kwargs)

    def read_bytes(self: Path) -> bytes:
        return text.encode() if self.resolve() == path else as_bytes(self)

    Path.read_text, Path.read_bytes = read_text, read_bytes  # type: ignore[method-assign,assignment]


class Watch:
    """Notes each test's processor time, what it calls and whether it fails, and stops endless ones.

    Parameters
    ----------
    limit_s : float
        Of a test's processor time: what else the machine does is not counted.
    family : str, optional
        Whose files are noted where a test calls into them.
    """

    def __init__(self, limit_s: float, family: str = "") -> None:
        self.seconds: dict[str, float] = {}
        self.failed: list[str] = []
        self.called: dict[str, list[str]] = {}
        self._limit_s, self._start = limit_s, 0.0
        self._home = str(ROOT / "plugins" / f"tactile_graph_{family}") if family else ""
        self._codes: set[CodeType] = set()
        signal.signal(signal.SIGPROF, self._over)

    @staticmethod
    def _over(*_: object) -> None:
        raise TimeoutError("takes too long")

    def _note(self, frame: FrameType, _: str, __: Any) -> None:
        self._codes.add(frame.f_code)

    def pytest_runtest_setup(self) -> None:
        """Begin to count a test's time and to note what it calls."""
        self._start = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, self._limit_s)
        if self._home:
            self._codes.clear()
            threading.settrace(self._note)
            sys.settrace(self._note)

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Keep a test's name if it fails, and at its end its time and the files it called into."""
        if report.failed:
            self.failed.append(report.nodeid)
        if report.when != "teardown":
            return
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        sys.settrace(None)
        self.seconds[report.nodeid] = time.process_time() - self._start
        files = {code.co_filename for code in self._codes}
        self.called[report.nodeid] = (
            sorted(
                str(Path(name).relative_to(ROOT)) for name in files if name.startswith(self._home)
            )
            if self._home
            else []
        )


def in_a_child(
    tests: list[str],
    mutant: Mutant | None,
    limit_s: float,
    stop: bool,
    loops: bool = False,
    cache: str = "",
    noted: str = "",
) -> dict[str, Any]:
    """Run tests in a process of its own; return exit code, times and failures.

    Parameters
    ----------
    tests : list of str
        Files and names of tests.
    mutant : Mutant, optional
        What is changed there.
    limit_s : float
        Then it is stopped, which tells an endless loop.
    stop : bool
        Whether the first failure ends it.
    loops : bool
        Whether kernels with a reference answer by their loops.
    cache : str
        Folder of machine code; kernels are compiled, and all in plain loops if not given.
    noted : str
        Family whose files are noted where a test calls into them.
    """
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        pid = os.fork()
        if pid == 0:
            os.environ |= {"NUMBA_CACHE_DIR": cache} if cache else {PLAIN: "plain"}
            if loops:
                _loops_answer()
            _child(tests, mutant, stop, answer, noted)
        for _ in range(math.ceil(limit_s / POLL_S)):  # no clock: it goes on while all is stopped
            if os.waitpid(pid, os.WNOHANG)[0]:
                return json.loads(answer.read_text()) if answer.exists() else {"code": -1}
            time.sleep(POLL_S)
        os.killpg(pid, signal.SIGKILL)
        os.waitpid(pid, 0)
        return {"code": -9}


def _child(tests: list[str], mutant: Mutant | None, stop: bool, answer: Path, noted: str) -> None:
    """Run the tests and write what came of it; never returns."""
    import pytest

    os.setpgid(0, 0)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    limit_s = slow_s(noted) if mutant is None else MUTANT_S
    compiles = PLAIN not in os.environ and mutant and mutant.family not in BY_MACHINE_CODE
    watch = Watch(COMPILED_S if compiles else limit_s, noted)
    told = ["-n0", "-p", "no:cacheprovider", "-m", "", "--no-header", "--tb=no", *UNWARNED]
    try:
        if mutant is not None:
            install(mutant)
        code = int(pytest.main([*told, *(["-x"] if stop else []), *tests], plugins=[watch]))
    except BaseException:
        code = 1
    found = {name: getattr(watch, name) for name in ("seconds", "failed", "called")}
    answer.write_text(json.dumps({"code": code, **found}))
    os._exit(0)


def _loops_answer() -> None:
    """Let every kernel of this process run its loops, also where a reference stands beside them."""
    from tactile_graph.compiled.kernel import Kernel

    beside = Kernel.plain

    def plain(self: Any, *args: Any) -> Any:
        reference, self.reference = self.reference, self.loops
        try:
            return beside(self, *args)
        finally:
            self.reference = reference

    Kernel.plain = plain  # type: ignore[method-assign]


# -- what tests there are ----------------------------------------------------------------------


def homes(family: str) -> list[Path]:
    """Return the folders of a family's tests.

    Parameters
    ----------
    family : str
    """
    tests = ROOT / "tests"
    if family == "pipelines":
        return [tests / "tactile_graph_thesis/pipelines", tests / "tactile_graph_pipelines"]
    return [tests / f"tactile_graph_{family}"]


class Tests(NamedTuple):
    """What is known of a family's tests that pass and are quick.

    Attributes
    ----------
    seconds : dict
        Name -> processor time.
    called : dict
        Name -> the family's files that it calls into.
    """

    seconds: dict[str, float]
    called: dict[str, list[str]]


def quick_tests(family: str, kept: Path) -> Tests:
    """Return the tests that pass and are quick.

    Parameters
    ----------
    family : str
    kept : Path
        Where they are kept for the next time.
    """
    if kept.exists():
        return Tests(**json.loads(kept.read_text()))
    files = sorted(p for home in homes(family) for p in home.rglob("test_*.py"))
    tests = Tests({}, {})
    left = 0
    for path in files:
        found = in_a_child(
            [str(path)], None, 900.0, False, cache=machine_code(family), noted=family
        )
        took = found.get("seconds", {})
        good = {n: s for n, s in took.items() if n not in found["failed"] and s <= slow_s(family)}
        left += len(took) - len(good)
        tests.seconds.update(good)
        tests.called.update({n: found["called"][n] for n in good})
    took_s = sum(tests.seconds.values())
    print(
        f"{family}: {len(tests.seconds)} quick tests, {took_s:.0f} s; {left} left out", flush=True
    )
    kept.write_text(json.dumps(tests._asdict()))
    return tests


def slow_s(family: str) -> float:
    """Return the processor time from which a family's tests are left out.

    Parameters
    ----------
    family : str
    """
    return COMPILED_SLOW_S if family in BY_MACHINE_CODE else SLOW_S


def machine_code(family: str) -> str:
    """Return the folder of machine code that a family's tests are run with; none for plain loops.

    Parameters
    ----------
    family : str
    """
    return os.environ["NUMBA_CACHE_DIR"] if family in BY_MACHINE_CODE else ""


def in_stages(mutant: Mutant, tests: Tests) -> list[list[str]]:
    """Return first the tests of files that name the module, then the others that call into it.

    Parameters
    ----------
    mutant : Mutant
    tests : Tests
    """
    names = re.compile(rf"\b{re.escape(Path(mutant.path).stem)}\b")
    near = {
        file
        for file in {name.partition("::")[0] for name in tests.seconds}
        if names.search((ROOT / file).read_text()) or names.search(Path(file).stem)
    }
    if _on_import(mutant):
        near |= {f for f in (n.partition("::")[0] for n in tests.seconds) if Path(f).stem in EVERY}
    reached = {mutant.path}
    if _on_import(mutant):
        family = python_files(mutant.family)
        reached |= {str(p.relative_to(ROOT)) for p in family if names.search(p.read_text())}
    by_name = [n for n in tests.seconds if n.partition("::")[0] in near]
    others = [n for n in tests.seconds if n.partition("::")[0] not in near]
    if mutant.family != "pipelines":
        others = [n for n in others if reached & set(tests.called[n])]
    return [
        stage
        for some in (by_name, others)
        for stage in _about_as_long(sorted(some, key=tests.seconds.__getitem__), tests)
    ]


def _about_as_long(names: list[str], tests: Tests) -> Iterator[list[str]]:
    """Yield tests, quick ones first, a few seconds' worth at a time."""
    stage: list[str] = []
    for name in names:
        stage.append(name)
        if sum(tests.seconds[n] for n in stage) > TESTS_AT_ONCE_S:
            yield stage
            stage = []
    if stage:
        yield stage


def _on_import(mutant: Mutant) -> bool:
    """Return whether what is changed runs when the module is imported, not when called."""
    if mutant.kind == "setting":
        return False
    tree = ast.parse((ROOT / mutant.path).read_text())
    bodies = [n.body for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)]
    return not any(b[0].lineno <= mutant.line <= (b[-1].end_lineno or 0) for b in bodies)


def killer_compiled(mutant: Mutant) -> str:
    """Return the test that fails on a mutant where kernels are machine code, nothing if none does.

    Parameters
    ----------
    mutant : Mutant
    """
    files = sorted(p for home in homes(mutant.family) for p in home.rglob("test_*.py"))
    every = {str(path.relative_to(ROOT)): 0.0 for path in files}
    for stage in in_stages(mutant, Tests(every, {n: [mutant.path] for n in every})):
        with tempfile.TemporaryDirectory() as folder:
            copied = Path(folder) / "cache"
            shutil.copytree(os.environ["NUMBA_CACHE_DIR"], copied)
            found = in_a_child(stage, mutant, COMPILED_S, stop=True, cache=str(copied))
        if found["code"] > 0:
            return str((found.get("failed") or ["import"])[0])
        if found["code"] < 0:
            return ""
    return ""


def killer(mutant: Mutant, tests: Tests) -> str:
    """Return the test that fails on a mutant, ``time`` if one never ends, nothing if it survives.

    Parameters
    ----------
    mutant : Mutant
    tests : Tests
    """
    stages, cache = in_stages(mutant, tests), machine_code(mutant.family)
    for stage in stages:
        limit_s = LEAST_TIMEOUT_S + 20.0 * sum(tests.seconds[name] for name in stage)
        found = in_a_child(stage, mutant, limit_s, stop=True, cache=cache)
        if found["code"] == -9:
            return "time"
        if found["code"] == NO_SUCH_TEST:  # also where no test can be begun
            if in_a_child(stage, None, limit_s, stop=True, cache=cache)["code"] != NO_SUCH_TEST:
                return "import"
            raise SystemExit("tests have changed; take away what --kept holds of them")
        if found["code"]:
            return str((found.get("failed") or ["import"])[0])
    if stages and "compiled_twin_of" in (ROOT / mutant.path).read_text():
        return _killer_of_loops(mutant, stages[0])
    return ""


def _killer_of_loops(mutant: Mutant, tests: list[str]) -> str:
    """Return the test that fails where loops answer in place of their references.

    That is slow, so what takes too long tells nothing.
    """
    found = in_a_child(tests, mutant, LEAST_TIMEOUT_S, stop=True, loops=True)
    return str((found.get("failed") or [""])[0]) if found["code"] > 0 else ""


# -- the run -----------------------------------------------------------------------------------


def wilson(k: int, n: int) -> tuple[float, float]:
    """Return the 95 % interval of a share.

    Parameters
    ----------
    k, n : int
        How many of how many.
    """
    z = 1.96
    middle = (k + z * z / 2) / (n + z * z)
    half = z / (n + z * z) * math.sqrt(k * (n - k) / n + z * z / 4)
    return middle - half, middle + half


UNCHANGED = ("hypothesis", "matplotlib.figure", "matplotlib.backends.backend_agg", "networkx",
             "numba", "numpy", "pydantic", "pytest", "rich.table", "scipy.ndimage",
             "scipy.optimize", "scipy.stats", "skimage.measure", "tactile_graph",
             "yaml")  # fmt: skip
BENEATH_THESIS = ("classifiers", "compare", "filters", "fitters", "hull", "likelihood", "mrf",
                  "pads", "sources", "tracking")  # fmt: skip
"""Families that do not import the thesis'."""


def preload(families: list[str]) -> None:
    """Import what every child needs and no mutant changes, once.

    Parameters
    ----------
    families : list of str
        That mutants are of.
    """
    for name in UNCHANGED:
        importlib.import_module(name)
    if set(families) <= set(BY_MACHINE_CODE):
        for family in BENEATH_THESIS:
            for path in python_files(family):
                parts = path.relative_to(ROOT / "plugins").with_suffix("").parts
                importlib.import_module(".".join(parts))


def run(
    chosen: list[Mutant],
    kept: Path | None,
    out: Path,
    found: dict[str, dict[str, Any]],
) -> None:
    """Try mutants one after the other, and write what came of each at once.

    Parameters
    ----------
    chosen : list of Mutant
    kept : Path, optional
        Folder of what the tests take in plain loops; without it kernels are compiled.
    out : Path
    found : dict
        What is known already, by file and place.
    """
    for k, mutant in enumerate(chosen, 1):
        start = time.monotonic()
        if kept is None:
            by = killer_compiled(mutant)
        else:
            by = killer(mutant, quick_tests(mutant.family, kept / f"{mutant.family}.tests.json"))
        found[f"{mutant.path}:{mutant.place}"] = asdict(mutant) | {"killed_by": by}
        out.write_text(json.dumps(list(found.values()), indent=1))
        told = by or "SURVIVES"
        what = f"{mutant.path}:{mutant.line} {mutant.before!r} -> {mutant.after!r}"
        print(f"{k}/{len(chosen)} {time.monotonic() - start:.0f} s {what}: {told}", flush=True)


REASONS = Path(__file__).with_name("mutations.yaml")
"""Why survivors live: ``path: before -> after`` and the reason, written by hand."""


def table(found: list[dict[str, Any]]) -> str:
    """Return what came out as Markdown: shares, and survivors with the reasons of `REASONS`.

    Parameters
    ----------
    found : list of dict
    """
    why: dict[str, str] = yaml.safe_load(REASONS.read_text()) or {}
    head = "| family | places | mutants | killed | 95 % interval | change nothing | of the others |"
    lines = [head, "|---|---|---|---|---|---|---|"]
    for family in dict.fromkeys(one["family"] for one in found):
        of = [one for one in found if one["family"] == family]
        killed = sum(bool(one["killed_by"]) for one in of)
        left = [one for one in of if not one["killed_by"]]
        same = sum(why.get(_key(one), "").startswith("same:") for one in left)
        low, high = wilson(killed, len(of))
        shown = f"{killed} ({killed / len(of):.0%}) | {100 * low:.0f} to {100 * high:.0f} %"
        others = f"{killed / max(len(of) - same, 1):.0%}"
        places = len(mutants_of(family))
        lines.append(f"| {family} | {places} | {len(of)} | {shown} | {same} | {others} |")
    left = sorted((o for o in found if not o["killed_by"]), key=lambda o: (o["path"], o["line"]))
    lines += ["", "| survivor | change | why |", "|---|---|---|"]
    for one in left:
        told = [f"`{_cell(one[name])}`" for name in ("before", "after")]
        reason = why.get(_key(one), "not noticed by any test").replace("same:", "no difference:")
        where = f"`{one['path'].partition('tactile_graph_')[2]}` {one['line']}"
        lines.append(f"| {where} | {' to '.join(told)} | {reason} |")
    return "\n".join(lines)


def _key(one: dict[str, Any]) -> str:
    return f"{one['path']}: {one['before']} -> {one['after']}"


def _cell(text: str) -> str:
    """Return code as it fits a cell of a table."""
    shown = text if len(text) <= 60 else f"{text[:57]}…"
    return shown.replace("|", "\\|")


def main() -> None:
    """Draw mutants and try them, or show what came out."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("families", nargs="*", metavar="FAMILY")
    parser.add_argument("--mutants", type=int, default=60, help="a family")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--again", type=Path, help="try these survivors once more")
    parser.add_argument("--compiled", action="store_true", help="with --again: by machine code")
    parser.add_argument("--table", type=Path, nargs="+", help="for docs/mutations.md")
    parser.add_argument("--kept", type=Path, default=Path(tempfile.gettempdir()))
    parser.add_argument("-o", "--output", type=Path, default=Path("mutations.json"))
    given = parser.parse_args()
    if given.table:
        print(table([one for path in given.table for one in json.loads(path.read_text())]))
        return
    given.kept.mkdir(parents=True, exist_ok=True)
    os.chdir(ROOT)
    earlier = json.loads(given.again.read_text()) if given.again else []
    preload(given.families or [one["family"] for one in earlier])
    found = {f"{one['path']}:{one['place']}": one for one in earlier}
    if given.again:
        fields = Mutant.__dataclass_fields__
        chosen = [Mutant(**{n: o[n] for n in fields}) for o in earlier if not o["killed_by"]]
    else:
        chosen = []
        for family in given.families:
            places = mutants_of(family)
            chosen += random.Random(given.seed).sample(places, min(given.mutants, len(places)))
            print(f"{family}: {len(places)} places")
    run(chosen, None if given.compiled else given.kept, given.output, found)


if __name__ == "__main__":
    main()
