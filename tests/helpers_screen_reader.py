"""A screen reader that really reads: Orca and a browser, with screen, bus and home of their own.

What it says is taken from its log, so nothing needs to sound.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

PROGRAMS = ("orca", "Xvfb", "xdotool", "dbus-daemon", "gsettings")
SAID = re.compile(r"SPEECH OUTPUT: '(.*?)'(?:\{|$)", re.MULTILINE)


def lacking() -> list[str]:
    """Return the programs that are not on the PATH."""
    return [name for name in PROGRAMS if shutil.which(name) is None]


class Reader:
    """A screen reader, and the browser that it reads.

    Attributes
    ----------
    page : playwright.sync_api.Page
        The page in the browser's only window.
    """

    def __init__(self, page: Any, log: Path, env: dict[str, str]) -> None:
        self.page = page
        self._log = log
        self._env = env
        self._at = 0

    def said(self) -> list[str]:
        """Return what was said since last asked."""
        with self._log.open("rb") as file:
            file.seek(self._at)
            new = file.read()
        new = new[: new.rfind(b"\n") + 1]
        self._at += len(new)
        return [" ".join(s.split()) for s in SAID.findall(new.decode(errors="replace"))]

    def hears(
        self,
        holds: Callable[[str], object],
        what: str,
        within_s: float = 20.0,
        quiet_s: float = 0.0,
    ) -> list[str]:
        """Wait until what was said, taken together, is as it should be; return all of it."""
        said, end = list[str](), time.monotonic() + within_s
        while not holds(" | ".join(said)):
            assert time.monotonic() < end, f"not said within {within_s:g} s: {what}; but {said}"
            time.sleep(0.05)
            said += self.said()
        while quiet_s:
            time.sleep(quiet_s)
            more = self.said()
            if not more:
                break
            said += more
        return said

    def press(self, *keys: str) -> None:
        """Press keys as hands do; the screen reader sees them before the browser."""
        self.said()
        subprocess.run(["xdotool", "key", "--clearmodifiers", *keys], env=self._env, check=True)

    def press_and_hear(self, key: str, words: str, **how: Any) -> list[str]:
        """Press a key and wait until all of these words were said."""
        self.press(key)
        return self.hears(lambda text: all(w in text for w in words.split(" + ")), words, **how)


@contextmanager
def screen_reader(executable: str, options: list[str], home: Path) -> Iterator[Reader]:
    """Start a screen with a browser and a screen reader; all end with it.

    Parameters
    ----------
    executable, options : str, list of str
        The browser and how it is started.
    home : Path
        A directory for what they keep.
    """
    from playwright.sync_api import sync_playwright

    env = _own_env(home)
    with ExitStack() as stack:
        bus = _started(stack, env, "dbus-daemon", "--session", "--nofork", "--print-address=1")
        env["DBUS_SESSION_BUS_ADDRESS"] = _first_line(bus)
        screen = _started(
            stack,
            env,
            "Xvfb",
            "-displayfd",
            "1",
            "-screen",
            "0",
            "1440x1000x24",
            "-nolisten",
            "tcp",
        )
        env["DISPLAY"] = f":{_first_line(screen)}"
        setting = ("org.gnome.desktop.interface", "toolkit-accessibility", "true")
        subprocess.run(["gsettings", "set", *setting], env=env, check=True, capture_output=True)
        log = home / "said.log"
        _started(stack, env, "orca", "--replace", f"--debug-file={log}")
        playwright = stack.enter_context(sync_playwright())
        browser = playwright.chromium.launch(
            executable_path=executable, headless=False, env=env,
            args=[*options, "--force-renderer-accessibility", "--window-size=1440,1000",
                  "--window-position=0,0"],
        )  # fmt: skip
        stack.callback(browser.close)
        page = browser.new_page(no_viewport=True)
        yield _ready(Reader(page, log, env))


def _own_env(home: Path) -> dict[str, str]:
    runtime = home / "run"
    runtime.mkdir(mode=0o700, parents=True)
    left_out = ("DISPLAY", "WAYLAND_DISPLAY", "DBUS_SESSION_BUS_ADDRESS", "NO_AT_BRIDGE")
    env = {k: v for k, v in os.environ.items() if k not in left_out and not k.startswith("XDG_")}
    return env | {"HOME": str(home), "XDG_RUNTIME_DIR": str(runtime), "LC_ALL": "C.UTF-8"}


def _started(stack: ExitStack, env: dict[str, str], *command: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        command, env=env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    )
    stack.callback(_end, process)
    return process


def _end(process: subprocess.Popen[str]) -> None:
    process.terminate()
    try:
        process.communicate(timeout=5)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()


def _first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    line = process.stdout.readline().strip()
    assert line, f"{process.args} ended at once"
    return line


def _ready(reader: Reader) -> Reader:
    """Wait until both talk to each other."""
    log = reader._log
    end = time.monotonic() + 60
    while not log.exists():
        assert time.monotonic() < end, "the screen reader does not start"
        time.sleep(0.1)
    reader.hears(lambda text: "Screen reader on" in text, "that it is on", 60)
    return reader
