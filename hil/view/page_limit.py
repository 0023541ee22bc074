"""The limit of pages of one view: a page beyond it shows a sentence, and costs nothing.

One process draws each page 20 times a second, and needs 7 MB for it.  With twenty pages, none would keep up.
"""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Callable
from typing import Any, Final
from weakref import WeakSet

from nicegui import Client, ui
from nicegui import app as nicegui_app
from starlette.responses import HTMLResponse

#: CHOICE: pages at once.  Six take half a core of the server; browsers on the same computer need more than that.
MAX_PAGES: Final = 6
#: How often a page that found no room asks again, in seconds.
RETRY_S: Final = 5
_SENTENCE: Final = (
    f"This view has {MAX_PAGES} pages open and no room for one more: close one of them, and the view appears here."
)
_TOO_MANY: Final = f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>one page too many - c2000-hil</title>
<meta name="viewport" content="width=device-width"><meta http-equiv="refresh" content="{RETRY_S}">
<style>:root {{ color-scheme: light dark; font: 1.2rem system-ui, sans-serif }} main {{ margin: 20vh auto; width: 80% }}
</style></head><body><main role="status">{_SENTENCE}</main></body></html>
"""


class PageLimit:
    """Builds a page by `build` while the limit allows it.  It is created in the process that serves.

    A page counts while a browser is connected to it, or may still be loading it.  A browser that left may return for a
    while; together with such pages, there are at most twice as many.
    """

    def __init__(self, build: Callable[[], Any], loading_s: float) -> None:
        self._build = build
        self._loading_s = loading_s
        self._came: WeakSet[Client] = WeakSet()
        self._collecting = False
        nicegui_app.on_connect(self._came.add)
        nicegui_app.on_delete(self._on_disconnect)

    def __call__(self) -> Any:
        """Called by NiceGUI for a page: build it, or answer that there is no room."""
        new = ui.context.client
        if self._has_room_for(new):
            return self._build()
        new.delete()
        return HTMLResponse(_TOO_MANY, status_code=503, headers={"Retry-After": str(RETRY_S)})

    def _has_room_for(self, new: Client) -> bool:
        Client.prune_instances(client_age_threshold=self._loading_s)  # asked for, and nobody came
        others = [client for client in Client.instances.values() if client is not new]
        left = [client for client in others if client in self._came and not client.has_socket_connection]
        return len(others) - len(left) < MAX_PAGES and len(others) < 2 * MAX_PAGES

    def _on_disconnect(self, client: Client) -> None:
        """Free the memory of a closed page: it is a cycle, and `hil.collector` makes Python collect rarely."""
        if client in self._came and not self._collecting:
            self._collecting = True  # once for all that go together
            asyncio.get_running_loop().call_later(1, self._collect)

    def _collect(self) -> None:
        self._collecting = False
        gc.collect()
