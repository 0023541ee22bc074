"""CAN controller (Bosch D_CAN): registers, interfaces to the message objects, errors, interrupts.

Modelled: Init, CCE, bit timing, automatic retransmission (DAR), software reset; IF1 and IF2 with their busy time, IF3
with its updates; 32 message objects (`can_objects.py`); internal and external loopback, silent mode, and both at once;
RX of CAN_TEST; error counters, warning, error passive, bus-off and its recovery, auto-bus-on; both interrupt lines and
their global flags; initialisation of the message RAM; clock gate (no SOFTPRESx has a bit for it); pins.
Not modelled: parity errors (nothing damages this RAM); the message RAM at addresses of its own (RDA) and the control of
CANTX (TX), whose use is reported; resynchronisation (SJW); a debugger; AUXCLKIN as clock; the levels at the wires of
the pins (`Wire`), which frames do not change.  CHOICE: the message RAM is 0 from the beginning.
A controller in loopback puts its frames on the bus for listeners only (`CanBus.arrived`): no other node takes them.
Time: a transfer of an interface takes TRANSFER_CLOCKS of the module's clock; frames take their bits (`can_bus.py`).
CHOICE: a transfer takes 3 clocks, the fewest of the 3 to 6 that the manual of the C_CAN gives.  The bridge makes no
access longer here, and what TI's InitCAN writes without waiting must arrive.
CHOICE: an initialisation of the RAM takes RAM_CYCLES.
CHOICE: an interrupt line that is still active when its global flag is cleared gives the next pulse.
CHOICE: the software reset leaves the message RAM, CAN_RAM_INIT and CAN_GLB_INT_x as they are.
CHOICE: a receiver counts 1 for every error.
CHOICE: the recovery from bus-off takes 129 times 11 bits, whatever is on the bus.
Sources: TRM CAN; HDR F2837xS_can.h, hw_can.h; Bosch C_CAN user's manual; ISO 11898-1 (fault confinement).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Final

from emulator.c28x.findings import Cause
from emulator.can_bus import IDLE_BITS, INTERMISSION_BITS, SUSPEND_BITS, CanBus, CanError, CanFrame, CanPort
from emulator.clock import NEVER, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.can_objects import (
    DIR,
    DLC,
    EOB,
    INTPND,
    MSGVAL,
    NEWDAT,
    OBJECTS,
    RXIE,
    TXIE,
    TXRQST,
    UMASK,
    MessageRam,
)
from emulator.registers.can import CanRegs
from emulator.registers.core import ALL

#: Bits of CAN_CTL.
INIT: Final = 1 << 0
IE0: Final = 1 << 1
SIE: Final = 1 << 2
EIE: Final = 1 << 3
DAR: Final = 1 << 5
CCE: Final = 1 << 6
TEST: Final = 1 << 7
ABO: Final = 1 << 9
SWR: Final = 1 << 15
IE1: Final = 1 << 17
#: Bits of CAN_ES.
LEC: Final = 7
TXOK: Final = 1 << 3
RXOK: Final = 1 << 4
EPASS: Final = 1 << 5
EWARN: Final = 1 << 6
BOFF: Final = 1 << 7
#: LEC after CAN_ES was read.
NO_EVENT: Final = 7
#: Bits of CAN_TEST.
SILENT: Final = 1 << 3
LBACK: Final = 1 << 4
RX: Final = 1 << 7
EXL: Final = 1 << 8
#: INT0ID of a status interrupt.
STATUS: Final = 0x8000
#: CAN_RAM_INIT: its key, the key that starts the initialisation, and the value after its end.
KEY: Final = 0xF
BEGIN: Final = 0xA
RAM_INIT: Final = 1 << 4
RAM_DONE: Final = 1 << 5
IDLE_KEY: Final = 0x5
#: Cycles that CAN_RAM_INIT takes.
RAM_CYCLES: Final = 4 * OBJECTS
#: Clocks of the module that a transfer between an interface and the message RAM takes.
TRANSFER_CLOCKS: Final = 3
#: A read of the fetched data sooner after the command than this, without reading Busy, is reported (CHOICE).
HASTY_CLOCKS: Final = 40
#: Bits of CAN_IFxCMD.
BUSY: Final = 1 << 15
NUMBER: Final = 0xFF
DATA_B: Final = 1 << 16
DATA_A: Final = 1 << 17
REQUEST: Final = 1 << 18
CLEAR_PENDING: Final = 1 << 19
CONTROL: Final = 1 << 20
ARBITRATION: Final = 1 << 21
MASK: Final = 1 << 22
WRITE: Final = 1 << 23
#: Register of an interface -> the bit of its command that moves it, and the name of that bit.
MOVES: Final = {
    "MSK": (MASK, "Mask"), "ARB": (ARBITRATION, "Arb"), "MCTL": (CONTROL, "Control"),
    "DATA": (DATA_A, "DATA_A"), "DATB": (DATA_B, "DATA_B"),
}  # fmt: skip
#: Bits of MCTL that the program chooses.  The controller changes the other ones.
CHOSEN_BITS: Final = UMASK | TXIE | RXIE | EOB | DLC
#: The bytes of a message that come before those of DATB.
FIRST_BYTES: Final = 4
CONTROL_BITS: Final = 0xFF8F
#: Registers of an interface after its first one.
PARTS: Final = ("MSK", "ARB", "MCTL", "DATA", "DATB")
IF3_UPDATED: Final = 1 << 15
IF3_OBSERVED: Final = 0x1F
IF3_UNREAD: Final = IF3_OBSERVED << 8
#: Registers that a software reset does not change.
KEPT: Final = ("CAN_RAM_INIT", "CAN_GLB_INT_EN", "CAN_GLB_INT_FLG")
#: Error counters: warning, error passive, bus-off; REC comes back from above 127 to this.
WARNING: Final = 96
PASSIVE: Final = 128
BUS_OFF: Final = 256
REC_AFTER_PASSIVE: Final = 119
SENDER_PENALTY: Final = 8
#: The way from bus-off to error active takes this many times 11 recessive bits.
RECOVERY: Final = 129


class Can:
    """One controller over its registers, at a port of the chip and on a bus.

    `clock_cycles()` are the cycles of the module's bit clock, 0 if it has none; `lines` are interrupts 0 and 1, and
    `on_blocked(line)` is called for one that its global flag keeps back.
    """

    def __init__(
        self, clock: Clock, cpu: Cpu, regs: CanRegs, port: CanPort, bus: CanBus, lines: tuple[Callable[[], None], ...],
        *, clock_cycles: Callable[[], int], on_blocked: Callable[[int], None],
    ) -> None:  # fmt: skip
        self._clock, self._findings, self._regs, self.port = clock, cpu.findings, regs, port
        self._lines, self._clock_cycles, self._on_blocked = lines, clock_cycles, on_blocked
        registers = regs.registers
        self._ctl, self._es, self._errc = registers["CAN_CTL"], registers["CAN_ES"], registers["CAN_ERRC"]
        self._int, self._test, self._btr = registers["CAN_INT"], registers["CAN_TEST"], registers["CAN_BTR"]
        self._flags, self._enables = registers["CAN_GLB_INT_FLG"], registers["CAN_GLB_INT_EN"]
        self._ram_init, self._mux = registers["CAN_RAM_INIT"], registers["CAN_IP_MUX21"]
        self._observed, self._updates = registers["CAN_IF3OBS"], registers["CAN_IF3UPD"]
        self.ram = MessageRam()
        #: Whether it has ever sent or received a frame without an error.
        self.heard = False
        #: Whether it repeats a frame that nobody acknowledges any more.
        self.unheard = False
        #: Frames in loopback that none of its objects took.
        self.passed_by = 0
        #: The bus at the pins; the inner bus, which no other node hears; the bus that it is on now.
        self._bus, self._inside = bus, CanBus(clock, f"{port.name} inside")
        self._at: CanBus | None = None
        self._on = False
        self._joined_at = NEVER
        self._suspended_until = 0
        #: The number of the object whose frame is on the bus or was offered to it.
        self._sending = 0
        self._offered: CanFrame | None = None
        self._tec = self._rec = 0
        self._status_pending = False
        #: The object whose update waits until interface 3 has been read.
        self._next_update = 0
        #: Transfers under way, by interface; other events that are under way.
        self._transfers: dict[int, ClockEvent | None] = {1: None, 2: None}
        #: When each began, until the program has seen its end.
        self._commanded = {1: -NEVER, 2: -NEVER}
        #: The registers of each interface that the program has written since its last transfer.
        self._written: dict[int, set[str]] = {1: set(), 2: set()}
        #: The statement that has cleared Init: from there on the controller takes part in the traffic.
        self._started: Cause | None = None
        self._recovery: ClockEvent | None = None
        self._recovered = 0
        self._bus_on_event: ClockEvent | None = None
        self._ram_event: ClockEvent | None = None
        self._bind()
        port.changed.connect(self._settle)

    def _bind(self) -> None:
        bind = self._regs.bind
        bind("CAN_CTL", write=self._write_CAN_CTL)
        bind("CAN_ES", read=self._read_CAN_ES)
        bind("CAN_BTR", write=self._write_CAN_BTR)
        bind("CAN_TEST", read=self._read_CAN_TEST, write=self._write_CAN_TEST)
        bind("CAN_RAM_INIT", write=self._write_CAN_RAM_INIT)
        bind("CAN_GLB_INT_EN", write=self._write_CAN_GLB_INT_EN)
        bind("CAN_GLB_INT_CLR", write=self._write_CAN_GLB_INT_CLR)
        bind("CAN_IP_MUX21", write=self._write_CAN_IP_MUX21)
        for name, bit in (("TXRQ", TXRQST), ("NDAT", NEWDAT), ("IPEN", INTPND)):
            bind(f"CAN_{name}_21", read=partial(self.ram.flags, bit), steady=True)
            bind(f"CAN_{name}_X", read=partial(self._groups, partial(self.ram.flags, bit)), steady=True)
        bind("CAN_MVAL_21", read=self.ram.valid_objects, steady=True)
        bind("CAN_MVAL_X", read=partial(self._groups, self.ram.valid_objects), steady=True)
        for n in self._transfers:
            bind(
                f"CAN_IF{n}CMD", read=partial(self._read_CAN_IFxCMD, n), write=partial(self._write_CAN_IFxCMD, n),
                steady=True,
            )  # fmt: skip
            for part in PARTS:
                bind(
                    f"CAN_IF{n}{part}", read=partial(self._read_interface, n, part),
                    write=partial(self._write_interface, n, part),
                )  # fmt: skip
        for bit, part in enumerate(PARTS):
            bind(f"CAN_IF3{part}", read=partial(self._read_interface_3, bit, part))
        bind("CAN_IF3UPD", write=self._write_CAN_IF3UPD)

    def set_clock(self, on: bool) -> None:
        """PCLKCR10 switched the module's clock."""
        self._on = on
        self._settle()

    def clock_changed(self) -> None:
        """The bit clock has changed."""
        self._settle()

    def connect(self, bus: CanBus) -> None:
        """Connect its transceiver to another bus."""
        self._bus = bus
        self._settle()

    def _reset(self) -> None:
        """Software reset."""
        kept = {name: self._regs.registers[name].value for name in KEPT}
        for n, event in self._transfers.items():
            self._clock.cancel(event)
            self._transfers[n] = None
        self._clock.cancel(self._recovery)
        self._clock.cancel(self._bus_on_event)
        self._recovery = self._bus_on_event = None
        self._regs.reset()
        for name, value in kept.items():
            self._regs.registers[name].value = value
        self._tec = self._rec = self._next_update = 0
        self._status_pending = False
        self._written = {1: set(), 2: set()}
        self._settle()
        self._update_lines()

    # --- the bus -----------------------------------------------------------------------------------------------------

    def _mode(self) -> int:
        """The test modes in effect."""
        return self._test.value if self._ctl.value & TEST else 0

    def _settle(self) -> None:
        """Join the bus that pins, test mode and Init select, or leave the bus."""
        active = self._on and not self._ctl.value & INIT and self._clock_cycles() > 0
        outside = self.port.connected and not self.in_loopback
        at = None if not active else self._bus if outside else self._inside
        if at is self._at:
            return
        if self._at is not None:
            self._at.detach(self)
        self._at, self._sending, self._joined_at = at, 0, NEVER
        if at is not None:
            if self._es.value & BOFF:
                self._recovered = 0
                self._recover()
            else:
                self._joined_at = self._clock.now + IDLE_BITS * self.bit_cycles
            at.attach(self)

    def _request_bus(self) -> None:
        """Request the bus: there may be a frame to send."""
        if self._at is not None and self.ram.next_request():
            self._at.request()

    @property
    def bit_cycles(self) -> int:
        """Cycles of one bit."""
        btr = self._btr.value
        prescaler = (btr >> 10 & 0x3C0 | btr & 0x3F) + 1
        quanta = 3 + (btr >> 8 & 0xF) + (btr >> 12 & 7)
        return max(1, quanta * prescaler * self._clock_cycles())

    @property
    def error_passive(self) -> bool:
        """Whether its error flags are recessive."""
        return bool(self._es.value & EPASS)

    @property
    def acknowledges(self) -> bool:
        """Not in silent mode."""
        return not self._mode() & SILENT

    @property
    def in_loopback(self) -> bool:
        """In both kinds of loopback."""
        return bool(self._mode() & (LBACK | EXL))

    @property
    def unconnected(self) -> bool:
        """Without pins and without loopback."""
        return self._at is self._inside and not self.in_loopback

    def follows_bus(self, now: int) -> bool:
        """Whether eleven recessive bits have passed since Init was cleared."""
        return self._joined_at <= now

    def earliest_start(self) -> int:
        """As soon as it takes part, if an object waits; never in silent mode."""
        if self._joined_at == NEVER or (self._mode() & SILENT and not self.in_loopback) or not self.ram.next_request():
            return NEVER
        return max(self._joined_at, self._suspended_until)

    def offer(self) -> CanFrame:
        """The first object that waits."""
        self._sending = self.ram.next_request()
        sending = self.ram[self._sending]
        if self._ctl.value & DAR:
            sending.control &= ~TXRQST
        elif sending.arbitration & DIR:
            sending.control &= ~NEWDAT
        if self.unconnected:
            self._findings.report(
                "not-configured", f"{self.port.missing}: the frame does not reach the bus", object=self.port.name,
                cause=self._started,
            )  # fmt: skip
        self._offered = sending.frame()
        return self._offered

    def lost(self) -> None:
        """Another frame has won the arbitration."""
        self._sending = 0

    def sent(self) -> None:
        """The frame has arrived."""
        number, self._sending = self._sending, 0
        self.unheard = False
        if self.error_passive:
            self._suspended_until = self._clock.now + (INTERMISSION_BITS + SUSPEND_BITS) * self.bit_cycles
        self._tec = max(0, self._tec - 1)
        each = self.ram[number]
        if self._ctl.value & DAR:
            each.control &= ~NEWDAT
        elif not (each.arbitration & DIR and each.control & NEWDAT):
            each.control &= ~TXRQST
        if each.control & TXIE:
            each.control |= INTPND
        self._record_result(0, TXOK)
        if self.in_loopback and not self._mode() & SILENT and self.port.connected and self._offered is not None:
            self._bus.report_loopback(self._offered)

    def received(self, frame: CanFrame) -> None:
        """A frame has arrived.  Store it in the object that accepts it, if there is one."""
        if self._rec >= PASSIVE:
            self._rec = REC_AFTER_PASSIVE
        elif self._rec:
            self._rec -= 1
        number = self.ram.receive(frame)
        if not number and self.in_loopback and not frame.remote:
            self.passed_by += 1
        if number and self._updates.value >> number - 1 & 1:
            self._update(number)
        self._record_result(0, RXOK)
        self._request_bus()

    def failed(self, error: CanError, sending: bool) -> None:
        """An error frame."""
        if not sending:
            self._rec = min(self._rec + 1, PASSIVE)
        else:
            self._sending = 0
            self.unheard = error is CanError.ACK and self.heard
            # An error passive sender that only misses the acknowledgement does not count it (ISO 11898-1, exception 1).
            if not (error is CanError.ACK and self.error_passive):
                self._tec += SENDER_PENALTY
            if self._tec >= PASSIVE:
                bits = INTERMISSION_BITS + SUSPEND_BITS
                at = self._at.free_at if self._at is not None else 0
                self._suspended_until = at + (bits - INTERMISSION_BITS) * self.bit_cycles
        self._record_result(error, 0)
        if self._tec >= BUS_OFF:
            self._bus_off()

    def _record_result(self, lec: int, ok: int) -> None:
        """Last error code, flags and counters after a frame, with their interrupts."""
        self.heard |= bool(ok)
        before = self._es.value
        counted = self._tec, self._rec
        state = EWARN if max(counted) >= WARNING else 0
        state |= EPASS if max(counted) >= PASSIVE else 0
        state |= BOFF if self._tec >= BUS_OFF else 0
        self._es.value = before & (TXOK | RXOK) | ok | state | lec
        self._show_counters()
        ctl = self._ctl.value
        if ctl & SIE or (ctl & EIE and (before ^ self._es.value) & (BOFF | EWARN)):
            self._status_pending = True
        self._update_lines()
        for line, enable in enumerate((IE0, IE1)):
            if self._flags.value >> line & 1 and ctl & enable and self._int.value >> 16 * line & 0xFFFF:
                self._on_blocked(line)

    def _show_counters(self) -> None:
        passive = 1 << 15 if self._rec >= PASSIVE else 0
        self._errc.value = min(self._tec, 0xFF) | min(self._rec, PASSIVE - 1) << 8 | passive

    # --- bus-off -----------------------------------------------------------------------------------------------------

    def _bus_off(self) -> None:
        """The hardware sets Init; with ABO it clears it again after CAN_ABOTR clocks."""
        self._ctl.value |= INIT
        self._settle()
        if self._ctl.value & ABO:
            cycles = self._regs.registers["CAN_ABOTR"].value * max(1, self._clock_cycles())
            self._bus_on_event = self._clock.after(max(1, cycles), self._leave_bus_off)

    def _leave_bus_off(self) -> None:
        self._bus_on_event = None
        self._ctl.value &= ~INIT
        self._settle()

    def _recover(self) -> None:
        """Eleven more recessive bits have passed on the way back from bus-off."""
        self._clock.cancel(self._recovery)
        self._recovery = self._clock.after(IDLE_BITS * self.bit_cycles, self._recover_step)

    def _recover_step(self) -> None:
        self._recovery = None
        if self._at is None:
            return
        self._recovered += 1
        if self._recovered < RECOVERY:
            self._record_result(CanError.BIT0, 0)
            self._recover()
            return
        self._tec = self._rec = 0
        self._joined_at = self._clock.now
        self._record_result(CanError.BIT0, 0)
        self._request_bus()

    # --- interrupts --------------------------------------------------------------------------------------------------

    def _update_lines(self) -> None:
        """Update CAN_INT and the interrupt lines."""
        pending, second = self.ram.flags(INTPND), self._mux.value
        ids = [_first(pending & ~second), _first(pending & second)]
        if self._status_pending:
            ids[0] = STATUS
        self._int.value = ids[0] | ids[1] << 16
        for line, enable in enumerate((IE0, IE1)):
            bit = 1 << line
            if ids[line] and self._ctl.value & enable and self._enables.value & bit and not self._flags.value & bit:
                self._flags.value |= bit
                self._lines[line]()

    def _read_CAN_ES(self) -> int:
        word = self._es.value
        self._es.value = word & ~(TXOK | RXOK) | NO_EVENT
        if self._status_pending:
            self._status_pending = False
            self._update_lines()
        return word

    def _write_CAN_GLB_INT_EN(self, word: int, lanes: int = ALL) -> None:
        self._enables.store(word, lanes)
        self._update_lines()

    def _write_CAN_GLB_INT_CLR(self, word: int, lanes: int = ALL) -> None:
        self._flags.value &= ~(word & lanes)
        self._update_lines()

    def _write_CAN_IP_MUX21(self, word: int, lanes: int = ALL) -> None:
        self._mux.store(word, lanes)
        self._update_lines()

    @staticmethod
    def _groups(flags: Callable[[], int]) -> int:
        """One bit for each group of eight objects that has a flag set."""
        word = flags()
        return sum(1 << n for n in range(OBJECTS // 8) if word >> 8 * n & 0xFF)

    # --- control -----------------------------------------------------------------------------------------------------

    def _write_CAN_CTL(self, word: int, lanes: int = ALL) -> None:
        stopped = self._ctl.value & INIT
        self._ctl.store(word, lanes)
        if stopped and not self._ctl.value & INIT:
            self._started = self._findings.mark()
        if word & lanes & SWR and self._ctl.value & INIT:
            self._reset()
            return
        if not self._ctl.value & INIT:
            self._clock.cancel(self._bus_on_event)
            self._bus_on_event = None
        self._settle()
        self._update_lines()

    def _write_CAN_BTR(self, word: int, lanes: int = ALL) -> None:
        if self._ctl.value & (INIT | CCE) == INIT | CCE:
            self._btr.store(word, lanes)
        else:
            self._refuse(self._btr.path, word, "CAN_CTL.Init and CCE are not both set")

    def _read_CAN_TEST(self) -> int:
        level = self._bus.level(self._clock.now) if self.port.connected else 1
        return self._test.value & ~RX | (RX if level else 0)

    def _write_CAN_TEST(self, word: int, lanes: int = ALL) -> None:
        if self._ctl.value & TEST:
            self._test.store(word, lanes)
            self._settle()
        elif (word ^ self._test.value) & lanes & self._test.rw_mask:
            self._refuse(self._test.path, word, "CAN_CTL.Test is not set")

    def _refuse(self, path: str, word: int, why: str) -> None:
        self._findings.report("locked", f"{why}: the write to {path} was dropped", object=path, value=word)

    def _write_CAN_RAM_INIT(self, word: int, lanes: int = ALL) -> None:
        self._ram_init.store(word, lanes)
        if word & lanes & RAM_INIT and self._ram_init.value & KEY == BEGIN:
            self._ram_init.value &= ~RAM_DONE
            self._clock.cancel(self._ram_event)
            self._ram_event = self._clock.after(RAM_CYCLES, self._ram_cleared)

    def _ram_cleared(self) -> None:
        self._ram_event = None
        self.ram.clear()
        self._ram_init.value = RAM_DONE | IDLE_KEY
        self._update_lines()

    # --- IF1 and IF2 -------------------------------------------------------------------------------------------------

    def _read_interface(self, n: int, part: str) -> int:
        register = self._regs.registers[f"CAN_IF{n}{part}"]
        command = self._regs.registers[f"CAN_IF{n}CMD"].value
        since = self._clock.now - self._commanded[n]
        if since < HASTY_CLOCKS * self._clock_cycles() and not command & WRITE and command & MOVES[part][0]:
            self._findings.report(
                "can-interface-busy",
                f"{register.path} was read {since} cycles after the command that fetches it, and CAN_IF{n}CMD.Busy was "
                "not looked at: it may hold what stood there before",
                object=register.path, value=register.value,
            )  # fmt: skip
        return register.value

    def _read_CAN_IFxCMD(self, n: int) -> int:
        if self._transfers[n] is None:
            self._commanded[n] = -NEVER
        return self._regs.registers[f"CAN_IF{n}CMD"].value

    def _write_interface(self, n: int, part: str, word: int, lanes: int = ALL) -> None:
        register = self._regs.registers[f"CAN_IF{n}{part}"]
        if self._transfers[n] is None:
            register.store(word, lanes)
            self._written[n].add(part)
        else:
            self._busy(register.path, n, word)

    def _write_CAN_IFxCMD(self, n: int, word: int, lanes: int = ALL) -> None:
        command = self._regs.registers[f"CAN_IF{n}CMD"]
        if self._transfers[n] is not None:
            self._busy(command.path, n, word)
            return
        command.store(word, lanes)
        if lanes & NUMBER:
            self._check_command(n, command.value)
            command.value |= BUSY
            cycles = TRANSFER_CLOCKS * max(1, self._clock_cycles())
            self._commanded[n] = self._clock.now
            self._transfers[n] = self._clock.after(cycles, partial(self._transfer, n))

    def _check_command(self, n: int, word: int) -> None:
        """Report what the program has written to an interface, and what its command does not move to the object."""
        registers = self._regs.registers
        written = {part for part in self._written[n] if not word & MOVES[part][0]}
        self._written[n] = set() if word & WRITE else written
        if not word & WRITE:
            return
        number = self.ram.valid(word & NUMBER)
        each = self.ram[number]
        mask, arbitration, control, *data = (registers[f"CAN_IF{n}{part}"].value for part in PARTS)
        after = control if word & CONTROL else each.control
        valid = (arbitration if word & ARBITRATION else each.arbitration) & MSGVAL
        sends = valid and (word & REQUEST or after & TXRQST)
        lost = {
            "ARB": arbitration & MSGVAL and not each.arbitration & MSGVAL,
            "MSK": valid and after & UMASK and mask != each.mask,
            "MCTL": valid and (control ^ each.control) & CHOSEN_BITS,
            "DATA": sends and after & DLC and data[0] != each.data[0],
            "DATB": sends and after & DLC > FIRST_BYTES and data[1] != each.data[1],
        }
        for part in sorted(part for part in written if lost[part]):
            register = registers[f"CAN_IF{n}{part}"]
            kept = "which stays invalid" if part == "ARB" else "which keeps what it had"
            self._findings.report(
                "can-part-lost",
                f"{register.path} = {register.value:#x} is lost: CAN_IF{n}CMD.{MOVES[part][1]} = 0 in the command for "
                f"object {number}, {kept}",
                object=register.path, value=register.value,
            )  # fmt: skip

    def _busy(self, path: str, n: int, word: int) -> None:
        self._findings.report(
            "can-interface-busy", f"{path} was written while CAN_IF{n}CMD.Busy is set: the write was dropped",
            object=path, value=word,
        )  # fmt: skip

    def _transfer(self, n: int) -> None:
        """A transfer is over: between interface `n` and the object that its command names."""
        self._transfers[n] = None
        registers = self._regs.registers
        command, mask, arbitration, control, data_a, data_b = (
            registers[f"CAN_IF{n}{part}"] for part in ("CMD", *PARTS)
        )  # fmt: skip
        command.value &= ~BUSY
        word = command.value
        each = self.ram[self.ram.valid(word & NUMBER)]
        if word & WRITE:
            if word & MASK:
                each.mask = mask.value
            if word & ARBITRATION:
                each.arbitration = arbitration.value
            if word & CONTROL:
                each.control = control.value & CONTROL_BITS
            if word & REQUEST:
                each.control |= TXRQST | NEWDAT
            if word & DATA_A:
                each.data[0] = data_a.value
            if word & DATA_B:
                each.data[1] = data_b.value
        # A read shows IntPnd and NewDat as they were.  Parts that a write does not move are read back from the object.
        writing = bool(word & WRITE)
        if writing or word & MASK:
            mask.value = each.mask
        if writing or word & ARBITRATION:
            arbitration.value = each.arbitration
        if writing or word & CONTROL:
            control.value = each.control
        if writing or word & DATA_A:
            data_a.value = each.data[0]
        if writing or word & DATA_B:
            data_b.value = each.data[1]
        if not writing:
            if word & (DATA_A | DATA_B) and each.control & NEWDAT:
                each.read_again += not each.fresh
                each.fresh = False
                each.used = True
            if word & CLEAR_PENDING:
                each.control &= ~INTPND
            if word & REQUEST:
                each.control &= ~NEWDAT
        self._update_lines()
        self._request_bus()

    # --- IF3 ---------------------------------------------------------------------------------------------------------

    def _write_CAN_IF3UPD(self, word: int, lanes: int = ALL) -> None:
        self._updates.store(word, lanes)

    def _update(self, number: int) -> None:
        """Copy an object that has received to interface 3, as soon as its last content has been read."""
        if self._observed.value & IF3_UNREAD:
            self._next_update = number
            return
        self._next_update = 0
        each, registers = self.ram[number], self._regs.registers
        words = (each.mask, each.arbitration, each.control, *each.data)
        for part, value in zip(PARTS, words, strict=True):
            registers[f"CAN_IF3{part}"].value = value
        wanted = self._observed.value & IF3_OBSERVED
        self._observed.value = wanted | wanted << 8 | IF3_UPDATED

    def _read_interface_3(self, bit: int, part: str) -> int:
        word = self._regs.registers[f"CAN_IF3{part}"].value
        self._observed.value &= ~(1 << 8 + bit)
        if not self._observed.value & IF3_UNREAD:
            self._observed.value &= ~IF3_UPDATED
            if self._next_update:
                self._update(self._next_update)
        return word


def _first(objects: int) -> int:
    """The number of the first object of a word of flags; 0: none."""
    return (objects & -objects).bit_length()
