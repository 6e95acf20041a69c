"""Profiles of Hypothesis, and how tests are shared out among processes.

The profile ``fast`` draws the same examples every time, ``full`` new ones;
``HYPOTHESIS_PROFILE=full`` or ``--hypothesis-profile=full`` chooses, ``fast`` otherwise.
"""

from __future__ import annotations

import gc
import os
import re
import shutil
import signal
import sys
import tempfile
from collections.abc import Generator, Iterator
from contextlib import nullcontext, suppress
from pathlib import Path

# Each process has a core: BLAS's threads would wait for each other, busily, at every small matrix.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest
from hypothesis import settings

from helpers_modes import answered_by, cool_down
from tactile_graph.compiled import warm_up

pytest_plugins = ["tactile_graph.testing.pytest_plugin"]
settings.register_profile("fast", derandomize=True, deadline=None)
settings.register_profile("full", deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "fast"))


def pytest_configure(config: pytest.Config) -> None:
    """Set up what a terminal and a usual environment give to every process."""
    _take_ctrl_c()
    if sys.dont_write_bytecode:
        _share_bytecode(config)


def _take_ctrl_c() -> None:
    """Take Ctrl-C as a terminal gives it: a shell without jobs has its background ignore it."""
    for name in ("SIGINT", "SIGHUP"):  # the latter is not on Windows
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_IGN:
            usual = signal.default_int_handler if name == "SIGINT" else signal.SIG_DFL
            signal.signal(number, usual)


def _share_bytecode(config: pytest.Config) -> None:
    """Keep bytecode for the length of the run, out of the way, where none is to be written.

    Each process that tests start would otherwise translate the libraries it imports, for seconds.
    """
    folder = tempfile.mkdtemp(prefix="bytecode-")
    config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))
    sys.dont_write_bytecode, sys.pycache_prefix = False, folder
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # not there under `python -B`
    os.environ["PYTHONPYCACHEPREFIX"] = folder


ALL_SLOW = re.compile(r"^pytestmark = (\[\s*)?pytest\.mark\.slow\b", re.MULTILINE)
"""How a module says first that all of its tests are slow."""


def _is_short(config: pytest.Config) -> bool:
    return bool(config.getoption("markexpr") == "not slow")


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave modules of slow tests alone unread in a short run, where none would be chosen."""
    is_module = collection_path.suffix == ".py" and _is_short(config)
    return (is_module and bool(ALL_SLOW.search(collection_path.read_text("utf-8")))) or None


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Generator[None, object, object]:
    """Look for no garbage in what is imported and collected, now or later: it stays.

    That takes a third of the time otherwise.
    """
    gc.disable()
    try:
        if os.environ.get("PYTEST_XDIST_WORKER") == "gw1":
            _import_from_the_end(session)
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def _import_from_the_end(session: pytest.Session) -> None:
    """Import what is collected in a moment, the last first.

    In a fresh environment modules are translated as they are imported. The first process starts
    at the front, so that each finds half of them done; trouble is told when they are collected.
    """
    for path in sorted(Path(__file__).parent.rglob("test_*.py"), reverse=True):
        if pytest_ignore_collect(path, session.config):
            continue
        with suppress(pytest.Collector.CollectError, pytest.skip.Exception):
            pytest.Module.from_parent(session, path=path)._getobj()


BY_LOOPS = tuple(
    Path(__file__).parent / room
    for room in (
        "docs", "tactile_graph/testing", "tactile_graph_classifiers",
        "tactile_graph_filters/morphology", "tactile_graph_filters/parting",
        "tactile_graph_fitters", "tactile_graph_hull", "tactile_graph_likelihood",
        "tactile_graph_mrf/contours", "tactile_graph_mrf/descent", "tactile_graph_mrf/energy",
        "tactile_graph_mrf/samplers/test_gibbs.py", "tactile_graph_pipelines",
        "tactile_graph_thesis/items/test_items.py", "tactile_graph_thesis/measure",
    )
)  # fmt: skip
"""Tests that plain loops answer sooner than the compiler has made machine code for them."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Count the cases of tests that machine code is made for among the slow ones."""
    for item in items:
        case = getattr(item, "callspec", None)
        if case is not None and "compiled" in case.id.split("-"):
            item.add_marker("slow")


@pytest.fixture(autouse=True, scope="module")
def quick_by_loops(request: pytest.FixtureRequest) -> Iterator[None]:
    """Have nobody wait for the compiler in a run that leaves the slow tests out.

    What compares machine code with loops compiles all the same. A run of all tests has kernels
    answer as users' do.
    """
    rooms = {request.path, *request.path.parents}
    quick = _is_short(request.config) and not rooms.isdisjoint(BY_LOOPS)
    with answered_by("plain") if quick else nullcontext():
        yield


@pytest.fixture(autouse=True)
def cool_kernels() -> Iterator[None]:
    """Whatever a test warms up is for that test alone."""
    yield
    cool_down()


@pytest.fixture
def warm_kernels() -> None:
    """Machine code from the first call on, as for live sources.

    For tests with much to do: plain loops would take long, and have those below them compiled
    for themselves.
    """
    warm_up()


@pytest.fixture
def plain_kernels() -> Iterator[None]:
    """Loops and references only, but for what a test asks to be ``compiled``.

    Loops would otherwise have the kernels they call compiled one by one.
    """
    with answered_by("plain"):
        yield


@pytest.fixture
def compiled_kernels() -> Iterator[None]:
    """Machine code only, from the first call on: for what loops would take minutes over.

    Only for what other tests compile as well, or the compiler takes as long.
    """
    with answered_by("compiled"):
        yield


def pytest_xdist_auto_num_workers(config: pytest.Config) -> int | None:
    """Keep single files and single tests in this process: starting others takes longer."""
    asked = [Path(arg.partition("::")[0]) for arg in config.args]
    return 0 if all(path.suffix == ".py" for path in asked) else None
