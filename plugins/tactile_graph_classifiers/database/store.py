"""``ObjectDatabase``: objects, their readings and statistics in one SQLite file."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tactile_graph.errors import DataError, UsageError, did_you_mean, one_of
from tactile_graph_classifiers.database.choice import Choice
from tactile_graph_classifiers.database.connection import reading, writing
from tactile_graph_classifiers.database.known import Known, KnownObject
from tactile_graph_classifiers.database.names import (
    is_of_recording,
    known_as,
    plain_name,
    recording_of,
)
from tactile_graph_classifiers.database.relief_rows import (
    Kept,
    Press,
    add_presses,
    keep,
    kept_in,
    presses_of,
    rename_presses,
)
from tactile_graph_classifiers.database.rows import (
    Contents,
    Lesson,
    Setting,
    StoredObject,
    add,
    contents,
    keep_readings,
    rename,
    settle,
)
from tactile_graph_classifiers.distances.identity import UNKNOWN

DEFAULT_PATH = "tactile-objects.sqlite"


class Summary(NamedTuple):
    """An object in short."""

    name: str
    shape: str
    n_readings: int
    learned_at: str


class ObjectDatabase:
    """Objects by name, in a file; made when the first one is learned.

    Parameters
    ----------
    path : str or Path
    timeout_s : float
        How long to wait for another program that is writing.
    """

    def __init__(self, path: str | Path = DEFAULT_PATH, timeout_s: float = 5.0) -> None:
        self.path = Path(path)
        self.timeout_s = timeout_s

    # -- learning and forgetting -------------------------------------------------------------

    def learn(
        self,
        setting: Setting,
        lessons: Iterable[Lesson],
        new: bool = False,
        presses: Mapping[str, Sequence[Press]] | None = None,
    ) -> int:
        """Add readings to objects, all of them or none.

        Parameters
        ----------
        setting : Setting
        lessons : iterable of Lesson
        new : bool
            Whether none of the objects may be there already.
        presses : mapping, optional
            By a lesson's name the images of its readings, to learn reliefs of.

        Returns
        -------
        int
            How many of them their object had before, to the last digit, whatever file they are of.

        Raises
        ------
        UsageError
            If a name cannot be one, an object is there already, or the readings measure other
            features or another quantity than those in the database, or of another pitch.
        DataError
            If the file cannot be written or is no object database.
        """
        checked = [_checked(lesson, setting) for lesson in lessons]
        with writing(self.path, self.timeout_s, create=True) as connection:
            there = contents(connection, str(self.path))
            objects = {it.known.name: it.known for it in there.objects}
            checked = [it._replace(name=known_as(it.name, objects) or it.name) for it in checked]
            self._same_setting(there.setting, setting)
            if new:
                self._none_there([lesson.name for lesson in checked], objects)
            if there.setting.features:
                instrument = there.setting.instrument or setting.instrument
                setting = there.setting._replace(instrument=instrument)
            settle(connection, setting, None)  # features first: values refer to them
            n_again = sum(_again(lesson, objects.get(lesson.name)) for lesson in checked)
            for lesson in checked:
                objects[lesson.name] = add(connection, lesson, objects.get(lesson.name))
                if presses:
                    of = {plain_name(name): some for name, some in presses.items()}
                    add_presses(connection, lesson.name, of[plain_name(lesson.name)])
            settle(connection, setting, None)
        return n_again

    def keep(self, choice: Choice, of: Known) -> None:
        """Keep how the objects are told apart best, unless they have changed since.

        Parameters
        ----------
        choice : Choice
        of : Known
            What the choice was made for.
        """
        with writing(self.path, self.timeout_s) as connection:
            there = contents(connection, str(self.path))
            if self._known(there).same_readings(of):
                settle(connection, there.setting, choice)

    def keep_reliefs(self, reliefs: Kept, of: Known) -> None:
        """Keep learned reliefs, unless the objects have changed since.

        Parameters
        ----------
        reliefs : Kept
        of : Known
            Whose presses they were learned of.

        Raises
        ------
        DataError
            If the objects are others by now.
        """
        with writing(self.path, self.timeout_s) as connection:
            if not self._known(contents(connection, str(self.path))).same_readings(of):
                raise DataError(
                    str(self.path), "was changed while reliefs were learned; learn them again"
                )
            keep(connection, reliefs)

    def forget(self, name: str, recording: str = "") -> int:
        """Remove an object with all its readings; return how many these were.

        Parameters
        ----------
        name : str
        recording : str
            Only its readings of this recording, named as when they were learned, are removed; the
            object too if it has no others.

        Raises
        ------
        UsageError
            If there is none of that name, or no reading of the recording.
        """
        with writing(self.path, self.timeout_s) as connection:
            there = contents(connection, str(self.path))
            it = self._one(there, name)
            kept = [k for k, source in enumerate(it.known.sources)
                    if recording and not is_of_recording(source, recording)]  # fmt: skip
            n_gone = it.known.statistics.n - len(kept)
            if not n_gone:
                raise self._unknown_recording(it.known, recording)
            if kept:
                keep_readings(connection, it, kept)
            else:
                connection.execute("DELETE FROM objects WHERE id = ?", (it.number,))
            settle(connection, there.setting, None)
            return n_gone

    def rename(self, name: str, new: str, merge: bool = False) -> int:
        """Give an object another name, its reliefs with it; return how many readings it has then.

        Parameters
        ----------
        name, new : str
        merge : bool
            Whether the readings may join those of an object that has the new name already.

        Raises
        ------
        UsageError
            If there is none of that name, the new one cannot be one, or is another object's.
        """
        new = _checked_name(new)
        with writing(self.path, self.timeout_s) as connection:
            there = contents(connection, str(self.path))
            it = self._one(there, name)
            objects = {one.known.name: one.known for one in there.objects}
            other = known_as(new, [one for one in objects if one != it.known.name])
            if other is not None and not merge:
                raise UsageError(
                    f"{self.path}: {new!r} is there already, with {objects[other].statistics.n}"
                    " readings; name another, or let the readings join those with --merge"
                )
            if other is None:
                kept, _ = kept_in(connection, str(self.path))
                rename_presses(connection, it.known.name, new, str(self.path))
                rename(connection, it, new)
                if kept.pad:
                    same = {new if k == it.known.name else k: v for k, v in kept.objects.items()}
                    keep(connection, Kept(kept.pad, same))
                settle(connection, there.setting, there.choice)
                return it.known.statistics.n
            presses = presses_of(connection, it.known.name, str(self.path))
            lesson = Lesson(
                other, objects[other].shape or it.known.shape, it.known.readings, it.known.sources
            )
            joined = add(connection, lesson, objects[other])
            if any(presses):
                add_presses(connection, other, presses)
            connection.execute("DELETE FROM objects WHERE id = ?", (it.number,))
            settle(connection, there.setting, None)
            return joined.statistics.n

    def _one(self, there: Contents, name: str) -> StoredObject:
        objects = {it.known.name: it for it in there.objects}
        found = known_as(name, objects)
        if found is None:
            raise self.unknown(name, objects)
        return objects[found]

    def _unknown_recording(self, it: KnownObject, recording: str) -> UsageError:
        names = list(dict.fromkeys(map(recording_of, it.sources)))
        hint = did_you_mean(recording, names) or f"; they are of: {one_of(names, 30)}"
        return UsageError(f"{self.path}: no reading of {it.name!r} is of {recording!r}{hint}")

    def unknown(self, name: str, known: Iterable[str]) -> UsageError:
        """Return the error that there is no object of that name.

        Parameters
        ----------
        name : str
        known : iterable of str
        """
        names = list(known)
        hint = did_you_mean(name, names) or f"; there are: {one_of(names, 30)}"
        return UsageError(f"{self.path}: no object named {name!r}{hint}")

    def _same_setting(self, there: Setting, setting: Setting) -> None:
        if not there.features:
            return
        for what in ("features", "quantity"):
            got, had = getattr(setting, what), getattr(there, what)
            if got != had:
                raise UsageError(
                    f"{self.path}: {_difference(what, got, had)}; readings that compare come from"
                    f" one pipeline (here {there.pipeline or 'not named'}), others go into a"
                    " database of their own"
                )

        was, new = there.instrument, setting.instrument
        if was is not None and new is not None and not was.same_pitch(new):
            raise UsageError(
                f"{self.path}: its readings are of {was}, the new ones of {new}; those of another"
                " instrument go into a database of their own"
            )

    def _none_there(self, names: Sequence[str], there: Container[str]) -> None:
        clash = [name for name in names if name in there or names.count(name) > 1]
        if clash:
            raise UsageError(
                f"{self.path}: there already: {one_of(clash)}; forget them first, or import into"
                " another database"
            )

    # -- looking -----------------------------------------------------------------------------

    def summaries(self) -> list[Summary]:
        """Return the objects in short, in the order they were first learned."""
        with reading(self.path, self.timeout_s) as connection:
            found = contents(connection, str(self.path))
        return [
            Summary(it.known.name, it.known.shape, it.known.statistics.n, it.learned_at)
            for it in found.objects
        ]

    def known(self) -> Known:
        """Return everything: objects, readings and statistics.

        Raises
        ------
        DataError
            If there is no such database, or none that can be read.
        """
        with reading(self.path, self.timeout_s) as connection:
            return self._known(contents(connection, str(self.path)))

    def presses(self) -> tuple[Known, list[list[Press | None]]]:
        """Return everything, and the image of each reading of each object where it was kept.

        Raises
        ------
        DataError
            As `known`, or if an image is not as it was written.
        """
        with reading(self.path, self.timeout_s) as connection:
            known = self._known(contents(connection, str(self.path)))
            return known, [presses_of(connection, it, str(self.path)) for it in known.names]

    def reliefs(self) -> tuple[Known, Kept, list[str]]:
        """Return everything, the reliefs, and the objects that have none of just their readings.

        Raises
        ------
        DataError
            As `known`, or if a relief is not as it was written.
        """
        with reading(self.path, self.timeout_s) as connection:
            known = self._known(contents(connection, str(self.path)))
            return known, *kept_in(connection, str(self.path))

    def _known(self, found: Contents) -> Known:
        setting, objects = found.setting, tuple(it.known for it in found.objects)
        return Known(
            str(self.path), *setting[:2], objects, setting.pipeline, found.choice,
            setting.instrument,
        )  # fmt: skip


def _again(lesson: Lesson, old: KnownObject | None) -> int:
    """Return how many readings of a lesson an object has already, to the last digit."""
    if old is None:
        return 0
    there = set(map(tuple, old.readings.tolist()))
    return sum(tuple(values) in there for values in lesson.readings.tolist())


def _checked_name(text: str) -> str:
    name = plain_name(text)
    if not name or name == UNKNOWN or not name.isprintable():
        raise UsageError(
            f"an object's name must be printable text other than {UNKNOWN!r}, got {text!r}"
        )
    return name


def _checked(lesson: Lesson, setting: Setting) -> Lesson:
    name = _checked_name(lesson.name)
    readings = np.asarray(lesson.readings, dtype=np.float64)
    if readings.ndim != 2 or readings.shape[1] != len(setting.features):
        raise UsageError(
            f"{name}: readings must be of shape (n, {len(setting.features)}), got {readings.shape}"
        )
    if not len(readings):
        raise UsageError(f"{name}: there is no reading to learn")
    if not np.isfinite(readings).all():
        raise DataError(name, "a reading holds a value that is no finite number")
    if len(lesson.sources) != len(readings):
        raise UsageError(f"{name}: {len(readings)} readings but {len(lesson.sources)} sources")
    return Lesson(name, lesson.shape, readings, lesson.sources)


def _difference(what: str, got: str | tuple[str, ...], had: str | tuple[str, ...]) -> str:
    if isinstance(got, str) or isinstance(had, str):
        return f"its readings are in {had or 'no unit'}, the new ones in {got or 'no unit'}"
    lacking, extra = sorted(set(had) - set(got)), sorted(set(got) - set(had))
    if not lacking and not extra:
        return "the new readings hold the features in another order"
    parts = [f"lack {one_of(lacking)}"] if lacking else []
    parts += [f"have {one_of(extra)} besides"] if extra else []
    return f"the new readings {' and '.join(parts)}"
