"""Attack the command line with plugins that misbehave, one or several at a time.

    python benchmarks/attacks/plugins.py                # each alone, and 20 mixtures; two minutes
    python benchmarks/attacks/plugins.py --tries 1000
    python benchmarks/attacks/plugins.py --forks        # a tenth of the time

Each plugin is installed for one process, as a folder on its path with an entry point. A run that
needs none of them must give whole JSON lines alone on standard output and exit with 0; `plugins`
must name each one that fails; a pipeline that uses a broken step must exit with 2, or with 1 where
the step fails in a frame, and name the step or its plugin; no traceback may be shown. In forks of a
process that has imported the project, and no plugin, what a plugin does to imports that come after
it is left out.
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import redirect_stderr, redirect_stdout, suppress
from io import StringIO
from pathlib import Path
from typing import NamedTuple, NoReturn, TypeAlias

from attempts import Attempt, parser_of, told

from tactile_graph.cli import main as main_command
from tactile_graph.cli.app import cli
from tactile_graph.plugins.registry import installed

HOOK = """
from tactile_graph import hookimpl
@hookimpl
def tactile_graph_steps():
    {in_hook}
    return {{"{name}": "{name}_step:step"}}
"""
STEP = """
from tactile_graph import Image
{at_import}
def step(image: Image) -> float:
    {in_step}
    return 1.0
"""
WRITES = "image.values.setflags(write=True); image.values[0, 0] += 1.0"
LONGEST_S = 300.0


class Bad(NamedTuple):
    """A plugin: what it does where, whether it fails to load, and how its step's run ends."""

    at_import: str = ""
    in_hook: str = "pass"
    step_import: str = ""
    in_step: str = "pass"
    fails: bool = False
    exits: tuple[int, ...] = (0,)
    says: str = ""


ODD = "class Odd(Exception):\n    def __str__(self): raise ValueError"
RAISES = ("raise KeyboardInterrupt", "raise SystemExit(0)", "import sys; sys.exit('no licence')",
          "raise GeneratorExit", "raise BaseException('base')", "raise MemoryError", "1 / 0",
          "import no_such_module", "raise RecursionError", "raise ExceptionGroup('g', [OSError()])",
          f"{ODD}\nraise Odd")  # fmt: skip
PLUGINS: dict[str, Bad] = {
    **{f"raises_{i}": Bad(at_import=r, fails=True, exits=(2,)) for i, r in enumerate(RAISES)},
    **{f"hook_{i}": Bad(in_hook=r, fails=True, exits=(2,)) for i, r in enumerate(RAISES[:10])},
    **{f"step_{i}": Bad(step_import=r, exits=(2,)) for i, r in enumerate(RAISES)},
    **{f"frame_{i}": Bad(in_step=r, exits=(1, 2, 130)) for i, r in enumerate(RAISES[:10])},
    "frame_odd": Bad(step_import=ODD, in_step="raise Odd", exits=(1,)),
    "syntax": Bad(at_import="def (", fails=True, exits=(2,)),
    "prints": Bad(at_import="print('{}')", step_import="print('{}')", in_step="print('{}')"),
    "prints_hook": Bad(in_hook="print('not json')"),
    "escapes": Bad(at_import="raise OSError('\\x1b[2J\\u202e')", fails=True, exits=(2,)),
    "hangs": Bad(at_import="import time; time.sleep(6.0)", says="still being imported"),
    "writes": Bad(in_step=WRITES, exits=(1,), says="writes into"),
    "handlers": Bad(at_import="import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"),
    "no_stdout": Bad(at_import="import sys; sys.stdout = None"),
    "folder": Bad(at_import="import os; os.chdir('/')"),
    "warns": Bad(at_import="import warnings; warnings.warn('old')"),
    "logs": Bad(at_import="import logging; logging.basicConfig(); logging.error('log')"),
}  # fmt: skip


def install(name: str, bad: Bad, folder: Path) -> None:
    """Lay a plugin out as if it were installed in a folder."""
    hook = HOOK.format(name=name, in_hook=bad.in_hook)
    (folder / f"{name}_plugin.py").write_text(bad.at_import + "\n" + hook)
    (folder / f"{name}_step.py").write_text(
        STEP.format(at_import=bad.step_import, in_step=bad.in_step)
    )
    info = folder / f"{name}-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[tactile_graph]\n{name} = {name}_plugin\n")
    (folder / f"{name}.yaml").write_text(
        f"{{pipeline: {name}-p, nodes: {{a: {{step: {name}, in: frame}}}}, outputs: [a]}}"
    )


Call: TypeAlias = "Callable[..., subprocess.CompletedProcess[str]]"


def call(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Return what came of a command with the plugins of a folder."""
    env = {**os.environ, "TACTILE_GRAPH_KERNELS": "plain", "PYTHONPATH": str(folder)}
    command = [sys.executable, "-m", "tactile_graph", *words]
    return subprocess.run(
        command, env=env, capture_output=True, text=True, timeout=LONGEST_S, check=False
    )


def call_forked(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Return what came of a command with the plugins of a folder, in a fork of this process."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        pid = os.fork()
        if pid == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            _go_on_as(folder, words)
        code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        said = []
        for file in (out, err):
            file.seek(0)
            said.append(file.read().decode(errors="backslashreplace"))
    return subprocess.CompletedProcess(words, code, *said)


def _go_on_as(folder: Path, words: Sequence[str]) -> NoReturn:
    """Be the command, and end as Python does."""
    code = 1
    try:
        signal.alarm(int(LONGEST_S))
        sys.argv = ["tactile-graph", *words]
        sys.path.insert(0, str(folder))
        main_command()
    except SystemExit as done:
        if done.code is None or isinstance(done.code, int):
            code = done.code or 0
        else:
            sys.stderr.write(f"{done.code}\n")
    except BaseException:
        traceback.print_exc()
    finally:
        with suppress(Exception):
            sys.stdout.flush()
        with suppress(Exception):
            sys.stderr.flush()
        os._exit(code)


def import_all() -> None:
    """Have all imported that commands need, and find no plugin of a folder yet."""
    with (
        tempfile.TemporaryDirectory() as name,
        redirect_stdout(StringIO()),
        redirect_stderr(StringIO()),
    ):
        for words in (("run", "circle-1", "--frames", "3", "--verify", "-o", f"{name}/a.jsonl"),
                      ("plugins",)):  # fmt: skip
            cli.main(list(words), standalone_mode=False)
    installed.cache_clear()


def trouble(got: subprocess.CompletedProcess[str], exits: Sequence[int]) -> str:
    """Return what is wrong with how a command ended; "" if nothing is."""
    if "Traceback" in got.stderr:
        return f"traceback: {got.stderr[-300:]}"
    if got.returncode not in exits:
        return f"exit code {got.returncode}: {got.stderr[-300:]}"
    if any(c in got.stdout + got.stderr for c in "\x1b\u202e"):
        return "an escape reaches the terminal"
    return ""


def tried(names: Sequence[str], folder: Path, call: Call) -> Iterator[tuple[str, str]]:
    """Yield what was called with plugins installed, and what is wrong, if anything is."""
    for name in names:
        install(name, PLUGINS[name], folder)
    got = call(folder, "run", "circle-1", "--frames", "3", "-o", "-")
    yield "run of others", trouble(got, (0,)) or _lines(got.stdout, 3)
    got = call(folder, "plugins")
    failing = [n for n in names if PLUGINS[n].fails]
    unnamed = [n for n in failing if f"plugin '{n}'" not in got.stdout]
    yield "plugins", trouble(got, (0,)) or (f"not named: {unnamed}" if unnamed else "")
    for name in names:
        bad = PLUGINS[name]
        file = str(folder / f"{name}.yaml")
        got = call(folder, "run", file, "--source", "sample", "--with", "name=discs", "--frames",
                   "3", "--verify", "-o", "-")  # fmt: skip
        why = trouble(got, bad.exits)
        if not why and bad.says not in got.stderr:
            why = f"does not say {bad.says!r}: {got.stderr[-300:]}"
        if not why and bad.exits == (2,) and name not in got.stderr:
            why = f"does not name {name!r}: {got.stderr[-300:]}"
        yield f"run of {name}", why or _lines(got.stdout, None)


def _lines(text: str, n: int | None) -> str:
    try:
        rows = [json.loads(line) for line in text.splitlines()]
    except ValueError:
        return f"no JSON line: {text[:200]!r}"
    return f"{len(rows)} lines, not {n}" if n is not None and len(rows) != n else ""


def attack(n_tries: int, seed: int, forks: bool) -> Iterator[Attempt]:
    """Yield what came of commands with plugins: each alone first, then mixtures of them."""
    rng = random.Random(seed)
    if forks:
        import_all()
    for i in range(n_tries):
        alone = i < len(PLUGINS)
        names = [list(PLUGINS)[i]] if alone else rng.sample(list(PLUGINS), rng.randint(2, 4))
        with tempfile.TemporaryDirectory() as folder:
            for what, why in tried(names, Path(folder), call_forked if forks else call):
                kind = what if what in ("plugins", "run of others") else "run of its step"
                came = "as promised" if not why else "FAILED"
                yield Attempt(kind, came, why and f"{', '.join(names)}: {what}: {why}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything went wrong."""
    parser = parser_of(__doc__, len(PLUGINS) + 20)
    parser.add_argument("--forks", action="store_true", help="of this process; far less time")
    args = parser.parse_args(arguments)
    return told(attack(args.tries, args.seed, args.forks), args)


if __name__ == "__main__":
    sys.exit(main())
