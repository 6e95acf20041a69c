"""How the likelihood fares on contacts it was not designed for, and whether it says so.

Run with ``python benchmarks/likelihood_robustness.py`` (about two minutes); ``--scenes N`` takes
N scenes of a kind. Discs of table 4.2 lie on the pad ``thesis``, but something is otherwise than
the model has it: the gains, the way the load comes down, the pad, or what lies there. Each
localiser's mean errors come with their ratio to circle-3's on the same frames; the likelihood's
with the share of frames that it flags (``fits`` False), their ratio on the frames that it does not
flag, and the share of its 90 % regions that hold the truth.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from tactile_graph import Circle, Frame, load
from tactile_graph.compiled import warm_up
from tactile_graph.wires import TrueObject
from tactile_graph_likelihood.single.likely import LikelyCircle
from tactile_graph_pads.contact import Grain, spread
from tactile_graph_pads.coverage.coverage import coverage_cm2
from tactile_graph_pads.pad import Pad, load_pad

Values = NDArray[np.float64]
DISCS = ((1860.0, 6.8), (6360.0, 5.1), (6810.0, 7.7))
"""Weight in grams and radius in cm of table 4.2's discs."""
THESIS = load_pad("thesis")
GEOMETRY = THESIS.geometry
WIDTH, HEIGHT = GEOMETRY.size_cm


@dataclass(frozen=True)
class Laid:
    """A disc put down, and what its elements' shares and gains are."""

    disc: Circle
    weight_g: float
    covered: Values
    gains: Values

    def shared(self, part: Values) -> Values:
        """Return the load that comes down in proportion to something."""
        total = float(part.sum())
        return part * (self.weight_g / total) if total > 0.0 else part

    @property
    def load_g(self) -> Values:
        return self.shared(self.covered * self.gains)


Kind = Callable[[Laid, np.random.Generator], Values]
"""Return each element's load in grams."""


def gains(rng: np.random.Generator, pad: Pad = THESIS) -> Values:
    uneven = pad.unevenness
    return uneven.gains(uneven.draw(GEOMETRY, rng), uneven.draw(GEOMETRY, rng))


def uneven(**changed: float) -> Pad:
    return replace(THESIS, unevenness=replace(THESIS.unevenness, **changed))


def as_designed(laid: Laid, rng: np.random.Generator) -> Values:
    return laid.load_g


def foam(width_cm: float) -> Kind:
    return lambda laid, rng: spread(laid.load_g, GEOMETRY, width_cm)


def heavy_tailed(laid: Laid, rng: np.random.Generator) -> Values:
    """Logarithms of gains by Student's t of two degrees of freedom."""
    t = np.clip(rng.standard_t(2.0, laid.gains.shape), -12.0, 12.0)
    return laid.shared(laid.covered * (laid.gains > 0.0) * np.exp(THESIS.unevenness.sigma * t))


def tilted(laid: Laid, rng: np.random.Generator) -> Values:
    """The weight stands a fifth of the radius off centre; one edge bears a tenth of the other."""
    way, off = rng.uniform(0.0, 2.0 * math.pi), 0.2 * laid.disc.radius_cm
    offset = off * math.cos(way), off * math.sin(way)
    return THESIS.contact.load_g(laid.disc, laid.weight_g, GEOMETRY, laid.gains, offset)


def sand(laid: Laid, rng: np.random.Generator) -> Values:
    """A grain under one covered element bears nine tenths of the weight."""
    rows, columns = np.nonzero(laid.covered > 0.5)
    k = rng.integers(len(rows))
    grain = Grain(int(rows[k]), int(columns[k]), 0.9)
    contact = replace(THESIS.contact, sand=(grain,))
    return contact.load_g(laid.disc, laid.weight_g, GEOMETRY, laid.gains)


def ball(power: float) -> Kind:
    """A curved face: the pressure falls to nothing at the rim as ``(1 - r**2) ** power``.

    A power of 1/2 is a ball on an elastic pad (Hertz), 1 a ball on a soft layer. Integrated over
    each element's covered part.
    """

    def loads(laid: Laid, rng: np.random.Generator) -> Values:
        steps = (np.arange(24) + 0.5) / 24.0 - 0.5
        off = (steps * (GEOMETRY.pitch_cm - GEOMETRY.gap_cm))[None, :]
        across = (GEOMETRY.x_cm[:, None] + off - laid.disc.x_cm).ravel()
        down = (GEOMETRY.y_cm[:, None] + off - laid.disc.y_cm).ravel()
        r2 = (across[None, :] ** 2 + down[:, None] ** 2) / laid.disc.radius_cm**2
        pressure = np.maximum(1.0 - r2, 0.0) ** power
        rows, columns = laid.covered.shape
        return laid.shared(laid.gains * pressure.reshape(rows, 24, columns, 24).mean(axis=(1, 3)))

    return loads


def cup(laid: Laid, rng: np.random.Generator) -> Values:
    """Only the outer 30 % of the radius touches."""
    disc = laid.disc
    inner = coverage_cm2(Circle(disc.x_cm, disc.y_cm, 0.7 * disc.radius_cm), GEOMETRY)
    return laid.shared((laid.covered - inner) * laid.gains)


def second_object(laid: Laid, rng: np.random.Generator) -> Values:
    """A disc of 1.5 cm with the same pressure lies beside, 1 to 3 cm away where there is room."""
    disc = laid.disc
    for _ in range(200):
        way = rng.uniform(0.0, 2.0 * math.pi)
        far = disc.radius_cm + 1.5 + rng.uniform(1.0, 3.0)
        x, y = disc.x_cm + far * math.cos(way), disc.y_cm + far * math.sin(way)
        if 1.5 <= x <= WIDTH - 1.5 and 1.5 <= y <= HEIGHT - 1.5:
            break
    small = coverage_cm2(Circle(x, y, 1.5), GEOMETRY)
    weight = laid.weight_g * (1.5 / disc.radius_cm) ** 2
    return laid.load_g + THESIS.contact.load_g(Circle(x, y, 1.5), weight, GEOMETRY, gains(rng)) * (
        small > 0.0
    )


def strays(laid: Laid, rng: np.random.Generator) -> Values:
    """One element in 25 bears a load of its own, 10 to 100 g."""
    own = np.exp(rng.uniform(math.log(10.0), math.log(100.0), laid.covered.shape))
    return laid.load_g + own * (rng.random(laid.covered.shape) < 0.04)


def times(factor: float) -> Kind:
    return lambda laid, rng: factor * laid.load_g


def law(**changed: float) -> Pad:
    return replace(THESIS, law=replace(THESIS.law, **changed))


def defects(**changed: object) -> Pad:
    return replace(THESIS, defects=replace(THESIS.defects, **changed))  # type: ignore[arg-type]


KINDS: dict[str, tuple[Kind, Pad]] = {
    "as designed": (as_designed, THESIS),
    "bumps 2 cells wide": (as_designed, uneven(correlation_cm=2.6)),
    "bumps 3 cells wide": (as_designed, uneven(correlation_cm=3.9)),
    "foam, half a cell": (foam(0.65), THESIS),
    "foam, one cell": (foam(1.3), THESIS),
    "heavy-tailed gains": (heavy_tailed, THESIS),
    "weight off centre": (tilted, THESIS),
    "grain of sand": (sand, THESIS),
    "a dead row": (as_designed, defects(dead_rows=(8,))),
    "30 % voids": (as_designed, uneven(voids=0.3)),
    "three times as uneven": (as_designed, uneven(sigma=1.45)),
    "saturated, 100 x weight": (times(100.0), THESIS),
    "saturated, 300 x weight": (times(300.0), THESIS),
    "exponent 2.2, not 1.46": (as_designed, law(exponent=2.2)),
    "exponent 1, not 1.46": (as_designed, law(exponent=1.0)),
    "ball on an elastic pad": (ball(0.5), THESIS),
    "ball on a soft layer": (ball(1.0), THESIS),
    "cup: rim alone touches": (cup, THESIS),
    "second, small object": (second_object, THESIS),
    "4 % strays": (strays, THESIS),
    "rows of unequal gain": (as_designed, defects(row_gain_sigma=0.7)),
}


def frames(kind: Kind, pad: Pad, count: int, seed: int) -> Iterator[Frame]:
    """Give frames of one disc each, its place anywhere where it lies on the pad."""
    rng = np.random.default_rng(seed)
    for index in range(count):
        weight, radius = DISCS[index % len(DISCS)]
        x, y = (float(rng.uniform(radius, size - radius)) for size in (WIDTH, HEIGHT))
        disc = Circle(x, y, radius)
        laid = Laid(disc, weight, coverage_cm2(disc, GEOMETRY), gains(rng, pad))
        siemens = pad.conductance_s(kind(laid, rng), pad.built(rng))
        siemens = siemens * np.exp(pad.law.repeatability * rng.standard_normal(siemens.shape))
        counts = pad.scan.counts(pad.volts_of(siemens), pad.converter, rng)
        image = pad.image(pad.converter.volts(counts), "volt")
        yield Frame(image, index, float(index), (TrueObject(disc, weight, ""),))


CONTESTANTS = {
    "circle-3": ("circle-3", {}),
    "circle-likelihood": ("circle-likelihood", {}),
    "estimating": ("circle-likelihood", {"circle.estimate": ["sigma", "voids"]}),
    "estimating foam too": ("circle-likelihood", {"circle.estimate": ["sigma", "voids", "foam"]}),
}


@dataclass
class Score:
    """What one localiser did on each frame of one kind; NaN errors where it had no answer."""

    errors: Values
    flagged: NDArray[np.bool_]
    inside: NDArray[np.bool_]


def scored(run: Callable[[Frame], object], seen: list[Frame]) -> Score:
    errors = np.full((len(seen), 2), np.nan)
    flagged, inside = np.zeros((2, len(seen)), np.bool_)
    for k, frame in enumerate(seen):
        assert frame.truth is not None
        found, true = run(frame), frame.truth[0].shape
        if found is None:
            continue
        assert isinstance(found, Circle)
        assert isinstance(true, Circle)
        off = math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm)
        errors[k] = off, abs(found.radius_cm - true.radius_cm)
        if isinstance(found, LikelyCircle):
            flagged[k], inside[k] = not found.posterior.fits, found.posterior.contains(true)
    return Score(errors, flagged, inside)


def line(name: str, score: Score, base: Score) -> str:
    """Return a row: errors, ratios, flags, errors where there is none, coverage."""
    answered = np.isfinite(score.errors[:, 0])
    both = answered & np.isfinite(base.errors[:, 0])
    if not both.any():
        return f"  {name:20s} no answer in {int((~answered).sum())}"

    def over(rows: NDArray[np.bool_]) -> Values:
        return np.asarray(score.errors[rows].mean(axis=0) / base.errors[rows].mean(axis=0))

    mean = score.errors[answered].mean(axis=0)
    text = f"  {name:20s}"
    text += "".join(f"{m:8.3f} {r:5.2f}" for m, r in zip(mean, over(both), strict=True))
    if score is not base:
        flagged = score.flagged[answered].mean()
        text += f"{flagged:9.1%}"
        left = both & ~score.flagged
        text += "".join(f"{r:7.2f}" for r in over(left)) if left.any() else f"{'':14s}"
        text += f"{score.inside[answered].mean():9.1%}  "
        if (over(both) <= 1.0 / 3.0).all():
            text += "a third"
        elif flagged >= 0.9:
            text += "flagged"
        else:
            third = not left.any() or bool((over(left) <= 1.0 / 3.0).all())
            text += "a third or flagged" if third else "NEITHER"
    lost = int((~answered).sum())
    return text + (f"  no answer in {lost}" if lost else "")


def reader(name: str, settings: dict[str, object]) -> Callable[[Frame], object]:
    run = load(name).with_settings(settings).runner()
    return lambda frame: run(frame).get("circle")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--scenes", type=int, default=150, help="of a kind")
    parser.add_argument("--seed", type=int, default=23)
    parser.add_argument("--kinds", nargs="*", default=[])
    parser.add_argument("--contestants", nargs="*", default=list(CONTESTANTS)[1:])
    chosen = parser.parse_args()
    warm_up()
    runs = {n: reader(*CONTESTANTS[n]) for n in ("circle-3", *chosen.contestants)}
    print("mean errors in cm, and over circle-3's on frames that both answer; share flagged; the")
    print("ratios on frames not flagged; share of 90 % regions that hold the truth")
    print(f"{'':22s}{'centre':>8s}{'':6s}{'radius':>8s}{'':6s}{'flagged':>9s}{'c':>7s}{'r':>7s}")
    for name, (kind, pad) in KINDS.items():
        if chosen.kinds and not any(part in name for part in chosen.kinds):
            continue
        seen = list(frames(kind, pad, chosen.scenes, chosen.seed))
        scores = {n: scored(run, seen) for n, run in runs.items()}
        print(name)
        for contestant, score in scores.items():
            print(line(contestant, score, scores["circle-3"]), flush=True)


if __name__ == "__main__":
    main()
