"""The ``simulate`` source: objects on a pad whose physics is known, with the truth."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from annotated_types import Ge, Le
from numpy.typing import NDArray

from tactile_graph.steps import Quantity, Report
from tactile_graph.wires import Frame, Shape, TrueObject
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import Pad, load_pad
from tactile_graph_pads.unevenness import Fields
from tactile_graph_sources.placement import check_places, place
from tactile_graph_sources.scene import Scene, Thing, load_scene

Array = NDArray[np.float64]


def simulate(
    *,
    scene: str | dict[str, Any] = "discs",
    pad: str | dict[str, Any] = "thesis",
    frames: Annotated[int, Ge(0)] = 20,
    sigma: Annotated[float, Ge(0)] | None = None,
    voids: Annotated[float, Ge(0), Le(1)] | None = None,
    output: Literal["volt", "counts"] = "volt",
    rng: np.random.Generator,
    report: Report,
) -> Iterator[Annotated[Frame, Quantity("volt", "counts", of="output")]]:
    """Give frames of objects put down on a simulated pad, each with its truth.

    Load is shared by exact coverage over uneven elements, turned into conductance by the force
    law, read through the pad's circuit, sampled with noise and converted (thesis chapter 2).

    Parameters
    ----------
    scene : str or mapping
        Name of a scene, a YAML file, or the scene itself: objects with shape, weight, size,
        place and angle.
    pad : str or mapping
        Name of a pad, a YAML file, or the pad itself.
    frames : int
        How many frames to give.
    sigma : float, optional
        Lognormal unevenness of the elements, instead of the pad's own.
    voids : float, optional
        Share of elements that make no contact, instead of the pad's own.
    output : "volt" or "counts"
        Volts, or the converter's mean counts.
    rng : numpy.random.Generator
        Everything random comes from it: same seed, same bits.
    report : Report
        Told how many frames to expect.
    """
    laid, under = load_scene(scene), load_pad(pad)
    check_places(laid, under.geometry)
    bench = _Bench(_overridden(under, laid, sigma, voids), laid, rng)
    report.expect(frames)
    seconds = bench.pad.scan.frame_s(bench.pad.geometry.rows * bench.pad.geometry.columns)
    for index in range(frames):
        if index % laid.hold == 0:
            bench.put_down(index // laid.hold)
        counts = bench.read()
        values = counts if output == "counts" else bench.pad.converter.volts(counts)
        image = bench.pad.image(values, output)
        yield Frame(image, index, index * seconds, bench.truth)


def check_simulate(*, scene: str | dict[str, Any], pad: str | dict[str, Any], **_: Any) -> None:
    """Refuse a scene that cannot lie on the pad, as the source itself does."""
    check_places(load_scene(scene), load_pad(pad).geometry)


simulate.check = check_simulate  # type: ignore[attr-defined]


def _overridden(pad: Pad, scene: Scene, sigma: float | None, voids: float | None) -> Pad:
    """Return the pad with what the scene and the settings say instead of its file."""
    uneven = replace(
        pad.unevenness,
        sigma=pad.unevenness.sigma if sigma is None else sigma,
        voids=pad.unevenness.voids if voids is None else voids,
    )
    contact = replace(
        pad.contact,
        foam_cm=pad.contact.foam_cm if scene.foam_cm is None else scene.foam_cm,
        sand=(*pad.contact.sand, *scene.sand),
    )
    return replace(pad, unevenness=uneven, contact=contact)


class _Bench:
    """A pad as built, with what lies on it just now."""

    def __init__(self, pad: Pad, scene: Scene, rng: np.random.Generator) -> None:
        self.pad, self.scene, self.rng = pad, scene, rng
        self.built = pad.built(rng)
        self.fields: Fields = pad.unevenness.draw(pad.geometry, rng)
        self.truth: tuple[TrueObject, ...] = ()
        self.siemens: Array = np.zeros(pad.geometry.shape)

    def put_down(self, placement: int) -> None:
        """Clear the pad and put the objects of a placement down."""
        pad, things = self.pad, self.scene.group(placement)
        shapes = place(things, pad.geometry, self.scene.apart_cm, self.rng)
        gains = pad.unevenness.gains(self.fields, pad.unevenness.draw(pad.geometry, self.rng))
        touching = [thing.touching(shape) for thing, shape in zip(things, shapes, strict=True)]
        load = np.zeros(pad.geometry.shape)
        for thing, shape in zip(things, touching, strict=True):
            offset = _pressure_offset(thing, pad.contact.lean_cm, self.rng)
            load += pad.contact.load_g(shape, thing.total_g, pad.geometry, gains, offset)
        if pad.unevenness.strays > 0.0:
            covered = sum((coverage_cm2(s, pad.geometry) for s in touching), np.zeros(load.shape))
            load += pad.unevenness.strays_g(covered, self.rng)
        self.truth = tuple(_true(t, s) for t, s in zip(things, shapes, strict=True))
        self.siemens = pad.conductance_s(load, self.built)

    def read(self) -> Array:
        """Return the mean counts of one scan of what lies there."""
        pad, siemens = self.pad, self.siemens
        if pad.law.repeatability > 0.0:
            scatter = self.rng.standard_normal(siemens.shape)
            siemens = siemens * np.exp(pad.law.repeatability * scatter)
        volts = pad.volts_of(siemens)
        return pad.scan.counts(volts, pad.converter, self.rng, self.built.noise)


def _true(thing: Thing, shape: Shape) -> TrueObject:
    return TrueObject(shape, thing.total_g, thing.name)


def _pressure_offset(thing: Thing, lean_cm: float, rng: np.random.Generator) -> tuple[float, float]:
    """Return where the centre of pressure lies from the object's own centre."""
    x = y = 0.0
    if thing.stack_offset_cm > 0.0 and thing.stacked_g:
        stands = rng.normal(0.0, thing.stack_offset_cm, (len(thing.stacked_g), 2))
        x, y = np.array(thing.stacked_g) @ stands / thing.total_g
    if lean_cm > 0.0:
        leans = rng.normal(0.0, lean_cm, 2)
        x, y = x + leans[0], y + leans[1]
    return (float(x), float(y))
