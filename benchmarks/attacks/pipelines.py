"""Attack loaders with damaged YAML: pipelines, pads, presets, scenes and exports of databases.

    python benchmarks/attacks/pipelines.py                   # 2,000 files
    python benchmarks/attacks/pipelines.py --tries 100000    # half an hour

Each try changes a file that is shipped: letters, words and lines lost, doubled and exchanged, words
of YAML and of Python put in, parts of another file, bytes that are no text. It is loaded, and if it
is a pipeline planned. It may be what it was or an error for people, within half a CPU second beyond
what files of its kind take as they are shipped. Counted as foreign code is whatever starts a
process, writes a file, or imports a module that only words of these files name.
"""

from __future__ import annotations

import random
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from attempts import Attempt, parser_of, told
from databases import written

from tactile_graph import load
from tactile_graph.errors import TactileGraphError
from tactile_graph.plugins.registry import installed
from tactile_graph_classifiers.database.opening import load_known
from tactile_graph_classifiers.database.text import to_text
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.devices.preset_file import load_preset
from tactile_graph_sources.scene import load_scene

SLOW_S = 0.5
CANARY = "attack_canary"
WORDS = (
    "", "~", "[]", "{}", "yes", "1e400", ".nan", "-.inf", "0x" + "f" * 5000, "9" * 4400, "-1",
    "1:30", "1" + ":59" * 400, "frame", "frame.image", "a.b.c", "*a", "&a x", "<<: *a", "? ",
    "!!int x",
    "!!set {a, b}", "!!binary aGk=", "!!python/name:os.system", "!!python/object:x.y {}",
    f"!!python/module:{CANARY}", f"!!python/object/apply:{CANARY}.run []",
    "!!python/object/apply:os.system ['true']", f"{CANARY}:run", f"{CANARY}.run", "os:system",
    f"__import__('{CANARY}')", "().__class__.__base__.__subclasses__()", "2020-01-01", "2020-99-99",
    "'", '"', '"\\0"', '"\\ud800"', "\u2028", "\ufeff", "\t", "- ", ": ", "#", "|\n", ">-\n",
    "%YAML 2", "---\n", "...\n", "(" * 300, "not " * 400 + "a", "-" * 1500 + "a", "x" * 3000,
    "[" * 60, "{a: " * 50, "../" * 40 + "x.yaml", "/dev/zero", "/etc/passwd", "step", "use", "each",
    "when", "with", "in", "extends", "objects", "geometry", "framer", "rows", "1e-320", "1e308",
    "-0.0", "10**9",
)  # fmt: skip


# -- damage ------------------------------------------------------------------------------------


def characters(text: str, rng: random.Random) -> str:
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(text) + 1)
        put = rng.choice("[]{}:,-&*!|>'\"%@`#?~ \n\t.0a\u00e9\x00\x85")
        end = at + rng.choice((0, 0, 1, 3))
        text = text[:at] + (put if end == at else "") + text[end:]
    return text


def words(text: str, rng: random.Random) -> str:
    parts = text.split(" ")
    for _ in range(rng.randint(1, 3)):
        parts[rng.randrange(len(parts))] = rng.choice((*WORDS, rng.choice(parts)))
    return " ".join(parts)


def values(text: str, rng: random.Random) -> str:
    """Put other words behind keys."""
    parts = text.split(": ")
    for _ in range(rng.randint(1, 2)):
        at = rng.randrange(len(parts))
        _, comma, rest = parts[at].partition(rng.choice((",", "}", "\n")))
        parts[at] = rng.choice(WORDS) + comma + rest
    return ": ".join(parts)


def lines(text: str, rng: random.Random) -> str:
    rows = text.splitlines(keepends=True)
    for _ in range(rng.randint(1, 3)):
        a, b = rng.randrange(len(rows)), rng.randrange(len(rows))
        how = rng.randrange(4)
        if how == 0 and len(rows) > 1:
            del rows[a]
        elif how == 1:
            rows.insert(b, rows[a])
        elif how == 2:
            rows[a], rows[b] = rows[b], rows[a]
        else:
            rows[a] = " " * rng.randint(0, 6) + rows[a].lstrip(" ")
    return "".join(rows)


def no_text(text: str, rng: random.Random) -> str:
    data = bytearray(text.encode("utf-8", "surrogateescape"))
    for _ in range(rng.randint(1, 6)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return data.decode("utf-8", "surrogateescape")


DAMAGES = (characters, words, values, values, lines, no_text)


def damaged(text: str, other: str, rng: random.Random) -> str:
    """Return a file with something done to it; now and then with a part of another in it."""
    if rng.random() < 0.1:
        rows, more = text.splitlines(keepends=True), other.splitlines(keepends=True)
        at, start = rng.randrange(len(rows)), rng.randrange(len(more))
        text = "".join([*rows[:at], *more[start : start + rng.randint(1, 9)], *rows[at:]])
    for _ in range(rng.choice((1, 1, 2))):
        text = rng.choice(DAMAGES)(text, rng) or "\n"
    return text


# -- loading -----------------------------------------------------------------------------------


def planned(path: Path) -> None:
    load(path).runner()


LOADS: dict[str, Callable[[Path], Any]] = {
    "pipelines": planned,
    "pads": load_pad,
    "presets": lambda path: load_preset(str(path)),
    "scenes": lambda path: load_scene(str(path)),
    "exports": lambda path: load_known(path, None),
}


def shipped() -> dict[str, list[str]]:
    """Return the texts of all files of each kind."""
    registry = installed()
    kinds = [k for k in LOADS if k != "exports"]
    texts = {
        k: [registry.path(k, n).read_text(encoding="utf-8") for n in registry.names(k)]
        for k in kinds
    }
    with tempfile.TemporaryDirectory() as folder:
        return {**texts, "exports": [to_text(written(Path(folder) / "a.sqlite"))]}


class Watch:
    """What happened that loading a file must never do; an audit hook, which stays for good."""

    DENIED = ("os.system", "subprocess.Popen", "os.exec", "os.posix_spawn", "os.fork",
              "socket.connect", "os.remove", "shutil.rmtree")  # fmt: skip

    def __init__(self) -> None:
        self.on = False
        self.seen = ""
        sys.addaudithook(self._note)

    def _note(self, event: str, args: tuple[Any, ...]) -> None:
        if not self.on:
            return
        bad = event in self.DENIED or (event == "import" and CANARY in str(args[0]))
        if event == "open" and isinstance(args[1], str) and set(args[1]) & set("wax+"):
            bad = not str(args[0]).endswith((".pyc", ".nbi", ".nbc"))
        if bad:
            self.seen = f"{event} {args!r}"[:200]


def once(kind: str, path: Path, watch: Watch, usual_s: float = 0.0) -> Attempt:
    """Return what came of loading a file; ``usual_s`` is what one takes as it is shipped."""
    watch.on, watch.seen, why = True, "", ""
    begun = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            LOADS[kind](path)
        came = "loaded"
    except TactileGraphError as error:
        came = "refused"
        str(error)
    except Exception as error:
        came, why = "FOREIGN", repr(error)[:200]
    finally:
        watch.on = False
    seconds = time.process_time() - begun
    if watch.seen:
        came, why = "CODE RUN", watch.seen
    elif not why and seconds > SLOW_S + usual_s:
        came, why = "SLOW", f"{seconds:.2f} s"
    return Attempt(kind, came, why, seconds)


def attack(n_tries: int, seed: int) -> Iterator[Attempt]:
    """Yield what came of damaged files, each kind in turn."""
    texts, watch = shipped(), Watch()
    every = [text for found in texts.values() for text in found]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / f"{CANARY}.py").write_text("def run(*a): return 1\n")
        sys.path.insert(0, name)
        path = folder / "a.yaml"
        usual_s: dict[str, float] = {}
        for kind, found in texts.items():
            taken = [0.0] * len(found)
            for k, text in enumerate((*found, *found)):  # what is imported once is not counted
                path.write_text(text, encoding="utf-8")
                taken[k % len(found)] = once(kind, path, watch).seconds
            usual_s[kind] = max(taken)
        for i in range(n_tries):
            rng = random.Random(seed * 1_000_003 + i)
            kind = list(LOADS)[i % len(LOADS)]
            text = damaged(rng.choice(texts[kind]), rng.choice(every), rng)
            path.write_bytes(text.encode("utf-8", "surrogateescape"))
            attempt = once(kind, path, watch, usual_s[kind])
            if attempt.why:
                kept = Path(tempfile.gettempdir()) / f"attack-{seed}-{i}.yaml"
                kept.write_bytes(path.read_bytes())
                attempt = attempt._replace(why=f"try {i}, kept as {kept}: {attempt.why}")
            yield attempt


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything was foreign or slow."""
    args = parser_of(__doc__, 2_000).parse_args(arguments)
    return told(attack(args.tries, args.seed), args)


if __name__ == "__main__":
    sys.exit(main())
