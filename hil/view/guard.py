"""Checks requests to the page.  By default, only a browser on this computer may connect.

* The `Host` of a request must be the server's own.  A foreign page whose name resolves to 127.0.0.1 (DNS rebinding) has
  another `Host`.
* The `Origin` must be the server's own.  A page of another site may open a websocket to any address, but the browser
  names that site.
* If the server does not listen on loopback, a token is needed: first in the address, then in a cookie.

It is plain ASGI, so the same checks hold for web pages and websockets.
"""

from __future__ import annotations

import ipaddress
import secrets
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from typing import Any, Final
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

LOOPBACK: Final = ("127.0.0.1", "localhost", "[::1]")


def is_loopback(host: str) -> bool:
    """Whether an address reaches this computer only."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


class RequestGuard:
    """Passes permitted requests on to `app`.  With an empty `token`, no token is needed."""

    def __init__(self, app: App, host: str, port: int, token: str = "") -> None:
        self._app = app
        self._port = port
        self._token = token
        self._cookie = f"hil_view_{port}"
        self._names = {*LOOPBACK, host.lower(), f"[{host.lower()}]"}
        #: If it listens on all addresses, every address of this computer is permitted, and of names only localhost.
        self._any_address = not is_loopback(host)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handle a request, a websocket, or an event of the server's life cycle."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = _headers(scope["headers"])
        refusal = self._refusal(scope, headers)
        if refusal:
            await _refuse(scope, receive, send, refusal)
            return
        first = await receive()
        if first["type"] in ("http.disconnect", "websocket.disconnect"):
            return  # gone before it was there: libraries behind us take it for a request
        receive = _again(first, receive)
        await self._app(scope, receive, self._with_cookie(send) if self._token_given(scope) else send)

    def _refusal(self, scope: Scope, headers: dict[str, str]) -> str:
        """The reason why a request is refused; empty if it is permitted."""
        host = headers.get("host", "")
        if not self._is_ours(host):
            return f"this is not {host or 'a host without a name'}"
        origin = headers.get("origin")
        if origin is not None and origin not in (f"http://{host}", f"https://{host}"):
            return f"no access from {origin}"
        if self._token and not self._token_given(scope) and not self._token_kept(headers):
            return "the address needs the token that was printed: ?token=..."
        return ""

    def _is_ours(self, host: str) -> bool:
        name, colon, port = host.rpartition(":")
        if not colon or not port.isdecimal():  # the port of http is not named
            name, port = host, "80"
        if port != str(self._port):
            return False
        if name.lower() in self._names:
            return True
        if not self._any_address:
            return False
        try:
            ipaddress.ip_address(name.strip("[]"))
        except ValueError:
            return False
        return True

    def _token_given(self, scope: Scope) -> bool:
        given = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        return bool(self._token) and secrets.compare_digest(given.encode(), self._token.encode())

    def _token_kept(self, headers: dict[str, str]) -> bool:
        # Not SimpleCookie: it drops all after a cookie of another program on this host that it cannot read.
        kept = (each.strip().partition("=") for each in headers.get("cookie", "").split(";"))
        return any(
            name == self._cookie and secrets.compare_digest(value.encode(), self._token.encode())
            for name, _, value in kept
        )

    def _with_cookie(self, send: Send) -> Send:
        cookie = f"{self._cookie}={self._token}; Path=/; HttpOnly; SameSite=Strict"

        async def sending(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), (b"set-cookie", cookie.encode("latin-1"))]
            await send(message)

        return sending


def _again(first: MutableMapping[str, Any], receive: Receive) -> Receive:
    """`receive`, which first returns a message that was taken already."""
    taken = [first]

    async def receiving() -> MutableMapping[str, Any]:
        return taken.pop() if taken else await receive()

    return receiving


def _headers(pairs: Iterable[tuple[bytes, bytes]]) -> dict[str, str]:
    return {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in pairs}


async def _refuse(scope: Scope, receive: Receive, send: Send, why: str) -> None:
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.close", "code": 1008, "reason": why[:100]})
        return
    body = f"refused: {why}\n".encode()
    headers = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(body)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": body})
