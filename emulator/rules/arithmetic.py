"""Rules of integer and float arithmetic with the widths of this chip."""

from __future__ import annotations

from functools import partial
from typing import Final

from emulator.rules.rule import Rule, Severity, rule

_rule: Final = partial(rule, "arithmetic")

RULES: Final[tuple[Rule, ...]] = (
    _rule(
        "overflow",
        Severity.ERROR,
        "A signed result does not fit its type.",
        """
A sum or a product has the wrong sign, or is far too small.

An `int` has 16 bits here: -32768 to 32767. A sum of a hundred 12-bit samples, a product of two ordinary numbers, or
the negative of -32768 does not fit. The hardware wraps (overflow mode is off). The compiler may assume that an
overflow never happens. On a PC `int` has 32 bits, so neither the test nor the sanitizer sees anything.

A sum or a product of two constants (`1800 * 1000`) is reported before the program runs. So is a product whose quotient
is compared with more than it can be: `counts * 7500 / 2000` of 32 bits is never above 1073741. So is a product of
a value that the source itself limits to more than the product holds: `if (off > 500) off = 500;` and then `off * 1000`.

A bit that is shifted into the sign bit (`1 << 15`, as in every mask for bit 15) loses nothing. It is reported only if
the result is widened.

**Fix:** compute in `long` (cast an *operand*, not the result), or divide before you add.
""",
        "ISO C 6.5 p5; CC table 6-1; CPU 2.3 (OVM)",
        how="dynamic/static",
    ),
    _rule(
        "widened-late",
        Severity.ERROR,
        "A 16-bit result lost its upper bits before it was widened.",
        """
A `long` or a `float` gets a value that was cut to 16 bits before.

`long area = a * b;` multiplies in 16 bits and widens the product afterwards. With unsigned operands this is not even
an overflow: `(adc - 2048) * 0.001` computes the difference in `unsigned int`, so for `adc` = 2000 it is 65488 and not
-48. If one operand is `int` and the other `unsigned int`, C computes in `unsigned int`. On a PC the operation has 32
bits and is right.

The same happens to a number in a text: `long value = atoi(text)` reads 70000 as 4464, because `atoi` returns an `int`.

Before the program runs, a value is enough that the source itself lets through: the test that refuses more than 3600
seconds, before `rest_ms = seconds * 1000U`; the one that lets results of the ADC up to 4045 through, before
`(long) (raw << 5)`; a mask of 12 bits that 16 bits do not hold after `<< 12`. If the result is divided or compared,
this is `unsigned-wrap`; if it is signed, `overflow`. Values behind a further test of them are not reported.

A product of 16 bits is reported beside one of the same sum that is widened first and has the same form:
`(long) a[0] * a[0] + a[1] * a[1]`, `(long) x * x + y * y`. Nothing is said if the function compares `a[1]` by order.

A difference that its name calls an error (`long error = SET - measured;` with a `Uint16 measured`) is reported before
the program runs, unless the function compares the two: above the set point it is some 65000.

So does a long pulse: `Uint16 width = fall - rise;` keeps 16 of 32 bits of the time between two captures of an eCAP. It
is reported when such a width is used as a wider number for the third time.

Two cases are not reported: a difference of two unsigned variables that wraps to a small number, because programs
compute elapsed counts in that way; and a result that is cast to its own type, because the cast says that the wrap is
intended. A number minus a constant is no elapsed count: `(long) (Uint16) (raw - 512U) * 5` is reported in spite of the
cast, where it is scaled or becomes a float.

**Fix:** cast one operand first: `(long) a * b`, `((int) adc - 2048) * 0.001`; `atol` for `atoi`.
""",
        "ISO C 6.3.1.8 with the widths of CC table 6-1",
        how="dynamic/static",
    ),
    _rule(
        "remainder-lost",
        Severity.WARNING,
        "A remainder or a fraction was lost before the number became a float or was scaled.",
        """
A ratio or a percentage is 0, or always a whole number.

With integers, `float ratio = a / b;` divides as integers: 3 / 4 is 0, and then 0.0. `a / b * 100` does the same, and
so does `code / 4095 * 120` with the full scale of an ADC (other constant divisors may count whole units). This is valid
C, so compilers do not warn. The finding is made only when a remainder was really lost, from a quotient below 100: above
that the loss is less than a hundredth. After such a quotient nothing is told at its place: a speed that was 3000 rpm
may fall to 71 rpm.

**Fix:** make one operand a float: `(float) a / b`. If you want the whole number, keep it in an integer.
""",
        "ISO C 6.5.5 p6",
    ),
    _rule(
        "narrowed",
        Severity.WARNING,
        "A number became an int without a cast, and its value changed.",
        """
An `int` holds another value than the program computed.

Either a 32-bit value was assigned to a 16-bit object, and C dropped the upper half without a message. Or an unsigned
and a signed number were added: the sum is unsigned, and above 32767 the `int` that takes it becomes negative. On a PC
both sides have 32 bits.

A cast says that the value fits or that only the lower half is wanted, so it is not reported. The exception is a
product, also one that is divided or shifted down (`(int) ((long) a * b >> 15)`): it is meant to fit, so its loss is
reported despite the cast. A capture of an eCAP (32 bits) that goes to a `Uint16` and is divided later is reported too;
other registers, and differences of captures, may be cut on purpose.

A test says which values are meant. So `if (n <= 100000L) period = (Uint16) n;` is reported before the program runs: the
test lets more through than the type holds. So is `if (n > 99999L) return;` before the conversion. It is not reported if
the value is used otherwise too, as for its upper word.

A stamp of 16 bits of a clock of 32 is reported if it is subtracted from all of it: `if (millis - last >= PERIOD)`
with `Uint16 last` is right for the first 65 seconds. `(Uint16)(millis - last)` is right for longer. The same is
reported of a position of an eQEP (`QPOSLAT - last`) that goes on to a QPOSMAX above 65535, where no index, no unit
time-out and no statement sets it back.

A capture (`CAP2`) or count (`TSCTR`, `TIM`) that a 16-bit object keeps without a cast is reported before the program
runs if a test then has one outcome only: `if (millimetres(width) < 200)`, where 65535 counts are 56 mm. Sixteen bits
are enough for short pulses, and then nothing is reported.

**Fix:** make the object `long`, or limit the value before the assignment.
""",
        "ISO C 6.3.1.3 p3",
        how="dynamic/static",
    ),
    _rule(
        "unsigned-wrap",
        Severity.WARNING,
        "An unsigned result wrapped and was then divided, shifted down or compared.",
        """
An unsigned difference or sum wraps, and the program continues with a number near 65536.

In `b + (a - b) / 2` with `a < b` the difference is near 65536, and half of it is near 32768. `now - before > 5` is
true when the value has gone *down* by one. Addition and subtraction alone give the right result modulo 65536. A
division, a shift to the right or a comparison by order does not. These wraps are reported:

* a result that is then divided, shifted down or compared by order; a product that is shifted down, unless a large odd
  factor shows that it is a hash;
* a sum of samples that is divided later (at the addition that wraps); also a global or `static` one that is taken and
  then begins again at 0, and through copies; not if it is masked or compared for equality, as check sums are;
* a sum of more than 32 readings of the ADC, before the program runs, if the number that ends the count is also what the
  sum is divided by;
* the step of a loop whose test compares the object (a count that goes down by two misses 0);
* the step of an object that is limited above (below 0 it wraps and becomes the limit); not a step by 1, because a ring
  or a digit goes down from 0 to its limit in that way;
* a difference of two 16-bit numbers that goes into a `long`, if one of them has wrapped;
* a sum or product of two constants, before the program runs: `400u * 195u` is 12464, because `unsigned int` has 16
  bits;
* a difference of two positions of an eQEP in quadrature mode that becomes a float, or is divided (shown at the end of
  the run): one step back is 4294967295. Not if the program compares steps or positions by order, or reads the
  direction.

These wraps are not reported: a difference that wraps by more than half of the range, because it is the elapsed count
of a free-running counter; and a result that is cast to its own type.

**Fix:** subtract the smaller number from the larger one, or compute in a signed type that is wide enough.
""",
        "ISO C 6.2.5 p9",
        how="dynamic/static",
    ),
    _rule(
        "stamp-compare",
        Severity.ERROR,
        "A comparison of two time stamps was wrong because the counter had wrapped.",
        """
A 16-bit counter wraps after 65536 counts, and so does every time that is computed from it. `now >= end` is true at once
if `end` has wrapped and `now` has not; in the opposite case it is false for a whole round. `now == end` misses the time
if it is not tested at exactly that count. `(int) (now - last) > LIMIT` is negative once more than half of the range has
passed.

The detector follows stamps from CPU timers, eCAPs, the kernel's clock and counters of interrupt routines and Clocks,
through variables, members and functions. What a task counts is no time, and a test for the next number of a sequence
(`if (m.number != last + 1) lost++; last = m.number;`) is none for a time. It reports a comparison that goes wrong
because the counter has wrapped between the two stamps. A comparison by order is right if its branch takes the
difference: `if (now < last) d = 65536 - last + now;`.

In three cases the source is enough. If a 16-bit counter is compared by order with a stamp and a number
(`now < last + 20`), the sum wraps before the counter does; so it does if a driver is given such a time (`Uint16 now`,
`ticks`, `ms`) and keeps it in `last`. If no statement ever sets the stamp of a difference of 16
bits, that is the time since the start: a time-out is over for ever, but for a moment in each round. If a program reads
the clock and then, without a mask, a stamp that an interrupt routine sets (`now = Millis; ... now - Heard_ms > LIMIT`),
the stamp can be later: the age is -1, which is greater than any limit. Read the stamp first, or mask both.

**Fix:** compare differences: `(unsigned int) (now - last) >= INTERVAL`, or `(int) (now - end) >= 0` for a time that is
at most half of the range ahead.
""",
        "ISO C 6.2.5 p9; TRM, CPU timers",
        how="dynamic/static",
    ),
    _rule(
        "sign-compare",
        Severity.ERROR,
        "A negative number was compared as an unsigned number.",
        """
A negative number passes a test as if it were very large.

One side of the comparison is unsigned, so C converts the other side too: -1 becomes 65535. An error code of -1 is then
"larger" than every size. `sizeof` is unsigned, too.

The finding is made while the program runs, when the value is negative. It is made before the program runs if the
source has a minus or a negative constant there: `wanted >= -250` is true from 65286 on if `wanted` is unsigned. -1 and
`~MASK` may be meant as bits, and are not reported.

**Fix:** test for negative values first, or make both sides signed.
""",
        "ISO C 6.3.1.8",
        how="dynamic/static",
    ),
    _rule(
        "sign-lost",
        Severity.ERROR,
        "A negative number was taken as an unsigned one, and then limited, scaled, compared or made a float.",
        """
Full power for a small negative error.

In `Uint16 duty = error * KP; if (duty > FULL) duty = FULL;` an error of -1 becomes 65535, and the limit makes `FULL`
of it. `(int32) SWING * (Uint16) position` multiplies by 65535. An unsigned parameter has the same effect on the
caller's argument.

The finding is made where a negative number becomes unsigned, if the object or parameter is limited above, or if a cast
makes it unsigned and the result is then widened and multiplied, divided, or converted to float. So it is if the source
casts a number to a signed type, an unsigned object or member takes it, and another expression makes a float of that
(`raw.x = (int16)(high << 8 | low);` with `Uint16 x`). Then only -4096 to -1 count: a cast may be needless, but a small
negative number is none of the upper half of an unsigned range. The same small numbers count if 16 bits without a sign
are kept of a difference of 32 bits, and become a float (`(Uint16) (count - before)` of a wheel that turns back): no
time since a stamp is below 0.

A word that came in octets (`int32_t rpm = data[0] | data[1] << 8;`), from a buffer or a union has no sign either. It is
reported if its highest bit is set, and the object that takes it, also as the result of a function, gets nothing else
and is compared by order with a number below -1 (`rpm >= -3000`): so negative numbers are expected, and none can come.
The same holds for an octet that a wider object takes, and for two sides of a comparison by order that both get signed
numbers only by casts to unsigned (`words[n] > (Uint16) limit`).

So is a word of three octets that becomes a signed number of 32 bits (`(int32) (high << 16 | middle << 8 | low)`), if it
steps from just above 0 to just below 16777216, and the program looks nowhere at bit 23.

These are not reported: additions and subtractions, which give the right result; masks and shifts; a factor above
65535; a test that rejects the number (`if (x >= N) return;`), because it rejects negative ones too.

**Fix:** limit to 0 first, and compute in a signed type that is wide enough.
""",
        "ISO C 6.3.1.3 p2",
    ),
    _rule(
        "sign-extended",
        Severity.ERROR,
        "A number above 32767 became an int, and its highest bit was then taken for a sign.",
        """
A checksum is right for half of the messages.

`int Crc(...)` returns 0xBEEF as -16657. Where this is compared with a `long`, it is widened with its sign, and
-16657 is not 48879: the test says that the two differ, although all 16 bits are the same. `(int) strtol(...)` in front
of such a comparison does the same.

The finding is made while the program runs, if both sides are the same number before the `int`. A negative number that
was meant (a temperature, an offset) is not reported.

Or the checksum is right for hardly any message: `int crc` is shifted to the right, and copies of its sign come in from
above. The finding is made when such a register is negative at its shift, and an exclusive or with a constant that needs
its highest bit (`(crc >> 1) ^ 0xA001`) says that it holds bits and no number. A mask (`crc >> 1 & 0x7FFF`) is right.

**Fix:** `Uint16` for words that have no sign, on both sides.
""",
        "ISO C 6.3.1.3 p3; CC table 6-1",
    ),
    _rule(
        "fields-overlap",
        Severity.WARNING,
        "A field of a word has bits in the place of the next field.",
        """
A message carries wrong values in two fields at once.

In `torque | percent << 16 | info << 24` a percent of 500 sets bits of `info`, for an OR only adds bits. A negative
`torque` is worse: it is widened with its sign, so that all bits above it are 1.

The finding is made while the program runs, where a bit of one field meets a bit of another one that a constant shifts
further to the left, or where the sign of a negative number reaches a constant (`3UL << 24 | (Uint32) speed`). It is not
made for two terms of the same object (`x | x << 1`), other constants, masks (`x & ~0xF0`), registers, and flags (an
object that some statement ORs into); nor for a word of two terms of which one is shifted by less than four bits.

**Fix:** mask each field to its width, and convert signed numbers to `Uint16` first: `(Uint32)(Uint16)torque`.
""",
        "ISO C 6.5.12; 6.3.1.3 p2",
    ),
    _rule(
        "octet",
        Severity.WARNING,
        "The code assumes that a character has eight bits.",
        """
A checksum, a CRC or a byte from a sensor has a wrong value.

`char`, `signed char` and `unsigned char` have 16 bits here. So a cast to `unsigned char` cuts nothing. A checksum does
not wrap at 256. CRC-8 keeps the bits that it shifts out of the byte. `~b` sets the upper eight bits. 0xF6 in a
`signed char` is 246 and not -10. `sizeof x * 8` is half of the number of bits.

On a PC all of this is right, so such drivers pass their tests there. The finding shows what eight bits would have
given. A counter that is incremented by a constant and compared with a limit is not reported: 16 bits do it no harm.

**Fix:** mask with `& 0xFF`; extend the sign yourself (`if (t > 127) t -= 256;`).
""",
        "CC table 6-1",
        how="dynamic/static",
    ),
    _rule(
        "float-to-int",
        Severity.ERROR,
        "A float outside the range of the integer type was converted.",
        """
A duty cycle or a register jumps to an extreme value.

The program converts a float that is outside the range of the integer type. C does not define the result; on this chip
it depends on the run-time library. The emulator saturates (`float_to_int="low16"` in Python gives the low bits
instead). NaN gives some number, too.

**Fix:** limit the float before the conversion. Find the place where the value left its range: `hil explain nan`.
""",
        "ISO C 6.3.1.4 p1",
    ),
    _rule(
        "float-argument",
        Severity.WARNING,
        "A float argument lost much of its value when it was converted to an integer.",
        """
A function works with 2 where the program computed 2.9.

The parameter is an integer, and C drops the fraction of the argument without a message: 2.9 volts become the code 2.

The finding is made at the end of a run, if the largest value was between 1 and 10 and lost at least a tenth of itself.
A float that was scaled to the unit of the function is not reported, nor is one that is rounded by adding 0.5.

**Fix:** scale the value to the unit of the function; write a cast if you want the whole part.
""",
        "ISO C 6.5.2.2 p7, 6.3.1.4 p1",
    ),
    _rule(
        "float-magnitude",
        Severity.WARNING,
        "An integer function takes the magnitude of a float.",
        """
The magnitude of a float is 0, or a whole number.

`abs` and `labs` take integers. C converts the argument first, because the prototype says so: -0.75 becomes 0, and
40000.0 does not fit a 16-bit `int`. A cast says that you want the whole part, and is not reported.

**Fix:** `fabsf(x)`, or `fabs(x)`.
""",
        "ISO C 7.20.6.1, 7.12.7.2",
        how="static",
    ),
    _rule(
        "angle-unwrapped",
        Severity.WARNING,
        "The difference of two headings is not brought back into one turn.",
        """
From 170 to -170 degrees the vehicle turns the long way round: the difference is -340, and not 20.

A function of the file (`wrap`) brings an angle back into -180 to 180 degrees, or -pi to pi, and the heading is what it
returns for its sum with a step. `error = wanted - heading;` is not passed through it, and is multiplied. The names say
that an angle goes round (`heading`, `yaw`, `course`) and that the difference is the error of a regulator. Not reported:
an error that is compared, changed, divided, or passed to any function, or its product that becomes a whole number or
goes to a sine; a wanted angle that is compared, or that only constants, functions or copies of the heading set; a file
in which another function has a turn or half of one as a constant.

**Fix:** `error = wrap(wanted - heading);`
""",
        how="static",
    ),
    _rule(
        "echo-not-halved",
        Severity.WARNING,
        "The time of an echo becomes a distance and is not halved.",
        """
Every distance is twice what it is: the vehicle stops late or not at all.

The time runs until the sound has come back, so the obstacle is at half of its way. It is reported where a time is
multiplied by the speed of sound (331 to 349 m/s), or divided by 29 us for a centimetre, with no other factors than
powers of ten. The name of the time says its unit (`echo_us`, `Width_ms`), and the source speaks of an echo, of a sonar
or of ultrasound. Not reported: a module that halves a time, a distance or the result of a function anywhere, and one
that speaks of sound that goes one way (a beacon, a wind meter).

**Fix:** `echo_us * 343 / 2000` is the distance in mm; 58 us are one centimetre.
""",
        how="static",
    ),
    _rule(
        "division-by-zero",
        Severity.ERROR,
        "A number was divided by zero.",
        """
A result is -1, 65535, infinity or NaN.

An integer division by zero does not trap on this chip. The emulator gives all ones, as the loop of the library does; a
remainder is the dividend. A float division gives infinity, or NaN for 0/0. With the divider of the chip
(`hil run --divide nr`) the seed of the iteration decides.

On a PC an integer division by zero ends the program at once. Here the program continues with the wrong number.

**Fix:** test the divisor. For a measured period, decide what the program does before the first measurement.
""",
        "ISO C 6.5.5 p5",
    ),
    _rule(
        "shift-range",
        Severity.ERROR,
        "A shift count is negative, or as large as the width of the type.",
        """
A shift gives another result than on a PC.

The shift count must be at least 0 and smaller than the width of the type. `1 << 20` shifts a 16-bit `int`, and C does
not define the result; on a PC it is 1048576. The emulator gives 0. The shift instructions of the chip use only the
lowest bits of the count. A constant count is reported before the program runs.

**Fix:** shift an `unsigned long`: `1UL << n`; test the count.
""",
        "ISO C 6.5.7 p3",
        how="dynamic/static",
    ),
    _rule(
        "nan",
        Severity.WARNING,
        "An operation on finite numbers gave a NaN or an infinity.",
        """
A product above 3.4e38, or the square root of a negative number, gives an infinity or a NaN. From here on it spreads
through every sum, and every comparison with NaN is false (`!=` is true).

The finding is at the first operation that makes it from finite numbers. `hil check` watches all float operations of
driver files; an image that you link in Python needs `watch=True`. The functions of `math.h` are always watched. A
division by zero has its own rule.

**Fix:** limit the operands; the finding shows their values.
""",
        "IEEE 754 7.2, 7.4",
    ),
    _rule(
        "nan-output",
        Severity.ERROR,
        "A NaN or an infinity reached a shared object or left the firmware.",
        """
A NaN or an infinity is stored in a file-scope object, or passed to a function of the library or the kernel (a text to
send, a sine). Other parts of the program now work with it. An integrator that has added a NaN keeps it for ever.

The first arrival at each place is reported.

**Fix:** follow the value back to its origin: see `nan`, `division-by-zero`, or an object that was never written
(`--fill nan`).
""",
        "IEEE 754 6.2",
    ),
)
