"""What a frame and a cell cost every built-in step from 16x16 to 512x512 cells, and how that grows.

    python benchmarks/growth.py                                    # all steps, about 25 minutes
    python benchmarks/growth.py contacts hull --sides 16 64 256    # some
    python benchmarks/growth.py --page docs/evidence/growth.md     # and the page of it

Scenes of each size: ``grown``, two objects that take the same share of every pad; ``one``, the
larger of them, for steps that find one outline; ``many``, objects of a fixed size, one in each 8 by
8 cells. Steps are fed as `check_step` feeds
them, their settings are their defaults. Times are of the processor, medians over rounds, machine
code on disk. A call over ``--bound`` seconds ends the step's scene there, and is told. The exponent
is the slope of log time over log cells, over all sizes and over the three largest that were
reached; its interval is of rounds drawn anew.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parent))

from growth_parts.page import page, table
from growth_parts.scenes import SCENES, scenes_of
from growth_parts.timing import COPY, Bounds, Point, family_of, points_of

from tactile_graph.compiled import warm_up
from tactile_graph.plugins.registry import installed
from tactile_graph.steps.signature import Kind

SIDES = (16, 32, 64, 128, 256, 512)


def steps() -> list[str]:
    """Return the built-in steps that are no source, by family."""
    found = installed()
    names = [n for n in found.names("steps") if found.step(n).kind is not Kind.SOURCE]
    return sorted(names, key=lambda n: (found.offer("steps", n).plugin.name, n))


def measured(
    wanted: Sequence[tuple[str, str]], sides: list[int], bounds: Bounds
) -> Iterator[Point]:
    """Yield the times of steps, each on a scene, telling them as they come."""
    for i, (name, scene) in enumerate(wanted, 1):
        for point in points_of(name, scene, sides, bounds):
            time = f"{1e6 * min(point.rounds_s):.1f} us" if point.rounds_s else ""
            what = f"{point.step} {point.scene} {point.side}: {time} {point.told}"
            print(f"[{i}/{len(wanted)}] {what.rstrip()}", file=sys.stderr, flush=True)
            yield point


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("steps", nargs="*", metavar="STEP", help="all built-in ones if none")
    parser.add_argument("--sides", type=int, nargs="+", default=list(SIDES))
    parser.add_argument("--bound", type=float, default=2.0, help="seconds a call may take")
    parser.add_argument("--keep", type=Path, help="JSON file: its points are not measured again")
    parser.add_argument("--kept", action="store_true", help="measure nothing, show what is kept")
    parser.add_argument("--page", type=Path, help="write the page to this file")
    chosen = parser.parse_args()
    warm_up()
    wanted = chosen.steps or [COPY, *steps()]
    points = _kept(chosen.keep)
    known = {(p.step, p.scene) for p in points}
    every = [(n, scene) for n in wanted for scene in scenes_of(family_of(n))]
    missing = [pair for pair in every if pair not in known]
    to_time = [] if chosen.kept else missing
    for point in measured(to_time, sorted(chosen.sides), Bounds(chosen.bound)):
        points.append(point)
        if chosen.keep:
            chosen.keep.write_text(json.dumps([p.__dict__ for p in points]))
    shown = sorted((p for p in points if p.step in wanted), key=order_of)
    print(table(shown))
    if chosen.page:
        timed = {p.step for p in shown}
        chosen.page.write_text(page(shown, chosen.bound, [n for n in wanted if n not in timed]))


def order_of(point: Point) -> tuple[str, str, int]:
    """Return where a point stands in the table."""
    return point.family, point.step, list(SCENES).index(point.scene)


def _kept(file: Path | None) -> list[Point]:
    if file is None or not file.exists():
        return []
    return [Point(**{**p, "rounds_s": tuple(p["rounds_s"])}) for p in json.loads(file.read_text())]


if __name__ == "__main__":
    main()
