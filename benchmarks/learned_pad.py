"""How good a pad learned by ``tactile-graph learn-pad`` is, on recordings it has not seen.

    python benchmarks/learned_pad.py people [--tuning FOLDER] [--others FOLDER]
    python benchmarks/learned_pad.py pads [--kinds NAME ...] [--scenes N]

``people``: CapContact, a capacitive panel of 41 by 72 cells and a camera that sees what truly
touches. The command learns from one folder and nothing else; told are the contacts of two other
people in the other folder. Errors are distances from the camera's centre, as the recordings give
both grids, in cells.

``pads``: pads of `second_simulator`, which shares no code with the project's own. The command gets
an empty recording and one of discs at known places with known weights; what it says is held
against what the simulator put in. Then other discs on the same pad are localised by circle-3,
circle-by-order and circle-likelihood, as shipped and behind the steps that the learned pad serves.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml
from click.testing import CliRunner
from numpy.typing import NDArray
from second_simulator import BASE, KINDS, Bench, Kind

from tactile_graph import Circle, Frame, Pipeline, loads
from tactile_graph.cli import cli
from tactile_graph.steps import Report
from tactile_graph_pads.learned import GOOD
from tactile_graph_pads.pad import load_pad
from tactile_graph_sources.recording import recording
from tactile_graph_sources.writers.write_npz import write_npz

Values = NDArray[np.float64]
SHARED = Path(__file__).parents[2] / "shared/data"
GATE_CM = 1.0


def learn(*arguments: object) -> str:
    """Run the command, and return what it says."""
    done = CliRunner().invoke(cli, ["learn-pad", *map(str, arguments)], catch_exceptions=False)
    if done.exit_code:
        raise SystemExit(done.output)
    return done.output


# -- people never seen -----------------------------------------------------------------------

PLACED = """
pipeline: placed
source: {{step: sample, with: {{name: discs}}}}
nodes:
  readings: {{step: correct_readings, in: frame, with: {{pad: {pad}}}}}
  touched: {{step: threshold_learned, in: readings, with: {{pad: {pad}}}}}
  contacts: {{step: contacts, in: [readings, touched]}}
  placed: {{step: correct_place, in: [readings, contacts.contacts], with: {{pad: {pad}}}}}
  located: {{step: locate_contacts, in: [frame, contacts.contacts],
             with: {{pad: {told}, shapes: [disc]}}}}
outputs: [contacts, placed, located]
"""


class Told(NamedTuple):
    """Errors in cells, and the deviations stated of them where any are; (n, 2) each."""

    session: list[str]
    off: Values
    stated: Values


def nearest(frame: Frame, contacts: Sequence[Any]) -> Iterator[tuple[Values, Values]]:
    """Yield each contact's error and stated deviation in cells, if a true one is near."""
    true = np.array([(t.shape.x_cm, t.shape.y_cm) for t in frame.truth or ()])
    pitch = np.array(frame.image.pitch_cm)
    for its in contacts:
        off = np.array([its.x_cm, its.y_cm]) - true
        k = int(np.hypot(*off.T).argmin())
        if np.hypot(*off[k]) <= GATE_CM:
            posterior = getattr(its, "posterior", None)
            x = posterior.std(0) if posterior else getattr(its, "x_std_cm", math.nan)
            y = posterior.std(1) if posterior else getattr(its, "y_std_cm", math.nan)
            yield off[k] / pitch, np.array([x, y]) / pitch


def told(pad: Path, paths: Sequence[Path], known: Path | str) -> dict[str, Told]:
    """Return what comes of recordings, with `locate_contacts` told the pad ``known``."""
    text = PLACED.format(pad=pad, told=known)
    run = loads(text).with_source("recording", path=str(paths[0])).runner()
    rows: dict[str, list[tuple[str, Values, Values]]] = {}
    for path in paths:
        for frame in recording(path=path, report=Report()):
            result = run(frame)
            of = {
                "plain centroid": result["contacts"].contacts,
                "correct_place": result["placed"].contacts,
                f"locate_contacts, pad {Path(known).stem}": result["located"].shapes,
            }
            for name, contacts in of.items():
                found = [(path.stem[:5], *both) for both in nearest(frame, contacts)]
                rows.setdefault(name, []).extend(found)
    return {
        name: Told(
            [r[0] for r in its], np.array([r[1] for r in its]), np.array([r[2] for r in its])
        )
        for name, its in rows.items()
    }


def people(tuning: Path, others: Path) -> None:
    """Print errors on people never seen."""
    learned_from, paths = sorted(tuning.glob("*.npz")), sorted(others.glob("*.npz"))
    for folder, found in ((tuning, learned_from), (others, paths)):
        if not found:
            raise SystemExit(f"no CapContact recordings in {folder}")
    with tempfile.TemporaryDirectory() as folder:
        pad = Path(folder) / "learned.yaml"
        print(learn(*learned_from, "-o", pad))
        seen = {**told(pad, paths, "thesis"), **told(pad, paths, pad)}
    print(
        "\nerror in cells               found  median   mean  95 % within  over stated  within 90 %"
    )
    for name, its in seen.items():
        d, over = np.hypot(*its.off.T), its.off / its.stated
        held = np.mean((over**2).sum(axis=1) < -2 * np.log(0.1))
        stated = "" if np.isnan(over).all() else f"{np.sqrt((over**2).mean()):12.2f} {held:12.0%}"
        print(
            f"{name:28s} {len(d):5d} {np.median(d):7.3f} {d.mean():6.3f} "
            f"{np.quantile(d, 0.95):12.3f} {stated}"
        )
        session = np.array(its.session)
        by = ", ".join(f"{s} {np.median(d[session == s]):.3f}" for s in np.unique(session))
        print(f"  median by person and session: {by}")


# -- simulated pads --------------------------------------------------------------------------

N_DISCS = 120
LOCALISERS = ("circle-3", "circle-by-order", "circle-likelihood", "locate-circle")
LEARNED_KINDS: dict[str, Kind] = {
    "noise 0.2 mV": KINDS["noise 0.2 mV"],
    "noise 3 mV": KINDS["noise 3 mV"],
    "offsets 5 mV": KINDS["drift 5 mV"],
    "offsets 50 mV": replace(BASE, noise_v=1e-3, offset_v=50e-3),
    "dead row": KINDS["dead row"],
    "dead column": KINDS["dead column"],
    "12 dead elements": KINDS["12 dead elements"],
    "3 stuck elements": KINDS["3 stuck elements"],
    "gains fixed": KINDS["gains fixed"],
    "gains half fixed": replace(BASE, fixed=0.5),
    "gains by row": KINDS["gains by row"],
    "turn-on 2 g": KINDS["turn-on 2 g"],
    "turn-on 40 g": KINDS["turn-on 40 g"],
    "8 bits": KINDS["8 bits"],
    "worn": replace(
        BASE, noise_v=1.6e-3, offset_v=20e-3, fixed=0.5, dead_rows=1, dead_columns=1,
        dead_elements=8, stuck_elements=2,
    ),
}  # fmt: skip


class Recorder(Bench):
    """A bench whose empty pad can be recorded too."""

    def empty(self, n: int) -> Iterator[Frame]:
        """Yield frames of nothing."""
        shape = (self.kind.rows, self.kind.columns)
        for index in range(n):
            volts = self._read(np.zeros(shape))
            yield Frame.of(volts, self.kind.pitch_cm, self._origin_cm, "volt", index=index)


Node = dict[str, Any]


def step(name: str, reads: Any, **settings: Any) -> Node:
    """Return a node of a pipeline file."""
    return (
        {"step": name, "in": reads, "with": settings} if settings else {"step": name, "in": reads}
    )


def fitted(name: str, volts: str, pad: str) -> dict[str, Node]:
    """Return what the pipeline of that name does behind its node ``footprint``.

    Parameters
    ----------
    name : str
    volts : str
        The node whose volts are localised.
    pad : str
        What the likelihood takes for the pad; evened by it where it was learned.
    """
    if name == "locate-circle":
        return {"circle": step("locate_disc", "frame", pad=pad)}
    if name == "circle-3":
        return {
            "fine": step("subdivide", "footprint", factor=2),
            "eroded": step("erode", "fine", element="disc5"),
            "dilated": step("dilate", "eroded", element="disc5"),
            "boundary": step("boundary_scan", "dilated"),
            "hull": step("hull", "boundary"),
            "circle": step("fit_circle", "hull"),
        }
    if name == "circle-by-order":
        ports = {"image": volts, "touched": "footprint"}
        return {"circle": step("footprint_by_order", ports, pad="thesis", on_pad="whole")}
    learned = pad != "thesis"
    even = {"even": step("correct_readings", "grams", pad=pad)} if learned else {}
    reads = "even" if learned else "grams"
    return {
        "siemens": step("decouple", volts, pad="thesis"),
        "grams": step("force", "siemens", pad=pad),
        **even,
        "circle": step("footprint_disc", reads, pad=pad, on_pad="whole", precision=0.2),
    }


def localisers(pad: Path) -> dict[str, Pipeline]:
    """Return each localiser as shipped, and behind what the learned pad corrects."""
    shipped: dict[str, Node] = {"footprint": step("threshold", "frame", level_v=0.01)}
    corrected = {
        "readings": step("correct_readings", "frame", pad=str(pad)),
        "filled": step("inpaint", "readings"),
        "footprint": step("threshold_learned", "filled", pad=str(pad)),
        "volts": step("correct_readings", "frame", pad=str(pad), keep_stuck=True),
    }
    found = {}
    for name in LOCALISERS:
        both = {
            "shipped": {**shipped, **fitted(name, "frame", "thesis")},
            "learned": {**corrected, **fitted(name, "volts", str(pad))},
        }
        for how, nodes in both.items():
            text = {
                "pipeline": f"{name}-{how}",
                "source": {"step": "simulate", "with": {"scene": "discs"}},
                "nodes": nodes,
                "outputs": ["circle"],
            }
            found[f"{name}, {how}"] = loads(yaml.safe_dump(text, sort_keys=False))
    return found


def off_cm(pipeline: Pipeline, frames: Sequence[Frame]) -> tuple[float, float, int]:
    """Return mean errors of centre and radius, and how many frames went without an answer."""
    centre, radius = [], []
    for result, frame in zip(pipeline.stream(frames), frames, strict=True):
        found: Any = result.outcome("circle")
        true: Any = (frame.truth or ())[0].shape
        if isinstance(found, Circle):
            centre.append(math.hypot(found.x_cm - true.x_cm, found.y_cm - true.y_cm))
            radius.append(abs(found.radius_cm - true.radius_cm))
    mean = float(np.mean(centre)) if centre else math.nan
    return mean, float(np.mean(radius)) if radius else math.nan, len(frames) - len(centre)


def recovered(bench: Recorder, pad: Path) -> dict[str, str]:
    """Return what the learned pad says beside what the simulator put in."""
    kind, learned, unevenness = bench.kind, load_pad(pad).learned, load_pad(pad).unevenness
    assert learned is not None
    table = learned.table
    good = table.state == GOOD
    compared = good & (table.gain != 1.0)
    noise_v = math.hypot(kind.noise_v, kind.step_v / math.sqrt(12.0))
    logs = kind.sigma * math.sqrt(kind.fixed) * bench.own + bench.lines
    varied = kind.fixed > 0.0 or kind.line_sigma > 0.0
    alike = (
        np.corrcoef(np.log(table.gain[compared]), np.broadcast_to(logs, good.shape)[compared])[0, 1]
        if varied
        else math.nan
    )
    dead, stuck = table.state == "dead", table.state == "stuck"
    off_v = np.sqrt(np.mean((table.offset - bench.zero_v)[good] ** 2))
    return {
        "noise / mV": f"{1e3 * np.median(table.noise[good]):.2f} ({1e3 * noise_v:.2f})",
        "offset off by / mV": f"{1e3 * off_v:.2f}",
        "dead": f"{(dead & bench.dead).sum()} of {bench.dead.sum()}, "
        f"{(dead & ~bench.dead).sum()} wrong",
        "stuck": f"{(stuck & bench.stuck).sum()} of {bench.stuck.sum()}",
        "gains alike": f"{alike:.2f}" if varied else
        ("none" if learned.gain_of is None else "told, are none"),
        "turn-on / g": "none" if learned.turn_on is None else
        f"{learned.turn_on.reading:.1f} ({kind.turn_on_g:g})",
        "sigma, voids": f"{unevenness.sigma:.2f} ({math.hypot(kind.sigma, kind.line_sigma):.2f}), "
        f"{unevenness.voids:.2f} ({kind.voids:g})",
    }  # fmt: skip


def of_kind(
    kind: Kind, n_scenes: int, rng: np.random.Generator, folder: Path
) -> tuple[dict[str, str], dict[str, str]]:
    """Learn a pad of a kind from recordings; return what came back, and the localisers' errors."""
    bench = Recorder(kind, rng)
    files = folder / "empty.npz", folder / "discs.npz"
    write_npz(files[0], bench.empty(100))
    write_npz(files[1], bench.frames(N_DISCS))
    pad = folder / "pad.yaml"
    learn("--empty", files[0], files[1], "--pad", "thesis", "-o", pad)
    frames, errors = list(bench.frames(n_scenes)), {}
    for name, pipeline in localisers(pad).items():
        centre, radius, unanswered = off_cm(pipeline, frames)
        errors[name] = f"{centre:.3f} / {radius:.3f}" + (f", {unanswered} none" * bool(unanswered))
    return recovered(bench, pad), errors


def pads(kinds: Sequence[str], n_scenes: int, seed: int) -> None:
    """Print what came back of each kind of pad, and then what the localisers make of it."""
    rows: list[tuple[dict[str, str], dict[str, str]]] = []
    for name in kinds:
        rng = np.random.default_rng([seed, *name.encode()])
        with tempfile.TemporaryDirectory() as folder:
            row = of_kind(LEARNED_KINDS[name], n_scenes, rng, Path(folder))
        rows.append(({"pad": name, **row[0]}, {"pad": name, **row[1]}))
    for which in (0, 1):
        head = list(rows[0][which])
        print("\n| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|")
        for both in rows:
            print("| " + " | ".join(both[which].values()) + " |")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("people", "pads"))
    parser.add_argument("--tuning", type=Path, default=SHARED / "capcontact")
    parser.add_argument("--others", type=Path, default=SHARED / "capcontact_others")
    parser.add_argument("--kinds", nargs="*", choices=LEARNED_KINDS, default=[*LEARNED_KINDS])
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    if asked.what == "people":
        people(asked.tuning, asked.others)
    else:
        pads(asked.kinds, asked.scenes, asked.seed)


if __name__ == "__main__":
    main()
