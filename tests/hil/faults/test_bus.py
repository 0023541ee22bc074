"""Faults of the gyro's bus, word by word, and of one who is removed."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from emulator.clock import CYCLES_PER_MS, SYSCLK_HZ
from emulator.devices.lv_maxsonar_beam import Echo
from hil.board import load
from hil.faults import MountedFault, mount, parse
from hil.testing.faults import BoardTarget

READ_WHO_AM_I = 0x8F
#: L3G, WHO_AM_I.
IDENTITY = 0xD3


class Rig:
    """The robot's board without a program: the gyro's bus is driven by hand."""

    def __init__(self) -> None:
        self.board = load("robot")()
        self.machine = BoardTarget(self.board, lambda: pytest.fail("no firmware is linked"))
        self.bus = self.board.spi_bus["A"]
        self.bus.simo = self.bus.somi = self.bus.connected = True

    def mount(self, text: str) -> MountedFault:
        mounted = mount(parse(text), self.machine, from_now=True)  # type: ignore[arg-type]
        self.board.clock.advance_to(self.board.clock.now + 1)
        return mounted

    def who_am_i(self) -> int:
        select = self.board.pins[61]
        select.drive("test", 0)
        self.bus.exchange(READ_WHO_AM_I, 8, 1, 1)
        answer = self.bus.exchange(0, 8, 1, 1)
        select.drive("test", 1)
        return answer

    def who_am_i_in_one_word(self) -> int:
        select = self.board.pins[61]
        select.drive("test", 0)
        answer = self.bus.exchange(READ_WHO_AM_I << 8, 16, 1, 1)
        select.drive("test", 1)
        return answer & 0xFF


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    yield made
    made.board.kernel.shutdown()


def test_who_am_i(rig: Rig) -> None:
    assert rig.who_am_i() == IDENTITY
    mounted = rig.mount("gyro-who-am-i:value=0x33")
    assert rig.who_am_i() == 0x33
    assert rig.who_am_i_in_one_word() == 0x33
    assert mounted.report().count == 2
    # Other registers are what they are: CTRL_REG1 is 0x07 after power-up.
    select = rig.board.pins[61]
    select.drive("test", 0)
    rig.bus.exchange(0xA0, 8, 1, 1)
    assert rig.bus.exchange(0, 8, 1, 1) == 0x07
    select.drive("test", 1)
    mounted.remove()
    assert rig.who_am_i() == IDENTITY


@pytest.mark.parametrize(("text", "answer"), [
    ("gyro-miso-stuck:level=1", 0xFF), ("gyro-miso-stuck:level=0", 0x00), ("gyro-select-lost", 0x00),
])  # fmt: skip
def test_bus(rig: Rig, text: str, answer: int) -> None:
    mounted = rig.mount(text)
    assert rig.who_am_i() == answer
    assert mounted.report().count
    mounted.remove()
    assert rig.who_am_i() == IDENTITY


@pytest.mark.parametrize("first", [0, 1])
def test_two_faults_end_in_any_order(rig: Rig, first: int) -> None:
    both = [rig.mount("gyro-select-lost"), rig.mount("gyro-who-am-i")]
    assert rig.who_am_i() == 0
    both.pop(first).remove()
    assert rig.who_am_i() == (0x33 if first == 0 else 0)
    both.pop().remove()
    assert rig.who_am_i() == IDENTITY


def test_reset_forgets_the_registers(rig: Rig) -> None:
    gyro = rig.board.gyro
    gyro.write_register(0x20, 0x0F)
    rig.mount("gyro-reset")
    assert gyro.read_register(0x20) == 0x07


def test_brown_out_darkens_the_sonars_and_lets_them_start_up(rig: Rig) -> None:
    clock, front = rig.board.clock, rig.board.analog["A"][3]
    rig.board.sonars.set_range_source(lambda _name, _cycles: Echo(40 * 0.0254))
    rig.board.pins[69].drive("test", 1)
    clock.advance_to(SYSCLK_HZ)
    # EZ: Vcc / 512 an inch.
    ranged = pytest.approx(40 * 3.3 / 512)
    assert front.volts(clock.now) == ranged
    mounted = rig.mount("brown-out:volts=2.45")
    clock.advance_to(2 * SYSCLK_HZ)
    assert front.volts(clock.now) == 0.0
    # The gyro bears that much.
    assert rig.who_am_i() == IDENTITY
    mounted.remove()
    # 250 ms of start-up, a calibration and a range of the left one, a calibration of its own: 397 ms to its first ping.
    clock.advance_to(2 * SYSCLK_HZ + 390 * CYCLES_PER_MS)
    assert front.volts(clock.now) == 0.0
    clock.advance_to(3 * SYSCLK_HZ)
    assert front.volts(clock.now) == ranged


def test_bumper_cannot_close(rig: Rig) -> None:
    pin, bumper = rig.board.pins[43], rig.board.bumper
    mounted = rig.mount("bumper-stuck:state=released")
    assert not mounted.count
    bumper.press(True)
    assert pin.level == 1
    assert mounted.count == 1
    mounted.remove()
    assert pin.level == 0
