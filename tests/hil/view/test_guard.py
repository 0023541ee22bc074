"""Who may pass: hosts, origins, tokens, for pages and websockets alike."""

from __future__ import annotations

import asyncio
from collections.abc import MutableMapping
from typing import Any

import pytest

from hil.view.guard import RequestGuard, is_loopback

TOKEN = "Zx81-secret"


async def _app(scope: Any, receive: Any, send: Any) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
    else:
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"page"})


def ask(guard: RequestGuard, kind: str = "http", query: str = "", **headers: str) -> list[MutableMapping[str, Any]]:
    """What the server would send."""
    sent: list[MutableMapping[str, Any]] = []

    async def receive() -> MutableMapping[str, Any]:
        return {"type": "websocket.connect"}

    async def send(message: MutableMapping[str, Any]) -> None:
        sent.append(message)

    pairs = [(name.encode(), value.encode()) for name, value in headers.items()]
    asyncio.run(guard({"type": kind, "headers": pairs, "query_string": query.encode()}, receive, send))
    return sent


def passes(guard: RequestGuard, kind: str = "http", query: str = "", **headers: str) -> bool:
    first = ask(guard, kind, query, **headers)[0]
    return first.get("status") == 200 or first["type"] == "websocket.accept"


@pytest.fixture
def local() -> RequestGuard:
    return RequestGuard(_app, "127.0.0.1", 8080)


@pytest.fixture
def open_to_all() -> RequestGuard:
    return RequestGuard(_app, "0.0.0.0", 8080, TOKEN)


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize("host", ["127.0.0.1:8080", "localhost:8080", "[::1]:8080"])
def test_this_computers_own_browser_passes(local: RequestGuard, kind: str, host: str) -> None:
    assert passes(local, kind, host=host)
    assert passes(local, kind, host=host, origin=f"http://{host}")


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    "host",
    [
        "evil.example:8080", "evil.example", "127.0.0.1:9090", "127.0.0.1", "192.168.1.5:8080", "", "127.0.0.1:80:8080",
        "127.0.0.1:" + "9" * 5000,
    ],
)  # fmt: skip
def test_a_host_that_is_not_ours_is_refused(local: RequestGuard, kind: str, host: str) -> None:
    assert not passes(local, kind, host=host)


def test_a_request_without_host_is_refused(local: RequestGuard) -> None:
    assert not passes(local)


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "null", "http://127.0.0.1:9090", "http://localhost:8080", "http://127.0.0.1:8080.evil"],
)
def test_a_foreign_origin_is_refused(local: RequestGuard, kind: str, origin: str) -> None:
    assert not passes(local, kind, host="127.0.0.1:8080", origin=origin)


def test_a_refused_page_says_why_and_a_refused_websocket_is_closed(local: RequestGuard) -> None:
    start, body = ask(local, host="evil.example:8080")
    assert start["status"] == 403
    assert body["body"] == b"refused: this is not evil.example:8080\n"
    assert ask(local, "websocket", host="evil.example:8080")[0]["type"] == "websocket.close"


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_listening_elsewhere_a_token_is_needed(open_to_all: RequestGuard, kind: str) -> None:
    host = "192.168.1.5:8080"
    assert not passes(open_to_all, kind, host=host)
    assert not passes(open_to_all, kind, "token=wrong", host=host)
    assert not passes(open_to_all, kind, "token=", host=host)
    assert passes(open_to_all, kind, f"token={TOKEN}", host=host)


def test_the_token_is_kept_in_a_cookie_that_scripts_and_other_sites_do_not_get(open_to_all: RequestGuard) -> None:
    start = ask(open_to_all, query=f"token={TOKEN}", host="192.168.1.5:8080")[0]
    (cookie,) = [value.decode() for name, value in start["headers"] if name == b"set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    kept = cookie.partition(";")[0]
    assert passes(open_to_all, "websocket", host="192.168.1.5:8080", cookie=kept)
    assert not passes(open_to_all, "websocket", host="192.168.1.5:8080", cookie=kept + "x")
    # Cookies know no ports: those of other programs on that host come too.
    assert passes(open_to_all, "websocket", host="192.168.1.5:8080", cookie='prefs={"a": [1, 2]}; ' + kept)


def test_the_address_that_is_listened_to_is_ours_however_it_is_written() -> None:
    assert passes(RequestGuard(_app, "127.0.0.2", 8080), host="127.0.0.2:8080")
    assert passes(RequestGuard(_app, "Robot.local", 8080, TOKEN), query=f"token={TOKEN}", host="robot.local:8080")


def test_the_token_does_not_open_the_door_to_names_and_origins(open_to_all: RequestGuard) -> None:
    query = f"token={TOKEN}"
    assert not passes(open_to_all, query=query, host="evil.example:8080")
    assert not passes(open_to_all, query=query, host="192.168.1.5:8080", origin="http://evil.example")


@pytest.mark.parametrize(
    ("host", "expected"),
    [("127.0.0.1", True), ("127.8.8.8", True), ("::1", True), ("localhost", True), ("0.0.0.0", False), ("::", False),
     ("192.168.1.5", False), ("robot.local", False)],
)  # fmt: skip
def test_loopback_is_told_from_the_rest(host: str, expected: bool) -> None:
    assert is_loopback(host) is expected


@pytest.mark.parametrize("kind", ["http", "websocket"])
def test_who_is_gone_before_he_is_there_reaches_nobody(kind: str) -> None:
    reached: list[str] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        reached.append((await receive())["type"])

    def comes(message: str) -> None:
        async def receive() -> MutableMapping[str, Any]:
            return {"type": f"{kind}.{message}"}

        async def send(message: MutableMapping[str, Any]) -> None:
            raise AssertionError(message)

        headers = [(b"host", b"127.0.0.1:8080")]
        guard = RequestGuard(app, "127.0.0.1", 8080)
        asyncio.run(guard({"type": kind, "headers": headers, "query_string": b""}, receive, send))

    comes("disconnect")
    assert reached == []
    begins = "connect" if kind == "websocket" else "request"
    comes(begins)
    assert reached == [f"{kind}.{begins}"]
