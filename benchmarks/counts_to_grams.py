"""Counts to grams on one 16x16 frame of the divider circuit: volts, decouple, force.

Run with ``python benchmarks/counts_to_grams.py``. Prints each step, the chain through the engine,
and a NumPy script of the same closed form as peer.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parent))
from rounds import print_table, time_side_by_side

from tactile_graph import Frame, load, loads
from tactile_graph.compiled import warm_up

PIPELINE = """
pipeline: counts-to-grams
nodes:
  volts: {step: volts, in: frame}
  siemens: {step: decouple, in: volts}
  grams: {step: force, in: siemens}
outputs: [grams]
"""


def numpy_script(counts: NDArray[np.float64]) -> NDArray[np.float64]:
    """The ideal pad: 12 bits over -5..5 V, 33 kOhm, a power law without turn-on or saturation."""
    ratio = (counts * (10.0 / 4096.0) - 5.0) / 5.0
    siemens = ratio / 33e3 / (1.0 - ratio.sum(axis=0))
    exponent = np.log(2000.0 / 100.0) / np.log(80e3 / 1e3)
    return np.asarray(100.0 * (np.maximum(siemens, 1e-12) * 80e3) ** exponent)


def main() -> None:
    warm_up()
    source = load("circle-3").with_source("simulate", scene="disc-1", frames=2, output="counts")
    frames = list(source.frames(seed=0))
    runner = loads(PIPELINE).runner()
    turn = iter(range(10**9))

    def ours() -> object:
        return runner(frames[next(turn) % 2])

    volts = runner(frames[0]).outcome("volts")
    steps = {n: node.bound() for n, node in loads(PIPELINE).nodes.items()}
    siemens = steps["siemens"](volts)
    counts = frames[0].image.values
    times = time_side_by_side(
        {
            "counts to grams, through the engine": ours,
            "volts": lambda: steps["volts"](frames[0].image),
            "decouple": lambda: steps["siemens"](volts),
            "force": lambda: steps["grams"](siemens),
            "NumPy script, ideal pad": lambda: numpy_script(counts),
        }
    )
    print_table(times, "NumPy script, ideal pad")
    grams = runner(frames[0])["grams"]
    assert isinstance(frames[0], Frame)
    assert frames[0].truth is not None
    print(f"weight read {grams.total:.0f} g, on the pad {frames[0].truth[0].weight_g:.0f} g")
    middle = times["counts to grams, through the engine"].median_us
    print(f"target: at most 20 us; reached: {middle:.1f} us")


if __name__ == "__main__":
    main()
