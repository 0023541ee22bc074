"""Properties of drivers and of the closed loop: what must hold of any correct implementation, each stated once.

No detector reports these while the firmware runs: a property test does, `hil check` by the text, or a demonstration of
the catalogue, with what it measured in the message.  The units stand in each page.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "property")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "rotation-sign", Severity.ERROR, "A measured rotation has the wrong sign, or one direction is lost.", """
The driver reads a turn to one side as a turn to the other side, or as 0.

The test turns the robot at a known rate (rad/s or degrees/s) in both directions, and the reading must have the sign of
the turn. Two bytes of the sensor form a 16-bit number in two's complement. If they pass through an unsigned type, or
if values above 32767 are cut off, one direction becomes a large positive rate or 0. Each conversion is defined in C,
so no compiler warns.

**Fix:** combine the bytes as `unsigned`, convert the 16-bit result once to a signed 16-bit type, and only then scale
it.
""", "L3G4200D data sheet, OUT_X_L..OUT_Z_H: two's complement",
    ),
    _rule(
        "rotation-scale", Severity.ERROR, "A measured rotation has the wrong scale.", """
A turn of 90 degrees ends too early or too late.

The reading divided by the true rate must be 1 within the tolerance of the part, at every full scale that the driver
can select. The sensitivity in the data sheet is a figure of its own: 8.75, 17.5 and 70 mdps per digit at 250, 500 and
2000 dps. It is not full scale divided by 32768, which is 13 % too small. The integrated angle has the same error: the
driver reads a quarter turn 11 degrees short.

**Fix:** multiply by the sensitivity in the data sheet for the full scale that is configured.
""", "L3G4200D data sheet, table of mechanical characteristics: So",
    ),
    _rule(
        "rotation-bias", Severity.WARNING, "A robot at rest measures a rotation.", """
The robot stands still, and its heading drifts.

At rest the corrected rate must stay within a bound (degrees/s). The bound follows from the part's zero-rate level and
noise after calibration. An offset is wrong if it is averaged over too few samples, summed in a type that overflows, or
measured while the robot moves. It then stays in every later reading, and the integrated angle grows without limit.

**Fix:** average new samples (data ready) in a 32-bit sum, at rest. Check their spread before you accept the mean.
""", "L3G4200D data sheet: DVoff, OffDr",
    ),
    _rule(
        "outlier-bound", Severity.ERROR, "One outlier moves a filtered distance too far.", """
One wrong echo moves the measured distance.

Twelve conversions make one distance. The test replaces one of them by any other value of the ADC's range. The result
may then move by no more than the spread of the other eleven (cm). A median satisfies this. A mean lets a twelfth of
the error through. A sort that is wrong, or that reads beside its array, lets any error through.

**Fix:** sort a copy completely and take the middle value (for an even number, the mean of the two middle values).
""",
    ),
    _rule(
        "distance-scale", Severity.ERROR, "A measured distance is wrong by more than the sensor's resolution.", """
The measured distance is wrong by a constant or by a factor.

With a wall at a known distance (cm), the reading must agree within the sensor's resolution of one inch and the step of
the ADC. Typical causes: a slope for another supply voltage, a sum of twelve conversions divided by a number that is
not twelve, an offset that is added twice.

**Fix:** compute slope and offset from the supply, the reference and the number of conversions, and check both ends of
the range.
""", "LV-MaxSonar-EZ data sheet: Vcc/512 per inch",
    ),
    _rule(
        "odometry-path", Severity.ERROR, "The odometry differs from the path that was driven.", """
The path on the map differs from the path that the robot drove.

The test drives a path (straight, turn on the spot, arc, back to the start). Position (mm) and angle (rad) from the
wheels must follow the true path within wheel slip and encoder resolution, in every quadrant and in both directions.
Typical causes: different units on two branches (millimetres when straight, metres when turning), an angle that is not
wrapped, an integer division before scaling, the wrong sign of a turn, an overflow of a counter that is taken as a
jump.

**Fix:** use one unit everywhere. Compute the difference of counts in a signed type of the counter's width. Use one
formula for all turns.
""",
    ),
    _rule(
        "order-latency", Severity.WARNING, "An order takes effect too late.", """
The robot reacts late to an order.

From the end of the order's last byte to the first changed output (PWM, state, answer), no more than the stated time
(ms) may pass, whatever the robot does at that moment. An order is late if it waits behind a busy loop, behind a task
of higher priority that never sleeps, or in a buffer that is only checked now and then.

**Fix:** let the interrupt of the receiver wake the task that acts. Give long work a lower priority.
""",
    ),
    _rule(
        "malformed-frame", Severity.ERROR, "A malformed frame has an effect.", """
The robot obeys bytes that are not an order, or does not understand the next order.

Bytes that are not an order (cut off, too long, two run together, a wrong keyword or number) must leave state,
references, outputs and memory unchanged, and the next valid order must work. A parser that relies on a terminator
leaves its buffer. A parser that converts before it checks acts on half a number.

**Fix:** limit every loop to the buffer. Check the whole frame first, then act. Resynchronise at the start character.
""",
    ),
    _rule(
        "stop-stops", Severity.ERROR, "The robot still moves after a stop.", """
The robot still moves after STOP, or after the bumper.

Every motor must get its neutral output within one control period and keep it (PWM duty, m/s) until another order
comes. No reference may be remembered, no integral may stay in a controller, and no task may write an output once more.

**Fix:** set state, references, integrators and outputs in one place. Every task that writes an output tests the state.
""",
    ),
    _rule(
        "closed-loop", Severity.ERROR, "The closed loop does not follow its reference.", """
The robot does not drive as ordered: it settles on a wrong value, oscillates, or collides.

With an ordered speed (m/s) and rate (rad/s), the true motion must reach them without an error beyond the stated bound
and without oscillation. A mission must end without a collision.

**Fix:** check the inputs of the controller: unit, sign, sampling period, saturation of the integral.
""",
    ),
    _rule(
        "no-effect", Severity.WARNING, "A statement, an order or a setting has no effect.", """
The user gives an order, sets a parameter or calibrates, and nothing changes.

Every function of the program (an order of the protocol, a parameter, a calibration, a branch) must change some output
in some situation. If the same run with it and without it is equal byte for byte, it has no effect.

**Fix:** complete the function, or remove it.
""",
    ),
    _rule(
        "unit", Severity.ERROR, "A number is used in the wrong unit.", """
A number is right in one unit (mm, m, cm, inch, rad, degree, ms, tick, count), and the program uses, sends or compares
it in another.

C has no units: `float` is `float`. The finding names both units. A measured ratio near 10, 25.4, 57.3, 100 or 1000
shows the defect.

You can declare the unit of a value in a comment where it is declared: `// hil: unit cm` at an object; above a function
for its result; `// hil: unit v mm/s` for its parameter `v`. Then `hil check` reports each place where a value with one
unit goes to an object with another, and each sum or comparison of two units. The C library's angles are in radians:
what goes to a value in degrees, or comes from one, is reported. A weighted mean (`0.98 * a + 0.02 * b`) is a sum of
its parts.

**Fix:** put the unit into the name, convert at one place, and send what the protocol specifies.
""",
    ),
    _rule(
        "unit-by-name", Severity.WARNING, "A value goes where a name or a comment states another unit.", """
A time in microseconds goes where milliseconds are expected, an angle in radians where degrees are: the number is wrong
by a factor.

The units are those that names and comments state. A name states one by its end (`timeoutMs`, `SAMPLE_US`, `dist_mm`,
`TiltDegrees`, `tempTenthsDeg`, `angle_deg_x10`), a comment beside the declaration if it begins with nothing but a unit
(`// mV`, `// 0.1 degree`), or has one in brackets (`[mm]`). Ends that mean other things too count beside a word for the
quantity (`timeout_s`, `temperatureDc`), and in a sum, a comparison or an assignment with a value in another unit of
this quantity (`now_ms - since_ms > hold_s`), unless the letter is one of several (`LIMIT_A`, `LIMIT_B`). Time-outs and
periods of SYS/BIOS are in ticks, `DELAY_US` takes microseconds, angles of the C library are in radians. The message
names both units, and says where each comes from.

`hil check` reports a value that goes to an object, a parameter or a result with another unit of the same quantity, also
in a list of initial values, and sums and comparisons of two units. A constant factor converts: `x_ms * 1000` is
microseconds. A power of ten in the wrong direction, or the reverse of the right factor, is reported. So is a time that
is converted and goes where its own unit is expected (`delay_ms(GAP_MS * 1000)`); for ticks, if the program passes a
time in this unit on as it is elsewhere. Any other factor may mean something else, and is not.
A product with 180/pi (57.3) is in degrees: it is reported where it, or an object that takes only such products, goes to
`sinf` or to a value in radians. A share of a value (`FULL_MV * permille / 100`) that goes to its own quantity is
reported if its factor is ten times too large, for a share is no multiple; a smaller part of it can be meant.
A current times a time is a charge: `mA * ms` is not `mAs`. So are products of power and time, and of voltage and
current. A local that goes as it is to an object in a unit, and to no other, is in this unit. What the program counts
one by one, divided by a constant such as `STEPS_PER_MM`, is in millimetres.
A constant divided by a time is a rate, and divided by a rate a time (`1000 / dt_ms` is in Hz): it is reported if it is
wrong by 1000 or more, for pulses can be counted in tens; and if it is in Hz, and goes to a name in rpm. A comment about
60 (teeth) keeps this silent.
What comes from the ADC, an SPI or an encoder as it is, is reported where it meets a value in a unit (`counts > MAX_mV`)
to which the program converts it by a factor in another line.
Values of two quantities are reported only if no sensor makes one of the other without a factor. An object that is
printed as it is, in front of another unit (`sprintf(line, "%u mV", current_mA)`), is reported in any case.

A comment that speaks of a scale (`// in tenths`, `// counts per mV`), an amount in a name (`RATE_6400_HZ`), and an
object that the program converts where it is (`t_us /= 1000`) make the unit unknown.

**Fix:** convert the value, or correct the name. If both are meant so, accept it: `// hil: allow unit-by-name, REASON`.
""", how="static",
    ),
    _rule(
        "turns-by-name", Severity.NOTE, "A rate in Hz goes to a name in rpm.", """
`speed_rpm = 2.0e8f / period` is in turns a second if one pulse comes each turn: 60 times too little for turns a minute.

The number is one divided by a count of a timer, an eCAP or an eQEP, or by a time or a rate whose name states its unit,
and the name states rpm. It is a note, because a wheel with 60 teeth gives rpm: a comment about 60 keeps this silent.

**Fix:** multiply by 60, or say in a comment what the wheel has.
""", how="static",
    ),
    _rule(
        "unit-in-comment", Severity.NOTE, "The name of a constant states another unit than its comment.", """
`#define TIMEOUT_MS 5    // 5 s` is 5 ms by its name and 5 s by its comment: one of them is wrong.

The definition is a macro, a constant of an enumeration or a declaration with a number. The comment beside it begins
with a number and a unit (`// 85 degrees`), and in the unit that the name states it is the number of the definition
times a power of ten. Differences that are no power of ten are not reported:
they come from rounding, or from a comment that says something else.

**Fix:** correct the number, the name or the comment.
""", how="static",
    ),
    _rule(
        "period-by-name", Severity.WARNING, "A name states another period than its routine has.", """
Speeds and integrals are wrong by a power of ten: the program computes with a period that it does not have.

The name of a constant (a macro, a `const` object or a member of one) says that it is a period or a rate (`CONTROL_S`,
`LOOP_MS`, `SAMPLE_HZ`, `pi.dt_s`), and each run of an
interrupt routine multiplies with it or divides by it. In the run, the routine's period is a power of ten longer or
shorter. Somebody has changed the timer and not the constant, or the other way round.

The same is told of an object that counts time in the unit of its name by a constant (`tickMs++`, `motor.still_ms += 1`,
`left_ms--`), wherever that stands, and on which condition: the run shows how long it lasts from step to step. If the
steps come regularly, and the count is wrong by a factor of 1.8 or more, it is in another unit. Not meant is what gets
other values than 0 too, what goes to a register or a function (a delay, a pulse width), and a step that is
the length of something else (`given_ms += STROKE_MS`).

A constant is reported for routines that run steadily, for statements that every run executes (a control in each tenth
run has another period), and for functions that nothing else calls. Times that are no period by their name (`_TAU_`,
`_FILTER_`, `_DELAY_`, `_TIMEOUT_`) are not meant.

A constant that is handed to a function, which computes the period of a CPU timer from it and from nothing else that
changes (`startTimer(1, SAMPLE_HZ)`), is told where it is handed on if that timer is slower than it says, by any factor:
a prescaler of 1 that divides by 2. A faster timer may be divided by the program.

**Fix:** compute the timer's period from the constant, or correct the timer or the name.
""",
    ),
    _rule(
        "count-by-name", Severity.WARNING, "A count of a timer is taken for a time that it is not.", """
A pulse, a distance or a time-out is wrong by one factor: the counter counts faster or slower than the program reckons.

The value is a count of a CPU timer (`CpuTimer1Regs.TIM`), of an eCAP (`ECap1Regs.CAP2`), of the capture unit of an eQEP
(`EQep1Regs.QCPRD`), or a difference of such counts, also through objects, parameters and functions. How long a count
lasts, the registers say at the end of the run: the prescaler of the timer or of an eQEP's capture unit, SYSCLK for an
eCAP, TBCLK for an ePWM. Five uses are reported:

* the count goes where a name or a comment states a time (`width > GAP_US`), and a count does not last so long;
* it is divided by, or multiplied with, a constant whose name says how fast the counter counts (`CYCLES_PER_US`,
  `TICKS_PER_MS`, `TIMER_HZ`), and it counts with another frequency;
* a number divided by it goes where a name states a rate that is wrong by 1000 or more;
* a time by its name goes as it is to a register that makes a time of a count, and a count lasts another time:
  `CMPA`, `TBPRD`, `DBRED` of an ePWM, `PRD` of a timer, `CAP1` of an eCAP (`EPwm1Regs.CMPA.bit.CMPA = pulse_us`);
* a period is made of an object and of a constant whose name says how fast the counter counts (`PRD = SYSCLK_HZ /
  speed - 1`, `TBPRD = period_us * TBCLK_MHZ`), and it counts with another frequency.

Nothing is reported about a counter that stands and that no statement starts, an eCAP that prescales its edges, an
object that holds other values too, or another factor: half of an echo is a distance, too. Nor is a period that counts
up and down, one with several clocks, or one of an object without a unit that may be in tenths or have bits of a
fraction: there a prescaler of 10 or of 256 can be meant.

**Fix:** compute the prescaler or the constant from SYSCLK, which has 200 MHz.
""",
    ),
    _rule(
        "stated-rate", Severity.WARNING, "A rate that is stated beside a setting is not that of the hardware.", """
Samples come at half the rate, a control runs twice as fast, a line has another bit rate: somebody reckoned with a clock
that the chip does not have. TBCLK is EPWMCLK, which has 100 MHz after reset; LSPCLK has 50 MHz.

At the end of the run the period of a CPU timer or an ePWM is compared with what stands beside the statement that has
set it:

* a comment there, or beside a definition that the value uses (`// 200 MHz / 25000 = 8 kHz`, `/* 1 ms */`): what is
  behind the last `=` counts;
* a comment beside or above the definition of the period that says how long its counts last (`// 62500 counts are 20 ms
  (50 Hz)`), or how long a period does (`20 ms per period`);
* the name of a constant from which the count is computed (`TBCLK_HZ / CARRIER_HZ - 1`, `PERIOD_US * 200`).

So is the bit rate of an SCI with a comment beside the statements that set `SCIHBAUD` and `SCILBAUD`, above them, or
above their function (`// 38400 baud`). If the real rate is another usual one, the comment may be old: it is reported
only if the other end of the line, on your board, has another rate, too.

A constant from which `SCIHBAUD` and `SCILBAUD` are computed, and whose name says a bit rate (`BAUD`, `BAUD_RATE`,
`GPS_BAUDIOS`), is reported if the SCI has another one by more than 4 %, at the half that is wrong: the two halves may
disagree (`BAUD * 8` in one, `BAUD * 16` in the other), or LSPCLK has another frequency. Not reported is a rate that is
set a second time or measured by the SCI, nor one that no divider gives better.

A comment that is nothing but a time beside a wait (`DELAY_US(500);  // 5 ms`, `Task_sleep(10)`), or beside the
definition of its number, is reported if the two differ by a power of ten, but not in a loop that ends.

A call of `SCI_setConfig` or `SPI_setConfig` is reported if it is told another frequency than LSPCLK has.

A period is reported if the two rates differ by a power of two or of ten. Every rate of the ePWM counts: that of its
counter, its interrupts, its triggers (every third event, both ends of the period), and of a pin that toggles.
Comments about other counts, pulses, limits or delays are not meant, nor a period that two statements set, nor a count
with a factor of its own (`CLOCK_HZ / (2 * BLINK_HZ)`).

**Fix:** compute the period from the clock that is set; or correct the comment or the name.
""",
        "TRM CPU timers; ePWM: time-base period; SCI: baud rate",
    ),
    _rule(
        "pulse-swallowed",
        Severity.WARNING,
        "The dead band swallows the pulses of the least duty.",
        """
The switch stays off at the least duty and some way above it: a start, a charge pump or a current at low duty fails.

A dead band delays one edge of each pulse. A pulse that is not longer than `DBRED` (or `DBFED`) does not come out. In
the run an ePWM had a compare value for more than a period, the action qualifier made pulses of it, and none came out of
the output. The value is a constant that is the least one by its name (`DUTY_MIN`, `LEAST_DUTY`), which the source gives
to the compare register, or to an object that it gives to the register.

Other small duties are not reported: a controller may go through them. Neither is a constant below 1 % of the period,
which only keeps the value away from 0.

**Fix:** make the least duty longer than the dead band, or the dead band as short as the switches allow.
""",
        "TRM ePWM: dead-band submodule",
    ),
    _rule(
        "capture-edge", Severity.WARNING, "The time of an eCAP that is taken for a width is none.", """
An echo, a servo pulse or a PWM is measured as its period, or as a number that only grows: the distance is always the
same, or changes from one measurement to the next.

An eCAP takes the count of its counter at each event, and `CAP1POL` and `CAP2POL` say which edge an event is: 0 a rising
one, 1 a falling one. At the end of the run one of these holds:

* both are the same edge, and the program takes the time between them (`CAP2` where `CTRRST1` resets the counter, or
  `CAP2 - CAP1`) for a width: by the name of what gets it (`echoTicks`, `ancho`, `pulse_length`), or by a comment beside
  `CAP1POL` or `CAP2POL` that says the other edge;
* no event resets the counter, and `CAP2` alone, from which nothing is subtracted, goes to a width by its name.

Not reported is a program that measures a period by its names, takes `CAP3` or `CAP4` too, changes the edges while it
runs, prescales the input, or sets the counter itself.

**Fix:** capture the rising edge as event 1 and the falling one as event 2, and reset the counter with event 1
(`CTRRST1`), or subtract `CAP1`.
""",
        "TRM eCAP: capture mode; ECCTL1",
    ),
    _rule(
        "wrong-identity",
        Severity.WARNING,
        "The identity of a part is compared with that of another part.",
        """
The program searches the part for ever, or says that it is missing, although it is there.

In the run a part on the board was asked three times or more who it is (`WHO_AM_I`), and nothing was ever written to it.
The source compares the answer with a constant that is another one than the data sheet of this part has. The part is the
right one if the board was named (`--board`), or if a comment or a name of the program names it. A program that knows
several parts, and compares with the right identity too, is not told.

**Fix:** take the identity from the data sheet of the part.
""",
        "L3G4200D data sheet, WHO_AM_I: 0xD3",
    ),
    _rule(
        "scale-by-face", Severity.WARNING, "An object follows a part of the board in another scale than its unit.", """
A weight of 1250 g is shown as 125 g, a limit in tenths of a degree is never reached: the object is wrong by a power of
ten.

The name or the comment of an object states its unit (`// tenths of a gram`), and a face of a part of the board has the
same quantity in its own unit. A number of a part whose name states a unit (`self.rpm`, `self.mbar`) is looked at like
a face. In the run the face changed, and the object changed with it, but not by the factor between the units: it is
wrong by a power of ten, or by a factor that programs forget: edges, pole pairs and minutes of a speed (2, 4, 8, 60),
degrees of a radian (57.3).

It is reported where the object gets its scale if the values agree before and behind a step, or if two steps of
different height agree, as after a tare. If the face never changes, only an object is reported that came to its value in
the run and is wrong by a power of ten. Objects with a stated unit at file scope are looked at, and members of
structures there, but no arrays. Of several objects that follow the face, the closest one is reported. Nothing is
reported if any object follows the face in the right scale, or if the object follows two faces.

**Fix:** correct the factor of the conversion, or the unit that the comment states.
""",
    ),
    _rule(
        "zero-by-face", Severity.WARNING, "An object follows a part of the board, but lacks its offset.", """
All pressures are 6.25 cmH2O too high, all temperatures 50 degrees: a limit is reached too early, a regulator gives too
little.

Many sensors do not begin at 0 V: 0.25 V at 0 cmH2O, 0.5 V at 0 degrees, half of the supply at 0 A. The run shows the
volts of a part at an input of an ADC as a line over its face, and an object as a line over the volts. The object has
the scale of the face, or that times a power of ten, but it is 0 at 0 V, where the face is not: the conversion scales,
and forgets the offset.

It is reported where the object gets its scale, if the face changed in the run. Nothing is reported if any object has
the zero of the face, as behind a tare, or if a constant of the program, or an object that keeps its value, is the
offset in volts, in counts or in the unit of the face; nor for an object that holds the volts or the counts themselves.

**Fix:** subtract the offset before the scale is applied.
""",
    ),
    _rule(
        "sign-by-face", Severity.NOTE, "An object follows a part of the board with the other sign.", """
A speed is negative while the shaft turns forwards: a control that uses it drives away from its target.

As for `scale-by-face`, an object in a stated unit is compared with the face or the number of a part that has the
quantity. It has the value of the face, but for its sign. Usually a difference is taken the wrong way (`last - now`),
two wires are crossed, or a bit for the direction is inverted.

It is a note, because the direction that counts as positive may be chosen: of a current, an angle, a mirrored motor.

**Fix:** turn the difference, or the sign of the conversion; or count the other direction as positive in the board.
""",
    ),
    _rule(
        "limit-unused",
        Severity.NOTE,
        "A limit or a time is defined, and nothing applies it.",
        """
The value that the limit is for may be anything: the check that belongs to it is missing, or has been removed. A time
that nothing uses is for a wait that is missing.

The limit is a `#define` of a number in a C file, or `NAME = 5` in Python. Its name says that it is one (`SPEED_MAX`,
`POT_MIN`, `TRAVEL_LIMIT`, `REPLY_TIMEOUT_MS`, `BATTERY_LOW_MV`, `OVERCURRENT_MA`) or states a unit (`SETTLING_US`,
`COLD_TENTHS`), and it occurs nowhere else in the files. Headers are not looked at, nor a file that leaves more of them
unused than it uses.

**Fix:** apply the limit, or remove it.
""",
        how="static",
    ),
    _rule(
        "no-hysteresis", Severity.WARNING, "The two limits that a hysteresis should part are one, or cross.", """
The output chatters: it is switched on and off at the same value.

A function compares a value with the same limit in both directions, in two tests:
`if (celsius < SET - HYST) heater = 1;` and `if (celsius > SET - HYST) heater = 0;`. That can be right, but here the
limit is a sum or a difference with a constant or an object that its name calls a hysteresis or a dead band.

Or the limits change their places: `if (celsius > limit) alarm = 1;` and `if (celsius < limit + HYST) alarm = 0;`.
Between them both tests hold. It is reported if both decide about the same object or pin, to which the program gives
these two values only, and if what else must hold is the same for both, or asks for that object (`if (!alarm)`).

**Fix:** the other sign in one of the two limits.
""",
        how="static",
    ),
    _rule(
        "step-away", Severity.WARNING, "A value that follows another one steps away from it.", """
A ramp or a limiter runs away: once its target is on one side, each step increases the distance.

The value follows its target in a chain of tests, of which one way sets it to the target. Another way is taken where the
target is more than a step away, and steps in the wrong direction: its test stays true, for ever.

```c
if (target > value + RISE)
    value += RISE;
else if (target < value - FALL)
    value += FALL;                // it has to be -=
else
    value = target;
```

A value that lasts and takes a share of the difference does the same where it takes it with the wrong sign:
`zero -= (reading() - zero) / 16` moves it away from `reading()` faster and faster.

**Fix:** step towards the target.
""", how="static",
    ),
    _rule(
        "figure", Severity.NOTE, "A figure of an analysis does not follow from its own numbers.", """
A published table or sum does not follow from the numbers beside it. Computed again, it gives another result. Examples:
a utilisation that is not the sum of C/T, a response time without its blocking term, a bound that is rounded to the
wrong side.

The message gives the figure, the recomputed value and the formula. No firmware needs to run for it.

**Fix:** correct the figure, and check whether the conclusion (schedulable, deadline met) still holds.
""", how="static",
    ),
    _rule(
        "text-versus-code", Severity.NOTE, "The documentation and the code disagree.", """
A sentence of the documentation contradicts the program: a period, priority, pin, unit, range, the order of the fields
of a frame, or the caller of a function. One of the two is wrong, and readers trust the text.

The message gives both. What the code does is measured, or read from its syntax tree.

**Fix:** decide which one is right, and change the other.
""",
    ),
    _rule(
        "wrong-result", Severity.ERROR, "A function returns a wrong result.", """
The function has a clear definition (a median, a temperature in degrees, the end of a frame). The test calls it with an
input whose result can be computed by hand, and it returns something else.

**Fix:** the message contains the input, the result and the right result. Keep them as a test.
""",
    ),
    _rule(
        "stale-value", Severity.WARNING, "An output follows a value whose source is silent.", """
The machine continues with an old value after its source is silent: a motor follows an order of a link that is lost, a
heater follows a sensor that is dead.

The variable keeps its last value, and nothing in it says how old it is. `hil check` runs a whole program once more and
follows each value with its time of arrival: from a register, a mailbox or the interrupt of a pin, through objects,
pointers, parameters and results, to a compare value, a DAC, or a pin that is switched under a test of the value. It
knows registers by their names and those that a library reaches by numbers.

It always looks at a source that pauses in the run and comes back: a master, a tachometer, an unplugged sensor, an ADC
that nothing triggers. With `--silence` it also cuts off serial lines, I2C parts and the other nodes of a CAN when the
usual time is over, and parts make no edges at pins any more: a tachometer stands, an echo does not come. That run is
three times as long. A check without `--silence` names the lines and buses that could fall silent.

A source is silent after ten of its longest recent intervals, which are at least 4 ms. The finding is at the statement
that drives the output, or the call that chooses its value, if the output keeps a value other than 0 that comes from
that source. A pause that nobody asked for must come after a time at least as long in which the source was regular, and
the value must be ten times older than it ever was when it was used. It may last to the end only if a fault was
declared (`--fault`). For a sensor, a text that is still made of its last value counts as an output; so does a message
on a CAN that still says what a sensor, or another message, said last.

Without `--silence`, a program that has noticed the silence is told nothing, whatever it does then: during the silence
a statement has run, or a test has decided otherwise, that did not while the source was alive, and a state or an output
depends on it. So it does not matter whether it counts passes, looks at a timer, a Clock or a status, lets the value
decay, switches the output off or only reports. With `--silence`, an output is told, too, that is still written with the
last value although the program has noticed. What another sensor decides is no notice. A stop that the program orders
is the reason of a silence that follows. An output that a trip zone or a pin's function has switched off drives
nothing. An object that has got a constant no longer contains an old value.

In the same run, a receiver is reported that goes on in the middle of a message: its state is still the one of a message
whose end never came, after ten times the longest pause within any message before, and it takes the beginning of the
next one for the rest. A start character that is known in any state, or a limit for the time between two characters,
ends it.

A program that tests the age with a limit longer than the silence is reported too: run it longer (`--for`). If it is
right to keep the last value, for example a set point, write `hil: allow stale-value, ...` at the statement.

**Fix:** store the time with the value, and test the age where you use it. Beyond the age that the machine can
tolerate, do what is safe: stop, or report that there is no value.
""",
    ),
    _rule(
        "cut-message", Severity.WARNING, "After a message that was cut off, the next one is not understood.", """
A cable that is pulled, a sender that restarts or a lost character ends a message too early. A receiver that counts
characters and never gives up takes the beginning of the next message for the missing rest, and that one is lost, too.
If it does not look for the beginning of a message then, all later ones are lost.

With `--silence`, `hil check` runs a whole program once more. When the usual time is over, all serial lines fall silent.
Then the program gets one of its own messages again, the last one of the usual length: three times whole, with pauses of
0.6 and 1.2 s; once only its first half; and after 0.6 s three times whole. Something that ran for each whole message
before, when it was complete, does not run for the first one after the half. The finding is at what first
runs for a character of that one and did not for the same character before, or where characters are kept; its details
say what did not run.

A start character that is known in any state is right, and so is a limit for the time between two characters. A limit
of more than 0.6 s is reported: accept it in the source. A line of text that ends with CR or LF may lose the line behind
the cut one, but no later one; behind a line that your own run does not finish it may lose none, and that line is then
the one that is sent. Nothing is said about messages that a program does not take when they are sent again, like an
answer that it has not asked for.

**Fix:** give the rest of a message a limit of some characters' time, and begin anew behind it. Or use a start character
that occurs nowhere else, and begin anew whenever it comes.
""",
    ),
    _rule(
        "declared-property", Severity.ERROR, "A function does not have the property that its author declares.", """
A comment above a function declares a property, and `hil check` found arguments for which it does not hold. The finding
gives the smallest example that it met. `hil check` generates the arguments.

| `hil:` | what must hold |
|---|---|
| `range -100..100` | the result lies there, ends included |
| `range v -300..300` | the precondition: `hil check` passes only such values for `v`, and so must other calls |
| `monotone rising`, `monotone v falling` | a greater argument gives no smaller (greater) result |
| `odd`, `even`, `odd v` | f(-v) is -f(v), is f(v) |
| `idempotent` | f(f(x)) is f(x); of any other function: the second of two equal calls changes no object |

**Fix:** keep the example as a test. If the declaration demands too much, give the range for which it holds.
""",
    ),
    _rule(
        "order-range", Severity.WARNING, "An order outside the robot's range is accepted.", """
The firmware accepts a well-formed order for a speed, an angle or a time outside the range of the machine. The result
depends on what saturates first.

**Fix:** limit the value where the order is accepted, or reject the order.
""", "TFG 3.2.3: +-0.3 m/s, +-1.57 rad/s",
    ),
    _rule(
        "consistent-set", Severity.WARNING, "Values that belong together are read from different measurements.", """
The program decides on values that were never true at the same time.

A gate protects each value, but not the set. If a writer runs between two reads of one reader, the reader has one value
of the old and one of the new measurement. No race is reported, because every access has a gate.

**Fix:** write the whole set, and read the whole set, inside one critical section.
""",
    ),
)  # fmt: skip
