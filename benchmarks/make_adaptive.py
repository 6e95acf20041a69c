"""Make ``adaptive`` and ``locate`` by ``tune``, and ship what comes out only if it is no worse.

Run with ``python benchmarks/make_adaptive.py`` (half an hour); ``--write`` puts what holds in the
place of the shipped file, ``--frames N`` and ``--seed N`` make the run another one.

``adaptive`` is tuned as the case ``mixture`` of `tuned`, from the ladder of every way to a circle;
``locate``, which has one way only, by its own guard. Frames are of the project's simulator and of
half the kinds of pad of the second one.

What would refute that it may be shipped, said before it was measured, on unseen frames of these
pads or on the other kinds: the upper end of the 95 % interval (bootstrap over stretches of frames)
of the error where something lies is more than a twentieth above today's; that of missed objects, or
of answers where nothing lies, more than a hundredth of the frames; or that of the time not below
today's.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

from tuned import CASES, Told, markdown, run

from tactile_graph import load
from tactile_graph.compiled import warm_up

PRODUCTS = {"adaptive": "mixture", "locate": "locate"}
ERROR_MARGIN = 0.05
"""Of today's error."""
SHARE_MARGIN = 0.01
PIPELINES = Path(__file__).parents[1] / "pipelines" / "tactile_graph_pipelines"


def refuted_by(told: Told) -> Iterator[str]:
    """Yield what speaks against shipping, of one set of frames."""
    more, today = told.difference, told.hand.error.mean
    if more.error.high > ERROR_MARGIN * today:
        yield f"the error may be {more.error.high:+.3f} more than {today:.3f}"
    for name, its in (("missed", more.missed), ("false", more.false)):
        if its.high > SHARE_MARGIN:
            yield f"{name}: maybe {100 * its.high:+.1f} % of the frames"
    if told.ratio.high >= 1.0:
        yield f"it may take {told.ratio.high:.2f} of the time"


def shipped(name: str, text: str) -> str:
    """Return a tuned file under the name, the words and the parent of the shipped one."""
    today = load(name)
    head = f"pipeline: {name}\nabout: {today.about}\nevolves: {today.evolves}\n"
    return re.sub(r"^pipeline: .*\n(?:about: .*\n)?(?:evolves: .*\n)?", head, text, flags=re.M)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=PRODUCTS, nargs="+", default=list(PRODUCTS))
    parser.add_argument("--frames", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    warm_up()
    for name in asked.only:
        assert CASES[PRODUCTS[name]].by_hand == name
        told, tuned = run(PRODUCTS[name], asked.frames, asked.seed)
        print("\n".join(markdown(list(told.values()))))
        against = [f"{on}: {why}" for on, its in told.items() for why in refuted_by(its)]
        text = shipped(name, tuned.text)
        print(f"\n{text}")
        for why in against:
            print(f"{name} stays as it is: {why}")
        if asked.write and not against:
            (PIPELINES / f"{name}.yaml").write_text(text, encoding="utf-8")
            print(f"wrote {name}.yaml")


if __name__ == "__main__":
    main()
