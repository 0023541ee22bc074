"""Rules of registers and of the modules behind them."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "peripherals")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "eallow",
        Severity.ERROR,
        "A protected register was written while EALLOW was off.",
        """
Most configuration registers of this chip take a write only between `EALLOW` and `EDIS`. Outside, the store executes
and the register keeps its old value: no trap, no flag, no bus error.

No host tool sees it, because on a host a register is a variable. On the chip it shows as a pin that does not switch
or a clock that does not run.

**Mend:** put `EALLOW;` before and `EDIS;` behind the group of writes. Two of them do not nest: an `EDIS` in a
function that you call ends your own `EALLOW` too. An interrupt starts with EALLOW off.
""",
        "TRM, system control: EALLOW-protected registers; SPRU430, ST1",
    ),
    _rule(
        "clock-gated",
        Severity.ERROR,
        "A register of a module was used while the module's clock was off.",
        """
Out of reset every peripheral's clock is off. A write to a module without clock is lost, and a read gives 0.

**Mend:** set the module's bit in `CpuSysRegs.PCLKCRn` (between `EALLOW` and `EDIS`) before the first other access.
""",
        "TRM, system control: PCLKCRn",
    ),
    _rule(
        "reserved-field",
        Severity.WARNING,
        "Ones were written to reserved bits of a register.",
        """
The manual asks for zeros in reserved bits. Often the word was meant for another register or another layout: all 16
bits of a baud rate written to `SCILBAUD` lose their upper half, a constant of another device family sets the wrong
bits.

A write of all ones is not reported (registers are cleared in that way), nor a write to a register of flags.

**Mend:** build the word from the fields, or assign `.bit.FIELD`.
""",
        "TRM, register descriptions",
    ),
    _rule(
        "unmodelled",
        Severity.NOTE,
        "The firmware uses a function that the emulator does not model.",
        """
The chip or the part has this function and the emulator does not: what happens next differs from silicon. It is no
defect of the firmware, and no result that depends on it can be trusted.

**Mend:** do without it in emulation, or model it (`emulator/peripherals/README.md`).
""",
    ),
    _rule(
        "not-configured",
        Severity.ERROR,
        "A module or a part was used before it was configured.",
        """
The finding names the register: a converter without power, a serial module in reset or without a baud rate, a pin that
is still set to another function, an encoder counter with `QPEN = 0` or `QPOSMAX = 0`, a duty for a counter that
stands still (`TBCLKSYNC`), an axis of the gyro that is switched off, a sonar that nobody has started.

None of these stops anything: the program goes on with zeros, with the last value, or with silence.

Pins and counters of an ePWM are looked at from 10 ms after the first compare value on, because start-up code may set
them in any order.

**Mend:** set the register that the finding names before the access, in the order that the manual's example gives.
""",
        "TRM, initialisation of each module; DS, GPIO muxed pins",
    ),
    _rule(
        "register-value",
        Severity.ERROR,
        "A number was computed that its field of a register does not hold.",
        """
A compare value, a period, a code of a DAC, a number of words or of a channel is stored without its upper bits: -4 in
`CMPA` is 65532, which the counter never reaches; 4100 in the twelve bits of `DACVALS` is 4, the other end of the
output. A cast in front of it changes nothing, and hides it from the compiler.

The number is looked at before any cast. Fields that take any word are left out: data, phases, positions, flags.

**Mend:** limit the number to the range of the field, below too, in the type in which it was computed.
""",
        "TRM, register descriptions",
    ),
    _rule(
        "latch-copied",
        Severity.ERROR,
        "A pin drives a level that a write to the whole port copied into its latch.",
        """
`GPxDAT` reads the levels of the pins and writes the latches. An assignment to one field of it, or `GPxDAT.all ^= ...`,
reads the whole port and writes it back: the latch of every input gets the present level of its pin. This has no effect
until the pin becomes an output. Then the pin drives this level: for example, it drives a bus high that others pull low.

The finding is made when an output drives a copied level. Its place is the statement that copied it.

**Mend:** write `GPxSET`, `GPxCLEAR` or `GPxTOGGLE`, which touch no other pin.
""",
        "TRM GPIO: GPxDAT, GPxSET, GPxCLEAR, GPxTOGGLE",
    ),
    _rule(
        "device-clock",
        Severity.ERROR,
        "A device is clocked faster than its data sheet allows.",
        """
A word was sent to a selected part with a shorter period of the clock than it takes at least. It works on one desk, and
not on another, or when it is cold. The clock is LSPCLK (SYSCLK / 4 out of reset) divided by `SPIBRR + 1`: whoever takes
another LSPCLK into account than the one that `LOSPCP` makes is wrong by that factor.

The finding names both clocks and the registers that make them.

**Mend:** a greater `SPIBRR`; the greatest clock stands in the part's data sheet (L3G4200D and LIS3DH: 10 MHz).
""",
        "TRM SPI: baud rate; L3G, SPI slave timing values: tc(SPC)",
    ),
    _rule(
        "serial-rate",
        Severity.ERROR,
        "The two ends of a serial line use different baud rates.",
        """
A character came with a bit length that its receiver cannot follow: half a bit off at the tenth bit is too much. It
takes other characters, or none, for those that were sent. The baud rate is LSPCLK / (8 * (BRR + 1)): whoever
takes another LSPCLK into account than the one that `LOSPCP` makes (SYSCLK / 4 out of reset) is wrong by that factor.

A program that is checked without a board of its own (`--board`) may have another peer than the robot's: a note then.

**Mend:** the rate of the peer, computed with the LSPCLK that is set.
""",
        "TRM SCI: baud rate; asynchronous serial format",
    ),
    _rule(
        "not-connected",
        Severity.ERROR,
        "An event can never come: one of the settings on its way is missing.",
        """
Events of this chip pass several modules, and each has a setting of its own. If one link is missing nothing fails: the
event just never comes. The finding names the link, and stands where it is set wrongly, or where the rest of its
register is set; what waits for the event stands behind it ("wanted by"):

* a conversion waits for an ePWM (`TRIGSEL`) whose counter stands still (`TBCLKSYNC`, `CTRMODE`, `TBPRD`), that gives no
  trigger (`SOCAEN`, `SOCAPRD`), or gives it at a compare value that the counter never reaches;
* `PIEIER` lets an interrupt through whose source is not enabled, whose pin was never chosen (`INPUTxSELECT` of an
  external interrupt), or which has no routine while another line of the group has one and is not let through;
* a channel of the DMA was never started, listens to no trigger, or to an ADC interrupt that is not enabled;
* an eCAP has no input, stands, loads nothing (`CAPLDEN`), or ends before the event that is waited for (`STOP_WRAP`);
* a position is read of `QPOSLAT`, which the unit timer never loads (`QCLM`), or the unit timer has no period;
* the digital compare of an ePWM listens to a TRIP of the X-BAR without an enabled mux, or to a comparator that is off;
* the dead band makes a pair of outputs, and only one of them has a pin;
* a DAC that gets codes drives no pin;
* an I2C or a SCI that is used is held in reset, an interrupt wants more words than its FIFO holds;
* a CAN that is used stays in Init, an object that is set up is never valid, or nothing asks for its transmission;
* a pin that the chip itself drives is qualified with longer samples than its pulses;
* a compare value is above the period, so that the output never changes at it (one above it is 100 % and is right);
* a compare register is never loaded from its shadow (`LOADAMODE = 3`).

It is looked at when a run ends, and told only if no statement of the program could set the link: a program that
starts its timer later, on an order that did not come in this run, is right.

**Mend:** set the register that the finding names, or take away what waits for it.
""",
        "TRM ADC: SOC triggers; TRM ePWM: time base, counter compare, event trigger; TRM PIE, external interrupts",
    ),
    _rule(
        "compare-above-period",
        Severity.WARNING,
        "A compare value was computed beyond the period.",
        """
The counter goes up to `TBPRD`. A compare value above it is never reached: the output stays where the period has put it,
100 % whatever the controller asks for, or 0 % where the compare sets. One above the period is how a counter that counts
up says 100 %, and is right; so is a constant, which is meant as it stands, and a value that is there before the longer
period it is for.

It is looked at when a run ends, told at the statement that wrote the first such value.

**Mend:** limit the value to `TBPRD + 1`, above and below, in a signed type.
""",
        "TRM ePWM: counter compare",
    ),
    _rule(
        "trip-open",
        Severity.WARNING,
        "A trip puts an output into high impedance, and no statement chose that.",
        """
`TZCTL.TZA` and `TZB` select what a trip does with an output. Their reset value 0 is high impedance: the chip does not
drive the pin. A gate driver or a transistor then keeps its charge, unless the board pulls the line. A driver that
selects a trip (`TZSEL`) and never writes `TZCTL` has probably not meant that.

The check is made at the end of a run, for outputs that have actions (`AQCTLA`, `AQCTLB`).

**Mend:** `TZCTL.bit.TZA = TZ_FORCE_LO`; if high impedance is meant, write `TZ_HIZ` so that it can be read.
""",
        "TRM ePWM: trip zone, TZCTL",
    ),
    _rule(
        "result-not-ready",
        Severity.ERROR,
        "A result was read before it was ready.",
        """
`ADCRESULTn` while its conversion waits or runs, or before there was any; `SPIRXBUF` while the word is still shifting,
or a second time; `SCIRXBUF` with `RXRDY = 0` or an empty FIFO, `I2CDRR` likewise. What is read is the previous result,
or 0: a plausible number that belongs to another moment, or to another channel.

After a hardware trigger it is normal that a driver takes the latest result while the next one is made; only
conversions that the firmware forces itself are reported. One read of an empty receive buffer before the first word or
character is not reported either: start-up code does that to empty it.

**Mend:** wait for the flag (`ADCINTFLG`, `SPISTS.INT_FLAG`, `SCIRXST.RXRDY`, the FIFO level) before the read.
""",
        "TRM ADC, SPI, SCI",
    ),
    _rule(
        "flag-not-cleared",
        Severity.ERROR,
        "An old flag was taken for a new event, or blocks it.",
        """
Flags of this chip stay set until the program clears them. A wait for a flag that is set already ends at once: the
driver reads the result of the event before, for ever one behind. And an interrupt is given only for the first event:
while the flag (`ADCINT`, `QFLG.INT`) or the group's acknowledge (`PIEACK`) stands, the next ones are swallowed.

Reported where the old flag is believed: the read of a result whose conversion still runs, the read of `INT_FLAG`
while a word shifts, the second unit time-out seen without a `QCLR`, a message of the I2C that is given up before its
address had an answer, a FIFO of the SCI that is emptied a second time for one overflow, the latch of a one-shot trip
(`TZFLG.OST`) that stands while `TZFLG.INT` is cleared again and again, a message of the CAN whose NewDat stays set and
which is taken again and again; or where an interrupt is lost.

**Mend:** clear the flag *before* the action that will set it again (ADC: `ADCINTFLGCLR`; SPI: read `SPIRXBUF` after
each word, also after one that was only sent; eQEP: `QCLR`; I2C: `NACK`; SCI: `RXFFOVF`), and write `PIEACK` in every
handler.
""",
        "TRM ADC interrupts, SPI INT_FLAG, eQEP QCLR, PIE acknowledge",
    ),
    _rule(
        "adc-flag-shared",
        Severity.ERROR,
        "An ADC interrupt was moved to another SOC during a conversion.",
        """
One `ADCINT` serves one SOC at a time. If `INT1SEL` is changed during a conversion that should set the flag, its end
sets nothing. The driver then waits for ever, or takes the end of another conversion for its own.

Two tasks (or a task and an interrupt) that both change the channel selection are needed, and one must interrupt the
other within the microsecond of a conversion.

**Mend:** one `ADCINT` for each user, or a gate around selection, start, wait and read.
""",
        "TRM ADC: ADCINTSEL1N2",
    ),
    _rule(
        "adc-not-powered",
        Severity.ERROR,
        "A conversion began before the analog core was powered up.",
        """
After `ADCCTL1.ADCPWDNZ = 1` the core needs 500 us. A conversion that begins earlier ends in time, with its flag, and
gives a number without meaning.

**Mend:** `DELAY_US(500)` or more behind the power-up, once.
""",
        "TRM ADC: power-up sequence",
    ),
    _rule(
        "adc-window",
        Severity.ERROR,
        "The sample window of a conversion is too short.",
        """
The sampling capacitor needs 75 ns (12 bits) or 320 ns (16 bits) at least: `ACQPS` is 14 or 63, more for a source with
a high resistance. With less it keeps part of the channel converted before.

**Mend:** set `ACQPS` of every `ADCSOCnCTL` in use; its reset value is too small.
""",
        "DS, ADC timing; TRM ADC: ACQPS",
    ),
    _rule(
        "adc-clock",
        Severity.ERROR,
        "The ADC's clock is above its limit.",
        """
ADCCLK is at most 50 MHz: at 200 MHz the divider must be 4 or more, that is `ADCCTL2.PRESCALE` 6 or more. The reset
value is the fastest one.

**Mend:** `PRESCALE = 6` at 200 MHz, before the converter is powered.
""",
        "DS, ADC characteristics",
    ),
    _rule(
        "adc-mode",
        Severity.ERROR,
        "The resolution and the signal mode of the ADC do not match.",
        """
Only 12 bits single-ended and 16 bits differential are specified. Set them through `AdcSetMode`, which loads the trims
that belong to the mode.
""",
        "TRM ADC: ADCCTL2; HDR F2837xS_Adc.c",
    ),
    _rule(
        "adc-burst",
        Severity.WARNING,
        "An ADC burst does not fit the round robin, or uses an SOC that was not set up.",
        """
With `BURSTEN` each trigger starts the next `BURSTSIZE + 1` SOCs of the round robin, which are those from `SOCPRIORITY`
to 15, and then SOC`SOCPRIORITY` again. With four of them and bursts of three the second burst begins at the fourth: the
results change places from burst to burst. And a SOC that nobody set up converts channel 0 with the shortest window.

**Mend:** as many SOCs in the round robin as a burst has, or a multiple: `SOCPRIORITY = 16 - (BURSTSIZE + 1)`, and the
sources in the last SOCs.
""",
        "TRM ADC: burst mode",
    ),
    _rule(
        "adc-limit-signed",
        Severity.ERROR,
        "A limit of a post-processing block compares a negative result, which this silicon does wrong.",
        """
`ADCPPBxRESULT` is negative once `ADCPPBxOFFREF` lies above the result (or below it, with `TWOSCOMPEN`). The manual
compares it with `TRIPHI` and `TRIPLO` as signed numbers; the silicon does not. The emulator compares as the manual
says, so that an interrupt that comes here may not come on the chip.

**Mend:** leave `ADCPPBxOFFREF` at 0 where the limits interrupt. A second block of the same SOC may subtract the
reference and watch for the zero crossing.
""",
        "ERR, ADC: post-processing block limit compare",
    ),
    _rule(
        "data-lost",
        Severity.ERROR,
        "A word or a request was lost: the one before it was still waiting.",
        """
The finding names the register: a word came to `SPIRXBUF` before the last one was read, a FIFO was full, a character
replaced one in `SCIRXBUF`, `SPITXBUF` or `SCITXBUF` was written while one waited in it, an SOC was triggered again
before its conversion had begun (`ADCSOCOVF1`). The hardware sets an overflow flag that nobody looks at. Or 16
characters came to a FIFO of the SCI that was running and that `RXFIFORESET` holds in reset since then.

**Mend:** read in time (interrupt, FIFO), or wait for room (`BUFFULL_FLAG`, `TXRDY`, FIFO level) before a write.
""",
        "TRM SPI, SCI, ADC: overrun and overflow flags",
    ),
    _rule(
        "locked",
        Severity.WARNING,
        "A register was written while its lock was set.",
        """
`GPxLOCK`, `CPUSYSLOCK1` and `INPUTSELECTLOCK` freeze configuration until the lock is taken back or until reset. The
write is dropped without a sign.

**Mend:** finish the configuration before the lock is set.
""",
        "TRM GPIO: GPxLOCK; system control: CPUSYSLOCK1; X-BAR: INPUTSELECTLOCK",
    ),
    _rule(
        "contention",
        Severity.ERROR,
        "A pin of the chip drives against another driver.",
        """
Two push-pull outputs with different levels short the supply through both. Here the wire reads 0, on the board one of
them suffers.

**Mend:** make the pin an input (or let it go) before the other side drives; check direction and function of the pin.
""",
        "TRM GPIO: GPxDIR",
    ),
    _rule(
        "dma-address",
        Severity.ERROR,
        "A DMA channel uses an address that the DMA cannot reach.",
        """
The DMA has a bus of its own. It leads to the global shared RAM (`RAMGS0` to `RAMGS15`), to the results of the ADCs,
and over two bridges to ePWM, eCAP, eQEP, DAC, CMPSS, SDFM (`SECMSEL.PF1SEL`) and McBSP, SPI, uPP (`PF2SEL`). A bridge
belongs to the CLA until its field is set to 1. Reads of anything else give 0 here, and writes are lost; the channel
counts on and interrupts as if all were well.

**Mend:** put buffers into a `ramgs` section (`#pragma DATA_SECTION`), and set the field of the bridge between `EALLOW`
and `EDIS`.
""",
        "TRM, DMA and system control: SECMSEL; DS, memory map",
    ),
    _rule(
        "interrupt-without-handler",
        Severity.ERROR,
        "An interrupt was taken that has no handler.",
        """
The line is enabled in `PIEIER` and `IER`, and its vector leads nowhere. On the chip the CPU jumps to whatever the
vector RAM holds.

**Mend:** plug the vector before the line is enabled; enable only what has a handler.
""",
        "TRM PIE: vector table",
    ),
    _rule(
        "interrupt-storm",
        Severity.ERROR,
        "Interrupts follow each other without a gap, and nothing else runs.",
        """
An interrupt is taken as soon as its routine has returned, again and again, and what it interrupts (`main`, a task, a
routine that lets interrupts through) gets not one statement between two of them. It counts as a storm after 1000
interrupts in a row that took 2,000,000 cycles (10 ms at 200 MHz) in all, if none of these cycles was left to what they
interrupt; the run ends there. An interrupt that leaves it a single statement each time is none, however fast it is.

Typical: a timer whose period is 0, or shorter than its routine; an ADC in continuous mode whose conversions end sooner
than the routine; a FIFO whose level flag is cleared while its level still holds, so that it is set again at once; a
routine that sets its own flag in `PIEIFR` or `IFR`. On the chip the program seems dead, and the debugger finds it in
the routine each time.

**Mend:** take away what the source asks for before its flag is cleared: read the FIFO, fill it, or disable the
interrupt until there is something to do. Make a period longer than the routine and what else must run; sum up samples
by ePWM-triggered conversions or the DMA.
""",
        "TRM PIE; TRM SCI, FIFO interrupt flags",
    ),
    _rule(
        "watchdog-reset",
        Severity.ERROR,
        "The watchdog reset the device.",
        """
Nothing wrote 0x55 and 0xAA to `WDKEY` in time, a window was missed, or `WDCR` was written without its check bits. The
program starts again from nothing: RAM keeps what it held, peripherals do not. In the emulator a program of SYS/BIOS
ends there: its pins are inputs, so that motors are off, and the world goes on without it; to begin anew is a new run.
What runs without the kernel goes on as if it had not been reset. A service that was begun with 0x55 and not ended with
0xAA is none; the finding stands there then.

**Mend:** service the watchdog in the slowest loop that must live; or disable it, as the start-up code does here.
""",
        "TRM system control: watchdog",
    ),
    _rule(
        "watchdog-in-vain",
        Severity.WARNING,
        "An interrupt services the watchdog while the main program hangs.",
        """
`main` waits in a loop that nothing can end any more, and an interrupt goes on to write 0x55 and 0xAA to `WDKEY`. The
watchdog is there for just that case, and does nothing about it: everything that blinks by a timer blinks on.

Told by `hil check FILE...` when a run ends in such a loop (`endless-poll`), at the service.

**Mend:** service the watchdog in the loop of `main`. If an interrupt has to do it, then only when `main` has said since
the last time that it lives: a flag that `main` sets and the interrupt takes back.
""",
        "TRM system control: watchdog",
    ),
    _rule(
        "epwm-shadow-lost",
        Severity.WARNING,
        "A value in a shadow register was lost before it was loaded.",
        """
A compare value, a period or an action was written to its shadow and the register was switched to immediate mode
before the load point came: the value never becomes active.

**Mend:** choose the mode before the value is written.
""",
        "TRM ePWM: shadow registers",
    ),
    _rule(
        "eqep-prescaler",
        Severity.WARNING,
        "The prescalers of the eQEP capture unit were changed while it ran.",
        """
`UPPS` and `CCPS` may be changed only with `CEN = 0`; the period that is being measured is wrong otherwise.

**Mend:** clear `QCAPCTL.CEN`, set the prescalers, set `CEN`.
""",
        "TRM eQEP: QCAPCTL",
    ),
    _rule(
        "i2c-clock",
        Severity.ERROR,
        "The module clock or the bus clock of the I2C is out of range.",
        """
The module's clock is SYSCLK / (`IPSC` + 1), and the times of the bus are counted in it: with less than 7 or more than
12 MHz they are not kept, whatever `I2CCLKL` and `I2CCLKH` make of SCL. At 200 MHz `IPSC` is 16 to 27.
SCL itself has 400 kHz at most: a bit lasts `I2CCLKL + d + I2CCLKH + d` module clocks, and d is 5, 6 or 7.

Reported at the START that would use it.

**Mend:** choose `IPSC` first, with `IRS = 0`, then `ICCL` and `ICCH` for the rate of SCL.
""",
        "TRM I2C: clock generation, I2CPSC",
    ),
    _rule(
        "i2c-fifo-interrupt",
        Severity.ERROR,
        "Interrupts of XRDY or RRDY are enabled while the I2C is in FIFO mode.",
        """
With `I2CFFTX.I2CFFEN = 1` the FIFOs fill `I2CDXR` and empty `I2CDRR`, so their flags and interrupts tell the program
nothing: the manual says not to use them then. A routine that waits for them sends or takes bytes at wrong times, or
none.

**Mend:** clear `XRDY` and `RRDY` in `I2CIER`, and use `TXFFIENA` and `RXFFIENA` with their levels (interrupt 8.2 or
8.4).
""",
        "TRM I2C: basic interrupt requests, XRDYINT and RRDYINT",
    ),
    _rule(
        "i2c-prescaler",
        Severity.ERROR,
        "The prescaler of the I2C was changed while the module ran.",
        """
`I2CPSC` takes effect when `IRS` goes from 0 to 1. Written later it reads back as written, and the bus goes on with the
old clock.

**Mend:** clear `I2CMDR.IRS`, write `I2CPSC`, set `IRS`.
""",
        "TRM I2C: clock generation, I2CPSC",
    ),
    _rule(
        "can-interface-busy",
        Severity.ERROR,
        "A register of a CAN interface was used during a transfer.",
        """
Writing the message number to `CAN_IF1CMD` or `CAN_IF2CMD` starts a transfer between the interface and the message RAM.
Until it is over `Busy` is 1 and the registers of that interface are protected: what is written to them is lost without
a sign. The next command then moves old values, or the command itself is the one that is lost. What a command fetches
is not there before: a read in between gives the data of the message before.

**Mend:** wait for `Busy` to be 0 before each use of an interface, and give interrupts an interface of their own.
""",
        "TRM CAN: IF1/IF2 command registers, Busy",
    ),
    _rule(
        "i2c-stop-pending",
        Severity.ERROR,
        "A START was requested before the previous STOP was done.",
        """
`I2CMDR.STP` stays 1 until the STOP condition has been made, a while after the last byte. The manual wants it to be 0
before a new message is set up. What a START in between does no document says; here it is made behind the byte or the
STOP that is under way.

**Mend:** test `I2CMDR.bit.STP` before the registers of a new message are written.
""",
        "TRM I2C: I2CMDR, STP",
    ),
    _rule(
        "i2c-left-busy",
        Severity.WARNING,
        "The driver leaves the I2C bus busy after a NACK.",
        """
After a NACK of an address or a byte, the controller holds SCL low and waits: the program must set STOP or a new START.
Until then `BB` is 1. A driver that waits for `BB` to fall, or that sends nothing while it is 1, waits for itself.

The finding is made at the first read of `I2CSTR` that comes 100 ms (CHOICE) or more after the first read since the
NACK, if neither `STT` nor `STP` was written between them (also if `STP` was set before: its effect then is a choice,
`stops_when_refused`).

**Mend:** set `STP` where `NACK` was seen, wait for `BB` to fall, and clear `NACK`.
""",
        "TRM I2C: NACK, bus activity by RM, STT and STP",
    ),
    _rule(
        "spi-mode",
        Severity.ERROR,
        "A device was addressed in an SPI clock mode that it does not support.",
        """
Phase and polarity decide at which edge each side samples. In a wrong mode every byte arrives shifted by a bit:
numbers that are double, half, or just odd. The phase bit of this chip counts the other way from the usual CPHA.

**Mend:** for modes 0 and 3 of the gyro: `CLKPOLARITY = 0, CLK_PHASE = 1` or `CLKPOLARITY = 1, CLK_PHASE = 0`.
""",
        "TRM SPI: clocking schemes; L3G, SPI bus interface",
    ),
    _rule(
        "spi-width",
        Severity.ERROR,
        "Words with more bits than the characters of the SPI were written, and their lower bits were never sent.",
        """
`SPITXBUF` is sent from bit 15 down, `SPICHAR + 1` bits of it. With characters of 8 bits the lower half of each word
stays at home: a driver that hands over 16 bits sends every other octet, one that does not shift its octet up
(`SPITXBUF = c`) sends zeros.

Told at the second of two words that lose different bits. A word whose rest is written next (`w`, then `w << 8`) loses
nothing.

**Mend:** `SPITXBUF = c << 8` for an octet; `SPICHAR = 15` for words.
""",
        "TRM SPI: SPITXBUF, left-justified; SPICHAR",
    ),
    _rule(
        "spi-transaction-cut",
        Severity.ERROR,
        "The chip select rose in the middle of a word or byte.",
        """
The device throws the unfinished byte away. The usual cause is a wait that ends too early (on a flag of the word
before, or on room in the transmit buffer, which says nothing about the shift register), or a second task that uses
the bus.

**Mend:** wait for `INT_FLAG` of the last word, read `SPIRXBUF`, then raise the chip select; one gate around the whole
transaction.
""",
        "L3G, SPI bus interface; TRM SPI",
    ),
    _rule(
        "spi-no-device",
        Severity.WARNING,
        "A word was sent on the SPI while no chip select was low.",
        """
The word leaves the chip, but no device takes it. The word that is received is the level of an undriven line.

**Mend:** lower the chip select before the first word of a transaction, and make its pin an output.
""",
        "L3G, SPI bus interface",
    ),
    _rule(
        "device-register",
        Severity.WARNING,
        "A register of a device was accessed in a way that its data sheet forbids.",
        """
A reserved address was read or written, a read-only register written, or bits were set that must stay 0. Reserved
registers of the gyro hold its factory trims: writing them can spoil the part for good.

**Mend:** check the address, the read bit and the auto-increment bit of the command byte.
""",
        "L3G, register mapping",
    ),
    _rule(
        "eeprom-page",
        Severity.ERROR,
        "A write to an EEPROM crossed the end of a page.",
        """
Only the lower bits of the EEPROM's address count on while a message is written (six of them, a page of 64 bytes).
Behind the last byte of the page comes its first one: what was meant for the next page replaces what stands at the
beginning of this one, and of more bytes than a page has the first ones are lost. The EEPROM acknowledges all of it.

Reported at the STOP that begins the write cycle.

**Mend:** end the message at the page's end, wait for the write cycle (poll for the acknowledgment), and begin the next
one.
""",
        "AT24C256: page write",
    ),
    _rule(
        "endless-poll",
        Severity.ERROR,
        "A polling loop waits for an event that cannot come.",
        """
A polling loop only reads, and no event is left (or none for a very long time) that could change what it reads: a
conversion that was never started, an interrupt flag that is not selected, a transmitter in reset. On the chip the task
hangs, and so does every task below it.

The idle loop of a program, `while (1) ;`, reads nothing and is not reported: interrupts run in between. In an interrupt
routine it is reported, because nothing interrupts a routine.

**Mend:** give each wait a limit (a count or a time) and handle the time-out; check that the event is configured before
the wait begins.
""",
    ),
)
