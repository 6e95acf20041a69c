"""Who may ask: this machine's own pages, or who has the token; and what a page may load."""

from __future__ import annotations

import hmac
import ipaddress
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlsplit

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

COOKIE = "tactile_graph_token_{}"
"""By port: a browser hands cookies to every port of a host."""
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = (
    (b"content-security-policy", POLICY.encode()),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cache-control", b"no-cache"),
)
REFUSED = 4403
"""Code of a WebSocket that is not let in, where it has one."""


@dataclass(frozen=True)
class Door:
    """Where the page is served, and who is let in.

    Parameters
    ----------
    host : str
        The address that is listened on.
    port : int
    token : str
        What every request has to bring; empty for none, on loopback only.
    names : frozenset of str
        Names of this machine, by which a page may be asked for beside its addresses.
    """

    host: str
    port: int
    token: str = ""
    names: frozenset[str] = field(default_factory=frozenset)

    @property
    def loopback(self) -> bool:
        """Whether it is reached from this machine alone."""
        return is_loopback(self.host)

    @property
    def address(self) -> str:
        """The address to open, with the token that belongs to it."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        query = f"?token={self.token}" if self.token else ""
        return f"http://{host}:{self.port}/{query}"

    def trouble(self, scope: Scope) -> str:
        """Return why a request is refused; empty where it is let in."""
        headers = _headers(scope)
        host = headers.get("host", "")
        if not self._is_ours(host):
            return f"this page is served for {self._allowed()} only, not for {host[:80]!r}"
        origin = headers.get("origin")
        if origin is not None and not _same_place(origin, host):
            return f"a page of {origin[:80]!r} asks; only this server's own may"
        site = headers.get("sec-fetch-site", "same-origin")
        followed = (
            headers.get("sec-fetch-mode") == "navigate"
            and headers.get("sec-fetch-dest") == "document"
        )  # a link to the page itself; what it does then it does as our own
        if site not in ("same-origin", "none") and not followed:
            return "another site's page asks; only this server's own may"
        if self.token and not self._knows(scope, headers):
            return "the token is missing or wrong; open the address that the command printed"
        return ""

    def _allowed(self) -> str:
        return "this machine" if self.loopback else "addresses and names of this machine"

    def _is_ours(self, host: str) -> bool:
        """Return whether a request's Host is an address of ours: a foreign name may be rebound."""
        name, _ = _host_and_port(host)  # a tunnel may lead here from any port
        if name == "localhost" or name in self.names:
            return True
        try:
            address = ipaddress.ip_address(name)
        except ValueError:
            return False
        return address.is_loopback if self.loopback else True

    def _knows(self, scope: Scope, headers: dict[str, str]) -> bool:
        return any(
            hmac.compare_digest(given.encode(), self.token.encode())
            for given in _tokens(scope, headers, COOKIE.format(self.port))
        )

    def brings_token(self, scope: Scope) -> bool:
        """Return whether the right token stands in the address, to be kept in a cookie."""
        return bool(self.token) and any(
            hmac.compare_digest(given.encode(), self.token.encode()) for given in _queried(scope)
        )


def is_loopback(host: str) -> bool:
    """Return whether an address is reached from this machine alone."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


class Guard:
    """Lets in only who may, and gives every answer the headers that keep a page to itself.

    Parameters
    ----------
    app : callable
        What is guarded (ASGI).
    door : Door
    """

    def __init__(self, app: App, door: Door) -> None:
        self._app = app
        self._door = door

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Let a request in, or refuse it and say why."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        trouble = self._door.trouble(scope)
        if trouble and scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": REFUSED, "reason": trouble[:120]})
        elif trouble:
            await _refuse(send, trouble)
        else:
            await self._app(scope, receive, self._headed(scope, send))

    def _headed(self, scope: Scope, send: Send) -> Send:
        more = [*HEADERS]
        if scope["type"] == "http" and self._door.brings_token(scope):
            name = COOKIE.format(self._door.port)
            value = f"{name}={self._door.token}; Path=/; HttpOnly; SameSite=Strict"
            more.append((b"set-cookie", value.encode()))

        async def sent(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", ()), *more]
            await send(message)

        return sent


async def _refuse(send: Send, why: str) -> None:
    body = f"Not served: {why}.\n".encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), *HEADERS]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def _headers(scope: Scope) -> dict[str, str]:
    return {k.decode("latin-1").lower(): v.decode("latin-1") for k, v in scope["headers"]}


def _host_and_port(host: str) -> tuple[str, int | None]:
    try:
        parts = urlsplit(f"//{host}")
        return (parts.hostname or "", parts.port or 80)
    except ValueError:
        return "", None


def _same_place(origin: str, host: str) -> bool:
    return origin.partition("://")[0] in ("http", "https") and _host_and_port(
        origin.partition("://")[2]
    ) == _host_and_port(host)


def _queried(scope: Scope) -> Iterable[str]:
    return parse_qs(scope["query_string"].decode("latin-1")).get("token", [])


def _tokens(scope: Scope, headers: dict[str, str], name: str) -> Iterable[str]:
    """Yield the tokens a request brings: in the address, in a cookie, or as a bearer's."""
    yield from _queried(scope)
    kind, _, bearer = headers.get("authorization", "").partition(" ")
    if kind.lower() == "bearer":
        yield bearer.strip()
    try:
        cookie = SimpleCookie(headers.get("cookie", "")).get(name)
    except CookieError:
        return
    if cookie is not None:
        yield cookie.value
