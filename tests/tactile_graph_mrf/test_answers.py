"""Every restorer and sampler gives the very answers in ``answers.yaml`` on one small image.

They were written down once the tests beside this one, against sums over all states and proofs,
had passed; what they add is that no change of a sum, a bound or a draw goes by unnoticed. After a
change that is meant, ``python tests/tactile_graph_mrf/test_answers.py`` writes them anew.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import pytest
import yaml

from helpers_modes import answered_by
from tactile_graph.wires import Image, Mask
from tactile_graph_mrf.descent.gnc import gnc
from tactile_graph_mrf.descent.graph_cuts import graph_cuts
from tactile_graph_mrf.descent.icm import icm
from tactile_graph_mrf.descent.mean_field import mean_field
from tactile_graph_mrf.descent.restore import restore
from tactile_graph_mrf.descent.trw import trw
from tactile_graph_mrf.energy.model import Model
from tactile_graph_mrf.samplers.gibbs import gibbs
from tactile_graph_mrf.samplers.posterior import posterior

pytestmark = pytest.mark.slow

FILE = Path(__file__).parent / "answers.yaml"
LEVELS = np.array([
    [0, 1, 0, 2, 1, 0, 1],
    [1, 0, 8, 9, 7, 1, 0],
    [0, 2, 9, 3, 9, 8, 1],
    [1, 1, 8, 9, 10, 7, 2],
    [0, 0, 7, 11, 8, 1, 0],
    [2, 1, 0, 1, 3, 0, 1],
], float)  # fmt: skip
IMAGE = Image(0.25 * LEVELS + 1.0)
"""A raised plate with a void, bumps and a corner that is missing; eleven steps of a quarter."""
GAPPY = Image(IMAGE.values, valid=LEVELS != 3)
REGION = Mask(np.pad(np.ones((5, 5), bool), ((1, 0), (1, 1))))
EXPECTED = Image(np.where(LEVELS > 5, 2.9, 1.1))
LINED = Model(n_levels=12, lambda_d=0.4, lambda_l=6.0)
MODELS: dict[str, Model] = {
    "lined": LINED,
    "plain": Model(n_levels=12, lambda_d=0.4, lines="none"),
    "wide": Model(n_levels=12, lambda_d=0.2, lambda_l=5.0, order=2,
                  smoothness="truncated_quadratic", truncation=3.0),
    "widest": Model(n_levels=12, lambda_d=0.2, order=3, lines="none", smoothness="huber",
                    truncation=2.0, noise="student_t", sigma=1.5),
    "summed": Model(n_levels=12, lambda_d=0.5, lambda_l=4.0, lines="marginal",
                    noise="outliers", sigma=1.2),
    "counted": Model(n_levels=12, lambda_d=0.1, lines="none", noise="poisson",
                     smoothness="geman_mcclure", truncation=2.0),
    "edges": Model(n_levels=12, lambda_d=0.6, lambda_l=3.0, lines="marginal",
                   smoothness="truncated_absolute", truncation=4.0, noise="laplace", sigma=1.0),
    "straight": Model(n_levels=12, lambda_d=0.8, lines="none", smoothness="absolute"),
    "expecting": Model(n_levels=12, lambda_d=0.3, lambda_l=6.0, lambda_prior=0.7),
}  # fmt: skip
"""Between them every kind of noise, smoothness, order and lines."""


class Case(NamedTuple):
    """A step, its model, and what else it is given."""

    step: Any
    model: str
    settings: Mapping[str, Any] = MappingProxyType({})
    on: Image = IMAGE

    @property
    def name(self) -> str:
        told = [self.step.__name__, self.model, *(f"{k}={v}" for k, v in self.settings.items())]
        return " ".join([*told, *(["gappy"] if self.on is GAPPY else [])])


ANNEALED = {"temperature": 4.0, "cooling": 0.7, "n_sweeps": 6}
DRAWN = {"n_burn": 3, "n_samples": 6, "n_between": 2}
CASES = [
    *(Case(gibbs, model, ANNEALED) for model in MODELS),
    Case(gibbs, "lined", {**ANNEALED, "schedule": "linear"}),
    Case(gibbs, "lined", {**ANNEALED, "schedule": "logarithmic", "start": "observed"}),
    Case(gibbs, "lined", {**ANNEALED, "energy_scale": 0.1}, GAPPY),
    *(Case(posterior, model, DRAWN) for model in MODELS),
    Case(posterior, "lined", {**DRAWN, "energy_scale": 0.5}, GAPPY),
    *(Case(icm, model) for model in MODELS),
    *(Case(gnc, model, {"n_steps": 4}) for model in MODELS),
    *(Case(restore, model, {"n_rounds": 3}) for model in MODELS),
    Case(restore, "lined", {"effort": 2, "n_rounds": 2}, GAPPY),
    Case(restore, "plain", {"effort": 3, "n_rounds": 0}),
    *(
        Case(mean_field, m, {"cooling": 0.3, "temperature": 50.0, "coldest": 0.5})
        for m in MODELS
        if m != "wide"
    ),
    Case(mean_field, "lined", {"cooling": 0.3, "temperature": 20.0, "finish": False}, GAPPY),
    *(Case(graph_cuts, model, {"n_cycles": 2}) for model in MODELS),
    Case(graph_cuts, "edges", {"moves": "swap", "n_cycles": 2}, GAPPY),
    *(Case(trw, m, {"n_sweeps": 4}) for m in ("plain", "summed", "edges", "straight")),
]


def answer(case: Case) -> dict[str, Any]:
    """Return what a step gives, as YAML keeps it."""
    given: dict[str, Any] = {"model": MODELS[case.model], **case.settings}
    if case.model == "expecting":
        given["expected"] = EXPECTED
    elif case.model == "straight":
        given["region"] = REGION
    if case.step in (gibbs, posterior):
        given["rng"] = np.random.default_rng(3)
    with answered_by("plain"):
        found = case.step(case.on, **given)
    image = found.mean if case.step is posterior else found.image
    told = {"image": _rows(4.0 * (image.values - 1.0)), "trace": _numbers(found.trace)}
    if found.lines.count:
        told["across"] = _flags(found.lines.horizontal)
        told["down"] = _flags(found.lines.vertical)
    if case.step is posterior:
        chances = (found.horizontal_probability, found.vertical_probability)
        told["deviation"] = _rows(found.deviation.values)
        told["chances"] = [_sum(chance) for chance in chances]
        return {**told, "effective_samples": _number(found.effective_samples)}
    told["energy"] = _number(found.energy)
    return told | ({"bound": _number(found.bound)} if case.step is trw else {})


def _number(value: float) -> float:
    return float(f"{value:.10g}")


def _numbers(values: Any) -> list[float]:
    return [_number(float(v)) for v in values]


def _rows(values: np.ndarray) -> list[str]:
    return [" ".join(f"{v + 0.0:.6g}" for v in np.round(row, 9)) for row in values]


def _flags(on: np.ndarray) -> list[str]:
    return ["".join("-|"[int(v)] for v in row) for row in on]


def _sum(values: np.ndarray) -> float:
    """Return a sum in which each place weighs otherwise."""
    return _number(float((values.ravel() * np.sqrt(np.arange(1, values.size + 1))).sum()))


def alike(one: Any, other: Any) -> bool:
    """Return whether two answers are the same but for the last digits of numbers."""
    if isinstance(one, float):
        return one == pytest.approx(other, rel=1e-8, abs=1e-8)
    if isinstance(one, list):
        return len(one) == len(other) and all(map(alike, one, other))
    if isinstance(one, str) and " " in one:
        return alike(*([float(v) for v in text.split()] for text in (one, other)))
    return bool(one == other)


ANSWERS = yaml.safe_load(FILE.read_text(encoding="utf-8")) if FILE.exists() else {}


def test_there_is_an_answer_for_each_and_no_other() -> None:
    assert list(ANSWERS) == [case.name for case in CASES]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_answer_is_the_one_written_down(case: Case) -> None:
    if case.step is graph_cuts:
        pytest.importorskip("maxflow", reason="graph_cuts needs PyMaxflow")
    found, told = answer(case), ANSWERS[case.name]
    assert {k: found.get(k) for k in {*found, *told} if not alike(found.get(k), told.get(k))} == {}


if __name__ == "__main__":
    texts = {case.name: answer(case) for case in CASES}
    FILE.write_text(yaml.safe_dump(texts, sort_keys=False, width=100, default_flow_style=None))
