"""The board support modules on the emulated chip: what their registers make the pins, lines and kernel do."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US
from emulator.image import Firmware
from firmware_model.image import link
from hil.robot.board import RobotBoard

SUPPORT = "firmware_model.board_support."
#: LSPCLK 50 MHz / ((650 + 1) * 8): ten bits of 651 * 8 LSPCLK, 4 SYSCLK each.
CHARACTER_CYCLES = 10 * 651 * 8 * 4


def linked(*modules: str) -> tuple[RobotBoard, Firmware]:
    board = RobotBoard()
    return board, link(board, modules=[SUPPORT + module for module in modules])


class Radio:
    """XBee.c under a running kernel; `read` is called in place of TaskORD for each posted Swi."""

    def __init__(self) -> None:
        self.board, self.fw = linked("xbee")
        self.received: list[str] = []
        self.sent: list[tuple[int, bytes]] = []
        self.board.link.received.connect(lambda data, cycles: self.sent.append((cycles, data)))
        self.buffer = self.fw.array("char", [0] * 100)
        self.board.kernel.start(self._main)
        self.run_ms(1)

    def _main(self) -> None:
        kernel, xbee = self.board.kernel, self.fw.xbee
        swi = kernel.externs["Swi_create"](self._read, None, None)
        xbee.Init_XBee()
        xbee.Receive_Frames("#", "\r")
        xbee.Install_Received_Frame_Action(swi)
        kernel.externs["BIOS_start"]()

    def _read(self, *_arguments: Any) -> None:
        self.fw.xbee.Read_Frame(self.buffer)
        characters = []
        for i in range(100):
            character = self.buffer[i]
            if character == 0:
                break
            characters.append(chr(character))
        self.received.append("".join(characters))

    def run_ms(self, ms: int) -> None:
        self.board.kernel.run_until(self.board.clock.now + ms * CYCLES_PER_MS)

    def hear(self, data: bytes) -> None:
        self.board.link.feed(data)
        self.run_ms(2 + 2 * len(data))


def test_a_frame_arrives_whole_with_both_marks() -> None:
    radio = Radio()
    radio.hear(b"#STOP\r")
    assert radio.received == ["#STOP\r"]
    assert radio.board.findings.of("clock-gated") == radio.board.findings.of("eallow") == []


def test_frames_back_to_back_and_in_pieces_arrive_in_order() -> None:
    radio = Radio()
    for piece in (b"#TELE\r#SE", b"TR0.2,", b"0.0\r#MISN\r"):
        radio.hear(piece)
    assert radio.received == ["#TELE\r", "#SETR0.2,0.0\r", "#MISN\r"]


def test_characters_outside_frames_are_ignored_and_a_begin_mark_starts_anew() -> None:
    radio = Radio()
    radio.hear(b"\r\nnoise#ST#MISN\r\rx")
    assert radio.received == ["#MISN\r"]


@pytest.mark.parametrize(("length", "arrives"), [(79, True), (80, False), (300, False)])
def test_a_frame_longer_than_the_buffer_is_dropped_and_the_next_one_arrives(length: int, arrives: bool) -> None:
    # 80 words hold 79 characters and the NUL.
    radio = Radio()
    long = b"#" + b"x" * (length - 2) + b"\r"
    radio.hear(long)
    radio.hear(b"#STOP\r")
    assert radio.received == [long.decode()] * arrives + ["#STOP\r"]


def test_the_buffer_keeps_what_lies_behind_the_nul() -> None:
    radio = Radio()
    radio.hear(b"#SETR0.30,0.70\r")
    radio.hear(b"#STOP\r")
    assert radio.buffer[6] == 0
    assert [*map(chr, radio.buffer[7:15])] == list("30,0.70\r")


def test_reception_goes_on_after_a_break() -> None:
    radio = Radio()
    line = radio.board.serial_pins[90]
    line.hold_low(True)
    radio.run_ms(20)
    line.hold_low(False)
    radio.run_ms(5)
    frame = b"#ODO 0,0,0,0,0,0\n\r"
    data = radio.fw.array("char", list(frame))
    radio.fw.xbee.Send_Frame(data, len(frame))
    radio.run_ms(30)
    radio.hear(b"#STOP\r")
    assert radio.received == ["#STOP\r"]
    assert b"".join(data for _, data in radio.sent) == frame


def test_a_disturbed_receive_line_costs_no_character_that_is_being_sent() -> None:
    radio = Radio()
    line = radio.board.serial_pins[90]
    frame = b"#ODO 100,-20,0,2000,1500,1500\n\r"
    data = radio.fw.array("char", list(frame))
    radio.fw.xbee.Send_Frame(data, len(frame))
    radio.run_ms(3)
    line.hold_low(True)
    radio.run_ms(20)
    line.hold_low(False)
    radio.run_ms(30)
    assert b"".join(data for _, data in radio.sent) == frame


def test_a_sent_frame_leaves_without_gaps_and_the_call_returns_at_once() -> None:
    radio = Radio()
    frame = b"#ODO 100,-20,0,2000,1500,1500\n\r"  # 31 characters: the FIFO of 16 is refilled once
    data = radio.fw.array("char", list(frame))
    before = radio.board.clock.now
    radio.fw.xbee.Send_Frame(data, len(frame))
    assert radio.board.clock.now - before < 10 * CYCLES_PER_US
    radio.run_ms(50)
    assert b"".join(data for _, data in radio.sent) == frame
    times = [cycles for cycles, _ in radio.sent]
    assert {later - earlier for earlier, later in itertools.pairwise(times)} == {CHARACTER_CYCLES}


def test_only_the_low_8_bits_of_a_16_bit_char_leave() -> None:
    radio = Radio()
    radio.fw.xbee.Send_Frame(radio.fw.array("char", [0x1241]), 1)
    radio.run_ms(5)
    assert [data for _, data in radio.sent] == [b"A"]


def test_a_second_frame_replaces_what_is_left_of_the_first() -> None:
    radio = Radio()
    first, second = radio.fw.array("char", list(b"a" * 40)), radio.fw.array("char", list(b"b" * 5))
    radio.fw.xbee.Send_Frame(first, 40)
    radio.run_ms(1)
    radio.fw.xbee.Send_Frame(second, 5)
    radio.run_ms(60)
    sent = b"".join(data for _, data in radio.sent)
    # 16 in the FIFO and one in the shifter at most had left the buffer.
    assert sent == b"a" * sent.count(b"a") + b"b" * 5
    assert 1 <= sent.count(b"a") <= 17


class Echo:
    """An SPI slave that answers with the complement of the byte before."""

    def __init__(self) -> None:
        self.words: list[tuple[int, int, int, int]] = []
        self.selected: list[int] = []
        self.answer = 0

    def select(self, level: int) -> None:
        self.selected.append(level)

    def exchange(self, out_bits: int, length: int, cpol: int, cpha: int) -> int:
        self.words.append((out_bits, length, cpol, cpha))
        answer, self.answer = self.answer, ~out_bits & 0xFF
        return answer


def test_spi_sends_8_bits_in_mode_3_and_returns_8_bits() -> None:
    board, fw = linked("spi")
    echo = Echo()
    board.spi_bus["A"].attach(board.pins[61], echo)
    fw.spi.Init_SPIA()
    fw.spi.Set_CS(0)
    assert fw.spi.SPI_transfer(0xA5) == 0
    # Without the mask the leftovers of the transmitted byte would stand above the answer.
    assert fw.spi.SPI_transfer(0x00) == 0x5A
    fw.spi.Set_CS(1)
    assert echo.words == [(0xA5, 8, 1, 1), (0x00, 8, 1, 1)]  # CPOL 1, CPHA 1: mode 3
    assert echo.selected[-2:] == [0, 1]
    assert list(board.findings) == []


def test_spi_needs_8_microseconds_a_byte() -> None:
    board, fw = linked("spi")
    fw.spi.Init_SPIA()
    before = board.clock.now
    fw.spi.SPI_transfer(0)
    # 8 bits of 50 LSPCLK, 4 SYSCLK each, and the instructions around them: TaskGYRO's 43 us (TFG figure 37) less three
    # bytes and a gate leave some 15 us for all of its code.
    assert 8 * CYCLES_PER_US <= board.clock.now - before < 10 * CYCLES_PER_US


@pytest.mark.parametrize(("side", "pins"), [("left", (10, 11)), ("right", (62, 63))])
def test_encoders_count_every_edge_both_ways_and_below_zero(side: str, pins: tuple[int, int]) -> None:
    board, fw = linked("encoder")
    getattr(fw.encoder, f"Init_Encoder_{side}")()
    position = getattr(fw.encoder, f"Encoder_{side}")
    wire = board.encoder_pins[pins]
    now = board.clock.now
    wire.move(100, now, now + 1000 * CYCLES_PER_US)
    board.clock.advance_to(now + 2000 * CYCLES_PER_US)
    assert position() == 100
    now = board.clock.now
    wire.move(-730, now, now + 1000 * CYCLES_PER_US)
    board.clock.advance_to(now + 2000 * CYCLES_PER_US)
    assert position() == -630
    assert list(board.findings) == []


@pytest.mark.parametrize(("module", "pins"), [(2, ("GPIO2", "GPIO3")), (7, ("GPIO12", "GPIO13"))])
@pytest.mark.parametrize("duties", [(0.0, 0.0), (1.0, 1.0), (1.0, 0.25), (0.5, 1.0)])
def test_pwm_puts_both_duties_on_the_bridge_at_20_khz(
    module: int, pins: tuple[str, str], duties: tuple[float, float]
) -> None:
    board, fw = linked("pwm")
    getattr(fw.pwm, f"Init_EPWM{module}")()
    getattr(fw.pwm, f"Duty_EPWM{module}")(*duties)
    board.clock.advance_to(board.clock.now + CYCLES_PER_MS)
    wires = [board.pwm_outputs[pin] for pin in pins]
    assert tuple(wire.duty for wire in wires) == duties
    # 5000 TBCLK of 100 MHz are 10000 SYSCLK; a steady level has no period.
    assert {wire.period_cycles for wire in wires if 0.0 < wire.duty < 1.0} <= {10_000}
    assert list(board.findings) == []


def test_the_bumper_reads_0_while_pressed() -> None:
    board, fw = linked("bumper")
    fw.bumper.Init_Bumper()
    readings = []
    for pressed in (False, True, False):
        board.bumper.press(pressed)
        board.clock.advance_to(board.clock.now + 50 * CYCLES_PER_MS)
        readings.append(fw.bumper.Read_Bumper())
    assert readings == [1, 0, 1]


def test_time_counts_milliseconds_and_wraps_at_16_bits() -> None:
    board, fw = linked("clock")
    fw.clock.Init_Clock()
    start = board.clock.now
    assert fw.clock.Get_Time() == 0
    board.clock.advance_to(start + 1500 * CYCLES_PER_MS + CYCLES_PER_MS // 2)
    assert fw.clock.Get_Time() == 1500
    board.clock.advance_to(start + 65_537 * CYCLES_PER_MS + CYCLES_PER_MS // 2)
    assert fw.clock.Get_Time() == 1


def test_the_period_timer_sets_its_flag_after_the_period() -> None:
    board, fw = linked("clock")
    fw.clock.Init_Clock()
    fw.clock.Set_Timer(5)
    start = board.clock.now
    control = board.register("CpuTimer0Regs", "TCR")
    board.clock.advance_to(start + 5 * CYCLES_PER_MS - CYCLES_PER_US)
    assert control.read() >> 15 == 0
    board.clock.advance_to(start + 5 * CYCLES_PER_MS + CYCLES_PER_US)
    assert control.read() >> 15 == 1


@pytest.mark.parametrize(
    ("side", "side_cm", "front_cm", "v", "w"),
    [
        # 10 cm too far from a wall: K_SIDE * 10 = 0.2 rad/s towards it, left is positive.
        (0, 40.0, 100.0, 0.15, 0.2), (1, 40.0, 100.0, 0.15, -0.2),
        # 60 cm too far: limited to 0.5 rad/s.
        (0, 90.0, 100.0, 0.15, 0.5),
        # 42.5 cm in front lie half-way between 25 and 60: half speed.
        (0, 30.0, 42.5, 0.075, 0.0),
        # Too near in front: turn on the spot, away from the wall.
        (0, 30.0, 20.0, 0.0, -0.5), (1, 30.0, 20.0, 0.0, 0.5),
    ],
)  # fmt: skip
def test_wall_follower_keeps_its_distance(side: int, side_cm: float, front_cm: float, v: float, w: float) -> None:
    _, fw = linked("wall_follower")
    reference = fw.new("REFERENCE", V=9.0, W=9.0)
    fw.wall_follower.Wall_Follower(side, side_cm, front_cm, 30.0, reference)
    assert reference.V == pytest.approx(v, abs=1e-6)
    assert reference.W == pytest.approx(w, abs=1e-6)
