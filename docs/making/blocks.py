"""The fenced blocks of a page, run in order in a folder of its own, as a reader would.

- ``python`` runs in one namespace for the whole page.
- ``sh`` runs in bash, which ends at the first command that fails; `tactile-graph` and `python` are
  those of this environment.
- ``yaml`` that begins with ``# name.yaml`` is written to that file and checked; what begins with
  ``# part of`` has to be YAML.
- ``text`` behind one of these is what it prints: its lines come in this order, ``…`` standing for
  anything.
- A block that begins with ``# not run:`` and the reason is left alone.
- A comment ``<!-- before: … -->`` right above a block holds what bash does first, such as making
  the files that the page's reader has; ``<!-- run by FILE -->`` says what else runs the block, and
  ``<!-- run here with 20 frames -->`` that so many do, where the block asks for more.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import traceback
from collections.abc import Iterable
from contextlib import chdir, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from types import ModuleType

import yaml

ROOT = Path(__file__).parents[2]
NOT_RUN = "# not run: "
PART = "# part of "
FENCE = re.compile(
    r"^(?:<!-- (?:before:\n(?P<before>(?:(?!-->).)*)|run by (?P<run_by>\S+) "
    r"|run here with (?P<frames>\d+) frames )-->\n)*"
    r"(?P<fence>```)(?P<language>\w+)[^\n]*\n(?P<text>.*?)^```$",
    re.M | re.S,
)
FRAMES = re.compile(r"(?<=\bframes[ =])\d+")
FILE = re.compile(r"# ([\w-]+\.yaml)$")
RUN = ("python", "sh", "yaml")
LONGEST_S = 600.0


@dataclass(frozen=True)
class Block:
    """A fenced block: where it stands, its language, its text; what bash does before.

    ``run_by`` is the file that runs it, below the project's root, where that is not this one;
    ``frames`` how many it is run with, 0 for as many as it says.
    """

    place: str
    language: str
    text: str
    before: str = ""
    run_by: str = ""
    frames: int = 0

    @property
    def first(self) -> str:
        """Its first line."""
        return self.text.partition("\n")[0]


def blocks_of(page: Path) -> list[Block]:
    """Return the blocks of a page that are run, and the texts behind them, in order."""
    text = page.read_text("utf-8")
    return [
        Block(
            f"{page.name}:{text.count(chr(10), 0, m.start('fence')) + 1}",
            m["language"], m["text"], m["before"] or "", m["run_by"] or "",
            int(m["frames"] or 0),
        )
        for m in FENCE.finditer(text)
        if m["language"] in (*RUN, "text")
    ]  # fmt: skip


def run_blocks(blocks: Iterable[Block], folder: Path) -> list[str]:
    """Run the blocks of one page in a folder, and return what went wrong, in words."""
    module = ModuleType("the_page")  # what blocks define asks for the module it is defined in
    sys.modules[module.__name__] = module
    try:
        return _troubles(blocks, folder, vars(module))
    finally:
        del sys.modules[module.__name__]  # and no more: what a page imports stays imported


def _troubles(blocks: Iterable[Block], folder: Path, space: dict[str, object]) -> list[str]:
    troubles: list[str] = []
    printed: str | None = None
    for block in blocks:
        if block.language == "text":
            if printed is not None:
                troubles += _differences(block, printed)
            printed = None
            continue
        printed = None
        if block.run_by and not (ROOT / block.run_by).is_file():
            troubles.append(f"{block.place}: there is no {block.run_by} to run it")
        if block.run_by or block.first.startswith(NOT_RUN):
            continue
        try:
            _shell(block.before, folder)
            printed = _run(block, folder, space)
        except BlockError as error:
            troubles.append(f"{block.place}: {error}")
    return troubles


class BlockError(Exception):
    """A block does not do what a reader expects; told in words."""


def _run(block: Block, folder: Path, space: dict[str, object]) -> str:
    if block.language == "sh":
        fewer = FRAMES.sub(str(block.frames), block.text) if block.frames else block.text
        return _shell(fewer, folder)
    if block.language == "python":
        return _python(block, folder, space)
    return _yaml(block, folder)


def _shell(text: str, folder: Path) -> str:
    if not text:
        return ""
    beside = str(Path(sys.executable).parent)
    environment = os.environ | {
        "PATH": os.pathsep.join([beside, os.environ.get("PATH", "")]),
        "COLUMNS": "100",
        "MPLBACKEND": "Agg",
        "NO_COLOR": "1",
    }
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", text],
        cwd=folder, env=environment, capture_output=True, text=True, timeout=LONGEST_S, check=False,
    )  # fmt: skip
    if done.returncode:
        raise BlockError(f"ends with {done.returncode}:\n{text}{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def _python(block: Block, folder: Path, space: dict[str, object]) -> str:
    with chdir(folder), redirect_stdout(StringIO()) as out:
        try:
            exec(compile(block.text, block.place, "exec"), space)
        except Exception:
            raise BlockError(f"fails:\n{traceback.format_exc(limit=-1)}") from None
    return out.getvalue()


def _yaml(block: Block, folder: Path) -> str:
    named = FILE.match(block.first)
    if named is None:
        if not block.first.startswith(PART):
            raise BlockError("says neither '# name.yaml' nor '# part of …' nor '# not run: …'")
        yaml.safe_load(block.text)
        return ""
    (folder / named[1]).write_text(block.text, "utf-8")
    return _shell(f"tactile-graph check {named[1]}\n", folder)


def _differences(block: Block, printed: str) -> list[str]:
    """Return the first line shown that does not come, in this order."""
    lines = iter(line.rstrip() for line in printed.splitlines())
    for shown in block.text.splitlines():
        wanted = re.compile(".*".join(map(re.escape, shown.strip().split("…"))))
        if shown.strip() and not any(wanted.fullmatch(line.strip()) for line in lines):
            return [f"{block.place}: nothing printed reads {shown.strip()!r}; it was:\n{printed}"]
    return []
