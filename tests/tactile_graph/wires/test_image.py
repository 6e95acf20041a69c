"""``Image``: values that every step and every kernel takes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tactile_graph import Image


@pytest.mark.parametrize("kind", [np.float16, np.longdouble])
def test_what_no_machine_code_takes_becomes_double(kind: Any) -> None:
    image = Image(np.array([[0.5, 2.0]], dtype=kind))
    assert image.values.dtype == np.float64
    assert image.values.tolist() == [[0.5, 2.0]]
    assert not image.values.flags.writeable


@pytest.mark.parametrize("kind", [np.int16, np.float32, np.bool_])
def test_other_numbers_are_taken_as_they_are(kind: Any) -> None:
    values = np.array([[0, 1]], dtype=kind)
    assert Image(values).values is values
