"""A session served: its address taken, its page up, everything ended when it is told to."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import re
import secrets
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from types import FrameType

import uvicorn

from tactile_graph.errors import UsageError
from tactile_graph_live.bench.process import ENDS
from tactile_graph_live.server.app import make_app
from tactile_graph_live.server.guard import Door, is_loopback
from tactile_graph_live.server.session import Say, Session, Setup

LARGEST_MESSAGE = 64 * 1024
"""Bytes that a page may send at once."""
MOST_BACKLOG = 64
PORTS_TRIED = 50
FAREWELL_S = 1
TOKEN = re.compile(r"[A-Za-z0-9._~-]{1,200}")
"""What stands in an address and in a cookie as it is."""


def taken_door(host: str, port: int, token: str = "") -> tuple[Door, socket.socket]:
    """Return where the page will be, and the socket that listens there.

    Parameters
    ----------
    host : str
    port : int
        0 for any that is free.
    token : str
        What requests have to bring; made up where the address is no loopback and none is given.

    Raises
    ------
    UsageError
        If the port is taken, the address is none of this machine's, or the token cannot stand in
        an address.
    """
    if token and not TOKEN.fullmatch(token):
        raise UsageError("--token: must be of letters, digits, '-', '_', '.' and '~', 200 at most")
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise UsageError(f"--host {host}: {error.strerror or error}") from None
    listener = _bound(found[0], found[4], host, port)
    name = socket.gethostname().lower()
    names = frozenset({host.lower(), name, f"{name}.local"})
    if not is_loopback(host):
        token = token or secrets.token_urlsafe(16)
    return Door(host, int(listener.getsockname()[1]), token, names), listener


def _bound(
    family: int, address: tuple[str | int, ...] | tuple[int, bytes], host: str, port: int
) -> socket.socket:
    # With the protocol named, asyncio sends at once what it is given (TCP_NODELAY): a picture
    # behind a pulse waited 40 ms for the viewer's acknowledgement.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        if sys.platform != "win32":  # there it would let two listen on one port
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(address)
        listener.listen(MOST_BACKLOG)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            free = _free_port(family, host, port)
            hint = f"--http-port {free} is free" if free else "name another by --http-port"
            raise UsageError(f"port {port} of {host} is taken; {hint}") from None
        why = error.strerror or error
        raise UsageError(f"cannot serve on {host}, port {port}: {why}") from None
    return listener


def _free_port(family: int, host: str, port: int) -> int:
    """Return the next port that is free; 0 if none is near."""
    for near in range(port + 1, min(port + PORTS_TRIED, 65535)):
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            try:
                probe.bind((host, near))
            except OSError:
                continue
            return near
    return 0


class _Server(uvicorn.Server):
    """Uvicorn's, which leaves signals to us."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Capture none."""
        yield


async def serve(
    setup: Setup, door: Door, listener: socket.socket, say: Say, begun: Callable[[], None]
) -> tuple[Session, int]:
    """Serve until a signal comes or nothing can be shown; return the session and the signal.

    Parameters
    ----------
    setup : Setup
    door : Door
    listener : socket
        Listens where the door is.
    say : callable
    begun : callable
        Called once the page can be opened.

    Returns
    -------
    session : Session
    number : int
        Of the signal that ended it; 0 for none.

    Raises
    ------
    UsageError
        If no frame could be had of the source, or the bench cannot be kept running.
    """
    session = await asyncio.to_thread(Session, setup, say)
    config = uvicorn.Config(
        make_app(session, door),
        log_level="critical",
        access_log=False,
        server_header=False,
        ws_max_size=LARGEST_MESSAGE,
        ws_per_message_deflate=False,
        timeout_graceful_shutdown=FAREWELL_S,
        lifespan="off",
    )
    server = _Server(config)
    with _signals(session.over) as came, quiet_about_the_gone():
        running = asyncio.create_task(session.run())
        serving = asyncio.create_task(server.serve(sockets=[listener]))
        over = asyncio.create_task(session.over.wait())
        begun()
        try:
            await asyncio.wait({running, serving, over}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            running.cancel()
            over.cancel()
            await session.close()
            server.should_exit = True
            await asyncio.gather(running, serving, over, return_exceptions=True)
    if session.failure:
        raise UsageError(session.failure)
    for task in (running, serving):
        if not task.cancelled() and (error := task.exception()) is not None:
            raise error
    return session, came[0] if came else 0


@contextlib.contextmanager
def quiet_about_the_gone() -> Iterator[None]:
    """While entered, asyncio does not log what is sent to a viewer that left without a word."""
    logger = logging.getLogger("asyncio")

    def is_worth_a_line(record: logging.LogRecord) -> bool:
        return not record.getMessage().startswith("socket.send() raised exception")

    logger.addFilter(is_worth_a_line)
    try:
        yield
    finally:
        logger.removeFilter(is_worth_a_line)


@contextlib.contextmanager
def _signals(over: asyncio.Event) -> Iterator[list[int]]:
    """While entered, signals that end programs set ``over``; those that are ignored stay so."""
    came: list[int] = []
    loop = asyncio.get_running_loop()

    def end(number: int, _frame: FrameType | None) -> None:
        came.append(number)
        loop.call_soon_threadsafe(over.set)

    before = {n: signal.getsignal(n) for n in ENDS}
    try:
        for number, handler in before.items():
            if handler is not signal.SIG_IGN:
                signal.signal(number, end)
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
