"""The loop that joins machine, port, pace and orders."""

from __future__ import annotations

import signal
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from hil.bench import Bench
from hil.cli import show
from hil.client.orders import TimedOrder
from hil.pacing import Pacer
from hil.serial_port import SerialPort
from hil.session import HOLD_BACK_BYTES, Session
from tests.hil.scripted_machine import BOOT_CYCLES, BYTE_CYCLES, ScriptedMachine, numbered_frame
from tests.hil.test_pacing import WallClock


class MemoryPort(SerialPort):
    """A port whose other side is two buffers."""

    address = "memory"

    def __init__(self) -> None:
        super().__init__()
        self.from_pc = bytearray()
        self.to_pc = bytearray()
        self.largest_read = 0
        self.on_write: Callable[[bytes], None] = lambda _data: None

    def wait_fds(self) -> Sequence[int]:
        return (0,)

    def close(self) -> None:
        pass

    def _write(self, data: bytes) -> int:
        self.to_pc += data
        self.on_write(data)
        return len(data)

    def _read(self, room: int) -> bytes:
        self.largest_read = max(self.largest_read, room)
        data = bytes(self.from_pc[:room])
        del self.from_pc[:room]
        return data


def booted() -> ScriptedMachine:
    machine = ScriptedMachine()
    machine.boot()
    return machine


def test_every_frame_is_handed_over_whole_and_in_order() -> None:
    machine, port = booted(), MemoryPort()
    session = Session(machine, port, Pacer(None))
    pieces: list[bytes] = []
    port.on_write = pieces.append
    session.run(10.0)
    # The first frame begins 250 ms after start-up, each ends within its period but the 40th, which begins at 10 s.
    assert pieces == [numbered_frame(number).encode() for number in range(1, 40)]
    assert session.decoder.frames == 39
    assert machine.clock.now == BOOT_CYCLES + 10 * SYSCLK_HZ


def test_a_writer_faster_than_the_line_is_held_back() -> None:
    machine, port = booted(), MemoryPort()
    port.from_pc += b"x" * 5000
    Session(machine, port, Pacer(None)).run(1.0)
    # 9600 baud take 960 bytes a second; beyond those one is on the wire and at most the bound waits.
    assert len(machine.taken) == 960
    assert 5000 - len(port.from_pc) <= 960 + 1 + HOLD_BACK_BYTES
    assert machine.pending_to_robot <= HOLD_BACK_BYTES
    assert port.largest_read <= HOLD_BACK_BYTES


def test_scripted_orders_begin_at_their_time_whatever_the_slices_are() -> None:
    machine = booted()
    orders = [TimedOrder(0.3333, b"#MISN\r"), TimedOrder(0.0, b"#STOP\r")]
    Session(machine, None, Pacer(None), orders=orders).run(1.0)
    assert machine.received == b"#STOP\r#MISN\r"
    # The first byte of an order ends one byte time after the order.
    assert machine.taken[0][0] == BOOT_CYCLES + BYTE_CYCLES
    assert machine.taken[6][0] == BOOT_CYCLES + round(0.3333 * SYSCLK_HZ) + BYTE_CYCLES


def test_an_order_is_stamped_with_the_time_of_its_arrival_not_of_its_slice() -> None:
    machine, port, wall = booted(), MemoryPort(), WallClock()
    wall.arrivals = [wall.now + 0.1230]

    def wait(fds: Sequence[int], seconds: float) -> bool:
        came = wall.wait(fds, seconds)
        if came:
            port.from_pc += b"#STOP\r"
        return came

    pacer = Pacer(1.0, monotonic=wall.monotonic, wait=wait)
    Session(machine, port, pacer).run(0.5)
    assert machine.received == b"#STOP\r"
    # Float seconds of the wall clock around 1000 s resolve about 20 cycles.
    assert abs(machine.taken[0][0] - (BOOT_CYCLES + 123 * CYCLES_PER_MS + BYTE_CYCLES)) < 100


def test_stop_ends_after_the_present_slice() -> None:
    machine = booted()
    session = Session(machine, None, Pacer(None), tick=lambda running: running.stop())
    session.run()
    assert session.elapsed_virtual_s == session.pacer.slice_cycles / SYSCLK_HZ


@pytest.mark.parametrize("booting", [True, False])
def test_a_signal_ends_firmware_that_never_yields_within_its_statement(booting: bool, tmp_path: Path) -> None:
    """Its computing time depends on how slow a computer is; its virtual time does not: one turn of a loop."""
    pytest.importorskip("pycparser", reason="needs the extra c: pip install 'c2000-hil[c]'")
    (tmp_path / "main_Robot.c").write_text(
        '#include "F28x_Project.h"\nunsigned int x;\nvoid main(void) { for (;;) x = (x ^ 3) * 5; }\n'
    )
    bench = Bench(firmware=(str(tmp_path),))
    session = Session(bench, None, Pacer(None))
    stop = show.StopRequest()
    stop.ends(bench.pause if booting else session.interrupt)
    if not booting:
        bench.power_up()
    # Half a millisecond into a slice, of 50 in the start-up and of 25 afterwards.
    sent = bench.clock.now + 100_000
    bench.clock.schedule(sent, lambda: signal.raise_signal(signal.SIGTERM))
    with show.ended_by_signals(stop):
        (bench.power_up if booting else session.run)()
    assert stop.requested
    assert sent <= bench.clock.now < sent + 100


@settings(max_examples=25, deadline=None)
@given(st.lists(st.binary(min_size=1, max_size=40), max_size=12), st.integers(1, 7))
def test_whatever_pieces_come_the_robot_gets_the_same_bytes(pieces: list[bytes], spread: int) -> None:
    machine, port = booted(), MemoryPort()
    left = list(pieces)

    def tick(session: Session) -> None:
        for _ in range(spread):
            if left:
                port.from_pc += left.pop(0)

    # 480 bytes take 0.5 s; the slices before them at most 12.
    Session(machine, port, Pacer(None), tick=tick).run(1.5)
    assert machine.received == b"".join(pieces)


def test_two_runs_give_the_same_bytes_however_they_are_sliced() -> None:
    fast, slow = booted(), booted()
    Session(fast, None, Pacer(None)).run(2.0)
    wall = WallClock()
    Session(slow, None, Pacer(3.0, monotonic=wall.monotonic, wait=wall.wait)).run(2.0)
    assert fast.uart_sha256 == slow.uart_sha256
