"""The benchmark of learned pads: what it holds the learned against is what was put in."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
sys.path.insert(0, str(FOLDER))
import learned_pad  # noqa: E402


def test_an_empty_bench_reads_its_offsets_and_noise() -> None:
    kind = learned_pad.LEARNED_KINDS["offsets 50 mV"]
    bench = learned_pad.Recorder(kind, np.random.default_rng(0))
    values = np.array([frame.image.values for frame in bench.empty(200)])
    assert values.mean(axis=0) == pytest.approx(bench.zero_v, abs=5e-4)
    assert values.std(axis=0).mean() == pytest.approx(kind.noise_v, rel=0.05)


@pytest.mark.slow
def test_offsets_that_spoil_localisers_spoil_none_behind_a_learned_pad(tmp_path: Path) -> None:
    rng, kind = np.random.default_rng(3), learned_pad.LEARNED_KINDS["offsets 50 mV"]
    told, errors = learned_pad.of_kind(kind, 12, rng, tmp_path)
    assert float(told["noise / mV"].split()[0]) == pytest.approx(1.0, rel=0.05)
    shipped, learned = (
        float(errors[f"circle-by-order, {how}"].split()[0]) for how in ("shipped", "learned")
    )
    assert learned < 0.2
    assert learned < 0.4 * shipped
