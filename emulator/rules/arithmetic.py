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
An `int` has 16 bits: -32768 to 32767. A sum of a hundred 12-bit samples, a product of two ordinary numbers, the
negative of -32768 do not fit. The hardware wraps (overflow mode is off); the compiler may assume that it never
happens.

On a host `int` has 32 bits, and neither the test nor the sanitizer there sees anything. A bit shifted into the sign
bit (`1 << 15`, every mask for bit 15) loses nothing and is reported only if the result is widened.

**Fix:** compute in `long` (cast an *operand*, not the result), or divide before you add.
""",
        "ISO C 6.5 p5; CC table 6-1; CPU 2.3 (OVM)",
    ),
    _rule(
        "widened-late",
        Severity.ERROR,
        "A 16-bit result lost its upper bits before it was widened.",
        """
`long area = a * b;` multiplies in 16 bits and widens the remains. With unsigned operands not even an overflow
happens: `(adc - 2048) * 0.001` takes the difference in `unsigned int`, so 2000 gives 65488 and not -48. An `int` that
meets an `unsigned int` becomes unsigned.

On a host the operation has 32 bits and is right. A difference of two unsigned variables that wraps to a small number
is how elapsed counts are taken and is not reported; nor is a result that is cast to its own type, which says that the
wrap is meant.

**Fix:** cast one operand first: `(long) a * b`, `((int) adc - 2048) * 0.001`.
""",
        "ISO C 6.3.1.8 with the widths of CC table 6-1",
    ),
    _rule(
        "remainder-lost",
        Severity.WARNING,
        "An integer division lost its remainder before the quotient became a float or was scaled.",
        """
`float ratio = a / b;` with integers divides as integers: 3 / 4 is 0, then 0.0. So does `a / b * 100` for a
percentage. The finding is made only when a remainder was really lost.

Compilers are silent: it is valid C.

**Fix:** make one operand a float: `(float) a / b`. If the whole number is meant, keep it in an integer.
""",
        "ISO C 6.5.5 p6",
    ),
    _rule(
        "narrowed",
        Severity.WARNING,
        "A number became an int without a cast, and its value changed.",
        """
The right side has 32 bits and the object 16; C drops the upper half in silence. Or an unsigned number was added to a
signed one: the sum is unsigned, and above 32767 the `int` that takes it is negative.

A cast says that the value is known to fit or that only the lower half is wanted, and is not reported; but a product,
and what it is divided by or shifted down to (`(int) ((long) a * b >> 15)`), is meant to fit, and is.

On a host both sides have 32 bits.

**Fix:** make the object `long`, or bring the value into range before the assignment.
""",
        "ISO C 6.3.1.3 p3",
    ),
    _rule(
        "unsigned-wrap",
        Severity.WARNING,
        "An unsigned result wrapped and was then divided, shifted down or compared.",
        """
`b + (a - b) / 2` with `a < b`: the difference is near 65536, and so is half of it near 32768. `now - before > 5` is
true when the reading has gone *down* by one. Addition and subtraction alone would come out right modulo 65536; a
division, a shift to the right or a comparison by order does not. A sum over samples that is divided further down is
reported at the addition that wraps.

So is the step of a loop that wraps, and whose object the loop's test compares: a count that goes down by two misses 0.
So is the step of an object that is limited above: what has gone below 0 becomes the limit.
So is a long that becomes the difference of two numbers of 16 bits of which one has wrapped: stamps of 16 bits are
subtracted in 16 bits, and the result is widened.

A wrap of more than half the range is taken for the elapsed count of a free-running counter and is silent.

Of two constants it is seen in the source: `400u * 195u` is 12464, because `unsigned int` has 16 bits. A cast to its own
type says that the wrap is meant.

**Fix:** subtract the smaller from the larger one, or compute in a signed type that is wide enough.
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

The detector follows stamps from CPU timers, eCAPs, the kernel's clock and counters of interrupt routines, through
variables, members and functions. It reports a comparison that goes wrong because the counter has wrapped between the
two stamps. A comparison by order is right if its branch takes the difference:
`if (now < last) d = 65536 - last + now;`.

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
One side is unsigned, so the other is converted: -1 counts as 65535. An error code is "larger" than every size.
`sizeof` is unsigned too.

Seen as it runs, when the value is negative; and in the source, when a minus or a negative constant stands there.

**Fix:** test for negative first, or make both sides signed.
""",
        "ISO C 6.3.1.8",
        how="dynamic/static",
    ),
    _rule(
        "sign-lost",
        Severity.ERROR,
        "A negative number was taken as an unsigned one, and then limited, scaled or divided.",
        """
`Uint16 duty = error * KP; if (duty > FULL) duty = FULL;` gives full power for every negative error: -1 is 65535, and
65535 is limited to FULL. `(int32) SWING * (Uint16) position` scales it as 65535. An unsigned parameter does the same to
what a caller hands over.

Told where a negative number becomes unsigned: in an object or a parameter that is limited above (what is more than the
limit becomes the limit); by a cast, if the result is widened and multiplied, divided, or becomes a float. Silent are
additions and subtractions, which come out right, masks and shifts, a factor above 65535, and a number that is limited
by being refused (`if (x >= N) return;` refuses negative ones too).

**Fix:** limit below 0 first, and compute in a signed type that is wide enough.
""",
        "ISO C 6.3.1.3 p2",
    ),
    _rule(
        "octet",
        Severity.WARNING,
        "The code assumes that a character has eight bits.",
        """
`char`, `signed char` and `unsigned char` have 16 bits here. A cast to `unsigned char` does not cut, a checksum does
not wrap at 256, CRC-8 shifts its bits out of the octet and keeps them, `~b` sets the upper eight bits, 0xF6 in a
`signed char` is 246 and not -10, `sizeof x * 8` is half of the bits.

On every host it is right, which is why such drivers arrive tested. The finding shows what eight bits would have
given. A counter that is stepped by a constant and held against a limit is not reported: to it 16 bits are welcome.

**Fix:** mask with `& 0xFF`; extend the sign by hand (`if (t > 127) t -= 256;`).
""",
        "CC table 6-1",
        how="dynamic/static",
    ),
    _rule(
        "float-to-int",
        Severity.ERROR,
        "A float outside the range of the integer type was converted.",
        """
C leaves the result undefined. What this chip gives depends on the library (`--float-to-int` chooses between
saturation and the low bits); NaN gives some number, too. A duty cycle or a register is then set to it.

**Fix:** limit the float before the conversion. Look for the place where it left its range: `hil explain nan`.
""",
        "ISO C 6.3.1.4 p1",
    ),
    _rule(
        "float-argument",
        Severity.WARNING,
        "A float argument lost much of its value when it was converted to an integer.",
        """
The prototype wants an integer, and C cuts the fraction in silence: 2.9 volts become the code 2. The finding is made at
the end of a run, and only where the greatest value lay between 1 and 10 and lost a tenth of itself: a float that was
scaled to what the function takes is not reported, nor is one to which a half was added to round it.

**Fix:** scale it to the unit that the function takes; a cast if the whole part is meant.
""",
        "ISO C 6.5.2.2 p7, 6.3.1.4 p1",
    ),
    _rule(
        "float-magnitude",
        Severity.WARNING,
        "An integer function takes the magnitude of a float.",
        """
`abs` and `labs` take integers: -0.75 becomes 0 before they see it, and 40000.0 does not fit an `int` of 16 bits. C
converts in silence, because the prototype says so.

A cast says that the whole part is meant, and is not reported.

**Fix:** `fabsf(x)`, or `fabs(x)`.
""",
        "ISO C 7.20.6.1, 7.12.7.2",
        how="static",
    ),
    _rule(
        "division-by-zero",
        Severity.ERROR,
        "A number was divided by zero.",
        """
An integer division by zero does not trap here: the result is made of ones (so does the loop of the library leave it).
A float division gives infinity, or NaN for 0/0; with the chip's own divider (`--divide nr`) the seed decides.

A host stops the program for integers, so the case was never met there if it never happened there.

**Fix:** test the divisor; for a measured period, decide what "none yet" means.
""",
        "ISO C 6.5.5 p5",
    ),
    _rule(
        "shift-range",
        Severity.ERROR,
        "A shift count is negative, or as large as the width of the type.",
        """
`1 << 20` is a shift of a 16-bit `int`: undefined, and 0 at best. On a host it is 1048576.

**Fix:** shift an `unsigned long`: `1UL << n`; check the count.
""",
        "ISO C 6.5.7 p3",
    ),
    _rule(
        "nan",
        Severity.WARNING,
        "An operation on finite numbers gave a NaN or an infinity.",
        """
The place of birth: a product beyond 3.4e38, a square root of a negative number. From here on it spreads through
every sum, and no comparison with NaN is true. Floats are watched in an image that is linked with `watch`;
`math.h` is watched always, and a division by zero has a rule of its own.

**Fix:** limit the operands; look at the first value in the finding.
""",
        "IEEE 754 7.2, 7.4",
    ),
    _rule(
        "nan-output",
        Severity.ERROR,
        "A NaN or an infinity reached a shared object or left the firmware.",
        """
It arrived in a file-scope object or in an argument of a library or kernel function (a text that is sent, a sine). The
first arrival at each place is reported. An integrator that has taken up a NaN never gets rid of it.

**Fix:** follow the value back: `nan`, `division-by-zero`, or an object that was never written (`--fill nan`).
""",
        "IEEE 754 6.2",
    ),
)
