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
A configuration register keeps its old value after a write. The pin does not switch, or the clock does not run.

Most configuration registers of this chip accept a write only between `EALLOW` and `EDIS`. Outside, the CPU executes
the store and the register ignores it. There is no trap, no flag and no bus error. No host tool sees the defect,
because on a host a register is a plain variable.

An interrupt routine starts with EALLOW off. The two macros do not nest: an `EDIS` in a function that you call also
ends your own `EALLOW`.

**Fix:** `EALLOW;` before the group of writes, `EDIS;` after it.
""",
        "TRM, system control: EALLOW-protected registers; SPRU430, ST1",
    ),
    _rule(
        "clock-gated",
        Severity.ERROR,
        "A register of a module was used while the module's clock was off.",
        """
A peripheral does not react: its registers read 0, and nothing that the program writes to them stays.

After reset the clock of every peripheral is off. A module without a clock loses each write and returns 0 for each
read.

**Fix:** set the module's bit in `CpuSysRegs.PCLKCRn` (between `EALLOW` and `EDIS`) before the first other access.
""",
        "TRM, system control: PCLKCRn",
    ),
    _rule(
        "reserved-field",
        Severity.WARNING,
        "Ones were written to reserved bits of a register.",
        """
The manual requires zeros in reserved bits. A one there usually means that the word was computed for another register
or another layout. Examples: all 16 bits of a baud rate are written to `SCILBAUD`, which loses the upper half; a
constant of another device family sets the wrong bits; an I2C address that contains the R/W bit is longer than 7 bits.

These writes are not reported:

* a word of all ones (programs clear registers in that way);
* a word with ones in all reserved bits of a register that is mostly reserved (`~mask`);
* a write to a register of flags.

**Fix:** build the word from the fields, or assign to `.bit.FIELD`.
""",
        "TRM, register descriptions",
    ),
    _rule(
        "unmodelled",
        Severity.NOTE,
        "The firmware uses a function that the emulator does not model.",
        """
The chip or the part has this function, and the emulator does not have it. From here on the run differs from the
silicon. This is no defect of the firmware, but do not trust a result that depends on the function.

**Fix:** avoid the function in emulation, or add it to the model (`emulator/peripherals/README.md`).
""",
    ),
    _rule(
        "not-configured",
        Severity.ERROR,
        "A module or a part was used before it was configured.",
        """
The program uses a module, and the module does nothing: it returns zeros, the last value, or silence. Nothing stops the
program.

The finding names the register or the pin that is missing. Examples:

* an ADC without power (`ADCPWDNZ = 0`);
* a serial module in reset or without a baud rate;
* a pin that still has another function;
* an eQEP counter with `QPEN = 0` or `QPOSMAX = 0`;
* a duty cycle for an ePWM counter that does not count (`TBCLKSYNC`);
* an axis of the gyro that is switched off;
* a sonar that was never started.

Start-up code may set an ePWM in any order. So its pins and counter are checked only when 10 ms have passed since the
first compare value.

**Fix:** set the register that the finding names before the access, in the order of the manual's example.
""",
        "TRM, initialisation of each module; DS, GPIO muxed pins",
    ),
    _rule(
        "register-value",
        Severity.ERROR,
        "A computed number does not fit its field of a register.",
        """
The program computes a number for a field, and the field stores only the lower bits. -4 in `CMPA` becomes 65532, which
the counter never reaches. 4100 in the twelve bits of `DACVALS` becomes 4, the other end of the output range.

A cast does not help: it only hides the loss from the compiler. The detector takes the number before any cast. It
checks fields that hold a quantity: compare values, periods, DAC codes, lengths, channel numbers. It does not check
fields that accept any word, such as data, phases, positions and flags.

**Fix:** limit the number to the range of the field, at both ends, in the type in which it was computed.
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

**Fix:** write `GPxSET`, `GPxCLEAR` or `GPxTOGGLE`, which touch no other pin.
""",
        "TRM GPIO: GPxDAT, GPxSET, GPxCLEAR, GPxTOGGLE",
    ),
    _rule(
        "device-clock",
        Severity.ERROR,
        "A device is clocked faster than its data sheet allows.",
        """
A part works on one desk and fails on another, or when it is cold. The program sent a word to the selected part with a
clock faster than its data sheet allows.

The SPI clock is LSPCLK / (`SPIBRR` + 1), and LSPCLK / 4 for `SPIBRR` below 3. LSPCLK is SYSCLK / 4 after reset;
`LOSPCP` sets it. If the driver assumes another LSPCLK, its clock is wrong by that factor. The finding names both
clocks and the registers that produce them.

**Fix:** a larger `SPIBRR`. The data sheet of the part gives the highest clock (L3G4200D and LIS3DH: 10 MHz).
""",
        "TRM SPI: baud rate; L3G, SPI slave timing values: tc(SPC)",
    ),
    _rule(
        "timer-clock",
        Severity.WARNING,
        "A CPU timer is set up for another SYSCLK than the program's own.",
        """
Everything that the timer paces is too fast or too slow by one factor.

`ConfigCpuTimer(&CpuTimer0, 100, 1000)` says that SYSCLK has 100 MHz and that the period is 1000 us, and loads 100000
into PRD. At 200 MHz that is 500 us. Typical: a call copied from an example for another chip (90, 100, 150 MHz).

The check is made in a program that calls `InitSysCtrl`, which makes 200 MHz, and does not set up the PLL itself. A
frequency of 1 is not reported, because the period is then meant in cycles; nor is CPU timer 2 in a program that gives
it a clock by TMR2CLKCTL.

**Fix:** the frequency of SYSCLK in MHz: 200.
""",
        "HDR F2837xS_CpuTimers.c: ConfigCpuTimer",
    ),
    _rule(
        "serial-rate",
        Severity.ERROR,
        "The two ends of a serial line, or the nodes of a CAN, use different rates.",
        """
The receiver gets wrong characters, or none.

The two ends of the line use different bit times. The tenth bit is sampled 9.5 bit times after the start edge, so an
error of half a bit there is too much. The baud rate is LSPCLK / (8 * (BRR + 1)). LSPCLK is SYSCLK / 4 after reset;
`LOSPCP` sets it. If the driver assumes another LSPCLK, its rate is wrong by that factor.

On a CAN the bit time comes from `CAN_BTR` and SYSCLK. A controller that has the bit time of no other node, and that has
neither sent nor received a frame, is reported at the end of a run.

If you check a program without a board of its own (`--board`), its real peer may use another rate than the robot's
peer. Then the finding is a note.

**Fix:** compute the divider for the peer's rate from the LSPCLK that is set.
""",
        "TRM SCI: baud rate; asynchronous serial format",
    ),
    _rule(
        "not-connected",
        Severity.ERROR,
        "An event can never come: one of the settings on its way is missing.",
        """
The program waits for an event, and the event never comes.

An event passes through several modules on this chip, and each module has a setting of its own. If one setting is
missing, nothing reports an error. The finding names the missing setting. It is at the statement that sets it wrongly,
or at a statement that sets up the same register. The details name the statement that waits ("wanted by"). These
connections are checked:

* ADC trigger: `TRIGSEL` selects an ePWM whose counter does not count (`TBCLKSYNC`, `CTRMODE`, `TBPRD`), which sends no
  trigger (`SOCAEN`, `SOCAPRD`), or which sends it at a compare value that the counter never reaches. Or it selects a
  CPU timer that does not run. `INTxSEL` selects a SOC that has no trigger, and no statement starts it, for an
  interrupt or for a program that polls the flag.
* Interrupts: `PIEIER` enables an interrupt whose source is not enabled, or an external interrupt whose pin was never
  selected (`INPUTxSELECT`). Or it enables a line without a routine, while another line of the group has a routine and
  is not enabled. Or the interrupt of a routine in the vector table has come, and no statement enables its line. Or
  `IER` or `ENPIE` does not pass the interrupt on, or no statement executes `EINT`. So it is if `IER = M_INT1` takes bit
  13 away again before the interrupt can come, and if the program has stopped the timer or disabled the line since.
* CPU timers: the program reads `TIM` again and again, and no statement starts the timer.
* Watchdog: the start-up of TI has switched it off, a statement of the program writes `WDCR` with `WDDIS = 1` again
  (`0x0068` for `0x0028`), and the program services it again and again. That is not reported if a statement could switch
  it on, if the program calls `DisableDog`, or if the line says off (a name, a comment, `#else`).
* DMA: a channel was never started, has no trigger, does not interrupt (`CHINTE`), or uses an ADC interrupt that is not
  enabled. It has stopped after a transfer, and is given the addresses of the next one without a start.
* ADC post-processing: an event interrupts, and nothing starts the SOC of its block.
* eCAP: it has no input, or the program selected the input of another eCAP; its counter is stopped, no edge loads it
  (`CAPLDEN`), or its sequence ends before the event that is enabled (`STOP_WRAP`). A one-shot has stopped and is not
  armed again (`REARM`), while the program waits for ever or clears its flags again and again.
* eQEP: the program reads `QPOSLAT`, which the unit timer never loads (`QCLM`), or the unit timer has no period.
* ePWM digital compare: it uses a TRIP input of the X-BAR that has no enabled mux, or a comparator that is off.
* ePWM outputs: an output with actions and a pin has a counter that does not count. The dead band makes a pair of
  outputs, and one of them has no pin. Its delays are set, and it is bypassed (`OUT_MODE = 0`). A compare value is above
  the period, so the output never changes there (one above the period means 100 % and is right). A compare register is
  never loaded from its shadow (`LOADAMODE = 3`), or its values change nothing, because its output switches at the other
  compare, or its actions only set the output or only clear it, or no output switches at it, while one does at the
  other compare, which only the start-up sets. An output switches at a compare that no statement writes, and the program
  writes the other one. A trip that the program forces changes no output (`TZA = 3`). A one-shot
  trip came in the moment when `TZSEL` chose its input, because this was still low (out of reset it is GPIO0), and no
  statement after the start-up clears `OST`.
* DAC: it gets codes and drives no pin.
* SCI: characters come, a break on the line has stopped the receiver before, and no statement clears `SWRESET` again.
* I2C and SCI: the module stays in reset, no interrupt of a direction is enabled, or one needs more characters than the
  FIFO holds.
* SPI: the interrupt of a direction is not enabled.
* CAN: a pin is missing, an interrupt line is not enabled, the controller stays in Init, a message object that is set up
  is never valid, nothing requests its transmission, or in loopback its filter passes none of the controller's own
  frames. An identifier of 11 bits is in the lower bits of `ARB`, which only extended identifiers have. Data are written
  to an object with `Dir = 0`, whose request sends a remote frame. An object receives messages, and the program never
  reads one. A mask (`UMask`) has none of bits 28 to 18, so that an object takes every frame of 11 bits: its mask has
  lower bits only, or an object behind it gets nothing.
* Swi: it is created with a trigger, and the program only calls `Swi_post`, which posts it at once, whatever the trigger
  is. `Swi_dec`, `Swi_andn`, `Swi_inc` and `Swi_or` change a trigger, and `Swi_getTrigger` reads it.
* Pins: the program sets and clears a pin that no statement makes an output. The chip itself drives a pin, and the input
  qualification of the pin needs longer pulses.

The check is made at the end of a run. It reports a setting only if no statement of the program could set it, also
through pointers to registers, to blocks, or to structures that hold these. A program that starts its timer on an order
that did not come in this run is not reported. The start-up runs once: a setting that it makes and takes back is
missing.

Driver files without a `main` are only half of a program. Of them three of these connections are checked, which no
application puts right: a line of `PIEIER` without a routine beside a routine whose line nothing enables, a compare that
is never loaded (`LOADAMODE = 3`), and an input of the Input X-BAR that gets a pin and that nothing uses, beside an
eCAP, an external interrupt or a trip zone whose own input gets none.

**Fix:** set the register that the finding names, or remove what waits for the event.
""",
        "TRM ADC: SOC triggers; TRM ePWM: time base, counter compare, event trigger; TRM PIE, external interrupts",
    ),
    _rule(
        "compare-above-period",
        Severity.WARNING,
        "A compare value was computed beyond the period.",
        """
The output stays at 100 %, or at 0 % if the compare event sets it, whatever the controller computes.

The counter counts up to `TBPRD`. It never reaches a compare value above `TBPRD`, so the output does not change there.

The check is made at the end of a run. The finding is at the statement that wrote the first such value. These values
are not reported: one above the period, which means 100 % for a counter that counts up; a constant (but not a percentage
that the program scales, even if it only has known values); a value that is written just before the longer period that
it is meant for.

**Fix:** limit the value to `TBPRD + 1` and to 0, in a signed type.
""",
        "TRM ePWM: counter compare",
    ),
    _rule(
        "trip-open",
        Severity.WARNING,
        "A trip puts an output into high impedance, and no statement selects that.",
        """
`TZCTL.TZA` and `TZB` select what a trip does with an output. Their reset value 0 is high impedance: the chip does not
drive the pin. A gate driver or a transistor then keeps its charge, unless the board pulls the line. A driver that
selects a trip (`TZSEL`) and never writes `TZCTL` has probably not meant that.

The check is made at the end of a run, for outputs that have actions (`AQCTLA`, `AQCTLB`).

**Fix:** `TZCTL.bit.TZA = TZ_FORCE_LO`; if high impedance is meant, write `TZ_HIZ` so that it can be read.
""",
        "TRM ePWM: trip zone, TZCTL",
    ),
    _rule(
        "break-stops", Severity.NOTE, "A break on its line stops a receiver for good.", """
After somebody has pulled the cable or switched the partner off, the program receives nothing until it is started again.

The line is low then for longer than a character. The SCI takes this for a break, sets `BRKDT` and `RXERROR`, and gives
one more interrupt. From then on it receives nothing, until `SCICTL1.SWRESET` is cleared and set again.

The note is made at the end of a run in which an SCI has received characters, if no statement clears `SWRESET` after the
start-up. If a break comes in the run, and characters come behind it, it is an error (`not-connected`).

**Fix:** look at `SCIRXST.RXERROR` where a character is taken, and give `SWRESET` a pulse if it is set.
""", "TRM SCI, SCIRXST.BRKDT",
    ),
    _rule(
        "result-not-ready",
        Severity.ERROR,
        "A result was read before it was ready.",
        """
The program gets a plausible number that belongs to another moment or to another channel.

It reads a result register before the new result is there, so it gets the previous result, or 0. These reads are
reported:

* `ADCRESULTn` while its conversion waits or runs, or before the first conversion;
* `SPIRXBUF` while the word is still being shifted, or a second time;
* `SCIRXBUF` with `RXRDY = 0` or with an empty FIFO;
* `I2CDRR` without a new byte.

These reads are not reported: the latest result of a conversion that hardware triggers, because drivers use it in that
way; and one read of an empty receive buffer before the first word, because start-up code clears the buffer with it.

**Fix:** wait for the flag (`ADCINTFLG`, `SPISTS.INT_FLAG`, `SCIRXST.RXRDY`, the FIFO level) before the read.
""",
        "TRM ADC, SPI, SCI",
    ),
    _rule(
        "result-of-before", Severity.NOTE, "An ADC routine reads a result whose conversion still runs.", """
The two results that the routine takes are not of the same moment: one of them is of the trigger before.

A trigger starts several conversions, one after the other. `ADCINTSEL1N2.INT1SEL = 0` requests the interrupt at the end
of SOC0, and the routine reads `ADCRESULT1` while SOC1 is being converted. Power and phase are wrong then, for voltage
and current are a period apart. With another compiler the routine may be slower, and gets the new result.

The note is made at such a read in the routine itself. A slow quantity, such as a temperature, may rightly be taken so.

**Fix:** request the interrupt at the end of the last conversion of the trigger.
""", "TRM ADC, ADCINTSEL1N2",
    ),
    _rule(
        "flag-not-cleared",
        Severity.ERROR,
        "An old flag was taken for a new event, or blocks it.",
        """
The driver always reads the result of the event before, or an interrupt comes once and never again.

Flags of this chip stay set until the program clears them. A wait for a flag that is already set ends at once. And an
interrupt is generated only for the first event: while the flag (`ADCINT`, `QFLG.INT`) or the acknowledge bit of the
group (`PIEACK`) is set, later events generate none.

The finding is made where the program believes the old flag, or where an interrupt is lost:

* ADC: a result is read while its conversion still runs, and the flag of the conversion before is set; or the flag
  triggers the DMA only, and neither `INTxCONT` nor a statement lets it trigger again;
* SPI: `INT_FLAG` is read while a word is being shifted, and it belongs to the word before;
* eQEP and CPU timer: the program sees the second time-out without a clear since the first (`QCLR`, `TCR.TIF`);
* eQEP: a test wants `QEPSTS.COEF` or `CDEF` not to be set, and no statement clears it: a standstill or a turn sets it;
* I2C: the program gives up a message because of an old `NACK`, before the address was answered;
* SCI: the program empties the FIFO a second time for one overflow (`RXFFOVF`);
* ePWM: the one-shot latch (`TZFLG.OST`) stays set while the program clears `TZFLG.INT` again and again;
* CAN: `NewDat` stays set, and the program takes the same message again and again;
* PIE: a routine leaves its flag or `PIEACK` set. At the end of a run that is told also of interrupts that have not come
  (eCAP, ePWM, eQEP, ADC, FIFOs, CAN): no statement of the program clears the flag after the start-up. Not told is a
  routine that disables the interrupt, stops the program, or only stores constants that nothing takes back;
* PIE: a routine acknowledges another group than that of its interrupt. Its own group is acknowledged by nobody, or by
  its other routines, which cannot run meanwhile. Not told if the value is not known, or if it is `|=` or a bit: these
  write back what they read, and so acknowledge each group whose bit is set;
* a test of an error that stays (`RXERROR`, `RXFFOVF`, `OVERRUN_FLAG`, `COEF`, `PHE`, `OST`, `NACK`, `BOff` and others)
  leads to a count, or away from the received character, and no statement clears the error after the start-up. A SCI
  keeps its errors until `SWRESET`.

**Fix:** clear the flag *before* the action that will set it again. ADC: `ADCINTFLGCLR`. SPI: read `SPIRXBUF` after
each word, also after a word that was only sent. eQEP: `QCLR`. I2C: `NACK`. SCI: `RXFFOVF`. Write `PIEACK` in every
interrupt routine.
""",
        "TRM ADC interrupts, SPI INT_FLAG, eQEP QCLR, PIE acknowledge",
    ),
    _rule(
        "adc-flag-shared",
        Severity.ERROR,
        "An ADC interrupt was moved to another SOC during a conversion.",
        """
The driver waits for ever, or takes the end of another conversion for the end of its own.

One `ADCINT` belongs to one SOC at a time. If the program changes `INT1SEL` during a conversion that should set the
flag, the end of that conversion sets nothing. This needs two tasks (or a task and an interrupt) that both change the
selection, and one must interrupt the other within the microsecond of a conversion.

**Fix:** one `ADCINT` for each user, or a gate around selection, start, wait and read.
""",
        "TRM ADC: ADCINTSEL1N2",
    ),
    _rule(
        "adc-not-powered",
        Severity.ERROR,
        "A conversion began before the analog core was powered up.",
        """
The first results have no meaning.

The analog core needs 500 us after `ADCCTL1.ADCPWDNZ = 1`. A conversion that begins earlier ends in time and sets its
flag, but its result is not a measurement.

**Fix:** `DELAY_US(500)` or more after the power-up, once.
""",
        "TRM ADC: power-up sequence",
    ),
    _rule(
        "adc-window",
        Severity.ERROR,
        "The sample window of a conversion is too short.",
        """
The result contains a part of the channel that was converted before.

The sampling capacitor needs a window of at least 75 ns (12 bits) or 320 ns (16 bits) to charge. At 200 MHz that is
`ACQPS` = 14 or 63. A source with a high resistance needs more.

**Fix:** set `ACQPS` in every `ADCSOCnCTL` that is used; its reset value is too small.
""",
        "DS, ADC timing; TRM ADC: ACQPS",
    ),
    _rule(
        "adc-input-open",
        Severity.WARNING,
        "The program converts an input of the ADC to which nothing is connected.",
        """
The result has no meaning: the input floats, and often follows the channel that was converted before it.

The board has a part at another input of the same ADC, which the program never converts. So `CHSEL` probably names the
wrong channel. The finding is made at the end of a run, at the statement that sets `CHSEL`, if the program reads the
result. A program that converts all inputs that the board uses, and others too, is not reported. Without a board of its
own (`--board`) a program may be meant for other parts: then the finding is a note.

**Fix:** set `CHSEL` to the input that the part is connected to; see the schematic.
""",
        "TRM ADC: ADCSOCxCTL, CHSEL; DS, analog subsystem",
    ),
    _rule(
        "half-duty",
        Severity.NOTE,
        "An output of an up-down counter changes only on the way up: its duty is half of what the compare value says.",
        """
The motor, the lamp or the converter gets half of the power, and the frequency is half of what it was.

The actions are those of a counter that counts up: the output is set at zero and cleared at the compare value. A counter
that counts up and down passes zero once in two times `TBPRD`, and on the way down nothing happens. So the duty is
`CMPA / (2 * TBPRD)`, and never more than 50 %.

The finding is made at the end of a run, where the counting mode is set, if the program computes the compare value and
has gone beyond half of `TBPRD`. It is a note, because an output that must never have more than 50 % may be made so.

**Fix:** `CTRMODE = 0` for these actions, with a period of `TBPRD + 1`. For a symmetric pulse use `CAU` and `CAD`.
""",
        "TRM ePWM: action qualifier, waveforms of up-down count mode",
    ),
    _rule(
        "adc-clock",
        Severity.ERROR,
        "The ADC's clock is above its limit.",
        """
ADCCLK may be 50 MHz at most. At 200 MHz the divider must be 4 or more, so `ADCCTL2.PRESCALE` must be 6 or more. The
reset value is the smallest divider. Above the limit the data sheet specifies nothing.

**Fix:** `PRESCALE = 6` at 200 MHz, before the converter is powered up.
""",
        "DS, ADC characteristics",
    ),
    _rule(
        "adc-mode",
        Severity.ERROR,
        "The resolution and the signal mode of the ADC do not match.",
        """
The data sheet specifies no accuracy for the results.

The chip has two modes only: 12 bits single-ended, and 16 bits differential. Each mode needs its own trim values.

**Fix:** set the mode with `AdcSetMode`, which also loads the trim values of the mode.
""",
        "TRM ADC: ADCCTL2; HDR F2837xS_Adc.c",
    ),
    _rule(
        "adc-burst",
        Severity.WARNING,
        "An ADC burst does not fit the round robin, or uses an SOC that was not set up.",
        """
The results change places from burst to burst, or one of them belongs to channel 0.

With `BURSTEN` each trigger starts the next `BURSTSIZE + 1` SOCs of the round robin. The round robin contains the SOCs
from `SOCPRIORITY` to 15, and then begins at `SOCPRIORITY` again. With four SOCs and bursts of three, the second burst
begins at the fourth SOC. An SOC that the program did not set up converts channel 0 with the shortest window.

**Fix:** as many SOCs in the round robin as a burst has, or a multiple: `SOCPRIORITY = 16 - (BURSTSIZE + 1)`, and the
sources in the last SOCs.
""",
        "TRM ADC: burst mode",
    ),
    _rule(
        "adc-limit-signed",
        Severity.ERROR,
        "A post-processing block compares a negative result with a limit, which this silicon does wrong.",
        """
An interrupt of a limit comes in the emulator and not on the chip, or the other way round.

`ADCPPBxRESULT` is negative if `ADCPPBxOFFREF` is above the result (or below it, with `TWOSCOMPEN`). The manual
compares it with `TRIPHI` and `TRIPLO` as signed numbers. The silicon does not (erratum). The emulator follows the
manual.

**Fix:** leave `ADCPPBxOFFREF` at 0 where the limits generate interrupts. A second block of the same SOC may subtract
the reference and detect the zero crossing.
""",
        "ERR, ADC: post-processing block limit compare",
    ),
    _rule(
        "data-lost",
        Severity.ERROR,
        "A word or a request was lost: the one before it was still waiting.",
        """
A character, a word or a conversion is missing.

A new word arrived while the one before was still waiting, so one of them is lost. The finding names the register:

* a word arrived in `SPIRXBUF`, `SCIRXBUF` or `I2CDRR` before the last one was read, or the FIFO was full;
* the program wrote `SPITXBUF`, `SCITXBUF` or `I2CDXR` while a word waited there;
* an SOC was triggered again before its conversion had begun (`ADCSOCOVF1`);
* a DMA channel got a second request before it had served the first;
* 16 characters came to an SCI FIFO that the program had used and then held in reset (`RXFIFORESET`).

The hardware sets an overflow flag in most of these cases, and the program does not look at it.

A program that only sends on an SPI loses what comes back. If it never reads `SPIRXBUF`, it is not told. If it uses none
of the words that it reads, the finding of `hil check` is a note.

**Fix:** read in time (interrupt, FIFO), or wait for room (`BUFFULL_FLAG`, `TXRDY`, FIFO level) before a write.
""",
        "TRM SPI, SCI, ADC: overrun and overflow flags",
    ),
    _rule(
        "locked",
        Severity.WARNING,
        "A register was written while its lock was set.",
        """
A configuration register keeps its old value after a write.

Lock registers (`GPxLOCK`, `CPUSYSLOCK1`, `INPUTSELECTLOCK` and those of other modules) freeze the configuration until
the program clears the lock, or until reset. The register ignores the write, without an error.

**Fix:** finish the configuration before you set the lock.
""",
        "TRM GPIO: GPxLOCK; system control: CPUSYSLOCK1; X-BAR: INPUTSELECTLOCK",
    ),
    _rule(
        "contention",
        Severity.ERROR,
        "A pin of the chip drives against another driver.",
        """
Two push-pull outputs drive one wire to different levels. On the board they short the supply, and one of them can be
damaged. In the emulator the wire reads 0.

**Fix:** make the pin an input before the other side drives. Check the direction and the function of the pin.
""",
        "TRM GPIO: GPxDIR",
    ),
    _rule(
        "dma-address",
        Severity.ERROR,
        "A DMA channel uses an address that the DMA cannot reach.",
        """
The DMA channel counts and interrupts as if all were well, but the data are zeros or do not arrive.

The DMA has its own bus. It reaches only these addresses:

* the global shared RAM (`RAMGS0` to `RAMGS15`) and the ADC results;
* over the first bridge (`SECMSEL.PF1SEL`): ePWM, eCAP, eQEP, DAC, CMPSS, SDFM;
* over the second bridge (`PF2SEL`): McBSP, SPI, uPP.

A bridge belongs to the CLA until its field is set to 1. In the emulator a read of any other address gives 0, and a
write there is lost.

**Fix:** place the buffers in a `ramgs` section (`#pragma DATA_SECTION`), and set the field of the bridge between
`EALLOW` and `EDIS`.
""",
        "TRM, DMA and system control: SECMSEL; DS, memory map",
    ),
    _rule(
        "fifo-level",
        Severity.WARNING,
        "Words wait in a receive FIFO, because its interrupt comes at more words than there are.",
        """
Words stay in the FIFO and are taken as the beginning of the next block, so that two blocks are mixed and each word
is late. Or the end of a message waits there, and is answered only when the next message comes.

The interrupt comes at `RXFFIL` words. There are two findings:

* At the read, when the routine has acknowledged three times in a row with fewer words taken than `RXFFIL`, and some
  left. A routine that takes as many as the level, or all of them (`RXFFST`), is right, and so is one that leaves all of
  them to a task.
* At the statement that sets `RXFFIL`, when three messages of the SCI have ended with fewer characters in the FIFO, and
  nobody has taken these before the next message. A message is a row of characters without a pause, and ends with a
  pause of 5 ms. Messages whose lengths are multiples of the level are right, and so is a program that takes the rest
  by itself (`RXFFST`) after a while.

**Fix:** set `RXFFIL` to the number of words that the routine takes, or read until `RXFFST` is 0. For messages of any
length set it to 1, or look into the FIFO from a timer too.
""",
        "TRM, SPI and SCI: FIFO interrupts",
    ),
    _rule(
        "dma-section",
        Severity.WARNING,
        "A buffer of the DMA has no section of its own, while another one has.",
        """
The DMA reaches the global shared RAM (`RAMGS0` to `RAMGS15`), and not the local RAM, where a linker's command file
usually puts objects without a section. Then the channel moves zeros, without an error.

Where objects lie is not modelled. The program places one buffer of the DMA by `#pragma DATA_SECTION`, so that this one
needs it too.

**Fix:** place each buffer of the DMA in a `ramgs` section.
""",
        "TRM, DMA; DS, memory map",
    ),
    _rule(
        "dma-range",
        Severity.ERROR,
        "A DMA transfer leaves the object in which it began.",
        """
The DMA counts words, and knows nothing of arrays: what lies behind the array is read or overwritten, and no pointer
shows it. `BURST_SIZE` and `TRANSFER_SIZE` hold the number of words of a burst less one, and of bursts less one.

The finding is at the statement that sets the sizes.

**Fix:** set both sizes less one, and check that bursts times words is not more than the array has.
""",
        "TRM, DMA: BURST_SIZE, TRANSFER_SIZE",
    ),
    _rule(
        "dma-step",
        Severity.ERROR,
        "A step of a DMA channel is too small: words are read or written twice.",
        """
`BURST_STEP` is added behind each access of a burst, `TRANSFER_STEP` behind the last access of a burst. They count
words of 16 bits, in 32-bit mode too: there a step of 1 meets each double word twice. A step of 0 is right for a
register (a result, a FIFO), and for one word that fills a block. Of an array it uses one word again and again.

**Fix:** use a step of 1 with 16 bits, and of 2 with 32 bits, within bursts and between them.
""",
        "TRM, DMA: address generation",
    ),
    _rule(
        "dma-unfinished",
        Severity.WARNING,
        "A DMA channel is started again before its transfer has ended.",
        """
A trigger moves one burst. Without `ONESHOT` a channel that only the program triggers needs as many `PERINTFRC` as the
transfer has bursts. Setting `RUN` again begins no new transfer: the next trigger moves the next burst of the old one.

The finding is at the statement that sets `MODE`.

**Fix:** set `ONESHOT`, or give a trigger for each burst and start the channel once.
""",
        "TRM, DMA: one-shot mode, CONTROL.RUN",
    ),
    _rule(
        "dma-race",
        Severity.WARNING,
        "The program uses a buffer while a DMA channel that it has triggered still moves it.",
        """
The program has triggered a copy by `PERINTFRC`, and reads the target, or rewrites the source, while words are still on
their way. How many have arrived depends on the clock, on other channels and on the build.

A loop that only polls a word of the target is not reported, nor are transfers that a module triggers.

**Fix:** wait for the interrupt at the end of the transfer, or until `CONTROL.TRANSFERSTS` is 0, with a limit.
""",
        "TRM, DMA: CONTROL.TRANSFERSTS, CHINTMODE",
    ),
    _rule(
        "interrupt-without-handler",
        Severity.ERROR,
        "An interrupt was taken that has no handler.",
        """
The program jumps to a random address when the interrupt comes.

`PIEIER` and `IER` enable the line, and no routine is in its vector. The CPU jumps to the address that the vector RAM
happens to hold.

**Fix:** set the vector before you enable the line; enable only lines that have a routine.
""",
        "TRM PIE: vector table",
    ),
    _rule(
        "isr-keyword",
        Severity.ERROR,
        "A function returns in another way than its caller expects: `interrupt` is missing, or too much.",
        """
The program dies at the first interrupt, or a little later with registers that nobody has written.

The CPU calls a routine of the vector table: it must save the registers that it uses, and end with `IRET`. The compiler
does both only for a function that is declared `interrupt` (or `__interrupt`, or named by `#pragma INTERRUPT`). Another
function ends with `LRETR`, takes the wrong words from the stack, and leaves INTM set. It is told when it returns; a
routine that never returns, like the default ones of TI's libraries, is right.

The function of a SYS/BIOS Hwi is called by the kernel's dispatcher. There the word is wrong: `IRET` takes words from
the stack that the dispatcher has not put there.

The run goes on as if the function were declared as it should be. A Python driver has no word for it, and is not told.

**Fix:** write `__interrupt` before the routine that is written to `PieVectTable` or given to `Interrupt_register`;
leave it out before the function of a Hwi.
""",
        "SPRU514, the interrupt keyword; TRM PIE: vector table; SYS/BIOS Hwi",
    ),
    _rule(
        "interrupt-storm",
        Severity.ERROR,
        "Interrupts follow each other without a gap, and nothing else runs.",
        """
The program seems dead. The debugger finds it in the same interrupt routine each time.

The interrupt comes again as soon as its routine returns. The interrupted code (`main`, a task, or a routine that
allows interrupts) does not execute one statement in between. It is a storm after 1000 interrupts in a row that took
2,000,000 cycles (10 ms at 200 MHz) in all, or after 50 that took 0.75 s. The run ends there. An interrupt that leaves
one statement each time is not reported, however fast it is.

Typical causes: a timer with a period of 0, or shorter than its routine; an ADC in continuous mode whose conversions
are shorter than the routine; a FIFO flag that is cleared while the level still holds, so the hardware sets it again at
once; a routine that sets its own flag in `PIEIFR` or `IFR`.

**Fix:** remove the cause before you clear the flag: read the FIFO, fill it, or disable the interrupt until there is
work. Make the period longer than the routine and all other code that must run. Collect samples with conversions that
an ePWM triggers, or with the DMA.
""",
        "TRM PIE; TRM SCI, FIFO interrupt flags",
    ),
    _rule(
        "watchdog-reset",
        Severity.ERROR,
        "The watchdog reset the device.",
        """
The program starts again from the beginning. RAM keeps its contents, and the peripherals are reset.

The program did not write 0x55 and then 0xAA to `WDKEY` in time, or it wrote them before the window opened, or it wrote
`WDCR` without its check bits. If the program wrote 0x55 and then not 0xAA, the finding is at the statement that wrote
0x55.

In the emulator a SYS/BIOS program ends here: its pins become inputs, so the motors are off, and the world continues
without it. Start a new run to start the program again. A program without the kernel continues as if it had not been
reset.

**Fix:** service the watchdog in the slowest loop that must run, or disable it, as the start-up code does here.
""",
        "TRM system control: watchdog",
    ),
    _rule(
        "watchdog-in-vain",
        Severity.WARNING,
        "The watchdog is serviced although a part of the program hangs.",
        """
A part of the program hangs, and the watchdog does not reset the chip. The watchdog exists for exactly this case.

* `main` hangs, and an interrupt routine still writes 0x55 and 0xAA to `WDKEY`. `hil check FILE...` reports it at the
  end of a run in which `main` hangs in a loop (`endless-poll`). The place is the statement that services the watchdog.
* The watchdog is serviced on signs of life that nothing takes back. Tasks set their bits (`Alive |= CONTROL`), the
  supervisor tests them (`if ((Alive & ALL) == ALL) ServiceDog();`), and no statement clears them: from the first time
  on the test stays true. This is reported in the source of a whole program, at the test. One real sign of life beside
  it is enough: then nothing is reported. Nor is a flag that only the start-up sets.
* Signs of life are taken back beside the service, and no statement reads them: `Alive = 0; ServiceDog();`.

**Fix:** service the watchdog in the loop of `main`. If an interrupt must do it, let `main` set a flag in each pass,
and let the routine service the watchdog only if the flag is set, and then clear it. A supervisor clears the signs of
life that it has seen.
""",
        "TRM system control: watchdog",
        how="dynamic/static",
    ),
    _rule(
        "epwm-shadow-lost",
        Severity.WARNING,
        "A value in a shadow register was lost before it was loaded.",
        """
A new compare value, period or action never becomes active.

The program wrote the value to the shadow register and then switched the register to immediate mode before the load
event. In immediate mode the hardware uses the active register, and the value in the shadow is lost.

**Fix:** select the mode before you write the value.
""",
        "TRM ePWM: shadow registers",
    ),
    _rule(
        "eqep-prescaler",
        Severity.WARNING,
        "The prescalers of the eQEP capture unit were changed while it ran.",
        """
One measured period is wrong.

The prescalers `UPPS` and `CCPS` may be changed only while `CEN = 0`. If they change while the capture unit runs, the
measurement under way mixes two units.

**Fix:** clear `QCAPCTL.CEN`, set the prescalers, set `CEN`.
""",
        "TRM eQEP: QCAPCTL",
    ),
    _rule(
        "i2c-clock",
        Severity.ERROR,
        "The module clock or the bus clock of the I2C is out of range.",
        """
Transfers on the I2C bus fail with some targets.

The module clock is SYSCLK / (`IPSC` + 1). The module counts all bus timing in it, and it needs 7 to 12 MHz, whatever
`I2CCLKL` and `I2CCLKH` are. At 200 MHz `IPSC` must be 16 to 27. SCL may have 400 kHz at most. A bit lasts `I2CCLKL` +
d + `I2CCLKH` + d module clocks, where d is 7, 6 or 5 for `IPSC` = 0, 1 or more.

The check is made at each START.

**Fix:** first set `IPSC` while `IRS = 0`, then `I2CCLKL` and `I2CCLKH` for the rate of SCL.
""",
        "TRM I2C: clock generation, I2CPSC",
    ),
    _rule(
        "i2c-slow",
        Severity.NOTE,
        "The bus clock of the I2C is below 10 kHz.",
        """
Transfers take so long that the program gives up before they end, or a part on the bus does.

SCL is slower than 10 kHz, the least that SMBus allows: parts with its time-outs let go of a slow bus. The message gives
the rate and the time of one byte. Usual rates are 100 and 400 kHz. A rate a thousand times lower is often one in kHz
where Hz are wanted.

A part without time-outs works at any low rate, so this is a note. The check is made at each START; the finding is at
the statement that set the dividers.

**Fix:** set `I2CCLKL` and `I2CCLKH` for the rate of SCL, or give the rate to the library in Hz.
""",
        "SMBus specification 3.2, AC specifications: FSMB; TRM I2C: clock generation",
    ),
    _rule(
        "i2c-fifo-interrupt",
        Severity.ERROR,
        "Interrupts of XRDY or RRDY are enabled while the I2C is in FIFO mode.",
        """
The interrupt routine sends or takes bytes at wrong times, or never.

With `I2CFFTX.I2CFFEN = 1` the FIFOs write `I2CDXR` and read `I2CDRR`. The flags `XRDY` and `RRDY` then say nothing to
the program, and the manual forbids their interrupts in this mode.

**Fix:** clear `XRDY` and `RRDY` in `I2CIER`, and use `TXFFIENA` and `RXFFIENA` with their levels (interrupt 8.2 or
8.4).
""",
        "TRM I2C: basic interrupt requests, XRDYINT and RRDYINT",
    ),
    _rule(
        "i2c-prescaler",
        Severity.ERROR,
        "The prescaler of the I2C was changed while the module ran.",
        """
The bus keeps its old clock, although `I2CPSC` reads back the new value.

`I2CPSC` takes effect when `IRS` changes from 0 to 1.

**Fix:** clear `I2CMDR.IRS`, write `I2CPSC`, set `IRS`.
""",
        "TRM I2C: clock generation, I2CPSC",
    ),
    _rule(
        "can-interface-busy",
        Severity.ERROR,
        "A register of a CAN interface was used during a transfer.",
        """
A CAN message is sent with old data, or the program reads the data of the message before.

A write of the message number to `CAN_IF1CMD` or `CAN_IF2CMD` starts a transfer between the interface and the message
RAM. Until the transfer ends, `Busy` is 1. The interface ignores all writes during this time, also a write of the next
command. The data that a command fetches arrive only at the end of the transfer, so a read before that gives the
previous message.

**Fix:** wait for `Busy` = 0 before each use of an interface, and use one interface in tasks and the other one in
interrupts.
""",
        "TRM CAN: IF1/IF2 command registers, Busy",
    ),
    _rule(
        "can-part-lost",
        Severity.ERROR,
        "What was written to a CAN interface is lost: its command does not move it.",
        """
A message object does not become valid, accepts other identifiers than it should, or sends the data of the message
before.

A command moves only the parts whose bits it sets: `Mask`, `Arb` (identifier, direction, `MsgVal`), `Control`, `DATA_A`
and `DATA_B`. The parts that it does not move are read back from the object, so that what the program has written there
is gone.

These commands are reported, at the statement that gives them:

* without `Arb`, while `MsgVal` was written for an object that is not valid;
* without `Mask` or `Control`, while another mask (with `UMask`), length, interrupt or end of a FIFO was written;
* without `DATA_A` or `DATA_B`, while it requests a transmission with new bytes there.

What is written and is the same as in the object is not reported.

**Fix:** set the bit of each part that was written.
""",
        "TRM CAN: IF1/IF2 command registers; Bosch C_CAN: interface registers",
    ),
    _rule(
        "i2c-stop-pending",
        Severity.ERROR,
        "A START was requested before the previous STOP was done.",
        """
`I2CMDR.STP` stays 1 until the module has made the STOP condition, some time after the last byte. The manual requires
`STP` = 0 before a new message is set up. No document says what a START in between does. The emulator makes it after
the byte or the STOP that is under way; the chip may do something else.

**Fix:** test `I2CMDR.bit.STP` before you write the registers of a new message.
""",
        "TRM I2C: I2CMDR, STP",
    ),
    _rule(
        "i2c-left-busy",
        Severity.WARNING,
        "The driver leaves the I2C bus busy.",
        """
After a NACK of an address or a byte, the controller holds SCL low and waits: the program must set STOP or a new START.
Until then `BB` is 1. A driver that waits for `BB` to fall, or that sends nothing while it is 1, waits for itself.

The finding is made at the first read of `I2CSTR` that comes 100 ms (CHOICE) or more after the first read since the
NACK, if neither `STT` nor `STP` was written between them (also if `STP` was set before: its effect then is a choice,
`stops_when_refused`).

A message that was acknowledged and begins without `STP` holds the bus too. It is reported if the program then reads
`I2CSTR` a thousand times, for half a millisecond or more, and resets the module (`IRS = 0`).

**Fix:** `STP` in the command of the last part of a message; after a NACK, set `STP` where `NACK` was seen, wait for
`BB` to fall, and clear `NACK`.
""",
        "TRM I2C: NACK, bus activity by RM, STT and STP",
    ),
    _rule(
        "i2c-count",
        Severity.ERROR,
        "A driver waits for more bytes than its I2C message has.",
        """
The driver times out at every message, although the part answers.

In non-repeat mode `I2CCNT` bytes are received, and then the STOP follows. `RRDY` does not come again. Typical: the
count of the part of the message that sent the register's address (1) is left for the part that receives.

The finding is made if the program reads `I2CSTR` a thousand times after the end of a message that received bytes, for
half a millisecond or more, and then resets the module (`IRS = 0`), and if there was no NACK.

**Fix:** write `I2CCNT` before each command that sets `STT`.
""",
        "TRM I2C: I2CCNT",
    ),
    _rule(
        "spi-mode",
        Severity.ERROR,
        "A device was addressed in an SPI clock mode that it does not support.",
        """
Every byte is shifted by one bit: numbers are doubled, halved or odd.

Clock polarity and phase decide at which edge each side samples. The phase bit of this chip (`CLK_PHASE`) is the
inverse of the usual CPHA: mode 0 is `CLKPOLARITY = 0, CLK_PHASE = 1`, mode 1 is 0 and 0, mode 2 is 1 and 1, mode 3 is
1 and 0.

A part of your own board says which modes it takes: `clock_modes = (1,)` in its class.

**Fix:** for mode 0 of the gyro `CLKPOLARITY = 0, CLK_PHASE = 1`, for mode 3 `CLKPOLARITY = 1, CLK_PHASE = 0`.
""",
        "TRM SPI: clocking schemes; L3G, SPI bus interface",
    ),
    _rule(
        "spi-width",
        Severity.ERROR,
        "Words with more bits than the characters of the SPI were written, and their lower bits were never sent.",
        """
The device gets zeros, or only every second byte.

The SPI sends `SPITXBUF` from bit 15 down, `SPICHAR` + 1 bits. With 8-bit characters it does not send the lower half of
the word. So `SPITXBUF = c` sends zeros, and a driver that writes 16 bits loses every second byte.

The finding is made at the second of two words that lose different bits. A word whose remaining bits are written next
(`w`, then `w << 8`) loses nothing and is not reported. It is also made when the chip select rises behind a transaction
that sent only zeros, at the first word that held something else, if the words were not all the same: a driver that only
wants an answer repeats one word.

**Fix:** `SPITXBUF = c << 8` for a byte; `SPICHAR = 15` for words.
""",
        "TRM SPI: SPITXBUF, left-justified; SPICHAR",
    ),
    _rule(
        "spi-transaction-cut",
        Severity.ERROR,
        "The chip select rose in the middle of a word or byte.",
        """
The last byte of a transaction has no effect.

The chip select rose before the byte was complete, and the device discards an incomplete byte. Usually the driver
waited for the wrong thing: for the flag of the word before, or for room in the transmit buffer, which does not mean
that the shift register is empty. Or a second task used the bus.

**Fix:** wait for `INT_FLAG` of the last word, read `SPIRXBUF`, then raise the chip select. Hold one gate for the whole
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

**Fix:** lower the chip select before the first word of a transaction, and make its pin an output.
""",
        "L3G, SPI bus interface",
    ),
    _rule(
        "device-register",
        Severity.WARNING,
        "A register of a device was accessed in a way that its data sheet forbids.",
        """
The program read or wrote a reserved address, wrote a read-only register, or set bits that must stay 0.

Reserved registers of the gyro hold its factory trim values. A write there can damage the part permanently.

**Fix:** check the address, the read bit and the auto-increment bit of the command byte.
""",
        "L3G, register mapping",
    ),
    _rule(
        "burst-repeats",
        Severity.ERROR,
        "A transaction with several bytes read or wrote the same register of a device again.",
        """
The low and the high byte of a value are equal, or all axes show the same. Or only the last of several settings has an
effect, and in the wrong register.

Some devices increment the register address within a transaction only if a bit of the command asks for that: MS on the
SPI, bit 7 of the sub-address on the I2C (L3G4200D, LIS3DH). Without the bit, every byte of the transaction comes from
the first register, or goes to it.

A read is reported only where a value of two bytes begins, at the second such transaction, if the driver has not read
the other byte by itself in between. So a status register that is polled within one transaction is not reported.

**Fix:** set the bit in the command (`0x80 | 0x40 | address` on the SPI, `0x80 | address` on the I2C), or read each
register in a transaction of its own.
""",
        "L3G, SPI bus interface: MS; I2C operation: SUB",
    ),
    _rule(
        "eeprom-page",
        Severity.ERROR,
        "A write to an EEPROM crossed the end of a page.",
        """
After a write, the data at the beginning of a page are overwritten, and the next page did not change.

While the EEPROM receives a message, it increments only the lower six bits of its address: a page has 64 bytes. After
the last byte of the page the address returns to the first byte of the same page. If a message is longer than a page,
its first bytes are lost. The EEPROM acknowledges every byte.

The finding is made at the STOP that begins the write cycle.

**Fix:** end the message at the end of the page, wait for the write cycle (poll for the acknowledge), then begin the
next message.
""",
        "AT24C256: page write",
    ),
    _rule(
        "eeprom-busy",
        Severity.ERROR,
        "An EEPROM was addressed in its write cycle, and nobody asked again.",
        """
Every record counts as an error, although it is written, or every second record is missing.

After the STOP of a write the EEPROM is busy for up to 5 ms. It does not acknowledge its address in this time, and takes
no part in the message.

The finding is made if the EEPROM was addressed in its write cycle three times in a row, and each time not once more
within the next four write cycles (20 ms). A driver that polls for the acknowledge, or comes back soon, is right. It is
at the statement that made both accesses, the write and the refused one.

**Fix:** poll for the acknowledge, or wait 5 ms, after each write.
""",
        "AT24C256: acknowledge polling, write cycle time",
    ),
    _rule(
        "endless-retry",
        Severity.WARNING,
        "A transaction that a part refuses is repeated without a limit.",
        """
Without the part, or with a broken wire, the program never goes on: no control, no answer, no message about the fault.

The finding is made when a run ends in a loop that repeats a transaction on the I2C until it works, which it has done
for the last quarter of a second, or for half of a shorter run, and no address was acknowledged. It is at the loop.

**Fix:** limit the number of attempts, go on without the part, and report the fault.
""",
        "TRM, I2C: NACK",
    ),
    _rule(
        "endless-poll",
        Severity.ERROR,
        "A polling loop waits for an event that cannot come.",
        """
The task hangs in a polling loop, and so does every task of lower priority.

The loop only reads, and no event is left that could change what it reads, or none for a very long time. Typical
causes: a conversion that was never started, an interrupt flag that is not selected, a transmitter in reset.

The idle loop of a program (`while (1) ;`) reads nothing and is not reported, because interrupts run in between. In an
interrupt routine such a loop is reported, because nothing interrupts the routine.

A program may wait for a button, a byte or an interrupt: `hil check` makes that a note. It stays an error if only
interrupt routines could end the wait and none of them can run (see `not-connected`); if a part on the I2C has sent no
acknowledgment and the loop does not look at `NACK`; and if no node of a CAN acknowledges a frame any more and the loop
waits for its end only (`TxRqst`, `TxOk`). `hil check FILE... --silence` runs the program with parts on the I2C and CAN
nodes that no longer answer from the middle of the run on, and so finds waits that hang only then.

**Fix:** give each wait a limit (a count or a time) and handle the time-out. Check that the event is configured before
the wait begins.
""",
    ),
)
