"""Which executor ``--on`` names."""

from __future__ import annotations

import pytest

from tactile_graph.errors import UsageError
from tactile_graph.many.dask_cluster import DASK
from tactile_graph.many.executor_kind import place_of
from tactile_graph.many.processes import PROCESSES, most_workers


def test_processes_of_this_machine_are_usual() -> None:
    assert place_of(None, 3) == (PROCESSES, "", 3)
    assert place_of("processes", None) == (PROCESSES, "", None)


def test_an_address_is_of_who_takes_its_scheme_or_is_named() -> None:
    assert place_of("tcp://here:8786", None) == (DASK, "tcp://here:8786", None)
    assert place_of("dask=tls://here:8786", 2) == (DASK, "tls://here:8786", 2)


@pytest.mark.parametrize("on", ["proceses", "http://here", ""])
def test_what_nobody_offers_is_refused_by_name(on: str) -> None:
    if not on:
        assert place_of(on, None).kind is PROCESSES
        return
    with pytest.raises(UsageError, match=r"is no executor.*dask, processes"):
        place_of(on, None)


def test_processes_have_no_address() -> None:
    with pytest.raises(UsageError, match="processes are on this machine; no address"):
        place_of("processes=there", None).opened()


def test_processes_far_beyond_the_cores_are_not_started() -> None:
    workers = place_of(None, 500).opened()
    workers.end()
    assert workers.n_workers == min(500, most_workers())


def test_a_cluster_has_one() -> None:
    with pytest.raises(UsageError, match="give the scheduler's address"):
        place_of("dask", None).opened()
