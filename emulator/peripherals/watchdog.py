"""The watchdog: an 8-bit counter that resets the chip, or raises WDINT, unless it is serviced.

Modelled: WDCR check pattern, disable, prescaler; WDKEY sequence; WDCNTR; SCSR (WDOVERRIDE, WDENINT, WDINTS); window.
Not modelled: HALT and STANDBY, drift of INTOSC1, the length of the reset pulse, the restart of the program.
Time: WDCLK = INTOSC1 (10 MHz) / 512 / prescaler.  The counter overflows after 256 counts, 13.1 ms at /1.  WDCNTR is
computed when it is read; the only event is the overflow of an enabled watchdog.
Sources: TRM watchdog; HDR F2837xS_sysctrl.h, struct WD_REGS.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from emulator.c28x.findings import Cause
from emulator.c28x.sites import Place
from emulator.clock import SYSCLK_HZ, Clock, ClockEvent, ms
from emulator.cpu import Cpu
from emulator.registers.core import ALL
from emulator.registers.watchdog import WdRegs

INTOSC1_HZ: Final = 10_000_000
#: One count at prescaler /1; WDINT stays low as long, 512 periods of INTOSC1.
COUNT_CYCLES: Final = 512 * (SYSCLK_HZ // INTOSC1_HZ)
COUNTS: Final = 256
WDCHK: Final = 0b101 << 3
WDDIS: Final = 0x40
FIRSTKEY: Final = 0x100


class Watchdog:
    """Watchdog behaviour.  `reset` resets the device; `wakeint` is the pulse of PIE interrupt 1.8."""

    def __init__(self, clock: Clock, cpu: Cpu, regs: WdRegs, reset: Callable[[], None], wakeint: Callable[[], None], *,
                 enabled_at_reset: bool = True) -> None:  # fmt: skip
        """CHOICE: out of reset the watchdog counts (`enabled_at_reset`); False spares a board its start-up code."""
        self._clock, self._cpu, self._regs = clock, cpu, regs
        self._reset_device, self._wakeint, self._enabled_at_reset = reset, wakeint, enabled_at_reset
        registers = regs.registers
        self._scsr, self._wdcr, self._wdwcr = registers["SCSR"], registers["WDCR"], registers["WDWCR"]
        regs.bind("SCSR", read=self._read_SCSR, write=self._write_SCSR)
        regs.bind("WDCNTR", read=self._read_WDCNTR)
        regs.bind("WDKEY", write=self._write_WDKEY)
        regs.bind("WDCR", write=self._write_WDCR)
        regs.bind("WDWCR", write=self._write_WDWCR)
        self._event: ClockEvent | None = None
        #: The statement that wrote the first key last.
        self._begun: Cause | None = None
        #: The statement that wrote WDCR last.
        self._set_up: Cause | None = None
        #: When it was serviced last; 0: never.
        self._serviced_at = 0
        #: The statements that switched it on, by their numbers: the last time.  A reset does not count.
        self.switched_on: dict[int, Cause | None] = {}
        #: Whether the last write of WDCR has switched it off.  A reset does not count.
        self._switched_off = False
        #: The last statement that wrote WDCR, if an earlier one had switched the watchdog off and it is off still.
        self.left_off: Cause | None = None
        #: How often it was serviced since then.
        self.serviced_off = 0
        self.reset()

    def report_hung_main(self, since: int, hung: Place) -> None:
        """Report a service of the watchdog although `main` hangs at `hung` since the cycle `since`."""
        begun, findings = self._begun, self._cpu.findings
        if self._wdcr.value & WDDIS or begun is None or self._serviced_at <= since:
            return
        path = findings.path(begun.at, begun.calls)
        findings.report_at(
            path[0], "watchdog-in-vain",
            f"{begun.who} services the watchdog while main hangs in {hung.function}, line {hung.line}, for the last "
            f"{ms(self._clock.now - since):.0f} ms: the device is not reset",
            how="dynamic", object=self._regs.name, call_path=path, task=begun.who,
        )  # fmt: skip

    def reset(self) -> None:
        """Reset of the device."""
        self._regs.reset()
        self._key_seen = False
        self._int_until = 0
        self._held = 0  # counts while disabled
        self._since = self._clock.now
        self._wdcr.value = 0 if self._enabled_at_reset else WDDIS
        self._plan()

    def _count_cycles(self) -> int:
        wdps = self._wdcr.value & 7
        return COUNT_CYCLES << (wdps - 1 if wdps else 0)

    def _counter(self) -> int:
        if self._wdcr.value & WDDIS:
            return self._held
        return (self._clock.now - self._since) // self._count_cycles() % COUNTS

    def _plan(self) -> None:
        self._clock.cancel(self._event)
        self._event = None
        if not self._wdcr.value & WDDIS:
            self._event = self._clock.schedule(self._since + COUNTS * self._count_cycles(), self._expire)

    def _restart(self, count: int = 0) -> None:
        self._held = count
        self._since = self._clock.now - count * self._count_cycles()
        self._plan()

    def _expire(self) -> None:
        """The counter overflowed."""
        served = self._serviced_at
        self._over(f"last serviced {ms(self._clock.now - served):.1f} ms ago" if served else "never serviced")

    def _over(self, why: str) -> None:
        """The counter overflowed, or a service came too early: reset, or WDINT."""
        self._event = None
        if self._scsr.value & 0x2:
            self._restart()
            self._int_until = self._clock.now + COUNT_CYCLES
            self._wakeint()
        else:
            self._bite(why)

    def _bite(self, why: str) -> None:
        if self._key_seen:
            why += "; 0x55 was written to WDKEY, and 0xAA did not follow"
        self._cpu.findings.report(
            "watchdog-reset", f"the watchdog resets the device: {why}", object=self._regs.name,
            cause=self._begun if self._key_seen else None, otherwise=self._begun or self._set_up,
        )  # fmt: skip
        self._reset_device()

    # --- register handlers -------------------------------------------------------------------------------------------

    def _read_SCSR(self) -> int:
        return self._scsr.value & 0x3 | (0 if self._clock.now < self._int_until else 0x4)

    def _write_SCSR(self, word: int, lanes: int = ALL) -> None:
        self._scsr.store(word, lanes)

    def _read_WDCNTR(self) -> int:
        return self._counter()

    def _write_WDKEY(self, word: int, lanes: int = ALL) -> None:
        key = word & 0xFF
        seen, self._key_seen = self._key_seen, key == 0x55
        if key == 0x55:
            self._begun = self._cpu.findings.mark()
        if key != 0xAA or not seen:
            return
        window = self._wdwcr.value
        if window & 0xFF:
            # TRM: the first service after MIN was set is free; later ones must not come before it.
            if window & FIRSTKEY and self._counter() < window & 0xFF:
                self._over("serviced before the counter reached WDWCR.MIN")
                return
            self._wdwcr.value = window | FIRSTKEY
        self._serviced_at = self._clock.now
        self.serviced_off += 1
        self._restart()

    def _write_WDCR(self, word: int, lanes: int = ALL) -> None:
        if word & 0x38 != WDCHK:
            self._bite(f"{word:#06x} was written to WDCR without 101b in WDCHK")
            return
        self._set_up = self._cpu.findings.mark()
        count = self._counter()
        if not self._scsr.value & 1:  # WDOVERRIDE cleared: WDDIS keeps its state
            word = word & ~WDDIS | self._wdcr.value & WDDIS
        self._wdcr.store(word, lanes)
        off = bool(self._wdcr.value & WDDIS)
        self.left_off = self._set_up if off and self._switched_off else None
        self._switched_off, self.serviced_off = off, 0
        if not off:
            self.switched_on[self._set_up.at if self._set_up is not None else 0] = self._set_up
        self._restart(count)

    def _write_WDWCR(self, word: int, lanes: int = ALL) -> None:
        self._wdwcr.store(word, lanes)
        self._wdwcr.value &= ~FIRSTKEY
