"""Check the documentation: docstrings, doctests, links, commands, lengths, and every block run.

Run with ``python docs/check.py``; exits with 1 and says what is wrong.
"""

from __future__ import annotations

import argparse
import ast
import dataclasses
import doctest
import importlib
import os
import pkgutil
import re
import shlex
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from multiprocessing import get_context
from pathlib import Path
from types import ModuleType
from unittest.mock import patch

# Two processes at a time have a core each: BLAS's threads would wait for each other, busily.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from making.blocks import RUN, blocks_of, run_blocks
from making.generate import INTO, KEPT
from making.tutorial_pictures import PAGE, write_pictures
from making.words import MOST_WORDS, by_kind, prose_words

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
PACKAGES = sorted(
    p.parent.name
    for folder in (ROOT, ROOT / "plugins", ROOT / "pipelines")
    for p in folder.glob("tactile_graph*/__init__.py")
)
CHECKS = {"PR01", "PR02"}
SHARES = 2
"""Processes at a time."""
FENCE = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```", re.M | re.S)
LINK = re.compile(r"\]\(([^)#\s]+)(#[^)\s]*)?\)")


def modules() -> Iterator[ModuleType]:
    """Yield every module of the project."""
    for name in PACKAGES:
        package = importlib.import_module(name)
        yield package
        for info in pkgutil.walk_packages(package.__path__, f"{name}."):
            if not info.name.endswith("__main__"):
                yield importlib.import_module(info.name)


def docstrings(module: ModuleType) -> Iterator[str]:
    """Yield where a documented parameter list and the signature differ (PR01, PR02)."""
    from numpydoc.validate import validate

    from tactile_graph.compiled import Kernel

    tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
    for node in tree.body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
            continue
        text = ast.get_docstring(node) or ""
        if "Parameters\n" not in text:
            continue
        found = getattr(module, node.name)
        # a compiled kernel hides the signature that its text documents
        plain = found.reference if isinstance(found, Kernel) else found
        with patch.object(module, node.name, plain):
            errors = validate(f"{module.__name__}.{node.name}")["errors"]
        inherited = {
            field.name
            for base in getattr(found, "__mro__", ())[1:]
            if dataclasses.is_dataclass(base)
            for field in dataclasses.fields(base)
        }
        for code, message in errors:
            told_by_base = code == "PR01" and set(re.findall(r"'(\w+)'", message)) <= inherited
            if code in CHECKS and not told_by_base:
                yield f"{module.__file__}:{node.lineno}: {node.name}: {code} {message}"


def doctests(module: ModuleType) -> Iterator[str]:
    """Yield the module's doctests that fail."""
    failed, _ = doctest.testmod(module)
    if failed:
        yield f"{module.__file__}: {failed} doctests fail"


def described(share: int) -> tuple[int, list[str]]:
    """Return how many modules one process looks at, and what is wrong in their docstrings."""
    found, n = [], 0
    for k, module in enumerate(modules()):
        if k % SHARES == share:
            n += 1
            found += [*docstrings(module), *doctests(module)]
    return n, found


@cache
def pages() -> list[Path]:
    """Return the Markdown pages; once, as those of a site may come and go beside this."""
    first = [ROOT / f"{name}.md" for name in ("README", "CHANGELOG", "CONTRIBUTING")]
    return [*first, *(p for p in sorted(DOCS.rglob("*.md")) if INTO not in p.parents)]


def guides() -> list[Path]:
    """Return the pages with blocks to run; the tutorial's are run by themselves."""
    return [
        page
        for page in pages()
        if page != PAGE and any(block.language in RUN for block in blocks_of(page))
    ]


def links(page: Path) -> Iterator[str]:
    """Yield the page's links to files that are not there."""
    for target, _ in LINK.findall(page.read_text(encoding="utf-8")):
        to = (page.parent / target).resolve()
        made = INTO in to.parents or page.name in ("contributing.md", "changelog.md")
        if "://" not in target and not made and not to.exists():
            yield f"{page}: no such file: {target}"


def lengths(page: Path) -> Iterator[str]:
    """Yield that a page has more words to read than anybody reads."""
    words = prose_words(page)
    if words > MOST_WORDS and DOCS in page.parents:
        yield f"{page}: {words} words outside tables and blocks, of at most {MOST_WORDS}"


def blocks(page: Path) -> list[str]:
    """Return which blocks of a page fail, run in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        return run_blocks(blocks_of(page), Path(folder))


def tutorial() -> list[str]:
    """Return which blocks of the tutorial fail; what they draw is kept for the site."""
    try:
        write_pictures(INTO, KEPT)
    except LookupError as error:
        return [f"{PAGE}: {error}"]
    return []


def commands(page: Path) -> Iterator[str]:
    """Yield the ``tactile-graph`` commands of a page whose name or options do not exist."""
    from tactile_graph.cli import cli

    for language, block in FENCE.findall(page.read_text(encoding="utf-8")):
        if language not in ("sh", "console"):
            continue
        for line in block.replace("\\\n", " ").splitlines():
            yield from _command(page, line, cli)


def _command(page: Path, line: str, cli: object) -> Iterator[str]:
    import click

    assert isinstance(cli, click.Group)
    for part in re.split(r"&&|\|", line):
        words = shlex.split(part.strip().removeprefix("$ "), comments=True)
        if not words or not words[0].endswith("tactile-graph"):
            continue
        name = next((w for w in words[1:] if not w.startswith("-")), "")
        context = click.Context(cli)
        command = cli.get_command(context, name) if name else cli
        if command is None:
            yield f"{page}: no such command: {line}"
            continue
        known = {o for p in command.params for o in (*p.opts, *p.secondary_opts)}
        known |= {o for p in cli.params for o in p.opts} | {"--help"}
        for word in words[1:]:
            if word.startswith("-") and word != "-" and word.partition("=")[0] not in known:
                yield f"{page}: no such option {word} in: {line}"


def main() -> int:
    """Run every check; return the exit code."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument(
        "--words", action="store_true",
        help="tell instead how many words of each kind of page there are",
    )  # fmt: skip
    parser.add_argument(
        "--site-beside", action="store_true",
        help="leave the tutorial to the building of the site, which runs it in any case",
    )  # fmt: skip
    asked = parser.parse_args()
    if asked.words:
        for kind, (read, every) in by_kind(DOCS, pages()[3:]).items():
            print(f"{kind:12} {read:6} words to read, {every:6} with tables and blocks")
        return 0
    checks = (links, commands, lengths)
    found = [text for page in pages() for check in checks for text in check(page)]
    first = [] if asked.site_beside else [tutorial]
    with ProcessPoolExecutor(SHARES, get_context("spawn")) as pool:
        waiting = [pool.submit(one) for one in first]
        waiting += [pool.submit(blocks, page) for page in guides()]
        found += [text for one in waiting for text in one.result()]
    n = 0
    # Processes of their own: none in which a page's blocks have run.
    with ProcessPoolExecutor(SHARES, get_context("spawn")) as pool:
        for count, texts in pool.map(described, range(SHARES)):
            n += count
            found += texts
    for text in found:
        print(text)
    print(
        f"{n} modules and {len(pages())} pages checked, {len(guides()) + len(first)} of them by "
        f"running all their blocks, {len(found)} troubles"
    )
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
