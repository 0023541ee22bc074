"""CAN controller (TRM CAN), in register language: interfaces, bit timing, sending and receiving, errors, interrupts."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from emulator.can_bus import CanError, CanFrame, CanPart, frame_bits
from emulator.chip import Chip
from emulator.registers.core import ALL, HIGH, LOW

#: BTR for 500 kbit/s at 200 MHz: 20 quanta (TSEG1 12: 13, TSEG2 5: 6, and one) of BRP + 1 = 20 clocks: 400 cycles.
BTR = 5 << 12 | 12 << 8 | 19
BIT = 400
#: CAN_CTL
INIT, IE0, SIE, EIE, DAR, CCE, TEST, ABO, IE1 = 1, 2, 4, 8, 0x20, 0x40, 0x80, 0x200, 1 << 17
PARITY_OFF = 5 << 10
#: CAN_TEST
SILENT, LBACK, EXL = 8, 0x10, 0x100
#: CAN_IFxCMD: write; mask, arbitration, control; request; clear IntPnd; data.
WRITE, MASK, ARB, CONTROL, CLEAR, REQUEST, DATA = 1 << 23, 1 << 22, 1 << 21, 1 << 20, 1 << 19, 1 << 18, 3 << 16
BUSY = 1 << 15
#: Arbitration and control words.
VALID, XTD, TRANSMIT = 1 << 31, 1 << 30, 1 << 29
NEWDAT, MSGLST, INTPND, UMASK, TXIE, RXIE, RMTEN, TXRQST, EOB = (1 << bit for bit in range(15, 6, -1))
#: CANTX and CANRX of each module, as functions: GPIO31 and 30 for A, 12 and 17 for B.
PINS = {"A": ((31, 1), (30, 1)), "B": ((12, 2), (17, 2))}
#: IF1 and IF2 take 3 clocks of the module (CHOICE).
TRANSFER = 3


class Bench:
    """A chip with its controllers, and the steps that every driver takes."""

    def __init__(self, *letters: str, pins: bool = True, ctl: int = 0, test: int = 0, start: bool = True) -> None:
        self.chip = chip = Chip(rng=Random(0))
        self.clock, self.findings = chip.clock, chip.findings
        self.write_to("CpuSysRegs", "PCLKCR10", 0b11)
        for letter in letters or ("A",):
            if pins:
                self.pin(letter)
            self.write(letter, "CTL", INIT | CCE | PARITY_OFF)
            self.write(letter, "BTR", BTR)
            if start:
                self.write(letter, "CTL", PARITY_OFF | ctl | (TEST if test else 0))
            if test:
                self.write(letter, "TEST", test)
        self.wait_bits(11)  # after which they take part in the bus

    def pin(self, letter: str, function: bool = True) -> None:
        """Give both pins to the module, or take them away."""
        for pin, mux in PINS[letter]:
            port, at = "ABC"[pin // 32], pin % 32
            half = 1 if at < 16 else 2
            name = f"GP{port}MUX{half}"
            old = self.chip.register("GpioCtrlRegs", name).value
            shift = 2 * (at % 16)
            self.write_to("GpioCtrlRegs", name, old & ~(3 << shift) | (mux if function else 0) << shift)

    def write_to(self, block: str, register: str, word: int) -> None:
        self.chip.cpu.eallow = True
        self.chip.register(block, register).write(word, ALL)

    def write(self, letter: str, register: str, word: int, lanes: int = ALL) -> None:
        self.chip.register(f"Can{letter.lower()}Regs", f"CAN_{register}").write(word, lanes)

    def read(self, letter: str, register: str) -> int:
        return self.chip.register(f"Can{letter.lower()}Regs", f"CAN_{register}").read()

    def wait(self, cycles: int) -> None:
        self.clock.advance_to(self.clock.now + cycles)

    def wait_bits(self, bits: int) -> None:
        self.wait(bits * BIT)

    def command(self, letter: str, word: int, n: int = 1) -> None:
        """Give a command to an interface and wait for Busy."""
        self.write(letter, f"IF{n}CMD", word)
        assert self.read(letter, f"IF{n}CMD") & BUSY
        self.wait(TRANSFER * (self.chip.sysctrl.can_cycles(letter) or 1))
        assert not self.read(letter, f"IF{n}CMD") & BUSY

    def object(self, letter: str, number: int, arb: int, control: int, mask: int = 0, data: bytes = b"") -> None:
        """Set up a message object."""
        self.write(letter, "IF1MSK", mask)
        self.write(letter, "IF1ARB", arb)
        self.write(letter, "IF1MCTL", control)
        padded = data.ljust(8, b"\0")
        self.write(letter, "IF1DATA", int.from_bytes(padded[:4], "little"))
        self.write(letter, "IF1DATB", int.from_bytes(padded[4:], "little"))
        self.command(letter, WRITE | MASK | ARB | CONTROL | DATA | number)

    def transmit(self, letter: str, number: int, identifier: int, data: bytes = b"", control: int = 0) -> None:
        """An object of 11 bits that waits for its transmission."""
        self.object(letter, number, VALID | TRANSMIT | identifier << 18, EOB | TXRQST | control | len(data), 0, data)

    def receive(self, letter: str, number: int, identifier: int, control: int = 0, mask: int = 0) -> None:
        """An object of 11 bits that receives."""
        self.object(letter, number, VALID | identifier << 18, EOB | control, mask)

    def message(self, letter: str, number: int, clear: int = 0) -> tuple[int, bytes]:
        """Control word and bytes of an object, read through IF2."""
        self.command(letter, MASK | ARB | CONTROL | DATA | clear | number, n=2)
        words = (self.read(letter, f"IF2DAT{x}") for x in "AB")
        return self.read(letter, "IF2MCTL"), b"".join(word.to_bytes(4, "little") for word in words)

    def rules(self) -> list[str]:
        return [finding.rule for finding in self.findings]

    def part(self, letter: str = "A", **options: int) -> CanPart:
        """A part on the bus of a module."""
        part = CanPart(**options)
        part.connect(self.chip.can_bus[letter])
        return part


# Interfaces


def test_an_object_goes_through_an_interface_and_comes_back_through_the_other() -> None:
    bench = Bench()
    bench.object("A", 7, XTD | 0x1234567, UMASK | EOB | 8, mask=0xC0000FFF, data=b"12345678")
    control, data = bench.message("A", 7)
    assert (control, data) == (UMASK | EOB | 8, b"12345678")
    assert bench.read("A", "IF2ARB") == XTD | 0x1234567
    # Bit 29 of the mask is reserved and reads 1.
    assert bench.read("A", "IF2MSK") == 0xE0000FFF
    # An object is only what its number says.
    assert bench.message("A", 8) == (0, bytes(8))
    assert bench.rules() == []


def test_only_what_the_command_names_moves_and_the_rest_of_the_interface_follows_the_object() -> None:
    bench = Bench()
    bench.object("A", 1, 0x111 << 18, EOB | 4, data=b"abcdefgh")
    bench.write("A", "IF1ARB", 0x222 << 18)
    bench.write("A", "IF1DATA", 0)
    bench.command("A", WRITE | ARB | 1)
    # After a partial write the other registers of the interface show the object.
    assert bench.read("A", "IF1DATA") == int.from_bytes(b"abcd", "little")
    assert bench.message("A", 1) == (EOB | 4, b"abcdefgh")
    assert bench.read("A", "IF2ARB") == 0x222 << 18
    # After a partial read they stay.
    bench.write("A", "IF2MCTL", 0)
    bench.command("A", ARB | 1, n=2)
    assert bench.read("A", "IF2MCTL") == 0


def test_a_write_while_busy_is_dropped_and_told() -> None:
    bench = Bench()
    bench.write("A", "IF1ARB", VALID)
    bench.write("A", "IF1CMD", WRITE | ARB | 1)
    bench.write("A", "IF1ARB", 0)
    bench.write("A", "IF1CMD", WRITE | ARB | 2)
    bench.write("A", "IF2ARB", 5)  # the other interface is free
    assert [(f.rule, f.object) for f in bench.findings] == [
        ("can-interface-busy", "CanaRegs.CAN_IF1ARB"), ("can-interface-busy", "CanaRegs.CAN_IF1CMD"),
    ]  # fmt: skip
    bench.wait(TRANSFER)
    assert bench.read("A", "MVAL_21") == 1


@pytest.mark.parametrize(("command", "wait", "looks", "told"), [
    (DATA, 0, False, True), (DATA, TRANSFER + 1, False, True), (DATA, TRANSFER + 1, True, False),
    (DATA, 0, True, True), (DATA, 1000, False, False), (ARB, 0, False, False), (WRITE | DATA, 0, False, False),
])  # fmt: skip
def test_what_a_command_fetches_is_read_behind_a_look_at_busy(command: int, wait: int, looks: bool, told: bool) -> None:
    bench = Bench()
    bench.write("A", "IF2CMD", command | 1)
    bench.wait(wait)
    if looks:
        bench.read("A", "IF2CMD")
    bench.read("A", "IF2DATA")
    assert [(f.rule, f.object) for f in bench.findings] == [("can-interface-busy", "CanaRegs.CAN_IF2DATA")] * told


def test_only_the_message_number_starts_a_transfer() -> None:
    bench = Bench()
    bench.write("A", "IF1CMD", WRITE | ARB, HIGH)
    assert not bench.read("A", "IF1CMD") & BUSY
    bench.write("A", "IF1CMD", 3, LOW)
    assert bench.read("A", "IF1CMD") == WRITE | ARB | BUSY | 3


def test_a_field_of_the_upper_half_is_written_with_the_whole_register() -> None:
    bench = Bench()
    # The compiler does not break up a register of 32 bits of a byte peripheral (SPRU514): the number is written too.
    command = bench.chip.blocks["CanaRegs"].registers["CAN_IF1CMD"]
    command.Arb = 1  # type: ignore[attr-defined]
    assert command.read() == ARB | BUSY | 1


def test_flags_of_all_objects_stand_in_their_registers() -> None:
    bench = Bench(start=False)
    bench.transmit("A", 1, 1)
    bench.transmit("A", 32, 2, control=NEWDAT)
    bench.receive("A", 9, 3, control=INTPND)
    assert bench.read("A", "TXRQ_21") == 1 << 31 | 1
    assert bench.read("A", "NDAT_21") == 1 << 31
    assert bench.read("A", "IPEN_21") == 1 << 8
    assert bench.read("A", "MVAL_21") == 1 << 31 | 1 << 8 | 1
    # Groups of eight: 1 to 8, 9 to 16, 17 to 24, 25 to 32.
    assert [bench.read("A", f"{name}_X") for name in ("TXRQ", "NDAT", "IPEN", "MVAL")] == [9, 8, 2, 0b1011]


def test_the_message_ram_is_cleared_by_its_key_alone() -> None:
    bench = Bench(start=False)
    bench.receive("A", 4, 0x44)
    bench.write("A", "RAM_INIT", 0x10 | 0x5)
    bench.wait(10_000)
    assert bench.read("A", "MVAL_21") == 1 << 3
    bench.write("A", "RAM_INIT", 0x10 | 0xA)
    assert not bench.read("A", "RAM_INIT") & 0x20
    bench.wait(10_000)
    # Done, and the key back at its reset value (HDR can.h, CAN_initRAM).
    assert bench.read("A", "RAM_INIT") == 0x25
    assert bench.read("A", "MVAL_21") == 0


# Bit timing and the bus


@settings(max_examples=30)
@given(
    prescaler=st.integers(0, 40), seg1=st.integers(1, 15), seg2=st.integers(0, 7), source=st.sampled_from([0, 1]),
)  # fmt: skip
def test_a_frame_takes_its_bits_at_the_rate_of_the_bit_timing(
    prescaler: int, seg1: int, seg2: int, source: int
) -> None:
    bench = Bench(start=False)
    bench.write_to("ClkCfgRegs", "CLKSRCCTL2", source << 2)
    bench.write("A", "BTR", seg2 << 12 | seg1 << 8 | prescaler & 0x3F | prescaler >> 6 << 16)
    # SYSCLK, or the crystal of 10 MHz: 20 cycles.
    bit = (1 + seg1 + 1 + seg2 + 1) * (prescaler + 1) * (20 if source else 1)
    ends: list[int] = []
    bench.chip.can_bus["A"].arrived.connect(lambda _frame: ends.append(bench.clock.now))
    node = CanPart()
    node.bit_cycles = bit
    node.connect(bench.chip.can_bus["A"])
    bench.transmit("A", 1, 0x2AA, b"\x5a")
    begin = bench.clock.now
    bench.write("A", "CTL", PARITY_OFF)
    bench.wait(200 * bit)
    # Eleven recessive bits behind Init = 0, then the frame.
    frame = CanFrame(0x2AA, b"\x5a")
    assert ends == [begin + (11 + len(frame_bits(frame))) * bit]
    assert node.frames == [frame]


def test_the_bit_timing_is_locked_without_init_and_cce() -> None:
    bench = Bench()
    bench.write("A", "BTR", 0)
    bench.write("A", "CTL", INIT | PARITY_OFF)
    bench.write("A", "BTR", 0)
    assert bench.read("A", "BTR") == BTR
    assert bench.rules() == ["locked"]
    assert bench.findings.of("locked")[0].count == 2


def test_two_controllers_of_one_chip_talk() -> None:
    bench = Bench("A", "B")
    bench.chip.join_can()
    bench.receive("B", 5, 0x321)
    bench.wait_bits(11)  # B is on another bus now
    bench.transmit("A", 2, 0x321, b"hello")
    bench.wait_bits(150)
    assert bench.message("B", 5) == (NEWDAT | EOB | 5, b"hello\0\0\0")
    assert bench.read("A", "TXRQ_21") == 0
    # LEC 0, TxOk; then nothing since the last read: LEC 7.
    assert (bench.read("A", "ES"), bench.read("A", "ES")) == (0x08, 0x07)
    assert bench.read("B", "ES") == 0x10
    assert bench.rules() == []


def test_parts_of_both_buses_are_on_one_when_they_are_joined() -> None:
    bench = Bench("A", "B")
    on_a, on_b = bench.part("A"), bench.part("B")
    seen: list[CanFrame] = []
    bench.chip.can_bus["B"].arrived.connect(seen.append)
    for _ in range(2):
        bench.chip.join_can()
    bench.wait_bits(11)
    on_b.send(CanFrame(0x12, b"b"))
    bench.wait_bits(200)
    assert on_a.frames == seen == [CanFrame(0x12, b"b")]
    assert bench.read("A", "ES") & 0x10
    assert bench.read("B", "ES") & 0x10


def test_objects_are_sent_in_the_order_of_their_numbers_and_identifiers_decide_between_nodes() -> None:
    bench = Bench("A", "B")
    bench.chip.join_can()
    listener = bench.part()
    bench.wait_bits(11)
    bench.part().send(CanFrame(0x7FF))
    bench.wait_bits(1)  # the bus is busy while the others get ready
    bench.transmit("A", 3, 0x300)
    bench.transmit("A", 1, 0x400)
    bench.transmit("B", 1, 0x350)
    bench.wait_bits(400)
    # A offers object 1 first, although its identifier is higher, so B's wins; then A's two in order.
    assert [frame.identifier for frame in listener.frames] == [0x7FF, 0x350, 0x400, 0x300]


def test_without_pins_no_frame_reaches_the_bus_and_it_is_told() -> None:
    bench = Bench(pins=False)
    listener = bench.part()
    bench.transmit("A", 1, 1)
    bench.wait_bits(40)
    assert listener.frames == []
    # It sends a dominant start of frame and sees none of it: Bit0Error.
    assert bench.read("A", "ES") & 7 == CanError.BIT0
    assert bench.rules() == ["not-configured"]
    assert "CANA" in bench.findings.of("not-configured")[0].message
    bench.pin("A")
    bench.wait_bits(200)
    assert [frame.identifier for frame in listener.frames] == [1]


def test_without_its_clock_a_controller_is_deaf() -> None:
    bench = Bench()
    bench.receive("A", 1, 1)
    sender = bench.part()
    bench.write_to("CpuSysRegs", "PCLKCR10", 0)
    sender.send(CanFrame(1))
    bench.wait_bits(200)
    assert sender.errors
    assert set(sender.errors) == {CanError.ACK}
    bench.write("A", "CTL", 0)
    assert bench.rules() == ["clock-gated"]


def test_auxclkin_as_bit_clock_is_told_to_be_missing() -> None:
    bench = Bench()
    bench.write_to("ClkCfgRegs", "CLKSRCCTL2", 2 << 2)
    assert bench.rules() == ["unmodelled"]
    bench.transmit("A", 1, 1)
    bench.wait_bits(200)
    assert bench.read("A", "TXRQ_21") == 1


# Receiving


def test_a_message_that_is_not_read_in_time_is_lost_and_told_by_the_chip() -> None:
    bench = Bench()
    bench.receive("A", 1, 0x10)
    sender = bench.part()
    for data in (b"a", b"b"):
        sender.send(CanFrame(0x10, data))
    bench.wait_bits(200)
    assert bench.message("A", 1, clear=REQUEST)[0] == NEWDAT | MSGLST | EOB | 1
    # The read has cleared NewDat in the object.
    assert bench.message("A", 1)[0] == MSGLST | EOB | 1


def test_a_fifo_fills_from_its_lowest_object_and_its_last_one_is_overwritten() -> None:
    bench = Bench()
    for number in (1, 2, 3):
        bench.object("A", number, VALID | 0x77 << 18, EOB if number == 3 else 0)
    sender = bench.part()
    for n in range(5):
        sender.send(CanFrame(0x77, bytes([n])))
    bench.wait_bits(400)
    assert [bench.message("A", number)[1][0] for number in (1, 2, 3)] == [0, 1, 4]
    assert [bool(bench.message("A", number)[0] & MSGLST) for number in (1, 2, 3)] == [False, False, True]
    # An object that was read takes frames again.
    bench.message("A", 1, clear=REQUEST)
    sender.send(CanFrame(0x77, b"\x09"))
    bench.wait_bits(200)
    assert bench.message("A", 1)[1][0] == 9


def test_a_remote_frame_is_answered_by_itself() -> None:
    bench = Bench()
    bench.object("A", 1, VALID | TRANSMIT | 0x111 << 18, EOB | RMTEN | UMASK | 3, 0x1FFC0000, b"xyz")
    asker = bench.part()
    asker.send(CanFrame(0x111, remote=True, dlc=3))
    bench.wait_bits(300)
    assert asker.frames == [CanFrame(0x111, b"xyz")]


def test_a_receive_object_asks_with_a_remote_frame_and_takes_the_answer() -> None:
    bench = Bench()
    other = bench.part()
    bench.receive("A", 4, 0x222, control=TXRQST | 2)
    bench.wait_bits(100)
    assert other.frames == [CanFrame(0x222, remote=True, dlc=2)]
    other.send(CanFrame(0x222, b"ok"))
    bench.wait_bits(100)
    assert bench.message("A", 4) == (NEWDAT | EOB | 2, b"ok" + bytes(6))


def test_interface_3_follows_its_objects_and_waits_until_it_was_read() -> None:
    bench = Bench()
    bench.receive("A", 1, 0x10)
    bench.receive("A", 2, 0x20)
    bench.write("A", "IF3UPD", 0b10)
    bench.write("A", "IF3OBS", 1 << 3)  # bytes 0 to 3 have to be read
    sender = bench.part()
    sender.send(CanFrame(0x10, b"no"))
    sender.send(CanFrame(0x20, b"one"))
    sender.send(CanFrame(0x20, b"two"))
    bench.wait_bits(400)
    # IF3Upd, and IF3SDA still to be read.
    assert bench.read("A", "IF3OBS") == 1 << 15 | 1 << 11 | 1 << 3
    assert bench.read("A", "IF3ARB") == VALID | 0x20 << 18
    assert bench.read("A", "IF3DATA") == int.from_bytes(b"one", "little")
    # Read: the update that waited comes.
    assert bench.read("A", "IF3OBS") & 1 << 15
    assert bench.read("A", "IF3DATA") == int.from_bytes(b"two", "little")
    assert bench.read("A", "IF3OBS") == 1 << 3


# Test modes


@pytest.mark.parametrize("mode", [LBACK, EXL, LBACK | SILENT])
def test_in_loopback_a_controller_receives_what_it_sends_and_needs_nobody(mode: int) -> None:
    bench = Bench(test=mode)
    other = bench.part()
    seen: list[CanFrame] = []
    bench.chip.can_bus["A"].arrived.connect(seen.append)
    bench.receive("A", 2, 0x1)
    bench.transmit("A", 1, 0x1, b"loop")
    bench.wait_bits(200)
    assert bench.message("A", 2) == (NEWDAT | EOB | 4, b"loop" + bytes(4))
    assert bench.read("A", "ES") == 0x18
    assert other.frames == []
    # At the pin it can be seen, unless it is silent.
    assert seen == ([] if mode & SILENT else [CanFrame(0x1, b"loop")])
    assert bench.rules() == []


def test_in_silent_mode_it_listens_and_neither_acknowledges_nor_sends() -> None:
    bench = Bench(test=SILENT)
    bench.receive("A", 1, 0x10)
    bench.transmit("A", 2, 0x20)
    sender = bench.part()
    sender.send(CanFrame(0x10, b"!"))
    bench.wait_bits(100)
    assert CanError.ACK in sender.errors
    assert bench.read("A", "TXRQ_21") == 2
    bench.part()  # who acknowledges
    bench.wait_bits(200)
    assert bench.message("A", 1)[0] & NEWDAT
    assert bench.read("A", "TXRQ_21") == 2


def test_the_test_register_wants_the_test_bit() -> None:
    bench = Bench()
    bench.write("A", "TEST", LBACK)
    assert bench.read("A", "TEST") & LBACK == 0
    assert bench.rules() == ["locked"]


def test_the_level_of_canrx_can_be_seen() -> None:
    bench = Bench()
    other = bench.part()
    assert bench.read("A", "TEST") & 0x80
    other.send(CanFrame(0))
    bench.wait(BIT // 2)
    assert not bench.read("A", "TEST") & 0x80


@pytest.mark.parametrize(("word", "field"), [(2 << 5, "TX"), (1 << 9, "RDA")])
def test_what_of_the_test_register_is_missing_is_told(word: int, field: str) -> None:
    bench = Bench(ctl=TEST)
    bench.write("A", "TEST", word)
    assert [f.object for f in bench.findings.of("unmodelled")] == [f"CanaRegs.CAN_TEST.{field}"]


# Errors


def test_alone_on_the_bus_a_sender_becomes_error_passive_and_not_bus_off() -> None:
    bench = Bench()
    bench.transmit("A", 1, 0x55)
    bench.wait_bits(40)
    # The acknowledgement is missing: LEC 3, TEC 8.
    assert bench.read("A", "ES") & 7 == CanError.ACK
    assert bench.read("A", "ERRC") == 8
    bench.wait_bits(10_000)
    # 16 times 8, EPass and EWarn; from there on a missing acknowledgement counts no more.
    assert bench.read("A", "ERRC") == 128
    assert bench.read("A", "ES") == 0x63
    assert bench.read("A", "CTL") & INIT == 0
    listener = bench.part()
    bench.wait_bits(200)
    assert [frame.identifier for frame in listener.frames] == [0x55]
    assert bench.read("A", "ERRC") == 127


def test_without_retransmission_a_frame_is_tried_once() -> None:
    bench = Bench(ctl=DAR)
    bench.transmit("A", 1, 0x55, control=NEWDAT)
    bench.wait_bits(500)
    # TxRqst was reset at the begin; NewDat tells that it has failed.
    assert bench.read("A", "TXRQ_21") == 0
    assert bench.read("A", "NDAT_21") == 1
    assert bench.read("A", "ERRC") == 8
    bench.part()
    bench.command("A", WRITE | REQUEST | 1)
    bench.wait_bits(100)
    assert bench.read("A", "NDAT_21") == 0


def to_bus_off(bench: Bench) -> None:
    """32 destroyed frames: TEC 256."""
    bench.part()
    bench.chip.can_bus["A"].disturb(frames=32)
    bench.transmit("A", 1, 0x55)
    while not bench.chip.register("CanaRegs", "CAN_ES").value & 0x80:
        bench.wait_bits(10)


def test_bus_off_sets_init_and_the_way_back_takes_129_times_eleven_bits() -> None:
    bench = Bench()
    to_bus_off(bench)
    assert bench.read("A", "CTL") & INIT
    assert bench.read("A", "ES") & 0xE0 == 0xE0
    bench.wait_bits(2_000)
    assert bench.read("A", "ES") & 0x80, "nothing happens before Init is cleared"
    bench.write("A", "CTL", PARITY_OFF)
    bench.wait_bits(129 * 11 - 1)
    # Each eleven recessive bits are told as Bit0Error.
    assert bench.read("A", "ES") & 0x87 == 0x85
    bench.wait_bits(2)
    assert bench.read("A", "ERRC") == 0
    assert bench.read("A", "ES") & 0xE0 == 0
    bench.wait_bits(100)
    assert bench.read("A", "TXRQ_21") == 0, "the frame has gone out"


def test_auto_bus_on_clears_init_after_its_time() -> None:
    bench = Bench(ctl=ABO)
    bench.write("A", "ABOTR", 1_000_000)
    to_bus_off(bench)
    off = bench.clock.now
    bench.clock.advance_to(off + 1_000_000 - 20 * BIT)
    assert bench.read("A", "CTL") & INIT
    bench.wait_bits(30)
    assert not bench.read("A", "CTL") & INIT
    bench.wait_bits(129 * 11 + 100)
    assert bench.read("A", "TXRQ_21") == 0


def test_a_receiver_counts_destroyed_frames_and_recovers() -> None:
    bench = Bench()
    sender = bench.part()
    bench.chip.can_bus["A"].disturb(frames=100)
    sender.send(CanFrame(1))
    while sender.waiting:
        bench.wait_bits(1)
    # 100 errors, and 1 less for the frame that came through: the warning is at 96.
    assert bench.read("A", "ERRC") == 99 << 8
    assert bench.read("A", "ES") & 0x60 == 0x40
    bench.chip.can_bus["A"].disturb(frames=60)
    sender.send(CanFrame(2))
    while len(sender.errors) < 100 + 40:
        bench.wait_bits(1)
    # Error passive; at 128 and above REC shows 127, and RP is set.
    assert bench.read("A", "ERRC") == 0xFF << 8
    assert bench.read("A", "ES") & 0x60 == 0x60
    while sender.waiting:
        bench.wait_bits(1)
    # A good frame brings it back to between 119 and 127 (ISO 11898-1).
    assert 119 <= bench.read("A", "ERRC") >> 8 <= 127
    assert bench.read("A", "ES") & 0x60 == 0x40


def test_a_software_reset_wants_init_and_leaves_the_message_ram() -> None:
    bench = Bench()
    bench.receive("A", 3, 3)
    bench.write("A", "CTL", PARITY_OFF | 1 << 15)
    assert bench.read("A", "BTR") == BTR, "without Init it does nothing"
    bench.write("A", "CTL", PARITY_OFF | INIT | 1 << 15)
    assert bench.read("A", "BTR") == 0x2301
    assert bench.read("A", "CTL") == 0x1401
    assert bench.read("A", "MVAL_21") == 4


# Interrupts


def flag(bench: Bench, letter: str, line: int) -> bool:
    """PIEIFR9 of CANA0, CANA1, CANB0, CANB1: INT9.5 to 9.8; and clear it."""
    bit = 1 << 4 + 2 * "AB".index(letter) + line
    register = bench.chip.register("PieCtrlRegs", "PIEIFR9")
    found = bool(register.value & bit)
    register.value &= ~bit
    return found


@pytest.mark.parametrize("letter", ["A", "B"])
@pytest.mark.parametrize("line", [0, 1])
def test_a_received_message_interrupts_on_the_line_of_its_object(letter: str, line: int) -> None:
    bench = Bench(letter, ctl=IE0 | IE1)
    bench.write(letter, "IP_MUX21", line << 5)
    bench.write(letter, "GLB_INT_EN", 0b11)
    bench.receive(letter, 6, 0x10, control=RXIE)
    bench.part(letter).send(CanFrame(0x10))
    bench.wait_bits(100)
    assert [flag(bench, letter, n) for n in (0, 1)] == [line == 0, line == 1]
    # INT0ID stands in 15:0, INT1ID in 23:16.
    assert bench.read(letter, "INT") == 6 << 16 * line
    assert bench.read(letter, "GLB_INT_FLG") == 1 << line
    bench.command(letter, CLEAR | 6)
    assert bench.read(letter, "INT") == 0


def test_the_lowest_object_is_named_first_and_the_global_flag_holds_further_pulses_back() -> None:
    bench = Bench(ctl=IE0)
    bench.write("A", "GLB_INT_EN", 1)
    for number in (4, 2):
        bench.receive("A", number, number, control=RXIE)
    sender = bench.part()
    sender.send(CanFrame(4))
    bench.wait_bits(100)
    assert bench.read("A", "INT") == 4
    assert flag(bench, "A", 0)
    sender.send(CanFrame(2))
    bench.wait_bits(100)
    assert bench.read("A", "INT") == 2
    assert not flag(bench, "A", 0), "the global flag still stands"
    bench.command("A", CLEAR | 2)
    bench.write("A", "GLB_INT_CLR", 1)
    # Object 4 still waits: the line is active, and gives the next pulse.
    assert flag(bench, "A", 0)
    bench.command("A", CLEAR | 4)
    bench.write("A", "GLB_INT_CLR", 1)
    assert not flag(bench, "A", 0)


def test_a_status_interrupt_comes_before_messages_and_ends_with_the_read_of_the_status() -> None:
    bench = Bench(ctl=IE0 | SIE)
    bench.write("A", "GLB_INT_EN", 1)
    bench.part()
    bench.transmit("A", 1, 0x10, control=TXIE)
    bench.wait_bits(100)
    assert flag(bench, "A", 0)
    assert bench.read("A", "INT") == 0x8000
    assert bench.read("A", "ES") == 0x08
    assert bench.read("A", "INT") == 1
    bench.command("A", CLEAR | 1)
    assert bench.read("A", "INT") == 0


def test_error_interrupts_are_those_of_warning_and_bus_off() -> None:
    bench = Bench(ctl=IE0 | EIE)
    bench.write("A", "GLB_INT_EN", 1)
    bench.transmit("A", 1, 0x10)
    bench.wait_bits(11 * 60)
    # TEC is below 96: single errors do not interrupt without SIE.
    assert not flag(bench, "A", 0)
    bench.wait_bits(300)
    assert bench.read("A", "ERRC") >= 96
    assert flag(bench, "A", 0)
    assert bench.read("A", "INT") == 0x8000


def test_no_interrupt_leaves_without_its_enables() -> None:
    bench = Bench(ctl=IE0)
    bench.receive("A", 1, 0x10, control=RXIE)
    bench.part().send(CanFrame(0x10))
    bench.wait_bits(100)
    assert bench.read("A", "INT") == 1
    assert bench.read("A", "GLB_INT_FLG") == 0
    assert not flag(bench, "A", 0)
    # The line is active: enabled now, it interrupts.
    bench.write("A", "GLB_INT_EN", 1)
    assert flag(bench, "A", 0)


# What else can come in between


def test_without_retransmission_a_lost_arbitration_is_not_tried_again_either() -> None:
    bench = Bench(ctl=DAR)
    bench.part()
    winner = bench.part()
    winner.send(CanFrame(0x7FF))
    bench.wait_bits(1)
    bench.transmit("A", 1, 0x200, control=NEWDAT)
    winner.send(CanFrame(0x100))
    bench.wait_bits(300)
    assert bench.read("A", "TXRQ_21") == 0
    assert bench.read("A", "NDAT_21") == 1
    assert bench.read("A", "ERRC") == 0, "to lose is no error"


def test_a_controller_that_is_stopped_breaks_its_frame_off_and_sends_it_when_it_is_back() -> None:
    bench = Bench()
    listener = bench.part()
    bench.transmit("A", 1, 0x10, b"12345678")
    bench.wait_bits(50)
    bench.write("A", "CTL", PARITY_OFF | INIT)
    bench.wait_bits(500)
    assert listener.frames == []
    assert listener.errors == [CanError.STUFF]
    bench.write("A", "CTL", PARITY_OFF)
    bench.wait_bits(200)
    assert listener.frames == [CanFrame(0x10, b"12345678")]


@pytest.mark.parametrize(("alone_bits", "order"), [(0, [1, 2, 3, 0x7FF]), (2_000, [1, 0x7FF, 2, 3])])
def test_an_error_passive_sender_lets_the_others_go_first(alone_bits: int, order: list[int]) -> None:
    bench = Bench()
    bus = bench.chip.can_bus["A"]
    seen: list[int] = []
    bus.arrived.connect(lambda frame: seen.append(frame.identifier))
    if not alone_bits:
        bench.part()
    for number in (1, 2, 3):
        bench.transmit("A", number, number)
    bench.wait_bits(alone_bits)
    assert bool(bench.read("A", "ES") & 0x20) == bool(alone_bits)
    other = bench.part()
    for wanted in (False, True):  # until the next frame begins, which somebody acknowledges
        while bus.busy != wanted:
            bench.wait_bits(1)
    # Behind its own frame an error passive node waits eight bits longer than the others.
    other.send(CanFrame(0x7FF))
    bench.wait_bits(500)
    assert seen == order


def test_new_data_during_a_transmission_keeps_the_request() -> None:
    bench = Bench()
    listener = bench.part()
    bench.transmit("A", 1, 0x10, b"old")
    bench.wait_bits(20)
    bench.write("A", "IF1DATA", int.from_bytes(b"new", "little"))
    bench.command("A", WRITE | DATA | REQUEST | 1)
    bench.wait_bits(300)
    assert [frame.data for frame in listener.frames] == [b"old", b"new"]


def test_an_object_that_is_no_longer_valid_is_not_sent() -> None:
    bench = Bench(start=False)
    listener = bench.part()
    bench.transmit("A", 1, 0x10)
    bench.write("A", "IF1ARB", 0)
    bench.command("A", WRITE | ARB | 1)
    bench.write("A", "CTL", PARITY_OFF)
    bench.wait_bits(300)
    assert listener.frames == []
