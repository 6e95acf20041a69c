"""``StressCases``: one set of cases, and the steps they are for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from tactile_graph_stress.case import Case
from tactile_graph_stress.subject import Subject


class StressCases(NamedTuple):
    """One set of cases.

    Attributes
    ----------
    suits : callable
        Whether they are for a step, told by its name, what it is fed (``feed``), and what it is
        stressed as (``kind``).
    make : callable
        Yields the cases, few of them where the last argument is true. What it draws is of the seed
        and the step's kind: steps of one kind are tried on the same.
    """

    suits: Callable[[Subject], bool]
    make: Callable[[Subject, np.random.Generator, bool], Iterator[Case]]
