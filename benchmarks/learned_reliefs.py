"""Objects named by one press, by reliefs learned from 25 presses each, the way users do it.

    python benchmarks/learned_reliefs.py --pads strip --seeds 51

Objects, pads and presses are those of `identify_objects`. Each catalogue goes the shipped way:
readings and presses into a database as `learn --keep-presses` does it, reliefs, the pad's law and
the limit as `learn-reliefs` does it, and further presses through the pipeline `identify-reliefs`,
and `identify-any` (`discriminant`) on the same database. Every setting is the shipped one. A
stranger is each object in turn, forgotten from the database, its test presses shown to what is left
(of the reliefs gains and law were learned with its presses too); foreign are 22 objects of another
catalogue on the same pad, of which nothing was ever learned.

Settings were chosen on catalogue 2 of the strip and of the capacitive pad. That one press names and
rejects well enough is refuted if, in the mean over catalogues that nothing was chosen on, less than
95 % of known presses are named right or less than 90 % of strangers found at the shipped limit.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from identify_objects import presses
from numpy.typing import NDArray
from pressed_objects import INSTRUMENTS, Instrument, Pad, Thing, catalogue

from tactile_graph import Frame, Pipeline, load
from tactile_graph.compiled import warm_up
from tactile_graph_classifiers.commands.learn import image_of
from tactile_graph_classifiers.database.rows import Lesson, Setting
from tactile_graph_classifiers.database.store import ObjectDatabase
from tactile_graph_classifiers.distances.choosing import choose
from tactile_graph_classifiers.distances.examples import Examples
from tactile_graph_classifiers.distances.identity import Identity
from tactile_graph_classifiers.measuring.reader import Given, Reader
from tactile_graph_classifiers.reliefs.of_database import learned_of
from tactile_graph_sources.writers.write_npz import write_npz

Values = NDArray[np.float64]
Frames = dict[str, list[Frame]]
WAYS = ("identify-any", "identify-reliefs")
LOST = (0.01, 0.025, 0.036, 0.05, 0.1)
BEYOND = float(np.nextafter(1.0, 2.0))


class Answers(NamedTuple):
    """What a pipeline said of presses: distances over the limit, and whether the nearest is right.

    Parameters
    ----------
    known, right : ndarray, shape (n,)
    strangers, foreign : ndarray
    """

    known: Values
    right: NDArray[np.bool_]
    strangers: Values
    foreign: Values

    def shares(self) -> list[float]:
        """Return shares named right, nearest right, lost, strangers and foreign found."""
        accepted = self.known <= 1.0
        return [100.0 * float(share.mean()) for share in
                (accepted & self.right, self.right, ~accepted, self.strangers > 1.0,
                 self.foreign > 1.0)]  # fmt: skip

    def line(self) -> str:
        """Return the shares, and those of strangers at limits on the test presses."""
        named, nearest, lost, strangers, foreign = self.shares()
        limits = [np.quantile(self.known, 1.0 - lost) for lost in LOST]
        curve = " ".join(f"{100 * (self.strangers > limit).mean():.1f}" for limit in limits)
        told = ", ".join(f"{100 * share:g}" for share in LOST)
        return (f"named right {named:.1f}, nearest {nearest:.1f}, lost {lost:.1f}, strangers "
                f"{strangers:.1f}, foreign {foreign:.1f} %; strangers where {told} % are lost "
                f"{curve} %")  # fmt: skip


def by_name(frames: Iterable[Frame], things: Sequence[Thing], every: int = 1) -> Frames:
    """Return each thing's presses, every so many-th of them."""
    found: Frames = {thing.name: [] for thing in things}
    for frame in frames:
        found[str(frame.label)].append(frame)
    return {name: some[::every] for name, some in found.items()}


def learn(store: ObjectDatabase, to_learn: Frames) -> None:
    """Learn objects with their presses, as the command does."""
    describe = load("describe")
    read = Reader(Given(describe, "features", 0, image_of(describe, "features", ())))
    for name, frames in to_learn.items():
        found = read.readings(frames)
        first = found.rows[0]
        rows = np.array([one.values for one in found.rows])
        setting = Setting(first.names, first.quantity, describe.name)
        lesson = Lesson(name, "", rows, found.sources)
        store.learn(setting, [lesson], presses={name: found.presses})
    tell_apart(store)


def tell_apart(store: ObjectDatabase) -> None:
    """Keep how the objects are told apart best."""
    known = store.known()
    store.keep(choose(Examples.of(known)), known)


def identities(pipeline: Pipeline, frames: Iterable[Frame]) -> list[Identity]:
    """Return what a pipeline says of frames."""
    return [result["identity"] for result in pipeline.stream(list(frames))]


def over_limit(found: Iterable[Identity]) -> Values:
    """Return distances over the limit, beyond it of all that is unknown.

    What is near enough, and unknown for another reason (it reaches the pad's edge, and may be the
    runner-up too), counts as just beyond it.
    """
    ratios = ((one.distance / one.limit, one.known) for one in found if one.limit)
    return np.array([far if known else max(far, BEYOND) for far, known in ratios])


def answers(store: ObjectDatabase, tested: Frames, foreign: Frames, say: bool) -> list[Answers]:
    """Return what both pipelines say; objects are forgotten for it and learned no more."""
    recording = store.path.with_name("press.npz")
    write_npz(recording, next(iter(tested.values()))[:1])  # its source says what its frames are in

    def opened(way: str, path: Path) -> Pipeline:
        pipeline = load(way).with_source("recording", path=str(recording))
        return pipeline.with_settings({"identity.database": str(path)})

    known: dict[str, tuple[Values, NDArray[np.bool_], Values]] = {}
    for way in WAYS:
        pipeline, begin = opened(way, store.path), time.process_time()
        found = {name: identities(pipeline, frames) for name, frames in tested.items()}
        spent = time.process_time() - begin
        n = sum(map(len, found.values()))
        if say:
            print(f"  {way}: {1e3 * spent / n:.0f} ms a press", flush=True)
        far = over_limit(one for some in found.values() for one in some)
        right = np.array([one.nearest == name for name, some in found.items() for one in some])
        others = over_limit(identities(pipeline, (f for some in foreign.values() for f in some)))
        known[way] = (far, right, others)
    strangers: dict[str, list[Values]] = {way: [] for way in WAYS}
    whole = store.path.read_bytes()
    without = ObjectDatabase(store.path.with_name("without.sqlite"))
    for name, frames in tested.items():
        without.path.write_bytes(whole)
        without.forget(name)
        tell_apart(without)
        for way in WAYS:
            strangers[way].append(over_limit(identities(opened(way, without.path), frames)))
    return [Answers(known[way][0], known[way][1], np.concatenate(strangers[way]), known[way][2])
            for way in WAYS]  # fmt: skip


def tried(it: Instrument, seed: int, every: int, folder: Path) -> list[Answers]:
    """Return what both pipelines say on one pad and catalogue."""
    rng = np.random.default_rng([seed])
    pad = Pad(it, rng)
    things = catalogue(it, rng)
    to_learn = by_name(presses(pad, things), things)
    tested = by_name(presses(pad, things), things, every)
    others = catalogue(it, np.random.default_rng([seed, 1]), "foreign ")
    foreign = by_name(presses(pad, others), others, every)
    store = ObjectDatabase(folder / f"{it.rows}x{it.columns}-{seed}.sqlite")
    if not store.path.exists() or store.reliefs()[2]:
        store.path.unlink(missing_ok=True)
        learn(store, to_learn)
        begin = time.process_time()
        known, images = store.presses()
        found = learned_of(known, images, lambda text: print(f"  {text}", flush=True))
        store.keep_reliefs(found.kept(), known)
        print(f"  learned in {time.process_time() - begin:.0f} s, "
              f"{store.path.stat().st_size >> 20} MB", flush=True)  # fmt: skip
    return answers(store, tested, foreign, say=True)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--pads", nargs="*", choices=INSTRUMENTS, default=[*INSTRUMENTS])
    parser.add_argument("--seeds", nargs="*", type=int, default=[51])
    parser.add_argument("--every", type=int, default=1, help="name every so many-th press only")
    parser.add_argument("--databases", type=Path, metavar="FOLDER",
                        help="where databases stay, and are taken from by a later run")  # fmt: skip
    asked = parser.parse_args(arguments)
    warm_up()
    shares: dict[str, list[list[float]]] = {way: [] for way in WAYS}
    for name in asked.pads:
        for seed in asked.seeds:
            print(f"{name}, catalogue {seed}", flush=True)
            with tempfile.TemporaryDirectory() as folder:
                where = asked.databases or Path(folder)
                both = tried(INSTRUMENTS[name], seed, asked.every, where)
            for way, found in zip(WAYS, both, strict=True):
                shares[way].append(found.shares())
                print(f"  {way}: {found.line()}", flush=True)
    for way, some in shares.items():
        named, nearest, lost, strangers, foreign = np.mean(some, axis=0)
        print(f"mean, {way}: named right {named:.1f}, nearest {nearest:.1f}, lost {lost:.1f}, "
              f"strangers {strangers:.1f}, foreign {foreign:.1f} %")  # fmt: skip


if __name__ == "__main__":
    main()
