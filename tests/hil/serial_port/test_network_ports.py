"""socket:// and rfc2217:// with pyserial's own clients on loopback."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
import serial
from hypothesis import given, settings
from hypothesis import strategies as st

from hil.cli import invoke
from hil.client.decode import FrameDecoder
from hil.serial_port import PortError, open_port
from hil.serial_port.rfc2217_port import Rfc2217Port
from hil.serial_port.tcp_port import TcpPort
from hil.serial_url import open_url
from tests.hil.serial_port.lines import Robot, frame
from tests.hil.waiting import eventually

IAC, SB, SE, COM_PORT = 255, 250, 240, 44


@contextmanager
def tcp_port() -> Iterator[TcpPort]:
    port = TcpPort("127.0.0.1", 0, keep=4)
    try:
        yield port
    finally:
        port.close()


@contextmanager
def rfc2217_port() -> Iterator[Rfc2217Port]:
    port = Rfc2217Port("127.0.0.1", 0, keep=4)
    try:
        yield port
    finally:
        port.close()


def connect(port: TcpPort) -> socket.socket:
    client = socket.create_connection(("127.0.0.1", int(port.address.rsplit(":", 1)[1])))
    client.setblocking(False)
    eventually(lambda: port.connected, lambda: port.transmit(0))
    return client


def receive(client: socket.socket) -> bytes:
    try:
        return client.recv(65536)
    except BlockingIOError:
        return b""


def numbers(data: bytes) -> list[int]:
    return [decoded.x_mm for decoded in FrameDecoder().feed(data)]


def test_opened_and_closed_a_hundred_times_every_frame_and_order_passes() -> None:
    with tcp_port() as port:
        robot = Robot(port)
        for number in range(100):
            client = connect(port)
            robot.send(frame(number))
            got = bytearray()
            eventually(lambda got=got: got.endswith(b"\r"), lambda got=got, client=client: got.extend(receive(client)))
            assert bytes(got) == frame(number)
            client.sendall(b"#STOP\r")
            order = bytearray()
            eventually(lambda order=order: len(order) >= 6, lambda order=order: order.extend(port.receive(64)))
            assert bytes(order) == b"#STOP\r"
            client.close()
            eventually(lambda: not port.connected, lambda: port.receive(64))
        assert port.counters.connections == 100


def test_pyserials_socket_url_passes_frames_and_orders_and_opens_again() -> None:
    with tcp_port() as port:
        robot = Robot(port)
        for number in range(2):
            with serial.serial_for_url(port.address, timeout=0) as line:
                eventually(lambda: port.connected, lambda: port.transmit(robot.now))
                robot.send(frame(number))
                got = bytearray()
                eventually(lambda got=got: got.endswith(b"\r"), lambda got=got, line=line: got.extend(line.read(100)))
                assert bytes(got) == frame(number)
                line.write(b"#STOP\r")
                order = bytearray()
                eventually(lambda order=order: len(order) >= 6, lambda order=order: order.extend(port.receive(64)))
                assert bytes(order) == b"#STOP\r"
            eventually(lambda: not port.connected, lambda: port.receive(64))
        assert port.counters.connections == 2


def test_what_nobody_hears_is_dropped_and_a_new_listener_begins_with_a_whole_frame() -> None:
    with tcp_port() as port:
        robot = Robot(port)
        robot.send(frame(1) + frame(2))
        assert port.counters.frames_dropped == 2
        robot.send(frame(3)[:5])
        client = connect(port)
        robot.send(frame(3)[5:] + frame(4))
        got = bytearray()
        eventually(lambda: got.count(b"\r") >= 2, lambda: got.extend(receive(client)))
        assert numbers(bytes(got)) == [3, 4]
        client.close()


def test_a_listener_that_does_not_read_never_blocks_the_robot_and_then_hears_whole_frames() -> None:
    with tcp_port() as port:
        robot = Robot(port)
        client = connect(port)
        number = 0

        def another() -> None:
            nonlocal number
            robot.send(frame(number))
            number += 1

        eventually(lambda: port.counters.frames_dropped > 100, another)
        got = bytearray()

        def read_on() -> None:
            got.extend(receive(client))
            port.transmit(robot.now)

        eventually(lambda: bool(got) and numbers(bytes(got))[-1:] == [number - 1], read_on)
        seen = numbers(bytes(got))
        assert len(seen) == got.count(b"\r")  # all whole
        assert seen == sorted(seen)
        assert len(seen) + port.counters.frames_dropped == number
        client.close()


def test_a_fast_writer_is_held_back_over_tcp() -> None:
    with tcp_port() as port:
        client = connect(port)

        def write_on() -> None:
            for _ in range(1 << 14):  # 64 MB, far beyond what both kernels store
                client.send(b"x" * 4096)
                assert port.receive(0) == b""

        with pytest.raises(BlockingIOError):
            write_on()
        got = 0

        def read_on() -> None:
            nonlocal got
            chunk = port.receive(64)
            assert len(chunk) <= 64
            got += len(chunk)

        eventually(lambda: got >= 4096, read_on)
        client.close()


def test_a_second_program_waits_until_the_first_is_gone() -> None:
    with tcp_port() as port:
        robot = Robot(port)
        first, second = connect(port), socket.create_connection(("127.0.0.1", int(port.address.rsplit(":", 1)[1])))
        second.setblocking(False)
        robot.send(frame(1))
        got = bytearray()
        eventually(lambda: bytes(got) == frame(1), lambda: got.extend(receive(first)))
        assert receive(second) == b""
        first.sendall(b"#STOP\r")
        first.close()
        # What the first sent before it went is not lost.
        order = bytearray()
        eventually(lambda: len(order) >= 6, lambda: order.extend(port.receive(64)))
        eventually(lambda: port.counters.connections == 2, lambda: port.receive(64))
        robot.send(frame(2))
        got.clear()
        eventually(lambda: bytes(got) == frame(2), lambda: got.extend(receive(second)))
        second.close()


@contextmanager
def served(port: TcpPort, robot: Robot) -> Iterator[bytearray]:
    """Turn the port in a thread, as `hil run` does, while pyserial's client negotiates."""
    orders = bytearray()
    ended = threading.Event()
    lock = threading.Lock()

    def serve() -> None:
        while not ended.wait(0.001):
            with lock:
                orders.extend(port.receive(64))
                robot.pause(1000)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        yield orders
    finally:
        ended.set()
        thread.join()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name)\\(:DeprecationWarning")  # pyserial 3.5's client
def test_pyserial_negotiates_rfc2217_and_every_byte_passes_both_ways() -> None:
    with rfc2217_port() as port:
        robot = Robot(port)
        every_byte = bytes(range(256)) * 2
        with served(port, robot) as orders, serial.serial_for_url(port.address, baudrate=9600, timeout=0.1) as line:
            line.write(every_byte)
            eventually(lambda: len(orders) >= 512)
            assert bytes(orders) == every_byte
            assert line.cts
            assert line.dsr
            line.baudrate = 115200  # accepted, as by any port server
        assert port.counters.protocol_errors == 0


@pytest.mark.filterwarnings("ignore:set(Daemon|Name)\\(:DeprecationWarning")  # pyserial 3.5's client
@pytest.mark.parametrize("scheme", ["rfc2217", "RFC2217"])
def test_an_rfc2217_url_is_connected_to_once_although_pyserial_cannot_limit_its_writes(scheme: str) -> None:
    with rfc2217_port() as port, served(port, Robot(port)) as orders:
        url = port.address.replace("rfc2217", scheme)
        with open_url(url, read_timeout_s=0.1, write_timeout_s=0.5) as line:
            line.write(b"#STOP\r")
            eventually(lambda: bytes(orders) == b"#STOP\r")
        assert port.counters.connections == 1


def test_rfc2217_doubles_the_escape_byte_and_puts_no_answer_inside_a_frame() -> None:
    with rfc2217_port() as port:
        client = connect(port)
        eventually(lambda: len(receive(client)) > 0)  # the server's first requests
        odd = b"#\xff\xff1\r"
        Robot(port).send(odd)
        got = bytearray()
        eventually(lambda: got.endswith(b"\r"), lambda: got.extend(receive(client)))
        assert bytes(got) == b"#\xff\xff\xff\xff1\r"
        client.close()


@pytest.mark.parametrize(
    "suboption",
    [
        bytes((COM_PORT, 1)),  # baud rate without a number
        bytes((COM_PORT, 3, 99)),  # a parity that does not exist
        bytes((COM_PORT, 10)),  # mask without a value
        b"x" * 400,  # too long
    ],
)
def test_a_client_that_breaks_the_protocol_is_disconnected_and_the_next_is_served(suboption: bytes) -> None:
    with rfc2217_port() as port:
        client = connect(port)
        client.sendall(bytes((IAC, SB)) + suboption + bytes((IAC, SE)) * (len(suboption) < 300))
        eventually(lambda: not port.connected, lambda: port.receive(64))
        assert port.counters.protocol_errors == 1
        client.close()
        connect(port).close()


@settings(max_examples=40, deadline=None)
@given(st.lists(st.binary(min_size=1, max_size=200), max_size=6))
def test_random_bytes_never_break_the_rfc2217_port(chunks: list[bytes]) -> None:
    with rfc2217_port() as port:
        client = connect(port)
        for chunk in chunks:
            try:
                client.sendall(chunk)
            except OSError:
                break
            for _ in range(4):
                assert len(port.receive(64)) <= 64
                port.transmit(0)
        client.close()
        eventually(lambda: not port.connected, lambda: port.receive(64))
        connect(port).close()


def test_addresses_that_cannot_be_listened_on_are_one_clear_line() -> None:
    with tcp_port() as port:
        taken = port.address.rsplit(":", 1)[1]
        with pytest.raises(PortError, match=f"cannot listen on 127.0.0.1:{taken}"):
            open_port(listen=f"tcp://127.0.0.1:{taken}")
    for wrong in ("foo", "udp://:1", "tcp://127.0.0.1", "tcp://127.0.0.1:99999", "tcp://127.0.0.1:x"):
        with pytest.raises(PortError, match="give tcp://HOST:PORT or rfc2217://HOST:PORT"):
            open_port(listen=wrong)
    with pytest.raises(PortError, match="choose one"):
        open_port(listen="tcp://:0", link="COM3")


def test_without_a_host_it_listens_on_loopback() -> None:
    port = open_port(listen="tcp://:0")
    assert port.address.startswith("socket://127.0.0.1:")
    port.close()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name)\\(:DeprecationWarning")  # pyserial 3.5's client
@pytest.mark.parametrize("kind", [TcpPort, Rfc2217Port])
def test_hil_drive_sends_orders_over_the_network(kind: type[TcpPort]) -> None:
    port = kind("127.0.0.1", 0)
    try:
        with served(port, Robot(port)) as orders:
            assert invoke(["drive", port.address, "tele", "set", "0.2", "-0.1"]) == 0
            eventually(lambda: orders.endswith(b"-0.1\r"))
        assert bytes(orders) == b"#TELE\r#SETR0.2,-0.1\r"
    finally:
        port.close()
