"""Open, read and write a port, with pyserial's many ways to fail made into one."""

from __future__ import annotations

import contextlib
from types import ModuleType
from typing import Any
from urllib.parse import parse_qs, urlsplit

import serial

from tactile_graph.errors import TactileGraphError
from tactile_graph_sources.devices.preset import Transport

termios: ModuleType | None
try:
    import termios
except ImportError:  # not on Windows
    termios = None

# A pad pulled out shows as any of these: a bare OSError from in_waiting, termios.error from a
# flush, TypeError from a read that raced with a close.
_TERMIOS_ERRORS: tuple[type[Exception], ...] = () if termios is None else (termios.error,)
PORT_ERRORS: tuple[type[Exception], ...] = (OSError, TypeError, *_TERMIOS_ERRORS)

PORT_OR_VALUE: tuple[type[Exception], ...] = (
    *PORT_ERRORS,
    ValueError,
)  # a URL or baud rate that makes no sense
LARGEST_READ = 65536


class UnpluggedError(TactileGraphError):
    """The port went away, or never came."""


class Port:
    """An open port.

    Parameters
    ----------
    url : str
        A device such as ``/dev/ttyACM0`` or ``COM3``, or any pyserial URL.
    transport : Transport
    baud : int, optional
        Instead of the preset's.
    wait_s : float
        How long a read waits for the first byte.

    Raises
    ------
    UnpluggedError
        If it cannot be opened.
    """

    def __init__(self, url: str, transport: Transport, baud: int | None, wait_s: float) -> None:
        self.url = url
        self.wait_s = wait_s
        # Only a socket reports in_waiting as 0 or 1; there a read without waiting empties it.
        self._is_socket = url.startswith("socket://")
        try:
            _write_no_file(url)
            # dtr and rts must be set before open, or opening resets the board with the defaults.
            self._port: Any = serial.serial_for_url(url, do_not_open=True)
            self._port.baudrate = baud or transport.baud
            self._port.timeout = wait_s
            self._port.write_timeout = 1.0
            if transport.dtr is not None:
                self._port.dtr = transport.dtr
            if transport.rts is not None:
                self._port.rts = transport.rts
            if isinstance(self._port, serial.Serial):  # also by hwgrep://, spy:// and alt://
                self._port.exclusive = True  # two readers would each get half of the bytes
            self._port.open()
        except PORT_OR_VALUE as error:
            raise UnpluggedError(str(error)) from error

    def read(self) -> bytes:
        """Return what has come, waiting a little for the first byte; empty where nothing came."""
        try:
            first: bytes = self._port.read(1)
            return first + self._rest() if first else first
        except PORT_ERRORS as error:
            raise UnpluggedError(str(error) or type(error).__name__) from error

    def _rest(self) -> bytes:
        if self._is_socket:
            self._port.timeout = 0
            try:
                return bytes(self._port.read(LARGEST_READ))
            finally:
                self._port.timeout = self.wait_s
        waiting = min(self._port.in_waiting, LARGEST_READ)
        return bytes(self._port.read(waiting)) if waiting else b""

    def pending(self) -> bytes:
        """Return what has come already, without waiting."""
        try:
            if self._is_socket:
                return self._rest()
            waiting = self._port.in_waiting
            return bytes(self._port.read(waiting)) if waiting else b""
        except PORT_ERRORS as error:
            raise UnpluggedError(str(error) or type(error).__name__) from error

    def write(self, data: bytes) -> None:
        """Send bytes."""
        try:
            self._port.write(data)
        except PORT_ERRORS as error:
            raise UnpluggedError(str(error) or type(error).__name__) from error

    def close(self) -> None:
        """Close; a port that is gone already is fine."""
        with contextlib.suppress(*PORT_ERRORS):
            self._port.close()


def _write_no_file(url: str) -> None:
    """Raise ValueError if pyserial would empty a file, and write what comes and goes into it."""
    if url.lower().startswith("spy:") and "file" in parse_qs(urlsplit(url).query, True):
        raise ValueError("spy:// writes no file here; without its 'file=' it writes to stderr")
