"""check_step holds a stacked form against the step."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tactile_graph import Degenerate, Image
from tactile_graph.testing import check_step
from tactile_graph.testing.check import BrokenPromises
from tactile_graph.wires.stacks import Answered, Column, ImageStack


def largest(image: Image) -> float:
    """Return the largest reading."""
    values = image.filled()
    if not values.size or not np.isfinite(values).all():
        raise Degenerate("there is no reading, or one that is no number")
    return float(values.max())


def good(image: ImageStack) -> Answered:
    values = image.values if image.valid is None else np.where(image.valid, image.values, 0.0)
    if not values[0].size:
        return NotImplemented  # type: ignore[no-any-return]
    done = np.isfinite(values).all(axis=(1, 2))
    return Answered(Column(values.max(axis=(1, 2)).astype(np.float64)), done)


def all_done(image: ImageStack) -> Column:
    return Column(image.values.max(axis=(1, 2), initial=-np.inf).astype(np.float64))


def another(image: ImageStack) -> Answered:
    found = good(image)
    if found is NotImplemented:
        return found
    return Answered(Column(found.values.values + 1.0), found.done)  # type: ignore[attr-defined]


def too_few(image: ImageStack) -> Column:
    return Column(np.zeros(1))


def raising(image: ImageStack) -> Column:
    raise KeyError("image")


def test_a_form_that_gives_the_same_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(largest, "stacked", good, raising=False)
    assert check_step(largest).n_values > 10


@pytest.mark.parametrize(
    ("form", "told"),
    [
        (all_done, "where the step raises there is no reading"),
        (another, r"its stacked form gives 2\.\d+, the step 1\.\d+"),
        (too_few, "gives no stack of as many values as it took"),
        (raising, "its stacked form raises KeyError"),
    ],
)
def test_a_form_that_does_not_is_told(
    form: object, told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(largest, "stacked", form, raising=False)
    with pytest.raises(BrokenPromises, match=told):
        check_step(largest)


def test_the_example_of_the_guide_keeps_its_promises(monkeypatch: pytest.MonkeyPatch) -> None:
    page = Path(__file__).parents[3] / "docs" / "plugins.md"
    blocks = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    (example,) = [b for b in blocks if "spread_stacked" in b]
    guide = ModuleType("guide")
    monkeypatch.setitem(sys.modules, "guide", guide)  # pickled by its name
    names: dict[str, Any] = vars(guide)
    exec(compile(example.replace("check_step(spread)", ""), str(page), "exec", 0, True), names)
    report = check_step(names["spread"])
    assert report.n_values > 10
    values = np.array([[[0.0, 2.0]], [[5.0, np.nan]]])
    found = names["spread_stacked"](ImageStack(values), factor=3.0)
    assert [found.values[0], *found.done.tolist()] == [6.0, True, False]
