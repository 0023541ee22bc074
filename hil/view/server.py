"""The page's server: a socket, a guard before it, the machine in its own thread, a clean end.

    run_view(setup, ...)               # hil run --view
    serve_console("/dev/ttyUSB0")      # hil console --view: the console's page, for a robot behind a serial line

NiceGUI stores its pages in the process, so a process serves only one of them.
"""

from __future__ import annotations

import contextlib
import secrets
import socket
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, Final

from hil.client.orders import TimedOrder
from hil.extras import require
from hil.machine import Machine, Setup
from hil.reports.policy import Policy
from hil.serial_port import SerialPort
from hil.view.engine import Engine
from hil.view.guard import RequestGuard, is_loopback
from hil.view.line import SerialPortLine
from hil.world.maps import load_map

HOST: Final = "127.0.0.1"
PORT: Final = 8080
#: The time that open pages have to close at the end, in seconds.
GRACE_S: Final = 1
#: A browser may be disconnected for this time, in seconds, before its page is built again; it may also load this long.
RECONNECT_S: Final = 20.0
#: A browser that has vanished without a word is disconnected after the sum of both times at most.  A busy one shall not
#: be: it would lose each click until it is connected again.  Driving by hand ends before (`hil.robot.view.tele`).
PING_S: Final = 2.0
PONG_S: Final = 20.0
#: The time between two reads of a serial port.
TURN_S: Final = 0.05

PrintLine = Callable[[str], None]
#: A function that gets the function that ends the server.
OnStop = Callable[[Callable[[], None]], None]


def listen(host: str, port: int) -> socket.socket:
    """Open the socket of the page; port 0 selects a free port.  Raises ValueError if that is not possible."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
    except OSError as error:
        raise ValueError(f"cannot listen on {host!r}: {error.strerror}") from None
    server = socket.socket(family, socket.SOCK_STREAM)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        server.bind((host, port))
        server.listen()  # whoever reads the address may come at once
    except OSError as error:
        server.close()
        raise ValueError(f"cannot listen on {host}:{port}: {error.strerror}; choose another with --view-port") from None
    return server


def run_view(
    setup: Setup,
    pace: float | None,
    orders: Iterable[TimedOrder],
    open_port: Callable[[Machine], SerialPort | None],
    *,
    host: str = HOST,
    port: int = PORT,
    print_line: PrintLine = print,
    on_stop: OnStop | None = None,
    read: Mapping[str, Any] | None = None,
    policy: Policy | None = None,
) -> Engine:
    """Run a board and its page until the user ends it (`hil run --view`).  The result can be read afterwards.

    `read` is what was read from files for the setup (`RunningBoard.read`).  `policy` weighs the findings (None: by
    their rules).  Raises ValueError before the start, and the exception that ends the machine's thread.
    """
    require("nicegui")
    engine = Engine(setup, pace=pace, orders=orders, open_port=open_port, read=read, policy=policy)

    def ends(stop: Callable[[], None]) -> None:
        engine.on_error(stop)
        if on_stop is not None:
            on_stop(stop)

    if engine.kind.bench is not None:
        load_map(setup.world)  # a wrong map is said here, not on the page
    with contextlib.closing(listen(host, port)) as listening:
        try:
            serve_view(engine, listening, host, print_line=print_line, on_stop=ends)
        finally:
            engine.close()
    if engine.error is not None:
        raise engine.error
    return engine


def serve_view(
    engine: Engine, listening: socket.socket, host: str, *, print_line: PrintLine = print, on_stop: OnStop | None = None
) -> None:
    """Start an emulated board and serve its page until the user ends it."""
    from hil.view.page import machine_page

    _serve(lambda: machine_page(engine), listening, host, print_line, on_stop, begin=engine.start)


def serve_console(
    port_url: str, *, host: str = HOST, port: int = PORT, print_line: PrintLine = print, on_stop: OnStop | None = None
) -> SerialPortLine:
    """Serve the console's page for the robot behind a serial port (device name or pyserial URL), then stop the robot.

    Returns the line, with its log.  Raises PortError or ValueError, one line, if port or address cannot be opened.
    """
    require("nicegui")
    from nicegui import app as nicegui_app

    from hil.robot.view.console_page import console_page

    line = SerialPortLine(port_url)
    try:
        with contextlib.closing(listen(host, port)) as listening:
            nicegui_app.timer(TURN_S, line.turn)
            _serve(lambda: console_page(line), listening, host, print_line, on_stop)
    finally:
        line.close()
    return line


def _nothing() -> None:
    pass


def _serve(
    build: Callable[[], Any], listening: socket.socket, host: str, print_line: PrintLine, on_stop: OnStop | None,
    begin: Callable[[], None] = _nothing,
) -> None:  # fmt: skip
    """Serve until the server is told to stop; `begin` is called when it has started."""
    import uvicorn
    from fastapi import FastAPI
    from nicegui import app as nicegui_app
    from nicegui import core, ui

    from hil.view.page_limit import PageLimit

    class Server(uvicorn.Server):
        """The HTTP server.  It installs no signal handlers; the caller does."""

        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            # NiceGUI looks through all of Python's objects as it starts, and a tuple that another thread is making at
            # that moment cannot be finished: SystemError.
            await super().startup(sockets)
            begin()

        @contextlib.contextmanager
        def capture_signals(self) -> Iterator[None]:
            yield

    number = listening.getsockname()[1]
    token = "" if is_loopback(host) else secrets.token_urlsafe(16)
    app = FastAPI(openapi_url=None)
    ui.run_with(
        app,
        root=PageLimit(build, RECONNECT_S),
        title="c2000-hil",
        dark=None,
        language="en-US",
        show_welcome_message=False,
        tailwind=False,
        reconnect_timeout=RECONNECT_S,
    )

    def watch_browsers() -> None:
        # NiceGUI derives both from its reconnect timeout, as it starts.
        core.sio.eio.ping_interval, core.sio.eio.ping_timeout = PING_S, PONG_S

    nicegui_app.on_startup(watch_browsers)
    guarded: Any = RequestGuard(app, host, number, token)
    config = uvicorn.Config(
        guarded, log_level="error", access_log=False, timeout_graceful_shutdown=GRACE_S, lifespan="on",
        server_header=False,
    )  # fmt: skip
    server = Server(config)

    def stop() -> None:
        server.should_exit = True

    if on_stop is not None:
        on_stop(stop)
    shown = f"[{host}]" if ":" in host else host
    print_line(f"view: http://{shown}:{number}/" + (f"?token={token}" if token else ""))
    server.run(sockets=[listening])
