"""``Pad``: a pad's physics from load to volts and back, read from a YAML file.

Nothing here is random except what is asked for with a generator: a likelihood and a simulator
share `Pad.forward`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from tactile_graph.errors import UsageError
from tactile_graph.pipeline.document import Document, read_document, text_of_file
from tactile_graph.plugins.registry import installed
from tactile_graph.wires import Image
from tactile_graph_pads.circuits import Divider, Feedback, Floating
from tactile_graph_pads.contact import Contact
from tactile_graph_pads.defects import Built, Defects
from tactile_graph_pads.geometry import Geometry
from tactile_graph_pads.law import ForceLaw
from tactile_graph_pads.learned import Learned
from tactile_graph_pads.records import inline, read_record
from tactile_graph_pads.scan import Converter, Scan
from tactile_graph_pads.unevenness import Unevenness

Array = NDArray[np.float64]


class Loads(NamedTuple):
    """Loads found behind a frame of volts; 0 where ``valid`` is False."""

    load_g: Array
    valid: NDArray[np.bool_]
    residual: float


@dataclass(frozen=True)
class Pad:
    """Everything about a pad that its YAML file says; the defaults are the thesis' pad, even.

    Parameters
    ----------
    about : str
        One line for people.
    geometry : Geometry
    law : ForceLaw
    circuit : Divider, Floating or Feedback
        How the elements are read: what drives the rows, and what the columns end in.
    converter : Converter
    scan : Scan
    contact : Contact
    unevenness : Unevenness
    defects : Defects
    learned : Learned, optional
        What recordings have taught; None for a pad that was described by hand alone.
    """

    about: str = ""
    geometry: Geometry = field(default_factory=Geometry)
    law: ForceLaw = field(default_factory=ForceLaw)
    circuit: Annotated[Divider | Floating | Feedback, Field(discriminator="kind")] = field(
        default_factory=Divider
    )
    converter: Converter = field(default_factory=Converter)
    scan: Scan = field(default_factory=Scan)
    contact: Contact = field(default_factory=Contact)
    unevenness: Unevenness = field(default_factory=Unevenness)
    defects: Defects = field(default_factory=Defects)
    learned: Learned | None = None
    __pydantic_config__: ClassVar[dict[str, str]] = {"extra": "forbid"}

    def __post_init__(self) -> None:
        self._check_lines()
        self._check_elements()

    def _check_lines(self) -> None:
        geometry, defects = self.geometry, self.defects
        for name, limit in (("row", geometry.rows), ("column", geometry.columns)):
            gains = getattr(defects, f"{name}_gain")
            if gains and len(gains) != limit:
                raise ValueError(
                    f"defects.{name}_gain: needs one factor for each of {limit} {name}s, "
                    f"got {len(gains)}"
                )
            lines = (*getattr(defects, f"dead_{name}s"), *getattr(defects, f"noisy_{name}s", ()))
            for line in lines:
                if line >= limit:
                    raise ValueError(f"defects: {name} {line} is not on the pad, 0 to {limit - 1}")

    def _check_elements(self) -> None:
        for where, things in (
            ("defects.hot", self.defects.hot),
            ("contact.sand", self.contact.sand),
            ("unevenness.bumps", self.unevenness.bumps),
        ):
            for thing in things:
                self._check_element(where, thing.row, thing.column)
        for row, column in self.defects.dead_elements:
            self._check_element("defects.dead_elements", row, column)

    def _check_element(self, where: str, row: int, column: int) -> None:
        rows, columns = self.geometry.shape
        if row >= rows or column >= columns:
            raise ValueError(
                f"{where}: element ({row}, {column}) is not on the pad; rows go from 0 to "
                f"{rows - 1}, columns from 0 to {columns - 1}"
            )

    def built(self, rng: np.random.Generator | None = None) -> Built:
        """Return one pad as built; without ``rng`` its random faults stay at their middle."""
        return self.defects.built(self.geometry, rng)

    def conductance_s(self, load_g: Array, built: Built | None = None) -> Array:
        """Return the conductance of each element under ``load_g``, shape (rows, columns)."""
        built = self._nominal if built is None else built
        siemens = self.law.conductance_s(load_g + built.preload_g)
        siemens *= built.gain
        siemens += built.leak_s
        return siemens

    def volts_of(self, siemens: Array) -> Array:
        """Return the voltage at the converter for each element, before noise and rounding."""
        ratio = self.circuit.ratio(siemens)
        ratio *= self.circuit.supply_v
        return ratio

    def forward(self, load_g: Array, built: Built | None = None) -> Array:
        """Return the volts that loads measure as, shape (rows, columns); nothing random.

        Parameters
        ----------
        load_g : ndarray of float64, shape (rows, columns)
            Grams on each element.
        built : Built, optional
            The pad as built; its nominal state by default.

        Notes
        -----
        Volts are positive, 0 to the supply: the thesis inverts its supply so that voltage rises
        with load (section 2.2.1).
        """
        return self.volts_of(self.conductance_s(load_g, built))

    def backward(self, volts: Array, start_s: Array | None = None) -> Loads:
        """Return the loads behind a frame of volts: the circuit's inverse, then the law's.

        Parameters
        ----------
        volts : ndarray of float64, shape (rows, columns)
        start_s : ndarray of float64, optional
            Conductances to start from where the circuit's inverse iterates.

        Notes
        -----
        Known leaks and gains are taken off, a uniform preload too. An element is invalid where
        the circuit calls its data impossible, where it is dead, or where it is saturated.
        """
        found = self.circuit.inverse(volts / self.circuit.supply_v, start_s)
        if self.defects == _NO_DEFECTS:
            siemens, valid = found.siemens, found.valid
        else:
            siemens, valid = _repaired(found.siemens, found.valid, self._nominal)
        load = self.law.load_of(siemens)
        if load.max() == np.inf:
            valid = valid & np.isfinite(load)
            load[~valid] = 0.0
        if self.defects.preload_g > 0.0:
            load = np.maximum(load - self._nominal.preload_g, 0.0)
        return Loads(load, valid, found.residual)

    @property
    def noise_v(self) -> float:
        """Standard deviation of a frame's voltage, by noise and the converter's rounding."""
        step_v = 0.0 if self.converter.bits is None else self.converter.step_v
        return math.hypot(
            self.scan.noise_v / math.sqrt(self.scan.samples), step_v / math.sqrt(12.0)
        )

    @cached_property
    def _nominal(self) -> Built:
        built = self.defects.built(self.geometry)
        for array in built:
            array.setflags(write=False)
        return built

    def image(self, values: Array, quantity: str = "volt") -> Image:
        """Return values of all elements as an image in pad coordinates."""
        pitch = self.geometry.pitch_cm
        return Image(values, (pitch, pitch), self.geometry.origin_cm, quantity)


_NO_DEFECTS = Defects()


def _repaired(
    siemens: Array, valid: NDArray[np.bool_], built: Built
) -> tuple[Array, NDArray[np.bool_]]:
    """Return conductances with known leaks and gains taken off, and which can be trusted."""
    valid = valid & (built.gain > 0.0)
    gain = np.where(valid, built.gain, 1.0)
    return np.where(valid, (siemens - built.leak_s) / gain, 0.0), valid


def load_pad(pad: str | Path | Mapping[str, Any]) -> Pad:
    """Return a pad by its name among the plugins' pads, by its YAML file, or from a mapping.

    Parameters
    ----------
    pad : str, Path or mapping
        A name has no path separator and no ending.

    Raises
    ------
    UsageError
        If no such pad or file is there.
    RecordError
        With everything wrong with the file, by line and column.
    """
    if isinstance(pad, Mapping):
        return read_record(inline(pad, "pad"), Pad, "a pad")
    path = path_of(pad)
    found = read_record(read_file(path, "pad"), Pad, "a pad")
    if found.learned is None:
        return found
    return replace(found, learned=found.learned.beside(path.parent))


def path_of(pad: str | Path) -> Path:
    """Return the file of a pad; errors as of `load_pad`, if there is no such pad."""
    path = Path(pad)
    return path if path.suffix in (".yaml", ".yml") else installed().path("pads", str(pad))


def learned_of(pad: str | Path | Mapping[str, Any]) -> Learned:
    """Return what recordings have taught about a pad.

    Parameters
    ----------
    pad : str, Path or mapping
        As `load_pad` takes it.

    Raises
    ------
    UsageError
        If no recordings have.
    """
    learned = load_pad(pad).learned
    if learned is None:
        named = f"pad {pad!r}" if isinstance(pad, str | Path) else "the pad"
        raise UsageError(
            f"{named} was not learned from recordings: it has no section 'learned'; "
            "tactile-graph learn-pad makes such a file"
        )
    return learned


def read_file(path: Path, what: str) -> Document:
    """Return a YAML file as a document.

    Raises
    ------
    UsageError
        If it cannot be read.
    """
    try:
        text = text_of_file(path)
    except OSError as error:
        why = error.strerror or error
        raise UsageError(f"{path}: this {what} file cannot be read: {why}") from error
    except UnicodeDecodeError as error:
        raise UsageError(f"{path}: this {what} file cannot be read: {error}") from error
    return read_document(text, str(path))
