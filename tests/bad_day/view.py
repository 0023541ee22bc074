"""The view's server under twenty pages, and bytes that are no HTTP: it serves on, and the terminal stays empty."""

from __future__ import annotations

import asyncio
import atexit
import contextlib
import os
import random
import re
import socket
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import urlopen

from tests.bad_day.figure import REPOSITORY
from tests.hil.view.conftest import View
from tests.hil.waiting import TIMEOUT_S

CALLERS = 20
#: So often twenty pages come and go; in the cases of every run once.
ROUNDS = 3
#: Six pages are 33 MB: a round that leaves more than this keeps pages that have gone.
MAX_GROWN_BYTES = 20 << 20
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
    """Twenty callers at once: pages of browsers, or mostly nonsense."""
    return asyncio.run(_pages(1 if seed < 3 else ROUNDS)) if seed % 3 == 1 else _nonsense(random.Random(f"view {seed}"))


def _nonsense(rng: random.Random) -> str:
    """Bytes of all kinds; then there is still an answer."""
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
        status, page = _got(view.address)
    return "" if (status, "nicegui" in page) in ((200, True), (503, False)) else f"the page is {status} {page[:80]!r}"


def _got(address: str) -> tuple[int, str]:
    """Status and text of a page."""
    try:
        with urlopen(address, timeout=60) as answer:
            return answer.status, answer.read().decode()
    except HTTPError as error:
        with error:
            return error.code, error.read().decode()


async def _pages(rounds: int) -> str:
    """Twenty pages, as browsers open them: each is fed, or told in a sentence; when they have gone, so is their memory.

    On a server of their own: of those who talk nonsense some have asked for pages.
    """
    from hil.view.page_limit import MAX_PAGES

    with contextlib.chdir(REPOSITORY):
        view = await asyncio.to_thread(View, "--world", "box", "--no-open")
    found, bytes_after = [], []
    try:
        first = await _Visit(view.address).begin()
        while not await first.fed():  # it starts up: the page asks to be loaded anew
            await first.end()
            first = await _Visit(view.address).begin()
        await first.end()
        for turn in range(rounds):
            visits = await asyncio.gather(*(_Visit(view.address).begin() for _ in range(CALLERS)))
            while turn and sum(visit.status == 200 for visit in visits) < MAX_PAGES:
                # Those who were there before may still come back.
                await asyncio.sleep(1)
                await next(visit for visit in visits if visit.status != 200).begin()
            within = [visit for visit in visits if visit.status == 200]
            told = [visit for visit in visits if visit.status == 503 and f"{MAX_PAGES} pages open" in visit.said]
            if (len(within), len(told)) != (MAX_PAGES, CALLERS - MAX_PAGES):
                found.append(f"round {turn}: {len(within)} pages, and {len(told)} told that they are too many")
            fed = await asyncio.gather(*(visit.fed() for visit in within))
            if not all(fed):
                found.append(f"round {turn}: {fed.count(False)} of {len(within)} pages are not drawn anew")
            for visit in visits:
                await visit.end()
            resident = int(Path(f"/proc/{view.process.pid}/statm").read_text().split()[1])
            bytes_after.append(resident * os.sysconf("SC_PAGE_SIZE"))
    finally:
        status, _, errors = await asyncio.to_thread(view.end)
    if status or errors:
        found.append(f"status {status}: {errors[-500:]}")
    if rounds > 2 and (grown := bytes_after[-1] - bytes_after[1]) > MAX_GROWN_BYTES:
        found.append(f"{grown >> 20} MB more after {rounds} rounds")
    return ", ".join(found)


class _Visit:
    """A page as a browser has it: asked for, then a socket that is told what changes."""

    def __init__(self, address: str) -> None:
        import socketio

        self._address = address
        self.status, self.said = 0, ""
        self._updates = 0
        self._known = asyncio.Event()
        self._client = socketio.AsyncClient(reconnection=False, request_timeout=TIMEOUT_S)
        self._client.on("update", self._updated)
        self._client.on("run_javascript", self._asked)

    async def begin(self) -> _Visit:
        """Ask for the page; where it comes, open its socket as the page's script does.

        A page that a slow computer has given up before its socket came is loaded anew, as by a browser.
        """
        from socketio.exceptions import ConnectionError as Refused

        async with asyncio.timeout(TIMEOUT_S):
            while not self._client.connected:
                self.status, self.said = await asyncio.to_thread(_got, self._address)
                if self.status != 200:
                    break
                found = re.search(r"client_id\W+([0-9a-f-]{36})", self.said)
                assert found is not None, self.said[:200]
                query = f"client_id={found[1]}&tab_id={id(self)}&document_id=1"
                with contextlib.suppress(Refused):
                    await self._client.connect(
                        f"{self._address}?{query}&next_message_id=0&implicit_handshake=true",
                        socketio_path="/_nicegui_ws/socket.io", transports=["websocket"], wait_timeout=TIMEOUT_S,
                    )  # fmt: skip
        return self

    async def fed(self) -> bool:
        """Whether it is drawn again and again, rather than nothing for a minute.

        A page that is asked to be loaded anew is, as by a browser: a slow computer has given it up before it came.
        """
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(TIMEOUT_S):
                await self._known.wait()
                while self._updates < 3 and self.status == 200:
                    await self.end()
                    self._known.clear()
                    await self.begin()
                    await self._known.wait()
        return self._updates >= 3

    def _updated(self, _elements: object) -> None:
        self._updates += 1
        if self._updates == 3:
            self._known.set()

    def _asked(self, to_do: dict[str, str]) -> None:
        if "history.go(0)" in to_do["code"]:
            self._known.set()

    async def end(self) -> None:
        """Close the page."""
        await self._client.disconnect()
