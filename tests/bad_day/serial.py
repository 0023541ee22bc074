"""Ports whose other side reads slowly, comes and goes, comes in crowds, or says what no order is."""

from __future__ import annotations

import contextlib
import os
import random
import socket
from collections.abc import Callable
from functools import cache

from hil.bench import Bench
from hil.machine import FirmwareStopped
from hil.serial_port import SerialPort, open_port
from tests.hil.serial_port.lines import Robot, frame

SCHEMES = ("pty", "tcp", "rfc2217")


class _Side:
    """A program at a port: never waits."""

    def __init__(self, port: SerialPort) -> None:
        if hasattr(port, "device"):
            fd = os.open(port.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            self.read: Callable[[int], bytes] = lambda count: os.read(fd, count)
            self.write: Callable[[bytes], int] = lambda data: os.write(fd, data)
            self.close: Callable[[], None] = lambda: os.close(fd)
        else:
            line = socket.socket()
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            line.setblocking(False)  # of a crowd some wait for ever
            line.connect_ex(("127.0.0.1", int(port.address.rpartition(":")[2])))
            self.read, self.write, self.close = line.recv, line.send, line.close


def _port(rng: random.Random, scheme: str) -> SerialPort:
    keep = rng.choice((1, 2, 4, 24))
    return open_port(keep=keep) if scheme == "pty" else open_port(listen=f"{scheme}://127.0.0.1:0", keep=keep)


def _plain(data: bytes, scheme: str) -> bytes:
    """What a program hears: of RFC 2217 without the talk at its begin, which has no end of a frame in it."""
    return data[data.find(b"#") :] if scheme == "rfc2217" and b"#" in data else data


def readers(seed: int) -> str:
    """A reader that is slower than the line: whole frames in their order, or none; nothing twice."""
    rng = random.Random(f"readers {seed}")
    scheme = SCHEMES[seed % len(SCHEMES)]
    frames = rng.choice((100, 400)) if scheme == "pty" else 2500
    port = _port(rng, scheme)
    side = _Side(port)
    try:
        port.transmit(0)
        robot, got = Robot(port), bytearray()

        def listen(count: int) -> bool:
            try:
                got.extend(side.read(count))
            except BlockingIOError:
                return False
            return True

        for number in range(frames):
            robot.send(frame(number))
            if count := rng.choice((0, 1, 5, 9, rng.randrange(60))):
                listen(count)
        idle = 0
        while idle < 200:
            port.transmit(robot.now)
            idle = 0 if listen(rng.randrange(1, 80)) else idle + 1
        counters = port.counters
    finally:
        side.close()
        port.close()
    units = _plain(bytes(got), scheme).split(b"\r")
    known = {frame(number)[:-1]: number for number in range(frames)}
    if torn := [unit for unit in units[:-1] if unit not in known] + [unit for unit in units[-1:] if unit]:
        return f"{scheme}: {sum(map(len, torn))} of {len(got)} bytes torn: {torn[0]!r}"
    numbers = [known[unit] for unit in units[:-1]]
    if numbers != sorted(set(numbers)):
        return f"{scheme}: frames out of order"
    if len(numbers) + counters.frames_dropped != frames:
        return f"{scheme}: {len(numbers)} read, {counters.frames_dropped} dropped, {frames} sent"
    return ""


def crowds(seed: int) -> str:
    """Programs that come together, talk nonsense and go: whoever comes afterwards hears whole frames."""
    rng = random.Random(f"crowds {seed}")
    scheme = SCHEMES[seed % len(SCHEMES)]
    port = _port(rng, scheme)
    robot, sides = Robot(port), list[_Side]()
    try:
        for number in range(rng.randrange(20, 60)):
            act = rng.random()
            with contextlib.suppress(OSError):
                if act < 0.4 and len(sides) < 20:
                    sides.append(_Side(port))
                elif act < 0.7 and sides:
                    sides.pop(rng.randrange(len(sides))).close()
                elif sides:
                    rng.choice(sides).write(rng.randbytes(rng.randrange(1, 300)))
            robot.send(frame(number))
            port.receive(rng.randrange(65))
        for side in sides:
            side.close()
        sides.clear()
        for _ in range(200):  # what they left in the buffers of the system
            while port.receive(64):
                pass
            port.transmit(robot.now)
        last, got, order = _Side(port), bytearray(), bytearray()
        sides.append(last)
        for _ in range(20):  # a terminal keeps what nobody has read
            port.transmit(robot.now)
            port.receive(64)
            with contextlib.suppress(BlockingIOError):
                last.read(65536)
        robot.send(frame(1) + frame(2))
        last.write(b"#STOP\r")
        for _ in range(2000):
            port.transmit(robot.now)
            order += port.receive(64)
            with contextlib.suppress(BlockingIOError):
                got += last.read(65536)
            if got.endswith(frame(2)) and order.endswith(b"#STOP\r"):
                return ""
        return f"{scheme}: the last heard {bytes(got)[-80:]!r}, the robot {bytes(order)[-20:]!r}"
    finally:
        for side in sides:
            side.close()
        port.close()


@cache
def _bench() -> Bench:
    bench = Bench("box", seed=1)
    bench.boot()
    return bench


def hostile_bytes(seed: int) -> str:
    """Bytes that are no orders, or nearly: the robot goes on, or stops with a sentence; the tool never fails."""
    rng = random.Random(f"bytes {seed}")
    orders = (
        b"#STOP\r", b"#MISN\r", b"#TELE\r", b"#SETR0.1,0.2\r", b"#SETR" + b"9" * 300 + b"\r", b"#INIT\r", b"#CALB\r",
    )  # fmt: skip
    data = bytearray()
    for _ in range(rng.randrange(1, 8)):
        piece = bytearray(rng.choice((*orders, rng.randbytes(rng.randrange(1, 80)))))
        if rng.random() < 0.6:
            piece[rng.randrange(len(piece))] = rng.randrange(256)
        data += piece
    bench = _bench()
    try:
        bench.feed(bytes(data))
        bench.run_until(bench.clock.now + 40_000_000)
    except FirmwareStopped:
        _bench.cache_clear()
    except Exception as error:
        _bench.cache_clear()
        return f"{bytes(data)!r}: {type(error).__name__}: {error}"
    return ""
