"""XBee S1 and the plain wire: bytes, order, times, packets, command mode."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ, Clock
from emulator.devices.serial_pacing import LinePacer, received
from emulator.devices.wire_link import WireLink
from emulator.devices.xbee import XBeeLink
from emulator.devices.xbee_radio import RadioChannel
from emulator.signals import SerialFrame, SerialLine

MS = CYCLES_PER_MS
US = CYCLES_PER_US


def char_end(n: int, baud: int = 9600) -> int:
    """End of the n-th of characters sent back to back from time 0: n * 10 bits, rounded."""
    return round(n * 10 * SYSCLK_HZ / baud)


class Bench:
    """Robot UART on one side, PC on the other."""

    def __init__(self, **kwargs: object) -> None:
        self.clock = Clock()
        self.robot_tx, self.robot_rx = SerialLine("robot TX"), SerialLine("robot RX")
        self.reports: list[tuple[str, str]] = []
        self.at_pc = bytearray()
        self.pc_times: list[int] = []
        self.at_robot: list[SerialFrame] = []
        self.robot_rx.sent.connect(self.at_robot.append)
        self.uart = LinePacer(self.clock, self.robot_tx, 9600)
        arguments: dict[str, object] = {
            "rng": random.Random(1), "report": lambda *a, **_: self.reports.append(a)
        } | kwargs  # fmt: skip
        self.link = XBeeLink(
            self.clock,
            self.robot_tx,
            self.robot_rx,
            **arguments,  # type: ignore[arg-type]
        )
        self.link.received.connect(self.pc)

    def pc(self, data: bytes, cycles: int) -> None:
        assert cycles == self.clock.now
        self.at_pc += data
        self.pc_times.append(cycles)

    def run_ms(self, ms: float) -> None:
        self.clock.advance_to(self.clock.now + round(ms * MS))

    @property
    def robot_bytes(self) -> bytes:
        return bytes(f.data for f in self.at_robot)

    def command(self, text: bytes, wait_ms: float = 200) -> bytes:
        """The PC talks to its own module."""
        self.at_pc.clear()
        self.link.feed(text)
        self.run_ms(wait_ms)
        return bytes(self.at_pc)

    def enter(self) -> None:
        assert self.command(b"+++", 1100) == b"OK\r"


def test_the_wire_paces_bytes_back_to_back_and_hands_over_at_the_stop_bit() -> None:
    clock, to_pc, to_robot = Clock(), SerialLine("a"), SerialLine("b")
    frames: list[SerialFrame] = []
    got: list[tuple[bytes, int]] = []
    to_robot.sent.connect(frames.append)
    link = WireLink(clock, to_pc, to_robot)
    link.received.connect(lambda d, c: got.append((d, c)))
    link.feed(b"#STOP\r")
    assert link.pending_to_robot == 6
    clock.advance_to(char_end(3))
    assert link.pending_to_robot == 3
    clock.advance_to(SYSCLK_HZ)
    assert bytes(f.data for f in frames) == b"#STOP\r"
    assert [(f.start, f.end) for f in frames] == [(char_end(n), char_end(n + 1)) for n in range(6)]
    LinePacer(clock, to_pc, 9600).send(b"ok")
    clock.advance_to(2 * SYSCLK_HZ)
    assert got == [(b"o", SYSCLK_HZ + char_end(1)), (b"k", SYSCLK_HZ + char_end(2))]


def test_a_thousand_characters_at_9600_baud_do_not_drift() -> None:
    # 1000 * 10 bits / 9600 = 1.0416667 s = 208,333,333 cycles.
    clock, line = Clock(), SerialLine("a")
    frames: list[SerialFrame] = []
    line.sent.connect(frames.append)
    LinePacer(clock, line, 9600).send(bytes(1000))
    clock.advance_to(2 * SYSCLK_HZ)
    assert frames[-1].end == 208_333_333


@given(data=st.integers(0, 255), error=st.floats(-0.04, 0.04))
def test_a_receiver_within_4_percent_takes_the_byte(data: int, error: float) -> None:
    # The middle of the stop bit is 9.5 bits away: 4 % of it is less than half a bit.
    frame = SerialFrame(data, 0, 208_333, 20_833.3)
    assert received(frame, 20_833.3 * (1 + error)) == (data, True)


def test_a_receiver_at_twice_the_speed_sees_each_bit_twice() -> None:
    # 0x0F, least significant first: start 0, 1 1 1 1 0 0 0 0, stop 1.  Sampled every half bit from 1.5 / 2:
    # positions 0.75 1.25 1.75 2.25 2.75 3.25 3.75 4.25 -> 0 1 1 1 1 1 1 1; the stop sample at 4.75 -> 1.
    assert received(SerialFrame(0x0F, 0, 208_333, 20_833.3), 20_833.3 / 2) == (0xFE, True)


def test_a_packet_leaves_after_three_silent_characters() -> None:
    bench = Bench()
    bench.uart.send(b"0123456789")
    bench.clock.advance_to(SYSCLK_HZ)
    # 10 characters in, RO = 3 more (3.125 ms), 2 ms latency, (10 + 21) * 32 us on the air, then one character out.
    sent = char_end(10) + round(30 * SYSCLK_HZ / 9600)
    arrival = sent + 2 * MS + 31 * 32 * US
    assert bench.pc_times[0] == arrival + char_end(1)
    assert bench.pc_times[-1] == arrival + char_end(10)
    assert bench.at_pc == b"0123456789"


def test_a_stream_without_gaps_comes_in_gulps_of_100() -> None:
    bench = Bench()
    bench.uart.send(bytes(250))
    bench.clock.advance_to(SYSCLK_HZ)
    assert len(bench.at_pc) == 250
    assert bench.link.air.packets == 3
    # The first gulp leaves with the 100th character.
    assert bench.pc_times[0] == char_end(100) + 2 * MS + 121 * 32 * US + char_end(1)


@settings(max_examples=30)
@given(
    st.lists(st.tuples(st.booleans(), st.binary(min_size=1, max_size=120), st.floats(0, 300)), max_size=12),
    st.integers(0, 1000),
)
def test_without_loss_every_byte_arrives_once_and_in_order(script: list[tuple[bool, bytes, float]], seed: int) -> None:
    clock = Clock()
    air = RadioChannel(clock, rng=random.Random(seed), ideal=False, packet_loss=0.0, burst_loss=0.0)
    robot_tx, robot_rx = SerialLine("tx"), SerialLine("rx")
    at_robot, at_pc = bytearray(), bytearray()
    robot_rx.sent.connect(lambda f: at_robot.append(f.data))
    link = XBeeLink(clock, robot_tx, robot_rx, rng=random.Random(seed), air=air)
    link.received.connect(lambda d, _c: at_pc.extend(d))
    uart = LinePacer(clock, robot_tx, 9600)
    sent_robot, sent_pc = bytearray(), bytearray()
    for from_robot, data, gap_ms in script:
        data = data.replace(b"+", b"-")  # the command sequence has its own tests
        (sent_robot if from_robot else sent_pc).extend(data)
        (uart.send if from_robot else link.feed)(data)
        clock.advance_to(clock.now + round(gap_ms * MS))
    clock.advance_to(clock.now + 10 * SYSCLK_HZ)
    assert at_pc == sent_robot
    assert at_robot == sent_pc
    assert link.pending_to_robot == 0


def test_loss_takes_whole_packets_and_leaves_the_order() -> None:
    clock = Clock()
    air = RadioChannel(clock, rng=random.Random(5), ideal=False, packet_loss=0.3, burst_loss=0.3)
    robot_tx, at_pc = SerialLine("tx"), bytearray()
    link = XBeeLink(clock, robot_tx, SerialLine("rx"), rng=random.Random(1), air=air)
    link.received.connect(lambda d, _c: at_pc.extend(d))
    uart = LinePacer(clock, robot_tx, 9600)
    for n in range(200):
        uart.send(b"<%03d>" % n)
        clock.advance_to(clock.now + 40 * MS)
    numbers = [int(text[1:]) for text in bytes(at_pc).decode().split(">") if text]
    assert numbers == sorted(set(numbers))
    assert len(at_pc) == 5 * len(numbers)
    assert len(numbers) == 200 - air.lost
    assert 35 <= air.lost <= 85  # 60 expected, standard deviation 6.5


def test_a_lost_unicast_is_told_by_the_ea_counter_only() -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(b"ATID1234,CN\r") == b"OK\rOK\r"  # another network: nobody acknowledges
    bench.link.feed(b"x")
    bench.run_ms(2000)
    assert bench.robot_bytes == b""
    bench.enter()
    assert bench.command(b"ATEA\r") == b"1\r"


def test_cts_is_taken_at_17_free_and_given_back_at_34() -> None:
    bench = Bench()
    edges: list[tuple[int, int]] = []
    module = bench.link.robot
    module.cts.changed.connect(lambda level: edges.append((level, 202 - module.bytes_from_host)))
    bench.link.air.busy = True  # a jammed channel
    bench.uart.send(bytes(300))
    bench.clock.advance_to(char_end(300) + MS)
    assert edges == [(1, 17)]
    assert module.di_overflow == 300 - 202  # silently
    bench.link.air.busy = False
    module.radio_free()
    assert edges[-1][0] == 0
    assert module.cts.level == 0


def test_a_packet_that_does_not_fit_the_do_buffer_is_dropped_whole() -> None:
    bench = Bench()
    for _ in range(3):
        bench.link.robot.radio_received(bytes(100))
    bench.clock.advance_to(SYSCLK_HZ)
    assert len(bench.at_robot) == 200
    assert bench.link.robot.do_dropped == 100


def test_pending_counts_a_byte_until_its_stop_bit_at_the_robot() -> None:
    bench = Bench()
    bench.link.feed(b"#STOP\r")
    seen = []
    while bench.link.pending_to_robot:
        seen.append(bench.link.pending_to_robot + len(bench.at_robot))
        bench.run_ms(0.25)
    assert set(seen) == {6}
    assert bench.robot_bytes == b"#STOP\r"


def test_the_command_sequence_is_answered_and_never_transmitted() -> None:
    bench = Bench()
    bench.run_ms(500)
    bench.enter()
    assert bench.link.pc.command_mode
    assert bench.command(b"ATCN\r") == b"OK\r"
    assert not bench.link.pc.command_mode
    assert bench.at_robot == []


@pytest.mark.parametrize("text", [b"+++\r", b"++", b"x+++", b"++++"])
def test_what_is_not_exactly_the_sequence_is_data(text: bytes) -> None:
    bench = Bench()
    bench.run_ms(1500)
    bench.link.feed(text)
    bench.run_ms(3000)
    assert bench.robot_bytes == text
    assert not bench.link.pc.command_mode


def test_without_guard_silence_before_it_the_sequence_is_data() -> None:
    bench = Bench()
    bench.link.feed(b"x")
    bench.run_ms(900)
    bench.link.feed(b"+++")
    bench.run_ms(2000)
    assert bench.robot_bytes == b"x+++"


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        (b"AT\r", b"OK\r"),
        (b"ATCH\r", b"C\r"),
        (b"ATID\r", b"3332\r"),
        (b"atbd\r", b"3\r"),
        (b"ATCT\r", b"64\r"),
        (b"ATGT\r", b"3E8\r"),
        (b"ATCC\r", b"2B\r"),
        (b"ATSH\r", b"13A200\r"),
        (b"ATRO 5\r", b"OK\r"),
        (b"ATNIrobot,NI,RR2,RR\r", b"OK\rrobot\rOK\r2\r"),
        (b"ATCH1B\r", b"ERROR\r"),  # 0B-1A
        (b"ATSL1\r", b"ERROR\r"),  # read only
        (b"ATGTG\r", b"ERROR\r"),
        (b"ATXX\r", b"ERROR\r"),
        (b"hello\r", b"ERROR\r"),
        (b"AT" + b"A" * 200 + b"\r", b"ERROR\r"),
    ],
)
def test_commands_are_answered(line: bytes, answer: bytes) -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(line, 300) == answer


def test_what_is_kept_without_effect_is_reported() -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(b"ATAP1\r") == b"OK\r"
    assert [rule for rule, _ in bench.reports] == ["unmodelled"]


def test_a_new_baud_rate_takes_effect_after_the_answer_to_cn() -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(b"ATBD6\r") == b"OK\r"
    assert bench.command(b"ATBD,CN\r") == b"6\rOK\r"  # answered at 9600
    bench.link.set_pc_baud(57600)
    bench.link.feed(b"fast")
    bench.run_ms(100)
    assert bench.robot_bytes == b"fast"
    # The robot's side stayed at 9600.
    assert bench.at_robot[3].end - bench.at_robot[0].start == char_end(4)


def test_command_mode_times_out_after_ct() -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(b"ATCT5,AC\r", 100) == b"OK\rOK\r"
    bench.run_ms(300)
    assert bench.link.pc.command_mode
    bench.link.feed(b"\r")
    # One character and CT = 500 ms after its stop bit.
    bench.run_ms(499)
    assert bench.link.pc.command_mode
    bench.run_ms(3)
    assert not bench.link.pc.command_mode


def test_only_what_was_written_survives_a_reset() -> None:
    bench = Bench()
    bench.enter()
    assert bench.command(b"ATRO7,WR,RO9,FR\r", 300) == b"OK\rOK\rOK\rOK\r"
    assert not bench.link.pc.command_mode
    bench.run_ms(1000)
    bench.enter()
    assert bench.command(b"ATRO,RE,RO\r") == b"7\rOK\r3\r"


def test_data_from_the_air_waits_while_the_host_is_in_command_mode() -> None:
    bench = Bench()
    bench.enter()
    bench.at_pc.clear()
    bench.uart.send(b"data")
    bench.run_ms(200)
    assert bench.at_pc == b""
    assert bench.command(b"ATCN\r") == b"OK\rdata"


def test_an_unknown_baud_rate_is_refused() -> None:
    with pytest.raises(ValueError, match="expected one of 1200, 2400"):
        Bench(baud=1234)
