"""Write the images and masks of nodes as stacks, an HDF5 file or a Zarr store, whole at the end.

``index`` (int64) and ``time_s`` (float64, NaN where there is none) have a row a frame. Each node
is a group of ``outcome`` (0 for a value, 1 skipped, 2 failed), likewise, and ``values``, shape
(frames, rows, columns): of images float64, NaN where a cell is invalid and in every cell of a
frame without a value; of masks uint8, 1 on, 0 off, 255 where there is no value. A node that never
had one has no ``values``. Quantity, unit, pitch and place are attributes of ``values``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from tactile_graph.api.result import Result
from tactile_graph.cli.output.array_files import Cells, Container, Growing, Hdf5, Zarr
from tactile_graph.cli.output.older import stays, unfinished_by
from tactile_graph.draw.display import view
from tactile_graph.engine.outcomes.outcome import NO_VALUE, Failed
from tactile_graph.errors import UsageError, one_of
from tactile_graph.exporter import Export, Exporter, Writer
from tactile_graph.files import check_target, left_of, said, uninterrupted
from tactile_graph.part_files import part_of, put_in_place, remove
from tactile_graph.pipeline.graph import FRAME, Graph
from tactile_graph.pipeline.wiring import arms
from tactile_graph.quantities import unit_of
from tactile_graph.wires import Frame, Image, Mask

OUTCOMES = ("value", "skipped", "failed")
NO_MASK = 255
MOST_A_CHUNK, CHUNK_BYTES, SMALL_CHUNK = 256, 1 << 20, 4096
_ABOUT = {"format": "tactile-graph node images", "version": 1}


def check_nodes(pipeline: Graph, asked: Sequence[str]) -> None:
    """Refuse nodes that never come out as an image or a mask, before the work.

    Raises
    ------
    UsageError
        Naming those that do.
    """
    for name in asked:
        if not _is_gridded(pipeline.type_of(pipeline.outputs.get(name) or pipeline.ref(name))):
            fit = [FRAME, *(n for n, kind in pipeline.types.items() if _is_gridded(kind))]
            raise UsageError(
                f"{name!r} is no image and no mask, of which alone stacks are made; choose with "
                f"--only among {one_of(dict.fromkeys(fit))}"
            )


def check_store(option: str, output: str) -> None:
    """Refuse a folder in place of which no store should stand, before the work.

    Raises
    ------
    UsageError
    """
    path = Path(output)
    if not path.is_dir():
        check_target(option, output)
    elif not _is_ours(path):
        raise UsageError(f"{option} {output}: is a folder and no store of images; name another")


def _is_ours(path: Path) -> bool:
    try:
        return str(_ABOUT["format"]) in (path / "zarr.json").read_text(encoding="utf-8")
    except OSError:
        return False


def _is_gridded(kind: Any) -> bool:
    return all(
        arm in (Frame, Image, Mask) or not {Image, Mask}.isdisjoint(getattr(arm, "provides", {}))
        for arm in arms(kind)
        if arm is not type(None)
    )


class ImageStore:
    """Stacks under way, beside their name; they stand under it when it is closed, whole.

    Parameters
    ----------
    output : str
        Path.
    form : str
        ``hdf5`` or ``zarr``.
    pipeline : Graph
    asked : sequence of str
        Nodes, outputs or ``node.field``.

    Raises
    ------
    UsageError
        If the library is not installed, or the file cannot be made.
    """

    keeps = False
    """Whether what is written stays where a run ends early: it stands when it is closed."""

    def __init__(self, output: str, form: str, pipeline: Graph, asked: Sequence[str]) -> None:
        if output == "-":
            raise UsageError("-o -: images cannot go to stdout; give a name")
        self.output = output
        self.broken = False
        """Whether frames could not be written; then nothing is left."""
        self.lies_at = output
        """Where they stand when it is closed."""
        self.stays = ""
        """What is to be said of older ones that stay."""
        target = Path(os.path.realpath(output))
        self._part = part_of(target)
        self._target = target
        with self._whole():
            made = Hdf5 if form == "hdf5" else Zarr
            self._container: Container = made(self._part, {**_ABOUT, "pipeline": pipeline.name})
            self._index = self._small("index", "int64", -1, {})
            self._time = self._small("time_s", "float64", np.nan, {"unit": "s"})
            told = {"meaning": ", ".join(f"{i} {word}" for i, word in enumerate(OUTCOMES))}
            self._stacks = {
                name: _Stack(name, self._small(f"{name}/outcome", "uint8", 0, told), pipeline)
                for name in asked
            }

    def _small(self, name: str, dtype: str, fill: float, about: dict[str, Any]) -> Growing:
        array = self._container.array(name, (), Cells(dtype, fill, SMALL_CHUNK), about)
        return Growing(array, SMALL_CHUNK)

    def write(self, result: Result) -> None:
        """Take in a frame.

        Raises
        ------
        UsageError
            If a node's grid is not the one it had before, or the frame cannot be written.
        """
        values = {name: _gridded(result.outcome(name)) for name in self._stacks}
        for name, stack in self._stacks.items():
            stack.check(values[name], result.frame.index, self.output)
        with self._whole():
            for name, stack in self._stacks.items():
                stack.add(values[name], result.outcome(name), self._container)
            self._index.add(result.frame.index)
            time_s = result.frame.time_s
            self._time.add(np.nan if time_s is None else time_s)
            self._container.check()

    def close(self) -> None:
        """Write what is left, and give the stacks their name."""
        if self.broken:
            return
        with self._whole():
            self._index.flush()
            self._time.flush()
            for stack in self._stacks.values():
                stack.flush()
            self._container.close()
            put_in_place(self._part, self._target, self.lies_at)

    def close_early(self) -> None:
        """Write what is left; older stacks stay, and these get a name beside them."""
        if beside := unfinished_by(self.output):
            self._target, self.lies_at, self.stays = Path(beside), beside, stays(self.output)
        self.close()

    @contextmanager
    def _whole(self) -> Iterator[None]:
        """Leave nothing behind where anything is raised."""
        try:
            with uninterrupted(), said(self.output, left_of(Path(self.output))):
                yield
        except BaseException:
            self.broken = True
            with suppress(Exception):  # what it raises is of a file that goes
                self._container.close()
            remove(self._part)
            raise


def _gridded(outcome: Any) -> Image | Mask | None:
    """Return the image or mask of an outcome, None where it has no value."""
    found = None if outcome.__class__ in NO_VALUE else outcome
    if found is not None and not isinstance(found, Image | Mask):
        found = view(found, Image) or view(found, Mask)
    return found if isinstance(found, Image | Mask) else None


class _Place(NamedTuple):
    """What all images of a stack have in common."""

    kind: str
    shape: tuple[int, int]
    pitch_cm: tuple[float, float]
    origin_cm: tuple[float, float]
    quantity: str

    @classmethod
    def of(cls, value: Image | Mask) -> _Place:
        image = isinstance(value, Image)
        quantity = value.quantity if isinstance(value, Image) else "binary"
        kind = "image" if image else "mask"
        return cls(kind, value.shape, value.pitch_cm, value.origin_cm, quantity)

    def __str__(self) -> str:
        (rows, columns), (x, y) = self.shape, self.pitch_cm
        left, top = self.origin_cm
        what = f"{rows} x {columns} cells of {x:g} x {y:g} cm from ({left:g}, {top:g}) cm on"
        return f"{self.kind} of {what}, {self.quantity}"


class _Stack:
    """One node's images."""

    def __init__(self, name: str, outcomes: Growing, pipeline: Graph) -> None:
        self.name = name
        node = pipeline.nodes.get((pipeline.outputs.get(name) or pipeline.ref(name)).node)
        self.about = {"node": name, "step": "" if node is None else node.what}
        self.place: _Place | None = None
        self._outcomes = outcomes
        self._values: Growing | None = None
        self._n = 0

    def check(self, value: Image | Mask | None, index: int, output: str) -> None:
        if value is not None and self.place not in (None, _Place.of(value)):
            raise UsageError(
                f"{output}: {self.name!r} is in frame {index} another {_Place.of(value)}; before "
                f"it was an {self.place}. A stack has one grid: ask with --only for another node"
            )

    def add(self, value: Image | Mask | None, outcome: Any, container: Container) -> None:
        if self.place is None and value is not None:
            self._begin(value, container)
        if self._values is not None and self.place is not None:
            self._values.add(self._absent if value is None else _cells(value))
        self._n += 1
        missing = 0 if value is not None else 2 if outcome.__class__ is Failed else 1
        self._outcomes.add(missing)

    def _begin(self, value: Image | Mask, container: Container) -> None:
        self.place = place = _Place.of(value)
        mask = place.kind == "mask"
        cells = place.shape[0] * place.shape[1] * (1 if mask else 8)
        chunk = min(max(CHUNK_BYTES // max(cells, 1), 1), MOST_A_CHUNK)
        kept = Cells("uint8", NO_MASK, chunk) if mask else Cells("float64", np.nan, chunk)
        unit = unit_of(place.quantity)
        about = {**self.about, **place._asdict(), "unit": unit, "axes": "frame, row, column"}
        del about["shape"]
        array = container.array(f"{self.name}/values", place.shape, kept, about)
        self._values = Growing(array, chunk, self._n)
        self._absent = np.full(place.shape, kept.fill, kept.dtype)

    def flush(self) -> None:
        self._outcomes.flush()
        if self._values is not None:
            self._values.flush()


def _cells(value: Image | Mask) -> Any:
    if isinstance(value, Mask):
        return value.values.astype(np.uint8)
    return np.asarray(value.values if value.valid is None else value.filled(np.nan), np.float64)


def _store(form: str) -> Callable[[Export], Writer]:
    def opened(export: Export) -> Writer:
        check_nodes(export.pipeline, export.asked)
        return ImageStore(export.name, form, export.pipeline, export.asked)

    return opened


def _check(name: str) -> None:
    if name != "-":
        check_store("-o", name)


HDF5 = Exporter("HDF5", "images", _store("hdf5"))
ZARR = Exporter("a Zarr store", "images", _store("zarr"), _check)
