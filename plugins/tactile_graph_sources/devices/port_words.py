"""Why a port cannot be opened, in words, and what to do."""

from __future__ import annotations

import errno
import os
import re

from tactile_graph.errors import did_you_mean, one_of

BUSY = (errno.EAGAIN, errno.EBUSY)
FORBIDDEN = (errno.EACCES, errno.EPERM)
NO_PORT = (errno.EISDIR, errno.ENOTTY)
TAKEN = "another program has it open"
NETWORK = ("socket", "rfc2217")
_WITHIN = re.compile(r"Error\((?P<number>\d+), (?P<quote>['\"])(?P<why>.*?)(?P=quote)[,)]")
"""On Windows pyserial tells the system's error within its text alone, as Python shows it."""


def refusal(port: str, error: BaseException, ports: list[str]) -> str:
    """Return what to say when a port cannot be opened.

    Parameters
    ----------
    port : str
        As it was given.
    error : Exception
        What pyserial raised.
    ports : list of str
        The ports of this machine.
    """
    there = f"; ports here: {one_of(ports)}"
    number = getattr(error, "errno", None)
    within = _WITHIN.search(str(error)) if number is None else None
    if within is not None:  # a port that is open is opened by nobody else there, whoever asks
        number = int(within["number"])
        number = errno.EBUSY if number == errno.EACCES else number
    head = f"port {port!r} cannot be opened: "
    if "://" in port:
        return head + _of_url(port, error)
    if number in BUSY:
        return head + TAKEN
    if number in FORBIDDEN:
        return f"{head}permission denied{_who_may(port)}"
    if number == errno.ENOENT:
        return f"{head}there is no such port{did_you_mean(port, ports)}{there}"
    if number in NO_PORT or "configure port" in str(error):
        return f"{head}it is no serial port{there}"
    return f"{head}{_last(error)}{there}"


def _of_url(port: str, error: BaseException) -> str:
    scheme, _, place = port.partition("://")
    host, _, number = place.partition(":")
    if scheme in NETWORK and not (host and number):
        return f"it names no host and port; a URL is like {scheme}://host:port"
    if scheme not in NETWORK and getattr(error, "errno", None) in BUSY:
        return TAKEN
    hint = "" if scheme in NETWORK else "; a URL is like socket://host:port"
    return f"{_last(error)}{hint}"


def _last(error: BaseException) -> str:
    """Return the end of pyserial's text: before it stand the port and the number once more."""
    text = str(error) or type(error).__name__
    if within := _WITHIN.search(text):
        return within["why"]
    return text.rpartition("] ")[2] if "[Errno" in text else text


def _who_may(port: str) -> str:
    """Return how to be let in, where the port belongs to a group as on Linux."""
    try:
        import grp

        group = grp.getgrgid(os.stat(port).st_gid).gr_name
    except (ImportError, OSError, KeyError):
        return ""
    return (
        f"; it belongs to the group {group!r}: 'sudo usermod -aG {group} $USER' lets you in "
        "when you log in next"
        if group != "root"
        else ""
    )
