"""Finds configurations that can have no effect, when a run ends: `not-connected`, `adc-burst`, `trip-open` and others.

A module is set up in several places, and the last link of the chain may be missing.  For example, the ADC waits for a
trigger of an ePWM whose counter was never started.  Then nothing happens at all, so there is no access at which it
could be reported.  At the end of a run the registers show what is configured, and the source shows whether any
statement of the program could still change it.  It is reported only if none can, at the statement that makes the link
wrong, or else at the one that wants the event.

A register that is reached through a pointer, or assigned a value that the source does not tell, could hold anything.
Firmware without a `main` is part of a program.  The rest may do what is missing, so nothing is reported.

Time: none while firmware runs.
Sources: TRM, ADC (SOC triggers), ePWM (time base, event trigger, counter compare), PIE, external interrupts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import product
from operator import eq, not_
from typing import Final

from emulator.c28x.declarations import lines_with_comments
from emulator.c28x.link import Linked
from emulator.c28x.sites import Place
from emulator.c28x.symbols import Module
from emulator.c28x.tree import Function
from emulator.c28x.tree_queries import below
from emulator.can_bus import TOLERANCE, CanPart
from emulator.chip import (
    ADC_PIE,
    ADCEVT_PIE,
    CAN_PIE,
    DMA_ADC,
    DMA_TRIGSEL,
    ECAP_COUNT,
    ECAP_INPUT,
    EPWM_COUNT,
    EQEP_COUNT,
    I2C_PIE,
    SCI_PIE,
    SPI_PIE,
    XINT_INPUT,
    XINT_PIE,
    Chip,
)
from emulator.clock import CYCLES_PER_MS, CYCLES_PER_US, SYSCLK_HZ
from emulator.interrupt_flags import InterruptFlag, acknowledged, interrupt_flags, routine_of, wanted_again
from emulator.latched_flags import CLEARED, LASTING, latched_flags
from emulator.peripherals.can import REQUEST, WRITE
from emulator.peripherals.can_objects import DIR, EOB, ID, MSGLST, MSGVAL, OBJECTS, RXIE, STANDARD_ID, UMASK
from emulator.peripherals.dma import CHANNELS as DMA_CHANNELS
from emulator.peripherals.epwm_checks import CompareBeyondPeriod
from emulator.peripherals.epwm_xbar import TRIPS as XBAR_TRIP_OUTPUTS
from emulator.peripherals.pie import vector_id
from emulator.peripherals.watchdog import WDCHK, WDDIS
from emulator.peripherals.xbar_mux import choices
from emulator.register_writes import RegisterWrites, field_of
from emulator.registers.core import Block
from emulator.registers.eqep import QEINT
from emulator.registers.gpio import PORTS
from emulator.xbar_users import other_inputs

#: TRIGSEL of the first ePWM's SOCA; its SOCB follows, and then those of the next ePWM (TRM, ADCSOCxCTL).
FIRST_SOCA: Final = 5
#: TRIGSEL of the CPU timers.
TIMERS: Final = range(1, 4)
#: A statement that sets up one module writes registers of so many blocks: its own, its clock gate, its interrupt, pins.
_ONE_MODULE: Final = 5
#: Values of TBCTL.CTRMODE.
UP: Final = 0
DOWN: Final = 1
UP_DOWN: Final = 2
STOPPED: Final = 3
#: Choice of ETSEL -> its compare, and the counter mode in which it never occurs: 4 CAU, 5 CAD, 6 CBU, 7 CBD.
COMPARES: Final = {4: ("CMPA", DOWN), 5: ("CMPA", UP), 6: ("CMPB", DOWN), 7: ("CMPB", UP)}
#: Functions and instructions that set INTM to 0, or go on when an interrupt waits although INTM is 1 (IDLE).
LET_THROUGH: Final = (
    "EINT", "__enable_interrupts", "__restore_interrupts", "EnableInterrupts", "Hwi_enable", "Hwi_restore",
    "BIOS_start", "IDLE", "__idle", "STANDBY", "HALT", "HIB",
)  # fmt: skip
#: Fields of AQCTLA and AQCTLB, and those of their values that do not toggle.
AQ_EVENTS: Final = ("ZRO", "PRD", "CAU", "CAD", "CBU", "CBD")
AQ_LEVELS: Final = {1: "clears", 2: "sets"}
#: Values of AQCTLA and AQCTLB, as they act on an output.
AQ_ACTIONS: Final = {1: "cleared", 2: "set"}
#: Channels of an ADC that are pins (DS, analog subsystem); the others are inside of the chip.
ADC_PINS: Final = (*range(6), 14, 15)
#: Words of a FIFO of the SCI.
FIFO_DEPTH: Final = 16
#: Value of CTRIPHSEL and CTRIPLSEL: the output of the digital filter.
FILTERED: Final = 2
#: Trip zones that are inputs of the chip: TZ1 to TZ3 are INPUT1 to INPUT3 of the X-BAR.
TRIP_INPUTS: Final = (1, 2, 3)
#: Nothing is reported for fewer edges, messages or frames than these.
MIN_EDGES: Final = 8
#: Value of TZA and TZB: a trip does not change the output.
NO_CHANGE: Final = 3
#: The watchdog is serviced again and again if it was so often.
MIN_SERVICES: Final = 3
#: TI's functions that service the watchdog, and those that switch it off.
SERVICES_WATCHDOG: Final = ("ServiceDog", "SysCtl_serviceWatchdog")
SWITCHES_OFF: Final = ("DisableDog", "SysCtl_disableWatchdog")
#: TI's functions that set up the clock.  They switch the watchdog off; some switch it on while the PLL locks.
STARTS_UP: Final = ("InitSysCtrl", "InitSysPll", "Device_init", "SysCtl_setClock")
#: A function or a line says with one of these words that the watchdog is to be off.
OFF: Final = re.compile(
    r"(?i:disabl|inactiv|debug|stop|wd\w{0,3}dis(?!\w*\s*=\s*0)|(?:ab|aus)schalt|desactiv|deshabilit|apaga)|"
    r"(?<![A-Za-z])(?:off|aus)(?![a-z])|(?:Off|OFF|Aus|AUS)(?![A-Za-z])"
)
#: Value of LOADAMODE: the active register is never loaded from the shadow register.
FREEZE: Final = 3


@dataclass(frozen=True, slots=True)
class MissingLink:
    """A missing link of a chain: what is wrong, and the register and field at fault."""

    why: str
    register: str
    field: str = ""


class Connections:
    """Checks one chip and the program that is linked to it."""

    def __init__(self, chip: Chip, linked: Linked) -> None:
        self._chip = chip
        self._linked = linked
        self._done = False
        #: Whether `main` has reached its last loop or the start of the kernel.  The code that runs `main` sets it.
        self.started_up = False
        #: Names of interrupt routines that can never run again.
        self.silent: set[str] = set()

    def finish(self) -> None:
        """Report every configuration that can have no effect."""
        if self._done:
            return
        self._done = True
        modules = list(self._linked.program.modules.values())
        if not any(f.name == "main" and f.body for module in modules for f in module.functions):
            return  # not a whole program
        self._read(modules)
        self._adc_triggers()
        self._polled_conversions()
        self._adc_inputs()
        self._interrupts()
        self._kept_out()
        self._always_masked()
        self._latches()
        self._captures()
        self._channels()
        self._sections()
        self._groups()
        self._qualifiers()
        self._cpu_timers()
        self._watchdog_off()
        self._time_bases()
        self._trips()
        self._trip_actions()
        self._trips_at_once()
        self._forced_trips()
        self._dead_bands()
        self._post_processing()
        self._pairs()
        self._chip.pie.finish()
        self._i2c()
        self._serial()
        self._other_groups(modules)
        self._interrupts_kept_back(modules)
        self._flags_kept(modules)
        self._can()
        self._dacs()
        self._loads()
        self._compares()
        self._compares_for_nobody()
        self._compares_never_set()
        self._half_duties()
        self._outputs()
        self._driven_inputs()

    def contradictions(self) -> None:
        """Report settings of driver files without a `main` that have no effect whatever an application does besides.

        Call it once the functions that initialise have been called.
        """
        modules = list(self._linked.program.modules.values())
        self._read(modules)
        for group in range(1, 13):
            for n in range(1, 17):
                register, field = f"PieCtrlRegs.PIEIER{group}", f"INTx{n}"
                place = self._wanting(register, field) if self._chip.pie.enabled(group, n) else None
                # Its routine may be given to a function of these files that nobody has called.
                if place is not None and not self._writes(f"PieVectTable.{self._chip.vectors.entry(group, n)}"):
                    self._other_line(place, group, n)
        self._other_groups(modules)
        for other in other_inputs(self._chip, self._source):
            self._chip.findings.report_at(
                other.place, "not-connected", other.message, object=other.listener.name, how="dynamic"
            )
        self._loads()

    # The source

    def _read(self, modules: list[Module]) -> None:
        self._source = RegisterWrites(modules, (*self._chip.blocks.values(), self._chip.vectors.registers))

    def _writes(self, register: str) -> bool:
        """Whether any statement assigns to a register by its name."""
        block, name = _split(register)
        return (block, name) in self._source.writes

    def _calls(self, *names: str) -> bool:
        """Whether any statement of the program calls one of these TI functions."""
        return any(name in self._source.calls for name in names)

    def _could(self, register: str, right: Callable[[int], bool], field: str) -> bool:
        """Whether some statement of the program could give a field a value that `right` accepts."""
        block, name = _split(register)
        return self._source.could(block, name, self._mask(register, field), right)

    def _wanting(self, register: str, field: str) -> Place | None:
        """The last statement of the source that gives a field the value that it has now."""
        block, name = _split(register)
        now = self._chip.blocks[block].registers[name].value
        return self._source.giving(block, name, self._mask(register, field), now)

    def _place(self, missing: MissingLink, *, whole: bool) -> Place | None:
        """Where a link is missing: the statement that gives the field its value, or the last write to the register.

        With `whole`, the last write to any register of the block if there is no such statement.
        """
        block, name = _split(missing.register)
        found = self._wanting(missing.register, missing.field) or self._source.last(block, name)
        return found or (self._source.last(block) if whole else None)

    def _mask(self, register: str, field: str) -> int:
        block, name = _split(register)
        cell = self._chip.blocks[block].registers[name]
        return cell.fields[field].mask if field else (1 << cell.bits) - 1

    def _value(self, register: str, field: str) -> int:
        """The value of a field now."""
        block, name = _split(register)
        return field_of(self._chip.blocks[block].registers[name].value, self._mask(register, field))

    def _stuck(self, register: str, field: str, right: Callable[[int], bool]) -> bool:
        """Whether `right` rejects the value of a field, and no statement could still give it a right one.

        Statements of the start-up do not count once it is over.
        """
        if right(self._value(register, field)):
            return False
        return not self._writes_again(register, right, field)

    def _writes_again(self, register: str, right: Callable[[int], bool], field: str) -> bool:
        """As `_could`, without the statements of the start-up once it is over."""
        block, name = _split(register)
        return self._source.could(block, name, self._mask(register, field), right, again=self.started_up)

    def _report(
        self, waits: Place | None, message: str, missing: MissingLink, object: str, *, whole: bool = False
    ) -> None:
        """Report that the statement at `waits` waits for an event that never occurs."""
        if waits is None:
            return
        place = self._place(missing, whole=whole) or waits
        if self._blocks_of(place) > _ONE_MODULE:
            place = waits  # a call that starts the whole chip says nothing about this link
        details = () if place == waits else (f"wanted by {waits}",)
        self._chip.findings.report_at(
            place, "not-connected", f"{message}: {missing.why}", object=object, how="dynamic", details=details
        )

    def _blocks_of(self, place: Place) -> int:
        """In how many blocks a statement sets registers, with what it calls of a library."""
        of_register = self._source.writes.items()
        return len({block for (block, _), writes in of_register if any(write.place == place for write in writes)})

    # The checks

    def _adc_triggers(self) -> None:
        for letter in ADC_PIE:
            block = f"Adc{letter.lower()}Regs"
            bursts = self._value(f"{block}.ADCBURSTCTL", "BURSTEN")
            # In burst mode only the SOCs of high priority use their TRIGSEL.
            end = self._value(f"{block}.ADCSOCPRICTL", "SOCPRIORITY") if bursts else 16
            if bursts and end < 16:
                self._burst(block, end)
            for n in range(min(end, 16)) if not self._writes(f"{block}.ADCSOCFRC1") else ():
                if self._value(f"{block}.ADCINTSOCSEL{n // 8 + 1}", f"SOC{n}"):
                    continue  # an ADCINT triggers it instead
                register = f"{block}.ADCSOC{n}CTL"
                trigsel = self._value(register, "TRIGSEL")
                place = self._wanting(register, "TRIGSEL")
                if place is None and trigsel:  # a value that the source does not show
                    place = self._source.last(*_split(register))
                if place is None:
                    continue
                trigger, missing = self._no_trigger(trigsel)
                if missing and missing.field in ("SOCAEN", "SOCBEN") and self._other_soc_is_unused(trigsel):
                    other = "SOCB" if trigger.startswith("SOCA") else "SOCA"
                    why = f"{missing.why}, while its {other} occurs and starts nothing"
                    missing = MissingLink(why, register, "TRIGSEL")
                elif missing and trigsel in TIMERS and (other_timer := self._unused_timer()) is not None:
                    why = f"{missing.why}, while CPU timer {other_timer} occurs and starts nothing"
                    missing = MissingLink(why, register, "TRIGSEL")
                if missing:
                    waits = f"{register}.TRIGSEL waits for {trigger}, which never occurs"
                    self._report(place, waits, missing, f"{register}.TRIGSEL")

    def _polled_conversions(self) -> None:
        """Flags of an ADC that the program polls, and that nothing can set: their SOC is never started."""
        for letter, lines in ADC_PIE.items():
            block, register = f"Adc{letter.lower()}Regs", "ADCINTFLG"
            selects = {k: f"{block}.ADCINTSEL{'1N2' if k < 3 else '3N4'}" for k in range(1, 5)}
            enabled = [k for k, select in selects.items() if self._value(select, f"INT{k}E")]
            for k in enabled:
                # A read of the whole register means the flag if it is the only one that is enabled.
                read = {(block, register, f"ADCINT{k}"), *([(block, register, "")] if enabled == [k] else ())}
                polled = self._source.reads.get((block, register))
                if not polled or read.isdisjoint(self._source.read_fields) or self._chip.pie.enabled(*lines[k - 1]):
                    continue
                missing = self._no_conversion(letter, k)
                if missing is not None:
                    flag = f"{block}.{register}.ADCINT{k}"
                    self._report(polled[-1], f"{flag} is polled and never set", missing, flag)

    def _other_soc_is_unused(self, trigsel: int) -> bool:
        """Whether the ePWM's other SOC occurs and starts nothing: then the TRIGSEL probably means that one."""
        other = trigsel + 1 if (trigsel - FIRST_SOCA) % 2 == 0 else trigsel - 1
        if self._no_trigger(other)[1] is not None or self._could_trigger_dma(other):
            return False
        return not any(
            self._could(f"Adc{letter.lower()}Regs.ADCSOC{n}CTL", lambda word: word == other, "TRIGSEL")
            for letter in ADC_PIE for n in range(16)
        )

    def _unused_timer(self) -> int | None:
        """A CPU timer that ends and that nobody waits for: probably the one that a TRIGSEL means."""
        ier = self._chip.cpu.ier
        for n, enabled in enumerate((self._chip.pie.enabled(1, 7), bool(ier & 1 << 12), bool(ier & 1 << 13))):
            trigsel = TIMERS[n]
            triggers = any(
                self._could(f"Adc{letter.lower()}Regs.ADCSOC{soc}CTL", trigsel.__eq__, "TRIGSEL")
                for letter in ADC_PIE for soc in range(16)
            )
            if not enabled and not triggers and self._no_timer(n) is None and not self._could_trigger_dma(trigsel):
                return n
        return None

    def _could_trigger_dma(self, trigsel: int) -> bool:
        """Whether a statement could make a DMA channel listen to the trigger of this TRIGSEL."""
        number = DMA_TRIGSEL[trigsel]
        return any(
            self._could(f"DmaClaSrcSelRegs.DMACHSRCSEL{1 + n // 4}", lambda word: word == number, f"CH{n + 1}")
            for n in range(DMA_CHANNELS)
        )

    def _adc_inputs(self) -> None:
        """Inputs that a program converts and that nothing drives, where it never converts one that a part drives."""
        for letter, inputs in self._chip.analog.items():
            block, results = f"Adc{letter.lower()}Regs", f"Adc{letter.lower()}ResultRegs"
            if self._value(f"{block}.ADCCTL2", "SIGNALMODE"):
                continue  # a channel is two inputs
            controls = [f"{block}.ADCSOC{n}CTL" for n in range(16)]
            chosen = {n: self._value(control, "CHSEL") for n, control in enumerate(controls) if self._writes(control)}
            unread = [
                n for n in ADC_PINS if inputs[n].driver and n not in chosen.values()
                and not any(self._could(control, n.__eq__, "CHSEL") for control in controls)
            ]  # fmt: skip
            for n, channel in chosen.items() if unread else ():
                if channel not in ADC_PINS or inputs[channel].driven or (results, f"ADCRESULT{n}") not in (
                    self._source.reads
                ):  # fmt: skip
                    continue
                place = self._wanting(controls[n], "CHSEL") or self._source.last(*_split(controls[n]))
                if place is not None:
                    self._chip.findings.report_at(
                        place, "adc-input-open",
                        f"SOC{n} converts ADCIN{letter}{channel}, which nothing drives; {inputs[unread[0]].driver} "
                        f"drives ADCIN{letter}{unread[0]}, which no SOC converts",
                        object=controls[n], how="dynamic",
                    )  # fmt: skip

    def _driven_inputs(self) -> None:
        """Pins that the program sets and clears, and that no statement makes outputs."""
        calls = self._source.calls.get("GPIO_SetupPinOptions", ())
        named = [self._source.values(arguments[0]) for _, arguments in calls]
        if None in named:
            return
        set_up = frozenset[int]().union(*(numbers for numbers in named if numbers is not None))
        for letter, first in zip(PORTS, range(0, 32 * len(PORTS), 32), strict=True):
            direction = f"GpioCtrlRegs.GP{letter}DIR"
            for n in range(32):
                places = [self._moves(f"GP{letter}{verb}", 1 << n) for verb in ("SET", "CLEAR", "TOGGLE")]
                moved = (places[0] and places[1]) or places[2]
                if moved is None or first + n in set_up:
                    continue
                block, name = _split(direction)
                register = self._chip.blocks[block].registers[name]
                if register.value & 1 << n or self._source.could(block, name, 1 << n, bool):
                    continue
                self._chip.findings.report_at(
                    moved, "not-connected", f"GPIO{first + n} is set and cleared, and drives nothing: it is an input, "
                    f"and no statement sets {direction}.GPIO{first + n}", object=f"GPIO{first + n}", how="dynamic",
                )  # fmt: skip

    def _moves(self, register: str, mask: int) -> Place | None:
        """The last statement that writes a 1 to this one bit of a register of GpioDataRegs."""
        places = [
            write.place for write in self._source.of("GpioDataRegs", register, mask)
            if write.values is not None and any(value & mask for value in write.values)
            and not write.place.file.startswith("<")
        ]  # fmt: skip
        return places[-1] if places else None

    def _burst(self, block: str, first: int) -> None:
        """Bursts go round through SOC `first` to SOC15.  Each should be set up, and a round should end with a burst."""
        place = self._wanting(f"{block}.ADCBURSTCTL", "BURSTSIZE") or self._wanting(f"{block}.ADCBURSTCTL", "BURSTEN")
        size = self._value(f"{block}.ADCBURSTCTL", "BURSTSIZE") + 1
        bare = [
            n for n in range(first, 16)
            if not self._value(f"{block}.ADCSOC{n}CTL", "") and not self._writes(f"{block}.ADCSOC{n}CTL")
            and f"ADCSOC{n}CTL" not in self._source.pointed
        ]  # fmt: skip
        why = ""
        if bare:
            why = f"SOC{bare[0]} is one of them, and no statement sets it up"
        elif (16 - first) % size and len(self._source.writes.get((block, "ADCSOCPRICTL"), ())) <= 1:
            why = f"{16 - first} are no multiple of {size}, so that each burst begins at another one"
        if why and place is not None:
            register = f"{block}.ADCBURSTCTL"
            self._chip.findings.report_at(
                place, "adc-burst", f"{register}: bursts of {size} go round through SOC{first} to SOC15: {why}",
                object=register, how="dynamic",
            )  # fmt: skip

    def _no_trigger(self, trigsel: int) -> tuple[str, MissingLink | None]:
        """The trigger that a TRIGSEL names, and why it never occurs; None if it can."""
        if trigsel in TIMERS:
            return f"CPU timer {trigsel - 1}", self._no_timer(trigsel - 1)
        epwm, b = divmod(trigsel - FIRST_SOCA, 2)
        if not 0 <= epwm < EPWM_COUNT:
            return "", None
        event = "SOCB" if b else "SOCA"
        return f"{event} of ePWM{epwm + 1}", self._no_event(epwm + 1, event)

    def _no_timer(self, n: int) -> MissingLink | None:
        """Why a CPU timer never ends; None if it can."""
        register = f"CpuTimer{n}Regs.TCR"
        if self._stuck(register, "TSS", lambda stopped: not stopped):
            return MissingLink(f"{register}.TSS = 1: it does not run", register, "TSS")
        return MissingLink(f"{register}.TIE = 0", register, "TIE") if self._stuck(register, "TIE", bool) else None

    def _no_event(self, n: int, event: str) -> MissingLink | None:
        """Why an ePWM never gives SOCA, SOCB or INT; None if it can."""
        name = f"EPwm{n}Regs"
        if self._writes(f"{name}.ETFRC"):
            return None
        if self._stuck(f"{name}.ETSEL", f"{event}EN", bool):
            return MissingLink(f"{name}.ETSEL.{event}EN = 0", f"{name}.ETSEL", f"{event}EN")
        scaled = self._value(f"{name}.ETPS", "INTPSSEL" if event == "INT" else "SOCPSSEL")
        if not scaled and self._stuck(f"{name}.ETPS", f"{event}PRD", bool):
            return MissingLink(f"{name}.ETPS.{event}PRD = 0: no event triggers it", f"{name}.ETPS", f"{event}PRD")
        # SOCxSEL = 0 is an event of the digital compare.  It needs no counter.
        by_counter = self._value(f"{name}.ETSEL", f"{event}SEL") or event == "INT"
        return self._no_count(n) or self._no_compare(n, event) if by_counter else None

    def _no_count(self, n: int) -> MissingLink | None:
        """Why the counter of an ePWM never counts; None if it can."""
        name, gate = f"EPwm{n}Regs", "CpuSysRegs.PCLKCR0"
        if self._stuck(gate, "TBCLKSYNC", bool):
            return MissingLink(f"{gate}.TBCLKSYNC = 0: no ePWM counter counts", gate, "TBCLKSYNC")
        if self._stuck(f"{name}.TBCTL", "CTRMODE", lambda mode: mode != STOPPED):
            return MissingLink(f"{name}.TBCTL.CTRMODE = 3: the counter stands still", f"{name}.TBCTL", "CTRMODE")
        if self._stuck(f"{name}.TBPRD", "", bool):
            return MissingLink(f"{name}.TBPRD = 0: the counter has no period", f"{name}.TBPRD")
        return None

    def _no_compare(self, n: int, event: str) -> MissingLink | None:
        """Why the counter never reaches the compare value of an event; None if it can."""
        name = f"EPwm{n}Regs"
        choice = self._value(f"{name}.ETSEL", f"{event}SEL")
        if choice not in COMPARES or self._value(f"{name}.ETSEL", f"{event}SELCMP"):
            return None
        if self._could(f"{name}.ETSEL", lambda other: other != choice, f"{event}SEL"):
            return None
        compare, wrong_way = COMPARES[choice]
        if self._stuck(f"{name}.TBCTL", "CTRMODE", lambda mode: mode not in (wrong_way, STOPPED)):
            way = "up" if wrong_way == UP else "down"
            why = f"{name}.ETSEL.{event}SEL = {choice} needs the other direction: the counter only counts {way}"
            return MissingLink(why, f"{name}.ETSEL", f"{event}SEL")
        return self._above(n, compare, 0)

    def _above(self, n: int, compare: str, beyond: int) -> MissingLink | None:
        """A compare value that is more than `beyond` above the period and that no statement could lower; else None."""
        name = f"EPwm{n}Regs"
        period = self._value(f"{name}.TBPRD", "")
        if not period or self._could(f"{name}.TBPRD", lambda other: other > period, ""):
            return None
        if not self._stuck(f"{name}.{compare}", compare, lambda value: value <= period + beyond):
            return None
        why = f"{name}.{compare} = {self._value(f'{name}.{compare}', compare)} is above TBPRD = {period}"
        return MissingLink(why, f"{name}.{compare}", compare)

    def _interrupts(self) -> None:
        """Check each enabled PIE line: can its source give an interrupt, and is there a routine for it?"""
        pie, chip = self._chip.pie, self._chip
        for group in range(1, 13):
            register = f"PieCtrlRegs.PIEIER{group}"
            if self._could(f"PieCtrlRegs.PIEIFR{group}", bool, ""):
                continue  # the firmware asks for interrupts itself
            for n in range(1, 17):
                field = f"INTx{n}"
                if not pie.enabled(group, n) or pie.left_by(group, n) is not None:
                    continue
                place = self._wanting(register, field) or self._enabled_by_create(group, n)
                if place is None:
                    continue
                if chip.vectors.routine(group, n) is None:
                    self._other_line(place, group, n)
                    continue
                missing = self._no_source(group, n) or self._closed(group, n)
                if missing:
                    self.silent.add(str(chip.vectors.routine(group, n)))
                    waits = f"interrupt {group}.{n} is enabled but never occurs"
                    self._report(place, waits, missing, f"{register}.{field}", whole=True)
            self._enabled_for_a_while(group)

    def _enabled_for_a_while(self, group: int) -> None:
        """Lines that PIEIER has let through and does not now, while no statement lets their group through IER."""
        pie, register = self._chip.pie, f"PieCtrlRegs.PIEIER{group}"
        place = self._source.last("PieCtrlRegs", f"PIEIER{group}")
        for n in range(1, 17) if self._never_let_through(group) else ():
            routine = self._chip.vectors.routine(group, n)
            if routine is not None and pie.kept_out(group, n) and pie.was_enabled(group, n):
                missing = MissingLink(f"bit {group - 1} of IER (M_INT{group}) is 0", register)
                waits = f"interrupt {group}.{n} is enabled at times, has come and never occurs"
                self._report(place, waits, missing, f"{register}.INTx{n}")

    def _never_let_through(self, line: int) -> bool:
        """Whether an interrupt waits at a line of the CPU that IER has never let through, and never will.

        A program that reads IFR asks for its interrupts itself.
        """
        cpu, bit = self._chip.cpu, 1 << line - 1
        if not cpu.ifr & bit or (cpu.ier | cpu.lines_taken) & bit or ("CPU", "IFR") in self._source.reads:
            return False
        return not self._source.could("CPU", "IER", bit, bool, again=self.started_up)

    def _enabled_by_create(self, group: int, n: int) -> Place | None:
        """The `Hwi_create` that enabled a line."""
        number = vector_id(group, n)
        for place, arguments in self._source.calls.get("Hwi_create", ()):
            if arguments and self._source.values(arguments[0]) == frozenset((number,)):
                return place
        return None

    def _other_line(self, place: Place, group: int, n: int) -> None:
        """A line without a routine is enabled.  Report it if a routine of the same group has a line that is not."""
        register = f"PieCtrlRegs.PIEIER{group}"
        for other in range(1, 17):
            routine = self._chip.vectors.routine(group, other)
            if routine is not None and self._stuck(register, f"INTx{other}", bool):
                message = (
                    f"{register}.INTx{n} lets interrupt {group}.{n} through, which has no routine; {routine} is that "
                    f"of interrupt {group}.{other}, and no statement sets INTx{other}"
                )  # fmt: skip
                self._chip.findings.report_at(
                    place, "not-connected", message, object=f"{register}.INTx{n}", how="dynamic"
                )
                return

    def _closed(self, group: int, n: int) -> MissingLink | None:
        """Why an interrupt that is pending is never taken; None if it is not pending, or can be taken."""
        if not self._chip.pie.waits(group, n):
            return None
        if self._stuck("PieCtrlRegs.PIECTRL", "ENPIE", bool):
            return MissingLink("PieCtrlRegs.PIECTRL.ENPIE = 0", f"PieCtrlRegs.PIEIER{group}", f"INTx{n}")
        bit = 1 << group - 1
        if self._chip.cpu.ier & bit or self._source.could("CPU", "IER", bit, bool, again=self.started_up):
            return None
        return MissingLink(f"bit {group - 1} of IER (M_INT{group}) is 0", f"PieCtrlRegs.PIEIER{group}", f"INTx{n}")

    def _kept_out(self) -> None:
        """Routines in the vector table whose interrupt has come, while no statement enables its line."""
        pie, vectors = self._chip.pie, self._chip.vectors
        for group in range(1, 13):
            register, flags = f"PieCtrlRegs.PIEIER{group}", f"PIEIFR{group}"
            if self._could(f"PieCtrlRegs.{flags}", bool, "") or ("PieCtrlRegs", flags) in self._source.reads:
                continue  # the firmware asks for interrupts itself
            told = any(f.object.startswith(f"{register}.") for f in self._chip.findings.of("not-connected"))
            for n in range(1, 17) if not told else ():
                entry, routine = vectors.entry(group, n), vectors.routine(group, n)
                place = self._source.last("PieVectTable", entry)
                if place is None or routine is None or not pie.kept_out(group, n) or pie.has_run(group, n):
                    continue
                if self._stuck(register, f"INTx{n}", bool):
                    message = (
                        f"{routine} never runs for interrupt {group}.{n}, which has come: "
                        f"no statement sets {register}.INTx{n}"
                    )
                    self._chip.findings.report_at(
                        place, "not-connected", message, object=f"PieVectTable.{entry}", how="dynamic"
                    )

    def _always_masked(self) -> None:
        """Interrupts that wait in IFR and are enabled in IER, in a program that never sets INTM to 0."""
        cpu, vectors = self._chip.cpu, self._chip.vectors
        waiting = cpu.ifr & cpu.ier
        if not self.started_up or not cpu.intm or not waiting or self._calls(*LET_THROUGH):
            return
        if ("CPU", "IFR") in self._source.reads:
            return  # it asks for them itself
        routines = [vectors.cpu_routine(line) for line in (13, 14) if waiting & 1 << line - 1]
        for group in (group for group in range(1, 13) if waiting & 1 << group - 1):
            routines += [vectors.routine(group, n) for n in range(1, 17) if self._chip.pie.enabled(group, n)]
        named = [routine for routine in routines if routine is not None]
        place = self._source.giving("CPU", "IER", waiting, cpu.ier)
        if named and place is not None:
            message = (
                f"INTM is 1 since the reset or the last DINT, and no statement executes EINT: {' and '.join(named)} "
                f"never run{'s' if len(named) == 1 else ''}, though the interrupt has come and IER lets it through"
            )  # fmt: skip
            self._chip.findings.report_at(place, "not-connected", message, object="INTM", how="dynamic")

    def _no_source(self, group: int, n: int) -> MissingLink | None:
        """Why the source of a PIE interrupt never gives one; None if it can, or if this is not known."""
        for letter, lines in ADC_PIE.items():
            if (group, n) in lines:
                return self._no_conversion(letter, lines.index((group, n)) + 1)
        for number, line in XINT_PIE.items():
            if (group, n) == line:
                return self._no_edge(number)
        for letter, lines in SCI_PIE.items():
            if (group, n) in lines:
                receive = (group, n) == lines[0]
                return self._no_character(letter, receive=receive) or (self._no_level(letter) if receive else None)
        for letter, lines in I2C_PIE.items():
            if (group, n) == lines[0] and self._stuck(f"I2c{letter.lower()}Regs.I2CIER", "", bool):
                register = f"I2c{letter.lower()}Regs.I2CIER"
                return MissingLink(f"{register} = 0", register)
        for letter, lines in SPI_PIE.items():
            if (group, n) in lines:
                return self._no_word(letter, receive=(group, n) == lines[0])
        for letter, lines in CAN_PIE.items():
            if (group, n) in lines:
                return self._no_can_line(letter, lines.index((group, n)))
        if (group, n) == (1, 7):
            return self._no_timer(0)
        if group == 4 and n <= ECAP_COUNT:
            return self._no_capture(n)
        if group == 5 and n <= EQEP_COUNT:
            return self._no_unit(n)
        if group == 7 and n <= DMA_CHANNELS:
            mode = f"DmaRegs.CH{n}.MODE"
            silent = self._stuck(mode, "CHINTE", bool)
            return MissingLink(f"{mode}.CHINTE = 0", mode, "CHINTE") if silent else self._no_transfer(n)
        return self._no_event(n, "INT") if group == 3 and n <= EPWM_COUNT else None

    def _no_conversion(self, letter: str, k: int) -> MissingLink | None:
        """Why an ADC never gives ADCINTk; None if it can."""
        register = f"Adc{letter.lower()}Regs." + ("ADCINTSEL1N2" if k < 3 else "ADCINTSEL3N4")
        if self._stuck(register, f"INT{k}E", bool):
            return MissingLink(f"{register}.INT{k}E = 0", register, f"INT{k}E")
        select = f"INT{k}SEL"
        if self._stuck(register, select, lambda soc: self._could_start(letter, soc)):
            soc = self._value(register, select)
            why = f"{register}.{select} = {soc}: SOC{soc} of ADC-{letter} has no trigger, and nothing else starts it"
            return MissingLink(why, register, select)
        return None

    def _could_start(self, letter: str, soc: int) -> bool:
        """Whether a SOC has a trigger, or a statement could give it one or start it: by itself, or in a burst."""
        block = f"Adc{letter.lower()}Regs"
        triggers = (
            (f"ADCSOC{soc}CTL", "TRIGSEL"), (f"ADCINTSOCSEL{soc // 8 + 1}", f"SOC{soc}"), ("ADCBURSTCTL", "BURSTEN"),
        )  # fmt: skip
        forced = self._could(f"{block}.ADCSOCFRC1", bool, f"SOC{soc}")
        return forced or any(not self._stuck(f"{block}.{name}", field, bool) for name, field in triggers)

    def _no_can_line(self, letter: str, line: int) -> MissingLink | None:
        """Why a CAN never gives an interrupt on its line 0 or 1; None if it can."""
        block = f"Can{letter.lower()}Regs"
        control, enable = f"{block}.CAN_CTL", f"{block}.CAN_GLB_INT_EN"
        if self._stuck(control, f"IE{line}", bool):
            return MissingLink(f"{control}.IE{line} = 0", control, f"IE{line}")
        if self._stuck(enable, f"GLBINT{line}_EN", bool):
            why = f"{enable}.GLBINT{line}_EN = 0"
            # Without any write to it, its place is that of the other enable.
            return MissingLink(why, enable) if self._writes(enable) else MissingLink(why, control, f"IE{line}")
        return None

    def _no_character(self, letter: str, *, receive: bool) -> MissingLink | None:
        """Why a SCI never gives the interrupt of one direction; None if it can."""
        block, way = f"Sci{letter.lower()}Regs", "RX" if receive else "TX"
        if self._stuck(f"{block}.SCIFFTX", "SCIFFENA", bool):
            enable = "RXBKINTENA" if receive else "TXINTENA"
            errors = receive and not self._stuck(f"{block}.SCICTL1", "RXERRINTENA", bool)
            if not errors and self._stuck(f"{block}.SCICTL2", enable, bool):
                return MissingLink(f"{block}.SCICTL2.{enable} = 0", f"{block}.SCICTL2", enable)
        elif self._value(f"{block}.SCIFFTX", "SCIFFENA") and self._stuck(f"{block}.SCIFF{way}", f"{way}FFIENA", bool):
            return MissingLink(f"{block}.SCIFF{way}.{way}FFIENA = 0", f"{block}.SCIFF{way}", f"{way}FFIENA")
        return None

    def _no_level(self, letter: str) -> MissingLink | None:
        """Why the receive FIFO of a SCI never gives an interrupt; None if it can."""
        register = f"Sci{letter.lower()}Regs.SCIFFRX"
        if not self._value(f"Sci{letter.lower()}Regs.SCIFFTX", "SCIFFENA"):
            return None
        if self._stuck(register, "RXFFIL", lambda level: level <= FIFO_DEPTH):
            level = self._value(register, "RXFFIL")
            return MissingLink(f"{register}.RXFFIL = {level}: the FIFO holds {FIFO_DEPTH}", register, "RXFFIL")
        return None

    def _no_word(self, letter: str, *, receive: bool) -> MissingLink | None:
        """Why a SPI never gives the interrupt of one direction; None if it can."""
        block, way = f"Spi{letter.lower()}Regs", "RX" if receive else "TX"
        register, enable = f"{block}.SPIFF{way}", f"{way}FFIENA"
        if self._stuck(f"{block}.SPIFFTX", "SPIFFENA", bool):
            if not receive:
                return MissingLink(
                    f"{block}.SPIFFTX.SPIFFENA = 0: without FIFO all interrupts are those of the RX line",
                    f"{block}.SPIFFTX", "SPIFFENA",
                )  # fmt: skip
            stuck = self._stuck(f"{block}.SPICTL", "SPIINTENA", bool)
            return MissingLink(f"{block}.SPICTL.SPIINTENA = 0", f"{block}.SPICTL", "SPIINTENA") if stuck else None
        if self._value(f"{block}.SPIFFTX", "SPIFFENA") and self._stuck(register, enable, bool):
            overrun = receive and not self._stuck(f"{block}.SPICTL", "OVERRUNINTENA", bool)
            return None if overrun else MissingLink(f"{register}.{enable} = 0", register, enable)
        return None

    def _no_transfer(self, n: int) -> MissingLink | None:
        """Why a channel of the DMA never transfers; None if it can."""
        mode, control, select = f"DmaRegs.CH{n}.MODE", f"DmaRegs.CH{n}.CONTROL", f"DMACHSRCSEL{1 + (n - 1) // 4}"
        running = self._value(control, "RUNSTS")
        if not running and not self._could(control, bool, "RUN"):
            return MissingLink(f"{control}.RUN is never set: the channel was never started", mode)
        if self._could(control, bool, "PERINTFRC"):
            return None
        if self._stuck(mode, "PERINTE", bool):
            return MissingLink(f"{mode}.PERINTE = 0: it listens to no trigger", mode, "PERINTE")
        source = self._value(listens := f"DmaClaSrcSelRegs.{select}", f"CH{n}")
        for letter, first in DMA_ADC.items():
            if first <= source < first + 4:
                missing = self._no_conversion(letter, source - first + 1)
                why = f"it listens to ADC{letter}INT{source - first + 1}"
                return MissingLink(f"{why}: {missing.why}", listens, f"CH{n}") if missing else None
        for trigsel, number in DMA_TRIGSEL.items():
            if number == source:
                trigger, missing = self._no_trigger(trigsel)
                return MissingLink(f"it listens to {trigger}: {missing.why}", listens, f"CH{n}") if missing else None
        return None

    def _waits_for_ever(self) -> bool:
        """Whether the run reached an endless wait (`endless-poll`)."""
        return bool(self._chip.findings.of("endless-poll"))

    def _no_capture(self, n: int) -> MissingLink | None:
        """Why an eCAP gives no interrupt; None if it can."""
        name = f"ECap{n}Regs"
        first, second, events = f"{name}.ECCTL1", f"{name}.ECCTL2", f"{name}.ECEINT"
        if self._writes(f"{name}.ECFRC") or self._value(second, "CAP_APWM") or self._could(second, bool, "CAP_APWM"):
            return None
        if self._stuck(events, "", bool):
            return MissingLink(f"{events} = 0", events)
        only = [k for k in range(1, 5) if self._value(events, f"CEVT{k}")]
        if self._value(events, "") != sum(1 << k for k in only) or self._source.could(name, "ECEINT", 0xE0, bool):
            return None
        last = self._value(second, "STOP_WRAP") + 1
        if only and min(only) > last and not self._could(second, lambda wrap: wrap + 1 >= min(only), "STOP_WRAP"):
            why = f"{second}.STOP_WRAP = {last - 1}: event {last} is the last, CEVT{min(only)} is enabled"
            return MissingLink(why, second, "STOP_WRAP")
        return self._no_input(ECAP_INPUT[n], first)

    def _no_input(self, number: int, user: str) -> MissingLink | None:
        """Why an input of the X-BAR has no edges for its user, an eCAP or external interrupt; None if it can have some.

        `user` is a register that sets up this eCAP or external interrupt.
        """
        select = f"InputXbarRegs.INPUT{number}SELECT"
        if self._value(select, "") or self._writes(select):
            return None
        why = f"{select} was never set, so its input is GPIO0"
        if not self._chip.pins[0].drivers():
            return MissingLink(f"{why}, which nothing drives", user)
        for other, name in self._single_users():
            instead = f"InputXbarRegs.INPUT{other}SELECT"
            if self._writes(instead) and self._source.last(*_split(name)) is None:
                return MissingLink(f"{why}; {instead} was set, and nothing uses that input", instead)
        return None

    def _single_users(self) -> Iterator[tuple[int, str]]:
        """Inputs of the X-BAR that have one user, and the registers of that user (TRM, input X-BAR destinations)."""
        yield from ((number, f"ECap{n}Regs") for n, number in ECAP_INPUT.items())
        yield from ((number, f"XintRegs.XINT{n}CR") for n, number in XINT_INPUT.items() if number > 6)

    def _captures(self) -> None:
        """Captures that are read and never loaded, and one-shot captures that are never armed again."""
        for n in range(1, ECAP_COUNT + 1):
            name = f"ECap{n}Regs"
            first, second = f"{name}.ECCTL1", f"{name}.ECCTL2"
            reads = [place for k in range(1, 5) for place in self._source.reads.get((name, f"CAP{k}"), ())]
            if not reads or not self._source.last(name) or self._could(second, bool, "CAP_APWM"):
                continue
            missing = None
            if self._stuck(second, "TSCTRSTOP", bool):
                missing = MissingLink(f"{second}.TSCTRSTOP = 0: its counter stands still", second, "TSCTRSTOP")
            elif self._stuck(first, "CAPLDEN", bool):
                missing = MissingLink(f"{first}.CAPLDEN = 0: no edge loads it", first, "CAPLDEN")
            elif self._chip.pins[0].drivers():
                missing = self._no_input(ECAP_INPUT[n], first)
                if missing:
                    self._report(reads[0], f"eCAP{n} measures another signal", missing, first)
                    continue
            if missing:
                self._report(reads[0], f"a capture of eCAP{n} is read, and is always 0", missing, f"{name}.CAP1")
            elif self._value(second, "CONT_ONESHT") and self._chip.ecap[n].stopped:
                cleared = self._chip.ecap[n].cleared_in_vain
                goes_on = self._writes_again(second, bool, "REARM") or self._writes_again(
                    second, lambda one_shot: not one_shot, "CONT_ONESHT"
                )
                if self._waits_for_ever():
                    waits = "the program waits for ever"
                elif cleared >= MIN_EDGES and not goes_on:
                    waits = f"its flags were cleared {cleared} times since, for a capture that never comes"
                else:
                    continue
                last = self._value(second, "STOP_WRAP") + 1
                missing = MissingLink(f"{second}.REARM is not set again", second, "CONT_ONESHT")
                message = f"the one shot of eCAP{n} stopped after event {last}, and {waits}"
                self._report(reads[0], message, missing, second)

    def _channels(self) -> None:
        """DMA channels that stopped after a transfer and are not started again.

        They are reported if the program waits for ever, or gives them the addresses of the next transfer.
        """
        for n in range(1, DMA_CHANNELS + 1):
            mode, control = f"DmaRegs.CH{n}.MODE", f"DmaRegs.CH{n}.CONTROL"
            if self._value(control, "RUNSTS") or not self._could(control, bool, "RUN"):
                continue
            if self._source.last(*_split(mode)) is None or not self._stuck(mode, "CONTINUOUS", bool):
                continue
            place = self._wanting(mode, "CONTINUOUS")
            why = f"{mode}.CONTINUOUS = 0, and no statement sets {control}.RUN again"
            missing = MissingLink(why, mode, "CONTINUOUS")
            addresses = [f"DmaRegs.CH{n}.{side}_ADDR_SHADOW" for side in ("SRC", "DST")]
            given = next((a for a in addresses if self._writes_again(a, lambda _address: True, "")), None)
            if given and self.started_up and not self._writes_again(control, bool, "RUN"):
                message = f"channel {n} of the DMA stopped, is given the next addresses, and is not started"
                self._report(self._source.last(*_split(given)), message, missing, mode)
            elif place is not None and self._waits_for_ever():
                message = f"channel {n} of the DMA stopped after a transfer, and the program waits for ever"
                self._report(place, message, missing, mode)

    def _sections(self) -> None:
        """DMA buffers without a `#pragma DATA_SECTION`, in a program that places another DMA buffer with one."""
        placed = {f"{m.name}.{name}" for m in self._linked.program.modules.values() for name in m.placed}
        used = self._chip.dma.objects
        for name, cause in used.items() if placed & used.keys() else ():
            path = self._chip.findings.path(cause.at, cause.calls) if cause is not None else ()
            if name not in placed and path:
                other = min(placed & used.keys())
                self._chip.findings.report_at(
                    path[0], "dma-section",
                    f"the DMA uses {name}, which no #pragma DATA_SECTION places, as one does with {other}",
                    object=name, how="dynamic", call_path=path,
                )  # fmt: skip

    def _groups(self) -> None:
        """PIE groups that wait for an acknowledge which no statement gives."""
        for group in range(1, 13):
            if not self._source.could("PieCtrlRegs", "PIEACK", 1 << group - 1, bool):
                for n in range(1, 17):
                    if self._chip.pie.is_blocked(group, n):  # it reports the finding
                        return

    def _qualifiers(self) -> None:
        """Inputs whose qualification loses at least a quarter of the edges, though the chip itself drives them."""
        inputs = {
            f"XintRegs.XINT{n}CR": number for n, number in XINT_INPUT.items()
            if self._wanting(f"XintRegs.XINT{n}CR", "ENABLE")
        }  # fmt: skip
        inputs |= {f"ECap{n}Regs": ECAP_INPUT[n] for n in ECAP_INPUT if self._source.last(f"ECap{n}Regs")}
        for user, number in inputs.items():
            pin = self._value(f"InputXbarRegs.INPUT{number}SELECT", "")
            qualifier = self._chip.gpio.qualifier(pin)
            if qualifier is None or not self._chip.pins[pin].drivers():
                continue
            lost = qualifier.edges - qualifier.passed
            if qualifier.edges < MIN_EDGES or lost < qualifier.edges // 4:
                continue
            block, name = _split(user) if "." in user else (user, "")
            place = self._qualified(pin) or self._source.last(block, name)
            window_us = qualifier.window_cycles() / CYCLES_PER_US
            if place is not None:
                self._chip.findings.report_at(
                    place, "not-connected",
                    f"{user} waits for GPIO{pin}, which the chip itself drives: {lost} of {qualifier.edges} edges were "
                    f"lost, because its qualification needs {qualifier.samples} equal samples, {window_us:.3g} us",
                    object=f"GPIO{pin}", how="dynamic",
                )  # fmt: skip

    def _qualified(self, pin: int) -> Place | None:
        """The statement that sets the qualification of a pin."""
        for place, arguments in self._source.calls.get("GPIO_SetupPinOptions", ()):
            if arguments and self._source.values(arguments[0]) == frozenset((pin,)):
                return place
        port = PORTS[pin // 32]
        return self._source.last("GpioCtrlRegs", f"GP{port}QSEL{pin % 32 // 16 + 1}")

    def _no_unit(self, n: int) -> MissingLink | None:
        """Why an eQEP gives no interrupt; None if it can."""
        name = f"EQep{n}Regs"
        if self._writes(f"{name}.QFRC"):
            return None
        enabled = f"{name}.QEINT"
        if self._stuck(enabled, "", bool):
            return MissingLink(f"{enabled} = 0", enabled)
        if self._stuck(f"{name}.QEPCTL", "QPEN", bool):
            return MissingLink(f"{name}.QEPCTL.QPEN = 0: the module is held in reset", f"{name}.QEPCTL", "QPEN")
        only_units = not self._could(enabled, lambda word: bool(word & ~QEINT.UTO.mask), "")
        if not only_units or self._value(enabled, "") != QEINT.UTO.mask:
            return None
        if self._stuck(f"{name}.QEPCTL", "UTE", bool):
            return MissingLink(f"{name}.QEPCTL.UTE = 0: the unit timer does not run", f"{name}.QEPCTL", "UTE")
        if self._stuck(f"{name}.QUPRD", "", bool):
            return MissingLink(f"{name}.QUPRD = 0: the unit timer never ends", f"{name}.QEPCTL", "UTE")
        return None

    def _latches(self) -> None:
        """Reads of the position latch QPOSLAT, where nothing loads the latch."""
        for n in range(1, EQEP_COUNT + 1):
            name = f"EQep{n}Regs"
            read = self._source.reads.get((name, "QPOSLAT"))
            told = any(finding.object == f"{name}.QEPCTL.UTE" for finding in self._chip.findings)
            if read and not told and self._value(f"{name}.QEPCTL", "QPEN") and self._stuck(
                f"{name}.QEPCTL", "UTE", bool
            ):  # fmt: skip
                missing = MissingLink(
                    f"{name}.QEPCTL.UTE = 0: the unit timer that latches it does not run", f"{name}.QEPCTL", "UTE"
                )
                self._report(read[-1], f"{name}.QPOSLAT is read and never loaded", missing, f"{name}.QPOSLAT")
            elif read and self._value(f"{name}.QEPCTL", "UTE") and self._stuck(f"{name}.QEPCTL", "QCLM", bool):
                why = f"{name}.QEPCTL.QCLM = 0: the unit timer latches nothing, reading QPOSCNT does"
                if (name, "QPOSCNT") not in self._source.reads:
                    missing = MissingLink(why, f"{name}.QEPCTL", "QCLM")
                    self._report(read[-1], f"{name}.QPOSLAT is read and never loaded", missing, f"{name}.QPOSLAT")

    def _no_edge(self, number: int) -> MissingLink | None:
        """Why an external interrupt has no edges; None if it can have some."""
        register = f"XintRegs.XINT{number}CR"
        if self._stuck(register, "ENABLE", bool):
            return MissingLink(f"{register}.ENABLE = 0", register, "ENABLE")
        return self._no_input(XINT_INPUT[number], register)

    def _time_bases(self) -> None:
        """CPU timers of which the program reads the time, and which stand."""
        for n, timer in enumerate(self._chip.timers):
            name, reader = f"CpuTimer{n}Regs", timer.read_in_vain
            path = self._chip.findings.path(reader.at, reader.calls) if reader is not None else ()
            if path and self._stuck(f"{name}.TCR", "TSS", not_):
                missing = MissingLink(f"{name}.TCR.TSS = 1: it does not count", f"{name}.TCR", "TSS")
                self._report(path[0], f"{path[0].function} reads {name}.TIM again and again", missing, name)

    def _cpu_timers(self) -> None:
        """Routines of CPU timers 1 and 2, whose interrupts go to the CPU directly."""
        for n in (1, 2):
            vector, name = 12 + n, f"CpuTimer{n}Regs"
            routine = self._chip.vectors.cpu_routine(vector)
            place = self._source.last(name, "TCR")
            if routine is None or place is None or self._chip.vectors.stands_for_all(vector):
                continue  # driverlib enters its default handler in every vector, and measures its clock with timer 2
            bit = 1 << vector - 1
            wanted = bool(self._value(f"{name}.TCR", "TIE"))
            runs = wanted and not self._value(f"{name}.TCR", "TSS")
            enabled = bool(self._chip.cpu.ier & bit)
            # A timer that the program has stopped by now may have asked before.
            if self._never_let_through(vector) or (
                runs and not enabled and not self._source.could("CPU", "IER", bit, bool)
            ):  # fmt: skip
                self.silent.add(routine)
                # Report it where IER is set, because the statement that sets up the timer is right.
                ier = self._source.last("CPU", "IER")
                does = "runs" if runs else "has run out"
                self._chip.findings.report_at(
                    ier or place, "not-connected",
                    f"{routine} waits for CPU timer {n}, which {does}: bit {vector - 1} of IER (M_INT{vector}) is 0",
                    object=name, how="dynamic", details=(f"wanted by {place}",) if ier else (),
                )  # fmt: skip
            elif self._chip.cpu.lines_taken & bit:
                pass  # the program has stopped it after its last interrupt
            elif enabled and wanted and self._stuck(f"{name}.TCR", "TSS", not_):
                self.silent.add(routine)
                missing = MissingLink(f"{name}.TCR.TSS = 1: it does not run", f"{name}.TCR", "TSS")
                self._report(place, f"{routine} waits for CPU timer {n}, which is stopped", missing, name)

    def _watchdog_off(self) -> None:
        """A watchdog that the program sets up with WDDIS = 1 and services, though the start-up has switched it off."""
        dog, findings = self._chip.watchdog, self._chip.findings
        if dog.left_off is None or dog.serviced_off < MIN_SERVICES:
            return
        if any(
            cause is None or not any(_starts_up(place) for place in findings.path(cause.at, cause.calls))
            for cause in dog.switched_on.values()
        ):
            return
        again = any(map(self._source.called_later, SERVICES_WATCHDOG)) or self._source.later("WdRegs", "WDKEY")
        if not again or self._could_enable_watchdog() or self._switches_watchdog_off():
            return
        # A statement of the program's own: TI's functions write WDCR by themselves.
        path = findings.path(dog.left_off.at, dog.left_off.calls)
        own = {write.place[:2] for write in self._source.writes.get(("WdRegs", "WDCR"), ())}
        at = next((n for n, place in enumerate(path) if place[:2] in own), None)
        if at is None or any(_starts_up(place) or OFF.search(place.function) for place in path):
            return
        if not _meant_off(path[at]):
            findings.report_at(
                path[at], "not-connected", f"the watchdog is off during the whole run (WdRegs.WDCR.WDDIS = 1), and the "
                f"program has serviced it {dog.serviced_off} times since: it never resets the device",
                object="WdRegs.WDCR.WDDIS", how="dynamic",
            )  # fmt: skip

    def _could_enable_watchdog(self) -> bool:
        """Whether some statement could switch the watchdog on.  Without WDCHK a write only resets the device."""
        source, register = self._source, ("WdRegs", "WDCR")
        start_up = {place for name in STARTS_UP for place, _ in source.calls.get(name, ())}
        return any(
            write.mask & WDDIS and (
                write.values is None or any(value & (WDCHK | WDDIS) == WDCHK for value in write.values)
            )
            for write in (
                *source.writes.get(register, ()), *source.pointed.get("WDCR", ()),
                *source.from_here_on.get(register, ()), *source.anywhere,
            )
            if write.place not in start_up and not _starts_up(write.place) and write.place.function not in SWITCHES_OFF
        )  # fmt: skip

    def _switches_watchdog_off(self) -> bool:
        """Whether the program calls a function of TI's that switches the watchdog off, beyond the start-up."""
        places = (place for name in SWITCHES_OFF for place, _ in self._source.calls.get(name, ()))
        return any(not _starts_up(place) for place in places)

    def _trips(self) -> None:
        """Check the path from a comparator through the X-BAR and the digital compare of an ePWM to its trip zone."""
        for n in range(1, EPWM_COUNT + 1):
            name = f"EPwm{n}Regs"
            for signal in ("DCAH", "DCAL", "DCBH", "DCBL"):
                place = self._wanting(f"{name}.DCTRIPSEL", f"{signal}COMPSEL")
                if place is not None:
                    number = self._value(f"{name}.DCTRIPSEL", f"{signal}COMPSEL") + 1
                    missing = self._no_trip_input(number) if number in XBAR_TRIP_OUTPUTS else None
                    if missing:
                        self._report(
                            place, f"{name}.DCTRIPSEL.{signal}COMPSEL waits for TRIPIN{number}, which never occurs",
                            missing, f"{name}.DCTRIPSEL.{signal}COMPSEL",
                        )  # fmt: skip
            for event in ("DCAEVT1", "DCAEVT2", "DCBEVT1", "DCBEVT2"):
                self._trip_event(name, event)
            for number in TRIP_INPUTS:
                self._trip_input(name, number)

    def _trip_input(self, name: str, number: int) -> None:
        """Report a trip zone TZ1 to TZ3 whose input is still GPIO0, which this chip drives itself."""
        select, signal = f"InputXbarRegs.INPUT{number}SELECT", self._chip.signal_of(0)
        enabled = [field for field in (f"OSHT{number}", f"CBC{number}") if self._value(f"{name}.TZSEL", field)]
        if not enabled or self._value(select, "") or self._writes(select) or not signal.startswith("EPWM"):
            return
        why, register = f"{select} was never set, so its input is GPIO0, the output of {signal}", f"{name}.TZSEL"
        for other in TRIP_INPUTS:
            instead = f"InputXbarRegs.INPUT{other}SELECT"
            users = (f"EPwm{n}Regs.TZSEL" for n in range(1, EPWM_COUNT + 1))
            if self._writes(instead) and not any(self._value(user, f"OSHT{other}") or self._value(user, f"CBC{other}")
                                                 for user in users):  # fmt: skip
                why, register = f"{why}; {instead} was set, and no trip zone uses that input", instead
        self._report(
            self._wanting(f"{name}.TZSEL", enabled[0]), f"TZ{number} trips {name} at what it does itself",
            MissingLink(why, register), f"{name}.TZSEL.{enabled[0]}",
        )  # fmt: skip

    def _no_trip_input(self, number: int) -> MissingLink | None:
        """Why a TRIP of the ePWM X-BAR is never high; None if it can be."""
        enable = f"EPwmXbarRegs.TRIP{number}MUXENABLE"
        if self._could("EPwmXbarRegs.TRIPOUTINV", bool, ""):
            return None
        if self._stuck(enable, "", bool):
            return MissingLink(f"{enable} = 0: no mux of it is enabled", enable)
        reasons = []
        for mux in range(32):
            if not self._value(enable, f"MUX{mux}"):
                if self._could(enable, bool, f"MUX{mux}"):
                    return None
                continue
            half = "0TO15" if mux < 16 else "16TO31"
            choice = self._value(f"EPwmXbarRegs.TRIP{number}MUX{half}CFG", f"MUX{mux}")
            for source in choices("CTRIP")[mux][choice]:
                missing = self._no_comparator(int(source[5]), source[-1], enable) if "CTRIP" in source else None
                if missing is None:
                    return None
                reasons.append(missing)
        return reasons[0] if reasons else None

    def _no_comparator(self, k: int, which: str, enable: str) -> MissingLink | None:
        """Why CTRIPH or CTRIPL of a comparator is never high; None if it can be."""
        name = f"Cmpss{k}Regs"
        if self._stuck(f"{name}.COMPCTL", "COMPDACE", bool):
            used = self._source.last(name) is not None
            return MissingLink(
                f"comparator {k} is off, {name}.COMPCTL.COMPDACE = 0", f"{name}.COMPCTL" if used else enable,
            )  # fmt: skip
        control = f"{name}.CTRIP{which}FILCTL"
        window, threshold = self._value(control, "SAMPWIN"), self._value(control, "THRESH")
        filtered = self._value(f"{name}.COMPCTL", f"CTRIP{which}SEL") == FILTERED
        if filtered and threshold > window and not self._could(control, lambda other: other <= window, "THRESH"):
            why = f"{control}.THRESH = {threshold} needs {threshold + 1} samples, but the window has {window + 1}"
            return MissingLink(why, control, "THRESH")
        return None

    def _trip_event(self, name: str, event: str) -> None:
        """Report an event of the digital compare that is used and never generated, or generated and not used."""
        number = event[-1]
        control = f"{name}.DC{event[2]}CTL"
        condition = f"{name}.TZDCSEL"
        users = [(f"{name}.TZSEL", event), (f"{name}.TZEINT", event)]
        if number == "1":
            users += [(control, "EVT1SOCE"), (control, "EVT1SYNCE")]
        asking = [self._wanting(register, field) for register, field in users if self._value(register, field)]
        asked = next(iter(asking), None)
        if asked is not None:
            if self._stuck(condition, event, bool):
                missing = MissingLink(f"{condition}.{event} = 0 names no condition for it", condition, event)
                message = f"the program waits for {event} of {name}, which never occurs"
                self._report(asked, message, missing, f"{condition}.{event}")
            return
        made = self._wanting(condition, event) if self._value(condition, event) else None
        polled = not {(name, "TZFLG", event), (name, "TZFLG", "")}.isdisjoint(self._source.read_fields)
        acted = self._could(f"{name}.TZCTL", lambda action: True, event) or self._acts_elsewhere(name)
        if made is None or polled or acted or any(self._could(register, bool, field) for register, field in users):
            return
        missing = MissingLink(f"{name}.TZSEL.{event} = 0, and no statement uses it", f"{name}.TZSEL", event)
        self._report(made, f"{event} of {name} is generated but trips nothing", missing, f"{name}.TZSEL.{event}")

    def _trip_actions(self) -> None:
        """Trips that put an output into high impedance, because no statement sets what the output does at a trip."""
        for n in range(1, EPWM_COUNT + 1):
            name = f"EPwm{n}Regs"
            select = f"{name}.TZSEL"
            place = self._source.last(name, "TZSEL")
            if place is None or not self._value(select, ""):
                continue
            if self._acts_elsewhere(name):
                continue
            control = self._source.writes.get((name, "TZCTL"), []) + self._source.pointed.get("TZCTL", [])
            for x in "AB":
                mask = self._mask(f"{name}.TZCTL", f"TZ{x}")
                if self._writes(f"{name}.AQCTL{x}") and not any(write.mask & mask for write in control):
                    self._chip.findings.report_at(
                        place, "trip-open",
                        f"{select} trips output {x}, and no statement sets {name}.TZCTL.TZ{x}: 0 is high impedance",
                        object=f"{name}.TZCTL.TZ{x}", how="dynamic",
                    )  # fmt: skip

    def _trips_at_once(self) -> None:
        """Trips that came when TZSEL chose an input that was still low, and that nothing ends."""
        for n in range(1, EPWM_COUNT + 1):
            name = f"EPwm{n}Regs"
            outputs = [x for x in "AB" if self._writes(f"{name}.AQCTL{x}")]
            if not outputs or self._writes_again(f"{name}.TZCLR", bool, "OST"):
                continue
            for k in self._chip.epwm[n].tripped_for_ever():
                register, field = f"{name}.TZSEL", f"OSHT{k}"
                why = f"TZ{k} was low when {register} chose it: choose its pin before, or clear TZFLG.OST then"
                message = f"{name} is tripped from its set-up on, and no statement ends that"
                self._report(self._wanting(register, field), message, MissingLink(why, register, field), register)

    def _dead_bands(self) -> None:
        """Delays of a dead band that is bypassed."""
        for n in range(1, EPWM_COUNT + 1):
            name, control = f"EPwm{n}Regs", f"EPwm{n}Regs.DBCTL"
            delays = [delay for delay in ("DBRED", "DBFED") if self._value(f"{name}.{delay}", delay)]
            place = self._source.last(name, delays[-1]) if delays else None
            if place is not None and self._stuck(control, "OUT_MODE", bool):
                missing = MissingLink(f"{control}.OUT_MODE = 0: the dead band is bypassed", control, "OUT_MODE")
                self._report(place, f"the delays of {name} are set, but no edge is delayed", missing, control)

    def _forced_trips(self) -> None:
        """Trips that the program forces and that change no output."""
        for n in range(1, EPWM_COUNT + 1):
            name = f"EPwm{n}Regs"
            force, control = self._source.last(name, "TZFRC"), f"{name}.TZCTL"
            outputs = [x for x in "AB" if self._writes(f"{name}.AQCTL{x}")]
            if force is None or not outputs or not self._sets_trip(name, "TZFRC"):
                continue
            if self._sets_trip(name, "TZEINT") or self._acts_elsewhere(name):
                continue
            if all(self._stuck(control, f"TZ{x}", lambda action: action != NO_CHANGE) for x in outputs):
                missing = MissingLink(f"{control}.TZ{outputs[0]} = 3: no change", control, f"TZ{outputs[0]}")
                self._report(force, f"{name}.TZFRC trips the outputs, which go on switching", missing, control)

    def _sets_trip(self, name: str, register: str) -> bool:
        """Whether the program can set the bit OST or CBC of a trip register of a module."""
        return any(self._could(f"{name}.{register}", bool, kind) for kind in ("OST", "CBC"))

    def _acts_elsewhere(self, name: str) -> bool:
        """Whether the program writes what a trip does by the counter's direction, which TZCTL does not say."""
        return any(self._writes(f"{name}.{other}") for other in ("TZCTL2", "TZCTLDCA", "TZCTLDCB"))

    def _post_processing(self) -> None:
        """Check the interrupting events of ADC post-processing blocks: does their SOC convert, is the event cleared?"""
        for letter in ADC_PIE:
            block = f"Adc{letter.lower()}Regs"
            for event in (f"PPB{k}{kind}" for k in range(1, 5) for kind in ("TRIPHI", "TRIPLO", "ZERO")):
                place = self._wanting(f"{block}.ADCEVTINTSEL", event)
                if place is None or not self._value(f"{block}.ADCEVTINTSEL", event):
                    continue
                config = f"{block}.ADCPPB{event[3]}CONFIG"
                soc = self._value(config, "CONFIG")
                routine = self._chip.pie.left_by(*ADCEVT_PIE[letter])
                flag = f"{block}.ADCEVTSTAT.{event}"
                if self._never_starts(block, soc):
                    missing = MissingLink(f"{config}.CONFIG = {soc}: nothing starts SOC{soc}", config, "CONFIG")
                    self._report(place, f"event {event} of {block} interrupts, and never comes", missing, config)
                elif routine and self._value(f"{block}.ADCEVTSTAT", event) and not self._writes_again(
                    f"{block}.ADCEVTCLR", bool, event
                ):  # fmt: skip
                    self._chip.findings.report_at(
                        routine, "flag-not-cleared",
                        f"{flag} is set, and no statement sets ADCEVTCLR.{event}: its interrupt comes once only",
                        object=flag, how="dynamic", task=self._chip.cpu.routine_at(routine),
                    )  # fmt: skip

    def _never_starts(self, block: str, soc: int) -> bool:
        """Whether nothing can start a SOC: no trigger, no ADCINT, no burst, no statement."""
        return (
            self._stuck(f"{block}.ADCSOC{soc}CTL", "TRIGSEL", bool)
            and self._stuck(f"{block}.ADCINTSOCSEL{soc // 8 + 1}", f"SOC{soc}", bool)
            and self._stuck(f"{block}.ADCBURSTCTL", "BURSTEN", bool)
            and not self._could(f"{block}.ADCSOCFRC1", bool, f"SOC{soc}")
        )

    def _pairs(self) -> None:
        """Pairs of outputs with a dead band where one output has no pin."""
        for n, epwm in self._chip.epwm.items():
            control = f"EPwm{n}Regs.DBCTL"
            wire = epwm.unpaired
            if wire is not None:
                missing = MissingLink(f"{wire.name} has no pin: {wire.missing}", control, "OUT_MODE")
                message = f"{control}.OUT_MODE = 3 makes a pair of outputs, but one of them has no pin"
                self._report(self._wanting(control, "OUT_MODE"), message, missing, wire.name)

    def _i2c(self) -> None:
        for letter in I2C_PIE:
            register = f"I2c{letter.lower()}Regs.I2CMDR"
            place = self._source.last(*_split(register))
            if place is not None and self._could(register, bool, "STT") and self._stuck(register, "IRS", bool):
                missing = MissingLink(f"{register}.IRS = 0: the module stays in reset", register, "IRS")
                self._report(place, f"{register}.STT starts a message, but nothing is sent", missing, register)

    def _can(self) -> None:
        """Check each CAN controller that is used: it is on the bus, its objects are valid, its messages are sent and
        taken once.
        """
        for letter in CAN_PIE:
            block = f"Can{letter.lower()}Regs"
            commands = [f"{block}.CAN_IF{n}CMD" for n in (1, 2)]
            used = next(filter(None, (self._source.last(*_split(command)) for command in commands)), None)
            if used is None:
                continue
            control = f"{block}.CAN_CTL"
            # The controller sets Init itself when it goes off the bus.
            if self._value(control, "Init") and not self._could(control, lambda init: not init, "Init"):
                self._report(
                    used, f"{block} sends and receives nothing", MissingLink(f"{control}.Init = 1", control, "Init"),
                    block, whole=True,
                )  # fmt: skip
                continue
            self._can_pins(block, letter)
            for n in (1, 2):
                arbitration = f"{block}.CAN_IF{n}ARB"
                place = self._source.last(*_split(arbitration))
                named = self._could(arbitration, bool, "ID")
                if place and named and self._writes(f"{block}.CAN_IF{n}MCTL") and not self._could(
                    arbitration, bool, "MsgVal"
                ):  # fmt: skip
                    missing = MissingLink(f"no statement sets {arbitration}.MsgVal", arbitration)
                    self._report(place, "the message object that is set up here is not valid", missing, arbitration)
            self._messages(block, letter, commands)
            self._objects(block, letter, commands)
            self._masks(block, letter)
            self._own_frames(block, letter)
            self._bit_rate(block, letter)

    def _can_pins(self, block: str, letter: str) -> None:
        """A controller without pins that has objects for messages, on a bus with other nodes."""
        can, bus = self._chip.can[letter], self._chip.can_bus[letter]
        control = f"{block}.CAN_CTL"
        told = any(finding.object == can.port.name for finding in self._chip.findings.of("not-configured"))
        if told or not can.unconnected or not can.ram.idle_receiver() or not bus.nodes:
            return
        missing = MissingLink(can.port.missing, control, "Init")
        self._report(self._wanting(control, "Init"), f"{block} receives nothing", missing, can.port.name)

    def _messages(self, block: str, letter: str, commands: list[str]) -> None:
        """Messages that are written and never sent, or that are taken again and again.

        With RmtEn, the remote frame of another node sends them.
        """
        asks = any(self._requests(command, writing=True) for command in commands) or any(
            self._could(f"{block}.CAN_IF{n}MCTL", bool, name) for n in (1, 2) for name in ("TxRqst", "RmtEn")
        )
        filled = [f"{block}.CAN_IF{n}CMD" for n in (1, 2) if self._writes(f"{block}.CAN_IF{n}DATA")]
        transmits = any(self._could(f"{block}.CAN_IF{n}ARB", bool, "Dir") for n in (1, 2))
        if filled and transmits and not asks:
            missing = MissingLink("no statement sets TxRqst", filled[-1])
            place = self._source.last(*_split(filled[-1]))
            self._report(place, "data are written to a message object but never sent", missing, filled[-1])
        elif (block, "CAN_NDAT_21") in self._source.reads:
            ram = self._chip.can[letter].ram
            again = max(range(1, OBJECTS + 1), key=lambda number: ram[number].read_again)
            place = self._source.reads[block, "CAN_NDAT_21"][0]
            if ram[again].read_again >= MIN_EDGES and not any(
                self._requests(command, writing=False) for command in commands
            ):  # fmt: skip
                self._chip.findings.report_at(
                    place, "flag-not-cleared",
                    f"NewDat of object {again} of {block} is never cleared: the same message was taken "
                    f"{ram[again].read_again} times more, and a new message cannot be recognised",
                    object=f"{block}.CAN_NDAT_21", how="dynamic",
                )  # fmt: skip

    def _objects(self, block: str, letter: str, commands: list[str]) -> None:
        """Message objects with an identifier in the wrong bits, with data that are not sent, or that nobody reads."""
        asks = any(self._requests(command, writing=True) for command in commands)
        for number in range(1, OBJECTS + 1):
            message = self._chip.can[letter].ram[number]
            word = message.arbitration
            if not word & MSGVAL or message.extended:
                continue
            if word & ID and not word & STANDARD_ID:
                why = f"{word & ID:#x} is below bits 28 to 18, where an identifier of 11 bits is: it has identifier 0"
            elif message.taken and message.control & MSGLST and not message.used:
                how = "RxIE = 1" if message.control & RXIE else "RxIE = 0, so no interrupt says that they are there"
                why = f"it receives messages which the program never reads ({how})"
            elif asks and not word & DIR and any(message.data) and not message.taken:
                why = "Dir = 0: TxRqst sends a remote frame, and not the data that were written to it"
            else:
                continue
            which, word = ("MCTL", message.control) if message.taken else ("ARB", word)
            registers = [f"{block}.CAN_IF{n}{which}" for n in (1, 2)]
            places = [self._source.giving(*_split(register), self._mask(register, ""), word) for register in registers]
            place = next(filter(None, places), None) or next(
                filter(None, (self._source.last(*_split(register)) for register in registers)), None
            )
            if place is not None:
                self._chip.findings.report_at(
                    place, "not-connected", f"object {number} of {block}: {why}", object=f"{block}.{number}",
                    how="dynamic",
                )  # fmt: skip

    def _masks(self, block: str, letter: str) -> None:
        """A message object with a mask that asks for no bit of an identifier of 11 bits: it takes every such frame.

        Either its mask has bits below them, where only identifiers of 29 bits are, or an object behind it, with an
        identifier of its own, has got nothing.
        """
        ram = self._chip.can[letter].ram
        ours = [(n, ram[n]) for n in range(1, OBJECTS + 1) if ram[n].arbitration & MSGVAL and not ram[n].extended]
        receiving = [(n, message) for n, message in ours if not message.arbitration & DIR]
        for number, message in receiving:
            if not message.control & UMASK or message.mask & STANDARD_ID:
                continue
            behind = next((
                n for n, other in receiving
                if n > number and not other.taken and other.arbitration & STANDARD_ID
                and (not other.control & UMASK or other.mask & STANDARD_ID)
            ), 0)  # fmt: skip
            if message.mask & ID:
                why = f"its mask {message.mask & ID:#x} has none of bits 28 to 18, where an identifier of 11 bits is"
            elif behind and message.taken and message.control & EOB:
                why = f"its mask is 0, so object {behind} never gets one"
            else:
                continue
            registers = [f"{block}.CAN_IF{n}MSK" for n in (1, 2)]
            places = [self._source.giving(*_split(register), ID, message.mask) for register in registers]
            places += [self._source.last(*_split(register)) for register in registers]
            place = next(filter(None, places), None)
            if place is not None:
                self._chip.findings.report_at(
                    place, "not-connected", f"object {number} of {block} takes every frame of 11 bits: {why}",
                    object=f"{block}.{number}", how="dynamic",
                )  # fmt: skip
            return

    def _bit_rate(self, block: str, letter: str) -> None:
        """A controller that shares no bit rate with any node of its bus, and has neither sent nor received a frame."""
        can = self._chip.can[letter]
        others = [node for node in self._chip.can_bus[letter].nodes if isinstance(node, CanPart)]
        place = self._source.last(block, "CAN_BTR")
        own = can.bit_cycles
        if not others or place is None or can.heard or can.in_loopback:
            return
        if all(abs(node.bit_cycles - own) * TOLERANCE > max(node.bit_cycles, own) for node in others):
            self._chip.findings.report_at(
                place, "serial-rate",
                f"{block} sends and receives {round(SYSCLK_HZ / own)} bits a second, and the bus has "
                f"{round(SYSCLK_HZ / others[0].bit_cycles)}: no frame has passed",
                object=f"{block}.CAN_BTR", how="dynamic",
            )  # fmt: skip

    def _own_frames(self, block: str, letter: str) -> None:
        """A controller in loopback receives only its own frames, and an object waits for a frame that never passes."""
        can = self._chip.can[letter]
        number = can.ram.idle_receiver() if can.passed_by >= MIN_EDGES else 0
        if not number:
            return
        waiting = can.ram[number]
        arbitrations = [f"{block}.CAN_IF{n}ARB" for n in (1, 2)]
        places = [
            self._source.giving(block, _split(register)[1], self._mask(register, ""), waiting.arbitration)
            for register in arbitrations
        ]  # fmt: skip
        place = next(filter(None, places), None) or self._source.last(*_split(arbitrations[1]))
        if place is not None:
            self._chip.findings.report_at(
                place, "not-connected",
                f"object {number} of {block} waits for identifier {waiting.identifier:#x}: the controller is in "
                f"loopback, and its filter passed none of the {can.passed_by} frames that no other object took",
                object=f"{block}.{number}", how="dynamic",
            )  # fmt: skip

    def _requests(self, command: str, *, writing: bool) -> bool:
        """Whether some CAN interface command sets TxRqst of an object (`writing`) or clears its NewDat (reading)."""
        return self._could(command, lambda word: bool(word & REQUEST) and bool(word & WRITE) == writing, "")

    def _outputs(self) -> None:
        """ePWMs with a pin and actions that are set to count, and do not count.

        A level that the program forces needs no counter.  What a written compare value has shown is not told again.
        """
        shown = {finding.object for finding in self._chip.findings.of("not-configured")}
        for n, epwm in self._chip.epwm.items():
            name = f"EPwm{n}Regs"
            place = self._wanting(f"{name}.TBCTL", "CTRMODE")
            forced = any(self._writes(f"{name}.{register}") for register in ("AQSFRC", "AQCSFRC", "TZFRC"))
            if place is None or forced or not epwm.acts_on_pin or self._value(f"{name}.TBCTL", "CTRMODE") == STOPPED:
                continue
            missing = self._no_count(n)
            if missing and shown.isdisjoint((f"{missing.register}.{missing.field}", missing.register)):
                self._report(place, f"the output of ePWM{n} never changes", missing, name)

    def _dacs(self) -> None:
        """A buffered DAC that gets codes and does not drive its pin."""
        for letter in "abc":
            block = f"Dac{letter}Regs"
            used = self._source.last(block, "DACVALS")
            if used is not None and self._stuck(f"{block}.DACOUTEN", "DACOUTEN", bool):
                missing = MissingLink(f"{block}.DACOUTEN = 0: the pin is not driven", f"{block}.DACVALS")
                self._report(used, f"{block} gets codes but drives no pin", missing, f"{block}.DACOUTEN")

    def _serial(self) -> None:
        """A SCI that is used while SWRESET keeps it in reset, or that hears nothing any more from a break on."""
        for letter in SCI_PIE:
            block = f"Sci{letter.lower()}Regs"
            register = f"{block}.SCICTL1"
            reads = self._source.reads.get((block, "SCIRXBUF"))
            used = self._source.last(block, "SCITXBUF") or (reads[0] if reads else None)
            if used is not None and self._stuck(register, "SWRESET", bool):
                missing = MissingLink(f"{register}.SWRESET = 0: the module stays in reset", register, "SWRESET")
                self._report(used, f"{block} never sends or receives a character", missing, register)
            receiver = self._chip.sci[letter].receiver
            reset = self._writes_again(register, lambda value: not value, "SWRESET")
            heard = receiver.received and not receiver.unheard and not receiver.loopback
            if reads and heard and self.started_up and not reset:
                self._chip.findings.report_at(
                    reads[-1], "break-stops",
                    f"{block}: a break on the line (a pulled cable, a partner without power) stops the receiver until "
                    f"SWRESET is cleared, and no statement clears {register}.SWRESET again",
                    object=f"{block}.SCIRXST", how="dynamic",
                )  # fmt: skip
            if reads and receiver.unheard and not reset:
                at = f"{receiver.broken_at / CYCLES_PER_MS:.3g} ms"
                why = f"a break at {at} has stopped the receiver, and no statement clears {register}.SWRESET again"
                message = f"{block} receives nothing any more: {receiver.unheard} characters have come since"
                self._report(reads[-1], message, MissingLink(why, register, "SWRESET"), f"{block}.SCIRXST")

    def _other_groups(self, modules: list[Module]) -> None:
        """Routines that acknowledge another group of the PIE than that of their interrupt, for one run after the other.

        Their own group is acknowledged by nobody, or by its other routines, which it keeps back as well.
        """
        if self._source.unclear("PieCtrlRegs", "PIEACK"):
            return
        writes = self._source.of("PieCtrlRegs", "PIEACK", -1)
        own = {f.path: f for module in modules for f in module.functions}
        groups: dict[str, set[int]] = {}
        routines: list[tuple[int, int, Function]] = []
        for group, n in product(range(1, 13), range(1, 17)):
            begins = self._chip.pie.routine(group, n)
            routine = routine_of(modules, begins) if begins is not None else None
            if routine is not None:
                groups.setdefault(routine.path, set()).add(group)
                routines.append((group, n, routine))
        reach = {f.path: {(g.where.file, g.name) for g in below([f.path], own)} for _, _, f in routines}
        told = {finding.object for finding in self._chip.findings.of("flag-not-cleared")}
        for group, n, routine in routines:
            name, bit = f"PieCtrlRegs.PIEACK.ACK{group}", 1 << group - 1
            if not routine.interrupt or len(groups[routine.path]) > 1 or name in told:
                continue
            mine = [write for write in writes if (write.place.file, write.place.function) in reach[routine.path]]
            # A read-modify-write also acknowledges each group whose bit is set.
            if not mine or not all(write.values and write.mask & 0xFFF == 0xFFF for write in mine):
                continue
            given = {value for write in mine for value in write.values or ()}
            if any(value & bit or not value & 0xFFF for value in given):
                continue
            fellows = {at for path, reached in reach.items() if groups[path] == {group} for at in reached}
            others = [write for write in writes if write.values is None or any(value & bit for value in write.values)]
            if not all((write.place.file, write.place.function) in fellows for write in others):
                continue
            if self._chip.pie.enabled(group, n) and wanted_again(modules, routine):
                told.add(name)
                wrong = min(given)
                message = (
                    f"{routine.name} is the routine of interrupt {group}.{n} and acknowledges group "
                    f"{(wrong & -wrong).bit_length()}: {name} stays set, and no interrupt of group {group} comes again"
                )  # fmt: skip
                self._chip.findings.report_at(
                    mine[0].place, "flag-not-cleared", message, object=name, how="dynamic",
                )  # fmt: skip

    def _interrupts_kept_back(self, modules: list[Module]) -> None:
        """Interrupts that can come once only: their flag stays set, for no statement clears it behind the start-up."""
        lines = dict.fromkeys((group, n) for group, n, _ in interrupt_flags())
        flags = [*interrupt_flags(), *((group, n, acknowledged(group)) for group, n in (*lines, *XINT_PIE.values()))]
        told = {finding.object for finding in self._chip.findings.of("flag-not-cleared")}
        for group, n, kept in flags:
            begins, name = self._chip.pie.routine(group, n), f"{kept.block}.{kept.flag}"
            if begins is None or name in told or not self._stays_enabled(group, n, kept):
                continue
            routine = routine_of(modules, begins)
            if routine is None or (kept.block == "PieCtrlRegs" and not routine.interrupt):
                continue  # the kernel's dispatcher acknowledges
            cleared = any(
                (kept.block, register) in self._source.by_library
                or self._writes_again(f"{kept.block}.{register}", partial(eq, value), field)
                for register, field, value in kept.clears
            )
            if not cleared and wanted_again(modules, routine):
                told.add(name)
                register, field, value = kept.clears[0]
                self._chip.findings.report_at(
                    begins, "flag-not-cleared",
                    f"interrupt {group}.{n} comes once only: {name} stays set after the first one, and no statement "
                    f"gives {kept.block}.{register}.{field} the value {value} behind the start-up",
                    object=name, how="dynamic", task=self._chip.cpu.routine_at(begins),
                )  # fmt: skip

    def _stays_enabled(self, group: int, n: int, kept: InterruptFlag) -> bool:
        """Whether an interrupt is enabled in its module, in PIEIER and in IER, and no statement disables it again."""
        bit = 1 << group - 1
        needs = [(f"{kept.block}.{register}", field) for register, field in kept.needs]
        needs.append((f"PieCtrlRegs.PIEIER{group}", f"INTx{n}"))
        without = [(f"{kept.block}.{register}", field) for register, field in kept.without]
        return bool(
            self._chip.cpu.ier & bit
            and not self._source.could("CPU", "IER", bit, not_, again=self.started_up)
            and all(self._value(*need) and not self._writes_again(need[0], not_, need[1]) for need in needs)
            and all(self._stuck(*other, bool) for other in without)
        )

    def _flags_kept(self, modules: list[Module]) -> None:
        """Flags that a test takes for new each time, and that no statement clears behind the start-up."""
        for block, name, field, place in latched_flags(modules):
            clears = [(f"{block}.{register}", bit or field, value) for register, bit, value in CLEARED[name][1]]
            if not any(
                (self._could if bit == LASTING else self._writes_again)(register, partial(eq, value), bit)
                for register, bit, value in clears
            ):  # fmt: skip
                register, bit, value = clears[0]
                self._chip.findings.report_at(
                    place, "flag-not-cleared",
                    f"{block}.{name}.{field} stays set after the first time: no statement gives {register}.{bit} the "
                    f"value {value} again", object=f"{block}.{name}.{field}", how="dynamic",
                )  # fmt: skip

    def _epwms(self) -> Iterator[tuple[int, str, str, Block]]:
        """Each compare register that the program writes, of ePWMs that can count: number, name, compare, registers."""
        for n in range(1, EPWM_COUNT + 1):
            name = f"EPwm{n}Regs"
            block = self._chip.blocks[name]
            for compare in ("CMPA", "CMPB"):
                if self._writes(f"{name}.{compare}") and not self._no_count(n):
                    yield n, name, compare, block

    def _loads(self) -> None:
        for _, name, compare, _ in self._epwms():
            x = compare[-1]
            mode, shadowed = f"LOAD{x}MODE", not self._value(f"{name}.CMPCTL", f"SHDW{x}MODE")
            at_sync = self._value(f"{name}.CMPCTL", f"LOAD{x}SYNC")
            if not shadowed or at_sync or self._could(f"{name}.CMPCTL", bool, f"SHDW{x}MODE"):
                continue
            if self._stuck(f"{name}.CMPCTL", mode, lambda value: value != FREEZE):
                missing = MissingLink(f"{name}.CMPCTL.{mode} = 3", f"{name}.CMPCTL", mode)
                self._report(
                    self._wanting(f"{name}.CMPCTL", mode),
                    f"the value written to {compare} is never loaded from its shadow", missing, f"{name}.CMPCTL.{mode}",
                )  # fmt: skip

    def _compares(self) -> None:
        for n, name, compare, block in self._epwms():
            x = compare[-1]
            used = any(
                block.registers[f"AQCTL{output}"].value & self._mask(f"{name}.AQCTL{output}", f"C{x}{way}")
                for output in "AB" for way in "UD"
            )  # fmt: skip
            # With a counter that counts up, one above the period means 100 %.
            missing = self._above(n, compare, 1) if used else None
            if missing:
                self._report(
                    self._wanting(f"{name}.{compare}", compare),
                    "the counter never reaches a compare value, so the output never changes there", missing,
                    f"{name}.{compare}",
                )  # fmt: skip
            elif used:
                for beyond in self._chip.epwm[n].above.get(compare, ()):
                    if self._check_beyond_period(f"{name}.{compare}", compare, beyond):
                        break

    def _compares_for_nobody(self) -> None:
        """Computed values of a compare that switches nothing.

        The other compare switches the output instead, or its actions only set it, or only clear it.  Or no output
        switches at it, and one does at the other compare, which only the start-up sets.
        """
        if any(self._writes(f"EPwm{n}Regs.EPWMXLINK") for n in range(1, EPWM_COUNT + 1)):
            return  # a value written to one ePWM also goes to another
        for n, name, compare, _ in self._epwms():
            x, other = compare[-1], "AB"[compare[-1] == "A"]
            action = f"{name}.AQCTL{x}"
            computed = any(write.values is None for write in self._source.writes[name, compare])
            crossed = any(self._value(action, f"C{other}{way}") for way in "UD")
            paired = self._value(f"{name}.DBCTL", "OUT_MODE")
            constant = self._constant_output(name, x) or self._left_at_start(n, compare)
            if not computed or not (crossed or constant) or paired or (name, compare) in self._source.reads:
                continue
            choices = {choice for choice, (of, _) in COMPARES.items() if of == compare}
            switches = (
                not self._stuck(f"{name}.AQCTL{output}", f"C{x}{way}", bool)
                for output in "AB" for way in "UD" if not self._constant_output(name, output)
            )
            triggers = (
                self._could(f"{name}.ETSEL", choices.__contains__, f"{event}SEL") for event in ("INT", "SOCA", "SOCB")
            )
            if not any(switches) and not any(triggers):
                why = constant or f"{action} switches output {x} at CMP{other}"
                missing = MissingLink(why, action)
                self._report(
                    self._source.last(name, compare), f"the values of {name}.{compare} change nothing", missing, action
                )  # fmt: skip

    def _left_at_start(self, n: int, compare: str) -> str:
        """Why nothing switches at a compare: an output does at the other one, which keeps the value of the start-up."""
        name, other = f"EPwm{n}Regs", "CMPB" if compare == "CMPA" else "CMPA"
        events = [f"C{other[-1]}{way}" for way in "UD"]
        switched = [action for o in "AB" for event in events if self._value(action := f"{name}.AQCTL{o}", event)]
        if not switched or not self.started_up or not self._chip.epwm[n].acts_on_pin or (
            self._source.later(name, other)
        ):  # fmt: skip
            return ""
        return f"{switched[0]} switches at {other}, which keeps the value that the start-up gives it"

    def _compares_never_set(self) -> None:
        """Outputs that switch at a compare which no statement writes, where the program writes the other compare."""
        if any(self._writes(f"EPwm{n}Regs.EPWMXLINK") for n in range(1, EPWM_COUNT + 1)):
            return  # a value written to one ePWM also goes to another
        pairs = (("CMPA", "CMPB"), ("CMPB", "CMPA"))
        for n, (written, compare) in product(range(1, EPWM_COUNT + 1), pairs):
            name = f"EPwm{n}Regs"
            register, pointed = f"{name}.{compare}", self._source.pointed
            if (
                not (self._writes(f"{name}.{written}") or written in pointed) or compare in pointed
                or self._writes(register) or self._could(register, bool, compare) or self._value(register, compare)
                or not self._chip.epwm[n].acts_on_pin or self._no_count(n)
            ):  # fmt: skip
                continue
            for output, way in ((output, way) for output in "AB" for way in "UD"):
                action, event = f"{name}.AQCTL{output}", f"C{compare[-1]}{way}"
                kind = self._value(action, event)
                if kind in AQ_ACTIONS:
                    missing = MissingLink(f"no statement writes {register}, which stays 0", action, event)
                    waits = f"output {output} is {AQ_ACTIONS[kind]} at {compare}, while {written} gets the values"
                    self._report(self._wanting(action, event), waits, missing, f"{action}.{event}")

    def _half_duties(self) -> None:
        """Outputs of an up-down counter that change at zero and at a compare on the way up, and not on the way down.

        The program computes the compare value, and has gone beyond half of the period.
        """
        for n, name, compare, _ in self._epwms():
            computed = any(write.values is None for write in self._source.writes[name, compare])
            value, period = self._chip.epwm[n].above_half.get(compare, (0, 0))
            if not value or not computed or not self._stuck(f"{name}.TBCTL", "CTRMODE", lambda mode: mode != UP_DOWN):
                continue
            up = f"C{compare[-1]}U"
            for output in "AB":
                action = f"{name}.AQCTL{output}"
                kinds = {event: kind for event in AQ_EVENTS if (kind := self._value(action, event))}
                other = [event for event in AQ_EVENTS if event not in ("ZRO", up)]
                if kinds.keys() != {"ZRO", up} or {*kinds.values()} != {*AQ_ACTIONS} or any(
                    self._could(action, bool, event) for event in other
                ) or self._value(f"{action}2", ""):  # fmt: skip
                    continue
                place = self._wanting(f"{name}.TBCTL", "CTRMODE") or self._wanting(action, up)
                if place is not None:
                    self._chip.findings.report_at(
                        place, "half-duty",
                        f"{name} counts up and down: output {output} is {AQ_ACTIONS[kinds['ZRO']]} at zero and "
                        f"{AQ_ACTIONS[kinds[up]]} at {compare} on the way up only, so that {compare} = {value} of "
                        f"{period} gives {50 * min(value / period, 1.0):.3g} % and no value more than 50 %",
                        object=action, how="dynamic",
                    )  # fmt: skip

    def _constant_output(self, name: str, x: str) -> str:
        """Why an output with actions never changes: they only set it, or only clear it.  Empty: it can change."""
        action = f"{name}.AQCTL{x}"
        forced = ("AQSFRC", "AQCSFRC", f"AQCTL{x}2")
        kinds = {self._value(action, event) for event in AQ_EVENTS} - {0}
        if len(kinds) != 1 or not kinds & AQ_LEVELS.keys() or any(self._writes(f"{name}.{other}") for other in forced):
            return ""
        (kind,) = kinds
        if any(self._could(action, lambda other: other not in (0, kind), event) for event in AQ_EVENTS):
            return ""
        return f"{action} only {AQ_LEVELS[kind]} output {x}"

    def _check_beyond_period(self, register: str, compare: str, beyond: CompareBeyondPeriod) -> bool:
        """Report a compare value above the period if it was computed.  A constant is taken to be meant."""
        findings = self._chip.findings
        path, task = findings.path(beyond.cause.at, beyond.cause.calls), beyond.cause.who
        writes = (*self._source.writes.get(_split(register), ()), *self._source.pointed.get(compare, ()))
        computed = {write.place[:2] for write in writes if write.values is None or write.scaled}
        at_call = next((n for n, place in enumerate(path) if place[:2] in computed), None)
        if at_call is not None:
            findings.report_at(
                path[at_call], "compare-above-period",
                f"{register} = {beyond.value}: TBPRD is {beyond.period}, so the output does not change at it",
                object=register, how="dynamic", value=beyond.value, call_path=path[at_call:], task=task,
            )  # fmt: skip
        return at_call is not None


def _starts_up(place: Place) -> bool:
    """Whether a place is in a function of TI's that sets up the clock, and the watchdog beside it."""
    return place.function in STARTS_UP


def _meant_off(place: Place) -> bool:
    """Whether the line of a place, or a comment there or just above, says off; or it is one of two builds (`#else`)."""
    lines = lines_with_comments(place.file)[: place.line][-4:]
    said = " ".join([code for code, _ in lines[-1:]] + [comment for _, comment in lines])
    return bool(OFF.search(said)) or any(code.lstrip().startswith(("#if", "#el")) for code, _ in lines)


def _split(register: str) -> tuple[str, str]:
    """Split a name into block and register: `DmaRegs.CH1.MODE` is CH1.MODE of DmaRegs."""
    block, _, name = register.partition(".")
    return block, name
