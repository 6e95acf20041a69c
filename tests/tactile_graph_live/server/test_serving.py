"""Where the page is served."""

from __future__ import annotations

import asyncio
import socket
import struct

import pytest

pytest.importorskip("uvicorn", reason="the live extra is not installed")

from tactile_graph.errors import UsageError
from tactile_graph_live.server.serving import quiet_about_the_gone, taken_door


def test_small_messages_are_not_held_back_for_the_next() -> None:
    """asyncio sets TCP_NODELAY only where a socket names its protocol."""
    door, listener = taken_door("127.0.0.1", 0)
    with listener:
        assert listener.proto == socket.IPPROTO_TCP
        assert door.port == listener.getsockname()[1]
        assert (door.loopback, door.token) == (True, "")


def test_an_address_that_others_reach_has_a_token_of_its_own_each_time() -> None:
    tokens = set()
    for _ in range(2):
        door, listener = taken_door("0.0.0.0", 0)
        listener.close()
        tokens.add(door.token)
    assert len(tokens) == 2
    assert min(map(len, tokens)) >= 20
    door, listener = taken_door("0.0.0.0", 0, "mine")
    listener.close()
    assert door.token == "mine"


def test_a_port_that_is_taken_is_said_with_one_that_is_free() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(UsageError, match=rf"port {port} of 127\.0\.0\.1 is taken; --http-port"):
            taken_door("127.0.0.1", port)


def test_what_is_no_address_of_this_machine_is_refused() -> None:
    with pytest.raises(UsageError, match=r"cannot serve on 203\.0\.113\.7"):
        taken_door("203.0.113.7", 0)
    with pytest.raises(UsageError, match="--host"):
        taken_door("no such host", 0)


@pytest.mark.parametrize("token", ["a b", "a&b=c", "a;b", "a\nb", "ä", "x" * 300])
def test_a_token_that_cannot_stand_in_an_address_is_refused(token: str) -> None:
    with pytest.raises(UsageError, match="--token: must be of letters"):
        taken_door("127.0.0.1", 0, token)


def test_what_is_sent_to_a_viewer_that_left_without_a_word_is_not_logged(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def sent_in_vain() -> None:
        async def left(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            for _ in range(20):
                writer.write(b"news")
                await asyncio.sleep(0)
            over.set()
            writer.close()

        over = asyncio.Event()
        server = await asyncio.start_server(left, "127.0.0.1", 0)
        async with server:
            with socket.create_connection(server.sockets[0].getsockname()) as viewer:
                at_once = struct.pack("ii", 1, 0)
                viewer.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, at_once)
            await over.wait()

    asyncio.run(sent_in_vain())
    assert "socket.send() raised exception" in caplog.text  # as asyncio has it by itself
    caplog.clear()
    with quiet_about_the_gone():
        asyncio.run(sent_in_vain())
    assert not caplog.text
