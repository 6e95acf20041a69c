"""Who may ask, and what a page may load."""

from __future__ import annotations

import asyncio
from collections.abc import MutableMapping
from typing import Any

import pytest

from tactile_graph_live.server.guard import POLICY, Door, Guard

HERE = Door("127.0.0.1", 8765)
LAN = Door("0.0.0.0", 8765, "secret", frozenset({"bench", "bench.local"}))


def scope(query: str = "", kind: str = "http", **headers: str) -> dict[str, Any]:
    found = {"host": "127.0.0.1:8765", **{k.replace("_", "-"): v for k, v in headers.items()}}
    return {
        "type": kind,
        "query_string": query.encode(),
        "headers": [(k.encode(), v.encode("latin-1")) for k, v in found.items()],
    }


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8765", "localhost:8765", "[::1]:8765", "localhost:9000", "localhost"]
)
def test_this_machine_may_ask_through_a_tunnel_too(host: str) -> None:
    assert HERE.trouble(scope(host=host)) == ""
    assert (
        HERE.trouble(scope(host=host, origin=f"http://{host}", sec_fetch_site="same-origin")) == ""
    )


@pytest.mark.parametrize(
    "host",
    ["evil.example:8765", "127.0.0.1.evil.example", "", "192.168.1.5:8765", "localhost.evil",
     "[::1", "127.0.0.1:port", "a@localhost.example"],
)  # fmt: skip
def test_a_name_that_may_have_been_rebound_is_refused(host: str) -> None:
    assert "not for" in HERE.trouble(scope(host=host))


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "http://localhost:3000", "null", "http://127.0.0.1", "file://",
     "chrome-extension://127.0.0.1:8765"],
)  # fmt: skip
def test_another_sites_page_is_refused(origin: str) -> None:
    assert "only this server's own may" in HERE.trouble(scope(origin=origin))


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_site_loads_is_refused_even_without_an_origin(site: str) -> None:
    assert "another site's page" in HERE.trouble(scope(sec_fetch_site=site))


def test_a_link_to_the_page_may_be_followed_from_anywhere() -> None:
    followed = scope(
        sec_fetch_site="cross-site", sec_fetch_mode="navigate", sec_fetch_dest="document"
    )
    assert HERE.trouble(followed) == ""
    framed = scope(sec_fetch_site="cross-site", sec_fetch_mode="navigate", sec_fetch_dest="iframe")
    assert "another site's page" in HERE.trouble(framed)


def test_any_other_address_wants_the_token() -> None:
    assert "token" in LAN.trouble(scope(host="192.168.1.5:8765"))
    assert "token" in LAN.trouble(scope("token=secre", host="192.168.1.5:8765"))
    assert LAN.trouble(scope("token=secret", host="192.168.1.5:8765")) == ""
    assert LAN.trouble(scope(host="bench.local:8765", authorization="Bearer secret")) == ""
    assert LAN.trouble(scope(host="bench:8765", cookie="tactile_graph_token_8765=secret")) == ""
    assert "token" in LAN.trouble(scope(host="bench", cookie="tactile_graph_token_8765=sécret"))
    assert "not for" in LAN.trouble(scope("token=secret", host="evil.example:8765"))


def test_the_printed_address_holds_the_token() -> None:
    assert LAN.address == "http://0.0.0.0:8765/?token=secret"
    assert HERE.address == "http://127.0.0.1:8765/"
    assert Door("::1", 80).address == "http://[::1]:80/"


def answered(door: Door, asked: dict[str, Any]) -> list[MutableMapping[str, Any]]:
    """Return what a guarded application sends."""
    sent: list[MutableMapping[str, Any]] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive() -> MutableMapping[str, Any]:
        return {"type": "websocket.connect"}

    async def send(message: MutableMapping[str, Any]) -> None:
        sent.append(message)

    asyncio.run(Guard(app, door)(asked, receive, send))
    return sent


def test_every_answer_carries_the_policy_and_a_refusal_says_why() -> None:
    (start,) = answered(HERE, scope())
    assert (b"content-security-policy", POLICY.encode()) in start["headers"]
    refused, body = answered(HERE, scope(host="evil.example"))
    assert refused["status"] == 403
    assert (b"content-security-policy", POLICY.encode()) in refused["headers"]
    assert b"for this machine only" in body["body"]


def test_a_page_may_load_nothing_from_elsewhere_and_run_nothing_written_in_it() -> None:
    assert POLICY.startswith("default-src 'none'")
    assert "unsafe" not in POLICY
    assert "http" not in POLICY


def test_the_token_of_the_address_is_kept_in_a_cookie_no_script_sees() -> None:
    (start,) = answered(LAN, scope("token=secret", host="bench:8765"))
    (cookie,) = [v for k, v in start["headers"] if k == b"set-cookie"]
    assert cookie == b"tactile_graph_token_8765=secret; Path=/; HttpOnly; SameSite=Strict"
    (start,) = answered(LAN, scope(host="bench", authorization="Bearer secret"))
    assert not [v for k, v in start["headers"] if k == b"set-cookie"]


def test_a_websocket_that_may_not_is_closed_before_it_opens() -> None:
    (sent,) = answered(HERE, scope(kind="websocket", origin="http://evil.example"))
    assert (sent["type"], sent["code"]) == ("websocket.close", 4403)
