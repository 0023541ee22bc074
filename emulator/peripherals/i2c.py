"""I2C controller: START, address, bytes and STOP on a bus, one clock event each.

Modelled: controller transmitter and receiver, with I2CCNT and in repeat mode; repeated START, STOP, acknowledgment in
both directions, NACKMOD; I2CDXR and I2CDRR with underflow and overrun (SCL stays low until the program has served
them); 16-deep FIFOs with levels; all flags of I2CSTR that a controller has; both interrupt lines; the clock from IPSC,
ICCL and ICCH; digital loopback of a transmitter; IRS; a bus that a second controller has (ARBL).
Not modelled: the module as a target (I2COAR, AAS and I2CEMDR report themselves; SDIR and AD0 stay 0), free data format,
START byte, data of less than 8 bits, loss of arbitration within a transfer, targets that stretch the clock, targets
with 10-bit addresses (the first of the two address bytes is sent, and nobody acknowledges it), the levels of SDA and
SCL within a byte, emulation halt (there is no debugger), a transfer that clock gating freezes half-way.
Time: a bit is (IPSC + 1) * (ICCL + ICCH + 2 d) SYSCLK cycles, d = 7, 6, 5 for IPSC = 0, 1, more.  A byte is 9 bits, and
takes effect at the end of its acknowledge bit.  CHOICE: SDA falls one module clock after STT is set, SCL ICCH + d
later.  A repeated START waits for one bit before that.  A STOP takes one bit, and STP is cleared one module clock after
SCD.  A held transfer continues one module clock after the event that it waited for.
Sources: TRM I2C chapter; HDR F2837xS_i2c.h.  They leave open, and TI's examples rely on:
CHOICE: a byte that is not acknowledged sets ARDY as well as NACK, unless the data counter has reached 0.  SCL then
stays low until STT or STP is *written*, even if STP was already set (`stops_when_refused` has the other reading).  What
waits in I2CDXR or the transmit FIFO stays there.
CHOICE: in repeat mode the address byte sets ARDY too.  STT clears ARDY when it is written and when the START is made; a
byte does not clear it.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeVar

from emulator.c28x.findings import Cause
from emulator.c28x.sites import Place
from emulator.clock import CYCLES_PER_MS, Clock, ClockEvent
from emulator.cpu import Cpu
from emulator.peripherals.i2c_checks import I2cChecks
from emulator.peripherals.i2c_data import I2cData
from emulator.peripherals.i2c_interrupts import ARBL, ARDY, NACK, SCD, I2cInterrupts
from emulator.peripherals.i2c_vain import VainWaits
from emulator.registers.cell import Cell
from emulator.registers.i2c import I2cRegs
from emulator.signals import I2cBus

T = TypeVar("T")

# I2CMDR
NACKMOD: Final = 0x8000
STT: Final = 0x2000
STP: Final = 0x0800
MST: Final = 0x0400
TRX: Final = 0x0200
XA: Final = 0x0100
RM: Final = 0x0080
DLB: Final = 0x0040
IRS: Final = 0x0020
#: No bus activity is defined for all three (TRM, bus activity by RM, STT and STP).
RESERVED_COMMAND: Final = RM | STT | STP
# I2CSTR, besides those of the interrupts and of the data
NACKSNT: Final = 0x2000
BB: Final = 0x1000

#: Module clocks that SCL is low beyond ICCL, and high beyond ICCH, for IPSC 0 and 1; above (TRM, the delay d).
DELAYS: Final = {0: 7, 1: 6}
DELAY: Final = 5
#: Bits of a byte on the bus, with its acknowledge bit.
BYTE_BITS: Final = 9
#: Module clocks from I2CDXR to I2CDRR in digital loopback.
LOOPBACK_CLOCKS: Final = 8
#: If a refused message holds the bus for this time while the program reads I2CSTR, the program has forgotten it.
LONG_CYCLES: Final = 100 * CYCLES_PER_MS
#: I2CCNT = 0.
LONGEST_COUNT: Final = 65536
#: The first address byte of a 10-bit address, without R/W: 11110 and the two upper bits.
TEN_BITS: Final = 0x78

# States of the controller on the bus
IDLE: Final = 0
STARTING: Final = 1
BYTE: Final = 2
STOPPING: Final = 3
#: The controller has the bus and holds SCL low.
HELD: Final = 4


class I2c:
    """One I2C module as controller of `bus`; `interrupt` and `fifo_interrupt` are pulses into the PIE.

    `stops_when_refused`: if STP is set already, a message that is not acknowledged ends with a STOP.
    """

    def __init__(
        self,
        clock: Clock,
        cpu: Cpu,
        regs: I2cRegs,
        bus: I2cBus,
        interrupt: Callable[[], None],
        fifo_interrupt: Callable[[], None],
        *,
        stops_when_refused: bool = False,
    ) -> None:
        self._clock = clock
        self._findings = cpu.findings
        self._regs = regs
        self._bus = bus
        self.stops_when_refused = stops_when_refused
        registers = regs.registers
        self._str, self._mdr, self._psc = registers["I2CSTR"], registers["I2CMDR"], registers["I2CPSC"]
        self._clkl, self._clkh = registers["I2CCLKL"], registers["I2CCLKH"]
        self._cnt, self._sar = registers["I2CCNT"], registers["I2CSAR"]
        self._interrupts = I2cInterrupts(regs, interrupt)
        self._data = I2cData(
            regs, cpu.findings, self._interrupts, fifo_interrupt, written=self._written, read=self._go_on
        )
        self._checks = I2cChecks(regs, cpu.findings, bus)
        self._vain = VainWaits(clock, cpu.findings, regs)
        #: The state on the bus, and the event at its end.  HELD has an event only when it is about to go on.
        self._state = IDLE
        self._event: ClockEvent | None = None
        #: Whether this controller has made a START and no STOP yet.
        self._owner = False
        #: Whether the message stays within the module.  CHOICE: DLB counts when its START is made, and until its STOP.
        self._loopback = False
        #: The transfer, as I2CMDR and I2CCNT were at its START; `_finished`: it takes no further byte.
        self._transmitter = self._repeat = self._finished = False
        self._left = 0
        #: Transmit shift register, and the byte on its way through the loopback.
        self._xsr = self._looped = 0
        self._loop: ClockEvent | None = None
        #: The statement that wrote the command or the byte that is on the bus.
        self._cause: Cause | None = None
        #: Whether the address of the present message has no answer yet while NACK was still set at its START.
        self._unanswered = self._old_refusal = False
        #: Whether a refused message holds the bus; when the program first read I2CSTR after that.
        self._forgotten = False
        self._seen_held_at: int | None = None
        #: The number of addresses in a row without an acknowledge.
        self.refusals = 0
        #: SYSCLK cycles a module clock, and d; they follow I2CPSC when IRS is set.
        self._module_cycles, self._delay = 1, DELAYS[0]
        bus.taken_changed.connect(self._bus_taken)
        regs.bind("I2CMDR", write=self._write_I2CMDR)
        regs.bind("I2CPSC", write=self._write_I2CPSC)
        regs.bind("I2CCLKL", write=self._write_I2CCLKL)
        regs.bind("I2CCLKH", write=self._write_I2CCLKH)

    def reset(self) -> None:
        """Reset of the module (power-on, SOFTPRES9)."""
        self._release()
        self._regs.reset()
        self._data.reset()

    @property
    def bit_cycles(self) -> int:
        """SYSCLK cycles a bit at the present settings."""
        return self._module_cycles * (self._clkl.value + self._clkh.value + 2 * self._delay)

    # --- commands --------------------------------------------------------------------------------------------------

    def _write_I2CPSC(self, word: int, lanes: int) -> None:
        before = self._psc.value
        self._psc.store(word, lanes)
        self._checks.prescaler(before, running=bool(self._mdr.value & IRS))

    def _write_I2CCLKL(self, word: int, lanes: int) -> None:
        self._clkl.store(word, lanes)
        self._checks.divider()

    def _write_I2CCLKH(self, word: int, lanes: int) -> None:
        self._clkh.store(word, lanes)
        self._checks.divider()

    def _write_I2CMDR(self, word: int, lanes: int) -> None:
        mdr = self._mdr
        before = mdr.value
        if not word & IRS:
            # CHOICE: a write that sets IRS can set STT and STP with it.
            word &= ~(STT | STP)
        mdr.store(word, lanes)
        mode = mdr.value
        if not mode & IRS:
            if before & IRS:
                self._vain.reset()
                self._release()
            return
        if not before & IRS:
            prescaler = self._psc.value
            self._module_cycles, self._delay = prescaler + 1, DELAYS.get(prescaler, DELAY)
            self._data.run(True)
        if mode & (STT | STP):
            self._command(mode, before)

    def _command(self, mode: int, before: int) -> None:
        """STT or STP was written: act as the TRM's table of bus activity says, as soon as the bus allows."""
        self._cause = self._findings.mark()
        if not mode & MST:
            if mode & STT:
                self._checks.no_controller()
        elif mode & RESERVED_COMMAND == RESERVED_COMMAND:
            # CHOICE: both bits are cleared, so that the next write does not start this command.
            self._mdr.value &= ~(STT | STP)
            self._checks.reserved_command()
        else:
            if mode & STT and not before & STT:
                self._checks.start(self._module_cycles, self.bit_cycles)
                self._vain.started()
                self._interrupts.clear(ARDY)
            if mode & STP and mode == before and self._unanswered and self._old_refusal:
                self._checks.old_refusal()
            self._execute(mode, before)

    def _execute(self, mode: int, before: int) -> None:
        """Carry out a valid command."""
        if self._state != IDLE:
            # The operation under way reads both bits when it ends.  CHOICE: so a START that comes too early is made
            # after the STOP, or after the byte.
            if mode & STT and before & STP and not before & STT and self._state in (BYTE, STOPPING):
                self._checks.early()
            if self._finished or not self._data.overrun:
                self._go_on()
        elif self._str.value & BB:
            # A second controller has the bus.
            self._mdr.value &= ~(STT | STP | MST)
            self._interrupts.set(ARBL)
        elif mode & STT:
            self._begin_start()
        else:
            # A STOP alone.  CHOICE: it acts at the next module clock, so an STT right after it acts together with it.
            self._state, self._finished = STARTING, True
            self._event = self._clock.after(self._module_cycles, self._next)

    def _written(self) -> None:
        """The program has written a byte to I2CDXR."""
        self._cause = self._findings.mark()
        if self._transmitter and not self._finished:
            self._go_on()

    def _go_on(self) -> None:
        """If SCL is held: the program has done what it was held for, so go on."""
        if self._state == HELD and self._event is None:
            self._forgotten = False
            self._event = self._clock.after(self._module_cycles, self._next)

    def _release(self) -> None:
        """IRS = 0: lines released, flags as after reset.  CHOICE: a target takes the release for a STOP."""
        for event in (self._event, self._loop):
            self._clock.cancel(event)
        self._event = self._loop = None
        self._state = IDLE
        if self._owner:
            self._owner = False
            if not self._loopback:
                self._bus.stop()
        self._mdr.value &= ~(STT | STP)
        self._data.run(False)
        self._interrupts.reset()

    def _bus_taken(self, taken: bool) -> None:
        """A second controller has the bus, or has made its STOP."""
        if self._mdr.value & IRS and not self._owner:
            if taken:
                self._str.value |= BB
            else:
                self._str.value &= ~BB
                self._interrupts.set(SCD)

    # --- a transfer ------------------------------------------------------------------------------------------------

    def _begin_start(self) -> None:
        wait = self.bit_cycles if self._owner else 0
        self._state = STARTING
        self._unanswered, self._old_refusal = True, bool(self._str.value & NACK)
        self._event = self._clock.after(wait + self._module_cycles, self._start)

    def _start(self) -> None:
        """SDA falls while SCL is high."""
        if not self._owner:
            self._loopback = bool(self._mdr.value & DLB)
        self._owner = True
        self._str.value |= BB
        if not self._loopback:
            self._caused(self._bus.start)
        self._event = self._clock.after(self._module_cycles * (self._clkh.value + self._delay), self._started)

    def _started(self) -> None:
        """SCL falls: the address follows.  The registers now decide the transfer."""
        mode = self._mdr.value
        self._mdr.value = mode & ~STT
        self._interrupts.clear(ARDY)
        self._transmitter, self._repeat = bool(mode & TRX), bool(mode & RM)
        self._left = self._vain.wanted = self._cnt.value or LONGEST_COUNT
        self._finished = False
        if self._loopback and not self._transmitter:
            self._checks.receiver_in_loopback()
        self._shift(self._address_sent)

    def report_retry(self, place: Place) -> None:
        """Report that the program ends in a loop, at `place`, that repeats its message until it succeeds."""
        self._findings.report_at(
            place, "endless-retry",
            f"repeated until it works: {self._regs.name} has sent {self.refusals} addresses in a row that nobody "
            "acknowledged", object=self._regs.name, how="dynamic", task="main",
        )  # fmt: skip

    def _shift(self, done: Callable[[], None]) -> None:
        self._state = BYTE
        self._event = self._clock.after(BYTE_BITS * self.bit_cycles, done)

    def _address_sent(self) -> None:
        mode, target = self._mdr.value, self._sar.value
        address = TEN_BITS | target >> 8 if mode & XA else target & 0x7F
        self._unanswered = False
        if not self._loopback and not self._caused(self._bus.address, address, not self._transmitter):
            self.refusals += 1
            self._refused()
            return
        self.refusals = 0
        self._interrupts.clear(NACK)
        if self._repeat:
            self._interrupts.set(ARDY)
        self._next()

    def _refused(self) -> None:
        """No acknowledgment: the transfer is over, and the program decides how it ends."""
        self._finished = True
        self._data.refused()
        self._interrupts.set(NACK | ARDY)
        mode = self._mdr.value
        if mode & STT or (mode & STP and (self._repeat or self.stops_when_refused)):
            self._next()
        else:
            self._hold()
            self._forgotten, self._seen_held_at = True, None
            self._str.tap(self._on_status_read, reads=True)

    def _on_status_read(self, register: Cell, access: str, _word: int, _mask: int) -> None:
        """The program reads I2CSTR after a message was refused."""
        now = self._clock.now
        if self._state != HELD or not self._forgotten:
            register.untap(self._on_status_read)
        elif access == "read":
            if self._seen_held_at is None:
                self._seen_held_at = now
            elif now - self._seen_held_at >= LONG_CYCLES:
                self._checks.left_busy(now - self._seen_held_at)
                register.untap(self._on_status_read)

    def _hold(self) -> None:
        self._state, self._event = HELD, None

    def _caused(self, step: Callable[..., T], *what: object) -> T:
        """Run a step on the bus.  Reports of targets get the statement that wrote the command or the byte."""
        self._findings.cause = self._cause
        try:
            return step(*what)
        finally:
            self._findings.cause = None

    def _next(self) -> None:
        """Decide the next step between two bytes, with SCL low."""
        mode = self._mdr.value
        if mode & STT:
            self._begin_start()
        elif mode & STP and (self._finished or (self._repeat and self._transmitter)):
            self._begin_stop()
        elif self._finished:
            self._hold()
            self._vain.ended(held=True, receiver=False)
        elif self._transmitter:
            byte = self._data.load()
            if byte < 0:
                self._hold()
            else:
                self._xsr = byte
                self._shift(self._byte_sent)
        else:
            self._shift(self._byte_received)

    def _count(self) -> None:
        """A data byte has ended.  Without repeat mode, ARDY is set after the last one, unless a STOP follows."""
        if self._repeat:
            self._interrupts.set(ARDY)
            return
        self._left -= 1
        if not self._left:
            self._finished = True
        if self._finished and not self._mdr.value & STP:
            self._interrupts.set(ARDY)

    def _byte_sent(self) -> None:
        acknowledged = True
        if self._loopback:
            self._looped = self._xsr
            self._loop = self._clock.after(LOOPBACK_CLOCKS * self._module_cycles, self._looped_back)
        else:
            acknowledged = self._caused(self._bus.write, self._xsr)
        self._count()
        if acknowledged:
            self._interrupts.clear(NACK)
            self._next()
        elif self._finished:
            self._interrupts.set(NACK)
            self._next()
        else:
            self._refused()

    def _looped_back(self) -> None:
        self._loop = None
        self._data.arrive(self._looped)

    def _byte_received(self) -> None:
        byte = self._caused(self._bus.read)
        mode = self._mdr.value
        last = bool(mode & STP) if self._repeat else self._left == 1
        if last or mode & NACKMOD:
            self._mdr.value = mode & ~NACKMOD
            self._str.value |= NACKSNT
            self._finished = True
        self._data.arrive(byte)
        self._count()
        # CHOICE: the acknowledge bit of a byte that was not read is sent before SCL is held; a STOP is not held.
        if self._data.overrun and not self._finished:
            self._hold()
        else:
            self._next()

    def _begin_stop(self) -> None:
        self._state = STOPPING
        self._event = self._clock.after(self.bit_cycles, self._stopped)

    def _stopped(self) -> None:
        """SDA rises while SCL is high."""
        if not self._owner:
            self._loopback = bool(self._mdr.value & DLB)
        self._owner = False
        if not self._loopback:
            self._caused(self._bus.stop)
        self._str.value &= ~BB
        self._interrupts.set(SCD)
        self._vain.ended(held=False, receiver=not self._transmitter and not self._unanswered and not self._left)
        self._event = self._clock.after(self._module_cycles, self._release_bus)

    def _release_bus(self) -> None:
        """Clear STP and MST, after SCD."""
        self._state, self._event = IDLE, None
        mode = self._mdr.value & ~STP
        if mode & STT:
            self._mdr.value = mode
            self._begin_start()
        else:
            self._mdr.value = mode & ~MST
