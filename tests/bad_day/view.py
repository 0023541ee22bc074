"""The view's server under twenty callers and bytes that are no HTTP: it serves on, and the terminal stays empty."""

from __future__ import annotations

import atexit
import contextlib
import random
import socket
from collections.abc import Iterator
from functools import cache
from urllib.request import urlopen

from tests.bad_day.figure import REPOSITORY
from tests.hil.view.conftest import View

CALLERS = 20
PIECES = (
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n", b"GET /%ff%00 HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n",
    b"GET /_nicegui_ws/socket.io/?EIO=4&transport=polling HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n",
    b"GET /_nicegui_ws/socket.io/?EIO=4&transport=websocket HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nConnection: Upgrade\r\n"
    b"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
    b"POST / HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nContent-Length: 999999999\r\n\r\nx", b"\x16\x03\x01\x02\x00\x01\x00",
    b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 5000,
)  # fmt: skip


@cache
def _view() -> View:
    with contextlib.chdir(REPOSITORY):  # the case's own folder will be gone
        view = View("--world", "box", "--no-open")
    # Of a test that failed: nobody else would end it.
    atexit.register(lambda: view.process.poll() is None and view.end())
    return view


def ended() -> Iterator[str]:
    """End the server; what it said that it should not have."""
    if _view.cache_info().currsize:
        status, _, errors = _view().end()
        _view.cache_clear()
        if status or errors:
            yield f"status {status}: {errors[-500:]}"


def missing() -> str:
    """Why there is no view."""
    try:
        import nicegui  # noqa: F401
    except ImportError:
        return "needs the extra view: pip install 'c2000-hil[view]'"
    return ""


def case(seed: int) -> str:
    """Twenty callers at once, most of whom talk nonsense; then the page."""
    rng = random.Random(f"view {seed}")
    view = _view()
    port = int(view.address.rstrip("/").rpartition(":")[2])
    with contextlib.ExitStack() as stack:
        for _ in range(CALLERS):
            line = stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=60))
            piece = rng.choice(PIECES).replace(b"%d", str(port).encode())
            if rng.random() < 0.5:
                piece += rng.randbytes(rng.randrange(1, 400))
            with contextlib.suppress(OSError):
                line.sendall(piece[: rng.randrange(1, len(piece) + 1)] if rng.random() < 0.3 else piece)
            if rng.random() < 0.3:
                line.close()
        with urlopen(view.address, timeout=60) as answer:
            page = answer.read()
    return "" if b"nicegui" in page else f"the page is {page[:80]!r}"
