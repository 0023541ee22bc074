"""Properties of drivers and of the closed loop: what must hold of any correct implementation, each stated once.

No detector reports these while the firmware runs: a property test does, or a demonstration of the catalogue, with what
it measured in the message.  The units stand in each page.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "property")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "rotation-sign", Severity.ERROR, "A measured rotation has the wrong sign, or one direction is lost.", """
Turn the robot at a known rate (rad/s or degrees/s) in both directions; the driver's reading must have the sign of the
turn. Two octets of a sensor make a number of 16 bits in two's complement: where they pass through an unsigned type or
where values above 32767 are cut off, one direction becomes a large positive rate or zero.

No compiler sees it: each conversion is defined. The test is the world: a rate goes in, a rate comes out.

**Fix:** combine the octets as `unsigned`, convert the 16-bit result to a signed 16-bit type once, and only then scale.
""", "L3G4200D data sheet, OUT_X_L..OUT_Z_H: two's complement",
    ),
    _rule(
        "rotation-scale", Severity.ERROR, "A measured rotation has the wrong scale.", """
The reading divided by the true rate must be 1 within the part's tolerance, at every full scale that the driver can
select. The data sheet's sensitivity is a figure of its own (8.75, 17.5 and 70 mdps a digit at 250, 500 and 2000 dps);
it is not full scale divided by 32768, which is 13 % too small.

An integrated angle carries the error on: a quarter turn ends 11 degrees short.

**Fix:** multiply by the sensitivity of the data sheet for the full scale that is configured.
""", "L3G4200D data sheet, table of mechanical characteristics: So",
    ),
    _rule(
        "rotation-bias", Severity.WARNING, "A robot at rest measures a rotation.", """
At rest the corrected rate must stay within a bound (degrees/s) that the part's zero-rate level and its noise leave
after calibration. An offset that is averaged over too few samples, summed in a type that overflows, or measured while
the robot moves, stays in every later reading and grows without limit in the integrated angle.

**Fix:** average new samples (data ready), in a 32-bit sum, at rest; check the spread before the mean is accepted.
""", "L3G4200D data sheet: DVoff, OffDr",
    ),
    _rule(
        "outlier-bound", Severity.ERROR, "One outlier moves a filtered distance too far.", """
Twelve conversions make one distance. If one of them is replaced by any other value of the converter's range, the
result may move by no more than the spread of the other eleven (cm). That is what a median is for; a mean lets a twelfth
of the error through, and a sort that does not sort, or reads beside its array, lets through anything.

**Fix:** sort a copy completely, take the middle (for an even number: the mean of the two middles).
""",
    ),
    _rule(
        "distance-scale", Severity.ERROR, "A measured distance is wrong by more than the sensor's resolution.", """
With a wall at a known distance (cm) the driver's reading must agree within the sensor's resolution of one inch and the
converter's step. Wrong: a slope that belongs to another supply voltage, twelve conversions divided by a number that is
not twelve, an offset that is added twice.

**Fix:** derive slope and offset from the supply, the reference and the number of conversions, and check both ends of
the range.
""", "LV-MaxSonar-EZ data sheet: Vcc/512 per inch",
    ),
    _rule(
        "odometry-path", Severity.ERROR, "The odometry differs from the path that was driven.", """
Drive a path (straight, turn on the spot, arc, back to the start); position (mm) and angle (rad) from the wheels must
follow the true path within wheel slip and the resolution of the encoders, in every quadrant and in both directions.

What breaks it: different units on two branches (millimetres when straight, metres when turning), an angle that is not
wrapped, integer division before scaling, the wrong sign of a turn, a counter's overflow taken as a jump.

**Fix:** one unit throughout; difference of counts in a signed type of the counter's width; one formula for all turns.
""",
    ),
    _rule(
        "order-latency", Severity.WARNING, "An order takes effect too late.", """
From the end of the order's last byte on the line to the first changed output (PWM, state, answer) no more than the
stated time (ms) may pass, whatever the robot does meanwhile. An order that waits behind a busy loop, behind a task of
higher priority that never sleeps, or in a buffer that is only looked at now and then, is late without a sign of it.

**Fix:** let the receiver's interrupt wake the task that acts; keep long work below it in priority.
""",
    ),
    _rule(
        "malformed-frame", Severity.ERROR, "A malformed frame has an effect.", """
Bytes that are no order - cut off, too long, two run together, with a wrong keyword or number - must leave state,
references, outputs and memory as they were, and the next good order must work. A parser that trusts a terminator runs
out of its buffer; one that converts before it checks acts on half a number.

**Fix:** bound every loop by the buffer; check the whole frame first, then act; resynchronise at the start character.
""",
    ),
    _rule(
        "stop-stops", Severity.ERROR, "The robot still moves after a stop.", """
After STOP (or the bumper) every motor must get its neutral output within one control period and keep it (PWM duty, m/s)
until another order comes: no remembered reference, no integral left in a controller, no task that writes once more.

**Fix:** a stop sets state, references, integrators and outputs in one place; every writer of outputs asks the state.
""",
    ),
    _rule(
        "closed-loop", Severity.ERROR, "The closed loop does not follow its reference.", """
Told a speed (m/s) and a rate (rad/s), the true motion must settle on them, without a lasting error beyond the stated
bound and without oscillation, and a mission must end without a collision.

**Fix:** see what the controller is fed: unit, sign, sampling period, saturation of the integral.
""",
    ),
    _rule(
        "no-effect", Severity.WARNING, "A statement, an order or a setting has no effect.", """
Every function of the program that is written down (an order of the protocol, a parameter, a calibration, a branch) must
change some output in some situation. If the same run with and without it is equal byte for byte, it has no effect.

**Fix:** complete it or remove it. Code without an effect costs everyone time who searches for a fault.
""",
    ),
    _rule(
        "unit", Severity.ERROR, "A number is used in the wrong unit.", """
The value is right in one unit (mm, m, cm, inch, rad, degree, ms, tick, count) and is used, sent or compared in another.
C has no units: `float` is `float`. The finding names both, and a measured ratio near 10, 25.4, 57.3, 100 or 1000
shows it.

The author of a driver can say which unit a value has, in a comment where it is declared: `// hil: unit cm` on an
object, above a function for its result, `// hil: unit v mm/s` for its parameter `v`. Then `hil check` tells each place
where a value of one unit goes where another one is declared, and each sum or comparison of two.

**Fix:** put the unit in the name, convert at one border, send what the protocol says.
""",
    ),
    _rule(
        "figure", Severity.NOTE, "A figure of an analysis does not follow from its own numbers.", """
A published table or sum, computed again from the numbers that stand beside it, gives something else: a utilisation that
is not the sum of C/T, a response time that leaves out a blocking term, a bound that was rounded to the wrong side.

The message states the figure, the recomputed value and the formula. Nothing of the firmware needs to run for it.

**Fix:** correct the figure, and see whether the conclusion drawn from it (schedulable, deadline met) still holds.
""", how="static",
    ),
    _rule(
        "text-versus-code", Severity.NOTE, "The documentation and the code disagree.", """
A sentence of the documentation contradicts the program: a period, priority, pin, unit, range, the order of a frame's
fields, or the caller of a function. One of them is wrong, and readers trust the text.

The message states both. What the code does is measured or read from its tree, not assumed.

**Fix:** decide which is meant and change the other.
""",
    ),
    _rule(
        "wrong-result", Severity.ERROR, "A function returns a wrong result.", """
A function with a clear definition (a median, a temperature in degrees, the end of a frame) is called with an input
whose result can be computed by hand, and it returns something else.

**Fix:** the message has the input, the result and the right result; keep them as a test.
""",
    ),
    _rule(
        "stale-value", Severity.WARNING, "An output follows a value whose source is silent.", """
A motor follows an order, a heater a temperature. When the link or the sensor falls silent the variable keeps its last
value, and nothing in it says how old it is: the machine drives on.

`hil check FILE... --silence` runs a whole program once more and carries the time of each value along, from the register
or the mailbox where it came in, through objects, parameters and results, to the statement that writes the output (a
compare value, a DAC, a pin that is switched under a test of it). How often there is a new value is measured at the same
statement in the same run. Told is the statement that still writes a value other than 0 when the source has been silent
for ten of its longest former intervals or more, to the end of the silence or of the run; where that only hands on what
its function is given, the call that chooses it. The source is silent by
itself, or because the check cuts it off (serial lines, parts on the I2C). An object that gets a constant carries no old
value any more.

The run is three times as long as usual. A program that looks at the age, with a limit beyond that, is told too: check
it longer (`--for`).

Keeping the last value may be right: a set point that stays until there is another one. Then say so at the statement,
`hil: allow stale-value, ...`.

**Fix:** keep the time of the value beside it, look at its age where it is used, and beyond the age that the machine
can bear go to what is safe: stop, or say that there is no value.
""",
    ),
    _rule(
        "declared-property", Severity.ERROR, "A function does not have the property that its author declares.", """
A comment above a function says what must hold of it, and `hil check` calls it with generated arguments until it does
not: the finding is the smallest example that was met.

| `hil:` | what must hold |
|---|---|
| `range -100..100` | the result lies there, ends included |
| `range v -300..300` | the contract: `v` is given nothing else, by `hil check` and by the calls that the text shows |
| `monotone rising`, `monotone v falling` | a greater argument gives no smaller (greater) result |
| `odd`, `even`, `odd v` | f(-v) is -f(v), is f(v) |
| `idempotent` | f(f(x)) is f(x); of any other function: the second of two calls alike changes no object |

**Fix:** the example is the test to keep. Where the declaration asks for too much, give the range for which it holds.
""",
    ),
    _rule(
        "order-range", Severity.WARNING, "An order outside the robot's range is accepted.", """
A well-formed order asks for a speed, an angle or a time outside the stated range of the machine, and the firmware
passes it on. What follows is decided by the first thing that saturates.

**Fix:** hold the value within the range where the order is taken, or refuse the order.
""", "TFG 3.2.3: +-0.3 m/s, +-1.57 rad/s",
    ),
    _rule(
        "consistent-set", Severity.WARNING, "Values that belong together are read from different measurements.", """
Each value is protected by its gate, and the set is not: a writer that runs between two reads of the same reader leaves
it with one value of the old and another of the new measurement. No race is reported, since every access has a gate.

**Fix:** write the whole set, and read the whole set, inside one critical section.
""",
    ),
)  # fmt: skip
