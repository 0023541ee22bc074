"""The server as a process: where it listens, whom it refuses, how it ends.  Plain HTTP, no browser."""

from __future__ import annotations

import http.client
import re
import socket
import subprocess
import sys
from contextlib import closing
from dataclasses import dataclass
from urllib.parse import urlsplit

import pytest

from hil.view.server import listen
from tests.hil.view.conftest import View, needs_view


@dataclass
class Answer:
    status: int
    body: str
    cookie: str


def get(address: str, path: str = "/", **headers: str) -> Answer:
    parts = urlsplit(address)
    with closing(http.client.HTTPConnection(parts.hostname or "", parts.port, timeout=60)) as connection:
        connection.request("GET", path, headers=headers)
        with connection.getresponse() as response:
            body = "" if response.status == 101 else response.read().decode()
            return Answer(response.status, body, str(response.getheader("set-cookie", "")).partition(";")[0])


def websocket(address: str, **headers: str) -> int:
    """Status of the answer to the page's own websocket handshake (101: it is open)."""
    upgrade = {
        "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
    }  # fmt: skip
    return get(address, "/_nicegui_ws/socket.io/?EIO=4&transport=websocket", **(upgrade | headers)).status


def test_it_listens_on_loopback_and_gives_the_page(view: View) -> None:
    assert re.fullmatch(r"view: http://127\.0\.0\.1:\d+/\n", view.value_text)
    answer = get(view.address)
    assert answer.status == 200
    assert "nicegui" in answer.body


def test_the_page_names_no_other_computer(view: View) -> None:
    page = get(view.address).body
    assert set(re.findall(r"(?:src|href)=[\"']?(?:https?:)?//", page)) == set()


def test_foreign_hosts_and_origins_are_refused_for_pages_and_websockets(view: View) -> None:
    ours = view.address.rstrip("/")
    assert get(view.address, Host="evil.example").status == 403
    assert get(view.address, Origin="http://evil.example").status == 403
    assert websocket(view.address, Origin=ours) == 101
    assert websocket(view.address, Origin="http://evil.example") == 403
    assert websocket(view.address, Host="evil.example", Origin="http://evil.example") == 403


def test_elsewhere_than_on_loopback_it_needs_the_token_that_it_prints() -> None:
    needs_view()
    view = View("--world", "room", "--view-host", "0.0.0.0")
    found = re.fullmatch(r"view: http://0\.0\.0\.0:(\d+)/\?token=(\S{20,})\n", view.value_text)
    assert found is not None, view.value_text
    address = f"http://127.0.0.1:{found[1]}/"
    assert get(address).status == 403
    assert get(address, "/?token=guessed").status == 403
    answer = get(address, f"/?token={found[2]}")
    assert answer.status == 200
    assert get(address, Cookie=answer.cookie).status == 200
    assert websocket(address, Origin=address.rstrip("/")) == 403
    assert websocket(address, Origin=address.rstrip("/"), Cookie=answer.cookie) == 101
    assert view.end()[::2] == (0, "")


def test_ctrl_c_ends_it_cleanly_with_a_summary() -> None:
    needs_view()
    view = View("--world", "box", "--order", "0.1:stop", "--listen", "tcp://127.0.0.1:0")
    assert get(view.address).status == 200
    assert view.process.stdout is not None
    assert view.process.stdout.readline().startswith("port: ")  # it has started up
    status, summary, errors = view.end()
    assert (status, errors) == (0, "")
    # Findings of start-up (us.c reads SONAR2.previous_distances before anything was written), then the line's counts:
    # a whole start-up has one damaged frame, because the firmware begins its second one while the first is under way.
    assert re.search(r"^\d+ errors?, \d+ warnings?", summary, re.MULTILINE)
    assert re.search(
        r"^virtual time \d+\.\d{3} s: \d+ frames( and 1 damaged)?, \d+ bytes from the robot, \d+ bytes to it$",
        summary,
        re.MULTILINE,
    )


def test_a_port_in_use_is_one_line() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(ValueError, match=rf"^cannot listen on 127\.0\.0\.1:{port}: .*; choose another"):
            listen("127.0.0.1", port)


def test_an_address_that_is_none_is_one_line() -> None:
    with pytest.raises(ValueError, match=r"^cannot listen on 'no such host'"):
        listen("no such host", 0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--json"], "hil: error: --view runs until Ctrl-C: leave out --plot, --wire, --trace, --page, "),
        (["--world", "nowhere"], "hil: error: "),
        (["--fill", "nothing"], "hil: error: unknown fill policy 'nothing'"),
        (["--port", "/dev/nothing"], "hil: error: cannot open the serial port /dev/nothing: "),
    ],
)
def test_what_cannot_be_is_one_line_and_nobody_need_end_it(options: list[str], message: str) -> None:
    needs_view()
    command = [sys.executable, "-m", "hil", "run", "--view", "--view-port", "0", *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith(message)
    assert done.stderr.count("\n") == 1


def test_without_the_extra_it_is_one_line_that_names_it() -> None:
    code = "import sys; sys.modules['nicegui'] = None; from hil.cli import invoke; sys.exit(invoke(['run', '--view']))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert done.stderr == "hil: error: the view needs NiceGUI: pip install 'c2000-hil[view]'\n"
