"""Interrupt commands that share their work among processes, at any moment.

    python benchmarks/attacks/interrupts.py                # 50 tries, four minutes
    python benchmarks/attacks/interrupts.py --tries 1000
    python benchmarks/attacks/interrupts.py --latest 3     # no later than 3 s after the start

Each try runs an endless command with two workers and sends, at a moment drawn at random, Ctrl-C to
the command alone, to all processes as a terminal does, or twice, or SIGTERM. The command must end
soon, say why, with the code of a signal and without a traceback, and leave no process behind.
"""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from attempts import Attempt, parser_of, told
from workers import left_of

DISCS = ("--source", "simulate", "--with", "scene=discs")
ENDLESS = (*DISCS, "--frames", "1000000")
COMMANDS: dict[str, tuple[str, ...]] = {
    "run circle-3": ("run", "circle-3", *ENDLESS, "-o", "out.csv"),
    "run locate": ("run", "locate", *ENDLESS, "-o", "out.jsonl"),
    "compare": ("compare", "circle-1", "circle-3", *ENDLESS),
    "audit": ("audit", "circle-3", *ENDLESS),
    "learn": ("learn", "stone", *ENDLESS),
    "tune": ("tune", "adaptive", *DISCS, "--frames", "2000"),
    "reproduce": ("reproduce", "all", "--quick", "-o", "book"),
}  # fmt: skip
WAYS = ("alone", "alone", "all", "twice", "SIGTERM")
TWICE_S = 0.5
SOON_S, LONGEST_S = 8.0, 30.0
CODES = (130, 143, -signal.SIGINT, -signal.SIGTERM)
"""What a command ends with: a second Ctrl-C kills it while Python shuts down."""
WORDS = ("interrupted", "ended by SIGTERM")


def begun(words: tuple[str, ...], folder: Path) -> subprocess.Popen[bytes]:
    """Return a command in a session of its own that Ctrl-C reaches, whoever has begun this."""
    with open(folder / "said", "wb") as said:
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "tactile_graph", *words, "--workers", "2"],
            cwd=folder, stdout=said, stderr=subprocess.STDOUT, start_new_session=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )  # fmt: skip


def interrupt(running: subprocess.Popen[bytes], way: str, pause_s: float) -> None:
    """Send what a way of interrupting is."""
    if way == "all":
        os.killpg(running.pid, signal.SIGINT)
    else:
        running.send_signal(signal.SIGTERM if way == "SIGTERM" else signal.SIGINT)
    if way == "twice":
        time.sleep(pause_s)
        running.send_signal(signal.SIGINT)  # nothing, if it has ended


def wrong(name: str, way: str, after_s: float, pause_s: float, folder: Path) -> str:
    """Return what is wrong after a command was interrupted; "" if nothing is."""
    running = begun(COMMANDS[name], folder)
    time.sleep(after_s)
    interrupt(running, way, pause_s)
    sent_s = time.monotonic()
    try:
        code = running.wait(LONGEST_S)
    except subprocess.TimeoutExpired:
        return f"runs on for {LONGEST_S:g} s: {_said(folder)}"
    finally:
        took_s = time.monotonic() - sent_s
        left = _left(running.pid)
    if "Traceback" in _said(folder):
        return f"a traceback: {_said(folder)}"
    if code not in CODES:
        return f"code {code}: {_said(folder)}"
    if code > 0 and not any(word in _said(folder) for word in WORDS):
        return f"it does not say why it ended: {_said(folder)}"
    if took_s > SOON_S:
        return f"it took {took_s:.1f} s"
    return f"{len(left)} processes are left" if left else ""


def _said(folder: Path) -> str:
    return (folder / "said").read_text()[-800:]


def _left(session: int) -> list[int]:
    """Return what is left after a while of a session, and end it."""
    left = left_of(session)
    for process in left:
        with suppress(ProcessLookupError):
            os.kill(process, signal.SIGKILL)
    return left


def attempts(n: int, seed: int, latest_s: float) -> Iterator[Attempt]:
    """Yield what came of each try."""
    rng = random.Random(seed)
    for _ in range(n):
        name, way = rng.choice([*COMMANDS]), rng.choice(WAYS)
        after_s, pause_s = rng.uniform(0.15, latest_s), rng.uniform(0.0, TWICE_S)
        begun_s = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            why = wrong(name, way, after_s, pause_s, Path(folder))
        where = f"{name}, {way}, after {after_s:.2f} s: {why}" if why else ""
        yield Attempt(name, way, where, time.monotonic() - begun_s)


def main() -> int:
    parser = parser_of(str(__doc__), 50)
    parser.add_argument("--latest", type=float, default=6.0, help="seconds from the start on")
    args = parser.parse_args()
    return told(attempts(args.tries, args.seed, args.latest), args)


if __name__ == "__main__":
    sys.exit(main())
