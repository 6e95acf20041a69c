"""What a plugin does while it is imported costs only the plugin, and is told by its name."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from types import ModuleType

import pytest

from tactile_graph.plugins import foreign_code as module
from tactile_graph.plugins.foreign_code import Broken, foreign_code
from tactile_graph.plugins.registry import Registry


class Boom(BaseException):
    pass


class OddError(Exception):
    def __str__(self) -> str:
        raise ValueError


def registry(load: Callable[[], ModuleType]) -> Registry:
    rows = [("bad", load), ("good", lambda: ModuleType("good"))]
    return Registry([(name, f"{name}-package", "1.0", loader) for name, loader in rows])


@pytest.mark.parametrize(
    "error", [Boom("no"), KeyboardInterrupt(), SystemExit(0), MemoryError(), OddError()]
)
def test_whatever_a_plugin_raises_costs_only_the_plugin(error: BaseException) -> None:
    def load() -> ModuleType:
        raise error

    bad, good = registry(load).plugins
    assert bad.error.startswith(type(error).__name__)
    assert "test_foreign_code.py" in bad.error
    assert (good.error, good.offers["steps"]) == ("", {})


def test_what_a_plugin_prints_goes_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    def load() -> ModuleType:
        print("hello from a plugin")  # noqa: T201
        return ModuleType("bad")

    registry(load)
    assert capsys.readouterr() == ("", "hello from a plugin\n")


def test_what_a_plugin_writes_to_the_descriptor_goes_to_stderr(
    capfd: pytest.CaptureFixture[str],
) -> None:
    def load() -> ModuleType:
        os.write(1, b"SDK 2.1 loaded\n")
        return ModuleType("bad")

    print("before", end="")  # noqa: T201
    registry(load)
    print(", after")  # noqa: T201
    assert capfd.readouterr() == ("before, after\n", "SDK 2.1 loaded\n")


def test_threads_that_import_at_once_leave_stdout_where_it_was(
    capfd: pytest.CaptureFixture[str],
) -> None:
    """The first one to end puts nothing back that the second would take for the usual."""
    inside, over = threading.Event(), threading.Event()

    def second() -> None:
        with foreign_code("b", "plugin"):
            inside.set()
            over.wait(30.0)

    before = sys.stdout
    thread = threading.Thread(target=second)
    with foreign_code("a", "plugin"):
        thread.start()
        assert inside.wait(30.0)
    over.set()
    thread.join()
    os.write(1, b"after\n")
    assert sys.stdout is before
    assert capfd.readouterr() == ("after\n", "")


def test_a_plugin_is_imported_where_stdout_is_closed(capfd: pytest.CaptureFixture[str]) -> None:
    kept = os.dup(1)
    os.close(1)
    try:
        plugins = registry(lambda: ModuleType("bad")).plugins
    finally:
        os.dup2(kept, 1)
        os.close(kept)
    assert [p.error for p in plugins] == ["", ""]


def test_ctrl_c_during_an_import_is_no_fault_of_the_plugin() -> None:
    def load() -> ModuleType:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(1.0)
        return ModuleType("bad")

    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        registry(load)
    assert signal.getsignal(signal.SIGINT) is before


def test_ctrl_c_stays_what_it_is_when_what_is_imported_makes_another_error_of_it() -> None:
    def load() -> ModuleType:
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)
        except BaseException as error:  # as compiled code does
            raise ValueError("cannot be built") from error
        return ModuleType("bad")

    with pytest.raises(KeyboardInterrupt):
        registry(load)


def test_ctrl_c_that_what_is_imported_passes_over_comes_when_it_is_imported() -> None:
    def load() -> ModuleType:
        with contextlib.suppress(BaseException):  # as a module that does without another one
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)
        return ModuleType("bad")

    with pytest.raises(KeyboardInterrupt):
        registry(load)


def test_a_handler_that_a_plugin_sets_stays() -> None:
    before = signal.signal(signal.SIGTERM, lambda number, frame: None)
    try:
        with foreign_code("mine", "plugin 'mine'"):
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGTERM, before)


def test_an_import_that_hangs_is_told_by_name(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert module.SLOW_S == 5.0
    monkeypatch.setattr(module, "SLOW_S", 0.05)
    with foreign_code("slow", "plugin 'slow' (package p)"):
        time.sleep(0.3)
    told = "plugin 'slow' (package p) is still being imported after 0.05 s"
    assert capsys.readouterr().err == f"{told}; --plugins=-slow does without it\n"


def test_a_quick_import_is_not_told_of(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(module, "SLOW_S", 0.2)
    with foreign_code("quick", "plugin 'quick'"):
        pass
    time.sleep(0.3)
    assert capsys.readouterr().err == ""


def test_what_was_raised_is_the_cause() -> None:
    error = Boom()
    with pytest.raises(Broken) as got, foreign_code("mine", "plugin 'mine'"):
        raise error
    assert got.value.error is error
