"""Attack stores: parts damaged, swapped and taken away, and writers killed at any moment.

    python benchmarks/attacks/stores.py                                # 300 damaged, 40 killed
    python benchmarks/attacks/stores.py --tries 20000 --killed 1000    # about an hour

Each damaged store is a copy of one of three in which one to three things happened to its files:
bits flipped, ends cut off, parts zeroed, files emptied, taken away, exchanged, overwritten by
others, numbers in metadata changed, lines of the journal dropped, doubled and exchanged, its first
line and the grid in `zarr.json` both damaged. It is read, mended by `check --repair`, read, damaged
once more, and read. A frame is wrong if it differs from what was written and is not marked as
doubtful; a store is short if frames are missing and nothing is told. Killed are `record`, `record
--append`, `convert` and `check --repair`, each at a moment drawn at random.
"""

from __future__ import annotations

import json
import mmap
import os
import random
import shutil
import signal
import struct
import sys
import tempfile
import time
import zlib
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np
from attempts import Attempt, parser_of, told

from tactile_graph import Circle, Frame
from tactile_graph.errors import TactileGraphError
from tactile_graph.steps.injected import Report
from tactile_graph.wires import TrueObject
from tactile_graph_sources.commands.convert import convert
from tactile_graph_sources.commands.record import record
from tactile_graph_sources.store import read_store
from tactile_graph_sources.stores.checking import check
from tactile_graph_sources.writers.write_npz import write_npz
from tactile_graph_sources.writers.write_store import StoreWriter

CHUNK = 8
SLOW_S = 2.0


def frames(n: int, seed: int, first: int = 0) -> list[Frame]:
    """Return frames that differ in all they can: truth, labels, times, gaps, invalid cells."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:5, :6]
    made = []
    for i in range(first, first + n):
        place = np.hypot(x - 3 - np.sin(i / 9), y - 2 - np.cos(i / 9))
        values = np.round(2000 * np.exp(-(place**2)) + rng.integers(0, 9, (5, 6)))
        values[rng.random((5, 6)) < 0.1] = np.nan
        if 16 <= i < 24:  # a chunk that Zarr does not write
            values[:] = np.nan
        disc = TrueObject(Circle(*rng.random(3)), 100.0, f"disc {i}")
        made.append(
            Frame.of(
                values, (1.3, 0.7), (0.5, 0.25), "counts", index=i, time_s=100 + 0.01 * i,
                truth=(disc,) if i % 3 == 0 else None, device_time_s=0.02 * i if i % 2 else None,
                gap=i % 5 == 3, label="left" if i % 4 == 0 else "", doubtful=i % 11 == 7,
            )
        )  # fmt: skip
    return made


def same(a: Frame, b: Frame) -> bool:
    """Return whether a frame is the one that was written; it may follow a gap it did not."""
    return (
        np.array_equal(a.image.filled(np.nan), b.image.filled(np.nan), equal_nan=True)
        and (a.image.pitch_cm, a.image.origin_cm) == (b.image.pitch_cm, b.image.origin_cm)
        and a.image.quantity == b.image.quantity
        and (a.time_s, a.truth, a.device_time_s, a.label, a.doubtful)
        == (b.time_s, b.truth, b.device_time_s, b.label, b.doubtful)
        and (b.gap or not a.gap)
    )


# -- what can happen to files ------------------------------------------------------------------

Damage = Callable[[Path, random.Random], None]


def any_file(store: Path, rng: random.Random) -> Path | None:
    """Return one of the files, each kind of them as likely as another."""
    files = sorted(p for p in store.rglob("*") if p.is_file())
    kinds = [
        [p for p in files if p.name == "frames.journal"],
        [p for p in files if p.name == "zarr.json"],
    ]
    kinds.append([p for p in files if "values" in p.parts and p.name != "zarr.json"])
    kinds.append([p for p in files if p not in kinds[0] + kinds[1] + kinds[2]])
    kinds = [k for k in kinds if k]
    return rng.choice(rng.choice(kinds)) if kinds else None


def on_bytes(change: Callable[[bytearray, random.Random], bytes | bytearray]) -> Damage:
    """Return the damage that changes the bytes of one file."""

    def damage(store: Path, rng: random.Random) -> None:
        file = any_file(store, rng)
        if file is not None:
            file.write_bytes(change(bytearray(file.read_bytes()), rng))

    return damage


def flip_bit(data: bytearray, rng: random.Random) -> bytearray:
    if data:
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return data


def flip_byte(data: bytearray, rng: random.Random) -> bytearray:
    if data:
        data[rng.randrange(len(data))] = rng.randrange(256)
    return data


def zero(data: bytearray, rng: random.Random) -> bytearray:
    low = rng.randrange(len(data) + 1)
    high = min(len(data), low + rng.randrange(1, 600))
    data[low:high] = bytes(high - low)
    return data


def number(data: bytearray, rng: random.Random) -> bytes:
    """Change a digit: the file may still be well-formed."""
    places = [i for i, b in enumerate(data) if 48 <= b < 58]
    if places:
        data[rng.choice(places)] = 48 + rng.randrange(10)
    return data


def lines(data: bytearray, rng: random.Random) -> bytes:
    """Drop, double or exchange lines."""
    rows = bytes(data).splitlines(keepends=True)
    if len(rows) < 2:
        return data
    i, j = rng.randrange(len(rows)), rng.randrange(len(rows))
    how = rng.randrange(4)
    if how == 0:
        del rows[i]
    elif how == 1:
        rows.insert(j, rows[i])
    elif how == 2:
        rows[i], rows[j] = rows[j], rows[i]
    else:
        del rows[i:]
    return b"".join(rows)


def take_away(store: Path, rng: random.Random) -> None:
    file = any_file(store, rng)
    if file is not None:
        file.unlink()


def take_folder_away(store: Path, rng: random.Random) -> None:
    folders = sorted(p for p in store.rglob("*") if p.is_dir())
    if folders:
        shutil.rmtree(rng.choice(folders))


def overwrite(store: Path, rng: random.Random) -> None:
    a, b = any_file(store, rng), any_file(store, rng)
    if a is not None and b is not None and a != b:
        a.write_bytes(b.read_bytes())


def exchange(store: Path, rng: random.Random) -> None:
    a, b = any_file(store, rng), any_file(store, rng)
    if a is not None and b is not None:
        one, other = a.read_bytes(), b.read_bytes()
        a.write_bytes(other)
        b.write_bytes(one)


def make_folder(store: Path, rng: random.Random) -> None:
    file = any_file(store, rng)
    if file is not None:
        file.unlink()
        file.mkdir()


def line_of_journal(store: Path, rng: random.Random) -> None:
    file = store / "frames.journal"
    if file.is_file():
        file.write_bytes(lines(bytearray(file.read_bytes()), rng))


def head_and_grid(store: Path, rng: random.Random) -> None:
    """Damage the journal's first line, and say another pitch, origin or quantity for Zarr."""
    file, group = store / "frames.journal", store / "zarr.json"
    if not (file.is_file() and group.is_file()):
        return
    head, *rest = file.read_bytes().splitlines(keepends=True) or [b""]
    file.write_bytes(b"".join([bytes(flip_byte(bytearray(head), rng)), *rest]))
    was, now = rng.choice(((b"1.3", b"1.8"), (b"0.25", b"0.75"), (b"counts", b"gram"),
                           (b'"version": 3', b'"version": 2')))  # fmt: skip
    group.write_bytes(group.read_bytes().replace(was, now, 1))


def without_copies(store: Path) -> None:
    """Take the attributes out of the journal's blocks, as they were written at first."""
    lines = (store / "frames.journal").read_bytes().splitlines(keepends=True)
    for i, line in enumerate(lines[1:], 1):
        data = json.loads(line[9:])
        data.pop("attributes")
        text = json.dumps(data, separators=(",", ":")).encode()
        lines[i] = b"%08x %s\n" % (zlib.crc32(text), text)
    (store / "frames.journal").write_bytes(b"".join(lines))


DAMAGES: dict[str, Damage] = {
    "bit flipped": on_bytes(flip_bit),
    "byte flipped": on_bytes(flip_byte),
    "zeroed": on_bytes(zero),
    "digit changed": on_bytes(number),
    "cut off": on_bytes(lambda d, rng: d[: rng.randrange(len(d) + 1)]),
    "longer": on_bytes(lambda d, rng: d + rng.randbytes(rng.randrange(1, 40))),
    "emptied": on_bytes(lambda d, rng: b""),
    "garbage": on_bytes(lambda d, rng: rng.randbytes(len(d))),
    "taken away": take_away,
    "folder taken away": take_folder_away,
    "overwritten": overwrite,
    "exchanged": exchange,
    "made a folder": make_folder,
    "journal's lines": line_of_journal,
    "head and grid": head_and_grid,
}


# -- damaged stores ----------------------------------------------------------------------------


def judged(store: Path, written: Sequence[Frame]) -> tuple[str, str, int]:
    """Return what came of reading a store, in a word and at length, and how many frames came."""
    report = Report()
    begun = time.process_time()
    n = 0
    try:
        bad = ""
        for frame in read_store(store, report):
            n += 1
            if frame.index >= len(written):
                bad = bad or f"frame {frame.index} was never written"
            elif not frame.doubtful and not same(written[frame.index], frame):
                bad = bad or f"frame {frame.index} differs"
    except TactileGraphError as error:
        return "refused", str(error), n
    except Exception as error:
        return "FOREIGN", repr(error), n
    seconds = time.process_time() - begun
    if seconds > SLOW_S:
        return "SLOW", f"{seconds:.1f} s", n
    if bad:
        return "WRONG", bad, n
    if n < len(written):
        return ("told", "", n) if report.troubles else ("SHORT", f"{n} frames", n)
    return ("whole, told" if report.troubles else "whole"), "", n


def damaged(base: Path, written: Sequence[Frame], work: Path, seed: int) -> list[tuple[str, str]]:
    """Return what came of one damaged store: as it was, and mended."""
    rng = random.Random(seed)
    store = work / "d.zarr"
    shutil.rmtree(store, ignore_errors=True)
    shutil.copytree(base, store)
    names = [rng.choice(list(DAMAGES)) for _ in range(rng.choice((1, 1, 1, 2, 3)))]
    for name in names:
        DAMAGES[name](store, rng)
    verdict, why, n = judged(store, written)
    what = f"seed {seed}, {', '.join(names)}"
    found = [(verdict, f"{what}: {why}")]
    if verdict == "refused":
        return found
    try:
        check(store, repair=True)
        again = check(store, repair=True)
        if again.mended:
            found.append(("UNSTEADY", f"seed {seed}: mended twice: {again.mended}"))
    except TactileGraphError as error:
        return [*found, ("not mended", str(error))]
    except Exception as error:
        return [*found, ("FOREIGN", f"{what}: mending: {error!r}")]
    verdict, why, n_after = judged(store, written)
    if n_after < n and verdict != "FOREIGN":
        verdict, why = "WORSE", f"{n} frames, mended {n_after}"
    found.append((f"mended: {verdict}", f"{what}: mended: {why}"))
    once_more = rng.choice(list(DAMAGES))
    DAMAGES[once_more](store, rng)
    verdict, why, _ = judged(store, written)
    return [*found, (f"once more: {verdict}", f"{what}, mended, {once_more}: {why}")]


# -- killed writers ----------------------------------------------------------------------------


SOON_S = 0.05
"""How long after there is a store every second command that makes one is killed."""


class Forked:
    """A command in a process of its own, which can be killed, and the frames its writer took."""

    def __init__(self, command: Callable[[], object]) -> None:
        self._taken = mmap.mmap(-1, 8)
        self.begun = time.monotonic()
        self.pid = os.fork()
        if self.pid == 0:
            self._run(command)

    def _run(self, command: Callable[[], object]) -> None:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 1)
        os.dup2(nowhere, 2)
        taken, real = self._taken, StoreWriter.write

        def write(writer: StoreWriter, frame: Frame) -> None:
            real(writer, frame)
            taken[:8] = struct.pack("q", writer.n_frames)

        StoreWriter.write = write  # type: ignore[method-assign]
        try:
            command()
        finally:
            os._exit(0)

    @property
    def n_taken(self) -> int:
        return int(struct.unpack("q", self._taken[:8])[0])

    def ended(self) -> float:
        """Wait for its end and return how long it took."""
        os.waitpid(self.pid, 0)
        return time.monotonic() - self.begun

    def kill(self, after_s: float) -> None:
        time.sleep(max(0.0, self.begun + after_s - time.monotonic()))
        os.kill(self.pid, signal.SIGKILL)
        os.waitpid(self.pid, 0)

    def kill_once_there(self, store: Path, after_s: float) -> None:
        """Kill it so long after there is a store, unless it has ended."""
        ended = False
        while not ended and not store.exists():
            time.sleep(0.0005)
            ended = os.waitpid(self.pid, os.WNOHANG)[0] == self.pid
        if not ended:
            self.begun = time.monotonic()
            self.kill(after_s)


class Killing:
    """Commands that write, over frames that are known, killed at moments drawn at random."""

    def __init__(self, work: Path, n_frames: int) -> None:
        self.work = work
        self.written = frames(n_frames, 1)
        self.more = [*self.written, *frames(n_frames, 2, n_frames)]
        write_npz(work / "a.npz", self.written)
        write_npz(work / "b.npz", self.more[n_frames:])
        self.store = work / "k.zarr"
        self.base = work / "base.zarr"
        with StoreWriter(self.base, CHUNK) as store:
            for frame in self.written:
                store.write(frame)
        self.broken = work / "broken.zarr"
        shutil.copytree(self.base, self.broken)
        for name in ("time_s/zarr.json", "frames.journal"):
            (self.broken / name).write_bytes((self.broken / name).read_bytes()[:-9])
        shutil.rmtree(self.broken / "gap" / "c", ignore_errors=True)
        self.lasts: dict[str, float] = {}

    def command(self, name: str) -> Callable[[], object]:
        if name == "convert":
            args = [str(self.work / "a.npz"), str(self.store)]
            return lambda: convert.main(args, standalone_mode=False)
        if name == "check --repair":
            return lambda: check(self.store, True)
        file = "b.npz" if "append" in name else "a.npz"
        args = [str(self.store), "--source", "recording", "--with", f"path={self.work / file}",
                "--chunk", str(CHUNK), *(["--append"] if "append" in name else [])]  # fmt: skip
        return lambda: record.main(args, standalone_mode=False)

    def lay_out(self, name: str) -> None:
        shutil.rmtree(self.store, ignore_errors=True)
        base = {"record --append": self.base, "check --repair": self.broken}.get(name)
        if base is not None:
            shutil.copytree(base, self.store)

    def once(self, name: str, rng: random.Random) -> tuple[str, str]:
        """Return what came of killing a command once."""
        if name not in self.lasts:
            self.lay_out(name)
            self.lasts[name] = Forked(self.command(name)).ended()
            if not self.store.exists():
                raise RuntimeError(f"{name} writes nothing even when it is let")
        self.lay_out(name)
        after_s = rng.random() * 1.1 * self.lasts[name]
        makes, soon_s = not self.store.exists(), rng.random() * SOON_S
        child = Forked(self.command(name))
        if makes and rng.random() < 0.5:
            child.kill_once_there(self.store, soon_s)
        else:
            child.kill(after_s)
        verdict, why = self._judge(name, child.n_taken)
        return verdict, f"{name} after {after_s:.3f} s: {why}"

    def _judge(self, name: str, n_taken: int) -> tuple[str, str]:
        chunk = 256 if name == "convert" else CHUNK
        if not self.store.exists():
            return ("nothing", "") if n_taken <= chunk else ("LOST", f"all of {n_taken}")
        least = max(n_taken - chunk, 0 if name in ("record", "convert") else len(self.written))
        verdict, why, n = judged(self.store, self.more[: max(least, 0)])
        if verdict in ("SHORT", "told"):
            return "LOST", f"{n} of {n_taken} frames"
        if verdict == "WRONG" and "never" in why:  # more than the least: hold them to all
            verdict, why, _ = judged(self.store, self.more[:n])
        if verdict == "refused" and least == 0 and "not a single" not in why:
            return "UNREADABLE", why
        if verdict == "refused" and least:
            return "UNREADABLE", why
        return self._gone_on(n) if verdict.islower() else (verdict, why)

    def _gone_on(self, n: int) -> tuple[str, str]:
        """Return whether a store that was cut short can be gone on with."""
        try:
            check(self.store, True)
            with StoreWriter(self.store, append=True) as store:
                store.write(frames(1, 3, n)[0])
        except Exception as error:
            return "NO MORE", repr(error)
        n_now = sum(1 for _ in read_store(self.store))
        return ("whole", "") if n_now == n + 1 else ("NO MORE", f"{n} frames and one are {n_now}")


# -- all of it ---------------------------------------------------------------------------------


def attack(n_damaged: int, n_killed: int, seed: int) -> Iterator[Attempt]:
    """Yield what came of stores that were damaged and of commands that were killed."""
    for what, verdict, why in _attack(n_damaged, n_killed, seed):
        bad = any(word.isupper() for word in verdict.replace(":", "").split())
        yield Attempt(what, verdict, why if bad else "")


def _attack(n_damaged: int, n_killed: int, seed: int) -> Iterator[tuple[str, str, str]]:
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        written = frames(45, seed)
        long, short = work / "long.zarr", work / "short.zarr"
        for path, upto in ((long, (20, 45)), (short, (3,))):
            for low, high in zip((0, *upto), upto, strict=False):
                with StoreWriter(path, CHUNK, append=True) as store:
                    for frame in written[low:high]:
                        store.write(frame)
        older = work / "older.zarr"
        shutil.copytree(long, older)
        without_copies(older)
        # Frames that are gone on with follow a gap.
        told = {path: list(read_store(path)) for path in (long, older, short)}
        for i in range(n_damaged):
            base = (long, older, long, long, short)[i % 5]
            for verdict, why in damaged(base, told[base], work, seed * 1_000_003 + i):
                yield "damaged", verdict, why
        killing, rng = Killing(work, 40), random.Random(seed)
        names = ("record", "record --append", "convert", "check --repair")
        for i in range(n_killed):
            verdict, why = killing.once(names[i % len(names)], rng)
            yield f"{names[i % len(names)]} killed", verdict, why


def main(arguments: Sequence[str] | None = None) -> int:
    """Attack, and return 1 if anything was silent, foreign or lost."""
    parser = parser_of(__doc__, 300)
    parser.add_argument("--killed", type=int, default=40, help="commands that are killed")
    args = parser.parse_args(arguments)
    return told(attack(args.tries, args.killed, args.seed), args)


if __name__ == "__main__":
    sys.exit(main())
