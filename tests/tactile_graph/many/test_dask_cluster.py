"""``--on tcp://…``: the workers of a Dask cluster, which the test starts."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from helpers_many import command, ran, ran_here, surroundings, write_plugin
from tactile_graph.errors import UsageError
from tactile_graph.many.executor_kind import place_of

distributed = pytest.importorskip("distributed", reason="the 'cluster' extra is not installed")
pytest.importorskip("zarr", reason="the 'zarr' extra is not installed")
pytestmark = pytest.mark.slow
CLUSTER = """
import sys
import threading

import dask
from distributed import LocalCluster

dask.config.set({
    "distributed.scheduler.allowed-failures": 0, "distributed.deploy.lost-worker-timeout": "2s",
})
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        reading = threading.Thread(target=sys.stdin.read, daemon=True)
        reading.start()
        while reading.is_alive():
            reading.join(1.0)
            cluster.scale(2)  # on a busy machine a worker may die as it is started anew
"""
NOBODY = """
import sys
from distributed import LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=0, threads_per_worker=1, dashboard_address=None) as cluster:
        print(cluster.scheduler_address, flush=True)
        sys.stdin.readline()
        cluster.scale(1)
        sys.stdin.read()
"""
BUSY = """
import sys, time
from distributed import Client

if __name__ == "__main__":
    with Client(sys.argv[1]) as client:
        others = client.map(time.sleep, [0.02] * 300, pure=False)
        print("busy", flush=True)
        sys.stdin.read()
"""


def started(folder: Path, code: str, *words: str) -> subprocess.Popen[str]:
    """Return a process of its own, which ends when its standard input does."""
    script = folder / f"script{len(list(folder.glob('script*')))}.py"
    script.write_text(code)
    return subprocess.Popen(
        [sys.executable, str(script), *words], cwd=folder, env=surroundings(folder), text=True,
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip


def ended(process: subprocess.Popen[str]) -> None:
    process.communicate(timeout=60)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("cluster")
    write_plugin(path)
    got = ran_here(path, "convert", "a.zarr", "--source", "simulate", "--with", "frames=600")
    assert got.returncode == 0, got.stderr
    return path


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    """Yield where the scheduler of two worker processes is."""
    cluster = started(folder, CLUSTER)  # which gives up a call when its first worker has died
    assert cluster.stdout is not None
    found = cluster.stdout.readline().strip()
    assert re.match(r"tcp://", found)
    yield found
    ended(cluster)


def both(folder: Path, address: str, *words: str) -> tuple[bytes, bytes, str]:
    """Return what one process writes and what the cluster does, and what was said of the latter."""
    for name, more in (("one.csv", ()), ("cluster.csv", ("--on", address))):
        got = (ran if more else ran_here)(folder, "run", *words, "-o", name, *more)
        assert got.returncode == 0, got.stderr
    return (folder / "one.csv").read_bytes(), (folder / "cluster.csv").read_bytes(), got.stderr


@pytest.mark.parametrize("source", [
    ("a.zarr",), ("--source", "simulate", "--frames", "200"),
], ids=["in place", "sent"])  # fmt: skip
def test_a_cluster_writes_what_one_process_does(
    folder: Path, address: str, source: tuple[str, ...]
) -> None:
    one, cluster, _ = both(folder, address, "circle-1", *source)
    assert one == cluster


def test_an_overloaded_scheduler_is_waited_for(folder: Path, address: str) -> None:
    others = started(folder, BUSY, address)
    assert others.stdout is not None
    assert others.stdout.readline() == "busy\n"
    begun = time.monotonic()
    one, cluster, said = both(folder, address, "circle-1", "a.zarr")
    assert one == cluster
    assert "600 frames" in said
    assert time.monotonic() - begun < 240
    ended(others)


def test_a_cluster_without_workers_is_waited_for_and_told(folder: Path) -> None:
    cluster = started(folder, NOBODY)
    assert cluster.stdout is not None
    assert cluster.stdin is not None
    words = command("run", "circle-1", "a.zarr", "-o", "late.csv", "--on")
    run = subprocess.Popen(
        [*words, cluster.stdout.readline().strip()], cwd=folder, env=surroundings(folder),
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert run.stderr is not None
    assert run.stderr.readline() == "a Dask cluster: there is no worker; waiting for one\n"
    cluster.stdin.write("now\n")
    cluster.stdin.flush()
    said = run.communicate(timeout=240)[1]
    assert run.returncode == 0
    assert "600 frames" in said
    assert "waiting" not in said
    ended(cluster)


def test_a_frame_of_which_the_clusters_workers_die_is_left_out(folder: Path, address: str) -> None:
    got = ran(folder, "run", "deadly.yaml", "a.zarr", "--frames", "12", "--on", address,
              "--set", "image.at=[5]", "-o", "d.csv")  # fmt: skip
    assert "frame 5: workers died of it each time: left out" in got.stderr
    assert got.returncode == 1
    assert len((folder / "d.csv").read_text().splitlines()) == 12


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("port", ["9", "port"])
def test_nobody_at_an_address_is_told(port: str) -> None:
    with pytest.raises(UsageError, match="no scheduler answers there"):
        place_of(f"tcp://127.0.0.1:{port}", None).opened()


def test_a_comparison_on_a_cluster_is_that_of_one_process(folder: Path, address: str) -> None:
    for name, more in (("one.csv", ()), ("cluster.csv", ("--on", address))):
        words = ("circle-1", "circle-3", "a.zarr", "--frames", "120", "--csv", name)
        got = (ran if more else ran_here)(folder, "compare", *words, *more)
        assert got.returncode == 0, got.stderr
    assert (folder / "one.csv").read_bytes() == (folder / "cluster.csv").read_bytes()
    assert "several workers side by side" in " ".join((got.stdout + got.stderr).split())
